//! What surfaces are made of: colours (linear RGB reflectances), gloss, and
//! the procedural patterns of wood, paint and leaves.

use glam::Vec3;

use crate::random::{cloudy, noise, unit};
use crate::shapes::{Ray, Shape};
use crate::spine;

/// How a surface answers light, beyond a plain matt or glossy one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// Matt with some gloss.
    Plain,
    /// Light bleeds under the surface.
    Skin,
    /// A hair lying along this direction.
    Hair(Vec3),
    /// Mirrors the lamps sharply.
    Wet,
}

/// A point of a surface, ready to be lit.
#[derive(Debug, Clone, Copy)]
pub struct Surface {
    /// Where it is.
    pub point: Vec3,
    /// The unit normal, towards the viewer's side.
    pub normal: Vec3,
    /// The share of light it scatters.
    pub albedo: Vec3,
    /// Mirror reflectance at normal incidence.
    pub gloss: f32,
    /// Width of the highlight, 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// How it answers light.
    pub kind: Kind,
}

/// What a solid shape is made of.
#[derive(Debug, Clone, Copy)]
pub enum Finish {
    /// Oiled wood with its grain along axis `along` of the block.
    Wood {
        /// The axis of the grain: 0, 1 or 2.
        along: usize,
        /// Mean reflectance.
        tone: Vec3,
        /// Which piece of the tree.
        seed: u32,
    },
    /// Matt paint.
    Paint(Vec3),
    /// Glazed pottery.
    Glaze(Vec3),
    /// Brass.
    Brass,
    /// A leaf of this lightness.
    Leaf(f32),
    /// A small globe of the Earth-like sort, with seas and lands.
    Globe,
    /// A box covered in striped paper.
    Carton(Vec3),
    /// A hair of this reflectance.
    Hair(Vec3),
}

/// Wood at the point `q` of a board, its grain along axis `along`.
fn wood(q: Vec3, along: usize, tone: Vec3, seed: u32) -> Vec3 {
    let shift = Vec3::new(unit(seed), unit(seed ^ 0x55), unit(seed ^ 0xaaaa)) * 90.0;
    let mut stretched = q;
    stretched[along] *= 0.045;
    let s = stretched + shift;
    let rings = (5.0 * cloudy(s * 0.55) + 1.6 * (s.x + s.y + s.z)).sin();
    let fine = cloudy(s * Vec3::splat(7.0));
    tone * (1.0 + 0.13 * rings + 0.10 * fine) * (Vec3::ONE - Vec3::new(0.0, 0.02, 0.05) * rings)
}

/// Sea or land of the toy globe at the unit vector `q`.
fn globe(q: Vec3) -> Vec3 {
    let land = cloudy(q * 2.1 + 11.0) + 0.25 * noise(q * 9.0);
    let meridian = ((q.x.atan2(q.z) * 12.0 / std::f32::consts::TAU).fract().abs() - 0.5).abs();
    let line = if meridian > 0.485 { 0.8 } else { 1.0 };
    let ground = if land > 0.12 {
        Vec3::new(0.52, 0.40, 0.20).lerp(Vec3::new(0.28, 0.34, 0.13), 0.5 + 0.5 * noise(q * 4.0))
    } else {
        Vec3::new(0.07, 0.22, 0.30)
    };
    ground * line
}

impl Finish {
    /// Reflectance, gloss and roughness at `q` (the shape's own coordinates).
    fn look(self, q: Vec3, p: Vec3) -> (Vec3, f32, f32) {
        match self {
            Self::Wood { along, tone, seed } => (wood(q, along, tone, seed), 0.035, 0.42),
            Self::Paint(tone) => (tone * (1.0 + 0.025 * cloudy(p * 0.21)), 0.02, 0.7),
            Self::Glaze(tone) => (tone * (1.0 + 0.08 * cloudy(q * 0.5)), 0.05, 0.16),
            Self::Brass => (Vec3::new(0.42, 0.29, 0.12), 0.35, 0.3),
            Self::Leaf(light) => {
                let vein = 1.0 - 0.35 * (-(q.x * q.x) * 400.0).exp();
                (Vec3::new(0.075, 0.19, 0.055) * (light * vein), 0.04, 0.35)
            }
            Self::Globe => (globe(q), 0.04, 0.3),
            Self::Carton(tone) => {
                let stripe = if (q.x * 0.9).rem_euclid(1.0) < 0.16 { 1.35 } else { 1.0 };
                (tone * stripe, 0.02, 0.6)
            }
            Self::Hair(tone) => (tone, 0.04, 0.35),
        }
    }
}

/// The surface of a solid shape where the ray has met it.
pub fn surface(shape: &Shape, ray: &Ray, t: f32) -> Surface {
    let point = ray.at(t);
    let (q, mut normal) = shape.face(point);
    let mut kind = Kind::Plain;
    let (albedo, gloss, roughness) = match shape {
        Shape::Block(s) => s.finish.look(q, point),
        Shape::Ellipsoid(s) => s.finish.look(q, point),
        Shape::Vessel(s) => s.finish.look(q, point),
        Shape::Book(s) => spine::binding(s.seed, s.half, s.bulge, q),
        Shape::Strand(s) => {
            kind = Kind::Hair((s.end - s.start).normalize_or(Vec3::Y));
            s.finish.look(q, point)
        }
    };
    if normal.dot(ray.direction) > 0.0 && kind == Kind::Plain {
        normal -= ray.direction * (normal.dot(ray.direction) + 0.01);
        normal = normal.normalize();
    }
    Surface { point, normal, albedo, gloss, roughness, kind }
}
