//! Numbers, words and choices from the bytes of a fuzzer, or from a seed.

use cloakroom::keys::ValueRange;
use cloakroom::split_mix::{STEP, mix};
use glam::DVec3;
use optics::geometry::Pose;
use std::f64::consts::TAU;

/// Where choices come from. The same source gives the same choices.
#[derive(Clone, Debug)]
pub enum Draws<'a> {
    /// Choices that bytes make, so that a fuzzer can change one and keep the others. Zeros follow
    /// the last byte, which mean the first choice or the default everywhere.
    Bytes(&'a [u8]),
    /// Choices without end, by the state of [`mix`].
    Seed(u64),
}

/// Limits that are farther apart say only what is possible, not what is likely.
const WIDE: f64 = 1e4;

/// The ends of what numbers can be.
const LARGEST: f64 = f64::MAX;
const SMALLEST: f64 = f64::MIN_POSITIVE;

/// Values at which something may change.
const SPECIAL: [f64; 22] = [
    0.0, -0.0, 1.0, -1.0, 0.5, 2.0, 3.0, 4.0, 10.0, 45.0, 90.0, 180.0, 360.0, 1e-9, 1e-16, 1e9,
    1e16, 1e154, 1e300, 1e-300, LARGEST, SMALLEST,
];

impl Draws<'_> {
    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let mut taken = [0; N];
        match self {
            Self::Bytes(bytes) => {
                let count = N.min(bytes.len());
                let (first, rest) = bytes.split_at(count);
                taken[..count].copy_from_slice(first);
                *bytes = rest;
            }
            Self::Seed(state) => {
                taken.copy_from_slice(&mix(*state).to_le_bytes()[..N]);
                *state = state.wrapping_add(STEP);
            }
        }
        taken
    }

    /// A number below `count`, at least 1 and at most 256.
    pub fn below(&mut self, count: usize) -> usize {
        let [byte] = self.bytes();
        usize::from(byte) % count.max(1)
    }

    /// Yes in `of` of 256 cases; no where bytes have ended.
    pub fn chance(&mut self, of: u8) -> bool {
        let [byte] = self.bytes();
        byte > u8::MAX - of
    }

    /// One of some; the first where bytes have ended.
    pub fn pick<'t, T>(&mut self, among: &'t [T]) -> &'t T {
        &among[self.below(among.len())]
    }

    /// A number in [0, 1).
    pub fn share(&mut self) -> f64 {
        f64::from(u32::from_le_bytes(self.bytes())) / 4_294_967_296.0
    }

    /// A number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// A whole number of any size.
    pub fn integer(&mut self) -> i64 {
        match self.below(3) {
            0 => self.below(10) as i64,
            1 => i64::from(i32::from_le_bytes(self.bytes())),
            _ => i64::from_le_bytes(self.bytes()),
        }
    }

    /// Any finite number, as a rule near a usual one and, but for a few, within limits.
    pub fn number(&mut self, usual: f64, limits: ValueRange) -> f64 {
        let (low, high) = match limits {
            ValueRange::Between(low, high) | ValueRange::Within(low, high) => (low, high),
            ValueRange::Whole(low, high) => (low as f64, high as f64),
            ValueRange::Positive => (0.0, f64::INFINITY),
            ValueRange::Finite => (f64::NEG_INFINITY, f64::INFINITY),
        };
        let size = if usual == 0.0 { 1.0 } else { usual };
        let number = match self.below(16) {
            0..3 => usual,
            3..10 => size * self.between(-2.0, 2.0).exp2(),
            10..12 if high - low < WIDE => self.between(low, high),
            10..12 => size * self.between(-4.0, 4.0),
            12 | 13 => size * 10f64.powf(self.between(-6.0, 6.0)) * *self.pick(&[1.0, -1.0]),
            14 => *self.pick(&SPECIAL),
            _ => f64::from_bits(u64::from_le_bytes(self.bytes())),
        };
        if limits.allow(number) || (number.is_finite() && self.chance(8)) { number } else { usual }
    }

    /// A number of one decimal in an interval.
    pub fn tenths(&mut self, low: f64, high: f64) -> f64 {
        (10.0 * self.between(low, high)).round() / 10.0
    }

    /// A pose about any axis, its origin within 30 cm of the world's.
    pub fn pose(&mut self) -> Pose {
        let origin = self.direction() * self.between(0.0, 30.0);
        Pose::with_axis(origin, self.between(0.0, TAU), self.direction())
    }

    /// A direction, evenly on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let (z, angle) = (self.between(-1.0, 1.0), self.between(0.0, TAU));
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * angle.cos(), across * angle.sin(), z)
    }
}
