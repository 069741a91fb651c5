//! Random numbers that depend on what they are for alone, and on no order.

use crate::split_mix::{STEP, mix};
use std::f64::consts::TAU;

/// A source of independent random numbers, told apart by a number of their own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Deviates {
    state: u64,
}

impl Deviates {
    /// The source that belongs to some numbers.
    pub fn new(of: [u64; 3]) -> Self {
        Self { state: of.into_iter().fold(0, |state, number| mix(state ^ mix(number))) }
    }

    /// A number between 0 and 1, neither included.
    pub fn uniform(&self, number: u64) -> f64 {
        let bits = mix(self.state.wrapping_add(STEP.wrapping_mul(number))) >> 11;
        (bits as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// A normally distributed number of mean 0 and variance 1 (Box & Muller, Ann. Math. Stat. 29,
    /// 610 (1958)).
    pub fn normal(&self, number: u64) -> f64 {
        let [a, b] = [0, 1].map(|i| self.uniform(2 * number + i));
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    }
}

#[cfg(test)]
mod tests;
