//! The rays of one point of the picture: every branch with its power, for the cross-section.

use crate::cross_section::point;
use crate::protocol::Ray;
use cloakroom::render::{PreparedScene, pulses};
use cloakroom::scene::Scene;
use cloakroom::trace::{Launch, Limits, Line, lines};
use serde_json::{Value, json};

/// Branches weaker than this are not drawn.
const LEAST_POWER: f64 = 1e-3;

/// Most pieces of the tree that are drawn, the strongest.
const MOST_LINES: usize = 600;

/// Most pulses that are listed.
const MOST_PULSES: usize = 8;

/// How far light is followed that meets nothing more, cm.
const REACH: f64 = 400.0;

/// The rays of a point of the picture, as pages are told them.
#[must_use]
pub fn rays(prepared: &PreparedScene<'_>, ray: &Ray) -> Value {
    json!({ "rays": answer(prepared.scene, prepared, ray) })
}

fn answer(scene: &Scene, prepared: &PreparedScene<'_>, ray: &Ray) -> Value {
    let camera = &scene.camera;
    let size = camera.resolution;
    let pixel: [u32; 2] = std::array::from_fn(|i| {
        // Shares lie between 0 and 1.
        ((ray.at[i] * f64::from(size[i])) as u32).min(size[i] - 1)
    });
    let [x, y] = pixel.map(|index| f64::from(index) + 0.5);
    let sight = camera.ray(x, y);
    let (h, v) = camera.polarization_basis(sight.direction);
    let limits = Limits {
        min_power: prepared.limits.min_power.max(LEAST_POWER),
        tolerance: prepared.limits.tolerance.max(1e-4),
    };
    let (origin, direction, assembly) = (sight.origin, sight.direction, &prepared.assembly);
    let mut tree = match camera.polarizer.amplitudes() {
        None => {
            let launch = Launch { origin, direction, electric: [h.into(), v.into()] };
            lines(assembly, limits, &launch, [0.5, 0.5], REACH)
        }
        Some([a, b]) => {
            let launch = Launch { origin, direction, electric: [(h * a + v * b).into()] };
            lines(assembly, limits, &launch, [1.0], REACH)
        }
    };
    tree.sort_by(|a, b| b.power.total_cmp(&a.power));
    tree.truncate(MOST_LINES);
    let drawn: Vec<Value> = tree.iter().map(|line| drawn(line, prepared)).collect();
    let list = pulses(prepared, pixel).ok().and_then(|mut list| {
        list.pulses.truncate(MOST_PULSES);
        serde_json::to_value(list).ok()
    });
    json!({ "id": ray.id, "pixel": pixel, "lines": drawn, "pulses": list })
}

/// A piece of the tree; a leaf ends on the photograph if it gets there.
fn drawn(line: &Line, prepared: &PreparedScene<'_>) -> Value {
    let mut points: Vec<[f64; 2]> =
        line.points.iter().map(|at| point(at.position.x, at.position.y)).collect();
    let mut lands = false;
    if let (true, [from, to]) = (line.leaves, &line.points[..]) {
        let direction = (to.position - from.position).normalize_or_zero();
        if let Some(distance) = prepared.screen.hit(from.position, direction, 0.0) {
            let end = from.position + direction * distance;
            points[1] = point(end.x, end.y);
            lands = true;
        }
    }
    json!({ "power": line.power, "points": points, "leaves": line.leaves, "lands": lands })
}
