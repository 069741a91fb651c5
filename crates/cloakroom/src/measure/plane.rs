//! Planes of numbers, filtered by kernels that are products of one along rows and one along
//! columns.

use rayon::prelude::*;

/// A plane of numbers, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plane {
    pub width: usize,
    pub values: Vec<f64>,
}

impl Plane {
    /// Convolves with a kernel across and one down, both of odd length; the edge goes on beyond
    /// itself.
    pub fn filtered(&self, across: &[f64], down: &[f64]) -> Self {
        let (width, height) = (self.width, self.values.len() / self.width);
        let reach = across.len() / 2;
        let mut rows = vec![0.0; self.values.len()];
        rows.par_chunks_mut(width).zip(self.values.par_chunks(width)).for_each(|(out, row)| {
            for (x, out) in out.iter_mut().enumerate() {
                let value = |k: usize| row[(x + k).saturating_sub(reach).min(width - 1)];
                *out = across.iter().enumerate().map(|(k, weight)| weight * value(k)).sum();
            }
        });
        let reach = down.len() / 2;
        let mut values = vec![0.0; self.values.len()];
        values.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
            for (k, weight) in down.iter().enumerate() {
                let from = (y + k).saturating_sub(reach).min(height - 1) * width;
                for (out, value) in out.iter_mut().zip(&rows[from..from + width]) {
                    *out += weight * value;
                }
            }
        });
        Self { width, values }
    }

    /// The plane of a function of two planes.
    pub fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let pairs = self.values.iter().zip(&other.values);
        Self { width: self.width, values: pairs.map(|(a, b)| f(*a, *b)).collect() }
    }
}

/// A Gaussian of a standard deviation (pixels), cut at a reach to either side, of sum 1.
pub(super) fn gaussian(deviation: f64, reach: usize) -> Vec<f64> {
    let value = |k: usize| (-0.5 * ((k as f64 - reach as f64) / deviation).powi(2)).exp();
    let kernel: Vec<f64> = (0..=2 * reach).map(value).collect();
    let sum: f64 = kernel.iter().sum();
    kernel.into_iter().map(|value| value / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filters_keep_what_is_even_and_spread_what_is_not() {
        let even = Plane { width: 5, values: vec![3.0; 20] };
        let kernel = gaussian(1.2, 4);
        assert!(even.filtered(&kernel, &kernel).values.iter().all(|v| (v - 3.0).abs() < 1e-14));
        let mut point = Plane { width: 9, values: vec![0.0; 81] };
        point.values[40] = 1.0;
        let spread = point.filtered(&kernel, &[1.0]);
        assert_eq!(spread.values[36..45], kernel);
        let down = point.filtered(&[1.0], &[0.0, 0.25, 0.75]);
        // The convention of correlation: the last weight takes what lies below.
        assert_eq!((down.values[31], down.values[40], down.values[49]), (0.75, 0.25, 0.0));
    }
}
