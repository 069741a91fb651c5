//! Paths for drawings are those of the rays: their ends are the traced ones, the optical path grows
//! by the index along them, and the angular momentum about an axis or centre of symmetry is kept.

use glam::DVec3;
use optics::geometry::Extent;
use optics::medium::{Medium, ModeKind};
use optics::propagation::{
    CentralLens, ConformalFlow, Half, OpticAxis, PathPoint, RadialFlow, TransformedShell,
    TransmutedSphere, UniaxialCylinder,
};
use optics::transformation::{ConformalMap, GaussianMap, RadialMap, Symmetry, Truncation};
use std::f64::consts::PI;

/// How far the optical path of short pieces is from that of the index in their middle, along `n
/// dr`.
fn worst_piece(path: &[PathPoint], index: impl Fn(DVec3) -> f64) -> f64 {
    path.windows(2)
        .map(|pair| {
            let way = pair[0].position.distance(pair[1].position);
            let middle = (pair[0].position + pair[1].position) / 2.0;
            let grown = pair[1].optical_path - pair[0].optical_path;
            (grown - index(middle) * way).abs() / grown
        })
        .fold(0.0, f64::max)
}

fn check_ends(path: &[PathPoint], start: DVec3, end: DVec3, optical_path: f64, name: &str) {
    let (first, last) = (path[0], path[path.len() - 1]);
    assert!(first.position.distance(start) < 1e-8, "{name}: {first:?}");
    assert!(last.position.distance(end) < 1e-8, "{name}: {last:?} {end}");
    assert!((last.optical_path - optical_path).abs() < 1e-8 * optical_path, "{name}: {last:?}");
    assert!(first.optical_path.abs() < 1e-12, "{name}");
}

/// Entries on a ball or cylinder of radius 10, the direction inwards.
fn entries() -> Vec<(DVec3, DVec3)> {
    let entry = |x: f64, y: f64, z: f64, d: [f64; 3]| {
        (DVec3::new(x, y, z).normalize() * 10.0, DVec3::from(d).normalize())
    };
    vec![
        entry(-1.0, 0.3, 0.0, [1.0, 0.1, 0.0]),
        entry(-0.4, -0.9, 0.1, [0.3, 0.8, -0.2]),
        entry(-0.2, 0.1, 1.0, [0.3, 0.3, -0.5]),
    ]
}

#[test]
fn rays_in_graded_balls() {
    for (name, lens) in [
        ("Luneburg", CentralLens::luneburg(10.0)),
        ("fish-eye", CentralLens::fisheye(10.0)),
        ("Eaton", CentralLens::eaton(10.0, PI)),
        ("right angle", CentralLens::eaton(10.0, PI / 2.0)),
        ("invisible", CentralLens::eaton(10.0, 2.0 * PI)),
    ] {
        let flow = RadialFlow::Lens(lens);
        for (start, direction) in entries() {
            let end = flow.advance(start, direction, ModeKind::Shared);
            let path = flow.path(start, direction, ModeKind::Shared, 4000);
            check_ends(&path, start, end.position, end.optical_path, name);
            let off = worst_piece(&path, |at| lens.index(at.length()));
            assert!(off < 1e-3, "{name}: {off}");
            let momentum = start.cross(direction);
            for pair in path.windows(2) {
                let middle = (pair[0].position + pair[1].position) / 2.0;
                let along = (pair[1].position - pair[0].position).normalize();
                let kept = middle.cross(along * lens.index(middle.length()));
                assert!(kept.distance(momentum) < 1e-3 * 10.0, "{name}: {kept} {momentum}");
            }
        }
    }
}

#[test]
fn rays_in_anisotropic_rounds() {
    let cylinder =
        |axis| RadialFlow::Uniaxial(UniaxialCylinder::new(4.0, 10.0, axis, Extent::ENDLESS));
    let shell = |symmetry| {
        RadialFlow::Transformed(TransformedShell {
            map: RadialMap::new(4.0, 10.0, symmetry),
            extent: Extent::ENDLESS,
        })
    };
    for (name, flow) in [
        ("transmuted", RadialFlow::Transmuted(TransmutedSphere::new(10.0))),
        ("sphere", shell(Symmetry::Centre)),
        ("cylinder", shell(Symmetry::Axis)),
        ("radial", cylinder(OpticAxis::Radial)),
        ("azimuthal", cylinder(OpticAxis::Azimuthal)),
    ] {
        for (start, direction) in entries().into_iter().take(2) {
            let start = if name == "sphere" || name == "transmuted" {
                start
            } else {
                start.with_z(0.0).normalize() * 10.0
            };
            let outward = flow.outward(start);
            let medium = flow.medium(start).expect("a medium");
            // The waves that refraction makes of a ray in air.
            let tangential = direction - outward * direction.dot(outward);
            let waves = optics::interface::split(
                &Medium::AIR,
                &medium,
                &optics::interface::IncidentWave {
                    wave_vector: direction,
                    attenuation: DVec3::ZERO,
                    direction,
                    electric: [
                        direction.any_orthonormal_vector(),
                        direction.any_orthonormal_pair().1,
                    ]
                    .map(Into::into),
                    power: [1.0; 2],
                },
                -outward,
            );
            let onward = waves.iter().filter(|w| w.side == optics::interface::Side::Transmitted);
            let mut count = 0;
            for wave in onward {
                count += 1;
                assert!(
                    (wave.wave_vector - outward * wave.wave_vector.dot(outward) - tangential)
                        .length()
                        < 1e-9
                );
                let end = flow.advance(start, wave.wave_vector, wave.mode);
                let path = flow.path(start, wave.wave_vector, wave.mode, 4000);
                let name = format!("{name} {:?}", wave.mode);
                check_ends(&path, start, end.position, end.optical_path, &name);
                // It starts along its ray and ends along that of its end.
                let [first, last] = [[0, 1], [path.len() - 2, path.len() - 1]]
                    .map(|[a, b]| (path[b].position - path[a].position).normalize());
                assert!(
                    first.distance(wave.direction) < 3e-3,
                    "{name}: {first} {}",
                    wave.direction
                );
                assert!(last.distance(end.direction) < 3e-3, "{name}: {last} {}", end.direction);
            }
            assert!(count > 0, "{name}");
        }
    }
}

#[test]
fn rays_above_a_bump() {
    let map = ConformalMap::Gaussian(GaussianMap::new(10.02, 4.25).expect("a map"));
    let cut = Truncation::centred(50.0, 28.57);
    let flow = ConformalFlow::new(map, cut, Extent::ENDLESS, 1.0);
    for half in [Half::Upper, Half::Lower] {
        for [y, up, aside] in
            [[12.0, 0.0, 0.0], [3.0, -0.05, 0.3], [6.0, -0.3, 0.0], [5.0, -0.2, -0.5]]
        {
            let start = half.mirrored(DVec3::new(-25.0, y, 1.0));
            let virtual_point = flow.virtual_point(half, start).expect("inside");
            let p = half.mirrored(DVec3::new(1.0, up, aside).normalize() * virtual_point.index);
            let end = flow.advance_from(&virtual_point, p, 1e-8).expect("an end");
            let path = flow.path(&virtual_point, p, 1e-8).expect("a path");
            check_ends(&path, start, end.position, end.optical_path, "bump");
            assert!(path.len() > 20, "{}", path.len());
            let off = worst_piece(&path, |at| flow.index(half, at).expect("an index"));
            assert!(off < 1e-3, "{off}");
            // The wave vector along z is kept.
            for pair in path.windows(2) {
                let way = pair[1].position - pair[0].position;
                let middle = (pair[0].position + pair[1].position) / 2.0;
                let kept = way.normalize().z * flow.index(half, middle).expect("an index");
                assert!((kept - p.z).abs() < 2e-3, "{kept} {}", p.z);
            }
        }
    }
}
