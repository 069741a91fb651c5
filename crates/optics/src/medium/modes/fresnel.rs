//! Modes of a lossless medium by Fresnel's equation of wave normals, a quartic for q.
//!
//! With E eliminated H, or the other way round, W E = 0 with W = ε + p × µ⁻¹ p × = ε - ((p·µp) µ -
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

/// Roots closer than this, relative to the largest, are left to the eigenproblem, as are waves whose
/// power runs along the surface.
const APART: f64 = 1e-5;

/// Roots farther apart than this are so whatever their rounding.
const FAR_APART: f64 = 1e-3;

/// Residuals, relative to the terms of Maxwell's equations, that rounding leaves.
const SOLVED: f64 = 4e-15;

/// Digits of q that are lost in rounding.
const EXACT: f64 = 1e-15;

/// Rounds of field and q.
const MOST_ROUNDS: usize = 4;

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
                        let wave = self.wave(q, size)?;
                        let is_near = |other: &LocalMode<f64>| (other.q - wave.q).abs() < near;
                        if forward.iter().chain(&backward).any(is_near) {
                            return None;
                        }
                        let heading = if wave.flux() > 0.0 { &mut forward } else { &mut backward };
                        heading.try_push(wave).ok()?;
                    }
                }
                Roots::Complex { re, im, .. } => {
                    let wave = self.wave(Complex64::new(re, im), size)?;
                    let is_near = |other: &LocalMode<Complex64>| (other.q - wave.q).norm() < near;
                    if wave.q.im < near || decaying.iter().any(is_near) {
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
        if let ([f1, f2], [b1, b2]) = (&mut forward[..], &mut backward[..]) {
            orthogonalize_in_flux(&mut [f1, f2, b1, b2], size);
        }
        Some([gathered(&forward, &decaying), gathered(&backward, &conjugates)])
    }

    /// The modes that head forward, if they are known to rounding and far from all others.
    pub fn onward(&self) -> Option<LocalModes> {
        let pairs = self.quartic.roots()?;
        let size = size(&pairs);
        if least_gap(&pairs) < FAR_APART * size {
            return None;
        }
        let mut forward: ArrayVec<LocalMode<f64>, 2> = ArrayVec::new();
        let mut decaying: ArrayVec<LocalMode<Complex64>, 2> = ArrayVec::new();
        for pair in pairs {
            match pair {
                Roots::Real { plus, minus, .. } => {
                    for q in [plus, minus] {
                        if self.heads_forward(q) {
                            forward.try_push(self.wave(q, size)?).ok()?;
                        }
                    }
                }
                Roots::Complex { re, im, .. } => {
                    decaying.push(self.wave(Complex64::new(re, im), size)?);
                }
            }
        }
        if forward.len() + decaying.len() != 2 || forward.iter().any(|wave| wave.flux() <= 0.0) {
            return None;
        }
        if let [a, b] = &mut forward[..] {
            orthogonalize_in_flux(&mut [a, b], size);
        }
        Some(gathered(&forward, &decaying))
    }

    /// Whether the wave of a real root carries power forward: (det W)' = -2 tr(adj W) S·n/|E|².
    fn heads_forward(&self, q: f64) -> bool {
        let (w, _) = self.matrix(&self.maxwell, q);
        let minor = |i: usize, j: usize| w[i][i] * w[j][j] - w[i][j] * w[i][j];
        let trace = minor(0, 1) + minor(1, 2) + minor(2, 0);
        (self.quartic.slope(q) * self.inverse_determinant < 0.0) == (trace > 0.0)
    }

    /// The wave of a root, of norm 1.
    fn wave<T: Number>(&self, mut q: T, size: f64) -> Option<LocalMode<T>> {
        let maxwell = self.maxwell.map(T::from);
        for _ in 0..MOST_ROUNDS {
            let mode = self.field(&maxwell, q);
            let [faraday, ampere] = maxwell.residual(&mode);
            // The symmetric form E·(p × H + εE) - H·(p × E - µH) changes with q by -2 n·(E × H).
            let form = dot(mode.electric, ampere) - dot(mode.magnetic, faraday);
            let (e, h) = (mode.electric, mode.magnetic);
            let flux = e[0] * h[1] - e[1] * h[0];
            let step = form / (flux * 2.0);
            if step.magnitude_squared() < (EXACT * size) * (EXACT * size) {
                let norm = square(&e) + square(&h);
                let residual = square(&faraday) + square(&ampere);
                let terms = self.terms + q.magnitude_squared();
                let is_solved = residual < SOLVED * SOLVED * norm * terms;
                let crosses = flux.magnitude_squared() > (APART * norm) * (APART * norm);
                return (is_solved && crosses).then(|| mode.scaled(norm.sqrt().recip()));
            }
            q += step;
        }
        None
    }

    /// W by rows, and µp.
    #[inline]
    fn matrix<T: Number>(&self, maxwell: &Maxwell<T>, q: T) -> ([[T; 3]; 3], [T; 3]) {
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

    /// The fields of a wave vector for which W is singular.
    fn field<T: Number>(&self, maxwell: &Maxwell<T>, q: T) -> LocalMode<T> {
        let (w, induction) = self.matrix(maxwell, q);
        let electric = null_vector(&w);
        // µ⁻¹ (p × E) = µp × µE/det µ.
        let response = maxwell.permeability.map(|row| dot(row, electric));
        let magnetic = cross(induction, response).map(|c| c * self.inverse_determinant);
        LocalMode { kind: ModeKind::First, propagating: true, q, electric, magnetic }
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

/// The vector that a singular matrix of rank 2 takes to 0, by elimination with complete pivoting:
/// where the second pivot is small, too, what rounding adds is of the plane of both.
fn null_vector<T: Number>(w: &[[T; 3]; 3]) -> [T; 3] {
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
    let [x, y] = if size(one) >= size(other) { one } else { other };
    let mut vector = [T::default(); 3];
    (vector[c], vector[d]) = (y, -x);
    vector[j] = x * to_d - y * to_c;
    vector
}

/// The other two of three indices.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];
