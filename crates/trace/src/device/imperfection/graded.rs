//! Graded conformal media: an index that is off by a smooth factor.
//!
//! Where the index is clamped or has levels, the deviation from the design, a ratio with kinks and steps, is smoothed by a
//! Gaussian of the process's resolution, over the medium alone; then comes the random error, a Gaussian field. What is
//! traced is that smooth index: its steps are wide against the wavelength, and reflect nothing.

use super::super::ConformalRegion;
use super::{Deviates, Imperfection, TABLE};
use crate::keys::KeyError;
use glam::{DVec2, DVec3};
use num_complex::Complex64;
use optics::propagation::{GridSpline, Half, IndexPerturbation};
use std::f64::consts::TAU;

/// Plane waves that a random field is made of.
const WAVES: u64 = 512;

/// Samples of the grid in one resolution, and in one correlation length.
const SAMPLES_A_RESOLUTION: f64 = 2.0;
const SAMPLES_A_CORRELATION: f64 = 4.0;

/// How far the grid reaches beyond the device, in samples, and how far the smoothing does, in resolutions.
const MARGIN: f64 = 6.0;
const REACH: f64 = 5.0;

/// More samples than these are no grid.
const MOST_SAMPLES: f64 = 4e6;

/// The least factor that an error may leave of an index.
const LEAST: f64 = 0.05;

/// Makes a region's index imperfect.
pub(super) fn apply(
    imperfection: &Imperfection,
    deviates: &Deviates,
    region: &mut ConformalRegion,
) -> Result<(), KeyError> {
    region.loss_tangent = imperfection.loss_tangent;
    let (limited, random) = (imperfection.limits_values(), imperfection.is_random());
    let spacings = [
        (limited, imperfection.resolution / SAMPLES_A_RESOLUTION, "imperfection.resolution"),
        (random, imperfection.correlation / SAMPLES_A_CORRELATION, "imperfection.correlation"),
    ];
    let needed = spacings.into_iter().filter(|(needed, ..)| *needed);
    let Some((_, spacing, key)) = needed.min_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(()) };
    let message = "this index is given on a grid; what is made of it is to be given so, too. Loss alone can be asked for";
    KeyError::refuse_if(region.flow.is_uneven(), TABLE, message)?;
    let grid = Grid::over(region, spacing).ok_or_else(|| {
        let message = format!(
            "on a grid of {spacing} cm the device has more than {MOST_SAMPLES:.0e} samples; make it larger"
        );
        KeyError::at(key, message)
    })?;
    let mut factor =
        if limited { grid.limited(imperfection, region) } else { vec![1.0; grid.len()] };
    if random {
        let field = grid.random_field(imperfection.correlation, deviates, region.half);
        for (factor, deviate) in factor.iter_mut().zip(field) {
            *factor *= (1.0 + imperfection.error * deviate).max(LEAST);
        }
    }
    let squares: Vec<f64> = factor.iter().map(|factor| factor * factor).collect();
    let spline = GridSpline::new(grid.corner, DVec2::splat(grid.spacing), grid.count, &squares);
    let unevenness = spline.ok().and_then(IndexPerturbation::new).ok_or_else(|| {
        KeyError::at(TABLE, "with this imperfection the index is not above 0 everywhere")
    })?;
    region.flow = region.flow.clone().with_unevenness(unevenness);
    Ok(())
}

/// A grid over a region, in the plane of the upper half.
struct Grid {
    corner: DVec2,
    spacing: f64,
    count: [usize; 2],
}

impl Grid {
    /// `None` if it would have too many samples.
    fn over(region: &ConformalRegion, spacing: f64) -> Option<Self> {
        let cut = region.flow.cut();
        let low = DVec2::new(cut.x_min, region.flow.map().trough()) - MARGIN * spacing;
        let high = DVec2::new(cut.x_max, cut.y_max) + MARGIN * spacing;
        let size = ((high - low) / spacing).ceil() + 1.0;
        let sound = size.x * size.y <= MOST_SAMPLES;
        let count = [size.x as usize, size.y as usize];
        sound.then_some(Self { corner: low, spacing, count })
    }

    fn len(&self) -> usize {
        self.count[0] * self.count[1]
    }

    fn place(&self, sample: usize) -> DVec2 {
        let at = [sample % self.count[0], sample / self.count[0]].map(|k| k as f64);
        self.corner + self.spacing * DVec2::from(at)
    }

    /// The ratio of the index that can be made to that of the design, smoothed.
    fn limited(&self, imperfection: &Imperfection, region: &ConformalRegion) -> Vec<f64> {
        let (least, largest) = region.flow.index_range();
        let process = imperfection.process([least, largest]);
        let floor = |x: f64| region.flow.map().floor_height_at(x);
        // By how much the ratio is off 1, and whether the place is in the medium.
        let mut off: Vec<[f64; 2]> = crate::parallel::map(self.len(), |sample| {
            let place = self.place(sample);
            if place.y < floor(place.x) {
                return [0.0; 2];
            }
            let index = region.flow.index(Half::Upper, place.extend(0.0));
            index.map_or([0.0; 2], |index| [process.made(index) / index - 1.0, 1.0])
        });
        let width = imperfection.resolution / self.spacing;
        self.smooth(&mut off, width);
        let ratio = |[sum, weight]: &[f64; 2]| if *weight > 0.0 { 1.0 + sum / weight } else { 1.0 };
        off.iter().map(ratio).collect()
    }

    /// Smooths by a Gaussian of a standard deviation in samples, along x and then along y.
    fn smooth(&self, values: &mut [[f64; 2]], width: f64) {
        let [nx, ny] = self.count;
        let reach = ((REACH * width).ceil() as usize).min(nx.max(ny));
        let kernel: Vec<f64> =
            (0..=reach).map(|k| (-0.5 * (k as f64 / width).powi(2)).exp()).collect();
        let line = |line: &[[f64; 2]]| -> Vec<[f64; 2]> {
            let n = line.len();
            (0..n)
                .map(|i| {
                    let near = i.saturating_sub(reach)..(i + reach + 1).min(n);
                    near.fold([0.0; 2], |sum, j| {
                        let weight = kernel[i.abs_diff(j)];
                        [sum[0] + weight * line[j][0], sum[1] + weight * line[j][1]]
                    })
                })
                .collect()
        };
        for row in values.chunks_exact_mut(nx) {
            let smoothed = line(row);
            row.copy_from_slice(&smoothed);
        }
        for x in 0..nx {
            let column: Vec<[f64; 2]> = (0..ny).map(|y| values[y * nx + x]).collect();
            for (y, value) in line(&column).into_iter().enumerate() {
                values[y * nx + x] = value;
            }
        }
    }

    /// A Gaussian random field of mean 0 and variance 1, correlated as exp(-r²/(2 l²)): plane waves with normally
    /// distributed wave vectors and amplitudes. It is a function of the place alone, whatever the grid.
    fn random_field(&self, correlation: f64, deviates: &Deviates, half: Half) -> Vec<f64> {
        let side = half.mirrored(DVec3::Y).y;
        let [nx, ny] = self.count;
        let scale = (WAVES as f64).sqrt().recip();
        let waves: Vec<(DVec2, Complex64)> = (0..WAVES)
            .map(|wave| {
                let [kx, ky, a, b] = [0, 1, 2, 3].map(|k| deviates.normal(4 * wave + k));
                (DVec2::new(kx, ky) / correlation, Complex64::new(a, b) * scale)
            })
            .collect();
        // exp(i k x) along a row, for each wave.
        let along: Vec<Vec<Complex64>> = waves
            .iter()
            .map(|(k, _)| {
                let turn = |i: usize| k.x * (self.corner.x + self.spacing * i as f64);
                (0..nx).map(|i| Complex64::cis(turn(i) % TAU)).collect()
            })
            .collect();
        let rows = crate::parallel::map(ny, |j| {
            let y = side * (self.corner.y + self.spacing * j as f64);
            let mut row = vec![0.0; nx];
            for ((k, amplitude), along) in waves.iter().zip(&along) {
                let here = amplitude * Complex64::cis(k.y * y % TAU);
                for (sum, turn) in row.iter_mut().zip(along) {
                    *sum += here.re * turn.re - here.im * turn.im;
                }
            }
            row
        });
        rows.concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_has_its_variance_and_its_correlation() {
        let grid = Grid { corner: DVec2::new(-3.0, 1.0), spacing: 0.5, count: [9, 9] };
        let correlation = 2.0;
        let draws = 2000;
        let fields: Vec<Vec<f64>> = (0..draws)
            .map(|k| grid.random_field(correlation, &Deviates::new([1, 0, k]), Half::Upper))
            .collect();
        let mean = |a: usize, b: usize| {
            fields.iter().map(|field| field[a] * field[b]).sum::<f64>() / fields.len() as f64
        };
        // Within five standard errors of a covariance, at most sqrt(2/N).
        let error = 5.0 * (2.0 / draws as f64).sqrt();
        for (a, b) in [(0, 0), (40, 40), (0, 4), (0, 36), (10, 50), (0, 80)] {
            let distance = grid.place(a).distance(grid.place(b));
            let expected = (-0.5 * (distance / correlation).powi(2)).exp();
            let found = mean(a, b);
            assert!((found - expected).abs() < error, "{distance}: {found} {expected}");
        }
    }

    #[test]
    fn what_is_much_wider_than_the_device_smooths_to_the_mean() {
        let grid = Grid { corner: DVec2::ZERO, spacing: 1.0, count: [3, 4] };
        for width in [1e9, 1e300] {
            let mut values: Vec<[f64; 2]> = (0..12).map(|k| [f64::from(k), 1.0]).collect();
            grid.smooth(&mut values, width);
            assert!(values.iter().all(|value| *value == [66.0, 12.0]), "{values:?}");
        }
    }

    #[test]
    fn the_field_is_one_of_places_not_of_grids() {
        let deviates = Deviates::new([4, 2, 0]);
        let coarse = Grid { corner: DVec2::new(-1.0, 0.0), spacing: 0.5, count: [5, 5] };
        let fine = Grid { corner: DVec2::new(-1.0, 0.0), spacing: 0.25, count: [9, 9] };
        let [coarse, fine] =
            [coarse, fine].map(|grid| grid.random_field(1.0, &deviates, Half::Upper));
        for (k, value) in coarse.iter().enumerate() {
            let same = fine[(k / 5) * 2 * 9 + (k % 5) * 2];
            assert!((value - same).abs() < 1e-12, "{value} {same}");
        }
        // In the lower half the plane goes on: the mirror image of y is -y.
        let grid = |y: f64| Grid { corner: DVec2::new(0.0, y), spacing: 1.0, count: [4, 1] };
        let [upper, lower] = [
            grid(-2.0).random_field(1.0, &deviates, Half::Upper),
            grid(2.0).random_field(1.0, &deviates, Half::Lower),
        ];
        assert_eq!(upper, lower);
    }
}
