//! The map against what defines it, against its series, and against published numbers.
//!
//! A map is conformal with these borders only if it is the quasi-conformal one, and by the maximum
//! principle it is as near to it everywhere as its borders are.

use std::sync::LazyLock;

use super::*;
use crate::transformation::ConformalMap;

const CUT: Truncation = Truncation { x_min: -25.0, x_max: 25.0, y_max: 28.57 };

/// Solved once.
static MAPS: LazyLock<[(QuasiConformalMap, Truncation); 6]> = LazyLock::new(|| {
    [
        (28.0, 4.25, CUT),
        (50.0, 4.25, CUT),
        (6.0, 2.0, CUT),
        (28.0, 9.0, CUT),
        (13.0, 1.0, Truncation::centred(60.0, 10.0)),
        (2.0, 0.2, Truncation::centred(4.0, 1.5)),
    ]
    .map(|(w, h, cut)| (QuasiConformalMap::new(w, h, &cut).expect("a map"), cut))
});

#[test]
fn borders_go_to_borders() {
    for (map, cut) in MAPS.iter() {
        let (a, top) = (cut.x_max, map.virtual_height());
        let (mut floor, mut corner) = (0.0_f64, 0.0_f64);
        for k in 0..=10_007 {
            let share = f64::from(k) / 10_007.0;
            let on_floor = map.jet((a * (2.0 * share - 1.0)).into()).f;
            floor = floor.max((on_floor.im - map.bump.height_at(on_floor.re)).abs());
            let on_top = map.jet(Complex64::new(a * (2.0 * share - 1.0), top)).f;
            corner = corner.max((on_top.im - cut.y_max).abs());
            for side in [-a, a] {
                let on_side = map.jet(Complex64::new(side, share * top)).f;
                corner = corner.max((on_side.re - side).abs());
            }
        }
        assert!(
            floor < 1e-4 * map.bump.height && corner < 1e-12 * a,
            "{floor:e} {corner:e} {map:?}"
        );
    }
}

#[test]
fn table_is_the_series_and_conformal() {
    for (map, cut) in MAPS.iter() {
        let (series, top) = (&map.solved.series, map.virtual_height());
        let tiny = 0.02 / series.highest_wave_number();
        let mut worst = [0.0_f64; 4];
        for k in 1..4000 {
            let spread = |root: f64| (f64::from(k) * root).fract();
            let x = cut.x_max * (2.0 * spread(0.754_877_666_246_692_8) - 1.0);
            // As many near the floor as far above it.
            let zeta = Complex64::new(x, top * spread(0.569_840_290_998_053_3).powi(4));
            let [f, f1, half_f2] = series.taylor::<3>(zeta);
            let jet = map.jet(zeta);
            let d = |along: Complex64| {
                let [a, b] = [-tiny, tiny].map(|t| map.jet(zeta + t * along));
                (b.f - a.f) / (2.0 * tiny * along)
            };
            let errors = [
                (jet.f - f).norm() / cut.x_max,
                (jet.f1 - f1).norm(),
                (jet.f2 - 2.0 * half_f2).norm() * map.bump.width,
                (d(Complex64::ONE) - jet.f1).norm().max((d(Complex64::i()) - jet.f1).norm()),
            ];
            for (worst, error) in worst.iter_mut().zip(errors) {
                *worst = worst.max(error);
            }
        }
        let good = worst[0] < 1e-13 && worst[1] < 1e-11 && worst[2] < 1e-8 && worst[3] < 1e-4;
        assert!(good, "{worst:?} {:?}", map.bump);
    }
}

#[test]
fn has_the_numbers_of_li_and_pendry() {
    let cut = Truncation::centred(4.0, 1.5);
    let map = QuasiConformalMap::new(2.0, 0.2, &cut).expect("a map");
    let c = map.index_scale();
    assert!((map.anisotropy() - 1.042).abs() < 5e-4, "{}", map.anisotropy());
    let (least, largest) = ConformalMap::QuasiConformal(map).index_range(&cut);
    let (least, largest) = (c * least, c * largest);
    assert!((least - 0.818).abs() < 5e-4 && (largest - 1.403).abs() < 5e-4, "{least} {largest}");
}

#[test]
fn inverse_undoes_the_map() {
    for (map, cut) in MAPS.iter() {
        let map = ConformalMap::QuasiConformal(map.clone());
        for row in 0..=20 {
            for column in 0..=50 {
                let x = cut.x_max * (f64::from(column) / 25.0 - 1.0);
                let low = map.floor_height_at(x);
                let z = Complex64::new(x, low + (cut.y_max - low) * f64::from(row) / 20.0);
                let zeta = map.invert(z).expect("a point of the box");
                assert!((map.jet(zeta).f - z).norm() < 1e-13 * cut.x_max, "{z} {zeta}");
                assert!(zeta.im > -1e-12 * cut.x_max, "{z} {zeta}");
            }
        }
    }
}

#[test]
fn area_is_the_integral_of_the_height() {
    let (map, _) = &MAPS[0];
    let count = 10_000;
    let spacing = 9.0 / f64::from(count);
    let sum: f64 = (0..count).map(|k| map.bump.height_at((f64::from(k) + 0.5) * spacing)).sum();
    assert!((sum * spacing - map.area_from_middle_to(9.0)).abs() < 1e-7);
    assert!((map.area_from_middle_to(25.0) - 0.25 * 28.0 * 4.25).abs() < 1e-12);
}

#[test]
fn refuses_what_is_not_a_map() {
    use ConformalMapError as Error;
    let error = |w, h| QuasiConformalMap::new(w, h, &CUT).err();
    assert!(matches!(error(f64::NAN, 1.0), Some(Error::Length { .. })));
    assert!(matches!(error(10.0, -1.0), Some(Error::Length { .. })));
    assert!(matches!(error(50.1, 1.0), Some(Error::TooWide { .. })));
    assert!(matches!(error(1.0, 1.0), Some(Error::TooNarrow { .. })));
    assert!(matches!(error(28.0, 28.57), Some(Error::TooHigh { .. })));
    assert!(matches!(error(6.0, 27.0), Some(Error::TooSteep { .. })));
    assert!(error(28.0, 14.0).is_none());
}

/// Whoever waits for a carpet waits a moment: the widest one took eight seconds when each sum was
/// added up term by term.
#[test]
fn the_widest_map_takes_a_moment() {
    let start = std::time::Instant::now();
    let map = QuasiConformalMap::new(39.0, 4.25, &Truncation::centred(390.0, 30.0)).expect("a map");
    // A tenth of a second on a machine that does nothing else.
    assert!(start.elapsed().as_secs() < 3, "{:?}", start.elapsed());
    let steep = QuasiConformalMap::new(10.0, 12.7, &Truncation::centred(100.0, 30.0));
    assert!(start.elapsed().as_secs() < 3, "{:?}", start.elapsed());
    for map in [map, steep.expect("a map")] {
        let (height, width) = (map.bump.height, map.bump.width);
        for k in 0..=1000 {
            let f = map.jet((f64::from(k) * 1e-3 * width).into()).f;
            assert!((f.im - map.bump.height_at(f.re)).abs() < 1e-4 * height, "{f}");
        }
    }
}

/// Rows of the table are found all points at once.
#[test]
fn rows_of_points_are_the_series() {
    for (map, _) in MAPS.iter() {
        let series = &map.solved.series;
        let least = series.highest_wave_number().recip();
        for (step, bottom) in [(1, -8.0), (1, 0.0), (4, 32.0), (64, 512.0)] {
            let (spacing, bottom) = (step as f64 * least, bottom * least);
            let columns = (series.half_width / spacing).round() as usize + 1;
            let mut transform = series.transform_along(columns, step, bottom);
            for y in [bottom, bottom + 5.0 * spacing] {
                if y > map.virtual_height() {
                    continue;
                }
                let row = series.taylor_along::<4>(&mut transform, columns, spacing, y);
                for (column, found) in row.iter().enumerate() {
                    let zeta = Complex64::new(column as f64 * spacing, y);
                    let expected = series.taylor::<4>(zeta);
                    for (n, (a, b)) in (0..).zip(found.iter().zip(expected)) {
                        // As much as it moves a place within a patch.
                        let error = (a - b).norm() * spacing.powi(n);
                        assert!(
                            error < 1e-13 * series.half_width,
                            "{step} {y} {column} {n}: {error:e}"
                        );
                    }
                }
            }
        }
    }
}
