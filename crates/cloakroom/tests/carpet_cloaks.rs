//! The carpet cloaks against a slow integration of the equation of motion in physical space, with
//! Snell's law at the border and the law of reflection at the metal; and against the flat mirror
//! that they imitate.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::equation_of_motion::{Expected, GradedHalf, gaussian, refract};
use crate::long::count;
use crate::rays::{self, launch, refusal, spread, strongest, try_bench};
use cloakroom::assembly::Assembly;
use cloakroom::trace::{Limits, Tracer};
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::transformation::{QuasiConformalMap, Truncation};
use std::f64::consts::{PI, TAU};

const HEIGHT: f64 = 28.57;

fn carpets() -> [(&'static str, GradedHalf); 3] {
    let i = Complex64::I;
    let grating = move |zeta: Complex64| {
        let (h, k) = (1.5, TAU / 20.0);
        let wave = (i * k * zeta).exp();
        [zeta + i * h * wave, 1.0 - h * k * wave, -i * h * k * k * wave]
    };
    // The map itself is held against its definition in the tests of the optics crate.
    let cut = Truncation::centred(50.0, HEIGHT);
    let map = QuasiConformalMap::new(28.0, 4.25, &cut).unwrap();
    let index_scale = map.index_scale();
    let quasi_conformal = move |zeta| {
        let jet = map.jet(zeta);
        [jet.f, jet.f1, jet.f2]
    };
    // The grating is the finest of the three.
    let half = |jet, index_scale, half_width| {
        GradedHalf::new(jet, index_scale, [half_width, HEIGHT], 0.012)
    };
    [
        ("gaussian-carpet", half(gaussian(10.02, 4.25), 1.0, 25.0)),
        ("grating-carpet", half(Box::new(grating), 1.0, 30.0)),
        ("quasi-conformal-carpet", half(Box::new(quasi_conformal), index_scale, 25.0)),
    ]
}

/// What becomes of the strongest branch of a ray in the device's frame; None for rays that miss the
/// top and the sides or come too near to grazing incidence, to a critical angle, or to an edge.
fn reference(carpet: &GradedHalf, origin: DVec3, direction: DVec3) -> Option<Expected> {
    let a = carpet.half_width;
    let through_top = (HEIGHT - origin.y) / direction.y;
    let through_side = (-a * direction.x.signum() - origin.x) / direction.x;
    let at_top = origin + direction * through_top;
    let (distance, inward) = if origin.y > HEIGHT && at_top.x.abs() < a - 0.1 {
        (through_top, DVec3::NEG_Y)
    } else {
        (through_side, DVec3::X * direction.x.signum())
    };
    let at = origin + direction * distance;
    if distance < 0.0 || at.y < 0.1 || at.y > HEIGHT + 1e-9 {
        return None;
    }
    if inward.x != 0.0 && at.y > HEIGHT - 0.1 {
        return None;
    }
    let p = refract(direction, inward, carpet.squared_index(at).value)?;
    carpet.out(at, p, distance)
}

fn assembly(kind: &str, extra: &str) -> Assembly {
    rays::assembly(&format!("[[device]]\nkind = \"{kind}\"\n{extra}\n"))
}

#[test]
fn rays_agree_with_the_equation_of_motion() {
    for (kind, carpet) in carpets() {
        let (rotation, position) = (17.0_f64, DVec3::new(3.0, -1.0, 2.0));
        let placed = "rotation = 17.0\nposition = [3.0, -1.0, 2.0]\nfloor = 0";
        let assembly = assembly(kind, placed);
        let turn = DMat3::from_rotation_z(rotation.to_radians());
        let (mut compared, mut mirrored, mut beyond_default) = (0, 0, 0);
        for n in 1..=count(60, 220) {
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
            let Some(expected) = reference(&carpet, origin, direction) else { continue };
            let launch = launch(position + turn * origin, turn * direction);
            let off = |tolerance: f64| {
                let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance });
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
            assert!(fine < 1e-8, "{kind}, ray {n}: {fine:.1e} cm");
            beyond_default += u32::from(off(1e-6) >= 1e-6);
            compared += 1;
            mirrored += u32::from(expected.mirrored);
        }
        assert!(
            compared > count(25, 100) && mirrored > count(18, 70),
            "{compared} compared, {mirrored} mirrored"
        );
        assert!(beyond_default * 200 <= compared, "{beyond_default} of {compared}");
    }
}

/// How far a ray in the plane z = 0 comes off a flat mirror on y = 0: beside it (cm), and by which
/// angle.
fn off_flat_mirror(assembly: &Assembly, origin: DVec3, direction: DVec3) -> [f64; 2] {
    let mut tracer = Tracer::new(assembly, Limits { min_power: 1e-2, tolerance: 1e-6 });
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
        let assembly = assembly(kind, keys);
        for n in 1..=200 {
            let angle = PI * (0.3 + 0.4 * spread(n, 0));
            let target = DVec3::X * 20.0 * (spread(n, 1) - 0.5);
            let direction = -DVec3::new(angle.cos(), angle.sin(), 0.0);
            let top = if kind == "gaussian-carpet" { 1000.0 } else { 60.0 };
            let origin = target - direction * 1.05 * top / angle.sin();
            let [beside, turned] = off_flat_mirror(&assembly, origin, direction);
            // On the way in and out, the map's shift and the refraction at the cut, 0.024 cm each.
            assert!(beside < 0.096 && turned < 1e-6, "{kind} {n}: {beside} cm, {turned}");
        }
    }
}

#[test]
fn every_carpet_hides_its_bump() {
    for (kind, _) in carpets() {
        let mean = |show: &str| {
            let assembly = assembly(kind, &format!("show = \"{show}\""));
            let count = 300;
            let off = |n| {
                let angle = PI * (0.3 + 0.4 * spread(n, 0));
                let target = DVec3::X * 14.0 * (spread(n, 1) - 0.5);
                let direction = -DVec3::new(angle.cos(), angle.sin(), 0.0);
                off_flat_mirror(&assembly, target - 70.0 * direction, direction)[1]
            };
            (1..=count).map(off).sum::<f64>() / f64::from(count)
        };
        let [cloak, bare, mirror] = ["cloak", "bare", "mirror"].map(mean);
        assert!(mirror < 1e-7 && bare > 0.3, "{kind} {mirror} {bare}");
        assert!(cloak < 0.1 * bare, "{kind} {cloak} {bare}");
    }
}

#[test]
fn the_back_is_a_flat_mirror() {
    for (kind, depth) in
        [("gaussian-carpet", 0.0), ("grating-carpet", 1.5), ("quasi-conformal-carpet", 0.0)]
    {
        for show in ["cloak", "bare", "mirror"] {
            let assembly = assembly(kind, &format!("show = \"{show}\""));
            for x in [0.0, 9.5, -24.9, 100.0] {
                let level = if show == "mirror" || x == 100.0 { 0.0 } else { -depth };
                let mut tracer =
                    Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance: 1e-6 });
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
        ("quasi-conformal-carpet", "h = 80.0\nw = 25.0\nheight = 100.0", "h", "too steep"),
    ] {
        let text = format!("[[device]]\nkind = \"{kind}\"\n{keys}\n");
        let message = refusal(&text);
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
        try_bench(&text)
    };
    // The troughs would stick out of the floor; above it there is room.
    assert!(two("0").is_err() && two("1.5").is_ok());
    let text = "[[device]]\nkind = \"gaussian-carpet\"\n[[device]]\nkind = \"gaussian-carpet\"\n\
                position = [80, 0, 0]\n";
    assert!(try_bench(text).is_err());
}
