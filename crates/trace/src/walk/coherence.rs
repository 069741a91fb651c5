//! Leaves that see the same thing add as fields where their paths are alike, as powers where they
//! are not.
//!
//! The coherency matrix of the light that arrives from an incoherent source is the sum over pairs
//! of ways i and j of g_ij w_ij (E_i · E_j*) exp(i k0 (l_i - l_j)), with their fields E and phase
//! lengths l. A Gaussian line gives g = exp(-(π (l_i - l_j)/L)²/(4 ln 2)) with the coherence length
//! L = λ²/Δλ; w is a Gaussian of the distance between the places that they see. Both kernels are
//! positive definite: there is no negative light.

use super::branch::{Branch, Place};
use super::{Leaf, LeafEnd};
use crate::assembly::{Assembly, slack_at};
use glam::DVec3;
use num_complex::Complex64;
use optics::medium::ModeKind;
use optics::wave::ComplexVector;
use std::f64::consts::{LN_2, PI, TAU};

/// Below this, a pair of ways does not count: its fields add as powers.
const LEAST_DEGREE: f64 = 1e-12;

/// Phase lengths that differ by no more than this, as a share of the coherence length, are one.
const SAME_LENGTH: f64 = 1e-10;

/// Directions that differ by no more than this are one.
const SAME_DIRECTION: f64 = 1e-9;

/// Light with a Gaussian line, or of one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coherence {
    /// k0, 1/cm.
    wave_number: f64,
    /// L, cm; infinite for one wavelength.
    length: f64,
}

/// A way of light to a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// Its number among the leaves.
    pub leaf: usize,
    /// What it sees: a place, cm, or a direction.
    pub seen: DVec3,
    /// The optical path to the point at which the ways are compared, cm.
    pub phase_length: f64,
}

/// Two ways that interfere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The numbers of their leaves.
    pub leaves: [usize; 2],
    /// g w exp(i k0 (l_0 - l_1)).
    pub degree: Complex64,
}

impl Coherence {
    /// Light of a mean wavelength in vacuum and a bandwidth (full width at half maximum), nm.
    ///
    /// # Example
    ///
    /// ```
    /// use cloakroom_trace::walk::Coherence;
    /// let light = Coherence::new(550.0, 100.0);
    /// assert!((light.length() - 3.025e-4).abs() < 1e-12);
    /// assert!(light.degree(2.0 * light.length()).norm() < 1e-5);
    /// assert_eq!(Coherence::new(550.0, 0.0).length(), f64::INFINITY);
    /// ```
    #[must_use]
    pub fn new(wavelength_nm: f64, bandwidth_nm: f64) -> Self {
        const CM_PER_NM: f64 = 1e-7;
        let wavelength = wavelength_nm * CM_PER_NM;
        Self { wave_number: TAU / wavelength, length: wavelength * (wavelength_nm / bandwidth_nm) }
    }

    /// The coherence length L, cm.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The largest difference of phase lengths at which light interferes, cm.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.length * (-4.0 * LN_2 * LEAST_DEGREE.ln()).sqrt() / PI
    }

    /// g exp(i k0 l) for a difference l of phase lengths, cm.
    #[must_use]
    pub fn degree(&self, difference: f64) -> Complex64 {
        Complex64::from_polar(self.visibility(difference), self.wave_number * difference)
    }

    /// g.
    fn visibility(&self, difference: f64) -> f64 {
        let share = PI * difference / self.length;
        (-share * share / (4.0 * LN_2)).exp()
    }

    /// Adds the pairs of ways that interfere; `width` is that of w, the standard deviation of the
    /// distance between what they see. The order of the ways is changed.
    pub fn add_pairs(&self, ways: &mut [Way], width: f64, pairs: &mut Vec<Pair>) {
        ways.sort_by(|a, b| a.phase_length.total_cmp(&b.phase_length));
        let reach = self.reach();
        for (i, one) in ways.iter().enumerate() {
            for other in &ways[i + 1..] {
                let difference = other.phase_length - one.phase_length;
                if difference.is_nan() || difference > reach {
                    break;
                }
                let apart = (other.seen - one.seen).length() / width;
                // Two that see the same point do so however narrow the width is.
                let together =
                    if one.seen == other.seen { 1.0 } else { (-0.5 * apart * apart).exp() };
                let visibility = self.visibility(difference);
                if visibility * together > LEAST_DEGREE {
                    let phase = self.wave_number * -difference;
                    let degree = Complex64::from_polar(visibility, phase) * together;
                    pairs.push(Pair { leaves: [one.leaf, other.leaf], degree });
                }
            }
        }
    }

    /// Adds leaves of one direction and one end as fields, as they would arrive in the far field:
    /// one leaf each, at the place of the strongest. Its electric field is that of the mean
    /// wavelength, scaled to its power.
    #[must_use]
    pub fn gather<const N: usize>(&self, leaves: &[Leaf<N>]) -> Vec<Leaf<N>> {
        let mut order: Vec<usize> = (0..leaves.len()).collect();
        order.sort_by(|a, b| leaves[*b].total_power().total_cmp(&leaves[*a].total_power()));
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for number in order {
            let leaf = &leaves[number];
            let same = |group: &&mut Vec<usize>| {
                let first = &leaves[group[0]];
                let turned = (first.direction - leaf.direction).length();
                turned <= SAME_DIRECTION && first.end == leaf.end && leaf.is_in_air()
            };
            match groups.iter_mut().find(same) {
                Some(group) => group.push(number),
                None => groups.push(vec![number]),
            }
        }
        let gathered = groups.into_iter().map(|group| {
            let mut first = leaves[group[0]];
            if group.len() == 1 {
                return first;
            }
            let (direction, position) = (first.direction, first.position);
            for i in 0..N {
                let mut waves: Vec<(f64, ComplexVector)> = (group.iter())
                    .map(|number| &leaves[*number])
                    .map(|leaf| (leaf.phase_length(direction, position), leaf))
                    .map(|(length, leaf)| (length - first.optical_path, leaf.electric[i]))
                    .collect();
                waves.sort_by(|a, b| a.0.total_cmp(&b.0));
                let power = self.power(&mut waves);
                let field = waves.iter().fold(ComplexVector::ZERO, |sum, (length, field)| {
                    sum + field.scaled(Complex64::cis(self.wave_number * length))
                });
                let size = field.norm_squared();
                first.electric[i] = if size > 0.0 { field * (power / size).sqrt() } else { field };
                first.power[i] = power;
            }
            first
        });
        gathered.collect()
    }
}

impl Coherence {
    /// The power of waves of one direction, by rising phase length (cm). Those of the same length
    /// become one: of the many ways through plates, many are as long.
    fn power(&self, waves: &mut Vec<(f64, ComplexVector)>) -> f64 {
        waves.dedup_by(|(length, field), (first, sum)| {
            let same = *length - *first <= SAME_LENGTH * self.length;
            if same {
                let phase = Complex64::cis(self.wave_number * (*length - *first));
                *sum = *sum + field.scaled(phase);
            }
            same
        });
        let mut power = 0.0;
        for (i, (length, field)) in waves.iter().enumerate() {
            power += field.norm_squared();
            for (longer, other) in &waves[i + 1..] {
                let difference = longer - length;
                if difference.is_nan() || difference > self.reach() {
                    break;
                }
                power += 2.0 * (self.degree(difference) * other.dot(field.conj())).re;
            }
        }
        // Of light that goes out, rounding may leave less than nothing.
        power.max(0.0)
    }
}

/// How alike branches are that become one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Joining {
    coherence: Coherence,
    /// The largest difference of their wave vectors.
    wave: f64,
    /// The largest difference of their phase lengths, cm.
    length: f64,
}

/// Wave vectors that differ by no more than this are one.
const SAME_WAVE: f64 = 1e-11;

/// By how much the phase of a picture's branch may be off where it lands, so far on (cm): that of
/// a thousandth of the wavelength.
const PHASE_OFF: f64 = 6e-3;
const REACH: f64 = 100.0;

/// Phase lengths that differ by no more than this share of the coherence length are one in pictures:
/// the degree of coherence changes by 4e-4 at most.
const SIMILAR_LENGTH: f64 = 1e-2;

/// Branches of one wave that are no further apart than this run together, cm.
const BESIDE: f64 = 5e-3;

impl Joining {
    /// Those that are one but for rounding.
    pub fn same(coherence: Coherence) -> Self {
        Self { coherence, wave: SAME_WAVE, length: SAME_LENGTH * coherence.length }
    }

    /// Those that a picture cannot tell apart: the path of a ray beside one varies by the square of
    /// its angle to it (Fermat).
    pub fn similar(coherence: Coherence) -> Self {
        let wave = (PHASE_OFF / (coherence.wave_number * REACH)).sqrt();
        Self { coherence, wave, length: SIMILAR_LENGTH * coherence.length }
    }

    /// What the fingerprint of a branch says of its mode: nothing where the ways of both are one.
    pub fn told(&self, mode: ModeKind) -> ModeKind {
        if self.wave > SAME_WAVE { ModeKind::Shared } else { mode }
    }

    /// Adds the field of another branch to one that is the same plane wave, of the same phase
    /// length and with nothing between them; whether it is.
    pub fn join<const N: usize>(
        &self,
        assembly: &Assembly,
        branch: &mut Branch<N>,
        other: &Branch<N>,
    ) -> bool {
        let apart = branch.position - other.position;
        let mean = 0.5 * (branch.wave_vector + other.wave_vector);
        let length = other.optical_path - branch.optical_path + mean.dot(apart);
        let same = |a: DVec3, b: DVec3| (a - b).abs().max_element() <= self.wave;
        let together = branch.place == other.place
            && branch.mode == other.mode
            && branch.departed == other.departed
            && apart.length() <= BESIDE
            && length.abs() <= self.length
            && same(branch.wave_vector, other.wave_vector)
            && same(branch.attenuation, other.attenuation)
            && !are_separated(assembly, branch, other);
        if together {
            let phase = Complex64::cis(self.coherence.wave_number * length);
            for i in 0..N {
                // Power is the square of the field but for what is the same in both.
                let scale = if branch.power[i] > other.power[i] {
                    branch.power[i] / branch.electric[i].norm_squared()
                } else {
                    other.power[i] / other.electric[i].norm_squared()
                };
                branch.electric[i] = branch.electric[i] + other.electric[i].scaled(phase);
                let power = scale * branch.electric[i].norm_squared();
                branch.power[i] = if power.is_finite() { power } else { 0.0 };
                branch.survives_alone[i] |= other.survives_alone[i];
            }
        }
        together
    }
}

/// Whether something stands between two branches in one place that run in one direction.
fn are_separated<const N: usize>(assembly: &Assembly, one: &Branch<N>, other: &Branch<N>) -> bool {
    // A hair ahead, off the surfaces that they leave, and in what is no thinner than can be told.
    let slack = slack_at(one.position);
    let hair = one.direction * (0.5 * slack);
    let apart = other.position - one.position;
    let distance = apart.length();
    if distance <= slack {
        return false;
    }
    let (origin, direction) = (one.position + hair, apart / distance);
    let met = match one.place {
        Place::Air => assembly.first_hit(origin, direction, None),
        Place::Region { device, .. } => {
            let pose = &assembly.device(device).pose;
            let (origin, direction) = (pose.to_world(origin), pose.vector_to_world(direction));
            assembly.first_guest(device, origin, direction, None)
        }
    };
    met.is_some_and(|(_, hit)| hit.distance < distance)
}

impl Pair {
    /// What the pair adds to the sum of the powers of its leaves, for one of the launched
    /// polarizations.
    #[must_use]
    pub fn power<const N: usize>(&self, leaves: &[Leaf<N>], polarization: usize) -> f64 {
        let [one, other] = self.leaves.map(|leaf| leaves[leaf].electric[polarization]);
        2.0 * (self.degree * one.dot(other.conj())).re
    }

    /// Whether both run in one direction: then what they have more of together, others have less.
    /// The fringes of others have their maxima and minima side by side.
    #[must_use]
    pub fn is_parallel<const N: usize>(&self, leaves: &[Leaf<N>]) -> bool {
        let [one, other] = self.leaves.map(|leaf| leaves[leaf].direction);
        (one - other).length() <= SAME_DIRECTION
    }

    /// What the pair adds to the element of the coherency matrix between the first two launched
    /// polarizations.
    #[must_use]
    pub fn coherency<const N: usize>(&self, leaves: &[Leaf<N>]) -> Complex64 {
        let [[a, b], [c, d]] =
            self.leaves.map(|leaf| [leaves[leaf].electric[0], leaves[leaf].electric[1]]);
        self.degree * a.dot(d.conj()) + self.degree.conj() * c.dot(b.conj())
    }
}

impl<const N: usize> Leaf<N> {
    /// The optical path to the plane through a point across its direction, cm; to one far off if
    /// `direction` is that of a way to there.
    #[must_use]
    pub fn phase_length(&self, direction: DVec3, point: DVec3) -> f64 {
        self.optical_path + direction.dot(point - self.position)
    }

    /// Whether it runs on through air or has ended in air, where |E|² is its power.
    #[must_use]
    pub fn is_in_air(&self) -> bool {
        const ROUNDING: f64 = 1e-6;
        let same = |i: usize| {
            (self.electric[i].norm_squared() - self.power[i]).abs() <= ROUNDING * self.power[i]
        };
        self.end == LeafEnd::Away || (0..N).all(same)
    }
}
