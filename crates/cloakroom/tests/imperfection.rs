//! Imperfect devices against the same media made by hand, and their account of power.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::rays::{assembly, launch, refusal};
use cloakroom::assembly::Assembly;
use cloakroom::device::Region;
use cloakroom::trace::{Limits, Tracer};
use glam::{DMat3, DVec3};
use std::fmt::Write;

const LIMITS: Limits = Limits { min_power: 1e-6, tolerance: 1e-6 };

/// Rays towards a device, and what comes of each: leaves by power, with position and direction.
fn seen(assembly: &Assembly) -> Vec<Vec<(f64, DVec3, DVec3, f64)>> {
    let mut tracer = Tracer::new(assembly, LIMITS);
    (0..40)
        .map(|k| {
            let share = f64::from(k) / 40.0;
            let origin = DVec3::new(-60.0, 16.0 * share - 8.1, 3.0 * (7.0 * share).fract());
            let slant = DVec3::new(
                1.0,
                0.2 * ((13.0 * share).fract() - 0.5),
                0.3 * ((5.0 * share).fract() - 0.5),
            );
            let ray = launch(origin, slant);
            let (leaves, outcome) = tracer.trace(&ray);
            outcome.assert_balanced(leaves, 1e-9, &ray);
            let mut found: Vec<_> = leaves
                .iter()
                .map(|leaf| (leaf.power[0], leaf.position, leaf.direction, leaf.optical_path))
                .collect();
            found.sort_by(|a, b| b.0.total_cmp(&a.0));
            found.truncate(5);
            found
        })
        .collect()
}

/// The segments of a square cloak as a scene of prisms.
fn by_hand(cloak: &Assembly) -> String {
    let mut scene = String::from("[[device]]\nkind = \"prisms\"\n");
    let d = 14.1 * 0.5f64.sqrt();
    let b = d / 3f64.sqrt();
    let signs = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    for (region, (x, y)) in cloak.devices()[0].structure.regions.iter().zip(signs) {
        let Region::Homogeneous(region) = region else { panic!("homogeneous") };
        let (e, m) = region.medium.tensors();
        let rows = |re: &DMat3, im: &DMat3| {
            let entry = |i: usize, j: usize| format!("[{:e}, {:e}]", re.col(j)[i], im.col(j)[i]);
            let row = |i| format!("[{}, {}, {}]", entry(i, 0), entry(i, 1), entry(i, 2));
            format!("[{}, {}, {}]", row(0), row(1), row(2))
        };
        writeln!(
            scene,
            "[[device.prism]]\ncorners = [[{:e}, 0], [0, {:e}], [0, {:e}]]\npermittivity = {}\npermeability = {}",
            x * d, y * d, y * b, rows(&e.re, &e.im), rows(&m.re, &m.im)
        )
        .unwrap();
    }
    writeln!(
        scene,
        "[[device.prism]]\ncorners = [[{d:e}, 0], [0, {b:e}], [{:e}, 0], [0, {:e}]]\nmetal = true",
        -d, -b
    )
    .unwrap();
    scene
}

#[test]
fn an_imperfect_square_cloak_is_a_device_of_prisms_of_its_tensors() {
    for (material, imperfection) in [
        ("impedance-matched", "error = 0.01, seed = 8"),
        ("positive-uniaxial", "error = 0.02, levels = 64"),
        ("negative-uniaxial", "maximum = 3, minimum = 0.35"),
        ("impedance-matched", "error = 0.01, loss_tangent = 1e-7"),
    ] {
        let text = format!(
            "[[device]]\nkind = \"square-cloak\"\nmaterial = \"{material}\"\nimperfection = {{ {imperfection} }}\n"
        );
        let cloak = assembly(&text);
        let hand = assembly(&by_hand(&cloak));
        let mut compared = 0;
        for (a, b) in seen(&cloak).iter().zip(&seen(&hand)) {
            for (a, b) in a.iter().zip(b) {
                assert!((a.0 - b.0).abs() < 1e-9, "{material}: {} {}", a.0, b.0);
                // Of branches of equal power the order is open.
                if a.0 > 1e-3 && (a.1 - b.1).length() < 1.0 {
                    assert!((a.1 - b.1).length() < 1e-9 && (a.2 - b.2).length() < 1e-9);
                    assert!((a.3 - b.3).abs() < 1e-9);
                    compared += 1;
                }
            }
        }
        assert!(compared > 40, "{material}: {compared}");
    }
}

#[test]
fn no_imperfection_is_the_ideal_device() {
    for kind in ["square-cloak", "double-gaussian-cloak", "gaussian-carpet", "body"] {
        let scene = format!("[[device]]\nkind = \"{kind}\"\n");
        let zero = format!("{scene}imperfection = {{ seed = 3 }}\n");
        assert_eq!(seen(&assembly(&scene)), seen(&assembly(&zero)), "{kind}");
    }
}

#[test]
fn loss_takes_what_beer_and_lambert_say() {
    // Through a slab of an impedance-matched medium straight: exp(-k0 n tan d L) for eps, and again
    // for mu.
    let scene = "[light]\nwavelength_nm = 1000\n[[device]]\nkind = \"body\"\nshape = \"slab\"\nthickness = 4\n\
                 permittivity = 1.5\npermeability = 1.5\nimperfection = { loss_tangent = 2e-6 }\n";
    let assembly = assembly(scene);
    let mut tracer = Tracer::new(&assembly, Limits { min_power: 0.0, ..LIMITS });
    let (leaves, outcome) = tracer.trace(&launch(DVec3::new(-50.0, 0.0, 0.0), DVec3::X));
    let wave_number = std::f64::consts::TAU / 1e-4;
    let exact = (-2.0 * wave_number * 1.5 * 2e-6 * 4.0).exp();
    outcome.assert_balanced(leaves, 1e-9, &scene);
    assert!((leaves[0].power[0] - exact).abs() < 1e-9, "{} {exact}", leaves[0].power[0]);
    assert!((outcome.absorbed[0] - (1.0 - exact)).abs() < 1e-9);
}

#[test]
fn bad_imperfections_are_refused_at_their_place() {
    let message = |keys: &str| {
        refusal(&format!("[[device]]\nkind = \"square-cloak\"\n[device.imperfection]\n{keys}\n"))
    };
    assert!(message("errer = 0.1").contains("did you mean `error`"));
    assert!(message("error = -0.1").contains("error"));
    let levels = message("levels = 1");
    assert!(levels.contains("levels is 1") && levels.contains("levels = 1"), "{levels}");
    assert!(message("minimum = 2\nmaximum = 1").contains("above maximum"));
    let detour = refusal("[[device]]\nkind = \"mirror-detour\"\nimperfection = { error = 0.1 }\n");
    assert!(detour.contains("no medium"), "{detour}");
    // Bare metal has nothing to be imperfect, and needs no other scene.
    assembly(
        "[[device]]\nkind = \"square-cloak\"\nshow = \"bare\"\nimperfection = { error = 0.1 }\n",
    );
}

/// How far beside where the ideal cloak sends them the strongest leaves run, the median of those
/// that differ, cm.
fn displaced(kind: &str, imperfection: &str) -> f64 {
    let scene = format!("[[device]]\nkind = \"{kind}\"\n");
    let made = assembly(&format!("{scene}imperfection = {{ {imperfection} }}\n"));
    let mut distances = Vec::new();
    for (ideal, made) in seen(&assembly(&scene)).iter().zip(&seen(&made)) {
        let (Some(ideal), Some(made)) = (ideal.first(), made.first()) else { continue };
        // Rays that one of them throws back tell nothing.
        if ideal.2.dot(made.2) > 0.7 {
            distances.push((ideal.1 - made.1).reject_from_normalized(ideal.2).length());
        }
    }
    // Of a carpet, the floor is perfect.
    distances.retain(|distance| *distance > 0.0);
    assert!(distances.len() > 8, "{}", distances.len());
    distances.sort_by(f64::total_cmp);
    distances[distances.len() / 2]
}

#[test]
fn what_the_process_can_make_anyway_stays() {
    // The index lies between 0.873 and 1.918: the range does nothing, and all that is left is the
    // integrator's error.
    let off = displaced("double-gaussian-cloak", "minimum = 0.8, maximum = 2.0");
    assert!(off > 0.0 && off < 1e-6, "{off:e}");
}

#[test]
fn graded_errors_grow_in_proportion_and_levels_converge() {
    let kind = "double-gaussian-cloak";
    let of = |error: f64, seed: u32| displaced(kind, &format!("error = {error}, seed = {seed}"));
    let (small, large) = (of(1e-5, 1), of(2e-5, 1));
    assert!(small > 1e-6 && (large / small - 2.0).abs() < 0.02, "{small:e} {large:e}");
    assert_eq!(small, of(1e-5, 1));
    assert!((of(1e-5, 2) / small - 1.0).abs() > 1e-3);
    let levels = |levels: u32| displaced(kind, &format!("levels = {levels}"));
    let (few, many) = (levels(40), levels(640));
    assert!(few > 5.0 * many && many > 1e-6, "{few:e} {many:e}");
    for carpet in ["gaussian-carpet", "quasi-conformal-carpet", "grating-carpet"] {
        let [small, large] = ["error = 1e-5", "error = 2e-5"].map(|error| displaced(carpet, error));
        assert!(
            small > 1e-6 && (large / small - 2.0).abs() < 0.02,
            "{carpet}: {small:e} {large:e}"
        );
    }
}

#[test]
fn a_lossy_graded_cloak_absorbs_along_the_optical_path() {
    let scene = |loss: &str| {
        assembly(&format!(
            "[light]\nwavelength_nm = 1000\n[[device]]\nkind = \"double-gaussian-cloak\"\nfresnel = false\n{loss}\n"
        ))
    };
    let (ideal, lossy) = (scene(""), scene("imperfection = { loss_tangent = 3e-7 }"));
    let limits = Limits { min_power: 0.0, ..LIMITS };
    let ray = launch(DVec3::new(-50.0, 3.0, 0.0), DVec3::new(1.0, -0.05, 0.1));
    let mut tracer = Tracer::new(&ideal, limits);
    let (leaves, outcome) = tracer.trace(&ray);
    outcome.assert_balanced(leaves, 1e-9, &ray);
    assert_eq!(leaves.len(), 1);
    let exit = leaves[0];
    // The optical path within: all of it less that in air before.
    let before = 25.0 / ray.direction.x;
    let inside = exit.optical_path - before;
    let kept = (-std::f64::consts::TAU / 1e-4 * 3e-7 * inside).exp();
    let mut tracer = Tracer::new(&lossy, limits);
    let (leaves, outcome) = tracer.trace(&ray);
    for i in 0..2 {
        assert!((leaves[0].power[i] / exit.power[i] - kept).abs() < 1e-9, "{kept}");
    }
    outcome.assert_balanced(&leaves[..1], 1e-9, &ray);
    assert_eq!(leaves[0].position, exit.position);
}
