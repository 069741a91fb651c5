//! Interfaces with thin films: stacks of layers in which light interferes, or through which it
//! tunnels.
//!
//! All waves that go on beyond a stack span a plane of tangential fields (E, H). It is carried back
//! through the layers in the modes F, B of each: where it is spanned by F a + B b on a layer's far
//! side, it is spanned by F + B exp(-i q_B k₀t) b a⁻¹ exp(i q_F k₀t) on its near side. Both
//! exponentials decay, so that metals may be as thick as they like; and at a conductor, which has
//! no finite admittance, the plane is E = 0.

use super::{Scattered, matched, tangential};
use crate::interface::splitting::Splitting;
use crate::interface::{IncidentWave, OutgoingWaves};
use crate::medium::{LocalMode, LocalModes, Medium, ModeKind, Tangential};
use crate::wave::{Frame, solve};
use glam::DVec3;
use num_complex::Complex64;

/// A layer of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmLayer {
    /// What it is of: anything, also what only decaying waves get through.
    pub medium: Medium,
    /// How thick it is, cm.
    pub thickness: f64,
}

/// The layers at an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film<'a> {
    /// The layers in the order in which transmitted light meets them: first one part, then the
    /// other.
    pub layers: [&'a [FilmLayer]; 2],
    /// The wave number in vacuum, 1/cm.
    pub wave_number: f64,
}

/// What lies beyond an interface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Backing<'a> {
    /// A medium in which light goes on.
    Medium(&'a Medium),
    /// A medium that keeps all light that enters it.
    Absorber(&'a Medium),
    /// A perfect conductor.
    Conductor,
}

/// Splits a wave at an interface with thin films, as
/// [`split_down_to`](crate::interface::split_down_to) does at a bare one. What is transmitted
/// starts where the incident wave ends: the films have no thickness but in the phases of the
/// fields. If nothing absorbs, the powers of the waves add up to that of the incident one; else the
/// rest is absorbed.
///
/// # Example
///
/// Gold of 20 nm on nothing is still a window.
///
/// ```
/// use glam::DVec3;
/// use num_complex::Complex64;
/// use optics::interface::{Backing, Film, FilmLayer, IncidentWave, OutgoingWaves, split_coated};
/// use optics::medium::Medium;
///
/// let gold = Medium::new(Complex64::new(-5.9, 2.1), 1.0)?;
/// let layers = [FilmLayer { medium: gold, thickness: 20e-7 }];
/// let film = Film { layers: [&layers, &[]], wave_number: std::f64::consts::TAU / 550e-7 };
/// let wave = IncidentWave {
///     wave_vector: DVec3::X,
///     attenuation: DVec3::ZERO,
///     direction: DVec3::X,
///     electric: [DVec3::Y.into()],
///     power: [1.0],
/// };
/// let mut waves = OutgoingWaves::new();
/// let beyond = Backing::Medium(&Medium::AIR);
/// split_coated(&Medium::AIR, (film, beyond), &wave, DVec3::X, 0.0, &mut waves);
/// assert!((waves[1].power[0] - 0.436).abs() < 5e-4);
/// # Ok::<(), optics::medium::MediumError>(())
/// ```
pub fn split_coated<const N: usize>(
    incident_medium: &Medium,
    (film, backing): (Film<'_>, Backing<'_>),
    wave: &IncidentWave<N>,
    normal: DVec3,
    least_power: f64,
    waves: &mut OutgoingWaves<N>,
) -> [f64; N] {
    let splitting = Splitting::new(wave, normal, least_power, waves);
    let normal_component = wave.wave_vector.dot(normal);
    let (frame, tangential) = (splitting.frame, tangential(&splitting));
    let (arriving, backward) =
        incident_medium.arriving_and_back(&frame, tangential, normal_component);
    let (arriving, backward) = (arriving.complex(), backward.complex());
    let (medium, absorber) = match backing {
        Backing::Medium(medium) => (Some(medium), false),
        Backing::Absorber(medium) => (Some(medium), true),
        Backing::Conductor => (None, false),
    };
    let onward = medium.map(|medium| medium.onward(&frame, tangential).complex());
    let layers = || film.layers.iter().copied().flatten();
    let mut fields = TransferredFields::beyond(onward.as_ref());
    for layer in layers().rev() {
        fields.carry_back(layer, film.wave_number * layer.thickness, &frame, tangential);
    }
    let mut scattered = Scattered { splitting, tangential, weak: [0.0; N] };
    let incident = scattered.incident(&arriving, normal_component);
    let spanning = fields.near.map(as_mode);
    let Some([r1, r2, s1, s2]) = matched(&incident, &backward, Some(&spanning)) else {
        return scattered.weak;
    };
    let onward = onward.filter(|_| !absorber);
    let [t1, t2] = fields
        .through
        .map(|[with_1, with_2]| std::array::from_fn(|i| with_1 * s1[i] + with_2 * s2[i]));
    let absorbing = absorber
        || incident_medium.absorbs()
        || medium.is_some_and(Medium::absorbs)
        || layers().any(|layer| layer.medium.absorbs());
    let outgoing = [r1, r2, t1, t2];
    scattered.share_out(&incident, &backward, onward.as_ref(), &outgoing, absorbing);
    scattered.weak
}

type Matrix = [[Complex64; 2]; 2];

/// Tangential fields (E·first, E·second, H·first, H·second).
type Fields = [Complex64; 4];

/// The tangential fields that what lies beyond allows.
struct TransferredFields {
    /// Two fields that span them.
    near: [Fields; 2],
    /// The amplitudes of the waves beyond, by rows, with either field.
    through: Matrix,
}

const IDENTITY: Matrix = [[Complex64::ONE, Complex64::ZERO], [Complex64::ZERO, Complex64::ONE]];

impl TransferredFields {
    /// Those of waves that run on, or at a conductor.
    fn beyond(onward: Option<&[LocalMode<Complex64>; 2]>) -> Self {
        let near = match onward {
            Some(modes) => modes.each_ref().map(fields),
            None => IDENTITY.map(|[a, b]| [Complex64::ZERO, Complex64::ZERO, a, b]),
        };
        Self { near, through: IDENTITY }
    }

    /// Takes them through a layer of an optical depth k₀t, from its far to its near side.
    fn carry_back(&mut self, layer: &FilmLayer, depth: f64, frame: &Frame, tangential: Tangential) {
        let ways = layer.medium.both_ways(frame, tangential, None);
        let [forward, backward] = ways.map(|modes: LocalModes| modes.complex());
        let [f, b] = [&forward, &backward].map(|modes| modes.each_ref().map(fields));
        let [p, q] = self.near;
        let parts = solve(
            std::array::from_fn(|i| [f[0][i], f[1][i], b[0][i], b[1][i]]),
            std::array::from_fn(|i| [p[i], q[i]]),
        );
        // In the forward waves of the near side: what is left of them on the far side, in the
        // fields there.
        let [left_1, left_2] = forward.map(|mode| (Complex64::i() * mode.q * depth).exp());
        let inverse = solve([parts[0], parts[1]], IDENTITY);
        let kept = inverse.map(|[with_1, with_2]| [with_1 * left_1, with_2 * left_2]);
        let back = backward.map(|mode| (-Complex64::i() * mode.q * depth).exp());
        let reflected = product([parts[2], parts[3]], kept);
        self.through = product(self.through, kept);
        self.near = std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                f[j][i] + b[0][i] * back[0] * reflected[0][j] + b[1][i] * back[1] * reflected[1][j]
            })
        });
    }
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    a.map(|[x, y]| [x * b[0][0] + y * b[1][0], x * b[0][1] + y * b[1][1]])
}

fn fields(mode: &LocalMode<Complex64>) -> Fields {
    let ([e0, e1, _], [h0, h1, _]) = (mode.electric, mode.magnetic);
    [e0, e1, h0, h1]
}

/// Fields as the matching has them.
fn as_mode([e0, e1, h0, h1]: Fields) -> LocalMode<Complex64> {
    LocalMode {
        kind: ModeKind::Shared,
        propagating: false,
        q: Complex64::ZERO,
        electric: [e0, e1, Complex64::ZERO],
        magnetic: [h0, h1, Complex64::ZERO],
    }
}
