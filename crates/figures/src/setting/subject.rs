//! The devices of a scene, ready to be drawn.

use super::TEXT;
use super::view::View;
use cloakroom::assembly::Assembly;
use cloakroom::device::{Contour, CrossSection, REACH, Section};
use glam::DVec2;
use optics::geometry::Pose;

/// A device as it is drawn, and the place of that.
pub(super) struct Subject<'s> {
    pub section: CrossSection<'s>,
    pub pose: Pose,
}

impl<'s> Subject<'s> {
    /// The devices of a scene, in its order.
    pub fn all(assembly: &'s Assembly) -> Vec<Self> {
        (assembly.devices().iter())
            .map(|placed| {
                let (section, pose) = placed.structure.drawn_at(&placed.pose);
                Self { section, pose }
            })
            .collect()
    }

    /// Where on the sheet a point of its frame is.
    pub fn place(&self, view: &View, point: DVec2) -> DVec2 {
        view.place(self.pose.point_to_world(point))
    }

    /// Where on the sheet points of its frame are.
    pub fn on_sheet(&self, view: &View, points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|point| self.place(view, *point)).collect()
    }

    /// Where on the sheet contours in its frame are.
    pub fn places(&self, view: &View, contours: &[Contour]) -> Vec<Vec<DVec2>> {
        contours.iter().map(|contour| self.on_sheet(view, &contour.points)).collect()
    }

    /// The contours of all that is to be seen of it, in its own frame.
    pub fn contours(&self) -> impl Iterator<Item = &Contour> {
        let section = &self.section;
        let borders = section.regions.iter().flat_map(|region| &region.border);
        section.outlines.iter().chain(&section.metal).chain(borders)
    }

    /// Least and greatest x and y in the scene, cm, of all that has an end; none if there is
    /// nothing.
    pub fn bounds(&self) -> Option<[DVec2; 2]> {
        let points = self.contours().flat_map(|contour| &contour.points);
        let ends = points.filter(|p| p.abs().max_element() < REACH / 2.0);
        bounds(ends.map(|p| self.pose.point_to_world(*p)))
    }

    /// The indices of the devices from back to front: of two bodies the one of the larger priority
    /// lies before the other, as it is the one that is there, else what has the larger z.
    pub fn from_back(subjects: &[Self]) -> Vec<usize> {
        let priority = |i: usize| subjects[i].section.body.map_or(0, |body| body.priority);
        let z = |i: usize| subjects[i].pose.origin.z;
        let mut order: Vec<usize> = (0..subjects.len()).collect();
        order.sort_by(|&i, &j| priority(i).cmp(&priority(j)).then(z(i).total_cmp(&z(j))));
        order
    }

    /// Whether it is an opaque body, of which there is nothing to see but its outline.
    pub fn is_opaque(&self) -> bool {
        self.section.body.is_some() && self.section.body_medium.is_none()
    }

    /// Whether it lies within another device as they are drawn, as a body, of two of one size the one that
    /// `stands_behind`, or hidden by an opaque one, or one of metal, that it stands behind.
    pub fn is_within(&self, other: &Self, stands_behind: bool) -> bool {
        let (Some(own), Some(others)) = (self.bounds(), other.bounds()) else { return false };
        let alike = own == others;
        let is_inner = self.section.body.is_some() && (stands_behind || !alike);
        let is_hidden = stands_behind && (other.is_opaque() || !other.section.metal.is_empty());
        (is_inner || is_hidden) && holds(others, own)
    }

    /// Whether its bounds are within those of another one.
    pub fn is_inside(&self, other: &Self) -> bool {
        other.bounds().zip(self.bounds()).is_some_and(|(others, own)| holds(others, own))
    }

    /// Whether another device leaves no room on the sheet for its dimensions: it is beside it or reaches into it,
    /// and is not within it or around it.
    pub fn is_crowded_by(&self, other: &Self, view: &View) -> bool {
        let (Some(own), Some(others)) = (self.bounds(), other.bounds()) else { return false };
        let on_sheet = |ends: [DVec2; 2]| bounds(ends.map(|end| view.place(end)));
        let (Some([low, high]), Some([from, to])) = (on_sheet(own), on_sheet(others)) else {
            return false;
        };
        let room = DVec2::splat(1.5 * TEXT);
        let is_near = (low - room).cmplt(to).all() && from.cmplt(high + room).all();
        is_near && !holds(own, others) && !holds(others, own)
    }

    /// Whether a point of the scene's xy-plane lies within its outline.
    pub fn surrounds(&self, point: DVec2) -> bool {
        let local = self.pose.to_local(point.extend(0.0)).truncate();
        self.section.outlines.iter().any(|outline| outline.surrounds(local))
    }

    /// Where its axis is in the scene.
    pub fn origin(&self) -> DVec2 {
        self.pose.origin.truncate()
    }
}

/// The middles of the cells of a box, `steps` either way.
pub(super) fn lattice([low, high]: [DVec2; 2], steps: u32) -> impl Iterator<Item = DVec2> {
    (0..steps * steps).map(move |k| {
        let share = DVec2::new(f64::from(k % steps), f64::from(k / steps)) + 0.5;
        low + (high - low) * share / f64::from(steps)
    })
}

/// The points of the border of a region.
pub(super) fn border(region: &Section<'_>) -> impl Iterator<Item = DVec2> + Clone {
    region.border.iter().flat_map(|contour| contour.points.iter().copied())
}

/// The sides of a contour that is closed: from each point to the next.
pub(super) fn sides(points: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    points.iter().enumerate().map(|(i, point)| (*point, points[(i + 1) % points.len()]))
}

/// Twice the area within a closed contour, positive where it runs from x to y.
pub(super) fn turn(points: &[DVec2]) -> f64 {
    sides(points).map(|(a, b)| a.perp_dot(b)).sum()
}

/// Whether a box, by its least and greatest corner, holds another one.
pub(super) fn holds([low, high]: [DVec2; 2], [from, to]: [DVec2; 2]) -> bool {
    low.cmple(from).all() && to.cmple(high).all()
}

/// Least and greatest x and y.
pub(super) fn bounds(points: impl IntoIterator<Item = DVec2>) -> Option<[DVec2; 2]> {
    points.into_iter().fold(None, |known, p| {
        let [low, high] = known.unwrap_or([p, p]);
        Some([low.min(p), high.max(p)])
    })
}
