//! Leaves that add as fields: films, plates, wave plates and polarizers against the 4 x 4 transfer
//! matrix.

use crate::long::count;
use crate::rays::{Numbers, assembly, launch};
use crate::transfer_matrix::{Jones, Layer, jones, polarizations};
use cloakroom::render::{PreparedScene, PulseList, pulses};
use cloakroom::scene_file;
use cloakroom::trace::{Coherence, Launch, Leaf, Limits, TraceStats, Tracer};
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::geometry::Pose;
use optics::wave::ComplexVector;
use std::f64::consts::TAU;
use std::path::Path;

const WAVELENGTH_NM: f64 = 550.0;
pub const WAVE_NUMBER: f64 = TAU / (WAVELENGTH_NM * 1e-7);

/// The frame of the transfer matrix in the scene, whose stacks lie across x.
pub fn to_scene(v: DVec3) -> DVec3 {
    DVec3::new(v.z, v.x, v.y)
}

/// Slabs that touch, the first at x = 0.
pub fn slabs(layers: &[Layer]) -> String {
    let mut x = 0.0;
    let slabs = layers.iter().map(|layer| {
        x += layer.thickness;
        slab(layer, x - 0.5 * layer.thickness)
    });
    slabs.collect()
}

/// The same where every other layer, with the first, is of one medium: a slab of it, and those
/// between in it.
fn nested(layers: &[Layer]) -> String {
    let thickness = layers.iter().map(|layer| layer.thickness).sum::<f64>();
    let mut scene = slab(&Layer { thickness, ..layers[0] }, 0.5 * thickness);
    let mut x = 0.0;
    for (number, layer) in layers.iter().enumerate() {
        x += layer.thickness;
        if number % 2 == 1 {
            scene += &slab(layer, x - 0.5 * layer.thickness);
            scene += "priority = 1\n";
        }
    }
    scene
}

/// A slab with its middle at x.
fn slab(layer: &Layer, x: f64) -> String {
    let Layer { permittivity, permeability, loss, thickness } = layer;
    // The axes of the scene in the frame of the transfer matrix.
    let axes = [DVec3::Z, DVec3::X, DVec3::Y];
    let rows = |re: &DMat3, im: &DMat3| {
        let entry = |i: DVec3, j: DVec3| [i.dot(*re * j), i.dot(*im * j)];
        format!("{:?}", axes.map(|i| axes.map(|j| entry(i, j))))
    };
    format!(
        "[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = {thickness:?}\n\
         position = [{x:?}, 0, 0]\npermittivity = {}\npermeability = {}\n",
        rows(permittivity, loss),
        rows(permeability, &DMat3::ZERO),
    )
}

/// A symmetric tensor with principal values near some.
pub fn tensor(numbers: &mut Numbers, low: f64, high: f64) -> DMat3 {
    let turn = Pose::with_axis(DVec3::ZERO, TAU * numbers.next(), numbers.direction()).rotation();
    let values = DVec3::from_array([0; 3].map(|_| numbers.between(low, high)));
    let tensor = turn * DMat3::from_diagonal(values) * turn.transpose();
    (tensor + tensor.transpose()) * 0.5
}

fn layer(numbers: &mut Numbers, thickness: [f64; 2]) -> Layer {
    let thickness = numbers.between(thickness[0], thickness[1]);
    let isotropic = |value: f64| DMat3::IDENTITY * value;
    let (permittivity, permeability) = match (numbers.next() * 4.0) as u32 {
        0 => (isotropic(numbers.between(1.2, 6.0)), DMat3::IDENTITY),
        1 => (tensor(numbers, 1.5, 4.0), tensor(numbers, 0.8, 1.6)),
        2 => (isotropic(numbers.between(1.2, 4.0)), isotropic(numbers.between(0.8, 2.0))),
        _ => (tensor(numbers, 1.5, 4.0), DMat3::IDENTITY),
    };
    Layer { permittivity, permeability, loss: DMat3::ZERO, thickness }
}

/// The leaves of light that comes in towards x = 0 with a polarization, added as fields.
pub fn gathered(scene: &str, k: f64, electric: DVec3, bandwidth_nm: f64) -> Vec<Leaf<1>> {
    let assembly = assembly(scene);
    let light = Coherence::new(WAVELENGTH_NM, bandwidth_nm);
    let limits = Limits { min_power: 1e-22, tolerance: 1e-9 };
    let mut tracer = Tracer::new(&assembly, limits).joining(light);
    let direction = to_scene(DVec3::new(k, 0.0, (1.0 - k * k).sqrt()));
    let launch = Launch { origin: -direction, direction, electric: [to_scene(electric).into()] };
    let (leaves, outcome) = tracer.trace(&launch);
    assert_eq!(outcome.stats, TraceStats::default(), "{scene}");
    light.gather(leaves)
}

/// The field that the transfer matrix has along a direction, on or back.
pub fn expected(jones: &Jones, k: f64, [s, p]: [f64; 2], on: bool) -> ComplexVector {
    let kz = (1.0 - k * k).sqrt();
    let (matrix, kz) = if on { (jones.transmitted, kz) } else { (jones.reflected, -kz) };
    let amplitudes = [0, 1].map(|row| matrix[row][0] * s + matrix[row][1] * p);
    let fields = polarizations(k, kz).map(|field| ComplexVector::from(to_scene(field)));
    fields[0].scaled(amplitudes[0]) + fields[1].scaled(amplitudes[1])
}

#[test]
fn random_stacks_are_those_of_the_transfer_matrix_and_keep_the_power() {
    let mut numbers = Numbers(31);
    for _ in 0..count(40, 2000) {
        let layers: Vec<Layer> = (0..1 + (numbers.next() * 5.0) as usize)
            .map(|_| layer(&mut numbers, [2e-6, 3e-4]))
            .collect();
        is_that_of_the_transfer_matrix(&mut numbers, &slabs(&layers), &layers);
    }
}

#[test]
fn slabs_in_a_slab_are_a_stack() {
    let mut numbers = Numbers(33);
    for _ in 0..count(40, 2000) {
        let host = layer(&mut numbers, [1.0; 2]);
        let layers: Vec<Layer> = (0..3 + 2 * (numbers.next() * 2.0) as usize)
            .map(|number| match number % 2 {
                0 => Layer { thickness: numbers.between(2e-6, 3e-4), ..host },
                _ => layer(&mut numbers, [2e-6, 3e-4]),
            })
            .collect();
        is_that_of_the_transfer_matrix(&mut numbers, &nested(&layers), &layers);
    }
}

/// Light from a random direction goes through a scene as through layers, and keeps its power.
fn is_that_of_the_transfer_matrix(numbers: &mut Numbers, scene: &str, layers: &[Layer]) {
    let k = numbers.between(0.0, 0.8);
    let angle = TAU * numbers.next();
    let [s, p] = [angle.cos(), angle.sin()];
    let fields = polarizations(k, (1.0 - k * k).sqrt());
    let exact = jones(layers, WAVE_NUMBER, k);
    let leaves = gathered(scene, k, fields[0] * s + fields[1] * p, 0.0);
    let sum: f64 = leaves.iter().map(|leaf| leaf.power[0]).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{sum} {layers:?}");
    for leaf in &leaves {
        let expected = expected(&exact, k, [s, p], leaf.direction.x > 0.0);
        // The phase at the place of the leaf is another one.
        let overlap = leaf.electric[0].dot(expected.conj()).norm();
        let power = expected.norm_squared();
        assert!((leaf.power[0] - power).abs() < 1e-9, "{leaf:?} {power} {layers:?}");
        assert!((overlap - power).abs() < 1e-9, "{leaf:?} {expected:?} {layers:?}");
    }
}

#[test]
fn stacks_that_absorb_are_those_of_the_transfer_matrix() {
    let mut numbers = Numbers(32);
    for _ in 0..count(40, 2000) {
        let layers: Vec<Layer> = (0..1 + (numbers.next() * 3.0) as usize)
            .map(|_| {
                let layer = layer(&mut numbers, [2e-6, 3e-4]);
                let loss = numbers.between(0.001, 0.3);
                let isotropic = layer.permittivity == DMat3::IDENTITY * layer.permittivity.x_axis.x;
                let loss = if isotropic {
                    DMat3::IDENTITY * loss
                } else {
                    tensor(&mut numbers, 0.2 * loss, loss)
                };
                Layer { loss, ..layer }
            })
            .collect();
        let k = numbers.between(0.0, 0.8);
        let fields = polarizations(k, (1.0 - k * k).sqrt());
        let exact = jones(&layers, WAVE_NUMBER, k);
        for (s, p) in [(1.0, 0.0), (0.0, 1.0), (0.6, 0.8)] {
            let leaves = gathered(&slabs(&layers), k, fields[0] * s + fields[1] * p, 0.0);
            for leaf in &leaves {
                let expected = expected(&exact, k, [s, p], leaf.direction.x > 0.0);
                let power = expected.norm_squared();
                let off = leaf.power[0] - power;
                assert!(off.abs() < 1e-9, "{off:e} {leaf:?} {power} {layers:?}");
            }
        }
    }
}

fn glass(thickness: f64) -> Layer {
    let permittivity = DMat3::IDENTITY * 2.25;
    Layer { permittivity, permeability: DMat3::IDENTITY, loss: DMat3::ZERO, thickness }
}

#[test]
fn films_reflect_as_their_thickness_has_it_and_thick_plates_do_not() {
    let reflected = |thickness: f64, bandwidth: f64| {
        let leaves = gathered(&slabs(&[glass(thickness)]), 0.0, DVec3::Y, bandwidth);
        leaves.iter().find(|leaf| leaf.direction.x < 0.0).map_or(0.0, |leaf| leaf.power[0])
    };
    // physics.md, section 8: 92 and 183 nm of glass.
    assert!((reflected(92e-7, 0.0) - 0.148).abs() < 2e-4);
    assert!(reflected(183.333_333e-7, 0.0) < 1e-9);
    // Two faces of 4 %, which add as powers: 2R/(1 + R).
    let powers = 2.0 * 0.04 / 1.04;
    assert!((reflected(0.1, 100.0) - powers).abs() < 1e-12);
    assert!((reflected(0.1, 0.0) - powers).abs() > 1e-3);
    // In between, the fringes fade with the line: the mean over it.
    let line = |thickness: f64, bandwidth: f64| {
        let sigma = bandwidth / WAVELENGTH_NM / (8.0 * std::f64::consts::LN_2).sqrt();
        let mut sums = [0.0; 2];
        for i in -2000..=2000 {
            let off = f64::from(i) * 0.003;
            let weight = (-0.5 * off * off).exp();
            let wave_number = WAVE_NUMBER * (1.0 + sigma * off);
            let r = jones(&[glass(thickness)], wave_number, 0.0).reflected[0][0].norm_sqr();
            sums[0] += weight * r;
            sums[1] += weight;
        }
        sums[0] / sums[1]
    };
    for thickness in [92e-7, 4e-5, 1.03e-4] {
        let (found, mean) = (reflected(thickness, 60.0), line(thickness, 60.0));
        assert!((found - mean).abs() < 1e-6, "{thickness} {found} {mean}");
    }
}

#[test]
fn weak_birefringence_is_weak() {
    // Light at Brewster's angle passes whole, whatever the axes.
    let k = 1.5 / 3.25f64.sqrt();
    let p = polarizations(k, (1.0 - k * k).sqrt())[1];
    let mut numbers = Numbers(5);
    for exponent in -11..=-6 {
        for _ in 0..10 {
            let weak = tensor(&mut numbers, -1.0, 1.0) * (3.0 * 10f64.powi(exponent));
            let permittivity = DMat3::IDENTITY * 2.25 + weak;
            let layer = Layer { permittivity, ..glass(0.1) };
            for bandwidth in [0.0, 100.0] {
                let leaves = gathered(&slabs(&[layer]), k, p, bandwidth);
                let on = leaves.iter().filter(|leaf| leaf.direction.x > 0.0);
                let on: f64 = on.map(|leaf| leaf.power[0]).sum();
                let exact = jones(&[layer], WAVE_NUMBER, k).transmitted;
                let exact = exact[0][1].norm_sqr() + exact[1][1].norm_sqr();
                // Over 1 mm, 1e-6 turns the light itself, by what the exact matrix says.
                assert!((on - exact).abs() < 1e-7 || bandwidth > 0.0, "{exponent} {on} {exact}");
                assert!(on > 1.0 - 1e-4, "{exponent} {on}");
            }
        }
    }
}

/// What the middle pixel of a camera that looks along x brings back.
fn middle(scene: &str) -> PulseList {
    let scene = format!(
        "[camera]\nposition = [-100, 0, 0]\ntarget = [50, 0, 0]\nresolution = [3, 3]\nsamples = 1\n{scene}"
    );
    let loaded = scene_file::parse(&scene, "test", Path::new(""), &[]).unwrap();
    pulses(&PreparedScene::new(&loaded.scene).unwrap(), [1, 1]).unwrap()
}

/// Films of any thickness, at any angle, at the limits of a picture: what a white photograph shows is
/// what the channels say that it gets, and that is what the transfer matrix has.
#[test]
fn what_is_delivered_through_films_is_what_is_seen_through_them() {
    let mut numbers = Numbers(29);
    for case in 0..count(60, 1000) {
        let index = numbers.between(1.2, 3.6);
        let nm = [10.0, 400.0, 1e6][case % 3] * numbers.between(1.0, 2.0);
        let loss = if case % 4 == 3 { numbers.between(0.0, 0.5) } else { 0.0 };
        let rotation = numbers.between(0.0, 60.0);
        let permittivity = DMat3::IDENTITY * (index * index);
        let loss = DMat3::IDENTITY * if nm < 1000.0 { loss } else { 0.0 };
        let film = Layer { permittivity, loss, ..glass(nm * 1e-7) };
        let scene = format!(
            "[light]\nbandwidth_nm = 0\n[surroundings]\ncolor = [0, 0, 0]\n{}rotation = {rotation}\n",
            slabs(&[film])
        );
        let list = middle(&scene);
        let delivered: f64 = list.pulses.iter().map(|pulse| pulse.power).sum();
        let sum = delivered + list.escaped + list.absorbed + list.pruned;
        assert!((sum - 1.0).abs() < 1e-9, "{sum} {scene}");
        for share in [delivered, list.escaped, list.absorbed, list.pruned] {
            assert!(share > -1e-12, "{list:?} {scene}");
        }
        if nm < 1000.0 {
            let exact = jones(&[film], WAVE_NUMBER, rotation.to_radians().sin()).transmitted;
            let exact = 0.5 * exact.as_flattened().iter().map(|t| t.norm_sqr()).sum::<f64>();
            assert!((delivered - exact).abs() < 1e-3, "{delivered} {exact} {scene}");
        }
    }
}

fn polarizer(x: f64, angle: f64) -> String {
    format!("[[device]]\nkind = \"polarizer\"\nposition = [{x}, 0, 0]\nangle = {angle}\n")
}

#[test]
fn wave_plates_between_polarizers_are_those_of_the_transfer_matrix() {
    for waves in [0.25, 0.5, 1.0, 1.7] {
        for angle in [45.0, 20.0] {
            for analyser in [0.0, 90.0, 30.0] {
                // Quartz, its axis turned from z towards y.
                let (no, ne) = (1.546, 1.555);
                let (sin, cos) = f64::to_radians(angle).sin_cos();
                // In the frame of the transfer matrix z and y of the scene are y and x.
                let axis = DVec3::new(sin, cos, 0.0);
                let dyad = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
                let permittivity = DMat3::IDENTITY * (no * no) + dyad * (ne * ne - no * no);
                let thickness = waves * WAVELENGTH_NM * 1e-7 / (ne - no);
                let layer = Layer { permittivity, ..glass(thickness) };
                let scene = format!(
                    "[light]\nbandwidth_nm = 0\n[trace]\nmin_power = 1e-20\n{}{}{}",
                    polarizer(-5.0, 0.0),
                    slabs(&[layer]),
                    polarizer(5.0, analyser)
                );
                let list = middle(&scene);
                let exact = jones(&[layer], WAVE_NUMBER, 0.0).transmitted;
                // Horizontal is z, the s of the transfer matrix; vertical is y, its p, x there.
                let (sin, cos) = f64::to_radians(analyser).sin_cos();
                let passed = exact[0][0] * cos + exact[1][0] * sin;
                // Unpolarized light: half of it passes the first.
                let expected = 0.5 * passed.norm_sqr();
                let delivered = list.delivered;
                assert!(
                    (delivered - expected).abs() < 2e-7,
                    "{waves} {angle} {analyser} {delivered} {expected}"
                );
            }
        }
    }
}

#[test]
fn polarizers_pass_by_the_law_of_malus_and_absorb_the_rest_in_any_pose() {
    for degrees in [0.0, 30.0, 45.0, 90.0, 200.0] {
        let list = middle(&(polarizer(-5.0, 10.0) + &polarizer(5.0, 10.0 + degrees)));
        let expected = 0.5 * f64::to_radians(degrees).cos().powi(2);
        assert!((list.delivered - expected).abs() < 1e-12, "{list:?}");
        assert!((list.absorbed - (1.0 - expected)).abs() < 1e-12, "{list:?}");
    }
    let mut numbers = Numbers(8);
    for _ in 0..100 {
        let (axis, rotation) = (numbers.direction(), numbers.between(0.0, 360.0));
        let (at, angle) = (numbers.direction() * 5.0, numbers.between(0.0, 180.0));
        let assembly = assembly(&format!(
            "[[device]]\nkind = \"polarizer\"\naxis = {:?}\nrotation = {rotation:?}\nposition = {:?}\n\
             angle = {angle:?}\nlength = 20\n",
            axis.to_array(),
            at.to_array()
        ));
        let pose = Pose::with_axis(at, rotation.to_radians(), axis);
        let (sin, cos) = angle.to_radians().sin_cos();
        let passing = pose.vector_to_world(DVec3::new(0.0, sin, cos));
        let from = numbers.direction() * 40.0;
        let ray = launch(from, at - from);
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 0.0, tolerance: 1e-6 });
        let (leaves, outcome) = tracer.trace(&ray);
        outcome.assert_balanced(leaves, 1e-12, &ray);
        let across = (passing - ray.direction * passing.dot(ray.direction)).normalize();
        for leaf in leaves {
            // It goes on as it came, without a path of its own.
            assert!(leaf.direction.distance(ray.direction) < 1e-14);
            let way = (leaf.position - ray.origin).length();
            assert!((leaf.optical_path - way).abs() < 1e-12);
            for (electric, launched) in leaf.electric.iter().zip(ray.electric) {
                let passed = ComplexVector::from(across).scaled(launched.dot_real(across));
                assert!((*electric + passed * -1.0).norm_squared() < 1e-24, "{leaf:?}");
            }
        }
        assert_eq!(leaves.len(), 1);
    }
}

#[test]
fn what_a_wave_plate_makes_of_horizontal_light_has_the_handedness_of_a_retarder() {
    // 1/4, 1/2 and 1 wave at 45 degrees; bare faces reflect, and those with a quarter wave of index
    // √n hardly.
    let (no, ne): (f64, f64) = (1.546, 1.555);
    let index = (0.5 * (no + ne)).sqrt();
    let quarter =
        format!("{{ index = {index:?}, thickness_nm = {:?} }}", WAVELENGTH_NM / (4.0 * index));
    for (waves, expected) in
        [(0.25, [0.0, 0.0, -1.0]), (0.5, [-1.0, 0.0, 0.0]), (1.0, [1.0, 0.0, 0.0])]
    {
        let dyad =
            DMat3::from_cols(DVec3::new(0.5, 0.5, 0.0), DVec3::new(0.5, 0.5, 0.0), DVec3::ZERO);
        let permittivity = DMat3::IDENTITY * (no * no) + dyad * (ne * ne - no * no);
        let thickness = waves * WAVELENGTH_NM * 1e-7 / (ne - no);
        let layer = Layer { permittivity, ..glass(thickness) };
        for (coating, tolerance) in
            [(String::new(), 0.15), (format!("coating = [{quarter}]\n"), 1e-4)]
        {
            let leaves = gathered(&(slabs(&[layer]) + &coating), 0.0, DVec3::Y, 0.0);
            let on = leaves.iter().find(|leaf| leaf.direction.x > 0.0).unwrap();
            let field = on.electric[0];
            let [h, v] = [DVec3::Z, DVec3::Y].map(|axis| field.dot_real(axis));
            let s0 = h.norm_sqr() + v.norm_sqr();
            let cross: Complex64 = h * v.conj();
            let found =
                [h.norm_sqr() - v.norm_sqr(), 2.0 * cross.re, 2.0 * cross.im].map(|s| s / s0);
            let off = |i: usize| f64::abs(found[i] - expected[i]);
            assert!((0..3).all(|i| off(i) < tolerance), "{waves} {found:?}");
            let coated = !coating.is_empty();
            assert!(s0 > if coated { 1.0 - 1e-4 } else { 0.8 }, "{waves} {s0}");
        }
    }
}

#[test]
fn light_goes_back_through_plates_that_absorb_as_it_came() {
    let mut numbers = Numbers(33);
    let (mut compared, mut off_by_more) = (0, 0);
    while compared < count(100, 1000) {
        let permittivity = tensor(&mut numbers, 1.5, 4.0);
        let strength = 10f64.powf(numbers.between(-9.0, 0.5));
        // Of what comes in, a tenth to a half goes through.
        let thickness = (numbers.between(1.0, 3.0) / (WAVE_NUMBER * strength)).min(0.5);
        let loss = tensor(&mut numbers, 0.1 * strength, strength);
        let rows = [DVec3::X, DVec3::Y, DVec3::Z].map(|i| {
            [DVec3::X, DVec3::Y, DVec3::Z].map(|j| [i.dot(permittivity * j), i.dot(loss * j)])
        });
        let assembly = assembly(&format!(
            "[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = {thickness:?}\npermittivity = {rows:?}\n"
        ));
        let limits = Limits { min_power: 1e-9, tolerance: 1e-9 };
        let mut tracer = Tracer::<1>::new(&assembly, limits);
        let from = numbers.direction() * (20.0 * thickness);
        let ray = launch(from, numbers.direction() * thickness - from);
        let turn = TAU * numbers.next();
        let [h, v] = ray.electric;
        let electric = h * turn.cos() + v.scaled(Complex64::new(0.0, turn.sin()));
        let there = Launch { origin: from, direction: ray.direction, electric: [electric] };
        if from.x.abs() < thickness {
            continue;
        }
        let (leaves, outcome) = tracer.trace(&there);
        outcome.assert_balanced(leaves, 1e-9, &there);
        // The two waves that go straight through; others share their ways with further ones.
        let mut through: Vec<Leaf<1>> = leaves
            .iter()
            .filter(|leaf| leaf.direction.dot(ray.direction) > 0.999)
            .copied()
            .collect();
        through.sort_by(|a, b| a.optical_path.total_cmp(&b.optical_path));
        for leaf in through.into_iter().take(2).filter(|leaf| leaf.power[0] > 1e-4) {
            let sent = leaf.electric[0].conj() * leaf.power[0].sqrt().recip();
            let beyond = 6.0 * thickness;
            let start = leaf.position + leaf.direction * beyond;
            let back = Launch { origin: start, direction: -leaf.direction, electric: [sent] };
            let (returned, _) = tracer.trace(&back);
            // It comes back on its line, by the same way.
            let same = |other: &&Leaf<1>| {
                let beside = (other.position - from).reject_from(ray.direction).length();
                let whole = leaf.optical_path + beyond;
                let way = other.optical_path + (other.position - from).length();
                other.direction.dot(ray.direction) < 1e-12 - 1.0
                    && beside < 1e-3 * thickness
                    && (way - whole).abs() < 1e-3 * thickness
            };
            let power: f64 = (returned.iter().filter(same))
                .map(|other| other.electric[0].dot(electric).norm_sqr())
                .sum();
            let off = power - leaf.power[0];
            // Near an optic axis modes have fewer digits.
            assert!(off.abs() < 1e-11, "{off:e} {strength:e} {leaf:?} {returned:?}");
            compared += 1;
            off_by_more += usize::from(off.abs() > 1e-12);
        }
    }
    assert!(100 * off_by_more <= compared, "{off_by_more} of {compared}");
}
