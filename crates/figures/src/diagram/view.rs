//! What part of space a diagram shows, and how.

use super::super::drawing::{Drawing, Face, Shape, Words};
use super::super::setting::{BAR, INK, MARGIN, PAPER, TEXT, THIN, View, corners};
use super::{DiagramSettings, Pulse, Source, pulse, rays};
use cloakroom::assembly::Assembly;
use cloakroom::device::REACH;
use glam::{DVec2, DVec3};

/// The row with the key.
const KEY: f64 = 1.8 * TEXT;

/// Least and greatest x and y of what devices take up, cm, without thin mirrors such as the floors
/// of carpets; of what is endless, as far as it is wide.
pub(super) fn bounds(assembly: &Assembly) -> Option<[DVec2; 2]> {
    /// What is shown of something without any end, cm to either side.
    const ENDLESS: f64 = 10.0;
    /// What is thinner is a sheet, turned with rounding, cm: no body is.
    const SHEET: f64 = 1e-7;
    let boxes = assembly.devices().iter().filter_map(|placed| {
        let [low, high] = placed.structure.hull.bounds(&placed.pose)?.map(DVec3::truncate);
        let size = high - low;
        let width = size.min_element();
        let shown = if (SHEET..REACH).contains(&width) { 1.5 * width } else { ENDLESS };
        let middle = placed.pose.origin.truncate();
        let is_endless = size.cmpge(DVec2::splat(REACH));
        Some([
            DVec2::select(is_endless, middle - shown, low),
            DVec2::select(is_endless, middle + shown, high),
        ])
    });
    boxes.reduce(|[low, high], [from, to]| [low.min(from), high.max(to)])
}

/// The devices' place, and how much around them is shown.
#[derive(Clone, Debug)]
pub(super) struct Scenery {
    bounds: [DVec2; 2],
    /// Least and greatest x and y that are shown, cm.
    shown: [DVec2; 2],
    pub z: f64,
}

impl Scenery {
    pub fn new([low, high]: [DVec2; 2], z: f64, settings: &DiagramSettings) -> Self {
        let size = (high - low).max_element();
        // Room for rays to come and to go.
        let along = match settings.source {
            Source::Parallel { degrees } => DVec2::from_angle(degrees.to_radians()).abs(),
            Source::Point(_) | Source::Camera => DVec2::X,
        };
        let around = size * (0.06 + 0.4 * along);
        let mut shown = [low - around, high + around];
        let near = |point: DVec2| point.distance((low + high) / 2.0) < 4.0 * size;
        if let Source::Point(point) = settings.source
            && near(point.truncate())
        {
            let point = point.truncate();
            shown = [shown[0].min(point - 0.05 * size), shown[1].max(point + 0.05 * size)];
        }
        let shown = settings.window.unwrap_or(shown);
        Self { bounds: [low, high], shown, z }
    }

    /// From where to where, as shares of it, a straight line is in what is shown, if it is.
    pub fn shown_part(&self, [from, to]: [DVec2; 2]) -> Option<[f64; 2]> {
        let [low, high] = self.shown;
        let way = to - from;
        let mut part = [0.0_f64, 1.0];
        for axis in 0..2 {
            let ends = [(low - from)[axis] / way[axis], (high - from)[axis] / way[axis]];
            if way[axis] != 0.0 {
                part = [part[0].max(ends[0].min(ends[1])), part[1].min(ends[0].max(ends[1]))];
            } else if from[axis] < low[axis] || from[axis] > high[axis] {
                return None;
            }
        }
        (part[0] < part[1]).then_some(part)
    }

    /// The middle of the devices.
    pub fn middle(&self) -> DVec2 {
        (self.bounds[0] + self.bounds[1]) / 2.0
    }

    /// The radius of a circle around the devices.
    pub fn radius(&self) -> f64 {
        0.5 * self.bounds[0].distance(self.bounds[1])
    }

    /// The width of a bundle that is a little wider than the devices in a direction.
    pub fn width(&self, across: DVec2) -> f64 {
        1.06 * (self.bounds[1] - self.bounds[0]).dot(across.abs())
    }

    /// How far before the middle a bundle starts: out of what is shown.
    pub fn start(&self) -> f64 {
        let [low, high] = self.shown;
        let [from, to] = [low.min(self.bounds[0]), high.max(self.bounds[1])];
        let middle = self.middle();
        2.0 * (middle - from).max(to - middle).length()
    }

    /// How far along z space is shown, where devices have no end.
    pub fn depth(&self) -> f64 {
        (self.bounds[1] - self.bounds[0]).max_element()
    }

    /// The view of the cross-section on a sheet; its window is what is shown.
    pub fn section_view(&self, sheet: DVec2, bar: bool) -> View {
        let bar = if bar { BAR } else { 0.0 };
        let from = DVec2::splat(MARGIN);
        let size = DVec2::new(sheet.x - 2.0 * MARGIN - bar, sheet.y - 2.0 * MARGIN - KEY);
        View::fitting(self.shown, [from, size])
    }
}

/// Where the colour bar beside a cross-section is: its top left corner and its height.
pub(super) fn bar(sheet: DVec2) -> (DVec2, f64) {
    let height = 0.7 * sheet.y;
    (DVec2::new(sheet.x - MARGIN - BAR + 0.6 * TEXT, 0.5 * (sheet.y - KEY - height)), height)
}

/// Covers what is drawn beyond a window, given by its corners on the sheet: devices go on there.
pub(super) fn cover_margins(drawing: &mut Drawing, frame: &[DVec2; 4]) {
    let [low, high] = [
        frame.iter().copied().fold(DVec2::INFINITY, DVec2::min),
        frame.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max),
    ];
    let sheet = drawing.size;
    for [from, to] in [
        [DVec2::ZERO, DVec2::new(low.x, sheet.y)],
        [DVec2::new(high.x, 0.0), sheet],
        [DVec2::ZERO, DVec2::new(sheet.x, low.y)],
        [DVec2::new(0.0, high.y), sheet],
    ] {
        drawing.add_area("margin", corners([from, to - from])).filled(PAPER);
    }
}

/// Draws what the strokes stand for, in a row at the lower edge.
pub(super) fn draw_key(drawing: &mut Drawing, settings: &DiagramSettings, pulse: Option<&Pulse>) {
    let mut x = MARGIN;
    let y = drawing.size.y - 0.5 * KEY;
    let mut write = |drawing: &mut Drawing, text: String, gap: f64| {
        let words = Words::new(text, DVec2::new(x, y), 0.8 * TEXT).anchored(0.0);
        x += words.width() + gap;
        drawing.add_words("key", words);
        x
    };
    let sample = |at: f64| [DVec2::new(at, y), DVec2::new(at + 1.8 * TEXT, y)];
    let mut at = write(drawing, "power".to_owned(), 0.6 * TEXT);
    for power in [1.0, 0.3, 0.1, 0.03].into_iter().filter(|power| *power >= settings.min_power) {
        drawing.add_line("key-ray", sample(at), rays::stroke(power));
        write(drawing, String::new(), 2.1 * TEXT);
        at = write(drawing, format!("{} %", power * 100.0), 0.9 * TEXT);
    }
    if let Some(distance) = settings.wavefronts {
        drawing.add_line("key-wavefront", sample(at), rays::FRONT);
        write(drawing, String::new(), 2.1 * TEXT);
        at = write(drawing, format!("equal optical path, every {distance} cm"), 0.9 * TEXT);
    }
    if let Some(pulse) = pulse {
        drawing.add_line("key-pulse", sample(at), pulse::stroke(1.0));
        write(drawing, String::new(), 2.1 * TEXT);
        write(drawing, pulse.words(), 0.0);
    }
}

/// A parallel projection of space onto the sheet.
pub(super) struct SpaceView {
    right: DVec3,
    up: DVec3,
    /// Towards whoever looks.
    pub toward: DVec3,
    scale: f64,
    middle: DVec3,
    centre: DVec2,
}

impl SpaceView {
    pub fn new(scenery: &Scenery, sheet: DVec2, [azimuth, elevation]: [f64; 2]) -> Self {
        let (sin, cos) = azimuth.to_radians().sin_cos();
        let (rise, level) = elevation.to_radians().sin_cos();
        let right = DVec3::new(cos, 0.0, -sin);
        let back = DVec3::new(sin, 0.0, cos);
        let toward = back * level + DVec3::Y * rise;
        let up = toward.cross(right);
        let [low, high] = scenery.shown;
        let half = 0.5 * scenery.depth();
        let middle = ((low + high) / 2.0).extend(scenery.z);
        let corners = (0..8).map(|k| {
            let pick = |bit: u32, a: f64, b: f64| if k >> bit & 1 == 0 { a } else { b };
            DVec3::new(
                pick(0, low.x, high.x),
                pick(1, low.y, high.y),
                scenery.z + pick(2, -half, half),
            ) - middle
        });
        let reach = corners.fold(DVec2::splat(1e-6), |most, corner| {
            most.max(DVec2::new(corner.dot(right), corner.dot(up)).abs())
        });
        let centre = DVec2::new(sheet.x, sheet.y - KEY) / 2.0;
        let scale = ((centre - MARGIN) / reach).min_element();
        Self { right, up, toward, scale, middle, centre }
    }

    /// Where on the sheet a point is.
    pub fn place(&self, at: DVec3) -> DVec2 {
        let at = at - self.middle;
        self.centre + self.scale * DVec2::new(at.dot(self.right), -at.dot(self.up))
    }

    /// The corners of the part of the sheet that it fills.
    pub fn frame(&self) -> [DVec2; 4] {
        corners([DVec2::ZERO, 2.0 * self.centre])
    }

    /// Draws the directions of x, y and z.
    pub fn draw_axes(&self, drawing: &mut Drawing) {
        let origin = drawing.size - 3.2 * TEXT;
        let ground = Shape::Circle { centre: origin, radius: 2.7 * TEXT };
        drawing.add("ground", ground).filled(PAPER.faint(0.85));
        for (name, axis) in [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)] {
            let along = DVec2::new(axis.dot(self.right), -axis.dot(self.up));
            let tip = origin + 1.9 * TEXT * along;
            drawing.add_line("coordinate", [origin, tip], (INK, THIN));
            let beside = tip + 0.55 * TEXT * along.normalize_or(DVec2::Y);
            let words = Words::of(Face::Italic, name, beside, 0.8 * TEXT);
            drawing.add_words("coordinate-name", words);
        }
    }
}
