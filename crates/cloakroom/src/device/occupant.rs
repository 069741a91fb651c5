//! What is where in a device: the same media that the tracer meets, point by point.

use super::{Cell, Filling, Structure};
use glam::DVec3;
use optics::medium::Medium;

/// What is at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "it is looked at and dropped")]
pub enum Occupant {
    /// Air outside of the device.
    Air,
    /// A medium, in the device's frame.
    Medium(Medium),
    /// Metal, a perfect conductor.
    Metal,
    /// Air in the hidden region of a device with an open core.
    HiddenAir,
    /// An opaque body.
    Opaque,
}

impl Structure {
    /// What is at a point of the device's frame. Sheets without thickness are not there; on a border the
    /// medium is, and of two media the first.
    #[must_use]
    pub fn occupant(&self, point: DVec3) -> Occupant {
        if !self.hull.spans(point) {
            return Occupant::Air;
        }
        if let Some(body) = self.hull.body() {
            return match &body.filling {
                Filling::Medium { medium, .. } => Occupant::Medium(*medium),
                Filling::Opaque(_) => Occupant::Opaque,
            };
        }
        let medium = self.cells.iter().find_map(|cell| cell.medium_if_within(point));
        medium.map_or_else(
            || if self.hull.has_open_core() { Occupant::HiddenAir } else { Occupant::Metal },
            Occupant::Medium,
        )
    }
}

impl Cell {
    /// The medium at a point between the ends of the device, if the point lies in the cell or on its border.
    fn medium_if_within(&self, point: DVec3) -> Option<Medium> {
        let within = match self {
            Self::Prism(prism) => prism.faces.iter().all(|face| {
                let slack = 1e-12 * (1.0 + face.plane.offset.abs());
                face.plane.normal.dot(point) - face.plane.offset <= slack
            }),
            // There is no foothold elsewhere.
            Self::Conformal(_) => true,
            Self::Radial(cell) => {
                let outward = cell.flow.outward(point);
                point.dot(outward) >= cell.flow.radii()[0]
            }
        };
        let entrance = within.then(|| self.enter(point))??;
        self.medium(point, entrance.foothold.as_ref(), &mut None).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{Request, built};

    fn structure(kind: &str, open_core: bool) -> Structure {
        let request = Request { open_core, length: Some(20.0), ..Request::default() };
        built(kind, &[], request)
    }

    #[test]
    fn air_media_metal_and_the_hidden_region_are_told_apart() {
        // Of each cloak a point in its medium and one in its hidden region.
        for (kind, in_medium, hidden) in [
            ("square-cloak", DVec3::new(0.0, 8.0, 3.0), DVec3::new(1.0, -1.0, 3.0)),
            ("double-gaussian-cloak", DVec3::new(3.0, -9.0, 3.0), DVec3::new(1.0, -1.0, 3.0)),
            ("cylinder-cloak", DVec3::new(0.0, -7.0, 3.0), DVec3::new(0.0, 3.9, -3.0)),
        ] {
            for open_core in [false, true] {
                let device = structure(kind, open_core);
                let inside = if open_core { Occupant::HiddenAir } else { Occupant::Metal };
                assert!(matches!(device.occupant(in_medium), Occupant::Medium(_)), "{kind}");
                assert_eq!(device.occupant(hidden), inside, "{kind}");
                for outside in [DVec3::new(60.0, 0.0, 0.0), hidden.with_z(10.5)] {
                    assert_eq!(device.occupant(outside), Occupant::Air, "{kind}");
                }
            }
        }
    }

    #[test]
    fn below_a_carpet_there_is_metal() {
        let device = structure("gaussian-carpet", false);
        assert_eq!(device.occupant(DVec3::new(0.0, 4.2, 0.0)), Occupant::Metal);
        assert!(matches!(device.occupant(DVec3::new(0.0, 4.3, 0.0)), Occupant::Medium(_)));
        assert_eq!(device.occupant(DVec3::new(0.0, -0.1, 0.0)), Occupant::Air);
    }
}
