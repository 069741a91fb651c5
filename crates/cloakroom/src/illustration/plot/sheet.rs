//! A drawing as a sheet that the plotting library draws on: what it puts there is lettered and rasterized as all
//! our drawings are.

use super::super::drawing::{Drawing, Face, Ink, Shape, Words};
use glam::DVec2;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontTransform,
};
use std::convert::Infallible;

/// A drawing in the hands of the plotting library; its units are the library's pixels.
pub(super) struct Sheet<'d>(pub &'d mut Drawing);

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

fn place((x, y): BackendCoord) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
}

fn ink(color: BackendColor) -> Ink {
    let (red, green, blue) = color.rgb;
    Ink { rgb: [red, green, blue], opacity: color.alpha }
}

impl Sheet<'_> {
    fn add<S: BackendStyle>(&mut self, shape: Shape, style: &S, fill: bool) {
        let element = self.0.add("plot", shape);
        if fill {
            element.filled(ink(style.color()));
        } else {
            element.stroked(ink(style.color()), f64::from(style.stroke_width()));
        }
    }
}

impl DrawingBackend for Sheet<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.0.size.x as u32, self.0.size.y as u32)
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, color: BackendColor) -> Drawn {
        let (x, y) = point;
        self.draw_rect(point, (x + 1, y + 1), &color, true)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Drawn {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        upper_left: BackendCoord,
        bottom_right: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let (a, b) = (place(upper_left), place(bottom_right));
        let corners = vec![a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)];
        self.add(Shape::Area(vec![corners]), style, fill);
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        self.add(Shape::Line(path.into_iter().map(place).collect()), style, false);
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        center: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let shape = Shape::Circle { centre: place(center), radius: f64::from(radius) };
        self.add(shape, style, fill);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        self.add(Shape::Area(vec![corners.into_iter().map(place).collect()]), style, true);
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Drawn {
        let anchor = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Center => 0.5,
            HPos::Right => 1.0,
        };
        let below = match style.anchor().v_pos {
            VPos::Top => 0.5,
            VPos::Center => 0.0,
            VPos::Bottom => -0.5,
        } * style.size();
        let (angle, off) = match style.transform() {
            FontTransform::None => (0.0, DVec2::new(0.0, below)),
            FontTransform::Rotate90 => (-90.0, DVec2::new(-below, 0.0)),
            FontTransform::Rotate180 => (180.0, DVec2::new(0.0, -below)),
            FontTransform::Rotate270 => (90.0, DVec2::new(below, 0.0)),
        };
        let words = Words {
            runs: vec![(Face::Regular, text.to_owned())],
            at: place(at) + off,
            anchor,
            size: style.size(),
            angle,
        };
        self.0.add("plot-words", Shape::Words(words)).filled(ink(style.color()));
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let width = Face::Regular.width(text, style.size());
        Ok((width.ceil() as u32, style.size().ceil() as u32))
    }
}
