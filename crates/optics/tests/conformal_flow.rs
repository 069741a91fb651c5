//! The conformal flow against a slow integrator that knows nothing of virtual space, of the fast
//! Faddeeva function, or of the crate's inversion; and against itself.

use std::cell::Cell;
use std::f64::consts::FRAC_2_SQRT_PI;

use errorfunctions::ComplexErrorFunctions;
use glam::{DMat3, DVec3};
use num_complex::Complex64;
use optics::geometry::Extent;
use optics::propagation::reference::{ReferenceRay, SquaredIndex, follow};
use optics::propagation::{Boundary, ConformalFlow, FlowEnd, FlowError, Foothold, Half};
use optics::transformation::{GaussianMap, Truncation};

const W: f64 = 10.02;
const H: f64 = 4.25;
const CUT: Truncation = Truncation { x_min: -25.0, x_max: 25.0, y_max: 28.57 };

fn flow(extent: Extent, strength: f64) -> ConformalFlow {
    let map = GaussianMap::new(W, H).expect("a valid map");
    ConformalFlow::new(map.into(), CUT, extent, strength)
}

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

/// The end of a ray by the reference integrator, extrapolated from two step sizes.
fn reference(start: &Foothold, wave_vector: DVec3, extent: Extent, c: f64) -> Option<ReferenceRay> {
    let field = wave_vector.normalize().any_orthonormal_vector();
    let ray = ReferenceRay {
        position: start.position,
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
        SquaredIndex { value, gradient: 2.0 * value * DVec3::new(g.re, side * g.im, 0.0) }
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

/// Numbers from 0 to 1, always the same (xorshift).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.roll()
    }

    /// A start on one of the faces or on the floor, and a wave vector that goes inwards from there.
    fn enter(&mut self, flow: &ConformalFlow, extent: Extent) -> (Foothold, DVec3) {
        let half = if self.roll() < 0.5 { Half::Upper } else { Half::Lower };
        let side = if half == Half::Upper { 1.0 } else { -1.0 };
        let (mut x, mut z) = (self.between(CUT.x_min, CUT.x_max), self.between(-8.0, 8.0));
        let share = self.roll();
        let faces = if extent == Extent::ENDLESS { 4.0 } else { 6.0 };
        let face = (faces * self.roll()) as u32;
        match face {
            0 => x = CUT.x_min,
            1 => x = CUT.x_max,
            4 => z = extent.min,
            5 => z = extent.max,
            _ => {}
        }
        let low = flow.map().floor_height_at(x);
        let y = match face {
            2 => CUT.y_max,
            3 => low,
            _ => low + share * (CUT.y_max - low),
        };
        let start = flow.foothold(half, DVec3::new(x, side * y, z)).expect("a point of the border");
        let slope = flow.map().jet(start.virtual_position).f1;
        let inward = match face {
            0 => DVec3::X,
            1 => DVec3::NEG_X,
            2 => DVec3::new(0.0, -side, 0.0),
            3 => DVec3::new(-slope.im, side * slope.re, 0.0).normalize(),
            4 => DVec3::Z,
            _ => DVec3::NEG_Z,
        };
        let (u, v) = inward.any_orthonormal_pair();
        let (angle, sine) = (self.between(0.0, 6.3), self.roll().sqrt());
        let tilt = u * angle.cos() + v * angle.sin();
        let mut direction = inward * (1.0 - sine * sine).sqrt() + sine * tilt;
        if self.roll() < 0.15 && face < 4 {
            direction.z = 0.0;
        }
        (start, start.index * direction.normalize())
    }
}

/// The legs of a ray from mirror to mirror until it leaves.
fn legs(
    flow: &ConformalFlow,
    (start, wave_vector): (Foothold, DVec3),
    tolerance: f64,
) -> Vec<(Foothold, DVec3, FlowEnd)> {
    let (mut at, mut p, mut legs) = (start, wave_vector, Vec::new());
    for _ in 0..4 {
        let end = flow.advance_from(&at, p, tolerance).expect("the ray gets through");
        legs.push((at, p, end));
        if end.boundary != Boundary::Floor {
            break;
        }
        at = end.at;
        p = end.wave_vector - 2.0 * end.wave_vector.dot(end.normal) * end.normal;
    }
    legs
}

/// The sine of the angle between a ray and the face it arrives at.
fn steepness(end: &FlowEnd) -> f64 {
    end.wave_vector.normalize().dot(end.normal)
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
            let (error, coarse) = ((end.at.position - exact.position).length(), {
                let coarse = flow.advance_from(&start, p, 1e-6).expect("the same ray");
                (coarse.at.position - exact.position).length()
            });
            assert!(error < 1e-8 && coarse < 1e-6, "{error:e} {coarse:e} {place}");
            assert!((end.optical_path - exact.optical_path).abs() < 1e-8, "{place}");
            let turned = end.wave_vector.normalize() - exact.wave_vector.normalize();
            assert!(turned.length() < 1e-9, "{:e} {place}", turned.length());
            let field = end.transport * p.normalize().any_orthonormal_vector();
            assert!((field - exact.electric_field).length() < 1e-8, "{place}");
            floors += u32::from(end.boundary == Boundary::Floor);
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
            let error = (fast.at.position - exact.at.position)
                .length()
                .max((fast.optical_path - exact.optical_path).abs())
                .max(10.0 * turned);
            count += 1;
            late += u32::from(error > tolerance || fast.boundary != exact.boundary);
            worst = worst.max(error);
        }
        assert!(
            f64::from(late) <= 1e-3 * f64::from(count),
            "{late} of {count} at {tolerance:e}, worst {worst:e}"
        );
    }
}

#[test]
fn ends_on_the_border_and_on_shell_with_a_rotation() {
    let short = Extent { min: -10.0, max: 10.0 };
    let flow = flow(short, 1.0);
    let mut dice = Dice(77);
    for _ in 0..2000 {
        for (start, p, end) in legs(&flow, dice.enter(&flow, short), 1e-6) {
            let Foothold { position, index, virtual_position, .. } = end.at;
            let n = flow.index(position).expect("a point of the medium");
            assert!((end.wave_vector.length() - index).abs() < 2e-15 * index);
            assert!((n - index).abs() < 1e-12);
            assert!(
                end.wave_vector.dot(end.normal) >= -1e-12
                    && (end.normal.length() - 1.0).abs() < 1e-14
            );
            assert!((end.wave_vector.z - p.z).abs() < 1e-15);
            let limit = match end.boundary {
                Boundary::XMin => position.x - CUT.x_min,
                Boundary::XMax => position.x - CUT.x_max,
                Boundary::YMax => position.y.abs() - CUT.y_max,
                Boundary::ZMin => position.z - short.min,
                Boundary::ZMax => position.z - short.max,
                Boundary::Floor => position.y.abs() - flow.map().floor_height_at(position.x),
            };
            assert!(limit.abs() < 1e-13, "{limit:e} {end:?}");
            let image = flow.map().jet(virtual_position).f;
            assert!((image.re - position.x).hypot(image.im - position.y.abs()) < 2e-13);
            let straightness = end.transport * end.transport.transpose() - DMat3::IDENTITY;
            assert!(straightness.to_cols_array().iter().all(|e| e.abs() < 1e-14));
            assert!((end.transport.determinant() - 1.0).abs() < 1e-14);
            let carried = end.transport * p / start.index - end.wave_vector / index;
            assert!(carried.length() < 1e-8, "{}", carried.length());
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
        let back = flow.advance(there.at.half, there.at.position, -there.wave_vector, 1e-10);
        let back = back.expect("the same ray");
        if steepness(&there) < 1e-2 || steepness(&back) < 1e-2 {
            continue;
        }
        assert!((back.at.position - start.position).length() < 1e-8);
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
        let start = flow.foothold(half, DVec3::new(-25.0, side, 0.0)).expect("above the tip");
        let end = flow.advance_from(&start, start.index * DVec3::X, 1e-6).expect("a ray");
        let delay = (end.optical_path - 50.0) / 29.979_245_8;
        assert!(end.boundary == Boundary::XMax && (delay - 0.068).abs() < 1e-3, "{delay} {end:?}");
    }
}

#[test]
fn starts_on_the_border_go_on_or_end_at_once() {
    let flow = flow(Extent::ENDLESS, 1.0);
    let at =
        |x, y| flow.foothold(Half::Upper, DVec3::new(x, y, 0.0)).expect("a point of the border");
    let top = at(3.0, CUT.y_max);
    let go = |start: &Foothold, direction: DVec3| {
        flow.advance_from(start, start.index * direction.normalize(), 1e-6).expect("a ray")
    };
    assert_eq!(go(&top, DVec3::new(0.1, 1.0, 0.2)).optical_path, 0.0);
    assert_eq!(go(&top, DVec3::new(0.1, 1.0, 0.2)).boundary, Boundary::YMax);
    assert!(go(&top, DVec3::new(0.1, -1.0, 0.2)).optical_path > 1.0);
    assert_eq!(go(&at(25.0, 3.0), DVec3::new(1e-3, 1.0, 0.0)).optical_path, 0.0);
    assert!(go(&at(25.0, 3.0), DVec3::new(-1e-3, 1.0, 0.0)).optical_path > 1e-3);
    let floor = at(2.0, flow.map().floor_height_at(2.0));
    assert_eq!(floor.virtual_position.im, 0.0);
    assert_eq!(go(&floor, DVec3::NEG_Y).boundary, Boundary::Floor);
    assert_eq!(go(&floor, DVec3::Y).boundary, Boundary::YMax);
    // Corners, and the middle line at the tip, where both halves meet.
    assert_eq!(go(&at(-25.0, CUT.y_max), DVec3::new(1.0, -1.0, 0.0)).boundary, Boundary::Floor);
    let tip = at(25.0, flow.map().floor_height_at(25.0));
    assert!(go(&tip, DVec3::new(-1.0, 0.3, 0.1)).optical_path > 10.0);
}

#[test]
fn refuses_what_it_cannot_follow() {
    let flow = flow(Extent::ENDLESS, 1.0);
    let start = DVec3::new(-25.0, 3.0, 0.0);
    let go = |position, p| flow.advance(Half::Upper, position, p, 1e-6);
    assert_eq!(go(DVec3::NAN, DVec3::X), Err(FlowError::NotFinite));
    assert_eq!(go(start, DVec3::INFINITY), Err(FlowError::NotFinite));
    assert_eq!(go(DVec3::new(-25.1, 3.0, 0.0), DVec3::X), Err(FlowError::Outside));
    assert_eq!(go(DVec3::new(0.0, 4.0, 0.0), DVec3::X), Err(FlowError::Outside));
    assert_eq!(flow.advance(Half::Lower, start, DVec3::X, 1e-6), Err(FlowError::Outside));
    assert!(matches!(go(start, 1.01 * DVec3::X), Err(FlowError::WaveVector { .. })));
    // Along z: bent away from the axis, it comes out; odd tolerances are made sensible.
    let n = flow.index(start).expect("a point of the medium");
    for tolerance in [1e-6, 0.0, f64::NAN, 1e9] {
        assert!(flow.advance(Half::Upper, start, n * DVec3::Z, tolerance).is_ok());
    }
}
