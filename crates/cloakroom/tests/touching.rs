//! Devices that touch: nothing leaks between them, and what is cut out of one glass is one glass.

use crate::long::count;
use crate::rays::{Numbers, assembly, launch};
use cloakroom::assembly::Assembly;
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DMat3, DVec2, DVec3};
use optics::geometry::Pose;
use std::fmt::Write;

const LIMITS: Limits = Limits { min_power: 1e-9, tolerance: 1e-6 };

/// The leaves of a ray, whose account must add up with nothing lost.
fn leaves(assembly: &Assembly, ray: &Launch<2>) -> Vec<Leaf<2>> {
    let mut tracer = Tracer::new(assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(ray);
    assert_eq!(outcome.stats.lost, 0, "{ray:?}");
    for i in 0..2 {
        let sum = leaves.iter().map(|leaf| leaf.power[i]).sum::<f64>()
            + outcome.absorbed[i]
            + outcome.pruned[i];
        assert!((sum - 1.0).abs() < 1e-9, "{sum} {ray:?}");
    }
    leaves.to_vec()
}

/// What goes on along a direction.
fn onward(leaves: &[Leaf<2>], direction: DVec3) -> f64 {
    let on = leaves.iter().filter(|leaf| leaf.direction.dot(direction) > 0.5);
    on.map(|leaf| leaf.power[0]).sum()
}

/// A block of half the size `half` along x, as a device of its own kind, at a place.
fn block(kind: usize, metal: bool, half: f64, place: &str) -> String {
    let corners = format!("[[{0}, {0}], [-{0}, {0}], [-{0}, -{0}], [{0}, -{0}]]", half);
    let filling = if metal { "metal = true" } else { "permittivity = 2.25" };
    let prism = format!("[[device.prism]]\ncorners = {corners}\n{filling}\n");
    let size = format!("size = [{0}, {0}, 4]", 2.0 * half);
    match (kind, metal) {
        (0, _) => format!("[[device]]\nkind = \"prisms\"\n{place}\n{prism}"),
        (1, _) => format!("[[device]]\nkind = \"prisms\"\nlength = 4\n{place}\n{prism}"),
        (_, false) => {
            format!("[[device]]\nkind = \"body\"\nshape = \"box\"\n{size}\n{filling}\n{place}\n")
        }
        (_, true) => format!(
            "[[device]]\nkind = \"body\"\nshape = \"box\"\n{size}\nsurface = {{ color = [1, 1, 1] }}\n{place}\n"
        ),
    }
}

#[test]
fn light_never_goes_through_metal_that_touches_glass() {
    let mut numbers = Numbers(7);
    for _ in 0..count(150, 5000) {
        // Sizes and places of one decimal, side by side along x: an ulp apart, or into each other.
        let tenths = |number: f64| number.floor() / 10.0;
        let [one, other] = [0, 1].map(|_| tenths(numbers.between(1.0, 10.0)));
        let x = tenths(numbers.between(-30.0, 30.0));
        let beyond = tenths(10.0 * (x + one + other) + 0.5);
        let [a, b] = [0, 1].map(|_| numbers.between(0.0, 3.0) as usize);
        let (rotation, tilt) = if numbers.next() < 0.5 {
            (0.0, DVec3::Z)
        } else {
            (numbers.between(-180.0, 180.0), numbers.direction())
        };
        let pose = Pose::with_axis(DVec3::ZERO, f64::to_radians(rotation), tilt);
        let place = |x: f64| {
            let [u, v, w] = pose.to_world(DVec3::X * x).to_array();
            let [i, j, k] = tilt.to_array();
            format!(
                "position = [{u:?}, {v:?}, {w:?}]\nrotation = {rotation:?}\naxis = [{i:?}, {j:?}, {k:?}]"
            )
        };
        let scene = block(a, false, one, &place(x)) + &block(b, true, other, &place(beyond));
        let assembly = assembly(&scene);
        let narrow = one.min(other) * 0.95;
        for _ in 0..10 {
            let from =
                DVec3::new(-20.0, numbers.between(-narrow, narrow), numbers.between(-1.0, 1.0));
            let ray = launch(pose.to_world(from), pose.vector_to_world(DVec3::X));
            let leaves = leaves(&assembly, &ray);
            let through: Vec<_> =
                leaves.iter().filter(|leaf| leaf.body().is_none()).cloned().collect();
            let through = onward(&through, ray.direction);
            assert!(through < 1e-12, "{through} through the metal of\n{scene}{ray:?}");
        }
    }
}

#[test]
fn blocks_of_one_glass_that_touch_are_one_block() {
    let mut numbers = Numbers(11);
    for _ in 0..count(100, 2000) {
        let (rotation, tilt) = (numbers.between(-180.0, 180.0), numbers.direction());
        let origin = numbers.direction() * 3.0;
        let pose = Pose::with_axis(origin, rotation.to_radians(), tilt);
        let place = |x: f64| {
            let [u, v, w] = pose.to_world(DVec3::X * x).to_array();
            let [i, j, k] = tilt.to_array();
            format!(
                "position = [{u:?}, {v:?}, {w:?}]\nrotation = {rotation:?}\naxis = [{i:?}, {j:?}, {k:?}]"
            )
        };
        let [a, b] = [0, 1].map(|_| numbers.between(0.0, 3.0) as usize);
        let assembly =
            assembly(&(block(a, false, 1.0, &place(-1.0)) + &block(b, false, 1.0, &place(1.0))));
        for _ in 0..10 {
            let slant = 0.3 * DVec2::new(numbers.next() - 0.5, numbers.next() - 0.5);
            let local = DVec3::new(1.0, slant.x, slant.y).normalize();
            let through = DVec3::new(0.0, numbers.between(-0.5, 0.5), numbers.between(-1.0, 1.0));
            let ray = launch(pose.to_world(through - local * 20.0), pose.vector_to_world(local));
            let leaves = leaves(&assembly, &ray);
            // Two faces: of the part T of the power that each lets through, T² goes on at once.
            let first: f64 = leaves.iter().map(|leaf| leaf.power[0]).fold(0.0, f64::max);
            let (cos_i, sin_i) = (local.x, (1.0 - local.x * local.x).sqrt());
            let cos_t = (1.0 - (sin_i / 1.5).powi(2)).sqrt();
            let s = ((cos_i - 1.5 * cos_t) / (cos_i + 1.5 * cos_t)).powi(2);
            let p = ((1.5 * cos_i - cos_t) / (1.5 * cos_i + cos_t)).powi(2);
            let bounds = [(1.0 - s).powi(2), (1.0 - p).powi(2)];
            assert!(
                first > bounds[0].min(bounds[1]) - 1e-9 && first < bounds[0].max(bounds[1]) + 1e-9,
                "{first} {bounds:?} {ray:?}"
            );
            assert!(onward(&leaves, ray.direction) > 0.9, "{leaves:?}");
        }
    }
}

#[test]
fn a_glass_square_is_the_same_however_it_is_cut() {
    let mut numbers = Numbers(3);
    for _ in 0..count(60, 2000) {
        let angle = numbers.between(0.0, 90.0).to_radians();
        let turn = DVec2::from_angle(angle) * 3.0;
        // As one writes corners: with six decimals.
        let text = |corners: &[DVec2]| {
            let written = corners.iter().map(|corner| {
                let at = turn.rotate(*corner);
                format!("[{:.6}, {:.6}]", at.x, at.y)
            });
            format!("[{}]", written.collect::<Vec<_>>().join(", "))
        };
        let [t, u, v, w] = [0; 4].map(|_| numbers.between(0.2, 0.8));
        let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(DVec2::from);
        let [a, b, c, d] = square;
        let (low, high) = (a.lerp(b, t), d.lerp(c, u));
        // A cut across, and one from the middle of it to the left side.
        let (middle, left) = (low.lerp(high, v), a.lerp(d, w));
        let pieces =
            [vec![a, low, middle, left], vec![left, middle, high, d], vec![low, b, c, high]];
        let scene = |parts: &[Vec<DVec2>]| {
            let mut scene = String::from("[[device]]\nkind = \"prisms\"\n");
            for part in parts {
                let corners = text(part);
                writeln!(scene, "[[device.prism]]\ncorners = {corners}\npermittivity = 2.25")
                    .unwrap();
            }
            scene
        };
        let (cut, whole) = (assembly(&scene(&pieces)), assembly(&scene(&[square.to_vec()])));
        // A rounded corner turns a piece of a side as moving the whole side's end by so much does, which shows where light
        // comes in or out grazing.
        let by = 1e-6 / 0.2;
        let moves = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y].map(|way| way * by / 3.0);
        let bent: Vec<Assembly> = (0..16)
            .map(|i| {
                let mut corners = square;
                corners[i / 4] += moves[i % 4];
                assembly(&scene(&[corners.to_vec()]))
            })
            .collect();
        for _ in 0..20 {
            let target = DVec3::new(0.0, numbers.between(-3.0, 3.0), numbers.between(-1.0, 1.0));
            let ray = launch(DVec3::new(-20.0, 0.1, 0.2), target - DVec3::new(-20.0, 0.1, 0.2));
            let sorted = |assembly: &Assembly| {
                let mut powers: Vec<f64> =
                    leaves(assembly, &ray).iter().map(|leaf| leaf.power[0]).collect();
                powers.sort_by(|a, b| b.total_cmp(a));
                powers.truncate(3);
                powers
            };
            let (found, expected) = (sorted(&cut), sorted(&whole));
            let others: Vec<_> = bent.iter().map(sorted).collect();
            let is_near = |i: usize| {
                let most = others.iter().filter_map(|other| other.get(i));
                let most = most.map(|other| (other - expected[i]).abs()).fold(1e-5, f64::max);
                (found[i] - expected[i]).abs() < most
            };
            let near = found.len() == expected.len() && (0..found.len()).all(is_near);
            assert!(near, "{found:?} {expected:?} {others:?}\n{}", scene(&pieces));
        }
    }
}

#[test]
fn every_pair_of_kinds_that_touch_balances() {
    // Round, graded and flat ones, each 10 cm or so wide, touching at x = 0 from either side, in poses that keep that.
    let kinds = [
        ("square-cloak", 14.1 * 0.5f64.sqrt(), ""),
        ("square-cloak", 14.1 * 0.5f64.sqrt(), "material = \"negative-uniaxial\"\n"),
        ("double-gaussian-cloak", 25.0, ""),
        ("cylinder-cloak", 10.0, ""),
        ("sphere-cloak", 10.0, ""),
        ("luneburg-lens", 10.0, ""),
        ("fisheye-lens", 10.0, ""),
        ("body", 5.0, "shape = \"sphere\"\npermittivity = 2.25\n"),
        ("body", 5.0, "shape = \"box\"\npermittivity = [[2.2, 0, 0], [0, 2.4, 0], [0, 0, 2.7]]\n"),
        ("body", 5.0, "shape = \"cylinder\"\nsurface = { color = [1, 0, 0] }\n"),
    ];
    let mut numbers = Numbers(19);
    for (one, half, keys) in kinds {
        for (other, other_half, other_keys) in kinds {
            // Turned together about the touching point.
            let turn = numbers.between(0.0, 360.0);
            let rotation = DMat3::from_rotation_z(turn.to_radians());
            let device = |kind: &str, keys: &str, x: f64| {
                let [u, v, _] = (rotation * DVec3::X * x).to_array();
                format!(
                    "[[device]]\nkind = \"{kind}\"\n{keys}position = [{u:?}, {v:?}, 0]\nrotation = {turn:?}\n"
                )
            };
            let scene = device(one, keys, -half) + &device(other, other_keys, other_half);
            let assembly = assembly(&scene);
            let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-4, tolerance: 1e-6 });
            for _ in 0..count(6, 100) {
                let aim = DVec3::new(0.0, numbers.between(-2.0, 2.0), numbers.between(-2.0, 2.0));
                let from =
                    DVec3::new(-60.0, numbers.between(-20.0, 20.0), numbers.between(-20.0, 20.0));
                let (leaves, outcome) =
                    tracer.trace(&launch(rotation * from, rotation * (aim - from)));
                assert_eq!(outcome.stats.lost, 0, "{scene}");
                for i in 0..2 {
                    let sum = leaves.iter().map(|leaf| leaf.power[i]).sum::<f64>()
                        + outcome.absorbed[i]
                        + outcome.pruned[i];
                    assert!((sum - 1.0).abs() < 1e-9, "{sum}\n{scene}");
                }
            }
        }
    }
}
