//! Transport of the polarization along a ray in virtual space.
//!
//! In an isotropic medium the field turns as de/ds = -(e·∇ln n) t (Rytov): it is carried parallel
//! in the optical metric n² dr², which in virtual space reads c² (dX² + dY²) + n² dz². In an
//! orthonormal frame along X, Y, z this is a turn of angular velocity p_z |f'| z × g, g = ∇ln n =
//! -conj(f''/f'). The ray turns likewise, so relative to a frame that is bound to the ray's
//! direction only one angle is left.

use glam::{DMat3, DVec3};

use super::points::Point;

/// A frame bound to a ray's direction in virtual space, and how that space is turned physically.
struct RayFrame {
    /// The smallest rotation that takes the z-axis (-z for p_z < 0) into the ray (it is regular
    /// both for rays along z and for rays across), and then one by arg f' about z, from virtual to
    /// physical components.
    rotation: DMat3,
    sign: f64,
}

impl RayFrame {
    fn new(p_z: f64, Point { momentum, jet, .. }: &Point) -> Self {
        let axial = p_z * jet.stretch();
        let length = (momentum.norm_sqr() + axial * axial).sqrt();
        let (tx, ty, sine) = (momentum.re / length, momentum.im / length, axial.abs() / length);
        let sign = 1.0_f64.copysign(p_z);
        let bend = 1.0 / (1.0 + sine);
        let rotation = DMat3::from_cols(
            DVec3::new(1.0 - tx * tx * bend, -tx * ty * bend, -sign * tx),
            DVec3::new(-tx * ty * bend, 1.0 - ty * ty * bend, -sign * ty),
            DVec3::new(sign * tx, sign * ty, sine),
        );
        let turn = jet.f1 / jet.stretch();
        Self { rotation: about_z(turn.re, turn.im) * rotation, sign }
    }
}

/// The rotation of the transverse field between two points of a ray's path.
pub(super) fn transport(p_z: f64, from: &Point, to: &Point) -> DMat3 {
    let [start, end] = [from, to].map(|point| RayFrame::new(p_z, point));
    // By how much it has turned about the ray against the frames.
    let (sin, cos) = (end.sign * (to.theta - from.theta)).sin_cos();
    end.rotation * about_z(cos, sin) * start.rotation.transpose()
}

fn about_z(cos: f64, sin: f64) -> DMat3 {
    DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z)
}
