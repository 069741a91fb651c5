//! The key to what is drawn magnified: the axes and tensors of media, and what colours and lines
//! stand for.

use super::super::drawing::{Drawing, Face, Ink, Words};
use super::body;
use super::device::{axes_of_graded, index_label, middle};
use super::medium_axes::MediumAxes;
use super::subject::Subject;
use super::view::corners;
use super::{INK, METAL, TEXT, THICK, THIN};
use glam::DVec2;
use optics::medium::Medium;

/// The distance of lines.
const LINE: f64 = 1.3 * TEXT;
/// The width of a sample of a colour.
const SAMPLE: f64 = 1.2 * TEXT;

/// What stands before an entry of the key.
#[derive(PartialEq)]
enum Sample {
    Nothing,
    /// A colour of areas.
    Area(Ink),
    /// A line of that colour and width.
    Line((Ink, f64)),
}

/// A colour or a line with what it stands for.
type Entry = (Sample, Vec<(Face, String)>);

/// Draws the key to devices that are magnified together into a box of the sheet (top left corner
/// and size), as far as there is room.
pub(super) fn draw(
    drawing: &mut Drawing,
    [from, size]: [DVec2; 2],
    subjects: &[(&Subject<'_>, bool)],
) {
    if size.x < 8.0 * TEXT || size.y < LINE {
        return;
    }
    let homogeneous = subjects.iter().find_map(|(subject, _)| Some((axes(subject)?, subject.pose)));
    let mut entries: Vec<Entry> = Vec::new();
    if let Some(((axes, medium), _)) = &homogeneous {
        entries.extend(axes.lines(medium).into_iter().map(|line| (Sample::Nothing, line)));
    }
    add_entries(&mut entries, subjects);
    let rows = entries.len() + 1;
    let radius = (0.5 * (size.y - LINE * rows as f64)).min(62.0);
    let mut y = from.y + 0.5 * LINE;
    if let Some(((axes, _), pose)) = &homogeneous
        && radius > 24.0
    {
        let at = DVec2::new(from.x + radius + TEXT, from.y + radius + 0.5 * TEXT);
        axes.draw_key(drawing, pose, at, radius);
        if axes.drawn().len() == 1 {
            let words = Words::new("optic axis", at + DVec2::new(radius + 4.5 * TEXT, 0.0), TEXT);
            drawing.add_words("optic-axis", words.anchored(0.0));
        }
        y = at.y + radius + 1.2 * LINE;
    }
    for (sample, words) in entries {
        let (class, left) = match sample {
            Sample::Nothing => ("tensor", from.x),
            _ => ("key", from.x + SAMPLE + 0.5 * TEXT),
        };
        let words = Words::of_runs(words, DVec2::new(left, y), TEXT).anchored(0.0);
        if y + 0.4 * LINE > from.y + size.y || left + words.width() > from.x + size.x {
            continue;
        }
        let at = DVec2::new(from.x, y);
        match sample {
            Sample::Nothing => {}
            Sample::Area(ink) => {
                let size = DVec2::new(SAMPLE, 0.8 * TEXT);
                let area =
                    drawing.add_area("sample", corners([at - DVec2::Y * 0.5 * size.y, size]));
                area.filled(ink).stroked(INK, THIN);
            }
            Sample::Line(stroke) => {
                drawing.add_line("sample", [at, at + DVec2::X * SAMPLE], stroke);
            }
        }
        drawing.add_words(class, words);
        y += LINE;
    }
}

/// The first homogeneous anisotropic medium of a device with its axes.
fn axes(subject: &Subject<'_>) -> Option<(MediumAxes, Medium)> {
    let section = &subject.section;
    if section.is_shadow {
        return None;
    }
    let of_regions = section.regions.iter().filter(|region| !region.region.is_graded());
    let of_regions = of_regions.filter_map(|region| region.region.medium_at(middle(region)?));
    let of_body = section.body_medium.copied();
    of_regions.chain(of_body).find_map(|medium| Some((MediumAxes::of(&medium)?, medium)))
}

/// Adds what the colours and lines of some devices stand for, each once.
fn add_entries(entries: &mut Vec<Entry>, subjects: &[(&Subject<'_>, bool)]) {
    let mut add = |sample: Sample, words: Vec<(Face, String)>| {
        let entry = (sample, words);
        if !entries.contains(&entry) {
            entries.push(entry);
        }
    };
    let plain = |words: &str| vec![(Face::Regular, words.to_owned())];
    for (subject, _) in subjects {
        let section = &subject.section;
        let tint = Sample::Area(body::tint(section.body_medium));
        match section.body_medium {
            None if section.body.is_some() => add(tint, plain("opaque")),
            Some(medium) if MediumAxes::of(medium).is_none() => add(tint, index_label(medium)),
            _ => {}
        }
        let graded = section.regions.iter().filter(|region| region.region.is_graded());
        if let Some((_, axes)) = graded.flat_map(|region| axes_of_graded(region).0).next() {
            let drawn = axes.drawn();
            let optic = drawn.len() == 1;
            for axis in drawn {
                let words = match axis.name {
                    _ if optic => "optic axis",
                    "u" => "larger principal value",
                    _ => "smaller principal value",
                };
                add(Sample::Line((axis.ink, THICK)), plain(words));
            }
        }
        if !section.polarizers.is_empty() {
            add(Sample::Line((INK, THICK)), plain("polarizer"));
        }
        for contour in &section.metal {
            if contour.closed {
                add(Sample::Area(METAL), plain("metal"));
            } else {
                add(Sample::Line((INK, 1.4 * THICK)), plain("mirror"));
            }
        }
    }
}
