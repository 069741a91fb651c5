//! Bodies: their outlines, filled with a tint of their index.

use super::super::drawing::{Ink, Shape};
use super::device::{Sketch, room};
use super::medium_axes::MediumAxes;
use super::subject::{Subject, bounds, lattice};
use super::{INK, OPAQUE, PAPER, TEXT, THIN};
use glam::DVec2;
use optics::medium::Medium;

/// The colour of a body of a medium, or an opaque one: white for an index of 1, the bluer the
/// larger it is, the redder the more negative.
pub(super) fn tint(medium: Option<&Medium>) -> Ink {
    /// For an index far from 1.
    const POSITIVE: [f64; 3] = [107.0, 174.0, 214.0];
    const NEGATIVE: [f64; 3] = [244.0, 165.0, 130.0];
    let Some(medium) = medium else { return OPAQUE };
    let index = medium.mean_index();
    let (far, off) = if index < 0.0 { (NEGATIVE, -index) } else { (POSITIVE, (index - 1.0).abs()) };
    let share = off / (off + 1.0);
    let mix = |paper: u8, far: f64| (f64::from(paper) * (1.0 - share) + far * share).round() as u8;
    Ink::new(std::array::from_fn(|i| mix(PAPER.rgb[i], far[i])))
}

impl Sketch<'_> {
    /// Draws a body.
    pub fn draw_body(&mut self) {
        let section = &self.subject.section;
        for outline in self.subject.places(self.view, &section.outlines) {
            let area = self.add_within("body", Shape::Area(vec![outline]));
            area.filled(tint(section.body_medium)).stroked(INK, THIN);
        }
    }

    /// Draws what a body is filled with, its axes or its index, where nothing stands before it.
    pub fn draw_body_medium(&mut self, before: &[(&Subject<'_>, bool)]) {
        let (view, subject) = (self.view, self.subject);
        let Some(medium) = subject.section.body_medium else { return };
        if subject.section.is_shadow && MediumAxes::of(medium).is_some() {
            return;
        }
        let [outline] = &subject.section.outlines[..] else { return };
        let devices = before.iter().map(|(other, _)| *other).chain([subject]);
        let lines: Vec<Vec<DVec2>> =
            devices.flat_map(|device| device.places(view, &device.section.outlines)).collect();
        // The middle of what is free, or nearly so.
        let Some([low, high]) = bounds(outline.points.iter().copied()) else { return };
        const STEPS: u32 = 24;
        let widest = std::iter::once((low + high) / 2.0)
            .chain(lattice([low, high], STEPS))
            .filter(|point| outline.surrounds(*point))
            .map(|point| subject.pose.point_to_world(point))
            .filter(|world| before.iter().all(|(other, _)| !other.surrounds(*world)))
            .map(|world| {
                let at = view.place(world);
                let free = |direction: DVec2| room(&lines, at, direction);
                // A label is wider than high.
                (free(DVec2::Y).min(0.3 * free(DVec2::X)), at)
            })
            .reduce(|best, next| if best.0 >= next.0 - 1e-9 { best } else { next });
        let Some((room, at)) = widest else { return };
        if room > 0.3 * TEXT || MediumAxes::of(medium).is_some() {
            self.draw_filling(medium, at, &lines, tint(Some(medium)));
        }
    }
}
