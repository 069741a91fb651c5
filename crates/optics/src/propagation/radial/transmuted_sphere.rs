//! The regularized invisible sphere.

use super::lens::{EatonWay, EatonWayOut};
use super::uniaxial_wave::{UniaxialPoint, transport};
use super::{Border, PathPoint, RadialEnd, plane_normal};
use crate::geometry::Sphere;
use crate::medium::{Medium, ModeKind};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// The invisible sphere with its singular centre transmuted (Tyc & Leonhardt, New J. Phys. 10, 115038
/// (2008)) into a uniaxial dielectric whose optic axis is the radius.
///
/// The ordinary index is π + 1 throughout; the extraordinary one is n_e = sin β/x at
/// x = r/radius = (2π - 2β + sin β)/(π + 1), from 1 at the surface (β = π/2) to (π + 1)/3 at the centre.
/// The radius is stretched such that the extraordinary ray sweeps the angles that a ray sweeps in
/// the invisible sphere, with the same optical path: it leaves on its chord, late by 2π radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransmutedSphere {
    /// Its radius, cm.
    pub radius: f64,
}

/// Closer to the centre than this share of the radius the local medium is that of here.
const NEAREST: f64 = 1e-6;

/// Closer to the surface than this share of the radius a ray starts on it.
const AT_SURFACE: f64 = 1e-9;

/// γ = π - β at x: x (π + 1) = 2γ + sin γ, which is concave in γ: Newton's method comes from below.
fn supplement(x: f64) -> f64 {
    let goal = TransmutedSphere::ORDINARY_INDEX * x;
    let mut gamma = goal / 3.0;
    for _ in 0..30 {
        let step = (goal - 2.0 * gamma - gamma.sin()) / (2.0 + gamma.cos());
        gamma += step;
        if step.abs() <= 1e-15 {
            break;
        }
    }
    gamma
}

/// The way of the extraordinary wave from a point within.
struct Within {
    way: EatonWayOut,
    /// The direction of its start from the centre.
    from: DVec3,
    normal: DVec3,
    /// L, the part of the wave vector around the centre times r/radius.
    tangential: f64,
}

impl Within {
    fn point(&self, sphere: &TransmutedSphere, share: f64) -> PathPoint {
        sphere.point_of(&self.way.at(share), self.from, self.normal)
    }
}

impl TransmutedSphere {
    /// The ordinary index.
    pub const ORDINARY_INDEX: f64 = PI + 1.0;

    /// The extraordinary index at the centre.
    pub const CENTRAL_EXTRAORDINARY_INDEX: f64 = (PI + 1.0) / 3.0;

    /// The sphere of a radius, cm.
    #[must_use]
    pub fn new(radius: f64) -> Self {
        debug_assert!(radius > 0.0);
        Self { radius }
    }

    /// The local medium.
    #[must_use]
    pub fn medium(&self, position: DVec3) -> Option<Medium> {
        let ordinary = Self::ORDINARY_INDEX * Self::ORDINARY_INDEX;
        let extraordinary = self.extraordinary_index(position.length()).powi(2);
        let axis = if position == DVec3::ZERO { DVec3::X } else { position };
        Medium::uniaxial_electric(1.0, ordinary, extraordinary, axis).ok()
    }

    /// The extraordinary index at a distance `r` (cm) from the centre, up to the radius.
    #[must_use]
    pub fn extraordinary_index(&self, r: f64) -> f64 {
        let x = r / self.radius;
        if (x - 1.0).abs() < AT_SURFACE {
            // On the surface to the last bit.
            return 1.0;
        }
        let x = x.clamp(NEAREST, 1.0);
        supplement(x).sin() / x
    }

    /// The point at a share of the way of the extraordinary wave: that in the invisible sphere, the radius
    /// stretched.
    pub(super) fn way_point(&self, position: DVec3, wave_vector: DVec3, share: f64) -> PathPoint {
        if let Some(within) = self.within(position, wave_vector) {
            return within.point(self, share);
        }
        let from = position.normalize();
        let normal = plane_normal(from, wave_vector.normalize());
        // In the invisible sphere light enters unbent.
        let tangential = wave_vector.dot(normal.cross(from)).clamp(-1.0, 1.0);
        let inward = (1.0 - tangential * tangential).sqrt();
        let direction = normal.cross(from) * tangential - from * inward;
        let way = EatonWay::new(from, direction, 2.0, share);
        self.point_of(&way, from, normal)
    }

    /// A point of a way that starts in the direction `from` of the centre.
    fn point_of(&self, way: &EatonWay, from: DVec3, normal: DVec3) -> PathPoint {
        let psi = way.c.min(1.0).asin();
        let x = (PI - 2.0 * psi + psi.cos()) / Self::ORDINARY_INDEX;
        PathPoint {
            position: from.rotate_axis(normal, way.swept) * (x * self.radius),
            optical_path: way.path * self.radius,
        }
    }

    /// The way out of the extraordinary wave, if it starts within.
    fn within(&self, position: DVec3, wave_vector: DVec3) -> Option<Within> {
        let x = position.length() / self.radius;
        if x > 1.0 - AT_SURFACE {
            return None;
        }
        let from = position.try_normalize().unwrap_or(wave_vector.normalize());
        let normal = plane_normal(from, wave_vector.normalize());
        let (sin, cos) = supplement(x.max(NEAREST)).sin_cos();
        let tangential = x * wave_vector.dot(normal.cross(from));
        // In the invisible sphere r n = sin γ, and of its part along the radius the wave vector has n_o/r times as much.
        let inward = -sin * wave_vector.dot(from) / Self::ORDINARY_INDEX;
        let way = EatonWayOut::new(2.0, cos, tangential, inward);
        Some(Within { way, from, normal, tangential })
    }

    /// Follows a ray of either wave that starts within to where it comes out.
    fn advance_from_within(
        &self,
        position: DVec3,
        wave_vector: DVec3,
        within: &Within,
        mode: ModeKind,
    ) -> RadialEnd {
        let outward_of = |position: DVec3| position.normalize();
        if mode != ModeKind::Extraordinary {
            let direction = wave_vector.normalize();
            let distance = Sphere { radius: self.radius }.time_to_leave(position, direction);
            let outward = outward_of(position + direction * distance);
            return RadialEnd {
                border: Border::Outer,
                position: outward * self.radius,
                wave_vector,
                direction,
                optical_path: Self::ORDINARY_INDEX * distance,
                transport: DMat3::IDENTITY,
                outward,
            };
        }
        let end = within.point(self, 1.0);
        let outward = outward_of(end.position);
        let onward = within.normal.cross(outward) * within.tangential;
        let index = Self::ORDINARY_INDEX;
        let after = outward * (index * within.way.cosine()) + onward;
        // Along εp, the extraordinary index at the surface being 1.
        let direction = outward * (index * within.way.cosine()) + onward * (index * index);
        let local = |position: DVec3| UniaxialPoint {
            ordinary: index * index,
            extraordinary: self.extraordinary_index(position.length()).powi(2),
            axis: position.try_normalize().unwrap_or(DVec3::X),
        };
        let [before_field, after_field] = [(position, wave_vector), (end.position, after)]
            .map(|(position, p)| local(position).field(p, mode));
        RadialEnd {
            border: Border::Outer,
            position: outward * self.radius,
            wave_vector: after,
            direction: direction.normalize(),
            optical_path: end.optical_path,
            transport: transport(before_field, after_field),
            outward,
        }
    }

    /// Follows a ray of either wave from a point of the sphere or its surface to where it comes out.
    pub fn advance(&self, position: DVec3, wave_vector: DVec3, mode: ModeKind) -> RadialEnd {
        if let Some(within) = self.within(position, wave_vector) {
            return self.advance_from_within(position, wave_vector, &within, mode);
        }
        let from = position.normalize();
        let normal = plane_normal(from, wave_vector.normalize());
        let around = normal.cross(from);
        let radial = wave_vector.dot(from).min(0.0).abs();
        let tangential = wave_vector.dot(around);
        let extraordinary = mode == ModeKind::Extraordinary;
        // Cosine and sine of the angle between the radius and the chord that sweeps the same angle.
        let index = Self::ORDINARY_INDEX;
        let (cosine, sine, path) = if extraordinary {
            let cosine = radial / index;
            (cosine, tangential, 2.0 * cosine + 2.0 * PI)
        } else {
            (radial / index, tangential / index, 2.0 * radial)
        };
        let to = from * (sine * sine - cosine * cosine) + around * (2.0 * sine * cosine);
        let outward = to.normalize();
        let onward = normal.cross(outward);
        let wave_vector = outward * radial + onward * tangential;
        // Along εp, the extraordinary index at the surface being 1.
        let ray = if extraordinary {
            outward * radial + onward * (index * index * tangential)
        } else {
            wave_vector
        };
        // The electric field across the plane stays; of the field in it, the radial part keeps its sign
        // and the other changes it with the radial part of the wave vector.
        let column = |i: usize| outward * from[i] - onward * around[i] + normal * normal[i];
        RadialEnd {
            border: Border::Outer,
            position: outward * self.radius,
            wave_vector,
            direction: ray.normalize(),
            optical_path: path * self.radius,
            transport: DMat3::from_cols(column(0), column(1), column(2)),
            outward,
        }
    }
}
