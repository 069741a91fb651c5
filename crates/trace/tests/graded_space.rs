//! An index on a grid in space, and uniaxial media on grids, against closed forms, the device of
//! two dimensions, and a homogeneous crystal.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::numbers::Numbers;
use cloakroom_trace::assembly::{Assembly, Placed};
use cloakroom_trace::device::{Fact, FactValue, Request, entry};
use cloakroom_trace::keys::{KeyError, Samples, Value};
use cloakroom_trace::walk::{Launch, Leaf, Limits, Tracer};
use glam::{DMat3, DVec3};
use optics::geometry::Pose;
use optics::wave::transverse_basis;
use std::f64::consts::PI;

const LIMITS: Limits = Limits { min_power: 1e-5, tolerance: 1e-10 };

/// What is at each sample of a grid over a box about the origin, flat where there is one layer.
fn sampled<const C: usize>(
    size: DVec3,
    count: [usize; 3],
    function: impl Fn(DVec3) -> [f64; C],
) -> Value {
    let mut values = Vec::new();
    let share = |i: usize, count: usize| {
        if count == 1 { 0.0 } else { i as f64 / (count - 1) as f64 - 0.5 }
    };
    for i in 0..count[0] {
        for j in 0..count[1] {
            for k in 0..count[2] {
                let at =
                    size * DVec3::new(share(i, count[0]), share(j, count[1]), share(k, count[2]));
                values.extend(function(at));
            }
        }
    }
    let mut shape = count[..if count[2] == 1 { 2 } else { 3 }].to_vec();
    if C > 1 {
        shape.push(C);
    }
    Value::from(&Samples::of(&shape, values).unwrap())
}

fn build(
    kind: &str,
    length: Option<f64>,
    keys: &[(&str, Value)],
) -> Result<(Assembly, Vec<Fact>), KeyError> {
    let mut device = (entry(kind).unwrap().device)();
    for (name, value) in keys {
        device.table_mut().set(name, value.clone())?;
    }
    let request = Request { length, ..Request::default() };
    let structure = device.build(request)?;
    let facts = device.facts(request);
    Ok((Assembly::new(vec![Placed::new(Pose::IDENTITY, structure)]), facts))
}

fn graded(size: DVec3, keys: &[(&str, Value)]) -> Assembly {
    let mut all: Vec<(&str, Value)> = vec![("width", size.x.into()), ("height", size.y.into())];
    all.extend(keys.iter().cloned());
    build("graded", Some(size.z), &all).unwrap().0
}

fn launch(origin: DVec3, direction: DVec3) -> Launch<2> {
    let direction = direction.normalize();
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [h.into(), v.into()] }
}

fn launches(count: u32, target: DVec3) -> impl Iterator<Item = Launch<2>> {
    let mut numbers = Numbers(7);
    (0..count).map(move |_| {
        let origin = 30.0 * numbers.vector().normalize();
        launch(origin, target * numbers.vector() - origin)
    })
}

/// Holds the leaves of two assemblies against each other; how many there were, and by how much they
/// differ at most.
fn compared([a, b]: [&Assembly; 2], tolerances: [f64; 2], target: DVec3, count: u32) -> (u32, f64) {
    // Boxes can trap light.
    let [of_a, of_b] = tolerances.map(|tolerance| Limits { min_power: 1e-2, tolerance });
    let (mut one, mut other) = (Tracer::new(a, of_a), Tracer::new(b, of_b));
    let (mut leaves, mut most) = (0, 0.0_f64);
    for launch in launches(count, target) {
        let (expected, outcome) = one.trace(&launch);
        outcome.assert_balanced(expected, 1e-9, &launch);
        let (found, outcome) = other.trace(&launch);
        outcome.assert_balanced(found, 1e-9, &launch);
        let strong = |leaf: &&Leaf<2>| leaf.met_device && leaf.power[0] + leaf.power[1] > 3e-2;
        for leaf in expected.iter().filter(strong) {
            let off = |other: &Leaf<2>| {
                let powers = (0..2).map(|i| (leaf.power[i] - other.power[i]).abs());
                let fields =
                    (0..2).map(|i| (leaf.electric[i] - other.electric[i]).norm_squared().sqrt());
                [
                    (leaf.position - other.position).length(),
                    (leaf.direction - other.direction).length(),
                    (leaf.optical_path - other.optical_path).abs(),
                    powers.fold(0.0, f64::max),
                    fields.fold(0.0, f64::max),
                ]
                .into_iter()
                .fold(0.0, f64::max)
            };
            let nearest = found.iter().map(off).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-6, "{nearest} {launch:?} {leaf:?}");
            most = most.max(nearest);
            leaves += 1;
        }
    }
    (leaves, most)
}

/// Maxwell's fish-eye as a ball: what leaves it is opposite to where it has come in.
fn fisheye_off(steps: usize) -> f64 {
    const R: f64 = 10.0;
    let index = |p: DVec3| [2.0 / (1.0 + p.length_squared() / (R * R))];
    let size = DVec3::splat(2.0 * R);
    let index = sampled(size, [steps + 1; 3], index);
    let ball = graded(size, &[("index", index), ("shape", "ball".into())]);
    let mut tracer = Tracer::new(&ball, LIMITS);
    let mut numbers = Numbers(3);
    let mut off = 0.0_f64;
    for _ in 0..12 {
        let entry = numbers.vector().normalize() * R;
        let inward = (0.6 * numbers.vector() - entry.normalize()).normalize();
        let (leaves, _) = tracer.trace(&launch(entry - 20.0 * inward, inward));
        let power = |leaf: &Leaf<2>| leaf.power[0] + leaf.power[1];
        let leaf = leaves.iter().max_by(|a, b| power(a).total_cmp(&power(b))).unwrap();
        let x = entry / R;
        let direction = 2.0 * inward.dot(x) * x - inward;
        off = off
            .max((leaf.position + entry).length())
            .max((leaf.direction - direction).length())
            .max((leaf.optical_path - 20.0 - PI * R).abs());
    }
    off
}

#[test]
fn a_sampled_fisheye_images_each_point_to_its_opposite() {
    let off = [16, 32].map(fisheye_off);
    let order = (off[0] / off[1]).log2();
    assert!(off[1] < 1e-3 && order > 3.5, "{off:?} {order}");
}

#[test]
fn what_is_the_same_along_z_is_the_device_of_two_dimensions() {
    let size = DVec3::new(12.0, 10.0, 9.0);
    let index = |p: DVec3| [1.4 + 0.1 * (0.4 * p.x).sin() * (0.5 * p.y + 0.2).cos()];
    let plane = graded(size, &[("index", sampled(size, [9, 8, 1], index))]);
    let space = graded(size, &[("index", sampled(size, [9, 8, 6], index))]);
    // Below 1e-8 the device of two dimensions is off by more, up to 2e-7 at 1e-12; at 1e-8 it agrees
    // with that of three at 1e-10 and at 1e-12.
    let (leaves, off) = compared([&plane, &space], [1e-8, 1e-10], 0.5 * size, 60);
    assert!(leaves > 100 && off < 1e-9, "{leaves} {off}");
}

#[test]
fn one_crystal_on_a_grid_is_a_body_of_it() {
    let size = DVec3::new(12.0, 10.0, 9.0);
    let axis = DVec3::new(0.3, -0.5, 0.7).normalize();
    let (index, ratio) = (1.5_f64, 1.1_f64);
    let [across, along] = [index * index, (index * ratio).powi(2)];
    let dyad = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    let tensor = DMat3::from_diagonal(DVec3::splat(across)) + dyad * (along - across);
    let rows = tensor.to_cols_array_2d();
    let keys = [
        ("shape", "box".into()),
        ("size", size.to_array().into()),
        ("permittivity", Value::from(rows)),
    ];
    let body = build("body", None, &keys).unwrap().0;
    let count = [5, 6, 7];
    let one = sampled(size, count, |_| [index]);
    let constant = graded(
        size,
        &[("index", one.clone()), ("ratio", ratio.into()), ("optic_axis", axis.to_array().into())],
    );
    let (leaves, off) = compared([&body, &constant], [1e-10; 2], 0.5 * size, 40);
    assert!(leaves > 100 && off < 1e-10, "{leaves} {off}");
    // Given at each sample, in either sense.
    let field = graded(
        size,
        &[
            ("index", one),
            ("ratio", sampled(size, count, |_| [ratio])),
            (
                "optic_axis",
                sampled(size, count, |p| (axis * (7.0 * p.x + p.y).signum()).to_array()),
            ),
        ],
    );
    let (leaves, off) = compared([&body, &field], [1e-10; 2], 0.5 * size, 40);
    assert!(leaves > 100 && off < 1e-10, "{leaves} {off}");
}

#[test]
fn layers_across_the_ray_keep_its_direction() {
    // All depends on z alone: p_x and p_y are kept from the air in front to that behind, and
    // dx/dz follows from the local wave at each depth.
    let size = DVec3::new(30.0, 30.0, 8.0);
    let index = |z: f64| 1.5 + 0.05 * (0.3 * z).sin();
    let axis = |z: f64| {
        let (turn, tilt) = (0.12 * z, 0.4 + 0.02 * z);
        DVec3::new(turn.cos() * tilt.cos(), turn.sin() * tilt.cos(), tilt.sin())
    };
    const RATIO: f64 = 1.12;
    let count = [4, 4, 121];
    let device = graded(
        size,
        &[
            ("index", sampled(size, count, |p| [index(p.z)])),
            ("ratio", RATIO.into()),
            ("optic_axis", sampled(size, count, |p| axis(p.z).to_array())),
        ],
    );
    let incoming = DVec3::new(0.3, -0.2, 1.0).normalize();
    // The way through, by the midpoint rule: aside, and the optical path.
    let through = |extraordinary: bool| {
        const STEPS: u32 = 200_000;
        let dz = size.z / f64::from(STEPS);
        let (mut aside, mut path) = (DVec3::ZERO, 0.0);
        for step in 0..STEPS {
            let z = (f64::from(step) + 0.5) * dz - 0.5 * size.z;
            let (square, a) = (index(z).powi(2), axis(z));
            let excess = if extraordinary { RATIO * RATIO - 1.0 } else { 0.0 };
            let constant = square * (1.0 + excess);
            let flat = incoming.with_z(0.0);
            // (p² + excess (p·a)²) = constant, in p_z.
            let (in_plane, rise) = (flat.dot(a), 1.0 + excess * a.z * a.z);
            let half = excess * in_plane * a.z;
            let rest = flat.length_squared() + excess * in_plane * in_plane - constant;
            let p = flat.with_z((-half + (half * half - rise * rest).sqrt()) / rise);
            let ray = p + a * (excess * p.dot(a));
            aside += ray / ray.z * dz;
            path += p.dot(ray) / ray.z * dz;
        }
        (aside, path)
    };
    let start = DVec3::new(-1.0, 0.5, -0.5 * size.z);
    let mut tracer = Tracer::new(&device, LIMITS);
    let (leaves, outcome) = tracer.trace(&launch(start - 10.0 * incoming, incoming));
    outcome.assert_balanced(leaves, 1e-9, &incoming);
    for extraordinary in [false, true] {
        let (aside, path) = through(extraordinary);
        let end = start + aside;
        let off = |leaf: &Leaf<2>| {
            (leaf.position - end).length() + (leaf.optical_path - 10.0 - path).abs()
        };
        let leaf = leaves.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
        assert!(off(leaf) < 2e-7, "{extraordinary} {} {leaf:?}", off(leaf));
        assert!((leaf.direction - incoming).length() < 1e-12, "{leaf:?}");
        assert!(leaf.power[0] + leaf.power[1] > 0.1);
    }
}

#[test]
fn power_is_kept_in_fields_of_any_kind() {
    let size = DVec3::new(8.0, 9.0, 7.0);
    for seed in 0..6 {
        let mut numbers = Numbers(100 * seed);
        let waves: [[DVec3; 2]; 3] =
            std::array::from_fn(|_| [0.5 * numbers.vector(), 3.0 * numbers.vector()]);
        let wave = |n: usize, p: DVec3| (waves[n][0].dot(p) + waves[n][1].x).sin();
        let axis = |p: DVec3| {
            let (turn, tilt) = (1.2 * wave(1, p) + waves[1][1].y, 0.8 * wave(2, p));
            [turn.cos() * tilt.cos(), turn.sin() * tilt.cos(), tilt.sin()]
        };
        let count = [8, 9, 10];
        let shape = ["rectangle", "circle", "ball"][seed as usize % 3];
        let device = graded(
            size,
            &[
                ("index", sampled(size, count, |p| [1.5 + 0.15 * wave(0, p)])),
                ("ratio", sampled(size, count, |p| [1.05 + 0.1 * wave(2, p)])),
                ("optic_axis", sampled(size, count, axis)),
                ("shape", shape.into()),
            ],
        );
        let limits = Limits { min_power: 1e-3, tolerance: 1e-7 };
        let mut tracer = Tracer::new(&device, limits);
        let mut met = 0;
        for launch in launches(40, 0.4 * size) {
            let (leaves, outcome) = tracer.trace(&launch);
            outcome.assert_balanced(leaves, 1e-9, &launch);
            assert_eq!(outcome.stats.lost, 0, "{launch:?}");
            for leaf in leaves.iter().filter(|leaf| leaf.met_device) {
                for (field, power) in leaf.electric.iter().zip(leaf.power) {
                    assert!((field.norm_squared() - power).abs() < 1e-6, "{leaf:?}");
                }
                met += 1;
            }
        }
        assert!(met > 60, "{met}");
    }
}

#[test]
fn facts_say_what_the_grid_holds() {
    let size = DVec3::splat(10.0);
    let count = [5; 3];
    let keys = [
        ("width", size.x.into()),
        ("height", size.y.into()),
        ("shape", "ball".into()),
        // Beyond the ball it does not count.
        (
            "index",
            sampled(size, count, |p| [if p.length() > 6.0 { 1.9 } else { 1.5 + 0.02 * p.x }]),
        ),
        ("ratio", 1.1.into()),
        ("optic_axis", 30.0.into()),
    ];
    let (_, facts) = build("graded", Some(10.0), &keys).unwrap();
    let found = |name: &str| {
        let fact = facts.iter().find(|fact| fact.name == name).unwrap();
        match fact.value {
            FactValue::Number(number) => number,
            _ => f64::NAN,
        }
    };
    assert_eq!([found("index_min"), found("index_max")], [1.4, 1.6]);
    assert_eq!([found("ratio_min"), found("ratio_max")], [1.1, 1.1]);
}

#[test]
fn what_does_not_go_together_is_told() {
    let size = DVec3::splat(10.0);
    let one = |count: [usize; 3]| sampled(size, count, |_| [1.5]);
    let refused = |length: Option<f64>, keys: &[(&str, Value)], part: &str| {
        let message = match build("graded", length, keys) {
            Err(error) => error.message,
            Ok(_) => panic!("{part}"),
        };
        assert!(message.contains(part) && !message.contains("NDIM"), "{message}");
    };
    let index = ("index", one([5, 5, 5]));
    let flat = ("index", one([5, 5, 1]));
    let crystal = |axis: Value| [index.clone(), ("ratio", 1.1.into()), ("optic_axis", axis)];
    refused(None, std::slice::from_ref(&index), "say with `length` how long");
    refused(Some(9.0), &[("index", one([5, 5, 3]))], "5 x 5 x 3 samples is too small");
    refused(Some(9.0), &[index.clone(), ("inner", 2.0.into())], "leave inner out");
    refused(Some(9.0), &[flat.clone(), ("shape", "ball".into())], "index of three dimensions");
    refused(Some(9.0), &[index.clone(), ("ratio", 1.1.into())], "and no optic_axis");
    refused(Some(9.0), &[flat, ("optic_axis", 30.0.into())], "and no ratio");
    let odd = ("ratio", one([5, 5, 4]));
    refused(
        Some(9.0),
        &[index.clone(), odd, ("optic_axis", 30.0.into())],
        "ratio is 5 x 5 x 4, index 5 x 5 x 5",
    );
    refused(
        Some(9.0),
        &crystal([0.0; 3].into()),
        "optic_axis is [0, 0, 0], which has no direction",
    );
    refused(Some(9.0), &crystal(one([5, 4, 5])), "5 x 5 x 5, or 5 x 5 x 5 x 3");
    let none = sampled(size, [5; 3], |p| if p.x < 4.0 { [1.0, 0.0, 0.0] } else { [0.0; 3] });
    refused(Some(9.0), &crystal(none), "optic_axis[4][0][0] is [0, 0, 0]");
    // A line around which the axes go once by half.
    let around = sampled(size, [5; 3], |p| [0.5 * (p.y + 0.3).atan2(p.x + 0.3).to_degrees()]);
    refused(Some(9.0), &crystal(around), "from sample to sample");
    let steep = sampled(size, [5; 3], |p| {
        [if p.length() < 1.0 {
            0.1
        } else if p.length() < 2.6 {
            9.0
        } else {
            1.0
        }]
    });
    refused(Some(9.0), &[("index", steep)], "between the samples the index falls to 0");
    let uneven = Value::List(vec![Value::from([[1.0; 4]; 4]), Value::from([[1.0; 4]; 3])]);
    refused(Some(9.0), &[("index", uneven)], "[1] has 3 entries, [0] has 4");
    refused(Some(9.0), &[("index", 1.5.into())], "it must be rows of numbers");
    refused(Some(9.0), &[("index", sampled(size, [5; 3], |_| [-1.0]))], "index[0][0][0] is -1");
    refused(Some(9.0), &[index, ("ratio", (-1.0).into())], "ratio is -1");
}
