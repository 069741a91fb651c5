//! An index given on a grid, against media whose rays are known in closed form.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use glam::{DVec2, DVec3};
use num_complex::Complex64;
use optics::geometry::Extent;
use optics::propagation::{
    Boundary, ConformalEnd, ConformalFlow, Degree, GridSpline, Half, IndexPerturbation,
};
use optics::transformation::{ConformalMap, FlatMap, Truncation};
use std::f64::consts::TAU;

/// Half the sides of the rectangle, cm.
const HALF: DVec2 = DVec2::new(8.0, 6.0);

/// The square of an index, on a grid from border to border with so many steps along x, in the
/// rectangle; it must be positive beyond the radius `core`.
fn flow(square: impl Fn(DVec2) -> f64, steps: usize, extent: Extent, core: f64) -> ConformalFlow {
    let count = [steps + 1, (steps as f64 * HALF.y / HALF.x).round() as usize + 1];
    let spacing = 2.0 * HALF / DVec2::new(count[0] as f64 - 1.0, count[1] as f64 - 1.0);
    let place =
        |k: usize| -HALF + spacing * DVec2::new((k % count[0]) as f64, (k / count[0]) as f64);
    let samples: Vec<f64> = (0..count[0] * count[1]).map(|k| square(place(k))).collect();
    let spline = GridSpline::new(Degree::Three, -HALF, spacing, count, &samples).unwrap();
    let cut = Truncation { x_min: -HALF.x, x_max: HALF.x, y_max: HALF.y };
    let map = ConformalMap::Flat(FlatMap::new(-HALF.y, 4.0));
    let index_perturbation = IndexPerturbation::within(spline, |[_, high]| high > core).unwrap();
    ConformalFlow::new(map, cut, extent, 1.0).with_index_perturbation(index_perturbation)
}

/// Numbers from 0 to 1 that fill a square evenly.
fn spread(k: u32) -> [f64; 3] {
    [0.618_033_988_7, 0.754_877_666_2, 0.569_840_290_9].map(|step| (step * f64::from(k)).fract())
}

/// A ray of a medium whose squared index is known: a point of the border, and a wave vector into
/// the medium.
fn enter(k: u32, square: impl Fn(DVec2) -> f64, steepest: f64) -> (DVec3, DVec3) {
    let [a, b, c] = spread(k);
    let y = HALF.y * (1.8 * a - 0.9);
    let at = DVec3::new(-HALF.x, y, 2.0 * b - 1.0);
    let (tilt, rise) = (1.4 * b - 0.7, steepest * (2.0 * c - 1.0));
    let d = DVec3::new(tilt.cos() * rise.cos(), tilt.sin() * rise.cos(), rise.sin());
    (at, d * square(at.truncate()).sqrt())
}

/// R of the oscillator n² = 2 - r²/R².
const RADIUS: f64 = 12.0;

fn oscillator(p: DVec2) -> f64 {
    2.0 - p.length_squared() / (RADIUS * RADIUS)
}

/// Where a ray of the oscillator is at τ, its wave vector, and its optical path.
fn swung(start: DVec3, p: DVec3, tau: f64) -> (DVec3, DVec3, f64) {
    let (sin, cos) = (tau / RADIUS).sin_cos();
    let (r, v) = (start.truncate(), p.truncate());
    let at = (r * cos + v * (RADIUS * sin)).extend(start.z + p.z * tau);
    let wave = (v * cos - r * (sin / RADIUS)).extend(p.z);
    let (mean, swing) = (
        0.5 * (r.length_squared() / RADIUS.powi(2) + v.length_squared()),
        (0.5 * (r.length_squared() / RADIUS.powi(2) - v.length_squared())),
    );
    let squares =
        mean * tau + swing * 0.5 * RADIUS * (2.0 * tau / RADIUS).sin() + r.dot(v) * sin * sin;
    (at, wave, 2.0 * tau - squares)
}

/// τ at which a function of the place first falls below 0.
fn first_fall(start: DVec3, p: DVec3, inside: impl Fn(DVec3) -> f64) -> f64 {
    let at = |tau: f64| inside(swung(start, p, tau).0);
    let step = 1e-3;
    let mut high = step;
    while at(high) >= 0.0 {
        high += step;
    }
    let mut low = high - step;
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if at(middle) < 0.0 { high = middle } else { low = middle }
    }
    high
}

fn check_swing(
    flow: &ConformalFlow,
    k: u32,
    inside: impl Fn(DVec3) -> f64,
) -> Option<ConformalEnd> {
    let (start, p) = enter(k, oscillator, 0.6);
    let entry = flow.virtual_point(Half::Upper, start).unwrap();
    let end = flow.advance_from(&entry, p, 1e-9).unwrap();
    let steep = end.wave_vector.normalize().dot(end.outward).abs();
    if steep < 0.05 {
        return None;
    }
    let (at, wave, path) = swung(start, p, first_fall(start, p, inside));
    assert!((end.position - at).length() < 1e-9, "{k}: {} {at}", end.position);
    assert!((end.wave_vector - wave).length() < 1e-9, "{k}: {} {wave}", end.wave_vector);
    assert!((end.optical_path - path).abs() < 1e-9, "{k}: {} {path}", end.optical_path);
    assert!((end.wave_vector.length() - end.virtual_point.index).abs() < 1e-12);
    Some(end)
}

fn in_rectangle(r: DVec3) -> f64 {
    (HALF.x - r.x.abs()).min(HALF.y - r.y.abs())
}

#[test]
fn rays_swing_where_the_squared_index_is_a_parabola() {
    // The spline keeps it as it is, on the coarsest grid too.
    for steps in [4, 23] {
        let flow = flow(oscillator, steps, Extent::ENDLESS, 0.0);
        let ends: Vec<_> = (0..300).filter_map(|k| check_swing(&flow, k, in_rectangle)).collect();
        for side in [Boundary::XMax, Boundary::YMax, Boundary::Floor] {
            assert!(ends.iter().filter(|end| end.surface == side).count() > 20, "{side:?}");
        }
        assert!(ends.iter().all(|end| end.outward.dot(end.wave_vector) > 0.0));
    }
}

#[test]
fn flat_ends_round_borders_and_round_cores_are_met_where_they_are() {
    let short = Extent { min: -1.5, max: 1.5 };
    let far = |r: DVec3| r.truncate().length();
    let (core, rim) = (2.5, 7.0);
    let cored = flow(oscillator, 16, short, 0.0).between(Some(core), None);
    let around = |r: DVec3| in_rectangle(r).min(1.5 - r.z.abs()).min(far(r) - core);
    let ends: Vec<_> = (0..300).filter_map(|k| check_swing(&cored, k, around)).collect();
    for side in [Boundary::Core, Boundary::XMax, Boundary::ZMin, Boundary::ZMax] {
        assert!(ends.iter().filter(|end| end.surface == side).count() > 10, "{side:?}");
    }
    for end in ends.iter().filter(|end| end.surface == Boundary::Core) {
        let p = end.position;
        assert!(
            (far(p) - core).abs() < 1e-14 && (end.outward + p.with_z(0.0) / core).length() < 1e-14
        );
        // Reflected, it goes on from there.
        let back = end.wave_vector - 2.0 * end.wave_vector.dot(end.outward) * end.outward;
        let on = cored.advance_from(&end.virtual_point, back, 1e-9).unwrap();
        // The index draws rays that are nearly along the core back to it.
        let steep = back.normalize().dot(end.outward).abs() > 0.4;
        assert!(!steep || on.surface != Boundary::Core);
    }
    // A disc: from point to point of its border.
    let cut = Truncation { x_min: -12.0, x_max: 12.0, y_max: 12.0 };
    let samples: Vec<f64> = (0..25)
        .map(|k| oscillator(DVec2::new(f64::from(k % 5), f64::from(k / 5)) * 4.0 - 8.0))
        .collect();
    let spline =
        GridSpline::new(Degree::Three, DVec2::splat(-8.0), DVec2::splat(4.0), [5, 5], &samples)
            .unwrap();
    let map = ConformalMap::Flat(FlatMap::new(-12.0, 4.0));
    let disc = ConformalFlow::new(map, cut, Extent::ENDLESS, 1.0)
        .between(None, Some(rim))
        .with_index_perturbation(IndexPerturbation::new(spline).unwrap());
    for k in 0..200 {
        let [a, b, c] = spread(k);
        let inward = DVec2::from_angle(TAU * a);
        let start = (-inward * rim).extend(0.0);
        let d = inward.rotate(DVec2::from_angle(1.3 * (2.0 * b - 1.0))).extend(c - 0.5).normalize();
        let p = d * oscillator(start.truncate()).sqrt();
        let entry = disc.virtual_point(Half::Upper, start).unwrap();
        let end = disc.advance_from(&entry, p, 1e-9).unwrap();
        // The first points are beyond by rounding.
        let tau = first_fall(start, p, |r| rim * (1.0 + 1e-13) - far(r));
        let (at, wave, path) = swung(start, p, tau);
        assert_eq!(end.surface, Boundary::Rim);
        assert!((end.position - at).length() < 1e-8 && (end.wave_vector - wave).length() < 1e-9);
        assert!((end.optical_path - path).abs() < 1e-8);
        assert!((end.outward - at.with_z(0.0) / rim).length() < 1e-9);
    }
    assert!(disc.virtual_point(Half::Upper, DVec3::new(6.0, 6.0, 0.0)).is_err());
    assert!(cored.virtual_point(Half::Upper, DVec3::new(1.0, 2.0, 0.0)).is_err());
}

#[test]
fn the_index_is_bounded_where_it_counts() {
    // Near the axis its square is negative.
    let (least, largest) =
        flow(|p| p.length_squared() - 1.0, 64, Extent::ENDLESS, 2.0).index_range();
    assert!(least > 1.2 && least < 3f64.sqrt(), "{least}");
    assert!((largest - 99f64.sqrt()).abs() < 0.01, "{largest}");
}

/// The radius of the cylinder that ζ = z + a²/z makes a strip of; the medium |ζ'| hides it.
const HIDDEN: f64 = 2.0;

/// ζ and ζ'.
fn unfolded(z: Complex64) -> [Complex64; 2] {
    let ratio = HIDDEN / z;
    [z + HIDDEN * ratio, 1.0 - ratio * ratio]
}

/// What is off at the end of a ray through the medium |ζ'|, whose rays across z are straight lines
/// in ζ: the line missed, the direction and the optical path.
fn off_the_line(flow: &ConformalFlow, k: u32) -> f64 {
    let complex = |v: DVec3| Complex64::new(v.x, v.y);
    let square = |p: DVec2| unfolded(Complex64::new(p.x, p.y))[1].norm_sqr();
    let (start, p) = enter(k, square, 0.0);
    let entry = flow.virtual_point(Half::Upper, start).unwrap();
    let end = flow.advance_from(&entry, p, 1e-11).unwrap();
    assert_ne!(end.surface, Boundary::Core);
    let [[from, bent], [to, bent_back]] = [start, end.position].map(|r| unfolded(complex(r)));
    // dζ = ζ' dz.
    let along = bent * complex(p);
    let along = along / along.norm();
    let way = (to - from) * along.conj();
    let direction = bent_back * complex(end.wave_vector) * along.conj();
    way.im.abs().max((end.optical_path - way.re).abs()).max(direction.arg().abs())
}

#[test]
fn the_error_of_a_grid_falls_with_the_fourth_power_of_its_spacing() {
    // Within the core the medium is singular: far from its border, any samples will do.
    let square = |p: DVec2| {
        let z = Complex64::new(p.x, p.y);
        let z = if z.norm() < 0.7 { Complex64::new(0.7, 0.0) } else { z };
        unfolded(z)[1].norm_sqr()
    };
    let worst = |steps: usize| {
        let core = 1.15 * HIDDEN;
        let flow = flow(square, steps, Extent::ENDLESS, core).between(Some(core), None);
        let clear = |k: &u32| {
            // Rays whose straight lines in ζ keep clear of the strip and of the ellipse that the
            // core becomes.
            let (start, p) = enter(*k, square, 0.0);
            let z = Complex64::new(start.x, start.y);
            let [from, bent] = unfolded(z);
            let along = bent * Complex64::new(p.x, p.y);
            (from * along.conj()).im.abs() / along.norm() > 4.0
        };
        let rays: Vec<u32> = (0..200).filter(clear).collect();
        assert!(rays.len() > 20, "{}", rays.len());
        rays.iter().map(|k| off_the_line(&flow, *k)).fold(0.0, f64::max)
    };
    let errors = [128, 256, 512].map(worst);
    let orders = [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
    assert!(errors[2] < 1e-6, "{errors:?}");
    assert!(orders.iter().all(|order| *order > 3.5), "{errors:?} {orders:?}");
}
