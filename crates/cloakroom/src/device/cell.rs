//! Cells: regions of a device filled with one medium.

use super::{Beyond, Finish};
use glam::{DMat3, DVec3};
use optics::geometry::Plane;
use optics::medium::{Medium, ModeKind};
use optics::propagation::{
    Border, Boundary, ConformalFlow, FlowEnd, Foothold, Half, PathPoint, RadialFlow,
};

/// A region filled with one medium.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "a device has few cells, and they are met often")]
pub enum Cell {
    /// A convex prism of a homogeneous medium, in which rays are straight.
    Prism(Prism),
    /// One half of a cut conformal map, of graded index.
    Conformal(ConformalCell),
    /// A ball or a round cylinder of a radially symmetric medium, whole or hollow.
    Radial(RadialCell),
}

/// A radially symmetric medium about the origin or the z axis.
#[derive(Clone, Copy, Debug)]
pub struct RadialCell {
    /// How rays run in it.
    pub flow: RadialFlow,
    /// What lies beyond its inner border, if it has one.
    pub inner: Beyond,
}

/// One half of a cut conformal map above its mirror.
#[derive(Clone, Debug)]
pub struct ConformalCell {
    /// How rays run in it.
    pub flow: ConformalFlow,
    /// Which half it is.
    pub half: Half,
    /// What lies beyond its floor.
    pub floor: Beyond,
    /// What lies in its round core, if it has one.
    pub core: Beyond,
    /// How the medium meets the air.
    pub finish: Finish,
    /// Imaginary over real part of its permittivity.
    pub loss_tangent: f64,
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
    /// The point in the virtual space of a conformal cell.
    pub foothold: Option<Foothold>,
}

/// A ray in a cell, at a point of it or of its border.
#[derive(Clone, Copy, Debug)]
pub struct InnerRay {
    /// Where it is.
    pub position: DVec3,
    /// Its wave vector.
    pub wave_vector: DVec3,
    /// Its unit vector, that of the Poynting vector.
    pub direction: DVec3,
    /// Which of the medium's waves it is.
    pub mode: ModeKind,
    /// What [`Cell::enter`] or the last passage has said of the point.
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
    /// What has taken the electric field along, |Re(E × H*)| being kept; `None` in homogeneous
    /// media, where the field stays as it is.
    pub transport: Option<DMat3>,
    /// Optical path length, cm.
    pub optical_path: f64,
    /// ∫ Im n ds along a bent way through a medium that absorbs, cm.
    pub extinction: f64,
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
    /// What a ray finds that enters the cell at a point of its border; `None` if a conformal map has no such
    /// point: it has been lost in rounding at an edge.
    #[must_use]
    pub fn enter(&self, position: DVec3) -> Option<Entrance> {
        Some(Entrance {
            foothold: match self {
                Self::Prism(_) | Self::Radial(_) => None,
                Self::Conformal(cell) => Some(cell.flow.foothold(cell.half, position).ok()?),
            },
        })
    }

    /// The medium at a point of the cell or its border, `foothold` being what [`Cell::enter`] or the last
    /// passage has said of it; `None` if there is none by rounding. That of a graded cell is put into
    /// `local`: media are large, and those of homogeneous cells are not copied.
    #[must_use]
    pub fn medium<'m>(
        &'m self,
        position: DVec3,
        foothold: Option<&Foothold>,
        local: &'m mut Option<Medium>,
    ) -> Option<&'m Medium> {
        *local = match self {
            Self::Prism(prism) => return Some(&prism.medium),
            Self::Conformal(_) => foothold.map(|foothold| Medium::dielectric(foothold.index)),
            Self::Radial(cell) => cell.flow.medium(position),
        };
        local.as_ref()
    }

    /// Where the waves of the medium start as one and then part: their electric fields, of unit power.
    #[must_use]
    pub fn parted(&self, position: DVec3, wave_vector: DVec3) -> Option<[(ModeKind, DVec3); 2]> {
        match self {
            Self::Prism(_) | Self::Conformal(_) => None,
            Self::Radial(cell) => cell.flow.parted(position, wave_vector),
        }
    }

    /// Follows a ray from a point of the cell or its border to the next surface.
    ///
    /// `tolerance` (cm) bounds the error of position and optical path where the way is integrated.
    ///
    /// `None` if the ray cannot be followed: it is lost in rounding at an edge, or an integration
    /// failed.
    #[must_use]
    pub fn advance(&self, ray: &InnerRay, tolerance: f64) -> Option<Passage> {
        match self {
            Self::Prism(prism) => prism.advance(ray.position, ray.wave_vector, ray.direction),
            Self::Conformal(cell) => {
                let [passage, ..] = cell.advance_four(&[Some(*ray), None, None, None], tolerance);
                passage
            }
            Self::Radial(cell) => cell.advance(ray),
        }
    }

    /// As [`Cell::advance`], up to four rays at once: see [`Cell::takes_four`]. Each gets what it would get
    /// alone.
    #[must_use]
    pub fn advance_four(
        &self,
        rays: &[Option<InnerRay>; 4],
        tolerance: f64,
    ) -> [Option<Passage>; 4] {
        match self {
            Self::Prism(_) | Self::Radial(_) => {
                rays.map(|ray| ray.and_then(|ray| self.advance(&ray, tolerance)))
            }
            Self::Conformal(cell) => cell.advance_four(rays, tolerance),
        }
    }

    /// Whether four rays go through the cell at once hardly slower than one.
    #[must_use]
    pub fn takes_four(&self) -> bool {
        matches!(self, Self::Conformal(_))
    }
}

/// Straight pieces that a closed form's path is drawn with.
const PIECES: u32 = 96;

impl Cell {
    /// Points along the way that [`Cell::advance`] takes to `end`, with the optical path from its start: for
    /// drawings. Without those between where they cannot be had.
    #[must_use]
    pub fn path(&self, ray: &InnerRay, end: &Passage, tolerance: f64) -> Vec<PathPoint> {
        let ends = || {
            let start = PathPoint { position: ray.position, optical_path: 0.0 };
            vec![start, PathPoint { position: end.position, optical_path: end.optical_path }]
        };
        match self {
            Self::Prism(_) => ends(),
            Self::Conformal(cell) => {
                let foothold =
                    ray.foothold.or_else(|| cell.flow.foothold(cell.half, ray.position).ok());
                let path = foothold
                    .and_then(|start| cell.flow.path(&start, ray.wave_vector, tolerance).ok());
                path.unwrap_or_else(ends)
            }
            Self::Radial(cell) if cell.inner == Beyond::Air && cell.turns_back(ray) => ends(),
            Self::Radial(cell) => cell.flow.path(ray.position, ray.wave_vector, ray.mode, PIECES),
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
            extinction: 0.0,
            foothold: None,
            face: index,
            outward: face.plane.normal,
            beyond: face.beyond,
            finish: Finish::Bare,
        })
    }
}

impl ConformalCell {
    fn advance_four(&self, rays: &[Option<InnerRay>; 4], tolerance: f64) -> [Option<Passage>; 4] {
        let starts = rays.map(|ray| {
            let ray = ray?;
            let here = || self.flow.foothold(self.half, ray.position).ok();
            Some((ray.foothold.or_else(here)?, ray.wave_vector))
        });
        let ends = self.flow.advance_four(&starts, tolerance);
        std::array::from_fn(|i| {
            let end = ends[i].as_ref()?.as_ref().ok()?;
            Some(self.passage(&starts[i]?.0, end))
        })
    }

    fn passage(&self, start: &Foothold, end: &FlowEnd) -> Passage {
        let beyond = match end.boundary {
            Boundary::Floor => self.floor,
            Boundary::Core => self.core,
            // Below the floor's level, in the troughs of a grating, the ends are metal.
            Boundary::XMin | Boundary::XMax
                if self.half.mirrored(end.at.position).y < self.flow.map().level() =>
            {
                Beyond::Conductor
            }
            _ => Beyond::Air,
        };
        Passage {
            position: end.at.position,
            wave_vector: end.wave_vector,
            direction: end.wave_vector.normalize(),
            // |Re(E × H*)| = n |E|² is what stays.
            transport: Some(end.transport * (start.index / end.at.index).sqrt()),
            optical_path: end.optical_path,
            // Im n = n tan δ/2 to first order.
            extinction: 0.5 * self.loss_tangent * end.optical_path,
            foothold: Some(end.at),
            face: end.boundary as u16,
            outward: end.normal,
            beyond,
            finish: if beyond == Beyond::Conductor { Finish::Bare } else { self.finish },
        }
    }
}

/// How far from the core, relative to its radius, rounding may put a ray that comes out of it.
const AT_CORE: f64 = 1e-12;

impl RadialCell {
    fn advance(&self, ray: &InnerRay) -> Option<Passage> {
        if self.inner == Beyond::Air && self.turns_back(ray) {
            return Some(self.back_into_core(ray));
        }
        let end = self.flow.advance(ray.position, ray.wave_vector, ray.mode);
        let sound = end.position.is_finite() && end.wave_vector.is_finite();
        sound.then_some(Passage {
            position: end.position,
            wave_vector: end.wave_vector,
            direction: end.direction,
            transport: Some(end.transport),
            optical_path: end.optical_path,
            extinction: 0.0,
            foothold: None,
            face: end.border as u16,
            outward: end.outward,
            beyond: if end.border == Border::Inner { self.inner } else { Beyond::Air },
            finish: Finish::Bare,
        })
    }

    /// Whether a ray has come out of an open core into a wave that no ray of the core can be in but those in
    /// a plane through the axis, or aimed at the centre, to the last digits: the medium is singular there.
    fn turns_back(&self, ray: &InnerRay) -> bool {
        let [core, _] = self.flow.radii();
        let outward = self.flow.outward(ray.position);
        self.flow.closes_core(ray.mode)
            && ray.position.dot(outward) <= core * (1.0 + AT_CORE)
            && ray.direction.dot(outward) > 0.0
    }

    /// The way of such a ray, which gets the limit: all its neighbours are reflected.
    fn back_into_core(&self, ray: &InnerRay) -> Passage {
        let outward = self.flow.outward(ray.position);
        let turned = |v: DVec3| v - outward * (2.0 * v.dot(outward));
        Passage {
            position: ray.position,
            wave_vector: turned(ray.wave_vector),
            direction: turned(ray.direction),
            transport: Some(DMat3::from_cols(turned(DVec3::X), turned(DVec3::Y), turned(DVec3::Z))),
            optical_path: 0.0,
            extinction: 0.0,
            foothold: None,
            face: Border::Inner as u16,
            outward: -outward,
            beyond: self.inner,
            // It has met the border already.
            finish: Finish::Antireflection,
        }
    }
}
