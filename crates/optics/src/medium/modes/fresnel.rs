//! Modes of a lossless medium by Fresnel's equation of wave normals, a quartic for q.
//!
//! With H eliminated, W E = 0 with W = ε + p × µ⁻¹ p × = ε - ((p·µp) µ -
//! µp (µp)ᵀ)/det µ, and det µ det W = (p·εp)(p·µp) - p·Gp + det ε det µ with
//! G = tr(µ adj ε) µ - µ adj(ε) µ. Its roots are as exact as the distance between them allows; the
//! pencil of Maxwell's equations is symmetric, so that its quotient with a field known to n digits
//! gives q to 2n.

use super::general::{gathered, orthogonalize_in_flux};
use super::refinement::Maxwell;
use super::{BothWays, LocalMode, LocalModes, ModeKind};
use crate::medium::quadratic::Roots;
use crate::medium::quartic::Quartic;
use crate::wave::{Number, cross, dot};
use arrayvec::ArrayVec;
use num_complex::Complex64;

/// Roots closer than this, relative to the largest, are left to the eigenproblem.
const APART: f64 = 1e-4;

/// Roots farther apart than this before their rounding is mended are so after it, but for pairs of
/// one heading.
const FAR_APART: f64 = 5e-4;

/// Waves of less normal flux, relative to |E|² + |H|², are left to the eigenproblem, and those that
/// decay slower, relative to the largest root: two of opposite headings are nearly one there, and
/// their fluxes lose digits.
const CROSSES: f64 = 1e-2;

/// Residuals, relative to the terms of Maxwell's equations, that rounding leaves as a rule.
const SOLVED: f64 = 1e-15;

/// Those that are not bettered after some rounds.
const STILL_SOLVED: f64 = 4e-15;

/// Steps of q, relative to the largest, that change no field by more than rounding.
const EXACT: f64 = 4e-15;

/// Rounds of field and q.
const MOST_ROUNDS: usize = 5;

/// W by rows, and µp.
type Operator<T> = ([[T; 3]; 3], [T; 3]);

/// Fresnel's equation for real tensors and a wave vector in the plane of the first tangent and the
/// normal.
pub(super) struct Fresnel {
    maxwell: Maxwell<f64>,
    along: f64,
    inverse_determinant: f64,
    /// The squares of the terms of Maxwell's equations but for q².
    terms: f64,
    quartic: Quartic,
}

impl Fresnel {
    pub fn new(permittivity: [[f64; 3]; 3], permeability: [[f64; 3]; 3], along: f64) -> Self {
        let maxwell = Maxwell { permittivity, permeability, tangential: [along, 0.0] };
        let (e, m) = (&permittivity, &permeability);
        let adjoint = [cross(e[1], e[2]), cross(e[2], e[0]), cross(e[0], e[1])];
        let determinant = dot(e[0], adjoint[0]);
        let trace = dot(m[0], adjoint[0]) + dot(m[1], adjoint[1]) + dot(m[2], adjoint[2]);
        let times = |v: [f64; 3]| adjoint.map(|row| dot(row, v));
        let (first, normal) = (times(m[0]), times(m[2]));
        // (p·Ap) = a₀ + 2 a₁ q + a₂ q².
        let form =
            |first: f64, mixed: f64, normal: f64| [first * along * along, mixed * along, normal];
        let [e0, e1, e2] = form(e[0][0], e[0][2], e[2][2]);
        let [m0, m1, m2] = form(m[0][0], m[0][2], m[2][2]);
        let [g0, g1, g2] = form(
            trace * m[0][0] - dot(m[0], first),
            trace * m[0][2] - dot(m[0], normal),
            trace * m[2][2] - dot(m[2], normal),
        );
        let mu_determinant = dot(m[0], cross(m[1], m[2]));
        let quartic = Quartic([
            e0 * m0 - g0 + determinant * mu_determinant,
            2.0 * (e0 * m1 + e1 * m0 - g1),
            e0 * m2 + e2 * m0 + 4.0 * e1 * m1 - g2,
            2.0 * (e1 * m2 + e2 * m1),
            e2 * m2,
        ]);
        let terms = along * along + square(e.as_flattened()) + square(m.as_flattened());
        Self { maxwell, along, inverse_determinant: mu_determinant.recip(), terms, quartic }
    }

    /// The modes, if they are known to rounding.
    pub fn modes(&self) -> Option<BothWays> {
        let pairs = self.quartic.roots()?;
        let size = size(&pairs);
        let near = APART * size;
        let mut forward: ArrayVec<LocalMode<f64>, 2> = ArrayVec::new();
        let mut backward: ArrayVec<LocalMode<f64>, 2> = ArrayVec::new();
        let mut decaying: ArrayVec<LocalMode<Complex64>, 2> = ArrayVec::new();
        for pair in pairs {
            match pair {
                Roots::Real { plus, minus, .. } => {
                    for q in [plus, minus] {
                        let wave = self.real_wave(q, size)?;
                        let is_near = |other: &LocalMode<f64>| (other.q - wave.q).abs() < near;
                        if forward.iter().chain(&backward).any(is_near) {
                            return None;
                        }
                        let heading = if wave.flux() > 0.0 { &mut forward } else { &mut backward };
                        heading.try_push(wave).ok()?;
                    }
                }
                Roots::Complex { re, im, .. } => {
                    let wave = self.decaying_wave(Complex64::new(re, im), size)?;
                    let is_near = |other: &LocalMode<Complex64>| (other.q - wave.q).norm() < near;
                    if wave.q.im < CROSSES * size || decaying.iter().any(is_near) {
                        return None;
                    }
                    decaying.push(wave);
                }
            }
        }
        if forward.len() != backward.len() {
            return None;
        }
        let conjugates: ArrayVec<_, 2> = decaying.iter().map(conjugate).collect();
        let real = forward.iter_mut().chain(&mut backward);
        orthogonalize_in_flux(&mut real.collect::<ArrayVec<_, 4>>(), size);
        Some([gathered(&forward, &decaying), gathered(&backward, &conjugates)])
    }

    /// The modes that head forward, if they are known to rounding and far from all others.
    pub fn onward(&self) -> Option<LocalModes> {
        let pairs = self.quartic.roots()?;
        let size = size(&pairs);
        (least_gap(&pairs) > FAR_APART * size).then_some(())?;
        self.headed(&pairs, size, true, f64::NAN)
    }

    /// The mode whose root is closest to `q`, and those that head back, if they are known to
    /// rounding and far from all others.
    pub fn arriving_and_back(&self, q: f64) -> Option<(LocalMode<f64>, LocalModes)> {
        let pairs = self.quartic.roots()?;
        let size = size(&pairs);
        (least_gap(&pairs) > FAR_APART * size).then_some(())?;
        let real = pairs.iter().flat_map(|pair| match *pair {
            Roots::Real { plus, minus, .. } => [plus, minus],
            Roots::Complex { .. } => [f64::INFINITY; 2],
        });
        let nearest = real.min_by(|a, b| (a - q).abs().total_cmp(&(b - q).abs()))?;
        if (nearest - q).abs() > APART * size {
            return None;
        }
        let arriving = self.real_wave(nearest, size)?;
        (arriving.flux() > 0.0).then_some((arriving, self.headed(&pairs, size, false, nearest)?))
    }

    /// The modes of one heading; the wave of the root `but` is known to have the other.
    fn headed(&self, pairs: &[Roots; 2], size: f64, forward: bool, but: f64) -> Option<LocalModes> {
        let sign = if forward { 1.0 } else { -1.0 };
        let mut real: ArrayVec<LocalMode<f64>, 2> = ArrayVec::new();
        let mut decaying: ArrayVec<LocalMode<Complex64>, 2> = ArrayVec::new();
        for pair in pairs {
            match *pair {
                Roots::Real { plus, minus, .. } => {
                    for q in [plus, minus] {
                        if q == but {
                            continue;
                        }
                        let operator = self.operator(&self.maxwell, q);
                        if self.heads_forward(q, &operator) == forward {
                            let wave = self.wave(&self.maxwell, q, operator, size)?;
                            (wave.flux() * sign > 0.0).then_some(())?;
                            real.try_push(wave).ok()?;
                        }
                    }
                }
                Roots::Complex { re, im, .. } => {
                    let wave = self.decaying_wave(Complex64::new(re, im * sign), size)?;
                    (wave.q.im * sign > CROSSES * size).then_some(())?;
                    decaying.push(wave);
                }
            }
        }
        if let [a, b] = &mut real[..] {
            ((a.q - b.q).abs() > APART * size).then_some(())?;
            orthogonalize_in_flux(&mut [a, b], size);
        }
        if let [a, b] = &decaying[..] {
            ((a.q - b.q).norm() > APART * size).then_some(())?;
        }
        (real.len() + decaying.len() == 2).then(|| gathered(&real, &decaying))
    }

    /// Whether the wave of a real root carries power forward: (det W)' = -2 tr(adj W) S·n/|E|².
    fn heads_forward(&self, q: f64, (w, _): &Operator<f64>) -> bool {
        let minor = |i: usize, j: usize| w[i][i] * w[j][j] - w[i][j] * w[i][j];
        let trace = minor(0, 1) + minor(1, 2) + minor(2, 0);
        (self.quartic.slope(q) * self.inverse_determinant < 0.0) == (trace > 0.0)
    }

    fn real_wave(&self, q: f64, size: f64) -> Option<LocalMode<f64>> {
        self.wave(&self.maxwell, q, self.operator(&self.maxwell, q), size)
    }

    fn decaying_wave(&self, q: Complex64, size: f64) -> Option<LocalMode<Complex64>> {
        let maxwell = self.maxwell.map(Complex64::from);
        self.wave(&maxwell, q, self.operator(&maxwell, q), size)
    }

    /// The wave of a root, of norm 1.
    #[inline(always)]
    fn wave<T: Number>(
        &self,
        maxwell: &Maxwell<T>,
        mut q: T,
        mut operator: Operator<T>,
        size: f64,
    ) -> Option<LocalMode<T>> {
        for round in 1..=MOST_ROUNDS {
            let (e, form) = null_vector(&operator.0);
            // µ⁻¹ (p × E) = µp × µE/det µ.
            let response = maxwell.permeability.map(|row| dot(row, e));
            let h = cross(operator.1, response).map(|c| c * self.inverse_determinant);
            // The symmetric form E·WE changes with q by -2 n·(E × H).
            let flux = e[0] * h[1] - e[1] * h[0];
            let per_flux = T::from(0.5) / flux;
            let step = form * per_flux;
            if step.magnitude_squared() > (EXACT * size) * (EXACT * size) {
                q += step;
                operator = self.operator(maxwell, q);
                continue;
            }
            // The same form without E or H eliminated: E·(p × H + εE) - H·(p × E - µH).
            let kind = ModeKind::First;
            let mode = LocalMode { kind, propagating: true, q, electric: e, magnetic: h };
            let [mut faraday, mut ampere] = maxwell.residual(&mode);
            let step = (dot(e, ampere) - dot(h, faraday)) * per_flux;
            q += step;
            // The residual of the same fields with the better q.
            for (part, field) in [(&mut faraday, e), (&mut ampere, h)] {
                part[0] -= step * field[1];
                part[1] += step * field[0];
            }
            let norm = square(&e) + square(&h);
            let residual = square(&faraday) + square(&ampere);
            let terms = self.terms + q.magnitude_squared();
            let most = if round < MOST_ROUNDS { SOLVED } else { STILL_SOLVED };
            if residual < most * most * norm * terms {
                let crosses = flux.magnitude_squared() > (CROSSES * norm) * (CROSSES * norm);
                return crosses.then(|| LocalMode { q, ..mode.scaled(norm.sqrt().recip()) });
            }
            operator = self.operator(maxwell, q);
        }
        None
    }

    #[inline]
    fn operator<T: Number>(&self, maxwell: &Maxwell<T>, q: T) -> Operator<T> {
        let (e, m) = (&maxwell.permittivity, &maxwell.permeability);
        let induction = m.map(|row| row[0] * self.along + row[2] * q);
        let square = induction[0] * self.along + induction[2] * q;
        let inverse = self.inverse_determinant;
        let entry = |i: usize, j: usize| {
            e[i][j] - (square * m[i][j] - induction[i] * induction[j]) * inverse
        };
        let (xx, xy, xz) = (entry(0, 0), entry(0, 1), entry(0, 2));
        let (yy, yz, zz) = (entry(1, 1), entry(1, 2), entry(2, 2));
        ([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], induction)
    }
}

fn square<T: Number>(numbers: &[T]) -> f64 {
    numbers.iter().map(|c| c.magnitude_squared()).sum()
}

/// The largest |q|, at least 1.
fn size(pairs: &[Roots; 2]) -> f64 {
    pairs.iter().fold(1.0, |size: f64, pair| {
        size.max(match *pair {
            Roots::Real { plus, minus, .. } => plus.abs().max(minus.abs()),
            Roots::Complex { re, im, .. } => re.abs().max(im),
        })
    })
}

/// The least distance between any two of four roots.
fn least_gap(pairs: &[Roots; 2]) -> f64 {
    let complex = |pair: &Roots| match *pair {
        Roots::Real { plus, minus, .. } => [Complex64::from(plus), minus.into()],
        Roots::Complex { re, im, .. } => [Complex64::new(re, im), Complex64::new(re, -im)],
    };
    let [[a, b], [c, d]] = [complex(&pairs[0]), complex(&pairs[1])];
    let gaps = [a - b, c - d, a - c, a - d, b - c, b - d].map(|gap| gap.norm_sqr());
    gaps.into_iter().fold(f64::INFINITY, f64::min).sqrt()
}

fn conjugate(mode: &LocalMode<Complex64>) -> LocalMode<Complex64> {
    LocalMode {
        q: mode.q.conj(),
        electric: mode.electric.map(|c| c.conj()),
        magnetic: mode.magnetic.map(|c| c.conj()),
        ..*mode
    }
}

/// The vector v that a nearly singular matrix of rank 2 takes to 0, by elimination with complete
/// pivoting, and v·wv: where the second pivot is small, too, what rounding adds to v is of the plane
/// of both.
#[inline]
fn null_vector<T: Number>(w: &[[T; 3]; 3]) -> ([T; 3], T) {
    let (mut i, mut j, mut largest) = (0, 0, w[0][0].magnitude_squared());
    for (row, column) in [(0, 1), (0, 2), (1, 1), (1, 2), (2, 2)] {
        let size = w[row][column].magnitude_squared();
        if size > largest {
            (i, j, largest) = (row, column, size);
        }
    }
    let [a, b] = OTHERS[i];
    let [c, d] = OTHERS[j];
    let inverse = T::from(1.0) / w[i][j];
    let (to_c, to_d) = (w[i][c] * inverse, w[i][d] * inverse);
    let row = |r: usize| [w[r][c] - w[r][j] * to_c, w[r][d] - w[r][j] * to_d];
    let size = |[x, y]: [T; 2]| x.magnitude_squared() + y.magnitude_squared();
    let (one, other) = (row(a), row(b));
    let ([x, y], rest, last) =
        if size(one) >= size(other) { (one, other, b) } else { (other, one, a) };
    // Selected, not stored by index: what is stored in parts is slow to read whole.
    let (at_c, at_d, at_j) = (y, -x, x * to_d - y * to_c);
    let vector = match j {
        0 => [at_j, at_c, at_d],
        1 => [at_d, at_j, at_c],
        _ => [at_c, at_d, at_j],
    };
    let of_last = match last {
        0 => vector[0],
        1 => vector[1],
        _ => vector[2],
    };
    (vector, of_last * (rest[0] * y - rest[1] * x))
}

/// The other two of three indices.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];
