//! Rays and wavefronts.

use super::super::drawing::{Drawing, Ink};
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

/// Lines in space through the points of equal optical path of neighbouring rays: of each the
/// strongest branch there. They are `distance` apart in optical path, cm; points of neighbouring
/// rays further than `apart` from each other, cm, are not of one front.
pub(super) fn wavefronts(
    trees: &[Vec<Line>],
    assembly: &Assembly,
    [distance, apart]: [f64; 2],
) -> Vec<Vec<DVec3>> {
    /// Weaker branches have no wavefronts of their own.
    const LEAST_POWER: f64 = 0.2;
    const MOST: u32 = 4000;
    let is_metal = |at: DVec3| {
        assembly.devices().iter().any(|placed| {
            let material = placed.structure.material_at(placed.pose.to_local(at));
            matches!(material, MaterialAt::Metal | MaterialAt::Opaque)
        })
    };
    let is_air = |at: DVec3| {
        assembly.devices().iter().all(|placed| {
            let material = placed.structure.material_at(placed.pose.to_local(at));
            matches!(material, MaterialAt::Air | MaterialAt::HiddenAir)
        })
    };
    // Near, without metal between them, and, in air, where fronts are across rays, across both: a ray that
    // a mirror has sent back and one that has missed it are of no front.
    let are_one = |(a, along_a): (DVec3, DVec3), (b, along_b): (DVec3, DVec3)| {
        /// The cosine of 73 degrees.
        const STEEPEST: f64 = 0.3;
        const BETWEEN: u32 = 16;
        let between = (1..BETWEEN).map(|i| a.lerp(b, f64::from(i) / f64::from(BETWEEN)));
        let chord = (b - a).normalize_or_zero();
        let is_across = |along: DVec3| chord.dot(along).abs() < STEEPEST;
        a.distance(b) < apart
            && (!is_air(a) || !is_air(b) || is_across(along_a) && is_across(along_b))
            && !between.into_iter().any(is_metal)
    };
    let longest = trees.iter().flatten().filter_map(|line| line.points.last());
    let longest = longest.map(|point| point.optical_path).fold(0.0, f64::max);
    let count = ((longest / distance) as u32).min(MOST);
    let mut fronts = Vec::new();
    for number in 1..=count {
        let path = f64::from(number) * distance;
        let strongest = |tree: &Vec<Line>| {
            let strong = tree.iter().filter(|line| line.power > LEAST_POWER);
            let met = strong.filter_map(|line| Some((line.power, point_at(line, path)?)));
            met.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point)
        };
        let mut front: Vec<DVec3> = Vec::new();
        let mut last: Option<(DVec3, DVec3)> = None;
        for point in trees.iter().map(strongest).chain([None]) {
            if !matches!((last, point), (Some(a), Some(b)) if are_one(a, b)) {
                let whole = std::mem::take(&mut front);
                fronts.extend(Some(whole).filter(|front| front.len() > 1));
            }
            front.extend(point.map(|(point, _)| point));
            last = point;
        }
    }
    fronts
}

/// Where the optical path along a line has a value, and the line's direction there.
fn point_at(line: &Line, path: f64) -> Option<(DVec3, DVec3)> {
    let between = |pair: &&[PathPoint]| {
        let [a, b] = [pair[0].optical_path, pair[1].optical_path];
        a.min(b) <= path && path < a.max(b)
    };
    let pair = line.points.windows(2).find(between)?;
    let share = (path - pair[0].optical_path) / (pair[1].optical_path - pair[0].optical_path);
    let [from, to] = [pair[0].position, pair[1].position];
    Some((from.lerp(to, share), (to - from).normalize_or_zero()))
}
