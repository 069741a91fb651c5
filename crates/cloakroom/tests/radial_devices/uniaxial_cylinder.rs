//! Cylindrical cloaks of uniaxial dielectric: exact in the plane for one polarization, and how they
//! fail off the plane.

use super::{assembly, launch, leaves};
use cloakroom::trace::Leaf;
use glam::DVec3;

fn cloak(material: &str) -> String {
    format!("'cylinder-cloak'\ninner = 1\nouter = 2\nmaterial = '{material}-uniaxial'")
}

/// The strongest of the leaves of vertical light that have not been reflected to the side of the
/// source.
fn strongest(leaves: &[Leaf<2>]) -> &Leaf<2> {
    let ahead = leaves.iter().filter(|leaf| leaf.direction.x > 0.5);
    ahead.max_by(|a, b| a.power[1].total_cmp(&b.power[1])).unwrap()
}

#[test]
fn vertical_light_in_the_plane_is_cloaked_but_for_reflections() {
    for material in ["radial", "azimuthal"] {
        let assembly = assembly(&cloak(material));
        for step in 0..400 {
            let y = -1.99 + 0.009_95 * f64::from(step);
            let ray = launch(DVec3::new(-10.0, y, 0.0), DVec3::X);
            let all = leaves(&assembly, &ray);
            let through = strongest(&all);
            assert!(through.direction.distance(DVec3::X) < 1e-9, "{material} {y}");
            assert!((through.position.y - y).abs() < 1e-9, "{material} {y}");
            let expected = 10.0 + through.position.x;
            assert!((through.optical_path - expected).abs() < 1e-9, "{material} {y}");
            // Horizontal light does not take that way, but at the rim.
            assert!(y.abs() > 1.9 || through.power[0] < 1e-9, "{material} {y}");
        }
        // At the axis the border reflects (a/(2b - a))², one ninth, of vertical light.
        let all = leaves(&assembly, &launch(DVec3::new(-10.0, 0.0, 0.0), DVec3::X));
        let back = all.iter().filter(|leaf| (leaf.optical_path - 8.0).abs() < 1e-9);
        let power: f64 = back.clone().map(|leaf| leaf.power[1]).sum();
        assert!((power - 1.0 / 9.0).abs() < 1e-9, "{material} {power}");
        let horizontal: f64 = back.map(|leaf| leaf.power[0]).sum();
        let expected = if material == "radial" { 1.0 / 9.0 } else { 0.0 };
        assert!((horizontal - expected).abs() < 1e-9, "{material} {horizontal}");
        assert!((strongest(&all).power[1] - (8.0f64 / 9.0).powi(2)).abs() < 1e-9);
    }
}

/// At an elevation of 10 degrees and impact 0.3 the extraordinary ray leaves off its line by: angle
/// in the plane, degrees; shift of the exit in the plane; shift along z.
fn failure(material: &str) -> (f64, f64, f64) {
    let (sin, cos) = 10f64.to_radians().sin_cos();
    let ray = launch(DVec3::new(-10.0, 0.3, 0.0), DVec3::new(cos, 0.0, sin));
    let all = leaves(&assembly(&cloak(material)), &ray);
    let leaf = strongest(&all);
    let x = (4.0f64 - 0.09).sqrt();
    let off = leaf.position - DVec3::new(x, 0.3, ray.direction.z / ray.direction.x * (x + 10.0));
    let angle = leaf.direction.y.atan2(leaf.direction.x).to_degrees();
    (angle.abs(), off.truncate().length(), off.z)
}

#[test]
fn the_azimuthal_axis_is_far_better_off_the_plane() {
    let (angle, beside, along) = failure("azimuthal");
    assert!((angle - 0.2).abs() < 0.005 && (beside - 0.007).abs() < 5e-4, "{angle} {beside}");
    assert!((along + 0.53).abs() < 0.01, "{along}");
    let (angle, beside, along) = failure("radial");
    assert!((angle - 29.0).abs() < 0.5 && (beside - 1.0).abs() < 0.05, "{angle} {beside}");
    assert!((along - 1.7).abs() < 0.05, "{along}");
}

#[test]
fn horizontal_light_at_the_axis_meets_the_metal_or_turns_back() {
    let central = launch(DVec3::new(-10.0, 0.0, 0.0), DVec3::X);
    for (material, path) in [
        // Index 2 to the metal and back.
        ("radial", 8.0 + 2.0 * 2.0),
        // Twice the integral of 2 (r - 1)/r from 1 to 2.
        ("azimuthal", 8.0 + 4.0 * (1.0 - 2f64.ln())),
    ] {
        let all = leaves(&assembly(&cloak(material)), &central);
        let back = all
            .iter()
            .filter(|leaf| leaf.direction.distance(DVec3::NEG_X) < 1e-9)
            .find(|leaf| (leaf.optical_path - path).abs() < 1e-9)
            .unwrap();
        let expected = if material == "radial" { (8.0f64 / 9.0).powi(2) } else { 1.0 };
        assert!((back.power[0] - expected).abs() < 1e-9, "{material} {back:?}");
        assert!(back.power[1] < 1e-9, "{material} {back:?}");
    }
}
