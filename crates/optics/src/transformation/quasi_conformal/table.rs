//! The series as a table of Taylor polynomials: hundreds of terms would be too slow for every step of a ray.
//!
//! The map is least smooth on the floor, where its wavelengths are shortest, and ever smoother above: the
//! patches double in size from band to band, as their distance from the floor does.

use num_complex::Complex64;

use super::super::conformal::MapJet;
use super::series::Series;

/// Taylor terms of f' in a patch.
const TERMS: usize = 11;

/// The least distance from the floor in units of a band's spacing, so that the first term left out is below
/// rounding.
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
        let mut spacing = 1.0 / series.highest_wave_number();
        let mut bands = vec![Band::new(
            series,
            spacing,
            -(BELOW as f64) * spacing,
            (2.0 * DISTANCE * spacing).min(virtual_height),
        )];
        while 2.0 * DISTANCE * spacing < virtual_height {
            spacing *= 2.0;
            let top = (2.0 * DISTANCE * spacing).min(virtual_height);
            bands.push(Band::new(series, spacing, DISTANCE * spacing, top));
        }
        let [top, ..] = series.taylor::<2>(Complex64::new(0.0, virtual_height));
        Self { half_width, virtual_height, height: top.im, bands }
    }

    /// Value and derivatives anywhere: beyond X = ±A and Y = H_c by the symmetries of the series.
    ///
    /// The steps of a ray need the derivatives alone; inlined, the value is computed only where it is used.
    #[inline]
    pub fn jet(&self, zeta: Complex64) -> MapJet {
        let local = self.local(zeta);
        MapJet { f: local.value(self.height), f1: local.f1, f2: local.f2 }
    }

    #[inline(never)]
    fn local(&self, zeta: Complex64) -> Local<'_> {
        // f(ζ + 2A) = f(ζ) + 2A, f(-conj ζ) = -conj f(ζ), f(conj ζ + 2iH_c) = conj f(ζ) + 2iH.
        let period = 2.0 * self.half_width;
        let shift =
            if zeta.re.abs() > self.half_width { (zeta.re / period).round() * period } else { 0.0 };
        let x = zeta.re - shift;
        let above = zeta.im > self.virtual_height;
        let y = if above { 2.0 * self.virtual_height - zeta.im } else { zeta.im };
        let (patch, d) = self.patch(x.abs(), y);
        let (mut f1, mut f2) = (patch.slopes[TERMS - 1], Complex64::ZERO);
        for c in patch.slopes[..TERMS - 1].iter().rev() {
            f2 = f2 * d + f1;
            f1 = f1 * d + c;
        }
        let side = 1.0_f64.copysign(x);
        let mirror = if above { -1.0 } else { 1.0 };
        Local {
            patch,
            d,
            shift,
            side,
            above,
            f1: Complex64::new(f1.re, side * mirror * f1.im),
            f2: Complex64::new(side * f2.re, mirror * f2.im),
        }
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

/// The map about a point, but for its value.
struct Local<'a> {
    patch: &'a Patch,
    d: Complex64,
    shift: f64,
    side: f64,
    above: bool,
    f1: Complex64,
    f2: Complex64,
}

impl Local<'_> {
    /// f, `height` being H.
    #[inline]
    fn value(&self, height: f64) -> Complex64 {
        let (mut f, mut order) = (Complex64::ZERO, TERMS as f64);
        for c in self.patch.slopes.iter().rev() {
            f = f * self.d + c / order;
            order -= 1.0;
        }
        f = f * self.d + self.patch.value;
        let im = if self.above { 2.0 * height - f.im } else { f.im };
        Complex64::new(self.side * f.re + self.shift, im)
    }
}

impl Band {
    /// The patches on 0 <= X <= A between two Y.
    fn new(series: &Series, spacing: f64, bottom: f64, top: f64) -> Self {
        let columns = (series.half_width / spacing).round() as usize + 1;
        let rows = ((top - bottom) / spacing).round() as usize + 1;
        let patches = (0..rows * columns)
            .map(|index| {
                let (row, column) = (index / columns, index % columns);
                let zeta = Complex64::new(column as f64 * spacing, bottom + row as f64 * spacing);
                let taylor = series.taylor::<{ TERMS + 1 }>(zeta);
                Patch {
                    value: taylor[0],
                    slopes: std::array::from_fn(|n| (n + 1) as f64 * taylor[n + 1]),
                }
            })
            .collect();
        Self { spacing, inverse_spacing: spacing.recip(), bottom, rows, patches, columns }
    }
}
