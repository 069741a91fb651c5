//! A device in cross-section.

use super::super::color_scale::ColorScale;
use super::super::drawing::{Drawing, Face, Ink, Shape, Words};
use super::body;
use super::index_map::{draw_region, on_sheet};
use super::medium_axes::{MediumAxes, draw_cross};
use super::subject::{Subject, border, bounds, sides, turn};
use super::view::View;
use super::{INK, MEDIUM, METAL, PAPER, TEXT, THICK, THIN, centimetres, dimension, rounded, write};
use cloakroom::device::{Contour, REACH, Section};
use glam::DVec2;
use optics::geometry::Pose;
use optics::medium::Medium;

/// Longest half of an axis within a cell, units of the sheet.
const AXIS: f64 = 46.0;
/// The distance of dimensions from what they measure.
const SHIFT: f64 = 15.0;
/// Contours of more corners than this are curves: their sides are not measured.
const MOST_CORNERS: usize = 8;

/// Draws the shapes of a device.
pub(super) fn draw(
    drawing: &mut Drawing,
    view: &View,
    subject: &Subject<'_>,
    scale: Option<&ColorScale>,
) {
    let section = &subject.section;
    if section.body.is_some() {
        body::draw(drawing, view, subject);
    }
    let window = || vec![view.frame().to_vec()];
    let place = |contour: &Contour| on_sheet(view, &subject.pose, &contour.points);
    let places = |contours: &[Contour]| contours.iter().map(place).collect::<Vec<_>>();
    for region in &section.regions {
        let border = places(&region.border);
        match scale {
            Some(scale) if region.region.is_graded() => {
                draw_region(drawing, view, region, &subject.pose, scale);
            }
            _ => {
                drawing.add("medium", Shape::Area(border.clone())).filled(MEDIUM).within(window());
            }
        }
        drawing.add("border", Shape::Area(border)).stroked(INK, THIN).within(window());
    }
    if section.is_shadow && section.body.is_none() && section.metal.is_empty() {
        let area = drawing.add("medium", Shape::Area(places(&section.outlines))).filled(MEDIUM);
        area.stroked(INK, THIN).within(window());
    }
    for contour in &section.metal {
        if contour.closed {
            drawing.add_area("metal", place(contour)).filled(METAL).stroked(INK, THICK);
        } else {
            let stroke = (INK, 1.4 * THICK);
            drawing.add_line("mirror", place(contour), stroke).within(window());
        }
    }
}

/// Draws what a device is filled with: the axes of its media, or their indices. `before` are those that stand
/// before it.
pub(super) fn draw_media(
    drawing: &mut Drawing,
    view: &View,
    subject: &Subject<'_>,
    before: &[(&Subject<'_>, bool)],
) {
    for region in &subject.section.regions {
        if region.region.is_graded() {
            draw_axes(drawing, view, subject, region);
        } else {
            draw_medium(drawing, view, subject, region);
        }
    }
    body::draw_medium(drawing, view, subject, before);
}

/// What a homogeneous cell is filled with: its axes, or its index.
fn draw_medium(drawing: &mut Drawing, view: &View, subject: &Subject<'_>, region: &Section<'_>) {
    let Some((middle, medium)) =
        middle(region).and_then(|p| Some((p, region.region.medium_at(p)?)))
    else {
        return;
    };
    let at = view.place(subject.pose.point_to_world(middle));
    let border: Vec<Vec<DVec2>> = (region.border.iter())
        .map(|contour| on_sheet(view, &subject.pose, &contour.points))
        .collect();
    draw_filling(drawing, &subject.pose, &medium, at, &border, MEDIUM);
}

/// Draws the axes of a medium, or its index, about a point of the sheet within some contours, on a ground of
/// that colour.
pub(super) fn draw_filling(
    drawing: &mut Drawing,
    pose: &Pose,
    medium: &Medium,
    at: DVec2,
    border: &[Vec<DVec2>],
    ground: Ink,
) {
    if let Some(axes) = MediumAxes::of(medium) {
        let reach = |direction| room(border, at, direction).min(AXIS);
        draw_cross(drawing, &axes, at, reach, |v| turned(pose, v));
    } else {
        let words = Words::of_runs(index_label(medium), at, TEXT);
        if words.width() < 2.0 * room(border, at, DVec2::X)
            && TEXT < 2.0 * room(border, at, DVec2::Y)
        {
            write(drawing, "index", words, ground);
        }
    }
}

/// The index of a medium in words.
pub(super) fn index_label(medium: &Medium) -> Vec<(Face, String)> {
    let value = format!(" = {}", rounded(medium.mean_index()));
    vec![(Face::Italic, "n".to_owned()), (Face::Regular, value)]
}

/// A vector of a device's frame in the plane, as a direction of the sheet.
pub(super) fn turned(pose: &Pose, v: DVec2) -> DVec2 {
    let world = pose.vector_to_world(v.extend(0.0)).truncate();
    DVec2::new(world.x, -world.y)
}

/// How far one can go from a point of the sheet, to and fro, well within some contours.
pub(super) fn room(border: &[Vec<DVec2>], at: DVec2, direction: DVec2) -> f64 {
    let free = [direction, -direction].map(|d| free_way(border, at, d));
    0.8 * free[0].min(free[1])
}

/// The axes of a graded cell here and there, as large as there is room between them.
fn draw_axes(drawing: &mut Drawing, view: &View, subject: &Subject<'_>, region: &Section<'_>) {
    let (axes, distance) = axes_of_graded(region);
    let half = 0.42 * distance * view.scale;
    for (point, axes) in axes {
        let at = view.place(subject.pose.point_to_world(point));
        for axis in axes.drawn() {
            let along = half * axis.length * turned(&subject.pose, axis.direction);
            let line = [at - along, at + along];
            drawing.add_line("rim", line, (PAPER.faint(0.7), 2.2 * THICK));
            drawing.add_line("axis", line, (axis.ink, THICK));
        }
    }
}

/// The axes of the medium of a graded cell on a lattice, if it is anisotropic, and how far apart they are, cm.
pub(super) fn axes_of_graded(region: &Section<'_>) -> (Vec<(DVec2, MediumAxes)>, f64) {
    const STEPS: u32 = 9;
    let Some([low, high]) = bounds(border(region)) else { return (Vec::new(), 0.0) };
    let distance = (high - low).max_element() / f64::from(STEPS);
    let lattice = (0..STEPS * STEPS).map(|k| {
        let steps = DVec2::new(f64::from(k % STEPS), f64::from(k / STEPS));
        (low + high) / 2.0 + (steps - 0.5 * f64::from(STEPS - 1)) * distance
    });
    let axes = lattice
        .filter(|point| region.holds(*point))
        .filter_map(|point| Some((point, MediumAxes::of(&region.region.medium_at(point)?)?)));
    (axes.collect(), distance)
}

/// A point well within a region: the centroid of its first contour, if it lies within.
pub(super) fn middle(region: &Section<'_>) -> Option<DVec2> {
    let points = &region.border.first()?.points;
    let [low, high] = bounds(points.iter().copied())?;
    if (high - low).max_element() >= REACH {
        return None;
    }
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for (a, b) in sides(points) {
        let piece = (a - low).perp_dot(b - low);
        area += piece;
        moment += piece * ((a - low) + (b - low)) / 3.0;
    }
    let centroid = low + moment / area;
    region.holds(centroid).then_some(centroid)
}

/// How far one can go from a point until the first line of some contours.
fn free_way(contours: &[Vec<DVec2>], from: DVec2, direction: DVec2) -> f64 {
    contours
        .iter()
        .flat_map(|points| sides(points))
        .filter_map(|(a, b)| {
            let side = b - a;
            let across = direction.perp_dot(side);
            let way = (a - from).perp_dot(side) / across;
            let along = (a - from).perp_dot(direction) / across;
            (across != 0.0 && way >= 0.0 && (0.0..=1.0).contains(&along)).then_some(way)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Draws the dimensions of a device: the sides of polygons, height and width of what is curved; none of an
/// opaque body, and of what is seen from the side.
pub(super) fn draw_dimensions(drawing: &mut Drawing, view: &View, subject: &Subject<'_>) {
    let section = &subject.section;
    if subject.is_opaque() || section.is_shadow {
        return;
    }
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
    let turn = turn(&points);
    // Away from the inside; below a line.
    let outward = |(a, b): (DVec2, DVec2)| {
        let along = b - a;
        let normal = DVec2::new(along.y, -along.x).normalize_or(DVec2::Y);
        let below = normal * normal.dot(DVec2::new(0.1, 1.0)).signum();
        if contour.closed { normal * turn.signum() } else { below }
    };
    // Outside rather below and on the side with more room, inside rather opposite.
    let [left, right] = [low.x - view.window[0].x, view.window[0].x + view.window[1].x - high.x];
    let beside = if left > right + 2.0 * TEXT { -0.6 } else { 0.6 };
    let liked = |side| outward(side).dot(DVec2::new(beside, 0.8) * way);
    // On the sheet, and how long they are, cm.
    let lengths = sides(&corners).map(|(a, b)| a.distance(b));
    let mut order: Vec<((DVec2, DVec2), f64)> = sides(&points).zip(lengths).collect();
    order.truncate(points.len() - usize::from(!contour.closed));
    order.sort_by(|(a, _), (b, _)| liked(*b).total_cmp(&liked(*a)));
    for ((a, b), length) in order {
        if a.distance(b) > 1.5 * TEXT && is_new(length) {
            let shift = way * SHIFT * outward((a, b));
            let ground = if way < 0.0 { METAL } else { PAPER };
            dimension::draw(drawing, [a, b], shift, &centimetres(length), ground);
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
            dimension::double_arrow(drawing, "dimension", ends);
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
