//! Devices and rays in space, painted from back to front.

use super::super::drawing::{Drawing, Ink};
use super::super::setting::{INK, MEDIUM, METAL, THIN};
use super::rays;
use super::view::{Scenery, SpaceView};
use cloakroom::assembly::{Assembly, Placed};
use cloakroom::device::Contour;
use cloakroom::trace::Line;
use glam::{DVec2, DVec3};
use optics::geometry::{Pose, Solid};
use std::f64::consts::TAU;

/// Pieces around a ball.
const AROUND: u32 = 48;

/// Something to be painted: its points in space, and how.
type Item = (Vec<DVec3>, Paint);

enum Paint {
    Face(Ink),
    /// Of a class, in a colour of a width.
    Line(&'static str, (Ink, f64)),
}

/// Draws the devices, and the rays and wavefronts among them; what is nearer hides what is behind metal.
pub(super) fn draw(
    drawing: &mut Drawing,
    view: &SpaceView,
    assembly: &Assembly,
    (trees, fronts): (&[Vec<Line>], &[Vec<DVec3>]),
    scenery: &Scenery,
) {
    let mut items = Vec::new();
    for placed in assembly.devices() {
        add_device(&mut items, view, placed, scenery);
    }
    for line in trees.iter().flatten() {
        add_ray(&mut items, line, scenery);
    }
    for pair in fronts.iter().flat_map(|front| front.windows(2)) {
        items.push((pair.to_vec(), Paint::Line("wavefront", rays::FRONT)));
    }
    let depth = |(points, _): &Item| {
        let sum: f64 = points.iter().map(|point| point.dot(view.toward)).sum();
        sum / points.len() as f64
    };
    items.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    let frame = view.frame();
    for (points, paint) in items {
        let at: Vec<DVec2> = points.iter().map(|point| view.place(*point)).collect();
        match paint {
            Paint::Face(ink) => drawing.add_area("face", at).filled(ink),
            Paint::Line(class, stroke) => drawing.add_line(class, at, stroke),
        }
        .within(vec![frame.to_vec()]);
    }
    view.draw_axes(drawing);
}

/// Cuts a ray into short pieces, so that each is before or behind its surroundings.
fn add_ray(items: &mut Vec<Item>, line: &Line, scenery: &Scenery) {
    let longest = scenery.depth() / 40.0;
    for pair in line.points.windows(2) {
        let [from, to] = [pair[0].position, pair[1].position];
        let pieces = (from.distance(to) / longest).ceil().clamp(1.0, 400.0) as u32;
        let at = |k: u32| from.lerp(to, f64::from(k) / f64::from(pieces));
        for k in 0..pieces {
            items.push((vec![at(k), at(k + 1)], Paint::Line("ray", rays::stroke(line.power))));
        }
    }
}

fn add_device(items: &mut Vec<Item>, view: &SpaceView, placed: &Placed, scenery: &Scenery) {
    let structure = &placed.structure;
    let section = structure.cross_section();
    let is_ball = structure.hull.solids().iter().all(|solid| {
        let whole = match solid {
            Solid::Hollow { whole, .. } => whole.as_ref(),
            solid => solid,
        };
        matches!(whole, Solid::Ball { .. } | Solid::CutBall { .. })
    });
    // Its ends in its own frame; upright ones are cut where the scenery is.
    let half = scenery.depth() / 2.0;
    let middle = if placed.pose.is_upright() { scenery.z - placed.pose.origin().z } else { 0.0 };
    let shown = [middle - half, middle + half];
    let ends = match structure.hull.bounds(&Pose::IDENTITY) {
        Some([low, high]) => [low.z.max(shown[0]), high.z.min(shown[1])],
        None => shown,
    };
    let borders = section.regions.iter().flat_map(|region| &region.border);
    let outer =
        section.outlines.iter().chain(borders).filter(|contour| !section.metal.contains(contour));
    let parts = outer.map(|c| (c, false)).chain(section.metal.iter().map(|c| (c, true)));
    for (contour, metal) in parts {
        if is_ball && !structure.hull.solids().is_empty() {
            add_ball(items, view, placed, contour, metal);
        } else {
            add_prism(items, placed, contour, ends, metal);
        }
    }
}

/// A contour drawn out along the device's z.
fn add_prism(
    items: &mut Vec<Item>,
    placed: &Placed,
    contour: &Contour,
    ends: [f64; 2],
    metal: bool,
) {
    let mut points = contour.points.clone();
    let corners = if points.len() > 16 { Vec::new() } else { contour.corners() };
    let at = |point: DVec2, z: f64| placed.pose.to_world(point.extend(z));
    if contour.closed {
        points.extend(points.first().copied());
    }
    const LAYERS: u32 = 16;
    let level = |k: u32| ends[0] + (ends[1] - ends[0]) * f64::from(k) / f64::from(LAYERS);
    // Only metal hides what is behind it. Straight sides are cut, to be sorted among the rays.
    for pair in points.windows(2).filter(|_| metal) {
        let side = (ends[1] - ends[0]) / 12.0;
        let pieces = (pair[0].distance(pair[1]) / side).ceil().max(1.0) as u32;
        for i in 0..pieces {
            let [a, b] =
                [i, i + 1].map(|i| pair[0].lerp(pair[1], f64::from(i) / f64::from(pieces)));
            for k in 0..LAYERS {
                let [low, high] = [level(k), level(k + 1)];
                let face = [at(a, low), at(b, low), at(b, high), at(a, high)];
                items.push((face.to_vec(), Paint::Face(METAL)));
            }
        }
    }
    let edge = || Paint::Line("edge", (INK.faint(0.7), THIN));
    for z in ends {
        for pair in points.windows(2) {
            items.push((pair.iter().map(|point| at(*point, z)).collect(), edge()));
        }
    }
    for corner in corners {
        for k in 0..LAYERS {
            items.push((vec![at(corner, level(k)), at(corner, level(k + 1))], edge()));
        }
    }
}

/// A circle of a cross-section as a ball: its outline as seen, and its equator; of a cut one what is left, and the rim.
fn add_ball(
    items: &mut Vec<Item>,
    view: &SpaceView,
    placed: &Placed,
    contour: &Contour,
    metal: bool,
) {
    let Some(radius) = contour.points.first().map(|point| point.length()) else { return };
    let centre = placed.pose.origin();
    let toward = view.toward;
    let right = toward.any_orthonormal_vector();
    let circle = |u: DVec3, v: DVec3| {
        let at = move |k: u32| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(AROUND)).sin_cos();
            centre + radius * (u * cos + v * sin)
        };
        (0..=AROUND).map(at).collect::<Vec<_>>()
    };
    let cut = placed.structure.hull.solids().iter().find_map(|solid| match solid {
        Solid::CutBall { ball, .. } => Some(*ball),
        _ => None,
    });
    let is_left = |at: DVec3| {
        let point = placed.pose.to_local(centre.lerp(at, 0.999));
        cut.is_none_or(|ball| ball.height(point) <= 0.0)
    };
    let mut outline = circle(right, toward.cross(right));
    if let Some(ball) = cut {
        for at in &mut outline {
            let direction = placed.pose.vector_to_local((*at - centre) / radius);
            *at = placed.pose.to_world(ball.farthest_along(direction));
        }
        let normal = placed.pose.vector_to_world(ball.plane.normal);
        let u = normal.any_orthonormal_vector() * (ball.rim() / radius);
        let rim = circle(u, normal.cross(u)).into_iter().map(|at| at + normal * ball.plane.offset);
        for pair in rim.collect::<Vec<_>>().windows(2) {
            items.push((pair.to_vec(), Paint::Line("edge", (INK.faint(0.4), THIN))));
        }
    }
    let ink = if metal { METAL } else { MEDIUM.faint(0.3) };
    items.push((outline.clone(), Paint::Face(ink)));
    for pair in outline.windows(2) {
        items.push((pair.to_vec(), Paint::Line("edge", (INK, THIN))));
    }
    for (u, v) in [(DVec3::X, DVec3::Z), (DVec3::X, DVec3::Y)] {
        for pair in circle(u, v).windows(2).filter(|pair| is_left(pair[0]) && is_left(pair[1])) {
            let hidden = ((pair[0] + pair[1]) / 2.0 - centre).dot(toward) < 0.0;
            let ink = INK.faint(if hidden { 0.15 } else { 0.4 });
            items.push((pair.to_vec(), Paint::Line("edge", (ink, 0.7 * THIN))));
        }
    }
}
