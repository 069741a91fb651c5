//! FLIP: how different two pictures look when one alternates between them. Andersson, Nilsson,
//! Akenine-Möller, Oskarsson, Åström & Fairchild, Proc. ACM Comput. Graph. Interact. Tech. 3, 15
//! (2020); the form for displays of standard range. Its constants and the names of its stages are
//! the paper's.

use super::View;
use super::plane::{Plane, gaussian};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Pixels per degree of a display 0.7 m away, 0.7 m wide, with 3840 pixels across: the paper's.
pub const DEFAULT_PIXELS_PER_DEGREE: f64 = 67.020_641;

/// Linear sRGB to XYZ.
const TO_XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// Exponents and limits of the paper's final stages: q_c, p_c, p_t, q_f, and the width w of
/// features in degrees.
const COLOR_EXPONENT: f64 = 0.7;
const COLOR_SHARE: f64 = 0.4;
const COLOR_TARGET: f64 = 0.95;
const FEATURE_EXPONENT: f64 = 0.5;
const FEATURE_WIDTH: f64 = 0.082;

/// The difference of each pixel, from 0 to 1, row by row. Light is held to what a display can show.
///
/// Both views must be of one size.
#[must_use]
pub fn flip(reference: &View, test: &View, pixels_per_degree: f64) -> Vec<f64> {
    let [one, other] = [reference, test].map(opponent);
    let [seen_one, seen_other] = [&one, &other].map(|planes| seen(planes, pixels_per_degree));
    let colors = color_differences(&seen_one, &seen_other);
    let features = feature_differences(&one[0], &other[0], pixels_per_degree);
    colors.iter().zip(features).map(|(color, feature)| color.powf(1.0 - feature)).collect()
}

/// A color as a product of a matrix.
fn times(matrix: &[[f64; 3]; 3], [a, b, c]: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * a + row[1] * b + row[2] * c)
}

/// XYZ of white.
fn white() -> [f64; 3] {
    times(&TO_XYZ, [1.0; 3])
}

/// The inverse of a matrix, by the adjugate.
fn inverse(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[r][c] * m[s][d] - m[r][d] * m[s][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant))
}

/// The planes Y, Cx and Cz of the opponent colors, of which Y is relative luminance, 0 to 1.
fn opponent(view: &View) -> [Plane; 3] {
    let white = white();
    let colors: Vec<[f64; 3]> = (0..view.pixels())
        .map(|i| {
            let rgb = view.light.each_ref().map(|plane| plane[i].clamp(0.0, 1.0));
            let xyz = times(&TO_XYZ, rgb);
            let [x, y, z] = std::array::from_fn(|k| xyz[k] / white[k]);
            [y, x - y, y - z]
        })
        .collect();
    let plane =
        |k: usize| Plane { width: view.width, values: colors.iter().map(|c| c[k]).collect() };
    [0, 1, 2].map(plane)
}

/// The contrast sensitivity as a Gaussian kernel: its b in square degrees.
fn sensitivity(b: f64, pixels_per_degree: f64, reach: usize) -> Vec<f64> {
    gaussian(pixels_per_degree * (b / 2.0).sqrt() / PI, reach)
}

/// What the eye makes of opponent colors at a distance, as Hunt-adjusted L*a*b*.
fn seen(planes: &[Plane; 3], pixels_per_degree: f64) -> Vec<[f64; 3]> {
    // Both Gaussians of blue-yellow: (a, b).
    const BLUE_YELLOW: [[f64; 2]; 2] = [[34.1, 0.04], [13.5, 0.025]];
    let widest = BLUE_YELLOW[0][1];
    let reach = (3.0 * (widest / 2.0).sqrt() / PI * pixels_per_degree).ceil() as usize;
    let filtered = |plane: &Plane, b: f64| {
        let kernel = sensitivity(b, pixels_per_degree, reach);
        plane.filtered(&kernel, &kernel)
    };
    let luminance = filtered(&planes[0], 0.0047);
    let red_green = filtered(&planes[1], 0.0053);
    // Each Gaussian's kernel has sum 1; what it counts for is its amplitude times its sum over the
    // pixels.
    let counts = BLUE_YELLOW.map(|[a, b]| {
        let value = |k: usize| {
            let x = (k as f64 - reach as f64) / pixels_per_degree;
            (-(PI * x).powi(2) / b).exp()
        };
        a * (PI / b).sqrt() * (0..=2 * reach).map(value).sum::<f64>().powi(2)
    });
    let [first, second] = counts.map(|count| count / (counts[0] + counts[1]));
    let blue_yellow = filtered(&planes[2], BLUE_YELLOW[0][1])
        .zip(&filtered(&planes[2], BLUE_YELLOW[1][1]), |a, b| first * a + second * b);
    let (white, to_rgb) = (white(), inverse(&TO_XYZ));
    (0..luminance.values.len())
        .into_par_iter()
        .map(|i| {
            let y = luminance.values[i];
            let relative = [red_green.values[i] + y, y, y - blue_yellow.values[i]];
            let xyz = std::array::from_fn(|k| relative[k] * white[k]);
            adjusted_lab(times(&to_rgb, xyz).map(|light| light.clamp(0.0, 1.0)))
        })
        .collect()
}

/// Hunt-adjusted L*a*b* of linear sRGB.
fn adjusted_lab(rgb: [f64; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let white = white();
    let xyz = times(&TO_XYZ, rgb);
    let [x, y, z] = std::array::from_fn(|k| {
        let t: f64 = xyz[k] / white[k];
        if t > DELTA.powi(3) { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    });
    let lightness = 116.0 * y - 16.0;
    let adjust = 0.01 * lightness;
    [lightness, adjust * 500.0 * (x - y), adjust * 200.0 * (y - z)]
}

/// The HyAB distance of two colors.
fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// Differences of color, compressed into 0 to 1.
fn color_differences(a: &[[f64; 3]], b: &[[f64; 3]]) -> Vec<f64> {
    let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(adjusted_lab);
    let largest = distance(green, blue).powf(COLOR_EXPONENT);
    let bend = COLOR_SHARE * largest;
    let compressed = |difference: f64| {
        if difference < bend {
            COLOR_TARGET / bend * difference
        } else {
            COLOR_TARGET + (difference - bend) / (largest - bend) * (1.0 - COLOR_TARGET)
        }
    };
    a.iter().zip(b).map(|(a, b)| compressed(distance(*a, *b).powf(COLOR_EXPONENT))).collect()
}

/// Differences of edges and points in luminance, from 0 to 1.
fn feature_differences(a: &Plane, b: &Plane, pixels_per_degree: f64) -> Vec<f64> {
    let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    let reach = (3.0 * deviation).ceil() as usize;
    let along = gaussian(deviation, reach);
    let derivative = |weight: &dyn Fn(f64) -> f64| {
        let place = |k: usize| k as f64 - reach as f64;
        let kernel = (0..along.len()).map(|k| weight(place(k)) * along[k]);
        balanced(kernel.collect())
    };
    let edge = derivative(&|x| -x);
    let point = derivative(&|x| x * x / (deviation * deviation) - 1.0);
    let strength = |plane: &Plane, kernel: &[f64]| {
        plane.filtered(kernel, &along).zip(&plane.filtered(&along, kernel), f64::hypot).values
    };
    let change = |kernel: &[f64]| -> Vec<f64> {
        let (a, b) = (strength(a, kernel), strength(b, kernel));
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect()
    };
    let (edges, points) = (change(&edge), change(&point));
    edges
        .iter()
        .zip(points)
        .map(|(edge, point)| (edge.max(point) * 0.5f64.sqrt()).powf(FEATURE_EXPONENT))
        .collect()
}

/// A kernel whose positive weights add up to 1 and whose negative ones to -1.
fn balanced(kernel: Vec<f64>) -> Vec<f64> {
    let sum = |sign: f64| kernel.iter().map(|v| (sign * v).max(0.0)).sum::<f64>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    kernel.iter().map(|v| if *v > 0.0 { v / positive } else { v / negative }).collect()
}

#[cfg(test)]
mod tests {
    use super::super::comparison::tests::{even, patterns};
    use super::*;

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    #[test]
    fn it_is_that_of_its_authors() {
        // flip-evaluator 1.7, evaluate(a, b, "LDR", inputsRGB=False): mean, and three pixels.
        let [a, b] = patterns();
        let map = flip(&a, &b, DEFAULT_PIXELS_PER_DEGREE);
        assert!((mean(&map) - 0.506_904_13).abs() < 2e-5, "{}", mean(&map));
        let at = |column: usize, row: usize| map[row * a.width + column];
        for (value, expected) in
            [(at(0, 0), 0.895_346_64), (at(30, 20), 0.634_127_86), (at(55, 39), 0.761_943_76)]
        {
            assert!((value - expected).abs() < 1e-4, "{value} {expected}");
        }
    }

    #[test]
    fn even_pictures_are_as_different_as_their_colors() {
        let (white, black) = (even(1.0), even(0.0));
        let map = flip(&white, &black, DEFAULT_PIXELS_PER_DEGREE);
        // One pixel of the authors' program, whose matrices between colors are rounded at about
        // 3e-5.
        assert!((mean(&map) - 0.967_388).abs() < 2e-5, "{}", mean(&map));
        let only = |color: usize| {
            let mut view = even(0.0);
            view.light[color].fill(1.0);
            view
        };
        let map = flip(&only(1), &only(2), DEFAULT_PIXELS_PER_DEGREE);
        assert!((mean(&map) - 1.0).abs() < 1e-6);
        assert!(flip(&white, &white, DEFAULT_PIXELS_PER_DEGREE).iter().all(|v| *v == 0.0));
    }
}
