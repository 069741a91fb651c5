//! The look of a book: cloth or leather, bands, labels and invented
//! lettering on its spine, and the leaves between the covers.

use glam::{Vec2, Vec3};

use crate::random::{Random, hash2, noise, unit};

/// Cover colours.
const CLOTH: [Vec3; 18] = [
    Vec3::new(0.290, 0.045, 0.040),
    Vec3::new(0.045, 0.085, 0.190),
    Vec3::new(0.050, 0.140, 0.095),
    Vec3::new(0.560, 0.330, 0.065),
    Vec3::new(0.640, 0.560, 0.420),
    Vec3::new(0.055, 0.055, 0.065),
    Vec3::new(0.330, 0.120, 0.050),
    Vec3::new(0.130, 0.240, 0.330),
    Vec3::new(0.470, 0.120, 0.070),
    Vec3::new(0.700, 0.660, 0.580),
    Vec3::new(0.190, 0.090, 0.150),
    Vec3::new(0.085, 0.230, 0.230),
    Vec3::new(0.230, 0.250, 0.110),
    Vec3::new(0.160, 0.075, 0.040),
    Vec3::new(0.400, 0.440, 0.440),
    Vec3::new(0.590, 0.240, 0.110),
    Vec3::new(0.080, 0.110, 0.330),
    Vec3::new(0.520, 0.440, 0.300),
];

/// Gold, cream and near-black inks.
const GOLD: Vec3 = Vec3::new(0.62, 0.44, 0.16);
const CREAM: Vec3 = Vec3::new(0.74, 0.69, 0.58);
const DARK: Vec3 = Vec3::new(0.045, 0.040, 0.040);

/// Whether the point `g` of a unit square lies on the strokes of an invented
/// letter, one of a dozen forms.
fn letter(form: u32, g: Vec2) -> bool {
    const PEN: f32 = 0.11;
    let stem = |x: f32| (g.x - x).abs() < PEN;
    let bar = |y: f32| (g.y - y).abs() < 0.09;
    let slope = |a: Vec2, b: Vec2| {
        let (pa, ba) = (g - a, b - a);
        (pa - ba * (pa.dot(ba) / ba.length_squared()).clamp(0.0, 1.0)).length() < PEN
    };
    let ring = |c: Vec2, r: Vec2| (((g - c) / r).length() - 1.0).abs() < 0.24;
    let (left, right) = (0.14, 0.86);
    let mid = Vec2::splat(0.5);
    if !(0.0..=1.0).contains(&g.x) || !(0.0..=1.0).contains(&g.y) {
        return false;
    }
    match form % 12 {
        0 => stem(0.5),
        1 => stem(left) || bar(0.09) || bar(0.5) || bar(0.91),
        2 => ring(mid, Vec2::new(0.4, 0.43)),
        3 => stem(left) || stem(right) || bar(0.5),
        4 => {
            slope(Vec2::new(0.1, 1.0), Vec2::new(0.5, 0.0))
                || slope(mid.with_y(0.0), Vec2::new(0.9, 1.0))
        }
        5 => stem(left) || bar(0.09),
        6 => stem(0.5) || bar(0.91),
        7 => {
            slope(Vec2::new(0.1, 0.0), mid.with_y(1.0))
                || slope(mid.with_y(1.0), Vec2::new(0.9, 0.0))
                || (bar(0.3) && (g.x - 0.5).abs() < 0.3)
        }
        8 => stem(left) || (g.x > 0.3 && ring(Vec2::new(0.42, 0.72), Vec2::new(0.4, 0.24))),
        9 => stem(left) || stem(right) || slope(Vec2::new(left, 1.0), Vec2::new(right, 0.0)),
        10 => {
            stem(left)
                || slope(Vec2::new(left, 0.45), Vec2::new(right, 1.0))
                || slope(Vec2::new(0.35, 0.6), Vec2::new(right, 0.0))
        }
        _ => stem(left) || (g.x > left && ring(Vec2::new(0.3, 0.5), Vec2::new(0.55, 0.44))),
    }
}

/// Whether `(s, t)` lies on a line of lettering that is `long` long and
/// `tall` tall, centred at the origin, reading along `s`.
fn lettering(seed: u32, s: f32, t: f32, long: f32, tall: f32) -> bool {
    if s.abs() > 0.5 * long || t.abs() > 0.5 * tall {
        return false;
    }
    let pitch = 0.86 * tall;
    let count = (long / pitch).floor().max(1.0);
    let place = (s + 0.5 * count * pitch) / pitch;
    if place < 0.0 || place >= count {
        return false;
    }
    let cell = place.floor();
    let mark = hash2(seed, cell as u32);
    let edge = cell < 0.5 || cell > count - 1.5;
    if !edge && mark.is_multiple_of(7) {
        return false;
    }
    letter(mark >> 5, Vec2::new((place.fract() - 0.09) / 0.78, t / tall + 0.5))
}

/// The drawing on the spine at `(u, v)`, given the half extents `h`, in `ink`
/// on `cloth`; the answer is a colour and whether it is metallic ink.
fn drawing(random: &mut Random, cloth: Vec3, h: Vec2, u: f32, v: f32) -> (Vec3, bool) {
    let bright = cloth.dot(Vec3::new(0.3, 0.6, 0.1)) > 0.2;
    let gilt = random.chance(0.45) && !bright;
    let ink = if gilt {
        GOLD
    } else if bright {
        random.pick(&[DARK, CLOTH[0], CLOTH[1], CLOTH[2]])
    } else {
        CREAM
    };
    let text = random.bits();
    let style = random.bits() % 6;
    let margin = random.range(0.8, 2.2);
    let twin = random.chance(0.6);
    let title = (h.x * random.range(0.6, 0.9)).clamp(0.42, 1.1);
    let plate = random.pick(&[CLOTH[0], CLOTH[1], DARK, CREAM, CREAM, CLOTH[3]]);
    let inked = |on: bool| if on { (ink, gilt) } else { (cloth, false) };

    // Lines across the spine at both ends.
    let end = h.y - v.abs();
    let lined = (end - margin).abs() < 0.09 || (twin && (end - margin - 0.32).abs() < 0.04);
    // The publisher's mark near the foot.
    let mark = Vec2::new(u, v + h.y - margin - 1.3);
    let size = (0.5 * h.x).min(0.55);
    let marked = match text % 4 {
        0 => (mark.length() - size).abs() < 0.08,
        1 => mark.x.abs() + mark.y.abs() < size,
        2 => mark.length() < 0.6 * size,
        _ => mark.abs().max_element() < size && mark.abs().max_element() > size - 0.12,
    };
    let reading = |from: f32, to: f32, tall: f32, seed: u32| {
        lettering(seed, 0.5 * (from + to) - v, u, (to - from) * 0.94, tall)
    };
    match style {
        // A coloured plate with the title across it, for the thicker books.
        0 | 1 if h.x > 1.05 => {
            let (top, height) = (h.y - margin - 1.0, 0.2 * h.y + 1.4);
            let y = top - v;
            if (0.0..height).contains(&y) {
                let on = plate.dot(Vec3::splat(0.33)) < 0.2;
                let print = if on { GOLD } else { DARK };
                let frame = (y - 0.5 * height).abs() > 0.5 * height - 0.24
                    && (y - 0.5 * height).abs() < 0.5 * height - 0.14;
                let rows = (height - 0.8) / 1.0;
                let row = ((y - 0.4) / 1.0).floor();
                let line = row >= 0.0 && row < rows.floor() && {
                    let wide = 2.0 * h.x * (0.62 + 0.25 * unit(hash2(text, row as u32)));
                    let t = 0.5 - ((y - 0.4) - row);
                    lettering(text ^ row as u32, u, t, wide, 0.62)
                };
                return if frame || line { (print, on) } else { (plate, false) };
            }
            let author = reading(-0.45 * h.y, 0.35 * h.y, 0.7 * title, text ^ 9);
            inked(lined || marked || (style == 1 && author))
        }
        // Raised bands with gilt lines beside them.
        2 if h.x > 1.2 => {
            let panel = 2.0 * h.y / 6.0;
            let y = (v + h.y) / panel;
            let from_band = ((y - y.round()) * panel).abs();
            if from_band < 0.28 && y > 0.5 && y < 5.5 {
                let lit = 1.0 + 0.9 * ((y - y.round()) * panel / 0.28);
                return (cloth * lit, false);
            }
            let middle = ((y.fract()) - 0.5) * panel;
            let named = y.floor() as i32 == 4;
            if named {
                let shade = cloth.lerp(plate, 0.85);
                let on = lettering(text, u, middle - 0.5, 1.7 * h.x, 0.68)
                    || lettering(text ^ 5, u, middle + 0.5, 1.3 * h.x, 0.68);
                let dark = shade.dot(Vec3::splat(0.33)) < 0.25;
                return if on { (if dark { GOLD } else { DARK }, dark) } else { (shade, false) };
            }
            let flower = Vec2::new(u, middle);
            let petal = flower.length() < 0.32 + 0.22 * (4.0 * flower.y.atan2(flower.x)).cos();
            inked((from_band - 0.42).abs() < 0.05 || (petal && (y.floor() as i32) % 2 == 1))
        }
        // A block of another colour at the head.
        3 => {
            let cut = h.y * 0.45;
            if v > cut {
                let on = plate.dot(Vec3::splat(0.33)) < 0.2;
                let print = if on { CREAM } else { DARK };
                let named = reading(cut + 0.3, h.y - 0.4, 0.8 * title, text);
                return (if named { print } else { plate }, false);
            }
            inked(reading(-0.6 * h.y, cut - 0.5, title, text ^ 3) || marked)
        }
        // A plain title along the spine, and the author.
        _ => {
            let titled = reading(-0.25 * h.y, h.y - margin - 0.7, title, text);
            let author =
                reading((-0.85 * h.y).max(margin + 2.6 - h.y), -0.3 * h.y, 0.65 * title, text ^ 7);
            inked(titled || author || (style == 4 && lined) || marked)
        }
    }
}

/// Reflectance, gloss and roughness of a book at `q`, in book coordinates.
pub fn binding(seed: u32, half: Vec3, bulge: f32, q: Vec3) -> (Vec3, f32, f32) {
    let mut random = Random::new(seed);
    let tint = 1.0 + 0.22 * random.range(-1.0, 1.0);
    let dye = random.pick(&CLOTH);
    // Years in the light have dulled it a little.
    let cloth = dye.lerp(Vec3::splat(dye.dot(Vec3::new(0.3, 0.6, 0.1))), 0.16) * (0.86 * tint);
    let smooth = random.chance(0.3);
    let (gloss, roughness) = if smooth { (0.045, 0.22) } else { (0.03, 0.5) };
    let board = 0.22_f32.min(0.3 * half.x);
    let between = q.x.abs() < half.x - board;
    if q.y.abs() > half.y - 0.01 && between && q.z < half.z - bulge - 0.25 {
        let leaf = noise(Vec3::new(q.x * 30.0, q.z * 0.3, 0.5));
        return (Vec3::new(0.62, 0.54, 0.41) * (0.9 + 0.16 * leaf), 0.01, 0.8);
    }
    let weave = if smooth { 0.0 } else { noise(q * 14.0) * 0.06 };
    let wear = 0.12 * (1.0 - (half.y - q.y.abs()) / 0.35).max(0.0);
    if q.z < half.z - bulge - 0.005 {
        return (cloth * (1.0 + weave), gloss, roughness);
    }
    let (colour, metal) = drawing(&mut random, cloth, Vec2::new(half.x, half.y), q.x, q.y);
    let worn = colour * (1.0 + weave) + Vec3::splat(wear * 0.4);
    if metal { (worn, 0.22, 0.3) } else { (worn, gloss, roughness) }
}
