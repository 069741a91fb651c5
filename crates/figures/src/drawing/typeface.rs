//! The outlines of letters: Noto Sans, which comes with the program.

use glam::DVec2;
use std::sync::LazyLock;
use ttf_parser::{OutlineBuilder, Rect};

/// A face of the type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// For running text.
    Regular,
    /// For titles and labels of panels.
    Bold,
    /// For symbols of quantities.
    Italic,
}

/// A piece of the outline of a letter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Piece {
    Move(DVec2),
    Line(DVec2),
    Quadratic(DVec2, DVec2),
    Cubic(DVec2, DVec2, DVec2),
    Close,
}

impl Face {
    fn font(self) -> &'static ttf_parser::Face<'static> {
        static FONTS: LazyLock<[ttf_parser::Face<'static>; 3]> = LazyLock::new(|| {
            [notosans::REGULAR_TTF, notosans::BOLD_TTF, notosans::ITALIC_TTF]
                .map(|data| ttf_parser::Face::parse(data, 0).expect("the font is sound"))
        });
        &FONTS[self as usize]
    }

    /// Units of the font in one of type size.
    fn scale(self) -> f64 {
        f64::from(self.font().units_per_em()).recip()
    }

    /// The width of a text in type of a size.
    #[must_use]
    pub fn width(self, text: &str, size: f64) -> f64 {
        text.chars().map(|c| self.advance(c)).sum::<f64>() * size
    }

    /// Breaks a text in type of a size into lines of at most that width, between words where it
    /// can; there is always room for one letter.
    pub(crate) fn wrap(self, text: &str, size: f64, width: f64) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        let mut line = String::new();
        for word in text.split_whitespace() {
            let space = if line.is_empty() { "" } else { " " };
            let together = self.width(&line, size) + self.width(space, size);
            if together + self.width(word, size) <= width {
                line = line + space + word;
                continue;
            }
            lines.extend(Some(std::mem::take(&mut line)).filter(|line| !line.is_empty()));
            let mut used = 0.0;
            for letter in word.chars() {
                let more = self.advance(letter) * size;
                if used + more > width && !line.is_empty() {
                    lines.push(std::mem::take(&mut line));
                    used = 0.0;
                }
                line.push(letter);
                used += more;
            }
        }
        lines.extend(Some(line).filter(|line| !line.is_empty()));
        lines
    }

    /// Half the height of capitals, in type of size 1.
    pub(super) fn half_capital(self) -> f64 {
        0.5 * self.font().capital_height().map_or(0.7, |h| f64::from(h) * self.scale())
    }

    fn advance(self, c: char) -> f64 {
        let advance = self.font().glyph_hor_advance(self.glyph(c)).unwrap_or(0);
        f64::from(advance) * self.scale()
    }

    /// The glyph of a character; the font's sign for a missing one if it has none.
    fn glyph(self, c: char) -> ttf_parser::GlyphId {
        self.font().glyph_index(c).unwrap_or(ttf_parser::GlyphId(0))
    }

    /// The outline of a text. `place` takes points of a line of type of size 1 to where they are:
    /// it runs from the origin on its base line to the right, y up.
    pub(super) fn outline(self, text: &str, place: &dyn Fn(DVec2) -> DVec2) -> Vec<Piece> {
        let mut pen = Pen { pieces: Vec::new(), x: 0.0, scale: self.scale(), place };
        for c in text.chars() {
            let _: Option<Rect> = self.font().outline_glyph(self.glyph(c), &mut pen);
            pen.x += self.advance(c);
        }
        pen.pieces
    }
}

/// Collects outlines.
struct Pen<'p> {
    pieces: Vec<Piece>,
    x: f64,
    scale: f64,
    place: &'p dyn Fn(DVec2) -> DVec2,
}

impl Pen<'_> {
    fn at(&self, x: f32, y: f32) -> DVec2 {
        let on_line = DVec2::new(self.x + f64::from(x) * self.scale, f64::from(y) * self.scale);
        (self.place)(on_line)
    }
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.pieces.push(Piece::Move(self.at(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.pieces.push(Piece::Line(self.at(x, y)));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.pieces.push(Piece::Quadratic(self.at(x1, y1), self.at(x, y)));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.pieces.push(Piece::Cubic(self.at(x1, y1), self.at(x2, y2), self.at(x, y)));
    }

    fn close(&mut self) {
        self.pieces.push(Piece::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_the_letters_of_figures() {
        for face in [Face::Regular, Face::Bold, Face::Italic] {
            for c in "aZ09 ()=.,−°×εμ–".chars() {
                assert!(face.font().glyph_index(c).is_some(), "{c} in {face:?}");
            }
        }
    }

    #[test]
    fn lines_are_broken_where_there_is_no_more_room() {
        let wrap = |text: &str, letters: f64| {
            Face::Regular.wrap(text, 10.0, letters * Face::Regular.width("m", 10.0) + 1e-9)
        };
        assert_eq!(wrap("mm  mm mm", 6.0), ["mm mm", "mm"]);
        assert_eq!(wrap("m mmmmm m", 2.0), ["m", "mm", "mm", "m", "m"]);
        assert_eq!(wrap("mm", 0.0), ["m", "m"]);
        assert!(wrap(" ", 5.0).is_empty());
    }

    #[test]
    fn letters_stand_side_by_side() {
        let width = Face::Regular.width("m", 10.0);
        assert!((Face::Regular.width("mm", 10.0) - 2.0 * width).abs() < 1e-12);
        assert!(Face::Bold.width("m", 10.0) > width);
        let reach = |text: &str| {
            let ends =
                Face::Regular.outline(text, &|p| p).into_iter().filter_map(|piece| match piece {
                    Piece::Move(p) | Piece::Line(p) => Some(p.x),
                    _ => None,
                });
            ends.fold(0.0, f64::max)
        };
        assert!((reach("mm") - reach("m") - width / 10.0).abs() < 1e-12);
        assert!(Face::Regular.outline(" ", &|p| p).is_empty());
    }
}
