//! What is where in a device: the same media that the tracer meets, point by point.

use super::{Region, Structure};
use glam::DVec3;
use optics::medium::Medium;
use optics::propagation::VirtualPoint;

/// What is at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "it is looked at and dropped")]
pub enum MaterialAt {
    /// Air outside of the device.
    Air,
    /// A medium, in the device's frame.
    Medium(Medium),
    /// Metal.
    Metal,
    /// Air in the hidden region of a device with an open core.
    HiddenAir,
    /// An opaque body.
    Opaque,
}

impl Structure {
    /// What is at a point of the device's frame. Sheets without thickness are not there; on a
    /// border the medium is, and of two media the first.
    #[must_use]
    pub fn material_at(&self, point: DVec3) -> MaterialAt {
        if !self.hull.spans(point) {
            return MaterialAt::Air;
        }
        match self.region_at(point) {
            Some((_, medium)) => MaterialAt::Medium(medium),
            None if self.is_opaque() => MaterialAt::Opaque,
            None if self.hull.filled.is_some() => MaterialAt::HiddenAir,
            None => MaterialAt::Metal,
        }
    }

    /// The region that a point within the device's ends lies in or on the border of, the first of
    /// several: its number, and the medium.
    #[must_use]
    pub fn region_at(&self, point: DVec3) -> Option<(u16, Medium)> {
        let mut numbered = (0u16..).zip(&self.regions);
        numbered.find_map(|(number, region)| Some((number, region.enter_if_within(point)?.1)))
    }
}

impl Region {
    /// As [`Region::enter`] at a point between the ends of the device, if it lies in the region or
    /// on its border.
    pub(crate) fn enter_if_within(&self, point: DVec3) -> Option<(Option<VirtualPoint>, Medium)> {
        let within = match self {
            Self::Homogeneous(_) => self.is_within_faces(point, 1e-12),
            // There is no virtual_point elsewhere.
            Self::Conformal(_) => true,
            Self::Radial(region) => {
                let outward = region.flow.outward(point);
                point.dot(outward) >= region.flow.radii()[0]
            }
            Self::ClosedForm(region) => region.holds(point),
            Self::Spatial(region) => region.holds(point),
        };
        let mut graded = None;
        let (virtual_point, medium) = within.then(|| self.enter(point, &mut graded))??;
        Some((virtual_point, *medium))
    }

    /// Whether a point is within the plane faces of a homogeneous medium, or beyond them by no more
    /// than `slack`, relative to their distance and absolute, cm.
    pub(crate) fn is_within_faces(&self, point: DVec3, slack: f64) -> bool {
        let Self::Homogeneous(region) = self else { return true };
        region.faces().iter().all(|face| {
            let slack = slack * (1.0 + face.plane.offset.abs());
            face.plane.normal.dot(point) - face.plane.offset <= slack
        })
    }
}

#[cfg(test)]
mod tests;
