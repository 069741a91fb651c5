//! A flat mirror floor under a device.

use super::{Coating, FarSide, Prisms, Region, RegionBorder, Shape, Structure, Surface};
use crate::key;
use crate::keys::KeyError;
use glam::DVec2;
use optics::geometry::{Extent, Outline, SAME_POINT, Wall};

/// A thin mirror on both sides, along x on a line of constant y, and centred on the z axis.
pub(super) struct Floor {
    /// Its whole width along x, cm; 0 for none.
    pub width: f64,
    /// Its y, cm.
    pub level: f64,
    /// How far it reaches along z.
    pub extent: Extent,
}

impl Floor {
    /// Whether there is one.
    pub fn is_there(&self) -> bool {
        self.width > 0.0
    }

    /// The floor with nothing on it.
    ///
    /// # Errors
    ///
    /// As [`Self::under`].
    pub fn alone(&self) -> Result<Structure, KeyError> {
        self.under(Structure::empty(), 0.0)
    }

    /// A device with the floor under it: no part of it reaches below, and where its sides lie on the
    /// floor, but for a rounding (cm) of their corners, the mirror is what is beyond them.
    ///
    /// # Errors
    ///
    /// If the device is wider than the floor.
    pub fn under(&self, mut structure: Structure, rounding: f64) -> Result<Structure, KeyError> {
        if !self.is_there() {
            return Ok(structure);
        }
        let (half, slack) = (0.5 * self.width, rounding.max(SAME_POINT));
        let on_it = |ends: [DVec2; 2]| ends.iter().all(|at| (at.y - self.level).abs() <= slack);
        // From where to where something stands on it.
        let mut covered: Vec<[f64; 2]> = Vec::new();
        for surface in &mut structure.surfaces {
            let Shape::Wall(wall) = &surface.shape else { continue };
            if wall.normal.y < 0.0 && on_it(wall.ends()) {
                let [a, b] = wall.ends().map(|at| at.x);
                covered.push([a.min(b), a.max(b)]);
                (surface.far, surface.coating) = (FarSide::Conductor, Coating::None);
            }
        }
        for region in &mut structure.regions {
            match region {
                Region::Homogeneous(region) => {
                    let RegionBorder::Faces(faces) = &mut region.border else { continue };
                    for face in faces {
                        if face.plane.normal.y < 0.0 && face.side.is_some_and(on_it) {
                            face.far = FarSide::Conductor;
                        }
                    }
                }
                Region::Conformal(region) => region.floor = FarSide::Conductor,
                Region::Spatial(region) => region.floor = FarSide::Conductor,
                Region::Radial(_) | Region::ClosedForm(_) => {}
            }
        }
        let widest = 2.0 * covered.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        let message = format!(
            "floor is {} cm; it must be at least {widest} cm wide, as what stands on it reaches, or 0 for \
             none",
            self.width
        );
        KeyError::refuse_if(widest > self.width + slack, key!(Prisms.floor), message)?;
        covered.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut free_from = -half;
        for [from, to] in covered.into_iter().chain([[half, half]]) {
            if from - free_from > slack {
                let ends = [free_from, from].map(|x| DVec2::new(x, self.level));
                structure.surfaces.push(Surface::mirror(Wall::new(ends[0], ends[1], self.extent)));
            }
            free_from = free_from.max(to);
        }
        let line = [-half, half].map(|x| DVec2::new(x, self.level));
        let line = Outline { corners: line.to_vec() };
        Ok(Structure { hull: structure.hull.with_thin_mirror(line, self.extent), ..structure })
    }
}
