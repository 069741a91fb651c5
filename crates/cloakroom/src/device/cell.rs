//! Cells: regions of a device filled with one medium.

use super::{Beyond, Finish};
use glam::{DMat3, DVec3};
use optics::geometry::Plane;
use optics::medium::Medium;

/// A region filled with one medium.
#[derive(Clone, Debug)]
pub enum Cell {
    /// A convex prism of a homogeneous medium, in which rays are straight.
    Prism(Prism),
}

/// A convex region between planes, filled with a homogeneous medium.
#[derive(Clone, Debug)]
pub struct Prism {
    /// What fills it.
    pub medium: Medium,
    /// The planes that bound it.
    pub faces: Vec<Face>,
}

/// One bounding plane of a prism.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// The plane, its normal pointing out of the cell.
    pub plane: Plane,
    /// What lies beyond it.
    pub beyond: Beyond,
}

/// A ray's way through a cell to the surface where it ends.
#[derive(Clone, Copy, Debug)]
pub struct Passage {
    /// The point on the surface.
    pub position: DVec3,
    /// The wave vector there.
    pub wave_vector: DVec3,
    /// The unit vector of the ray there.
    pub direction: DVec3,
    /// The rotation that has taken the electric field along, and the factor of its length that
    /// keeps the power; `None` in homogeneous media, where the field stays as it is.
    pub transport: Option<(DMat3, f64)>,
    /// Optical path length, cm.
    pub optical_path: f64,
    /// Which surface.
    pub face: u16,
    /// The unit normal of the surface, out of the cell.
    pub outward: DVec3,
    /// What lies beyond.
    pub beyond: Beyond,
    /// How the media meet there.
    pub finish: Finish,
}

impl Cell {
    /// The medium at a point of the cell or its border.
    #[must_use]
    pub fn medium_at(&self, _position: DVec3) -> Medium {
        match self {
            Self::Prism(prism) => prism.medium,
        }
    }

    /// Follows a ray from a point of the cell or its border to the next surface.
    ///
    /// `tolerance` (cm) bounds the error of position and optical path where the medium is graded.
    ///
    /// `None` if the ray cannot be followed: it is lost in rounding at an edge, or an integration
    /// failed.
    #[must_use]
    pub fn advance(
        &self,
        position: DVec3,
        wave_vector: DVec3,
        direction: DVec3,
        _tolerance: f64,
    ) -> Option<Passage> {
        match self {
            Self::Prism(prism) => prism.advance(position, wave_vector, direction),
        }
    }
}

impl Prism {
    fn advance(&self, position: DVec3, wave_vector: DVec3, direction: DVec3) -> Option<Passage> {
        let mut nearest: Option<(u16, &Face, f64)> = None;
        for (index, face) in (0u16..).zip(&self.faces) {
            if let Some(distance) = face.plane.distance(position, direction)
                && nearest.is_none_or(|(_, _, least)| distance < least)
            {
                nearest = Some((index, face, distance));
            }
        }
        let (index, face, distance) = nearest?;
        // On the plane to the last bit: what is off along the normal would show in the optical path.
        let end = face.plane.project(position + direction * distance);
        Some(Passage {
            position: end,
            wave_vector,
            direction,
            transport: None,
            optical_path: wave_vector.dot(end - position),
            face: index,
            outward: face.plane.normal,
            beyond: face.beyond,
            finish: Finish::Bare,
        })
    }
}
