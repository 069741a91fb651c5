//! Invariants of every interface over random pairs of media and random waves: energy, Maxwell's
//! equations, continuity of the tangential fields, and limits from textbooks.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::long::count;
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::interface::{
    IncidentWave, Reflectionless, Scattering, Side, reflect_at_conductor, split,
    transmit_antireflection,
};
use optics::medium::{Medium, MediumError, Tensor};
use optics::wave::{ComplexVector, poynting, transverse_basis};
use proptest::prelude::*;

fn unit_vector() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0f64, 0.0..std::f64::consts::TAU).prop_map(|(z, angle)| {
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * angle.cos(), r * angle.sin(), z)
    })
}

/// Isotropic media of either sign of the index.
fn isotropic() -> impl Strategy<Value = Medium> {
    (0.2..4.0f64, 0.2..4.0f64, prop_oneof![Just(1.0), Just(-1.0)])
        .prop_map(|(e, m, sign)| Medium::isotropic(sign * e, sign * m).unwrap())
}

/// Isotropic media and positive impedance-matched ones.
fn medium() -> impl Strategy<Value = Medium> {
    prop_oneof![
        isotropic(),
        (unit_vector(), 0.0..6.3f64, (0.2..4.0f64, 0.2..4.0f64, 0.2..4.0f64)).prop_map(
            |(axis, angle, (a, b, c))| {
                let turn = DMat3::from_axis_angle(axis, angle);
                let m = turn * DMat3::from_diagonal(DVec3::new(a, b, c)) * turn.transpose();
                Medium::impedance_matched((m + m.transpose()) * 0.5).unwrap()
            }
        ),
    ]
}

/// A wave in a medium that runs towards an interface, of unit power.
fn incident(medium: &Medium, direction: DVec3, jones: [f64; 4]) -> IncidentWave<1> {
    // The ray lies along µp, and p·µp = z det µ for ε = zµ.
    let mu = medium.permeability();
    let ratio = medium.permittivity().x_axis.x / mu.x_axis.x;
    let along = mu.inverse() * direction;
    let wave_vector = along * (ratio * mu.determinant() / along.dot(direction)).sqrt();
    // Any field with p·εE = 0 is one of the medium's degenerate waves.
    let displacement_normal = *medium.permittivity() * wave_vector;
    let (a, b) = transverse_basis(displacement_normal.normalize(), DVec3::Z, DVec3::X);
    let field = ComplexVector::new(a * jones[0] + b * jones[1], a * jones[2] + b * jones[3]);
    let power = medium.poynting(wave_vector, field).length();
    IncidentWave {
        wave_vector,
        attenuation: DVec3::ZERO,
        direction,
        electric: [field * power.powf(-0.5)],
        power: [1.0],
    }
}

/// How far a wave with H = µ⁻¹ (p × E) is from solving p × H = -εE, relative to its fields, and its
/// Poynting vector.
fn examined(medium: &Medium, wave_vector: DVec3, electric: ComplexVector) -> (f64, DVec3) {
    let magnetic = medium.magnetic_field(wave_vector, electric);
    let ampere = magnetic.crossed_by(wave_vector) + electric.transformed(medium.permittivity());
    let fields = electric.norm_squared() + magnetic.norm_squared();
    ((ampere.norm_squared() / fields).sqrt(), poynting(electric, magnetic))
}

fn jones() -> impl Strategy<Value = [f64; 4]> {
    [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64]
        .prop_filter("not zero", |j| j.iter().map(|x| x * x).sum::<f64>() > 0.01)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(500, 20_000)))]

    #[test]
    fn energy_maxwell_and_continuity(
        from in medium(), to in medium(), normal in unit_vector(), direction in unit_vector(),
        jones in jones(),
    ) {
        let facing = direction.dot(normal);
        prop_assume!(facing.abs() > 1e-3);
        let direction = direction * facing.signum();
        let wave = incident(&from, direction, jones);
        let waves = split(&from, &to, &wave, normal);

        // Energy: outgoing power equals incident power, total internal reflection included.
        let total: f64 = waves.iter().map(|w| w.power[0]).sum();
        prop_assert!((total - 1.0).abs() < 1e-12, "power {total}");

        // What goes in at the interface comes out: tangential E and H are continuous.
        let mut electric = ComplexVector::ZERO;
        let mut magnetic = ComplexVector::ZERO;
        let mut add = |medium: &Medium, p: DVec3, e: ComplexVector, sign: f64| {
            electric = electric + e * sign;
            magnetic = magnetic + medium.magnetic_field(p, e) * sign;
        };
        add(&from, wave.wave_vector, wave.electric[0], 1.0);
        for w in &waves {
            let (medium, sign) = match w.side {
                Side::Reflected => (&from, 1.0),
                Side::Transmitted => (&to, -1.0),
            };
            let cosine = w.direction.dot(normal);
            prop_assert!(cosine * sign < 0.0, "flux of {:?} runs the wrong way", w.side);
            let narrowing = (cosine / direction.dot(normal)).abs().sqrt();
            add(medium, w.wave_vector, w.electric[0] * (1.0 / narrowing), sign);

            let (residual, poynting) = examined(medium, w.wave_vector, w.electric[0]);
            prop_assert!(w.power[0] < 1e-20 || residual < 1e-11, "Maxwell {residual}");
            let cosine = cosine.abs().min(facing.abs());
            prop_assert!((poynting - w.direction * w.power[0]).length() < 1e-13 / cosine.powi(2));
        }
        if waves.len() == 2 {
            // Near grazing, a direction known to 1e-16 fixes the beam's width less and less well.
            let cosine =
                waves.iter().map(|w| w.direction.dot(normal).abs()).fold(facing.abs(), f64::min);
            let scale = wave.electric[0].norm_squared().sqrt();
            for field in [electric, magnetic] {
                let across = field.crossed_by(normal).norm_squared().sqrt();
                prop_assert!(across < 1e-13 * scale.max(1.0) / cosine.powi(2), "jump {across}");
            }
        }
    }

    #[test]
    fn a_conductor_reflects_all_and_has_no_tangential_field(
        medium in medium(), normal in unit_vector(), direction in unit_vector(), jones in jones(),
    ) {
        let facing = direction.dot(normal);
        prop_assume!(facing.abs() > 1e-3);
        let direction = direction * facing.signum();
        let wave = incident(&medium, direction, jones);
        let back = reflect_at_conductor(&medium, &wave, normal)[0];
        prop_assert!((back.power[0] - 1.0).abs() < 1e-12);
        let (residual, poynting) = examined(&medium, back.wave_vector, back.electric[0]);
        prop_assert!(residual < 1e-11, "Maxwell {residual}");
        let cosine = back.direction.dot(normal).abs().min(facing.abs());
        prop_assert!((poynting - back.direction).length() < 1e-13 / cosine.powi(2));
        let narrowing = (back.direction.dot(normal) / direction.dot(normal)).abs().sqrt();
        let total = wave.electric[0] + back.electric[0] * (1.0 / narrowing);
        prop_assert!(total.crossed_by(normal).norm_squared().sqrt() < 1e-11);
    }

    #[test]
    fn a_way_back_is_as_good_as_the_way_there(
        from in isotropic(), to in isotropic(), normal in unit_vector(),
        direction in unit_vector(),
    ) {
        // Reciprocity: unpolarized light is transmitted equally well either way.
        let facing = direction.dot(normal);
        prop_assume!(facing.abs() > 1e-2);
        let direction = direction * facing.signum();
        let transmitted = |from: &Medium, to: &Medium, direction: DVec3, normal: DVec3| {
            let basis = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]];
            let mut sum = None;
            for jones in basis {
                let wave = incident(from, direction, jones);
                let out = split(from, to, &wave, normal);
                let t = out.iter().find(|w| w.side == Side::Transmitted)?;
                let share = t.power[0];
                let (total, _) = sum.unwrap_or((0.0, t.direction));
                sum = Some((total + share, t.direction));
            }
            sum
        };
        if let Some((there, onward)) = transmitted(&from, &to, direction, normal) {
            let (back, _) = transmitted(&to, &from, -onward, -normal).unwrap();
            prop_assert!((there - back).abs() < 1e-11, "{there} {back}");
        }
    }
}

/// A medium behind the map that moves points at unit height above an interface by `shift`.
fn mapped(medium: &Medium, normal: DVec3, shift: DVec3) -> Medium {
    let lifted = DMat3::from_cols(shift * normal.x, shift * normal.y, shift * normal.z);
    let jacobian = DMat3::IDENTITY + lifted;
    let image = |tensor: &DMat3| {
        let m = jacobian * *tensor * jacobian.transpose() * (1.0 / jacobian.determinant());
        (m + m.transpose()) * 0.5
    };
    Medium::new(image(medium.permittivity()), image(medium.permeability())).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(300, 5_000)))]

    #[test]
    fn a_map_that_keeps_the_interface_reflects_nothing(
        from in medium(), normal in unit_vector(), direction in unit_vector(), jones in jones(),
        shift in unit_vector(), size in 0.0..2.0f64,
    ) {
        let shift = shift * size;
        prop_assume!((1.0 + shift.dot(normal)).abs() > 0.1);
        let facing = direction.dot(normal);
        prop_assume!(facing.abs() > 1e-2);
        let wave = incident(&from, direction * facing.signum(), jones);
        let to = mapped(&from, normal, shift);
        let seen = Reflectionless::between(&from, &to, normal).expect("no reflection");
        let onward = seen.transmit(&wave);
        let waves = split(&from, &to, &wave, normal);
        // Rounding in the tensors alone may leave some 1e-28 of the power in a reflected wave.
        let expected = waves.iter().find(|wave| wave.side == Side::Transmitted).unwrap();
        prop_assert!((expected.power[0] - 1.0).abs() < 1e-20);
        prop_assert_eq!(onward.power, wave.power);
        // Of p·µp = z det µ all terms are rounded; divided by how fast it changes along the normal, that is what
        // p is known to.
        let p = expected.wave_vector;
        let (mu, ray) = (to.permeability(), *to.permeability() * p);
        let size = [mu.x_axis, mu.y_axis, mu.z_axis].map(DVec3::length_squared).iter().sum::<f64>().sqrt();
        let z = to.permittivity().x_axis.x / mu.x_axis.x;
        let terms = z * size.powi(3) + size * p.length_squared();
        let known = 4.0 * f64::EPSILON * terms / ray.dot(normal).abs();
        let turned = known * size / ray.length();
        prop_assert!((onward.wave_vector - p).length() < known);
        prop_assert!((onward.direction - expected.direction).length() < turned);
        let [field, difference] = [expected.electric[0], onward.electric[0] - expected.electric[0]]
            .map(|field| field.norm_squared().sqrt());
        prop_assert!(difference < turned * field, "{difference}");
    }
}

#[test]
fn other_interfaces_are_not_taken_for_reflectionless() {
    let normal = DVec3::X;
    let air = Medium::AIR;
    let matched =
        Medium::impedance_matched(DMat3::from_diagonal(DVec3::new(0.5, 2.0, 2.0))).unwrap();
    assert!(Reflectionless::between(&air, &matched, normal).is_some());
    // A perfectly matched layer is one for its own normal alone.
    assert!(Reflectionless::between(&air, &matched, DVec3::Y).is_none());
    for other in [
        Medium::dielectric(1.5),
        Medium::isotropic(1.5, 1.5).unwrap(),
        Medium::isotropic(1.0 + 1e-12, 1.0 + 1e-12).unwrap(),
        Medium::uniaxial_magnetic(2.0, 2.0, 0.5, normal).unwrap(),
        Medium::new(DMat3::from_diagonal(DVec3::new(0.5, 2.0, 2.0)), 1.0).unwrap(),
    ] {
        assert!(Reflectionless::between(&air, &other, normal).is_none(), "{other:?}");
    }
}

/// Textbook amplitudes (Born & Wolf, 1.5.2) for s and p at an interface of dielectrics.
fn fresnel(n1: f64, n2: f64, angle: f64) -> [Complex64; 2] {
    let cos1 = Complex64::from(angle.cos());
    let sin2 = n1 * angle.sin() / n2;
    // The branch with Im > 0 decays.
    let cos2 = Complex64::from(1.0 - sin2 * sin2).sqrt();
    let s = (n1 * cos1 - n2 * cos2) / (n1 * cos1 + n2 * cos2);
    let p = (n2 * cos1 - n1 * cos2) / (n2 * cos1 + n1 * cos2);
    [s, p]
}

#[test]
fn dielectrics_follow_fresnel() {
    for (n1, n2) in [(1.0, 1.5), (1.5, 1.0), (1.918, 0.873)] {
        let (from, to) = (Medium::dielectric(n1), Medium::dielectric(n2));
        for step in 0..90 {
            let angle = f64::from(step).to_radians();
            let direction = DVec3::new(angle.cos(), angle.sin(), 0.0);
            let [s, p] = fresnel(n1, n2, angle);
            let reflect = |field: DVec3| {
                let wave = IncidentWave {
                    wave_vector: direction * n1,
                    attenuation: DVec3::ZERO,
                    direction,
                    electric: [(field * n1.powf(-0.5)).into()],
                    power: [1.0],
                };
                split(&from, &to, &wave, DVec3::X)[0]
            };
            let scale = n1.sqrt();
            let back_s = reflect(DVec3::Z);
            assert!((back_s.electric[0].dot_real(DVec3::Z) * scale - s).norm() < 1e-13);
            // For p the sign convention is that E and its reflection agree at grazing.
            let back_p = reflect(direction.cross(DVec3::Z));
            let along = back_p.direction.cross(DVec3::Z);
            assert!((back_p.electric[0].dot_real(along) * scale - p).norm() < 1e-13, "{angle}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(count(100, 2000)))]

    /// Fresnel's equations with complex permittivities and permeabilities, total reflection and
    /// evanescent waves included.
    #[test]
    fn jones_matrices_are_fresnels(
        here in (0.3..4.0f64, prop_oneof![Just(0.0), 0.0..2.0f64], 0.3..4.0f64),
        there in (-3.0..4.0f64, prop_oneof![Just(0.0), 0.05..2.0f64], 0.3..4.0f64),
        normal in unit_vector(),
        direction in unit_vector(),
        size in 0.05..2.0f64,
    ) {
        prop_assume!(there.0.abs() > 0.1);
        let along = (direction - normal * direction.dot(normal)).normalize() * size;
        let [(e1, m1), (e2, m2)] = [here, there].map(|(re, im, mu)| (Complex64::new(re, im), mu));
        let q = |e: Complex64, m: f64| {
            let root = (e * m - size * size).sqrt();
            if root.im < 0.0 { -root } else { root }
        };
        let (q1, q2) = (q(e1, m1), q(e2, m2));
        let (s1, s2, p1, p2) = (q1 / m1, q2 / m2, e2 * q1, e1 * q2);
        // Fields of p are those of H times its impedance.
        let [n1, n2] = [e1 * m1, e2 * m2].map(|square| {
            let root = square.sqrt();
            if root.re + root.im < 0.0 { -root } else { root }
        });
        let h_to_e = n1 * m2 / (n2 * m1);
        let expected = [
            [(s1 - s2) / (s1 + s2), (p1 - p2) / (p1 + p2)],
            [2.0 * s1 / (s1 + s2), 2.0 * p1 / (p1 + p2) * h_to_e],
        ];
        let medium = |e: Complex64, m: f64| {
            let scalar = |re: f64, im: f64| Tensor {
                re: DMat3::from_diagonal(DVec3::splat(re)),
                im: DMat3::from_diagonal(DVec3::splat(im)),
            };
            Medium::new(scalar(e.re, e.im), scalar(m, 0.0)).unwrap()
        };
        let solved = Scattering::new(&medium(e1, m1), Some(&medium(e2, m2)), along, normal);
        let found = solved.jones.unwrap();
        for (matrix, expected) in [found.reflected, found.transmitted.unwrap()].iter().zip(expected) {
            for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let wanted = if row == column { expected[row] } else { Complex64::ZERO };
                let scale = 1.0 + expected[row].norm();
                let off = (matrix[row][column] - wanted).norm() / scale;
                prop_assert!(off < 1e-10, "{row} {column} {off} {solved:?} {expected:?}");
            }
        }
        // Metal: no field along it.
        let metal = Scattering::new(&medium(e1, m1), None, along, normal).jones.unwrap();
        prop_assert!((metal.reflected[0][0] + 1.0).norm() < 1e-12);
        prop_assert!((metal.reflected[1][1] - 1.0).norm() < 1e-12);
        prop_assert!(metal.transmitted.is_none());
    }
}

#[test]
fn brewsters_angle_transmits_all_of_p() {
    let angle = 1.5f64.atan();
    let direction = DVec3::new(angle.cos(), angle.sin(), 0.0);
    let wave = IncidentWave {
        wave_vector: direction,
        attenuation: DVec3::ZERO,
        direction,
        electric: [direction.cross(DVec3::Z).into()],
        power: [1.0],
    };
    // What carries no power is left out.
    let waves = split(&Medium::AIR, &Medium::dielectric(1.5), &wave, DVec3::X);
    let [onward] = &waves[..] else { panic!("{waves:?}") };
    assert!(onward.side == Side::Transmitted && (onward.power[0] - 1.0).abs() < 1e-15);
}

#[test]
fn a_perfect_lens_reflects_nothing() {
    let lens = Medium::isotropic(-1.0, -1.0).unwrap();
    let direction = DVec3::new(0.8, 0.36, 0.48);
    let wave = incident(&Medium::AIR, direction, [0.3, 0.5, -0.2, 0.7]);
    let waves = split(&Medium::AIR, &lens, &wave, DVec3::X);
    let [onward] = &waves[..] else { panic!("{waves:?}") };
    assert!(onward.side == Side::Transmitted);
    assert!((onward.direction - DVec3::new(0.8, -0.36, -0.48)).length() < 1e-15);
}

#[test]
fn an_antireflection_coating_refracts_without_loss() {
    let direction = DVec3::new(0.8, 0.36, 0.48);
    let wave = incident(&Medium::AIR, direction, [0.3, 0.5, -0.2, 0.7]);
    let glass = Medium::dielectric(1.5);
    let waves = transmit_antireflection(&Medium::AIR, &glass, &wave, DVec3::X);
    assert_eq!(waves.len(), 1);
    assert!((waves[0].power[0] - 1.0).abs() < 1e-14);
    assert!((waves[0].direction.y - 0.24).abs() < 1e-15);
    assert!(examined(&glass, waves[0].wave_vector, waves[0].electric[0]).0 < 1e-14);
}

#[test]
fn grazing_incidence_gives_the_limit() {
    for cosine in [1e-6, 1e-9, 1e-12] {
        let direction = DVec3::new(cosine, 1.0, 0.0);
        let wave = incident(&Medium::AIR, direction.normalize(), [1.0, 0.3, 0.0, 0.2]);
        let waves = split(&Medium::AIR, &Medium::dielectric(1.5), &wave, DVec3::X);
        let total: f64 = waves.iter().map(|w| w.power[0]).sum();
        assert!((total - 1.0).abs() < 1e-9, "{total}");
        assert!(waves[0].power[0] > 0.999_99, "{}", waves[0].power[0]);
    }
}

#[test]
fn media_as_extreme_as_they_may_be_give_numbers() {
    let ends = [1e-12, -1e-12, 0.3, -7.0, 1e12, -1e12];
    let mut media = Vec::new();
    for a in ends {
        for b in ends {
            let made = [
                Medium::isotropic(a, b),
                Medium::uniaxial_electric(1.0, a, b, DVec3::new(0.3, 0.4, 0.5)),
                Medium::new(DMat3::from_diagonal(DVec3::new(a, 2.0, b)), 1.5),
                Medium::new(DMat3::from_diagonal(DVec3::new(2.0, 3.0, a)), b),
                Medium::new(Complex64::new(a, 1e-3), Complex64::new(b, 1e-6)),
            ];
            media.extend(made.into_iter().filter_map(|medium| match medium {
                Err(MediumError::TooDense { permittivity, permeability }) => {
                    assert!(permittivity * permeability > 1e12);
                    None
                }
                Err(MediumError::Singular { .. }) => {
                    // Beside a value of order 1, these are the ends.
                    assert!([a, b].iter().any(|end| !(1e-11..1e11).contains(&end.abs())));
                    None
                }
                medium => Some(medium.unwrap()),
            }));
        }
    }
    assert!(media.len() > 90, "{}", media.len());
    for direction in [DVec3::X, DVec3::new(0.6, 0.64, 0.48), DVec3::new(1e-3, 0.7, 0.7).normalize()]
    {
        let wave = incident(&Medium::AIR, direction, [0.6, 0.0, 0.0, 0.8]);
        for medium in &media {
            let waves = split(&Medium::AIR, medium, &wave, DVec3::X);
            let total: f64 = waves.iter().map(|wave| wave.power[0]).sum();
            assert!(total < 1.0 + 1e-9, "{total}: {waves:?} in {medium:?}");
            // An evanescent wave takes what the medium absorbs.
            let most = if medium.absorbs() {
                let scattering = Scattering::new(&Medium::AIR, Some(medium), direction, DVec3::X);
                let beyond = scattering.power.iter().flatten().map(|share| share[2] + share[3]);
                beyond.fold(0.0, f64::max)
            } else {
                0.0
            };
            assert!(total + most > 1.0 - 1e-9, "{total}: {waves:?} in {medium:?}");
            for wave in &waves {
                assert!(wave.direction.is_normalized(), "{wave:?} in {medium:?}");
                assert!(
                    wave.wave_vector.is_finite() && wave.electric[0].norm_squared().is_finite()
                );
            }
        }
    }
    for beyond in [1e-13, -1e13, 0.0, f64::NAN, f64::INFINITY] {
        assert!(Medium::isotropic(beyond, 1.0).is_err() && Medium::new(1.0, beyond).is_err());
        assert!(Medium::new(DMat3::from_diagonal(DVec3::new(1.0, beyond, 1.0)), 1.0).is_err());
    }
}
