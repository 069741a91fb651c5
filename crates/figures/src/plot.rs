//! Plots of curves, one panel above the other, as wide as a column of a journal.

use super::axes::Frame;
use super::drawing::{Drawing, Ink, Shape, Words};
use super::quantity::Quantity;
use super::ticks::{Axis, Tick, axis};
use glam::DVec2;
use std::ops::Range;

/// Curves over one common axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What runs along the axis, with its unit.
    pub axis: String,
    /// What the whole numbers from 0 on stand for along the axis, if they stand for anything; there is
    /// nothing between them, and no line then.
    pub categories: Vec<String>,
    /// The panels, from top to bottom, one at least.
    pub panels: Vec<PlotPanel>,
}

/// One panel: a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotPanel {
    /// The quantity with its unit.
    pub title: String,
    /// What is smaller is rounding, and drawn as 0.
    pub rounding: f64,
    /// Its curves, in the same order in all panels.
    pub curves: Vec<Curve>,
}

/// One curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What it is of; for the key, if there is more than one.
    pub label: String,
    /// Its points from left to right; it is interrupted where one is not finite.
    pub points: Vec<CurvePoint>,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Place along the axis.
    pub x: f64,
    /// Value.
    pub y: f64,
    /// Half the length of its error bar; 0 for none.
    pub error: f64,
}

/// Points of a curve each of which has a mark, at most; of more only so many have.
const MOST_MARKS: usize = 100;
const FEW_MARKS: usize = 12;

/// Units of the sheet in a millimetre.
const MM: f64 = 20.0;

/// The width of a column, mm.
const COLUMN: f64 = 86.0;

/// The height of a panel, mm.
const PANEL: f64 = 46.0;

/// The size of the type, 8 points, in mm, and the height of a line of the key.
const TYPE: f64 = 2.8;
const KEY_LINE: f64 = 4.2;

/// Colours that the colour-blind can tell apart: Okabe & Ito, 2008.
const COLORS: [[u8; 3]; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [0, 0, 0],
    [230, 159, 0],
    [86, 180, 233],
];

/// The room left and right of the panels, and above each, mm.
const LEFT: f64 = 17.5;
const RIGHT: f64 = 3.0;
const ABOVE: f64 = TYPE + 0.7;

impl Plot {
    /// The plot as a drawing; its units are twentieths of a millimetre.
    #[must_use]
    pub fn draw(&self) -> Drawing {
        let curves = self.panels.first().map_or(&[][..], |panel| &panel.curves);
        let keyed = if curves.len() > 1 { curves } else { &[] };
        let key = KEY_LINE * keyed.len() as f64 + if keyed.is_empty() { 0.0 } else { 1.0 };
        let size = DVec2::new(COLUMN - LEFT - RIGHT, PANEL - ABOVE) * MM;
        let frame = |number: usize| {
            let top = key + PANEL * number as f64 + ABOVE;
            Frame { corner: DVec2::new(LEFT, top) * MM, size, text: TYPE * MM }
        };
        let across = self.across();
        let ticks = self.ticks_across(&across);
        let height = (key + PANEL * self.panels.len() as f64) * MM + frame(0).below(&ticks.ticks);
        let mut drawing = Drawing::new(DVec2::new(COLUMN * MM, height).round(), TYPE * MM);
        let bare = Axis::default();
        let mut marks = Vec::new();
        for (i, panel) in self.panels.iter().enumerate() {
            let frame = frame(i);
            let is_last = i + 1 == self.panels.len();
            frame.draw_across(&mut drawing, if is_last { &ticks } else { &bare });
            panel.draw(&mut drawing, &frame, (&across, self.is_connected()), &mut marks);
        }
        marks.sort_by_key(|(curve, _)| *curve);
        for (curve, at) in marks {
            mark(&mut drawing, curve, at);
        }
        // Long words are smaller.
        let room = (COLUMN - LEFT - 8.0) * MM;
        let widest = keyed
            .iter()
            .map(|Curve { label, .. }| Words::new(label.as_str(), DVec2::ZERO, TYPE * MM).width());
        let text = TYPE * MM * (room / widest.fold(room, f64::max));
        for (i, Curve { label, .. }) in keyed.iter().enumerate() {
            let at = DVec2::new(LEFT + 3.5, 2.6 + KEY_LINE * i as f64) * MM;
            let ends = [at - DVec2::X * 3.0 * MM, at + DVec2::X * 3.0 * MM];
            if self.is_connected() {
                drawing.add_line("key", ends, stroke(i));
            }
            mark(&mut drawing, i, at);
            let words = Words::new(label.as_str(), at + DVec2::X * 4.5 * MM, text).anchored(0.0);
            drawing.add_words("key-words", words);
        }
        drawing
    }

    /// Whether lines join the points.
    fn is_connected(&self) -> bool {
        self.categories.is_empty()
    }

    /// The range of the axis.
    fn across(&self) -> Range<f64> {
        match self.categories.len() {
            0 => {
                let curves = self.panels.iter().flat_map(|panel| &panel.curves);
                padded(curves.flat_map(|curve| &curve.points).map(|point| point.x), 0.03, 0.0)
            }
            count => -0.5..count as f64 - 0.5,
        }
    }

    /// What stands along the axis.
    fn ticks_across(&self, range: &Range<f64>) -> Axis {
        if self.categories.is_empty() {
            return axis(&Quantity::named(&self.axis), Some((range.start, range.end)), 7);
        }
        let count = self.categories.len() as f64;
        let tick = |(i, label): (usize, &String)| Tick {
            place: (i as f64 + 0.5) / count,
            label: label.clone(),
        };
        let ticks = self.categories.iter().enumerate().map(tick).collect();
        Axis { ticks, title: self.axis.clone() }
    }
}

impl PlotPanel {
    /// Draws the panel but for its marks, which are collected.
    fn draw(
        &self,
        drawing: &mut Drawing,
        frame: &Frame,
        (across, connected): (&Range<f64>, bool),
        marks: &mut Vec<(usize, DVec2)>,
    ) {
        let points = self.curves.iter().flat_map(|curve| &curve.points);
        let numbers = points.flat_map(|point| [point.y - point.error, point.y + point.error]);
        let along = padded(numbers, 0.08, self.rounding);
        let up = axis(&Quantity::named(&self.title), Some((along.start, along.end)), 6);
        frame.draw(drawing);
        frame.draw_up(drawing, &up);
        let share =
            |value: f64, range: &Range<f64>| (value - range.start) / (range.end - range.start);
        let place = |x: f64, y: f64| frame.place(DVec2::new(share(x, across), share(y, &along)));
        for (i, curve) in self.curves.iter().enumerate() {
            let whole = |point: &CurvePoint| point.x.is_finite() && point.y.is_finite();
            for run in curve.points.split(|point| !whole(point)) {
                let line: Vec<DVec2> = run.iter().map(|point| place(point.x, point.y)).collect();
                let step = if line.len() > MOST_MARKS { line.len() / FEW_MARKS } else { 1 };
                marks.extend(line.iter().step_by(step).map(|at| (i, *at)));
                if connected {
                    drawing.add_line("curve", line, stroke(i));
                }
                for CurvePoint { x, y, error } in run.iter().filter(|point| point.error > 0.0) {
                    let bar = [place(*x, y - error), place(*x, y + error)];
                    drawing.add_line("error", bar, stroke(i));
                }
            }
        }
    }
}

fn color(curve: usize) -> Ink {
    Ink::new(COLORS[curve % COLORS.len()])
}

/// How large marks and how thick lines of a curve are: later ones are smaller, so that of curves
/// that lie on each other all are seen.
fn size_of(curve: usize) -> f64 {
    0.82_f64.powi(curve.min(5) as i32) * 1.15
}

fn stroke(curve: usize) -> (Ink, f64) {
    (color(curve), 0.3 * MM * size_of(curve))
}

/// The mark of a curve: its form tells curves apart where colour does not.
fn mark(drawing: &mut Drawing, curve: usize, at: DVec2) {
    let radius = 0.75 * MM * size_of(curve);
    let polygon = |corners: u32, turn: f64| {
        let corner = |k: u32| {
            let angle = std::f64::consts::TAU * (f64::from(k) / f64::from(corners) + turn);
            at + DVec2::from_angle(angle) * radius * 1.2
        };
        Shape::Area(vec![(0..corners).map(corner).collect()])
    };
    let shape = match curve % 4 {
        0 => Shape::Circle { centre: at, radius },
        1 => polygon(4, 0.125),
        2 => polygon(3, -0.25),
        _ => polygon(4, 0.0),
    };
    drawing.add("mark", shape).filled(color(curve));
}

/// Numbers are drawn apart that differ by more than this share of them.
const LEVEL: f64 = 1e-3;

/// The range of numbers, a little wider than they are; from 0 to 1 where all of them are `rounding`.
fn padded(numbers: impl Iterator<Item = f64>, share: f64, rounding: f64) -> Range<f64> {
    let (low, high) = numbers
        .filter(|number| number.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), n| (l.min(n), h.max(n)));
    if low > high {
        return 0.0..1.0;
    }
    let size = low.abs().max(high.abs());
    if size <= rounding {
        return -share..1.0;
    }
    // Numbers that differ by rounding alone are one number, and what differs by less than can be seen on paper is
    // all but level.
    let width = high - low;
    if width <= rounding.max(1e-9 * size) {
        return low - 0.1 * size..high + 0.1 * size;
    }
    if width < LEVEL * size {
        let half = 5.0 * LEVEL * size;
        return low - half..high + half;
    }
    low - share * width..high + share * width
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot() -> Plot {
        let curve = |label: &str, scale: f64| Curve {
            label: label.to_owned(),
            points: (0..10)
                .map(|i| {
                    let x = f64::from(i) * 5.0;
                    let y = if i == 4 { f64::NAN } else { scale * x };
                    CurvePoint { x, y, error: 0.0 }
                })
                .collect(),
        };
        let panel = |title: &str| PlotPanel {
            title: title.to_owned(),
            rounding: 0.0,
            curves: vec![curve("horizontal", 1.0), curve("vertical", -2.0)],
        };
        Plot {
            axis: "Rotation (°)".to_owned(),
            categories: Vec::new(),
            panels: vec![panel("Correlation"), panel("Displacement (cm)")],
        }
    }

    fn words(drawing: &Drawing) -> Vec<String> {
        let text = |shape: &Shape| match shape {
            Shape::Words(words) => Some(words.text()),
            _ => None,
        };
        drawing.elements.iter().filter_map(|element| text(&element.shape)).collect()
    }

    #[test]
    fn everything_is_named() {
        let drawing = plot().draw();
        let words = words(&drawing);
        for expected in
            ["Rotation (°)", "Correlation", "Displacement (cm)", "horizontal", "vertical"]
        {
            assert!(words.iter().any(|word| word == expected), "{expected} in {words:?}");
        }
        // The axis that both panels share is lettered once.
        assert_eq!(words.iter().filter(|word| *word == "40").count(), 1, "{words:?}");
        // Nine points on each of two curves in each of two panels, and the key.
        assert_eq!(drawing.of_class("mark").count(), 2 * 2 * 9 + 2);
        let one = Plot { panels: vec![plot().panels.remove(0)], ..plot() };
        assert!(one.draw().size.y < drawing.size.y);
    }

    #[test]
    fn points_lie_where_their_numbers_say() {
        let drawing = plot().draw();
        let marks: Vec<DVec2> = drawing
            .of_class("mark")
            .filter_map(|element| match &element.shape {
                Shape::Circle { centre, .. } => Some(*centre),
                _ => None,
            })
            .collect();
        // The first curve of the first panel rises evenly.
        let step = (marks[1] - marks[0]).round();
        assert!(step.x > 0.0 && step.y < 0.0);
        assert!((marks[8] - marks[0] - 9.0 * (marks[8] - marks[7])).length() < 12.0);
        assert!(marks.iter().all(|at| at.x > 0.0 && at.x < drawing.size.x));
    }

    #[test]
    fn the_axis_suits_what_it_counts() {
        assert_eq!(padded([3.0, f64::NAN].into_iter(), 0.1, 0.0), 2.7..3.3);
        assert_eq!(padded([0.0, 1e-15].into_iter(), 0.1, 1e-9), -0.1..1.0);
        assert_eq!(padded(std::iter::empty(), 0.1, 0.0), 0.0..1.0);
        // Labels are plain numbers, whatever little they differ by.
        for differs in [0.0, 1e-12, 1e-7, 1e-5, 1e-3, 1e-2] {
            let range = padded([0.675, 0.675 + differs].into_iter(), 0.08, 1e-9);
            let axis = axis(&Quantity::named("Correlation"), Some((range.start, range.end)), 6);
            assert_eq!(axis.title, "Correlation", "{differs}");
            assert!(axis.ticks.len() > 2 && axis.ticks.iter().all(|tick| tick.label.len() < 7));
        }
        let categories = vec!["horizontal".to_owned(), "vertical".to_owned()];
        let mut plot = plot();
        for panel in &mut plot.panels {
            for curve in &mut panel.curves {
                curve.points.truncate(2);
                curve.points[1].x = 1.0;
            }
        }
        let drawing = Plot { categories, axis: String::new(), ..plot }.draw();
        // Nothing is between words.
        assert_eq!((drawing.of_class("curve").count(), drawing.of_class("key").count()), (0, 0));
        let words = words(&drawing);
        assert_eq!(words.iter().filter(|word| *word == "vertical").count(), 2);
    }
}
