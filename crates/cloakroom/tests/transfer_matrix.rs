//! Plane-parallel stacks by Berreman's 4 x 4 transfer matrix, which shares no code with the tracer.
//!
//! The layers lie across z, light comes in from air along (k, 0, √(1 - k²)); fields go as exp(i k0
//! k x). With magnetic fields scaled by the impedance of vacuum, Maxwell's equations for Ψ = (Ex,
//! Ey, Hx, Hy) are dΨ/dz = i k0 M Ψ.

use glam::{DMat3, DVec3};
use num_complex::Complex64;

pub type Matrix = [[Complex64; 4]; 4];

const ZERO: Complex64 = Complex64::ZERO;

/// A layer of a stack.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    pub permittivity: DMat3,
    pub permeability: DMat3,
    /// The absorbing part of the permittivity.
    pub loss: DMat3,
    /// cm.
    pub thickness: f64,
}

/// What a stack reflects and transmits: rows are s and p of the outgoing light, columns those of
/// the incident.
#[derive(Clone, Copy, Debug)]
pub struct Jones {
    pub reflected: [[Complex64; 2]; 2],
    pub transmitted: [[Complex64; 2]; 2],
}

/// The unit vectors of s and p for light along (k, 0, kz).
pub fn polarizations(k: f64, kz: f64) -> [DVec3; 2] {
    [DVec3::Y, DVec3::Y.cross(DVec3::new(k, 0.0, kz))]
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..4).map(|l| a[i][l] * b[l][j]).sum::<Complex64>())
    })
}

/// exp(i t M) by its series, halved until it converges fast.
fn exponential(m: &Matrix, t: f64) -> Matrix {
    let size = m.iter().flatten().map(|entry| entry.norm()).fold(0.0, f64::max) * t.abs() * 4.0;
    let halvings = (size.log2().ceil() + 2.0).max(0.0) as i32;
    let step = Complex64::i() * t / 2f64.powi(halvings);
    let identity: Matrix =
        std::array::from_fn(|i| std::array::from_fn(|j| Complex64::from(f64::from(i == j))));
    let (mut sum, mut term) = (identity, identity);
    for order in 1..24 {
        term = product(&term, m).map(|row| row.map(|entry| entry * step / f64::from(order)));
        for (sum, term) in sum.iter_mut().flatten().zip(term.iter().flatten()) {
            *sum += term;
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum
}

impl Layer {
    fn matrix(&self, k: f64) -> Matrix {
        let e =
            |i: usize, j: usize| Complex64::new(self.permittivity.col(j)[i], self.loss.col(j)[i]);
        let m = |i: usize, j: usize| self.permeability.col(j)[i];
        // The columns are the derivatives of unit fields.
        let of = |unit: [f64; 4]| -> [Complex64; 4] {
            let [ex, ey, hx, hy] = unit;
            let ez = -(k * hy + e(2, 0) * ex + e(2, 1) * ey) / e(2, 2);
            let hz = (k * ey - m(2, 0) * hx - m(2, 1) * hy) / m(2, 2);
            let d = |i: usize| e(i, 0) * ex + e(i, 1) * ey + e(i, 2) * ez;
            let b = |i: usize| m(i, 0) * hx + m(i, 1) * hy + m(i, 2) * hz;
            [b(1) + k * ez, (-b(0)).into(), -d(1) + k * hz, d(0)]
        };
        let columns: [[Complex64; 4]; 4] =
            std::array::from_fn(|j| of(std::array::from_fn(|i| f64::from(u8::from(i == j)))));
        std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]))
    }
}

/// Ψ of a plane wave in air of an electric field along a unit vector.
fn in_air(k: f64, kz: f64, electric: DVec3) -> [Complex64; 4] {
    let magnetic = DVec3::new(k, 0.0, kz).cross(electric);
    [electric.x, electric.y, magnetic.x, magnetic.y].map(Complex64::from)
}

/// Solves a linear system by elimination with pivots.
fn solve(mut a: Matrix, mut b: [Complex64; 4]) -> [Complex64; 4] {
    for column in 0..4 {
        let pivot = (column..4)
            .max_by(|&i, &j| a[i][column].norm().total_cmp(&a[j][column].norm()))
            .unwrap();
        a.swap(column, pivot);
        b.swap(column, pivot);
        for row in column + 1..4 {
            let factor = a[row][column] / a[column][column];
            let above = a[column];
            for (entry, above) in a[row].iter_mut().zip(above).skip(column) {
                *entry -= factor * above;
            }
            let above = b[column];
            b[row] -= factor * above;
        }
    }
    let mut x = [ZERO; 4];
    for row in (0..4).rev() {
        let known: Complex64 = (row + 1..4).map(|l| a[row][l] * x[l]).sum();
        x[row] = (b[row] - known) / a[row][row];
    }
    x
}

/// What a stack in air does to light of a vacuum wave number (1/cm) that comes in with the
/// tangential wave vector k.
pub fn jones(layers: &[Layer], wave_number: f64, k: f64) -> Jones {
    let kz = (1.0 - k * k).sqrt();
    let through = layers.iter().fold(None, |before: Option<Matrix>, layer| {
        let own = exponential(&layer.matrix(k), wave_number * layer.thickness);
        Some(before.map_or(own, |before| product(&own, &before)))
    });
    let through = through.unwrap();
    let onto = |psi: [Complex64; 4]| -> [Complex64; 4] {
        std::array::from_fn(|i| (0..4).map(|j| through[i][j] * psi[j]).sum())
    };
    let back = polarizations(k, -kz).map(|field| onto(in_air(k, -kz, field)));
    let on = polarizations(k, kz).map(|field| in_air(k, kz, field));
    // Transmitted - through · reflected = through · incident.
    let a = std::array::from_fn(|i| [on[0][i], on[1][i], -back[0][i], -back[1][i]]);
    let columns = polarizations(k, kz).map(|field| solve(a, onto(in_air(k, kz, field))));
    let part =
        |first: usize| [0, 1].map(|row| [0, 1].map(|column: usize| columns[column][first + row]));
    Jones { transmitted: part(0), reflected: part(2) }
}

#[test]
fn a_quarter_wave_of_glass_is_the_airy_formula() {
    let glass = |thickness| Layer {
        permittivity: DMat3::IDENTITY * 2.25,
        permeability: DMat3::IDENTITY,
        loss: DMat3::ZERO,
        thickness,
    };
    let wave_number = std::f64::consts::TAU;
    // λ/4 in glass: r = (1 - n²)/(1 + n²).
    let quarter = jones(&[glass(1.0 / 6.0)], wave_number, 0.0);
    let r: f64 = -1.25 / 3.25;
    assert!((quarter.reflected[0][0].norm() - r.abs()).abs() < 1e-14);
    assert!(jones(&[glass(1.0 / 3.0)], wave_number, 0.0).reflected[1][1].norm() < 1e-14);
    let oblique = jones(&[glass(0.3), glass(0.1)], wave_number, 0.6);
    let power = |m: [[Complex64; 2]; 2], i: usize| m[0][i].norm_sqr() + m[1][i].norm_sqr();
    for i in 0..2 {
        assert!((power(oblique.reflected, i) + power(oblique.transmitted, i) - 1.0).abs() < 1e-13);
    }
}
