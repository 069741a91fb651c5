//! Coatings of devices, and metals with an index, against the 4 x 4 transfer matrix, Fresnel's
//! equations and the devices that they must be the same as.

use crate::coherence::{WAVE_NUMBER, expected, gathered, slabs, tensor};
use crate::long::count;
use crate::rays::{Numbers, assembly, launch, placed, refusal};
use crate::transfer_matrix::{Layer, jones, polarizations};
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::fmt::Write;

const NM: f64 = 1e-7;
const LIMITS: Limits = Limits { min_power: 1e-7, tolerance: 1e-9 };

/// A layer of a random kind: dielectric, metal or crystal, absorbing or not; nanometres thick.
fn layer(numbers: &mut Numbers) -> Layer {
    let thickness = numbers.between(0.0, 300.0) * NM;
    let isotropic = |value: f64| DMat3::IDENTITY * value;
    let (permittivity, loss) = match (numbers.next() * 4.0) as u32 {
        0 => (isotropic(numbers.between(1.2, 6.0)), DMat3::ZERO),
        1 => (isotropic(numbers.between(-12.0, -1.0)), isotropic(numbers.between(0.0, 3.0))),
        2 => (tensor(numbers, 1.5, 4.0), DMat3::ZERO),
        _ => (tensor(numbers, 1.5, 4.0), tensor(numbers, 0.01, 0.5)),
    };
    // Metals of the oracle, which has growing waves, too, must be thin.
    let thickness = if permittivity.x_axis.x < 0.0 { 0.2 * thickness } else { thickness };
    Layer { permittivity, permeability: DMat3::IDENTITY, loss, thickness }
}

/// A tensor of the transfer matrix's frame in that of the scene, as scenes write it.
fn rows(re: &DMat3, im: &DMat3) -> String {
    let axes = [DVec3::Z, DVec3::X, DVec3::Y];
    let entry = |i: DVec3, j: DVec3| [i.dot(*re * j), i.dot(*im * j)];
    format!("{:?}", axes.map(|i| axes.map(|j| entry(i, j))))
}

/// The key of a coating, from the outside inwards.
fn coating(layers: &[Layer]) -> String {
    let mut text = "coating = [".to_owned();
    for Layer { permittivity, loss, thickness, .. } in layers {
        let nanometres = thickness / NM;
        let permittivity = rows(permittivity, loss);
        write!(text, "{{ thickness_nm = {nanometres:?}, permittivity = {permittivity} }}, ")
            .unwrap();
    }
    text + "]\n"
}

fn plate(numbers: &mut Numbers) -> Layer {
    let permittivity = match (numbers.next() * 2.0) as u32 {
        0 => DMat3::IDENTITY * numbers.between(1.2, 6.0),
        _ => tensor(numbers, 1.5, 4.0),
    };
    let thickness = numbers.between(1e-4, 1e-3);
    Layer { permittivity, permeability: DMat3::IDENTITY, loss: DMat3::ZERO, thickness }
}

fn reversed(layers: &[Layer]) -> Vec<Layer> {
    layers.iter().rev().copied().collect()
}

/// Compares what a stack in a scene reflects and transmits with the transfer matrix of layers.
fn compare(scene: &str, layers: &[Layer], numbers: &mut Numbers) {
    let k = numbers.between(0.0, 0.9);
    let angle = TAU * numbers.next();
    let [s, p] = [angle.cos(), angle.sin()];
    let fields = polarizations(k, (1.0 - k * k).sqrt());
    let exact = jones(layers, WAVE_NUMBER, k);
    let leaves = gathered(scene, k, fields[0] * s + fields[1] * p, 0.0);
    let mut checked = 0.0;
    for leaf in &leaves {
        let expected = expected(&exact, k, [s, p], leaf.direction.x > 0.0);
        let overlap = leaf.electric[0].dot(expected.conj()).norm();
        let power = expected.norm_squared();
        assert!((leaf.power[0] - power).abs() < 1e-9, "{leaf:?} {power} {scene} {k}");
        assert!((overlap - power).abs() < 1e-9, "{leaf:?} {expected:?} {scene}");
        checked += power;
    }
    let all: f64 =
        [true, false].map(|on| expected(&exact, k, [s, p], on).norm_squared()).iter().sum();
    assert!((checked - all).abs() < 1e-9, "{checked} {all} {scene}");
}

#[test]
fn coated_plates_are_those_of_the_transfer_matrix() {
    let mut numbers = Numbers(51);
    for _ in 0..count(60, 3000) {
        let layers: Vec<Layer> =
            (0..1 + (numbers.next() * 4.0) as usize).map(|_| layer(&mut numbers)).collect();
        let plate = plate(&mut numbers);
        let whole = [&layers[..], &[plate], &reversed(&layers)].concat();
        compare(&(slabs(&[plate]) + &coating(&layers)), &whole, &mut numbers);
    }
}

#[test]
fn where_coated_bodies_touch_the_layers_of_both_are_between_them() {
    let mut numbers = Numbers(52);
    for _ in 0..count(30, 1000) {
        let [one, other] = [0, 1].map(|_| plate(&mut numbers));
        let [film, skin] = [0, 1].map(|_| {
            let count = (numbers.next() * 3.0) as usize;
            (0..count).map(|_| layer(&mut numbers)).collect::<Vec<_>>()
        });
        let both = slabs(&[one, other]);
        let second = both.rfind("[[device]]").unwrap();
        let scene =
            format!("{}{}{}{}", &both[..second], coating(&film), &both[second..], coating(&skin));
        let whole =
            [&film[..], &[one], &reversed(&film), &skin, &[other], &reversed(&skin)].concat();
        compare(&scene, &whole, &mut numbers);
    }
}

/// The share that layers (index, nm) between two indices reflect of s, for the tangential wave
/// vector k: Airy's recursion.
fn reflectance(first: f64, layers: &[(f64, f64)], last: f64, k: f64) -> f64 {
    let normal = |n: f64| Complex64::from(n * n - k * k).sqrt();
    let (mut r, mut here) = (Complex64::ZERO, normal(last));
    for (n, nanometres) in layers.iter().rev().chain([&(first, 0.0)]) {
        let q = normal(*n);
        let own = (q - here) / (q + here);
        let turn = (2.0 * Complex64::i() * q * nanometres * NM * WAVE_NUMBER).exp();
        (r, here) = ((own + r) / (1.0 + own * r) * turn, q);
    }
    r.norm_sqr()
}

#[test]
fn a_coated_body_in_another_one_keeps_its_coating_and_adds_none_of_its_host() {
    let mut numbers = Numbers(53);
    for _ in 0..count(100, 3000) {
        let [host, guest] = [0, 1].map(|_| numbers.between(1.2, 2.5));
        let mut film = || -> Vec<(f64, f64)> {
            let count = (numbers.next() * 4.0) as usize;
            (0..count).map(|_| (numbers.between(1.2, 2.6), numbers.between(0.0, 300.0))).collect()
        };
        let [outer, inner] = [film(), film()];
        let slab = |thickness: f64, index: f64, film: &[(f64, f64)], priority: i32| {
            let layer = |(n, t): &(f64, f64)| format!("{{ index = {n:?}, thickness_nm = {t:?} }}");
            let layers: Vec<String> = film.iter().map(layer).collect();
            format!(
                "[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = {thickness}\npriority = {priority}\n\
                 permittivity = {:?}\ncoating = [{}]\n",
                index * index,
                layers.join(", ")
            )
        };
        let scene = slab(9.0, host, &outer, 0) + &slab(3.0, guest, &inner, 1);
        let angle = numbers.between(0.0, 0.9);
        let (sin, cos) = angle.sin_cos();
        let direction = DVec3::new(cos, sin, 0.0);
        let origin = direction * -30.0;
        let ray = Launch { origin, direction, electric: [DVec3::Z.into()] };
        // Powers add: 1/T - 1 is the sum of R/(1 - R) over all faces.
        let faces = [reflectance(1.0, &outer, host, sin), reflectance(host, &inner, guest, sin)];
        let sum: f64 = faces.map(|r| 2.0 * r / (1.0 - r)).iter().sum();
        // Light that goes to and fro for long is pruned.
        if sum > 1.0 {
            continue;
        }
        let expected = 1.0 / (1.0 + sum);
        let assembly = assembly(&scene);
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-8, ..LIMITS });
        let (leaves, outcome) = tracer.trace(&ray);
        outcome.assert_balanced(leaves, 1e-9, &ray);
        let pruned = outcome.pruned[0];
        let on = leaves.iter().filter(|leaf| leaf.direction.x > 0.0);
        let found: f64 = on.map(|leaf| leaf.power[0]).sum();
        assert!((found - expected).abs() < pruned + 1e-9, "{found} {expected} {scene}");
        assert!(pruned < 5e-3, "{pruned}");
    }
}

/// A square of a medium, in cm.
fn square(half: f64, keys: &str) -> String {
    format!(
        "[[device.prism]]\ncorners = [[{0}, {0}], [-{0}, {0}], [-{0}, -{0}], [{0}, -{0}]]\n{keys}",
        half
    )
}

/// The leaves of a ray, and what is absorbed, with nothing lost.
fn leaves_of(scene: &str, ray: &Launch<2>) -> (Vec<Leaf<2>>, [f64; 2]) {
    let assembly = assembly(scene);
    let mut tracer = Tracer::new(&assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(ray);
    outcome.assert_balanced(leaves, 1e-9, ray);
    (leaves.to_vec(), outcome.absorbed)
}

fn assert_same_leaves(one: &str, other: &str, ray: &Launch<2>) {
    let [(a, lost_a), (b, lost_b)] = [one, other].map(|scene| leaves_of(scene, ray));
    let strong = |leaf: &&Leaf<2>| leaf.power[0].max(leaf.power[1]) > COMPARED;
    let distance = |a: &Leaf<2>, b: &Leaf<2>| {
        let path = (a.optical_path - b.optical_path).abs();
        // Ways that are mirror images of each other end alike.
        a.direction.distance(b.direction) + path + (a.power[0] - b.power[0]).abs()
    };
    for (these, those) in [(&a, &b), (&b, &a)] {
        for leaf in these.iter().filter(strong) {
            let same = those.iter().min_by(|a, b| distance(leaf, a).total_cmp(&distance(leaf, b)));
            let same = same.unwrap();
            assert!(distance(leaf, same) < 1e-7, "{leaf:?} {same:?} {one}\n{other}");
            for i in 0..2 {
                let off = (leaf.electric[i] + same.electric[i] * -1.0).norm_squared().sqrt();
                assert!(off < 1e-7, "{off} {leaf:?} {same:?} {one}\n{other}");
            }
        }
    }
    assert!((0..2).all(|i| (lost_a[i] - lost_b[i]).abs() < 1e-4), "{one}\n{other}");
}

/// Leaves of less power need not be the same: which of them are pruned is a matter of rounding.
const COMPARED: f64 = 1e-5;

const LAYERS: &str = "coating = [{ index = 1.38, thickness_nm = 90 }, { index = [0.05, 3.9], thickness_nm = 8 }, \
                      { permittivity = [[2.3, 0.1, 0.2], [0.1, 2.6, 0], [0.2, 0, 2.1]], thickness_nm = 130 }]\n";

#[test]
fn bodies_prisms_and_seams_have_the_same_coatings_in_any_pose() {
    let mut numbers = Numbers(54);
    for _ in 0..count(60, 1000) {
        let origin = numbers.direction() * 3.0;
        let rotation = numbers.pose().rotation();
        let place = placed(origin, &rotation);
        let body = format!(
            "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [6, 6, 6]\npermittivity = 2.3\n{LAYERS}{place}"
        );
        let device = format!("[[device]]\nkind = \"prisms\"\nlength = 6\n{place}");
        let own = device.clone() + &square(3.0, &format!("permittivity = 2.3\n{LAYERS}"));
        let of_device = device.replace("length", &format!("{LAYERS}length"))
            + &square(3.0, "permittivity = 2.3\n");
        let world = format!(
            "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [6, 6, 6]\npermittivity = 2.3\n{LAYERS}"
        );
        let from = numbers.direction() * 20.0;
        let ray = launch(from, numbers.direction() * 2.0 - from);
        let turned = |v: DVec3| rotation * v;
        let there = Launch {
            origin: origin + turned(ray.origin),
            direction: turned(ray.direction),
            electric: ray.electric.map(|field| field.transformed(&rotation)),
        };
        assert_same_leaves(&body, &own, &there);
        assert_same_leaves(&body, &of_device, &there);
        // The layers turn with the device.
        let [(a, _), (b, _)] = [leaves_of(&world, &ray), leaves_of(&body, &there)];
        assert_eq!(a.len(), b.len());
        let sums = [a, b].map(|leaves| -> f64 {
            leaves.iter().map(|leaf| leaf.power[0] * (1.0 + leaf.power[1])).sum()
        });
        assert!((sums[0] - sums[1]).abs() < 1e-9, "{sums:?}");
        // Half of it in a pool of glass of its own: the layers are between media and in any frame.
        let pool =
            "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 9\npermittivity = 1.7\n";
        assert_same_leaves(&(pool.to_owned() + &own), &(pool.to_owned() + &of_device), &there);
        let inner = body.replace("kind = \"body\"\n", "kind = \"body\"\npriority = 3\n");
        assert_same_leaves(&(pool.to_owned() + &own), &(pool.to_owned() + &inner), &there);
    }
}

#[test]
fn neighbouring_prisms_have_the_layers_of_both_between_them() {
    // Two halves of a plate, each coated, against bodies that touch.
    let mut numbers = Numbers(55);
    let films = [
        "coating = [{ index = 1.38, thickness_nm = 90 }, { index = [0.2, 2], thickness_nm = 10 }]\n",
        "coating = [{ index = [0.1, 3], thickness_nm = 12 }]\n",
    ];
    let media = ["permittivity = 2.3\n", "permittivity = 3.1\n"];
    let half = |side: usize| {
        let x = if side == 0 { "-3" } else { "3" };
        let corners = format!("corners = [[{x}, 4], [{x}, -4], [0, -4], [0, 4]]\n");
        format!("[[device.prism]]\n{corners}{}{}", media[side], films[side])
    };
    let prisms = format!("[[device]]\nkind = \"prisms\"\nlength = 8\n{}{}", half(0), half(1));
    let body = |side: usize| {
        let x = [-1.5, 1.5][side];
        format!(
            "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [3, 8, 8]\nposition = [{x}, 0, 0]\n{}{}",
            media[side], films[side]
        )
    };
    let bodies = body(0) + &body(1);
    for _ in 0..count(100, 2000) {
        let from = numbers.direction() * 30.0;
        let ray = launch(from, numbers.direction() * 2.0 - from);
        assert_same_leaves(&prisms, &bodies, &ray);
    }
    // Between prisms of one medium without coatings there is nothing, with one there is.
    let of_one = |film: &str| {
        prisms.replace(media[1], media[0]).replace(films[0], film).replace(films[1], "")
    };
    let ray = launch(DVec3::new(-20.0, 1.0, 0.3), DVec3::X);
    let parted = |film: &str| leaves_of(&of_one(film), &ray).0.len();
    assert!(parted(films[0]) > parted(""));
}

#[test]
fn round_graded_and_cut_devices_take_coatings() {
    // Each in air, at its border: what the first face reflects is what a coated body of the index
    // there does.
    let film =
        "coating = [{ index = 2.0, thickness_nm = 60 }, { index = 1.3, thickness_nm = 120 }]\n";
    let ray = launch(DVec3::new(-40.0, 1.0, 0.5), DVec3::X);
    let glass = format!("[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 10\n{film}");
    let matched = leaves_of(&glass, &ray).0;
    let back = |leaves: &[Leaf<2>]| {
        let back = leaves.iter().find(|leaf| leaf.direction.x < 0.0).copied();
        back.map_or([0.0; 2], |leaf| leaf.power)
    };
    let bare = "[[device]]\nkind = \"luneburg-lens\"\n";
    let lens = leaves_of(&format!("{bare}{film}"), &ray).0;
    // At its border a Luneburg lens is as air.
    let [found, expected] = [back(&lens), back(&matched)];
    assert!(expected[0] > 1e-3 && back(&leaves_of(bare, &ray).0)[0] < 1e-12);
    assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 1e-9), "{found:?} {expected:?}");
    for device in [
        "kind = \"cylinder-cloak\"\n",
        "kind = \"cylinder-cloak\"\ncore = \"open\"\nlength = 30\n",
        "kind = \"sphere-cloak\"\n",
        "kind = \"square-cloak\"\n",
        "kind = \"square-cloak\"\ncore = \"open\"\n",
        "kind = \"double-gaussian-cloak\"\nlength = 30\n",
        "kind = \"gaussian-carpet\"\nrotation = 90\n",
        "kind = \"invisible-sphere\"\n",
        "kind = \"fisheye-hemisphere\"\n",
        "kind = \"graded-box\"\n",
        "kind = \"mirror-detour\"\n",
    ] {
        let bare = format!("[[device]]\n{device}");
        let coated = bare.clone() + film;
        let none = bare.clone() + "coating = []\n";
        assert_same_leaves(&bare, &none, &ray);
        let [(a, _), (b, _)] = [leaves_of(&bare, &ray), leaves_of(&coated, &ray)];
        let share =
            |leaves: &[Leaf<2>]| leaves.iter().map(|leaf| leaf.power[0].powi(2)).sum::<f64>();
        let same = (share(&a) - share(&b)).abs() < 1e-6;
        // A lossless film on a mirror sends all back.
        assert!(same == device.contains("mirror"), "{device} {a:?} {b:?}");
    }
}

#[test]
fn metals_with_an_index_reflect_by_fresnels_equations_and_keep_the_rest() {
    let index = Complex64::new(0.27, 2.9);
    let mut numbers = Numbers(56);
    let mirror = |metal: &str| {
        "[[device]]\nkind = \"prisms\"\nlength = 40\n".to_owned()
            + &square(10.0, &format!("metal = {metal}\n"))
    };
    for _ in 0..count(200, 5000) {
        let from = DVec3::new(-30.0, numbers.between(-20.0, 20.0), numbers.between(-20.0, 20.0));
        let ray = launch(from, DVec3::new(-10.0, numbers.between(-9.0, 9.0), 0.0) - from);
        let (leaves, absorbed) = leaves_of(&mirror("{ index = [0.27, 2.9] }"), &ray);
        let (perfect, none) = leaves_of(&mirror("true"), &ray);
        assert_eq!((leaves.len(), perfect.len(), none), (1, 1, [0.0; 2]));
        assert!(leaves[0].direction.distance(perfect[0].direction) < 1e-12);
        // Which face is met.
        let before = leaves[0].position;
        let normal = if (before.x + 10.0).abs() < 1e-9 { DVec3::X } else { DVec3::Y };
        let cos = ray.direction.dot(normal).abs();
        let inner = (index * index - (1.0 - cos * cos)).sqrt();
        let r_s = (cos - inner) / (cos + inner);
        let r_p = (index * index * cos - inner) / (index * index * cos + inner);
        let s = ray.direction.cross(normal).normalize();
        for ((electric, power), absorbed) in ray.electric.iter().zip(leaves[0].power).zip(absorbed)
        {
            let share = electric.dot_real(s).norm_sqr();
            let expected = share * r_s.norm_sqr() + (1.0 - share) * r_p.norm_sqr();
            assert!((power - expected).abs() < 1e-12, "{expected} {leaves:?}");
            assert!((absorbed - (1.0 - expected)).abs() < 1e-12);
        }
    }
    // At normal incidence, by tmm 0.2.0.
    let ray = launch(DVec3::new(-30.0, 1.0, 2.0), DVec3::X);
    let (leaves, _) = leaves_of(&mirror("{ index = [0.27, 2.9] }"), &ray);
    assert!((leaves[0].power[0] - 0.892_246_754_931_207).abs() < 1e-12);
    // A quarter wave over the metal, and one over a perfect conductor, which cannot absorb.
    let film = "coating = [{ index = 1.46, thickness_nm = 94 }]\n";
    let (coated, absorbed) = leaves_of(&(mirror("{ index = [0.27, 2.9] }") + film), &ray);
    assert!((coated[0].power[0] + absorbed[0] - 1.0).abs() < 1e-12 && coated[0].power[0] < 0.88);
    let (coated, absorbed) = leaves_of(&(mirror("true") + film), &ray);
    assert!((coated[0].power[0] - 1.0).abs() < 1e-12 && absorbed == [0.0; 2]);
}

#[test]
fn the_metal_of_every_device_may_have_an_index() {
    // A metal of a huge index is a perfect conductor, nearly; gold is not.
    for device in [
        "kind = \"square-cloak\"\nrotation = 20\n",
        "kind = \"square-cloak\"\nshow = \"bare\"\n",
        "kind = \"square-cloak\"\nshow = \"mirror\"\nrotation = 40\n",
        "kind = \"double-gaussian-cloak\"\nrotation = 30\n",
        "kind = \"double-gaussian-cloak\"\nshow = \"bare\"\n",
        "kind = \"cylinder-cloak\"\nmaterial = \"radial-uniaxial\"\naxis = [0, 1, 3]\n",
        "kind = \"cylinder-cloak\"\nshow = \"bare\"\n",
        "kind = \"sphere-cloak\"\nshow = \"bare\"\n",
        "kind = \"gaussian-carpet\"\nrotation = 90\n",
        "kind = \"grating-carpet\"\nrotation = 90\nlength = 30\n",
        "kind = \"quasi-conformal-carpet\"\nrotation = 90\nshow = \"bare\"\n",
        "kind = \"mirror-detour\"\n",
    ] {
        let ray = launch(DVec3::new(-60.0, 1.7, 0.5), DVec3::new(1.0, 0.01, 0.02));
        let of = |metal: &str| leaves_of(&format!("[[device]]\n{device}{metal}"), &ray);
        let (perfect, _) = of("");
        assert_eq!(perfect, of("metal = true\n").0);
        let sum = |leaves: &[Leaf<2>]| leaves.iter().map(|leaf| leaf.power[0]).sum::<f64>();
        let (dense, absorbed) = of("metal = { index = [0, 1e5] }\n");
        assert!((sum(&perfect) - sum(&dense)).abs() < 1e-9 && absorbed[0].abs() < 1e-9, "{device}");
        let (gold, absorbed) = of("metal = { index = [0.42, 2.47] }\n");
        assert!(absorbed[0] > 1e-3 && sum(&gold) < 0.999, "{device} {absorbed:?} {gold:?}");
    }
}

#[test]
fn what_is_wrong_with_a_coating_is_told() {
    let body =
        |key: &str| refusal(&format!("[[device]]\nkind = \"body\"\npermittivity = 2.25\n{key}\n"));
    let of =
        |layer: &str| body(&format!("coating = [{{ index = 1.4, thickness_nm = 5 }}, {layer}]"));
    for (layer, message) in [
        ("{ index = 1.4 }", "this layer has no `thickness_nm`"),
        ("{ thickness_nm = 4 }", "this layer has no medium"),
        (
            "{ index = 1.4, thickness_nm = -4 }",
            "thickness_nm is -4 nm; it must be from 0 to 1000000",
        ),
        ("{ index = [1.4, -0.1], thickness_nm = 4 }", "n and k of n + ik must be 0 or above"),
        ("{ index = -1.4, thickness_nm = 4 }", "has none below 0"),
        ("{ index = 0, thickness_nm = 4 }", "not both 0"),
        ("{ index = 1.4, permittivity = 2, thickness_nm = 4 }", "take one of them"),
        ("{ index = [1, 2, 3], thickness_nm = 4 }", "it must be a number or [re, im]"),
        ("{ permittivity = [2, -0.1], thickness_nm = 4 }", "media with gain are not supported"),
        ("{ indx = 2, thickness_nm = 4 }", "did you mean `index`?"),
    ] {
        let refused = of(layer);
        assert!(refused.contains(message), "{layer}: {refused}");
        assert!(refused.starts_with("test:4:"), "{layer}: {refused}");
    }
    let many = vec!["{ index = 1.4, thickness_nm = 5 }"; 101].join(", ");
    let refused = body(&format!("coating = [{many}]"));
    assert!(refused.contains("coating has 101 layers; it may have 100"), "{refused}");
    let film = "coating = [{ index = 1.4, thickness_nm = 5 }]";
    for (scene, message) in [
        (format!("kind = \"body\"\nsurface = {{}}\n{film}"), "an opaque body shows its `surface`"),
        (format!("kind = \"polarizer\"\n{film}"), "a polarizer takes no coating"),
        (
            format!("kind = \"double-gaussian-cloak\"\nfresnel = false\n{film}"),
            "leave one of them out",
        ),
        ("kind = \"lens\"\nmetal = { index = [1, 2] }".to_owned(), "has no metal of its own"),
        (
            "kind = \"luneburg-lens\"\nmetal = { index = [1, 2] }".to_owned(),
            "has no metal of its own",
        ),
        (
            "kind = \"square-cloak\"\ncore = \"open\"\nmetal = { index = 2 }".to_owned(),
            "has no metal of its own",
        ),
        ("kind = \"square-cloak\"\nmetal = false".to_owned(), "core = \"open\""),
        (
            "kind = \"square-cloak\"\nmetal = {}".to_owned(),
            "this metal has neither `index` nor `material`",
        ),
        (
            "kind = \"square-cloak\"\nmetal = 3".to_owned(),
            "it must be true, false or a table with the keys index, material",
        ),
        (
            "kind = \"square-cloak\"\nmetal = { index = [-1, 2] }".to_owned(),
            "metal.index is [-1, 2]",
        ),
    ] {
        let refused = refusal(&format!("[[device]]\n{scene}\n"));
        assert!(refused.contains(message), "{scene}: {refused}");
    }
    let prism = refusal(&format!(
        "[[device]]\nkind = \"prisms\"\n{}",
        square(3.0, "metal = { index = [1, 2] }\npermittivity = 2\n")
    ));
    assert!(prism.contains("metal has its `index`, and takes no permittivity"), "{prism}");
    let prism = refusal(&format!(
        "[[device]]\nkind = \"prisms\"\n{}",
        square(3.0, "permittivity = 2\ncoating = [{ index = 2 }]\n")
    ));
    assert!(prism.starts_with("test:6:12: this layer has no"), "{prism}");
}
