//! The solid shapes that everything but the person is built from: where a ray
//! enters them and which way their surface faces. Lengths are centimetres;
//! x points right, y up and z towards the camera.

use glam::{Mat3, Vec3};

use crate::materials::Finish;

/// A half-line along which light is followed.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    /// Where the ray starts.
    pub origin: Vec3,
    /// Its unit direction.
    pub direction: Vec3,
}

impl Ray {
    /// The point at distance `t` from the origin.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// An axis-parallel box around a shape.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// The corner with the smallest coordinates.
    pub low: Vec3,
    /// The corner with the largest coordinates.
    pub high: Vec3,
}

impl Bounds {
    /// Bounds of nothing, neutral in [`Bounds::join`].
    pub const EMPTY: Self = Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    /// The bounds of both.
    pub fn join(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The surface area, the cost measure of the hierarchy.
    pub fn area(self) -> f32 {
        let d = (self.high - self.low).max(Vec3::ZERO);
        2.0 * (d.x * d.y + d.y * d.z + d.z * d.x)
    }

    /// The interval of `t` that the ray spends inside, empty when reversed.
    pub fn span(&self, origin: Vec3, inverse: Vec3) -> (f32, f32) {
        let a = (self.low - origin) * inverse;
        let b = (self.high - origin) * inverse;
        (a.min(b).max_element(), a.max(b).min_element())
    }
}

/// A box that may be turned; boards, boxes and panels.
#[derive(Debug, Clone)]
pub struct Block {
    /// The box's middle.
    pub centre: Vec3,
    /// Half its extents along its own axes.
    pub half: Vec3,
    /// Its axes as columns.
    pub axes: Mat3,
    /// Width of the rounding of its edges, in shading only.
    pub bevel: f32,
    /// What it is made of.
    pub finish: Finish,
}

/// A book: a box whose front, the spine, is a shallow cylinder.
#[derive(Debug, Clone)]
pub struct Book {
    /// The box's middle.
    pub centre: Vec3,
    /// Half thickness, half height and half depth.
    pub half: Vec3,
    /// Its axes as columns: across the spine, along the spine, out of the spine.
    pub axes: Mat3,
    /// How far the spine's middle stands out before its sides.
    pub bulge: f32,
    /// The number from which the binding's look is drawn.
    pub seed: u32,
}

/// A turned ellipsoid; leaves, globes and pebbles.
#[derive(Debug, Clone)]
pub struct Ellipsoid {
    /// The middle.
    pub centre: Vec3,
    /// The three radii along its own axes.
    pub radii: Vec3,
    /// Its axes as columns.
    pub axes: Mat3,
    /// What it is made of.
    pub finish: Finish,
}

/// A vessel turned about a vertical axis, with a wavy profile.
#[derive(Debug, Clone)]
pub struct Vessel {
    /// The middle of its foot.
    pub foot: Vec3,
    /// Its height.
    pub height: f32,
    /// Its radius at evenly spaced heights from foot to rim.
    pub profile: [f32; 5],
    /// What it is made of.
    pub finish: Finish,
}

/// A piece of a hair: a capsule.
#[derive(Debug, Clone)]
pub struct Strand {
    /// One end.
    pub start: Vec3,
    /// The other end.
    pub end: Vec3,
    /// The capsule's radius.
    pub radius: f32,
    /// What kind of hair, and its shade.
    pub finish: Finish,
}

/// Any of the solid shapes.
#[derive(Debug, Clone)]
pub enum Shape {
    /// A box.
    Block(Block),
    /// A book.
    Book(Book),
    /// An ellipsoid.
    Ellipsoid(Ellipsoid),
    /// A turned vessel.
    Vessel(Vessel),
    /// A piece of a hair.
    Strand(Strand),
}

/// The interval that a ray (in box coordinates) spends in `|x| <= half`.
fn slab(origin: Vec3, direction: Vec3, half: Vec3) -> (f32, f32) {
    Bounds { low: -half, high: half }.span(origin, direction.recip())
}

/// Bounds of a turned box.
fn turned_bounds(centre: Vec3, half: Vec3, axes: Mat3) -> Bounds {
    let reach =
        axes.x_axis.abs() * half.x + axes.y_axis.abs() * half.y + axes.z_axis.abs() * half.z;
    Bounds { low: centre - reach, high: centre + reach }
}

/// The outward normal of the box face nearest to `q`, bent near the edges.
fn box_normal(q: Vec3, half: Vec3, bevel: f32) -> Vec3 {
    let inside = half - q.abs();
    let nearest = inside.min_element();
    let bend = |depth: f32, coordinate: f32| {
        let weight = if depth == nearest {
            1.0
        } else {
            0.8 * (1.0 - depth / bevel.max(1e-4)).max(0.0).powi(2)
        };
        weight * coordinate.signum()
    };
    Vec3::new(bend(inside.x, q.x), bend(inside.y, q.y), bend(inside.z, q.z)).normalize()
}

impl Book {
    /// The radius of the spine's cylinder.
    fn spine_radius(&self) -> f32 {
        (self.half.x * self.half.x + self.bulge * self.bulge) / (2.0 * self.bulge)
    }

    /// Where the ray, given in book coordinates, enters the book, at `least`
    /// or later.
    fn enter(&self, origin: Vec3, direction: Vec3, least: f32) -> Option<f32> {
        let (whole_in, whole_out) = slab(origin, direction, self.half);
        if whole_in > whole_out || whole_out < least {
            return None;
        }
        let inset = Vec3::new(0.0, 0.0, 0.5 * self.bulge);
        let (cover_in, cover_out) = slab(origin + inset, direction, self.half - inset);
        let cover = (cover_in <= cover_out && cover_in > least).then_some(cover_in);

        let radius = self.spine_radius();
        let axis = self.half.z - radius;
        let (ox, oz) = (origin.x, origin.z - axis);
        let a = direction.x * direction.x + direction.z * direction.z;
        let b = ox * direction.x + oz * direction.z;
        let c = ox * ox + oz * oz - radius * radius;
        let root = b * b - a * c;
        if root <= 0.0 {
            return cover;
        }
        let root = root.sqrt();
        let front = Vec3::new(0.0, 0.0, self.half.z - 0.5 * self.bulge);
        let half = Vec3::new(self.half.x, self.half.y, 0.5 * self.bulge);
        let (cap_in, cap_out) = slab(origin - front, direction, half);
        let near = cap_in.max((-b - root) / a);
        let far = cap_out.min((-b + root) / a);
        let spine = (near <= far && near > least).then_some(near);
        match (cover, spine) {
            (Some(x), Some(y)) => Some(x.min(y)),
            (x, y) => x.or(y),
        }
    }

    /// The normal in book coordinates.
    fn normal(&self, q: Vec3) -> Vec3 {
        if q.z > self.half.z - self.bulge + 1e-3 && q.y.abs() < self.half.y - 2e-3 {
            let axis = self.half.z - self.spine_radius();
            let mut n = Vec3::new(q.x, 0.0, q.z - axis).normalize();
            let edge = (1.0 - (self.half.y - q.y.abs()) / 0.12).max(0.0);
            n.y += edge * edge * 0.8 * q.y.signum();
            n.normalize()
        } else {
            box_normal(q, self.half, 0.08)
        }
    }
}

impl Ellipsoid {
    /// Where the ray enters the ellipsoid, at `least` or later.
    fn enter(&self, ray: &Ray, least: f32) -> Option<f32> {
        let turn = self.axes.transpose();
        let o = turn * (ray.origin - self.centre) / self.radii;
        let d = turn * ray.direction / self.radii;
        let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
        let h = b * b - a * c;
        let t = (-b - h.max(0.0).sqrt()) / a;
        (h > 0.0 && t > least).then_some(t)
    }
}

impl Vessel {
    /// The profile's radius at a height given as a fraction.
    fn radius(&self, height: f32) -> f32 {
        let s = height.clamp(0.0, 1.0) * 4.0;
        let i = (s as usize).min(3);
        let t = s - i as f32;
        let at = |k: isize| self.profile[(i as isize + k).clamp(0, 4) as usize];
        let (a, b, c, d) = (at(-1), at(0), at(1), at(2));
        b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
    }

    /// A bound on the distance to the vessel's surface.
    fn distance(&self, p: Vec3) -> f32 {
        let q = p - self.foot;
        let around = q.x.hypot(q.z) - self.radius(q.y / self.height);
        let along = (q.y - 0.5 * self.height).abs() - 0.5 * self.height;
        let solid = around.max(along);
        let hollow = (around + 0.35).max(self.height - 1.2 - q.y);
        solid.max(-hollow) * 0.7
    }

    /// Where the ray enters the vessel, found by walking safe distances.
    fn enter(&self, ray: &Ray, bounds: Bounds) -> Option<f32> {
        let (near, far) = bounds.span(ray.origin, ray.direction.recip());
        let mut t = near.max(0.0);
        for _ in 0..90 {
            if t > far {
                break;
            }
            let d = self.distance(ray.at(t));
            if d < 2e-3 {
                return Some(t);
            }
            t += d;
        }
        None
    }
}

impl Strand {
    /// Where the ray enters the capsule, at `least` or later.
    fn enter(&self, ray: &Ray, least: f32) -> Option<f32> {
        let ba = self.end - self.start;
        let oa = ray.origin - self.start;
        let (baba, bard, baoa) = (ba.dot(ba), ba.dot(ray.direction), ba.dot(oa));
        let (rdoa, oaoa) = (ray.direction.dot(oa), oa.dot(oa));
        let a = baba - bard * bard;
        let b = baba * rdoa - baoa * bard;
        let c = baba * oaoa - baoa * baoa - self.radius * self.radius * baba;
        let h = b * b - a * c;
        if h < 0.0 || a < 1e-12 {
            return None;
        }
        let t = (-b - h.sqrt()) / a;
        let y = baoa + t * bard;
        if y > 0.0 && y < baba {
            return (t > least).then_some(t);
        }
        let oc = if y <= 0.0 { oa } else { ray.origin - self.end };
        let b = ray.direction.dot(oc);
        let h = b * b - (oc.dot(oc) - self.radius * self.radius);
        if h < 0.0 {
            return None;
        }
        let t = -b - h.sqrt();
        (t > least).then_some(t)
    }
}

impl Shape {
    /// A box around the shape.
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Block(s) => turned_bounds(s.centre, s.half, s.axes),
            Self::Book(s) => turned_bounds(s.centre, s.half, s.axes),
            Self::Ellipsoid(s) => turned_bounds(s.centre, s.radii, s.axes),
            Self::Vessel(s) => {
                let wide = s.profile.iter().fold(0.0_f32, |a, &b| a.max(b)) + 0.4;
                let low = s.foot - Vec3::new(wide, 0.1, wide);
                Bounds { low, high: s.foot + Vec3::new(wide, s.height + 0.1, wide) }
            }
            Self::Strand(s) => {
                let low = s.start.min(s.end) - s.radius;
                Bounds { low, high: s.start.max(s.end) + s.radius }
            }
        }
    }

    /// The distance along the ray at which it enters the shape.
    pub fn enter(&self, ray: &Ray) -> Option<f32> {
        // Quadratics lose their digits far from a small shape, so the ray is
        // first moved to where it passes the shape's middle.
        let middle = match self {
            Self::Block(s) => s.centre,
            Self::Book(s) => s.centre,
            Self::Ellipsoid(s) => s.centre,
            Self::Vessel(s) => return s.enter(ray, self.bounds()),
            Self::Strand(s) => 0.5 * (s.start + s.end),
        };
        let passed = (middle - ray.origin).dot(ray.direction);
        let close = Ray { origin: ray.at(passed), direction: ray.direction };
        let t = match self {
            Self::Block(s) => {
                let turn = s.axes.transpose();
                let (near, far) =
                    slab(turn * (close.origin - s.centre), turn * close.direction, s.half);
                (near <= far && near > -passed).then_some(near)
            }
            Self::Book(s) => {
                let turn = s.axes.transpose();
                s.enter(turn * (close.origin - s.centre), turn * close.direction, -passed)
            }
            Self::Ellipsoid(s) => s.enter(&close, -passed),
            Self::Vessel(_) => None,
            Self::Strand(s) => s.enter(&close, -passed),
        };
        t.map(|t| t + passed)
    }

    /// The point in the shape's own coordinates, and the unit normal there.
    pub fn face(&self, p: Vec3) -> (Vec3, Vec3) {
        match self {
            Self::Block(s) => {
                let q = s.axes.transpose() * (p - s.centre);
                (q, s.axes * box_normal(q, s.half, s.bevel))
            }
            Self::Book(s) => {
                let q = s.axes.transpose() * (p - s.centre);
                (q, s.axes * s.normal(q))
            }
            Self::Ellipsoid(s) => {
                let q = s.axes.transpose() * (p - s.centre) / s.radii;
                (q, (s.axes * (q / s.radii)).normalize())
            }
            Self::Vessel(s) => {
                let e = 0.02;
                let slope = |axis: Vec3| s.distance(p + axis * e) - s.distance(p - axis * e);
                let n = Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z));
                (p - s.foot, n.normalize_or(Vec3::Y))
            }
            Self::Strand(s) => {
                let along = s.end - s.start;
                let h = ((p - s.start).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                (Vec3::new(0.0, h, 0.0), (p - s.start - along * h).normalize_or(Vec3::Z))
            }
        }
    }
}
