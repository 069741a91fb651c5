//! A device in cross-section.

use super::super::color_scale::ColorScale;
use super::super::drawing::{Drawing, Element, Face, Ink, Shape, Words};
use super::layout::outline;
use super::medium_axes::{MediumAxes, turned};
use super::subject::{Subject, border, bounds, sides, turn};
use super::view::View;
use super::{INK, MEDIUM, METAL, PAPER, TEXT, THICK, THIN, centimetres, dimension, rounded, write};
use cloakroom::device::{Contour, REACH, Section};
use glam::DVec2;
use optics::medium::Medium;

/// Longest half of an axis within a cell, units of the sheet.
const AXIS: f64 = 46.0;
/// The distance of dimensions from what they measure.
const SHIFT: f64 = 15.0;
/// Contours of more corners than this are curves: their sides are not measured.
const MOST_CORNERS: usize = 8;

/// What stands beside a device that is measured.
pub(super) struct Neighbours<'a> {
    pub devices: Vec<&'a Subject<'a>>,
    /// What will be written there.
    pub labels: &'a [Words],
    /// What else is there.
    pub shapes: &'a [Vec<DVec2>],
}

/// A device, and where it is drawn.
pub(super) struct Sketch<'a> {
    pub drawing: &'a mut Drawing,
    pub view: &'a View,
    pub subject: &'a Subject<'a>,
}

impl Sketch<'_> {
    /// Draws its shapes.
    pub fn draw(&mut self, scale: Option<&ColorScale>) {
        let section = &self.subject.section;
        if section.body.is_some() {
            self.draw_body();
        }
        for region in &section.regions {
            let border = self.subject.places(self.view, &region.border);
            match scale {
                Some(scale) if region.region.is_graded() => self.draw_index(region, scale),
                _ => {
                    self.add_within("medium", Shape::Area(border.clone())).filled(MEDIUM);
                }
            }
            self.add_within("border", Shape::Area(border)).stroked(INK, THIN);
        }
        if section.is_shadow && section.body.is_none() && section.metal.is_empty() {
            let area = Shape::Area(self.subject.places(self.view, &section.outlines));
            self.add_within("medium", area).filled(MEDIUM).stroked(INK, THIN);
        }
        for contour in &section.polarizers {
            let points = self.subject.on_sheet(self.view, &contour.points);
            self.add_within("polarizer", Shape::Line(points)).stroked(INK, THICK);
        }
        for contour in &section.metal {
            let points = self.subject.on_sheet(self.view, &contour.points);
            if contour.closed {
                self.drawing.add_area("metal", points).filled(METAL).stroked(INK, THICK);
            } else {
                self.add_within("mirror", Shape::Line(points)).stroked(INK, 1.4 * THICK);
            }
        }
    }

    /// Adds an element that ends with the window.
    pub fn add_within(&mut self, class: &'static str, shape: Shape) -> &mut Element {
        self.drawing.add(class, shape).within(vec![self.view.frame().to_vec()])
    }

    /// Draws what it is filled with: the axes of its media, or their indices. `before` are those
    /// that stand before it.
    pub fn draw_media(&mut self, before: &[(&Subject<'_>, bool)]) {
        for region in &self.subject.section.regions {
            if region.region.is_graded() {
                self.draw_axes(region);
            } else {
                self.draw_medium(region);
            }
        }
        self.draw_body_medium(before);
    }

    /// What a homogeneous cell is filled with: its axes, or its index.
    fn draw_medium(&mut self, region: &Section<'_>) {
        let Some(middle) = middle(region) else { return };
        let Some(medium) = region.region.medium_at(middle) else { return };
        let at = self.subject.place(self.view, middle);
        let border = self.subject.places(self.view, &region.border);
        self.draw_filling(&medium, at, &border, MEDIUM);
    }

    /// Draws the axes of a medium, or its index, about a point of the sheet within some contours,
    /// on a ground of that colour.
    pub fn draw_filling(&mut self, medium: &Medium, at: DVec2, border: &[Vec<DVec2>], ground: Ink) {
        if let Some(axes) = MediumAxes::of(medium) {
            let reach = |direction| room(border, at, direction).min(AXIS);
            axes.draw_cross(self.drawing, &self.subject.pose, at, reach);
        } else {
            let words = Words::of_runs(index_label(medium), at, TEXT);
            if words.width() < 2.0 * room(border, at, DVec2::X)
                && TEXT < 2.0 * room(border, at, DVec2::Y)
            {
                write(self.drawing, "index", words, ground);
            }
        }
    }

    /// The axes of a graded cell here and there, as large as there is room between them.
    fn draw_axes(&mut self, region: &Section<'_>) {
        let (axes, distance) = axes_of_graded(region);
        let half = 0.42 * distance * self.view.scale;
        for (point, axes) in axes {
            let at = self.subject.place(self.view, point);
            for axis in axes.drawn() {
                let along = half * axis.length * turned(&self.subject.pose, axis.direction);
                let line = [at - along, at + along];
                self.drawing.add_line("rim", line, (PAPER.faint(0.7), 2.2 * THICK));
                self.drawing.add_line("axis", line, (axis.ink, THICK));
            }
        }
    }

    /// Draws its dimensions where they can be read beside `others`: the sides of polygons, height and width of
    /// what is curved; none of an opaque body, and of what is seen from the side.
    pub fn draw_dimensions(&mut self, others: &Neighbours<'_>) {
        let section = &self.subject.section;
        if self.subject.is_opaque() || section.is_shadow {
            return;
        }
        let mut told = Vec::new();
        for contour in &section.outlines {
            self.measure(contour, &mut told, 1.0, others);
        }
        let inner = section.metal.iter().filter(|contour| !section.outlines.contains(contour));
        for contour in inner {
            self.measure(contour, &mut told, -1.0, others);
        }
    }

    /// Whether a label would lie on the sheet, on no other one, on none of `others` that do not hold the device, and not on the
    /// device itself if it is outside of it (`way` 1).
    fn can_be_read(&self, label: &Words, way: f64, others: &Neighbours<'_>) -> bool {
        let corners = label.corners();
        let place = outline(&corners);
        let labels = ["dimension-label", "index"].into_iter();
        let is_clear = |words: &Words| !outline(&words.corners()).overlaps(&place, 0.0);
        let is_apart = |element: &Element| match &element.shape {
            Shape::Words(words) => is_clear(words),
            _ => true,
        };
        // Here and there on it.
        let middle = label.at;
        let points = corners.iter().flat_map(|corner| [*corner, corner.midpoint(middle)]);
        let points: Vec<DVec2> = points.chain([middle]).collect();
        let own = (way > 0.0).then_some(self.subject);
        let devices = others
            .devices
            .iter()
            .filter(|other| !self.subject.is_inside(other))
            .copied()
            .chain(own);
        let on_sheet = |at: &DVec2| at.min_element() >= 0.0 && at.cmple(self.drawing.size).all();
        corners.iter().all(on_sheet)
            && labels.flat_map(|class| self.drawing.of_class(class)).all(is_apart)
            && others.labels.iter().all(is_clear)
            && devices
                .flat_map(|other| other.places(self.view, &other.section.outlines))
                .chain(others.shapes.iter().cloned())
                .map(|points| Contour { points, closed: true })
                .all(|shape| !points.iter().any(|point| shape.surrounds(*point)))
    }

    /// Measures a contour, from outside (`way` 1) or from within (-1). Lengths that have been told
    /// are not told again.
    fn measure(
        &mut self,
        contour: &Contour,
        told: &mut Vec<f64>,
        way: f64,
        others: &Neighbours<'_>,
    ) {
        let corners = contour.corners();
        let points = self.subject.on_sheet(self.view, &corners);
        let Some([low, high]) = bounds(points.iter().copied()) else { return };
        let mut is_new = |length: f64| {
            let new =
                length < REACH && told.iter().all(|known| (known - length).abs() > 1e-6 * length);
            if new {
                told.push(length);
            }
            new
        };
        if corners.len() > MOST_CORNERS {
            self.measure_curve(contour, way, is_new, others);
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
        let [from, size] = self.view.window;
        let [left, right] = [low.x - from.x, from.x + size.x - high.x];
        let beside = if left > right + 2.0 * TEXT { -0.6 } else { 0.6 };
        let liked = |side| outward(side).dot(DVec2::new(beside, 0.8) * way);
        // On the sheet, and how long they are, cm.
        let lengths = sides(&corners).map(|(a, b)| a.distance(b));
        let mut order: Vec<((DVec2, DVec2), f64)> = sides(&points).zip(lengths).collect();
        order.truncate(points.len() - usize::from(!contour.closed));
        order.sort_by(|(a, _), (b, _)| liked(*b).total_cmp(&liked(*a)));
        for ((a, b), length) in order {
            let shift = way * SHIFT * outward((a, b));
            let label = dimension::label([a, b], shift, &centimetres(length));
            if a.distance(b) > 1.5 * TEXT && self.can_be_read(&label, way, others) && is_new(length)
            {
                let ground = if way < 0.0 { METAL } else { PAPER };
                dimension::draw(self.drawing, [a, b], shift, label, ground);
            }
        }
    }

    /// Measures a curve: how wide and how high it is in the frame of its device.
    fn measure_curve(
        &mut self,
        contour: &Contour,
        way: f64,
        mut is_new: impl FnMut(f64) -> bool,
        others: &Neighbours<'_>,
    ) {
        let Some([low, high]) = bounds(contour.points.iter().copied()) else { return };
        let (view, subject) = (self.view, self.subject);
        let at = |x: f64, y: f64| subject.place(view, DVec2::new(x, y));
        let size = high - low;
        let middle = (low + high) / 2.0;
        if way < 0.0 {
            // Within: its height, at its middle.
            let ends = [at(middle.x, low.y), at(middle.x, high.y)];
            if ends[0].distance(ends[1]) > 1.2 * TEXT && is_new(size.y) {
                dimension::double_arrow(self.drawing, "dimension", ends);
                let beside = ends[1] + DVec2::new(10.0, -0.4 * TEXT);
                let words = Words::new(centimetres(size.y), beside, TEXT).anchored(0.0);
                write(self.drawing, "dimension-label", words, PAPER);
            }
            return;
        }
        let round = (size.x - size.y).abs() < 1e-3 * size.x;
        if is_new(size.x) {
            let label =
                if round { format!("Ø {}", centimetres(size.x)) } else { centimetres(size.x) };
            let ends = [at(low.x, low.y), at(high.x, low.y)];
            let down = (at(middle.x, low.y) - at(middle.x, high.y)).normalize_or(DVec2::Y);
            let shift = SHIFT * down;
            let label = dimension::label(ends, shift, &label);
            if self.can_be_read(&label, 0.0, others) {
                dimension::draw(self.drawing, ends, shift, label, PAPER);
            }
        }
        if !round && is_new(size.y) {
            let ends = [at(high.x, low.y), at(high.x, high.y)];
            let right = (at(high.x, middle.y) - at(low.x, middle.y)).normalize_or(DVec2::X);
            let shift = SHIFT * right;
            let label = dimension::label(ends, shift, &centimetres(size.y));
            if self.can_be_read(&label, 0.0, others) {
                dimension::draw(self.drawing, ends, shift, label, PAPER);
            }
        }
    }
}

/// The index of a medium in words.
pub(super) fn index_label(medium: &Medium) -> Vec<(Face, String)> {
    let value = format!(" = {}", rounded(medium.mean_index()));
    vec![(Face::Italic, "n".to_owned()), (Face::Regular, value)]
}

/// How far one can go from a point of the sheet, to and fro, well within some contours.
pub(super) fn room(border: &[Vec<DVec2>], at: DVec2, direction: DVec2) -> f64 {
    let free = [direction, -direction].map(|d| free_way(border, at, d));
    0.8 * free[0].min(free[1])
}

/// The axes of the medium of a graded cell on a lattice, if it is anisotropic, and how far apart
/// they are, cm.
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
