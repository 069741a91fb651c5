//! The series as a table of Taylor polynomials: hundreds of terms would be too slow for every step
//! of a ray.
//!
//! The map is least smooth on the floor, where its wavelengths are shortest, and ever smoother
//! above: the patches double in size from band to band, as their distance from the floor does.

use num_complex::Complex64;
use pulp::Simd;

use super::super::conformal::{JetLanes, MapJet};
use super::series::Series;
use crate::lanes::ComplexLanes;

/// Taylor terms of f' in a patch.
const TERMS: usize = 11;

/// 1/(n + 1).
const INVERSE: [f64; TERMS] = {
    let mut inverse = [0.0; TERMS];
    let mut n = 0;
    while n < TERMS {
        inverse[n] = 1.0 / (n as f64 + 1.0);
        n += 1;
    }
    inverse
};

/// The least distance from the floor in units of a band's spacing, so that the first term left out
/// is below rounding.
const DISTANCE: f64 = 8.0;

/// Rows of the lowest band below Y = 0, where steps of a ray may stray.
const BELOW: usize = 8;

/// f(ζ0) and the coefficients c_n of f'(ζ0 + d) = Σ c_n d^n.
#[derive(Debug)]
struct Patch {
    value: Complex64,
    slopes: [Complex64; TERMS],
}

#[derive(Debug)]
pub(super) struct Table {
    half_width: f64,
    virtual_height: f64,
    height: f64,
    bands: Vec<Band>,
}

/// Patches of equal size between two Y.
#[derive(Debug)]
struct Band {
    spacing: f64,
    inverse_spacing: f64,
    /// Y of the first row.
    bottom: f64,
    rows: usize,
    /// Row by row, 0 <= X <= A.
    patches: Vec<Patch>,
    columns: usize,
}

impl Table {
    pub fn new(series: &Series) -> Self {
        let (half_width, virtual_height) = (series.half_width, series.virtual_height);
        let least = 1.0 / series.highest_wave_number();
        let band = |step: u64, bottom: f64| {
            let top = 2.0 * DISTANCE * step as f64 * least;
            Band::new(series, (step, least), bottom, top.min(virtual_height))
        };
        let mut step = 1;
        let mut bands = vec![band(step, -(BELOW as f64) * least)];
        while 2.0 * DISTANCE * step as f64 * least < virtual_height {
            step *= 2;
            bands.push(band(step, DISTANCE * step as f64 * least));
        }
        let [top, ..] = series.taylor::<2>(Complex64::new(0.0, virtual_height));
        Self { half_width, virtual_height, height: top.im, bands }
    }

    /// Value and derivatives anywhere: beyond X = ±A and Y = H_c by the symmetries of the series.
    pub fn jet(&self, zeta: Complex64) -> MapJet {
        let TablePoint { patch, d, shift, sign, mirror } = self.find(zeta);
        let (mut f1, mut f2) = (patch.slopes[TERMS - 1], Complex64::ZERO);
        for c in patch.slopes[..TERMS - 1].iter().rev() {
            f2 = f2 * d + f1;
            f1 = f1 * d + c;
        }
        let mut f = Complex64::ZERO;
        for (c, inverse) in patch.slopes.iter().zip(INVERSE).rev() {
            f = f * d + c * inverse;
        }
        f = f * d + patch.value;
        let im = if mirror < 0.0 { 2.0 * self.height - f.im } else { f.im };
        MapJet {
            f: Complex64::new(sign * f.re + shift, im),
            f1: Complex64::new(f1.re, sign * mirror * f1.im),
            f2: Complex64::new(sign * f2.re, mirror * f2.im),
        }
    }

    /// As [`Self::jet`] at four points.
    #[inline(always)]
    pub fn jets<S: Simd>(&self, zeta: ComplexLanes<S>) -> JetLanes<S> {
        let [a, b, c, d] = zeta.values();
        let (a, b, c, d) = (self.find(a), self.find(b), self.find(c), self.find(d));
        let like = zeta.re;
        let off = zeta.with([a.d, b.d, c.d, d.d]);
        let mut slopes = [off; TERMS];
        for (n, slope) in slopes.iter_mut().enumerate() {
            *slope = zeta.with([&a, &b, &c, &d].map(|point| point.patch.slopes[n]));
        }
        let mut f2 = zeta.real(0.0);
        let mut f1 = slopes[TERMS - 1];
        let mut f = f1 * INVERSE[TERMS - 1];
        for n in (0..TERMS - 1).rev() {
            f2 = f2 * off + f1;
            f1 = f1 * off + slopes[n];
            f = f * off + slopes[n] * INVERSE[n];
        }
        f = f * off + zeta.with([a.patch.value, b.patch.value, c.patch.value, d.patch.value]);
        let sign = like.with([a.sign, b.sign, c.sign, d.sign]);
        let mirror = like.with([a.mirror, b.mirror, c.mirror, d.mirror]);
        let shift = like.with([a.shift, b.shift, c.shift, d.shift]);
        // 2H for the mirror images, else 0.
        let height = (like.all(1.0) - mirror) * self.height;
        JetLanes {
            f: ComplexLanes { re: sign * f.re + shift, im: height + mirror * f.im },
            f1: ComplexLanes { re: f1.re, im: sign * mirror * f1.im },
            f2: ComplexLanes { re: sign * f2.re, im: mirror * f2.im },
        }
    }

    /// Any point in the table.
    #[inline(always)]
    fn find(&self, zeta: Complex64) -> TablePoint<'_> {
        // f(ζ + 2A) = f(ζ) + 2A, f(-conj ζ) = -conj f(ζ), f(conj ζ + 2iH_c) = conj f(ζ) + 2iH.
        let period = 2.0 * self.half_width;
        let shift =
            if zeta.re.abs() > self.half_width { (zeta.re / period).round() * period } else { 0.0 };
        let x = zeta.re - shift;
        let above = zeta.im > self.virtual_height;
        let y = if above { 2.0 * self.virtual_height - zeta.im } else { zeta.im };
        let (patch, d) = self.patch(x.abs(), y);
        let sign = 1.0_f64.copysign(x);
        let mirror = if above { -1.0 } else { 1.0 };
        TablePoint { patch, d, shift, sign, mirror }
    }

    /// The patch for X from 0 to A and Y up to H_c, and where in it.
    #[inline]
    fn patch(&self, x: f64, y: f64) -> (&Patch, Complex64) {
        // log2 of Y in units of where the first band ends, at least one lower.
        let unit = y * self.bands[0].inverse_spacing * (0.5 / DISTANCE);
        let band = if unit >= 1.0 { (unit.to_bits() >> 52) as usize - 1022 } else { 0 };
        let band = &self.bands[band.min(self.bands.len() - 1)];
        // Casts saturate: what lies below the table continues its lowest row.
        let column = ((x * band.inverse_spacing + 0.5) as usize).min(band.columns - 1);
        let row = (((y - band.bottom) * band.inverse_spacing + 0.5) as usize).min(band.rows - 1);
        let patch = &band.patches[row * band.columns + column];
        let d = Complex64::new(
            x - column as f64 * band.spacing,
            y - (band.bottom + row as f64 * band.spacing),
        );
        (patch, d)
    }
}

/// Where a point is in the table.
struct TablePoint<'a> {
    patch: &'a Patch,
    d: Complex64,
    /// By how much X is off its place in the table.
    shift: f64,
    /// The sign of X there.
    sign: f64,
    /// -1 for a point above Y = H_c, of which the table holds the mirror image.
    mirror: f64,
}

impl Band {
    /// The patches on 0 <= X <= A between two Y, `step` times the least spacing apart.
    fn new(series: &Series, (step, least): (u64, f64), bottom: f64, top: f64) -> Self {
        let spacing = step as f64 * least;
        let columns = (series.half_width / spacing).round() as usize + 1;
        let rows = ((top - bottom) / spacing).round() as usize + 1;
        let mut transform = series.transform_along(columns, step, bottom);
        let patches = (0..rows)
            .flat_map(|row| {
                let y = bottom + row as f64 * spacing;
                series.taylor_along::<{ TERMS + 1 }>(&mut transform, columns, spacing, y)
            })
            .map(|taylor| Patch {
                value: taylor[0],
                slopes: std::array::from_fn(|n| (n + 1) as f64 * taylor[n + 1]),
            })
            .collect();
        Self { spacing, inverse_spacing: spacing.recip(), bottom, rows, patches, columns }
    }
}
