//! From physical to virtual space.

use num_complex::Complex64;

use super::{ConformalMap, MapJet};

impl ConformalMap {
    /// The virtual point of a physical one above or on the floor; it may lie below Y = 0 by
    /// rounding, or by more for a point within the metal. None where there is no such point.
    #[must_use]
    pub fn invert(&self, z: Complex64) -> Option<Complex64> {
        self.invert_with_jet(z).map(|(zeta, _)| zeta)
    }

    /// See [`Self::invert`]; with what the map is there, but for f'', which is that nearby.
    pub(crate) fn invert_with_jet(&self, z: Complex64) -> Option<(Complex64, MapJet)> {
        let guess = match self {
            Self::Gaussian(map) => map.first_guess(z),
            Self::Grating(map) => map.first_guess(z),
            Self::QuasiConformal(map) => map.first_guess(z),
            Self::Flat(map) => {
                let zeta = z - Complex64::new(0.0, map.level);
                return Some((zeta, map.jet(zeta)));
            }
        };
        self.newton(z, guess).or_else(|| self.invert_from_above(z))
    }

    /// Newton's method for f(ζ) = z, each step bent by f'' (Halley's) and shortened until the
    /// residual falls.
    fn newton(&self, z: Complex64, mut zeta: Complex64) -> Option<(Complex64, MapJet)> {
        // Well below the floor f' has zeros, and the map branches; the series does so at once.
        let depth = if matches!(self, Self::QuasiConformal(_)) { 1e-6 } else { 0.25 };
        let lowest = -depth * self.scale();
        let mut jet = self.jet(zeta);
        for _ in 0..40 {
            let residual = z - jet.f;
            let step = residual / jet.f1;
            // What one more full step leaves: convergence is quadratic.
            let remainder = 0.5 * step.norm_sqr() * jet.f2.norm_sqr().sqrt() / jet.stretch();
            if remainder <= 1e-16 * zeta.norm_sqr().sqrt().max(self.scale()) {
                let root = zeta + step;
                let at_root = MapJet { f: z, f1: jet.f1 + jet.f2 * step, f2: jet.f2 };
                return (root.im > lowest).then_some((root, at_root));
            }
            let bend = 0.5 * jet.f2 * step / jet.f1;
            let step = if bend.norm_sqr() < 0.25 { step / (1.0 + bend) } else { step };
            let mut factor = 1.0;
            loop {
                let mut trial = zeta + factor * step;
                trial.im = trial.im.max(0.5 * lowest);
                let trial_jet = self.jet(trial);
                if (z - trial_jet.f).norm_sqr() < residual.norm_sqr() {
                    (zeta, jet) = (trial, trial_jet);
                    break;
                }
                factor *= 0.5;
                // Also ends the search where a coordinate is not a number.
                if factor < 1e-3 {
                    return None;
                }
            }
        }
        None
    }

    /// Newton's method along the vertical line down to z, which stays above the floor.
    #[cold]
    fn invert_from_above(&self, z: Complex64) -> Option<(Complex64, MapJet)> {
        const ROUNDS: u32 = 24;
        let reach = 8.0 * self.scale();
        let above = z + Complex64::new(0.0, reach);
        let mut found = self.newton(above, above)?;
        for k in (0..ROUNDS).rev() {
            let share = f64::from(k) / f64::from(ROUNDS);
            found = self.newton(z + Complex64::new(0.0, reach * share * share), found.0)?;
        }
        Some(found)
    }
}
