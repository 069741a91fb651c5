//! Cells: regions of a device filled with one medium.

use super::{Beyond, Finish};
use glam::{DMat3, DVec3};
use optics::geometry::Plane;
use optics::medium::Medium;
use optics::propagation::{Boundary, ConformalFlow, Foothold, Half};

/// A region filled with one medium.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "a device has few cells, and they are met often")]
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
    /// Where the face ends, if the next one goes on in its plane: the coordinate (cm) along z × normal.
    /// Infinite for the last face in its plane.
    pub until: f64,
}

impl Face {
    /// A whole plane face.
    #[must_use]
    pub fn new(plane: Plane, beyond: Beyond) -> Self {
        Self { plane, beyond, until: f64::INFINITY }
    }
}

/// What a ray finds on entering a cell.
#[derive(Clone, Copy, Debug)]
pub struct Entrance {
    /// The medium there.
    pub medium: Medium,
    /// The point in the virtual space of a conformal cell.
    pub foothold: Option<Foothold>,
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
    /// The point in the virtual space of a conformal cell, to go on from after a reflection.
    pub foothold: Option<Foothold>,
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
    /// What a ray finds that enters the cell at a point of its border; `None` if a graded medium has none
    /// there: the point has been lost in rounding at an edge.
    #[must_use]
    pub fn enter(&self, position: DVec3) -> Option<Entrance> {
        match self {
            Self::Prism(prism) => Some(Entrance { medium: prism.medium, foothold: None }),
            Self::Conformal(cell) => {
                let foothold = cell.flow.foothold(cell.half, position).ok()?;
                let medium = Medium::dielectric(foothold.index);
                Some(Entrance { medium, foothold: Some(foothold) })
            }
        }
    }

    /// Follows a ray from a point of the cell or its border to the next surface. `foothold` is what
    /// [`Cell::enter`] or the last passage has said of that point.
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
        foothold: Option<Foothold>,
        tolerance: f64,
    ) -> Option<Passage> {
        match self {
            Self::Prism(prism) => prism.advance(position, wave_vector, direction),
            Self::Conformal(cell) => {
                let start = match foothold {
                    Some(foothold) => foothold,
                    None => cell.flow.foothold(cell.half, position).ok()?,
                };
                cell.advance(&start, wave_vector, tolerance)
            }
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
        let (mut index, mut face, distance) = nearest?;
        // On the plane to the last bit: what is off along the normal would show in the optical path.
        let end = face.plane.project(position + direction * distance);
        while face.until < DVec3::Z.cross(face.plane.normal).dot(end) {
            index += 1;
            face = self.faces.get(usize::from(index))?;
        }
        Some(Passage {
            position: end,
            wave_vector,
            direction,
            transport: None,
            optical_path: wave_vector.dot(end - position),
            medium: self.medium,
            foothold: None,
            face: index,
            outward: face.plane.normal,
            beyond: face.beyond,
            finish: Finish::Bare,
        })
    }
}

impl ConformalCell {
    fn advance(&self, start: &Foothold, wave_vector: DVec3, tolerance: f64) -> Option<Passage> {
        let end = self.flow.advance_from(start, wave_vector, tolerance).ok()?;
        let metal = end.boundary == Boundary::Floor;
        Some(Passage {
            position: end.at.position,
            wave_vector: end.wave_vector,
            direction: end.wave_vector.normalize(),
            // |Re(E × H*)| = n |E|² is what stays.
            transport: Some((end.transport, (start.index / end.at.index).sqrt())),
            optical_path: end.optical_path,
            medium: Medium::dielectric(end.at.index),
            foothold: Some(end.at),
            face: end.boundary as u16,
            outward: end.normal,
            beyond: if metal { Beyond::Conductor } else { Beyond::Air },
            finish: if metal { Finish::Bare } else { self.finish },
        })
    }
}
