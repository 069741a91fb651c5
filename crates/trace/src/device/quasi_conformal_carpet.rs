//! The quasi-conformal carpet cloak (Li & Pendry, Phys. Rev. Lett. 101, 203901 (2008); Ergin et
//! al., Science 328, 337 (2010)).
//!
//! The map is solved for here, [`QuasiConformalMap`]. It does not quite keep the shape of the box,
//! and that small anisotropy is neglected: an index of c/|f'| is left.

use super::{Device, Fact, Request, Structure, carpet};
use crate::key;
use crate::keys::{KeyError, ValueRange};
use optics::transformation::{ConformalMap, ConformalMapError, QuasiConformalMap, Truncation};

crate::table! {
    /// Hides a bump of a mirror floor, h cos^2(pi x/w), below a locally isotropic graded index,
    /// from the quasi-conformal map of a box. Li & Pendry 2008, Ergin et al. 2010.
    pub struct QuasiConformalCarpet {
        /// Height of the metal bump.
        h: f64 = 4.25, "cm", in ValueRange::LENGTH,
        /// Whole width of the bump; at most that of the device.
        w: f64 = 28.0, "cm", in ValueRange::LENGTH,
        /// Size of the device along x.
        width: f64 = 50.0, "cm", in ValueRange::LENGTH,
        /// Height of the device above the floor's level; above the bump.
        height: f64 = 28.57, "cm", in ValueRange::LENGTH,
        /// Whole width along x of the mirror floor that the device stands on; 0 for none.
        floor: f64 = 400.0, "cm", in ValueRange::LENGTH_OR_ZERO,
    }
}

impl QuasiConformalCarpet {
    fn parts(&self) -> Result<(QuasiConformalMap, Truncation), KeyError> {
        let cut = carpet::cut([self.width, self.height], self.floor, self.h)?;
        let map = QuasiConformalMap::new(self.w, self.h, &cut).map_err(|error| {
            let key = match error {
                ConformalMapError::TooWide { .. } | ConformalMapError::TooNarrow { .. } => {
                    key!(Self.w)
                }
                _ => key!(Self.h),
            };
            KeyError::at(key, error.to_string())
        })?;
        Ok((map, cut))
    }
}

impl Device for QuasiConformalCarpet {
    const KIND: &'static str = "quasi-conformal-carpet";
    const TITLE: &'static str = "Quasi-conformal carpet cloak";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        let (map, cut) = self.parts()?;
        let index_scale = map.index_scale();
        Ok(carpet::structure(
            ConformalMap::QuasiConformal(map),
            cut,
            index_scale,
            self.floor,
            request,
        ))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let Ok((quasi_conformal, cut)) = self.parts() else { return Vec::new() };
        let c = quasi_conformal.index_scale();
        let anisotropy = quasi_conformal.anisotropy();
        let map = ConformalMap::QuasiConformal(quasi_conformal);
        let own = [
            Fact::number("neglected_anisotropy", anisotropy),
            Fact::number("cloaked_area_cm2", map.area_within(&cut)),
        ];
        carpet::facts(&map, &cut, c, &own)
    }
}
