//! Designs (i) and (ii): what must come out of their interfaces, and the reversal of paths.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may")]

use crate::long::count;
use crate::rays::{self, launch};
use cloakroom::assembly::Assembly;
use cloakroom::trace::{Launch, Leaf, LeafEnd, Limits, TraceStats, Tracer};
use glam::{DMat3, DVec2, DVec3};
use optics::wave::ComplexVector;

fn assembly(material: &str) -> Assembly {
    bench_of(material, 0.0)
}

/// Design (i) ("positive") or (ii) ("negative"), turned by an angle in degrees.
fn bench_of(material: &str, rotation: f64) -> Assembly {
    let text = format!(
        "[[device]]\nkind = \"square-cloak\"\nmaterial = \"{material}-uniaxial\"\n\
         rotation = {rotation:?}\n"
    );
    rays::assembly(&text)
}

#[test]
fn horizontal_light_is_cloaked_in_every_vertical_plane_and_vertical_light_is_not() {
    for material in ["positive", "negative"] {
        let assembly = assembly(material);
        let limits = Limits { min_power: 1e-9, tolerance: 1e-8 };
        let mut tracer = Tracer::new(&assembly, limits);
        for step in (0..200).step_by(count(4, 1)) {
            let y = -9.5 + 0.0951 * f64::from(step);
            let launch = launch(DVec3::new(-50.0, y, 3.0), DVec3::X);
            let (leaves, outcome) = tracer.trace(&launch);
            assert_eq!(outcome.stats, TraceStats::default());
            let on: Vec<_> =
                leaves.iter().filter(|leaf| leaf.direction.distance(DVec3::X) < 1e-11).collect();
            let straight: f64 = on
                .iter()
                .filter(|leaf| (leaf.position.y - y).abs() < 1e-10)
                .filter(|leaf| (leaf.optical_path - (leaf.position.x + 50.0)).abs() < 1e-10)
                .map(|leaf| leaf.power[0])
                .sum();
            assert!((straight - 1.0).abs() < 1e-10, "{material}, y = {y}: {straight}");
            let undisturbed: f64 = on
                .iter()
                .filter(|leaf| (leaf.position.y - y).abs() < 1e-6)
                .map(|leaf| leaf.power[1])
                .sum();
            assert!(undisturbed < 0.5, "{material}, y = {y}: {undisturbed} of vertical light");
        }
    }
}

#[test]
fn powers_add_up_at_any_threshold() {
    for material in ["positive", "negative"] {
        let assembly = assembly(material);
        for min_power in [0.3, 1e-2, 1e-4, 1e-6, 1e-8] {
            let mut tracer = Tracer::new(&assembly, Limits { min_power, tolerance: 1e-6 });
            for n in 1..count(60, 300) {
                let n = f64::from(n);
                let target = DVec3::new(0.0, 9.0 * (n * 0.618).sin(), 30.0 * (n * 0.755).cos());
                let (leaves, outcome) =
                    tracer.trace(&launch(DVec3::new(-100.0, 0.0, 0.0), target + DVec3::X * 100.0));
                outcome.assert_balanced(leaves, 1e-10, &(material, min_power, n));
            }
        }
    }
}

#[test]
fn trapped_vertical_light_leaves_design_ii_after_a_few_bounces() {
    // Derived by hand from the interfaces: in the centre plane 88.6 % leaves in one path, at -2.14
    // or 92.14 degrees.
    let assembly = assembly("negative");
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-6, tolerance: 1e-6 });
    for y in [2.0, 4.0, 6.0, 8.0] {
        let (leaves, _) = tracer.trace(&launch(DVec3::new(-50.0, y, 0.0), DVec3::X));
        let main = leaves.iter().max_by(|a, b| a.power[1].total_cmp(&b.power[1])).unwrap();
        let angle = main.direction.y.atan2(main.direction.x).to_degrees();
        assert!((main.power[1] - 0.886).abs() < 5e-3, "y = {y}: {}", main.power[1]);
        let expected = [-2.14, 2.14, 92.14, -92.14];
        assert!(expected.iter().any(|e| (angle - e).abs() < 0.01), "y = {y}: {angle}");
    }
}

/// Two leaves of one tree that run on one line and are on time with each other. Mirrored paths
/// ("transmit, reflect" and "reflect, transmit" at the seam) do so.
fn coincide<const N: usize>(a: &Leaf<N>, b: &Leaf<N>) -> bool {
    let apart = b.position - a.position;
    let along = apart.dot(a.direction);
    a.direction.distance(b.direction) < 1e-8
        && (apart - a.direction * along).length() < 1e-6
        && (a.optical_path + along - b.optical_path).abs() < 1e-6
}

/// How far from equal two lists of powers are, whatever their order.
fn largest_difference(mut a: Vec<f64>, mut b: Vec<f64>) -> f64 {
    let length = a.len().max(b.len());
    for list in [&mut a, &mut b] {
        list.resize(length, 0.0);
        list.sort_by(f64::total_cmp);
    }
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn paths_reversed_carry_the_same_power() {
    // For symmetric tensors the transpose of a path's Jones matrix is that of the reversed path. So
    // a field e sent back along a line returns in the launched polarization h, on each of the paths
    // T_k on that line, with the power |h·T_kᵀ e|² = |e·T_k h|²: a list that the leaves T_k h tell
    // beforehand.
    for material in ["positive", "negative"] {
        let assembly = assembly(material);
        let limits = Limits { min_power: 1e-10, tolerance: 1e-8 };
        let mut tracer = Tracer::<2>::new(&assembly, limits);
        let mut back_tracer = Tracer::<1>::new(&assembly, limits);
        let (mut alone, mut together, mut worst) = (0, 0, 0.0f64);
        for n in 1..60 {
            let n = f64::from(n);
            let target = DVec3::new(100.0, 8.0 * (n * 0.618).sin(), 25.0 * (n * 0.755).cos());
            let there = launch(DVec3::new(-100.0, 0.0, 0.0), target);
            let leaves = tracer.trace(&there).0.to_vec();
            for (leaf, i) in leaves.iter().flat_map(|leaf| [(leaf, 0), (leaf, 1)]) {
                if leaf.power[i] < 0.005 {
                    continue;
                }
                // Time reversed.
                let norm = leaf.electric[i].norm_squared().sqrt();
                let sent = leaf.electric[i].conj() * (1.0 / norm);
                let back = Launch {
                    origin: leaf.position + leaf.direction * 5.0,
                    direction: -leaf.direction,
                    electric: [sent],
                };
                let expected: Vec<f64> = leaves
                    .iter()
                    .filter(|other| coincide(leaf, other))
                    .map(|other| sent.dot(other.electric[i]).norm_sqr())
                    .collect();
                let start = Leaf {
                    survives_alone: [true; 1],
                    position: there.origin,
                    met_device: true,
                    direction: -there.direction,
                    power: [0.0],
                    electric: [ComplexVector::ZERO],
                    optical_path: leaf.optical_path + 5.0,
                    delay_path: 0.0,
                    group_path: None,
                    end: LeafEnd::Away,
                    path: 0,
                };
                let returned: Vec<f64> = back_tracer
                    .trace(&back)
                    .0
                    .iter()
                    .filter(|home| coincide(&start, home))
                    .map(|home| home.electric[0].dot(there.electric[i]).norm_sqr())
                    .collect();
                *(if expected.len() == 1 { &mut alone } else { &mut together }) += 1;
                worst = worst.max(largest_difference(expected, returned));
            }
        }
        println!(
            "{material}: {alone} paths alone, {together} with others on their line: {worst:.1e}"
        );
        assert!(alone > 50 && together > 20, "{material}: {alone} {together}");
        // But for paths that were pruned one way and not the other.
        assert!(worst < limits.min_power, "{material}: {worst:e}");
    }
}

/// Where a ray leaves the ideal prism that the extraordinary wave of designs (i) and (ii) sees in
/// virtual space: the square, with |P|² = 1 - g p_z² in its plane, and the strip mirror in it.
struct Exit {
    position: DVec3,
    direction: DVec3,
    optical_path: f64,
}

/// Follows a ray through the prism to the first face that lets it out.
fn through_prism(origin: DVec3, direction: DVec3, g: f64) -> Option<Exit> {
    let d = 14.1 * 0.5f64.sqrt();
    let corners = [(d, 0.0), (0.0, d), (-d, 0.0), (0.0, -d)].map(DVec2::from);
    let side = |i: usize| (corners[i], corners[(i + 1) % 4]);
    let outward = |i: usize| corners[i] + corners[(i + 1) % 4];
    let crossing = |o: DVec2, v: DVec2, (a, b): (DVec2, DVec2)| {
        let t = (a - o).perp_dot(b - a) / v.perp_dot(b - a);
        let u = (a - o).perp_dot(v) / v.perp_dot(b - a);
        (t > 1e-9 && (0.0..=1.0).contains(&u)).then_some(t)
    };
    let pz = direction.z;
    // Wave vector in the plane after refraction into or out of the prism: the part along the face
    // stays.
    let refracted = |p: DVec2, n: DVec2, square: f64| {
        let along = p - n * p.dot(n);
        let rest = square - along.length_squared();
        (rest > 0.0).then(|| along + n * rest.sqrt().copysign(p.dot(n)))
    };
    let (o, v) = (origin.truncate(), direction.truncate());
    let (t, face) = (0..4)
        .filter(|i| outward(*i).dot(v) < 0.0)
        .find_map(|i| Some((crossing(o, v, side(i))?, i)))?;
    let mut position = origin + direction * t;
    let mut optical_path = t;
    let mut p = refracted(v, outward(face).normalize(), 1.0 - g * pz * pz)?;
    for _ in 0..40 {
        let strip = crossing(position.truncate(), p, (corners[2], corners[0]));
        let faces = (0..4).filter(|i| outward(*i).dot(p) > 0.0);
        let (t, face) = faces
            .filter_map(|i| Some((crossing(position.truncate(), p, side(i))?, Some(i))))
            .chain(strip.map(|t| (t, None)))
            .min_by(|a, b| a.0.total_cmp(&b.0))?;
        // The ray runs along (P, g p_z); P·P + g p_z² = 1.
        position += p.extend(g * pz) * t;
        optical_path += t;
        let Some(face) = face else {
            position.y = 0.0;
            p.y = -p.y;
            continue;
        };
        let n = outward(face).normalize();
        match refracted(p, n, 1.0 - pz * pz) {
            Some(out) => {
                return Some(Exit { position, direction: out.extend(pz), optical_path });
            }
            None => p -= n * (2.0 * p.dot(n)),
        }
    }
    None
}

#[test]
fn extraordinary_light_sees_an_ideal_prism_in_virtual_space() {
    for (material, g) in [("positive", 0.1292), ("negative", 1.3828)] {
        // By the map: |P|² = (1 - κ) p·µp in the plane.
        let kappa = 1.0 / 3f64.sqrt();
        let m = optics::transformation::StripToRhombus::new(1.0, kappa).principal_values().0;
        let exact = (1.0 - kappa) * if material == "positive" { m.y } else { m.x };
        assert!((exact - g).abs() < 5e-5, "{exact}");
        for rotation in [0.0, 10.0, -25.0] {
            let turned = bench_of(material, rotation);
            let turn = DMat3::from_rotation_z(f64::to_radians(rotation));
            let mut tracer = Tracer::new(&turned, Limits { min_power: 1e-9, tolerance: 1e-8 });
            let (mut seen, mut weakest) = (0, 1.0f64);
            for n in 1..count(60, 200) {
                let n = f64::from(n);
                let origin = DVec3::new(-100.0, 0.0, 0.0);
                let target = DVec3::new(0.0, 9.0 * (n * 0.618).sin(), 45.0 * (n * 0.755).cos());
                let there = launch(origin, target - origin);
                let local = turn.transpose();
                let Some(exit) = through_prism(local * origin, local * there.direction, exact)
                else {
                    continue;
                };
                let (leaves, _) = tracer.trace(&there);
                let found = leaves.iter().find(|leaf| {
                    leaf.position.distance(turn * exit.position) < 1e-9
                        && leaf.direction.distance(turn * exit.direction) < 1e-10
                        && (leaf.optical_path - exit.optical_path).abs() < 1e-9
                });
                let power = found.map_or(0.0, |leaf| leaf.power[0] + leaf.power[1]);
                weakest = weakest.min(power);
                seen += 1;
            }
            assert!(
                seen > count(30, 100) && weakest > 0.0,
                "{material} {rotation}: {seen}, {weakest}"
            );
        }
    }
}

#[test]
fn design_ii_sends_little_horizontal_light_back() {
    // At an azimuth of 20 degrees, over all heights: 2.2 % on average, 3.2 % at most, counting what
    // the first face sends straight up or down.
    let assembly = assembly("negative");
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-7, tolerance: 1e-6 });
    let (mut sum, mut most, mut count) = (0.0, 0.0f64, 0.0);
    for step in 0..400 {
        let y = (f64::from(step) - 199.5) / 200.0 * 14.1 * 0.5f64.sqrt();
        let azimuth = 20f64.to_radians();
        let direction = DVec3::new(azimuth.cos(), 0.0, azimuth.sin());
        let (leaves, _) =
            tracer.trace(&launch(DVec3::new(0.0, y, 0.0) - direction * 100.0, direction));
        let back: f64 =
            leaves.iter().filter(|leaf| leaf.direction.x < 1e-9).map(|leaf| leaf.power[0]).sum();
        sum += back;
        most = most.max(back);
        count += 1.0;
    }
    assert!((sum / count - 0.022).abs() < 0.0005, "{}", sum / count);
    assert!((most - 0.032).abs() < 0.0005, "{most}");
}

#[test]
fn a_tree_too_large_to_follow_keeps_its_strong_leaves() {
    // Light that runs almost along the cloak is split ten thousands of times before it has left.
    let assembly = assembly("negative");
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-3, tolerance: 1e-6 });
    let mut deep = Tracer::new(&assembly, Limits { min_power: 1e-8, tolerance: 1e-6 });
    let mut cut = 0;
    for n in 1..5 {
        let n = f64::from(n);
        let direction = DVec3::new((n * 0.618).cos(), (n * 0.618).sin(), 10.0).normalize();
        let there =
            launch(DVec3::new((n * 0.755).cos() * 5.0, 2.0, 0.0) - direction * 400.0, direction);
        let (leaves, outcome) = deep.trace(&there);
        cut += usize::from(outcome.stats.endless > 0);
        let found: Vec<u64> = leaves.iter().map(|leaf| leaf.path).collect();
        for leaf in tracer.trace(&there).0 {
            assert!(found.contains(&leaf.path), "{n}: {leaf:?}");
        }
        assert!(outcome.pruned[0] < 0.1, "{n}: {outcome:?}");
    }
    assert!(cut > 0, "no tree was too large");
}
