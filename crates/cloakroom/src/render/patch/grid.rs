//! Where in a patch rays are traced, and polynomials through what they find there.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// How nodes lie in a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// So many across and as many down, [`FEWEST`] to [`MOST`].
    Square(usize),
    /// More down than across: for patches that have become low because leaves vary fast down the picture.
    Low,
    /// The other way round.
    Narrow,
}

/// Nodes along a side of a square grid at least.
pub(super) const FEWEST: usize = MOST - 2;

/// Nodes along a side of a square grid at most.
pub(super) const MOST: usize = 5;

/// Nodes along the sides of others, across and down a low patch.
const LOW: [usize; 2] = [4, 8];

/// Nodes at most, and terms of a polynomial.
pub(super) const MOST_NODES: usize = LOW[0] * LOW[1];

/// The degrees, across and down the patch, of the Chebyshev polynomials that make each term.
type Degrees = [[usize; 2]; MOST_NODES];

const SQUARE_DEGREES: Degrees = degrees([MOST; 2]);
const LOW_DEGREES: Degrees = degrees(LOW);

/// All below so many across and down: the lower their sum, in terms of the highest of each, the earlier.
const fn degrees(counts: [usize; 2]) -> Degrees {
    let [across, down] = [counts[0] - 1, counts[1] - 1];
    // What is not filled is above the highest.
    let mut degrees = [counts; MOST_NODES];
    let (mut term, mut sum) = (0, 0);
    while sum <= 2 * across * down {
        let mut i = 0;
        while i <= across {
            if i * down <= sum && (sum - i * down).is_multiple_of(across) {
                let j = (sum - i * down) / across;
                if j <= down {
                    degrees[term] = [i, j];
                    term += 1;
                }
            }
            i += 1;
        }
        sum += 1;
    }
    degrees
}

/// Functions vary far faster along one axis than along the other if their terms of the highest degree are so
/// much larger.
const FAR: f64 = 64.0;

/// The square grids, from the one with the fewest nodes on, that of low patches and that of narrow ones.
static GRIDS: LazyLock<[Grid; 5]> = LazyLock::new(|| {
    let [fewest, more, most] = [FEWEST, FEWEST + 1, MOST].map(Shape::Square);
    [fewest, more, most, Shape::Low, Shape::Narrow].map(Grid::new)
});

impl Shape {
    /// Where rays are traced in a patch of that shape.
    pub fn grid(self) -> &'static Grid {
        &GRIDS[match self {
            Self::Square(side) => side - FEWEST,
            Self::Low => 3,
            Self::Narrow => 4,
        }]
    }
}

/// Where rays are traced in a patch.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Nodes across and down.
    counts: [usize; 2],
    /// The nodes, row by row, and then the points between them where what a polynomial says is
    /// compared with what is true: all along the edges, and every other one within.
    pub points: Vec<[f64; 2]>,
    /// The terms at the latter.
    pub checks: Vec<Terms>,
    /// The degrees of each term, across and down.
    degrees: Degrees,
    /// What each node counts for in each term.
    shares: Vec<f64>,
}

impl Grid {
    /// Chebyshev-Lobatto points across and down: the corners are among them, so that a straight cut through
    /// the patch parts them.
    fn new(shape: Shape) -> Self {
        let counts = match shape {
            Shape::Square(side) => [side; 2],
            Shape::Low => LOW,
            Shape::Narrow => [LOW[1], LOW[0]],
        };
        let gaps = counts.map(|count| count - 1);
        let angle = |axis: usize, k: usize| PI * (gaps[axis] - k) as f64 / gaps[axis] as f64;
        let [across, down] =
            [0, 1].map(|axis| (0..counts[axis]).map(|k| angle(axis, k).cos()).collect::<Vec<_>>());
        let middles = |along: &[f64]| -> Vec<f64> {
            along.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect()
        };
        let between = [middles(&across), middles(&down)];
        let nodes = down.iter().flat_map(|&y| across.iter().map(move |&x| [x, y]));
        let above_and_below = between[0].iter().flat_map(|&x| [[x, -1.0], [x, 1.0]]);
        let beside = between[1].iter().flat_map(|&y| [[-1.0, y], [1.0, y]]);
        let within = (0..gaps[1]).flat_map(|j| (0..gaps[0]).map(move |i| [i, j]));
        let within = within.filter(|[i, j]| (i + j) % 2 == 0);
        let within = within.map(|[i, j]| [between[0][i], between[1][j]]);
        let points: Vec<_> = nodes.chain(above_and_below).chain(beside).chain(within).collect();
        let count = counts[0] * counts[1];
        let checks = points[count..].iter().map(|point| Terms::at(*point, shape)).collect();
        let degrees = match shape {
            Shape::Square(_) => SQUARE_DEGREES,
            Shape::Low => LOW_DEGREES,
            Shape::Narrow => LOW_DEGREES.map(|[down, across]| [across, down]),
        };
        // Along a side: the discrete cosine transform.
        let share = |axis: usize, degree: usize, k: usize| {
            let gaps = gaps[axis];
            let half = |k: usize| if k == 0 || k == gaps { 0.5 } else { 1.0 };
            let all = 2.0 / gaps as f64 * half(degree) * half(k);
            if degree <= gaps { all * (degree as f64 * angle(axis, k)).cos() } else { 0.0 }
        };
        let of_term = |[i, j]: [usize; 2]| {
            let columns = counts[0];
            (0..count).map(move |node| share(0, i, node % columns) * share(1, j, node / columns))
        };
        let terms = if matches!(shape, Shape::Square(_)) { MOST * MOST } else { MOST_NODES };
        let shares = degrees.into_iter().take(terms).flat_map(of_term).collect();
        Self { counts, points, checks, degrees, shares }
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        self.counts[0] * self.counts[1]
    }

    /// How many neighbours among the nodes, across and down, differ in whether they are among the
    /// given points, see [`bits`]: as if there were as many nodes across as down.
    pub fn cuts(&self, points: u64) -> [usize; 2] {
        let [columns, rows] = self.counts;
        let is_in = |column: usize, row: usize| points >> (row * columns + column) & 1;
        let mut cuts = [0; 2];
        for row in 0..rows {
            for column in 0..columns {
                let here = is_in(column, row);
                cuts[0] += usize::from(column > 0 && here != is_in(column - 1, row));
                cuts[1] += usize::from(row > 0 && here != is_in(column, row - 1));
            }
        }
        [0, 1].map(|axis| cuts[axis] * self.counts[axis] / columns.min(rows))
    }

    /// The coefficients of the polynomials through the values of [`LANES`] functions at the nodes.
    pub fn coefficients(&self, values: &[[f64; LANES]]) -> Coefficients {
        let mut coefficients = [[0.0; LANES]; MOST_NODES];
        for (sums, shares) in coefficients.iter_mut().zip(self.shares.chunks(self.nodes())) {
            add_products(sums, shares, values);
        }
        coefficients
    }

    /// Along which axis functions of these coefficients vary the faster, by those of the highest degree, and
    /// whether they do so by far.
    pub fn rougher(&self, coefficients: &[Coefficients]) -> (usize, bool) {
        let leading = |axis: usize| -> f64 {
            let terms = coefficients.iter().flat_map(|lane| lane.iter().zip(self.degrees));
            let terms = terms.filter(|(_, degrees)| degrees[axis] == self.counts[axis] - 1);
            terms.flat_map(|(values, _)| values).map(|value| value * value).sum()
        };
        let leading = [0, 1].map(leading);
        let axis = usize::from(leading[1] > leading[0]);
        (axis, leading[axis] > FAR * FAR * leading[1 - axis])
    }
}

/// The terms of a polynomial at one place of a patch, whose coordinates go from -1 to 1. None is
/// ever above 1.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Terms([f64; MOST_NODES]);

impl Terms {
    #[inline(always)]
    pub fn at(place: [f64; 2], shape: Shape) -> Self {
        match shape {
            Shape::Square(_) => Self::of(place, &SQUARE_DEGREES),
            Shape::Low => Self::of(place, &LOW_DEGREES),
            Shape::Narrow => Self::of([place[1], place[0]], &LOW_DEGREES),
        }
    }

    #[inline(always)]
    fn of(place: [f64; 2], degrees: &Degrees) -> Self {
        let [across, down] = place.map(|x| {
            let second = 2.0 * x * x - 1.0;
            let third = x * (2.0 * second - 1.0);
            let fourth = 2.0 * second * second - 1.0;
            let fifth = 2.0 * second * third - x;
            let sixth = 2.0 * third * third - 1.0;
            [1.0, x, second, third, fourth, fifth, sixth, 2.0 * third * fourth - x]
        });
        Self(std::array::from_fn(|term| {
            let [i, j] = degrees[term];
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
pub(super) type Coefficients = [[f64; LANES]; MOST_NODES];

/// Points, by their numbers, as bits.
pub(super) fn bits(points: impl Iterator<Item = usize>) -> u64 {
    points.fold(0, |bits, point| bits | 1 << point)
}

/// So many functions are interpolated at once.
pub(super) const LANES: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    fn grids() -> impl Iterator<Item = &'static Grid> {
        GRIDS.iter()
    }

    fn shape(grid: &Grid) -> Shape {
        match grid.counts {
            LOW => Shape::Low,
            [across, down] if across == down => Shape::Square(across),
            _ => Shape::Narrow,
        }
    }

    /// Polynomials of degrees below the numbers of nodes are what they are.
    #[test]
    fn polynomials_are_met() {
        for grid in grids() {
            assert!(std::ptr::eq(shape(grid).grid(), grid));
            let [across, down] = grid.counts.map(|count| count as i32 - 1);
            let value = |[x, y]: [f64; 2]| (1.3 - x).powi(across) * (y + 0.4).powi(down);
            let largest = value([-1.0, 1.0]);
            let at_nodes: Vec<_> =
                (grid.points[..grid.nodes()].iter()).map(|point| [value(*point); LANES]).collect();
            let coefficients = grid.coefficients(&at_nodes);
            for point in grid.points.iter().copied().chain([[0.3, -0.8], [0.91, 0.17]]) {
                let sum = Terms::at(point, shape(grid)).sum(&coefficients);
                assert!((sum[3] - value(point)).abs() < 1e-14 * largest, "{point:?}: {sum:?}");
            }
            assert!(grid.points.len() <= 64, "they are bits of a number");
            assert_eq!(grid.points.len(), grid.nodes() + grid.checks.len());
        }
    }

    #[test]
    fn the_first_terms_are_those_of_the_lowest_degrees() {
        for (degrees, [across, down]) in [(SQUARE_DEGREES, [MOST; 2]), (LOW_DEGREES, LOW)] {
            let terms = &degrees[..across * down];
            let sums: Vec<_> =
                terms.iter().map(|[i, j]| i * (down - 1) + j * (across - 1)).collect();
            assert!(sums.is_sorted());
            let all: std::collections::BTreeSet<_> = terms.iter().collect();
            assert_eq!(all.len(), terms.len());
            assert!(terms.iter().all(|[i, j]| *i < across && *j < down));
        }
    }

    #[test]
    fn patches_are_cut_where_they_part() {
        for grid in grids() {
            let beyond = |axis: usize| {
                let points = grid.points.iter().enumerate();
                bits(points.filter(|(_, point)| point[axis] > 0.3).map(|(i, _)| i))
            };
            let most = *grid.counts.iter().max().expect("two");
            assert_eq!(grid.cuts(beyond(0)), [most, 0]);
            assert_eq!(grid.cuts(beyond(1)), [0, most]);
            let steep = |axis: usize| {
                let nodes = grid.points[..grid.nodes()].iter();
                let values: Vec<_> =
                    nodes.map(|point| [(1.0 + 5.0 * point[axis]).sin(); LANES]).collect();
                grid.coefficients(&values)
            };
            let rougher = [0, 1].map(|axis| grid.rougher(&[steep(axis)]));
            assert_eq!(rougher, [(0, true), (1, true)]);
            let lanes = [steep(0), steep(1).map(|values| values.map(|value| 0.9 * value))];
            if matches!(shape(grid), Shape::Square(_)) {
                assert_eq!(grid.rougher(&lanes), (0, false));
            }
        }
    }
}
