//! What of a device's interfaces is worked out once.

use crate::device::{Coating, Face, FarSide, Region, Shape, Structure, Surface};
use glam::DVec3;
use optics::interface::Reflectionless;
use optics::medium::Medium;

/// Those interfaces of a device that reflect nothing. They are flat, and homogeneous media meet
/// there.
#[derive(Clone, Debug)]
pub(crate) struct Interfaces {
    /// From air, by the number of the device's surface.
    surfaces: Vec<Option<Reflectionless>>,
    /// Out of each region, by the number of its face.
    faces: Vec<Vec<Option<Reflectionless>>>,
}

impl Interfaces {
    /// The interfaces of a device.
    pub fn of(structure: &Structure) -> Self {
        let medium = |far: FarSide| match far {
            FarSide::Outside => Some(&Medium::AIR),
            FarSide::Region(region) => match structure.regions.get(usize::from(region)) {
                Some(Region::Homogeneous(region)) => Some(&region.medium),
                _ => None,
            },
            FarSide::Seam(_)
            | FarSide::Conductor
            | FarSide::Metal(_)
            | FarSide::Opaque
            | FarSide::Polarizer => None,
        };
        let between = |from: &Medium, far: FarSide, normal: DVec3| {
            Reflectionless::between(from, medium(far)?, normal)
        };
        let entrance = |surface: &Surface| {
            if surface.coating != Coating::None || !matches!(surface.far, FarSide::Region(_)) {
                return None;
            }
            let normal = match &surface.shape {
                Shape::Wall(wall) => wall.normal,
                Shape::Cap(cap) => cap.normal,
                _ => return None,
            };
            between(&Medium::AIR, surface.far, -normal)
        };
        let faces = |region: &Region| match region {
            Region::Homogeneous(region) => {
                let exit = |face: &Face| {
                    let bare = face.coating == Coating::None;
                    bare.then(|| between(&region.medium, face.far, face.plane.normal))?
                };
                region.faces().iter().map(exit).collect()
            }
            Region::Conformal(_)
            | Region::Radial(_)
            | Region::ClosedForm(_)
            | Region::Spatial(_) => Vec::new(),
        };
        Self {
            surfaces: structure.surfaces.iter().map(entrance).collect(),
            faces: structure.regions.iter().map(faces).collect(),
        }
    }

    /// The way from air into the region behind a surface, if nothing is reflected there.
    pub fn entrance(&self, surface: u16) -> Option<&Reflectionless> {
        self.surfaces.get(usize::from(surface))?.as_ref()
    }

    /// The way out of a region through one of its faces, if nothing is reflected there.
    pub fn exit(&self, region: u16, face: u16) -> Option<&Reflectionless> {
        self.faces.get(usize::from(region))?.get(usize::from(face))?.as_ref()
    }
}
