//! An index that is uneven, against the physical ray equation.

use super::rays::{CUT, Dice, flow, legs, steepness, turn};
use super::{place, uneven_reference};
use glam::DVec2;
use optics::geometry::Extent;
use optics::propagation::{Boundary, Degree, GridSpline, IndexPerturbation};

/// Samples of the square of a factor on a grid that reaches beyond the cut.
fn grid(degree: Degree, spacing: f64, square: impl Fn(DVec2) -> f64) -> GridSpline {
    let corner = DVec2::new(CUT.x_min - 4.0, -6.0);
    let end = DVec2::new(CUT.x_max + 4.0, CUT.y_max + 4.0);
    let [columns, rows] =
        ((end - corner) / spacing).to_array().map(|steps| steps.ceil() as usize + 1);
    let place =
        |k: usize| corner + spacing * DVec2::new((k % columns) as f64, (k / columns) as f64);
    let samples: Vec<f64> = (0..columns * rows).map(|k| square(place(k))).collect();
    GridSpline::new(degree, corner, DVec2::splat(spacing), [columns, rows], &samples)
        .expect("a grid")
}

/// Hills and dells of 3 %, about 10 cm apart.
fn hills(p: DVec2) -> f64 {
    1.0 + 0.06 * (0.6 * p.x + 0.2).sin() * (0.5 * p.y - 0.1 * p.x).cos()
}

/// Bumps as those of a random error, correlated over 2 cm.
fn bumps(p: DVec2) -> f64 {
    1.0 + 0.04 * (0.9 * p.x + 0.2).sin() * (0.7 * p.y - 0.6 * p.x).cos()
}

#[test]
fn an_even_unevenness_is_none() {
    let short = Extent { min: -10.0, max: 10.0 };
    let even = flow(short, 1.1);
    let uneven = flow(short, 1.1).with_index_perturbation(
        IndexPerturbation::new(grid(Degree::Three, 2.0, |_| 1.0)).expect("positive"),
    );
    let mut dice = Dice(77);
    for _ in 0..300 {
        let (start, p) = dice.enter(&even, short);
        let [a, b] =
            [&even, &uneven].map(|flow| flow.advance_from(&start, p, 1e-9).expect("a ray"));
        if steepness(&a) < 0.02 {
            continue;
        }
        assert_eq!(a.surface, b.surface);
        assert!((a.position - b.position).length() < 1e-8, "{a:?} {b:?}");
        assert!((a.wave_vector - b.wave_vector).length() < 1e-9);
        assert!((a.optical_path - b.optical_path).abs() < 1e-8);
        let turned = a.transport - b.transport;
        assert!(turned.to_cols_array().iter().all(|e| e.abs() < 1e-8), "{turned}");
    }
}

#[test]
fn uneven_rays_obey_the_physical_ray_equation() {
    let short = Extent { min: -10.0, max: 10.0 };
    let splines = [
        grid(Degree::Three, 0.8, hills),
        grid(Degree::Seven, 0.8, hills),
        grid(Degree::Seven, 0.5, bumps),
    ];
    let mut dice = Dice(0x0dd5_eed5);
    let (mut floors, mut compared, mut worst) = (0, 0, [[0.0_f64; 4]; 3]);
    for k in 0..180 {
        let (spline, worst) = (&splines[k % 3], &mut worst[k % 3]);
        let (extent, c) = [(Extent::ENDLESS, 1.0), (short, 1.0), (short, 1.1456)][k / 3 % 3];
        let flow = flow(extent, c)
            .with_index_perturbation(IndexPerturbation::new(spline.clone()).expect("positive"));
        for (start, p, end) in legs(&flow, dice.enter(&flow, extent), 1e-8) {
            if steepness(&end) < 0.02 {
                continue;
            }
            let exact =
                uneven_reference(&start, p, extent, c, |at| spline.look(at)).expect("a ray");
            let coarse = flow.advance_from(&start, p, 1e-6).expect("the same ray");
            let field = turn(&start, &end) * p.normalize().any_orthonormal_vector();
            let off = [
                (end.position - exact.position).length(),
                (coarse.position - exact.position).length(),
                (end.optical_path - exact.optical_path).abs(),
                (field - exact.electric_field).length(),
            ];
            for (worst, off) in worst.iter_mut().zip(off) {
                *worst = worst.max(off);
            }
            floors += u32::from(end.surface == Boundary::Floor);
            compared += 1;
        }
    }
    assert!(compared > 150 && floors > 5, "{compared} {floors}");
    // The reference crosses the lines of the grid without care.
    let bounds = [[2e-7, 1e-6, 2e-7, 2e-7], [5e-8, 1e-6, 5e-8, 2e-8], [5e-8, 1e-6, 5e-8, 2e-8]];
    let mut all = worst.as_flattened().iter().zip(bounds.as_flattened());
    assert!(all.all(|(worst, bound)| worst < bound), "{worst:?}");
}

#[test]
fn uneven_rays_can_be_reversed() {
    // Along z without an end, hills of the index can guide light for ever.
    let extent = Extent { min: -50.0, max: 50.0 };
    let flow = flow(extent, 1.0).with_index_perturbation(
        IndexPerturbation::new(grid(Degree::Three, 0.5, hills)).expect("positive"),
    );
    let mut dice = Dice(99);
    for _ in 0..200 {
        let (start, p) = dice.enter(&flow, extent);
        let there = flow.advance_from(&start, p, 1e-8).expect("a ray");
        let back = flow
            .virtual_point(there.virtual_point.half, there.position)
            .and_then(|start| flow.advance_from(&start, -there.wave_vector, 1e-8));
        let back = back.expect("the same ray");
        if steepness(&there) < 2e-2 || steepness(&back) < 2e-2 {
            continue;
        }
        assert!((back.position - place(&start)).length() < 1e-7);
        assert!((back.optical_path - there.optical_path).abs() < 1e-7);
        assert!((there.wave_vector.length() - there.virtual_point.index).abs() < 1e-10);
    }
}

#[test]
fn a_factor_must_be_positive() {
    assert!(IndexPerturbation::new(grid(Degree::Three, 1.0, |p| p.x)).is_none());
}
