//! Heat maps with axes: panels of numbers over two coordinates, one scale of colours for all of them.

use super::IllustrationError;
use super::color_scale::ColorScale;
use super::drawing::{Drawing, Shape, Words};
use super::quantity::{Dimension, Quantity};
use super::setting::{INK, TEXT, THIN, corners, draw_color_bar};
use super::ticks::axis;
use crate::output::RgbImage;
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
/// The height of a panel, and the room above each for its title and below the last for its axis.
const PANEL: f64 = 300.0;
const TITLE: f64 = 1.9 * TEXT;
const AXIS: f64 = 3.4 * TEXT;

impl HeatMap {
    /// The maps as a drawing.
    ///
    /// # Errors
    ///
    /// If a panel has no whole rows.
    pub fn draw(&self) -> Result<Drawing, IllustrationError> {
        let count = self.panels.len().max(1) as f64;
        let mut drawing = Drawing::new(DVec2::new(SHEET, count * (TITLE + PANEL) + AXIS));
        let numbers = self.panels.iter().flat_map(|panel| panel.numbers.iter().copied());
        let colors = ColorScale::new(numbers, 1e-12);
        let width = SHEET - LEFT - RIGHT;
        for (number, panel) in self.panels.iter().enumerate() {
            let corner = DVec2::new(LEFT, number as f64 * (TITLE + PANEL) + TITLE);
            let rows = panel.numbers.len() / panel.columns.max(1);
            let image = RgbImage::from_fn(panel.columns as u32, rows as u32, |column, row| {
                let row = rows - 1 - row as usize;
                colors.color(panel.numbers[row * panel.columns + column as usize])
            });
            if rows == 0 || rows * panel.columns != panel.numbers.len() {
                return Err(IllustrationError::WrongSize {
                    name: panel.title.clone(),
                    samples: panel.numbers.len(),
                    width: panel.columns,
                    height: rows,
                });
            }
            let place = DAffine2::from_cols(DVec2::X * width, DVec2::Y * PANEL, corner);
            drawing.add("heat-map", Shape::Image { image, place });
            let frame = corners([corner, DVec2::new(width, PANEL)]);
            drawing.add("frame", Shape::Area(vec![frame])).stroked(INK, THIN);
            let title = Words::new(panel.title.clone(), corner - DVec2::Y * 0.8 * TEXT, TEXT);
            drawing.add("title", Shape::Words(title.anchored(0.0))).filled(INK);
            self.draw_up(&mut drawing, corner);
            if number + 1 == self.panels.len() {
                self.draw_across(&mut drawing, corner + DVec2::Y * PANEL, width);
            }
        }
        let height = drawing.size.y - TITLE - AXIS;
        let at = DVec2::new(SHEET - RIGHT + TEXT, TITLE + 0.1 * height);
        let quantity = number(&self.quantity);
        draw_color_bar(&mut drawing, &colors, &quantity, (at, 0.8 * height));
        Ok(drawing)
    }

    fn draw_up(&self, drawing: &mut Drawing, corner: DVec2) {
        let [low, high] = self.up_range;
        for tick in axis(&number(&self.up), Some((low, high)), 6).ticks {
            let at = corner + DVec2::Y * PANEL * (1.0 - tick.place);
            let line = vec![at, at - DVec2::X * 7.0];
            drawing.add("tick", Shape::Line(line)).stroked(INK, THIN);
            let words = Words::new(tick.label, at - DVec2::X * 12.0, 0.85 * TEXT).anchored(1.0);
            drawing.add("tick-label", Shape::Words(words)).filled(INK);
        }
        let at = DVec2::new(0.9 * TEXT, corner.y + 0.5 * PANEL);
        let title = Words::new(self.up.clone(), at, TEXT).turned(90.0);
        drawing.add("axis-title", Shape::Words(title)).filled(INK);
    }

    fn draw_across(&self, drawing: &mut Drawing, corner: DVec2, width: f64) {
        let [low, high] = self.across_range;
        for tick in axis(&number(&self.across), Some((low, high)), 7).ticks {
            let at = corner + DVec2::X * width * tick.place;
            let line = vec![at, at + DVec2::Y * 7.0];
            drawing.add("tick", Shape::Line(line)).stroked(INK, THIN);
            let words = Words::new(tick.label, at + DVec2::Y * 0.95 * TEXT, 0.85 * TEXT);
            drawing.add("tick-label", Shape::Words(words)).filled(INK);
        }
        let at = corner + DVec2::new(0.5 * width, 2.4 * TEXT);
        let title = Words::new(self.across.clone(), at, TEXT);
        drawing.add("axis-title", Shape::Words(title)).filled(INK);
    }
}

/// A quantity whose unit, if any, is in its name.
fn number(title: &str) -> Quantity {
    Quantity { title: title.to_owned(), dimension: Dimension::Number }
}
