//! Rays and wavefronts.

use super::super::drawing::{Drawing, Ink, Shape};
use super::super::setting::{HEAD, INK, PAPER, arrow_head};
use cloakroom::assembly::Assembly;
use cloakroom::device::MaterialAt;
use cloakroom::trace::Line;
use glam::{DVec2, DVec3};
use optics::propagation::PathPoint;

/// The colour of rays.
const RAY: Ink = Ink::new([192, 32, 0]);
/// The width of a ray of all the power.
const WIDEST: f64 = 2.4;
/// The colour and the width of wavefronts.
pub(super) const FRONT: Ink = INK.faint(0.75);
pub(super) const FRONT_WIDTH: f64 = 1.1;
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
    frame: &[DVec2],
    trees: &[Vec<Line>],
) {
    let mut lines: Vec<&Line> = trees.iter().flatten().collect();
    lines.sort_by(|a, b| a.power.total_cmp(&b.power));
    let drawn: Vec<(Vec<DVec2>, &Line)> = lines
        .into_iter()
        .map(|line| (line.points.iter().map(|point| place(point.position)).collect(), line))
        .collect();
    for (points, line) in &drawn {
        let rim = drawing.add("ray-rim", Shape::Line(points.clone()));
        rim.stroked(RIM.faint(RIM.opacity * line.power.min(1.0)), stroke(line.power).1 + 2.0);
        rim.within(vec![frame.to_vec()]);
    }
    for (points, line) in &drawn {
        let (ink, width) = stroke(line.power);
        let ray = drawing.add("ray", Shape::Line(points.clone()));
        ray.stroked(ink, width).within(vec![frame.to_vec()]);
    }
    for (points, line) in &drawn {
        if line.power > 0.3 && line.leaves {
            draw_head(drawing, frame, points, line.power);
        }
    }
}

/// An arrow's head where a line leaves the frame.
fn draw_head(drawing: &mut Drawing, frame: &[DVec2], points: &[DVec2], power: f64) {
    let [from, to] = [points[0], points[points.len() - 1]];
    let Some((low, high)) = frame.iter().fold(None, |known: Option<(DVec2, DVec2)>, p| {
        Some(known.map_or((*p, *p), |(low, high)| (low.min(*p), high.max(*p))))
    }) else {
        return;
    };
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

/// Lines through the points of equal optical path of neighbouring rays: of each the strongest branch there.
pub(super) struct Wavefronts {
    /// How far apart they are in optical path, cm.
    pub distance: f64,
    /// Points of neighbouring rays further apart than this are not of one front, cm.
    pub apart: f64,
}

impl Wavefronts {
    /// Draws them.
    pub fn draw(
        &self,
        drawing: &mut Drawing,
        place: &dyn Fn(DVec3) -> DVec2,
        frame: &[DVec2],
        trees: &[Vec<Line>],
        assembly: &Assembly,
    ) {
        for front in self.lines(trees, assembly) {
            let line = Shape::Line(front.into_iter().map(place).collect());
            let line = drawing.add("wavefront", line);
            line.stroked(FRONT, FRONT_WIDTH).within(vec![frame.to_vec()]);
        }
    }

    /// The fronts as lines in space.
    pub fn lines(&self, trees: &[Vec<Line>], assembly: &Assembly) -> Vec<Vec<DVec3>> {
        /// Weaker branches have no wavefronts of their own.
        const LEAST_POWER: f64 = 0.2;
        const MOST: u32 = 4000;
        let longest = trees.iter().flatten().filter_map(|line| line.points.last());
        let longest = longest.map(|point| point.optical_path).fold(0.0, f64::max);
        let count = ((longest / self.distance) as u32).min(MOST);
        let mut fronts = Vec::new();
        for number in 1..=count {
            let path = f64::from(number) * self.distance;
            let strongest = |tree: &Vec<Line>| {
                let strong = tree.iter().filter(|line| line.power > LEAST_POWER);
                let met = strong.filter_map(|line| Some((line.power, point_at(line, path)?)));
                met.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point)
            };
            let mut front: Vec<DVec3> = Vec::new();
            let mut last: Option<DVec3> = None;
            for point in trees.iter().map(strongest).chain([None]) {
                let joins =
                    matches!((last, point), (Some(a), Some(b)) if self.are_one(a, b, assembly));
                if !joins {
                    let whole = std::mem::take(&mut front);
                    fronts.extend(Some(whole).filter(|front| front.len() > 1));
                }
                front.extend(point);
                last = point;
            }
        }
        fronts
    }

    /// Whether points of neighbouring rays are of one front: near, and without metal between them.
    fn are_one(&self, a: DVec3, b: DVec3, assembly: &Assembly) -> bool {
        let is_metal = |at: DVec3| {
            let devices = assembly.devices().iter();
            let mut occupants =
                devices.map(|placed| placed.structure.material_at(placed.pose.to_local(at)));
            occupants.any(|occupant| matches!(occupant, MaterialAt::Metal | MaterialAt::Opaque))
        };
        a.distance(b) < self.apart
            && [0.2, 0.5, 0.8].iter().all(|share| !is_metal(a.lerp(b, *share)))
    }
}

/// Where the optical path along a line has a value.
fn point_at(line: &Line, path: f64) -> Option<DVec3> {
    let between = |pair: &&[PathPoint]| {
        let [a, b] = [pair[0].optical_path, pair[1].optical_path];
        a.min(b) <= path && path < a.max(b)
    };
    let pair = line.points.windows(2).find(between)?;
    let share = (path - pair[0].optical_path) / (pair[1].optical_path - pair[0].optical_path);
    Some(pair[0].position.lerp(pair[1].position, share))
}
