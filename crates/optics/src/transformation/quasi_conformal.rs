//! The quasi-conformal map of the carpet cloak of Li & Pendry.

mod chirp;
mod series;
mod table;

use std::f64::consts::PI;
use std::sync::Arc;

use num_complex::Complex64;
use pulp::Simd;

use self::series::Series;
use self::table::Table;
use super::conformal::{ConformalMapError, JetLanes, LaneMap, MapJet, Truncation};
use super::monotone_root::root_between;
use crate::lanes::ComplexLanes;

/// The map of the box |x| <= A, y <= H above the floor y = h cos²(πx/w), |x| < w/2, else 0, from a
/// rectangle |X| <= A, 0 <= Y <= H_c, whose borders may slide along those of the box (Li & Pendry,
/// Phys. Rev. Lett. 101, 203901 (2008)).
///
/// Sliding borders make it conformal: by Schwarz's reflection it is the sine series
/// f(ζ) = ζ + i y0 - Σ b_j sin(k_j (ζ - i H_c))/sinh(k_j H_c), k_j = πj/A, H_c = H - y0, and only
/// the heights H and H_c differ. That anisotropy H/H_c neglected, the index is c/|f'| with
/// c = √(H/H_c). The series is broken off where its floor is that of the device to 1e-4 h.
///
/// It holds tables: copies share them.
#[derive(Clone, Debug)]
pub struct QuasiConformalMap {
    /// The device's own floor, to which the series comes near.
    pub(super) bump: Bump,
    pub(super) solved: Arc<Solved>,
}

/// The floor: h cos²(πx/w) for |x| < w/2, else 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bump {
    height: f64,
    pub width: f64,
}

#[derive(Debug)]
pub(super) struct Solved {
    /// A and H.
    box_size: [f64; 2],
    series: Series,
    table: Table,
    /// The largest height of the floor of the series, cm.
    pub peak: f64,
}

impl PartialEq for QuasiConformalMap {
    fn eq(&self, other: &Self) -> bool {
        // The rest follows.
        self.bump == other.bump && self.solved.box_size == other.solved.box_size
    }
}

/// The widest box, in widths of the bump: the table of the map takes time and room as the square of
/// it, some tenths of a second here.
pub(super) const MOST_WIDTHS: f64 = 10.0;

impl Bump {
    /// The floor as a curve over x, with its derivatives by x.
    pub(super) fn profile(self, x: f64) -> MapJet {
        let Self { height, width } = self;
        if x.abs() >= 0.5 * width {
            return MapJet { f: x.into(), f1: Complex64::ONE, f2: Complex64::ZERO };
        }
        let k = 2.0 * PI / width;
        let (sin, cos) = (k * x).sin_cos();
        let half = 0.5 * height;
        MapJet {
            f: Complex64::new(x, half * (1.0 + cos)),
            f1: Complex64::new(1.0, -half * k * sin),
            f2: Complex64::new(0.0, -half * k * k * cos),
        }
    }

    fn height_at(self, x: f64) -> f64 {
        self.profile(x).f.im
    }
}

impl QuasiConformalMap {
    /// Solves for the map of a bump of whole width `w` and height `h` in a device as large as
    /// `cut`, which must be centred; in cm.
    ///
    /// # Errors
    ///
    /// If a length is not finite and positive, or the bump too wide, narrow, high or steep for the
    /// device.
    pub fn new(w: f64, h: f64, cut: &Truncation) -> Result<Self, ConformalMapError> {
        let [half_width, box_height] = [cut.x_max, cut.y_max];
        let lengths =
            [("width w", w), ("height h", h), ("width", half_width), ("height", box_height)];
        ConformalMapError::unless_lengths("carpet", &lengths)?;
        let box_width = 2.0 * half_width;
        if w > box_width {
            return Err(ConformalMapError::TooWide { width: w, box_width });
        }
        if w * MOST_WIDTHS < box_width {
            let least = box_width / MOST_WIDTHS;
            return Err(ConformalMapError::TooNarrow { width: w, least });
        }
        if h >= box_height {
            return Err(ConformalMapError::TooHigh { height: h, box_height });
        }
        let bump = Bump { height: h, width: w };
        let series = Series::solve(bump, half_width, box_height)
            .ok_or(ConformalMapError::TooSteep { ratio: h / w })?;
        let table = Table::new(&series);
        let peak = h.max(table.jet(Complex64::ZERO).f.im);
        let box_size = [half_width, box_height];
        Ok(Self { bump, solved: Arc::new(Solved { box_size, series, table, peak }) })
    }

    /// The height H_c of the virtual rectangle, cm.
    fn virtual_height(&self) -> f64 {
        self.solved.series.virtual_height
    }

    /// H/H_c: by how much the neglected anisotropy stretches the virtual rectangle.
    #[must_use]
    pub fn anisotropy(&self) -> f64 {
        self.solved.box_size[1] / self.virtual_height()
    }

    /// c = √(H/H_c) of the index c/|f'|.
    #[must_use]
    pub fn index_scale(&self) -> f64 {
        self.anisotropy().sqrt()
    }

    /// Value and derivatives at a virtual point (cm), from the table.
    #[inline]
    pub fn jet(&self, zeta: Complex64) -> MapJet {
        self.solved.table.jet(zeta)
    }

    /// A virtual point to start the inversion of `z` from: each vertical line evenly squeezed.
    pub(super) fn first_guess(&self, z: Complex64) -> Complex64 {
        let (height, low) = (self.solved.box_size[1], self.bump.height_at(z.re));
        Complex64::new(z.re, (z.im - low).max(0.0) * self.virtual_height() / (height - low))
    }

    /// The virtual X of the floor point at physical `x` (cm).
    pub(super) fn floor_parameter(&self, x: f64) -> f64 {
        let half = self.solved.box_size[0];
        root_between(-half, half, |virtual_x| {
            let jet = self.jet(virtual_x.into());
            (jet.f.re - x, jet.f1.re)
        })
    }

    /// The height of the series' floor at physical `x` (cm).
    pub(super) fn floor_height_at(&self, x: f64) -> f64 {
        self.jet(self.floor_parameter(x).into()).f.im
    }

    /// Where the floor's bend changes its sense or begins.
    pub(super) fn inflections(&self, start: f64, end: f64) -> Vec<f64> {
        let inside = |x: &f64| *x > start && *x < end;
        [-0.5, -0.25, 0.25, 0.5].map(|x| x * self.bump.width).into_iter().filter(inside).collect()
    }

    /// The area below the floor from x = 0 to physical `x`, cm²; odd in x.
    pub(super) fn area_from_middle_to(&self, x: f64) -> f64 {
        let Bump { height, width } = self.bump;
        let x = x.clamp(-0.5 * width, 0.5 * width);
        let k = 2.0 * PI / width;
        0.5 * height * (x + (k * x).sin() / k)
    }
}

impl LaneMap for QuasiConformalMap {
    #[inline(always)]
    fn jets<S: Simd>(&self, zeta: ComplexLanes<S>) -> JetLanes<S> {
        self.solved.table.jets(zeta)
    }
}

#[cfg(test)]
mod tests;
