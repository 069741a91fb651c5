//! Hair, eyebrows and lashes as many thin strands that grow from the head and
//! follow the body of the hair.

use glam::{Vec2, Vec3};

use crate::head::{EYE, EYE_RADIUS, hair, head, opening};
use crate::materials::Finish;
use crate::person::{SCALE, from_head};
use crate::random::{Random, noise};
use crate::shapes::{Shape, Strand};

/// Mean reflectance of the hair, a warm dark brown.
const BROWN: Vec3 = Vec3::new(0.115, 0.060, 0.032);
/// How many locks the hair has.
const LOCKS: usize = 1250;
/// How many strands a lock has.
const STRANDS: usize = 28;
/// Length of a piece of a strand, in life-size centimetres.
const PIECE: f32 = 0.55;
/// Where the parting is, in head coordinates.
const PARTING: f32 = 4.6;

/// The slope of a distance field.
fn slope(field: impl Fn(Vec3) -> f32, p: Vec3) -> Vec3 {
    let e = 0.05;
    let along = |axis: Vec3| field(p + axis * e) - field(p - axis * e);
    Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)).normalize_or(Vec3::Y)
}

/// The direction in which the hair is combed at `p`.
fn combed(p: Vec3, normal: Vec3, whim: Vec3) -> Vec3 {
    let front = ((p.z - 2.0) / 3.0).clamp(0.0, 1.0);
    let top = ((p.y - 6.5 + 4.0 * front) / 3.0).clamp(0.0, 1.0);
    let side = if p.x > PARTING { 1.0 } else { -1.0 };
    let over = Vec3::new(side * (0.9 - 0.1 * front), 0.8 * front, -0.75);
    let down = Vec3::new(0.0, -1.0, -0.55);
    let swirl = 0.3 * Vec3::new(noise(p * 0.28), noise(p * 0.28 + 9.0), noise(p * 0.28 + 18.0));
    let d = down.lerp(over, top) + swirl + 0.22 * whim;
    (d - normal * d.dot(normal)).normalize_or(Vec3::NEG_Y)
}

/// Adds a chain of pieces through `points` (head coordinates), thinning out.
fn chain(points: &[Vec3], radius: f32, tone: Vec3, shapes: &mut Vec<Shape>) {
    let last = points.len() as f32 - 1.0;
    for (k, pair) in points.windows(2).enumerate() {
        let thin = 1.0 - 0.6 * (k as f32 / last).powi(2);
        shapes.push(Shape::Strand(Strand {
            start: from_head(pair[0]),
            end: from_head(pair[1]),
            radius: radius * thin * SCALE,
            finish: Finish::Hair(tone),
        }));
    }
}

/// Grows the given share of all strands.
pub fn grow(share: f32, shapes: &mut Vec<Shape>) {
    let random = &mut Random::new(2024);
    let mut grown = 0;
    while grown < (LOCKS as f32 * share) as usize {
        // A root: where a random ray from inside the skull leaves the hair.
        let way = random.in_cube();
        if !(0.1..1.0).contains(&way.length_squared()) {
            continue;
        }
        let way = way.normalize();
        // Some roots lie on the skin along the hairline, to soften it.
        let border = grown % 4 == 0;
        let ground = |p: Vec3| if border { head(p).skin } else { hair(p) };
        let mut root = Vec3::new(0.0, 3.5, -1.5);
        for _ in 0..40 {
            root -= way * ground(root) * 0.8;
        }
        let fits = if border {
            root.z > 1.0 && root.y > 2.5 && (-0.5..0.12).contains(&hair(root))
        } else {
            head(root).skin > -0.25
        };
        if !fits || ground(root).abs() > 0.05 || root.y < -7.0 {
            continue;
        }
        grown += 1;
        lock(random, root, shapes);
    }
    brows(random, shapes);
    lashes(random, shapes);
}

/// One lock: a leading curve, and strands that gather towards it.
fn lock(random: &mut Random, root: Vec3, shapes: &mut Vec<Shape>) {
    let top = ((root.y - 4.0) / 5.0).clamp(0.0, 1.0);
    let pieces = 4 + (top * random.range(7.0, 13.0)) as usize;
    let whim = random.in_cube();
    let rise = top * random.range(0.1, 0.75) + 0.08;
    let mut p = root;
    let mut lead = vec![root - 0.25 * slope(hair, root)];
    for k in 1..=pieces {
        let normal = slope(hair, p);
        p += combed(p, normal, whim) * PIECE;
        let s = k as f32 / pieces as f32;
        let height = rise * (s * 2.4).sin().max(0.0) + 0.10 * s;
        p -= normal * (hair(p) - height);
        lead.push(p);
    }
    let shade = 1.0 + 0.35 * random.range(-1.0, 1.0);
    for _ in 0..STRANDS {
        let offset = random.in_cube() * Vec3::new(0.65, 0.45, 0.65);
        let gather = random.range(0.35, 0.85);
        let skip = random.range(0.0, 0.25);
        let count = ((1.0 - skip) * lead.len() as f32) as usize;
        let points: Vec<Vec3> = lead
            .iter()
            .take(count.max(3))
            .enumerate()
            .map(|(k, &q)| q + offset * (1.0 - gather * k as f32 / pieces as f32))
            .collect();
        let own = 1.0 + 0.15 * random.range(-1.0, 1.0);
        chain(&points, random.range(0.030, 0.050), BROWN * (shade * own), shapes);
    }
}

/// The eyebrows: short hairs along two arcs, lying on the skin.
fn brows(random: &mut Random, shapes: &mut Vec<Shape>) {
    let skin = |p: Vec3| head(p).skin;
    for side in [-1.0_f32, 1.0] {
        for _ in 0..230 {
            let s = random.unit();
            let thick = 0.50 * (1.0 - s).powf(0.5) * (0.45 + 0.55 * (s * 6.0).min(1.0));
            let arch = 1.95 + 0.75 * (s * 2.3).sin() - 0.35 * s + 0.08 * side;
            let across = random.range(-1.0, 1.0) * thick;
            let mut p = Vec3::new(side * (1.25 + 3.9 * s), arch + across, 9.5 - 2.5 * s);
            let rise = 0.75 * (1.0 - s) - 0.35 * s - 0.3 * across;
            let way = Vec3::new(side, rise, 0.0).normalize();
            let mut points = Vec::new();
            for k in 0..4 {
                for _ in 0..12 {
                    p -= slope(skin, p) * (skin(p) - 0.03 - 0.02 * k as f32) * 0.9;
                }
                points.push(p);
                p += way * 0.22;
            }
            chain(&points, 0.035, BROWN * random.range(0.45, 0.8), shapes);
        }
    }
}

/// The lashes along the upper lids.
fn lashes(random: &mut Random, shapes: &mut Vec<Shape>) {
    for side in [-1.0_f32, 1.0] {
        for k in 0..46 {
            let x = -1.3 + 2.75 * k as f32 / 45.0;
            // The rim: the highest point of the opening above this x.
            let mut y = 1.0;
            while opening(Vec2::new(x, y)) > 0.0 && y > -0.5 {
                y -= 0.01;
            }
            let reach = EYE_RADIUS + 0.14;
            let z = (reach * reach - x * x - y * y).max(0.1).sqrt();
            let rim = EYE + Vec3::new(x, y, z);
            let long = 0.20 + 0.20 * ((x + 1.3) / 2.75) + random.range(-0.05, 0.05);
            let out = Vec3::new(0.45 * x + random.range(-0.08, 0.08), 0.45, 0.75).normalize();
            let points: Vec<Vec3> = (0..4)
                .map(|j| {
                    let s = j as f32 / 3.0;
                    let curl = Vec3::Y * (0.16 * s * s);
                    (rim + out * (long * s) + curl) * Vec3::new(side, 1.0, 1.0)
                })
                .collect();
            chain(&points, 0.034, BROWN * 0.25, shapes);
        }
    }
}
