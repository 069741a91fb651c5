//! Rays and wavefronts.

use super::super::drawing::{Drawing, Ink};
use super::super::setting::{HEAD, INK, PAPER, arrow_head};
use cloakroom::assembly::Assembly;
use cloakroom::device::MaterialAt;
use cloakroom::trace::Line;
use glam::{DVec2, DVec3};

/// The colour of rays.
const RAY: Ink = Ink::new([192, 32, 0]);
/// The width of a ray of all the power.
const WIDEST: f64 = 2.4;
/// The colour and the width of wavefronts.
pub(super) const FRONT: (Ink, f64) = (INK.faint(0.75), 1.1);
/// The light rim of rays on dark ground.
const RIM: Ink = PAPER.faint(0.55);

/// The stroke of a ray of some power: width and opacity fall with it.
pub(super) fn stroke(power: f64) -> (Ink, f64) {
    let share = power.clamp(0.0, 1.0);
    (RAY.faint(share.powf(0.4).max(0.12)), (WIDEST * share.powf(0.35)).max(0.6))
}

/// Draws the rays, the strong before the weak.
pub(super) fn draw(
    drawing: &mut Drawing,
    place: &dyn Fn(DVec3) -> DVec2,
    frame: &[DVec2; 4],
    trees: &[Vec<Line>],
) {
    let mut lines: Vec<&Line> = trees.iter().flatten().collect();
    lines.sort_by(|a, b| a.power.total_cmp(&b.power));
    let drawn: Vec<(Vec<DVec2>, &Line)> = lines
        .into_iter()
        .map(|line| (line.points.iter().map(|point| place(point.position)).collect(), line))
        .collect();
    for (points, line) in &drawn {
        let rim = (RIM.faint(RIM.opacity * line.power.min(1.0)), stroke(line.power).1 + 2.0);
        drawing.add_line("ray-rim", points.clone(), rim).within(vec![frame.to_vec()]);
    }
    for (points, line) in &drawn {
        let ray = drawing.add_line("ray", points.clone(), stroke(line.power));
        ray.within(vec![frame.to_vec()]);
    }
    for (points, line) in &drawn {
        if line.power > 0.3 && line.leaves {
            draw_head(drawing, frame, points, line.power);
        }
    }
}

/// An arrow's head where a line leaves the frame.
fn draw_head(drawing: &mut Drawing, frame: &[DVec2; 4], points: &[DVec2], power: f64) {
    let [from, to] = [points[0], points[points.len() - 1]];
    let [low, high] = [frame[0].min(frame[2]), frame[0].max(frame[2])];
    let inside = |p: DVec2| p.cmpge(low).all() && p.cmple(high).all();
    if !inside(from) {
        return;
    }
    let along = (to - from).normalize_or(DVec2::X);
    let edge = DVec2::select(along.cmpgt(DVec2::ZERO), high, low);
    let way = ((edge - from) / along).min_element();
    if way.is_finite() && way > 3.0 * HEAD {
        let head = arrow_head(from + along * (way - 4.0), -along, HEAD);
        drawing.add("ray-head", head).filled(stroke(power).0);
    }
}

/// A point of a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayPoint {
    pub at: DVec3,
    /// The unit vector of the ray there.
    pub along: DVec3,
    /// Its share of the power launched.
    pub power: f64,
    /// The fingerprint of its turns.
    pub branch: u64,
}

impl RayPoint {
    /// That of a line between two of its points.
    pub fn on(line: &Line, [from, to]: [DVec3; 2], share: f64) -> Self {
        let along = (to - from).normalize_or_zero();
        Self { at: from.lerp(to, share), along, power: line.power, branch: line.branch }
    }
}

/// Tells which points of neighbouring rays are of one wavefront.
pub(super) struct Joints<'a> {
    pub assembly: &'a Assembly,
    /// Points of neighbouring rays further from each other than this, cm, are not of one front.
    pub apart: f64,
}

impl Joints<'_> {
    fn any_is(&self, at: DVec3, is: fn(MaterialAt) -> bool) -> bool {
        self.assembly
            .devices()
            .iter()
            .any(|placed| is(placed.structure.material_at(placed.pose.to_local(at))))
    }

    fn is_air(&self, at: DVec3) -> bool {
        !self.any_is(at, |material| !matches!(material, MaterialAt::Air | MaterialAt::HiddenAir))
    }

    /// Whether fronts are across rays at a point: the media there are isotropic.
    fn is_isotropic(&self, at: DVec3) -> bool {
        !self.any_is(at, |material| matches!(material, MaterialAt::Medium(m) if !m.is_isotropic()))
    }

    /// Near, without metal between them.
    pub fn are_near(&self, a: &RayPoint, b: &RayPoint) -> bool {
        const BETWEEN: u32 = 16;
        let mut between = (1..BETWEEN).map(|i| a.at.lerp(b.at, f64::from(i) / f64::from(BETWEEN)));
        a.at.distance(b.at) < self.apart
            && !between.any(|at| {
                self.any_is(at, |material| {
                    matches!(material, MaterialAt::Metal | MaterialAt::Opaque)
                })
            })
    }

    /// Near and, where fronts are across rays, across both: a ray that a mirror has sent back and one that has missed
    /// it are of no front, nor are two of which one has missed a device that holds the other up.
    pub fn are_one(&self, a: &RayPoint, b: &RayPoint) -> bool {
        /// The cosine of 73 degrees: how steep the line from one to the other may be.
        const STEEP: f64 = 0.3;
        /// How far it may be from being across the mean of both: 7 degrees.
        const ASKEW: f64 = 0.12;
        let chord = (b.at - a.at).normalize_or_zero();
        let mean = (a.along + b.along).normalize_or_zero();
        let are_across = chord.dot(a.along).abs().max(chord.dot(b.along).abs()) < STEEP
            && chord.dot(mean).abs() < ASKEW
            && a.along.dot(b.along) > 0.0;
        let [air_at_a, air_at_b] = [a.at, b.at].map(|at| self.is_air(at));
        // At borders fronts have kinks, and of few rays in graded media they are coarse.
        let may_lean = if a.branch == b.branch {
            !air_at_a || !air_at_b
        } else {
            air_at_a != air_at_b || !self.is_isotropic(a.at) || !self.is_isotropic(b.at)
        };
        (are_across || may_lean) && self.are_near(a, b)
    }
}

/// The longest optical path of rays, cm.
pub(super) fn longest<'a>(lines: impl Iterator<Item = &'a Line>) -> f64 {
    let ends = lines.filter_map(|line| line.points.last());
    ends.map(|point| point.optical_path).fold(0.0, f64::max)
}

/// Lines in space through the points of equal optical path of neighbouring rays: of each the
/// strongest branch there. They are `distance` apart in optical path, cm.
pub(super) fn wavefronts(
    trees: &[Vec<Line>],
    joints: &Joints<'_>,
    distance: f64,
) -> Vec<Vec<DVec3>> {
    /// Weaker branches have no wavefronts of their own.
    const LEAST_POWER: f64 = 0.2;
    let count = (longest(trees.iter().flatten()) / distance) as u32;
    let mut fronts = Vec::new();
    for number in 1..=count {
        let path = f64::from(number) * distance;
        let strongest = |tree: &Vec<Line>| {
            let strong = tree.iter().filter(|line| line.power > LEAST_POWER);
            let met = strong.filter_map(|line| point_at(line, path));
            met.max_by(|a, b| a.power.total_cmp(&b.power))
        };
        let mut front: Vec<DVec3> = Vec::new();
        let mut last: Option<RayPoint> = None;
        for point in trees.iter().map(strongest).chain([None]) {
            if !matches!((&last, &point), (Some(a), Some(b)) if joints.are_one(a, b)) {
                let whole = std::mem::take(&mut front);
                fronts.extend(Some(whole).filter(|front| front.len() > 1));
            }
            front.extend(point.map(|point| point.at));
            last = point;
        }
    }
    fronts
}

/// Where the optical path along a line has a value.
fn point_at(line: &Line, path: f64) -> Option<RayPoint> {
    line.points.windows(2).find_map(|pair| {
        let share = between([pair[0].optical_path, pair[1].optical_path], path)?;
        Some(RayPoint::on(line, [pair[0].position, pair[1].position], share))
    })
}

/// Which share of the way from one value to the other another one is, if it is between them.
pub(super) fn between([from, to]: [f64; 2], value: f64) -> Option<f64> {
    (from.min(to) <= value && value < from.max(to)).then(|| (value - from) / (to - from))
}
