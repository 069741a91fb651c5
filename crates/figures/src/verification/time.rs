//! Times of pulses, which the paper takes for those of the phase.

use super::Result;
use super::finding::{DOUBLE, Page, below};
use super::fixture::{
    CAMERA, DESIGNS, Fixture, GAUSSIAN, camera_direction, launch, square, tracer,
};
use glam::DVec3;
use optics::wave::SPEED_OF_LIGHT;

/// How far from the middle plane the ray on the axis runs, cm.
const BESIDE: f64 = 1e-7;

pub(super) fn pulses(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let assembly = fixture.assembly(&square(DESIGNS[2]))?;
    let mut rays = tracer(&assembly, 1e-12).with_group_delays();
    let start = CAMERA + DVec3::Y * BESIDE;
    let (leaves, _) = rays.trace(&launch(start, DVec3::X));
    let leaf = leaves.first().ok_or("light on the axis")?;
    let straight = leaf.position.distance(start);
    let phase = (leaf.optical_path - straight).abs() / SPEED_OF_LIGHT;
    let late = (leaf.group_path.ok_or("the time of a pulse")? - straight) / SPEED_OF_LIGHT;
    page.says(
        "1",
        "A true wave cloak reconstructs the time of flight of a light ray or a light pulse",
    )
    .computed(format!(
        "(iii) on its axis: the phase is on time within {}, a pulse late by at least {late:.4} ns",
        below(phase, DOUBLE, "ns")
    ))
    .verdict(phase < 1e-9 && late < 1e-9)
    .because(
        "Of the phase it is true. A pulse goes with the energy, and causality asks for dispersion where ε or µ \
         is below 1.",
    );
    let mut earliest = f64::INFINITY;
    for device in DESIGNS.map(square).into_iter().chain([GAUSSIAN.to_owned()]) {
        let assembly = fixture.assembly(&device)?;
        let mut rays = tracer(&assembly, 1e-3).with_group_delays();
        for right in [0.0, 7.0, 14.0, 20.0] {
            for step in -12..=12 {
                let direction = camera_direction(right, 0.43 * f64::from(step) + 0.1);
                let (leaves, _) = rays.trace(&launch(CAMERA, direction));
                for leaf in leaves.iter().filter(|leaf| leaf.met_device) {
                    let path = leaf.group_path.ok_or("the time of a pulse")?;
                    earliest = earliest.min(path - leaf.position.distance(CAMERA));
                }
            }
        }
    }
    let early = (-earliest / SPEED_OF_LIGHT).max(0.0);
    page.says("1", "Not said, but asked of any cloak by causality: no pulse outruns one in air")
        .computed(format!(
            "over the view of (i)-(iv), the fastest is early by {}",
            below(early, 1e-10, "ns")
        ))
        .verdict(early < 1e-7);
    Ok(())
}
