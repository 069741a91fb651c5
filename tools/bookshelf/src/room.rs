//! The rest of the room, which only the panorama shows: walls, floor and ceiling, the ends of the
//! bookcase, a desk before the person, a window where the fill light comes from, and furniture.

use glam::{Mat3, Vec3};

use crate::books::Accent::{Carton, Gap, Globe, Plant, Stack, Vase};
use crate::books::{Accent, Compartment, globe, plant};
use crate::light::KEY;
use crate::materials::Finish;
use crate::random::Random;
use crate::shapes::{Block, Ellipsoid, Shape, Strand, Vessel};
use crate::shelf::{BACK, BOARDS, FRONT, HALF_BOARD, HALF_UPRIGHT, OAK, UPRIGHTS, block, door};

/// Height of the floor.
pub const FLOOR: f32 = -150.0;
const CEILING: f32 = 250.0;
const LEFT: f32 = -300.0;
const RIGHT: f32 = 265.0;
/// The wall with the door, opposite the bookcase.
const END: f32 = 430.0;
/// The wall behind the bookcase.
const WALL: f32 = BACK - 2.0;

const PAINT: Finish = Finish::Paint(Vec3::new(0.36, 0.43, 0.38));
const WHITE: Finish = Finish::Paint(Vec3::new(0.66, 0.64, 0.58));
const BLACK: Finish = Finish::Paint(Vec3::splat(0.035));
const WALNUT: Vec3 = Vec3::new(0.23, 0.115, 0.06);

/// Up to where the photograph's own geometry is filled, to either side.
pub const FILLED: f32 = 64.0;

/// Whether a point belongs to what the photograph shows, or nearly: it gets the photograph's light.
pub fn in_photograph(p: Vec3) -> bool {
    p.x.abs() < FILLED && p.y > -76.0 && p.z < 20.0
}

/// Walls, floor and ceiling. Light comes through them: the lamps and the glow of the room stand for
/// all that there is beyond the furniture.
pub fn shell() -> Vec<Shape> {
    let mut shapes = Vec::new();
    let s = &mut shapes;
    let v = Vec3::new;
    let low_wall = FLOOR - 2.0;
    block(s, v(LEFT - 9.0, low_wall, WALL), v(LEFT, CEILING, END), 0.0, PAINT);
    block(s, v(LEFT, low_wall, END), v(RIGHT, CEILING, END + 9.0), 0.0, PAINT);
    // The right wall around its window.
    let [[y0, y1], [z0, z1]] = WINDOW;
    for (low, high) in [
        (v(RIGHT, low_wall, WALL), v(RIGHT + 22.0, CEILING, z0)),
        (v(RIGHT, low_wall, z1), v(RIGHT + 22.0, CEILING, END)),
        (v(RIGHT, low_wall, z0), v(RIGHT + 22.0, y0, z1)),
        (v(RIGHT, y1, z0), v(RIGHT + 22.0, CEILING, z1)),
    ] {
        block(s, low, high, 0.0, PAINT);
    }
    let plaster = Finish::Paint(Vec3::new(0.80, 0.78, 0.73));
    block(s, v(LEFT, CEILING, WALL), v(RIGHT, CEILING + 9.0, END), 0.0, plaster);
    mouldings(s);
    // Boards of the floor, two lengths a row.
    let random = &mut Random::new(7001);
    let (mut x, mut row) = (LEFT, 0);
    while x < RIGHT {
        let middle = random.range(60.0, 330.0);
        for (k, (z0, z1)) in [(WALL, middle), (middle, END)].into_iter().enumerate() {
            let tone = OAK * random.range(0.62, 0.80);
            let finish = Finish::Wood { along: 2, tone, seed: 7100 + 2 * row + k as u32 };
            let low = v(x + 0.12, FLOOR - 3.0, z0 + 0.1);
            block(s, low, v(x + 14.0, FLOOR, z1), 0.2, finish);
        }
        x += 14.12;
        row += 1;
    }
    let gap = Finish::Paint(Vec3::splat(0.06));
    block(s, v(LEFT, FLOOR - 4.0, WALL), v(RIGHT, FLOOR - 0.6, END), 0.0, gap);
    shapes
}

/// Height and depth of the window in the right wall.
const WINDOW: [[f32; 2]; 2] = [[-62.0, 165.0], [72.0, 232.0]];

/// The picture rail, which goes on from the photograph, the skirting, and the ceiling's mouldings.
fn mouldings(s: &mut Vec<Shape>) {
    let v = Vec3::new;
    let [[_, y1], [z0, z1]] = WINDOW;
    let profiles = [
        (75.2, 76.0, 4.2),
        (76.0, 78.5, 5.2),
        (78.5, 90.0, 6.4),
        (FLOOR, FLOOR + 14.0, 2.0),
        (FLOOR + 14.0, FLOOR + 16.0, 1.2),
        (CEILING - 4.0, CEILING, 9.0),
        (CEILING - 9.0, CEILING - 4.0, 5.0),
    ];
    for (low, high, out) in profiles {
        // On the wall behind the bookcase, the rail is the photograph's.
        if !(70.0..100.0).contains(&low) {
            block(s, v(LEFT, low, WALL), v(RIGHT, high, WALL + out), 0.3, WHITE);
        }
        let out = out - if (70.0..100.0).contains(&low) { 3.0 } else { 0.0 };
        block(s, v(LEFT, low, WALL), v(LEFT + out, high, END), 0.3, WHITE);
        block(s, v(LEFT, low, END - out), v(RIGHT, high, END), 0.3, WHITE);
        let interrupted = high > WINDOW[0][0] && low < y1;
        let pieces: &[(f32, f32)] =
            if interrupted { &[(WALL, z0 - 9.0), (z1 + 9.0, END)] } else { &[(WALL, END)] };
        for &(z0, z1) in pieces {
            block(s, v(RIGHT - out, low, z0), v(RIGHT, high, z1), 0.3, WHITE);
        }
    }
}

/// Everything that stands and hangs in the room.
pub fn furniture() -> Vec<Shape> {
    let mut shapes = Vec::new();
    let s = &mut shapes;
    bookcase_ends(s);
    desk(s);
    legs(s);
    window(s);
    softbox(s);
    door_of_the_room(s);
    facing_bookcase(s);
    left_wall(s);
    seat(s);
    let v = Vec3::new;
    let rug = Block {
        centre: v(-10.0, FLOOR + 0.4, 235.0),
        half: v(135.0, 0.5, 95.0),
        axes: Mat3::IDENTITY,
        bevel: 0.2,
        finish: Finish::Rug,
    };
    s.push(Shape::Block(rug));
    pendant(s, v(20.0, 168.0, 235.0));
    for (place, size, seed) in [
        (v(222.0, FLOOR, 8.0), 2.3, 31),
        (v(-262.0, FLOOR, 385.0), 2.0, 32),
        (v(-150.0, FLOOR, -22.0), 1.5, 33),
    ] {
        tall_plant(s, place, size, seed);
    }
    // Pictures beside the bookcase.
    for (x, y, half, seed) in [
        (-160.0, 22.0, [26.0, 34.0], 3),
        (-230.0, 26.0, [30.0, 22.0], 4),
        (-226.0, -34.0, [22.0, 28.0], 5),
        (138.0, 30.0, [22.0, 28.0], 6),
        (205.0, 18.0, [32.0, 38.0], 7),
        (138.0, -32.0, [20.0, 24.0], 8),
    ] {
        picture(s, v(x, y, WALL), Mat3::IDENTITY, half, seed);
    }
    // A low chest under the pictures at the right.
    chest(s, v(138.0, FLOOR, WALL), Mat3::IDENTITY, [52.0, 68.0, 38.0], 61);
    vase(s, v(124.0, FLOOR + 68.0, -30.0), 24.0, Vec3::new(0.42, 0.20, 0.10));
    globe(v(152.0, FLOOR + 68.0, -32.0), s);
    shapes
}

/// What the photograph's bookcase lacks: its outer bays, doors, drawers and feet.
fn bookcase_ends(s: &mut Vec<Shape>) {
    let v = Vec3::new;
    let accents: [[&[Accent]; 2]; 4] =
        [[&[], &[Gap]], [&[Vase], &[]], [&[Gap], &[Plant]], [&[], &[Carton]]];
    for (row, accents) in accents.iter().enumerate() {
        let floor = BOARDS[row + 1] + HALF_BOARD;
        let clear = BOARDS[row] - HALF_BOARD - floor;
        let bays = [(UPRIGHTS[0] + HALF_UPRIGHT, -FILLED), (FILLED, UPRIGHTS[3] - HALF_UPRIGHT)];
        for (bay, ((left, right), accents)) in bays.into_iter().zip(accents).enumerate() {
            let place = Compartment { left, right, floor, clear, front: FRONT };
            place.fill(240 + 10 * row as u32 + bay as u32, accents, s);
        }
    }
    for (k, (x, width)) in
        [(-100.0, 12.0), (-88.0, 22.0), (66.0, 22.0), (88.0, 12.0)].into_iter().enumerate()
    {
        door(s, x, width, 640 + 10 * k as u32, k % 2 == 0);
    }
    let wood = |along, tone: f32, seed| Finish::Wood { along, tone: OAK * tone, seed };
    let front = FRONT + 2.0;
    block(s, v(-100.0, -98.0, BACK), v(100.0, -95.0, front + 0.6), 0.16, wood(0, 1.0, 700));
    block(s, v(-99.0, FLOOR, BACK), v(99.0, -98.0, front - 1.2), 0.1, wood(0, 0.7, 701));
    block(s, v(-100.0, FLOOR, BACK), v(100.0, FLOOR + 8.0, front + 0.9), 0.16, wood(0, 0.95, 702));
    for k in 0..6_u32 {
        let x = -99.0 + 33.0 * k as f32;
        for (y0, y1, seed) in [(-119.0, -98.4, 710), (FLOOR + 8.4, -119.6, 730)] {
            block(s, v(x + 0.3, y0, BACK), v(x + 32.7, y1, front), 0.3, wood(0, 0.9, seed + k));
            let knob = Ellipsoid {
                centre: v(x + 16.5, 0.5 * (y0 + y1), front + 0.9),
                radii: Vec3::splat(1.1),
                axes: Mat3::IDENTITY,
                finish: Finish::Brass,
            };
            s.push(Shape::Ellipsoid(knob));
        }
    }
    // The sides.
    for x in [-100.0, 98.6] {
        block(s, v(x, FLOOR, BACK), v(x + 1.4, 58.6, FRONT - 0.2), 0.16, wood(1, 0.93, 720));
    }
}

/// The desk between the person and the device, over which the latter stands.
fn desk(s: &mut Vec<Shape>) {
    let v = Vec3::new;
    let wood = |along, seed| Finish::Wood { along, tone: WALNUT, seed };
    let top = -77.0;
    block(s, v(-88.0, top - 3.5, 17.0), v(88.0, top, 96.0), 0.5, wood(0, 800));
    block(s, v(-84.0, top - 12.0, 20.0), v(84.0, top - 3.5, 93.0), 0.2, wood(0, 801));
    for x in [-84.0, 46.0] {
        block(s, v(x, FLOOR + 4.0, 20.0), v(x + 38.0, top - 12.0, 93.0), 0.2, wood(1, 802));
        for k in 0..3 {
            let y = FLOOR + 6.0 + 17.5 * k as f32;
            block(s, v(x + 2.0, y, 92.0), v(x + 36.0, y + 16.0, 94.4), 0.4, wood(0, 803 + k));
            block(s, v(x + 14.0, y + 7.0, 94.4), v(x + 24.0, y + 8.6, 96.2), 0.3, Finish::Brass);
        }
    }
    block(s, v(-50.0, FLOOR + 20.0, 20.0), v(50.0, top - 12.0, 22.0), 0.2, wood(0, 810));
    // A blotter, sheets, and what lies on it.
    block(
        s,
        v(-36.0, top, 34.0),
        v(36.0, top + 0.3, 88.0),
        0.1,
        Finish::Paint(v(0.07, 0.13, 0.10)),
    );
    for (k, (x, z, turn)) in
        [(-14.0, 62.0, 0.12_f32), (11.0, 58.0, -0.2), (13.0, 64.0, 0.05), (44.0, 64.0, 0.5)]
            .into_iter()
            .enumerate()
    {
        s.push(Shape::Block(Block {
            centre: v(x, top + 0.4 + 0.1 * k as f32, z),
            half: v(10.5, 0.06, 14.8),
            axes: Mat3::from_rotation_y(turn),
            bevel: 0.0,
            finish: Finish::Letter,
        }));
    }
    let pen = Strand {
        start: v(-4.0, top + 1.2, 72.0),
        end: v(7.0, top + 1.2, 79.0),
        radius: 0.5,
        finish: Finish::Brass,
    };
    s.push(Shape::Strand(pen));
    let mug = Vessel {
        foot: v(-46.0, top, 62.0),
        height: 9.5,
        profile: [3.6, 4.1, 4.2, 4.2, 4.3],
        finish: Finish::Glaze(v(0.55, 0.20, 0.08)),
    };
    s.push(Shape::Vessel(mug));
    stack_of_books(s, v(52.0, top, 78.0), 860);
    // The lamp of the desk.
    let foot = v(-68.0, top, 74.0);
    s.push(Shape::Vessel(Vessel {
        foot,
        height: 2.6,
        profile: [8.5, 8.6, 7.6, 5.0, 1.2],
        finish: Finish::Brass,
    }));
    let shade = foot + v(0.0, 33.0, 0.0);
    s.push(Shape::Strand(Strand { start: foot, end: shade, radius: 0.7, finish: Finish::Brass }));
    s.push(Shape::Vessel(Vessel {
        foot: shade,
        height: 14.0,
        profile: [12.5, 11.6, 10.2, 8.4, 5.6],
        finish: Finish::Glaze(v(0.03, 0.20, 0.12)),
    }));
    plant(&mut Random::new(77), v(-24.0, top, 91.0), s);
}

/// The person's legs, from where the photograph's own end.
fn legs(s: &mut Vec<Shape>) {
    let v = Vec3::new;
    for side in [-1.0, 1.0] {
        let (start, end) = (v(6.9 * side, -86.0, -3.0), v(7.4 * side, FLOOR, -3.5));
        let finish = Finish::Paint(v(0.075, 0.080, 0.105));
        s.push(Shape::Strand(Strand { start, end, radius: 6.7, finish }));
        let (centre, radii) = (v(8.0 * side, FLOOR + 3.0, 3.0), v(5.0, 4.5, 13.0));
        let finish = Finish::Glaze(v(0.05, 0.03, 0.02));
        s.push(Shape::Ellipsoid(Ellipsoid { centre, radii, axes: Mat3::IDENTITY, finish }));
    }
}

fn stack_of_books(s: &mut Vec<Shape>, place: Vec3, seed: u32) {
    let pile = Compartment { left: 0.0, right: 30.0, floor: 0.0, clear: 28.0, front: 0.0 };
    let mut books = Vec::new();
    pile.stack(&mut Random::new(seed), 0.0, &mut books);
    s.extend(books.iter().map(|b| moved(b, Mat3::from_rotation_y(0.25), place)));
}

/// The window, and the curtains beside it.
fn window(s: &mut Vec<Shape>) {
    let v = Vec3::new;
    let [[y0, y1], [z0, z1]] = WINDOW;
    block(s, v(RIGHT + 16.0, y0, z0), v(RIGHT + 17.0, y1, z1), 0.0, Finish::Daylight);
    let bar = |s: &mut Vec<Shape>, ya, yb, za, zb, out: f32| {
        block(s, v(RIGHT + 10.0 - out, ya, za), v(RIGHT + 16.0, yb, zb), 0.5, WHITE);
    };
    let (mid, cross) = (0.5 * (z0 + z1), y1 - 70.0);
    for (ya, yb, za, zb, out) in [
        (y0, y1, z0, z0 + 7.0, 0.0),
        (y0, y1, z1 - 7.0, z1, 0.0),
        (y0, y0 + 8.0, z0, z1, 0.0),
        (y1 - 7.0, y1, z0, z1, 0.0),
        (y0, y1, mid - 5.0, mid + 5.0, 1.5),
        (cross - 4.0, cross + 4.0, z0, z1, 1.0),
        (0.5 * (y0 + cross) - 1.3, 0.5 * (y0 + cross) + 1.3, z0, z1, -2.0),
    ] {
        bar(s, ya, yb, za, zb, out);
    }
    // The frame on the wall, and the sill.
    for (ya, yb, za, zb) in
        [(y0, y1, z0 - 9.0, z0), (y0, y1, z1, z1 + 9.0), (y1, y1 + 10.0, z0 - 9.0, z1 + 9.0)]
    {
        block(s, v(RIGHT - 2.0, ya, za), v(RIGHT + 16.0, yb, zb), 0.5, WHITE);
    }
    block(s, v(RIGHT - 14.0, y0 - 4.0, z0 - 14.0), v(RIGHT + 17.0, y0, z1 + 14.0), 0.6, WHITE);
    // The radiator below.
    for k in 0..22 {
        let z = z0 + 12.0 + 6.4 * k as f32;
        let (start, end) = (v(RIGHT - 7.0, FLOOR + 14.0, z), v(RIGHT - 7.0, y0 - 16.0, z));
        s.push(Shape::Strand(Strand { start, end, radius: 2.7, finish: WHITE }));
    }
    let pole = Strand {
        start: v(RIGHT - 9.0, y1 + 22.0, z0 - 52.0),
        end: v(RIGHT - 9.0, y1 + 22.0, z1 + 52.0),
        radius: 1.6,
        finish: Finish::Brass,
    };
    s.push(Shape::Strand(pole));
    let random = &mut Random::new(9100);
    for (from, count) in [(z0 - 46.0, 9), (z1 + 2.0, 9)] {
        for k in 0..count {
            let z = from + 5.2 * k as f32 + random.range(-0.7, 0.7);
            let x = RIGHT - 9.0 + random.range(-2.2, 2.2);
            let (start, end) = (v(x, FLOOR + 3.0, z), v(x + random.range(-1.0, 1.0), y1 + 20.0, z));
            let cloth = Finish::Paint(v(0.40, 0.19, 0.10) * random.range(0.9, 1.1));
            s.push(Shape::Strand(Strand { start, end, radius: 3.7, finish: cloth }));
        }
    }
    for (z, seed) in [(96.0, 41), (208.0, 42)] {
        plant(&mut Random::new(seed), v(RIGHT - 5.0, y0, z), s);
    }
}

/// The main light, as the thing that it is.
fn softbox(s: &mut Vec<Shape>) {
    let (across, upward) = (KEY.across.normalize(), KEY.upward.normalize());
    let axes = Mat3::from_cols(across, upward, across.cross(upward));
    let (wide, high) = (KEY.across.length(), KEY.upward.length());
    let mut panel = |depth: f32, half: Vec3, finish| {
        let centre = KEY.centre + axes.z_axis * depth;
        s.push(Shape::Block(Block { centre, half, axes, bevel: 0.0, finish }));
    };
    panel(4.0, Vec3::new(wide, high, 0.5), Finish::Glow(Vec3::new(2.1, 2.05, 1.95)));
    panel(9.0, Vec3::new(wide + 4.0, high + 4.0, 4.4), BLACK);
    panel(22.0, Vec3::new(0.6 * wide, 0.6 * high, 9.0), BLACK);
    panel(38.0, Vec3::new(10.0, 10.0, 12.0), BLACK);
    let head = KEY.centre + axes.z_axis * 38.0;
    let foot = Vec3::new(head.x, FLOOR + 60.0, head.z);
    let mut rod = |start, end| {
        s.push(Shape::Strand(Strand { start, end, radius: 1.4, finish: BLACK }));
    };
    rod(head, foot);
    for angle in [0.4_f32, 2.5, 4.6] {
        rod(foot, Vec3::new(foot.x + 42.0 * angle.cos(), FLOOR + 1.0, foot.z + 42.0 * angle.sin()));
    }
}

/// The door, in the wall opposite the bookcase.
fn door_of_the_room(s: &mut Vec<Shape>) {
    let v = Vec3::new;
    let (x0, x1, top) = (-120.0, -24.0, 62.0);
    block(s, v(x0 - 12.0, FLOOR, END - 4.0), v(x0, top + 12.0, END), 0.5, WHITE);
    block(s, v(x1, FLOOR, END - 4.0), v(x1 + 12.0, top + 12.0, END), 0.5, WHITE);
    block(s, v(x0, top, END - 4.0), v(x1, top + 12.0, END), 0.5, WHITE);
    let leaf = Finish::Paint(v(0.60, 0.58, 0.52));
    block(s, v(x0 + 0.5, FLOOR + 0.6, END - 1.0), v(x1 - 0.5, top - 0.5, END), 0.2, leaf);
    // Stiles and rails stand before the panels.
    let mut stile =
        |xa, xb, ya, yb| block(s, v(xa, ya, END - 2.6), v(xb, yb, END - 1.0), 0.7, leaf);
    for (xa, xb) in [(x0 + 0.5, x0 + 13.0), (x1 - 13.0, x1 - 0.5), (-77.0, -67.0)] {
        stile(xa, xb, FLOOR + 0.6, top - 0.5);
    }
    for (ya, yb) in
        [(FLOOR + 0.6, FLOOR + 22.0), (-66.0, -52.0), (24.0, 34.0), (top - 12.0, top - 0.5)]
    {
        stile(x0 + 0.5, x1 - 0.5, ya, yb);
    }
    let start = v(x1 - 7.0, -50.0, END - 7.0);
    s.push(Shape::Strand(Strand {
        start,
        end: start + v(-12.0, 0.0, 0.0),
        radius: 1.0,
        finish: Finish::Brass,
    }));
    s.push(Shape::Strand(Strand {
        start,
        end: start + v(0.0, 0.0, 7.0),
        radius: 1.0,
        finish: Finish::Brass,
    }));
    // A clock over it, a switch beside it, pictures on either side.
    let disc = |centre, radius: f32, thick, finish| {
        Shape::Ellipsoid(Ellipsoid {
            centre,
            radii: v(radius, radius, thick),
            axes: Mat3::IDENTITY,
            finish,
        })
    };
    let middle = v(-72.0, 120.0, END - 1.0);
    s.push(disc(middle, 20.0, 4.0, Finish::Wood { along: 0, tone: WALNUT, seed: 91 }));
    s.push(disc(middle - v(0.0, 0.0, 1.5), 16.5, 4.0, Finish::Paint(v(0.70, 0.67, 0.58))));
    for (angle, long) in [(0.9_f32, 12.5), (-1.1, 9.0)] {
        let end = middle + v(long * angle.sin(), long * angle.cos(), -5.6);
        s.push(Shape::Strand(Strand {
            start: middle - v(0.0, 0.0, 5.6),
            end,
            radius: 0.6,
            finish: BLACK,
        }));
    }
    block(s, v(-6.0, -42.0, END - 1.2), v(3.0, -33.0, END), 0.4, WHITE);
    let facing = Mat3::from_rotation_y(std::f32::consts::PI);
    picture(s, v(-205.0, 10.0, END), facing, [38.0, 30.0], 11);
    picture(s, v(32.0, 16.0, END), facing, [20.0, 27.0], 12);
    chest(s, v(-205.0, FLOOR, END), facing, [60.0, 76.0, 42.0], 63);
    vase(s, v(-225.0, FLOOR + 76.0, END - 22.0), 30.0, v(0.10, 0.22, 0.30));
    stack_of_books(s, v(-200.0, FLOOR + 76.0, END - 12.0), 861);
}

/// A second bookcase, right of the door for who has come in.
fn facing_bookcase(s: &mut Vec<Shape>) {
    let v = Vec3::new;
    let mut own = Vec::new();
    let (half, high, deep) = (82.0, 196.0, 30.0);
    let wood = |along, seed| Finish::Wood { along, tone: OAK * 0.9, seed };
    block(&mut own, v(-half, 0.0, 0.0), v(half, high, 1.5), 0.2, wood(1, 900));
    for x in [-half, -1.2, half - 2.4] {
        block(&mut own, v(x, 0.0, 0.0), v(x + 2.4, high, deep - 0.4), 0.2, wood(1, 901));
    }
    let boards = [8.0, 42.0, 73.0, 104.0, 135.0, 166.0, 196.0];
    for (k, &y) in boards.iter().enumerate() {
        block(&mut own, v(-half, y, 0.0), v(half, y + 2.4, deep), 0.2, wood(0, 910 + k as u32));
    }
    block(&mut own, v(-half, 0.0, 0.0), v(half, 8.0, deep - 2.0), 0.2, wood(0, 920));
    block(
        &mut own,
        v(-half - 2.0, high + 2.4, 0.0),
        v(half + 2.0, high + 6.0, deep + 2.0),
        0.4,
        wood(0, 921),
    );
    let accents: [[&[Accent]; 2]; 6] = [
        [&[Carton, Stack], &[Stack]],
        [&[Gap], &[Carton, Gap]],
        [&[], &[Globe]],
        [&[Plant], &[Gap]],
        [&[Gap, Vase], &[Stack]],
        [&[Stack, Gap], &[Gap, Plant]],
    ];
    for (row, accents) in accents.iter().enumerate() {
        let floor = boards[row] + 2.4;
        let clear = boards[row + 1] - floor;
        for (bay, accents) in accents.iter().enumerate() {
            let left = if bay == 0 { 2.4 - half } else { 1.2 };
            let place = Compartment { left, right: left + half - 3.6, floor, clear, front: deep };
            place.fill(330 + 10 * row as u32 + bay as u32, accents, &mut own);
        }
    }
    let facing = Mat3::from_rotation_y(std::f32::consts::PI);
    s.extend(own.iter().map(|shape| moved(shape, facing, v(150.0, FLOOR, END))));
}

/// Sideboard and pictures at the left wall.
fn left_wall(s: &mut Vec<Shape>) {
    let v = Vec3::new;
    let inward = Mat3::from_rotation_y(std::f32::consts::FRAC_PI_2);
    chest(s, v(LEFT, FLOOR, 130.0), inward, [95.0, 74.0, 44.0], 62);
    vase(s, v(LEFT + 22.0, FLOOR + 74.0, 60.0), 34.0, v(0.36, 0.30, 0.20));
    vase(s, v(LEFT + 18.0, FLOOR + 74.0, 82.0), 20.0, v(0.12, 0.24, 0.20));
    globe(v(LEFT + 24.0, FLOOR + 74.0, 188.0), s);
    plant(&mut Random::new(55), v(LEFT + 24.0, FLOOR + 74.0, 214.0), s);
    let pile = v(LEFT + 22.0, FLOOR + 74.0, 130.0);
    stack_of_books(s, pile, 862);
    picture(s, v(LEFT, 6.0, 100.0), inward, [46.0, 36.0], 21);
    picture(s, v(LEFT, 12.0, 186.0), inward, [24.0, 30.0], 22);
    picture(s, v(LEFT, 8.0, 262.0), inward, [30.0, 40.0], 23);
    picture(s, v(LEFT, 14.0, 20.0), inward, [20.0, 26.0], 24);
}

/// A chest of drawers with its back on a wall at `place`: half its width, height and depth.
fn chest(s: &mut Vec<Shape>, place: Vec3, axes: Mat3, [half, high, deep]: [f32; 3], seed: u32) {
    let v = Vec3::new;
    let mut own = Vec::new();
    let wood = |along, tone: f32, seed| Finish::Wood { along, tone: WALNUT * tone, seed };
    block(&mut own, v(-half, 10.0, 2.0), v(half, high - 3.0, deep), 0.3, wood(0, 1.2, seed));
    block(
        &mut own,
        v(-half - 2.0, high - 3.0, 2.0),
        v(half + 2.0, high, deep + 2.0),
        0.6,
        wood(0, 1.3, seed + 1),
    );
    for x in [3.0 - half, half - 8.0] {
        for z in [5.0, deep - 6.0] {
            block(&mut own, v(x, 0.0, z), v(x + 5.0, 10.0, z + 5.0), 0.3, wood(1, 1.1, seed + 2));
        }
    }
    let columns = (half / 26.0).round().max(1.0);
    let wide = 2.0 * half / columns;
    for column in 0..columns as u32 {
        let x = wide * column as f32 - half;
        for row in 0..3 {
            let y = 11.0 + (high - 15.0) / 3.0 * row as f32;
            let top = y + (high - 15.0) / 3.0 - 1.2;
            let finish = wood(0, 1.35, 20 * seed + 3 * column + row);
            block(&mut own, v(x + 1.2, y, deep), v(x + wide - 1.2, top, deep + 1.4), 0.4, finish);
            own.push(Shape::Ellipsoid(Ellipsoid {
                centre: v(x + 0.5 * wide, 0.5 * (y + top), deep + 2.6),
                radii: Vec3::splat(1.6),
                axes: Mat3::IDENTITY,
                finish: Finish::Brass,
            }));
        }
    }
    s.extend(own.iter().map(|shape| moved(shape, axes, place)));
}

/// A framed picture on a wall, its middle at `place`; `axes` turn z out of the wall.
fn picture(s: &mut Vec<Shape>, place: Vec3, axes: Mat3, [wide, high]: [f32; 2], seed: u32) {
    let v = Vec3::new;
    let mut own = Vec::new();
    let dark = seed % 2 == 0;
    let frame = if dark { Finish::Brass } else { Finish::Wood { along: 0, tone: WALNUT, seed } };
    for (xa, xb, ya, yb) in [
        (-wide, wide, high - 3.2, high),
        (-wide, wide, -high, 3.2 - high),
        (-wide, 3.2 - wide, -high, high),
        (wide - 3.2, wide, -high, high),
    ] {
        block(&mut own, v(xa, ya, 0.0), v(xb, yb, 3.0), 0.8, frame);
    }
    block(&mut own, v(-wide, -high, 0.0), v(wide, high, 0.8), 0.0, WHITE);
    let inset = if seed % 3 == 0 { 9.0 } else { 3.2 };
    let canvas = Finish::Canvas(seed);
    block(
        &mut own,
        v(inset - wide, inset - high, 0.0),
        v(wide - inset, high - inset, 1.0),
        0.0,
        canvas,
    );
    s.extend(own.iter().map(|shape| moved(shape, axes, place)));
}

/// An armchair and a floor lamp near the window.
fn seat(s: &mut Vec<Shape>) {
    let v = Vec3::new;
    let mut own = Vec::new();
    let cloth = Finish::Paint(v(0.16, 0.23, 0.27));
    block(&mut own, v(-38.0, 14.0, -36.0), v(38.0, 34.0, 38.0), 3.0, cloth);
    block(&mut own, v(-38.0, 14.0, -42.0), v(38.0, 88.0, -24.0), 4.0, cloth);
    for x in [-44.0, 28.0] {
        block(&mut own, v(x, 12.0, -40.0), v(x + 16.0, 58.0, 40.0), 4.0, cloth);
        own.push(Shape::Strand(Strand {
            start: v(x + 8.0, 58.0, -36.0),
            end: v(x + 8.0, 58.0, 36.0),
            radius: 8.0,
            finish: cloth,
        }));
    }
    own.push(Shape::Strand(Strand {
        start: v(-31.0, 88.0, -32.0),
        end: v(31.0, 88.0, -32.0),
        radius: 9.0,
        finish: cloth,
    }));
    let soft = |centre, radii, finish| {
        Shape::Ellipsoid(Ellipsoid { centre, radii, axes: Mat3::IDENTITY, finish })
    };
    own.push(soft(v(0.0, 38.0, 6.0), v(28.0, 9.0, 32.0), cloth));
    own.push(soft(v(6.0, 58.0, -18.0), v(20.0, 19.0, 8.0), Finish::Paint(v(0.52, 0.30, 0.09))));
    for (x, z) in [(-36.0, -36.0), (36.0, -36.0), (-36.0, 34.0), (36.0, 34.0)] {
        let finish = Finish::Wood { along: 1, tone: WALNUT, seed: 950 };
        own.push(Shape::Strand(Strand {
            start: v(x, 0.0, z),
            end: v(x, 14.0, z),
            radius: 2.2,
            finish,
        }));
    }
    let facing = Mat3::from_rotation_y(-2.25);
    s.extend(own.iter().map(|shape| moved(shape, facing, v(188.0, FLOOR, 300.0))));
    // A small round table beside it, and the lamp behind.
    let finish = Finish::Wood { along: 0, tone: WALNUT * 1.3, seed: 951 };
    let foot = v(128.0, FLOOR, 352.0);
    s.push(Shape::Vessel(Vessel {
        foot,
        height: 50.0,
        profile: [16.0, 3.0, 2.4, 2.4, 3.0],
        finish,
    }));
    s.push(Shape::Ellipsoid(Ellipsoid {
        centre: foot + v(0.0, 51.0, 0.0),
        radii: v(26.0, 2.0, 26.0),
        axes: Mat3::IDENTITY,
        finish,
    }));
    vase(s, foot + v(4.0, 53.0, 2.0), 14.0, v(0.50, 0.42, 0.30));
    let foot = v(232.0, FLOOR, 372.0);
    s.push(Shape::Vessel(Vessel {
        foot,
        height: 4.0,
        profile: [15.0, 15.0, 13.0, 6.0, 1.5],
        finish: Finish::Brass,
    }));
    let head = foot + v(0.0, 140.0, 0.0);
    s.push(Shape::Strand(Strand { start: foot, end: head, radius: 1.3, finish: Finish::Brass }));
    s.push(Shape::Vessel(Vessel {
        foot: head,
        height: 30.0,
        profile: [25.0, 22.8, 20.4, 18.0, 15.6],
        finish: Finish::Glow(v(0.95, 0.74, 0.44)),
    }));
}

/// A lamp that hangs from the ceiling.
fn pendant(s: &mut Vec<Shape>, centre: Vec3) {
    let end = Vec3::new(centre.x, CEILING, centre.z);
    s.push(Shape::Strand(Strand { start: centre, end, radius: 0.8, finish: BLACK }));
    s.push(Shape::Ellipsoid(Ellipsoid {
        centre,
        radii: Vec3::new(24.0, 20.0, 24.0),
        axes: Mat3::IDENTITY,
        finish: Finish::Glow(Vec3::new(1.1, 1.0, 0.84)),
    }));
    for lift in [19.5, 80.0] {
        s.push(Shape::Ellipsoid(Ellipsoid {
            centre: centre + Vec3::Y * lift,
            radii: Vec3::new(6.0, 2.5, 6.0),
            axes: Mat3::IDENTITY,
            finish: Finish::Brass,
        }));
    }
}

fn vase(s: &mut Vec<Shape>, foot: Vec3, height: f32, tone: Vec3) {
    let profile = [0.15, 0.25, 0.21, 0.10, 0.14].map(|r| r * height);
    s.push(Shape::Vessel(Vessel { foot, height, profile, finish: Finish::Glaze(tone) }));
}

/// A plant that stands on the floor.
fn tall_plant(s: &mut Vec<Shape>, foot: Vec3, size: f32, seed: u32) {
    let random = &mut Random::new(seed);
    let pot = Finish::Glaze(Vec3::new(0.50, 0.36, 0.25));
    let profile = [7.5, 9.0, 10.2, 11.0, 11.4].map(|r| r * 0.55 * size);
    s.push(Shape::Vessel(Vessel { foot, height: 11.0 * size, profile, finish: pot }));
    let crown = foot + Vec3::Y * 10.0 * size;
    for _ in 0..60 {
        let out =
            Vec3::new(random.range(-1.0, 1.0), random.range(0.5, 2.6), random.range(-0.8, 1.0));
        let tip =
            crown + out.normalize() * random.range(16.0, 36.0) * size * Vec3::new(0.7, 1.1, 0.7);
        let along =
            (out.normalize() + Vec3::new(0.0, -0.5, 0.0) + 0.4 * random.in_cube()).normalize();
        let side = along.cross(Vec3::Y + 0.4 * random.in_cube()).normalize_or(Vec3::X);
        let axes = Mat3::from_cols(side, along, side.cross(along));
        let radii = Vec3::new(random.range(2.0, 3.4), random.range(5.5, 8.5), 0.12) * size;
        let finish = Finish::Leaf(random.range(0.7, 1.5));
        s.push(Shape::Ellipsoid(Ellipsoid { centre: tip, radii, axes, finish }));
        s.push(Shape::Strand(Strand {
            start: crown,
            end: tip,
            radius: 0.3 * size,
            finish: Finish::Leaf(0.8),
        }));
    }
}

/// A shape turned about the origin and moved.
fn moved(shape: &Shape, turn: Mat3, by: Vec3) -> Shape {
    let mut shape = shape.clone();
    match &mut shape {
        Shape::Block(b) => (b.centre, b.axes) = (turn * b.centre + by, turn * b.axes),
        Shape::Book(b) => (b.centre, b.axes) = (turn * b.centre + by, turn * b.axes),
        Shape::Ellipsoid(e) => (e.centre, e.axes) = (turn * e.centre + by, turn * e.axes),
        Shape::Vessel(v) => v.foot = turn * v.foot + by,
        Shape::Strand(s) => (s.start, s.end) = (turn * s.start + by, turn * s.end + by),
    }
    shape
}
