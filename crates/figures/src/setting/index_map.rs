//! Graded media: the refractive index in colours, and the bar that says which is which.

use super::super::color_bar::ColorBar;
use super::super::color_scale::ColorScale;
use super::super::drawing::Shape;
use super::super::quantity::Quantity;
use super::device::Sketch;
use super::medium_axes::MediumAxes;
use super::subject::{Subject, border, bounds, lattice};
use cloakroom::device::Section;
use cloakroom::output::RgbImage;
use glam::{DAffine2, DVec2};

/// The colours for the index of all graded cells; none if there are none.
pub(super) fn bar(subjects: &[Subject<'_>]) -> Option<ColorBar> {
    const STEPS: u32 = 64;
    let mut numbers = Vec::new();
    let mut isotropic = true;
    let regions = subjects.iter().flat_map(|subject| &subject.section.regions);
    for region in regions.filter(|region| region.region.is_graded()) {
        // The extremes may lie on the border.
        let Some([low, high]) = bounds(border(region)) else { continue };
        let inside = lattice([low, high], STEPS).filter(|p| region.holds(*p));
        for medium in border(region).chain(inside).filter_map(|p| region.region.medium_at(p)) {
            isotropic &= MediumAxes::of(&medium).is_none();
            numbers.push(medium.mean_index());
        }
    }
    let title = if isotropic { "refractive index" } else { "mean refractive index" };
    (!numbers.is_empty()).then(|| {
        let scale = ColorScale::new(numbers.into_iter(), 1e-12);
        ColorBar { scale, quantity: Quantity::named(title) }
    })
}

impl Sketch<'_> {
    /// Draws a graded region: its index in colours, within its border.
    pub fn draw_index(&mut self, region: &Section<'_>, scale: &ColorScale) {
        const MOST: f64 = 480.0;
        let Some([low, high]) = bounds(border(region)) else { return };
        let size = high - low;
        let step = (size.max_element() / MOST).max(0.7 / self.view.scale);
        let count = (size / step).ceil().max(DVec2::splat(4.0)).min(DVec2::splat(MOST));
        let (columns, rows) = (count.x as u32, count.y as u32);
        let at = |column: u32, row: u32| {
            let share = (DVec2::new(f64::from(column), f64::from(row)) + 0.5) / count;
            DVec2::new(low.x + share.x * size.x, high.y - share.y * size.y)
        };
        let mut numbers: Vec<Option<f64>> = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| {
                let medium = region.region.medium_at(at(column, row))?;
                Some(medium.mean_index()).filter(|index| index.is_finite())
            })
            .collect();
        // What lies just outside the medium shows where a pixel is cut by the border.
        for _ in 0..3 {
            numbers = spread(&numbers, columns as usize);
        }
        let image = RgbImage::from_fn(columns, rows, |column, row| {
            let number = numbers[(row * columns + column) as usize];
            scale.color(number.unwrap_or(f64::NAN))
        });
        let corner = |x: f64, y: f64| self.subject.place(self.view, DVec2::new(x, y));
        let top_left = corner(low.x, high.y);
        let place = DAffine2::from_cols(
            corner(high.x, high.y) - top_left,
            corner(low.x, low.y) - top_left,
            top_left,
        );
        let border = self.subject.places(self.view, &region.border);
        self.drawing.add("index-map", Shape::Image { image, cells: false, place }).within(border);
    }
}

/// Fills pixels without a number from their neighbours.
fn spread(numbers: &[Option<f64>], columns: usize) -> Vec<Option<f64>> {
    let rows = numbers.len() / columns.max(1);
    let around = |i: usize| {
        let (row, column) = (i / columns, i % columns);
        let near = |n: usize, end: usize| n.saturating_sub(1)..(n + 2).min(end);
        let cells = near(row, rows).flat_map(move |r| near(column, columns).map(move |c| (r, c)));
        let known: Vec<f64> = cells.filter_map(|(r, c)| numbers[r * columns + c]).collect();
        (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
    };
    (0..numbers.len()).map(|i| numbers[i].or_else(|| around(i))).collect()
}
