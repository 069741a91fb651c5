//! Cylindrical and spherical shells.

use super::Numbers;
use super::hamiltonian::{Dual, End, Phase, cylindrical, follow, spherical};
use glam::DVec3;
use optics::geometry::Extent;
use optics::medium::{Heading, ModeKind};
use optics::propagation::{
    Border, OpticAxis, PathEnd, RadialFlow, TransformedShell, UniaxialCylinder,
};
use optics::transformation::{RadialMap, Symmetry};
use optics::wave::ComplexVector;

pub const A: f64 = 1.0;
pub const B: f64 = 2.0;
const K: f64 = 2.0;

fn constant(value: f64) -> Dual {
    Dual::constant(value)
}

/// s = (r - a)/r.
fn s_of(r: Dual) -> Dual {
    constant(1.0) - constant(A) / r
}

/// p·Mp = det M for M = diag(s, 1/s, k² s).
pub fn matched_cylinder(phase: Phase) -> Dual {
    let (r, radial, around) = cylindrical(phase);
    let s = s_of(r);
    let axial = constant(K * K) * s;
    (s * radial + around / s + axial * phase[5] * phase[5] - axial) * constant(0.5)
}

/// p·Mp = det M for M = diag(k s², k, k).
pub fn matched_sphere(phase: Phase) -> Dual {
    let (r, radial, across) = spherical(phase);
    let s2 = s_of(r) * s_of(r);
    (s2 * radial + across - constant(K * K) * s2) * constant(0.5 * K)
}

/// (p·a)²/ε_o + (p × a)²/ε_e = 1 for the optic axis a, or p² = ε_o.
pub fn uniaxial(axis: OpticAxis, mode: ModeKind) -> impl Fn(Phase) -> Dual {
    move |phase| {
        let (r, radial, around) = cylindrical(phase);
        let axial = phase[5] * phase[5];
        let (large, small) = (constant(K * K), constant(K * K) * s_of(r) * s_of(r));
        let all = radial + around + axial;
        let form = match (axis, mode) {
            (OpticAxis::Radial, ModeKind::Extraordinary) => {
                radial / large + (around + axial) / small
            }
            (OpticAxis::Azimuthal, ModeKind::Extraordinary) => {
                around / small + (radial + axial) / large
            }
            (OpticAxis::Radial, _) => all / large,
            (OpticAxis::Azimuthal, _) => all / small,
        };
        (form - constant(1.0)) * constant(0.5)
    }
}

/// A ray that enters a flow from air: a point of the border, the wave vector inside and what else
/// there is to know of the wave.
struct Entry {
    position: DVec3,
    wave_vector: DVec3,
    ray: DVec3,
    electric: ComplexVector,
}

fn enter(
    flow: &RadialFlow,
    position: DVec3,
    outward: DVec3,
    d: DVec3,
    mode: ModeKind,
) -> Option<Entry> {
    let tangential = d - outward * d.dot(outward);
    let medium = flow.medium(position)?;
    let modes = medium.modes(tangential, -outward, Heading::Forward);
    let wave = modes.into_iter().find(|wave| mode == ModeKind::Shared || wave.kind == mode)?;
    Some(Entry {
        position,
        wave_vector: wave.wave_vector.re,
        ray: wave.ray?,
        electric: wave.electric,
    })
}

pub fn compare(found: &PathEnd<Border>, expected: &End, tolerance: f64, what: &str) {
    let off = found.position.distance(expected.position);
    assert!(off < tolerance, "{what}: position off by {off}");
    let off = found.wave_vector.distance(expected.wave_vector) / found.wave_vector.length();
    assert!(off < tolerance, "{what}: wave vector off by {off}");
    let off = (found.optical_path - expected.optical_path).abs();
    assert!(off < tolerance, "{what}: optical path off by {off}");
    let off = found.direction.distance(expected.velocity.normalize());
    assert!(off < tolerance, "{what}: direction off by {off}");
}

/// Random rays into a shell from its round border, against the integrator.
fn check(
    flow: RadialFlow,
    dispersion: impl Fn(Phase) -> Dual + Copy,
    mode: ModeKind,
    symmetry: Symmetry,
) {
    let radial_part = |v: DVec3| if symmetry == Symmetry::Axis { v.with_z(0.0) } else { v };
    let mut numbers = Numbers(5);
    let mut compared = 0;
    while compared < 300 {
        let outward = radial_part(numbers.direction()).normalize();
        let d = numbers.direction();
        let graze = -d.dot(outward);
        // Rays that hardly turn pass the core so close that the integrator takes forever.
        let impact = radial_part(d).cross(outward).length();
        if graze < 0.05 || impact < 0.05 {
            continue;
        }
        let Some(start) = enter(&flow, outward * B, outward, d, mode) else { continue };
        let expected = follow(
            start.position,
            start.wave_vector,
            dispersion,
            |r| B - radial_part(r).length(),
            0.1,
        );
        let found = flow.advance(start.position, start.wave_vector, mode);
        assert_eq!(found.surface, Border::Outer);
        compare(&found, &expected, 1e-9 / graze, &format!("{flow:?} {mode:?} {d}"));
        let medium = flow.medium(found.position).expect("a medium");
        let field = ComplexVector::from(found.transport * start.electric.re);
        let after = medium.poynting(found.wave_vector, field);
        let before = flow.medium(start.position).expect("a medium");
        let power = before.poynting(start.wave_vector, start.electric.re.into()).length();
        assert!((after.length() / power - 1.0).abs() < 1e-10);
        assert!(after.normalize().distance(found.direction) < 1e-10);
        assert!(start.ray.is_normalized());
        compared += 1;
    }
}

#[test]
fn matched_shells_against_hamiltons_equations() {
    for (symmetry, dispersion) in [
        (Symmetry::Axis, matched_cylinder as fn(Phase) -> Dual),
        (Symmetry::Centre, matched_sphere as fn(Phase) -> Dual),
    ] {
        let map = RadialMap::new(A, B, symmetry);
        let flow = RadialFlow::Transformed(TransformedShell { map, extent: Extent::ENDLESS });
        check(flow, dispersion, ModeKind::Shared, symmetry);
    }
}

#[test]
fn uniaxial_shells_against_hamiltons_equations() {
    for (axis, mode) in [
        (OpticAxis::Azimuthal, ModeKind::Extraordinary),
        (OpticAxis::Azimuthal, ModeKind::Ordinary),
        (OpticAxis::Radial, ModeKind::Extraordinary),
    ] {
        let flow = RadialFlow::Uniaxial(UniaxialCylinder::new(A, B, axis, Extent::ENDLESS));
        check(flow, &uniaxial(axis, mode), mode, Symmetry::Axis);
    }
}

#[test]
fn short_shells_end_where_they_end() {
    let extent = Extent::centred(Some(0.8));
    let map = RadialMap::new(A, B, Symmetry::Axis);
    let uniaxial_shell = |axis| RadialFlow::Uniaxial(UniaxialCylinder::new(A, B, axis, extent));
    let matched = RadialFlow::Transformed(TransformedShell { map, extent });
    let inside = |r: DVec3| (B - r.truncate().length()).min(0.4 - r.z.abs());
    let mut ends = [0; 3];
    let mut numbers = Numbers(9);
    for (flow, mode, axis) in [
        (matched, ModeKind::Shared, None),
        (uniaxial_shell(OpticAxis::Azimuthal), ModeKind::Extraordinary, Some(OpticAxis::Azimuthal)),
        (uniaxial_shell(OpticAxis::Azimuthal), ModeKind::Ordinary, Some(OpticAxis::Azimuthal)),
        (uniaxial_shell(OpticAxis::Radial), ModeKind::Extraordinary, Some(OpticAxis::Radial)),
    ] {
        let mut compared = 0;
        while compared < 100 {
            // From the side, or from the upper end.
            let across = numbers.direction().with_z(0.0).normalize();
            let (position, outward) = if compared % 2 == 0 {
                (across * B + DVec3::Z * numbers.between(-0.4, 0.4), across)
            } else {
                (across * numbers.between(1.2, 1.95) + DVec3::Z * 0.4, DVec3::Z)
            };
            let d = numbers.direction();
            if -d.dot(outward) < 0.1 || d.with_z(0.0).cross(position).length() < 0.05 {
                continue;
            }
            let Some(start) = enter(&flow, position, outward, d, mode) else { continue };
            let (p, at) = (start.wave_vector, start.position);
            let expected = match axis {
                None => follow(at, p, matched_cylinder, inside, 0.02),
                Some(axis) => follow(at, p, uniaxial(axis, mode), inside, 0.02),
            };
            let found = flow.advance(at, p, mode);
            let sine = found.direction.dot(found.outward);
            if sine < 0.02 {
                continue;
            }
            ends[match found.surface {
                Border::Outer => 0,
                Border::Bottom => 1,
                _ => 2,
            }] += 1;
            compare(&found, &expected, 1e-9 / sine, &format!("{mode:?} {axis:?} {position} {d}"));
            compared += 1;
        }
    }
    assert!(ends.iter().all(|&count| count > 20), "{ends:?}");
}

#[test]
fn straight_ordinary_waves_come_to_the_core() {
    let shell = UniaxialCylinder::new(A, B, OpticAxis::Radial, Extent::ENDLESS);
    let p = DVec3::new(-1.8, 0.3, 0.0);
    let p = p.with_z((K * K - p.length_squared()).sqrt());
    let start = DVec3::new(B, 0.0, 0.0);
    let end = shell.advance(start, p, ModeKind::Ordinary);
    assert_eq!(end.surface, Border::Inner);
    assert!((end.position.truncate().length() - A).abs() < 1e-15);
    assert!((end.position - start).cross(p).length() < 1e-14);
    assert!((end.optical_path - K * end.position.distance(start)).abs() < 1e-14);
    assert!(end.outward.dot(end.position) < 0.0);
    let reflected = p - end.outward * (2.0 * p.dot(end.outward));
    let out = shell.advance(end.position, reflected, ModeKind::Ordinary);
    assert_eq!(out.surface, Border::Outer);
    assert!((out.position.truncate().length() - B).abs() < 1e-14);
}

/// Rays ever closer to the axis tend to the ray that is aimed at it.
#[test]
fn rays_at_the_axis_get_the_limit() {
    let map = |symmetry| RadialMap::new(A, B, symmetry);
    let shell = |symmetry| {
        RadialFlow::Transformed(TransformedShell { map: map(symmetry), extent: Extent::ENDLESS })
    };
    let uniaxial = |axis| RadialFlow::Uniaxial(UniaxialCylinder::new(A, B, axis, Extent::ENDLESS));
    for (flow, mode) in [
        (shell(Symmetry::Axis), ModeKind::Shared),
        (shell(Symmetry::Centre), ModeKind::Shared),
        (uniaxial(OpticAxis::Azimuthal), ModeKind::Extraordinary),
        (uniaxial(OpticAxis::Azimuthal), ModeKind::Ordinary),
        (uniaxial(OpticAxis::Radial), ModeKind::Extraordinary),
    ] {
        let run = |impact: f64| {
            let position = DVec3::new(-(B * B - impact * impact).sqrt(), impact, 0.0);
            let outward = position.normalize();
            let start = enter(&flow, position, outward, DVec3::X, mode);
            // On the axis both waves are one, by the names s and p.
            let p = start.map_or_else(|| DVec3::X * K, |start| start.wave_vector);
            let p = if mode == ModeKind::Ordinary && impact == 0.0 { DVec3::X } else { p };
            flow.advance(position, p, mode)
        };
        let limit = run(0.0);
        assert!(limit.position.is_finite() && limit.optical_path.is_finite());
        assert!(limit.transport.x_axis.is_finite() && limit.direction.is_finite());
        for impact in [1e-4, 1e-7, 1e-10] {
            // The ordinary ray that turns sweeps an angle of impact times its logarithm.
            let tolerance = 100.0 * impact;
            let near = run(impact);
            assert!(
                near.position.distance(limit.position) < tolerance,
                "{flow:?} {mode:?} {impact}"
            );
            assert!(near.direction.distance(limit.direction) < tolerance, "{flow:?} {mode:?}");
            assert!(
                (near.optical_path - limit.optical_path).abs() < tolerance,
                "{flow:?} {mode:?}"
            );
        }
    }
}
