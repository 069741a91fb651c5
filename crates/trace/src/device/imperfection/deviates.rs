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

    /// A normally distributed number of mean 0 and variance 1 (Box & Muller, Ann. Math. Stat. 29, 610 (1958)).
    pub fn normal(&self, number: u64) -> f64 {
        let [a, b] = [0, 1].map(|i| self.uniform(2 * number + i));
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviates_are_normal_and_independent() {
        let deviates = Deviates::new([7, 0, 3]);
        let other = Deviates::new([7, 0, 4]);
        let count = 100_000_u32;
        let mean = |value: &dyn Fn(u64) -> f64| {
            (0..u64::from(count)).map(value).sum::<f64>() / f64::from(count)
        };
        // Each within five of its own standard errors.
        let error = f64::from(count).sqrt().recip();
        assert!(mean(&|k| deviates.normal(k)).abs() < 5.0 * error);
        assert!((mean(&|k| deviates.normal(k).powi(2)) - 1.0).abs() < 5.0 * 2f64.sqrt() * error);
        assert!((mean(&|k| deviates.normal(k).powi(4)) - 3.0).abs() < 5.0 * 96f64.sqrt() * error);
        assert!(mean(&|k| deviates.normal(k) * deviates.normal(k + 1)).abs() < 5.0 * error);
        assert!(mean(&|k| deviates.normal(k) * other.normal(k)).abs() < 5.0 * error);
        assert!((mean(&|k| deviates.uniform(k)) - 0.5).abs() < 5.0 * error / 12f64.sqrt());
        assert_eq!(deviates.normal(5), Deviates::new([7, 0, 3]).normal(5));
    }
}
