//! The carpet cloaks against a slow integration of the equation of motion in physical space, with Snell's law
//! at the border and the law of reflection at the metal; and against the flat mirror that they imitate.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::scene_file;
use cloakroom::trace::{Bench, Launch, Leaf, Limits, Tracer};
use errorfunctions::ComplexErrorFunctions;
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::propagation::reference::{ReferenceRay, SquaredIndex, follow};
use optics::transformation::{QuasiConformalMap, Truncation};
use optics::wave::transverse_basis;
use std::cell::Cell;
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// A carpet as the reference knows it: f, f' and f'', where Newton's method starts for a physical point, c,
/// and half the width.
struct Carpet {
    kind: &'static str,
    jet: Box<dyn Fn(Complex64) -> [Complex64; 3]>,
    strength: f64,
    half_width: f64,
    nearby: Cell<Complex64>,
}

const HEIGHT: f64 = 28.57;

fn carpets() -> [Carpet; 3] {
    let i = Complex64::I;
    let gaussian = move |zeta: Complex64| {
        let (w, h) = (10.02, 4.25);
        let t = zeta / w;
        let w0 = t.w();
        let w1 = -2.0 * t * w0 + 2.0 * i / PI.sqrt();
        let w2 = -2.0 * w0 - 2.0 * t * w1;
        [zeta + i * h * w0, 1.0 + i * h / w * w1, i * h / (w * w) * w2]
    };
    let grating = move |zeta: Complex64| {
        let (h, k) = (1.5, TAU / 20.0);
        let wave = (i * k * zeta).exp();
        [zeta + i * h * wave, 1.0 - h * k * wave, -i * h * k * k * wave]
    };
    // The map itself is held against its definition in the tests of the optics crate.
    let cut = Truncation::centred(50.0, HEIGHT);
    let map = QuasiConformalMap::new(28.0, 4.25, &cut).unwrap();
    let strength = map.strength();
    let quasi_conformal = move |zeta| {
        let jet = map.jet(zeta);
        [jet.f, jet.f1, jet.f2]
    };
    let nearby = Cell::new(i * HEIGHT);
    let carpet = |kind, jet, strength, half_width| Carpet {
        kind,
        jet,
        strength,
        half_width,
        nearby: nearby.clone(),
    };
    [
        carpet("gaussian-carpet", Box::new(gaussian), 1.0, 25.0),
        carpet("grating-carpet", Box::new(grating), 1.0, 30.0),
        carpet("quasi-conformal-carpet", Box::new(quasi_conformal), strength, 25.0),
    ]
}

impl Carpet {
    /// The virtual point of a physical one by Newton's method, from the last one found.
    fn invert(&self, r: DVec3) -> Complex64 {
        let z = Complex64::new(r.x, r.y);
        let near = self.nearby.get();
        let far = ((self.jet)(near)[0] - z).norm() > 3.0;
        let mut zeta = if far { Complex64::new(z.re, z.im.max(0.5)) } else { near };
        for _ in 0..200 {
            let [f, f1, _] = (self.jet)(zeta);
            let step = (f - z) / f1;
            zeta -= step / (1.0 + 0.5 * step.norm());
            zeta.im = zeta.im.max(-0.3);
            if step.norm() < 1e-13 {
                break;
            }
        }
        self.nearby.set(zeta);
        zeta
    }

    fn squared_index(&self, r: DVec3) -> SquaredIndex {
        let [_, f1, f2] = (self.jet)(self.invert(r));
        let value = self.strength.powi(2) / f1.norm_sqr();
        let slope = -2.0 * value * (f2 / (f1 * f1)).conj();
        SquaredIndex { value, gradient: DVec3::new(slope.re, slope.im, 0.0) }
    }

    fn inside(&self, r: DVec3) -> f64 {
        (self.half_width - r.x.abs()).min(HEIGHT - r.y).min(self.invert(r).im)
    }

    /// What becomes of the strongest branch of a ray in the device's frame; None for rays that miss the top
    /// and the sides or come too near to grazing incidence, to a critical angle, or to an edge.
    fn reference(&self, origin: DVec3, direction: DVec3) -> Option<Expected> {
        let a = self.half_width;
        let through_top = (HEIGHT - origin.y) / direction.y;
        let through_side = (-a * direction.x.signum() - origin.x) / direction.x;
        let at_top = origin + direction * through_top;
        let (distance, inward) = if origin.y > HEIGHT && at_top.x.abs() < a - 0.1 {
            (through_top, DVec3::NEG_Y)
        } else {
            (through_side, DVec3::X * direction.x.signum())
        };
        let mut at = origin + direction * distance;
        if distance < 0.0 || at.y < 0.1 || at.y > HEIGHT + 1e-9 {
            return None;
        }
        if inward.x != 0.0 && at.y > HEIGHT - 0.1 {
            return None;
        }
        let mut p = refract(direction, inward, self.squared_index(at).value)?;
        let mut optical_path = distance;
        let mut mirrored = false;
        for _ in 0..12 {
            let start = ReferenceRay {
                position: at,
                wave_vector: p,
                electric_field: p.any_orthonormal_vector(),
                optical_path: 0.0,
            };
            let run = |step: f64| {
                follow(start, step, 200_000, |r| self.squared_index(r), |r| self.inside(r))
            };
            // The grating is the finest of the three.
            let [coarse, fine] = [run(0.012)?, run(0.006)?];
            // Richardson: the method is of order 4.
            let better = |coarse: DVec3, fine: DVec3| fine + (fine - coarse) / 15.0;
            at = better(coarse.position, fine.position);
            p = better(coarse.wave_vector, fine.wave_vector);
            optical_path += fine.optical_path + (fine.optical_path - coarse.optical_path) / 15.0;
            let [gap_x, gap_y] = [a - at.x.abs(), HEIGHT - at.y];
            if gap_x.abs().min(gap_y.abs()) > 1e-6 {
                let [_, f1, _] = (self.jet)(self.invert(at));
                let up = DVec3::new(-f1.im, f1.re, 0.0).normalize();
                if gap_x < 0.5 || p.normalize().dot(up).abs() < 5e-3 {
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
                return Some(Expected { position: at, direction, optical_path, mirrored });
            }
            p = across - out * p.dot(out);
        }
        None
    }
}

struct Expected {
    position: DVec3,
    direction: DVec3,
    optical_path: f64,
    mirrored: bool,
}

/// Snell's law into a medium of squared index `square`; None near grazing.
fn refract(p: DVec3, inward: DVec3, square: f64) -> Option<DVec3> {
    let across = p - inward * p.dot(inward);
    let normal = square - across.length_squared();
    (normal > 0.02 && p.dot(inward) > 0.02).then(|| across + inward * normal.sqrt())
}

fn bench(kind: &str, extra: &str) -> Bench {
    let text = format!("[[device]]\nkind = \"{kind}\"\n{extra}\n");
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
    for carpet in carpets() {
        let (rotation, position) = (17.0_f64, DVec3::new(3.0, -1.0, 2.0));
        let placed = "rotation = 17.0\nposition = [3.0, -1.0, 2.0]\nfloor = 0";
        let bench = bench(carpet.kind, placed);
        let turn = DMat3::from_rotation_z(rotation.to_radians());
        let (mut compared, mut mirrored, mut beyond_default) = (0, 0, 0);
        for n in 1..=220 {
            let angle = PI * (0.02 + 0.96 * spread(n, 0));
            let origin =
                DVec3::new(70.0 * angle.cos(), 70.0 * angle.sin(), 60.0 * (spread(n, 1) - 0.5));
            let size = 2.0 * carpet.half_width * 0.9;
            let mut target = DVec3::new(
                size * (spread(n, 2) - 0.5),
                24.0 * spread(n, 3),
                50.0 * (spread(n, 4) - 0.5),
            );
            if n % 7 == 0 {
                target.z = origin.z;
            }
            let direction = (target - origin).normalize();
            let Some(expected) = carpet.reference(origin, direction) else { continue };
            let launch = launch(position + turn * origin, turn * direction);
            let off = |tolerance: f64| {
                let mut tracer = Tracer::new(&bench, Limits { min_power: 1e-3, tolerance });
                let leaf = strongest(tracer.trace(&launch).0);
                [
                    (leaf.position - position - turn * expected.position).length(),
                    (leaf.optical_path - expected.optical_path).abs(),
                    10.0 * (leaf.direction - turn * expected.direction).length(),
                ]
                .into_iter()
                .fold(0.0, f64::max)
            };
            let fine = off(1e-8);
            assert!(fine < 1e-8, "{}, ray {n}: {fine:.1e} cm", carpet.kind);
            beyond_default += u32::from(off(1e-6) >= 1e-6);
            compared += 1;
            mirrored += u32::from(expected.mirrored);
        }
        assert!(compared > 100 && mirrored > 70, "{compared} compared, {mirrored} mirrored");
        assert!(beyond_default * 200 <= compared, "{beyond_default} of {compared}");
    }
}

/// How far a ray in the plane z = 0 comes off a flat mirror on y = 0: beside it (cm), and by which angle.
fn off_flat_mirror(bench: &Bench, origin: DVec3, direction: DVec3) -> [f64; 2] {
    let mut tracer = Tracer::new(bench, Limits { min_power: 1e-2, tolerance: 1e-6 });
    let leaf = strongest(tracer.trace(&launch(origin, direction)).0);
    let mirror = DVec3::new(1.0, -1.0, 1.0);
    let to_image = origin * mirror - leaf.position;
    let beside = to_image - leaf.direction * to_image.dot(leaf.direction);
    [beside.length(), leaf.direction.angle_between(direction * mirror)]
}

#[test]
fn conformal_carpets_look_like_the_flat_floor() {
    // So large that the map is the identity where it is cut, but for 24/r cm of the Gaussian one.
    let large = "width = 2000\nheight = 1000\nfloor = 4000";
    for (kind, keys) in [("gaussian-carpet", large), ("grating-carpet", "width = 200\nheight = 60")]
    {
        let bench = bench(kind, keys);
        for n in 1..=200 {
            let angle = PI * (0.3 + 0.4 * spread(n, 0));
            let target = DVec3::X * 20.0 * (spread(n, 1) - 0.5);
            let direction = -DVec3::new(angle.cos(), angle.sin(), 0.0);
            let top = if kind == "gaussian-carpet" { 1000.0 } else { 60.0 };
            let origin = target - direction * 1.05 * top / angle.sin();
            let [beside, turned] = off_flat_mirror(&bench, origin, direction);
            // On the way in and out, the map's shift and the refraction at the cut, 0.024 cm each.
            assert!(beside < 0.096 && turned < 1e-6, "{kind} {n}: {beside} cm, {turned}");
        }
    }
}

#[test]
fn every_carpet_hides_its_bump() {
    for carpet in carpets() {
        let mean = |show: &str| {
            let bench = bench(carpet.kind, &format!("show = \"{show}\""));
            let count = 300;
            let off = |n| {
                let angle = PI * (0.3 + 0.4 * spread(n, 0));
                let target = DVec3::X * 14.0 * (spread(n, 1) - 0.5);
                let direction = -DVec3::new(angle.cos(), angle.sin(), 0.0);
                off_flat_mirror(&bench, target - 70.0 * direction, direction)[1]
            };
            (1..=count).map(off).sum::<f64>() / f64::from(count)
        };
        let [cloak, bare, mirror] = ["cloak", "bare", "mirror"].map(mean);
        assert!(mirror < 1e-7 && bare > 0.3, "{} {mirror} {bare}", carpet.kind);
        assert!(cloak < 0.1 * bare, "{} {cloak} {bare}", carpet.kind);
    }
}

#[test]
fn the_back_is_a_flat_mirror() {
    for (kind, depth) in
        [("gaussian-carpet", 0.0), ("grating-carpet", 1.5), ("quasi-conformal-carpet", 0.0)]
    {
        for show in ["cloak", "bare", "mirror"] {
            let bench = bench(kind, &format!("show = \"{show}\""));
            for x in [0.0, 9.5, -24.9, 100.0] {
                let level = if show == "mirror" || x == 100.0 { 0.0 } else { -depth };
                let mut tracer = Tracer::new(&bench, Limits { min_power: 1e-3, tolerance: 1e-6 });
                let (leaves, _) = tracer.trace(&launch(DVec3::new(x, -50.0, 0.0), DVec3::Y));
                assert!(leaves.len() == 1 && leaves[0].direction == -DVec3::Y, "{kind} {show} {x}");
                assert!((leaves[0].optical_path - level - 50.0).abs() < 1e-12, "{kind} {show} {x}");
            }
        }
    }
}

#[test]
fn keys_that_do_not_go_together_are_told_apart() {
    for (kind, keys, key, part) in [
        ("gaussian-carpet", "h = 9.0", "h", "h/w < "),
        ("gaussian-carpet", "height = 4.0", "height", "to hold the metal"),
        ("gaussian-carpet", "floor = 49.0", "floor", "at least as wide as the device"),
        ("grating-carpet", "h = 3.2", "h", "< 1"),
        ("grating-carpet", "period = 61.0", "period", "1 to 1000 of them"),
        ("quasi-conformal-carpet", "w = 51.0", "w", "fit into the device"),
        ("quasi-conformal-carpet", "w = 1.0", "w", "at least"),
        ("quasi-conformal-carpet", "h = 20.0\nw = 4.0", "h", "too steep"),
    ] {
        let text = format!("[[device]]\nkind = \"{kind}\"\n{keys}\n");
        let loaded = scene_file::parse(&text, "test", Path::new(""), &[]);
        let message = match loaded {
            Err(error) => error.to_string(),
            Ok(loaded) => cloakroom::render::bench(&loaded.scene).unwrap_err().to_string(),
        };
        assert!(message.contains(part) && message.contains(key), "{kind} {keys}: {message}");
    }
}

#[test]
fn floors_may_not_lie_on_each_other() {
    let two = |floor: &str| {
        let text = format!(
            "[[device]]\nkind = \"gaussian-carpet\"\n[[device]]\nkind = \"grating-carpet\"\n\
             position = [60, {floor}, 0]\nfloor = 0\n"
        );
        let loaded = scene_file::parse(&text, "test", Path::new(""), &[]).unwrap();
        cloakroom::render::bench(&loaded.scene)
    };
    // The troughs would stick out of the floor; above it there is room.
    assert!(two("0").is_err() && two("1.5").is_ok());
    let text = "[[device]]\nkind = \"gaussian-carpet\"\n[[device]]\nkind = \"gaussian-carpet\"\n\
                position = [80, 0, 0]\n";
    let loaded = scene_file::parse(text, "test", Path::new(""), &[]).unwrap();
    assert!(cloakroom::render::bench(&loaded.scene).is_err());
}
