//! Devices and rays in space, painted from back to front.

use super::super::drawing::{Drawing, Ink, Shape};
use super::super::setting::{INK, MEDIUM, METAL, THIN};
use super::pulse::{self, Front};
use super::rays;
use super::view::{Scenery, SpaceView};
use cloakroom::assembly::{Assembly, Placed};
use cloakroom::device::Contour;
use cloakroom::trace::Line;
use glam::{DVec2, DVec3};
use optics::geometry::{Lens, Polyhedron, Pose, Solid};
use std::f64::consts::TAU;

/// Pieces around a ball.
const AROUND: u32 = 48;

/// Something to be painted: its points in space, and how.
type Item = (Vec<DVec3>, Paint);

enum Paint {
    Face(Ink),
    /// Of a class, in a colour of a width.
    Line(&'static str, (Ink, f64)),
    /// Of a pulse, at the only point.
    Dot(Ink),
}

/// What runs among the devices.
pub(super) struct Light<'a> {
    pub trees: &'a [Vec<Line>],
    pub wavefronts: &'a [Vec<DVec3>],
    pub pulse: &'a [Front],
}

/// Draws the devices, and the rays and wavefronts among them; what is nearer hides what is behind
/// metal.
pub(super) fn draw(
    drawing: &mut Drawing,
    view: &SpaceView,
    assembly: &Assembly,
    light: &Light<'_>,
    scenery: &Scenery,
) {
    let mut solids = Solids { items: Vec::new(), view, scenery };
    for placed in assembly.devices() {
        solids.add_device(placed);
    }
    for line in light.trees.iter().flatten() {
        solids.add_ray(line);
    }
    for front in light.wavefronts {
        solids.add_line(front, "wavefront", rays::FRONT);
    }
    for front in light.pulse {
        let stroke = pulse::stroke(front.power);
        match front.points[..] {
            [_] => solids.items.push((front.points.clone(), Paint::Dot(stroke.0))),
            _ => solids.add_line(&front.points, "pulse", stroke),
        }
    }
    let mut items = solids.items;
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
            Paint::Dot(ink) => drawing
                .add("pulse", Shape::Circle { centre: at[0], radius: pulse::DOT })
                .filled(ink),
        }
        .within(vec![frame.to_vec()]);
    }
    view.draw_axes(drawing);
}

/// What is to be painted.
struct Solids<'a> {
    items: Vec<Item>,
    view: &'a SpaceView,
    scenery: &'a Scenery,
}

impl Solids<'_> {
    /// Adds a line, in its pieces.
    fn add_line(&mut self, points: &[DVec3], class: &'static str, stroke: (Ink, f64)) {
        let pieces = points.windows(2);
        self.items.extend(pieces.map(|pair| (pair.to_vec(), Paint::Line(class, stroke))));
    }

    /// Cuts a ray into short pieces, so that each is before or behind its surroundings.
    fn add_ray(&mut self, line: &Line) {
        let longest = self.scenery.depth() / 40.0;
        for pair in line.points.windows(2) {
            let [from, to] = [pair[0].position, pair[1].position];
            let pieces = (from.distance(to) / longest).ceil().clamp(1.0, 400.0) as u32;
            let at = |k: u32| from.lerp(to, f64::from(k) / f64::from(pieces));
            let points: Vec<DVec3> = (0..=pieces).map(at).collect();
            self.add_line(&points, "ray", rays::stroke(line.power));
        }
    }

    fn add_device(&mut self, placed: &Placed) {
        let structure = &placed.structure;
        for solid in &structure.hull.solids {
            if let Solid::Lens { lens, pose } = solid {
                self.add_lens(lens, &placed.pose.after(pose));
                return;
            }
            if let Solid::Polyhedron { solid, pose } = solid {
                self.add_polyhedron(solid, &placed.pose.after(pose), structure.is_metal());
                return;
            }
        }
        let section = structure.cross_section();
        let is_ball = structure.hull.solids.iter().all(|solid| {
            let whole = match solid {
                Solid::Hollow { whole, .. } => whole.as_ref(),
                solid => solid,
            };
            matches!(whole, Solid::Ball { .. } | Solid::CutBall { .. })
        });
        // Its ends in its own frame; upright ones are cut where the scenery is.
        let half = self.scenery.depth() / 2.0;
        let is_upright = placed.pose.is_upright();
        let middle = if is_upright { self.scenery.z - placed.pose.origin.z } else { 0.0 };
        let shown = [middle - half, middle + half];
        let ends = match structure.hull.bounds(&Pose::IDENTITY) {
            Some([low, high]) => [low.z.max(shown[0]), high.z.min(shown[1])],
            None => shown,
        };
        let borders = section.regions.iter().flat_map(|region| &region.border);
        let outer = section.outlines.iter().chain(borders);
        let outer = outer.filter(|contour| !section.metal.contains(contour));
        let parts = outer.map(|c| (c, false)).chain(section.metal.iter().map(|c| (c, true)));
        for (contour, metal) in parts {
            if is_ball && !structure.hull.solids.is_empty() {
                self.add_ball(placed, contour, metal);
            } else {
                self.add_prism(placed, contour, ends, metal);
            }
        }
    }

    /// A contour drawn out along the device's z.
    fn add_prism(&mut self, placed: &Placed, contour: &Contour, ends: [f64; 2], metal: bool) {
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
                    self.items.push((face.to_vec(), Paint::Face(METAL)));
                }
            }
        }
        let edge = (INK.faint(0.7), THIN);
        for z in ends {
            let rim: Vec<DVec3> = points.iter().map(|point| at(*point, z)).collect();
            if metal && contour.closed {
                self.items.push((rim.clone(), Paint::Face(METAL)));
            }
            self.add_line(&rim, "edge", edge);
        }
        for corner in corners {
            let upright: Vec<DVec3> = (0..=LAYERS).map(|k| at(corner, level(k))).collect();
            self.add_line(&upright, "edge", edge);
        }
    }

    /// A solid with flat faces at its place: its edges, and its faces if it is of metal.
    fn add_polyhedron(&mut self, solid: &Polyhedron, pose: &Pose, metal: bool) {
        for [a, b] in solid.edges() {
            let at = |k: u32| pose.to_world(a.lerp(b, f64::from(k) / 8.0));
            self.add_line(&(0..=8).map(at).collect::<Vec<_>>(), "edge", (INK.faint(0.7), THIN));
        }
        let faces = solid.pieces().filter(|_| metal);
        let place = |piece: [DVec3; 3]| piece.map(|at| pose.to_world(at)).to_vec();
        self.items.extend(faces.map(|piece| (place(piece), Paint::Face(METAL))));
    }

    /// A lens at its place: its two rims, and its outline in two planes through its axis.
    fn add_lens(&mut self, lens: &Lens, pose: &Pose) {
        let edge = (INK.faint(0.7), THIN);
        let [low, high] = lens.between(lens.radius);
        for x in [low, high] {
            let at = |k: u32| {
                let (sin, cos) = (TAU * f64::from(k) / f64::from(AROUND)).sin_cos();
                pose.to_world(DVec3::new(x, lens.radius * cos, lens.radius * sin))
            };
            self.add_line(&(0..=AROUND).map(at).collect::<Vec<_>>(), "edge", edge);
        }
        for up in [DVec3::Y, DVec3::Z] {
            let place = |[x, r]: [f64; 2]| pose.to_world(DVec3::X * x + up * r);
            for face in [&lens.front, &lens.back] {
                let line: Vec<DVec3> = lens.face_line(face, 64).into_iter().map(place).collect();
                self.add_line(&line, "edge", (INK.faint(0.4), THIN));
            }
            for r in [lens.radius, -lens.radius] {
                self.add_line(&[place([low, r]), place([high, r])], "edge", edge);
            }
        }
    }

    /// A circle of a cross-section as a ball: its outline as seen, and its equator; of a cut one
    /// what is left, and the rim.
    fn add_ball(&mut self, placed: &Placed, contour: &Contour, metal: bool) {
        let Some(radius) = contour.points.first().map(|point| point.length()) else { return };
        let centre = placed.pose.origin;
        let toward = self.view.toward;
        let right = toward.any_orthonormal_vector();
        let circle = |u: DVec3, v: DVec3| {
            let at = move |k: u32| {
                let (sin, cos) = (TAU * f64::from(k) / f64::from(AROUND)).sin_cos();
                centre + radius * (u * cos + v * sin)
            };
            (0..=AROUND).map(at)
        };
        let cut = placed.structure.hull.solids.iter().find_map(|solid| match solid {
            Solid::CutBall { ball, .. } => Some(*ball),
            _ => None,
        });
        let is_left = |at: DVec3| {
            let point = placed.pose.to_local(centre.lerp(at, 0.999));
            cut.is_none_or(|ball| ball.height(point) <= 0.0)
        };
        let mut outline: Vec<DVec3> = circle(right, toward.cross(right)).collect();
        if let Some(ball) = cut {
            for at in &mut outline {
                let direction = placed.pose.vector_to_local((*at - centre) / radius);
                *at = placed.pose.to_world(ball.farthest_along(direction));
            }
            let normal = placed.pose.vector_to_world(ball.plane.normal);
            let u = normal.any_orthonormal_vector() * (ball.rim() / radius);
            let rim = circle(u, normal.cross(u)).map(|at| at + normal * ball.plane.offset);
            self.add_line(&rim.collect::<Vec<_>>(), "edge", (INK.faint(0.4), THIN));
        }
        let ink = if metal { METAL } else { MEDIUM.faint(0.3) };
        self.items.push((outline.clone(), Paint::Face(ink)));
        self.add_line(&outline, "edge", (INK, THIN));
        for (u, v) in [(DVec3::X, DVec3::Z), (DVec3::X, DVec3::Y)] {
            let equator: Vec<DVec3> = circle(u, v).collect();
            for pair in equator.windows(2).filter(|pair| is_left(pair[0]) && is_left(pair[1])) {
                let hidden = ((pair[0] + pair[1]) / 2.0 - centre).dot(toward) < 0.0;
                let ink = INK.faint(if hidden { 0.15 } else { 0.4 });
                self.add_line(pair, "edge", (ink, 0.7 * THIN));
            }
        }
    }
}
