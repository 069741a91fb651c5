//! What the devices of a scene look like from outside, as triangles in the world's frame: for other
//! programs and for printing in space. Curved surfaces are cut into flat pieces.

mod files;
mod tessellate;

pub use files::{MeshFormat, write_mesh};

use crate::assembly::{Assembly, Placed};
use crate::device::Contour;
use crate::scene::{Appearance, DeviceName, DeviceSettings, NoDevice, Scene};
use glam::DVec3;
use optics::geometry::{Polygon, Pose, REACH, Solid};

/// A part of a device, of one kind of matter.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineMesh {
    /// What messages call the device, and its kind.
    pub name: String,
    /// What it is of.
    pub matter: Matter,
    /// The corners of each triangle, counterclockwise as seen from outside, cm.
    pub triangles: Vec<[DVec3; 3]>,
}

/// What a part of a device is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Matter {
    /// A medium, which light goes through.
    Medium,
    /// Metal.
    Metal,
    /// A polarizer.
    Polarizer,
    /// An opaque body, of a linear red, green and blue.
    Opaque([f64; 3]),
}

/// Why there are no outlines of devices.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OutlineError {
    /// There is nothing to be seen.
    #[error("there is no device whose outline could be written")]
    Nothing,
    /// There is no device of that number.
    #[error(transparent)]
    NoDevice(#[from] NoDevice),
    /// A device has no end.
    #[error(
        "{0} is endless, and a mesh is not; give it a `length`, and take a box instead of a \
         slab"
    )]
    Endless(DeviceName),
}

/// The outlines of all devices of a scene, or of one: of each the space that it takes up, its metal
/// apart, and the thin mirrors that belong to it. Where a cloak has an open core, the border of that is
/// a shell within.
///
/// # Errors
///
/// If a device is endless, or there is none.
pub fn outlines(
    scene: &Scene,
    assembly: &Assembly,
    device: Option<usize>,
) -> Result<Vec<OutlineMesh>, OutlineError> {
    let count = assembly.devices().len();
    if let Some(device) = device.filter(|device| *device >= count) {
        return Err(NoDevice { device, count }.into());
    }
    let mut meshes = Vec::new();
    for (number, (placed, settings)) in assembly.devices().iter().zip(&scene.devices).enumerate() {
        if device.is_some_and(|device| device != number) {
            continue;
        }
        let name = scene.device_name(number);
        let text = format!("{name}, {}", settings.kind());
        let parts = parts(placed, settings).ok_or(OutlineError::Endless(name))?;
        meshes.extend(parts.into_iter().filter(|(_, triangles)| !triangles.is_empty()).map(
            |(matter, triangles)| {
                let triangles =
                    triangles.into_iter().map(|t| t.map(|at| placed.pose.to_world(at))).collect();
                OutlineMesh { name: text.clone(), matter, triangles }
            },
        ));
    }
    if meshes.is_empty() { Err(OutlineError::Nothing) } else { Ok(meshes) }
}

type Part = (Matter, Vec<[DVec3; 3]>);

/// The parts of a device in its frame; `None` if one has no end.
fn parts(placed: &Placed, settings: &DeviceSettings) -> Option<Vec<Part>> {
    let structure = &placed.structure;
    let hull = &structure.hull;
    let has_ends = |solid: &Solid| {
        solid
            .bounds()
            .is_none_or(|[low, high]| low.min_element() > -REACH && high.max_element() < REACH)
    };
    if !hull.solids.iter().chain(&hull.thin_mirror).all(has_ends) {
        return None;
    }
    let solids = || hull.solids.iter().flat_map(tessellate::solid).collect::<Vec<_>>();
    let matter = match settings.appearance() {
        Some(Appearance::Color(color)) => Matter::Opaque(color),
        Some(Appearance::Image(_)) => Matter::Opaque([0.5; 3]),
        None if structure.polarizes() => Matter::Polarizer,
        None if structure.is_metal() => Matter::Metal,
        None => Matter::Medium,
    };
    let mut parts = Vec::new();
    // Metal below a curved floor is less than the box around it.
    if hull.metal.is_none() {
        parts.push((matter, solids()));
    }
    if matter == Matter::Medium || hull.metal.is_some() {
        parts.push((Matter::Metal, metal(placed)));
    }
    let mirror = hull.thin_mirror.iter().flat_map(tessellate::solid).collect();
    parts.push((Matter::Metal, mirror));
    Some(parts)
}

/// The metal in a device, drawn out along z, or around the middle of a ball.
fn metal(placed: &Placed) -> Vec<[DVec3; 3]> {
    let structure = &placed.structure;
    let section = structure.cross_section();
    let contours = section.metal.iter().filter(|contour| contour.closed);
    let is_ball = structure.hull.solids.iter().all(|solid| {
        let whole = if let Solid::Hollow { whole, .. } = solid { whole } else { solid };
        matches!(whole, Solid::Ball { .. } | Solid::CutBall { .. })
    });
    let extent = structure.hull.bounds(&Pose::IDENTITY).map(|[low, high]| [low.z, high.z]);
    let Some(extent) = extent else { return Vec::new() };
    let drawn = |contour: &Contour| match contour.points.first() {
        Some(first) if is_ball => tessellate::solid(&Solid::ball(first.length())),
        _ => Polygon::new(&contour.corners())
            .map(|polygon| tessellate::drawn_out(&polygon, extent))
            .unwrap_or_default(),
    };
    contours.flat_map(drawn).collect()
}
