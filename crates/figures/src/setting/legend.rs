//! The key to what is drawn magnified: the axes and tensors of media, and what colours and lines stand for.

use super::super::drawing::{Drawing, Face, Ink, Shape, Words};
use super::body;
use super::device::{axes_of_graded, index_label, middle, turned};
use super::medium_axes::{MediumAxes, draw_key};
use super::subject::Subject;
use super::view::corners;
use super::{INK, METAL, TEXT, THICK, THIN};
use glam::DVec2;
use optics::geometry::Pose;
use optics::medium::Medium;

/// The distance of lines.
const LINE: f64 = 1.3 * TEXT;
/// The width of a sample of a colour.
const SAMPLE: f64 = 1.2 * TEXT;

/// A colour or a line with what it stands for.
#[derive(PartialEq)]
struct Entry {
    sample: Sample,
    words: Vec<(Face, String)>,
}

#[derive(PartialEq)]
enum Sample {
    /// A colour of areas.
    Area(Ink),
    /// A line of that colour and width.
    Line(Ink, f64),
}

/// Draws the key to devices that are magnified together into a box of the sheet (top left corner and size),
/// as far as there is room.
pub(super) fn draw(
    drawing: &mut Drawing,
    [from, size]: [DVec2; 2],
    subjects: &[(&Subject<'_>, bool)],
) {
    if size.x < 8.0 * TEXT || size.y < LINE {
        return;
    }
    let homogeneous = subjects.iter().find_map(|(subject, _)| Some((axes(subject)?, subject.pose)));
    let mut lines = Vec::new();
    if let Some(((axes, medium), _)) = &homogeneous {
        lines = axes.lines(medium);
    }
    let entries = entries(subjects);
    let rows = lines.len() + entries.len() + 1;
    let radius = (0.5 * (size.y - LINE * rows as f64)).min(62.0);
    let mut y = from.y + 0.5 * LINE;
    if let Some(((axes, _), pose)) = &homogeneous
        && radius > 24.0
    {
        y = draw_axes(drawing, from, radius, axes, pose) + 1.2 * LINE;
    }
    let fits = |y: f64, words: &Words, left: f64| {
        y + 0.4 * LINE <= from.y + size.y && left + words.width() <= from.x + size.x
    };
    for runs in lines {
        let words = Words::of_runs(runs, DVec2::new(from.x, y), TEXT).anchored(0.0);
        if fits(y, &words, from.x) {
            drawing.add("tensor", Shape::Words(words)).filled(INK);
            y += LINE;
        }
    }
    for Entry { sample, words } in entries {
        let left = from.x + SAMPLE + 0.5 * TEXT;
        let words = Words::of_runs(words, DVec2::new(left, y), TEXT).anchored(0.0);
        if fits(y, &words, left) {
            draw_sample(drawing, DVec2::new(from.x, y), &sample);
            drawing.add("key", Shape::Words(words)).filled(INK);
            y += LINE;
        }
    }
}

/// Draws the axes of a homogeneous medium below the top left corner of a box, and says how far down they
/// reach.
fn draw_axes(
    drawing: &mut Drawing,
    from: DVec2,
    radius: f64,
    axes: &MediumAxes,
    pose: &Pose,
) -> f64 {
    let at = DVec2::new(from.x + radius + TEXT, from.y + radius + 0.5 * TEXT);
    draw_key(drawing, axes, at, radius, |v| turned(pose, v));
    if axes.drawn().len() == 1 {
        let words = Words::new("optic axis", at + DVec2::new(radius + 4.5 * TEXT, 0.0), TEXT);
        drawing.add("optic-axis", Shape::Words(words.anchored(0.0))).filled(INK);
    }
    at.y + radius
}

fn draw_sample(drawing: &mut Drawing, at: DVec2, sample: &Sample) {
    match sample {
        Sample::Area(ink) => {
            let size = DVec2::new(SAMPLE, 0.8 * TEXT);
            let area = Shape::Area(vec![corners([at - DVec2::Y * 0.5 * size.y, size])]);
            drawing.add("sample", area).filled(*ink).stroked(INK, THIN);
        }
        Sample::Line(ink, width) => {
            let line = Shape::Line(vec![at, at + DVec2::X * SAMPLE]);
            drawing.add("sample", line).stroked(*ink, *width);
        }
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

/// What the colours and lines of some devices stand for, each once.
fn entries(subjects: &[(&Subject<'_>, bool)]) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut add = |sample: Sample, words: Vec<(Face, String)>| {
        let entry = Entry { sample, words };
        if !entries.contains(&entry) {
            entries.push(entry);
        }
    };
    let plain = |words: &str| vec![(Face::Regular, words.to_owned())];
    for (subject, _) in subjects {
        let section = &subject.section;
        if section.body.is_some() {
            match section.body_medium {
                None => add(Sample::Area(body::tint(section.body_medium)), plain("opaque")),
                Some(medium) if MediumAxes::of(medium).is_none() => {
                    add(Sample::Area(body::tint(section.body_medium)), index_label(medium));
                }
                Some(_) => {}
            }
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
                add(Sample::Line(axis.ink, THICK), plain(words));
            }
        }
        for contour in &section.metal {
            if contour.closed {
                add(Sample::Area(METAL), plain("metal"));
            } else {
                add(Sample::Line(INK, 1.4 * THICK), plain("mirror"));
            }
        }
    }
    entries
}
