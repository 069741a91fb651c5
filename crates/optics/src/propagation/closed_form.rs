//! Graded media whose rays are known in closed form, between planes and spheres.
//!
//! A medium of this kind says where its rays run and where they come through a plane or a sphere;
//! it may be cut to any convex shape, and rays may start in it. Rays are plane curves here, as
//! wherever the gradient of the index stays in the plane of the ray: in it the electric field turns
//! with the ray.

pub use super::reference::SquaredIndex;
use super::{PathEnd, turn_in_plane};
use crate::geometry::{FlatOrRound, first_along};
use glam::DVec3;
use std::fmt::Debug;

/// An isotropic medium of graded index whose rays are plane curves, known in closed form.
pub trait ClosedForm: Debug + Send + Sync {
    /// The square of the index and its gradient at a point.
    fn squared_index(&self, at: DVec3) -> SquaredIndex;

    /// Where on its way, from its start on, a ray first comes out through a surface: the parameter
    /// of the way, which grows along it from 0; `None` if it never does. It starts inside of the
    /// surface, or on it: there, the way it runs decides, not rounding. See [`first_way_out`].
    fn way_out(&self, start: &CurvedRay, surface: &FlatOrRound) -> Option<f64>;

    /// Where a ray is at a parameter of its way, and the optical path to there, cm.
    fn way_point(&self, start: &CurvedRay, parameter: f64) -> (CurvedRay, f64);
}

/// A ray at a point of its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedRay {
    /// Where it is, cm.
    pub position: DVec3,
    /// Its wave vector, as long as the index.
    pub wave_vector: DVec3,
}

/// The first way out of a surface along a ray: the first t from 0 on, infinity and then the
/// negative numbers following the positive ones, at which c + b t + a t² grows through zero. As
/// numerator and denominator, the former never negative: t = ∞ is sound, and the angle 2
/// atan2(numerator, denominator) with t = tan(angle/2) is, too. `None` if it never does.
///
/// c, how far outside the start is, counts as 0 where rounding has made it positive.
#[must_use]
pub fn first_way_out([c, b, a]: [f64; 3]) -> Option<[f64; 2]> {
    let c = c.min(0.0);
    let discriminant = b * b - 4.0 * a * c;
    let constant = [b, a] == [0.0; 2];
    if constant || discriminant.is_nan() || discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    // Without cancellation.
    Some(if b > 0.0 { [-2.0 * c, b + root] } else { [root - b, 2.0 * a] })
}

/// Follows a ray from a point within some surfaces, or on them, to the first that it comes through,
/// and the parameter of its way there; `None` if it comes through none. The surface's number is
/// that in their order.
#[must_use]
pub fn follow(
    medium: &dyn ClosedForm,
    start: &CurvedRay,
    surfaces: impl Iterator<Item = FlatOrRound>,
) -> Option<(PathEnd<u16>, f64)> {
    let met = (0u16..).zip(surfaces).filter_map(|(number, surface)| {
        Some((medium.way_out(start, &surface)?, (number, surface)))
    });
    let (parameter, (number, surface)) = first_along(met)?;
    let (mut ray, optical_path) = medium.way_point(start, parameter);
    ray.position = surface.project(ray.position);
    let before = medium.squared_index(start.position);
    let after = medium.squared_index(ray.position);
    let [from, to] = [start, &ray].map(|ray| ray.wave_vector.normalize());
    let turn = turn_in_plane(normal(from, before.gradient), from, to);
    let sound = ray.position.is_finite() && ray.wave_vector.is_finite();
    let end = || PathEnd {
        surface: number,
        position: ray.position,
        virtual_point: (),
        wave_vector: ray.wave_vector,
        direction: to,
        optical_path,
        // |Re(E × H*)| = n |E|².
        group_path: None,
        transport: turn * (before.value / after.value).powf(0.25),
        outward: surface.outward(ray.position),
    };
    sound.then(|| (end(), parameter))
}

/// The unit normal of the plane in which a ray of that direction runs; any if it runs along the
/// gradient.
fn normal(direction: DVec3, gradient: DVec3) -> DVec3 {
    let across = |v: DVec3| (v - direction * v.dot(direction)).try_normalize();
    let normal = direction.cross(gradient).try_normalize().and_then(across);
    normal.unwrap_or_else(|| direction.any_orthonormal_vector())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_out_is_the_first_that_leads_out() {
        let coefficients = [-2.0, -1.0, -0.3, 0.0, 0.4, 1.0, 3.0];
        for c in [-2.0, -0.7] {
            for (b, a) in coefficients.into_iter().flat_map(|b| coefficients.map(|a| (b, a))) {
                // Once around, by the angle 2 atan t.
                let value = |half: f64| {
                    let (sin, cos) = half.sin_cos();
                    c * cos * cos + b * sin * cos + a * sin * sin
                };
                let found = first_way_out([c, b, a]).map(|[over, under]| over.atan2(under));
                let steps = (0..3141).map(|step| f64::from(step) * 1e-3);
                let first = steps.into_iter().find(|half| value(*half) > 0.0);
                match (found, first) {
                    (Some(found), Some(first)) => {
                        assert!(value(found).abs() < 1e-14 && first - found < 1.1e-3);
                    }
                    // It only touches, or comes out where it has gone in.
                    (Some(found), None) => assert!(value(found).abs() < 1e-14),
                    (None, first) => assert_eq!(first, None, "{c} {b} {a}"),
                }
            }
        }
    }

    #[test]
    fn on_a_surface_the_way_decides() {
        for c in [-1e-17, 0.0, 1e-17] {
            let time = |b: f64, a: f64| first_way_out([c, b, a]).map(|[over, under]| over / under);
            assert!(time(-1.0, 0.5).is_some_and(|t| (t - 2.0).abs() < 1e-15));
            assert!(time(1.0, 0.5).is_some_and(|t| t.abs() < 1e-15));
            assert!(time(1.0, -0.5).is_some_and(|t| t.abs() < 1e-15));
            // Away for ever, or until it comes back from beyond infinity.
            assert!(time(-1.0, -0.5).is_some_and(|t| (t + 2.0).abs() < 1e-15));
        }
    }
}
