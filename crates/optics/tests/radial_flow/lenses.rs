//! Graded balls.

use super::Numbers;
use super::hamiltonian::{Dual, Phase, follow, spherical};
use crate::long;
use glam::DVec3;
use optics::medium::ModeKind;
use optics::propagation::reference::{self, ReferenceRay, SquaredIndex};
use optics::propagation::{CentralLens, TransmutedSphere};
use std::f64::consts::PI;

pub const RADIUS: f64 = 3.0;

/// n and dn/dr at a radius.
type Profile = fn(f64) -> (f64, f64);

/// A point of the surface and a direction into the ball, of an impact parameter of at least
/// `least`.
fn entry(numbers: &mut Numbers, least: f64) -> (DVec3, DVec3) {
    loop {
        let x = numbers.direction();
        let mut d = numbers.direction();
        if d.dot(x) > 0.0 {
            d = -d;
        }
        if x.cross(d).length() > least {
            return (x * RADIUS, d);
        }
    }
}

/// n and dn/dr of Eaton's family, from v = n^m alone.
fn eaton(turn: f64, r: f64) -> (f64, f64) {
    let m = PI / turn;
    let x = r / RADIUS;
    let radius_of = |v: f64| 2.0 * v.powf(1.0 - 1.0 / m) / (1.0 + v * v);
    let (mut low, mut high) = (1.0 - 1e-2, 1e9);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if radius_of(middle) > x { low = middle } else { high = middle }
    }
    let v = 0.5 * (low + high);
    let slope = radius_of(v) * ((1.0 - 1.0 / m) / v - 2.0 * v / (1.0 + v * v));
    let n = v.powf(1.0 / m);
    (n, n / (m * v) / slope / RADIUS)
}

fn luneburg(r: f64) -> (f64, f64) {
    let x = r / RADIUS;
    let n = (2.0 - x * x).sqrt();
    (n, -x / n / RADIUS)
}

fn fisheye(r: f64) -> (f64, f64) {
    let x = r / RADIUS;
    (2.0 / (1.0 + x * x), -4.0 * x / (1.0 + x * x).powi(2) / RADIUS)
}

/// Rays through a lens against Hamilton's equations of p² = n².
fn check(lens: CentralLens, index: impl Fn(f64) -> (f64, f64) + Copy, least: f64) {
    let mut numbers = Numbers(7);
    for _ in 0..long::count(40, 300) {
        let (position, d) = entry(&mut numbers, least);
        let r = numbers.between(0.1, 1.0) * RADIUS;
        assert!((lens.index(r) / index(r).0 - 1.0).abs() < 1e-10, "{r}");
        let dispersion = |phase| {
            let (r, radial, across) = spherical(phase);
            let n = r.through(index);
            (radial + across - n * n) * Dual::constant(0.5)
        };
        let expected = follow(position, d, dispersion, |r| RADIUS - r.length(), 0.2);
        let found = lens.advance(position, d);
        // What is off in the angle at the surface is magnified where a ray grazes it.
        let graze = position.dot(d).abs() / RADIUS;
        let tolerance = 1e-9 / graze;
        assert!(
            found.position.distance(expected.position) < tolerance * RADIUS,
            "{lens:?} {graze} {found:?} {expected:?}"
        );
        assert!(
            found.wave_vector.distance(expected.wave_vector) < tolerance,
            "{lens:?} {graze} {found:?} {expected:?}"
        );
        assert!((found.optical_path - expected.optical_path).abs() < tolerance * RADIUS);
    }
}

#[test]
fn eatons_family_against_the_ray_equation() {
    for turn in [0.5 * PI, PI, 2.0 * PI, 0.7] {
        // Closer to the centre, where the index has its pole, the integrator loses digits.
        check(CentralLens::eaton(RADIUS, turn), |r| eaton(turn, r), 0.2);
    }
}

#[test]
fn luneburg_and_fisheye_against_the_ray_equation() {
    check(CentralLens::luneburg(RADIUS), luneburg, 0.0);
    check(CentralLens::fisheye(RADIUS), fisheye, 0.0);
}

#[test]
fn fields_turn_as_rytov_says() {
    let lenses: [(CentralLens, Profile); 4] = [
        (CentralLens::eaton(RADIUS, PI), |r| eaton(PI, r)),
        (CentralLens::eaton(RADIUS, 2.0 * PI), |r| eaton(2.0 * PI, r)),
        (CentralLens::luneburg(RADIUS), luneburg),
        (CentralLens::fisheye(RADIUS), fisheye),
    ];
    let mut numbers = Numbers(11);
    for (lens, index) in lenses {
        for _ in 0..10 {
            let (position, d) = entry(&mut numbers, 0.6);
            if position.dot(d).abs() < 0.3 * RADIUS {
                continue;
            }
            let field = d.cross(numbers.direction()).normalize();
            let start =
                ReferenceRay { position, wave_vector: d, electric_field: field, optical_path: 0.0 };
            let medium = |at: DVec3| {
                let (n, slope) = index(at.length());
                SquaredIndex { value: n * n, gradient: at.normalize() * (2.0 * n * slope) }
            };
            let inside = |at: DVec3| RADIUS - at.length();
            let expected = reference::follow(start, 5e-4, 100_000, medium, inside).expect("out");
            let found = lens.advance(position, d).transport * field;
            assert!(
                found.distance(expected.electric_field) < 1e-6,
                "{lens:?} {position} {d} {found} {expected:?}"
            );
        }
    }
}

#[test]
fn rays_through_the_centre_get_the_limit() {
    for axis in [DVec3::X, DVec3::Z, DVec3::new(0.6, 0.0, -0.8)] {
        let through = |lens: CentralLens| lens.advance(-axis * RADIUS, axis);
        let invisible = through(CentralLens::eaton(RADIUS, 2.0 * PI));
        assert!(invisible.position.distance(axis * RADIUS) < 1e-13);
        assert!(invisible.direction.distance(axis) < 1e-14);
        assert!((invisible.optical_path - RADIUS * (2.0 + 2.0 * PI)).abs() < 1e-13);
        let returned = through(CentralLens::eaton(RADIUS, PI));
        assert!(returned.position.distance(-axis * RADIUS) < 1e-13);
        assert!(returned.direction.distance(-axis) < 1e-14);
        let bent = through(CentralLens::eaton(RADIUS, 0.5 * PI));
        assert!(bent.direction.dot(axis).abs() < 1e-14);
        for lens in [CentralLens::luneburg(RADIUS), CentralLens::fisheye(RADIUS)] {
            let end = through(lens);
            assert!(end.position.distance(axis * RADIUS) < 1e-13);
            assert!(end.direction.distance(axis) < 1e-14);
        }
        for mode in [ModeKind::Ordinary, ModeKind::Extraordinary, ModeKind::Shared] {
            let p = axis * TransmutedSphere::ORDINARY_INDEX;
            let end = TransmutedSphere::new(RADIUS).advance(-axis * RADIUS, p, mode);
            assert!(end.position.distance(axis * RADIUS) < 1e-13);
            assert!(end.wave_vector.distance(p) < 1e-13);
            assert!((end.optical_path - RADIUS * (2.0 + 2.0 * PI)).abs() < 1e-13);
        }
    }
}

/// n_e(r) of the transmuted sphere and its slope, from β.
fn extraordinary_index(r: f64) -> (f64, f64) {
    let x = r / RADIUS;
    let radius_of = |beta: f64| (2.0 * PI - 2.0 * beta + beta.sin()) / (PI + 1.0);
    let (mut low, mut high) = (0.5 * PI - 0.1, PI);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if radius_of(middle) > x { low = middle } else { high = middle }
    }
    let beta = 0.5 * (low + high);
    let slope = (beta.cos() - 2.0) / (PI + 1.0);
    let n = beta.sin() / x;
    (n, (beta.cos() / slope / x - n / x) / RADIUS)
}

/// p_r²/ε_o + p_t²/ε_e = 1, or p² = ε_o.
pub fn transmuted(mode: ModeKind) -> impl Fn(Phase) -> Dual {
    move |phase| {
        let (r, radial, across) = spherical(phase);
        let ordinary = Dual::constant((PI + 1.0).powi(2));
        let extraordinary = r.through(extraordinary_index);
        let of_across =
            if mode == ModeKind::Extraordinary { extraordinary * extraordinary } else { ordinary };
        (radial / ordinary + across / of_across - Dual::constant(1.0)) * Dual::constant(0.5)
    }
}

#[test]
fn the_transmuted_sphere_against_hamiltons_equations() {
    assert!((extraordinary_index(1e-6 * RADIUS).0 - (PI + 1.0) / 3.0).abs() < 1e-5);
    let sphere = TransmutedSphere::new(RADIUS);
    for r in [1e-3, 0.4, 1.7, 2.9].map(|x| x * RADIUS / 3.0) {
        assert!((sphere.extraordinary_index(r) / extraordinary_index(r).0 - 1.0).abs() < 1e-11);
    }
    let mut numbers = Numbers(3);
    for _ in 0..long::count(40, 300) {
        let (position, d) = entry(&mut numbers, 0.05);
        let x = position / RADIUS;
        let impact = x.cross(d).length();
        let around = (d - x * x.dot(d)) / impact;
        let radial = TransmutedSphere::ORDINARY_INDEX * (1.0 - impact * impact).sqrt();
        let p = around * impact - x * radial;
        let wave = transmuted(ModeKind::Extraordinary);
        let expected = follow(position, p, wave, |r| RADIUS - r.length(), 0.2);
        let found = sphere.advance(position, p, ModeKind::Extraordinary);
        let tolerance = 1e-9 / position.dot(d).abs();
        assert!(found.position.distance(expected.position) < tolerance * RADIUS);
        assert!(found.wave_vector.distance(expected.wave_vector) < tolerance * 5.0);
        assert!((found.optical_path - expected.optical_path).abs() < tolerance * RADIUS);
        // The ray is more sensitive than the wave vector, by the ratio of the permittivities.
        let off = found.direction.distance(expected.velocity.normalize());
        assert!(off < tolerance * 5.0 * (PI + 1.0).powi(2), "{off}");
        // As the invisible sphere does it.
        let invisible = CentralLens::eaton(RADIUS, 2.0 * PI).advance(position, d);
        assert!(found.position.distance(invisible.position) < 1e-12 * RADIUS);
        assert!((found.optical_path - invisible.optical_path).abs() < 1e-12 * RADIUS);
    }
}
