//! Plots of curves, one panel above the other, as wide as a column of a journal.

mod sheet;

use super::drawing::{Drawing, Ink, Shape, Words};
use super::quantity::short;
use super::setting::INK;
use glam::DVec2;
use plotters::prelude::{
    ChartBuilder, DrawingArea, IntoDrawingArea, IntoFont, IntoTextStyle, LineSeries, PathElement,
    RGBColor, Rectangle, ShapeStyle, TextStyle,
};
use sheet::Sheet;
use std::ops::Range;

/// Curves over one common axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What runs along the axis, with its unit.
    pub axis: String,
    /// What the whole numbers from 0 on stand for along the axis, if they stand for anything.
    pub categories: Vec<String>,
    /// The panels, from top to bottom, one at least.
    pub panels: Vec<PlotPanel>,
}

/// One panel: a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotPanel {
    /// The quantity with its unit.
    pub title: String,
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

/// Units of the sheet in a millimetre.
const MM: f64 = 20.0;

/// The width of a column, mm.
const COLUMN: f64 = 86.0;

/// The height of a panel, and of the room for the axis under the last one, mm.
const PANEL: f64 = 46.0;
const AXIS: f64 = 11.0;

/// The size of the type, 8 points, in mm, and the height of a line of the key.
const TYPE: f64 = 2.8;
const LINE: f64 = 4.2;

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

const BLACK: RGBColor = RGBColor(INK.rgb[0], INK.rgb[1], INK.rgb[2]);

impl Plot {
    /// The plot as a drawing; its units are twentieths of a millimetre.
    #[must_use]
    pub fn draw(&self) -> Drawing {
        let labels: Vec<&str> = match self.panels.first() {
            Some(panel) if panel.curves.len() > 1 => {
                panel.curves.iter().map(|curve| curve.label.as_str()).collect()
            }
            _ => Vec::new(),
        };
        let key = LINE * labels.len() as f64 + if labels.is_empty() { 0.0 } else { 1.0 };
        let height = key + PANEL * self.panels.len() as f64 + AXIS;
        let size = (DVec2::new(COLUMN, height) * MM).round();
        let mut drawing = Drawing::new(size);
        let mut marks = Vec::new();
        let sheet = Sheet(&mut drawing).into_drawing_area();
        for (i, panel) in self.panels.iter().enumerate() {
            let top = ((key + PANEL * i as f64) * MM) as u32;
            let last = i + 1 == self.panels.len();
            let bottom = top + ((PANEL + if last { AXIS } else { 0.0 }) * MM) as u32;
            let area = sheet.clone().shrink((0, top), (size.x as u32, bottom - top));
            // A sheet in memory takes everything.
            let drawn: Result<(), Box<dyn std::error::Error>> =
                self.panel(&area, panel, last, &mut marks);
            if drawn.is_err() {
                marks.clear();
            }
        }
        drop(sheet);
        marks.sort_by_key(|(curve, _)| *curve);
        for (curve, at) in marks {
            mark(&mut drawing, curve, at);
        }
        for (i, label) in labels.iter().enumerate() {
            let at = DVec2::new(18.0, 2.6 + LINE * i as f64) * MM;
            let ends = vec![at - DVec2::X * 3.0 * MM, at + DVec2::X * 3.0 * MM];
            drawing.add("key", Shape::Line(ends)).stroked(color(i), 0.3 * MM * size_of(i));
            mark(&mut drawing, i, at);
            let words = Words::new(*label, at + DVec2::X * 4.5 * MM, TYPE * MM).anchored(0.0);
            drawing.add("key-words", Shape::Words(words)).filled(INK);
        }
        drawing
    }

    fn panel(
        &self,
        area: &DrawingArea<Sheet<'_>, plotters::coord::Shift>,
        panel: &PlotPanel,
        last: bool,
        marks: &mut Vec<(usize, DVec2)>,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let points = || panel.curves.iter().flat_map(|curve| &curve.points);
        let across = match self.categories.len() {
            0 => padded(
                self.panels.iter().flat_map(|p| &p.curves).flat_map(|c| &c.points).map(|p| p.x),
                0.03,
            ),
            count => -0.5..count as f64 - 0.5,
        };
        let along =
            padded(points().flat_map(|point| [point.y - point.error, point.y + point.error]), 0.08);
        let units = |mm: f64| (mm * MM) as i32;
        let mut chart = ChartBuilder::on(area)
            // Half a line of type stands out above the panel, and below the one before.
            .margin_top(units(TYPE + 0.7))
            .margin_right(units(3.0))
            .margin_left(units(1.0))
            .x_label_area_size(if last { units(AXIS) } else { 0 })
            .y_label_area_size(units(16.5))
            .build_cartesian_2d(across.clone(), along.clone())?;
        let type_size = TYPE * MM;
        let style: TextStyle<'_> =
            ("sans-serif", type_size).into_font().into_text_style(area).color(&BLACK);
        let thin = ShapeStyle { color: BLACK.into(), filled: false, stroke_width: 4 };
        let numbers = |value: &f64, range: &Range<f64>| number(*value, range);
        let category = |value: &f64| {
            let index = value.round();
            let whole = (value - index).abs() < 1e-6 && index >= 0.0;
            let found = whole.then(|| self.categories.get(index as usize)).flatten();
            found.cloned().unwrap_or_default()
        };
        let x_label = |value: &f64| match self.categories.is_empty() {
            true => numbers(value, &across),
            false => category(value),
        };
        let y_label = |value: &f64| numbers(value, &along);
        let mut mesh = chart.configure_mesh();
        mesh.disable_mesh()
            .axis_style(thin)
            .label_style(style.clone())
            .axis_desc_style(style)
            .set_all_tick_mark_size(units(1.0))
            .x_labels(if last { 7.max(self.categories.len()) } else { 0 })
            .y_labels(6)
            .x_label_formatter(&x_label)
            .y_label_formatter(&y_label)
            .y_desc(panel.title.clone());
        if last {
            mesh.x_desc(self.axis.clone());
        }
        mesh.draw()?;
        let frame = [(across.start, along.start), (across.end, along.end)];
        chart.plotting_area().draw(&Rectangle::new(frame, thin))?;
        for (i, curve) in panel.curves.iter().enumerate() {
            let [red, green, blue] = color(i).rgb;
            let color = RGBColor(red, green, blue);
            let stroke_width = (0.3 * MM * size_of(i)).round() as u32;
            let style = ShapeStyle { color: color.into(), filled: false, stroke_width };
            let whole = |point: &CurvePoint| point.x.is_finite() && point.y.is_finite();
            for run in curve.points.split(|point| !whole(point)) {
                chart.draw_series(LineSeries::new(run.iter().map(|p| (p.x, p.y)), style))?;
                for point in run {
                    let (x, y) = chart.plotting_area().map_coordinate(&(point.x, point.y));
                    marks.push((i, DVec2::new(f64::from(x), f64::from(y))));
                    if point.error > 0.0 {
                        let ends = [-1.0, 1.0].map(|s| (point.x, point.y + s * point.error));
                        chart.draw_series([PathElement::new(ends.to_vec(), style)])?;
                    }
                }
            }
        }
        Ok(())
    }
}

fn color(curve: usize) -> Ink {
    Ink::new(COLORS[curve % COLORS.len()])
}

/// How large marks and how thick lines of a curve are: later ones are smaller, so that of curves that lie on each other all
/// are seen.
fn size_of(curve: usize) -> f64 {
    0.82_f64.powi(curve.min(5) as i32) * 1.15
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

/// The range of numbers, a little wider than they are.
fn padded(numbers: impl Iterator<Item = f64>, share: f64) -> Range<f64> {
    let (low, high) = numbers
        .filter(|number| number.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), n| (l.min(n), h.max(n)));
    if low > high {
        return 0.0..1.0;
    }
    // Numbers that differ by rounding alone are one number.
    let width = high - low;
    if width <= 1e-9 * low.abs().max(high.abs()) || width == 0.0 {
        let room = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
        return low - room..high + room;
    }
    low - share * width..high + share * width
}

/// A number beside a tick, as fine as the range of the axis asks for.
fn number(value: f64, range: &Range<f64>) -> String {
    let width = range.end - range.start;
    let largest = range.start.abs().max(range.end.abs());
    // Zero is not what is left of a sum of steps.
    let value = if value.abs() < 1e-9 * width { 0.0 } else { value };
    let text = if !(1e-3..1e5).contains(&largest) {
        let text = format!("{value:.2e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        if value == 0.0 { "0".to_owned() } else { format!("{digits}e{exponent}") }
    } else {
        short(value, (2.0 - width.log10().floor()).clamp(0.0, 12.0) as usize)
    };
    text.replace('-', "\u{2212}")
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
    fn numbers_are_as_short_as_the_axis_allows() {
        assert_eq!(number(0.5, &(0.0..1.0)), "0.5");
        assert_eq!(number(-20.0, &(-45.0..45.0)), "\u{2212}20");
        assert_eq!(number(1e-17, &(-1.0..1.0)), "0");
        assert_eq!(number(2e-6, &(0.0..5e-6)), "2e\u{2212}6");
        assert_eq!(padded([3.0, f64::NAN].into_iter(), 0.1), 2.7..3.3);
        assert_eq!(padded(std::iter::empty(), 0.1), 0.0..1.0);
        let categories = vec!["horizontal".to_owned(), "vertical".to_owned()];
        let mut plot = plot();
        for panel in &mut plot.panels {
            for curve in &mut panel.curves {
                curve.points.truncate(2);
                curve.points[1].x = 1.0;
            }
        }
        let words = words(&Plot { categories, axis: String::new(), ..plot }.draw());
        assert_eq!(words.iter().filter(|word| *word == "vertical").count(), 2);
    }
}
