//! Devices in any pose: rays through a tilted device are the turned rays through the upright one.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test may panic, and say why")]

use crate::numbers::Numbers;
use cloakroom_trace::assembly::{Assembly, Placed, Screen};
use cloakroom_trace::device::{AnyDevice, CATALOGUE, Entry, Request, Show, Structure, entry};
use cloakroom_trace::keys::Value;
use cloakroom_trace::walk::{Launch, Leaf, LeafEnd, Limits, Outcome, Tracer};
use glam::DVec3;
use optics::geometry::Pose;
use optics::wave::{ComplexVector, transverse_basis};

const LIMITS: Limits = Limits { min_power: 1e-6, tolerance: 1e-12 };

/// What a kind needs to be something, its media of low index so that boxes cannot trap light.
fn device(entry: &Entry) -> AnyDevice {
    let mut device = (entry.device)();
    let table = |pairs: &[(&str, Value)]| {
        Value::Table(
            pairs.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect(),
        )
    };
    let tensor = [[1.3, 0.05, 0.02], [0.05, 1.4, 0.0], [0.02, 0.0, 1.2]];
    match entry.kind {
        "body" => {
            device.table_mut().set("shape", Value::from("box")).unwrap();
            device.table_mut().set("permittivity", Value::from(tensor)).unwrap();
        }
        "prisms" => {
            let step =
                [[-8.0, -6.0], [4.0, -6.0], [4.0, 0.0], [-2.0, 0.0], [-2.0, 7.0], [-8.0, 7.0]];
            let metal = [[-2.0, 0.0], [1.0, 0.0], [1.0, 5.0], [-2.0, 5.0]];
            let medium = table(&[("corners", step.into()), ("permittivity", tensor.into())]);
            let metal = table(&[("corners", metal.into()), ("metal", true.into())]);
            device.table_mut().set("prism", Value::List(vec![medium, metal])).unwrap();
        }
        "graded" => {
            device.table_mut().set("width", Value::from(24.0)).unwrap();
            device.table_mut().set("height", Value::from(20.0)).unwrap();
            let rows = [
                [1.02, 1.05, 0.98, 1.04, 1.01],
                [1.10, 1.15, 1.12, 1.03, 0.97],
                [1.08, 1.12, 1.10, 1.11, 1.06],
                [0.95, 1.07, 1.14, 1.18, 1.02],
                [1.00, 1.02, 1.05, 1.09, 1.10],
            ];
            device.table_mut().set("index", Value::from(rows)).unwrap();
        }
        _ => {}
    }
    device
}

/// Every kind of device in every view that it has, endless and short.
fn structures() -> Vec<(String, Structure)> {
    let views = [Show::Cloak, Show::Bare, Show::Mirror];
    let lengths = [None, Some(18.0)];
    let requests = views.into_iter().flat_map(|show| lengths.map(|length| (show, length)));
    let requests: Vec<_> = requests.collect();
    CATALOGUE
        .iter()
        .flat_map(|entry| requests.iter().map(move |request| (*entry, *request)))
        .filter_map(|(entry, (show, length))| {
            let request = Request { show, length, ..Request::default() };
            let structure = device(entry).build(request).ok()?;
            Some((format!("{} {show:?} {length:?}", entry.kind), structure))
        })
        .collect()
}

fn turned(launch: &Launch<2>, pose: &Pose) -> Launch<2> {
    Launch {
        origin: pose.to_world(launch.origin),
        direction: pose.vector_to_world(launch.direction),
        electric: launch.electric.map(|field| pose.field_to_world(field)),
    }
}

fn traced(assembly: &Assembly, launch: &Launch<2>) -> (Vec<Leaf<2>>, Outcome<2>) {
    let mut tracer = Tracer::new(assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(launch);
    (leaves.to_vec(), *outcome)
}

fn launch(numbers: &mut Numbers) -> Launch<2> {
    let origin = 60.0 * numbers.vector().normalize();
    let direction = (numbers.vector() * 12.0 - origin).normalize();
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [h.into(), v.into()] }
}

#[test]
fn rays_through_a_tilted_device_are_turned_rays_through_an_upright_one() {
    /// What happens within this of the threshold may fall on either side of it.
    const STRONG: f64 = 1.01 * LIMITS.min_power;
    let mut numbers = Numbers(1);
    let (mut compared, mut apart) = (0, 0);
    for (name, structure) in structures() {
        let assembly = |pose| Assembly::new(vec![Placed::new(pose, structure.clone())]);
        let upright = assembly(Pose::IDENTITY);
        let mut met = 0;
        for n in 0..60 {
            let axes = [DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z];
            let pose = match axes.get(n) {
                Some(axis) => Pose::with_axis(numbers.vector(), 0.65, *axis),
                None => numbers.pose(),
            };
            let tilted = assembly(pose);
            let launch = launch(&mut numbers);
            if tilted.device_containing(pose.to_world(launch.origin)).is_some() {
                continue;
            }
            let (expected, outcome) = traced(&upright, &launch);
            let (found, same) = traced(&tilted, &turned(&launch, &pose));
            assert_eq!(outcome.stats.lost + same.stats.lost, 0, "{name} {pose:?} {launch:?}");
            met += u32::from(expected.iter().any(|leaf| leaf.met_device));
            for leaf in expected.iter().filter(|leaf| leaf.power[0].max(leaf.power[1]) > STRONG) {
                compared += 1;
                // Weak leaves have been through the device three times or more, and what rounding
                // has changed has grown. In an index of one's own rays are followed by steps that
                // it changes, too.
                let weak = leaf.power[0].max(leaf.power[1]) < 1e-2;
                let off = if name.starts_with("graded") {
                    1e-6
                } else if weak {
                    1e-8
                } else {
                    1e-9
                };
                let near = |other: &&Leaf<2>| {
                    let back = |v: DVec3| pose.vector_to_local(v);
                    let field = |a: &ComplexVector, b: &ComplexVector| {
                        (pose.field_to_local(*b) - *a).norm_squared() < 100.0 * off * off
                    };
                    other.path == leaf.path
                        && pose.to_local(other.position).distance(leaf.position) < off
                        && back(other.direction).distance(leaf.direction) < off
                        && (0..2).all(|i| (other.power[i] - leaf.power[i]).abs() < off)
                        && (0..2).all(|i| field(&leaf.electric[i], &other.electric[i]))
                        && (other.optical_path - leaf.optical_path).abs() < off
                };
                if !found.iter().any(|other| near(&other)) {
                    apart += 1;
                    println!("{name} {pose:?} {launch:?}\n{leaf:?}\n{found:?}");
                }
            }
        }
        let nothing = name.contains("Mirror");
        assert!(met > 1 || nothing, "{name}: {met} rays meet it");
    }
    assert!(compared > 3000 && apart == 0, "{apart} of {compared}");
}

#[test]
fn a_photograph_in_any_pose_is_met_where_it_is() {
    let mut numbers = Numbers(2);
    let cloak = entry("square-cloak").unwrap();
    let assembly = |pose| {
        let structure = device(cloak).build(Request::default()).unwrap();
        Assembly::new(vec![Placed::new(pose, structure)])
    };
    let at = Pose::new(DVec3::X * 3.0, 0.0);
    let upright = Screen::new(&at, 8.0, 5.0);
    let mut hits = 0;
    for _ in 0..300 {
        let pose = numbers.pose();
        let screen = Screen::new(&pose.after(&at), 8.0, 5.0);
        let launch = launch(&mut numbers);
        let other = turned(&launch, &pose);
        let expected = upright.hit(launch.origin, launch.direction, 0.0);
        let found = screen.hit(other.origin, other.direction, 0.0);
        assert_eq!(expected.is_some(), found.is_some(), "{pose:?} {launch:?}");
        if let (Some(expected), Some(found)) = (expected, found) {
            hits += 1;
            assert!((expected - found).abs() < 1e-12 * (1.0 + expected.abs()) * 100.0);
            let [a, b] = [(&upright, &launch, expected), (&screen, &other, found)].map(
                |(screen, launch, distance)| {
                    let at = launch.origin + launch.direction * distance;
                    assert!(screen.foot(at).distance(at) < 1e-10);
                    screen.image_position(launch.direction)(at)
                },
            );
            assert!((0..2).all(|i| (a[i] - b[i]).abs() < 1e-11), "{a:?} {b:?}");
            // A ray that has passed it by rounding still meets it where that is asked for.
            let past = other.origin + other.direction * (found + 1e-7);
            assert!(screen.hit(past, other.direction, 0.0).is_none());
            assert!(screen.hit(past, other.direction, -1e-6).is_some_and(|t| t < 0.0));
        }
        let (beside, through) = (Pose::new(DVec3::X * 30.0, 0.0), Pose::IDENTITY);
        assert_eq!(screen.cut_by(&assembly(pose.after(&beside))), None);
        assert_eq!(screen.cut_by(&assembly(pose.after(&through))), Some(0), "{pose:?}");
    }
    assert!(hits > 40, "{hits}");
}

#[test]
fn leaves_on_a_tilted_opaque_body_end_on_it() {
    let ball = entry("body").unwrap();
    let mut device = (ball.device)();
    device.table_mut().set("shape", Value::from("cylinder")).unwrap();
    device.table_mut().set("radius", Value::from(4.0)).unwrap();
    device.table_mut().set("surface", Value::Table(Vec::new())).unwrap();
    let request = Request { length: Some(9.0), ..Request::default() };
    let mut numbers = Numbers(3);
    let mut ended = 0;
    for _ in 0..200 {
        let pose = numbers.pose();
        let structure = device.build(request).unwrap();
        let assembly = Assembly::new(vec![Placed::new(pose, structure)]);
        let launch = turned(&launch(&mut numbers), &pose);
        let (leaves, _) = traced(&assembly, &launch);
        for leaf in leaves.iter().filter(|leaf| leaf.end == LeafEnd::Body(0)) {
            ended += 1;
            let at = pose.to_local(leaf.position);
            let off = (at.truncate().length() - 4.0).max(at.z.abs() - 4.5);
            assert!(off.abs() < 1e-12, "{at}");
        }
    }
    assert!(ended > 20, "{ended}");
}
