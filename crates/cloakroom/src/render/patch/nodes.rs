//! Where in a patch rays are traced, and polynomials through what they find there.

use std::f64::consts::FRAC_1_SQRT_2;

/// Nodes along a side.
const SIDE: usize = 5;

/// All nodes of a patch.
pub(super) const COUNT: usize = SIDE * SIDE;

/// The Chebyshev-Lobatto points of a patch, whose coordinates go from -1 to 1: its corners are among
/// them, so that a straight cut through the patch parts them.
const ALONG: [f64; SIDE] = [-1.0, -FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2, 1.0];

/// Where rays are traced in a patch.
#[derive(Clone, Debug)]
pub(super) struct Nodes {
    /// What makes each Lagrange polynomial 1 at its node.
    scales: [f64; SIDE],
    /// The nodes, row by row, and then the points between them where what a polynomial says is
    /// compared with what is true: all along the edges, and every other one within.
    pub points: Vec<[f64; 2]>,
    /// What the nodes count for at the latter.
    pub checks: Vec<Weights>,
}

impl Nodes {
    pub fn new() -> Self {
        let mut scales = [0.0; SIDE];
        for (k, (scale, node)) in scales.iter_mut().zip(ALONG).enumerate() {
            let others = ALONG.iter().enumerate().filter(|(j, _)| *j != k);
            *scale = 1.0 / others.map(|(_, other)| node - other).product::<f64>();
        }
        let mut nodes = Self { scales, points: Self::points(), checks: Vec::new() };
        let between = nodes.points[COUNT..].iter();
        nodes.checks = between.map(|point| nodes.weights(*point)).collect();
        nodes
    }

    fn points() -> Vec<[f64; 2]> {
        let middle = |k: usize| 0.5 * (ALONG[k] + ALONG[k + 1]);
        let gaps = SIDE - 1;
        let nodes = ALONG.iter().flat_map(|&y| ALONG.iter().map(move |&x| [x, y]));
        let edges = (0..gaps).map(middle).flat_map(|m| [[m, -1.0], [m, 1.0], [-1.0, m], [1.0, m]]);
        let within = (0..gaps).flat_map(|j| (0..gaps).map(move |i| (i, j)));
        let within = within.filter(|(i, j)| (i + j) % 2 == 0).map(|(i, j)| [middle(i), middle(j)]);
        nodes.chain(edges).chain(within).collect()
    }

    /// How many neighbours among the nodes, across and down, differ in whether they are among the
    /// given points: see [`bits`].
    pub fn cuts(&self, points: u64) -> [usize; 2] {
        let is_in = |column: usize, row: usize| points >> (row * SIDE + column) & 1;
        let mut cuts = [0; 2];
        for i in 0..SIDE {
            for k in 1..SIDE {
                cuts[0] += usize::from(is_in(k, i) != is_in(k - 1, i));
                cuts[1] += usize::from(is_in(i, k) != is_in(i, k - 1));
            }
        }
        cuts
    }

    /// Along which axis functions of these values at the nodes are the less smooth: by the leading
    /// coefficients of their polynomials.
    pub fn rougher(&self, values: &[[f64; LANES]]) -> usize {
        let leading = |start: usize, step: usize| {
            let mut sums = [0.0; LANES];
            for (k, scale) in self.scales.iter().enumerate() {
                for (sum, value) in sums.iter_mut().zip(values[start + k * step]) {
                    *sum += scale * value;
                }
            }
            sums.iter().map(|sum| sum * sum).sum::<f64>()
        };
        let across: f64 = (0..SIDE).map(|row| leading(row * SIDE, 1)).sum();
        let down: f64 = (0..SIDE).map(|column| leading(column, SIDE)).sum();
        usize::from(down > across)
    }

    /// What each node counts for at a point.
    #[inline(always)]
    pub fn weights(&self, [x, y]: [f64; 2]) -> Weights {
        let mut weights = Weights([0.0; COUNT]);
        let [across, down] = [self.along_side(x), self.along_side(y)];
        for (row, down) in weights.0.chunks_exact_mut(SIDE).zip(down) {
            for (weight, across) in row.iter_mut().zip(across) {
                *weight = across * down;
            }
        }
        weights
    }

    /// The Lagrange polynomials at a place along a side.
    #[inline(always)]
    fn along_side(&self, x: f64) -> [f64; SIDE] {
        let mut values = self.scales;
        let mut product = 1.0;
        for (value, node) in values.iter_mut().zip(ALONG) {
            *value *= product;
            product *= x - node;
        }
        product = 1.0;
        for (value, node) in values.iter_mut().zip(ALONG).rev() {
            *value *= product;
            product *= x - node;
        }
        values
    }
}

/// What each node counts for at one point, row by row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights([f64; COUNT]);

impl Weights {
    /// The values at a point of [`LANES`] functions, whose values at the nodes are given node by
    /// node.
    #[inline(always)]
    pub fn mean(&self, values: &[[f64; LANES]]) -> [f64; LANES] {
        let mut sums = [0.0; LANES];
        for (weight, values) in self.0.iter().zip(values) {
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += weight * value;
            }
        }
        sums
    }
}

/// Points, by their numbers, as bits.
pub(super) fn bits(points: impl Iterator<Item = usize>) -> u64 {
    points.fold(0, |bits, point| bits | 1 << point)
}

/// So many functions are interpolated at once.
pub(super) const LANES: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    /// Polynomials of a degree below the number of nodes are what they are.
    #[test]
    fn polynomials_are_met() {
        let nodes = Nodes::new();
        let value = |[x, y]: [f64; 2]| (1.3 - x).powi(4) * (y + 0.4).powi(4);
        let at_nodes: Vec<_> =
            nodes.points[..COUNT].iter().map(|point| [value(*point); LANES]).collect();
        for point in nodes.points.iter().copied().chain([[0.3, -0.8], [0.91, 0.17]]) {
            let mean = nodes.weights(point).mean(&at_nodes);
            assert!((mean[3] - value(point)).abs() < 1e-13, "{point:?}: {mean:?}");
        }
        assert!(nodes.points.len() <= 64, "they are bits of a number");
    }

    #[test]
    fn patches_are_cut_where_they_part() {
        let nodes = Nodes::new();
        let beyond = |axis: usize| {
            let points = nodes.points.iter().enumerate();
            bits(points.filter(|(_, point)| point[axis] > 0.3).map(|(i, _)| i))
        };
        assert_eq!(nodes.cuts(beyond(0)), [SIDE, 0]);
        assert_eq!(nodes.cuts(beyond(1)), [0, SIDE]);
        let steep = |axis: usize| -> Vec<_> {
            nodes.points[..COUNT]
                .iter()
                .map(|point| [(1.0 + 5.0 * point[axis]).sin(); LANES])
                .collect()
        };
        assert_eq!([0, 1].map(|axis| nodes.rougher(&steep(axis))), [0, 1]);
    }
}
