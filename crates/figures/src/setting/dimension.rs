//! Dimensions: how long things are.

use super::super::drawing::{Drawing, Ink, Shape, Words};
use super::{INK, TEXT, THIN, write};
use glam::DVec2;

/// The length of an arrow head.
pub(crate) const HEAD: f64 = 11.0;

/// The label of a dimension line beside the line from `a` to `b` (both on the sheet), shifted by `shift`: beyond it.
pub(super) fn label([a, b]: [DVec2; 2], shift: DVec2, text: &str) -> Words {
    let outward = shift.normalize_or(DVec2::Y);
    let at = (a + b) / 2.0 + shift + 0.66 * TEXT * outward;
    Words::new(text, at, TEXT).turned(upright(b - a))
}

/// Draws a dimension line beside the line from `a` to `b` (both on the sheet), shifted by `shift`,
/// with its label on a ground of that colour.
pub(super) fn draw(
    drawing: &mut Drawing,
    [a, b]: [DVec2; 2],
    shift: DVec2,
    label: Words,
    ground: Ink,
) {
    let outward = shift.normalize_or(DVec2::Y);
    for end in [a, b] {
        let line = [end + 3.0 * outward, end + shift + 6.0 * outward];
        drawing.add_line("extension", line, (INK, 0.7 * THIN));
    }
    double_arrow(drawing, "dimension", [a + shift, b + shift]);
    write(drawing, "dimension-label", label, ground);
}

/// The angle in degrees of text along a line of the sheet that nobody has to read upside down.
fn upright(along: DVec2) -> f64 {
    let angle = (-along.y).atan2(along.x).to_degrees();
    let turned = match angle {
        _ if angle > 90.0 - 1e-9 => angle - 180.0,
        _ if angle <= -90.0 - 1e-9 => angle + 180.0,
        _ => angle,
    };
    // Upright lines are read upwards.
    if (turned + 90.0).abs() < 1e-6 { 90.0 } else { turned }
}

/// A line with a head at either end; where it is too short for that, the heads point at it from
/// outside.
pub(super) fn double_arrow(drawing: &mut Drawing, class: &'static str, [a, b]: [DVec2; 2]) {
    let along = (b - a).normalize_or(DVec2::X);
    let inside = a.distance(b) > 2.2 * HEAD;
    let (inward, shorter) = if inside { (along, 0.8) } else { (-along, -2.0) };
    let end = shorter * HEAD * along;
    drawing.add_line(class, [a + end, b - end], (INK, THIN));
    for (tip, back) in [(a, inward), (b, -inward)] {
        drawing.add("head", arrow_head(tip, back, HEAD)).filled(INK);
    }
}

/// The head of an arrow with its tip at a point; `back` is the unit vector along its shaft.
pub(crate) fn arrow_head(tip: DVec2, back: DVec2, length: f64) -> Shape {
    let base = tip + length * back;
    let side = 0.32 * length * back.perp();
    Shape::Area(vec![vec![tip, base + side, base - side]])
}
