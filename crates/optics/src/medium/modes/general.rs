//! Modes of any medium: Fresnel's equation where it serves, elsewhere Berreman's eigenproblem for the
//! tangential fields.

use super::eigenvalues::eigenvalues;
use super::eigenvector::eigenvector;
use super::fresnel::Fresnel;
use super::local::mutual_flux;
use super::refinement::{Maxwell, best};
use super::{Arriving, BothWays, LocalMode, LocalModes, ModeKind};
use crate::medium::{Medium, Tensor};
use crate::wave::{Frame, Number, dot};
use arrayvec::ArrayVec;
use num_complex::Complex64;
use std::ops::Mul;

/// q ψ = matrix ψ with scale ψ = (E·first, E·second, H·first, H·second).
pub(super) struct Berreman<T> {
    maxwell: Maxwell<T>,
    matrix: [[T; 4]; 4],
    scale: [f64; 4],
    /// The normal components of E and H, as rows acting on the tangential ones.
    lift: [[T; 4]; 2],
}

/// An eigenvalue with its eigenvector.
type Eigenpair = (Complex64, [Complex64; 4]);

impl<T: Number> Berreman<T> {
    /// Of tensors whose normal-normal entries are taken for `least` of the largest entry where they
    /// are smaller.
    fn new(
        permittivity: [[T; 3]; 3],
        permeability: [[T; 3]; 3],
        [k1, k2]: [T; 2],
        least: f64,
    ) -> Self {
        let maxwell = Maxwell { permittivity, permeability, tangential: [k1, k2] };
        let zero = T::from(0.0);
        let (e, m) = (permittivity, permeability);
        // The normal components of p × E = µH and p × H = -εE hold no q.
        let (e_scale, h_scale) = (bounded(e, least), bounded(m, least));
        let normal_e = [-e[2][0], -e[2][1], k2, -k1].map(|c| c * e_scale);
        let normal_h = [-k2, k1, -m[2][0], -m[2][1]].map(|c| c * h_scale);
        let columns: [[T; 4]; 4] = std::array::from_fn(|j| {
            let unit = |i: usize| if i == j { T::from(1.0) } else { zero };
            let electric = [unit(0), unit(1), normal_e[j]];
            let magnetic = [unit(2), unit(3), normal_h[j]];
            [
                k1 * electric[2] + dot(m[1], magnetic),
                k2 * electric[2] - dot(m[0], magnetic),
                k1 * magnetic[2] - dot(e[1], electric),
                k2 * magnetic[2] + dot(e[0], electric),
            ]
        });
        let mut matrix = std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]));
        let scale = balance(&mut matrix);
        Self { maxwell, matrix, scale, lift: [normal_e, normal_h] }
    }

    /// How far the worst of some modes is from solving Maxwell's equations.
    fn residual<'m>(&self, modes: impl Iterator<Item = &'m LocalMode<Complex64>>) -> f64 {
        let maxwell = self.maxwell.map(Into::<Complex64>::into);
        let residual = modes.map(|mode| maxwell.residual_size(&mode.normalized()));
        residual.fold(0.0, |worst, one| if one.is_nan() { f64::INFINITY } else { one.max(worst) })
    }

    /// The eigenvalues and their vectors.
    fn eigenpairs(&self) -> [Eigenpair; 4] {
        let matrix = self.complex_matrix();
        eigenvalues(&self.matrix).map_or_else(fallback, |values| {
            std::array::from_fn(|i| {
                let field = eigenvector(&matrix, values[i], None);
                (values[i], field.unwrap_or(fallback()[i].1))
            })
        })
    }

    fn complex_matrix(&self) -> [[Complex64; 4]; 4] {
        self.matrix.map(|row| row.map(Into::into))
    }

    /// The mode of an eigenpair, made better where the eigenvalues differ much in size.
    fn mode<U: Number + From<T> + Mul<T, Output = U>>(&self, q: U, field: [U; 4]) -> LocalMode<U> {
        let field = std::array::from_fn(|i| field[i] * U::from(T::from(self.scale[i])));
        let normal = self
            .lift
            .map(|row| row.into_iter().zip(field).fold(U::default(), |sum, (a, b)| sum + b * a));
        self.maxwell.map(U::from).refined(unnamed(q, field, normal))
    }
}

/// A mode of the given tangential fields, see [`Berreman`], and normal ones.
fn unnamed<T>(q: T, [e0, e1, h0, h1]: [T; 4], [normal_e, normal_h]: [T; 2]) -> LocalMode<T> {
    let (electric, magnetic) = ([e0, e1, normal_e], [h0, h1, normal_h]);
    LocalMode { kind: ModeKind::First, propagating: true, q, electric, magnetic }
}

/// Makes rows and columns of a matrix, off the diagonal, of one size, by powers of two on the
/// diagonal, which are returned: the small eigenvalues of an uneven matrix would drown in the
/// rounding of the large ones (Parlett & Reinsch 1969).
fn balance<T: Number>(matrix: &mut [[T; 4]; 4]) -> [f64; 4] {
    let mut scale = [1.0; 4];
    for i in (0..4).cycle().take(16) {
        let others = (0..4).filter(|j| *j != i);
        let size = |entry: T| entry.magnitude_squared();
        let [row, column] = others.fold([0.0; 2], |[row, column], j| {
            [row + size(matrix[i][j]), column + size(matrix[j][i])]
        });
        let factor = (0.25 * (row / column).log2()).round().exp2();
        if factor.is_normal() {
            scale[i] *= factor;
            matrix[i] = matrix[i].map(|entry| entry * T::from(factor.recip()));
            for row in matrix.iter_mut() {
                row[i] = row[i] * T::from(factor);
            }
        }
    }
    scale
}

/// The reciprocal of the normal-normal entry, which an indefinite tensor may have zero.
fn bounded<T: Number>(tensor: [[T; 3]; 3], least: f64) -> T {
    let size = tensor.iter().flatten().map(|c| c.magnitude_squared()).fold(0.0, f64::max);
    let entry = tensor[2][2];
    if entry.magnitude_squared() > least * least * size {
        T::from(1.0) / entry
    } else {
        T::from((least * size.sqrt()).recip())
    }
}

/// A wave that runs along the surface is, both ways, the limit of waves that hardly cross it: by so
/// much their tangential wave vectors differ from its own.
const SHIFTS: [f64; 8] = [-1e-14, 1e-14, -1e-12, 1e-12, -1e-10, 1e-10, -1e-8, 1e-8];

/// The modes of a lossless medium.
struct Lossless {
    modes: BothWays,
    /// How many propagate.
    propagating: usize,
    /// Whether one does along the surface: two roots are one there, and have one vector.
    along_the_surface: bool,
}

impl Medium {
    /// The modes of a lossless medium without a closed form.
    pub(super) fn general_modes(&self, frame: &Frame, along: f64, known: Option<f64>) -> BothWays {
        let tensors = [&self.real.permittivity, &self.real.permeability].map(|t| frame.tensor(t));
        if let Some(modes) = Fresnel::new(tensors[0], tensors[1], along).modes() {
            return modes;
        }
        eigenmodes(tensors, along, known)
    }

    /// The mode of a wave that arrives with the normal component `q`, and those that head back.
    pub(super) fn general_arriving(
        &self,
        frame: &Frame,
        along: f64,
        q: f64,
    ) -> (Arriving, LocalModes) {
        let tensors = [&self.real.permittivity, &self.real.permeability].map(|t| frame.tensor(t));
        let fresnel = Fresnel::new(tensors[0], tensors[1], along);
        if let Some((arriving, back)) = fresnel.arriving_and_back(q) {
            return (Arriving::One(arriving), back);
        }
        let modes = fresnel.modes().unwrap_or_else(|| eigenmodes(tensors, along, Some(q)));
        let [forward, backward] = modes;
        (Arriving::Both(forward), backward)
    }

    /// Those that head forward.
    pub(super) fn general_onward(&self, frame: &Frame, along: f64) -> LocalModes {
        let tensors = [&self.real.permittivity, &self.real.permeability].map(|t| frame.tensor(t));
        let fresnel = Fresnel::new(tensors[0], tensors[1], along);
        if let Some(modes) = fresnel.onward() {
            return modes;
        }
        fresnel.modes().unwrap_or_else(|| eigenmodes(tensors, along, None))[0]
    }
}

/// The modes of a lossless medium by the eigenproblem.
fn eigenmodes(tensors: [[[f64; 3]; 3]; 2], along: f64, known: Option<f64>) -> BothWays {
    let at = |along| {
        best(|least| {
            let problem = Berreman::new(tensors[0], tensors[1], [along, 0.0], least);
            let found = problem.lossless_modes(known);
            let [forward, backward] = &found.modes;
            let residual = problem.residual(forward.complex().iter().chain(&backward.complex()));
            (found, residual)
        })
    };
    let exactly = at(along);
    if !exactly.along_the_surface {
        return exactly.modes;
    }
    let mut near = SHIFTS.iter().map(|shift| at(along * (1.0 + shift)));
    near.find(|near| !near.along_the_surface && near.propagating == exactly.propagating)
        .unwrap_or(exactly)
        .modes
}

impl Berreman<Complex64> {
    /// The pairs (forward, backward) of a medium that may absorb, of any size.
    pub fn modes_of(
        frame: &Frame,
        permittivity: &Tensor,
        permeability: &Tensor,
        k: [Complex64; 2],
    ) -> [[LocalMode<Complex64>; 2]; 2] {
        let in_frame = |tensor: &Tensor| {
            let (re, im) = (frame.tensor(&tensor.re), frame.tensor(&tensor.im));
            std::array::from_fn(|i| std::array::from_fn(|j| Complex64::new(re[i][j], im[i][j])))
        };
        let (permittivity, permeability) = (in_frame(permittivity), in_frame(permeability));
        best(|least| {
            let problem = Self::new(permittivity, permeability, k, least);
            let modes = problem.complex_modes();
            let residual = problem.residual(modes.as_flattened().iter());
            (modes, residual)
        })
    }

    fn complex_modes(&self) -> [[LocalMode<Complex64>; 2]; 2] {
        let mut pairs = self.eigenpairs();
        let size = pairs.iter().map(|(q, _)| q.norm()).fold(1.0, f64::max);
        separate_double_roots(&self.matrix, &mut pairs, size);
        let mut modes = pairs.map(|(q, field)| self.mode(q, field));
        modes.sort_by(|a, b| b.forwardness().total_cmp(&a.forwardness()));
        let [a, b, c, d] = modes;
        [ordered([a, b]), ordered([d, c])]
    }
}

impl Berreman<f64> {
    fn lossless_modes(&self, known: Option<f64>) -> Lossless {
        let mut pairs = self.eigenpairs();
        let size = pairs.iter().map(|(q, _)| q.norm()).fold(1.0, f64::max);
        // Evanescent ones come as conjugates; the real ones in order show which are double.
        pairs.sort_by(|(a, _), (b, _)| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
        let mut decaying: ArrayVec<Eigenpair, 4> = ArrayVec::new();
        let mut real: ArrayVec<(f64, [f64; 4]), 4> = ArrayVec::new();
        let mut along_the_surface = false;
        for (q, field) in pairs {
            // A double real root may come out as a pair of conjugates a rounding error apart, and
            // at grazing incidence half the digits apart.
            let grazing = known.is_some_and(|known| (q - known).norm() < 1e-6 * size);
            if q.im.abs() > if grazing { 1e-6 } else { DOUBLE } * size {
                decaying.push((q, field));
            } else if q.im == 0.0 {
                real.push((q.re, real_part(field)));
            } else if q.im > 0.0 {
                along_the_surface |= q.im > DOUBLE * size;
                // Both parts of the vector: the conjugate root has the same.
                let turned = parts_across(field);
                real.push((q.re, turned.map(|c| c.re)));
                real.push((q.re, turned.map(|c| c.im)));
            }
        }
        real.sort_by(|a, b| a.0.total_cmp(&b.0));
        for i in 1..real.len() {
            let (q, first) = real[i - 1];
            if real[i].0 - q >= DOUBLE * size {
                continue;
            }
            match eigenvector(&self.matrix, q, Some(first)) {
                Some(second) => real[i].1 = second,
                None => along_the_surface = true,
            }
            // Of three, two have one vector.
            along_the_surface |= i > 1 && real[i].0 - real[i - 2].0 < DOUBLE * size;
        }
        let propagating = real.len();
        separate_double_roots(&self.complex_matrix(), &mut decaying, size);
        let running = real.into_iter().map(|(q, field)| self.mode(q, field).normalized()).collect();
        let decaying = decaying.into_iter().map(|(q, field)| self.mode(q, field)).collect();
        Lossless { modes: by_heading(running, decaying, size), propagating, along_the_surface }
    }
}

/// Roots closer than this, relative to the largest, are one.
const DOUBLE: f64 = 1e-13;

/// Gives double roots two vectors that differ.
fn separate_double_roots(matrix: &[[Complex64; 4]; 4], pairs: &mut [Eigenpair], size: f64) {
    for i in 0..pairs.len() {
        for j in i + 1..pairs.len() {
            let (q, first) = pairs[i];
            if (pairs[j].0 - q).norm() < 1e-12 * size
                && let Some(second) = eigenvector(matrix, q, Some(first))
            {
                pairs[j] = (q, second);
            }
        }
    }
}

/// The vector with the phase that makes real and imaginary parts orthogonal.
fn parts_across(field: [Complex64; 4]) -> [Complex64; 4] {
    let square = field.iter().map(|c| c * c).sum::<Complex64>();
    let phase = if square.norm() > 0.0 { (square / square.norm()).sqrt() } else { Complex64::ONE };
    field.map(|c| c / phase)
}

/// Should the eigensolver ever give up: no waves but decaying ones without fields that matter.
fn fallback() -> [Eigenpair; 4] {
    let (z, o, i) = (Complex64::ZERO, Complex64::ONE, Complex64::I);
    [(i, [o, z, z, i]), (i, [z, o, i, z]), (-i, [o, z, z, -i]), (-i, [z, o, -i, z])]
}

/// The eigenvector of a real eigenvalue, which may carry a common phase.
fn real_part(field: [Complex64; 4]) -> [f64; 4] {
    let most = field.into_iter().max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap_or_default();
    let turn = most.conj() / most.norm();
    field.map(|c| (c * turn).re)
}

/// The modes of a lossless medium that propagate, of norm 1, and those that do not, each where it
/// heads.
fn by_heading(
    mut real: ArrayVec<LocalMode<f64>, 4>,
    mut evanescent: ArrayVec<LocalMode<Complex64>, 4>,
    size: f64,
) -> BothWays {
    // Vectors of a double root are any basis of their plane: take the one orthogonal in flux.
    real.sort_by(|a, b| a.q.total_cmp(&b.q));
    for i in 1..real.len() {
        if real[i].q - real[i - 1].q < DOUBLE * size {
            [real[i - 1], real[i]] = diagonal_in_flux(real[i - 1], real[i]);
        }
    }
    // Half of the propagating ones head each way; the rank, where rounding at grazing incidence
    // hides the sign.
    real.sort_by(|a, b| b.flux().total_cmp(&a.flux()));
    orthogonalize_in_flux(&mut real.iter_mut().collect::<ArrayVec<_, 4>>(), size);
    evanescent.sort_by(|a, b| b.q.im.total_cmp(&a.q.im));
    let (r, e) = (real.len() / 2, evanescent.len() / 2);
    [gathered(&real[..r], &evanescent[..e]), gathered(&real[r..], &evanescent[e..])]
}

/// Two modes of one heading, normalized and in order.
pub(super) fn gathered(real: &[LocalMode<f64>], evanescent: &[LocalMode<Complex64>]) -> LocalModes {
    let normalized = |mode: &LocalMode<f64>| {
        let flux = mode.flux().abs().max(1e-15);
        mode.scaled(flux.sqrt().recip())
    };
    let decaying =
        |mode: &LocalMode<Complex64>| LocalMode { propagating: false, ..mode.normalized() };
    match (real, evanescent) {
        ([a, b], _) => LocalModes::Real(ordered([normalized(a), normalized(b)])),
        ([a], [b, ..]) => LocalModes::Complex(ordered([normalized(a).complex(), decaying(b)])),
        (_, [a, b, ..]) => LocalModes::Complex(ordered([decaying(a), decaying(b)])),
        _ => LocalModes::Complex(ordered([0, 1].map(|i| fallback()[i]).map(|(q, field)| {
            LocalMode { propagating: false, ..unnamed(q, field, [Complex64::ZERO; 2]) }
        }))),
    }
}

/// Makes modes of norm 1 orthogonal in flux, as those of a lossless medium are: computed ones are as far as
/// their roots are apart.
pub(super) fn orthogonalize_in_flux(modes: &mut [&mut LocalMode<f64>], size: f64) {
    for i in 1..modes.len() {
        let (before, after) = modes.split_at_mut(i);
        let mode = &mut *after[0];
        for other in before {
            let share = mutual_flux(&**other, mode) / other.flux();
            // At grazing incidence there may be no flux: only what Maxwell's equations do not feel.
            if (share * (mode.q - other.q)).abs() < 1e-14 * size {
                *mode = added(*mode, other, -share);
            }
        }
    }
}

/// The basis of the plane of two modes with one q that is orthogonal in flux.
fn diagonal_in_flux(a: LocalMode<f64>, b: LocalMode<f64>) -> [LocalMode<f64>; 2] {
    let inner = |a: &LocalMode<f64>, b: &LocalMode<f64>| {
        dot(a.electric, b.electric) + dot(a.magnetic, b.magnetic)
    };
    let b = added(b, &a, -inner(&a, &b) / inner(&a, &a));
    let b = b.scaled(inner(&b, &b).max(1e-300).sqrt().recip());
    let (aa, bb, ab) = (a.flux(), b.flux(), mutual_flux(&a, &b));
    let (sine, cosine) = (0.5 * (2.0 * ab).atan2(aa - bb)).sin_cos();
    [added(a.scaled(cosine), &b, sine), added(b.scaled(cosine), &a, -sine)]
}

/// a + factor b.
pub(super) fn added(mut a: LocalMode<f64>, b: &LocalMode<f64>, factor: f64) -> LocalMode<f64> {
    for i in 0..3 {
        a.electric[i] += factor * b.electric[i];
        a.magnetic[i] += factor * b.magnetic[i];
    }
    a
}

/// Modes that propagate first, then the smaller |p|; the tangential part is common to both.
fn ordered<T: Number>(modes: [LocalMode<T>; 2]) -> [LocalMode<T>; 2] {
    let [a, b] = modes;
    let size = |mode: &LocalMode<T>| {
        let q: Complex64 = mode.q.into();
        q.re * q.re - q.im * q.im
    };
    let swap = (b.propagating && !a.propagating)
        || (a.propagating == b.propagating && size(&b) < size(&a));
    let (a, b) = if swap { (b, a) } else { (a, b) };
    [LocalMode { kind: ModeKind::First, ..a }, LocalMode { kind: ModeKind::Second, ..b }]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from 0 to 1, `SplitMix64`.
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let bits = ((z ^ (z >> 31)) >> 11) as f64;
        bits / 9_007_199_254_740_992.0
    }

    fn symmetric(state: &mut u64, diagonal: f64) -> [[f64; 3]; 3] {
        let [a, b, c] = [0; 3].map(|_| diagonal + 2.0 * random(state));
        let [d, e, f] = [0; 3].map(|_| 1.2 * random(state) - 0.6);
        [[a, d, e], [d, b, f], [e, f, c]]
    }

    /// Each mode of one has a partner in the other with the same q, the same fields but for a phase,
    /// and the same name.
    fn assert_alike(ours: LocalModes, theirs: LocalModes) {
        for (a, b) in ours.complex().iter().zip(&theirs.complex()) {
            assert_eq!((a.kind, a.propagating), (b.kind, b.propagating));
            assert!((a.q - b.q).norm() < 1e-11, "{a:?} {b:?}");
            let inner = |a: &LocalMode<Complex64>, b: &LocalMode<Complex64>| {
                let product = |a: [Complex64; 3], b: [Complex64; 3]| dot(a.map(|c| c.conj()), b);
                (product(a.electric, b.electric) + product(a.magnetic, b.magnetic)).norm()
            };
            let cosine = inner(a, b) / (inner(a, a) * inner(b, b)).sqrt();
            assert!((cosine - 1.0).abs() < 1e-13, "{cosine} {a:?} {b:?}");
            assert!((a.flux() - b.flux()).abs() < 1e-11);
        }
    }

    #[test]
    fn fresnels_quartic_and_the_eigenproblem_agree() {
        let mut state = 21;
        let (mut solved, mut decaying) = (0, 0);
        for number in 0..2_000 {
            // Every second one is indefinite or nearly so.
            let diagonal = if number % 2 == 0 { 1.5 } else { -1.0 };
            let tensors = [symmetric(&mut state, diagonal), symmetric(&mut state, 1.5)];
            let along = 3.0 * random(&mut state);
            let fresnel = Fresnel::new(tensors[0], tensors[1], along);
            let Some([forward, backward]) = fresnel.modes() else { continue };
            let [expected, expected_back] = eigenmodes(tensors, along, None);
            assert_alike(forward, expected);
            assert_alike(backward, expected_back);
            solved += 1;
            decaying += usize::from(forward.real().is_none());
            if let Some(onward) = fresnel.onward() {
                assert_alike(onward, expected);
            }
            for mode in expected.complex().iter().filter(|mode| mode.propagating) {
                if let Some((arriving, back)) = fresnel.arriving_and_back(mode.q.re) {
                    assert!((arriving.q - mode.q.re).abs() < 1e-11);
                    assert_alike(back, expected_back);
                }
            }
        }
        // Nearly all, with waves of either sort.
        assert!(solved > 1_800 && decaying > 400 && solved - decaying > 400, "{solved} {decaying}");
    }
}
