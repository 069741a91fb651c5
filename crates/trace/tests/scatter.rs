//! Rays for renderers of others: what is drawn is what there is, wherever the devices stand.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom_trace::assembly::{Assembly, Placed};
use cloakroom_trace::device::{
    Device, DoubleGaussianCloak, InvisibleSphere, Request, SegmentMaterial, SphereCloak,
    SquareCloak,
};
use cloakroom_trace::walk::{
    Launch, LeafTable, Limits, Placement, RayStatus, ScatterRay, Scattered, Stopped, Tracer,
    scatter,
};
use glam::{DMat3, DVec3};
use optics::geometry::Pose;
use optics::wave::transverse_basis;
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

#[test]
fn leaves_are_drawn_by_their_power() {
    let assembly = alone(&crystal());
    let launch = launch(DVec3::new(-60.0, 4.0, 3.0), DVec3::new(60.0, -3.0, 20.0));
    let draws = 20_000;
    let draw = |number: usize| Some((number as f64 + 0.5) / draws as f64);
    let ray = |number: usize| ScatterRay { launch, draw: draw(number) };
    let drawn = scattered(&assembly, &Placement::default(), draws, ray);
    let mut tracer = Tracer::<2>::new(&assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(&launch);
    let pruned = 0.5 * (outcome.pruned[0] + outcome.pruned[1]);
    let whole = 1.0 - pruned;
    let mut seen = 0.0;
    for leaf in leaves {
        let share = leaf.total_power() / 2.0 / whole;
        let of_leaf = |row: &&Scattered| row.path == leaf.path;
        let count = drawn.iter().filter(of_leaf).count();
        // Numbers that are evenly spaced miss a share by one at each of its ends.
        assert!((count as f64 - share * draws as f64).abs() <= 2.0, "{count} of {share}");
        for row in drawn.iter().filter(of_leaf) {
            assert!((row.probability - share).abs() < 1e-12);
            // In calcite nothing is absorbed: what was pruned is weighed with the rest.
            assert!((row.weight - 1.0).abs() < 1e-9, "{}", row.weight);
            assert_eq!(row.pruned, pruned);
        }
        seen += count as f64;
    }
    assert_eq!(seen, draws as f64);
    assert!(leaves.len() > 3);
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
