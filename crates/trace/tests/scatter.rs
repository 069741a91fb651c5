//! Rays for renderers of others: what is drawn is what there is, wherever the devices stand.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may panic, and say why")]

use cloakroom_trace::assembly::{Assembly, Placed};
use cloakroom_trace::device::{
    Device, DoubleGaussianCloak, InvisibleSphere, Request, SegmentMaterial, SphereCloak,
    SquareCloak, entry,
};
use cloakroom_trace::keys::Value;
use cloakroom_trace::split_mix::mix;
use cloakroom_trace::walk::{
    Launch, LeafTable, Limits, Placement, RayStatus, ScatterRay, Scattered, Stopped, Tracer,
    scatter,
};
use glam::{DMat3, DVec3};
use optics::geometry::Pose;
use optics::wave::transverse_basis;
use std::collections::HashMap;
use std::sync::atomic::AtomicBool;

const LIMITS: Limits = Limits { min_power: 1e-6, tolerance: 1e-6 };

fn alone(device: &impl Device) -> Assembly {
    let structure = device.build(Request::default()).unwrap();
    Assembly::new(vec![Placed::new(Pose::IDENTITY, structure)])
}

fn crystal() -> SquareCloak {
    let material = SegmentMaterial::NegativeUniaxial;
    SquareCloak { material, ..SquareCloak::default() }
}

fn launch(origin: DVec3, direction: DVec3) -> Launch<2> {
    let direction = direction.normalize();
    let (horizontal, vertical) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [horizontal.into(), vertical.into()] }
}

/// Rays from in front, some of which miss.
fn fan(number: usize) -> Launch<2> {
    let part = |stride: usize, size: usize| (number * stride % size) as f64 / size as f64 - 0.5;
    launch(DVec3::new(-60.0, 3.0, 5.0), DVec3::new(60.0, 40.0 * part(17, 101), 30.0 * part(29, 71)))
}

fn scattered(
    assembly: &Assembly,
    placement: &Placement,
    count: usize,
    ray: impl Fn(usize) -> ScatterRay + Sync,
) -> Vec<Scattered> {
    let stop = AtomicBool::new(false);
    scatter(assembly, LIMITS, placement, count, &ray, &|_| {}, &stop).unwrap()
}

#[test]
fn all_leaves_are_those_of_the_tracer() {
    let mut missed = 0;
    for assembly in [alone(&crystal()), alone(&DoubleGaussianCloak::default())] {
        let count = 300;
        let whole = |number: usize| ScatterRay { launch: fan(number), draw: None };
        let rows = scattered(&assembly, &Placement::default(), count, whole);
        let launched = |number: usize| Ok::<_, Stopped>(fan(number));
        let stop = AtomicBool::new(false);
        let table = LeafTable::<2>::trace(&assembly, LIMITS, count, &launched, &|_| {}, &stop);
        let table = table.unwrap();
        assert_eq!(rows.iter().map(|row| row.ray).collect::<Vec<_>>(), table.ray);
        for (place, row) in rows.iter().enumerate() {
            assert_eq!(row.direction.to_array(), table.direction[place]);
            assert_eq!(row.electric.map(|field| field.components()), table.electric_field[place]);
            match row.status {
                RayStatus::Left => {
                    assert_eq!(row.position.to_array(), table.position[place]);
                    assert_eq!(row.weight, 0.5 * (table.power[place][0] + table.power[place][1]));
                    assert_eq!(row.optical_path, table.optical_path[place]);
                }
                RayStatus::Missed => assert!(table.position[place][0].is_nan() && row.straight),
                other => panic!("{other:?}"),
            }
        }
        missed += rows.iter().filter(|row| row.status == RayStatus::Missed).count();
    }
    assert!(missed > 0);
}

/// A slab of calcite that absorbs a little, its optic axis askew.
fn slab(absorbing: f64) -> Assembly {
    let mut slab = (entry("body").unwrap().device)();
    let tensor = [[2.6, 0.15, 0.1], [0.15, 2.5, 0.05], [0.1, 0.05, 2.3]];
    let entry_at = |row: usize, column: usize| {
        let im = if row == column { absorbing } else { 0.0 };
        Value::List(vec![tensor[row][column].into(), im.into()])
    };
    let complex = [0, 1, 2].map(|row| Value::List([0, 1, 2].map(|at| entry_at(row, at)).to_vec()));
    let table = slab.table_mut();
    table.set("shape", Value::from("slab")).unwrap();
    table.set("permittivity", Value::List(complex.to_vec())).unwrap();
    let structure = slab.build(Request::default()).unwrap();
    Assembly::new(vec![Placed::new(Pose::IDENTITY, structure)])
}

/// A number from 0 to 1 that has nothing to do with its neighbours.
fn hashed(number: usize) -> f64 {
    mix(number as u64 ^ 0x5eed_0000_0000) as f64 / 2_f64.powi(64)
}

/// Leaves that are drawn without their tree are drawn as often as their powers in it say, by Pearson's test at
/// one wrong alarm in a million or so; what was pruned is given to them, and what was absorbed is not.
fn check_against_the_tree(assembly: &Assembly, min_power: f64, launch: Launch<2>, draws: usize) {
    let limits = Limits { min_power, tolerance: 1e-6 };
    let stop = AtomicBool::new(false);
    let ray = |number: usize| ScatterRay { launch, draw: Some(hashed(number)) };
    let place = Placement::default();
    let drawn = scatter(assembly, limits, &place, draws, &ray, &|_| {}, &stop).unwrap();
    assert_eq!(drawn.len(), draws);
    let mut tracer = Tracer::<2>::new(assembly, limits);
    let (leaves, outcome) = tracer.trace(&launch);
    let mean = |of: [f64; 2]| 0.5 * (of[0] + of[1]);
    let (pruned, absorbed) = (mean(outcome.pruned), mean(outcome.absorbed));
    let count = draws as f64;
    // Sums of weights, which are counts where nothing is absorbed.
    let mut of_leaf: HashMap<u64, (f64, f64)> = HashMap::new();
    for row in &drawn {
        let (sum, squares) = of_leaf.entry(row.path).or_default();
        (*sum, *squares) = (*sum + row.weight, *squares + row.weight * row.weight);
        if row.status == RayStatus::Left {
            let leaf = leaves.iter().find(|leaf| leaf.path == row.path).unwrap();
            assert!((row.weight * row.probability - mean(leaf.power)).abs() < 1e-9);
            assert!(row.position.distance(leaf.position) < 1e-9, "{row:?} {leaf:?}");
            assert!(row.direction.distance(leaf.direction) < 1e-9);
            assert!((row.optical_path - leaf.optical_path).abs() < 1e-9);
        }
    }
    let (mut chi, mut bins, mut few) = (0.0, 0.0, (0.0, 0.0));
    for leaf in leaves {
        let share = mean(leaf.power) / (1.0 - pruned);
        let (sum, squares) = of_leaf.get(&leaf.path).copied().unwrap_or_default();
        let weight = if sum > 0.0 { squares / sum } else { 1.0 };
        if share * count < 10.0 * weight {
            few = (few.0 + sum, few.1 + share * count);
            continue;
        }
        chi += (sum - share * count).powi(2) / (share * count * weight);
        bins += 1.0;
    }
    if few.1 > 5.0 {
        chi += (few.0 - few.1).powi(2) / few.1;
        bins += 1.0;
    }
    assert!(chi < bins + 5.0 * (2.0_f64 * bins).sqrt() + 12.0, "{chi} for {bins} bins");
    println!("{} leaves, {bins} bins, chi squared {chi:.1}, pruned {pruned:.1e}", leaves.len());
    let all: f64 = drawn.iter().map(|row| row.weight).sum::<f64>() / count;
    let expected = 1.0 - absorbed / (1.0 - pruned);
    assert!((all - expected).abs() < 1e-9 + 5.0 * (absorbed / count).sqrt(), "{all} {expected}");
    let told: f64 = drawn.iter().map(|row| row.pruned).sum::<f64>() / count;
    assert!((told - pruned).abs() < 1e-9 + 5.0 * (pruned / count).sqrt(), "{told} {pruned}");
}

#[test]
fn leaves_are_drawn_as_the_whole_tree_says() {
    let positive = SegmentMaterial::PositiveUniaxial;
    let positive = SquareCloak { material: positive, ..SquareCloak::default() };
    let aslant = launch(DVec3::new(-60.0, 4.0, 3.0), DVec3::new(60.0, -3.0, 20.0));
    let steep = launch(DVec3::new(-60.0, 2.0, -30.0), DVec3::new(60.0, -1.0, 34.0));
    for min_power in [1e-6, 1e-2] {
        check_against_the_tree(&alone(&positive), min_power, aslant, 4000);
        check_against_the_tree(&alone(&crystal()), min_power, aslant, 4000);
        check_against_the_tree(&alone(&DoubleGaussianCloak::default()), min_power, steep, 4000);
        check_against_the_tree(&slab(0.0), min_power, aslant, 4000);
        check_against_the_tree(&slab(1e-6), min_power, aslant, 4000);
    }
}

#[test]
fn what_is_drawn_depends_on_the_ray_and_its_number_alone() {
    for assembly in [alone(&crystal()), alone(&DoubleGaussianCloak::default())] {
        let ray = |number: usize| ScatterRay { launch: fan(number), draw: Some(hashed(number)) };
        let together = scattered(&assembly, &Placement::default(), 600, ray);
        for (number, row) in together.iter().enumerate().step_by(7) {
            let alone = scattered(&assembly, &Placement::default(), 1, |_| ray(number))[0];
            assert_eq!(Scattered { ray: row.ray, ..alone }, *row);
        }
    }
}

#[test]
fn evenly_spaced_numbers_draw_each_leaf_as_often_as_it_is_to_be() {
    let assembly = alone(&crystal());
    let launch = launch(DVec3::new(-60.0, 4.0, 3.0), DVec3::new(60.0, -3.0, 20.0));
    let draws = 20_000;
    let draw = |number: usize| Some((number as f64 + 0.5) / draws as f64);
    let ray = |number: usize| ScatterRay { launch, draw: draw(number) };
    let drawn = scattered(&assembly, &Placement::default(), draws, ray);
    let mut tracer = Tracer::<2>::new(&assembly, LIMITS);
    let (leaves, _) = tracer.trace(&launch);
    assert!(leaves.len() > 3);
    for leaf in leaves.iter().filter(|leaf| leaf.total_power() > 1e-3) {
        let share = leaf.total_power() / 2.0;
        let of_leaf = |row: &&Scattered| row.path == leaf.path;
        let count = drawn.iter().filter(of_leaf).count();
        assert!((count as f64 - share * draws as f64).abs() <= 3.0, "{count} of {share}");
        // In calcite nothing is absorbed: what was pruned is weighed with the rest.
        assert!(drawn.iter().filter(of_leaf).all(|row| (row.weight - 1.0).abs() < 1e-9));
    }
}

#[test]
fn a_placement_turns_and_scales_what_comes_out() {
    let assembly = alone(&crystal());
    let rotation = DMat3::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 0.7);
    let origin = DVec3::new(31.0, -12.0, 7.0);
    let placement = Placement { pose: Pose::from_rotation(origin, rotation), unit: 100.0 };
    let there = |launch: Launch<2>| Launch {
        origin: (rotation * launch.origin + origin) / 100.0,
        direction: rotation * launch.direction,
        electric: launch.electric.map(|field| placement.pose.field_to_world(field)),
    };
    let count = 200;
    let draw = |number: usize| Some(number as f64 / count as f64);
    let here = scattered(&assembly, &Placement::default(), count, |number| ScatterRay {
        launch: fan(number),
        draw: draw(number),
    });
    let placed = scattered(&assembly, &placement, count, |number| ScatterRay {
        launch: there(fan(number)),
        draw: draw(number),
    });
    for (one, other) in here.iter().zip(&placed) {
        assert_eq!((one.status, one.ray), (other.status, other.ray));
        // Where the drawn number is at the border of two leaves, rounding decides.
        if one.path != other.path {
            continue;
        }
        let position = (rotation * one.position + origin) / 100.0;
        assert!(position.distance(other.position) < 1e-10, "{one:?} {other:?}");
        assert!((rotation * one.direction).distance(other.direction) < 1e-10);
        assert!((one.optical_path / 100.0 - other.optical_path).abs() < 1e-10);
        assert!((one.weight - other.weight).abs() < 1e-10);
        for (one, other) in one.electric.iter().zip(other.electric) {
            let off = placement.pose.field_to_world(*one) - other;
            assert!(off.norm_squared().sqrt() < 1e-9);
        }
    }
    let same = here.iter().zip(&placed).filter(|(one, other)| one.path == other.path).count();
    assert!(same > count - 3);
}

#[test]
fn what_goes_on_along_its_line_is_told() {
    let ray = |number: usize| ScatterRay { launch: fan(number), draw: Some(0.5) };
    for assembly in [alone(&SphereCloak::default()), alone(&InvisibleSphere::default())] {
        for row in scattered(&assembly, &Placement::default(), 500, ray) {
            assert!(row.straight && (row.transmitted - 1.0).abs() < 1e-9, "{row:?}");
        }
    }
    // A cloak that is turned is a mirror: light that meets it does not go on along its line.
    let turned = Pose::new(DVec3::ZERO, 0.4);
    let structure = SquareCloak::default().build(Request::default()).unwrap();
    let assembly = Assembly::new(vec![Placed::new(turned, structure)]);
    let through = launch(DVec3::new(-60.0, 0.0, 0.0), DVec3::X);
    let ray = ScatterRay { launch: through, draw: Some(0.5) };
    let row = scattered(&assembly, &Placement::default(), 1, |_| ray)[0];
    assert!(!row.straight && row.transmitted == 0.0 && row.status == RayStatus::Left);
}

#[test]
fn no_ray_is_an_error() {
    let assembly = alone(&SquareCloak::default());
    let good = launch(DVec3::new(-60.0, 0.0, 0.0), DVec3::X);
    let ray = |launch, draw| ScatterRay { launch, draw };
    let rays = [
        ray(good, Some(0.5)),
        ray(Launch { origin: DVec3::NAN, ..good }, Some(0.5)),
        ray(Launch { direction: DVec3::ZERO, ..good }, None),
        ray(good, Some(1.5)),
        ray(good, Some(f64::NAN)),
        // In the metal.
        ray(Launch { origin: DVec3::ZERO, ..good }, Some(0.5)),
        ray(Launch { origin: DVec3::new(-60.0, 30.0, 0.0), ..good }, Some(0.0)),
        ray(Launch { origin: DVec3::new(-60.0, 3.0, 0.0), ..good }, Some(1.0)),
    ];
    let rows = scattered(&assembly, &Placement::default(), rays.len(), |number| rays[number]);
    use RayStatus::{Left, Missed, Refused};
    let expected = [Left, Refused, Refused, Refused, Refused, Refused, Missed, Left];
    assert_eq!(rows.iter().map(|row| row.status).collect::<Vec<_>>(), expected);
    assert!(rows.iter().filter(|row| row.status == Refused).all(|row| row.weight == 0.0));
}
