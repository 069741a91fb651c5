//! Where in a patch rays are traced, and polynomials through what they find there.

use std::f64::consts::PI;

/// Nodes along a side at most.
pub(super) const MOST: usize = 5;

/// Terms of a polynomial at most.
const MOST_TERMS: usize = MOST * MOST;

/// The degrees, across and down the patch, of the Chebyshev polynomials that make each term: the
/// lower their sum, the earlier.
const DEGREES: [[usize; 2]; MOST_TERMS] = degrees();

const fn degrees() -> [[usize; 2]; MOST_TERMS] {
    let mut degrees = [[0; 2]; MOST_TERMS];
    let (mut term, mut sum) = (0, 0);
    while sum < 2 * MOST - 1 {
        let mut across = 0;
        while across <= sum {
            let down = sum - across;
            if across < MOST && down < MOST {
                degrees[term] = [across, down];
                term += 1;
            }
            across += 1;
        }
        sum += 1;
    }
    degrees
}

/// Where rays are traced in a patch.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Nodes along a side.
    side: usize,
    /// The nodes, row by row, and then the points between them where what a polynomial says is
    /// compared with what is true: all along the edges, and every other one within.
    pub points: Vec<[f64; 2]>,
    /// The terms at the latter.
    pub checks: Vec<Terms>,
    /// What each node counts for in each term.
    shares: Vec<f64>,
}

impl Grid {
    /// So many Chebyshev-Lobatto points along a side: the corners are among them, so that a straight
    /// cut through the patch parts them.
    pub fn new(side: usize) -> Self {
        let gaps = side - 1;
        let angle = |k: usize| PI * (gaps - k) as f64 / gaps as f64;
        let along: Vec<f64> = (0..side).map(|k| angle(k).cos()).collect();
        let middle = |k: usize| 0.5 * (along[k] + along[k + 1]);
        let nodes = along.iter().flat_map(|&y| along.iter().map(move |&x| [x, y]));
        let edges = (0..gaps).map(middle).flat_map(|m| [[m, -1.0], [m, 1.0], [-1.0, m], [1.0, m]]);
        let within = (0..gaps).flat_map(|j| (0..gaps).map(move |i| (i, j)));
        let within = within.filter(|(i, j)| (i + j) % 2 == 0).map(|(i, j)| [middle(i), middle(j)]);
        let points: Vec<_> = nodes.chain(edges).chain(within).collect();
        let checks = points[side * side..].iter().map(|point| Terms::at(*point)).collect();
        // Along a side: the discrete cosine transform.
        let half = |k: usize| if k == 0 || k == gaps { 0.5 } else { 1.0 };
        let share = |degree: usize, k: usize| {
            let all = 2.0 / gaps as f64 * half(degree) * half(k);
            if degree < side { all * (degree as f64 * angle(k)).cos() } else { 0.0 }
        };
        let of_term = |[across, down]: [usize; 2]| {
            (0..side * side).map(move |node| share(across, node % side) * share(down, node / side))
        };
        let shares = DEGREES.into_iter().flat_map(of_term).collect();
        Self { side, points, checks, shares }
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        self.side * self.side
    }

    /// How many neighbours among the nodes, across and down, differ in whether they are among the
    /// given points: see [`bits`].
    pub fn cuts(&self, points: u64) -> [usize; 2] {
        let is_in = |column: usize, row: usize| points >> (row * self.side + column) & 1;
        let mut cuts = [0; 2];
        for i in 0..self.side {
            for k in 1..self.side {
                cuts[0] += usize::from(is_in(k, i) != is_in(k - 1, i));
                cuts[1] += usize::from(is_in(i, k) != is_in(i, k - 1));
            }
        }
        cuts
    }

    /// The coefficients of the polynomials through the values of [`LANES`] functions at the nodes.
    pub fn coefficients(&self, values: &[[f64; LANES]]) -> Coefficients {
        let mut coefficients = [[0.0; LANES]; MOST_TERMS];
        for (sums, shares) in coefficients.iter_mut().zip(self.shares.chunks(self.nodes())) {
            add_products(sums, shares, values);
        }
        coefficients
    }

    /// Along which axis functions of these coefficients are the less smooth: by those of the highest
    /// degree.
    pub fn rougher(&self, coefficients: &[Coefficients]) -> usize {
        let leading = |axis: usize| -> f64 {
            let terms = coefficients.iter().flat_map(|lane| lane.iter().zip(DEGREES));
            let terms = terms.filter(|(_, degrees)| degrees[axis] == self.side - 1);
            terms.flat_map(|(values, _)| values).map(|value| value * value).sum()
        };
        usize::from(leading(1) > leading(0))
    }
}

/// The terms of a polynomial at one place of a patch, whose coordinates go from -1 to 1. None is
/// ever above 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms([f64; MOST_TERMS]);

impl Terms {
    #[inline(always)]
    pub fn at(place: [f64; 2]) -> Self {
        let [across, down] = place.map(|x| {
            let second = 2.0 * x * x - 1.0;
            [1.0, x, second, x * (2.0 * second - 1.0), 2.0 * second * second - 1.0]
        });
        Self(std::array::from_fn(|term| {
            let [i, j] = DEGREES[term];
            across[i] * down[j]
        }))
    }

    /// The values here of [`LANES`] polynomials, given the coefficients of their first terms.
    #[inline(always)]
    pub fn sum(&self, coefficients: &[[f64; LANES]]) -> [f64; LANES] {
        let mut sums = [0.0; LANES];
        add_products(&mut sums, &self.0, coefficients);
        sums
    }
}

#[inline(always)]
fn add_products(sums: &mut [f64; LANES], factors: &[f64], values: &[[f64; LANES]]) {
    for (factor, values) in factors.iter().zip(values) {
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += factor * value;
        }
    }
}

/// Those of [`LANES`] functions, term by term.
pub(super) type Coefficients = [[f64; LANES]; MOST_TERMS];

/// Points, by their numbers, as bits.
pub(super) fn bits(points: impl Iterator<Item = usize>) -> u64 {
    points.fold(0, |bits, point| bits | 1 << point)
}

/// So many functions are interpolated at once.
pub(super) const LANES: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    fn grids() -> impl Iterator<Item = Grid> {
        [3, 4, 5].into_iter().map(Grid::new)
    }

    /// Polynomials of a degree below the number of nodes are what they are.
    #[test]
    fn polynomials_are_met() {
        for grid in grids() {
            let degree = grid.side as i32 - 1;
            let value = |[x, y]: [f64; 2]| (1.3 - x).powi(degree) * (y + 0.4).powi(degree);
            let at_nodes: Vec<_> =
                (grid.points[..grid.nodes()].iter()).map(|point| [value(*point); LANES]).collect();
            let coefficients = grid.coefficients(&at_nodes);
            for point in grid.points.iter().copied().chain([[0.3, -0.8], [0.91, 0.17]]) {
                let sum = Terms::at(point).sum(&coefficients);
                assert!((sum[3] - value(point)).abs() < 1e-13, "{point:?}: {sum:?}");
            }
            assert!(grid.points.len() <= 64, "they are bits of a number");
        }
    }

    #[test]
    fn the_first_terms_are_those_of_the_lowest_degrees() {
        let sums = DEGREES.map(|[across, down]| across + down);
        assert!(sums.is_sorted());
        let all: std::collections::BTreeSet<_> = DEGREES.into_iter().collect();
        assert_eq!(all.len(), MOST_TERMS);
    }

    #[test]
    fn patches_are_cut_where_they_part() {
        for grid in grids() {
            let beyond = |axis: usize| {
                let points = grid.points.iter().enumerate();
                bits(points.filter(|(_, point)| point[axis] > 0.3).map(|(i, _)| i))
            };
            assert_eq!(grid.cuts(beyond(0)), [grid.side, 0]);
            assert_eq!(grid.cuts(beyond(1)), [0, grid.side]);
            let steep = |axis: usize| {
                let nodes = grid.points[..grid.nodes()].iter();
                let values: Vec<_> =
                    nodes.map(|point| [(1.0 + 5.0 * point[axis]).sin(); LANES]).collect();
                grid.coefficients(&values)
            };
            assert_eq!([0, 1].map(|axis| grid.rougher(&[steep(axis)])), [0, 1]);
        }
    }
}
