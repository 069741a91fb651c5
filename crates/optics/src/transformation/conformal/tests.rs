use approx::assert_relative_eq;
use errorfunctions::ComplexErrorFunctions;
use proptest::prelude::*;
use pulp::WithSimd;

use super::*;
use crate::lanes::{LANES, portably, side_by_side};

fn map(w: f64, h: f64) -> ConformalMap {
    ConformalMap::Gaussian(GaussianMap::new(w, h).expect("a valid map"))
}

struct Four<'m, M>(&'m M, [Complex64; LANES]);

impl<M: LaneMap> WithSimd for Four<'_, M> {
    type Output = [MapJet; LANES];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let jets = self.0.jets(ComplexLanes::new(simd, self.1));
        let (f, f1, f2) = (jets.f.values(), jets.f1.values(), jets.f2.values());
        std::array::from_fn(|i| MapJet { f: f[i], f1: f1[i], f2: f2[i] })
    }
}

#[test]
fn four_points_at_once_are_four_alone() {
    fn check<M: LaneMap>(lanes: &M, map: &ConformalMap) {
        for k in 0..5000 {
            // All over, beyond the device and below the floor a little.
            let points: [Complex64; LANES] = std::array::from_fn(|i| {
                let x = f64::from(k) + 0.31 * i as f64;
                Complex64::new(60.0 * (1.7 * x).sin(), 18.0 + 18.1 * (0.9 * x).cos())
            });
            let wide = side_by_side(Four(lanes, points)).unwrap_or_else(portably);
            let narrow = portably(Four(map, points));
            for (four, zeta) in wide.into_iter().zip(points).chain(narrow.into_iter().zip(points)) {
                let alone = map.jet(zeta);
                assert!((four.f - alone.f).norm() < 1e-13, "{zeta}: {four:?} {alone:?}");
                assert!((four.f1 - alone.f1).norm() < 1e-14, "{zeta}: {four:?} {alone:?}");
                assert!((four.f2 - alone.f2).norm() < 1e-14, "{zeta}: {four:?} {alone:?}");
            }
        }
    }
    let gaussian = GaussianMap::new(10.02, 4.25).expect("a valid map");
    check(&gaussian, &ConformalMap::Gaussian(gaussian));
    let grating = GratingMap::new(20.0, 1.5).expect("a valid map");
    check(&grating, &ConformalMap::Grating(grating));
    let quasi_conformal = QuasiConformalMap::new(28.0, 4.25, &PAPER).expect("a valid map");
    check(&quasi_conformal, &ConformalMap::QuasiConformal(quasi_conformal.clone()));
}

const PAPER: Truncation = Truncation { x_min: -25.0, x_max: 25.0, y_max: 28.57 };

#[test]
fn has_the_numbers_of_the_paper() {
    let (least, largest) = map(10.02, 4.25).index_range(&PAPER);
    assert!((least - 0.873).abs() < 5e-4 && (largest - 1.918).abs() < 5e-4, "{least} {largest}");
    let (_, largest) = map(10.0158, 4.2532).index_range(&PAPER);
    assert!((largest - 1.920).abs() < 5e-4, "{largest}");
    let area = GaussianMap::new(10.02, 4.25).expect("a valid map").area();
    assert!((2.0 * area - 114.83).abs() < 0.1);
}

#[test]
fn range_is_not_exceeded_inside() {
    let map = map(10.02, 4.25);
    let (least, largest) = map.index_range(&PAPER);
    for row in 0..60 {
        for column in 0..=100 {
            let x = f64::from(column - 50) * 0.5;
            let low = map.floor_height_at(x);
            let y = low + (PAPER.y_max - low) * f64::from(row) / 59.0;
            let zeta = map.invert(Complex64::new(x, y)).expect("above the floor");
            let n = map.jet(zeta).f1.norm().recip();
            assert!(n > least - 1e-12 && n < largest + 1e-12);
        }
    }
}

#[test]
fn area_within_the_cut_is_the_integral_of_the_height() {
    let map = map(8.0, 5.0);
    let cut = Truncation { x_min: -7.0, x_max: 13.0, y_max: 20.0 };
    let count = 20_000;
    let spacing = 20.0 / f64::from(count);
    let sum: f64 =
        (0..count).map(|k| map.floor_height_at(-7.0 + (f64::from(k) + 0.5) * spacing)).sum();
    assert_relative_eq!(map.area_within(&cut), sum * spacing, max_relative = 1e-7);
    let wide = Truncation::centred(400.0, 20.0);
    let whole = GaussianMap::new(8.0, 5.0).expect("a valid map").area();
    assert_relative_eq!(map.area_within(&wide), whole, max_relative = 1e-12);
}

#[test]
fn refuses_what_is_not_a_map() {
    for (w, h) in [(0.0, 1.0), (1.0, 0.0), (-1.0, -0.5), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
        assert!(matches!(GaussianMap::new(w, h), Err(ConformalMapError::Length { .. })));
    }
    assert!(matches!(GaussianMap::new(1.0, 0.9), Err(ConformalMapError::Folds { .. })));
    assert!(GaussianMap::new(1.0, 0.886).is_ok());
}

#[test]
fn has_no_inverse_at_nonsense() {
    assert_eq!(map(10.0, 4.0).invert(Complex64::new(f64::NAN, 1.0)), None);
    assert_eq!(map(10.0, 4.0).invert(Complex64::new(1.0, f64::INFINITY)), None);
    assert_eq!(map(10.0, 4.0).invert(Complex64::new(0.0, -80.0)), None);
}

proptest! {
    #[test]
    fn jet_agrees_with_an_independent_faddeeva_function(
        w in 0.1..40.0, ratio in 0.001..0.88, x in -5.0..5.0, y in -0.2..8.0,
    ) {
        let (t, h) = (Complex64::new(x, y), ratio * w);
        let exact = w * t + Complex64::i() * h * t.w();
        let map = map(w, h);
        prop_assert!((map.jet(w * t).f - exact).norm() < 1e-13 * w * (1.0 + t.norm()));
        let d = 1e-4 * w;
        let [before, at, after] = [t - 1e-4, t, t + 1e-4].map(|t| map.jet(w * t));
        prop_assert!(((after.f - before.f) / (2.0 * d) - at.f1).norm() < 1e-7);
        prop_assert!(((after.f1 - before.f1) / (2.0 * d) - at.f2).norm() < 1e-7 / w);
    }

    #[test]
    fn inverse_undoes_the_map(
        w in 0.01..100.0, ratio in 0.001..0.885, x in -6.0..6.0, y in 0.0..6.0, reach in 0..4,
    ) {
        let map = map(w, ratio * w);
        let scale = w * [1.0, 0.03, 100.0, 1e6][reach as usize];
        for zeta in [Complex64::new(x, y), Complex64::new(x, 0.0), Complex64::new(0.0, y)] {
            let zeta = zeta * scale;
            let z = map.jet(zeta).f;
            let back = map.invert(z).ok_or(TestCaseError::fail(format!("{zeta}")))?;
            prop_assert!((map.jet(back).f - z).norm() < 1e-13 * (w + z.norm()));
            // Near the top of a steep bump f' almost vanishes, and the inverse is as badly
            // conditioned.
            let slack = 1e-14 * (w + zeta.norm()) / map.jet(zeta).f1.norm();
            prop_assert!((back - zeta).norm() < 10.0 * slack, "{} {}", back, zeta);
        }
    }

    #[test]
    fn floor_is_where_y_is_zero(w in 0.1_f64..40.0, ratio in 0.001_f64..0.885, x in -5.0_f64..5.0) {
        let map = map(w, ratio * w);
        let parameter = map.floor_parameter(x * w);
        let point = map.jet(parameter.into()).f;
        prop_assert!((point.re - x * w).abs() < 1e-13 * w);
        prop_assert!((point.im - map.floor_height_at(x * w)).abs() < 1e-12 * w);
        prop_assert!(point.im <= map.peak());
    }
}
