//! The conformal flow against a slow integrator that knows nothing of virtual space, of the fast
//! Faddeeva function, or of the crate's inversion; and against itself.

mod border;
pub mod rays;
mod uneven;

use std::cell::Cell;
use std::f64::consts::FRAC_2_SQRT_PI;

use errorfunctions::ComplexErrorFunctions;
use glam::{DMat3, DVec2, DVec3};
use num_complex::Complex64;
use optics::geometry::Extent;
use optics::propagation::reference::{ReferenceRay, SquaredIndex, follow};
use optics::propagation::{Boundary, ConformalFlow, Half, VirtualPoint};
use optics::transformation::{ConformalMap, GaussianMap, Truncation};

use self::rays::{CUT, Dice, H, W, flow, legs, steepness, turn};

/// f', f'' and ζ at a physical point of the upper half, from an independent Faddeeva function.
fn independent_map(z: Complex64, guess: Complex64) -> (Complex64, Complex64, Complex64) {
    let mut zeta = guess;
    for _ in 0..50 {
        let t = zeta / W;
        let w = t.w();
        let w1 = Complex64::new(0.0, FRAC_2_SQRT_PI) - 2.0 * t * w;
        let f1 = 1.0 + Complex64::i() * H / W * w1;
        let step = (z - zeta - Complex64::i() * H * w) / f1;
        zeta += step;
        if step.norm() < 1e-8 {
            let t = zeta / W;
            let w = t.w();
            let w1 = Complex64::new(0.0, FRAC_2_SQRT_PI) - 2.0 * t * w;
            let w2 = -2.0 * (w + t * w1);
            let factor = Complex64::i() * H / W;
            return (1.0 + factor * w1, factor * w2 / W, zeta);
        }
    }
    panic!("no inverse of {z} from {guess}")
}

/// Where a point of the medium is.
fn place(point: &VirtualPoint) -> DVec3 {
    let at = flow(Extent::ENDLESS, 1.0).map().jet(point.virtual_position).f;
    point.half.mirrored(DVec3::new(at.re, at.im, point.z))
}

/// The end of a ray by the reference integrator, extrapolated from two step sizes.
fn reference(
    start: &VirtualPoint,
    wave_vector: DVec3,
    extent: Extent,
    c: f64,
) -> Option<ReferenceRay> {
    uneven_reference(start, wave_vector, extent, c, |_| (1.0, DVec2::ZERO))
}

/// The same in an index that is uneven by a factor: its square and the gradient of that, in the
/// upper half or in the mirror image of the lower one.
fn uneven_reference(
    start: &VirtualPoint,
    wave_vector: DVec3,
    extent: Extent,
    c: f64,
    factor: impl Fn(DVec2) -> (f64, DVec2),
) -> Option<ReferenceRay> {
    let field = wave_vector.normalize().any_orthonormal_vector();
    let ray = ReferenceRay {
        position: place(start),
        wave_vector,
        electric_field: field,
        optical_path: 0.0,
    };
    let side = if start.half == Half::Upper { 1.0 } else { -1.0 };
    let nearby = Cell::new(start.virtual_position);
    let locate = |r: DVec3| {
        let found = independent_map(Complex64::new(r.x, side * r.y), nearby.get());
        nearby.set(found.2);
        found
    };
    let medium = |r: DVec3| {
        let (f1, f2, _) = locate(r);
        let value = c * c / f1.norm_sqr();
        // ∇ ln n = -conj(f''/f') in virtual space, over conj(f') in physical space.
        let g = -(f2 / f1).conj() / f1.conj();
        let (square, uphill) = factor(DVec2::new(r.x, side * r.y));
        let gradient = 2.0 * value * square * DVec2::new(g.re, g.im) + value * uphill;
        SquaredIndex {
            value: value * square,
            gradient: DVec3::new(gradient.x, side * gradient.y, 0.0),
        }
    };
    let inside = |r: DVec3| {
        [r.x - CUT.x_min, CUT.x_max - r.x, CUT.y_max - side * r.y]
            .into_iter()
            .chain([r.z - extent.min, extent.max - r.z, locate(r).2.im])
            .fold(f64::INFINITY, f64::min)
    };
    let [coarse, fine] = [0.03, 0.015].map(|step| follow(ray, step / c, 16000, medium, inside));
    let (coarse, fine) = (coarse?, fine?);
    let better = |coarse: DVec3, fine: DVec3| fine + (fine - coarse) / 15.0;
    Some(ReferenceRay {
        position: better(coarse.position, fine.position),
        wave_vector: better(coarse.wave_vector, fine.wave_vector),
        electric_field: better(coarse.electric_field, fine.electric_field),
        optical_path: fine.optical_path + (fine.optical_path - coarse.optical_path) / 15.0,
    })
}

#[test]
fn agrees_with_the_physical_ray_equation() {
    let short = Extent { min: -10.0, max: 10.0 };
    let mut dice = Dice(0x1234_5678_9abc_def1);
    let (mut floors, mut compared) = (0, 0);
    for k in 0..330 {
        let (extent, c) = [(Extent::ENDLESS, 1.0), (short, 1.0), (short, 1.1456)][k % 3];
        let flow = flow(extent, c);
        for (start, p, end) in legs(&flow, dice.enter(&flow, extent), 1e-8) {
            if steepness(&end) < 0.02 {
                continue;
            }
            let Some(exact) = reference(&start, p, extent, c) else { panic!("{start:?} {p}") };
            let place = format!("from {start:?} along {p}: {end:?} against {exact:?}");
            let (error, coarse) = ((end.position - exact.position).length(), {
                let coarse = flow.advance_from(&start, p, 1e-6).expect("the same ray");
                (coarse.position - exact.position).length()
            });
            assert!(error < 1e-8 && coarse < 1e-6, "{error:e} {coarse:e} {place}");
            assert!((end.optical_path - exact.optical_path).abs() < 1e-8, "{place}");
            let turned = end.wave_vector.normalize() - exact.wave_vector.normalize();
            assert!(turned.length() < 1e-9, "{:e} {place}", turned.length());
            let field = turn(&start, &end) * p.normalize().any_orthonormal_vector();
            assert!((field - exact.electric_field).length() < 1e-8, "{place}");
            floors += u32::from(end.surface == Boundary::Floor);
            compared += 1;
        }
    }
    assert!(compared > 330 && floors > 50, "{compared} {floors}");
}

#[test]
fn keeps_its_contract_of_accuracy() {
    let flow = flow(Extent::ENDLESS, 1.0);
    for tolerance in [1e-6, 1e-8] {
        let mut dice = Dice(0x0bad_cafe_0bad_cafe);
        let (mut count, mut late, mut worst) = (0_u32, 0_u32, 0.0_f64);
        for _ in 0..10_000 {
            let entry = dice.enter(&flow, Extent::ENDLESS);
            let [fast, exact] =
                [tolerance, 1e-12].map(|t| flow.advance_from(&entry.0, entry.1, t).expect("a ray"));
            if steepness(&exact) < 1e-2 {
                continue;
            }
            let turned = (fast.wave_vector.normalize() - exact.wave_vector.normalize()).length();
            let error = (fast.position - exact.position)
                .length()
                .max((fast.optical_path - exact.optical_path).abs())
                .max(10.0 * turned);
            count += 1;
            late += u32::from(error > tolerance || fast.surface != exact.surface);
            worst = worst.max(error);
        }
        assert!(
            f64::from(late) <= 1e-3 * f64::from(count),
            "{late} of {count} at {tolerance:e}, worst {worst:e}"
        );
    }
}

#[test]
fn follows_rays_through_other_cloaks() {
    let mut dice = Dice(31);
    for _ in 0..200 {
        let w = dice.between(0.1, 30.0);
        let map = GaussianMap::new(w, w * dice.between(0.01, 0.88)).expect("a valid map");
        let cut = Truncation::centred(
            w * dice.between(1.0, 8.0),
            map.height + w * dice.between(0.2, 4.0),
        );
        let extent = Extent::centred(Some(w * dice.between(0.5, 20.0)));
        let flow = ConformalFlow::new(ConformalMap::Gaussian(map), cut, extent, 1.0);
        for _ in 0..20 {
            let x = dice.between(cut.x_min, cut.x_max);
            let y = dice.between(flow.map().floor_height_at(x), cut.y_max);
            let z = dice.between(extent.min, extent.max);
            let start = flow.virtual_point(Half::Upper, DVec3::new(x, y, z)).expect("inside");
            let [a, b, c] = [(); 3].map(|()| dice.between(-1.0, 1.0));
            let p = start.index * DVec3::new(a, b, c).normalize();
            let [fast, exact] =
                [1e-6, 1e-11].map(|t| flow.advance_from(&start, p, t).expect("a ray"));
            if steepness(&exact) > 0.05 && fast.surface == exact.surface {
                let error = (fast.position - exact.position).length();
                assert!(error < 1e-5, "{error:e} {flow:?} {start:?} {p}");
            } else {
                // Only at an edge may the two disagree about the face.
                let apart = (fast.position - exact.position).length();
                assert!(fast.surface == exact.surface || apart < 1e-4, "{fast:?} {exact:?}");
            }
        }
    }
}

#[test]
fn can_be_reversed() {
    let flow = flow(Extent::ENDLESS, 1.0);
    let mut dice = Dice(4711);
    for _ in 0..1000 {
        let (start, p) = dice.enter(&flow, Extent::ENDLESS);
        let there = flow.advance_from(&start, p, 1e-10).expect("a ray");
        let back = flow
            .virtual_point(there.virtual_point.half, there.position)
            .and_then(|start| flow.advance_from(&start, -there.wave_vector, 1e-10));
        let back = back.expect("the same ray");
        if steepness(&there) < 1e-2 || steepness(&back) < 1e-2 {
            continue;
        }
        assert!((back.position - place(&start)).length() < 1e-8);
        assert!((back.wave_vector + p).length() < 1e-9);
        assert!((back.optical_path - there.optical_path).abs() < 1e-8);
        let there_and_back = back.transport * there.transport - DMat3::IDENTITY;
        assert!(there_and_back.to_cols_array().iter().all(|e| e.abs() < 1e-7));
    }
}

#[test]
fn delays_light_on_the_axis_by_68_picoseconds() {
    let flow = flow(Extent::ENDLESS, 1.0);
    for half in [Half::Upper, Half::Lower] {
        let side = if half == Half::Upper { 1.0 } else { -1.0 };
        let start = flow.virtual_point(half, DVec3::new(-25.0, side, 0.0)).expect("above the tip");
        let end = flow.advance_from(&start, start.index * DVec3::X, 1e-6).expect("a ray");
        let delay = (end.optical_path - 50.0) / 29.979_245_8;
        assert!(end.surface == Boundary::XMax && (delay - 0.068).abs() < 1e-3, "{delay} {end:?}");
    }
}
