//! Heat maps with axes: panels of numbers over two coordinates, one scale of colours for all of them.

use super::IllustrationError;
use super::axes::Frame;
use super::color_bar::ColorBar;
use super::color_scale::ColorScale;
use super::drawing::{Drawing, INK, Shape, Words};
use super::quantity::Quantity;
use super::setting::TEXT;
use super::ticks::axis;
use cloakroom::output::RgbImage;
use glam::{DAffine2, DVec2};

/// Panels of numbers, one below the other.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// What the numbers are, with their unit.
    pub quantity: String,
    /// What runs to the right, with its unit.
    pub across: String,
    /// What runs upwards, with its unit.
    pub up: String,
    /// The least and the greatest place to the right.
    pub across_range: [f64; 2],
    /// The least and the greatest place upwards.
    pub up_range: [f64; 2],
    /// The panels, from top to bottom.
    pub panels: Vec<HeatMapPanel>,
}

/// One panel.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMapPanel {
    /// Its title.
    pub title: String,
    /// How many numbers there are to the right.
    pub columns: usize,
    /// The numbers, to the right first, the lowest row first.
    pub numbers: Vec<f64>,
}

/// The width of the sheet, and of the maps on it.
const SHEET: f64 = 900.0;
const LEFT: f64 = 4.4 * TEXT;
const RIGHT: f64 = 6.4 * TEXT;
/// The height of a panel, and the room above each for its title.
const PANEL: f64 = 300.0;
const TITLE: f64 = 1.9 * TEXT;

impl HeatMap {
    /// The maps as a drawing.
    ///
    /// # Errors
    ///
    /// If a panel has no whole rows.
    pub fn draw(&self) -> Result<Drawing, IllustrationError> {
        let [across, up] = [(&self.across, self.across_range), (&self.up, self.up_range)]
            .map(|(title, [low, high])| axis(&Quantity::named(title), Some((low, high)), 7));
        let size = DVec2::new(SHEET - LEFT - RIGHT, PANEL);
        let frame = |number: usize| {
            let top = number as f64 * (TITLE + PANEL) + TITLE;
            Frame { corner: DVec2::new(LEFT, top), size, text: TEXT }
        };
        let maps = self.panels.len().max(1) as f64 * (TITLE + PANEL);
        let height = maps + frame(0).below(&across.ticks);
        let mut drawing = Drawing::new(DVec2::new(SHEET, height), TEXT);
        let numbers = self.panels.iter().flat_map(|panel| panel.numbers.iter().copied());
        let scale = ColorScale::new(numbers, 1e-12);
        for (number, panel) in self.panels.iter().enumerate() {
            let frame = frame(number);
            let rows = panel.numbers.len() / panel.columns.max(1);
            if rows == 0 || rows * panel.columns != panel.numbers.len() {
                return Err(IllustrationError::WrongSize {
                    name: panel.title.clone(),
                    samples: panel.numbers.len(),
                    width: panel.columns,
                    height: rows,
                });
            }
            let image = RgbImage::from_fn(panel.columns as u32, rows as u32, |column, row| {
                let row = rows - 1 - row as usize;
                scale.color(panel.numbers[row * panel.columns + column as usize])
            });
            let place = DAffine2::from_cols(DVec2::X * size.x, DVec2::Y * size.y, frame.corner);
            drawing.add("heat-map", Shape::Image { image, cells: true, place });
            frame.draw(&mut drawing);
            let title = Words::new(panel.title.clone(), frame.corner - DVec2::Y * 0.8 * TEXT, TEXT);
            drawing.add("title", Shape::Words(title.anchored(0.0))).filled(INK);
            frame.draw_up(&mut drawing, &up.ticks, &up.title);
            if number + 1 == self.panels.len() {
                frame.draw_across(&mut drawing, &across.ticks, &across.title);
            }
        }
        let height = maps - TITLE;
        let at = DVec2::new(SHEET - RIGHT + TEXT, TITLE + 0.1 * height);
        let bar = ColorBar { scale, quantity: Quantity::named(&self.quantity) };
        bar.draw(&mut drawing, at, 0.8 * height, TEXT);
        Ok(drawing)
    }
}
