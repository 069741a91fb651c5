//! A device in cross-section.

use super::super::drawing::{Drawing, Face, Shape, Words};
use super::index_map::{IndexScale, mean_index, on_sheet};
use super::medium_axes::{MediumAxes, draw_cross, draw_key};
use super::subject::{Subject, bounds};
use super::view::View;
use super::{INK, MEDIUM, METAL, PAPER, TEXT, THICK, THIN, centimetres, dimension, rounded, write};
use crate::device::{Contour, REACH, Region};
use glam::DVec2;

/// Longest half of an axis within a cell, units of the sheet.
const AXIS: f64 = 46.0;
/// The distance of dimensions from what they measure.
const SHIFT: f64 = 15.0;
/// Contours of more corners than this are curves: their sides are not measured.
const MOST_CORNERS: usize = 8;

/// Draws a device; in detail, with the axes of its media and its dimensions.
pub(super) fn draw(
    drawing: &mut Drawing,
    view: &View,
    subject: &Subject<'_>,
    scale: Option<&IndexScale>,
    in_detail: bool,
) {
    let section = &subject.section;
    let place = |contour: &Contour| on_sheet(view, &subject.pose, &contour.points);
    let places = |contours: &[Contour]| contours.iter().map(place).collect::<Vec<_>>();
    for region in &section.regions {
        let border = places(&region.border);
        match scale {
            Some(scale) if region.cell.is_graded() => {
                scale.draw_region(drawing, view, region, &subject.pose);
            }
            _ => {
                let area = Shape::Area(border.clone());
                drawing.add("medium", area).filled(MEDIUM).within(vec![view.frame()]);
            }
        }
        let line = drawing.add("border", Shape::Area(border));
        line.stroked(INK, THIN).within(vec![view.frame()]);
    }
    for contour in &section.metal {
        if contour.closed {
            let area = Shape::Area(vec![place(contour)]);
            drawing.add("metal", area).filled(METAL).stroked(INK, THICK);
        } else {
            let line = drawing.add("mirror", Shape::Line(place(contour)));
            line.stroked(INK, 1.4 * THICK).within(vec![view.frame()]);
        }
    }
    if in_detail {
        for region in section.regions.iter().filter(|region| !region.cell.is_graded()) {
            draw_medium(drawing, view, subject, region);
        }
        draw_dimensions(drawing, view, subject);
    }
}

/// What a homogeneous cell is filled with: its axes, or its index.
fn draw_medium(drawing: &mut Drawing, view: &View, subject: &Subject<'_>, region: &Region<'_>) {
    let Some((middle, medium)) = middle(region).and_then(|p| Some((p, region.cell.medium_at(p)?)))
    else {
        return;
    };
    let at = view.place(subject.pose.point_to_world(middle));
    let turned = |v: DVec2| {
        let world = subject.pose.vector_to_world(v.extend(0.0)).truncate();
        DVec2::new(world.x, -world.y)
    };
    let border: Vec<Vec<DVec2>> = (region.border.iter())
        .map(|contour| on_sheet(view, &subject.pose, &contour.points))
        .collect();
    let room = |direction: DVec2| {
        let free = [direction, -direction].map(|d| free_way(&border, at, d));
        0.8 * free[0].min(free[1])
    };
    if let Some(axes) = MediumAxes::of(&medium) {
        draw_cross(drawing, &axes, at, |direction| room(direction).min(AXIS), turned);
    } else {
        let name = (Face::Italic, "n".to_owned());
        let value = (Face::Regular, format!(" = {}", rounded(mean_index(&medium))));
        let words = Words::of_runs(vec![name, value], at, TEXT);
        if words.width() < 2.0 * room(DVec2::X) && TEXT < 2.0 * room(DVec2::Y) {
            write(drawing, "index", words, MEDIUM);
        }
    }
}

/// The key to a device that is drawn magnified: its title, and the axes and tensors of its media.
pub(super) fn draw_legend(drawing: &mut Drawing, [from, size]: [DVec2; 2], subject: &Subject<'_>) {
    if size.x < 12.0 * TEXT || size.y < 3.0 * TEXT {
        return;
    }
    let line = 1.3 * TEXT;
    let medium = subject.section.regions.iter().find_map(|region| {
        let medium = region.cell.medium_at(middle(region)?)?;
        (!region.cell.is_graded()).then_some(())?;
        Some((MediumAxes::of(&medium)?, medium))
    });
    let mut lines = Vec::new();
    if let Some((axes, medium)) = &medium {
        lines = axes.lines(medium);
    }
    let radius = (0.5 * (size.y - line * (lines.len() + 1) as f64)).min(62.0);
    let mut y = from.y + 0.5 * line;
    if let Some((axes, _)) = &medium
        && radius > 24.0
    {
        let turned = |v: DVec2| {
            let world = subject.pose.vector_to_world(v.extend(0.0)).truncate();
            DVec2::new(world.x, -world.y)
        };
        let at = DVec2::new(from.x + radius + TEXT, from.y + radius + 0.5 * TEXT);
        draw_key(drawing, axes, at, radius, turned);
        if axes.drawn().len() == 1 {
            let words = Words::new("optic axis", at + DVec2::new(radius + 4.5 * TEXT, 0.0), TEXT);
            drawing.add("optic-axis", Shape::Words(words.anchored(0.0))).filled(INK);
        }
        y = at.y + radius + 1.2 * line;
    }
    for runs in lines {
        let words = Words::of_runs(runs, DVec2::new(from.x, y), TEXT).anchored(0.0);
        drawing.add("tensor", Shape::Words(words)).filled(INK);
        y += line;
    }
}

/// A point well within a region: the centroid of its first contour, if it lies within.
fn middle(region: &Region<'_>) -> Option<DVec2> {
    let points = &region.border.first()?.points;
    let [low, high] = bounds(points.iter().copied())?;
    if (high - low).max_element() >= REACH {
        return None;
    }
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for (i, a) in points.iter().enumerate() {
        let b = points[(i + 1) % points.len()];
        let piece = (*a - low).perp_dot(b - low);
        area += piece;
        moment += piece * ((*a - low) + (b - low)) / 3.0;
    }
    let centroid = low + moment / area;
    region.holds(centroid).then_some(centroid)
}

/// How far one can go from a point until the first line of some contours.
fn free_way(contours: &[Vec<DVec2>], from: DVec2, direction: DVec2) -> f64 {
    let sides = contours.iter().flat_map(|points| {
        (0..points.len()).map(move |i| (points[i], points[(i + 1) % points.len()]))
    });
    sides
        .filter_map(|(a, b)| {
            let side = b - a;
            let across = direction.perp_dot(side);
            let way = (a - from).perp_dot(side) / across;
            let along = (a - from).perp_dot(direction) / across;
            (across != 0.0 && way >= 0.0 && (0.0..=1.0).contains(&along)).then_some(way)
        })
        .fold(f64::INFINITY, f64::min)
}

/// The dimensions of a device: the sides of polygons, height and width of what is curved.
fn draw_dimensions(drawing: &mut Drawing, view: &View, subject: &Subject<'_>) {
    let section = &subject.section;
    let mut told = Vec::new();
    for contour in &section.outlines {
        measure(drawing, view, subject, contour, &mut told, 1.0);
    }
    let inner = section.metal.iter().filter(|contour| !section.outlines.contains(contour));
    for contour in inner {
        measure(drawing, view, subject, contour, &mut told, -1.0);
    }
}

/// Measures a contour, from outside (`way` 1) or from within (-1). Lengths that have been told are
/// not told again.
fn measure(
    drawing: &mut Drawing,
    view: &View,
    subject: &Subject<'_>,
    contour: &Contour,
    told: &mut Vec<f64>,
    way: f64,
) {
    let corners = contour.corners();
    let points = on_sheet(view, &subject.pose, &corners);
    let Some([low, high]) = bounds(points.iter().copied()) else { return };
    let mut is_new = |length: f64| {
        let new = length < REACH && told.iter().all(|known| (known - length).abs() > 1e-6 * length);
        if new {
            told.push(length);
        }
        new
    };
    if corners.len() > MOST_CORNERS {
        measure_curve(drawing, view, subject, contour, way, is_new);
        return;
    }
    // A dimension within needs room for its label.
    if way < 0.0 && (high - low).min_element() < 4.5 * TEXT {
        return;
    }
    let sides = points.len() - usize::from(!contour.closed);
    let turn: f64 =
        (0..points.len()).map(|i| points[i].perp_dot(points[(i + 1) % points.len()])).sum();
    // Away from the inside; below a line.
    let outward = |i: usize| {
        let along = points[(i + 1) % points.len()] - points[i];
        let normal = DVec2::new(along.y, -along.x).normalize_or(DVec2::Y);
        let below = normal * normal.dot(DVec2::new(0.1, 1.0)).signum();
        if contour.closed { normal * turn.signum() } else { below }
    };
    // Outside rather below and on the side with more room, inside rather opposite.
    let [left, right] = [low.x - view.window[0].x, view.window[0].x + view.window[1].x - high.x];
    let side = if left > right + 2.0 * TEXT { -0.6 } else { 0.6 };
    let liked = |i: usize| outward(i).dot(DVec2::new(side, 0.8) * way);
    let mut order: Vec<usize> = (0..sides).collect();
    order.sort_by(|&i, &j| liked(j).total_cmp(&liked(i)));
    for i in order {
        let length = corners[i].distance(corners[(i + 1) % corners.len()]);
        let ends = [points[i], points[(i + 1) % points.len()]];
        if ends[0].distance(ends[1]) > 1.5 * TEXT && is_new(length) {
            let shift = way * SHIFT * outward(i);
            let ground = if way < 0.0 { METAL } else { PAPER };
            dimension::draw(drawing, ends, shift, &centimetres(length), ground);
        }
    }
}

/// Measures a curve: how wide and how high it is in the frame of its device.
fn measure_curve(
    drawing: &mut Drawing,
    view: &View,
    subject: &Subject<'_>,
    contour: &Contour,
    way: f64,
    mut is_new: impl FnMut(f64) -> bool,
) {
    let Some([low, high]) = bounds(contour.points.iter().copied()) else { return };
    let at = |x: f64, y: f64| view.place(subject.pose.point_to_world(DVec2::new(x, y)));
    let size = high - low;
    let middle = (low + high) / 2.0;
    if way < 0.0 {
        // Within: its height, at its middle.
        let ends = [at(middle.x, low.y), at(middle.x, high.y)];
        if ends[0].distance(ends[1]) > 1.2 * TEXT && is_new(size.y) {
            dimension::double_arrow(drawing, "dimension", ends, INK, THIN);
            let beside = ends[1] + DVec2::new(10.0, -0.4 * TEXT);
            let words = Words::new(centimetres(size.y), beside, TEXT).anchored(0.0);
            write(drawing, "dimension-label", words, PAPER);
        }
        return;
    }
    let round = (size.x - size.y).abs() < 1e-3 * size.x;
    if is_new(size.x) {
        let label = if round { format!("Ø {}", centimetres(size.x)) } else { centimetres(size.x) };
        let ends = [at(low.x, low.y), at(high.x, low.y)];
        let down = (at(middle.x, low.y) - at(middle.x, high.y)).normalize_or(DVec2::Y);
        dimension::draw(drawing, ends, SHIFT * down, &label, PAPER);
    }
    if !round && is_new(size.y) {
        let ends = [at(high.x, low.y), at(high.x, high.y)];
        let right = (at(high.x, middle.y) - at(low.x, middle.y)).normalize_or(DVec2::X);
        dimension::draw(drawing, ends, SHIFT * right, &centimetres(size.y), PAPER);
    }
}
