//! Paths of rays, leaves that are drawn, and tables of several polarizations.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::numbers::Numbers;
use cloakroom_trace::assembly::{Assembly, Placed};
use cloakroom_trace::device::{Device, Request, SegmentMaterial, SquareCloak};
use cloakroom_trace::walk::{Launch, LeafTable, Limits, Line, RaySettings, Stopped, Tracer, lines};
use glam::DVec3;
use optics::geometry::Pose;
use optics::wave::transverse_basis;
use std::sync::atomic::AtomicBool;

const LIMITS: Limits = Limits { min_power: 1e-5, tolerance: 1e-9 };
const REACH: f64 = 20.0;

/// A birefringent cloak, turned: trees of many branches.
fn assembly() -> Assembly {
    let material = SegmentMaterial::NegativeUniaxial;
    let cloak = SquareCloak { material, ..SquareCloak::default() };
    let structure = cloak.build(Request::default()).unwrap();
    Assembly::new(vec![Placed::new(Pose::new(DVec3::ZERO, 0.2), structure)])
}

fn launches(count: usize) -> Vec<Launch<2>> {
    let mut numbers = Numbers(5);
    let mut within = |most: f64| most * numbers.next();
    let mut launch = || {
        let origin = DVec3::new(-30.0, within(9.0), within(9.0));
        let sideways = DVec3::new(0.0, within(0.2), within(0.2));
        let direction = (DVec3::X + sideways).normalize();
        let (horizontal, vertical) = transverse_basis(direction, DVec3::Z, DVec3::X);
        Launch { origin, direction, electric: [horizontal.into(), vertical.into()] }
    };
    (0..count).map(|_| launch()).collect()
}

fn table<const N: usize>(settings: impl Into<RaySettings>, launches: &[Launch<N>]) -> LeafTable<N> {
    let launch = |ray: usize| Ok::<_, Stopped>(launches[ray]);
    let stop = AtomicBool::new(false);
    LeafTable::trace(&assembly(), settings, launches.len(), &launch, &|_| {}, &stop).unwrap()
}

#[test]
fn pieces_go_on_where_their_parents_end_and_lead_to_the_leaves() {
    let launches = launches(150);
    let with_paths = RaySettings { paths: Some(REACH), ..LIMITS.into() };
    let mut traced = table(with_paths, &launches);
    let paths = traced.paths.take().unwrap();
    // The leaves are those without paths.
    assert_eq!(format!("{traced:?}"), format!("{:?}", table(LIMITS, &launches)));
    assert!(traced.ray.len() > 600);
    let ends = |piece: usize| {
        let [from, to] = [paths.start[piece], paths.start[piece + 1] - 1].map(|at| at as usize);
        [from, to].map(|at| (DVec3::from_array(paths.vertex[at]), paths.optical_path[at]))
    };
    let mut handed_on = vec![0.0; paths.ray.len()];
    let mut found = vec![false; traced.ray.len()];
    for piece in 0..paths.ray.len() {
        let [from, to] = ends(piece);
        match usize::try_from(paths.parent[piece]) {
            Ok(parent) => {
                let [_, end] = ends(parent);
                assert!(from.0.distance(end.0) < 1e-9 && (from.1 - end.1).abs() < 1e-9);
                assert_eq!(paths.ray[parent], paths.ray[piece]);
                handed_on[parent] += paths.power[piece][0];
            }
            Err(_) => assert_eq!(from.0, launches[paths.ray[piece] as usize].origin),
        }
        if let Ok(leaf) = usize::try_from(paths.leaf[piece]) {
            assert!(!std::mem::replace(&mut found[leaf], true));
            assert_eq!(
                (traced.ray[leaf], traced.power[leaf]),
                (paths.ray[piece], paths.power[piece])
            );
            let way = to.0 - from.0;
            assert!(way.distance(DVec3::from_array(traced.direction[leaf]) * REACH) < 1e-9);
        }
    }
    assert!(found.iter().all(|found| *found));
    for (handed_on, power) in handed_on.iter().zip(&paths.power) {
        assert!(*handed_on <= power[0] + 1e-12);
    }
    // Lines to be drawn are the same pieces.
    let drawn: usize =
        launches.iter().map(|ray| lines(&assembly(), LIMITS, ray, [0.5; 2], REACH).len()).sum();
    assert_eq!(drawn, paths.ray.len());
}

#[test]
fn each_polarization_of_a_table_is_that_alone() {
    let launches = launches(100);
    let both = table(LIMITS, &launches);
    for i in 0..2 {
        let alone: Vec<Launch<1>> = (launches.iter())
            .map(|ray| Launch {
                origin: ray.origin,
                direction: ray.direction,
                electric: [ray.electric[i]],
            })
            .collect();
        let alone = table(LIMITS, &alone);
        for ray in 0..100 {
            // What the other polarization keeps alive was pruned there.
            let lost = |pruned: f64, delivered: f64, absorbed: f64| {
                assert!((pruned + delivered + absorbed - 1.0).abs() < 1e-9);
            };
            let of = |numbers: &[u32], power: &dyn Fn(usize) -> f64| -> f64 {
                let leaves = numbers.iter().enumerate().filter(|(_, of)| **of as usize == ray);
                leaves.map(|(leaf, _)| power(leaf)).sum()
            };
            let delivered = of(&both.ray, &|leaf| both.power[leaf][i]);
            let delivered_alone = of(&alone.ray, &|leaf| alone.power[leaf][0]);
            lost(both.pruned[ray][i], delivered, both.absorbed[ray][i]);
            lost(alone.pruned[ray][0], delivered_alone, alone.absorbed[ray][0]);
            assert!((delivered - delivered_alone).abs() <= alone.pruned[ray][0] + 1e-9);
        }
    }
}

#[test]
fn leaves_are_drawn_by_their_power() {
    let many = vec![launches(1)[0]; 20_000];
    let all = table(LIMITS, &many[..1]);
    let pick = |seed| table(RaySettings { pick: Some(seed), ..LIMITS.into() }, &many);
    let drawn = pick(1);
    assert_eq!(format!("{drawn:?}"), format!("{:?}", pick(1)));
    assert_ne!(drawn.optical_path, pick(2).optical_path);
    // One leaf a ray at most.
    assert!(drawn.ray.windows(2).all(|pair| pair[0] < pair[1]));
    // Several leaves may have one path.
    for path in &all.optical_path {
        let same = |other: &f64| (other - path).abs() < 1e-9;
        let paths = all.optical_path.iter().zip(&all.power);
        let share: f64 = paths.filter(|(p, _)| same(p)).map(|(_, p)| 0.5 * (p[0] + p[1])).sum();
        let count = drawn.optical_path.iter().filter(|path| same(path)).count();
        let drawn = count as f64 / 20_000.0;
        assert!((drawn - share).abs() < 6.0 * (share / 20_000.0).sqrt() + 1e-4, "{drawn} {share}");
    }
}

#[test]
fn pieces_know_when_light_comes_and_no_pulse_is_faster_than_light() {
    let assembly = assembly();
    let mut tracer = Tracer::new(&assembly, LIMITS).with_group_delays();
    for launch in launches(60) {
        let (leaves, _) = tracer.trace(&launch);
        let drawn = lines(&assembly, LIMITS, &launch, [0.5; 2], REACH);
        let (away, inner): (Vec<_>, Vec<_>) = drawn.iter().partition(|line| line.leaves);
        assert_eq!(away.len(), leaves.len());
        for (line, leaf) in away.iter().zip(leaves) {
            assert_eq!((line.branch, line.times[0]), (leaf.path, leaf.time()));
            assert_eq!(line.times[0].pulse, leaf.group_path.unwrap());
        }
        for line in &drawn {
            assert_eq!(line.times.len(), line.points.len());
            for (ends, times) in line.points.windows(2).zip(line.times.windows(2)) {
                let way = ends[0].position.distance(ends[1].position);
                assert!(times[1].pulse - times[0].pulse > way - 1e-9, "{line:?}");
            }
            // It begins when another comes to its end, or at the origin.
            let start = line.times[0];
            let ends = |other: &&&Line| {
                let end = other.times.last().unwrap();
                (end.pulse - start.pulse).abs() < 1e-9 && (end.phase - start.phase).abs() < 1e-9
            };
            assert!(start.pulse == 0.0 || inner.iter().find(ends).is_some(), "{line:?}");
        }
    }
}
