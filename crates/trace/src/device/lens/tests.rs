use super::*;
use crate::device::{Coating, built};

fn refused(lens: &GlassLens) -> String {
    lens.build(Request::default()).expect_err("no lens").to_string()
}

/// The number after some words of a message.
fn number_after(message: &str, words: &str) -> f64 {
    let rest = message.split(words).nth(1).unwrap_or_else(|| panic!("{message}"));
    rest.split_whitespace().next().and_then(|word| word.parse().ok()).expect("a number")
}

#[test]
fn what_a_refusal_says_would_do_does() {
    let thin = [
        GlassLens { back_radius: -20.0, ..GlassLens::default() },
        GlassLens {
            front_radius: -20.0,
            back_radius: 20.0,
            thickness: 5e-5,
            ..GlassLens::default()
        },
        GlassLens {
            front_radius: 28.0,
            front_conic: -1.0,
            back_radius: 30.0,
            thickness: 1e-3,
            diameter: 50.0,
            ..GlassLens::default()
        },
    ];
    let mut with_diameter = 0;
    for lens in thin {
        let message = refused(&lens);
        let thickness = number_after(&message, "it must be ");
        let mended = GlassLens { thickness, ..lens.clone() };
        let slack = 1e-9;
        let mended = mended.build(Request::default()).is_ok()
            || GlassLens { thickness: thickness + slack, ..lens.clone() }
                .build(Request::default())
                .is_ok();
        assert!(mended, "{message}");
        let thinner = GlassLens { thickness: thickness - slack, ..lens.clone() };
        assert!(thinner.build(Request::default()).is_err(), "{message}");
        if message.contains("or diameter") {
            with_diameter += 1;
            let diameter = number_after(&message, "or diameter ");
            let narrow = GlassLens { diameter, ..lens.clone() };
            assert!(narrow.build(Request::default()).is_ok(), "{message}");
            let wide = GlassLens { diameter: 1.001 * diameter, ..lens };
            assert!(wide.build(Request::default()).is_err(), "{message}");
        }
    }
    assert_eq!(with_diameter, 2);
    let wide = GlassLens { diameter: 41.0, thickness: 30.0, ..GlassLens::default() };
    assert_eq!(number_after(&refused(&wide), "it must be "), 40.0);
    let half = GlassLens { diameter: 40.0, thickness: 30.0, ..GlassLens::default() };
    assert!(half.build(Request::default()).is_ok());
    let long = GlassLens { front_conic: -0.75, ..wide };
    assert!(long.build(Request::default()).is_ok());
}

#[test]
fn facts_are_those_of_the_lensmaker() {
    let lens = GlassLens {
        front_radius: 10.0,
        back_radius: -25.0,
        thickness: 6.0,
        diameter: 8.0,
        ..GlassLens::default()
    };
    let facts = lens.facts(Request::default());
    let fact =
        |name: &str| match &facts.iter().find(|fact| fact.name == name).expect("a fact").value {
            crate::device::FactValue::Number(number) => *number,
            crate::device::FactValue::Numbers(numbers) => numbers[1],
        };
    let n = 1.5168;
    // 1/f = (n - 1)(1/R1 - 1/R2 + (n - 1) t/(n R1 R2)).
    let power = (n - 1.0) * (1.0 / 10.0 + 1.0 / 25.0 - (n - 1.0) * 6.0 / (n * 250.0));
    assert!((fact("focal_length_cm") * power - 1.0).abs() < 1e-14);
    let back = (1.0 - (n - 1.0) * 6.0 / (n * 10.0)) / power;
    assert!((fact("back_focal_distance_cm") - back).abs() < 1e-13);
    let front = (1.0 - (n - 1.0) * 6.0 / (n * 25.0)) / power;
    assert!((fact("front_focal_distance_cm") - front).abs() < 1e-13);
    assert!((fact("principal_planes_cm") - (3.0 + back - 1.0 / power)).abs() < 1e-13);
    assert!((fact("index") - n).abs() < 1e-15);
    let sags = [10.0f64, 25.0].map(|radius| radius - (radius * radius - 16.0).sqrt());
    assert!((fact("edge_thickness_cm") - (6.0 - sags[0] - sags[1])).abs() < 1e-12);
}

#[test]
fn coatings_are_on_its_faces_and_its_edge() {
    let structure = built("lens", &[], Request::default());
    let layer = optics::interface::FilmLayer {
        medium: optics::medium::Medium::dielectric(1.38),
        thickness: 1e-5,
    };
    let coated = structure.coated("coating", vec![layer]).expect("a coating");
    assert_eq!(coated.surfaces.len(), 3);
    assert!(coated.surfaces.iter().all(|surface| surface.coating == Coating::Film(1)));
}
