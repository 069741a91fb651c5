//! The rays of one point of the picture: every branch with its power, for the cross-section.

use crate::client::Outbox;
use crate::cross_section::point;
use crate::painter::Shown;
use crate::protocol::Ray;
use crate::slot::Slot;
use cloakroom::render::{Images, PreparedScene, pulses};
use cloakroom::scene::Scene;
use cloakroom::trace::{Launch, Limits, Line, lines};
use serde_json::{Value, json};
use std::sync::Arc;

/// Branches weaker than this are not drawn.
const LEAST_POWER: f64 = 1e-3;

/// Most pieces of the tree that are drawn, the strongest.
const MOST_LINES: usize = 600;

/// Most pulses that are listed.
const MOST_PULSES: usize = 8;

/// How far light is followed that meets nothing more, cm.
const REACH: f64 = 400.0;

/// What to follow: a point of what is shown.
pub(crate) type Wish = (Ray, Arc<Shown>);

/// Follows rays until the slot is closed.
pub(crate) fn follow(slot: &Slot<Wish>, outbox: &Outbox) {
    let mut images = Images::default();
    let mut next = slot.take();
    while let Some((_, shown)) = next.clone() {
        images.clone_from(&shown.images);
        // The devices are built once for all points of one picture.
        let prepared = PreparedScene::with_images(&shown.scene, &mut images);
        while let Some((ray, same)) = &next
            && Arc::ptr_eq(same, &shown)
        {
            if let Ok(prepared) = &prepared {
                let answer = json!({ "rays": answer(&shown.scene, prepared, ray) });
                if outbox.say(&answer).is_err() {
                    return;
                }
            }
            next = slot.take();
        }
    }
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
