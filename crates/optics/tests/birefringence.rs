//! Birefringent media: limits and symmetries.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::cast_precision_loss,
    clippy::expect_used,
    reason = "a test may"
)]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "shared with the other tests"
)]

use crate::long::count;
use crate::random_media::{KINDS, Random, medium};
use glam::{DMat3, DVec3};
use optics::interface::{
    IncidentWave, OutgoingWave, OutgoingWaves, Scattering, Side, reflect_at_conductor, split,
};
use optics::medium::{Heading, Medium, Mode, ModeKind};
use optics::wave::ComplexVector;

/// The two tensors exchanged.
fn dual(medium: &Medium) -> Medium {
    let (e, m) = medium.tensors();
    Medium::new(m, e).unwrap()
}

/// A mode as an incident wave of two polarizations: itself and a multiple.
fn as_incident(mode: &Mode) -> IncidentWave<2> {
    let flux = mode.poynting().length();
    let unit = mode.electric * flux.sqrt().recip();
    IncidentWave {
        wave_vector: mode.wave_vector.re,
        attenuation: mode.wave_vector.im,
        direction: mode.ray.unwrap(),
        electric: [unit, unit.scaled(num_complex::Complex64::new(0.3, -0.4))],
        power: [1.0, 0.25],
    }
}

#[test]
fn exchanging_the_tensors_changes_no_power_except_o_for_e() {
    let mut random = Random(3);
    for _ in 0..count(1_000, 5_000) {
        let (from, to) =
            (medium(random.below(10), &mut random), medium(random.below(10), &mut random));
        let normal = random.direction();
        let tangential = random.direction() * random.between(0.0, 2.5);
        let there = Scattering::new(&from, Some(&to), tangential, normal);
        let dual = Scattering::new(&dual(&from), Some(&dual(&to)), tangential, normal);
        let totals = |s: &Scattering| {
            let columns = s.power.iter().flatten().map(|p| p[0] + p[1]);
            columns.fold((0usize, 0.0), |(count, sum), r| (count + 1, sum + r))
        };
        let ((n, a), (m, b)) = (totals(&there), totals(&dual));
        assert_eq!(n, m);
        assert!((a - b).abs() < 1e-9, "{a} {b} {from:?} {to:?}");
    }
}

#[test]
fn the_way_back_has_the_same_amplitude() {
    // S_ij(k_t) = S_ji(-k_t) between flux-normalized modes, up to the modes' own phases.
    let mut random = Random(4);
    let mut worst: f64 = 0.0;
    let mut pairs = 0;
    for _ in 0..count(1_000, 5_000) {
        let (from, to) =
            (medium(random.below(10), &mut random), medium(random.below(10), &mut random));
        let normal = random.direction();
        let tangential = random.direction() * random.between(0.0, 2.5);
        let tangential = tangential - normal * normal.dot(tangential);
        let there = Scattering::new(&from, Some(&to), tangential, normal);
        let back = Scattering::new(&to, Some(&from), -tangential, -normal);
        let Some(transmitted) = there.transmitted else { continue };
        let reversed = |mode: &Mode, modes: &[Mode; 2]| {
            let near = |other: &Mode| (mode.wave_vector + other.wave_vector).norm_squared() < 1e-8;
            let both = modes.iter().filter(|m| near(m)).count() == 2;
            if both { None } else { modes.iter().position(near) }
        };
        for (i, mode) in there.incident.iter().enumerate() {
            for (j, onward) in transmitted.iter().enumerate() {
                if !mode.is_propagating() || !onward.is_propagating() {
                    continue;
                }
                let Some(column) = reversed(onward, &back.incident) else { continue };
                let row = reversed(mode, back.transmitted.as_ref().unwrap());
                let Some(row) = row else { continue };
                let forth = there.amplitudes[2 + j][i].norm();
                let again = back.amplitudes[2 + row][column].norm();
                worst = worst.max((forth - again).abs());
                pairs += 1;
            }
        }
    }
    println!("reciprocity: {worst:.1e} over {pairs} pairs");
    assert!(pairs > 1_000 && worst < 1e-9, "{worst:e}");
}

#[test]
fn split_is_the_scattering_of_its_mode() {
    let mut random = Random(5);
    for _ in 0..count(4_000, 40_000) {
        let from = medium(random.below(10), &mut random);
        let beyond = random.below(KINDS.len() + 1);
        let to = (beyond < KINDS.len()).then(|| medium(beyond, &mut random));
        let normal = random.direction();
        let tangential = random.direction() * random.between(0.0, 2.0);
        let s = Scattering::new(&from, to.as_ref(), tangential, normal);
        for (column, mode) in s.incident.iter().enumerate() {
            let Some((power, together)) = s.power[column].zip(s.interference[column]) else {
                continue;
            };
            let wave = as_incident(mode);
            let waves = match &to {
                Some(to) => split(&from, to, &wave, normal),
                None => reflect_at_conductor(&from, &wave, normal),
            };
            for polarization in [0, 1] {
                let total: f64 = waves.iter().map(|w| w.power[polarization]).sum();
                // In media that absorb, waves carry together what none of them carries alone.
                let absorbs = from.absorbs() || to.as_ref().is_some_and(Medium::absorbs);
                assert!(absorbs || (total - wave.power[polarization]).abs() < 1e-14, "{total}");
            }
            let reflected: f64 =
                waves.iter().filter(|w| w.side == Side::Reflected).map(|w| w.power[0]).sum();
            let facing = wave.direction.dot(normal).abs();
            assert!(
                (reflected - power[0] - power[1]).abs() < 1e-12 / facing
                    || (reflected - power[0] - power[1] - together[0]).abs() < 1e-12 / facing,
                "{reflected} {power:?} {together:?}"
            );
            check_waves(&from, to.as_ref(), &waves, normal);
        }
    }
}

/// Fields carry the power they claim, along the ray they claim, away from the interface.
fn check_waves(from: &Medium, to: Option<&Medium>, waves: &OutgoingWaves<2>, normal: DVec3) {
    for wave in waves {
        let OutgoingWave { side, mode, wave_vector, attenuation, direction, electric, power } =
            *wave;
        let (medium, sign) = match (side, to) {
            (Side::Transmitted, Some(to)) => (to, 1.0),
            _ => (from, -1.0),
        };
        assert!(direction.dot(normal) * sign > 0.0);
        let p = ComplexVector::new(wave_vector, attenuation);
        for (electric, power) in electric.into_iter().zip(power) {
            let magnetic = medium.decaying_magnetic_field(p, electric);
            let flux = optics::wave::poynting(electric, magnetic);
            let cosine = direction.dot(normal).abs();
            // In an absorbing medium a share may hold cross terms, and the rays of two waves with
            // one wave vector part.
            let parting = medium.absorbs() && mode == ModeKind::Shared;
            let error = (flux.normalize_or_zero() - direction).length();
            assert!(
                power < 1e-25 || parting || error < 1e-9 / cosine.powi(2),
                "{flux} {direction} {power:e}"
            );
            if !medium.absorbs() {
                let size = electric.norm_squared() + magnetic.norm_squared();
                let error = (flux.length() - power).abs();
                assert!(error < 1e-10 * size.max(power) / cosine.powi(2), "{flux} {power}");
            }
        }
    }
}

#[test]
fn light_along_the_axis_is_one_wave() {
    let crystal = Medium::uniaxial_electric(1.0, 2.25, 3.0, DVec3::X).unwrap();
    let wave = IncidentWave {
        wave_vector: DVec3::X,
        attenuation: DVec3::ZERO,
        direction: DVec3::X,
        electric: [DVec3::new(0.0, 0.6, 0.8).into(), DVec3::Y.into()],
        power: [1.0; 2],
    };
    let waves = split(&Medium::AIR, &crystal, &wave, DVec3::X);
    assert_eq!(waves.len(), 2);
    for wave in &waves {
        assert_eq!(wave.mode, ModeKind::Shared);
    }
    assert!((waves[0].power[0] - 0.04).abs() < 1e-15 && (waves[1].power[1] - 0.96).abs() < 1e-15);
    // And on through the crystal, with any polarization, into air again.
    let inside = IncidentWave {
        wave_vector: waves[1].wave_vector,
        attenuation: DVec3::ZERO,
        direction: waves[1].direction,
        electric: waves[1].electric,
        power: waves[1].power,
    };
    let out = split(&crystal, &Medium::AIR, &inside, DVec3::X);
    let onward = out.iter().find(|w| w.side == Side::Transmitted).unwrap();
    assert!((onward.power[0] - 0.96 * 0.96).abs() < 1e-15);
    let field = onward.electric[0];
    assert!((field.re - DVec3::new(0.0, 0.6, 0.8) * 0.96).length() < 1e-15);
}

#[test]
fn close_to_the_axis_the_powers_are_continuous() {
    let crystal = Medium::uniaxial_magnetic(2.0, 1.5, 0.8, DVec3::new(1.0, 0.2, 0.0)).unwrap();
    let along = DVec3::new(0.0, 3.0f64.sqrt() * 0.2 / 1.04f64.sqrt(), 0.0);
    let reflectance = |offset: f64| {
        let tangential = along + DVec3::new(0.0, 0.0, offset);
        let s = Scattering::new(&crystal, Some(&Medium::AIR), tangential, DVec3::X);
        s.power.iter().flatten().map(|p| p[0] + p[1]).sum::<f64>()
    };
    let at = reflectance(0.0);
    for exponent in 1..18 {
        let offset = 10f64.powi(-exponent);
        assert!((reflectance(offset) - at).abs() < 10.0 * offset + 1e-13, "{exponent}");
    }
}

#[test]
fn grazing_incidence_gives_the_limit() {
    let air = Medium::AIR;
    let crystals = [
        Medium::uniaxial_magnetic(2.4, 0.3, 3.3, DVec3::new(0.8, -0.6, 0.1)).unwrap(),
        Medium::uniaxial_electric(1.0, 2.7, 2.2, DVec3::new(0.3, 0.5, 0.8)).unwrap(),
        Medium::new(DMat3::from_diagonal(DVec3::new(2.0, 2.5, 3.0)), 1.0).unwrap(),
    ];
    for crystal in crystals {
        // Air's waves along the surface, a little off, and beyond.
        for tangential in [1.0, 1.0 - 1e-15, 1.0 - 1e-12, 1.0 - 1e-9, 1.0 + 1e-15, 1.0 + 1e-9] {
            let s = Scattering::new(&air, Some(&crystal), DVec3::Y * tangential, DVec3::X);
            for power in s.power.iter().flatten() {
                assert!((power.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                assert!(power[0] + power[1] > 0.99, "{power:?}");
            }
        }
        // A wave inside that grazes the surface: found by walking to the edge of the waves.
        let (mut inside, mut outside) = (0.0, 10.0);
        for _ in 0..60 {
            let middle = f64::midpoint(inside, outside);
            let [a, b] = crystal.modes(DVec3::Y * middle, DVec3::X, Heading::Forward);
            let propagating = a.is_propagating() || b.is_propagating();
            *(if propagating { &mut inside } else { &mut outside }) = middle;
        }
        for tangential in [inside, outside] {
            let known = crystal.modes(DVec3::Y * inside, DVec3::X, Heading::Forward);
            let mode = known.iter().find(|mode| mode.is_propagating()).unwrap();
            let mut wave = as_incident(mode);
            wave.wave_vector.y = tangential;
            for waves in [
                split(&crystal, &air, &wave, DVec3::X),
                reflect_at_conductor(&crystal, &wave, DVec3::X),
            ] {
                let total: f64 = waves.iter().map(|w| w.power[0]).sum();
                assert!((total - 1.0).abs() < 1e-13, "{total}");
                assert!(waves.iter().all(|w| w.electric[0].norm_squared().is_finite()));
            }
        }
    }
}

#[test]
fn nearly_the_same_indices_are_continuous() {
    // A uniaxial medium whose birefringence vanishes, and a biaxial one, become isotropic.
    let exact =
        Scattering::new(&Medium::AIR, Some(&Medium::dielectric(1.5)), DVec3::Y * 0.6, DVec3::X);
    let total = |s: &Scattering| s.power.map(|p| p.map_or(0.0, |p| p[0] + p[1]));
    for exponent in 1..17 {
        let d = 10f64.powi(-exponent);
        let axis = DVec3::new(0.3, -0.5, 0.7).normalize();
        let uniaxial = Medium::uniaxial_electric(1.0, 2.25, 2.25 + d, axis).unwrap();
        let turn = DMat3::from_axis_angle(axis, 0.7);
        let values = DVec3::new(2.25, 2.25 + d, 2.25 - d);
        let biaxial = turn * DMat3::from_diagonal(values) * turn.transpose();
        let biaxial = Medium::new((biaxial + biaxial.transpose()) * 0.5, 1.0).unwrap();
        for medium in [uniaxial, uniaxial.without_closed_form(), biaxial] {
            let s = Scattering::new(&Medium::AIR, Some(&medium), DVec3::Y * 0.6, DVec3::X);
            for (a, b) in total(&s).iter().zip(total(&exact)) {
                assert!((a - b).abs() < d + 1e-13, "{d:e}: {a} {b}");
            }
        }
    }
}

#[test]
fn silver_reflects_and_absorbs_the_rest() {
    // Normal incidence: R = |(n - 1)/(n + 1)|² with n² = ε.
    let silver = Medium::new(num_complex::Complex64::new(-15.0, 0.5), 1.0).unwrap();
    let n = num_complex::Complex64::new(-15.0, 0.5).sqrt();
    let expected = ((n - 1.0) / (n + 1.0)).norm_sqr();
    let s = Scattering::new(&Medium::AIR, Some(&silver), DVec3::ZERO, DVec3::X);
    for power in s.power.iter().flatten() {
        assert!((power[0] + power[1] - expected).abs() < 1e-14);
        assert!((power.iter().sum::<f64>() - 1.0).abs() < 1e-14);
    }
}

#[test]
fn an_isotropic_medium_worked_out_as_any_other_follows_fresnel() {
    // Total reflection: the phases of s and p (Born & Wolf, 1.5.4) from the amplitudes.
    let (n, angle) = (1.5f64, 50f64.to_radians());
    let tangential = DVec3::Y * (n * angle.sin());
    let s = Scattering::new(&Medium::dielectric(n), Some(&Medium::AIR), tangential, DVec3::X);
    assert_eq!(s.incident[0].kind, ModeKind::S);
    let ratio = (angle.sin().powi(2) - 1.0 / (n * n)).sqrt() / angle.cos();
    for (i, tan) in [(0, ratio), (1, n * n * ratio)] {
        let amplitude = s.amplitudes[i][i];
        assert!((amplitude.norm() - 1.0).abs() < 1e-15);
        // tan(δ/2) = -tan up to the sign of the reflected mode's own field.
        let half = 0.5 * amplitude.arg();
        let fits = [half.tan(), -1.0 / half.tan()].iter().any(|t| (t.abs() - tan).abs() < 1e-12);
        assert!(fits, "{i}: {} {tan}", half.tan());
    }
}
