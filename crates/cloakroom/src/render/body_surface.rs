//! What opaque bodies show: a color, or an image laid on their shape.
//!
//! An image stands whole and upright, as seen from outside, on each face of a box and each end of a
//! cylinder. Up is y there; on the upper and the lower face of a box it is as if they were folded
//! up and down from the face that looks along -x, towards the usual camera. Around a ball and the
//! side of a cylinder the image goes once: its middle column is on the side of -x, and its top row
//! at the pole +y of a ball, at the end +z of a cylinder.
//!
//! A surface that is lit scatters what comes from the surroundings evenly to all sides, a share of it
//! that the color or the image says; other bodies and devices neither light nor shade it.

use super::Images;
use super::prepared_scene::LightAround;
use crate::assembly::Placed;
use crate::device::Convex;
use crate::photograph::{Equirectangular, LoadError, Pyramid};
use crate::scene::{Appearance, DeviceSettings};
use glam::DVec3;
use optics::geometry::{Border, Cylinder, Pose};
use std::f64::consts::TAU;
use std::sync::Arc;

/// What an opaque body shows.
#[derive(Clone, Debug)]
pub(super) struct BodySurface {
    pose: Pose,
    texture: Texture,
    /// Its shape and what lights it; none where it shines by itself.
    lit: Option<(Convex, LightAround)>,
}

#[derive(Clone, Debug)]
enum Texture {
    /// The same everywhere.
    Color([f64; 3]),
    /// On the faces of a box of half that size.
    Box(DVec3, Arc<Pyramid>),
    /// On the side and the ends of a cylinder.
    Cylinder(Cylinder, Arc<Pyramid>),
    /// Around a ball.
    Ball(Arc<Equirectangular>),
}

/// Where a point is on the image, and by how much (u, v) changes per cm along the surface; all in
/// the body's frame.
#[derive(Clone, Copy, Debug)]
struct Spot {
    normal: DVec3,
    position: [f64; 2],
    across: DVec3,
    down: DVec3,
}

impl BodySurface {
    /// The surface of a device, if it is an opaque body; its image is taken from those that are
    /// known, or read.
    ///
    /// # Errors
    ///
    /// If its image cannot be read.
    pub fn of(
        device: &DeviceSettings,
        placed: &Placed,
        images: &mut Images,
        light: Option<&LightAround>,
    ) -> Result<Option<Self>, LoadError> {
        let (Some(body), Some(appearance)) = (placed.structure.hull.body, device.appearance())
        else {
            return Ok(None);
        };
        let texture = match (&appearance, body.shape) {
            (Appearance::Color(color), _) => Texture::Color(*color),
            (Appearance::Image(image), Convex::Ball(_) | Convex::CutBall(_)) => {
                Texture::Ball(images.ball(image)?)
            }
            (Appearance::Image(image), Convex::Cylinder(cylinder)) => {
                Texture::Cylinder(cylinder, images.side(image)?)
            }
            (Appearance::Image(image), Convex::Box { half }) => {
                Texture::Box(half, images.face(image)?)
            }
        };
        let light = light.filter(|_| device.is_lit());
        let lit = light.map(|light| (body.shape, light.clone()));
        Ok(Some(Self { pose: placed.pose, texture, lit }))
    }

    /// The outward unit normal at a point of the surface, where that matters for what it shows.
    pub fn normal(&self, point: DVec3) -> Option<DVec3> {
        let local = self.pose.to_local(point);
        let normal = match &self.texture {
            Texture::Color(_) => return None,
            Texture::Ball(_) => local.normalize_or_zero(),
            Texture::Box(half, _) => on_box(local, *half).normal,
            Texture::Cylinder(cylinder, _) => on_cylinder(local, cylinder).normal,
        };
        Some(self.pose.vector_to_world(normal))
    }

    /// Linear light from a point of the surface. `steps` says, for the normal of the tangent plane
    /// there, how far away (cm) rays one sample further along the axes of the camera's picture come
    /// to that plane.
    pub fn light(&self, point: DVec3, steps: impl Fn(DVec3) -> [DVec3; 2]) -> [f64; 3] {
        let local = self.pose.to_local(point);
        let own = self.own(local, steps);
        let Some((shape, light)) = &self.lit else { return own };
        let around = light.at(self.pose.vector_to_world(outward(local, *shape)));
        std::array::from_fn(|color| own[color] * around[color])
    }

    /// The color or the image at a point in the body's frame.
    fn own(&self, local: DVec3, steps: impl Fn(DVec3) -> [DVec3; 2]) -> [f64; 3] {
        let Self { pose, texture, .. } = self;
        let steps_from = |normal: DVec3| {
            steps(pose.vector_to_world(normal)).map(|step| pose.vector_to_local(step))
        };
        let (image, spot) = match texture {
            Texture::Color(color) => return *color,
            Texture::Ball(image) => {
                let radius = local.length();
                // Seen from outside, right and left are exchanged.
                let mirrored = |v: DVec3| DVec3::new(-v.x, v.y, v.z) / radius;
                let [dx, dy] = steps_from(local / radius).map(mirrored);
                return image.sample(mirrored(local), dx, dy).map(f64::from);
            }
            Texture::Box(half, image) => (image, on_box(local, *half)),
            Texture::Cylinder(cylinder, image) => (image, on_cylinder(local, cylinder)),
        };
        let change = |step: DVec3| {
            // More than the whole image is no wider than that.
            [spot.across.dot(step), spot.down.dot(step)].map(|part| part.clamp(-1.0, 1.0))
        };
        let [dx, dy] = steps_from(spot.normal).map(change);
        image.sample(spot.position, dx, dy).map(f64::from)
    }
}

/// The outward unit normal of a shape.
fn outward(point: DVec3, shape: Convex) -> DVec3 {
    match shape {
        Convex::Ball(_) | Convex::CutBall(_) => point.normalize_or_zero(),
        Convex::Cylinder(cylinder) => on_cylinder(point, &cylinder).normal,
        Convex::Box { half } => on_box(point, half).normal,
    }
}

fn on_box(point: DVec3, half: DVec3) -> Spot {
    let off = (point / half).abs();
    let axis = (0..3).fold(0, |best, axis| if off[axis] > off[best] { axis } else { best });
    let normal = DVec3::AXES[axis] * point[axis].signum();
    let up = if axis == 1 { DVec3::X * normal.y } else { DVec3::Y };
    on_face(point, normal, up, half)
}

fn on_cylinder(point: DVec3, cylinder: &Cylinder) -> Spot {
    let (radius, end) = (cylinder.radius, cylinder.extent.max);
    if point.z.abs() * radius > point.truncate().length() * end {
        let normal = DVec3::Z * point.z.signum();
        return on_face(point, normal, DVec3::Y, DVec3::new(radius, radius, end));
    }
    let normal = cylinder.outward(Border::Outer, point);
    Spot {
        normal,
        position: [0.5 + (-normal.y).atan2(-normal.x) / TAU, 0.5 - point.z / (2.0 * end)],
        across: DVec3::Z.cross(normal) / (TAU * radius),
        down: DVec3::NEG_Z / (2.0 * end),
    }
}

/// The whole image on a face of a box about the origin.
fn on_face(point: DVec3, normal: DVec3, up: DVec3, half: DVec3) -> Spot {
    let right = up.cross(normal);
    let size = |axis: DVec3| 2.0 * axis.abs().dot(half);
    let (across, down) = (right / size(right), -up / size(up));
    Spot { normal, position: [0.5 + across.dot(point), 0.5 + down.dot(point)], across, down }
}
