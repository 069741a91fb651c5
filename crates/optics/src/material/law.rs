//! Laws of the refractive index.

use super::slope::Sloped;
use num_complex::Complex64;
use std::borrow::Cow;

/// The product of the wavelength in µm and the energy of a photon in eV.
const UM_EV: f64 = 1.239_841_984_332_002_8;

/// How a refractive index depends on the wavelength in vacuum.
#[derive(Clone, Debug, PartialEq)]
pub struct IndexLaw {
    /// The index of refraction, complex for [`Dispersion::Resonances`] alone.
    pub dispersion: Dispersion,
    /// The extinction coefficient k of n + ik; none where the law is of a transparent medium.
    pub extinction: Option<Table>,
    /// The wavelengths for which it holds, µm.
    pub range_um: [f64; 2],
}

/// The kinds of laws. Wavelengths λ are in µm.
#[derive(Clone, Debug, PartialEq)]
pub enum Dispersion {
    /// One of the dispersion formulas 1 to 9 of the refractiveindex.info database, with its
    /// coefficients c1, c2, ...; those that are missing are 0:
    ///
    /// 1. n² = 1 + c1 + Σ c2 λ²/(λ² - c3²), Sellmeier's;
    /// 2. n² = 1 + c1 + Σ c2 λ²/(λ² - c3), the same with squared poles;
    /// 3. n² = c1 + Σ c2 λ^c3;
    /// 4. n² = c1 + c2 λ^c3/(λ² - c4^c5) + c6 λ^c7/(λ² - c8^c9) + Σ c10 λ^c11;
    /// 5. n = c1 + Σ c2 λ^c3, Cauchy's;
    /// 6. n = 1 + c1 + Σ c2/(c3 - λ⁻²), of gases;
    /// 7. n = c1 + c2/(λ² - 0.028) + c3/(λ² - 0.028)² + c4 λ² + c5 λ⁴ + ..., Herzberger's;
    /// 8. (n² - 1)/(n² + 2) = c1 + c2 λ²/(λ² - c3) + c4 λ², Retro's;
    /// 9. n² = c1 + c2/(λ² - c3) + c4 (λ - c5)/((λ - c5)² + c6).
    Formula {
        /// Its number.
        number: u8,
        /// c1, c2 and so on.
        coefficients: Cow<'static, [f64]>,
    },
    /// Between measured indices.
    Table(Table),
    /// Charges that are bound or free, of which light has the energy E: ε = ε∞ - Ep²/(E² + iΓE) +
    /// Σ s E0²/(E0² - E² - iΓE), Drude's and Lorentz's.
    Resonances {
        /// The permittivity ε∞ far above all resonances.
        permittivity_infinity: f64,
        /// The energy Ep of the plasma of free charges and the width Γ, eV; none by 0.
        plasma_ev: [f64; 2],
        /// Strength s, energy E0 (eV) and width Γ (eV) of each resonance.
        lorentz: Vec<[f64; 3]>,
    },
}

/// Values at rising wavelengths (µm), and straight lines between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Wavelengths, µm.
    pub wavelengths_um: Cow<'static, [f64]>,
    /// The value at each of them.
    pub values: Cow<'static, [f64]>,
}

/// A refractive index at one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refraction {
    /// The index N = n + ik.
    pub index: Complex64,
    /// The group index N - λ dN/dλ, which is d(ωN)/dω.
    pub group_index: Complex64,
}

impl Refraction {
    /// The relative permittivity N², of a medium that is not magnetic.
    #[must_use]
    pub fn permittivity(&self) -> Complex64 {
        self.index * self.index
    }

    /// d(ωε)/dω of the permittivity.
    #[must_use]
    pub fn dispersive_permittivity(&self) -> Complex64 {
        self.index * (2.0 * self.group_index - self.index)
    }
}

/// Why there is no index.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum IndexLawError {
    /// The law is not known to hold there.
    #[error("its law holds from {} to {} nm, and the wavelength is {} nm", nm(range_um[0]), nm(range_um[1]), nm(*wavelength_um))]
    OutOfRange {
        /// The wavelength, µm.
        wavelength_um: f64,
        /// Where the law holds, µm.
        range_um: [f64; 2],
    },
    /// It gives no number, or one that no medium has.
    #[error("its law gives n = {}, k = {} at {} nm, which no medium has: neither is negative, nor are both 0", index.re, index.im, nm(*wavelength_um))]
    NoIndex {
        /// The wavelength, µm.
        wavelength_um: f64,
        /// What it gives.
        index: Complex64,
    },
}

/// A wavelength in nm, without the rounding of the unit.
fn nm(um: f64) -> f64 {
    (um * 1e6).round() / 1e3
}

/// How far beyond the ends of its range, relatively, a law still holds: for rounding.
const ROUNDING: f64 = 1e-9;

impl IndexLaw {
    /// The index at a wavelength in vacuum, µm.
    ///
    /// # Errors
    ///
    /// If the wavelength is outside the law's range, or the law gives no index there.
    pub fn at(&self, wavelength_um: f64) -> Result<Refraction, IndexLawError> {
        let [least, most] = self.range_um;
        let range_um = self.range_um;
        if !(least * (1.0 - ROUNDING)..=most * (1.0 + ROUNDING)).contains(&wavelength_um) {
            return Err(IndexLawError::OutOfRange { wavelength_um, range_um });
        }
        let wavelength = wavelength_um.clamp(least, most);
        let found = match &self.dispersion {
            Dispersion::Formula { number, coefficients } => {
                refraction(formula(*number, coefficients, Sloped::variable(wavelength)), wavelength)
            }
            Dispersion::Table(table) => refraction(table.at(wavelength), wavelength),
            Dispersion::Resonances { permittivity_infinity, plasma_ev, lorentz } => {
                resonances(*permittivity_infinity, *plasma_ev, lorentz, UM_EV / wavelength)
            }
        };
        let extinction = match &self.extinction {
            Some(table) => refraction(table.at(wavelength), wavelength),
            None => Refraction { index: Complex64::ZERO, group_index: Complex64::ZERO },
        };
        let refraction = Refraction {
            index: found.index + Complex64::I * extinction.index,
            group_index: found.group_index + Complex64::I * extinction.group_index,
        };
        let Complex64 { re, im } = refraction.index;
        let is_index = re >= 0.0 && im >= 0.0 && refraction.index != Complex64::ZERO;
        if is_index && re.is_finite() && im.is_finite() && refraction.group_index.is_finite() {
            Ok(refraction)
        } else {
            Err(IndexLawError::NoIndex { wavelength_um, index: refraction.index })
        }
    }
}

/// Of a real index.
fn refraction(index: Sloped, wavelength: f64) -> Refraction {
    let group_index = index.value - wavelength * index.slope;
    Refraction { index: index.value.into(), group_index: group_index.into() }
}

impl Table {
    fn at(&self, wavelength: f64) -> Sloped {
        let (wavelengths, values) = (&self.wavelengths_um, &self.values);
        let after = wavelengths.partition_point(|known| *known <= wavelength);
        let Some(first) = after.min(wavelengths.len().saturating_sub(1)).checked_sub(1) else {
            return Sloped { value: values.first().copied().unwrap_or(f64::NAN), slope: 0.0 };
        };
        let slope =
            (values[first + 1] - values[first]) / (wavelengths[first + 1] - wavelengths[first]);
        Sloped { value: values[first] + slope * (wavelength - wavelengths[first]), slope }
    }
}

/// The index by one of the formulas.
fn formula(number: u8, coefficients: &[f64], wavelength: Sloped) -> Sloped {
    let c = |i: usize| coefficients.get(i - 1).copied().unwrap_or(0.0);
    // The coefficients from one on, in groups.
    let pairs = |first: usize| coefficients.get(first - 1..).unwrap_or(&[]).chunks_exact(2);
    let square = wavelength * wavelength;
    let nothing = Sloped::from(0.0);
    match number {
        1 | 2 => {
            let term = |term: &[f64]| {
                let pole = if number == 1 { term[1] * term[1] } else { term[1] };
                square * term[0] / (square - pole)
            };
            pairs(2).map(term).fold(Sloped::from(1.0 + c(1)), |sum, term| sum + term).sqrt()
        }
        3 | 5 => {
            let sum = pairs(2).map(|term| wavelength.powf(term[1]) * term[0]);
            let sum = sum.fold(Sloped::from(c(1)), |sum, term| sum + term);
            if number == 3 { sum.sqrt() } else { sum }
        }
        4 => {
            let pole = |first: usize| {
                let [strength, power, base, exponent] = [0, 1, 2, 3].map(|i| c(first + i));
                if strength == 0.0 {
                    return nothing;
                }
                wavelength.powf(power) * strength / (square - base.powf(exponent))
            };
            let powers = pairs(10).map(|term| wavelength.powf(term[1]) * term[0]);
            powers.fold(pole(2) + pole(6) + c(1), |sum, term| sum + term).sqrt()
        }
        6 => {
            let inverse = Sloped::from(1.0) / square;
            let term = |term: &[f64]| Sloped::from(term[0]) / (Sloped::from(term[1]) - inverse);
            pairs(2).map(term).fold(Sloped::from(1.0 + c(1)), |sum, term| sum + term)
        }
        7 => {
            let pole = Sloped::from(1.0) / (square - 0.028);
            let start = pole * c(2) + pole * pole * c(3) + c(1);
            let powers = coefficients.iter().skip(3).zip(1..);
            powers.fold(start, |sum, (c, half)| sum + wavelength.powf(f64::from(2 * half)) * *c)
        }
        8 => {
            let ratio = square * c(2) / (square - c(3)) + square * c(4) + c(1);
            ((ratio * 2.0 + 1.0) / (Sloped::from(1.0) - ratio)).sqrt()
        }
        9 => {
            let off = wavelength - c(5);
            let last = if c(4) == 0.0 { nothing } else { off * c(4) / (off * off + c(6)) };
            (Sloped::from(c(2)) / (square - c(3)) + last + c(1)).sqrt()
        }
        _ => Sloped::from(f64::NAN),
    }
}

/// The index by Drude's and Lorentz's laws at an energy, eV.
fn resonances(
    infinity: f64,
    [plasma, width]: [f64; 2],
    lorentz: &[[f64; 3]],
    energy: f64,
) -> Refraction {
    // Permittivity, and d(Eε)/dE.
    let damped = Complex64::new(energy, width);
    let free = plasma * plasma / damped;
    let mut permittivity = infinity - free / energy;
    let mut derivative = infinity + free / damped;
    for [strength, at, width] in lorentz {
        let resonance = Complex64::new(at * at - energy * energy, -width * energy);
        permittivity += strength * at * at / resonance;
        derivative += strength * at * at * (at * at + energy * energy) / (resonance * resonance);
    }
    // Of the two roots that of the wave that decays.
    let root = permittivity.sqrt();
    let index = if root.im < 0.0 { -root } else { root };
    Refraction { index, group_index: 0.5 * (derivative / index + index) }
}
