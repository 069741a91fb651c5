//! Design (iv) against a slow integration of the paper's own equation of motion in physical space, with
//! Snell's law at the cut and the law of reflection at the metal: nothing of it knows virtual space, the
//! program's Faddeeva function, its interfaces or its surfaces.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::scene_file;
use cloakroom::trace::{Bench, Launch, Leaf, Limits, Tracer};
use errorfunctions::ComplexErrorFunctions;
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::propagation::reference::{ReferenceRay, SquaredIndex, follow};
use optics::wave::transverse_basis;
use std::f64::consts::PI;
use std::path::Path;

const W: f64 = 10.02;
const H: f64 = 4.25;
/// Half the cut along x and y.
const CUT: [f64; 2] = [25.0, 28.57];
/// Speed of light, cm/ns.
const C: f64 = 29.979_245_8;

/// f, f' and f'' of the map, from an independent Faddeeva function.
fn jet(zeta: Complex64) -> [Complex64; 3] {
    let i = Complex64::I;
    let t = zeta / W;
    let w = t.w();
    let w1 = -2.0 * t * w + 2.0 * i / PI.sqrt();
    let w2 = -2.0 * w - 2.0 * t * w1;
    [zeta + i * H * w, 1.0 + i * H / W * w1, i * H / (W * W) * w2]
}

/// The virtual point of a physical one by Newton's method.
fn invert(z: Complex64) -> Complex64 {
    let mut zeta = z + Complex64::from(H * W / PI.sqrt()) / z;
    zeta.im = zeta.im.max(0.0);
    for _ in 0..50 {
        let [f, f1, _] = jet(zeta);
        let step = (f - z) / f1;
        zeta -= step * (W / (W + 4.0 * step.norm()));
        if step.norm() < 1e-14 {
            break;
        }
    }
    zeta
}

/// n² = 1/|f'|² and its gradient in the upper half.
fn squared_index(r: DVec3) -> SquaredIndex {
    let [_, f1, f2] = jet(invert(Complex64::new(r.x, r.y)));
    let value = 1.0 / f1.norm_sqr();
    // ∇ ln n in virtual space is -conj(f''/f'); one more conj(f') takes it to physical space.
    let slope = -2.0 * value * (f2 / (f1 * f1)).conj();
    SquaredIndex { value, gradient: DVec3::new(slope.re, slope.im, 0.0) }
}

/// How far a point of the upper half is inside.
fn inside(r: DVec3) -> f64 {
    let virtual_y = invert(Complex64::new(r.x, r.y)).im;
    (CUT[0] - r.x.abs()).min(CUT[1] - r.y).min(virtual_y)
}

/// What the reference says of a ray: the leaving point, its direction, the optical path from the origin.
struct Expected {
    position: DVec3,
    direction: DVec3,
    optical_path: f64,
    mirrored: bool,
}

/// Follows the strongest branch of a ray in the device's frame; None for rays that miss the device or
/// come too near to grazing incidence, to a critical angle, or to an edge.
fn reference(origin: DVec3, direction: DVec3, step: f64) -> Option<Expected> {
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
    let mut p = flip(direction);
    p = refract(p, inward, squared_index(at).value)?;
    let mut optical_path = distance;
    let mut mirrored = false;
    for _ in 0..12 {
        let start = ReferenceRay {
            position: at,
            wave_vector: p,
            electric_field: p.any_orthonormal_vector(),
            optical_path: 0.0,
        };
        let run = |step: f64| follow(start, step, 200_000, squared_index, inside);
        let [coarse, fine] = [run(step)?, run(step / 2.0)?];
        // Richardson: the method is of order 4.
        let better = |coarse: DVec3, fine: DVec3| fine + (fine - coarse) / 15.0;
        at = better(coarse.position, fine.position);
        p = better(coarse.wave_vector, fine.wave_vector);
        optical_path += fine.optical_path + (fine.optical_path - coarse.optical_path) / 15.0;
        let [gap_x, gap_y] = [CUT[0] - at.x.abs(), CUT[1] - at.y];
        if gap_x.abs().min(gap_y.abs()) > 1e-6 {
            let [_, f1, _] = jet(invert(Complex64::new(at.x, at.y)));
            let up = DVec3::new(-f1.im, f1.re, 0.0).normalize();
            if at.x.abs() > CUT[0] - 0.5 || p.normalize().dot(up).abs() < 5e-3 {
                return None;
            }
            p -= 2.0 * p.dot(up) * up;
            mirrored = true;
            continue;
        }
        if gap_x + gap_y < 0.05 || at.y < 0.1 {
            return None;
        }
        let out = if gap_x < gap_y { DVec3::X * at.x.signum() } else { DVec3::Y };
        if p.normalize().dot(out) < 0.02 {
            return None;
        }
        let across = p - out * p.dot(out);
        let slack = 1.0 - across.length_squared();
        if slack.abs() < 0.02 {
            return None;
        }
        if slack > 0.0 {
            let direction = across + out * slack.sqrt();
            return Some(Expected {
                position: flip(at),
                direction: flip(direction),
                optical_path,
                mirrored,
            });
        }
        p = across - out * p.dot(out);
    }
    None
}

/// Snell's law into a medium of squared index `square`; None near grazing.
fn refract(p: DVec3, inward: DVec3, square: f64) -> Option<DVec3> {
    let across = p - inward * p.dot(inward);
    let normal = square - across.length_squared();
    (normal > 0.02 && p.dot(inward) > 0.02).then(|| across + inward * normal.sqrt())
}

fn bench(extra: &str) -> Bench {
    let text = format!("[[device]]\nkind = \"double-gaussian-cloak\"\n{extra}\n");
    let loaded = scene_file::parse(&text, "test", Path::new(""), &[]).unwrap();
    cloakroom::render::bench(&loaded.scene).unwrap()
}

fn launch(origin: DVec3, direction: DVec3) -> Launch<2> {
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [h.into(), v.into()] }
}

fn strongest(leaves: &[Leaf<2>]) -> Leaf<2> {
    let power = |leaf: &Leaf<2>| leaf.power[0] + leaf.power[1];
    *leaves.iter().max_by(|a, b| power(a).total_cmp(&power(b))).unwrap()
}

/// A pseudo-random number in [0, 1) for every n and k, evenly spread.
fn spread(n: u32, k: i32) -> f64 {
    (f64::from(n) * 1.134_724_138_401_519_4_f64.powi(-k - 1)).fract()
}

#[test]
fn rays_agree_with_the_equation_of_motion() {
    let mut compared = 0;
    let mut mirrored = 0;
    let mut beyond_default = 0;
    for (rotation, position) in
        [(0.0, DVec3::ZERO), (17.0, DVec3::new(3.0, -1.0, 2.0)), (75.0, DVec3::ZERO)]
    {
        let [x, y, z] = position.to_array();
        let bench = bench(&format!("rotation = {rotation:?}\nposition = [{x:?}, {y:?}, {z:?}]"));
        let trace = |launch: &Launch<2>, tolerance: f64| {
            let mut tracer = Tracer::new(&bench, Limits { min_power: 1e-3, tolerance });
            strongest(tracer.trace(launch).0)
        };
        let turn = DMat3::from_rotation_z(f64::to_radians(rotation));
        for n in 1..=180 {
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
            let expected = reference(local(origin - position), local(launch.direction), 0.02);
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
    assert!(compared > 250 && mirrored > 60, "{compared} compared, {mirrored} mirrored");
    assert!(beyond_default * 1000 <= compared, "{beyond_default} of {compared}");
}

#[test]
fn light_on_the_axis_is_late_by_68_picoseconds() {
    let bench = bench("");
    let mut tracer = Tracer::new(&bench, Limits { min_power: 1e-3, tolerance: 1e-8 });
    // The last hair above the axis, where the metal's blunt ends are passed.
    let leaf = strongest(tracer.trace(&launch(DVec3::new(-100.0, 0.05, 0.0), DVec3::X)).0);
    let late = (leaf.optical_path - (leaf.position.x + 100.0)) / C;
    assert!((late - 0.0680).abs() < 5e-5, "{late}");
}

#[test]
fn light_in_the_default_view_is_late_by_less_than_a_tenth_of_a_nanosecond() {
    let bench = bench("");
    let mut tracer = Tracer::new(&bench, Limits { min_power: 1e-3, tolerance: 1e-6 });
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
fn first_reflection(bench: &Bench, direction: DVec3) -> [f64; 2] {
    let mut tracer = Tracer::new(bench, Limits { min_power: 1e-9, tolerance: 1e-6 });
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
    // Fresnel's formulas with the index at the cut: up to 0.06 % near the middle, 0.12 % a polarization
    // up to a rotation of 20 degrees.
    for rotation in [0, 5, 10, 20] {
        let bench = bench(&format!("rotation = {rotation}"));
        let (mut largest, mut middle): (f64, f64) = (0.0, 0.0);
        for n in 1..=3000 {
            let direction =
                DVec3::new(1.0, 0.54 * (spread(n, 0) - 0.5), 0.72 * (spread(n, 1) - 0.5));
            // The front face alone, not the sides that the turned box shows, nor the metal's blunt ends.
            let [h, v] = first_reflection(&bench, direction);
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
    let bench = bench("fresnel = false");
    let mut tracer = Tracer::new(&bench, Limits { min_power: 1e-9, tolerance: 1e-6 });
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
    let bench = bench("");
    let mut tracer = Tracer::new(&bench, Limits { min_power: 1e-6, tolerance: 1e-6 });
    // Head-on at the blunt end: straight back.
    let leaf = strongest(tracer.trace(&launch(DVec3::new(-100.0, 0.0, 0.0), DVec3::X)).0);
    assert_eq!((leaf.direction, leaf.position.x), (-DVec3::X, -25.0));
}
