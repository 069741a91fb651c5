//! Devices that stand in bodies, and rays that start in media.

use crate::equation_of_motion::{GradedHalf, fresnel, gaussian, refract};
use crate::long::count;
use crate::rays::{Numbers, assembly, launch, refusal};
use cloakroom::assembly::Assembly;
use cloakroom::render::{ChannelSet, PreparedScene, Supervision, render};
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const LIMITS: Limits = Limits { min_power: 1e-9, tolerance: 1e-8 };

/// The strongest leaf of a ray, if not all of it is trapped.
fn strongest_of(assembly: &Assembly, ray: &Launch<2>) -> Option<Leaf<2>> {
    let mut tracer = Tracer::new(assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(ray);
    outcome.assert_balanced(leaves, 1e-9, ray);
    (!leaves.is_empty()).then(|| crate::rays::strongest(leaves))
}

fn strongest(assembly: &Assembly, ray: &Launch<2>) -> Leaf<2> {
    strongest_of(assembly, ray).expect("a leaf")
}

/// A block of a medium that is nothing but a name: light goes through it as through air.
const OF_AIR: &str = "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [60, 60, 60]\n";

#[test]
fn a_block_of_nothing_around_a_device_changes_nothing() {
    let mut numbers = Numbers(5);
    for device in [
        "kind = \"square-cloak\"\nlength = 20\n",
        "kind = \"square-cloak\"\nlength = 20\nmaterial = \"positive-uniaxial\"\n",
        "kind = \"square-cloak\"\nlength = 20\nrotation = 12\ncore = \"open\"\n",
        "kind = \"double-gaussian-cloak\"\nwidth = 30\nheight = 30\nw = 6\nh = 2.5\nlength = 20\n",
        "kind = \"cylinder-cloak\"\nlength = 20\naxis = [0.3, 1, 0.2]\n",
        "kind = \"sphere-cloak\"\n",
        "kind = \"invisible-sphere\"\nmaterial = \"regularized\"\n",
        "kind = \"luneburg-lens\"\n",
        "kind = \"mirror-detour\"\noffset = 3\nhalf_length = 9\nlength = 20\n",
        "kind = \"gaussian-carpet\"\nwidth = 20\nheight = 10\nw = 4\nh = 1.7\nlength = 20\nfloor = 0\n",
    ] {
        let device = format!("[[device]]\n{device}");
        let (alone, immersed) = (assembly(&device), assembly(&(device.clone() + OF_AIR)));
        for _ in 0..40 {
            let from = numbers.direction() * 100.0;
            let aim = 12.0 * numbers.next() * numbers.direction();
            let ray = launch(from, aim - from);
            let [one, other] = [&alone, &immersed].map(|assembly| strongest_of(assembly, &ray));
            assert_eq!(one.is_some(), other.is_some(), "{device} {ray:?}");
            let (Some(one), Some(other)) = (one, other) else { continue };
            assert!((one.power[0] - other.power[0]).abs() < 1e-9, "{device} {one:?} {other:?}");
            assert!(one.direction.distance(other.direction) < 1e-9, "{device} {one:?} {other:?}");
            // The block's border is the last that the other leaves.
            let way = other.position - one.position;
            if one.met_device {
                assert!((way - one.direction * way.dot(one.direction)).length() < 1e-9, "{device}");
                let path = other.optical_path - one.optical_path;
                assert!((path - way.dot(one.direction)).abs() < 1e-9, "{device} {path} {way}");
            }
        }
    }
}

#[test]
fn a_pane_with_air_in_it_is_two_panes() {
    // Light that goes to and fro in one of them comes to the air again and again, which it has
    // left.
    let slab = |rotation: f64, middle: f64, keys: &str| {
        let DVec2 { x, y } = DVec2::from_angle(rotation.to_radians()) * middle;
        format!(
            "[[device]]\nkind = \"body\"\nshape = \"slab\"\nrotation = {rotation}\nposition = [{x}, {y}, 0]\n{keys}"
        )
    };
    let mut numbers = Numbers(3);
    let mut compared = 0;
    for _ in 0..count(5, 20) {
        let rotation = numbers.between(-40.0, 40.0);
        let glass = |thickness: f64| format!("thickness = {thickness}\npermittivity = 6\n");
        let hollow = slab(rotation, 0.0, &glass(6.0))
            + &slab(rotation, 0.0, "thickness = 4\npriority = 1\n");
        let panes = slab(rotation, -2.5, &glass(1.0)) + &slab(rotation, 2.5, &glass(1.0));
        let (hollow, panes) = (assembly(&hollow), assembly(&panes));
        for _ in 0..10 {
            let from = DVec3::new(-40.0, 10.0 * numbers.next(), 10.0 * numbers.next());
            let ray = launch(from, 10.0 * numbers.direction() - from);
            let [one, other] = [&hollow, &panes].map(|assembly| {
                let mut tracer = Tracer::new(assembly, Limits { min_power: 1e-7, ..LIMITS });
                let (leaves, outcome) = tracer.trace(&ray);
                outcome.assert_balanced(leaves, 1e-9, &ray);
                leaves.to_vec()
            });
            for leaf in one.iter().filter(|leaf| leaf.power[0] > 1e-6) {
                compared += 1;
                let same = |other: &&Leaf<2>| {
                    other.position.distance(leaf.position) < 1e-9
                        && other.direction.distance(leaf.direction) < 1e-12
                        && (other.optical_path - leaf.optical_path).abs() < 1e-9
                        && (0..2).all(|i| (other.power[i] - leaf.power[i]).abs() < 1e-12)
                };
                assert!(other.iter().any(|other| same(&other)), "{ray:?} {leaf:?} {other:?}");
            }
        }
    }
    assert!(compared > count(500, 2000), "{compared}");
}

#[test]
fn in_a_matched_block_a_perfect_cloak_changes_nothing_but_the_path() {
    // The block is matched, so that it reflects nothing; the sphere cloak in it is that of air, and
    // bends. A cloak of the block's own medium would not: a prism device of the block's tensor
    // times the cloak's is the square cloak in it.
    let block = "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [60, 60, 60]\npermittivity = 2\npermeability = 2\n";
    let (empty, full) =
        (assembly(block), assembly(&(block.to_owned() + &scaled_square_cloak(2.0))));
    let mut numbers = Numbers(9);
    for _ in 0..200 {
        let from = DVec3::new(-100.0, numbers.between(-8.0, 8.0), numbers.between(-8.0, 8.0));
        let ray = launch(from, DVec3::new(1.0, 0.0, numbers.between(-0.05, 0.05)));
        let [one, other] = [&empty, &full].map(|assembly| strongest(assembly, &ray));
        assert!((one.power[0] - other.power[0]).abs() < 1e-9, "{one:?} {other:?}");
        assert!(one.direction.distance(other.direction) < 1e-9, "{one:?} {other:?}");
        assert!(one.position.distance(other.position) < 1e-8, "{one:?} {other:?}");
        assert!((one.optical_path - other.optical_path).abs() < 1e-8, "{one:?} {other:?}");
    }
}

/// The segments of the square cloak with both tensors times a number, as prisms: the cloak of a
/// medium of that ε = µ.
fn scaled_square_cloak(factor: f64) -> String {
    use cloakroom::device::Region;
    let cloak = assembly("[[device]]\nkind = \"square-cloak\"\n");
    let d = 14.1 * 0.5f64.sqrt();
    let b = d / 3f64.sqrt();
    let mut scene = String::from("[[device]]\nkind = \"prisms\"\nlength = 40\n");
    let signs = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    for (region, (x, y)) in cloak.devices()[0].structure.regions.iter().zip(signs) {
        let Region::Homogeneous(region) = region else { panic!("homogeneous") };
        let tensor = *region.medium.permittivity() * factor;
        let row = |i: usize| format!("{:?}", [0, 1, 2].map(|j| tensor.col(j)[i]));
        let rows = format!("[{}, {}, {}]", row(0), row(1), row(2));
        scene += &format!(
            "[[device.prism]]\ncorners = [[{:?}, 0], [0, {:?}], [0, {:?}]]\npermittivity = {rows}\npermeability = {rows}\n",
            x * d,
            y * d,
            y * b
        );
    }
    scene
        + &format!(
            "[[device.prism]]\ncorners = [[{d:?}, 0], [0, {b:?}], [{:?}, 0], [0, {:?}]]\nmetal = true\n",
            -d, -b
        )
}

#[test]
fn rays_that_start_in_glass_leave_it_by_snell_and_fresnel() {
    for glass in [
        "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [10, 40, 40]\npermittivity = 2.25\n",
        "[[device]]\nkind = \"prisms\"\n[[device.prism]]\ncorners = [[-5, -20], [5, -20], [5, 20], [-5, 20]]\npermittivity = 2.25\n",
    ] {
        let assembly = assembly(glass);
        for angle in [0.0, 10.0, 25.0, 40.0_f64] {
            let (sin, cos) = angle.to_radians().sin_cos();
            let leaf =
                strongest(&assembly, &launch(DVec3::new(1.0, 0.5, 0.0), DVec3::new(cos, sin, 0.0)));
            assert!((leaf.direction.y - 1.5 * sin).abs() < 1e-12, "{leaf:?}");
            let cos_t = (1.0 - 2.25 * sin * sin).sqrt();
            let [s, p] = [
                (1.5 * cos - cos_t) / (1.5 * cos + cos_t),
                (cos - 1.5 * cos_t) / (cos + 1.5 * cos_t),
            ];
            // Horizontal light has its field along z: s.
            assert!((leaf.power[0] - (1.0 - s * s)).abs() < 1e-9, "{leaf:?}");
            assert!((leaf.power[1] - (1.0 - p * p)).abs() < 1e-9, "{leaf:?}");
            assert!((leaf.optical_path - 1.5 * 4.0 / cos).abs() < 1e-9, "{leaf:?}");
        }
    }
}

#[test]
fn rays_that_start_in_a_device_are_those_that_come_by() {
    // In a medium that reflects nothing, what starts on the way of a ray leaves as it does.
    let mut numbers = Numbers(23);
    for kind in [
        "square-cloak",
        "sphere-cloak",
        "cylinder-cloak",
        "luneburg-lens",
        "fisheye-lens",
        "eaton-lens",
        "bending-sphere",
        "invisible-sphere",
    ] {
        let device = format!("kind = \"{kind}\"");
        let assembly = assembly(&format!("[[device]]\n{device}\n"));
        for _ in 0..20 {
            let from = DVec3::new(-30.0, numbers.between(-7.0, 7.0), numbers.between(-4.0, 4.0));
            let ray = launch(from, DVec3::X);
            let whole = strongest(&assembly, &ray);
            let lines = cloakroom::trace::lines(&assembly, LIMITS, &ray, [1.0, 0.0], 1.0);
            let inside: Vec<_> = lines
                .iter()
                .filter(|line| !line.leaves && line.points[0].optical_path > 1.0)
                .collect();
            let Some(line) = inside.first() else { continue };
            // Far from the core, where a piece of the drawn way hardly bends.
            let middle = (line.points.len() / 8).max(1);
            if line.points.len() < 2 {
                continue;
            }
            // The middle of a piece of the way, and its direction.
            let [a, b] = if line.points.len() == 2 {
                [line.points[0], line.points[1]]
            } else {
                [line.points[middle - 1], line.points[middle]]
            };
            let (at, along) = (a.position.midpoint(b.position), b.position - a.position);
            if along.length() < 1e-6 {
                continue;
            }
            let started = strongest(&assembly, &launch(at, along));
            // The way is drawn in straight pieces.
            let near = if line.points.len() == 2 { 1e-9 } else { 0.1 };
            assert!(
                started.direction.distance(whole.direction) < near,
                "{device} {whole:?} {started:?}"
            );
            assert!((started.power[0] - 1.0).abs() < 1e-6, "{device} {started:?}");
        }
    }
}

#[test]
fn rays_start_in_round_birefringent_devices() {
    let mut numbers = Numbers(29);
    for device in [
        "kind = \"cylinder-cloak\"\nmaterial = \"radial-uniaxial\"\n",
        "kind = \"cylinder-cloak\"\nmaterial = \"azimuthal-uniaxial\"\n",
        "kind = \"cylinder-cloak\"\nmaterial = \"radial-uniaxial\"\ncore = \"open\"\n",
        "kind = \"invisible-sphere\"\nmaterial = \"regularized\"\n",
    ] {
        let assembly = assembly(&format!("[[device]]\n{device}"));
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-5, ..LIMITS });
        let mut come_out = 0;
        for _ in 0..20 {
            let [x, y, z] = [0; 3].map(|_| numbers.between(-1.0, 1.0));
            let from = DVec3::new(x, y, if device.contains("sphere") { z } else { 0.0 });
            let start = from.normalize() * numbers.between(4.1, 9.9);
            let across = DVec2::from_angle(numbers.between(0.0, 6.0));
            let ray = launch(start, across.extend(numbers.between(-0.2, 0.2)));
            assert!(assembly.region_around(ray.origin, ray.direction) == Ok(Some((0, 0))));
            let (leaves, outcome) = tracer.trace(&ray);
            // Some run around in it for good, totally reflected.
            come_out += u32::from(!leaves.is_empty());
            outcome.assert_balanced(leaves, 1e-9, &(device, ray));
        }
        assert!(come_out > 10, "{device} {come_out}");
    }
}

/// A picture of colors alone takes rays that meet nothing for such as see the photograph past all devices. Those
/// that start in a medium are none of them.
#[test]
fn what_is_seen_out_of_a_medium_is_the_same_however_much_is_asked_for() {
    const CARPET: &str = "kind = 'gaussian-carpet'";
    const BLOCK: &str = "kind = 'body'\nshape = 'box'\nsize = [60, 60, 60]\nindex = 1.5";
    const BALL: &str = "kind = 'body'\nshape = 'sphere'\nradius = 5\nindex = 1.5";
    const TURNED: &str =
        "kind = 'body'\nshape = 'box'\nsize = [20, 30, 30]\nindex = 1.5\nrotation = 20";
    for (projection, position, device) in [
        ("", [-10.0, 6.0, -30.0], CARPET),
        ("", [-10.0, 3.0, 5.0], BLOCK),
        ("", [-1.0, -0.5, 0.0], BALL),
        // Only some of the rays start in it.
        ("projection = 'orthographic'\nwidth = 40\n", [-5.0, 0.0, 0.0], TURNED),
    ] {
        for light in ["", "[light]\nspectrum = 'D65'\n"] {
            let text = format!(
                "[camera]\n{projection}position = {position:?}\n\
                 target = [40, 2, 3]\nresolution = [48, 36]\nsamples = 2\n\
                 [picture]\nchannels = ['group_delay']\n{light}[[device]]\n{device}\n"
            );
            let loaded = cloakroom::scene_file::parse(&text, "test", Path::new(""), &[]).unwrap();
            let prepared = PreparedScene::new(&loaded.scene).unwrap();
            let supervision = Supervision { rows_done: &|_| {}, stop: &AtomicBool::new(false) };
            let [alone, with_all] = [ChannelSet::Image, ChannelSet::Everything]
                .map(|channels| render(&prepared, channels, &supervision).unwrap().picture);
            for color in ["R", "G", "B"] {
                let [alone, with_all] =
                    [&alone, &with_all].map(|picture| &picture.channel(color).unwrap().samples);
                let off = (0..48 * 36).map(|i| (alone.get(i) - with_all.get(i)).abs());
                let off = off.fold(0.0, f64::max);
                // Where more is asked for weaker branches are followed, too.
                assert!(off < 1e-4, "{off}: {text}");
            }
        }
    }
}

#[test]
fn nothing_starts_in_metal() {
    let scene =
        "[camera]\nposition = [0, 0, 0]\ntarget = [1, 0, 0]\n[[device]]\nkind = \"square-cloak\"\n";
    let loaded = cloakroom::scene_file::parse(scene, "test", Path::new(""), &[]).unwrap();
    let error = PreparedScene::new(&loaded.scene).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("in metal or an opaque body"), "{error}");
    // A device that only reaches into a body.
    let half = "[[device]]\nkind = \"sphere-cloak\"\nposition = [30, 0, 0]\n";
    assert!(refusal(&(half.to_owned() + OF_AIR)).contains("overlaps"));
}

#[test]
fn light_goes_into_a_carpet_in_glass_and_out_by_the_equation_of_motion() {
    const INDEX: f64 = 1.5;
    let scene = assembly(include_str!("../../../scenes/gallery/carpet-in-glass.toml"));
    let mut carpet = GradedHalf::new(gaussian(8.0, 3.4), 1.0, [20.0, 20.0], 0.012);
    carpet.outside = INDEX;
    // The block, which stands on the floor.
    let (low, high) = (DVec3::new(-35.0, 0.0, -30.0), DVec3::new(35.0, 40.0, 30.0));
    let mut tracer = Tracer::new(&scene, LIMITS);
    let mut numbers = Numbers(31);
    let (mut compared, mut mirrored) = (0, 0);
    for _ in 0..count(80, 600) {
        // Onto the top of the block, and then onto that of the carpet.
        let top = DVec3::new(numbers.between(-19.5, 19.5), 20.0, numbers.between(-12.0, 12.0));
        let across = DVec2::from_angle(numbers.between(0.0, TAU)) * numbers.between(0.0, 0.8);
        let outside = DVec3::new(across.x, -(1.0 - across.length_squared()).sqrt(), across.y);
        let Some(in_glass) = refract(outside, DVec3::NEG_Y, INDEX * INDEX) else { continue };
        let entry = top - in_glass * (20.0 / -in_glass.y);
        if entry.x.abs() > 34.9 || entry.z.abs() > 29.9 {
            continue;
        }
        let index = carpet.squared_index(top).value;
        let Some(in_carpet) = refract(in_glass, DVec3::NEG_Y, index) else { continue };
        let path = 40.0 + INDEX * entry.distance(top);
        let Some(out) = carpet.out(top, in_carpet, path) else { continue };
        // Out of the glass by its nearest face; not again onto the floor, or out of the ends of the
        // carpet.
        let faces = DVec3::select(out.direction.cmpgt(DVec3::ZERO), high, low);
        let ways = (faces - out.position) / out.direction;
        let way = ways.min_element();
        let normal =
            DVec3::select(ways.cmpeq(DVec3::splat(way)), out.direction.signum(), DVec3::ZERO);
        if out.direction.y < 0.0 || out.position.z.abs() > 19.9 {
            continue;
        }
        let Some(direction) = refract(out.direction * INDEX, normal, 1.0) else { continue };
        let position = out.position + out.direction * way;
        let path = out.optical_path + INDEX * way;
        let ray = launch(entry - outside * 40.0, outside);
        let (leaves, outcome) = tracer.trace(&ray);
        outcome.assert_balanced(leaves, 1e-9, &ray);
        let off = |leaf: &Leaf<2>| {
            (leaf.position.distance(position))
                .max((leaf.optical_path - path).abs())
                .max(10.0 * leaf.direction.distance(direction))
        };
        let nearest = leaves.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
        assert!(off(nearest) < 1e-7, "{:e} {ray:?} {nearest:?} {out:?}", off(nearest));
        // Through each of four borders goes what Fresnel's equations say of s or of p, or what is
        // between.
        let through = |before: DVec3, beyond: DVec3, normal: DVec3| {
            fresnel(before.dot(normal), beyond.dot(normal), before.length(), beyond.length())
        };
        let borders = [
            through(outside, in_glass, DVec3::NEG_Y),
            through(in_glass, in_carpet, DVec3::NEG_Y),
            out.transmitted,
            through(out.direction * INDEX, direction, normal),
        ];
        let least: f64 = borders.iter().map(|[s, p]| s.min(*p)).product();
        let most: f64 = borders.iter().map(|[s, p]| s.max(*p)).product();
        assert!(
            nearest.power.iter().all(|power| (least - 1e-7..most + 1e-7).contains(power)),
            "{least} {most} {ray:?} {nearest:?}"
        );
        compared += 1;
        mirrored += u32::from(out.mirrored);
    }
    assert!(compared > count(30, 200) && mirrored > count(25, 150), "{compared} {mirrored}");
}
