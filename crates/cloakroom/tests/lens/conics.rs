//! Faces that form an exact image: Descartes' ovals that are conics, and the aplanatic points of a
//! sphere.

use super::{at_plane, through};
use crate::rays::assembly;
use glam::DVec3;

const N: f64 = 1.5168;

/// The rays along x at these heights all run through one point, and are as long to there.
fn assert_stigmatic(scene: &str, focus: DVec3, heights: &[f64]) {
    let bench = assembly(scene);
    let mut paths = Vec::new();
    for (k, height) in heights.iter().enumerate() {
        let (sin, cos) = (1.3 * k as f64).sin_cos();
        let leaf = through(&bench, DVec3::new(-30.0, height * cos, height * sin), DVec3::X);
        let off = at_plane(&leaf, focus.x).distance(focus);
        assert!(off < 1e-10, "{height}: {off}");
        paths.push(leaf.optical_path + leaf.direction.dot(focus - leaf.position));
    }
    for path in &paths {
        assert!((path - paths[0]).abs() < 1e-10, "{paths:?}");
    }
}

#[test]
fn a_hyperbolic_back_focuses_parallel_light_exactly() {
    // Light along the axis is not bent by the plane front; f = R/(n - 1).
    let (radius, thickness) = (8.0, 5.0);
    let scene = format!(
        "[[device]]\nkind = \"lens\"\nfront_radius = 0\nback_radius = -{radius}\n\
         back_conic = {:?}\nthickness = {thickness}\ndiameter = 12\nindex = {N}",
        -N * N
    );
    let focus = DVec3::X * (0.5 * thickness + radius / (N - 1.0));
    assert_stigmatic(&scene, focus, &[0.0, 0.7, 2.0, 4.4, 5.9]);
}

#[test]
fn an_elliptic_front_focuses_parallel_light_exactly() {
    // K = -1/n²: all light meets at n R/(n - 1) in the glass. The back is a sphere about that point.
    let (radius, thickness) = (6.0, 4.0);
    let focus = N * radius / (N - 1.0);
    let scene = format!(
        "[[device]]\nkind = \"lens\"\nfront_radius = {radius}\nfront_conic = {:?}\n\
         back_radius = {:?}\nthickness = {thickness}\ndiameter = 9\nindex = {N}",
        -1.0 / (N * N),
        focus - thickness
    );
    assert_stigmatic(&scene, DVec3::X * (focus - 0.5 * thickness), &[0.0, 0.7, 2.0, 3.3, 4.4]);
}

#[test]
fn a_sphere_has_aplanatic_points() {
    // Light that aims at n R behind the centre of a ball meets at R/n behind it, whatever its angle.
    // The back is a sphere about that point, so that it goes straight on.
    let radius = 5.0;
    let thickness = 2.0;
    let centre = -0.5 * thickness + radius;
    let (aim, focus) = (centre + N * radius, centre + radius / N);
    let bench = assembly(&format!(
        "[[device]]\nkind = \"lens\"\nfront_radius = {radius}\nback_radius = {:?}\n\
         thickness = {thickness}\ndiameter = 6\nindex = {N}",
        focus - 0.5 * thickness
    ));
    let mut paths = Vec::new();
    for k in 0..12 {
        let (height, turn) = (0.24 * f64::from(k), 1.1 * f64::from(k));
        let (sin, cos) = turn.sin_cos();
        let origin = DVec3::new(-20.0, height * 1.9 * cos, height * 1.9 * sin);
        let to = DVec3::X * aim - origin;
        let leaf = through(&bench, origin, to);
        let off = at_plane(&leaf, focus).distance(DVec3::X * focus);
        assert!(off < 1e-10, "{height}: {off}");
        // From a sphere about the point aimed at all ways are as long.
        let image = leaf.direction.dot(DVec3::X * focus - leaf.position);
        paths.push(leaf.optical_path + image - to.length());
    }
    assert!(paths.iter().all(|path| (path - paths[0]).abs() < 1e-10), "{paths:?}");
}
