//! What is made of homogeneous devices.

use super::*;
use crate::device::{Request, built};
use crate::keys::Value;
use glam::DMat3;
use optics::medium::{Medium, principal_axes};

fn structure(kind: &str, keys: &[(&str, Value)]) -> Structure {
    built(kind, keys, Request::default())
}

fn perfect() -> Imperfection {
    Imperfection::default()
}

fn media(structure: &Structure) -> Vec<Medium> {
    let medium = |region: &Region| match region {
        Region::Homogeneous(region) => region.medium,
        _ => panic!("homogeneous"),
    };
    structure.regions.iter().map(medium).collect()
}

#[test]
fn without_imperfections_nothing_changes() {
    for material in ["impedance-matched", "positive-uniaxial", "negative-uniaxial"] {
        let design = structure("square-cloak", &[("material", material.into())]);
        let made = perfect().apply(design.clone(), (0, 0)).expect("made");
        assert_eq!(media(&made), media(&design));
    }
}

#[test]
fn each_value_has_its_own_error_and_equal_ones_stay_equal() {
    let design = structure("square-cloak", &[("material", "positive-uniaxial".into())]);
    let imperfection = Imperfection { error: 0.01, seed: 3, ..perfect() };
    let made = media(&imperfection.apply(design.clone(), (0, 0)).expect("made"));
    for (medium, design) in made.iter().zip(media(&design)) {
        let axis = medium.optic_axis().expect("still uniaxial");
        assert!(axis.cross(design.optic_axis().expect("uniaxial")).length() < 1e-12);
        let e = medium.permittivity();
        assert_eq!(*e, DMat3::from_diagonal(glam::DVec3::splat(e.x_axis.x)));
        let off = e.x_axis.x / design.permittivity().x_axis.x - 1.0;
        assert!(off != 0.0 && off.abs() < 0.05, "{off}");
    }
    assert!(made[0].permittivity() != made[1].permittivity());
    let again = media(&imperfection.apply(design.clone(), (0, 0)).expect("made"));
    assert_eq!(made, again);
    for other in [
        Imperfection { seed: 4, ..imperfection }.apply(design.clone(), (0, 0)),
        imperfection.apply(design.clone(), (0, 1)),
        imperfection.apply(design, (1, 0)),
    ] {
        assert!(made[0] != media(&other.expect("made"))[0]);
    }
}

#[test]
fn errors_have_the_spread_asked_for() {
    let design = structure("square-cloak", &[]);
    let ideal = principal_axes(media(&design)[0].permittivity()).0;
    let (mut squares, mut count) = (0.0, 0.0);
    for draw in 0..400 {
        let imperfection = Imperfection { error: 0.02, ..perfect() };
        let made = media(&imperfection.apply(design.clone(), (0, draw)).expect("made"));
        let values = principal_axes(made[0].permittivity()).0;
        for i in 0..3 {
            squares += (values[i] / ideal[i] - 1.0).powi(2);
            count += 1.0;
        }
    }
    let sigma = f64::sqrt(squares / count);
    // Within five standard errors of a standard deviation, 1/sqrt(2 N) of it.
    assert!((sigma / 0.02 - 1.0).abs() < 5.0 / f64::sqrt(2.0 * count), "{sigma}");
}

#[test]
fn levels_and_a_range_bring_values_to_what_can_be_made() {
    let design = structure("square-cloak", &[]);
    let sorted = |medium: &Medium| {
        let mut values = principal_axes(medium.permeability()).0.to_array();
        values.sort_by(f64::total_cmp);
        values
    };
    // 0.30565, 2.36603 and 3.27170 in a range of 0.4 to 3.0 in steps of 0.65.
    let limited = Imperfection { minimum: Some(0.4), maximum: Some(3.0), levels: 5, ..perfect() };
    for medium in media(&limited.apply(design.clone(), (0, 0)).expect("made")) {
        for (value, level) in sorted(&medium).into_iter().zip([0.4, 2.35, 3.0]) {
            assert!((value - level).abs() < 1e-12, "{value} {level}");
        }
    }
    // Of the design's own range, two levels keep the ends.
    let two = Imperfection { levels: 2, ..perfect() };
    for (made, design) in
        media(&two.apply(design.clone(), (0, 0)).expect("made")).iter().zip(media(&design))
    {
        let [least, middle, largest] = sorted(made);
        let ends = sorted(&design);
        assert!((least - ends[0]).abs() < 1e-12 && (largest - ends[2]).abs() < 1e-12);
        assert!((middle - largest).abs() < 1e-12);
    }
}

#[test]
fn loss_is_that_of_each_component_but_not_of_vacuum() {
    let lossy = Imperfection { loss_tangent: 1e-3, ..perfect() };
    let made = lossy.apply(structure("square-cloak", &[]), (0, 0)).expect("made");
    for medium in media(&made) {
        let (permittivity, permeability) = medium.tensors();
        for tensor in [permittivity, permeability] {
            assert!(tensor.im.abs_diff_eq(tensor.re * 1e-3, 1e-17));
        }
    }
    let body = structure("body", &[("permittivity", 2.25.into())]);
    let made = lossy.apply(body, (0, 0)).expect("made");
    let (permittivity, permeability) = media(&made)[0].tensors();
    assert!(permittivity.im.abs_diff_eq(DMat3::from_diagonal(glam::DVec3::splat(2.25e-3)), 1e-15));
    assert_eq!(permeability.im, DMat3::ZERO);
    // A body of vacuum stays one.
    let made = lossy.apply(structure("body", &[]), (0, 0)).expect("made");
    assert!(!media(&made)[0].absorbs());
}

#[test]
fn what_cannot_be_is_refused_by_its_key() {
    let refused = |imperfection: Imperfection, kind: &str| {
        imperfection
            .apply(structure(kind, &[]), (0, 0))
            .expect_err("must be refused")
            .path_in("device.0")
    };
    let upside_down = Imperfection { minimum: Some(2.0), maximum: Some(1.0), ..perfect() };
    assert_eq!(refused(upside_down, "square-cloak"), "device.0.imperfection.minimum");
    assert_eq!(
        refused(Imperfection { levels: 1, ..perfect() }, "square-cloak"),
        "device.0.imperfection.levels"
    );
    assert_eq!(refused(perfect(), "mirror-detour"), "device.0.imperfection");
    assert_eq!(refused(perfect(), "eaton-lens"), "device.0.imperfection");
    let nothing = Imperfection { minimum: Some(0.0), maximum: Some(0.0), ..perfect() };
    assert_eq!(refused(nothing, "square-cloak"), "device.0.imperfection");
}
