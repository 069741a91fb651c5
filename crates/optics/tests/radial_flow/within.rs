//! Rays that start within.

use super::Numbers;
use super::hamiltonian::{Dual, Phase, follow};
use super::lenses::{RADIUS, transmuted};
use super::shells::{A, B, compare, matched_cylinder, matched_sphere, uniaxial};
use crate::long;
use glam::DVec3;
use optics::geometry::{Border, Extent};
use optics::medium::ModeKind;
use optics::propagation::{
    OpticAxis, RadialFlow, TransformedShell, TransmutedSphere, UniaxialCylinder,
};
use optics::transformation::{RadialMap, Symmetry};

type Dispersion = Box<dyn Fn(Phase) -> Dual>;

/// A flow, one of its waves, and how that runs.
type Wave = (RadialFlow, ModeKind, Dispersion);

fn waves() -> Vec<Wave> {
    let matched = |symmetry| {
        let map = RadialMap::new(A, B, symmetry);
        RadialFlow::Transformed(TransformedShell { map, extent: Extent::ENDLESS })
    };
    let mut waves: Vec<Wave> = vec![
        (matched(Symmetry::Axis), ModeKind::Shared, Box::new(matched_cylinder)),
        (matched(Symmetry::Centre), ModeKind::Shared, Box::new(matched_sphere)),
    ];
    for mode in [ModeKind::Ordinary, ModeKind::Extraordinary] {
        for axis in [OpticAxis::Radial, OpticAxis::Azimuthal] {
            let flow = RadialFlow::Uniaxial(UniaxialCylinder::new(A, B, axis, Extent::ENDLESS));
            waves.push((flow, mode, Box::new(uniaxial(axis, mode))));
        }
        let sphere = RadialFlow::Transmuted(TransmutedSphere::new(RADIUS));
        waves.push((sphere, mode, Box::new(transmuted(mode))));
    }
    waves
}

#[test]
fn rays_that_start_within_against_hamiltons_equations() {
    let mut numbers = Numbers(13);
    for (flow, mode, dispersion) in waves() {
        let [core, outer] = flow.radii();
        let radius_of = |r: DVec3| r.dot(flow.outward(r));
        let mut compared = 0;
        while compared < long::count(40, 400) {
            let from = flow.outward(numbers.direction());
            let is_upright = flow.outward(DVec3::X + DVec3::Z) == DVec3::X;
            let along = DVec3::Z * if is_upright { numbers.between(-1.0, 1.0) } else { 0.0 };
            let least = core.max(0.1) + 0.1;
            let start = from * numbers.between(least, outer - 0.05) + along;
            let ray = numbers.direction();
            // Those that hardly turn pass the core or the centre so close that the integrator takes
            // forever.
            let turns = flow.outward(ray).cross(from).length();
            let medium = flow.medium(start).expect("a medium");
            let waves = medium.waves_along_ray(ray);
            let Some(wave) = waves.iter().find(|wave| wave.kind == mode) else {
                panic!("{flow:?} {mode:?} {ray}: {waves:?}")
            };
            let p = wave.wave_vector;
            let found = flow.advance(start, p, mode);
            let graze = found.direction.dot(found.outward);
            let to_core = found.surface == Border::Inner;
            if turns < 0.1 || graze < 0.1 || (core == 0.0 && p.cross(start).length() < 0.2 * outer)
            {
                continue;
            }
            let inside = |r: DVec3| {
                let radius = radius_of(r);
                if to_core { radius - core } else { outer - radius }
            };
            let expected = follow(start, p, &dispersion, inside, 0.1);
            compare(&found, &expected, 1e-9 / graze, &format!("{flow:?} {mode:?} {start} {ray}"));
            let field = wave.electric.map_or_else(|| ray.any_orthonormal_vector(), |e| e.re);
            let size = medium.poynting(p, field.into()).length();
            if mode != ModeKind::Shared && !to_core {
                let there = flow.medium(found.position).expect("a medium");
                let after = there.poynting(found.wave_vector, (found.transport * field).into());
                assert!((after.length() / size - 1.0).abs() < 1e-9, "{flow:?} {mode:?}");
                assert!(after.normalize().distance(found.direction) < 1e-9, "{flow:?} {mode:?}");
            }
            let path = flow.path(start, p, mode, 8);
            assert!(path[0].position.distance(start) < 1e-9, "{path:?}");
            assert!(path[8].position.distance(found.position) < 1e-9, "{path:?}");
            compared += 1;
        }
    }
}
