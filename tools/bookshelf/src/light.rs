//! The lights: a big soft lamp at the upper left before the person, a weaker
//! one at the right, and the glow of the room.

use glam::Vec3;

use crate::fields::ramp;
use crate::materials::{Kind, Surface};

/// A rectangular lamp, bright on both sides.
#[derive(Debug)]
pub struct Lamp {
    /// Its middle.
    pub centre: Vec3,
    /// From its middle to the middle of its right edge.
    pub across: Vec3,
    /// From its middle to the middle of its upper edge.
    pub upward: Vec3,
    /// The irradiance it gives at the origin at normal incidence.
    pub power: Vec3,
}

/// The main light.
pub const KEY: Lamp = Lamp {
    centre: Vec3::new(-190.0, 165.0, 290.0),
    across: Vec3::new(62.0, 0.0, 40.0),
    upward: Vec3::new(20.0, 66.0, -25.0),
    power: Vec3::new(1.62, 1.50, 1.32),
};

/// The light that lifts the shadows from the right, a little cooler.
pub const FILL: Lamp = Lamp {
    centre: Vec3::new(250.0, 60.0, 150.0),
    across: Vec3::new(30.0, 0.0, -50.0),
    upward: Vec3::new(0.0, 70.0, 0.0),
    power: Vec3::new(0.26, 0.31, 0.37),
};

impl Lamp {
    /// The point of the lamp at `(u, v)` in the unit square.
    pub fn point(&self, u: f32, v: f32) -> Vec3 {
        self.centre + self.across * (2.0 * u - 1.0) + self.upward * (2.0 * v - 1.0)
    }

    /// Whether a ray towards `direction` from `origin` meets the lamp or the
    /// bright frame of its reflector.
    pub fn seen(&self, origin: Vec3, direction: Vec3) -> bool {
        let normal = self.across.cross(self.upward);
        let t = (self.centre - origin).dot(normal) / direction.dot(normal);
        let q = origin + direction * t - self.centre;
        let u = q.dot(self.across) / self.across.length_squared();
        let v = q.dot(self.upward) / self.upward.length_squared();
        t > 0.0 && u.abs() < 1.4 && v.abs() < 1.4
    }

    /// The share of its light that goes towards `point`, for the reflector directs it: all within
    /// some 40 degrees.
    pub fn beam(&self, source: Vec3, point: Vec3) -> f32 {
        let axis = self.across.cross(self.upward).normalize();
        let to = source - point;
        // Right before a lamp, it would outshine all else.
        let near = (to.length_squared() / 250.0_f32.powi(2)).min(1.0);
        ramp(0.1, 0.75, to.normalize().dot(axis)) * near
    }

    /// Irradiance at normal incidence from the lamp's `source` point.
    fn reach(&self, to: Vec3) -> Vec3 {
        self.power * (self.centre.length_squared() / to.length_squared())
    }
}

/// Light scattered and mirrored towards the viewer, each per unit albedo and
/// absolute.
#[derive(Debug, Clone, Copy, Default)]
pub struct Answer {
    /// To be multiplied by the surface's albedo.
    pub scattered: Vec3,
    /// To be added as it is.
    pub mirrored: Vec3,
}

/// Schlick's reflectance at this cosine.
pub fn fresnel(gloss: f32, cosine: f32) -> f32 {
    gloss + (1.0 - gloss) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5)
}

/// How the surface answers the unshadowed lamp, sampled at its `source`.
pub fn answer(surface: &Surface, view: Vec3, lamp: &Lamp, source: Vec3) -> Answer {
    let to = source - surface.point;
    let light = to.normalize();
    let reach = lamp.reach(to);
    let cosine = surface.normal.dot(light);
    let half = (light + view).normalize();
    if let Kind::Hair(along) = surface.kind {
        // Kajiya and Kay: a thin cylinder scatters and mirrors in cones.
        let sine = |d: Vec3| (1.0 - along.dot(d).powi(2)).max(0.0).sqrt();
        let facing = 0.35 + 0.65 * cosine.clamp(0.0, 1.0);
        let tilt = (along + 0.12 * surface.normal).normalize();
        let first = (1.0 - tilt.dot(half).powi(2)).max(0.0).powf(45.0);
        let deep = (along - 0.10 * surface.normal).normalize();
        let second = (1.0 - deep.dot(half).powi(2)).max(0.0).powf(14.0);
        let gate = (cosine + 0.3).clamp(0.0, 1.0);
        return Answer {
            scattered: reach * (sine(light) * facing + 1.3 * second * gate),
            mirrored: reach * surface.albedo * (0.8 * first * gate),
        };
    }
    let scattered = if surface.kind == Kind::Skin {
        // Light that has crossed the skin wraps round, the red the farthest.
        let wrap = Vec3::new(0.30, 0.14, 0.10);
        ((Vec3::splat(cosine) + wrap) / (1.0 + wrap)).max(Vec3::ZERO)
    } else {
        Vec3::splat(cosine.max(0.0))
    };
    let shine = if surface.kind == Kind::Wet || cosine <= 0.0 {
        0.0
    } else {
        let power = 2.0 / surface.roughness.max(0.08).powi(3);
        let lobe = surface.normal.dot(half).max(0.0).powf(power) * (power + 2.0) / 8.0;
        lobe * fresnel(surface.gloss, half.dot(view)) * cosine
    };
    Answer { scattered: reach * scattered, mirrored: reach * shine }
}

/// The glow of the room in a direction that meets nothing.
pub fn room(direction: Vec3) -> Vec3 {
    let up = 0.5 + 0.5 * direction.y;
    let walls =
        Vec3::new(0.20, 0.165, 0.13).lerp(Vec3::new(0.50, 0.50, 0.50), up * up * (3.0 - 2.0 * up));
    let window = Vec3::new(0.62, 0.30, 0.72).normalize();
    let glow = direction.dot(window).max(0.0).powi(6);
    walls + Vec3::new(0.32, 0.36, 0.42) * glow
}
