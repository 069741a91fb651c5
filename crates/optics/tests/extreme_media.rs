//! Media whose principal values differ by up to twelve powers of ten.
#![allow(clippy::unwrap_used, reason = "a test may")]

use crate::long::count;
use crate::random_media::{Random, maxwell_residual};
use glam::{DMat3, DVec3};
use optics::interface::Scattering;
use optics::medium::{Heading, Medium, Tensor};

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

/// What an absorbing medium takes counts however little its wave carries across the surface: with a permeability
/// next to zero across that the magnetic field is nearly all across, too, and strong.
#[test]
fn powers_add_up_at_absorbing_media_with_a_permeability_next_to_zero() {
    let mut random = Random(8);
    let (mut worst, mut columns): (f64, usize) = (0.0, 0);
    for _ in 0..count(4_000, 400_000) {
        let from = DVec3::from_array([0; 3].map(|_| 10f64.powf(random.between(-2.0, 4.5))));
        let incident = Medium::new(DMat3::from_diagonal(from), 1.0).unwrap();
        let next_to_zero = 10f64.powf(random.between(-12.0, -9.0));
        let permeability = Tensor {
            re: DMat3::from_diagonal(DVec3::new(0.0, -random.between(0.5, 3.0), 0.0)),
            im: DMat3::from_diagonal(DVec3::new(1e-6, 1e-6, next_to_zero)),
        };
        let Ok(transmitted) = Medium::new(random.between(1.0, 6.0), permeability) else { continue };
        let tilt = 10f64.powf(random.between(-6.0, 0.0));
        let normal = (DVec3::Z + tilt * random.direction()).normalize();
        let tangential = random.direction() * random.between(0.1, 3.0);
        let Scattering { power, interference, .. } =
            Scattering::new(&incident, Some(&transmitted), tangential, normal);
        for (power, together) in power.into_iter().zip(interference) {
            if let (Some(power), Some(together)) = (power, together) {
                worst = worst.max((power.iter().chain(&together).sum::<f64>() - 1.0).abs());
                columns += 1;
            }
        }
    }
    assert!(worst < 1e-9 && columns > 1_000, "{worst:e} {columns}");
}
