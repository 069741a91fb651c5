//! Scenes in any pose: turned as a whole they look the same, and what stands across others works as
//! it does alone.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::pictures::picture;
use crate::rays::{Numbers, assembly, launch, placed, refusal};
use cloakroom::output::Samples;
use cloakroom::trace::{Limits, Tracer};
use glam::{DMat3, DVec3};
use optics::geometry::Pose;
use std::f64::consts::TAU;
use toml::{Table, Value};

const LIMITS: Limits = Limits { min_power: 1e-6, tolerance: 1e-9 };

fn number(value: &Value) -> f64 {
    value.as_float().or(value.as_integer().map(|whole| whole as f64)).unwrap()
}

/// A vector of a table of a scene.
fn vector(table: &Table, key: &str, default: DVec3) -> DVec3 {
    let of = |value: &Value| DVec3::from_array(std::array::from_fn(|i| number(&value[i])));
    table.get(key).map_or(default, of)
}

/// A scene with the whole of it turned by a rotation about the origin.
fn turned(scene: &str, turn: &DMat3) -> String {
    let mut scene: Table = scene.parse().unwrap();
    for (name, defaults) in [
        (
            "camera",
            [("position", DVec3::X * -100.0), ("target", DVec3::X * 50.0), ("up", DVec3::Y)],
        ),
        ("photograph", [("position", DVec3::X * 50.0), ("normal", DVec3::NEG_X), ("up", DVec3::Y)]),
    ] {
        let table = scene.entry(name).or_insert(Table::new().into()).as_table_mut().unwrap();
        for (key, default) in defaults {
            let vector = *turn * vector(table, key, default);
            table.insert(key.to_owned(), vector.to_array().to_vec().into());
        }
    }
    for device in scene["device"].as_array_mut().unwrap() {
        let device = device.as_table_mut().unwrap();
        let rotation = device.get("rotation").map_or(0.0, number).to_radians();
        let axis = vector(device, "axis", DVec3::Z);
        let own = Pose::with_axis(DVec3::ZERO, rotation, axis).rotation();
        let position = *turn * vector(device, "position", DVec3::ZERO);
        let pose: Table = placed(position, &(*turn * own)).parse().unwrap();
        device.extend(pose);
    }
    scene.to_string()
}

/// A scene, seen by a camera with few pixels, in the dark: an image of surroundings is not turned.
fn few_pixels(scene: &str) -> String {
    let mut scene: Table = scene.parse().unwrap();
    scene.remove("surroundings");
    let camera = scene.entry("camera").or_insert(Table::new().into()).as_table_mut().unwrap();
    camera.insert("resolution".to_owned(), vec![96, 72].into());
    camera.insert("samples".to_owned(), 1.into());
    scene.to_string()
}

#[test]
fn a_scene_that_is_turned_as_a_whole_looks_the_same() {
    const VIEW: &str = "[camera]\nposition = [-90, 8, 5]\n[photograph]\nposition = [45, 1, 2]\n\
                        normal = [-1, 0.2, 0.1]\nup = [0.1, 1, 0]\n";
    let cases = [
        "[[device]]\nkind = \"square-cloak\"\nmaterial = \"negative-uniaxial\"\nrotation = 10\n",
        "[[device]]\nkind = \"double-gaussian-cloak\"\nlength = 40\nrotation = 5\n",
        "[[device]]\nkind = \"cylinder-cloak\"\nmaterial = \"azimuthal-uniaxial\"\nposition = [0, 1, 0]\n",
        "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [9, 12, 15]\nposition = [0, 3, -9]\nrotation = 20\n\
         permittivity = [[2.2, 0.1, 0], [0.1, 2.5, 0], [0, 0, 1.8]]\n\
         [[device]]\nkind = \"body\"\nshape = \"cylinder\"\nradius = 3\nlength = 14\n\
         position = [-5, -4, 9]\nsurface = { color = [0.1, 0.5, 0.2] }\n",
    ];
    let gallery = [
        include_str!("../../../scenes/gallery/crossed-cloaks.toml"),
        include_str!("../../../scenes/gallery/tilted-box.toml"),
        include_str!("../../../scenes/gallery/standing-cylinder-cloak.toml"),
        include_str!("../../../scenes/gallery/carpet-in-glass.toml"),
    ];
    let scenes = cases.iter().map(|case| VIEW.to_owned() + case);
    let mut numbers = Numbers(11);
    for (number, scene) in scenes.chain(gallery.map(String::from)).enumerate() {
        let scene = few_pixels(&scene);
        let turn = Pose::with_axis(DVec3::ZERO, TAU * numbers.next(), numbers.direction());
        let upright = picture(&scene);
        let turned = picture(&turned(&scene, &turn.rotation()));
        let pixels = upright.width * upright.height;
        for (one, other) in upright.channels.iter().zip(&turned.channels) {
            let (Samples::F32(a), Samples::F32(b)) = (&one.samples, &other.samples) else {
                continue;
            };
            let same = |a: f32, b: f32| {
                (a - b).abs() < 1e-4 * (1.0 + a.abs()) || a.is_nan() == b.is_nan() && a.is_nan()
            };
            let off = a.iter().zip(b).filter(|(a, b)| !same(**a, **b)).count();
            // Rays that meet an edge, or a seam of the filter's blocks, may fall on either side of
            // it.
            assert!(off * 200 < pixels, "{number} {}: {off} of {pixels} pixels", one.name);
        }
    }
}

#[test]
fn both_sides_of_a_photograph_are_upright_and_unmirrored() {
    let seen = |x: f64, normal: &str| {
        let text = format!(
            "[camera]\nposition = [{x:?}, 0, 0]\ntarget = [0, 0, 0]\nresolution = [32, 24]\nsamples = 1\n\
             [photograph]\nposition = [0, 0, 0]\nnormal = {normal}\n"
        );
        picture(&text)
    };
    let front = seen(-100.0, "[-1, 0, 0]");
    for (x, normal) in [(100.0, "[-1, 0, 0]"), (-100.0, "[3, 0, 0]"), (100.0, "[1e-200, 0, 0]")] {
        let other = seen(x, normal);
        for (a, b) in front.channels.iter().zip(&other.channels).take(3) {
            assert_eq!(a.samples, b.samples, "{x} {normal} {}", a.name);
        }
    }
}

#[test]
fn crossed_cloaks_are_as_nothing_to_each_other() {
    let crossed = assembly(include_str!("../../../scenes/gallery/crossed-cloaks.toml"));
    let mut tracer = Tracer::new(&crossed, LIMITS);
    let mut numbers = Numbers(12);
    let mut met = [0; 2];
    for _ in 0..400 {
        let at = 24.0 * (DVec3::new(0.0, numbers.next(), numbers.next()) - 0.5).with_x(0.0);
        let ray = launch(at - DVec3::X * 100.0, DVec3::X);
        let (leaves, outcome) = tracer.trace(&ray);
        outcome.assert_balanced(leaves, 1e-9, &ray);
        for (device, beside) in [(0, at.y), (1, at.z)] {
            met[device] += u32::from(beside.abs() < 9.9);
        }
        assert_eq!(leaves.len(), 1, "{at}");
        let leaf = leaves[0];
        assert!(leaf.direction.distance(DVec3::X) < 1e-10, "{at} {leaf:?}");
        assert!(leaf.position.with_x(0.0).distance(at) < 1e-9, "{at} {leaf:?}");
        assert!(leaf.power.iter().all(|power| (power - 1.0).abs() < 1e-9));
        // As late as in air.
        let way = (leaf.position - ray.origin).x;
        assert!((leaf.optical_path - way).abs() < 1e-9 || !leaf.met_device, "{at} {leaf:?}");
    }
    assert!(met.iter().all(|met| *met > 100), "{met:?}");
}

#[test]
fn a_standing_cylinder_cloak_is_not_seen_from_the_side() {
    let cloak = assembly(include_str!("../../../scenes/gallery/standing-cylinder-cloak.toml"));
    let mut tracer = Tracer::new(&cloak, LIMITS);
    let mut numbers = Numbers(13);
    let mut met = 0;
    for _ in 0..400 {
        // Level enough to come and to go through the side.
        let angle = TAU * numbers.next();
        let direction =
            DVec3::new(angle.cos(), 0.3 * (numbers.next() - 0.5), angle.sin()).normalize();
        let across = direction.cross(DVec3::Y).normalize();
        let at = across * 24.0 * (numbers.next() - 0.5) + DVec3::Y * 8.0 * (numbers.next() - 0.5);
        let ray = launch(at - direction * 60.0, direction);
        let (leaves, outcome) = tracer.trace(&ray);
        outcome.assert_balanced(leaves, 1e-9, &ray);
        assert_eq!(leaves.len(), 1, "{ray:?}");
        let leaf = leaves[0];
        met += u32::from(leaf.met_device);
        assert!(leaf.direction.distance(direction) < 1e-9, "{ray:?} {leaf:?}");
        assert!((leaf.position - at).reject_from(direction).length() < 1e-8, "{ray:?} {leaf:?}");
    }
    assert!(met > 250, "{met}");
}

#[test]
fn light_leaves_a_tilted_box_parallel_to_itself_and_beside_itself() {
    const HALF: f64 = 9.0;
    let glass = assembly(include_str!("../../../scenes/gallery/tilted-box.toml"));
    let pose = Pose::with_axis(DVec3::ZERO, 20f64.to_radians(), DVec3::new(1.0, 2.0, 2.0));
    let mut tracer = Tracer::new(&glass, LIMITS);
    let mut numbers = Numbers(14);
    for _ in 0..400 {
        // Onto the upper end, steep enough to leave through the lower one.
        let entry =
            DVec3::new(numbers.next() - 0.5, numbers.next() - 0.5, 0.0) * 8.0 + DVec3::Z * HALF;
        let down = (DVec3::new(numbers.next() - 0.5, numbers.next() - 0.5, 0.0) * 0.6 - DVec3::Z)
            .normalize();
        let ray = launch(pose.to_world(entry - down * 30.0), pose.vector_to_world(down));
        // Snell's law for the way through.
        let inner = down.with_z(0.0) / 1.5;
        let inner = inner - DVec3::Z * (1.0 - inner.length_squared()).sqrt();
        let exit = entry + inner * (2.0 * HALF / -inner.z);
        assert!(exit.truncate().abs().max_element() < HALF);
        let (leaves, outcome) = tracer.trace(&ray);
        outcome.assert_balanced(leaves, 1e-9, &ray);
        let strongest = leaves.iter().max_by(|a, b| a.power[0].total_cmp(&b.power[0])).unwrap();
        assert!(strongest.direction.distance(ray.direction) < 1e-12, "{ray:?}");
        assert!(strongest.position.distance(pose.to_world(exit)) < 1e-11, "{ray:?}");
        let path = 30.0 + 1.5 * exit.distance(entry);
        assert!((strongest.optical_path - path).abs() < 1e-11, "{ray:?}");
    }
}

#[test]
fn tilted_devices_that_are_in_each_others_way_are_found() {
    let cloak = |more: &str| format!("[[device]]\nkind = \"square-cloak\"\n{more}\n");
    let first = cloak("position = [-12, 0, 0]");
    // The diagonal of a square cloak is 19.94 cm: 24 cm apart they are free of each other, 18 cm
    // apart not.
    let second = |x: f64| cloak(&format!("position = [{x:?}, 0, 0]\naxis = [0, 1, 0]"));
    assembly(&(first.clone() + &second(12.0)));
    let message = refusal(&(first + &second(6.0)));
    assert!(message.contains("device 1 overlaps device 0"), "{message}");
    let photograph = "[photograph]\nposition = [0, 0, 20]\nnormal = [0, 0, -1]\n";
    let loaded = cloakroom::scene_file::parse(
        &format!("{photograph}{}", cloak("")),
        "test",
        std::path::Path::new(""),
        &[],
    )
    .unwrap();
    let error = cloakroom::render::PreparedScene::new(&loaded.scene).unwrap_err();
    assert!(error.to_string().contains("cuts through the photograph"), "{error}");
}

#[test]
fn what_is_no_pose_is_refused_with_its_place() {
    for (text, expected) in [
        (
            "[[device]]\nkind = \"square-cloak\"\naxis = [0, 0, 0]\n",
            "axis is [0, 0, 0]; it must be a direction",
        ),
        (
            "[[device]]\nkind = \"square-cloak\"\naxis = [0, 1]\n",
            "axis is [0, 1]; it must be three numbers",
        ),
        ("[photograph]\nx = 40\nposition = [40, 0, 0]\n", "x and position are both given"),
        ("[photograph]\nnormal = [0, 0, 0]\n", "normal is [0, 0, 0]; it must be a direction"),
        ("[photograph]\nup = [0, 0, 0]\n", "up is [0, 0, 0]; it must be a direction"),
        ("[photograph]\nnormal = [0, 2, 0]\n", "up is [0, 1, 0], along the normal"),
    ] {
        let message = refusal(text);
        assert!(message.contains(expected), "{message}");
        assert!(message.contains("test:"), "{message}");
    }
}
