//! Where things are on the sheet.

use super::super::drawing::Drawing;
use super::stage::{AXES, DISTANCES, EYE, Stage};
use super::subject::{Subject, bounds, turn};
use super::view::{View, corners};
use super::{BAR, GRAY, MARGIN, TEXT, THIN};
use glam::DVec2;
use optics::geometry::Outline;

/// Devices drawn smaller than this share of the sheet's shorter side are drawn once more, magnified.
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
    pub sheet: DVec2,
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
        let mut layout = Self {
            sheet,
            view: whole,
            insets: Vec::new(),
            bar: (DVec2::ZERO, 0.0),
            axes: DVec2::ZERO,
        };
        if let [group] = &small[..] {
            layout.place_one(group, world, view, stage, subjects);
        } else if !small.is_empty() {
            layout.place_row(&small, view(0.56));
        }
        let [top, size] = layout.view.window;
        let bar_at = DVec2::new(sheet.x - MARGIN - BAR + 0.6 * TEXT, top.y + 0.08 * size.y);
        layout.bar = (bar_at, 0.84 * size.y);
        layout.place_axes(stage, subjects);
        layout
    }

    /// Whether a device is drawn once more, magnified.
    pub fn is_magnified(&self, subject: usize) -> bool {
        self.insets.iter().any(|inset| inset.group.subjects.contains(&subject))
    }

    /// One small device: magnified in the corner below the camera, as large as it can be beside what
    /// the camera sees.
    fn place_one(
        &mut self,
        group: &Group,
        world: [DVec2; 2],
        view: impl Fn(f64) -> View,
        stage: &Stage,
        subjects: &[Subject<'_>],
    ) {
        let sheet = self.sheet;
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
            self.place_row(std::slice::from_ref(group), view(0.56));
            return;
        };
        self.view = view;
        let legend = self.free_below(frame, &obstacles(&view, stage, subjects));
        let (group, view) = (group.clone(), within(group.bounds, frame));
        self.insets.push(Inset { group, view, frame, legend });
    }

    /// The largest free room to the right of an inset, down to the lower edge of the sheet.
    fn free_below(&self, [from, size]: [DVec2; 2], taken: &[Vec<DVec2>]) -> [DVec2; 2] {
        let left = from.x + size.x + TEXT;
        let lower = self.sheet.y - MARGIN;
        let ends = taken.iter().flatten().map(|p| p.x).chain([self.sheet.x - MARGIN]);
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

    /// Several small devices: magnified in a row below the scene, each with its key beside it, or below it
    /// where there is no room.
    fn place_row(&mut self, small: &[Group], view: View) {
        self.view = view;
        let top = view.window[0].y + view.window[1].y + 2.2 * TEXT;
        let height = (self.sheet.y - MARGIN - top).max(1.0);
        let room = (self.sheet.x - 2.0 * MARGIN) / small.len() as f64;
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
            self.insets.push(Inset { group: group.clone(), view, frame, legend });
        }
    }

    /// Puts the axes of coordinates into the first corner that is free.
    fn place_axes(&mut self, stage: &Stage, subjects: &[Subject<'_>]) {
        let mut taken = obstacles(&self.view, stage, subjects);
        let insets = self.insets.iter().flat_map(|inset| [inset.frame, inset.legend]);
        taken.extend(insets.map(|taken| corners(taken).to_vec()));
        let [DVec2 { y: view_top, .. }, size] = self.view.window;
        let (left, right) = (MARGIN, self.sheet.x - MARGIN - AXES.x);
        let bottom = self.sheet.y - MARGIN - AXES.y;
        let places = [
            (left, bottom),
            (left, view_top + size.y - AXES.y),
            (left, view_top + 0.5 * TEXT),
            (right, bottom),
            (right, view_top),
            ((left + right) / 2.0, bottom),
        ]
        .map(DVec2::from);
        let free = places.into_iter().find(|at| is_free([*at, AXES], &taken));
        self.axes = free.unwrap_or(places[0]);
    }
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

/// The devices that have ends, those together whose boxes overlap, with the opaque bodies that lie within.
fn groups(subjects: &[Subject<'_>]) -> Vec<Group> {
    let boxed = |opaque: bool| {
        let of_kind = move |(_, subject): &(usize, &Subject<'_>)| subject.is_opaque() == opaque;
        let with_ends = |(index, subject): (usize, &Subject<'_>)| {
            Some(Group { subjects: vec![index], bounds: subject.bounds()? })
        };
        subjects.iter().enumerate().filter(of_kind).filter_map(with_ends)
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
        if let Some(group) = groups.iter().position(|group| group.holds(&own)) {
            let around = groups.remove(group);
            groups.insert(group, around.with(own));
        }
    }
    groups
}

impl Group {
    fn touches(&self, other: &Self) -> bool {
        let ([low, high], [from, to]) = (self.bounds, other.bounds);
        low.max(from).cmplt(high.min(to)).all()
    }

    fn holds(&self, other: &Self) -> bool {
        let ([low, high], [from, to]) = (self.bounds, other.bounds);
        low.cmple(from).all() && to.cmple(high).all()
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

/// Whether none of some convex shapes reaches into a part of the sheet, its top left corner and size.
fn is_free(part: [DVec2; 2], taken: &[Vec<DVec2>]) -> bool {
    taken.iter().all(|shape| !overlap(shape, &corners(part)))
}

/// Whether two convex shapes of the sheet overlap.
fn overlap(a: &[DVec2], b: &[DVec2]) -> bool {
    // Outlines run counterclockwise with y up.
    let outline = |shape: &[DVec2]| {
        let mut points: Vec<DVec2> = shape.iter().map(|p| DVec2::new(p.x, -p.y)).collect();
        if turn(&points) < 0.0 {
            points.reverse();
        }
        Outline::new(points)
    };
    outline(a).overlaps(&outline(b), 0.0)
}
