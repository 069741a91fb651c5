//! Tensors as people type them, and what is weak but real.
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a test may"
)]

use crate::long::count;
use crate::random_media::{Random, maxwell_residual};
use glam::{DMat3, DVec3};
use optics::medium::{Heading, Medium, Tensor, principal_axes};

const CALCITE: DVec3 = DVec3::new(2.7495, 2.7495, 2.2077);

/// A tensor of the given principal values, turned by a random rotation.
fn turned(values: DVec3, random: &mut Random) -> DMat3 {
    let turn = DMat3::from_axis_angle(random.direction(), random.between(0.0, 6.3));
    let m = turn * DMat3::from_diagonal(values) * turn.transpose();
    (m + m.transpose()) * 0.5
}

fn typed(tensor: DMat3, digits: i32) -> DMat3 {
    let unit = 10f64.powi(-digits);
    DMat3::from_cols_array(&tensor.to_cols_array().map(|entry| (entry / unit).round() * unit))
}

/// Modes solve Maxwell's equations of the tensors that the medium says it has.
fn assert_consistent(medium: &Medium, random: &mut Random) {
    let (normal, tangential) = (random.direction(), random.direction() * 0.7);
    for heading in [Heading::Forward, Heading::Backward] {
        for mode in medium.modes(tangential, normal, heading) {
            let residual = maxwell_residual(medium, &mode);
            assert!(residual < 1e-13, "{residual:e} {mode:?} {medium:?}");
        }
    }
}

/// The largest difference between the wave vectors of two media.
fn apart(a: &Medium, b: &Medium, random: &mut Random) -> f64 {
    let (normal, tangential) = (random.direction(), random.direction() * 0.7);
    let pairs = [Heading::Forward, Heading::Backward].map(|heading| {
        let [a, b] = [a, b].map(|medium| medium.modes(tangential, normal, heading));
        let distance =
            |i: usize, j: usize| (a[i].wave_vector - b[j].wave_vector).norm_squared().sqrt();
        distance(0, 0).max(distance(1, 1)).min(distance(0, 1).max(distance(1, 0)))
    });
    pairs[0].max(pairs[1])
}

#[test]
fn typed_calcite_is_uniaxial() {
    let mut random = Random(11);
    for _ in 0..count(500, 20_000) {
        let tensor = turned(CALCITE, &mut random);
        let exact = Medium::new(tensor, 1.0).unwrap();
        assert_eq!(exact.class_name(), "uniaxial");
        for digits in 9..=12 {
            let printed = typed(tensor, digits);
            for (medium, exact) in [
                (Medium::new(printed, 1.0).unwrap(), exact),
                (Medium::new(1.3, printed).unwrap(), Medium::new(1.3, tensor).unwrap()),
            ] {
                assert_eq!(medium.class_name(), "uniaxial", "{printed:?}");
                assert_consistent(&medium, &mut random);
                let apart = apart(&medium, &exact, &mut random);
                assert!(apart < 1e-8, "{apart:e} with {digits} digits");
                let axis = medium.optic_axis().unwrap();
                let off = axis.cross(exact.optic_axis().unwrap()).length();
                assert!(off < 1e-8, "axis off by {off:e}");
            }
        }
        // Made again from its own tensors it is the same.
        let medium = Medium::new(typed(tensor, 10), 1.0).unwrap();
        let again = Medium::new(*medium.permittivity(), 1.0).unwrap();
        assert_eq!(again.class_name(), "uniaxial");
        assert_eq!(again.permittivity(), medium.permittivity());
    }
}

#[test]
fn typed_metal_with_an_axis_is_uniaxial() {
    let mut random = Random(12);
    for _ in 0..count(200, 5_000) {
        let turn = DMat3::from_axis_angle(random.direction(), random.between(0.0, 6.3));
        let of = |a: f64, b: f64| {
            let m = turn * DMat3::from_diagonal(DVec3::new(a, a, b)) * turn.transpose();
            typed((m + m.transpose()) * 0.5, 10)
        };
        let tensor = Tensor { re: of(-3.1, 2.2), im: of(0.31, 0.07) };
        let medium = Medium::new(tensor, 1.0).unwrap();
        assert_eq!(medium.class_name(), "absorbing, uniaxial");
        assert_consistent(&medium, &mut random);
        // Absorption of which digits are a part is left as it is.
        let weak = Tensor { im: DMat3::from_diagonal(DVec3::new(1e-10, 2e-10, 3e-10)), ..tensor };
        let medium = Medium::new(weak, 1.0).unwrap();
        assert_eq!(medium.class_name(), "absorbing, general");
        assert_eq!(medium.tensors().0, weak);
    }
}

#[test]
fn typed_multiples_are_impedance_matched() {
    let mut random = Random(13);
    for _ in 0..count(200, 5_000) {
        let tensor = turned(DVec3::new(0.5, 1.3, 2.9), &mut random);
        let medium = Medium::new(typed(tensor * 1.7, 10), typed(tensor, 10)).unwrap();
        assert_eq!(medium.class_name(), "impedance matched");
        assert_consistent(&medium, &mut random);
        let absorbing = Tensor { re: tensor, im: DMat3::IDENTITY * 1e-10 };
        assert_eq!(Medium::new(absorbing, tensor).unwrap().class_name(), "absorbing, general");
    }
}

#[test]
fn biaxial_media_stay_general() {
    let mut random = Random(14);
    for _ in 0..count(200, 5_000) {
        // A biaxiality that shows in the digits, and weak ones that are small against nothing.
        for values in [
            DVec3::new(2.609, 2.613, 2.641),
            DVec3::new(2.7495, 2.7495 + 1e-8, 2.2077),
            DVec3::new(2.25, 2.25 + 1e-10, 2.25 - 1e-10),
            DVec3::new(2.25, 2.25 + 1e-9, 2.25 - 1e-7),
        ] {
            let tensor = turned(values, &mut random);
            let medium = Medium::new(tensor, 1.0).unwrap();
            assert_eq!(medium.class_name(), "biaxial", "{values}");
            assert_eq!(*medium.permittivity(), tensor);
            assert_eq!(Medium::new(1.0, tensor).unwrap().class_name(), "biaxial");
            assert_consistent(&medium, &mut random);
        }
        let [e, m] = [DVec3::new(2.0, 3.0, 4.0), DVec3::new(1.0, 1.5, 3.0)];
        let general = Medium::new(turned(e, &mut random), turned(m, &mut random)).unwrap();
        assert_eq!(general.class_name(), "general");
    }
}

#[test]
fn weak_birefringence_stays() {
    let axis = DVec3::new(0.3, -0.5, 0.7).normalize();
    let dyad = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    for exponent in 6..12 {
        let excess = 10f64.powi(-exponent);
        let tensor = DMat3::IDENTITY * 2.25 + dyad * excess;
        let medium = Medium::new(tensor, 1.0).unwrap();
        assert_eq!(medium.class_name(), "uniaxial");
        assert_eq!(*medium.permittivity(), tensor);
        let values = principal_axes(medium.permittivity()).0;
        let found = values.max_element() - values.min_element();
        assert!((found - excess).abs() < 1e-14, "{found:e}");
    }
}

#[test]
fn every_class_has_its_name() {
    let names = [
        (Medium::AIR, "isotropic"),
        (Medium::isotropic(-2.0, -1.0).unwrap(), "isotropic"),
        (Medium::new(num_complex::Complex64::new(-5.8, 2.1), 1.0).unwrap(), "absorbing, isotropic"),
        (Medium::uniaxial_magnetic(1.0, 2.0, 3.0, DVec3::X).unwrap(), "uniaxial"),
        (Medium::uniaxial_electric(1.0, 2.0, 2.0 + 1e-11, DVec3::X).unwrap(), "uniaxial"),
        (
            Medium::impedance_matched(DMat3::from_diagonal(DVec3::new(0.5, 2.0, 2.0))).unwrap(),
            "impedance matched",
        ),
    ];
    for (medium, name) in names {
        assert_eq!(medium.class_name(), name, "{medium:?}");
    }
}
