//! Plane mirrors, bodies of metal, and mirror floors, against the law of reflection, Fresnel's
//! equations for metals, and the method of images.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::rays::{Numbers, assembly, launch, launches_around, placed, refusal, strongest};
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::DVec3;
use num_complex::Complex64;
use std::fmt::Write;

const LIMITS: Limits = Limits { min_power: 1e-9, tolerance: 1e-9 };

/// Of silver in green light, about.
const INDEX: [f64; 2] = [0.06, 3.6];

fn turned(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

/// The shares that a metal reflects of light whose field is across the plane of incidence, and in it.
fn fresnel(cos: f64) -> [f64; 2] {
    let index = Complex64::new(INDEX[0], INDEX[1]);
    let below = (index * index - (1.0 - cos * cos)).sqrt();
    let s = (cos - below) / (cos + below);
    let p = (index * index * cos - below) / (index * index * cos + below);
    [s.norm_sqr(), p.norm_sqr()]
}

/// A ray with its field across the plane of incidence, and in it.
fn s_and_p(origin: DVec3, direction: DVec3, normal: DVec3) -> Launch<2> {
    let s = direction.cross(normal).normalize();
    Launch { origin, direction, electric: [s.into(), direction.cross(s).into()] }
}

#[test]
fn plane_mirrors_of_any_pose_reflect_on_both_sides() {
    let mut numbers = Numbers(7);
    let (width, height) = (14.0, 9.0);
    for metal in ["", "metal = { index = [0.06, 3.6] }"] {
        for _ in 0..20 {
            let pose = numbers.pose();
            let text = format!(
                "[[device]]\nkind = \"mirror\"\nwidth = {width}\nheight = {height}\n{metal}\n{}",
                placed(pose.origin, &pose.rotation())
            );
            let assembly = assembly(&text);
            let mut tracer = Tracer::new(&assembly, LIMITS);
            let normal = pose.vector_to_world(DVec3::X);
            for _ in 0..60 {
                let own = DVec3::new(0.0, numbers.between(-6.0, 6.0), numbers.between(-9.0, 9.0));
                let (target, direction) = (pose.to_world(own), numbers.direction());
                let launch = s_and_p(target - 50.0 * direction, direction, normal);
                let (leaves, outcome) = tracer.trace(&launch);
                outcome.assert_balanced(leaves, 1e-12, &launch);
                let leaf = leaves[0];
                if own.y.abs() > 0.5 * height || own.z.abs() > 0.5 * width {
                    assert!(!leaf.met_device);
                    continue;
                }
                assert!((leaf.position - target).length() < 1e-9);
                assert!((leaf.direction - turned(direction, normal)).length() < 1e-12);
                let cos = direction.dot(normal).abs();
                let expected = if metal.is_empty() { [1.0; 2] } else { fresnel(cos) };
                for (power, expected) in leaf.power.iter().zip(expected) {
                    assert!((power - expected).abs() < 1e-9, "{cos} {leaf:?}");
                }
            }
        }
    }
}

#[test]
fn layers_lie_on_both_sides_of_a_mirror() {
    let text =
        "[[device]]\nkind = \"mirror\"\ncoating = [{ thickness_nm = 80, index = [1.4, 0.02] }]\n";
    let assembly = assembly(text);
    let mut tracer = Tracer::new(&assembly, LIMITS);
    let mut reflected = |side: f64| {
        let launch = launch(DVec3::new(-9.0 * side, 1.0, 2.0), DVec3::new(side, 0.3, 0.2));
        let (leaves, outcome) = tracer.trace(&launch);
        outcome.assert_balanced(leaves, 1e-12, &launch);
        leaves[0].power
    };
    let [front, back] = [1.0, -1.0].map(&mut reflected);
    assert!(front[0] < 0.99 && (front[0] - back[0]).abs() < 1e-12, "{front:?} {back:?}");
}

#[test]
fn a_metal_ball_reflects_at_each_of_its_points() {
    for (metal, ideal) in [("true", true), ("{ index = [0.06, 3.6] }", false)] {
        let text = format!(
            "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 6\nmetal = {metal}\n"
        );
        let assembly = assembly(&text);
        let mut tracer = Tracer::new(&assembly, LIMITS);
        let mut numbers = Numbers(3);
        for _ in 0..300 {
            let (normal, aside) = (numbers.direction(), numbers.direction());
            let direction = (0.99 * aside - normal).normalize();
            let launch = s_and_p(6.0 * normal - 40.0 * direction, direction, normal);
            if direction.dot(normal) > -1e-3 {
                continue;
            }
            let (leaves, outcome) = tracer.trace(&launch);
            outcome.assert_balanced(leaves, 1e-12, &launch);
            let [leaf] = leaves else { panic!("{leaves:?}") };
            assert!((leaf.direction - turned(direction, normal)).length() < 1e-9);
            let expected = if ideal { [1.0; 2] } else { fresnel(-direction.dot(normal)) };
            for (power, expected) in leaf.power.iter().zip(expected) {
                assert!((power - expected).abs() < 1e-9, "{leaf:?}");
            }
        }
    }
}

fn leaves_of(tracer: &mut Tracer<'_, 2>, launch: &Launch<2>) -> Vec<Leaf<2>> {
    let (leaves, outcome) = tracer.trace(launch);
    outcome.assert_balanced(leaves, 1e-12, launch);
    let mut leaves = leaves.to_vec();
    leaves.sort_by(|a, b| a.optical_path.total_cmp(&b.optical_path));
    leaves
}

fn assert_alike(leaves: &[Leaf<2>], others: &[Leaf<2>], tolerance: f64, launch: &Launch<2>) {
    assert_eq!(leaves.len(), others.len(), "{launch:?}\n{leaves:?}\n{others:?}");
    for (a, b) in leaves.iter().zip(others) {
        assert!((a.position - b.position).length() < tolerance, "{launch:?} {a:?} {b:?}");
        assert!((a.direction - b.direction).length() < tolerance, "{launch:?} {a:?} {b:?}");
        for i in 0..2 {
            assert!((a.power[i] - b.power[i]).abs() < tolerance, "{launch:?} {a:?} {b:?}");
        }
    }
}

#[test]
fn a_metal_box_is_the_metal_prism_also_in_water() {
    let silver = "{ material = \"silver\" }";
    let water = "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 12\nindex = 1.33\n";
    for (around, metal) in [("", "true"), ("", silver), (water, silver)] {
        let place = "rotation = 23\nposition = [1, -2, 0.5]\n";
        let boxed = assembly(&format!(
            "{around}[[device]]\nkind = \"body\"\npriority = 1\n{place}shape = \"box\"\nsize = [6, 8, 7]\n\
             metal = {metal}\n"
        ));
        let prism = assembly(&format!(
            "{around}[[device]]\nkind = \"prisms\"\nlength = 7\n{place}[[device.prism]]\n\
             corners = [[-3, -4], [3, -4], [3, 4], [-3, 4]]\nmetal = {metal}\n"
        ));
        let limits = Limits { min_power: 1e-3, tolerance: 1e-9 };
        let (mut one, mut other) = (Tracer::new(&boxed, limits), Tracer::new(&prism, limits));
        for launch in launches_around(200, [60.0, 40.0], DVec3::splat(12.0)) {
            let (leaves, others) = (leaves_of(&mut one, &launch), leaves_of(&mut other, &launch));
            assert_alike(&leaves, &others, 1e-9, &launch);
        }
    }
}

#[test]
fn what_metal_cannot_be_is_refused() {
    let body = |keys: &str| format!("[[device]]\nkind = \"body\"\n{keys}\n");
    for (text, place, words) in [
        (body("metal = true\nindex = 1.5"), "test:4:9", "lets no light in; it has no index"),
        (body("metal = true\nsurface = {}"), "test:4:11", "both given"),
        (body("metal = false"), "test:3:9", "metal is false"),
        (
            "[[device]]\nkind = \"mirror\"\nlength = 3\n".to_owned(),
            "test:3:10",
            "`width` and `height`",
        ),
        ("[[device]]\nkind = \"mirror\"\nshow = \"bare\"\n".to_owned(), "test:3:8", "no cloak"),
    ] {
        let error = refusal(&text);
        assert!(error.starts_with(place) && error.contains(words), "{text}\n{error}");
    }
    let mirror = "[[device]]\nkind = \"mirror\"\n";
    let crossing = format!("{mirror}{mirror}rotation = 90\n");
    assert!(refusal(&crossing).contains("overlaps"), "{crossing}");
}

/// A device on a mirror floor does what the device and its mirror image do without it.
fn assert_mirrored(on_floor: &str, whole: &str, tolerance: f64) {
    let (on_floor, whole) = (assembly(on_floor), assembly(whole));
    let limits = Limits { min_power: 1e-5, tolerance: 1e-10 };
    let (mut one, mut other) = (Tracer::new(&on_floor, limits), Tracer::new(&whole, limits));
    let mut met = 0;
    for launch in launches_around(150, [60.0, 10.0], DVec3::new(16.0, 12.0, 6.0)) {
        if launch.origin.y < 5.0 || launch.direction.y > -0.1 {
            continue;
        }
        let up = |v: DVec3| v.with_y(v.y.abs());
        let floor = launch.origin - launch.direction * (launch.origin.y / launch.direction.y);
        if floor.truncate().length() > 180.0 {
            continue;
        }
        let leaves = leaves_of(&mut one, &launch);
        let mut others = leaves_of(&mut other, &launch);
        if !others.iter().all(|leaf| leaf.met_device) {
            // It meets the floor alone.
            let leaf = strongest(&leaves);
            assert!((leaf.direction - up(launch.direction)).length() < 1e-12);
            continue;
        }
        met += 1;
        for leaf in &mut others {
            // Those that go down have met the floor, or meet it yet.
            if leaf.direction.y < 0.0 {
                leaf.position.y *= -1.0;
                leaf.direction.y *= -1.0;
            }
        }
        // What hardly goes up or down may pass the end of the floor.
        let strong = |leaf: &&Leaf<2>| leaf.power[0] > 1e-3 && leaf.direction.y.abs() > 0.06;
        let leaves: Vec<Leaf<2>> = leaves.iter().filter(strong).copied().collect();
        // The image of a ray that leaves above the floor for the floor comes from there.
        for other in others.iter().filter(strong) {
            let alike = |leaf: &&Leaf<2>| {
                let way = leaf.position - other.position;
                (leaf.direction - other.direction).length() < tolerance
                    && way.reject_from(other.direction).length() < tolerance
                    && (leaf.power[0] - other.power[0]).abs() < tolerance
                    && (leaf.power[1] - other.power[1]).abs() < tolerance
            };
            assert!(leaves.iter().any(|leaf| alike(&leaf)), "{launch:?}\n{other:?}\n{leaves:#?}");
        }
    }
    assert!(met > 20, "{met}");
}

#[test]
fn prisms_on_a_floor_are_prisms_and_their_images() {
    let prisms = |keys: &str, sides: &[f64]| {
        let mut text = format!("[[device]]\nkind = \"prisms\"\nlength = 400\n{keys}\n");
        for y in sides {
            // Two that meet above the floor, both on it.
            write!(
                text,
                "[[device.prism]]\ncorners = [[-6, 0], [1, 0], [1, {0}], [-4, {1}]]\npermittivity = 2.1\n\
                 [[device.prism]]\ncorners = [[1, 0], [5, 0], [6, {1}], [1, {0}]]\n\
                 permittivity = 1.5\npermeability = 1.2\n",
                5.0 * y,
                4.0 * y
            )
            .unwrap();
        }
        text
    };
    assert_mirrored(&prisms("floor = 400", &[1.0]), &prisms("", &[1.0, -1.0]), 1e-7);
    // From below it is a mirror all over.
    let below = assembly(&prisms("floor = 30\nmetal = { index = [0.06, 3.6] }", &[1.0]));
    let mut tracer = Tracer::new(&below, LIMITS);
    for x in [-14.9, -6.0, -2.0, 1.0, 3.0, 5.5, 14.9] {
        let direction = DVec3::new(0.2, 1.0, 0.1).normalize();
        let launch = s_and_p(DVec3::new(x, 0.0, 0.0) - 20.0 * direction, direction, DVec3::Y);
        let (leaves, outcome) = tracer.trace(&launch);
        outcome.assert_balanced(leaves, 1e-12, &launch);
        assert!((leaves[0].direction - turned(direction, DVec3::Y)).length() < 1e-12, "{x}");
        assert!((leaves[0].power[0] - fresnel(direction.y)[0]).abs() < 1e-9, "{x}");
    }
}

#[test]
fn graded_media_on_a_floor_are_graded_media_and_their_images() {
    // The index varies along x alone: half of the grid is as good as all of it.
    let graded = |height: f64, keys: &str, deep: bool| {
        let mut text = format!(
            "[[device]]\nkind = \"graded\"\nwidth = 12\nheight = {height}\nlength = 400\n{keys}\nindex = ["
        );
        for x in 0..6 {
            let index = 1.2 + 0.05 * f64::from(x * x % 7);
            let number = if deep {
                format!("[{index}, {index}, {index}, {index}]")
            } else {
                index.to_string()
            };
            write!(text, "[{}],", vec![number; 5].join(",")).unwrap();
        }
        text + "]\n"
    };
    for deep in [false, true] {
        let on_floor = graded(5.0, "floor = 400\nposition = [0, 2.5, 0]", deep);
        assert_mirrored(&on_floor, &graded(10.0, "", deep), 1e-6);
    }
}

#[test]
fn the_floor_alone_is_what_a_device_on_it_should_look_like() {
    let prism = "[[device]]\nkind = \"prisms\"\nfloor = 60\n";
    let glass = "[[device.prism]]\ncorners = [[-6, 0], [6, 0], [0, 4]]\nindex = 1.5\n";
    let graded = "[[device]]\nkind = \"graded\"\nwidth = 12\nheight = 8\nfloor = 60\n\
                  index = [[1,1,1,1],[1,1,1,1],[1,1,1,1],[1,1,1,1]]\nposition = [0, 4, 0]\n";
    for text in
        [format!("{prism}show = \"mirror\"\n{glass}"), format!("{graded}show = \"mirror\"\n")]
    {
        let assembly = assembly(&text);
        let mut tracer = Tracer::new(&assembly, LIMITS);
        let launch = launch(DVec3::new(-20.0, 21.0, 0.0), DVec3::new(1.0, -1.0, 0.1));
        let (leaves, _) = tracer.trace(&launch);
        let [leaf] = leaves else { panic!("{leaves:?}") };
        assert!((leaf.position.y).abs() < 1e-12 && (leaf.power[0] - 1.0).abs() < 1e-12);
    }
    for (text, words) in [
        (prism.replace("60", "10") + glass, "at least 12 cm wide"),
        (prism.to_owned() + &glass.replace("[0, 4]", "[0, -4]"), "below the floor"),
        (graded.replace("60", "10"), "at least 12 cm wide"),
        (graded.to_owned() + "shape = \"circle\"\n", "does not stand on a floor"),
    ] {
        let error = refusal(&text);
        assert!(error.contains(words), "{text}\n{error}");
    }
}

/// A triangle of metal under two prisms of the map's media looks like the flat floor in every polarization,
/// from every direction.
#[test]
fn a_carpet_of_ones_own_looks_like_the_flat_floor() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/gallery/prisms-on-floor.toml");
    let assembly = assembly(&std::fs::read_to_string(path).unwrap());
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-6, tolerance: 1e-9 });
    let floor = -41.5;
    for launch in launches_around(400, [60.0, 30.0], DVec3::new(30.0, 8.0, 20.0)) {
        let launch =
            Launch { origin: launch.origin.with_y(launch.origin.y.abs() + 25.0 + floor), ..launch };
        let target = DVec3::new(launch.direction.x * 12.0, floor, launch.direction.z * 9.0);
        let launch = s_and_p(launch.origin, (target - launch.origin).normalize(), DVec3::Y);
        let (leaves, outcome) = tracer.trace(&launch);
        outcome.assert_balanced(leaves, 1e-12, &launch);
        let [leaf] = leaves else { panic!("{launch:?} {leaves:?}") };
        let expected = turned(launch.direction, DVec3::Y);
        assert!((leaf.direction - expected).length() < 1e-9, "{launch:?} {leaf:?}");
        let off = (leaf.position - target).reject_from(expected).length();
        assert!(
            off < 1e-9 && leaf.power.iter().all(|power| (power - 1.0).abs() < 1e-9),
            "{launch:?} {leaf:?}"
        );
    }
}
