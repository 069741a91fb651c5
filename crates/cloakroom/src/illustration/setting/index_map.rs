//! Graded media: the refractive index in colours, and the bar that says which is which.

use super::super::color_scale::ColorScale;
use super::super::drawing::{Drawing, Ink, Shape, Words};
use super::super::quantity::{Dimension, Quantity};
use super::super::ticks::axis;
use super::medium_axes::MediumAxes;
use super::subject::{Subject, bounds, lattice};
use super::view::{View, corners};
use super::{INK, TEXT, THIN};
use crate::device::Region;
use crate::output::RgbImage;
use glam::{DAffine2, DVec2};
use optics::geometry::Pose;

/// The width of the colours of the bar.
const COLORS: f64 = 22.0;

/// The colours of all graded media of a scene.
pub(super) struct IndexScale {
    colors: ColorScale,
    quantity: Quantity,
}

impl IndexScale {
    /// The scale for all graded cells; none if there are none.
    pub fn of(subjects: &[Subject<'_>]) -> Option<Self> {
        const STEPS: u32 = 64;
        let mut numbers = Vec::new();
        let mut isotropic = true;
        let regions = subjects.iter().flat_map(|subject| &subject.section.regions);
        for region in regions.filter(|region| region.cell.is_graded()) {
            // The extremes may lie on the border.
            let border = region.border.iter().flat_map(|contour| contour.points.iter().copied());
            let Some([low, high]) = bounds(border.clone()) else { continue };
            let inside = lattice([low, high], STEPS).filter(|p| region.holds(*p));
            for medium in border.chain(inside).filter_map(|p| region.cell.medium_at(p)) {
                isotropic &= MediumAxes::of(&medium).is_none();
                numbers.push(medium.mean_index());
            }
        }
        let title = if isotropic { "refractive index" } else { "mean refractive index" };
        (!numbers.is_empty()).then(|| Self {
            colors: ColorScale::new(numbers.into_iter(), 1e-12),
            quantity: Quantity { title: title.to_owned(), dimension: Dimension::Number },
        })
    }

    /// Draws a graded region: its index in colours, within its border.
    pub fn draw_region(
        &self,
        drawing: &mut Drawing,
        view: &View,
        region: &Region<'_>,
        pose: &Pose,
    ) {
        const MOST: f64 = 480.0;
        let points = region.border.iter().flat_map(|contour| contour.points.iter().copied());
        let Some([low, high]) = bounds(points) else { return };
        let size = high - low;
        let step = (size.max_element() / MOST).max(0.7 / view.scale);
        let count = (size / step).ceil().max(DVec2::splat(4.0)).min(DVec2::splat(MOST));
        let (columns, rows) = (count.x as u32, count.y as u32);
        let at = |column: u32, row: u32| {
            let share = (DVec2::new(f64::from(column), f64::from(row)) + 0.5) / count;
            DVec2::new(low.x + share.x * size.x, high.y - share.y * size.y)
        };
        let mut numbers: Vec<Option<f64>> = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| {
                let medium = region.cell.medium_at(at(column, row))?;
                Some(medium.mean_index()).filter(|index| index.is_finite())
            })
            .collect();
        // What lies just outside the medium shows where a pixel is cut by the border.
        for _ in 0..3 {
            numbers = spread(&numbers, columns as usize);
        }
        let image = RgbImage::from_fn(columns, rows, |column, row| {
            let number = numbers[(row * columns + column) as usize];
            self.colors.color(number.unwrap_or(f64::NAN))
        });
        let corner = |x: f64, y: f64| view.place(pose.point_to_world(DVec2::new(x, y)));
        let top_left = corner(low.x, high.y);
        let place = DAffine2::from_cols(
            corner(high.x, high.y) - top_left,
            corner(low.x, low.y) - top_left,
            top_left,
        );
        drawing.add("index-map", Shape::Image { image, place }).within(
            region.border.iter().map(|contour| on_sheet(view, pose, &contour.points)).collect(),
        );
    }

    /// Draws the colour bar with its top left corner at a point, as high as told.
    pub fn draw_bar(&self, drawing: &mut Drawing, place: (DVec2, f64)) {
        draw_color_bar(drawing, &self.colors, &self.quantity, place);
    }
}

/// Draws the bar of a scale of colours with its top left corner at a point, as high as told.
pub(in crate::illustration) fn draw_color_bar(
    drawing: &mut Drawing,
    colors: &ColorScale,
    quantity: &Quantity,
    (at, height): (DVec2, f64),
) {
    let steps = 128;
    let image = RgbImage::from_fn(1, steps, |_, row| {
        colors.color_at(1.0 - (f64::from(row) + 0.5) / f64::from(steps))
    });
    let width = COLORS;
    let place = DAffine2::from_cols(DVec2::X * width, DVec2::Y * height, at);
    let frame = corners([at, DVec2::new(width, height)]);
    drawing.add("color-bar", Shape::Image { image, place }).within(vec![frame.clone()]);
    drawing.add("color-bar-frame", Shape::Area(vec![frame])).stroked(INK, THIN);
    let (below, above) = colors.is_clipped();
    for (clipped, end, up) in [(above, at, -1.0), (below, at + DVec2::Y * height, 1.0)] {
        if clipped {
            // A point: there are numbers beyond.
            let tip = end + DVec2::new(width / 2.0, up * width / 2.0);
            let rgb = colors.color_at(if up < 0.0 { 1.0 } else { 0.0 }).0;
            let point = Shape::Area(vec![vec![end, tip, end + DVec2::X * width]]);
            drawing.add("color-bar-end", point).filled(Ink::new(rgb)).stroked(INK, THIN);
        }
    }
    let most = (height / (1.6 * TEXT)) as usize;
    let axis = axis(quantity, colors.range(), most);
    let mut widest = 0.0_f64;
    for tick in &axis.ticks {
        let from = at + DVec2::new(width, (1.0 - tick.place) * height);
        let line = vec![from, from + DVec2::X * 7.0];
        drawing.add("tick", Shape::Line(line)).stroked(INK, THIN);
        let words = Words::new(tick.label.clone(), from + DVec2::X * 12.0, TEXT).anchored(0.0);
        widest = widest.max(words.width());
        drawing.add("tick-label", Shape::Words(words)).filled(INK);
    }
    let x = width + 12.0 + widest + 0.8 * TEXT;
    let title = Words::new(axis.title, at + DVec2::new(x, height / 2.0), TEXT).turned(90.0);
    drawing.add("color-bar-title", Shape::Words(title)).filled(INK);
}

/// Points of a device's frame on the sheet.
pub(super) fn on_sheet(view: &View, pose: &Pose, points: &[DVec2]) -> Vec<DVec2> {
    points.iter().map(|p| view.place(pose.point_to_world(*p))).collect()
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
