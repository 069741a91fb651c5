//! Tests of crossings.

use pulp::WithSimd;

use super::*;
use crate::lanes::{portably, side_by_side};

/// When a value next falls through zero.
struct Fall(EventJet);

impl WithSimd for Fall {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let EventJet { value, rate, bend } = self.0;
        let [value, rate, bend] = [value, rate, bend].map(|x| Lanes::splat(simd, x));
        EventJet { value, rate, bend }.time_ahead().values()[2]
    }
}

/// (s - a)(s - b)(s - c) and its derivatives at s.
fn cubic(s: f64, [a, b, c]: [f64; 3]) -> EventJet {
    let (p, q, r) = (s - a, s - b, s - c);
    EventJet { value: p * q * r, rate: p * q + q * r + r * p, bend: 2.0 * (p + q + r) }
}

#[test]
fn the_first_fall_is_found_and_a_root_at_the_start_passed_over() {
    let fall =
        |roots: [f64; 3]| Hermite::new(cubic(0.0, roots), cubic(1.0, roots), 1.0).first_fall();
    assert!((fall([-0.5, 0.4, 2.0]) - 0.4).abs() < 1e-14);
    assert!((fall([0.0, 0.7, 3.0]) - 0.7).abs() < 1e-14);
    assert!((fall([0.0, 1e-6, 3.0]) - 1e-6).abs() < 1e-14);
}

#[test]
fn a_dip_is_seen_from_its_ends() {
    let roots = [-1.0, 0.4, 0.6];
    let (share, least) = Hermite::new(cubic(0.0, roots), cubic(1.0, roots), 1.0).minimum();
    assert!(share > 0.4 && share < 0.6 && least < 0.0);
    assert!(
        (cubic(share, roots).rate).abs() < 1e-13
            && (cubic(share, roots).value - least).abs() < 1e-14
    );
}

#[test]
fn extrapolation_sees_the_next_fall_only() {
    let time = |value, rate, bend| {
        side_by_side(Fall(EventJet { value, rate, bend })).unwrap_or_else(portably)
    };
    assert_eq!(time(2.0, -1.0, 0.0), 2.0);
    assert_eq!(time(2.0, 1.0, 0.0), f64::INFINITY);
    assert_eq!(time(2.0, 0.0, -1.0), 2.0);
    assert_eq!(time(0.0, 1.0, -1.0), 2.0);
    assert_eq!(time(2.0, -1.0, 5.0), f64::INFINITY);
    assert_eq!(time(f64::NAN, 1.0, 1.0), f64::INFINITY);
}
