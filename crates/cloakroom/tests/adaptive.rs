//! Samples where the picture has edges, on request.
#![allow(clippy::unwrap_used)]

use crate::pictures::{difference, png};
use cloakroom::output::RgbImage;

/// A coloured ball before the photograph.
fn scene(samples: u32, adaptive: f64) -> String {
    format!(
        r#"
        [camera]
        resolution = [160, 120]
        samples = {samples}
        adaptive = {adaptive}

        [[device]]
        kind = "body"
        shape = "sphere"
        radius = 10
        surface = {{ color = [0.2, 0.5, 0.1] }}
        "#
    )
}

/// How many pixels of two pictures differ by more than so many 8-bit steps.
fn astray(one: &RgbImage, other: &RgbImage, steps: u8) -> usize {
    one.pixels()
        .zip(other.pixels())
        .filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > steps))
        .count()
}

#[test]
fn blocks_of_one_colour_are_spared_samples_and_edges_get_all() {
    let [all, spared, few] = [(16, 0.0), (16, 6.0), (4, 0.0)].map(|(n, a)| png(&scene(n, a)));
    // Some blocks have got a quarter of the samples; next to none shows it, the edges least of all.
    assert!(astray(&all, &spared, 0) > 50);
    assert!(astray(&all, &spared, 2) < 40, "{}", astray(&all, &spared, 2));
    assert!(astray(&all, &few, 2) > 2000, "{}", astray(&all, &few, 2));
    // The ball's middle is of one colour: no sample could change it.
    assert_eq!(all.get_pixel(80, 60), spared.get_pixel(80, 60));
}

#[test]
fn too_few_samples_to_spare_any_are_all_taken() {
    assert_eq!(difference(&png(&scene(4, 200.0)), &png(&scene(4, 0.0))), (0, 0));
}
