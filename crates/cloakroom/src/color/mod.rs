//! Colors of light: what a camera that sees as people do makes of wavelengths.
//!
//! A linear sRGB color (R, G, B) is the spectrum R r(λ) + G g(λ) + B b(λ), with functions that are not negative, sum to
//! 1, and look under D65 as their color says, seen by the CIE's observer of 1931. So what nothing
//! disperses keeps its color under D65, and white is the color of the lamp. A lamp is as bright as lets
//! the largest of the three numbers of white be 1.

mod bands;
mod standard;
#[cfg(test)]
mod tests;

pub use bands::{BIN_EDGES_NM, BINS};
pub(crate) use bands::{
    Bands, Fringe, Group, Interpolation, Light, Stretch, chebyshev_nodes, weights,
};

use glam::{DMat3, DVec3};
use standard::{COUNT, D65, FIRST_NM, OBSERVER, RED_AND_GREEN, STEP_NM};

/// The least and the largest wavelength that is seen, nm.
pub const SEEN_NM: [f64; 2] = [FIRST_NM, FIRST_NM + STEP_NM * (COUNT - 1) as f64];

/// A lamp: the power of its light in equal ranges of wavelengths, in any unit.
#[derive(Clone, Debug, PartialEq)]
pub enum Lamp {
    /// Daylight, the CIE's illuminant D65: the white of sRGB.
    D65,
    /// The same power at all wavelengths, the CIE's illuminant E.
    EqualPower,
    /// A black body of that temperature, K.
    BlackBody(f64),
    /// Lines: the wavelength (nm) and the power of each.
    Lines(Vec<[f64; 2]>),
    /// Wavelengths (nm), rising, and the power there; straight lines between them, nothing beyond.
    Table(Vec<[f64; 2]>),
}

/// A part of a lamp's light, so narrow that it is of one wavelength.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    /// Its wavelength, nm.
    pub nm: f64,
    /// Its color in the camera where a thing sends all of it back.
    pub color: DVec3,
    /// Shares of it that come back from a red, a green and a blue thing.
    shares: DVec3,
    /// Its power.
    power: f64,
}

impl Sample {
    /// The color of a thing of linear red, green and blue in this light.
    pub fn color_of_things(&self) -> DMat3 {
        let outer = |share: f64| self.color * share;
        DMat3::from_cols(outer(self.shares.x), outer(self.shares.y), outer(self.shares.z))
    }
}

impl Lamp {
    /// Whether none of its light is seen.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        let white: DVec3 = self.unscaled().iter().map(|sample| sample.color).sum();
        white.max_element() <= 0.0
    }

    /// Its light, as bright as a picture shows it.
    pub(crate) fn samples(&self) -> Vec<Sample> {
        let mut samples = self.unscaled();
        let white: DVec3 = samples.iter().map(|sample| sample.color).sum();
        let largest = white.max_element();
        let scale = if largest > 0.0 { 1.0 / largest } else { 0.0 };
        let power: f64 = samples.iter().map(|sample| sample.power).sum();
        for sample in &mut samples {
            sample.color *= scale;
            sample.power /= power;
        }
        samples
    }

    fn unscaled(&self) -> Vec<Sample> {
        let camera = camera_matrix();
        let sample = |nm: f64, power: f64| {
            let ([x, y, z], [red, green]) = (at(&OBSERVER, nm), at(&RED_AND_GREEN, nm));
            let color = camera * DVec3::new(x, y, z) * power;
            Sample { nm, color, shares: DVec3::new(red, green, 1.0 - red - green), power }
        };
        match self {
            Self::Lines(lines) => lines.iter().map(|[nm, power]| sample(*nm, *power)).collect(),
            Self::D65 => grid(|i, _| D65[i]).map(|(nm, power)| sample(nm, power)).collect(),
            Self::EqualPower => grid(|_, _| 1.0).map(|(nm, power)| sample(nm, power)).collect(),
            Self::BlackBody(kelvin) => {
                let peak = planck(SEEN_NM[1], *kelvin).max(f64::MIN_POSITIVE);
                let power = |_, nm| planck(nm, *kelvin) / peak;
                grid(power).map(|(nm, power)| sample(nm, power)).collect()
            }
            Self::Table(rows) => {
                let around = |_, nm| mean_around(rows, nm);
                grid(around).map(|(nm, power)| sample(nm, power)).collect()
            }
        }
    }
}

/// The wavelengths of the standard's tables with the power there, which is a function of its place in
/// them and the wavelength; half of it at either end, as the trapezoidal rule has it.
fn grid(power: impl Fn(usize, f64) -> f64) -> impl Iterator<Item = (f64, f64)> {
    (0..COUNT).map(move |i| {
        let nm = FIRST_NM + STEP_NM * i as f64;
        let share = if i == 0 || i + 1 == COUNT { 0.5 } else { 1.0 };
        (nm, share * power(i, nm))
    })
}

/// The matrix from the observer's X, Y, Z to linear sRGB: that by which red, green and blue things keep their
/// numbers under D65.
fn camera_matrix() -> DMat3 {
    let mut seen = DMat3::ZERO;
    for (nm, power) in grid(|i, _| D65[i]) {
        let ([x, y, z], [red, green]) = (at(&OBSERVER, nm), at(&RED_AND_GREEN, nm));
        let stimulus = DVec3::new(x, y, z) * power;
        seen += DMat3::from_cols(stimulus * red, stimulus * green, stimulus * (1.0 - red - green));
    }
    seen.inverse()
}

/// The entry of a table of the standard at a wavelength (nm), by straight lines between its entries.
fn at<const M: usize>(table: &[[f64; M]; COUNT], nm: f64) -> [f64; M] {
    let place = ((nm - FIRST_NM) / STEP_NM).clamp(0.0, (COUNT - 1) as f64);
    let first = (place as usize).min(COUNT - 2);
    let share = place - first as f64;
    std::array::from_fn(|i| table[first][i] * (1.0 - share) + table[first + 1][i] * share)
}

/// Planck's law: the power of a black body of a temperature (K) at a wavelength (nm), in any unit.
fn planck(nm: f64, kelvin: f64) -> f64 {
    /// hc/k, nm K.
    const SECOND_CONSTANT: f64 = 1.438_776_877e7;
    // Of 560 nm, so that nothing overflows.
    (560.0 / nm).powi(5) / (SECOND_CONSTANT / (nm * kelvin)).exp_m1()
}

/// The mean power of a table about a wavelength, weighted as straight lines between the standard's
/// wavelengths are.
fn mean_around(rows: &[[f64; 2]], nm: f64) -> f64 {
    const STEPS: i32 = 250;
    let power = |nm: f64| {
        let above = rows.partition_point(|[other, _]| *other < nm);
        match (above.checked_sub(1).map(|below| rows[below]), rows.get(above)) {
            (Some([low, from]), Some([high, to])) => from + (to - from) * (nm - low) / (high - low),
            (None, Some([first, power])) if *first == nm => *power,
            _ => 0.0,
        }
    };
    let offsets = (1 - STEPS)..STEPS;
    let weighted = |i: i32| {
        let share = f64::from(i) / f64::from(STEPS);
        power(nm + STEP_NM * share) * (1.0 - share.abs())
    };
    offsets.map(weighted).sum::<f64>() / f64::from(STEPS)
}
