//! Design (iv) against a slow integration of the paper's own equation of motion in physical space,
//! with Snell's law at the cut and the law of reflection at the metal.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::equation_of_motion::{Expected, GradedHalf, gaussian, refract};
use crate::long::count;
use crate::rays::{self, launch, spread, strongest};
use cloakroom::assembly::Assembly;
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// Half the cut along x and y.
const CUT: [f64; 2] = [25.0, 28.57];
/// Speed of light, cm/ns.
const C: f64 = 29.979_245_8;

/// Follows the strongest branch of a ray in the device's frame; None for rays that miss the device
/// or come too near to grazing incidence, to a critical angle, or to an edge.
fn reference(upper: &GradedHalf, origin: DVec3, direction: DVec3) -> Option<Expected> {
    // Into the rectangle: the last of the planes it must cross.
    let mut entry: Option<(f64, DVec3)> = None;
    let mut leave = f64::INFINITY;
    for (axis, half) in [(DVec3::X, CUT[0]), (DVec3::Y, CUT[1])] {
        let (o, d) = (origin.dot(axis), direction.dot(axis));
        let [a, b] = [(-half - o) / d, (half - o) / d];
        if entry.is_none_or(|(t, _)| a.min(b) > t) {
            entry = Some((a.min(b), axis * d.signum()));
        }
        leave = leave.min(a.max(b));
    }
    let (distance, inward) = entry?;
    if distance < 0.0 || distance > leave - 0.05 {
        return None;
    }
    let mut at = origin + direction * distance;
    let side = at.y.signum();
    let flip = |v: DVec3| DVec3::new(v.x, side * v.y, v.z);
    at = flip(at);
    let inward = flip(inward);
    // Clear of the corners and of the metal's blunt ends.
    if at.y < 0.1 || (CUT[0] - at.x.abs()) + (CUT[1] - at.y) < 0.1 {
        return None;
    }
    let p = refract(flip(direction), inward, upper.squared_index(at).value)?;
    let end = upper.out(at, p, distance)?;
    Some(Expected { position: flip(end.position), direction: flip(end.direction), ..end })
}

fn assembly(extra: &str) -> Assembly {
    rays::assembly(&format!("[[device]]\nkind = \"double-gaussian-cloak\"\n{extra}\n"))
}

#[test]
fn rays_agree_with_the_equation_of_motion() {
    let upper = GradedHalf::new(gaussian(10.02, 4.25), 1.0, CUT, 0.02);
    let mut compared = 0;
    let mut mirrored = 0;
    let mut beyond_default = 0;
    for (rotation, position) in
        [(0.0, DVec3::ZERO), (17.0, DVec3::new(3.0, -1.0, 2.0)), (75.0, DVec3::ZERO)]
    {
        let [x, y, z] = position.to_array();
        let assembly =
            assembly(&format!("rotation = {rotation:?}\nposition = [{x:?}, {y:?}, {z:?}]"));
        let trace = |launch: &Launch<2>, tolerance: f64| {
            let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance });
            strongest(tracer.trace(launch).0)
        };
        let turn = DMat3::from_rotation_z(f64::to_radians(rotation));
        for n in 1..=count(45, 180) {
            let angle = 2.0 * PI * spread(n, 0);
            let origin = position
                + DVec3::new(70.0 * angle.cos(), 70.0 * angle.sin(), 60.0 * (spread(n, 1) - 0.5));
            let aim = |k: i32, size: f64| size * (spread(n, k) - 0.5);
            let mut target = position + DVec3::new(aim(2, 44.0), aim(3, 44.0), aim(4, 50.0));
            if n % 7 == 0 {
                target.z = origin.z;
            }
            let launch = launch(origin, (target - origin).normalize());
            let local = |v: DVec3| turn.transpose() * v;
            let expected = reference(&upper, local(origin - position), local(launch.direction));
            let Some(expected) = expected else { continue };
            let off = |leaf: &Leaf<2>| {
                [
                    (leaf.position - position - turn * expected.position).length(),
                    (leaf.optical_path - expected.optical_path).abs(),
                    10.0 * (leaf.direction - turn * expected.direction).length(),
                ]
                .into_iter()
                .fold(0.0, f64::max)
            };
            let fine = off(&trace(&launch, 1e-8));
            assert!(fine < 1e-8, "rotation {rotation}, ray {n}: {fine:.1e} cm");
            beyond_default += u32::from(off(&trace(&launch, 1e-6)) >= 1e-6);
            compared += 1;
            mirrored += u32::from(expected.mirrored);
        }
    }
    assert!(
        compared > count(60, 250) && mirrored > count(15, 60),
        "{compared} compared, {mirrored} mirrored"
    );
    assert!(beyond_default * 1000 <= compared, "{beyond_default} of {compared}");
}

#[test]
fn light_on_the_axis_is_late_by_68_picoseconds() {
    let assembly = assembly("");
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance: 1e-8 });
    // The last hair above the axis, where the metal's blunt ends are passed.
    let leaf = strongest(tracer.trace(&launch(DVec3::new(-100.0, 0.05, 0.0), DVec3::X)).0);
    let late = (leaf.optical_path - (leaf.position.x + 100.0)) / C;
    assert!((late - 0.0680).abs() < 5e-5, "{late}");
}

#[test]
fn light_in_the_default_view_is_late_by_less_than_a_tenth_of_a_nanosecond() {
    let assembly = assembly("");
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance: 1e-6 });
    let mut seen = 0;
    let mut largest: f64 = 0.0;
    for row in 0..60 {
        for column in 0..80 {
            let target = DVec3::new(
                50.0,
                (f64::from(row) - 29.5) / 60.0 * 81.9,
                (f64::from(column) - 39.5) / 80.0 * 109.2,
            );
            let origin = DVec3::new(-100.0, 0.0, 0.0);
            let launch = launch(origin, (target - origin).normalize());
            let leaf = strongest(tracer.trace(&launch).0);
            let remaining = (50.0 - leaf.position.x) / leaf.direction.x;
            if remaining > 0.0 {
                let path = leaf.optical_path + remaining;
                largest = largest.max((path - target.distance(origin)) / C);
                seen += 1;
            }
        }
    }
    assert!(seen > 4700, "{seen}");
    assert!(largest > 0.068 && largest < 0.1, "{largest}");
}

/// Power reflected by the first face for a ray from the camera of the paper.
fn first_reflection(assembly: &Assembly, direction: DVec3) -> [f64; 2] {
    let mut tracer = Tracer::new(assembly, Limits { min_power: 1e-9, tolerance: 1e-6 });
    let launch = launch(DVec3::new(-100.0, 0.0, 0.0), direction.normalize());
    let (leaves, _) = tracer.trace(&launch);
    // It leaves where it has come in, having met nothing else.
    leaves
        .iter()
        .filter(|leaf| (leaf.optical_path - leaf.position.distance(launch.origin)).abs() < 1e-9)
        .map(|leaf| leaf.power)
        .next()
        .unwrap_or([0.0; 2])
}

#[test]
fn the_front_face_reflects_little() {
    // Fresnel's formulas with the index at the cut: up to 0.06 % near the middle, 0.12 % a
    // polarization up to a rotation of 20 degrees.
    for rotation in [0, 5, 10, 20] {
        let assembly = assembly(&format!("rotation = {rotation}"));
        let (mut largest, mut middle): (f64, f64) = (0.0, 0.0);
        for n in 1..=count(600, 3000) {
            let direction =
                DVec3::new(1.0, 0.54 * (spread(n, 0) - 0.5), 0.72 * (spread(n, 1) - 0.5));
            // The front face alone, not the sides that the turned box shows, nor the metal's blunt
            // ends.
            let [h, v] = first_reflection(&assembly, direction);
            let turn = DMat3::from_rotation_z(-f64::from(rotation).to_radians());
            let (eye, d) = (turn * DVec3::new(-100.0, 0.0, 0.0), turn * direction);
            let y = eye.y + d.y / d.x * (-25.0 - eye.x);
            if y.abs() > 0.1 && y.abs() < 28.5 {
                largest = largest.max(h).max(v);
                if y.abs() < 3.0 && direction.z.abs() < 0.1 {
                    middle = middle.max(h).max(v);
                }
            }
        }
        assert!(largest < 1.2e-3 && largest > 5e-4, "rotation {rotation}: {largest}");
        if rotation == 0 {
            assert!(middle < 6.5e-4 && middle > 5e-4, "in the middle: {middle}");
        }
    }
}

#[test]
fn a_coating_against_reflection_loses_nothing() {
    let assembly = assembly("fresnel = false");
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-9, tolerance: 1e-6 });
    for n in 1..=500 {
        let direction = DVec3::new(1.0, 0.5 * (spread(n, 0) - 0.5), 0.7 * (spread(n, 1) - 0.5));
        let launch = launch(DVec3::new(-100.0, 0.0, 0.0), direction.normalize());
        let (leaves, outcome) = tracer.trace(&launch);
        assert_eq!(leaves.len(), 1);
        assert!((leaves[0].power[0] - 1.0).abs() < 1e-12 && outcome.pruned == [0.0; 2]);
    }
}

#[test]
fn rays_in_the_plane_of_the_strip_get_the_limit() {
    let assembly = assembly("");
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-6, tolerance: 1e-6 });
    // Head-on at the blunt end: straight back.
    let leaf = strongest(tracer.trace(&launch(DVec3::new(-100.0, 0.0, 0.0), DVec3::X)).0);
    assert_eq!((leaf.direction, leaf.position.x), (-DVec3::X, -25.0));
}
