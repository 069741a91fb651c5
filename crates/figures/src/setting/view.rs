//! From the scene to the sheet.

use glam::DVec2;

/// A part of the xy-plane on a part of the sheet, to scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The part of the sheet: its top left corner and its size.
    pub window: [DVec2; 2],
    /// Units of the sheet in a cm.
    pub scale: f64,
    /// Where on the sheet the origin of the scene is.
    pub origin: DVec2,
}

impl View {
    /// The view that shows a rectangle of the xy-plane (least and greatest x and y, cm) as large as
    /// it fits into a window, in its middle.
    #[must_use]
    pub fn fitting([low, high]: [DVec2; 2], window: [DVec2; 2]) -> Self {
        let size = (high - low).max(DVec2::splat(1e-6));
        let room = window[1].max(DVec2::splat(1.0));
        let scale = (room / size).min_element();
        let middle = (low + high) / 2.0;
        let origin = window[0] + room / 2.0 - scale * DVec2::new(middle.x, -middle.y);
        Self { window, scale, origin }
    }

    /// Where on the sheet a point of the xy-plane is.
    #[must_use]
    pub fn place(&self, point: DVec2) -> DVec2 {
        self.origin + self.vector(point)
    }

    /// Where on the sheet the points of a line are.
    #[must_use]
    pub fn places(&self, points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|point| self.place(*point)).collect()
    }

    /// A vector of the xy-plane on the sheet.
    #[must_use]
    pub fn vector(&self, v: DVec2) -> DVec2 {
        self.scale * DVec2::new(v.x, -v.y)
    }

    /// The corners of the window, counterclockwise as seen.
    #[must_use]
    pub fn frame(&self) -> [DVec2; 4] {
        corners(self.window)
    }
}

/// The corners of a rectangle of the sheet (top left corner and size), counterclockwise as seen.
pub(crate) fn corners([from, size]: [DVec2; 2]) -> [DVec2; 4] {
    let to = from + size;
    [from, DVec2::new(from.x, to.y), to, DVec2::new(to.x, from.y)]
}
