//! Follows light from the camera: visibility, the lamps with their soft
//! shadows, and one bounce off what surrounds a point.

use glam::Vec3;
use rayon::prelude::*;

use crate::film::{Film, Pixel};
use crate::light::{Answer, FILL, KEY, Lamp, answer, fresnel, room};
use crate::materials::{Kind, Surface};
use crate::panorama;
use crate::random::{hash2, hash3, unit};
use crate::scene::Scene;
use crate::shapes::Ray;

/// Width of the picture's plane, in centimetres.
pub const WIDTH: f32 = 110.0;
/// Height of the picture's plane, in centimetres.
pub const HEIGHT: f32 = 137.5;
/// Distance of the camera from the picture's plane `z = 0`.
pub const DISTANCE: f32 = 480.0;

/// The ray from the camera through a point of the plane `z = 0`.
pub fn camera(x: f32, y: f32) -> Ray {
    let origin = Vec3::new(0.0, 0.0, DISTANCE);
    Ray { origin, direction: (Vec3::new(x, y, 0.0) - origin).normalize() }
}

/// Points of the unit square, spread evenly over the samples of one pixel,
/// however many they are.
struct Spread {
    turn: u32,
    index: u32,
}

impl Spread {
    /// The pair with this number: the plastic-number lattice, shifted
    /// differently for each pixel and number (Cranley and Patterson).
    fn pair(&self, number: u32) -> (f32, f32) {
        let key = hash2(self.turn, number);
        let k = self.index as f32;
        let u = unit(key) + k * 0.754_877_7;
        let v = unit(hash2(key, 2)) + k * 0.569_840_3;
        (u.fract(), v.fract())
    }

    /// A pair without any order, for what depends on another pair's choice.
    fn stray(&self, number: u32) -> (f32, f32) {
        let key = hash3(self.turn, number, self.index);
        (unit(key), unit(hash2(key, 2)))
    }
}

/// A direction about `normal`, likelier the nearer to it (cosine law).
fn scatter(normal: Vec3, (u, v): (f32, f32)) -> Vec3 {
    let z = 1.0 - 2.0 * u;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let angle = std::f32::consts::TAU * v;
    let ball = Vec3::new(r * angle.cos(), r * angle.sin(), z);
    (normal + 0.999 * ball).normalize()
}

/// Where a ray leaving the surface starts, clear of the surface itself.
fn lift(surface: &Surface) -> Vec3 {
    let clear = match surface.kind {
        Kind::Hair(_) => 0.09,
        Kind::Skin => 0.05,
        _ => 0.03,
    };
    surface.point + surface.normal * clear
}

/// What the lamp gives a surface, shadows included.
fn lit(scene: &Scene, surface: &Surface, view: Vec3, lamp: &Lamp, at: (f32, f32)) -> Answer {
    let source = lamp.point(at.0, at.1);
    let mut given = answer(surface, view, lamp, source);
    if given.scattered.max_element() + given.mirrored.max_element() < 1e-5 {
        return Answer::default();
    }
    let start = lift(surface);
    let to = source - start;
    let reach = to.length();
    if scene.shaded(surface.point, &Ray { origin: start, direction: to / reach }, reach) {
        given = Answer::default();
        // Hair lets some light through between its strands.
        if let Kind::Hair(_) = surface.kind {
            given.scattered = answer(surface, view, lamp, source).scattered * 0.12;
        }
    }
    if scene.has_room() {
        let beam = lamp.beam(source, surface.point);
        given.scattered *= beam;
        given.mirrored *= beam;
    }
    given
}

/// Light that reaches a surface from its surroundings rather than the lamps.
fn surroundings(scene: &Scene, from: &Surface, spread: &Spread) -> Vec3 {
    let ray = Ray { origin: lift(from), direction: scatter(from.normal, spread.pair(3)) };
    match scene.meet_from(from.point, &ray, 400.0) {
        None => room(ray.direction),
        Some(other) if other.kind == Kind::Bright => Vec3::ZERO,
        Some(other) => {
            let direct = lit(scene, &other, -ray.direction, &KEY, spread.stray(4)).scattered;
            let dim = 0.5 * room(other.normal) + Vec3::splat(0.04);
            other.albedo * (direct + dim)
        }
    }
}

/// A sharp picture of the lamps and the room, mirrored in a wet surface.
fn mirror(surface: &Surface, direction: Vec3) -> Vec3 {
    let cosine = -surface.normal.dot(direction);
    let away = direction + 2.0 * cosine * surface.normal;
    let mut seen = room(away) * 0.5;
    for (lamp, glow) in [(&KEY, 48.0), (&FILL, 10.0)] {
        if lamp.seen(surface.point, away) {
            seen += lamp.power * glow;
        }
    }
    seen * fresnel(surface.gloss, cosine)
}

/// One sample of a pixel.
fn sample(scene: &Scene, ray: &Ray, spread: &Spread) -> Pixel {
    let Some(surface) = scene.see(ray, 2000.0) else {
        return Pixel::default();
    };
    // All around, depth is that of the surface's plane, so that what is flat is known to be so.
    let depth = if scene.has_room() { surface.point.dot(surface.normal) } else { surface.point.z };
    if surface.kind == Kind::Bright {
        let (albedo, normal) = (surface.albedo, surface.normal);
        return Pixel { albedo, lit: albedo, normal, depth, ..Pixel::default() };
    }
    let view = -ray.direction;
    let key = lit(scene, &surface, view, &KEY, spread.pair(1));
    let fill = lit(scene, &surface, view, &FILL, spread.pair(2));
    let around = surroundings(scene, &surface, spread);
    let mut shine = key.mirrored + fill.mirrored;
    if surface.kind == Kind::Wet {
        shine += mirror(&surface, ray.direction);
    }
    Pixel {
        albedo: surface.albedo,
        lit: surface.albedo * (key.scattered + fill.scattered + around),
        shine,
        normal: surface.normal,
        depth,
        skin: if surface.kind == Kind::Skin { 1.0 } else { 0.0 },
    }
}

/// How many samples a pixel gets: the first number always, the second where
/// the first ones show an edge or a pattern. Noise in the light alone needs
/// no more samples, as it is smoothed over neighbouring pixels.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Samples of an even pixel.
    pub least: u32,
    /// Samples of a pixel with an edge in it.
    pub most: u32,
}

/// Whether two samples of a pixel see different things.
fn differ(a: &Pixel, b: &Pixel) -> bool {
    let tone = (a.albedo - b.albedo).abs().max_element();
    let shine = (a.shine - b.shine).abs().max_element();
    tone > 0.05 * (a.albedo + b.albedo).max_element() + 0.006
        || shine > 0.08
        || (a.depth - b.depth).abs() > 0.25
        || a.normal.dot(b.normal) < 0.97
}

/// A picture: the ray behind each of its points, given from its left and top in pixels.
struct View<R> {
    width: usize,
    height: usize,
    /// Centimetres a pixel, where the person is.
    pitch: f32,
    ray: R,
}

impl<R: Fn(f32, f32) -> Ray + Sync> View<R> {
    /// The pixel at this row and column.
    fn expose(&self, scene: &Scene, row: usize, column: usize, effort: Effort) -> Pixel {
        let turn = hash3(row as u32, column as u32, 0x5eed);
        let mut total = Pixel::default();
        let mut first = None;
        let (mut taken, mut wanted) = (0, effort.least);
        while taken < wanted {
            let spread = Spread { turn, index: taken };
            let (du, dv) = spread.pair(0);
            let ray = (self.ray)(column as f32 + du, row as f32 + dv);
            let seen = sample(scene, &ray, &spread);
            if differ(first.get_or_insert(seen), &seen) {
                wanted = effort.most.max(effort.least);
            }
            total.add(&seen);
            taken += 1;
        }
        total.scale(1.0 / taken as f32);
        total
    }

    fn render(&self, scene: &Scene, effort: Effort) -> Film {
        let mut pixels = vec![Pixel::default(); self.width * self.height];
        pixels.par_chunks_mut(self.width).enumerate().for_each(|(row, line)| {
            for (column, pixel) in line.iter_mut().enumerate() {
                *pixel = self.expose(scene, row, column, effort);
            }
        });
        Film { width: self.width, height: self.height, pitch: self.pitch, pixels }
    }
}

/// Renders the photograph `width` pixels wide.
pub fn render(scene: &Scene, width: usize, effort: Effort) -> Film {
    let height = (width as f32 * HEIGHT / WIDTH).round() as usize;
    let pitch = WIDTH / width as f32;
    let ray = |x: f32, y: f32| camera(x * pitch - 0.5 * WIDTH, 0.5 * HEIGHT - y * pitch);
    View { width, height, pitch, ray }.render(scene, effort)
}

/// Renders the panorama `width` pixels wide, half as high.
pub fn render_panorama(scene: &Scene, width: usize, effort: Effort) -> Film {
    let height = (width / 2).max(1);
    let ray = |x: f32, y: f32| panorama::ray(x / width as f32, y / height as f32);
    let pitch = panorama::PLACE * std::f32::consts::TAU / width as f32;
    View { width, height, pitch, ray }.render(scene, effort)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Detail;
    use crate::shelf::{BOARDS, FRONT, HALF_BOARD};

    /// The tests' scene, coarse enough to be quick.
    fn scene() -> Scene {
        Scene::new(Detail::COARSE)
    }

    #[test]
    fn the_number_of_threads_changes_no_byte() -> Result<(), Box<dyn std::error::Error>> {
        let scene = scene();
        let effort = Effort { least: 2, most: 4 };
        let with = |threads| -> Result<Vec<u8>, rayon::ThreadPoolBuildError> {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
            Ok(pool.install(|| render(&scene, 32, effort).develop().into_raw()))
        };
        let alone = with(1)?;
        assert_eq!(alone.len(), 32 * 40 * 3);
        assert_eq!(alone, with(3)?);
        Ok(())
    }

    #[test]
    fn boards_are_straight_and_level() {
        let scene = scene();
        // The top board is under the cornice, the lowest is the cabinet's ledge.
        for board in &BOARDS[1..4] {
            // Where the board's upper front edge is seen from the camera.
            let top = board + HALF_BOARD;
            let edge = top * DISTANCE / (DISTANCE - FRONT);
            let wood = |x: f32, y: f32| {
                let seen = scene.see(&camera(x, y), 2000.0);
                seen.is_some_and(|s| s.point.z > FRONT - 0.1 && s.point.y < top + 0.1)
            };
            for x in [-54.0, -27.0, 27.0, 54.0] {
                assert!(wood(x, edge - 0.05), "no board under its edge at {x}, {edge}");
                assert!(!wood(x, edge + 0.05), "a board above its edge at {x}, {edge}");
            }
        }
    }

    #[test]
    fn the_picture_is_neither_black_nor_blown_out() {
        let picture = render(&scene(), 48, Effort { least: 2, most: 2 }).develop();
        let count = picture.pixels().len();
        let dark = picture.pixels().filter(|p| p.0.iter().all(|&v| v < 6)).count();
        let bright = picture.pixels().filter(|p| p.0.iter().all(|&v| v > 252)).count();
        assert!(dark * 50 < count, "{dark} of {count} pixels are black");
        assert!(bright * 100 < count, "{bright} of {count} pixels are blown out");
    }
}
