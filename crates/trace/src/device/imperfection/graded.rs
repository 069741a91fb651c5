//! Graded conformal media: an index that is off by a smooth factor.
//!
//! Where the index is clamped or has levels, the deviation from the design, a ratio with kinks and
//! steps, is smoothed by a Gaussian of the process's resolution, over the medium alone; then comes
//! the random error, a Gaussian field. What is traced is that smooth index: its steps are wide
//! against the wavelength, and reflect nothing.

use super::super::ConformalRegion;
use super::{Deviates, Imperfection, TABLE};
use crate::keys::KeyError;
use glam::{DVec2, DVec3};
use num_complex::Complex64;
use optics::propagation::{Degree, GridSpline, Half, IndexPerturbation};
use std::f64::consts::TAU;

/// Plane waves that a random field is made of.
const WAVES: u64 = 512;

/// Samples of the grid in one resolution, and in one correlation length.
const SAMPLES_A_RESOLUTION: f64 = 2.0;
const SAMPLES_A_CORRELATION: f64 = 4.0;

/// How far the grid reaches beyond the device, in samples, and how far the smoothing does, in
/// resolutions.
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
    let of_degree = |degree| {
        let spacing = DVec2::splat(grid.spacing);
        let spline = GridSpline::new(degree, grid.corner, spacing, grid.count, &squares);
        spline.ok().and_then(IndexPerturbation::new)
    };
    // Only what is smooth from sample to sample is so between them in a high degree: a limited index
    // has a step beyond the medium, where the smoothing ends.
    let smooth = if limited { None } else { of_degree(Degree::Seven) };
    let index_perturbation = smooth.or_else(|| of_degree(Degree::Three));
    let index_perturbation = index_perturbation.ok_or_else(|| {
        KeyError::at(TABLE, "with this imperfection the index is not above 0 everywhere")
    })?;
    region.flow = region.flow.clone().with_index_perturbation(index_perturbation);
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
        let mut off: Vec<DVec2> = crate::parallel::map(self.len(), |sample| {
            let place = self.place(sample);
            if place.y < floor(place.x) {
                return DVec2::ZERO;
            }
            let index = region.flow.index(Half::Upper, place.extend(0.0));
            index.map_or(DVec2::ZERO, |index| DVec2::new(process.made(index) / index - 1.0, 1.0))
        });
        self.smooth(&mut off, imperfection.resolution / self.spacing);
        off.iter().map(|sum| if sum.y > 0.0 { 1.0 + sum.x / sum.y } else { 1.0 }).collect()
    }

    /// Smooths by a Gaussian of a standard deviation in samples, along x and then along y.
    fn smooth(&self, values: &mut [DVec2], width: f64) {
        let [nx, ny] = self.count;
        let reach = ((REACH * width).ceil() as usize).min(nx.max(ny));
        let kernel: Vec<f64> =
            (0..=reach).map(|k| (-0.5 * (k as f64 / width).powi(2)).exp()).collect();
        let mut smooth_line = |first: usize, step: usize, count: usize| {
            let line: Vec<DVec2> = (0..count).map(|i| values[first + i * step]).collect();
            for i in 0..count {
                let near = i.saturating_sub(reach)..(i + reach + 1).min(count);
                values[first + i * step] =
                    near.fold(DVec2::ZERO, |sum, j| sum + kernel[i.abs_diff(j)] * line[j]);
            }
        };
        (0..ny).for_each(|y| smooth_line(y * nx, 1, nx));
        (0..nx).for_each(|x| smooth_line(x, nx, ny));
    }

    /// A Gaussian random field of mean 0 and variance 1, correlated as exp(-r²/(2 l²)): plane waves
    /// with normally distributed wave vectors and amplitudes. It is a function of the place alone,
    /// whatever the grid.
    fn random_field(&self, correlation: f64, deviates: &Deviates, half: Half) -> Vec<f64> {
        let side = half.mirrored(DVec3::Y).y;
        let [nx, ny] = self.count;
        let scale = (WAVES as f64).sqrt().recip();
        // Of each wave: its wave vector along y, its amplitude, and exp(i k x) along a row.
        let waves: Vec<(f64, Complex64, Vec<Complex64>)> = (0..WAVES)
            .map(|wave| {
                let [kx, ky, a, b] = [0, 1, 2, 3].map(|k| deviates.normal(4 * wave + k));
                let turn = |i: usize| kx / correlation * (self.corner.x + self.spacing * i as f64);
                let along = (0..nx).map(|i| Complex64::cis(turn(i) % TAU)).collect();
                (ky / correlation, Complex64::new(a, b) * scale, along)
            })
            .collect();
        let rows = crate::parallel::map(ny, |j| {
            let y = side * (self.corner.y + self.spacing * j as f64);
            let mut row = vec![0.0; nx];
            for (ky, amplitude, along) in &waves {
                let here = amplitude * Complex64::cis(ky * y % TAU);
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
mod tests;
