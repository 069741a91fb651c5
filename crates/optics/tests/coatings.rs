//! Thin films against a scalar recursion, against other programs' numbers, and against what any of
//! them must obey.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::long::count;
use crate::random_media::{KINDS, Random, medium};
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::interface::{
    Backing, Film, FilmLayer, IncidentWave, OutgoingWaves, Side, reflect_at_conductor, split,
    split_coated,
};
use optics::medium::{Heading, Medium};
use optics::wave::ComplexVector;
use std::f64::consts::{PI, TAU};

const NM: f64 = 1e-7;
const WAVE_NUMBER: f64 = TAU / (550.0 * NM);

/// The error of amplitudes where light is caught behind a layer through which it tunnels: a
/// resonance magnifies rounding, by up to 1e5 here.
const RESONANT: f64 = 1e-10;

fn of_index(index: Complex64) -> Medium {
    Medium::new(index * index, 1.0).unwrap()
}

fn layer(index: impl Into<Complex64>, nanometres: f64) -> FilmLayer {
    FilmLayer { medium: of_index(index.into()), thickness: nanometres * NM }
}

/// The unit vectors of s and p for light along (k, 0, kz).
fn polarizations(direction: DVec3) -> [DVec3; 2] {
    [DVec3::Y, DVec3::Y.cross(direction)]
}

/// Light in a dielectric that comes to the plane z = 0 at an angle, s and p, of the power 1 each.
fn arriving(index: f64, angle: f64) -> IncidentWave<2> {
    let direction = DVec3::new(angle.sin(), 0.0, angle.cos());
    let electric = polarizations(direction).map(|field| field / index.sqrt());
    IncidentWave {
        wave_vector: direction * index,
        attenuation: DVec3::ZERO,
        direction,
        electric: electric.map(ComplexVector::from),
        power: [1.0; 2],
    }
}

fn coated<const N: usize>(
    medium: &Medium,
    layers: &[FilmLayer],
    backing: Backing<'_>,
    wave: &IncidentWave<N>,
) -> OutgoingWaves<N> {
    let mut waves = OutgoingWaves::new();
    let film = Film { layers: [layers, &[]], wave_number: WAVE_NUMBER };
    split_coated(medium, (film, backing), wave, DVec3::Z, 0.0, &mut waves);
    waves
}

fn power<const N: usize>(waves: &OutgoingWaves<N>, side: Side) -> [f64; N] {
    std::array::from_fn(|i| waves.iter().filter(|w| w.side == side).map(|w| w.power[i]).sum())
}

/// A stack of isotropic media of complex indices between two of them, by Airy's recursion with
/// scalar amplitudes: those reflected and transmitted of tangential fields E_y (s) or H_y (p).
fn airy(indices: &[Complex64], depths: &[f64], k: f64, p: bool) -> [Complex64; 2] {
    let normal = |n: Complex64| {
        let q = (n * n - k * k).sqrt();
        if q.im < 0.0 || (q.im == 0.0 && q.re < 0.0) { -q } else { q }
    };
    let impedance = |n: Complex64| if p { normal(n) / (n * n) } else { normal(n) };
    let between = |a: Complex64, b: Complex64| {
        let (a, b) = (impedance(a), impedance(b));
        [(a - b) / (a + b), 2.0 * a / (a + b)]
    };
    let last = indices.len() - 1;
    let [mut r, mut t] = between(indices[last - 1], indices[last]);
    for i in (1..last).rev() {
        let phase = (Complex64::i() * normal(indices[i]) * depths[i - 1]).exp();
        let [r1, t1] = between(indices[i - 1], indices[i]);
        let around = 1.0 + r1 * r * phase * phase;
        t = t1 * t * phase / around;
        r = (r1 + r * phase * phase) / around;
    }
    [r, t]
}

#[test]
fn films_are_those_of_other_programs() {
    // Reflectance and transmittance, s and p, at 550 nm, by the Python package tmm 0.2.0; indices,
    // thicknesses (nm), angle.
    type Case<'a> = (&'a [(f64, f64)], &'a [f64], f64, [[f64; 2]; 2]);
    let cases: [Case<'_>; 4] = [
        (
            &[(1.0, 0.0), (1.38, 0.0), (2.15, 0.0), (1.7, 0.0), (1.52, 0.0)],
            &[97.3, 121.9, 80.2],
            35.0,
            [
                [0.003110416282687, 9.968895837173126e-01],
                [0.001504628592731, 9.984953714072687e-01],
            ],
        ),
        (
            &[(1.0, 0.0), (0.05, 3.9), (1.46, 0.0), (0.13, 3.2), (1.5, 0.0)],
            &[12.0, 140.0, 25.0],
            60.0,
            [
                [0.748278362821933, 1.543770615540065e-01],
                [0.134254521803043, 0.673_468_626_352_846],
            ],
        ),
        // Frustrated total reflection.
        (
            &[(1.7, 0.0), (1.3, 0.0), (1.7, 0.0)],
            &[200.0],
            70.0,
            [
                [0.954288543318891, 4.571145668110882e-02],
                [0.975910562703138, 2.408943729686176e-02],
            ],
        ),
        // A surface plasmon takes light that would be totally reflected.
        (
            &[(1.52, 0.0), (0.06, 3.6), (1.0, 0.0)],
            &[50.0],
            43.5,
            [[0.981570381548352, 0.0], [0.500790985668217, 0.0]],
        ),
    ];
    for (indices, thicknesses, angle, expected) in cases {
        let indices: Vec<Complex64> = indices.iter().map(|(n, k)| Complex64::new(*n, *k)).collect();
        let layers: Vec<FilmLayer> =
            indices[1..].iter().zip(thicknesses).map(|(n, t)| layer(*n, *t)).collect();
        let [first, last] = [indices[0], indices[indices.len() - 1]].map(of_index);
        let wave = arriving(indices[0].re, f64::to_radians(angle));
        let waves = coated(&first, &layers, Backing::Medium(&last), &wave);
        for (polarization, [r, t]) in expected.into_iter().enumerate() {
            assert!((power(&waves, Side::Reflected)[polarization] - r).abs() < 1e-14, "{waves:?}");
            let found = power(&waves, Side::Transmitted)[polarization];
            assert!((found - t).abs() < 1e-14, "{found} {t}");
        }
    }
    // A biaxial film on glass at 40 degrees, by pyElli 0.23.1 (Berreman): rows from s, then p,
    // columns to s, then p.
    let tensor = DMat3::from_cols_array_2d(&[
        [2.443_482_31, -0.232_374_86, 0.007_366_63],
        [-0.232_374_86, 2.728_881_57, -0.320_892_01],
        [0.007_366_63, -0.320_892_01, 2.737_636_13],
    ]);
    let biaxial = Medium::new(tensor, 1.0).unwrap();
    let layers = [FilmLayer { medium: biaxial, thickness: 150.0 * NM }];
    let wave = arriving(1.0, f64::to_radians(40.0));
    let glass = Medium::dielectric(1.5);
    let waves = coated(&Medium::AIR, &layers, Backing::Medium(&glass), &wave);
    for wave in &waves {
        let share = |from: usize, to: usize| {
            let field = wave.electric[from].dot_real(polarizations(wave.direction)[to]);
            field.norm_sqr() * if wave.side == Side::Transmitted { 1.5 } else { 1.0 }
        };
        let expected = if wave.side == Side::Reflected {
            [[0.091_009_73, 0.001_122_99], [6.931_440_38e-05, 0.015_349_73]]
        } else {
            [[0.905_476_82, 0.002_390_46], [0.002_713_9, 0.981_867_06]]
        };
        for (from, row) in expected.iter().enumerate() {
            for (to, expected) in row.iter().enumerate() {
                let found = share(from, to);
                assert!((found - expected).abs() < 2e-8, "{from} {to} {found} {expected}");
            }
        }
    }
}

#[test]
fn metal_films_and_quarter_waves_are_those_of_the_textbook() {
    let transmitted = |permittivity: Complex64| {
        let medium = Medium::new(permittivity, 1.0).unwrap();
        let layers = [FilmLayer { medium, thickness: 20.0 * NM }];
        let waves =
            coated(&Medium::AIR, &layers, Backing::Medium(&Medium::AIR), &arriving(1.0, 0.0));
        power(&waves, Side::Transmitted)[0]
    };
    // physics.md, section 8.
    assert!((transmitted(Complex64::new(-5.9, 2.1)) - 0.435_734_1).abs() < 1e-6);
    assert!((transmitted(Complex64::new(-2.0, 0.0)) - 0.891_582_3).abs() < 1e-6);
    // A quarter wave of index √n kills the reflection of n; so do two of n₁ and n₂ with n₂/n₁ = √n.
    for n in [1.5, 2.4, 4.0] {
        let quarter = |index: f64| layer(index, 550.0 / (4.0 * index));
        let glass = Medium::dielectric(n);
        for layers in [vec![quarter(n.sqrt())], vec![quarter(1.38), quarter(1.38 * n.sqrt())]] {
            let waves = coated(&Medium::AIR, &layers, Backing::Medium(&glass), &arriving(1.0, 0.0));
            assert!(power(&waves, Side::Reflected)[0] < 1e-28, "{waves:?}");
        }
        // A quarter-wave stack of N pairs reflects ((1 - n (H/L)^2N)/(1 + n (H/L)^2N))².
        let pairs: Vec<FilmLayer> = (0..8).flat_map(|_| [quarter(2.3), quarter(1.4)]).collect();
        let waves = coated(&Medium::AIR, &pairs, Backing::Medium(&glass), &arriving(1.0, 0.0));
        let admittance = n * f64::powi(2.3 / 1.4, 16);
        let expected = ((1.0 - admittance) / (1.0 + admittance)).powi(2);
        assert!((power(&waves, Side::Reflected)[0] - expected).abs() < 1e-13);
    }
}

#[test]
fn stacks_of_isotropic_layers_are_those_of_airys_recursion() {
    let mut random = Random(7);
    for _ in 0..count(2000, 200_000) {
        let metal = random.unit() < 0.5;
        let mut index = |metal: bool| match metal {
            true => Complex64::new(random.between(0.05, 3.0), random.between(0.0, 5.0)),
            false => random.between(1.0, 3.0).into(),
        };
        let first = index(false).re;
        let layers: Vec<Complex64> = (0..3).map(|i| index(metal && i == 1)).collect();
        let last = index(metal);
        let thicknesses: Vec<f64> = (0..3).map(|_| random.between(0.0, 300.0)).collect();
        let angle = random.between(0.0, 1.5);
        let (k, indices) = (first * angle.sin(), [&[first.into()], &layers[..], &[last]].concat());
        // Near a critical angle normal components are small differences, in either program.
        if indices.iter().any(|n| (n * n - k * k).norm() < 1e-2) {
            continue;
        }
        let depths: Vec<f64> = thicknesses.iter().map(|t| t * NM * WAVE_NUMBER).collect();
        let film: Vec<FilmLayer> =
            layers.iter().zip(&thicknesses).map(|(n, t)| layer(*n, *t)).collect();
        let wave = arriving(first, angle);
        let here = of_index(first.into());
        let beyond = of_index(last);
        for backing in [Backing::Medium(&beyond), Backing::Absorber(&beyond)] {
            let waves = coated(&here, &film, backing, &wave);
            for (i, p) in [false, true].into_iter().enumerate() {
                let [r, t] = airy(&indices, &depths, k, p);
                let back = waves.iter().find(|wave| wave.side == Side::Reflected).unwrap();
                // H_y of p is that of E along y × k; of the wave that runs back, too.
                let field = back.electric[i].dot_real(polarizations(back.direction)[i]);
                let expected = r / first.sqrt();
                assert!((field - expected).norm() < RESONANT, "{field} {expected} {indices:?}");
                let on = waves.iter().find(|wave| wave.side == Side::Transmitted);
                if backing == Backing::Absorber(&beyond) {
                    assert!(on.is_none());
                }
                let real = last.im == 0.0 && last.re > k;
                if let Some(on) = on.filter(|_| real) {
                    // E of p from H_y, and the beam's width.
                    let field = on.electric[i].dot_real(polarizations(on.direction)[i]);
                    let amplitude = if p { t * first / last.re } else { t };
                    let widening = (on.direction.z / angle.cos()).sqrt();
                    let expected = amplitude * widening / first.sqrt();
                    assert!((field - expected).norm() < RESONANT, "{field} {expected} {indices:?}");
                }
            }
        }
        // On a perfect conductor the last index is that of r_s = -1, r_p = 1.
        let waves = coated(&here, &film[..1], Backing::Conductor, &wave);
        for (i, last) in [-1.0, 1.0].into_iter().enumerate() {
            let [r1, _] = airy(&indices[..2], &[], k, i == 1);
            let q = (layers[0] * layers[0] - k * k).sqrt();
            let around = (2.0 * Complex64::i() * q * depths[0]).exp() * last;
            let expected = (r1 + around) / (1.0 + r1 * around) / first.sqrt();
            let field = waves[0].electric[i].dot_real(polarizations(waves[0].direction)[i]);
            assert!((field - expected).norm() < RESONANT, "{field} {expected} {indices:?}");
        }
    }
}

/// A wave of a medium towards z = 0, if it has one with that tangential wave vector.
fn mode_towards(medium: &Medium, tangential: DVec3, which: usize) -> Option<IncidentWave<1>> {
    let mode = medium.modes(tangential, DVec3::Z, Heading::Forward)[which];
    let (ray, flux) = (mode.ray?, mode.poynting().length());
    Some(IncidentWave {
        wave_vector: mode.wave_vector.re,
        attenuation: mode.wave_vector.im,
        direction: ray,
        electric: [mode.electric * flux.sqrt().recip()],
        power: [1.0],
    })
}

fn assert_same(a: &OutgoingWaves<1>, b: &OutgoingWaves<1>, tolerance: f64, what: &str) {
    let strong = |waves: &OutgoingWaves<1>| -> Vec<_> {
        waves.iter().filter(|wave| wave.power[0] > 1e-20).copied().collect()
    };
    let (a, b) = (strong(a), strong(b));
    assert_eq!(a.len(), b.len(), "{what} {a:?} {b:?}");
    for (a, b) in a.iter().zip(&b) {
        assert_eq!(a.side, b.side);
        let off = (a.electric[0] + b.electric[0] * -1.0).norm_squared().sqrt();
        assert!(
            off < tolerance * (1.0 + a.electric[0].norm_squared().sqrt()),
            "{off} {what} {a:?} {b:?}"
        );
        assert!((a.power[0] - b.power[0]).abs() < tolerance, "{what} {a:?} {b:?}");
    }
}

#[test]
fn layers_of_no_thickness_change_nothing_and_layers_of_the_medium_itself_only_phases() {
    let mut random = Random(11);
    let mut compared = 0;
    while compared < count(1500, 100_000) {
        let kinds = [0; 3].map(|_| random.below(KINDS.len() - 1));
        let [here, there, between] = kinds.map(|kind| medium(kind, &mut random));
        let tangential = random.direction() * random.between(0.0, 1.2);
        let tangential = tangential - DVec3::Z * tangential.z;
        let which = random.below(2);
        let Some(wave) = mode_towards(&here, tangential, which) else { continue };
        let what = format!("{:?}", kinds.map(|kind| KINDS[kind]));
        let none = [FilmLayer { medium: between, thickness: 0.0 }];
        let bare = split(&here, &there, &wave, DVec3::Z);
        let found = coated(&here, &none, Backing::Medium(&there), &wave);
        assert_same(&found, &bare, 1e-7, &what);
        let bare = reflect_at_conductor(&here, &wave, DVec3::Z);
        let found = coated(&here, &none, Backing::Conductor, &wave);
        assert_same(&found, &bare, 1e-7, &what);
        // Powers of what is transmitted do not see a layer of the medium beyond, nor those of what
        // is reflected.
        let own = [FilmLayer { medium: there, thickness: random.between(0.0, 300.0) * NM }];
        let bare = split(&here, &there, &wave, DVec3::Z);
        let found = coated(&here, &own, Backing::Medium(&there), &wave);
        let sum = |waves: &OutgoingWaves<1>, side| power(waves, side)[0];
        for side in [Side::Reflected, Side::Transmitted] {
            let [a, b] = [sum(&bare, side), sum(&found, side)];
            assert!((a - b).abs() < 1e-7, "{what} {a} {b}");
        }
        compared += 1;
    }
}

#[test]
fn light_goes_back_through_films_as_it_came() {
    let mut random = Random(13);
    let mut compared = 0;
    while compared < count(1500, 100_000) {
        // S_ij(k) = S_ji(-k) for symmetric tensors, absorbing or not.
        let kinds =
            [random.below(KINDS.len()), [0, 1, 2, 3, 5, 6][random.below(6)], random.below(7)];
        let [between, here, there] = kinds.map(|kind| medium(kind, &mut random));
        let tangential = DVec3::new(random.between(0.0, 1.0), random.between(0.0, 0.5), 0.0);
        let thickness = random.between(0.0, 400.0) * NM;
        let film = [FilmLayer { medium: between, thickness }];
        let Some(wave) = mode_towards(&here, tangential, random.below(2)) else { continue };
        let waves = coated(&here, &film, Backing::Medium(&there), &wave);
        let total: f64 = waves.iter().map(|wave| wave.power[0]).sum();
        assert!(total < 1.0 + 1e-9, "{total}");
        let lossless = !between.absorbs();
        assert!(!lossless || (total - 1.0).abs() < 1e-12, "{total} {kinds:?}");
        for on in waves.iter().filter(|wave| wave.side == Side::Transmitted) {
            // Backwards: the fields of a plane wave that runs the other way are its conjugate ones.
            if on.power[0] < 1e-6 {
                continue;
            }
            let back = IncidentWave {
                wave_vector: -on.wave_vector,
                attenuation: DVec3::ZERO,
                direction: -on.direction,
                electric: [on.electric[0].conj() * on.power[0].sqrt().recip()],
                power: [1.0],
            };
            let mut waves = OutgoingWaves::new();
            let film = Film { layers: [&film, &[]], wave_number: WAVE_NUMBER };
            let beyond = (film, Backing::Medium(&here));
            split_coated(&there, beyond, &back, -DVec3::Z, 0.0, &mut waves);
            let same = waves.iter().filter(|returned| {
                returned.side == Side::Transmitted
                    && (returned.wave_vector + wave.wave_vector).length() < 1e-6
            });
            // Of two polarizations on one wave, orthogonal in isotropic media, the part that has
            // been launched.
            let returned: f64 = same
                .map(|returned| {
                    let (e, f) = (returned.electric[0], wave.electric[0]);
                    returned.power[0] * e.dot(f).norm_sqr() / (e.norm_squared() * f.norm_squared())
                })
                .sum();
            assert!((returned - on.power[0]).abs() < 1e-7, "{returned} {on:?} {kinds:?}");
        }
        compared += 1;
    }
}

#[test]
fn thick_metals_hold_and_films_on_metal_reflect_what_they_do_not_absorb() {
    let silver = Complex64::new(0.06, 3.6);
    for thickness in [0.0, 1e3, 1e4, 1e6] {
        for angle in [0.0, 0.7, 1.4, 0.5 * PI - 1e-9] {
            let wave = arriving(1.0, angle);
            let bulk = of_index(silver);
            // A film of the metal on the metal is the metal, however thick it is.
            let film = [layer(silver, thickness)];
            let waves = coated(&Medium::AIR, &film, Backing::Absorber(&bulk), &wave);
            let bare = split(&Medium::AIR, &bulk, &wave, DVec3::Z);
            let [found, expected] = [&waves, &bare].map(|waves| power(waves, Side::Reflected));
            for i in 0..2 {
                assert!((found[i] - expected[i]).abs() < 1e-12, "{found:?} {expected:?}");
            }
            if thickness > 0.0 {
                let waves = coated(&Medium::AIR, &film, Backing::Conductor, &wave);
                let found = power(&waves, Side::Reflected);
                assert!((found[0] - expected[0]).abs() < 1e-12, "{found:?} {expected:?}");
            }
            // What does not absorb sends all back, half waves on a conductor too.
            let half = [layer(1.5, 550.0 / 3.0)];
            let waves = coated(&Medium::AIR, &half, Backing::Conductor, &wave);
            assert!((power(&waves, Side::Reflected)[1] - 1.0).abs() < 1e-12);
        }
    }
}

/// Where a layer's waves run along it, forward and backward ones are one.
#[test]
fn layers_whose_waves_run_along_them_keep_the_power() {
    let mut worst: f64 = 0.0;
    for index in [3.54e-3, 1e-2, 0.1, 0.5, 0.9] {
        let film = [layer(index, 162.88)];
        let critical = f64::asin(index);
        for i in -60_i32..=60 {
            let off = 10f64.powf(-0.25 * f64::from(i).abs() - 1.0) * f64::from(i).signum();
            let wave = arriving(1.0, critical * (1.0 + off));
            let waves = coated(
                &of_index(Complex64::ONE),
                &film,
                Backing::Medium(&of_index(Complex64::ONE)),
                &wave,
            );
            let sums: [f64; 2] = std::array::from_fn(|p| waves.iter().map(|w| w.power[p]).sum());
            worst = sums.iter().fold(worst, |worst, sum| worst.max((sum - 1.0).abs()));
        }
    }
    assert!(worst < 1e-13, "{worst:e}");
}
