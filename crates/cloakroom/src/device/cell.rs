//! Cells: regions of a device filled with one medium.

use super::{Beyond, Finish};
use glam::{DMat3, DVec3};
use optics::geometry::Plane;
use optics::medium::Medium;
use optics::propagation::{Boundary, ConformalFlow, Half};

/// A region filled with one medium.
#[derive(Clone, Debug)]
pub enum Cell {
    /// A convex prism of a homogeneous medium, in which rays are straight.
    Prism(Prism),
    /// One half of a cut conformal map, of graded index.
    Conformal(ConformalCell),
}

/// One half of a cut conformal map above its mirror.
#[derive(Clone, Debug)]
pub struct ConformalCell {
    /// How rays run in it.
    pub flow: ConformalFlow,
    /// Which half it is.
    pub half: Half,
    /// How the medium meets the air at the cut.
    pub finish: Finish,
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
    /// The medium at the surface.
    pub medium: Medium,
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
    /// The medium at a point of the cell or its border; `None` if a graded medium has none there: the
    /// point has been lost in rounding at an edge.
    #[must_use]
    pub fn medium_at(&self, position: DVec3) -> Option<Medium> {
        match self {
            Self::Prism(prism) => Some(prism.medium),
            Self::Conformal(cell) => {
                Some(Medium::dielectric(cell.flow.foothold(cell.half, position).ok()?.index))
            }
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
        tolerance: f64,
    ) -> Option<Passage> {
        match self {
            Self::Prism(prism) => prism.advance(position, wave_vector, direction),
            Self::Conformal(cell) => cell.advance(position, wave_vector, tolerance),
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
            medium: self.medium,
            face: index,
            outward: face.plane.normal,
            beyond: face.beyond,
            finish: Finish::Bare,
        })
    }
}

impl ConformalCell {
    fn advance(&self, position: DVec3, wave_vector: DVec3, tolerance: f64) -> Option<Passage> {
        let start = self.flow.foothold(self.half, position).ok()?;
        let end = self.flow.advance_from(&start, wave_vector, tolerance).ok()?;
        let metal = end.boundary == Boundary::Floor;
        Some(Passage {
            position: end.at.position,
            wave_vector: end.wave_vector,
            direction: end.wave_vector.normalize(),
            // |Re(E × H*)| = n |E|² is what stays.
            transport: Some((end.transport, (start.index / end.at.index).sqrt())),
            optical_path: end.optical_path,
            medium: Medium::dielectric(end.at.index),
            face: end.boundary as u16,
            outward: end.normal,
            beyond: if metal { Beyond::Conductor } else { Beyond::Air },
            finish: if metal { Finish::Bare } else { self.finish },
        })
    }
}
