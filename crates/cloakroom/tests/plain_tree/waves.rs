//! Plane waves in any medium and at any interface, by linear algebra alone.
//!
//! Maxwell's equations p × E - µH = 0 and p × H + εE = 0 are six linear equations for the six
//! numbers (E, H). With p = t + q n, t given, they are a pencil in q: its four finite eigenvalues
//! are the waves of the medium, whatever the medium is. The null space at each is its fields; at a
//! double eigenvalue it has two dimensions, and any basis does.

use glam::{DMat3, DVec3};
use nalgebra::DMatrix;
use num_complex::Complex64;

type Matrix = DMatrix<Complex64>;

/// E and H of a wave, in the world's frame.
pub type Fields = [Complex64; 6];

/// The tensors of a medium, in the world's frame.
#[derive(Clone, Copy, Debug)]
pub struct Material {
    pub permittivity: DMat3,
    pub permeability: DMat3,
}

pub const AIR: Material = Material { permittivity: DMat3::IDENTITY, permeability: DMat3::IDENTITY };

/// All waves with one wave vector t + q n.
#[derive(Debug)]
struct Wave {
    q: Complex64,
    /// One or two independent solutions of Maxwell's equations.
    basis: Vec<Fields>,
}

/// Roots closer than this are one.
const ONE_ROOT: f64 = 1e-10;

/// The left-hand side of Maxwell's equations as a matrix.
fn maxwell(material: &Material, p: [Complex64; 3]) -> Matrix {
    let zero = Complex64::ZERO;
    let curl = [[zero, -p[2], p[1]], [p[2], zero, -p[0]], [-p[1], p[0], zero]];
    Matrix::from_fn(6, 6, |i, j| match (i < 3, j < 3) {
        (true, true) => curl[i][j],
        (true, false) => (-material.permeability.col(j - 3)[i]).into(),
        (false, true) => material.permittivity.col(j)[i - 3].into(),
        (false, false) => curl[i - 3][j - 3],
    })
}

/// A reflection along no axis in particular, I - 2 w wᵀ/w².
fn reflection() -> Matrix {
    let w: [f64; 6] = [0.31, -0.74, 0.52, 0.93, -0.18, 0.65];
    let square: f64 = w.iter().map(|x| x * x).sum();
    Matrix::from_fn(6, 6, |i, j| (f64::from(u8::from(i == j)) - 2.0 * w[i] * w[j] / square).into())
}

fn complex(v: DVec3) -> [Complex64; 3] {
    v.to_array().map(Complex64::from)
}

/// t + q n.
fn wave_vector(t: DVec3, q: Complex64, n: DVec3) -> [Complex64; 3] {
    let (t, n) = (complex(t), complex(n));
    std::array::from_fn(|i| t[i] + q * n[i])
}

/// The four waves with tangential wave vector `t` at a surface of normal `n`, joined where they
/// share one wave vector.
fn waves(material: &Material, t: DVec3, n: DVec3) -> Vec<Wave> {
    // Shifted by a number that is no eigenvalue, and inverted: 0 stands for infinity then.
    let shift = Complex64::new(0.37, 0.61);
    let void = Material { permittivity: DMat3::ZERO, permeability: DMat3::ZERO };
    let slope = maxwell(&void, complex(n));
    let matrix =
        maxwell(material, wave_vector(t, shift, n)).lu().solve(&slope).expect("no eigenvalue");
    let mut values = matrix.schur().eigenvalues().expect("six eigenvalues");
    values.as_mut_slice().sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    let mut roots: Vec<(Complex64, usize)> = Vec::new();
    for value in &values.as_slice()[..4] {
        let q = shift - 1.0 / value;
        match roots.iter_mut().find(|(other, _)| (*other - q).norm() < ONE_ROOT) {
            Some((mean, count)) => {
                *mean = (*mean * *count as f64 + q) / (*count as f64 + 1.0);
                *count += 1;
            }
            None => roots.push((q, 1)),
        }
    }
    let turn = reflection();
    roots
        .into_iter()
        .map(|(q, count)| {
            let q = if q.im.abs() < ONE_ROOT { q.re.into() } else { q };
            // Turned out of all symmetry, in which the singular value decomposition may not
            // converge.
            let turned = &turn * maxwell(material, wave_vector(t, q, n)) * &turn;
            // Singular values are sorted, the largest first.
            let vectors = &turn * turned.svd(false, true).v_t.expect("singular vectors").adjoint();
            let basis = (6 - count..6).map(|j| std::array::from_fn(|i| vectors[(i, j)])).collect();
            Wave { q, basis }
        })
        .collect()
}

/// Re(E × H*).
pub fn poynting(f: &Fields) -> DVec3 {
    let cross = |i: usize, j: usize| (f[i] * f[3 + j].conj() - f[j] * f[3 + i].conj()).re;
    DVec3::new(cross(1, 2), cross(2, 0), cross(0, 1))
}

impl Wave {
    fn propagates(&self) -> bool {
        self.q.im == 0.0
    }

    /// Whether it carries its power, or decays, along the normal.
    fn is_forward(&self, n: DVec3) -> bool {
        if self.propagates() { poynting(&self.basis[0]).dot(n) > 0.0 } else { self.q.im > 0.0 }
    }
}

/// A field of unit intensity across a ray in air.
pub fn in_air(direction: DVec3, electric: [Complex64; 3]) -> Fields {
    let d = complex(direction);
    let h = |i: usize, j: usize| d[i] * electric[j] - d[j] * electric[i];
    let [x, y, z] = electric;
    [x, y, z, h(1, 2), h(2, 0), h(0, 1)]
}

/// A wave that leaves an interface and carries power.
#[derive(Debug)]
pub struct Outgoing<const N: usize> {
    pub reflected: bool,
    pub wave_vector: DVec3,
    pub fields: [Fields; N],
}

/// What leaves the interface between `from` and `to`, a perfect conductor if `None`, when a wave
/// with wave vector `p` and the fields of `N` polarizations arrives along the normal `n`.
pub fn scatter<const N: usize>(
    from: &Material,
    to: Option<&Material>,
    p: DVec3,
    fields: &[Fields; N],
    n: DVec3,
) -> Vec<Outgoing<N>> {
    let t = p - n * p.dot(n);
    let back = waves(from, t, n).into_iter().filter(|wave| !wave.is_forward(n));
    let onward =
        to.map_or(Vec::new(), |to| waves(to, t, n)).into_iter().filter(|w| w.is_forward(n));
    let out: Vec<(bool, Wave)> =
        back.map(|w| (true, w)).chain(onward.map(|w| (false, w))).collect();
    let columns: Vec<(bool, Fields)> =
        out.iter().flat_map(|(r, wave)| wave.basis.iter().map(|f| (*r, *f))).collect();
    // Tangential E and, unless there is metal, H: incident + reflected - transmitted = 0.
    let first = n.any_orthonormal_vector();
    let second = n.cross(first);
    let tangential = |f: &Fields, row: usize| {
        let part = if row < 2 { &f[..3] } else { &f[3..] };
        let tangent = complex(if row.is_multiple_of(2) { first } else { second });
        (0..3).map(|i| part[i] * tangent[i]).sum::<Complex64>()
    };
    let size = if to.is_some() { 4 } else { 2 };
    assert_eq!(columns.len(), size, "waves out of an interface");
    let matrix = Matrix::from_fn(size, size, |row, j| {
        let (reflected, f) = &columns[j];
        tangential(f, row) * if *reflected { 1.0 } else { -1.0 }
    });
    let right = Matrix::from_fn(size, N, |row, i| -tangential(&fields[i], row));
    let amplitudes = matrix.full_piv_lu().solve(&right).expect("amplitudes");
    let mut first_column = 0;
    let mut outgoing = Vec::new();
    for (reflected, wave) in out {
        let start = first_column;
        first_column += wave.basis.len();
        if wave.propagates() {
            let fields = std::array::from_fn(|i| {
                std::array::from_fn(|c| {
                    let terms = wave.basis.iter().enumerate();
                    terms.map(|(k, f)| amplitudes[(start + k, i)] * f[c]).sum()
                })
            });
            outgoing.push(Outgoing { reflected, wave_vector: t + n * wave.q.re, fields });
        }
    }
    outgoing
}
