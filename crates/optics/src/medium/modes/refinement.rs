//! Modes of a general medium, made exact to rounding.
//!
//! Where an indefinite tensor has a small normal-normal entry, one eigenvalue of Berreman's matrix
//! is large and the others lose as many digits. Newton's method on Maxwell's equations themselves,
//! in which no entry is large, finds them again.

use super::LocalMode;
use crate::wave::{Number, cross, dot, solve};

/// Maxwell's equations p × E = µH, p × H = -εE in the frame of an interface.
#[derive(Clone, Copy)]
pub(super) struct Maxwell<T> {
    pub permittivity: [[T; 3]; 3],
    pub permeability: [[T; 3]; 3],
    pub tangential: [T; 2],
}

/// Residuals below this, relative to the terms of the equations, are rounding.
const ROUNDING: f64 = 4e-15;

/// Modes that solve Maxwell's equations to this are not sought again.
const SOLVED: f64 = 1e-10;

/// The modes that `of` finds, and how far they are from solving Maxwell's equations, given the
/// least normal-normal entries. Beside the reciprocal of a small one, all else in Berreman's matrix
/// loses digits: then the entry is taken for larger than it is, and Newton's method mends that.
pub(super) fn best<M>(of: impl Fn(f64) -> (M, f64)) -> M {
    let (modes, residual) = of(1e-14);
    if residual < SOLVED {
        return modes;
    }
    let (others, smaller) = of(1e-7);
    if smaller < residual { others } else { modes }
}

impl<T: Number> Maxwell<T> {
    /// The same of other numbers.
    pub fn map<U>(&self, number: impl Fn(T) -> U + Copy) -> Maxwell<U> {
        let tensor = |tensor: [[T; 3]; 3]| tensor.map(|row| row.map(number));
        Maxwell {
            permittivity: tensor(self.permittivity),
            permeability: tensor(self.permeability),
            tangential: self.tangential.map(number),
        }
    }

    /// The mode after as many steps of Newton's method as it needs, normally none.
    pub fn refined(&self, mode: LocalMode<T>) -> LocalMode<T> {
        let mut best = mode.normalized();
        let mut least = self.residual_size(&best);
        for _ in 0..3 {
            if least < ROUNDING {
                break;
            }
            let next = self.newton_step(&best);
            let size = self.residual_size(&next);
            // At a double root, where the equations are singular, the step may lead astray.
            let close = (next.norm_squared() - 1.0).abs() < 1e-3;
            if !(size < least && close) {
                break;
            }
            (best, least) = (next, size);
        }
        best
    }

    /// p × E - µH and p × H + εE.
    pub fn residual(&self, mode: &LocalMode<T>) -> [[T; 3]; 2] {
        let [k1, k2] = self.tangential;
        let p = [k1, k2, mode.q];
        let (e, h) = (mode.electric, mode.magnetic);
        let (curl_e, curl_h) = (cross(p, e), cross(p, h));
        [
            std::array::from_fn(|i| curl_e[i] - dot(self.permeability[i], h)),
            std::array::from_fn(|i| curl_h[i] + dot(self.permittivity[i], e)),
        ]
    }

    /// The residual of a mode with |E|² + |H|² = 1, relative to the terms it is made of.
    pub fn residual_size(&self, mode: &LocalMode<T>) -> f64 {
        let square = |v: &[T]| v.iter().map(|c| c.magnitude_squared()).sum::<f64>();
        let terms = square(&self.tangential)
            + mode.q.magnitude_squared()
            + square(self.permittivity.as_flattened())
            + square(self.permeability.as_flattened());
        (square(self.residual(mode).as_flattened()) / terms).sqrt()
    }

    /// Solves the equations linearized in the fields and q, keeping the size of the fields.
    fn newton_step(&self, mode: &LocalMode<T>) -> LocalMode<T> {
        let zero = T::from(0.0);
        let [k1, k2] = self.tangential;
        let q = mode.q;
        // The matrix of p ×.
        let curl = [[zero, -q, k2], [q, zero, -k1], [-k2, k1, zero]];
        let (e, h) = (mode.electric, mode.magnetic);
        let mut matrix = [[zero; 7]; 7];
        for i in 0..3 {
            for j in 0..3 {
                matrix[i][j] = curl[i][j];
                matrix[i][j + 3] = -self.permeability[i][j];
                matrix[i + 3][j] = self.permittivity[i][j];
                matrix[i + 3][j + 3] = curl[i][j];
            }
            matrix[6][i] = e[i].conjugate();
            matrix[6][i + 3] = h[i].conjugate();
        }
        // The derivative by q: n × E and n × H.
        for (row, value) in [(0, -e[1]), (1, e[0]), (3, -h[1]), (4, h[0])] {
            matrix[row][6] = value;
        }
        let [r, s] = self.residual(mode);
        let right = [r[0], r[1], r[2], s[0], s[1], s[2], zero].map(|value| [-value]);
        let step = solve(matrix, right).map(|[value]| value);
        LocalMode {
            q: q + step[6],
            electric: std::array::from_fn(|i| e[i] + step[i]),
            magnetic: std::array::from_fn(|i| h[i] + step[i + 3]),
            ..*mode
        }
    }
}
