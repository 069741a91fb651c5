//! Section 3, design (iii).

use super::Result;
use super::finding::{DOUBLE, Page, SINGLE, below};
use super::fixture::{
    CAMERA, DESIGNS, Fixture, camera_direction, largest_difference, square, tracer, undisturbed,
};

/// Yoctoseconds in a nanosecond.
const YOCTOSECONDS: f64 = 1e15;

pub(super) fn along_the_axis(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let device = square(DESIGNS[2]);
    let empty = fixture.show("", "none")?.view;
    let shown = fixture.show(&device, "none")?;
    let bare = fixture.show(&format!("{device}show = \"bare\"\n"), "none")?.view;
    let difference = largest_difference(&empty, &shown.view);
    let bare = largest_difference(&empty, &bare);
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
    page.says("3", "(iii) is impedance matched to air, for any polarization")
        .computed(format!("power that is not on its own line, over the view: {lost_at_most}"))
        .verdict(lost < 1e-9);
    Ok(())
}

pub(super) fn turned(fixture: &Fixture<'_>, page: &mut Page) -> Result<()> {
    let mut largest: f64 = 0.0;
    for rotation in [5, 10, 20] {
        let device = format!("{}rotation = {rotation}\n", square(DESIGNS[2]));
        let cloaked = fixture.show(&device, "none")?.view;
        let mirror = fixture.show(&format!("{device}show = \"mirror\"\n"), "none")?.view;
        largest = largest.max(largest_difference(&cloaked, &mirror));
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
