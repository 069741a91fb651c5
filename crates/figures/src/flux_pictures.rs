//! Flux as plots: curves over the directions, and maps of the receiver.

use super::axes::Frame;
use super::color_bar::ColorBar;
use super::color_scale::ColorScale;
use super::drawing::{Drawing, Shape, Words};
use super::quantity::Quantity;
use super::setting::TEXT;
use super::ticks::axis;
use super::{Curve, CurvePoint, Plot, PlotPanel};
use cloakroom::flux::{FluxReport, Incidence, Stand};
use cloakroom::output::RgbImage;
use glam::{DAffine2, DVec2};

/// What the curves of a plot are of: the stands with their polarizations.
const CURVES: [(&str, Stand, usize); 5] = [
    ("cloaked, horizontal", Stand::Cloaked, 0),
    ("cloaked, vertical", Stand::Cloaked, 1),
    ("cloaked, unpolarized", Stand::Cloaked, 2),
    ("bare", Stand::Bare, 2),
    ("nothing", Stand::Nothing, 2),
];

/// The irradiance over the directions for nothing, bare metal and the cloak in each polarization,
/// and the shadow that is given back; `axis` says what the directions are named by.
#[must_use]
pub fn flux_plot(report: &FluxReport, axis: &str) -> Plot {
    // Every panel has the curves of the key.
    let panel = |title: &str, value: &dyn Fn(&Incidence, Stand, usize) -> [f64; 2]| {
        let curves = CURVES.map(|(label, stand, light)| {
            let point = |incidence: &Incidence| {
                let [y, error] = value(incidence, stand, light);
                CurvePoint { x: incidence.direction.label, y, error }
            };
            let points = report.incidences.iter().map(point).collect();
            Curve { label: label.to_owned(), points }
        });
        PlotPanel { title: title.to_owned(), rounding: 0.0, curves: curves.to_vec() }
    };
    let irradiance = panel("Mean irradiance", &|incidence, stand, light| {
        let total = incidence.totals[stand as usize][light];
        [total.mean, total.error]
    });
    let given_back = panel("Shadow given back (%)", &|incidence, stand, light| {
        let gain = incidence.gains[light].filter(|_| stand == Stand::Cloaked);
        gain.map_or([f64::NAN, 0.0], |gain| [gain.percent, gain.error])
    });
    Plot { axis: axis.to_owned(), categories: Vec::new(), panels: vec![irradiance, given_back] }
}

/// The width of the sheet of maps, and the room beside them.
const SHEET: f64 = 900.0;
const LEFT: f64 = 4.4 * TEXT;
const RIGHT: f64 = 6.4 * TEXT;
/// The height of a map, and the room above each for its title.
const PANEL: f64 = 300.0;
const TITLE: f64 = 1.9 * TEXT;

/// Where the light goes: for bare metal and the cloak, one below the other in one scale of colours,
/// the irradiance across the receiver over all directions, or of a receiver with cells along it,
/// too, over the receiver for the first direction; none without directions.
#[must_use]
pub fn flux_map(report: &FluxReport, axis_title: &str) -> Option<Drawing> {
    let [wide, long] = report.cells;
    let all = &report.incidences;
    let (first, last) = (all.first()?, all.last()?);
    let half = [0, 1].map(|i| 0.5 * report.size[i]);
    let over_directions = long == 1 && all.len() > 1;
    let shown = if over_directions { &all[..] } else { &all[..1] };
    let stands = [Stand::Bare, Stand::Cloaked];
    // To the right first, the lowest row first.
    let numbers = stands.map(|stand| {
        let maps = shown.iter().flat_map(|incidence| &incidence.maps[stand as usize]);
        maps.copied().collect::<Vec<f64>>()
    });
    let rows = numbers[0].len() / wide;
    let scale = ColorScale::new(numbers.iter().flatten().copied(), 1e-12);
    // A row is as high as the step to the next direction.
    let step = (last.direction.label - first.direction.label) / (all.len().max(2) - 1) as f64;
    let (up, up_range) = if over_directions {
        let [low, high] = [first, last].map(|incidence| incidence.direction.label);
        (axis_title, (low - 0.5 * step, high + 0.5 * step))
    } else {
        ("Place along the receiver (cm)", (-half[1], half[1]))
    };
    let across = "Place across the receiver (cm)";
    let across = axis(&Quantity::named(across), Some((-half[0], half[0])), 7);
    let up = axis(&Quantity::named(up), Some(up_range), 7);

    let size = DVec2::new(SHEET - LEFT - RIGHT, PANEL);
    let frame = |number: usize| {
        let top = number as f64 * (TITLE + PANEL) + TITLE;
        Frame { corner: DVec2::new(LEFT, top), size, text: TEXT }
    };
    let maps = stands.len() as f64 * (TITLE + PANEL);
    let height = maps + frame(0).below(&across.ticks);
    let mut drawing = Drawing::new(DVec2::new(SHEET, height), TEXT);
    for (number, (stand, numbers)) in stands.iter().zip(&numbers).enumerate() {
        let frame = frame(number);
        let image = RgbImage::from_fn(wide as u32, rows as u32, |column, row| {
            let row = rows - 1 - row as usize;
            scale.color(numbers[row * wide + column as usize])
        });
        let place = DAffine2::from_cols(DVec2::X * size.x, DVec2::Y * size.y, frame.corner);
        drawing.add("heat-map", Shape::Image { image, cells: true, place });
        frame.draw(&mut drawing);
        let title = Words::new(stand.name(), frame.corner - DVec2::Y * 0.8 * TEXT, TEXT);
        drawing.add_words("title", title.anchored(0.0));
        frame.draw_up(&mut drawing, &up);
        if number + 1 == stands.len() {
            frame.draw_across(&mut drawing, &across);
        }
    }
    let height = maps - TITLE;
    let at = DVec2::new(SHEET - RIGHT + TEXT, TITLE + 0.1 * height);
    let bar = ColorBar { scale, quantity: Quantity::named("Irradiance") };
    bar.draw(&mut drawing, at, 0.8 * height, TEXT);
    Some(drawing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cloakroom::flux::{Sampling, across_range, flux};
    use cloakroom::render::Supervision;
    use cloakroom::scene_file;
    use std::path::Path;
    use std::sync::atomic::AtomicBool;

    #[test]
    fn what_was_measured_is_drawn() {
        let text =
            "[receiver]\nposition = [30, 0, 0]\nwidth = 50\n[[device]]\nkind = \"square-cloak\"\n";
        let scene = scene_file::parse(text, "scene", Path::new(""), &[]).expect("a scene").scene;
        let supervision = Supervision { rows_done: &|_| {}, stop: &AtomicBool::new(false) };
        let directions = across_range(&scene.receiver, &[0.0, 30.0], 0.0);
        let sampling = Sampling { rays: 256, samples: 2, cells: 40 };
        let report = flux(&scene, &directions, sampling, &|_| {}, &supervision).expect("a report");
        let plot = flux_plot(&report, "Angle of incidence (°)");
        assert_eq!(plot.panels[0].curves.len(), 5);
        let map = flux_map(&report, "Angle of incidence (°)").expect("a map");
        assert_eq!(map.of_class("heat-map").count(), 2);
    }
}
