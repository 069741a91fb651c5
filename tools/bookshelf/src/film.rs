//! The exposed picture: noise in the light is smoothed without touching edges
//! or patterns, light is spread under skin, and the result is developed to
//! 8-bit sRGB.

use glam::Vec3;
use image::{Rgb, RgbImage};
use rayon::prelude::*;

/// Averages over the samples of one pixel.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pixel {
    /// Reflectance.
    pub albedo: Vec3,
    /// Light scattered by the surfaces (reflectance included).
    pub lit: Vec3,
    /// Light mirrored by the surfaces.
    pub shine: Vec3,
    /// The surfaces' normal.
    pub normal: Vec3,
    /// The surfaces' z.
    pub depth: f32,
    /// The share that is skin.
    pub skin: f32,
}

impl Pixel {
    /// Adds another pixel's values.
    pub fn add(&mut self, other: &Self) {
        self.albedo += other.albedo;
        self.lit += other.lit;
        self.shine += other.shine;
        self.normal += other.normal;
        self.depth += other.depth;
        self.skin += other.skin;
    }

    /// Multiplies everything by `factor`.
    pub fn scale(&mut self, factor: f32) {
        self.albedo *= factor;
        self.lit *= factor;
        self.shine *= factor;
        self.normal *= factor;
        self.depth *= factor;
        self.skin *= factor;
    }
}

/// A rendered picture before development.
#[derive(Debug)]
pub struct Film {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Centimetres a pixel.
    pub pitch: f32,
    /// Rows from the top, each from the left.
    pub pixels: Vec<Pixel>,
}

impl Film {
    /// Averages `light` over neighbours at multiples of `step` pixels up to
    /// `reach`, each weighted by `weight(here, there, distance in pixels)`.
    fn blur(
        &self,
        light: &[Vec3],
        reach: isize,
        step: isize,
        weight: impl Fn(&Pixel, &Pixel, f32) -> Vec3 + Sync,
    ) -> Vec<Vec3> {
        let mut out = vec![Vec3::ZERO; light.len()];
        out.par_chunks_mut(self.width).enumerate().for_each(|(row, line)| {
            for (column, value) in line.iter_mut().enumerate() {
                let here = &self.pixels[row * self.width + column];
                let (mut sum, mut total) = (Vec3::ZERO, Vec3::splat(1e-9));
                for dy in -reach..=reach {
                    let y = row as isize + dy * step;
                    if y < 0 || y >= self.height as isize {
                        continue;
                    }
                    for dx in -reach..=reach {
                        let x = column as isize + dx * step;
                        if x < 0 || x >= self.width as isize {
                            continue;
                        }
                        let k = y as usize * self.width + x as usize;
                        let away = ((dx * dx + dy * dy) as f32).sqrt() * step as f32;
                        let w = weight(here, &self.pixels[k], away);
                        sum += light[k] * w;
                        total += w;
                    }
                }
                *value = sum / total;
            }
        });
        out
    }

    /// The light on each pixel, per unit reflectance, freed from noise.
    fn smooth_light(&self) -> Vec<Vec3> {
        let raw: Vec<Vec3> =
            self.pixels.iter().map(|p| p.lit / p.albedo.max(Vec3::splat(1e-4))).collect();
        let alike = |a: &Pixel, b: &Pixel, away: f32| {
            let turn = (a.normal - b.normal).length_squared() * 60.0;
            let gap = (a.depth - b.depth).abs() * 3.0 / (1.0 + 0.5 * away);
            let skin = (a.skin - b.skin).abs() * 8.0;
            Vec3::splat((-turn - gap - skin - away * away * 0.06).exp())
        };
        let once = self.blur(&raw, 2, 1, alike);
        let twice = self.blur(&once, 2, 2, alike);
        // Under skin, red light travels some millimetres, green and blue less.
        let spread = Vec3::new(0.20, 0.09, 0.06) / self.pitch;
        // Every second pixel will do, as the light is smooth already.
        let step = if spread.x > 2.0 { 2 } else { 1 };
        let reach = (spread.x.ceil() as isize).min(5);
        let narrow = (-0.5 / (spread * spread)).max(Vec3::splat(-20.0));
        self.blur(&twice, reach, step, |a, b, away| {
            if away == 0.0 {
                return Vec3::ONE;
            }
            if a.skin < 0.05 || b.skin < 0.05 {
                return Vec3::ZERO;
            }
            let near = (-(a.depth - b.depth).abs() * 2.0).exp() * a.skin * b.skin;
            let e = narrow * (away * away);
            Vec3::new(e.x.exp(), e.y.exp(), e.z.exp()) * near
        })
    }

    /// The finished picture.
    pub fn develop(&self) -> RgbImage {
        let light = self.smooth_light();
        RgbImage::from_fn(self.width as u32, self.height as u32, |x, y| {
            let k = y as usize * self.width + x as usize;
            let pixel = &self.pixels[k];
            let colour = print(pixel.albedo * light[k] + pixel.shine);
            let byte = |v: f32| (255.0 * v.clamp(0.0, 1.0) + 0.5) as u8;
            Rgb([byte(colour.x), byte(colour.y), byte(colour.z)])
        })
    }
}

/// A film's gentle S-shaped answer to scene light, encoded as sRGB.
fn print(light: Vec3) -> Vec3 {
    let x = light * 0.60;
    // Film dulls strong colours a little.
    let x = x.lerp(Vec3::splat(x.dot(Vec3::new(0.21, 0.72, 0.07))), 0.10);
    let toned = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
    let encode = |v: f32| {
        if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
    };
    Vec3::new(encode(toned.x), encode(toned.y), encode(toned.z))
}
