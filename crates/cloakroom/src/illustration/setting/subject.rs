//! The devices of a scene, ready to be drawn.

use crate::device::{Contour, CrossSection, REACH};
use crate::trace::Bench;
use glam::DVec2;
use optics::geometry::Pose;

/// A device at its place.
pub(super) struct Subject<'s> {
    pub section: CrossSection<'s>,
    pub pose: Pose,
}

impl<'s> Subject<'s> {
    /// The devices of a scene, in its order.
    pub fn all(bench: &'s Bench) -> Vec<Self> {
        (bench.devices().iter())
            .map(|placed| Self { section: placed.structure.cross_section(), pose: placed.pose })
            .collect()
    }

    /// The contours of all that is to be seen of it, in its own frame.
    pub fn contours(&self) -> impl Iterator<Item = &Contour> {
        let section = &self.section;
        let borders = section.regions.iter().flat_map(|region| &region.border);
        section.outlines.iter().chain(&section.metal).chain(borders)
    }

    /// Least and greatest x and y in the scene, cm, of all that has an end; none if there is nothing.
    pub fn bounds(&self) -> Option<[DVec2; 2]> {
        let points = self.contours().flat_map(|contour| &contour.points);
        let ends = points.filter(|p| p.abs().max_element() < REACH / 2.0);
        bounds(ends.map(|p| self.pose.point_to_world(*p)))
    }

    /// Where its axis is in the scene.
    pub fn origin(&self) -> DVec2 {
        self.pose.origin().truncate()
    }
}

/// Least and greatest x and y.
pub(super) fn bounds(points: impl IntoIterator<Item = DVec2>) -> Option<[DVec2; 2]> {
    points.into_iter().fold(None, |known, p| {
        let [low, high] = known.unwrap_or([p, p]);
        Some([low.min(p), high.max(p)])
    })
}
