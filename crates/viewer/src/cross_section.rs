//! The cross-section of a scene in the plane z = 0, for the page to draw.

use cloakroom::assembly::Placed;
use cloakroom::device::{Contour, Section};
use cloakroom::render::PreparedScene;
use cloakroom::scene::{Appearance, DeviceSettings, Projection, Scene};
use glam::DVec2;
use optics::geometry::Pose;
use serde_json::{Value, json};

/// Coordinates beyond this are drawn no better, cm.
const FAR: f64 = 1e4;

/// The shapes of all devices, the photograph and the camera, in world coordinates, cm.
pub(crate) fn cross_section(scene: &Scene, prepared: &PreparedScene<'_>) -> Value {
    let devices = scene.devices.iter().zip(prepared.assembly.devices());
    let devices: Vec<Value> = devices.map(|(settings, placed)| device(settings, placed)).collect();
    let photograph = prepared.screen.middle_line().map(|end| point(end.x, end.y));
    let camera = &scene.camera;
    let [width_px, height_px] = camera.resolution.map(f64::from);
    let ray = |y: f64| {
        let ray = camera.ray(width_px / 2.0, y);
        json!([point(ray.origin.x, ray.origin.y), point(ray.direction.x, ray.direction.y)])
    };
    json!({
        "devices": devices,
        "photograph": photograph,
        "camera": {
            "position": point(camera.position.x, camera.position.y),
            "edges": [ray(0.0), ray(height_px)],
            "parallel": matches!(camera.projection, Projection::Orthographic),
        },
    })
}

fn device(settings: &DeviceSettings, placed: &Placed) -> Value {
    let (section, pose) = placed.structure.drawn_at(&placed.pose);
    let points = |contour: &Contour| -> Vec<[f64; 2]> {
        let world = contour.points.iter().map(|at| pose.point_to_world(*at));
        world.map(|at| point(at.x, at.y)).collect()
    };
    let all = |contours: &[Contour]| contours.iter().map(points).collect::<Vec<_>>();
    let region = |section: &Section<'_>| json!({ "border": all(&section.border), "index": index(section, &pose) });
    let regions: Vec<Value> = section.regions.iter().map(region).collect();
    let metal = |contour: &Contour| json!({ "points": points(contour), "closed": contour.closed });
    let metal: Vec<Value> = section.metal.iter().chain(&section.polarizers).map(metal).collect();
    let body = section.body.map(|_| match settings.appearance() {
        None => json!("medium"),
        Some(Appearance::Color(color)) => json!(color),
        Some(Appearance::Image(_)) => json!("image"),
    });
    json!({ "regions": regions, "metal": metal, "outlines": all(&section.outlines), "body": body })
}

/// Cells along the longer side of a region whose index is graded: enough to see how it goes.
const CELLS: f64 = 24.0;

/// The mean index of a region: a number, or, where it is graded, a picture of it, whose `rows` from the bottom up lie within
/// the parallelogram of a `corner` and two sides in world coordinates; `null` where the region is not.
fn index(section: &Section<'_>, pose: &Pose) -> Value {
    let at =
        |point| section.region.medium_at(point).map(|medium| rounded(medium.mean_index(), 1e3));
    let corners = || section.border.iter().flat_map(|contour| &contour.points);
    if !section.region.is_graded() {
        return json!(corners().next().and_then(|corner| at(*corner)));
    }
    let least = corners().fold(DVec2::INFINITY, |least, corner| least.min(*corner));
    let most = corners().fold(DVec2::NEG_INFINITY, |most, corner| most.max(*corner));
    let size = most - least;
    let cells = (size / size.max_element() * CELLS).ceil().max(DVec2::ONE);
    let row = |y: u32| -> Vec<Option<f64>> {
        let place = |x: u32| (DVec2::new(x.into(), y.into()) + 0.5) / cells;
        (0..cells.x as u32).map(|x| at(least + size * place(x))).collect()
    };
    let rows: Vec<_> = (0..cells.y as u32).map(row).collect();
    let all = rows.iter().flatten().copied().chain(corners().map(|corner| at(*corner))).flatten();
    let range = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], index| {
        [least.min(index), most.max(index)]
    });
    let corner = pose.point_to_world(least);
    let side = |to: DVec2| {
        let side = pose.point_to_world(to) - corner;
        point(side.x, side.y)
    };
    json!({
        "corner": point(corner.x, corner.y),
        "across": side(DVec2::new(most.x, least.y)),
        "up": side(DVec2::new(least.x, most.y)),
        "rows": rows,
        "range": range,
    })
}

/// A point of the drawing, rounded to what can be seen.
pub(crate) fn point(x: f64, y: f64) -> [f64; 2] {
    [x, y].map(|number| rounded(number.clamp(-FAR, FAR), 1e4))
}

fn rounded(number: f64, steps: f64) -> f64 {
    (number * steps).round() / steps
}
