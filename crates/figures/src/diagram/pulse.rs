//! A pulse on its way through a diagram: the points that it has come to at one time.

use super::super::drawing::{Drawing, Ink, Shape};
use super::super::film::time_in_words;
use super::super::setting::PAPER;
use super::rays::{Joints, RayPoint, between};
use super::view::Scenery;
use cloakroom::render::Delay;
use cloakroom::trace::{Line, PathTime};
use glam::{DVec2, DVec3};

/// A pulse at one time of its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// When, ns: after it has left the point or the camera that the rays come from; if they are parallel,
    /// after it would be in the middle of the devices, were there nothing in its way.
    pub time: f64,
    /// Which of the two times of light counts.
    pub delay: Delay,
    /// How exact the clock is, ns.
    pub step: f64,
}

/// Points of neighbouring rays to which one piece of a pulse has come.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Front {
    /// From ray to ray; one alone where no neighbour has come to the same.
    pub points: Vec<DVec3>,
    /// The mean share of the power of their rays.
    pub power: f64,
}

impl Pulse {
    pub(super) fn words(&self) -> String {
        let which = match self.delay {
            Delay::Group => "pulse",
            Delay::Phase => "phase",
        };
        format!("{which} at {}", time_in_words(self.time, self.step))
    }
}

/// The delay that counts, cm.
fn counted(delay: Delay) -> impl Fn(&PathTime) -> f64 {
    move |time| match delay {
        Delay::Group => time.pulse,
        Delay::Phase => time.phase,
    }
}

/// The pieces of a pulse that has been on its way for so long (cm): each goes from ray to ray along
/// branches that have taken the same turns, or else along those that are nearest, and as strong.
pub(super) fn fronts(
    trees: &[Vec<Line>],
    joints: &Joints<'_>,
    way: f64,
    delay: Delay,
) -> Vec<Front> {
    /// Branches of different turns are of one front if one has at most so much more power.
    const MOST_STRONGER: f64 = 2.0;
    let mut whole: Vec<Vec<RayPoint>> = Vec::new();
    // Of the last ray, which front its points are of.
    let mut last: Vec<(RayPoint, usize)> = Vec::new();
    for tree in trees {
        let points = tree.iter().filter_map(|line| point_at(line, way, delay));
        let points: Vec<RayPoint> = points.collect();
        let mut pairs: Vec<(bool, f64, usize, usize)> = Vec::new();
        for (i, (a, _)) in last.iter().enumerate() {
            for (j, b) in points.iter().enumerate() {
                let same = a.branch == b.branch;
                let ratio = a.power / b.power;
                let alike = (MOST_STRONGER.recip()..=MOST_STRONGER).contains(&ratio);
                if same && joints.are_near(a, b) || alike && joints.are_one(a, b) {
                    pairs.push((!same, a.at.distance_squared(b.at), i, j));
                }
            }
        }
        // Those of the same turns before all others, then those that are nearest.
        pairs.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut goes_on = vec![false; last.len()];
        let mut front_of: Vec<Option<usize>> = vec![None; points.len()];
        for (_, _, i, j) in pairs {
            if !goes_on[i] && front_of[j].is_none() {
                (goes_on[i], front_of[j]) = (true, Some(last[i].1));
            }
        }
        last.clear();
        for (point, front) in points.into_iter().zip(front_of) {
            let front = front.unwrap_or_else(|| {
                whole.push(Vec::new());
                whole.len() - 1
            });
            whole[front].push(point);
            last.push((point, front));
        }
    }
    let front = |points: Vec<RayPoint>| Front {
        power: points.iter().map(|point| point.power).sum::<f64>() / points.len() as f64,
        points: points.into_iter().map(|point| point.at).collect(),
    };
    let mut fronts: Vec<Front> = whole.into_iter().map(front).collect();
    fronts.sort_by(|a, b| a.power.total_cmp(&b.power));
    fronts
}

/// Where a pulse is on a line, if it is.
pub(super) fn point_at(line: &Line, way: f64, delay: Delay) -> Option<RayPoint> {
    let counted = counted(delay);
    let mut pieces = line.points.windows(2).zip(line.times.windows(2));
    pieces.find_map(|(points, times)| {
        let share = between([counted(&times[0]), counted(&times[1])], way)?;
        Some(RayPoint::on(line, [points[0].position, points[1].position], share))
    })
}

/// From when to when (cm) a pulse is in the part of the cross-section that is shown: until the last of
/// the light that leaves the devices has left it.
pub(super) fn seen(trees: &[Vec<Line>], scenery: &Scenery, delay: Delay) -> Option<[f64; 2]> {
    /// Weaker branches have no say in how long it is looked at.
    const LEAST_POWER: f64 = 0.05;
    let counted = counted(delay);
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for line in trees.iter().flatten().filter(|line| line.power >= LEAST_POWER) {
        for (points, times) in line.points.windows(2).zip(line.times.windows(2)) {
            let ends = [points[0].position, points[1].position].map(DVec3::truncate);
            let Some(shares) = scenery.shown_part(ends) else { continue };
            let [from, to] = [counted(&times[0]), counted(&times[1])];
            let [first, last] = shares.map(|share| from + (to - from) * share);
            range[0] = range[0].min(first);
            if line.leaves {
                range[1] = range[1].max(last);
            }
        }
    }
    (range[0] <= range[1]).then_some(range)
}

/// The stroke of a front of some power.
pub(super) fn stroke(power: f64) -> (Ink, f64) {
    const INK: Ink = Ink::new([0, 56, 168]);
    (INK.faint(power.clamp(0.0, 1.0).powf(0.4).max(0.15)), 3.0)
}

/// How large a front of one ray alone is drawn.
pub(super) const DOT: f64 = 2.6;

/// Draws the pieces of a pulse, the strong over the weak.
pub(super) fn draw(
    drawing: &mut Drawing,
    place: &dyn Fn(DVec3) -> DVec2,
    frame: &[DVec2; 4],
    fronts: &[Front],
) {
    let drawn: Vec<(Vec<DVec2>, (Ink, f64))> = fronts
        .iter()
        .map(|front| (front.points.iter().map(|at| place(*at)).collect(), stroke(front.power)))
        .collect();
    for (points, (ink, width)) in drawn.iter().filter(|(points, _)| points.len() > 1) {
        let rim = (PAPER.faint(0.7 * ink.opacity), width + 2.0);
        drawing.add_line("pulse-rim", points.clone(), rim).within(vec![frame.to_vec()]);
    }
    for (points, (ink, width)) in drawn {
        match points[..] {
            [centre] => {
                let dot = Shape::Circle { centre, radius: DOT };
                drawing.add("pulse", dot).filled(ink).within(vec![frame.to_vec()]);
            }
            _ => {
                drawing.add_line("pulse", points, (ink, width)).within(vec![frame.to_vec()]);
            }
        }
    }
}
