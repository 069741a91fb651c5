//! Where things are on the sheet.

use super::super::drawing::Drawing;
use super::stage::{AXES, DISTANCES, EYE, Stage};
use super::subject::{Subject, bounds, holds, turn};
use super::view::{View, corners};
use super::{BAR, GRAY, MARGIN, TEXT, THIN};
use glam::DVec2;
use optics::geometry::Outline;

/// Devices drawn smaller than this share of the sheet's shorter side are drawn once more,
/// magnified.
const SMALL: f64 = 0.28;
/// The least width of the key to a magnified device.
const LEGEND: f64 = 14.5 * TEXT;
/// The room around a magnified device for its dimensions.
const AROUND: f64 = 2.0 * TEXT;

/// Devices that overlap as they are drawn.
#[derive(Clone)]
pub(super) struct Group {
    /// Which.
    pub subjects: Vec<usize>,
    /// Least and greatest x and y of all of them, cm.
    bounds: [DVec2; 2],
}

/// Where things are on the sheet.
pub(super) struct Layout {
    /// The whole scene.
    pub view: View,
    /// Devices once more, magnified.
    pub insets: Vec<Inset>,
    /// Where a colour bar would be: top left corner and height.
    pub bar: (DVec2, f64),
    /// The top left corner of the axes of coordinates.
    pub axes: DVec2,
}

/// Devices that stand in or before one another once more, magnified.
pub(super) struct Inset {
    pub group: Group,
    pub view: View,
    /// The frame around it: top left corner and size.
    frame: [DVec2; 2],
    /// Where the key to it goes.
    pub legend: [DVec2; 2],
}

impl Layout {
    pub fn new(sheet: DVec2, stage: &Stage, subjects: &[Subject<'_>], bar: bool) -> Self {
        let bar = if bar { BAR } else { 0.0 };
        let scene = subjects.iter().filter_map(Subject::bounds).flatten();
        let world = bounds(scene.chain(stage.bounds())).unwrap_or([DVec2::ZERO; 2]);
        let view = |share: f64| {
            let from = DVec2::new(MARGIN + 1.6 * EYE, DISTANCES);
            let below = 1.5 * TEXT + MARGIN;
            let to = DVec2::new(sheet.x - MARGIN - bar - 0.8 * TEXT, share * sheet.y - below);
            View::fitting(world, [from, to - from])
        };
        let whole = view(1.0);
        let small: Vec<Group> = groups(subjects)
            .into_iter()
            .filter(|Group { bounds: [low, high], .. }| {
                whole.scale * (*high - *low).max_element() < SMALL * sheet.min_element()
            })
            .collect();
        let (view, insets) = match &small[..] {
            [] => (whole, Vec::new()),
            [group] => one_inset(sheet, group, world, view, (stage, subjects)),
            _ => row_of_insets(sheet, &small, view(0.56)),
        };
        let [top, size] = view.window;
        let bar_at = DVec2::new(sheet.x - MARGIN - BAR + 0.6 * TEXT, top.y + 0.08 * size.y);
        let mut taken = obstacles(&view, stage, subjects);
        let of_insets = insets.iter().flat_map(|inset| [inset.frame, inset.legend]);
        taken.extend(of_insets.map(|taken| corners(taken).to_vec()));
        let axes = place_of_axes(sheet, view.window, &taken);
        Self { view, insets, bar: (bar_at, 0.84 * size.y), axes }
    }

    /// Whether a device is drawn once more, magnified.
    pub fn is_magnified(&self, subject: usize) -> bool {
        self.insets.iter().any(|inset| inset.group.subjects.contains(&subject))
    }
}

/// One small device: magnified in the corner below the camera, as large as it can be beside what
/// the camera sees.
fn one_inset(
    sheet: DVec2,
    group: &Group,
    world: [DVec2; 2],
    view: impl Fn(f64) -> View,
    (stage, subjects): (&Stage, &[Subject<'_>]),
) -> (View, Vec<Inset>) {
    let mut best: Option<(f64, View, [DVec2; 2])> = None;
    for share in [0.84, 0.8, 0.76, 0.72, 0.68, 0.64, 0.6, 0.56] {
        // To the right, away from the inset.
        let mut view = view(share);
        let right = view.window[0].x + view.window[1].x;
        view.origin.x += (right - view.place(world[1]).x).max(0.0);
        let taken = obstacles(&view, stage, subjects);
        for height in (4..=13).map(|k| 0.04 * f64::from(k) * sheet.y) {
            let size = DVec2::splat(height);
            let from = DVec2::new(MARGIN, sheet.y - MARGIN - height);
            let frame = [from, size];
            // The scene should be large, and so should the inset.
            let merit = height * view.scale.powi(2);
            if is_free(frame, &taken) && best.as_ref().is_none_or(|(most, ..)| merit > *most) {
                best = Some((merit, view, frame));
            }
        }
    }
    let Some((_, view, frame)) = best else {
        return row_of_insets(sheet, std::slice::from_ref(group), view(0.56));
    };
    let legend = free_below(sheet, frame, &obstacles(&view, stage, subjects));
    let (group, inset) = (group.clone(), within(group.bounds, frame));
    (view, vec![Inset { group, view: inset, frame, legend }])
}

/// The largest free room to the right of an inset, down to the lower edge of the sheet.
fn free_below(sheet: DVec2, [from, size]: [DVec2; 2], taken: &[Vec<DVec2>]) -> [DVec2; 2] {
    let left = from.x + size.x + TEXT;
    let lower = sheet.y - MARGIN;
    let ends = taken.iter().flatten().map(|p| p.x).chain([sheet.x - MARGIN]);
    let rooms = ends.filter(|right| *right >= left + LEGEND).flat_map(|right| {
        (0..40).map(move |k| {
            let top = lower * f64::from(k) / 40.0;
            [DVec2::new(left, top), DVec2::new(right - left, lower - top)]
        })
    });
    rooms
        .filter(|room| is_free(*room, taken))
        .max_by(|a, b| (a[1].x * a[1].y).total_cmp(&(b[1].x * b[1].y)))
        .unwrap_or([DVec2::new(left, lower), DVec2::ZERO])
}

/// Several small devices: magnified in a row below the scene, each with its key beside it, or below
/// it where there is no room.
fn row_of_insets(sheet: DVec2, small: &[Group], view: View) -> (View, Vec<Inset>) {
    let mut insets = Vec::new();
    let top = view.window[0].y + view.window[1].y + 2.2 * TEXT;
    let height = (sheet.y - MARGIN - top).max(1.0);
    let room = (sheet.x - 2.0 * MARGIN) / small.len() as f64;
    for (k, group) in small.iter().enumerate() {
        let from = DVec2::new(MARGIN + k as f64 * room, top);
        let beside = room - height - 2.0 * TEXT >= LEGEND;
        let below = if beside { 0.0 } else { (5.0 * TEXT).min(0.45 * height) };
        let frame_height = height - below;
        let frame = [from, DVec2::new(frame_height.min(room - 0.5 * TEXT), frame_height)];
        let legend = if beside {
            let legend_from = DVec2::new(from.x + frame[1].x + 1.2 * TEXT, top);
            [legend_from, DVec2::new((room - frame[1].x - 2.0 * TEXT).max(0.0), height)]
        } else {
            let gap = 0.4 * TEXT;
            let legend_from = DVec2::new(from.x, top + frame_height + gap);
            [legend_from, DVec2::new((room - 0.5 * TEXT).max(0.0), (below - gap).max(0.0))]
        };
        let view = within(group.bounds, frame);
        insets.push(Inset { group: group.clone(), view, frame, legend });
    }
    (view, insets)
}

/// The first corner that is free, for the axes of coordinates.
fn place_of_axes(sheet: DVec2, window: [DVec2; 2], taken: &[Vec<DVec2>]) -> DVec2 {
    let [DVec2 { y: view_top, .. }, size] = window;
    let (left, right) = (MARGIN, sheet.x - MARGIN - AXES.x);
    let bottom = sheet.y - MARGIN - AXES.y;
    let places = [
        (left, bottom),
        (left, view_top + size.y - AXES.y),
        (left, view_top + 0.5 * TEXT),
        (right, bottom),
        (right, view_top),
        ((left + right) / 2.0, bottom),
    ]
    .map(DVec2::from);
    // Else anywhere, from the left.
    const STEPS: u32 = 24;
    let [most, steps] = [DVec2::new(right, bottom), DVec2::splat(f64::from(STEPS))];
    let anywhere = (0..=STEPS).flat_map(|column| {
        (0..=STEPS).rev().map(move |row| DVec2::new(f64::from(column), f64::from(row)))
    });
    let anywhere = anywhere.map(|step| left + (most - left) * step / steps);
    let free = places.into_iter().chain(anywhere).find(|at| is_free([*at, AXES], taken));
    free.unwrap_or(places[0])
}

impl Inset {
    /// Draws the frame, and what of the scene is in it.
    pub fn draw_frame(&self, drawing: &mut Drawing, scene: &View) {
        let [low, high] = self.group.bounds;
        let from = scene.place(DVec2::new(low.x, high.y)) - 5.0;
        let to = scene.place(DVec2::new(high.x, low.y)) + 5.0;
        let source = corners([from, to - from]);
        let frame = corners(self.frame);
        drawing.add_area("magnified", source).stroked(GRAY, 0.8 * THIN);
        drawing.add_area("inset", frame).stroked(GRAY, 0.8 * THIN);
        // From the lower corners to the upper ones of the inset.
        for (a, b) in [(source[1], frame[0]), (source[2], frame[3])] {
            drawing.add_line("magnification", [a, b], (GRAY, 0.6 * THIN)).dashed(4.0, 4.0);
        }
    }
}

/// The devices that have ends, those together whose boxes overlap, with the opaque bodies that lie
/// within.
fn groups(subjects: &[Subject<'_>]) -> Vec<Group> {
    let boxed = |opaque: bool| {
        let of_kind = subjects.iter().enumerate().filter(move |(_, s)| s.is_opaque() == opaque);
        of_kind.filter_map(|(i, s)| Some(Group { subjects: vec![i], bounds: s.bounds()? }))
    };
    let mut groups: Vec<Group> = Vec::new();
    for mut own in boxed(false) {
        // What it touches may reach further, and touch more.
        while let Some(other) = groups.iter().position(|group| group.touches(&own)) {
            own = groups.remove(other).with(own);
        }
        groups.push(own);
    }
    for own in boxed(true) {
        if let Some(around) = groups.iter_mut().find(|group| holds(group.bounds, own.bounds)) {
            *around = around.clone().with(own);
        }
    }
    groups
}

impl Group {
    fn touches(&self, other: &Self) -> bool {
        let ([low, high], [from, to]) = (self.bounds, other.bounds);
        low.max(from).cmplt(high.min(to)).all()
    }

    fn with(mut self, other: Self) -> Self {
        self.subjects.extend(other.subjects);
        let ends = bounds(self.bounds.into_iter().chain(other.bounds));
        Self { bounds: ends.unwrap_or(self.bounds), ..self }
    }
}

/// The view of a device in the frame of an inset, with room for its dimensions.
fn within(bounds: [DVec2; 2], [from, size]: [DVec2; 2]) -> View {
    let around = DVec2::splat(AROUND).min(size * 0.3);
    View::fitting(bounds, [from + around, size - 2.0 * around])
}

/// The convex shapes on the sheet that nothing else should cover.
fn obstacles(view: &View, stage: &Stage, subjects: &[Subject<'_>]) -> Vec<Vec<DVec2>> {
    let mut shapes = vec![view.places(&stage.sight)];
    let boxed = |[low, high]: [DVec2; 2], around: DVec2| {
        let from = view.place(DVec2::new(low.x, high.y)) - around;
        corners([from, view.place(DVec2::new(high.x, low.y)) + around - from]).to_vec()
    };
    shapes.push(boxed([stage.eye; 2], DVec2::new(2.0 * EYE, EYE + 1.2 * TEXT)));
    let around = DVec2::new(2.0 * TEXT, 1.4 * TEXT);
    shapes.extend(bounds(stage.photograph()).map(|photograph| boxed(photograph, around)));
    shapes.extend(subjects.iter().filter_map(Subject::bounds).map(|b| boxed(b, DVec2::splat(6.0))));
    shapes.retain(|shape| shape.len() > 2);
    shapes
}

/// Whether none of some convex shapes reaches into a part of the sheet, its top left corner and
/// size.
fn is_free(part: [DVec2; 2], taken: &[Vec<DVec2>]) -> bool {
    let part = outline(&corners(part));
    taken.iter().all(|shape| !outline(shape).overlaps(&part, 0.0))
}

/// A convex shape of the sheet as an outline, which runs counterclockwise with y up.
pub(super) fn outline(shape: &[DVec2]) -> Outline {
    let mut points: Vec<DVec2> = shape.iter().map(|p| DVec2::new(p.x, -p.y)).collect();
    if turn(&points) < 0.0 {
        points.reverse();
    }
    Outline { corners: points }
}
