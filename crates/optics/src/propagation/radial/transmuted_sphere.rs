//! The regularized invisible sphere.

use super::lens::{AT_SURFACE, EatonWayOut};
use super::uniaxial_wave::{UniaxialPoint, transport};
use super::{Border, PathEnd, PathPoint, plane_normal};
use crate::geometry::Sphere;
use crate::medium::{Medium, ModeKind};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// The invisible sphere with its singular centre transmuted (Tyc & Leonhardt, New J. Phys. 10,
/// 115038 (2008)) into a uniaxial dielectric whose optic axis is the radius.
///
/// The ordinary index is π + 1 throughout; the extraordinary one is n_e = sin β/x at x = r/radius =
/// (2π - 2β + sin β)/(π + 1), from 1 at the surface (β = π/2) to (π + 1)/3 at the centre. The
/// radius is stretched such that the extraordinary ray sweeps the angles that a ray sweeps in the
/// invisible sphere, with the same optical path: it leaves on its chord, late by 2π radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransmutedSphere {
    /// Its radius, cm.
    pub radius: f64,
}

/// Closer to the centre than this share of the radius the local medium is that of here.
const NEAREST: f64 = 1e-6;

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

    /// The way out of the extraordinary wave: that in the invisible sphere, the radius stretched.
    pub(super) fn way(&self, position: DVec3, wave_vector: DVec3) -> ExtraordinaryWay {
        let x = position.length() / self.radius;
        let from = position.try_normalize().unwrap_or(wave_vector.normalize());
        let normal = plane_normal(from, wave_vector.normalize());
        let (x, (sine, cosine)) = if x > 1.0 - AT_SURFACE {
            // To the last bit.
            (1.0, (1.0, 0.0))
        } else {
            (x, supplement(x.max(NEAREST)).sin_cos())
        };
        let tangential = x * wave_vector.dot(normal.cross(from));
        // In the invisible sphere r n = sin γ; the radial part of the wave vector is n_o times as
        // much of itself.
        let inward = -sine * wave_vector.dot(from) / Self::ORDINARY_INDEX;
        let way = EatonWayOut::new(2.0, cosine, tangential, inward);
        ExtraordinaryWay { way, from, normal, tangential, radius: self.radius }
    }

    /// Follows a ray of either wave from a point of the ball or its surface to where it comes out.
    pub fn advance(&self, position: DVec3, wave_vector: DVec3, mode: ModeKind) -> PathEnd<Border> {
        let index = Self::ORDINARY_INDEX;
        if mode != ModeKind::Extraordinary {
            let direction = wave_vector.normalize();
            let distance = Sphere { radius: self.radius }.time_to_leave(position, direction);
            let outward = (position + direction * distance).normalize();
            return PathEnd {
                virtual_point: (),
                surface: Border::Outer,
                position: outward * self.radius,
                wave_vector,
                direction,
                optical_path: index * distance,
                group_path: None,
                transport: DMat3::IDENTITY,
                outward,
            };
        }
        let way = self.way(position, wave_vector);
        let end = way.point(1.0);
        let outward = end.position.normalize();
        let (along, onward) =
            (outward * (index * way.way.cosine()), way.normal.cross(outward) * way.tangential);
        let field = |axis: DVec3, extraordinary: f64, p: DVec3| {
            let local = UniaxialPoint { ordinary: index * index, extraordinary, axis };
            local.field_across(p, way.normal, mode)
        };
        let here = self.extraordinary_index(position.length()).powi(2);
        PathEnd {
            virtual_point: (),
            surface: Border::Outer,
            position: outward * self.radius,
            wave_vector: along + onward,
            // Along εp, the extraordinary index at the surface being 1.
            direction: (along + onward * (index * index)).normalize(),
            optical_path: end.optical_path,
            group_path: None,
            transport: transport(
                field(way.from, here, wave_vector),
                field(outward, 1.0, along + onward),
            ),
            outward,
        }
    }
}

/// The way of the extraordinary wave to the surface.
pub(super) struct ExtraordinaryWay {
    way: EatonWayOut,
    /// The direction of its start from the centre.
    from: DVec3,
    normal: DVec3,
    /// L, the part of the wave vector around the centre times r/radius.
    tangential: f64,
    radius: f64,
}

impl ExtraordinaryWay {
    /// The point at a share of it.
    pub fn point(&self, share: f64) -> PathPoint {
        let way = self.way.at(share);
        let psi = way.c.min(1.0).asin();
        let x = (PI - 2.0 * psi + psi.cos()) / TransmutedSphere::ORDINARY_INDEX;
        PathPoint {
            position: self.from.rotate_axis(self.normal, way.swept) * (x * self.radius),
            optical_path: way.path * self.radius,
        }
    }
}
