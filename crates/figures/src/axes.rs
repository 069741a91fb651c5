//! Frames with ticks, for whatever runs to the right and upwards.

use super::drawing::{Drawing, Face, INK, LINE, Words};
use super::ticks::{Axis, Tick};
use glam::DVec2;

/// A frame on a sheet, and how it is lettered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Its top left corner.
    pub corner: DVec2,
    /// Width and height.
    pub size: DVec2,
    /// The size of the type.
    pub text: f64,
}

impl Frame {
    /// The thickness of thin lines that go with type of a size.
    pub fn thin(text: f64) -> f64 {
        text / 16.0
    }

    /// Where in it are shares of its width and, from below, its height.
    pub fn place(&self, share: DVec2) -> DVec2 {
        self.corner + self.size * DVec2::new(share.x, 1.0 - share.y)
    }

    /// Draws the frame itself.
    pub fn draw(&self, drawing: &mut Drawing) {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let corners = corners.map(|share| self.place(DVec2::from(share)));
        drawing.add_area("frame", corners).stroked(INK, Self::thin(self.text));
    }

    /// In how many rows labels below it stand, so that none runs into its neighbour.
    pub fn rows(&self, ticks: &[Tick]) -> usize {
        let width = |tick: &Tick| Face::Regular.width(&tick.label, self.text) + 0.5 * self.text;
        let room = |a: &Tick, b: &Tick| (b.place - a.place).abs() * self.size.x;
        let apart = |rows: usize| {
            ticks.windows(rows + 1).all(|run| {
                let (a, b) = (&run[0], &run[rows]);
                room(a, b) >= 0.5 * (width(a) + width(b))
            })
        };
        (1..4).find(|rows| apart(*rows)).unwrap_or(4)
    }

    /// The room below it that such ticks and a title take.
    pub fn below(&self, ticks: &[Tick]) -> f64 {
        (1.2 + LINE * (self.rows(ticks) + 1) as f64) * self.text
    }

    /// Draws ticks at its lower side and the title below them.
    pub fn draw_across(&self, drawing: &mut Drawing, Axis { ticks, title }: &Axis) {
        let rows = self.rows(ticks);
        for (i, tick) in ticks.iter().enumerate() {
            let at = self.place(DVec2::X * tick.place);
            self.draw_tick(drawing, at, DVec2::Y);
            let below = (1.0 + LINE * (i % rows) as f64) * self.text;
            let half = 0.5 * Face::Regular.width(&tick.label, self.text);
            // Words of any length stay on the sheet.
            let x = at.x.min(drawing.size.x - half).max(half);
            let words = Words::new(tick.label.clone(), DVec2::new(x, at.y + below), self.text);
            drawing.add_words("tick-label", words);
        }
        let below = (1.1 + LINE * rows as f64) * self.text;
        let at = self.place(DVec2::X * 0.5) + DVec2::Y * below;
        drawing.add_words("axis-title", Words::new(title.as_str(), at, self.text));
    }

    /// Draws ticks at its left side, and the title, in as many lines as it needs, upwards beside
    /// them.
    pub fn draw_up(&self, drawing: &mut Drawing, Axis { ticks, title }: &Axis) {
        let mut widest = 0.0_f64;
        for tick in ticks {
            let at = self.place(DVec2::Y * tick.place);
            self.draw_tick(drawing, at, DVec2::NEG_X);
            let at = at - DVec2::X * 0.5 * self.text;
            let words = Words::new(tick.label.clone(), at, self.text).anchored(1.0);
            widest = widest.max(words.width());
            drawing.add_words("tick-label", words);
        }
        let lines = Face::Regular.wrap(title, self.text, self.size.y);
        for (line, outwards) in lines.iter().rev().zip(0..) {
            let left = widest + (1.3 + LINE * f64::from(outwards)) * self.text;
            let at = self.place(DVec2::Y * 0.5) - DVec2::X * left;
            let words = Words::new(line.clone(), at, self.text).turned(90.0);
            drawing.add_words("axis-title", words);
        }
    }

    /// Draws a tick from a point outwards.
    pub fn draw_tick(&self, drawing: &mut Drawing, at: DVec2, outwards: DVec2) {
        let end = at + outwards * 0.3 * self.text;
        drawing.add_line("tick", [at, end], (INK, Self::thin(self.text)));
    }
}
