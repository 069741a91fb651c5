//! Uniaxial media whose principal values differ by up to twelve powers of ten.
#![allow(clippy::unwrap_used, reason = "a test may")]

use crate::long::count;
use crate::random_media::{Random, maxwell_residual};
use optics::medium::{Heading, Medium};

/// Waves solve Maxwell's equations wherever their axis points: next to zero along it the extraordinary wave's own
/// equation tells what cancels in its fields.
#[test]
fn waves_of_extreme_uniaxial_media_solve_maxwells_equations() {
    let mut random = Random(7);
    let mut worst: f64 = 0.0;
    for number in 0..count(4_000, 400_000) {
        let axis = random.direction();
        let (across, along) = (random.between(0.5, 3.0), 10f64.powf(random.between(-9.0, 3.0)));
        let medium = if number % 2 == 0 {
            Medium::uniaxial_electric(1.0, across, along, axis)
        } else {
            Medium::uniaxial_magnetic(1.0, across, along, axis)
        };
        let medium = medium.unwrap();
        let (normal, tangential) =
            (random.direction(), random.direction() * random.between(0.0, 2.0));
        for heading in [Heading::Forward, Heading::Backward] {
            for mode in medium.modes(tangential, normal, heading) {
                worst = worst.max(maxwell_residual(&medium, &mode));
            }
        }
    }
    assert!(worst < 1e-13, "{worst:e}");
}
