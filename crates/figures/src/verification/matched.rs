//! Section 3, design (iii).

use super::Result;
use super::finding::{DOUBLE, Page, SINGLE, below, percent};
use super::fixture::{
    CAMERA, DESIGNS, Fixture, camera_direction, largest_difference, launch, square, strongest,
    tracer, undisturbed,
};
use cloakroom::assembly::Assembly;
use glam::DVec3;

/// Yoctoseconds in a nanosecond.
const YOCTOSECONDS: f64 = 1e15;

pub(super) fn along_the_axis(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let device = square(DESIGNS[2]);
    let empty = &fixture.show("", "none")?.view;
    let shown = fixture.show(&device, "none")?;
    let bare = &fixture.show(&format!("{device}show = \"bare\"\n"), "none")?.view;
    let difference = largest_difference(empty, &shown.view);
    let bare = largest_difference(empty, bare);
    let [_, late] = shown.statistics("time_of_flight_difference")?;
    let assembly = fixture.assembly(&device)?;
    let mut rays = tracer(&assembly, 1e-12);
    let mut lost: f64 = 0.0;
    for right in [0.0, 7.0, 14.0, 20.0] {
        for step in -12..=12 {
            let up = 0.43 * f64::from(step) + 0.1;
            let [h, v] = undisturbed(&mut rays, CAMERA, camera_direction(right, up));
            lost = lost.max(1.0 - h).max(1.0 - v);
        }
    }
    let (least, lost_at_most) = (below(difference, SINGLE, ""), below(lost, DOUBLE, ""));
    page.says(
        "3, Fig. 6",
        "Bare metal distorts the view; (iii) retrieves the empty view perfectly",
    )
    .computed(format!("largest difference of linear light: {least}, bare {bare:.2}"))
    .verdict(difference < 1e-5 && bare > 0.1);
    page.says(
        "3, Fig. 6",
        "The time of flight is retrieved, too, to machine precision: yoctoseconds",
    )
    .computed(format!("largest difference {}", below(late * YOCTOSECONDS, 20.0, "ys")))
    .verdict(late * YOCTOSECONDS < 1000.0);
    wave_cloak(&assembly, page, lost)?;
    page.says("3", "(iii) is impedance matched to air, for any polarization")
        .computed(format!("power that is not on its own line, over the view: {lost_at_most}"))
        .verdict(lost < 1e-9);
    Ok(())
}

/// Whether (iii) cloaks rays, and waves: their phase, and their field on the mirror that is seen
/// edge-on.
fn wave_cloak(assembly: &Assembly, page: &mut Page, lost: f64) -> Result<()> {
    let mut rays = tracer(assembly, 1e-12);
    let mut late: f64 = 0.0;
    let mut changed: f64 = 0.0;
    for right in [0.0, 7.0, 14.0, 20.0] {
        for step in -12..=12 {
            let direction = camera_direction(right, 0.43 * f64::from(step) + 0.1);
            let ray = launch(CAMERA, direction);
            let leaf = strongest(rays.trace(&ray).0, 0)?;
            late = late.max((leaf.optical_path - leaf.position.distance(CAMERA)).abs());
            for (before, after) in ray.electric.iter().zip(leaf.electric) {
                changed = changed.max((after - *before).norm_squared().sqrt());
            }
        }
    }
    // In virtual space the metal is a flat strip along x and z; what a wave along x has of its
    // field along it.
    let [h, v] = launch(CAMERA, DVec3::X).electric.map(|field| {
        let along = field.re.x.hypot(field.re.z);
        (along / field.re.length()).powi(2)
    });
    page.says("3, 5", "(iii) is a perfect three-dimensional ray cloak")
        .computed(format!(
            "power that is not on its own line, over the view: {}",
            below(lost, DOUBLE, "")
        ))
        .verdict(lost < 1e-9);
    page.says("3, 5", "and a perfect three-dimensional wave cloak")
        .computed(format!(
            "over the view the phase path changes by {}, the field by {}; of a wave along x the \
             mirror, seen edge-on, shorts {} of H, {} of V",
            below(late, 1e-12, "cm"),
            below(changed, DOUBLE, ""),
            percent(h, 0),
            percent(v, 0)
        ))
        .verdict(late < 1e-9 && changed < 1e-9 && h.max(v) < 1e-9)
        .because(
            "Along every ray phase and polarization are those of empty space. As a wave, vertical \
             light is cloaked exactly; the field of horizontal light lies along the hidden metal, \
             which in virtual space is a thin strip and scatters it: see below.",
        );
    Ok(())
}

pub(super) fn turned(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let mut largest: f64 = 0.0;
    for rotation in [5, 10, 20] {
        let device = format!("{}rotation = {rotation}\n", square(DESIGNS[2]));
        let cloaked = &fixture.show(&device, "none")?.view;
        let mirror = &fixture.show(&format!("{device}show = \"mirror\"\n"), "none")?.view;
        largest = largest.max(largest_difference(cloaked, mirror));
    }
    page.says(
        "3, Fig. 7",
        "Turned by 5, 10, 20 degrees, (iii) looks exactly as a flat mirror 19.94 cm wide \
         does",
    )
    .computed(format!("largest difference of linear light: {}", below(largest, SINGLE, "")))
    .verdict(largest < 1e-5);
    Ok(())
}
