//! Bodies: against Snell and Fresnel, in one another, opaque and absorbing, and what cannot be.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod snell;

use crate::rays::{assembly, launch, launches_around, refusal};
use cloakroom::trace::{Launch, Leaf, Limits, Tracer};
use glam::DVec3;

const LIMITS: Limits = Limits { min_power: 1e-7, tolerance: 1e-9 };

fn body(keys: &str) -> String {
    format!("[[device]]\nkind = \"body\"\n{keys}\n")
}

/// Rays from all around that come near the origin.
fn launches(count: u32, reach: f64) -> impl Iterator<Item = Launch<2>> {
    launches_around(count, [60.0, 40.0], DVec3::splat(reach))
}

/// Surfaces in one place are one surface: two boxes face to face, and boxes in a box up to its
/// face, leave what one box leaves.
#[test]
fn bodies_face_to_face_have_no_air_between() {
    let part = |size: f64, x: f64, priority: i32| {
        body(&format!(
            "shape = \"box\"\nsize = [{size}, 6, 6]\nposition = [{x}, 0, 0]\npermittivity = 2\n\
             priority = {priority}"
        ))
    };
    let whole = assembly(&part(6.0, 0.0, 0));
    let mut tracer = Tracer::new(&whole, LIMITS);
    for text in [
        part(2.0, -2.0, 0) + &part(4.0, 1.0, 0),
        part(6.0, 0.0, 0) + &part(3.0, 1.5, 1) + &part(1.0, 2.5, 2),
    ] {
        let assembly = assembly(&text);
        let mut parts = Tracer::new(&assembly, LIMITS);
        for launch in launches(500, 8.0) {
            let (leaves, _) = tracer.trace(&launch);
            let (others, outcome) = parts.trace(&launch);
            assert_eq!((leaves.len(), outcome.stats.lost), (others.len(), 0), "{launch:?}");
            for (one, other) in leaves.iter().zip(others) {
                assert!((one.position - other.position).length() < 1e-9);
                assert!((one.power[0] - other.power[0]).abs() < 1e-12);
                assert!((one.optical_path - other.optical_path).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn opaque_bodies_end_rays_and_absorbing_ones_dim_them() {
    let text = body("shape = \"sphere\"\nsurface = { color = [1, 0.2, 0] }")
        + &body(
            "shape = \"box\"\nposition = [20, 0, 0]\nsize = [4, 40, 40]\npermittivity = [1.2, 4e-7]",
        );
    let assembly = assembly(&text);
    let mut tracer = Tracer::new(&assembly, LIMITS);
    let (leaves, _) = tracer.trace(&launch(DVec3::new(-20.0, 1.0, 0.0), DVec3::X));
    let [leaf] = leaves else { panic!("one leaf") };
    assert_eq!((leaf.body(), leaf.power), (Some(0), [1.0; 2]));
    assert!((leaf.position.length() - 5.0).abs() < 1e-12);
    let launch = launch(DVec3::new(-20.0, 7.0, 0.0), DVec3::X);
    let (leaves, outcome) = tracer.trace(&launch);
    let index = num_complex::Complex64::new(1.2, 4e-7).sqrt();
    let kept = (-2.0 * std::f64::consts::TAU / 5.5e-5 * index.im * 4.0).exp();
    let r = ((index - 1.0) / (index + 1.0)).norm_sqr();
    let absorbed = (1.0 - r) * (1.0 - kept) / (1.0 - r * kept);
    assert!((outcome.absorbed[0] - absorbed).abs() < 1e-6 && kept < 0.9);
    outcome.assert_balanced(leaves, 1e-12, &launch);
}

#[test]
fn a_group_index_sets_the_time_alone() {
    let assembly =
        assembly(&body("thickness = 4\npermittivity = -1\npermeability = -1\ngroup_index = 3"));
    let mut tracer = Tracer::new(&assembly, LIMITS);
    let (leaves, _) = tracer.trace(&launch(DVec3::new(-5.0, 0.0, 0.0), DVec3::X));
    assert!((leaves[0].optical_path - (3.0 - 4.0)).abs() < 1e-12);
    assert!((leaves[0].delay_path - (3.0 + 12.0)).abs() < 1e-12);
}

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    let ball = "shape = \"sphere\"\npermittivity = 2";
    for (text, place, words) in [
        (body(ball) + &body(ball), "test:5:1", "same priority"),
        (
            body(ball) + &body("priority = 1") + "[[device]]\nkind = \"square-cloak\"\n",
            "test:8:1",
            "overlaps",
        ),
        (body("shape = \"box\"\nradius = 3"), "test:4:10", "size"),
        (body("shape = \"box\"\nlength = 3"), "test:4:10", "no length"),
        (body("show = \"bare\""), "test:3:8", "show = \"cloak\""),
        (body("surface = { colour = [1, 0, 0] }"), "test:3:13", "`color`"),
        (body("surface = { color = [1, 0, -1] }"), "test:3:21", "third component"),
        (body("surface = 3"), "test:3:11", "a table with the keys color, image"),
        (body("permittivity = 2\nsurface = {}"), "test:3:16", "opaque"),
        (body("group_index = 0.5"), "test:3:15", "from 1"),
    ] {
        let error = refusal(&text);
        assert!(error.starts_with(place) && error.contains(words), "{text}\n{error}");
    }
    let many: String = (0..65)
        .map(|i| body(&format!("shape = \"sphere\"\nradius = 1\nposition = [{}, 0, 0]", 3 * i)))
        .collect();
    assert_eq!(assembly(&many).devices().len(), 65);
}

/// Tensors are those of the body's own frame, as in a prism.
#[test]
fn a_turned_anisotropic_box_is_the_turned_prism() {
    let medium = "permittivity = [[2.5, 0.3, 0.1], [0.3, 1.8, 0], [0.1, 0, [1.4, 2e-7]]]\n";
    let place = "rotation = 23\nposition = [1, -2, 0.5]\n";
    let boxed = assembly(&body(&format!("{place}shape = \"box\"\nsize = [6, 8, 7]\n{medium}")));
    let prism = assembly(&format!(
        "[[device]]\nkind = \"prisms\"\nlength = 7\n{place}[[device.prism]]\n\
         corners = [[-3, -4], [3, -4], [3, 4], [-3, 4]]\n{medium}"
    ));
    let limits = Limits { min_power: 1e-3, tolerance: 1e-9 };
    let (mut one, mut other) = (Tracer::new(&boxed, limits), Tracer::new(&prism, limits));
    let by_path = |leaves: &[Leaf<2>]| {
        let mut leaves = leaves.to_vec();
        leaves.sort_by(|a, b| b.power[0].total_cmp(&a.power[0]));
        leaves
    };
    for launch in launches(300, 8.0) {
        let leaves = by_path(one.trace(&launch).0);
        let (others, outcome) = other.trace(&launch);
        let others = by_path(others);
        assert_eq!(outcome.stats.lost, 0);
        for (a, b) in leaves.iter().zip(&others).take(3) {
            assert!((a.power[0] - b.power[0]).abs() < 1e-9, "{launch:?} {a:?} {b:?}");
            assert!((a.optical_path - b.optical_path).abs() < 1e-7 || a.power[0] < 1e-2);
        }
    }
}
