//! Media whose rays are known in closed form, cut to convex shapes, against plain integration and
//! what is known of them from elsewhere.

mod fisheye_hemisphere;
mod graded_box;

use crate::rays::{Numbers, assembly, launch};
use cloakroom::assembly::Assembly;
use cloakroom::device::{InnerRay, Region, Structure};
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::DVec3;
use optics::medium::ModeKind;
use optics::propagation::reference::{ReferenceRay, SquaredIndex, follow};

const LIMITS: Limits = Limits { min_power: 1e-6, tolerance: 1e-9 };

/// The leaves of a ray whose power is accounted for, none of it lost; what starts inside may be
/// caught by total reflection.
fn leaves(assembly: &Assembly, launch: &Launch<2>) -> Vec<Leaf<2>> {
    let mut tracer = Tracer::new(assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(launch);
    assert_eq!(outcome.stats.lost, 0, "{launch:?}");
    outcome.assert_balanced(leaves, 1e-9, launch);
    leaves.to_vec()
}

/// A point at which a height is negative.
fn point_inside(numbers: &mut Numbers, reach: f64, height: &dyn Fn(DVec3) -> f64) -> DVec3 {
    loop {
        let mut coordinate = || numbers.between(-reach, reach);
        let point = DVec3::new(coordinate(), coordinate(), coordinate());
        if height(point) < -1e-3 {
            return point;
        }
    }
}

/// Follows rays through the one region of a device, from its inside and on from its border, and
/// each piece of their way by plain integration, too. `height` is how far outside a point is.
fn check_by_integration(
    structure: &Structure,
    square: &dyn Fn(DVec3) -> SquaredIndex,
    height: &dyn Fn(DVec3) -> f64,
) {
    let [region] = &structure.regions[..] else { panic!("one region") };
    let mut numbers = Numbers(11);
    for _ in 0..40 {
        let mut position = point_inside(&mut numbers, 12.0, height);
        let mut direction = numbers.direction();
        for _ in 0..3 {
            let (next, onward) = check_piece(region, square, height, position, direction);
            (position, direction) = (next, onward);
        }
    }
}

/// Checks one piece; where it ends, and the way from there after a reflection.
fn check_piece(
    region: &Region,
    square: &dyn Fn(DVec3) -> SquaredIndex,
    height: &dyn Fn(DVec3) -> f64,
    position: DVec3,
    direction: DVec3,
) -> (DVec3, DVec3) {
    let wave_vector = direction * square(position).value.sqrt();
    let mode = ModeKind::Shared;
    let ray = InnerRay { position, wave_vector, direction, mode, virtual_point: None };
    let end = region.advance(&ray, 1e-9, None).expect("an end");
    let field = direction.any_orthonormal_vector();
    let start = ReferenceRay { position, wave_vector, electric_field: field, optical_path: 0.0 };
    // A first step from the border must not end behind it by rounding.
    let inside = |at: DVec3| if at.distance(position) < 1e-9 { 1.0 } else { -height(at) };
    let expected = follow(start, 0.02, 100_000, square, inside).expect("an end");
    assert!(end.position.distance(expected.position) < 1e-8, "{ray:?} {end:?} {expected:?}");
    assert!(height(end.position).abs() < 1e-12, "{end:?}");
    assert!(end.wave_vector.distance(expected.wave_vector) < 1e-8, "{ray:?}");
    assert!(end.direction.distance(end.wave_vector.normalize()) < 1e-14);
    let index = |at: DVec3| square(at).value.sqrt();
    assert!((end.wave_vector.length() - index(end.position)).abs() < 1e-12);
    assert!((end.optical_path - expected.optical_path).abs() < 1e-8, "{ray:?}");
    let kept = (index(position) / index(end.position)).sqrt();
    let transported = end.transport.expect("a bent way") * field;
    assert!(transported.distance(expected.electric_field * kept) < 1e-7, "{ray:?}");
    // The way that is drawn leads there.
    let path = region.path(&ray, &end, 1e-9);
    let last = path.last().expect("points");
    let first = path[0].position;
    assert!(last.position.distance(end.position) < 1e-11 && first.distance(position) < 1e-11);
    assert!(path.iter().all(|at| height(at.position) < 1e-11));
    let outward = end.outward;
    (end.position, (end.direction - outward * (2.0 * outward.dot(end.direction))).normalize())
}

/// Rays that start within a device come out where the way through its region ends, and are
/// accounted for.
fn check_starts_inside(scene: &str, height: &dyn Fn(DVec3) -> f64) {
    let assembly = assembly(scene);
    let placed = &assembly.devices()[0];
    let mut numbers = Numbers(12);
    for _ in 0..30 {
        let local = point_inside(&mut numbers, 12.0, height);
        let direction = numbers.direction();
        let ray = launch(placed.pose.to_world(local), direction);
        let (region, medium) = placed.structure.region_at(local).expect("a medium");
        let index = medium.tensors().0.re.x_axis.x.sqrt();
        let onward = placed.pose.vector_to_local(ray.direction);
        let inner = InnerRay {
            position: local,
            wave_vector: onward * index,
            direction: onward,
            mode: ModeKind::Shared,
            virtual_point: None,
        };
        let end =
            placed.structure.regions[usize::from(region)].advance(&inner, 1e-9, None).unwrap();
        let end_there = placed.pose.to_world(end.position);
        let found = leaves(&assembly, &ray);
        let straight = found.iter().find(|leaf| leaf.position.distance(end_there) < 1e-9);
        // Or it is totally reflected.
        let sine = end.wave_vector.cross(end.outward).length();
        assert_eq!(straight.is_some(), sine < 1.0, "{ray:?} {found:?}");
        if let Some(leaf) = straight {
            assert!((leaf.optical_path - end.optical_path).abs() < 1e-9);
        }
    }
}
