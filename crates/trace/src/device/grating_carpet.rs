//! The grating carpet cloak: a periodically corrugated mirror floor that looks flat (Schmied,
//! Halimeh & Wegener, Opt. Express 18, 24361 (2010)).
//!
//! A conformal map, [`GratingMap`], so the index 1/|f'| is exact. The metal swings between y = -h
//! and h about the floor's level y = 0, and below that level the device ends at metal.

use super::{Device, Fact, Request, Structure, carpet};
use crate::key;
use crate::keys::{KeyError, ValueRange};
use optics::transformation::{ConformalMap, GratingMap, Truncation};

crate::table! {
    /// Makes a corrugated mirror look flat by a locally isotropic graded index, from a conformal
    /// map. Schmied, Halimeh & Wegener 2010.
    pub struct GratingCarpet {
        /// How far the metal swings above and below the floor's level; below period/(2 pi).
        h: f64 = 1.5, "cm", in ValueRange::LENGTH,
        /// Period of the grating along x; at most the width.
        period: f64 = 20.0, "cm", in ValueRange::LENGTH,
        /// Size of the device along x.
        width: f64 = 60.0, "cm", in ValueRange::LENGTH,
        /// Height of the device above the floor's level; above the bump.
        height: f64 = 28.57, "cm", in ValueRange::LENGTH,
        /// Whole width along x of the mirror floor that the device stands on; 0 for none.
        floor: f64 = 400.0, "cm", in ValueRange::LENGTH_OR_ZERO,
    }
}

/// More periods than anyone can see; each takes memory.
const MOST_PERIODS: f64 = 1000.0;

impl GratingCarpet {
    fn parts(&self) -> Result<(GratingMap, Truncation), KeyError> {
        let Self { h, period, width, .. } = *self;
        let map = GratingMap::new(period, h)
            .map_err(|error| KeyError::at(key!(Self.h), error.to_string()))?;
        let least = width / MOST_PERIODS;
        let message = format!(
            "period is {period} cm; it must be from {least} cm to {width} cm, for 1 to {MOST_PERIODS} of them \
             on the width"
        );
        let refused = period > width || period * MOST_PERIODS < width;
        KeyError::refuse_if(refused, key!(Self.period), message)?;
        Ok((map, carpet::cut([width, self.height], self.floor, h)?))
    }
}

impl Device for GratingCarpet {
    const KIND: &'static str = "grating-carpet";
    const TITLE: &'static str = "Periodic grating cloak";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        let (map, cut) = self.parts()?;
        Ok(carpet::structure(ConformalMap::Grating(map), cut, 1.0, self.floor, request))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let Ok((grating, cut)) = self.parts() else { return Vec::new() };
        let area = Fact::number("cloaked_area_per_period_cm2", grating.area_of_a_period());
        carpet::facts(&ConformalMap::Grating(grating), &cut, 1.0, &[area])
    }
}
