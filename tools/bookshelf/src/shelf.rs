//! The room behind the person: the bookcase with its boards, uprights,
//! cornice and cabinet, and the wall above it.

use glam::{Mat3, Vec3};

use crate::books::Accent::{Carton, Gap, Globe, Plant, Stack, Vase};
use crate::books::{Accent, Compartment};
use crate::materials::Finish;
use crate::room::FILLED;
use crate::shapes::{Block, Ellipsoid, Shape};

/// Where the boards' front edges are, behind the person.
pub const FRONT: f32 = -28.0;
/// Where the back panel is.
pub const BACK: f32 = -53.0;
/// Heights of the middles of the boards, from the top one down.
pub const BOARDS: [f32; 5] = [57.5, 29.5, 1.5, -26.5, -54.5];
/// Half the thickness of a board.
pub const HALF_BOARD: f32 = 1.15;
/// Places of the middles of the uprights.
pub const UPRIGHTS: [f32; 4] = [-97.0, -33.0, 33.0, 97.0];
/// Half the width of an upright.
pub const HALF_UPRIGHT: f32 = 1.2;

/// Honey-coloured oak.
pub const OAK: Vec3 = Vec3::new(0.47, 0.285, 0.145);

/// Adds a block between two corners.
pub fn block(shapes: &mut Vec<Shape>, low: Vec3, high: Vec3, bevel: f32, finish: Finish) {
    let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
    shapes.push(Shape::Block(Block { centre, half, axes: Mat3::IDENTITY, bevel, finish }));
}

/// A horizontal length of wood across the whole picture.
fn rail(shapes: &mut Vec<Shape>, low: f32, high: f32, front: f32, seed: u32) {
    let finish = Finish::Wood { along: 0, tone: OAK, seed };
    block(shapes, Vec3::new(-100.0, low, BACK), Vec3::new(100.0, high, front), 0.16, finish);
}

/// What stands in each compartment besides books; rows from the top down.
const ACCENTS: [[&[Accent]; 3]; 4] = [
    [&[Stack], &[Gap, Carton], &[Vase]],
    [&[Plant], &[Gap, Gap], &[Globe]],
    [&[Gap], &[Gap, Vase], &[Gap]],
    [&[Carton], &[Gap, Gap], &[Stack]],
];

/// Adds the bookcase, its books, and the room.
pub fn furnish(shapes: &mut Vec<Shape>) {
    for (k, &y) in BOARDS.iter().enumerate() {
        rail(shapes, y - HALF_BOARD, y + HALF_BOARD, FRONT, 100 + k as u32);
    }
    for (k, &x) in UPRIGHTS.iter().enumerate() {
        let finish = Finish::Wood { along: 1, tone: OAK * 0.93, seed: 200 + k as u32 };
        let low = Vec3::new(x - HALF_UPRIGHT, -90.0, BACK);
        block(shapes, low, Vec3::new(x + HALF_UPRIGHT, 57.0, FRONT - 0.35), 0.16, finish);
    }
    // Tongue-and-groove back, one plank a time so that its joints show.
    for k in 0..25 {
        let x = -100.0 + 8.0 * k as f32;
        let finish = Finish::Wood { along: 1, tone: OAK * 0.85, seed: 300 + k };
        let low = Vec3::new(x + 0.04, -90.0, BACK - 1.0);
        block(shapes, low, Vec3::new(x + 7.96, 58.0, BACK), 0.25, finish);
    }
    fill(shapes);
    cornice(shapes);
    cabinet(shapes);
    let paint = Finish::Paint(Vec3::new(0.36, 0.43, 0.38));
    let low = Vec3::new(-400.0, -300.0, BACK - 6.0);
    block(shapes, low, Vec3::new(400.0, 300.0, BACK - 2.0), 0.0, paint);
    let white = Finish::Paint(Vec3::new(0.66, 0.64, 0.58));
    for (low, high, out) in [(75.2, 76.0, 1.2), (76.0, 78.5, 2.2), (78.5, 90.0, 3.4)] {
        let low = Vec3::new(-400.0, low, BACK - 3.0);
        block(shapes, low, Vec3::new(400.0, high, BACK + out), 0.3, white);
    }
}

/// Fills the compartments.
fn fill(shapes: &mut Vec<Shape>) {
    for (row, accents) in ACCENTS.iter().enumerate() {
        let floor = BOARDS[row + 1] + HALF_BOARD;
        let clear = BOARDS[row] - HALF_BOARD - floor;
        for (bay, accents) in accents.iter().enumerate() {
            // Only what can be seen of the outer bays is filled.
            let left = (UPRIGHTS[bay] + HALF_UPRIGHT).max(-FILLED);
            let right = (UPRIGHTS[bay + 1] - HALF_UPRIGHT).min(FILLED);
            let place = Compartment { left, right, floor, clear, front: FRONT };
            place.fill(40 + 10 * row as u32 + bay as u32, accents, shapes);
        }
    }
}

/// The mouldings at the top of the bookcase.
fn cornice(shapes: &mut Vec<Shape>) {
    for (low, high, out, seed) in [
        (58.65, 60.4, 0.3, 401),
        (60.4, 61.0, 1.3, 402),
        (61.0, 62.2, 2.4, 403),
        (62.2, 63.4, 3.6, 404),
    ] {
        rail(shapes, low, high, FRONT + out, seed);
    }
    // Paper boxes stand on top, set back.
    let top = 63.4;
    for (x, half, tone) in [
        (-44.0, Vec3::new(9.0, 3.4, 7.0), Vec3::new(0.42, 0.20, 0.12)),
        (-43.0, Vec3::new(7.6, 2.0, 6.0), Vec3::new(0.16, 0.24, 0.30)),
        (38.0, Vec3::new(11.0, 4.2, 7.0), Vec3::new(0.50, 0.44, 0.32)),
    ] {
        let lift = if half.x < 8.0 { 6.8 } else { 0.0 };
        let centre = Vec3::new(x, top + lift + half.y, -40.0);
        let finish = Finish::Carton(tone);
        shapes.push(Shape::Block(Block {
            centre,
            half,
            axes: Mat3::IDENTITY,
            bevel: 0.15,
            finish,
        }));
    }
}

/// The cabinet under the lowest board: a ledge and panelled doors.
fn cabinet(shapes: &mut Vec<Shape>) {
    rail(shapes, BOARDS[4] - HALF_BOARD, BOARDS[4] + HALF_BOARD, FRONT + 4.5, 500);
    rail(shapes, -58.0, BOARDS[4] - HALF_BOARD, FRONT + 2.6, 501);
    for k in 0..6_u32 {
        door(shapes, -66.0 + 22.0 * k as f32, 22.0, 510 + 10 * k, k % 2 == 0);
    }
}

/// A panelled door of the cabinet with its left edge at `x`, its knob at the `right` or the left.
pub fn door(shapes: &mut Vec<Shape>, x: f32, width: f32, seed: u32, right: bool) {
    let wood = |along, tone: f32, seed| Finish::Wood { along, tone: OAK * tone, seed };
    let z = FRONT + 2.0;
    let slab = |x0: f32, x1: f32, y0: f32, y1: f32, z1: f32| {
        (Vec3::new(x0, y0, BACK), Vec3::new(x1, y1, z1))
    };
    let (low, high) = slab(x + 0.15, x + (width - 0.15), -95.0, -58.2, z - 0.9);
    block(shapes, low, high, 0.1, wood(1, 0.86, seed));
    for (x0, x1, along, y0, y1) in [
        (x + 0.15, x + 3.4, 1, -95.0, -58.2),
        (x + (width - 3.4), x + (width - 0.15), 1, -95.0, -58.2),
        (x + 3.4, x + (width - 3.4), 0, -61.6, -58.2),
    ] {
        let (low, high) = slab(x0, x1, y0, y1, z);
        block(shapes, low, high, 0.18, wood(along, 0.95, seed + x0 as u32));
    }
    let (low, high) = slab(x + 5.6, x + (width - 5.6), -95.0, -63.8, z - 0.3);
    block(shapes, low, high, 0.5, wood(1, 0.9, seed + 5));
    let side = if right { x + (width - 1.8) } else { x + 1.8 };
    let knob = Ellipsoid {
        centre: Vec3::new(side, -66.0, z + 0.9),
        radii: Vec3::splat(0.95),
        axes: Mat3::IDENTITY,
        finish: Finish::Brass,
    };
    shapes.push(Shape::Ellipsoid(knob));
}
