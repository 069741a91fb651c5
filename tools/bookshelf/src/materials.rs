//! What surfaces are made of: colours (linear RGB reflectances), gloss, and
//! the procedural patterns of wood, paint and leaves.

use glam::Vec3;

use crate::random::{cloudy, hash2, hash3, noise, unit};
use crate::shapes::{Block, Ellipsoid, Ray, Shape, Vessel};
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
    /// Shines by itself, with the light that stands for its albedo.
    Bright,
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
    /// A picture of the kind that hangs on walls, with this number.
    Canvas(u32),
    /// A sheet of paper with lines of writing.
    Letter,
    /// A woven rug.
    Rug,
    /// Something that shines with this light.
    Glow(Vec3),
    /// What is seen through the window: sky over trees.
    Daylight,
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

/// Hills under a sky, or coloured fields, at the point `q` of a picture.
fn canvas(q: Vec3, seed: u32) -> Vec3 {
    let shift = Vec3::new(unit(hash2(seed, 1)), unit(hash2(seed, 2)), unit(hash2(seed, 3))) * 50.0;
    let p = Vec3::new(q.x, q.y, 0.0);
    let stroke = 1.0 + 0.10 * cloudy(p * Vec3::new(0.5, 1.6, 1.0) + shift);
    let colour = |k: u32| {
        let part = |channel| unit(hash3(seed, k, channel));
        let mix = Vec3::new(part(1), part(2), part(3));
        Vec3::new(0.10, 0.12, 0.11) + mix * Vec3::new(0.42, 0.32, 0.26)
    };
    if seed % 2 == 0 {
        let sky = Vec3::new(0.34, 0.42, 0.48)
            .lerp(Vec3::new(0.60, 0.50, 0.36), (-0.03 * q.y).exp().min(1.0));
        let mut seen = sky;
        for k in 0..3 {
            let ridge =
                6.0 - 7.0 * k as f32 + 5.0 * cloudy(Vec3::new(q.x * 0.05, 0.0, k as f32) + shift);
            if q.y < ridge {
                seen = Vec3::new(0.20, 0.26, 0.27).lerp(colour(k), 0.25 + 0.25 * k as f32);
            }
        }
        seen * stroke
    } else {
        let warp = p * 0.06 + 0.5 * noise(p * 0.05 + shift);
        let field = (hash3(warp.x.floor() as i32 as u32, warp.y.floor() as i32 as u32, seed)) % 5;
        colour(field) * stroke
    }
}

/// The rug: a border about a field of lozenges, at `q` from its middle.
fn rug(q: Vec3) -> Vec3 {
    let (x, z) = (q.x.abs(), q.z.abs());
    let (red, blue, cream) =
        (Vec3::new(0.24, 0.055, 0.045), Vec3::new(0.05, 0.075, 0.13), Vec3::new(0.46, 0.38, 0.26));
    let edge = (135.0 - x).min(95.0 - z);
    let lozenge = |step: f32| (q.x / step).rem_euclid(1.0) - 0.5;
    let tile = |step: f32| lozenge(step).abs() + ((q.z / step).rem_euclid(1.0) - 0.5).abs();
    let yarn = 1.0 + 0.16 * noise(q * 1.3) + 0.08 * noise(q * Vec3::new(4.0, 0.0, 0.8));
    let colour = if edge < 4.0 || (22.0..24.0).contains(&edge) {
        cream
    } else if edge < 22.0 {
        if tile(18.0) < 0.26 {
            cream
        } else if tile(18.0) < 0.40 {
            red
        } else {
            blue
        }
    } else if (x / 80.0 + z / 52.0) < 1.0 {
        if (x / 80.0 + z / 52.0) > 0.92 {
            cream
        } else if tile(13.0) < 0.3 {
            red
        } else {
            blue
        }
    } else if tile(26.0) < 0.16 {
        cream
    } else {
        red
    };
    colour * yarn
}

/// Sky over trees, out of focus, at this point of the window.
fn daylight(p: Vec3) -> Vec3 {
    let height = p.y + 10.0 * cloudy(p * 0.022);
    let sky = Vec3::new(1.05, 1.25, 1.5)
        .lerp(Vec3::new(0.75, 1.0, 1.45), (height / 200.0).clamp(0.0, 1.0));
    let cloud = (0.5 + 0.6 * cloudy(p * Vec3::new(1.0, 0.016, 0.008) + 3.0)).clamp(0.0, 1.0);
    let sky = sky.lerp(Vec3::splat(1.7), 0.6 * cloud);
    let trees = Vec3::new(0.20, 0.30, 0.11) * (1.0 + 0.45 * cloudy(p * 0.09));
    let lawn = Vec3::new(0.36, 0.48, 0.20);
    let ground = lawn.lerp(trees, ((p.y + 42.0) / 14.0).clamp(0.0, 1.0));
    ground.lerp(sky, ((height - 38.0) / 14.0).clamp(0.0, 1.0))
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
            Self::Canvas(seed) => (canvas(q, seed), 0.02, 0.6),
            Self::Letter => {
                let line = (q.z * 1.1).rem_euclid(1.0) < 0.3 && q.z.abs() < 12.0;
                let written = line && q.x.abs() < 8.5 && noise(q * Vec3::new(3.0, 0.0, 1.1)) > -0.2;
                (Vec3::new(0.66, 0.63, 0.55) * if written { 0.45 } else { 1.0 }, 0.02, 0.7)
            }
            Self::Rug => (rug(q), 0.0, 0.9),
            Self::Glow(light) => (light, 0.0, 0.9),
            Self::Daylight => (daylight(p), 0.0, 0.9),
        }
    }
}

/// The surface of a solid shape where the ray has met it.
pub fn surface(shape: &Shape, ray: &Ray, t: f32) -> Surface {
    let point = ray.at(t);
    let (q, mut normal) = shape.face(point);
    let mut kind = Kind::Plain;
    if let Shape::Block(Block { finish, .. })
    | Shape::Ellipsoid(Ellipsoid { finish, .. })
    | Shape::Vessel(Vessel { finish, .. }) = shape
        && matches!(finish, Finish::Glow(_) | Finish::Daylight)
    {
        kind = Kind::Bright;
    }
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
