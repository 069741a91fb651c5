//! Rays through radially symmetric media, in closed form.
//!
//! Straight lines in virtual space, exact transfers from border to border, or elementary integrals;
//! no path is stepped along, so that the singular points (the centre, the border of the hole) need
//! no care. A ray that is aimed exactly at the axis or centre gets the limit of its neighbours, or
//! that of the neighbours on one side where they part.

mod core_integrals;
mod lens;
mod transformed_shell;
mod transmuted_sphere;
mod uniaxial_cylinder;
pub(super) mod uniaxial_wave;

pub use lens::CentralLens;
pub use transformed_shell::TransformedShell;
pub use transmuted_sphere::TransmutedSphere;
pub use uniaxial_cylinder::{OpticAxis, UniaxialCylinder};

use super::{PathEnd, PathPoint, first_way_out, group_path_along, turn_in_plane};
pub use crate::geometry::Border;
use crate::medium::{Medium, ModeKind, PrincipalMedium};
use glam::DVec3;

/// A radially symmetric medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RadialFlow {
    /// A ball of graded index.
    Lens(CentralLens),
    /// A ball of graded uniaxial dielectric.
    Transmuted(TransmutedSphere),
    /// An impedance-matched shell.
    Transformed(TransformedShell),
    /// A cylindrical shell of graded uniaxial dielectric.
    Uniaxial(UniaxialCylinder),
}

impl RadialFlow {
    /// The radius of the hole, 0 without one, and the outer radius, cm.
    #[must_use]
    pub fn radii(&self) -> [f64; 2] {
        match self {
            Self::Lens(lens) => [0.0, lens.radius],
            Self::Transmuted(sphere) => [0.0, sphere.radius],
            Self::Transformed(shell) => [shell.map.inner, shell.map.outer],
            Self::Uniaxial(cylinder) => [cylinder.map.inner, cylinder.map.outer],
        }
    }

    /// The unit vector away from the axis or the centre.
    #[must_use]
    pub fn outward(&self, position: DVec3) -> DVec3 {
        match self {
            Self::Lens(_) | Self::Transmuted(_) => position.try_normalize().unwrap_or(DVec3::X),
            Self::Transformed(shell) => shell.map.radial(position),
            Self::Uniaxial(cylinder) => cylinder.map.radial(position),
        }
    }

    /// Whether a wave of the medium never comes to the hole: at its border the medium is singular.
    #[must_use]
    pub fn closes_core(&self, mode: ModeKind) -> bool {
        !matches!(self, Self::Uniaxial(cylinder) if cylinder.comes_to_core(mode))
    }

    /// The local medium at a point of the medium or its border.
    #[must_use]
    pub fn medium(&self, position: DVec3) -> Option<Medium> {
        match self {
            Self::Lens(lens) => Some(lens.medium(position)),
            Self::Transmuted(sphere) => sphere.medium(position),
            Self::Transformed(shell) => Some(shell.medium(position)),
            Self::Uniaxial(cylinder) => cylinder.medium(position),
        }
    }

    /// Follows a ray from a point of the medium or its border, where it has the given wave vector
    /// and is the given wave of the medium, to the next point of the border. On the border it must
    /// run into the medium or along it.
    pub fn advance(&self, position: DVec3, wave_vector: DVec3, mode: ModeKind) -> PathEnd<Border> {
        match self {
            Self::Lens(lens) => lens.advance(position, wave_vector),
            Self::Transmuted(sphere) => sphere.advance(position, wave_vector, mode),
            Self::Transformed(shell) => shell.advance(position, wave_vector),
            Self::Uniaxial(cylinder) => cylinder.advance(position, wave_vector, mode),
        }
    }

    /// Points along the way that [`Self::advance`] takes, from its start to its end, in that many
    /// pieces.
    #[must_use]
    pub fn path(
        &self,
        position: DVec3,
        wave_vector: DVec3,
        mode: ModeKind,
        pieces: u32,
    ) -> Vec<PathPoint> {
        let point = self.way(position, wave_vector, mode);
        (0..=pieces).map(|k| point(f64::from(k) / f64::from(pieces.max(1)))).collect()
    }

    /// Points of that way, by shares of it.
    fn way(
        &self,
        position: DVec3,
        wave_vector: DVec3,
        mode: ModeKind,
    ) -> impl Fn(f64) -> PathPoint {
        let end = self.advance(position, wave_vector, mode);
        let turning = match self {
            Self::Uniaxial(cylinder) => cylinder.turning_path(position, wave_vector, mode),
            _ => None,
        };
        // Straight in virtual space.
        let line = match self {
            Self::Transformed(TransformedShell { map, .. }) => Some(map),
            Self::Uniaxial(cylinder) if !cylinder.comes_to_core(mode) => Some(&cylinder.map),
            _ => None,
        };
        let line = line.map(|map| (map, [position, end.position].map(|at| map.to_virtual(at))));
        move |share: f64| match (self, &turning) {
            (_, Some(path)) => path.way_point(position, share),
            (Self::Lens(lens), _) => lens.way_point(position, wave_vector, share),
            (Self::Transmuted(sphere), _) if mode == ModeKind::Extraordinary => {
                sphere.way(position, wave_vector).point(share)
            }
            _ => PathPoint {
                position: match line {
                    Some((map, [start, stop])) => map.to_physical(start.lerp(stop, share)),
                    None => position.lerp(end.position, share),
                },
                optical_path: share * end.optical_path,
            },
        }
    }

    /// The speed of light times the time that a pulse takes on the way of [`Self::advance`], cm, to
    /// within about `tolerance` (cm), at the least dispersion that causality allows: see
    /// [`Medium::causal_group_index`].
    #[must_use]
    pub fn causal_group_path(
        &self,
        position: DVec3,
        wave_vector: DVec3,
        mode: ModeKind,
        tolerance: f64,
    ) -> f64 {
        let ratio = |at: DVec3, ray: DVec3| {
            let (medium, axes) = self.principal(at, mode);
            medium.group_over_phase(axes.map(|axis| axis.dot(ray).powi(2)))
        };
        let sides = |at: DVec3| self.principal(at, mode).0.sides();
        group_path_along(self.way(position, wave_vector, mode), ratio, sides, tolerance)
    }

    /// The medium at a point for a wave, and its principal axes.
    fn principal(&self, at: DVec3, mode: ModeKind) -> (PrincipalMedium, [DVec3; 3]) {
        let uniaxial = |ordinary: f64, extraordinary: f64, axis: DVec3| {
            let (a, b) = axis.any_orthonormal_pair();
            (PrincipalMedium::Uniaxial { ordinary, extraordinary, mode }, [a, b, axis])
        };
        match self {
            Self::Lens(lens) => {
                let square = lens.index_at(at).powi(2);
                uniaxial(square, square, DVec3::Z)
            }
            Self::Transmuted(sphere) => {
                let extraordinary = sphere.extraordinary_index(at.length()).powi(2);
                uniaxial(TransmutedSphere::ORDINARY_INDEX.powi(2), extraordinary, self.outward(at))
            }
            Self::Transformed(shell) => {
                let (values, axes) = shell.map.principal_values(shell.beside_hole(at));
                (PrincipalMedium::Matched(values), axes)
            }
            Self::Uniaxial(cylinder) => {
                let point = cylinder.point(at);
                uniaxial(point.ordinary, point.extraordinary, point.axis)
            }
        }
    }

    /// Where both waves of the medium start as one, along the optic axis, and then part: their
    /// electric fields, of unit power.
    #[must_use]
    pub fn parted(&self, position: DVec3, wave_vector: DVec3) -> Option<[(ModeKind, DVec3); 2]> {
        match self {
            Self::Uniaxial(cylinder) => Some(cylinder.parted(position, wave_vector)),
            // In the transmuted sphere they run to the far side together.
            Self::Lens(_) | Self::Transmuted(_) | Self::Transformed(_) => None,
        }
    }
}

/// The unit normal of the plane in which a ray runs about the centre, the ray turning towards the
/// centre about it. A ray through the centre runs in the plane across z, or any if it is along z.
fn plane_normal(position: DVec3, direction: DVec3) -> DVec3 {
    let across = |v: DVec3| (v - direction * v.dot(direction)).try_normalize();
    position
        .cross(direction)
        .try_normalize()
        // Once more across the ray: near the centre the cross product is rounding.
        .and_then(across)
        .or_else(|| across(DVec3::Z))
        .unwrap_or(DVec3::X)
}
