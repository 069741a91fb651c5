//! The person: head and clothes put together, where rays meet them, and what
//! their surface looks like there.

use glam::{Mat3, Vec3};
use rayon::prelude::*;

use crate::clothes::{clothes, knit, ribbed, thread};
use crate::complexion;
use crate::fields::join;
use crate::head::{head, lips};
use crate::materials::{Kind, Surface};
use crate::random::{cloudy, noise};
use crate::shapes::{Bounds, Ray};

/// World centimetres per life-size centimetre.
pub const SCALE: f32 = 0.93;
/// Where the point between the eyes would be, were the head held straight.
pub const PLACE: Vec3 = Vec3::new(0.0, 13.2, 0.0);
/// The joint about which the head is turned, in body coordinates.
const JOINT: Vec3 = Vec3::new(0.0, -10.0, -3.0);
/// How much lower the head sits on the neck.
const LOWER: Vec3 = Vec3::new(0.0, 0.9, 0.0);
/// The person's extent in the world.
const EXTENT: Bounds =
    Bounds { low: Vec3::new(-29.0, -92.0, -15.0), high: Vec3::new(29.0, 28.0, 14.0) };

/// The parts that differ in what they are made of.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Skin,
    Eye,
    Hair,
    Sweater,
    Collar,
    Trousers,
}

/// The head's turn: a slight tilt, and a slight look to the lamp's side.
pub fn turn() -> Mat3 {
    Mat3::from_rotation_z(-0.055) * Mat3::from_rotation_y(-0.13) * Mat3::from_rotation_x(0.015)
}

/// From body to head coordinates.
fn to_head(p: Vec3) -> Vec3 {
    turn().transpose() * (p - JOINT + LOWER) + JOINT
}

/// From head coordinates to the world.
pub fn from_head(p: Vec3) -> Vec3 {
    (turn() * (p - JOINT) + JOINT - LOWER) * SCALE + PLACE
}

/// From the world to body coordinates.
fn to_body(world: Vec3) -> Vec3 {
    (world - PLACE) / SCALE
}

/// Distance to the person, in world centimetres, and the nearest part.
fn nearest(world: Vec3) -> (f32, Part) {
    let p = to_body(world);
    let mut best = (f32::INFINITY, Part::Skin);
    let mut offer = |d: f32, part: Part| {
        if d < best.0 {
            best = (d, part);
        }
    };
    let mut flesh = f32::INFINITY;
    let apart = (p - Vec3::new(0.0, -0.5, -1.0)).length() - 14.5;
    if apart > 3.0 {
        offer(apart, Part::Hair);
    } else {
        let h = head(to_head(p));
        flesh = h.skin;
        offer(h.eye, Part::Eye);
        offer(h.hair, Part::Hair);
    }
    if p.y < -4.0 {
        let neck = turn() * (Vec3::new(0.0, -6.0, -2.2) - JOINT) + JOINT;
        let c = clothes(p, neck);
        flesh = if flesh.is_finite() { join(flesh, c.skin, 0.9) } else { c.skin };
        offer(c.sweater, Part::Sweater);
        offer(c.collar, Part::Collar);
        offer(c.trousers, Part::Trousers);
    }
    offer(flesh, Part::Skin);
    (best.0 * SCALE, best.1)
}

/// Distances to the person at the corners of a lattice.
#[derive(Debug)]
pub struct Person {
    cell: f32,
    count: [usize; 3],
    lattice: Vec<f32>,
}

impl Person {
    /// Measures the distances on a lattice of this cell size.
    pub fn new(cell: f32) -> Self {
        let size = (EXTENT.high - EXTENT.low) / cell;
        let count = [size.x, size.y, size.z].map(|s| s.ceil() as usize + 1);
        let lattice = (0..count[1] * count[2])
            .into_par_iter()
            .flat_map_iter(|line| {
                let (y, z) = (line % count[1], line / count[1]);
                (0..count[0]).map(move |x| {
                    let corner = Vec3::new(x as f32, y as f32, z as f32);
                    nearest(EXTENT.low + corner * cell).0
                })
            })
            .collect();
        Self { cell, count, lattice }
    }

    /// Distance to the person at a point inside the extent: exact nearby,
    /// interpolated farther away.
    pub fn distance(&self, p: Vec3) -> f32 {
        let s = (p - EXTENT.low) / self.cell;
        let cell = s.floor().max(Vec3::ZERO);
        let f = s - cell;
        let at = |v: f32, n: usize| (v as usize).min(n - 2);
        let [nx, ny, nz] = self.count;
        let base = at(cell.x, nx) + nx * (at(cell.y, ny) + ny * at(cell.z, nz));
        let row = |k: usize| self.lattice[k] + (self.lattice[k + 1] - self.lattice[k]) * f.x;
        let sheet = |k: usize| row(k) + (row(k + nx) - row(k)) * f.y;
        let d = sheet(base) + (sheet(base + nx * ny) - sheet(base)) * f.z;
        if d > 1.4 * self.cell { d } else { nearest(p).0 }
    }

    /// Where the ray enters the person, within `reach`.
    pub fn enter(&self, ray: &Ray, reach: f32) -> Option<f32> {
        let (near, far) = EXTENT.span(ray.origin, ray.direction.recip());
        let far = far.min(reach);
        let mut t = near.max(0.0);
        for _ in 0..200 {
            if t > far {
                return None;
            }
            let d = self.distance(ray.at(t));
            if d < 0.006 {
                return Some(t);
            }
            t += 0.8 * d;
        }
        None
    }

    /// The surface where the ray has entered.
    pub fn surface(&self, ray: &Ray, t: f32) -> Surface {
        let point = ray.at(t);
        let (_, part) = nearest(point);
        let step = if part == Part::Sweater { 0.06 } else { 0.025 };
        let slope = |along: fn(Vec3) -> f32, at: Vec3, e: f32| {
            let corners = [(1, -1, -1), (-1, -1, 1), (-1, 1, -1), (1, 1, 1)];
            corners.iter().fold(Vec3::ZERO, |sum, &(x, y, z)| {
                let k = Vec3::new(x as f32, y as f32, z as f32);
                sum + k * along(at + k * e)
            }) / (4.0 * e)
        };
        let mut normal = slope(|p| nearest(p).0, point, step).normalize_or(Vec3::Z);
        let body = to_body(point);
        let h = to_head(body);
        let mut kind = Kind::Plain;
        let (albedo, gloss, roughness) = match part {
            Part::Skin => {
                kind = Kind::Skin;
                let pores =
                    Vec3::new(noise(h * 11.0), noise(h * 11.0 + 40.0), noise(h * 11.0 + 80.0));
                normal = (normal + 0.02 * pores).normalize();
                let lip = lips(h);
                let moist = lip.0.min(lip.1) < 0.05;
                (complexion::skin(h), 0.03, if moist { 0.28 } else { 0.42 })
            }
            Part::Eye => {
                kind = Kind::Wet;
                let gaze = turn().transpose() * Vec3::new(0.0, 0.0, 1.0);
                (complexion::eye(h, gaze), 0.035, 0.1)
            }
            Part::Hair => (Vec3::new(0.070, 0.037, 0.020), 0.01, 0.6),
            Part::Sweater => {
                let height = |p: Vec3| {
                    let (around, along) = thread(p);
                    knit(around, along, ribbed(p))
                };
                let rise = slope(height, body, 0.05);
                let bump = rise - normal * rise.dot(normal);
                normal = (normal - 0.16 * bump).normalize();
                let deep = 0.62 + 0.42 * height(body);
                let fuzz = 1.0 + 0.06 * cloudy(body * 3.0);
                (Vec3::new(0.075, 0.235, 0.265) * (deep * fuzz), 0.012, 0.75)
            }
            Part::Collar => {
                let weave = 1.0 + 0.02 * noise(body * 12.0);
                (Vec3::new(0.70, 0.69, 0.66) * weave, 0.02, 0.6)
            }
            Part::Trousers => {
                // Twill, and a seam down the front.
                let twill = 0.10 * ((body.x + body.y) * 14.0).sin() + 0.10 * cloudy(body * 0.9);
                let seam = 1.0 - 0.5 * (-(body.x * body.x) * 120.0).exp();
                (Vec3::new(0.075, 0.080, 0.105) * ((1.0 + twill) * seam), 0.02, 0.6)
            }
        };
        Surface { point, normal, albedo, gloss, roughness, kind }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The leftmost and rightmost of the person at this height.
    fn sides(y: f32) -> (f32, f32) {
        let covered = |x: f32| (-14..14).any(|z| nearest(Vec3::new(x, y, z as f32)).0 < 0.5);
        let xs: Vec<f32> = (-58..=58).map(|k| 0.5 * k as f32).filter(|&x| covered(x)).collect();
        let low = xs.iter().fold(f32::INFINITY, |a, &b| a.min(b));
        (low, xs.iter().fold(f32::NEG_INFINITY, |a, &b| a.max(b)))
    }

    #[test]
    fn the_person_stands_in_the_middle() {
        for y in [14.0, 4.0, -15.0, -30.0] {
            let (left, right) = sides(y);
            assert!((left + right).abs() < 3.0, "off centre at y = {y}: {left} to {right}");
            assert!(right - left > 8.0, "too thin at y = {y}");
        }
    }

    #[test]
    fn the_head_is_inside_the_usual_view() {
        // Chin to crown, within the 82 cm that the default camera sees.
        let covered = |y: f32| (-14..14).any(|z| nearest(Vec3::new(0.0, y, z as f32)).0 < 0.0);
        let crown = (0..60).map(|k| k as f32 * 0.5).filter(|&y| covered(y)).fold(0.0, f32::max);
        assert!((22.0..28.0).contains(&crown), "crown at {crown}");
    }

    #[test]
    fn distances_near_the_surface_are_exact() {
        let person = Person::new(0.6);
        let mut random = crate::random::Random::new(5);
        let mut near = 0;
        for _ in 0..20_000 {
            let p = random.in_cube() * Vec3::new(27.0, 26.0, 12.0);
            let exact = nearest(p).0;
            if exact.abs() < 0.3 {
                assert_eq!(person.distance(p), exact, "at {p}");
                near += 1;
            }
        }
        assert!(near > 100, "only {near} points are near the surface");
    }
}
