//! A million interfaces of random media: energy, Maxwell's equations, continuity, no NaN.
//!
//! Every ordered pair of eleven kinds of media, and metal, at random normals and tangential wave
//! vectors up to |p_t| = 3: total reflection and evanescent waves from either side are in it.
#![allow(
    clippy::expect_used,
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::print_stdout,
    reason = "a test may"
)]

use crate::long::count;
use crate::random_media::{KINDS, Random, jump, maxwell_residual, medium};
use glam::DVec3;
use optics::interface::Scattering;
use optics::medium::{Medium, Mode};
use optics::wave::{ComplexVector, poynting};

#[derive(Default)]
struct Worst {
    maxwell: f64,
    jump: f64,
    share: f64,
    energy: f64,
    energy_of_moderate_waves: f64,
    /// Incident modes above and below [`MODERATE`].
    counts: [usize; 2],
}

/// |E|² + |H|² of a wave, in units of its interface's flux, above which 1e-12 of the flux is next to
/// the rounding of the field's own products.
const MODERATE: f64 = 1e4;

/// A NaN is worse than anything.
fn raise(worst: &mut f64, value: f64) {
    *worst = if value.is_nan() { f64::INFINITY } else { worst.max(value) };
}

/// The flux through the interface of an incident mode and of what it makes, Re(E × H*) along the
/// normal, from the fields themselves: the powers of a [`Scattering`] are shares of the outgoing
/// sum, and add up whatever the fields are.
fn fluxes(s: &Scattering, column: usize, normal: DVec3) -> [f64; 2] {
    let incident = &s.incident[column];
    let incident = poynting(incident.electric, incident.magnetic).dot(normal);
    let flux = |modes: &[Mode; 2], first: usize| {
        let [a, b] = [0, 1].map(|i| s.amplitudes[first + i][column]);
        let field = |x: ComplexVector, y: ComplexVector| x.scaled(a) + y.scaled(b);
        poynting(
            field(modes[0].electric, modes[1].electric),
            field(modes[0].magnetic, modes[1].magnetic),
        )
        .dot(normal)
    };
    [incident, s.transmitted.as_ref().map_or(0.0, |modes| flux(modes, 2)) - flux(&s.reflected, 0)]
}

/// The largest |E|² + |H|² of the waves at an interface for an incident mode of flux 1.
fn largest_wave(s: &Scattering, column: usize) -> f64 {
    let size = |mode: &Mode| mode.electric.norm_squared() + mode.magnetic.norm_squared();
    let outgoing = s.reflected.iter().chain(s.transmitted.iter().flatten());
    outgoing
        .zip(&s.amplitudes)
        .map(|(mode, row)| size(mode) * row[column].norm_sqr())
        .fold(size(&s.incident[column]), f64::max)
}

fn examine(worst: &mut Worst, from: &Medium, to: Option<&Medium>, s: &Scattering, normal: DVec3) {
    for mode in s.incident.iter().chain(&s.reflected) {
        raise(&mut worst.maxwell, maxwell_residual(from, mode));
    }
    for (to, modes) in to.iter().zip(&s.transmitted) {
        for mode in modes {
            raise(&mut worst.maxwell, maxwell_residual(to, mode));
        }
    }
    for (column, power) in s.power.iter().enumerate() {
        let Some(power) = power else { continue };
        raise(&mut worst.jump, jump(s, column, normal));
        assert!(power.iter().all(|p| p.is_finite() && *p >= 0.0), "{power:?}");
        if !from.absorbs() {
            let together = s.interference[column].expect("as there is a power");
            let sum = power.iter().chain(&together).sum::<f64>();
            let [incident, outgoing] = fluxes(s, column, normal);
            let error = (outgoing - incident).abs();
            let size = largest_wave(s, column);
            if to.is_some_and(Medium::absorbs) {
                raise(&mut worst.energy, (sum - 1.0).abs() / size);
            } else {
                raise(&mut worst.share, (sum - 1.0).abs());
            }
            raise(&mut worst.energy, error / size);
            if size < MODERATE {
                raise(&mut worst.energy_of_moderate_waves, error);
            }
            worst.counts[usize::from(size < MODERATE)] += 1;
        }
    }
}

#[test]
fn energy_maxwell_and_continuity() {
    let mut random = Random(1);
    let mut worst = Worst::default();
    for _ in 0..count(20_000, 1_000_000) {
        let from = medium(random.below(KINDS.len()), &mut random);
        let beyond = random.below(KINDS.len() + 1);
        let to = (beyond < KINDS.len()).then(|| medium(beyond, &mut random));
        let normal = random.direction();
        let tangential = random.direction() * random.between(0.0, 3.0);
        let s = Scattering::new(&from, to.as_ref(), tangential, normal);
        examine(&mut worst, &from, to.as_ref(), &s, normal);
    }
    // Relative to the terms of the equations and to the largest field.
    assert!(worst.maxwell < 1e-11, "Maxwell {:e}", worst.maxwell);
    assert!(worst.jump < 1e-14, "jump {:e}", worst.jump);
    // The account of the power is exact.
    assert!(worst.share < 4e-15, "share {:e}", worst.share);
    // The fields' own flux, before it is shared out, is a check on the modes. Near grazing, near
    // the asymptotic cone of a hyperbolic medium and at resonances of evanescent waves it is a
    // small difference of products of large fields, each of which is known to rounding: so relative
    // to them.
    let [immoderate, moderate] = worst.counts;
    println!(
        "Maxwell {:.1e}, jump {:.1e}, share {:.1e}, energy {:.1e}, relative to the largest wave {:.1e}; \
         {immoderate} of {} waves immoderate",
        worst.maxwell,
        worst.jump,
        worst.share,
        worst.energy_of_moderate_waves,
        worst.energy,
        immoderate + moderate,
    );
    assert!(worst.energy_of_moderate_waves < 1e-12, "{:e}", worst.energy_of_moderate_waves);
    assert!(worst.energy < 5e-14, "{:e}", worst.energy);
    assert!(immoderate * 100 < moderate, "{immoderate} {moderate}");
}

/// Both ways to the modes of a medium: its closed form and the eigenproblem.
#[test]
fn closed_forms_agree_with_the_eigenproblem() {
    let mut random = Random(2);
    let mut worst: f64 = 0.0;
    for _ in 0..count(4_000, 40_000) {
        let pick = |random: &mut Random| {
            let kind = [0, 1, 2, 3, 4, 8, 10][random.below(7)];
            medium(kind, random)
        };
        let (from, to) = (pick(&mut random), pick(&mut random));
        let normal = random.direction();
        let tangential = random.direction() * random.between(0.0, 3.0);
        let closed = Scattering::new(&from, Some(&to), tangential, normal);
        let general = Scattering::new(
            &from.without_closed_form(),
            Some(&to.without_closed_form()),
            tangential,
            normal,
        );
        // The powers between modes, whatever their order; those of degenerate pairs, whose basis is
        // free, in sum.
        let named =
            |a: &Mode, b: &Mode| (a.wave_vector - b.wave_vector).norm_squared().sqrt() < 1e-5;
        let degenerate = |m: &[Mode; 2]| named(&m[0], &m[1]);
        if degenerate(&closed.incident) {
            let sum = |s: &Scattering, row: usize| {
                let rows = s.power.iter().flatten().map(|p| p[row] + p[row + 1]);
                let together = s.interference.iter().flatten().map(|of| of[row / 2]);
                rows.chain(together).sum::<f64>()
            };
            for row in [0, 2] {
                let difference = (sum(&closed, row) - sum(&general, row)).abs();
                if closed.power.iter().all(Option::is_some) && !to.absorbs() && !from.absorbs() {
                    raise(&mut worst, difference);
                }
            }
            continue;
        }
        for (i, a) in closed.incident.iter().enumerate() {
            let Some(j) = general.incident.iter().position(|b| named(a, b)) else {
                panic!("no mode {a:?} among {:?}", general.incident);
            };
            assert_eq!(closed.power[i].is_some(), general.power[j].is_some(), "{from:?}");
            let (Some(p), Some(q)) = (closed.power[i], general.power[j]) else { continue };
            let together = [closed.interference[i], general.interference[j]]
                .map(|of| of.expect("as there is a power"));
            let sides = [
                (0, Some((&closed.reflected, &general.reflected))),
                (2, closed.transmitted.as_ref().zip(general.transmitted.as_ref())),
            ];
            for (row, modes) in sides {
                let Some((ours, theirs)) = modes else { continue };
                let swapped = usize::from(!named(&ours[0], &theirs[0]));
                if degenerate(ours) {
                    let [ours, theirs] = together.map(|of| of[row / 2]);
                    let sums = [p[row] + p[row + 1] + ours, q[row] + q[row + 1] + theirs];
                    raise(&mut worst, (sums[0] - sums[1]).abs());
                } else {
                    for k in 0..2 {
                        raise(&mut worst, (p[row + k] - q[row + (k ^ swapped)]).abs());
                    }
                }
            }
        }
    }
    println!("closed forms against eigenproblem: {worst:.1e}");
    // Worst next to grazing, where either way loses digits.
    assert!(worst < 1e-9, "{worst:e}");
}
