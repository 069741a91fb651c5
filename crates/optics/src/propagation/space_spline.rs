//! Smooth functions in space through samples on a grid.

use super::GridSplineError;
use super::spline::{LEAST, basis, bernstein, coefficients};
use glam::DVec3;

/// Tricubic splines through samples of `C` numbers each on a grid, as [`super::GridSpline`] in the
/// plane: two derivatives are continuous, and cubic polynomials are kept as they are. A grid of one
/// layer along z is that of functions that do not depend on z.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceSpline<const C: usize> {
    corner: DVec3,
    spacing: DVec3,
    /// How many basis functions there are along x, y and z: two more than samples, or one.
    count: [usize; 3],
    /// Their coefficients, those along z side by side.
    coefficients: Vec<[f64; C]>,
}

/// What the functions of a spline are at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look<const C: usize> {
    /// Their values.
    pub value: [f64; C],
    /// Their gradients, 1/cm.
    pub gradient: [DVec3; C],
}

impl<const C: usize> SpaceSpline<C> {
    /// The spline through `samples`, those along z side by side, `count` along x, y and z: the
    /// first at `corner`, the others at steps of `spacing` (cm).
    ///
    /// # Errors
    ///
    /// If there are fewer than four along x or y, or two or three along z, if their number is
    /// another, or something is not finite.
    pub fn new(
        corner: DVec3,
        spacing: DVec3,
        count: [usize; 3],
        samples: &[[f64; C]],
    ) -> Result<Self, GridSplineError> {
        let [nx, ny, nz] = count;
        if nx < LEAST || ny < LEAST || (nz < LEAST && nz != 1) {
            return Err(match nz {
                1 => GridSplineError::TooFew { count: [nx, ny] },
                _ => GridSplineError::TooFewInSpace { count },
            });
        }
        let whole = nx.checked_mul(ny).and_then(|layer| layer.checked_mul(nz));
        if whole != Some(samples.len()) {
            return Err(GridSplineError::Count { count: [nx, ny * nz], samples: samples.len() });
        }
        let sound = corner.is_finite() && spacing.is_finite() && spacing.min_element() > 0.0;
        if !sound || samples.iter().flatten().any(|sample| !sample.is_finite()) {
            return Err(GridSplineError::NotFinite);
        }
        let (mx, my) = (nx + 2, ny + 2);
        let mz = if nz == 1 { 1 } else { nz + 2 };
        let along_z = if nz == 1 { samples.to_vec() } else { along(samples, [nx * ny, nz, 1]) };
        let along_y = along(&along_z, [nx, ny, mz]);
        let coefficients = along(&along_y, [1, nx, my * mz]);
        Ok(Self { corner, spacing, count: [mx, my, mz], coefficients })
    }

    /// Values and gradients at a point. Beyond the grid the outermost pieces go on.
    #[must_use]
    pub fn look(&self, point: DVec3) -> Look<C> {
        let place = (point - self.corner) / self.spacing;
        let [_, my, mz] = self.count;
        let [(i, x), (j, y), (k, z)] = [0, 1, 2].map(|axis| {
            let count = self.count[axis];
            if count == 1 {
                return (0, ([1.0, 0.0, 0.0, 0.0], [0.0; 4]));
            }
            let cell = (place[axis] as i64).clamp(0, count as i64 - 4) as usize;
            (cell, basis(place[axis] - cell as f64))
        });
        let layers = mz.min(4);
        let (mut value, mut gradient) = ([0.0; C], [DVec3::ZERO; C]);
        for a in 0..4 {
            for b in 0..4 {
                let start = ((i + a) * my + j + b) * mz + k;
                let (mut along, mut slope) = ([0.0; C], [0.0; C]);
                for (l, sample) in self.coefficients[start..start + layers].iter().enumerate() {
                    for c in 0..C {
                        along[c] += z.0[l] * sample[c];
                        slope[c] += z.1[l] * sample[c];
                    }
                }
                let weights = DVec3::new(x.1[a] * y.0[b], x.0[a] * y.1[b], x.0[a] * y.0[b]);
                for c in 0..C {
                    value[c] += weights.z * along[c];
                    gradient[c] += weights * DVec3::new(along[c], along[c], slope[c]);
                }
            }
        }
        Look { value, gradient: gradient.map(|gradient| gradient / self.spacing) }
    }

    /// The planes between the cells next to a point that moves, along an axis: the sample below and
    /// the one above; `None` along z where nothing depends on it. Within `slack` cells of a plane
    /// the point counts as beyond it.
    pub(super) fn cell_along(
        &self,
        axis: usize,
        at: f64,
        speed: f64,
        slack: f64,
    ) -> Option<[f64; 2]> {
        let count = self.count[axis];
        if count == 1 {
            return None;
        }
        let place = (at - self.corner[axis]) / self.spacing[axis];
        let cell = (place + slack.copysign(speed)).floor().clamp(0.0, count as f64 - 4.0);
        let plane = |cell: f64| self.corner[axis] + self.spacing[axis] * cell;
        // Beyond the outermost planes the outermost pieces go on.
        let low = if cell == 0.0 { f64::NEG_INFINITY } else { plane(cell) };
        let high = if cell == count as f64 - 4.0 { f64::INFINITY } else { plane(cell + 1.0) };
        Some([low, high])
    }

    /// Whether a combination of the functions is above 0 in all cells of the grid that `counts`
    /// accepts by their lowest and highest corner: `combine` gives its weights from the values in
    /// the middle of a cell. By the coefficients in Bernstein's form, which are near the values on
    /// coarse grids, too.
    #[must_use]
    pub fn is_positive(
        &self,
        counts: impl Fn(DVec3, DVec3) -> bool,
        combine: impl Fn([f64; C]) -> [f64; C],
    ) -> bool {
        let [mx, my, mz] = self.count;
        let (layers, levels) = if mz == 1 { (1, 1) } else { (4, mz - 3) };
        let mut pieces = vec![0.0; 16 * layers];
        for (i, j, k) in (0..mx - 3)
            .flat_map(|i| (0..my - 3).map(move |j| (i, j)))
            .flat_map(|(i, j)| (0..levels).map(move |k| (i, j, k)))
        {
            let low = self.corner + self.spacing * DVec3::new(i as f64, j as f64, k as f64);
            let high = low + self.spacing;
            if !counts(low, high) {
                continue;
            }
            let weights = combine(self.look(0.5 * (low + high)).value);
            for a in 0..4 {
                for b in 0..4 {
                    for l in 0..layers {
                        let sample = &self.coefficients[((i + a) * my + j + b) * mz + k + l];
                        let value = sample.iter().zip(weights).map(|(s, w)| s * w).sum();
                        pieces[(a * 4 + b) * layers + l] = value;
                    }
                }
            }
            // The basis functions are positive, and their sum is 1.
            if pieces.iter().all(|piece| *piece > 0.0) {
                continue;
            }
            let steps: &[usize] = if layers == 1 { &[4, 1] } else { &[16, 4, 1] };
            for &step in steps {
                for start in (0..pieces.len()).filter(|start| (start / step).is_multiple_of(4)) {
                    let line = bernstein(std::array::from_fn(|n| pieces[start + n * step]));
                    line.iter()
                        .enumerate()
                        .for_each(|(n, value)| pieces[start + n * step] = *value);
                }
            }
            if pieces.iter().any(|piece| *piece <= 0.0 || piece.is_nan()) {
                return false;
            }
        }
        true
    }
}

/// The coefficients along the middle one of three axes, from samples.
fn along<const C: usize>(samples: &[[f64; C]], [outer, count, inner]: [usize; 3]) -> Vec<[f64; C]> {
    let more = count + 2;
    let mut found = vec![[0.0; C]; outer * more * inner];
    let (mut line, mut factors) = (vec![0.0; more], vec![0.0; more]);
    for (o, i) in (0..outer).flat_map(|o| (0..inner).map(move |i| (o, i))) {
        for c in 0..C {
            let line_of = (0..count).map(|n| samples[(o * count + n) * inner + i][c]);
            coefficients(line_of, &mut line, &mut factors);
            for (n, value) in line.iter().enumerate() {
                found[(o * more + n) * inner + i][c] = *value;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spline(count: [usize; 3], function: impl Fn(DVec3) -> f64) -> SpaceSpline<2> {
        let (corner, size) = (DVec3::new(-1.0, 2.0, 0.5), DVec3::new(3.0, 1.5, 2.0));
        let steps = count.map(|count| (count.max(2) - 1) as f64);
        let spacing = size / DVec3::from_array(steps);
        let mut samples = Vec::new();
        for i in 0..count[0] {
            for j in 0..count[1] {
                for k in 0..count[2] {
                    let at = corner + spacing * DVec3::new(i as f64, j as f64, k as f64);
                    samples.push([function(at), 1.0 + at.x]);
                }
            }
        }
        SpaceSpline::new(corner, spacing, count, &samples).expect("a spline")
    }

    fn points() -> impl Iterator<Item = DVec3> {
        (0..200).map(|k| {
            let share = f64::from(k) / 200.0;
            let [b, c] = [17.3, 41.7].map(|turns| (turns * share).fract());
            DVec3::new(-1.0 + 3.0 * share, 2.0 + 1.5 * b, 0.5 + 2.0 * c)
        })
    }

    #[test]
    fn cubic_polynomials_are_kept_up_to_the_border() {
        let function =
            |p: DVec3| 1.0 + p.x * p.z - 0.3 * p.x * p.x * p.y + 0.2 * (p.y * p.z).powi(3);
        let slope = |p: DVec3| {
            let cubes = 0.6 * (p.y * p.z).powi(2);
            DVec3::new(p.z - 0.6 * p.x * p.y, -0.3 * p.x * p.x + cubes * p.z, p.x + cubes * p.y)
        };
        for count in [[4, 4, 4], [4, 5, 6], [9, 4, 5]] {
            let spline = spline(count, function);
            for point in points() {
                let Look { value, gradient } = spline.look(point);
                assert!((value[0] - function(point)).abs() < 1e-11, "{count:?} {point}");
                assert!((gradient[0] - slope(point)).length() < 1e-10, "{count:?} {point}");
                assert!((value[1] - 1.0 - point.x).abs() < 1e-12);
                assert!((gradient[1] - DVec3::X).length() < 1e-12);
            }
        }
    }

    #[test]
    fn one_layer_is_a_function_in_the_plane() {
        let function = |p: DVec3| (2.0 * p.x).sin() * (1.3 * p.y).cos();
        let (flat, deep) = (spline([9, 8, 1], function), spline([9, 8, 5], function));
        for point in points() {
            let (a, b) = (flat.look(point), deep.look(point));
            assert!((a.value[0] - b.value[0]).abs() < 1e-14);
            assert!((a.gradient[0] - b.gradient[0]).length() < 1e-13);
        }
        assert_eq!(flat.cell_along(2, 0.7, 1.0, 0.01), None);
    }

    #[test]
    fn smooth_functions_are_met_to_the_fourth_order() {
        let function = |p: DVec3| (2.0 * p.x).sin() * (1.3 * p.y).cos() * (1.7 * p.z).sin();
        let error = |n: usize| {
            let spline = spline([n + 1; 3], function);
            points().map(|p| (spline.look(p).value[0] - function(p)).abs()).fold(0.0, f64::max)
        };
        let order = (error(16) / error(32)).log2();
        assert!(order > 3.7 && order < 4.7, "{order}");
    }

    #[test]
    fn what_falls_to_zero_between_samples_is_found() {
        let dip = |depth: f64| {
            let spline = spline([9, 9, 9], |p| {
                1.0 - depth * (-40.0 * (p - DVec3::new(0.5, 2.75, 1.5)).length_squared()).exp()
            });
            spline.is_positive(|_, _| true, |_| [1.0, 0.0])
        };
        assert!(dip(0.9) && !dip(1.2));
        let apart = spline([9, 9, 9], |p| p.x);
        assert!(apart.is_positive(|low, _| low.x > 0.01, |_| [1.0, 0.0]));
        assert!(!apart.is_positive(|_, high| high.x > 0.01, |_| [1.0, 0.0]));
    }

    #[test]
    fn cells_end_at_the_samples() {
        let spline = spline([4, 4, 5], |p| p.x);
        let near = |cell: Option<[f64; 2]>, ends: [f64; 2]| cell == Some(ends);
        let infinite = f64::INFINITY;
        assert!(near(spline.cell_along(0, -0.5, 1.0, 0.01), [-infinite, 0.0]));
        assert!(near(spline.cell_along(0, -1e-6, 1.0, 0.01), [0.0, 1.0]));
        assert!(near(spline.cell_along(0, 1e-6, -1.0, 0.01), [-infinite, 0.0]));
        assert!(near(spline.cell_along(0, 7.0, -1.0, 0.01), [1.0, infinite]));
    }

    #[test]
    fn what_is_no_grid_is_refused() {
        let new = |count, samples: usize| {
            SpaceSpline::new(DVec3::ZERO, DVec3::ONE, count, &vec![[1.0]; samples])
        };
        assert!(matches!(new([4, 4, 3], 48), Err(GridSplineError::TooFewInSpace { .. })));
        assert!(matches!(new([3, 4, 1], 12), Err(GridSplineError::TooFew { .. })));
        assert!(matches!(new([4, 4, 4], 63), Err(GridSplineError::Count { .. })));
        let new = |sample| SpaceSpline::new(DVec3::ZERO, DVec3::ONE, [4; 3], &vec![[sample]; 64]);
        assert_eq!(new(f64::NAN), Err(GridSplineError::NotFinite));
    }
}
