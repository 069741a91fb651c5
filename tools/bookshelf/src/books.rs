//! Fills the compartments of the shelf: runs of upright books, leaning books,
//! stacks, gaps and a few other things.

use glam::{Mat3, Vec3};

use crate::materials::Finish;
use crate::random::Random;
use crate::shapes::{Block, Book, Ellipsoid, Shape, Strand, Vessel};

/// One compartment: between two uprights, above one board and below the next.
#[derive(Debug, Clone, Copy)]
pub struct Compartment {
    /// The left upright's right face.
    pub left: f32,
    /// The right upright's left face.
    pub right: f32,
    /// The top of the board below.
    pub floor: f32,
    /// The clear height.
    pub clear: f32,
    /// The front edges of the boards.
    pub front: f32,
}

/// Something other than upright books, standing in a compartment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Accent {
    /// A pot with a leafy plant.
    Plant,
    /// A small globe on a foot.
    Globe,
    /// A vase.
    Vase,
    /// A paper-covered box.
    Carton,
    /// A pile of lying books.
    Stack,
    /// Nothing: a gap, against which books lean.
    Gap,
}

impl Accent {
    /// How much of the board it takes.
    fn width(self) -> f32 {
        match self {
            Self::Plant => 14.5,
            Self::Globe => 15.0,
            Self::Vase => 10.0,
            Self::Carton => 15.0,
            Self::Stack => 24.5,
            Self::Gap => 1.0,
        }
    }
}

/// What the next few upright books have in common.
struct Series {
    seed: u32,
    half: Vec3,
    recess: f32,
    left: u32,
}

impl Series {
    /// Draws a single book or, now and then, a set in one binding.
    fn draw(random: &mut Random, clear: f32) -> Self {
        let set = random.chance(0.2);
        let thick =
            if random.chance(0.3) { random.range(3.0, 5.0) } else { random.range(1.5, 3.1) };
        let tallest = (clear - 1.0).min(24.3);
        let tall = tallest * (1.0 - 0.27 * random.unit().powf(1.5));
        Self {
            seed: random.bits(),
            half: Vec3::new(0.5 * thick, 0.5 * tall, 0.5 * random.range(13.0, 18.0)),
            recess: random.range(1.0, 3.2),
            left: if set { 3 + random.bits() % 4 } else { 1 },
        }
    }
}

/// An upright or leaning book with its lower left spine corner at `corner`,
/// its head tipped to the left by `lean` radians.
fn upright(corner: Vec3, half: Vec3, lean: f32, bulge: f32, seed: u32) -> Shape {
    let axes = Mat3::from_rotation_z(lean);
    let centre = corner + axes * Vec3::new(half.x, half.y, -half.z);
    Shape::Book(Book { centre, half, axes, bulge, seed })
}

impl Compartment {
    /// Fills the compartment, with the accents in order at random places.
    pub fn fill(&self, seed: u32, accents: &[Accent], shapes: &mut Vec<Shape>) {
        let random = &mut Random::new(seed);
        let mut x = self.left + random.range(0.1, 0.5);
        let taken: f32 = accents.iter().map(|a| a.width()).sum();
        let run = (self.right - self.left - taken) / (accents.len() + 1) as f32;
        for &accent in accents {
            let until = x + run * random.range(0.85, 1.15);
            x = self.books(random, x, until, shapes);
            if accent == Accent::Gap || random.chance(0.35) {
                x = self.leaning(random, x, shapes);
            }
            let room = accent.width().min(self.right - x);
            self.place(random, accent, x, shapes);
            x += room;
        }
        self.books(random, x, self.right, shapes);
    }

    /// Upright books from `x` until no more fit before `until`.
    fn books(&self, random: &mut Random, mut x: f32, until: f32, shapes: &mut Vec<Shape>) -> f32 {
        let mut series = Series::draw(random, self.clear);
        loop {
            if series.left == 0 {
                series = Series::draw(random, self.clear);
            }
            // What does not fit gives way to something thinner, if anything.
            let room = 0.5 * (until - x);
            if series.half.x > room {
                if room < 0.8 {
                    return x;
                }
                series = Series::draw(random, self.clear);
                series.half.x = series.half.x.min(room);
            }
            let bulge = series.half.x * random.range(0.12, 0.3);
            let recess = series.recess + random.range(0.0, 0.25);
            let corner = Vec3::new(x, self.floor, self.front - recess);
            shapes.push(upright(corner, series.half, 0.0, bulge, series.seed));
            x += 2.0 * series.half.x + random.range(0.02, 0.14);
            series.left -= 1;
        }
    }

    /// One or two books leaning to the left against what stands there.
    fn leaning(&self, random: &mut Random, x: f32, shapes: &mut Vec<Shape>) -> f32 {
        let mut foot = x;
        let lean = random.range(0.09, 0.2);
        for _ in 0..1 + random.bits() % 2 {
            let series = Series::draw(random, self.clear - 1.2);
            let half = Vec3::new(series.half.x.min(1.3), series.half.y, series.half.z);
            let slide = if foot > x { 0.1 } else { 2.0 * half.y * lean.sin() };
            foot += slide;
            if foot + 2.0 * half.x > self.right - 0.5 {
                return foot;
            }
            let corner = Vec3::new(foot, self.floor, self.front - series.recess);
            shapes.push(upright(corner, half, lean, 0.2 * half.x, series.seed));
            foot += 2.0 * half.x / lean.cos();
        }
        foot + 0.3
    }

    /// Puts an accent at `x`.
    fn place(&self, random: &mut Random, accent: Accent, x: f32, shapes: &mut Vec<Shape>) {
        let middle = Vec3::new(x + 0.5 * accent.width(), self.floor, self.front - 9.0);
        match accent {
            Accent::Gap => {}
            Accent::Stack => self.stack(random, x + 0.4, shapes),
            Accent::Vase => shapes.push(Shape::Vessel(Vessel {
                foot: middle,
                height: 17.5,
                profile: [2.6, 4.3, 3.6, 1.7, 2.5],
                finish: Finish::Glaze(Vec3::new(0.09, 0.23, 0.33)),
            })),
            Accent::Globe => globe(middle, shapes),
            Accent::Carton => {
                let half = Vec3::new(6.9, 5.6, 8.0);
                let finish = Finish::Carton(Vec3::new(0.30, 0.38, 0.36));
                let axes = Mat3::IDENTITY;
                let centre = middle + Vec3::Y * half.y;
                shapes.push(Shape::Block(Block { centre, half, axes, bevel: 0.15, finish }));
                let lid = Vec3::new(7.15, 1.3, 8.25);
                let centre = middle + Vec3::Y * (2.0 * half.y - 0.6);
                shapes.push(Shape::Block(Block { centre, half: lid, axes, bevel: 0.15, finish }));
                let half = Vec3::new(2.2, 1.1, 0.06);
                let centre = middle + Vec3::new(0.0, 4.6, 8.06);
                let finish = Finish::Paint(Vec3::new(0.68, 0.62, 0.48));
                shapes.push(Shape::Block(Block { centre, half, axes, bevel: 0.05, finish }));
            }
            Accent::Plant => plant(random, middle, shapes),
        }
    }

    /// A pile of lying books with its left edge at `x`.
    pub fn stack(&self, random: &mut Random, x: f32, shapes: &mut Vec<Shape>) {
        let mut y = self.floor;
        let across = Mat3::from_cols(Vec3::Y, Vec3::NEG_X, Vec3::Z);
        for level in 0..3 + random.bits() % 3 {
            let long = (23.6 - 0.9 * level as f32 - random.range(0.0, 2.0)).max(15.0);
            let half = Vec3::new(random.range(0.9, 2.0), 0.5 * long, random.range(6.5, 8.5));
            let shift = random.range(0.0, 23.6 - long) + 0.5 * long;
            let recess = random.range(1.2, 2.6) + half.z;
            let centre = Vec3::new(x + shift, y + half.x, self.front - recess);
            let axes = Mat3::from_rotation_y(random.range(-0.05, 0.05)) * across;
            let bulge = 0.2 * half.x;
            shapes.push(Shape::Book(Book { centre, half, axes, bulge, seed: random.bits() }));
            y += 2.0 * half.x + 0.02;
        }
    }
}

/// A globe on a wooden foot, standing at `middle`.
pub fn globe(middle: Vec3, shapes: &mut Vec<Shape>) {
    let foot = Finish::Wood { along: 0, tone: Vec3::new(0.22, 0.10, 0.05), seed: 77 };
    let profile = [4.2, 3.4, 1.0, 0.8, 1.1];
    shapes.push(Shape::Vessel(Vessel { foot: middle, height: 5.0, profile, finish: foot }));
    let centre = middle + Vec3::Y * 12.0;
    let axes = Mat3::from_rotation_z(-0.4) * Mat3::from_rotation_y(0.7);
    let radii = Vec3::splat(6.6);
    shapes.push(Shape::Ellipsoid(Ellipsoid { centre, radii, axes, finish: Finish::Globe }));
    // The brass meridian, a half ring of short rods.
    let spin = Mat3::from_rotation_z(-0.4);
    let on = |k: i32| {
        let angle = -1.57 + 0.157 * k as f32;
        centre + spin * Vec3::new(7.1 * angle.cos(), 7.1 * angle.sin(), 0.0)
    };
    for k in 0..20 {
        let (start, end) = (on(k), on(k + 1));
        let bar = Strand { start, end, radius: 0.3, finish: Finish::Brass };
        shapes.push(Shape::Strand(bar));
    }
}

/// A potted plant standing at `middle`.
pub fn plant(random: &mut Random, middle: Vec3, shapes: &mut Vec<Shape>) {
    let finish = Finish::Glaze(Vec3::new(0.62, 0.56, 0.47));
    let profile = [3.3, 4.0, 4.5, 4.8, 4.9];
    shapes.push(Shape::Vessel(Vessel { foot: middle, height: 7.6, profile, finish }));
    for _ in 0..46 {
        let out =
            Vec3::new(random.range(-1.0, 1.0), random.range(0.1, 1.5), random.range(-0.8, 1.0));
        let reach = random.range(3.5, 7.2);
        let out = out.normalize();
        let tip = middle + Vec3::Y * 8.0 + out * reach * Vec3::new(0.85, 1.25, 0.8);
        let along = (out + Vec3::new(0.0, -0.35, 0.25) + 0.3 * random.in_cube()).normalize();
        let flat = (Vec3::new(0.0, 0.8, 0.9) + 0.5 * random.in_cube()).normalize();
        let side = along.cross(flat).normalize_or(Vec3::X);
        let axes = Mat3::from_cols(side, along, side.cross(along));
        let radii = Vec3::new(random.range(0.9, 1.5), random.range(1.8, 2.7), 0.09);
        let finish = Finish::Leaf(random.range(0.7, 1.5));
        shapes.push(Shape::Ellipsoid(Ellipsoid { centre: tip, radii, axes, finish }));
        let stem = Strand {
            start: middle + Vec3::Y * 6.5,
            end: tip,
            radius: 0.12,
            finish: Finish::Leaf(0.8),
        };
        shapes.push(Shape::Strand(stem));
    }
}
