//! Waves that run along the surface: the limit of waves that hardly cross it.
#![allow(clippy::unwrap_used, reason = "a test may")]

use glam::{DMat3, DVec3};
use optics::interface::{IncidentWave, Scattering, Side, split};
use optics::medium::{Medium, Mode};
use optics::wave::ComplexVector;

fn biaxial(a: f64, b: f64, c: f64) -> Medium {
    Medium::new(DMat3::from_diagonal(DVec3::new(a, b, c)), 1.0).unwrap()
}

/// Media whose wave with E along y runs along the surface where the tangential wave vector is along
/// x and as long as given.
fn media() -> [(Medium, f64); 4] {
    [
        (biaxial(1.5, 1.0, 2.0), 1.0),
        (biaxial(2.2, 1.7, 1.9), 1.7f64.sqrt()),
        // Hyperbolic, and with a wave of a large wave vector beside.
        (biaxial(-1.5, 1.0, 2e-4), 1.0),
        (Medium::dielectric(1.5).without_closed_form(), 1.5),
    ]
}

#[test]
fn modes_solve_maxwells_equations() {
    for (medium, along) in media() {
        let tangential = DVec3::X * along;
        let solved = Scattering::new(&medium, None, tangential, DVec3::NEG_Z);
        for mode in solved.incident.iter().chain(&solved.reflected) {
            assert!(medium.residual(mode) < 1e-6, "{mode:?}");
            assert!((mode.wave_vector.re - tangential).dot(DVec3::X).abs() < 1e-15);
        }
    }
}

#[test]
fn everything_is_reflected() {
    let glass = Medium::dielectric(1.8);
    for (medium, along) in media() {
        for beyond in [None, Some(&glass)] {
            let solved = Scattering::new(&medium, beyond, DVec3::X * along, DVec3::NEG_Z);
            let is_grazing = |mode: &Mode| mode.wave_vector.re.z.abs() < 1e-3;
            let grazing: Vec<usize> = (0..2).filter(|i| is_grazing(&solved.incident[*i])).collect();
            assert!(!grazing.is_empty(), "{solved:?}");
            for column in grazing {
                let power = solved.power[column].unwrap();
                assert!((power.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{power:?}");
                assert!(power[0] + power[1] > 1.0 - 1e-3, "{power:?} {medium:?}");
            }
        }
    }
}

#[test]
fn a_wave_that_arrives_along_the_surface_is_reflected() {
    let glass = Medium::dielectric(1.8);
    for (medium, along) in media() {
        for tilt in [0.0, 1e-12, 1e-9] {
            let wave_vector = DVec3::new(along, 0.0, -along * tilt);
            let size = along.sqrt().recip();
            let electric = ComplexVector::from(DVec3::Y * size);
            let direction = medium.poynting(wave_vector, electric).normalize();
            let wave = IncidentWave {
                wave_vector,
                attenuation: DVec3::ZERO,
                direction,
                electric: [electric],
                power: [1.0],
            };
            let waves = split(&medium, &glass, &wave, DVec3::NEG_Z);
            let power = |side: Side| -> f64 {
                waves.iter().filter(|wave| wave.side == side).map(|wave| wave.power[0]).sum()
            };
            let (back, on) = (power(Side::Reflected), power(Side::Transmitted));
            assert!((back + on - 1.0).abs() < 1e-9, "{back} {on}: {medium:?}");
            assert!(back > 1.0 - 1e-3, "{back} at {tilt:e}: {medium:?}");
            assert!(waves.iter().all(|wave| wave.direction.is_normalized()));
        }
    }
}
