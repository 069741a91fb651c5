//! Prisms of one's own: the square cloak written as prisms is the square cloak, however its
//! cross-sections are cut; absorbing ones keep what Beer and Lambert say; what cannot be is refused
//! at its place.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::long::count;
use crate::pictures::{difference, picture, png};
use crate::rays::{assembly, launch, launches_around, refusal};
use cloakroom::output::to_srgb;
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DMat3, DVec2, DVec3};
use num_complex::Complex64;
use optics::transformation::StripToRhombus;
use std::fmt::Write;

fn prisms(prisms: &str) -> String {
    format!("[[device]]\nkind = \"prisms\"\n{prisms}")
}

/// Rays from all around, towards the device.
fn launches(count: u32) -> impl Iterator<Item = Launch<2>> {
    launches_around(count, [60.0, 40.0], DVec3::splat(20.0))
}

const D: f64 = 14.1 * std::f64::consts::FRAC_1_SQRT_2;

/// Permittivity and permeability of the square cloak in a quadrant.
fn media(map: &StripToRhombus, material: &str, quadrant: DVec2) -> [DMat3; 2] {
    let (principal, angle) = map.principal_values();
    let (sin, cos) = (angle.to_radians() * quadrant.x * quadrant.y).sin_cos();
    let (u, v) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
    // The ordinary value everywhere but along the axis.
    let uniaxial = |ordinary: f64, extraordinary: f64, axis: DVec3| {
        let dyad = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
        DMat3::from_diagonal(DVec3::splat(ordinary)) + dyad * (extraordinary - ordinary)
    };
    let scalar = DMat3::from_diagonal(DVec3::splat(principal.z));
    match material {
        "positive-uniaxial" => [scalar, uniaxial(principal.y, principal.x, u)],
        "negative-uniaxial" => [scalar, uniaxial(principal.x, principal.y, v)],
        _ => [map.tensor(quadrant); 2],
    }
}

/// The square cloak as prisms; `cut` moves a corner along a seam between two segments, in
/// which the side of one then meets two of the other.
fn square_cloak_as_prisms(material: &str, cut: bool) -> String {
    let map = StripToRhombus::new(D, 1.0 / 3f64.sqrt());
    let b = map.half_height();
    let mut text = prisms("");
    for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
        let [permittivity, permeability] =
            media(&map, material, DVec2::new(x, y)).map(|m| [0, 1, 2].map(|i| m.row(i).to_array()));
        // Each quadrant whole, or in two parts; the segments meet at x = 0, in part only.
        let middle = y * (0.4 * D + 0.6 * b);
        let outlines: Vec<Vec<[f64; 2]>> = if cut && x > 0.0 {
            let aside = [0.5 * D * x, 0.5 * D * y];
            vec![
                vec![[x * D, 0.0], aside, [0.0, middle], [0.0, y * b]],
                vec![aside, [0.0, y * D], [0.0, middle]],
            ]
        } else {
            vec![vec![[x * D, 0.0], [0.0, y * D], [0.0, y * b]]]
        };
        for corners in outlines {
            writeln!(
                text,
                "[[device.prism]]\ncorners = {corners:?}\npermittivity = {permittivity:?}\n\
                 permeability = {permeability:?}"
            )
            .unwrap();
        }
    }
    let metal = [[D, 0.0], [0.0, b], [-D, 0.0], [0.0, -b]];
    writeln!(text, "[[device.prism]]\ncorners = {metal:?}\nmetal = true").unwrap();
    text
}

fn same_leaves(one: &[Leaf<2>], other: &[Leaf<2>]) -> bool {
    one.len() == other.len()
        && one.iter().zip(other).all(|(a, b)| {
            (a.position - b.position).length() < 1e-9
                && (a.direction - b.direction).length() < 1e-9
                && (a.optical_path - b.optical_path).abs() < 1e-9
                && (a.power[0] - b.power[0]).abs() + (a.power[1] - b.power[1]).abs() < 1e-9
        })
}

#[test]
fn the_square_cloak_as_prisms_is_the_square_cloak() {
    let limits = Limits { min_power: 1e-9, tolerance: 1e-9 };
    for rotation in [0.0, 10.0] {
        let cloak =
            assembly(&format!("[[device]]\nkind = \"square-cloak\"\nrotation = {rotation}\n"));
        for cut in [false, true] {
            let text = square_cloak_as_prisms("impedance-matched", cut).replacen(
                "\"prisms\"\n",
                &format!("\"prisms\"\nrotation = {rotation}\n"),
                1,
            );
            let own = assembly(&text);
            let (mut tracer, mut own_tracer) =
                (Tracer::new(&cloak, limits), Tracer::new(&own, limits));
            let mut off = 0;
            for launch in launches(count(400, 3000)) {
                let (leaves, _) = tracer.trace(&launch);
                let (own_leaves, outcome) = own_tracer.trace(&launch);
                assert_eq!(outcome.stats.lost, 0, "{launch:?}");
                off += u32::from(!same_leaves(leaves, own_leaves));
            }
            assert_eq!(off, 0, "{rotation} {cut}");
        }
    }
}

#[test]
fn both_give_the_same_pictures() {
    for material in ["impedance-matched", "positive-uniaxial", "negative-uniaxial"] {
        for rotation in ["rotation = 0\n", "rotation = 10\n"] {
            let camera = "[camera]\nresolution = [96, 72]\nsamples = 1\n";
            let own = |cut: bool| {
                let device = format!("\"prisms\"\n{rotation}");
                let own = square_cloak_as_prisms(material, cut);
                picture(&format!("{camera}{}", own.replacen("\"prisms\"\n", &device, 1)))
            };
            let cloak = picture(&format!(
                "{camera}[[device]]\nkind = \"square-cloak\"\nmaterial = \"{material}\"\n{rotation}"
            ));
            let (whole, cut) = (own(false), own(true));
            let shown = |picture| to_srgb(picture).unwrap();
            let (pixels, steps) = difference(&shown(&cloak), &shown(&whole));
            // A step of rounding, in 0.01 % of the pixels.
            assert!(steps <= 1 && 10_000 * pixels <= 96 * 72, "{material} {pixels} {steps}");
            // Cut in parts it is the same to the light; but rays beside each other that enter
            // through two parts of a face are not known for neighbours, and the photograph is
            // filtered otherwise.
            for name in ["delivered", "pruned", "time_of_flight", "time_of_flight_spread"] {
                let [one, other] =
                    [&cloak, &cut].map(|picture| &picture.channel(name).unwrap().samples);
                let off = |i: usize| (one.get(i) - other.get(i)).abs();
                let worst = (0..one.len()).map(off).filter(|off| off.is_finite());
                let worst = worst.fold(0.0, f64::max);
                assert!(worst < 1e-12, "{material} {name} {worst:e}");
            }
            let empty = png(camera);
            let seen = difference(&shown(&cloak), &empty).0;
            assert!(rotation.contains("= 0") || seen > 300, "{material} {seen}");
        }
    }
}

#[test]
fn bare_prisms_are_the_metal_alone() {
    let limits = Limits { min_power: 1e-9, tolerance: 1e-9 };
    let own = assembly(&square_cloak_as_prisms("impedance-matched", true).replacen(
        '\n',
        "\nshow = \"bare\"\n",
        1,
    ));
    let bare = assembly("[[device]]\nkind = \"square-cloak\"\nshow = \"bare\"\n");
    let (mut tracer, mut own_tracer) = (Tracer::new(&bare, limits), Tracer::new(&own, limits));
    for launch in launches(count(200, 1000)) {
        let (leaves, _) = tracer.trace(&launch);
        assert!(same_leaves(leaves, own_tracer.trace(&launch).0), "{launch:?}");
    }
}

/// A concave glass prism and the same glass in convex prisms: how it is cut makes no difference.
#[test]
fn cuts_are_no_interfaces() {
    let concave = assembly(&prisms(
        "[[device.prism]]\npermittivity = 2.25\n\
         corners = [[-8, -6], [4, -6], [4, 0], [-2, 1], [-2, 7], [-8, 6]]\n",
    ));
    let convex = assembly(&prisms(
        "[[device.prism]]\npermittivity = 2.25\ncorners = [[-8, -6], [-2, -6], [-2, 7], [-8, 6]]\n\
         [[device.prism]]\npermittivity = 2.25\ncorners = [[-2, -6], [4, -6], [4, 0], [-2, 1]]\n",
    ));
    let limits = Limits { min_power: 1e-6, tolerance: 1e-9 };
    let (mut one, mut other) = (Tracer::new(&concave, limits), Tracer::new(&convex, limits));
    for launch in launches(count(300, 2000)) {
        let (leaves, outcome) = one.trace(&launch);
        assert_eq!(outcome.stats.lost, 0);
        assert!(same_leaves(leaves, other.trace(&launch).0), "{launch:?}");
    }
}

/// Slab of an absorbing medium between x = -d/2 and d/2: powers of the leaves from Fresnel's
/// amplitudes and Beer and Lambert's law, computed for each polarization on its own.
#[test]
fn absorbing_slabs_keep_what_beer_and_lambert_say() {
    let (thickness, wavelength) = (3.0, 633.0);
    let wave_number = std::f64::consts::TAU / (wavelength * 1e-7);
    for (e, m) in [
        (Complex64::new(2.25, 6e-7), Complex64::ONE),
        (Complex64::new(2.25, 2e-7), Complex64::new(1.3, 3e-7)),
        (Complex64::new(-1.8, 1e-6), Complex64::new(-1.1, 5e-7)),
    ] {
        let text = format!(
            "[light]\nwavelength_nm = {wavelength}\n[[device]]\nkind = \"prisms\"\n[[device.prism]]\n\
             corners = [[-1.5, -1000], [1.5, -1000], [1.5, 1000], [-1.5, 1000]]\n\
             permittivity = [{}, {:e}]\npermeability = [{}, {:e}]\n",
            e.re, e.im, m.re, m.im
        );
        let assembly = assembly(&text);
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-9, tolerance: 1e-9 });
        for angle in [0.0f64, 20.0, 45.0, 70.0] {
            let (sin, cos) = angle.to_radians().sin_cos();
            let launch = launch(DVec3::new(-5.0, 1.0, 2.0), DVec3::new(cos, sin, 0.0));
            let (leaves, outcome) = tracer.trace(&launch);
            let mut q = (e * m - sin * sin).sqrt();
            if q.im < 0.0 {
                q = -q;
            }
            // E along z (the first launched) sees q/µ, E in the plane q/ε; air sees cos.
            let admittance = [q / m, q / e];
            let kept = (-2.0 * wave_number * q.im * thickness).exp();
            for (i, admittance) in admittance.into_iter().enumerate() {
                let r = ((cos - admittance) / (cos + admittance)).norm_sqr();
                // Reflected from the first face; through; once back and forth inside.
                let expected = [r, (1.0 - r).powi(2) * kept, (1.0 - r).powi(2) * kept.powi(2) * r];
                for power in expected {
                    let near = leaves.iter().any(|leaf| (leaf.power[i] - power).abs() < 1e-6);
                    assert!(near, "{e} {m} {angle} {i}: {power} not in {leaves:?}");
                }
                let all = (1.0 - r) * (1.0 - kept) / (1.0 - r * kept);
                assert!((outcome.absorbed[i] - all).abs() < 1e-6);
                assert!(outcome.absorbed[i] > 0.01);
            }
            outcome.assert_balanced(leaves, 1e-12, &(e, m, angle));
        }
    }
}

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    let square = "corners = [[0, 0], [2, 0], [2, 2], [0, 2]]\n";
    let glass = "permittivity = 2.25\n";
    for (text, place, words) in [
        (prisms(""), "test:1:1", "there is no prism"),
        (prisms(&format!("[[device.prism]]\n{glass}")), "test:3:1", "no `corners`"),
        (prisms(&format!("[[device.prism]]\n{square}")), "test:3:1", "metal = true"),
        (
            prisms(&format!("[[device.prism]]\n{square}{glass}metal = true\n")),
            "test:5:16",
            "no permittivity",
        ),
        (
            prisms(&format!("[[device.prism]]\n{square}permitivity = 2\n")),
            "test:5:1",
            "`permittivity`",
        ),
        (
            prisms(&format!("[[device.prism]]\n{square}permittivity = [1, 2, 3]\n")),
            "test:5:16",
            "3 x 3",
        ),
        (
            prisms(&format!(
                "[[device.prism]]\n{square}permittivity = 2\n\
                 permeability = [[1, 0, 0], [0.5, 1, 0], [0, 0, 1]]\n"
            )),
            "test:6:16",
            "not symmetric",
        ),
        (
            prisms(&format!("[[device.prism]]\n{square}permittivity = [2, -0.1]\n")),
            "test:5:16",
            "gain",
        ),
        (
            prisms(&format!(
                "[[device.prism]]\n{square}{glass}[[device.prism]]\n\
                 corners = [[1, 1], [3, 1], [3, 3]]\nmetal = true\n"
            )),
            "test:7:11",
            "prism 1 overlaps prism 0",
        ),
        (
            prisms("[[device.prism]]\ncorners = [[0, 0], [1, 1], [1, 0], [0, 1]]\nmetal = true\n"),
            "test:4:11",
            "crosses",
        ),
        (
            prisms("[[device.prism]]\ncorners = [[0, 0], [1, 1], [2]]\nmetal = true\n"),
            "test:4:11",
            "[x, y]",
        ),
        (prisms("prism = 3\n"), "test:3:9", "list of tables"),
        (
            prisms(&format!("show = \"bare\"\n[[device.prism]]\n{square}{glass}")),
            "test:3:8",
            "no prism is metal",
        ),
    ] {
        let error = refusal(&text);
        assert!(error.starts_with(place) && error.contains(words), "{text}\n{error}");
    }
}

#[test]
fn prisms_are_shown_as_what_they_imitate() {
    let glass = "corners = [[-8, 0], [8, 0], [0, 9]]\nindex = 1.5\n";
    let metal = "corners = [[-9, -1], [9, -1], [9, 0], [-9, 0]]\nmetal = true\n";
    let imitated = |show: &str| {
        prisms(&format!(
            "show = \"{show}\"\n[[device.prism]]\ncorners = [[-8, 0], [8, 0], [0, 5]]\nindex = 2\n\
             [[device.imitated]]\n{glass}[[device.imitated]]\n{metal}"
        ))
    };
    let plain = prisms(&format!("[[device.prism]]\n{glass}[[device.prism]]\n{metal}"));
    let limits = Limits { min_power: 1e-6, tolerance: 1e-9 };
    let [plain, shown, cloak] =
        [plain, imitated("mirror"), imitated("cloak")].map(|text| assembly(&text));
    let [mut plain, mut shown, mut cloak] =
        [&plain, &shown, &cloak].map(|assembly| Tracer::new(assembly, limits));
    let mut other = 0;
    for launch in launches(count(100, 1000)) {
        let (leaves, _) = plain.trace(&launch);
        assert!(same_leaves(leaves, shown.trace(&launch).0), "{launch:?}");
        other += u32::from(!same_leaves(leaves, cloak.trace(&launch).0));
    }
    assert!(other > 30, "{other}");
    // What is imitated is checked where nobody looks at it, too.
    let crossed = imitated("cloak").replace("[9, 0], [-9, 0]", "[9, 1], [-9, 1]");
    let message = refusal(&crossed);
    assert!(message.contains("prism 1 overlaps prism 0"), "{message}");
    let alone = prisms(
        "show = \"mirror\"\n[[device.prism]]\ncorners = [[0, 0], [1, 0], [0, 1]]\nindex = 2\n",
    );
    assert!(refusal(&alone).contains("[[device.imitated]]"), "{}", refusal(&alone));
}
