//! The scenes that a scene is held against.

use crate::assembly::Placed;
use crate::device::{MaterialAt, REACH, Show};
use crate::render::assembly;
use crate::scene::{Core, DeviceSettings, Scene};
use glam::DVec3;
use optics::geometry::Pose;

/// What a scene should look like: its cloaks as the flat mirrors that they imitate, and nothing in
/// the place of other devices.
#[must_use]
pub fn ideal(scene: &Scene) -> Scene {
    let mut ideal = scene.clone();
    ideal.devices.retain_mut(|device| show_as(device, Show::Mirror) == Some(true));
    ideal
}

/// A scene without its devices.
#[must_use]
pub fn empty(scene: &Scene) -> Scene {
    Scene { devices: Vec::new(), ..scene.clone() }
}

/// A scene with the bare metal of its cloaks: `None` if none has any, as bodies and lenses, which
/// stay, have not. What stands in an open core, which is metal then, is gone.
#[must_use]
pub fn bare(scene: &Scene) -> Option<Scene> {
    let mut bare = scene.clone();
    let mut changed = false;
    for device in &mut bare.devices {
        changed |= show_as(device, Show::Bare).is_some();
    }
    let mut hidden = hidden(scene).into_iter();
    bare.devices.retain(|_| hidden.next() != Some(true));
    changed.then_some(bare)
}

/// Shows a device otherwise, if it can be, and says whether anything is there to be seen then. One
/// that is not there stays away.
fn show_as(device: &mut DeviceSettings, show: Show) -> Option<bool> {
    if device.placement.show == Show::Empty {
        return None;
    }
    let mut filled = device.clone();
    (filled.placement.core, filled.placement.show) = (Core::Metal, show);
    let built = filled.built(show).ok()?;
    *device = filled;
    Some(!built.surfaces.is_empty())
}

/// Whether each device stands in the open core of another; nothing where there is no such core.
fn hidden(scene: &Scene) -> Vec<bool> {
    if !scene.devices.iter().any(|device| device.has_open_core()) {
        return Vec::new();
    }
    let Ok(assembly) = assembly(scene) else { return Vec::new() };
    let reach = DVec3::splat(REACH);
    let ends = |placed: &Placed, frame: &Pose| {
        let [low, high] = placed.structure.hull.bounds(&frame.inverse().after(&placed.pose))?;
        Some([low.max(-reach), high.min(reach)])
    };
    // Of two cores one in the other, the smaller box is in the larger; across the axis, for both
    // may be endless along it.
    let holds = |around: &Placed, placed: &Placed| {
        let [from, to] = ends(around, &around.pose)?.map(DVec3::truncate);
        let [low, high] = ends(placed, &around.pose)?;
        let is_smaller = (low.truncate().cmpgt(from) & high.truncate().cmplt(to)).all();
        let middle = around.structure.material_at((low + high) / 2.0);
        (is_smaller && middle == MaterialAt::HiddenAir).then_some(())
    };
    let is_hidden =
        |placed: &Placed| assembly.devices().iter().any(|around| holds(around, placed).is_some());
    assembly.devices().iter().map(is_hidden).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file;
    use std::path::Path;

    #[test]
    fn bare_metal_has_no_core() {
        let scene =
            |text: &str| scene_file::parse(text, "a", Path::new(""), &[]).expect("a scene").scene;
        let lens = "[[device]]\nkind = 'luneburg-lens'\nposition = [0, 50, 0]\n";
        let rod = "[[device]]\nkind = 'body'\nshape = 'cylinder'\nradius = 1\npermittivity = 2\n";
        let square = "[[device]]\nkind = 'square-cloak'\ncore = 'open'\n";
        let small = "[[device]]\nkind = 'cylinder-cloak'\ncore = 'open'\ninner = 1.5\nouter = 3\n";
        let bare = bare(&scene(&format!("{lens}{rod}{small}{square}"))).expect("a cloak");
        let shown: Vec<_> = bare.devices.iter().map(|d| (d.kind(), d.placement.show)).collect();
        assert_eq!(shown, [("luneburg-lens", Show::Cloak), ("square-cloak", Show::Bare)]);
        assert!(assembly(&bare).is_ok());
        assert!(super::bare(&scene(&format!("{lens}{rod}"))).is_none());
        // A cloak that is not there has no metal, and nothing should be seen in its place.
        let away = scene("[[device]]\nkind = 'square-cloak'\nshow = 'empty'\ncore = 'open'\n");
        assert!(super::bare(&away).is_none() && ideal(&away).devices.is_empty());
        assert!(assembly(&away).is_ok());
    }
}
