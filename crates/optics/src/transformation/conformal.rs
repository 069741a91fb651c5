//! Conformal maps of the half plane above a flat mirror onto the space above a bumped one.

use glam::DVec2;
use num_complex::Complex64;
use pulp::Simd;
use thiserror::Error;

use super::flat::FlatMap;
use super::gaussian::GaussianMap;
use super::grating::GratingMap;
use super::quasi_conformal::{MOST_WIDTHS, QuasiConformalMap};
use crate::lanes::ComplexLanes;

mod inversion;

/// Value and derivatives of a conformal map at one virtual point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[must_use]
pub struct MapJet<C = Complex64> {
    /// f(ζ) = x + iy, cm.
    pub f: C,
    /// f'(ζ).
    pub f1: C,
    /// f''(ζ), 1/cm.
    pub f2: C,
}

impl MapJet {
    /// |f'|, by how much lengths grow from virtual to physical space. (`Complex64::norm` guards
    /// against overflow, which takes as long as evaluating the map.)
    #[inline]
    #[must_use]
    pub fn stretch(&self) -> f64 {
        self.f1.norm_sqr().sqrt()
    }
}

/// Value and derivatives at four virtual points.
pub(crate) type JetLanes<S> = MapJet<ComplexLanes<S>>;

/// A map that can be evaluated at four points at once. What is not used of the jets is not
/// computed.
pub(crate) trait LaneMap {
    /// Values and derivatives at virtual points, to be inlined.
    fn jets<S: Simd>(&self, zeta: ComplexLanes<S>) -> JetLanes<S>;
}

/// The same of whichever map it is.
macro_rules! of_each {
    ($of:expr, $map:ident => $same:expr) => {
        match $of {
            $crate::transformation::ConformalMap::Gaussian($map) => $same,
            $crate::transformation::ConformalMap::Grating($map) => $same,
            $crate::transformation::ConformalMap::QuasiConformal($map) => $same,
            $crate::transformation::ConformalMap::Flat($map) => $same,
        }
    };
}
pub(crate) use of_each;

impl LaneMap for ConformalMap {
    #[inline(never)]
    fn jets<S: Simd>(&self, zeta: ComplexLanes<S>) -> JetLanes<S> {
        of_each!(self, map => map.jets(zeta))
    }
}

/// A rectangle that a half-space device is cut to: x_min <= x <= x_max, y <= y_max, above the
/// floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truncation {
    /// Least x, cm.
    pub x_min: f64,
    /// Largest x, cm.
    pub x_max: f64,
    /// Largest y, cm.
    pub y_max: f64,
}

impl Truncation {
    /// `width` along x, centred, and `height` along y from the line Y = 0 upwards, in cm.
    #[must_use]
    pub fn centred(width: f64, height: f64) -> Self {
        Self { x_min: -0.5 * width, x_max: 0.5 * width, y_max: height }
    }
}

/// A conformal map x + iy = f(X + iY) of the virtual half plane Y >= 0 (capital = virtual; lengths
/// in cm).
///
/// Filled with the isotropic index n = c/|f'|, the space above the bumped floor f(X) looks like the
/// half plane of index c above a flat mirror (Leonhardt, Science 312, 1777 (2006)).
#[derive(Clone, Debug, PartialEq)]
pub enum ConformalMap {
    /// The Gaussian carpet, one half of the double-Gaussian cloak.
    Gaussian(GaussianMap),
    /// A sinusoidal grating.
    Grating(GratingMap),
    /// A box with a bump whose border slides.
    QuasiConformal(QuasiConformalMap),
    /// No map: the space above a flat floor is as it was.
    Flat(FlatMap),
}

/// Why there is no such map.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ConformalMapError {
    /// A length is not a finite positive number.
    #[error("the {name} of a {map} must be a finite positive length, not {value}")]
    Length {
        /// Which map it was to be.
        map: &'static str,
        /// Which length.
        name: &'static str,
        /// What it was, cm.
        value: f64,
    },
    /// The floor is so steep that the map folds over.
    #[error("a {map} needs {limit}, not {ratio}; a lower or a wider bump would do")]
    Folds {
        /// Which map it was to be.
        map: &'static str,
        /// What must hold.
        limit: &'static str,
        /// The ratio that does not keep to it.
        ratio: f64,
    },
    /// The bump does not fit into the box.
    #[error("the bump is {width} cm wide; it must fit into the device, {box_width} cm")]
    TooWide {
        /// w, cm.
        width: f64,
        /// 2A, cm.
        box_width: f64,
    },
    /// The bump is so narrow that its map would take too many terms.
    #[error(
        "the bump is {width} cm wide; it must be at least {least} cm, 1/{MOST_WIDTHS} of the device"
    )]
    TooNarrow {
        /// w, cm.
        width: f64,
        /// The least w, cm.
        least: f64,
    },
    /// The bump reaches the top of the box.
    #[error("the bump is {height} cm high; it must be lower than the device, {box_height} cm")]
    TooHigh {
        /// h, cm.
        height: f64,
        /// H, cm.
        box_height: f64,
    },
    /// The bump is too steep for the map to be found.
    #[error(
        "the bump is too steep: h/w is {ratio}, and no map of it was found; below 0.5 there is one"
    )]
    TooSteep {
        /// h/w.
        ratio: f64,
    },
}

impl ConformalMapError {
    /// If one of some named values is no finite positive length.
    pub(super) fn unless_lengths(
        map: &'static str,
        lengths: &[(&'static str, f64)],
    ) -> Result<(), Self> {
        let wrong = lengths.iter().find(|(_, value)| !(value.is_finite() && *value > 0.0));
        wrong.map_or(Ok(()), |&(name, value)| Err(Self::Length { map, name, value }))
    }
}

impl ConformalMap {
    /// Value and derivatives at a virtual point.
    #[inline]
    pub fn jet(&self, zeta: Complex64) -> MapJet {
        of_each!(self, map => map.jet(zeta))
    }

    /// The length over which the map varies, cm.
    #[must_use]
    pub fn scale(&self) -> f64 {
        match self {
            Self::Gaussian(map) => map.width,
            Self::Grating(map) => map.wave_number.recip(),
            Self::QuasiConformal(map) => 0.25 * map.bump.width,
            Self::Flat(map) => map.scale,
        }
    }

    /// By how much the error of a low order exceeds that of a high one in steps of the length that
    /// a ray takes. The quasi-conformal map is nearly singular at the feet of the bump, where the
    /// floor's curvature jumps: measured, nothing can be counted on there.
    pub(crate) fn smoothness(&self) -> f64 {
        if matches!(self, Self::QuasiConformal(_)) { 3.0 } else { 100.0 }
    }

    /// The longest step about a virtual point, `usual` being what suits the map where it varies
    /// most, cm.
    pub(crate) fn longest_stride(&self, zeta: Complex64, usual: f64) -> f64 {
        match self {
            Self::Gaussian(_) | Self::QuasiConformal(_) => usual.max(zeta.norm_sqr().sqrt() / 3.0),
            Self::Grating(_) => usual.max(zeta.im / 3.0),
            Self::Flat(_) => usual,
        }
    }

    /// The largest height y of the floor, cm.
    #[must_use]
    pub fn peak(&self) -> f64 {
        match self {
            Self::Gaussian(map) => map.height,
            Self::Grating(map) => map.height,
            Self::QuasiConformal(map) => map.solved.peak,
            Self::Flat(map) => map.level,
        }
    }

    /// The least height y of the floor, cm.
    #[must_use]
    pub fn trough(&self) -> f64 {
        if let Self::Grating(map) = self { -map.height } else { self.level() }
    }

    /// The height y of the floor far from what is on it, cm.
    #[must_use]
    pub fn level(&self) -> f64 {
        if let Self::Flat(map) = self { map.level } else { 0.0 }
    }

    /// The virtual X of the floor point above physical `x`.
    #[must_use]
    pub fn floor_parameter(&self, x: f64) -> f64 {
        match self {
            Self::Gaussian(map) => map.floor_parameter(x),
            Self::Grating(map) => map.floor_parameter(x),
            Self::QuasiConformal(map) => map.floor_parameter(x),
            Self::Flat(_) => x,
        }
    }

    /// The height y of the floor above physical `x`.
    #[must_use]
    pub fn floor_height_at(&self, x: f64) -> f64 {
        match self {
            Self::Gaussian(map) => map.floor_height_at(x),
            Self::Grating(map) => map.floor_height_at(x),
            Self::QuasiConformal(map) => map.floor_height_at(x),
            Self::Flat(map) => map.level,
        }
    }

    /// The floor between two physical x as that many straight pieces.
    #[must_use]
    pub fn floor_line(&self, x_min: f64, x_max: f64, pieces: u32) -> Vec<DVec2> {
        let (start, end) = (self.floor_parameter(x_min), self.floor_parameter(x_max));
        (0..=pieces)
            .map(|k| {
                let share = f64::from(k) / f64::from(pieces.max(1));
                let point = self.jet((start + (end - start) * share).into()).f;
                DVec2::new(point.re, point.im)
            })
            .collect()
    }

    /// The metal as a curve, with the derivatives by its real parameter. It is f(X), or what f(X)
    /// comes near to where the map is a series.
    pub(crate) fn profile(&self, parameter: f64) -> MapJet {
        match self {
            Self::Gaussian(_) | Self::Grating(_) | Self::Flat(_) => self.jet(parameter.into()),
            Self::QuasiConformal(map) => map.bump.profile(parameter),
        }
    }

    /// The parameter of [`Self::profile`] at physical `x`.
    pub(crate) fn profile_parameter(&self, x: f64) -> f64 {
        if matches!(self, Self::QuasiConformal(_)) { x } else { self.floor_parameter(x) }
    }

    /// The parameters between two others at which [`Self::profile`] changes the sense of its bend,
    /// in rising order.
    pub(crate) fn profile_inflections(&self, start: f64, end: f64) -> Vec<f64> {
        match self {
            Self::Gaussian(_) => self.sampled_inflections(start, end),
            Self::Grating(map) => map.inflections(start, end),
            Self::QuasiConformal(map) => map.inflections(start, end),
            Self::Flat(_) => Vec::new(),
        }
    }

    fn sampled_inflections(&self, start: f64, end: f64) -> Vec<f64> {
        let samples = samples_over((end - start) / self.scale());
        let bend = |x: f64| {
            let jet = self.profile(x);
            (jet.f1.conj() * jet.f2).im
        };
        let sample = |k: u32| start + (end - start) * f64::from(k) / f64::from(samples);
        let inflection = |(mut a, mut b): (f64, f64)| {
            let rising = bend(b) > 0.0;
            if rising == (bend(a) > 0.0) {
                return None;
            }
            while b - a > 4.0 * f64::EPSILON * (a.abs() + b.abs()) {
                let middle = 0.5 * (a + b);
                if rising == (bend(middle) > 0.0) { b = middle } else { a = middle }
            }
            Some(0.5 * (a + b))
        };
        (0..samples).map(|k| (sample(k), sample(k + 1))).filter_map(inflection).collect()
    }

    /// The area between the line y = 0 and the floor within the ends of a cut device, cm².
    #[must_use]
    pub fn area_within(&self, cut: &Truncation) -> f64 {
        let from_middle = |x: f64| match self {
            Self::Gaussian(map) => map.area_from_middle_to(x),
            Self::Grating(map) => map.area_from_middle_to(x),
            Self::QuasiConformal(map) => map.area_from_middle_to(x),
            Self::Flat(map) => map.level * x,
        };
        from_middle(cut.x_max) - from_middle(cut.x_min)
    }

    /// Least and largest 1/|f'| in a cut device: the range of its index for c = 1.
    ///
    /// log |f'| is harmonic, so both lie on the border; a search there finds them.
    #[must_use]
    pub fn index_range(&self, cut: &Truncation) -> (f64, f64) {
        let (start, end) = (self.floor_parameter(cut.x_min), self.floor_parameter(cut.x_max));
        let between = |a: f64, b: f64, s: f64| a + (b - a) * s;
        let index = |zeta: Complex64| self.jet(zeta).stretch().recip();
        let at = |x: f64, y: f64| self.invert(Complex64::new(x, y)).map(index);
        let side = |x: f64, s: f64| at(x, between(self.floor_height_at(x), cut.y_max, s));
        let samples = samples_over((cut.x_max - cut.x_min).max(cut.y_max) / self.scale());
        let border: [&dyn Fn(f64) -> Option<f64>; 4] = [
            &|s| Some(index(between(start, end, s).into())),
            &|s| side(cut.x_min, s),
            &|s| side(cut.x_max, s),
            &|s| at(between(cut.x_min, cut.x_max, s), cut.y_max),
        ];
        border
            .map(|side| range_over(samples, side))
            .into_iter()
            .fold((f64::INFINITY, 0.0), |a, b| (b.0.min(a.0), b.1.max(a.1)))
    }
}

/// How many samples of a map miss none of its features over so many of its scales.
fn samples_over(scales: f64) -> u32 {
    (32.0 * scales).clamp(200.0, 1e5) as u32
}

/// Least and largest value of a positive function over 0 <= s <= 1, smooth between `samples`.
fn range_over(samples: u32, function: &dyn Fn(f64) -> Option<f64>) -> (f64, f64) {
    let spacing = f64::from(samples).recip();
    let sampled: Vec<_> = (0..=samples)
        .map(|k| f64::from(k) / f64::from(samples))
        .filter_map(|s| Some((s, function(s)?)))
        .collect();
    let extreme = |sign: f64| {
        let value = |s: f64| function(s).map_or(f64::INFINITY, |v| sign * v);
        let signed = sampled.iter().map(|(s, v)| (*s, sign * v));
        let best = signed.min_by(|a, b| a.1.total_cmp(&b.1));
        let (best, least) = best.unwrap_or((0.0, f64::INFINITY));
        let (mut a, mut b) = ((best - spacing).max(0.0), (best + spacing).min(1.0));
        // Shortening the bracket by thirds narrows it below the flatness of an extremum.
        for _ in 0..50 {
            let (p, q) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
            if value(p) < value(q) { b = q } else { a = p }
        }
        sign * value(0.5 * (a + b)).min(least)
    };
    (extreme(1.0), extreme(-1.0))
}

#[cfg(test)]
mod tests;
