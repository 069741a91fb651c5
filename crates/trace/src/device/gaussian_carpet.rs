//! The Gaussian carpet cloak: one half of the double-Gaussian cloak on a mirror floor (Schmied,
//! Halimeh & Wegener, Opt. Express 18, 24361 (2010)).
//!
//! A conformal map, [`GaussianMap`], so the index 1/|f'| is exact: the bump looks like flat floor.

use super::{Device, Fact, Request, Structure, carpet};
use crate::keys::{KeyError, ValueRange};
use optics::transformation::{ConformalMap, GaussianMap, Truncation};

crate::table! {
    /// Hides a bump of a mirror floor below a locally isotropic graded index, from a conformal map:
    /// one half of the double-Gaussian cloak. Schmied, Halimeh & Wegener 2010.
    pub struct GaussianCarpet {
        /// Width parameter of the map.
        w: f64 = 10.02, "cm", in ValueRange::LENGTH,
        /// Height of the metal bump; below 0.886 w.
        h: f64 = 4.25, "cm", in ValueRange::LENGTH,
        /// Size of the device along x.
        width: f64 = 50.0, "cm", in ValueRange::LENGTH,
        /// Height of the device above the floor's level; above the bump.
        height: f64 = 28.57, "cm", in ValueRange::LENGTH,
        /// Whole width along x of the mirror floor that the device stands on; 0 for none.
        floor: f64 = 400.0, "cm", in ValueRange::LENGTH_OR_ZERO,
    }
}

impl GaussianCarpet {
    fn parts(&self) -> Result<(GaussianMap, Truncation), KeyError> {
        let map = carpet::gaussian_map(self.w, self.h)?;
        Ok((map, carpet::cut([self.width, self.height], self.floor, map.height)?))
    }
}

impl Device for GaussianCarpet {
    const KIND: &'static str = "gaussian-carpet";
    const TITLE: &'static str = "Conformal carpet cloak";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        let (map, cut) = self.parts()?;
        Ok(carpet::structure(ConformalMap::Gaussian(map), cut, 1.0, self.floor, request))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let Ok((gaussian, cut)) = self.parts() else { return Vec::new() };
        let map = ConformalMap::Gaussian(gaussian);
        let areas = [
            Fact::number("cloaked_area_cm2", gaussian.area()),
            Fact::number("cloaked_area_within_cut_cm2", map.area_within(&cut)),
        ];
        carpet::facts(&map, &cut, 1.0, &areas)
    }
}
