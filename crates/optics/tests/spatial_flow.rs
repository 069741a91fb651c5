//! Rays through media on a grid in space, against a slow integrator of Hamilton's equations that
//! knows the permittivity tensor and nothing else.

use glam::{DMat3, DVec3};
use optics::geometry::{FlatOrRound, Plane, Sphere};
use optics::medium::{Medium, ModeKind};
use optics::propagation::reference::{self, ReferenceRay};
use optics::propagation::{
    Anisotropy, AxisField, Extraordinary, PathEnd, SpaceSpline, SpatialBorder, SpatialFlow,
    SpatialMedium, SpatialRay, SquaredIndex,
};
use std::array::from_fn;

const HALF: DVec3 = DVec3::new(6.0, 5.0, 4.0);
const COUNT: [usize; 3] = [15, 13, 11];

fn spline<const C: usize>(function: impl Fn(DVec3) -> [f64; C]) -> SpaceSpline<C> {
    let spacing = 2.0 * HALF / DVec3::from_array(COUNT.map(|count| count as f64 - 1.0));
    let mut samples = Vec::new();
    for i in 0..COUNT[0] {
        for j in 0..COUNT[1] {
            for k in 0..COUNT[2] {
                samples.push(function(DVec3::new(i as f64, j as f64, k as f64) * spacing - HALF));
            }
        }
    }
    SpaceSpline::new(-HALF, spacing, COUNT, &samples).expect("a spline")
}

fn planes() -> Vec<SpatialBorder> {
    let side = |side: usize| Plane {
        normal: [-1.0, 1.0][side % 2] * DVec3::AXES[side / 2],
        offset: HALF[side / 2],
    };
    (0..6).map(|i| SpatialBorder::FlatOrRound(side(i).into())).collect()
}

fn square(at: DVec3) -> [f64; 1] {
    [2.4 + 0.5 * (0.5 * at.x).sin() * (0.4 * at.y + 0.3).cos()
        + 0.3 * (0.6 * at.z - 0.2 * at.x).sin()]
}

fn isotropic() -> SpatialFlow {
    SpatialFlow::new(SpatialMedium { square: spline(square), anisotropy: None }, planes(), 12.0)
}

/// A liquid crystal that twists and splays.
fn twisted(along: impl Fn(DVec3) -> f64) -> SpatialFlow {
    let axis = |at: DVec3| {
        let (turn, tilt) = (0.2 * at.x + 0.03 * at.x * at.x + 0.1 * at.z, 0.3 + 0.08 * at.y);
        [turn.cos() * tilt.cos(), turn.sin() * tilt.cos(), tilt.sin()]
    };
    let anisotropy = Anisotropy {
        extraordinary: Extraordinary::Square(spline(|at| [along(at)])),
        axis: AxisField::Spline(spline(axis)),
    };
    let medium = SpatialMedium { square: spline(square), anisotropy: Some(anisotropy) };
    SpatialFlow::new(medium, planes(), 12.0)
}

fn birefringent() -> SpatialFlow {
    twisted(|at| square(at)[0] * (1.3 + 0.1 * (0.4 * at.y).sin()))
}

/// The permittivity across and along the axis, and the axis, as the splines say.
fn permittivity(flow: &SpatialFlow, at: DVec3) -> (f64, f64, DVec3) {
    let across = flow.medium().square.look(at).value[0];
    let Some(Anisotropy { extraordinary, axis }) = &flow.medium().anisotropy else {
        return (across, across, DVec3::X);
    };
    let along = match extraordinary {
        Extraordinary::Ratio(ratio) => ratio * across,
        Extraordinary::Square(spline) => spline.look(at).value[0],
    };
    let axis = match axis {
        AxisField::Constant(axis) => *axis,
        AxisField::Spline(spline) => DVec3::from_array(spline.look(at).value).normalize(),
    };
    (across, along, axis)
}

/// p·εp - ε_o ε_e, or p² - ε_o, over twice the size.
fn hamiltonian(flow: &SpatialFlow, mode: ModeKind, at: DVec3, p: DVec3) -> f64 {
    let (across, along, axis) = permittivity(flow, at);
    if mode != ModeKind::Extraordinary {
        return 0.5 * (p.length_squared() - across);
    }
    let dyad = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    let tensor = DMat3::from_diagonal(DVec3::splat(across)) + dyad * (along - across);
    0.5 * (p.dot(tensor * p) / across - along)
}

/// By differences of fourth order.
fn slope(function: impl Fn(f64) -> f64) -> f64 {
    const H: f64 = 2e-3;
    (8.0 * (function(H) - function(-H)) - (function(2.0 * H) - function(-2.0 * H))) / (12.0 * H)
}

/// The classical method of order 4, until the ray leaves the box: place, wave vector and optical
/// path.
fn slowly(flow: &SpatialFlow, ray: &SpatialRay, h: f64) -> [f64; 7] {
    let rates = |y: &[f64; 7]| -> [f64; 7] {
        let (r, p) = (DVec3::new(y[0], y[1], y[2]), DVec3::new(y[3], y[4], y[5]));
        let along = |axis: usize| {
            let e = DVec3::AXES[axis];
            [
                slope(|h| hamiltonian(flow, ray.mode, r, p + e * h)),
                -slope(|h| hamiltonian(flow, ray.mode, r + e * h, p)),
            ]
        };
        let [x, y, z] = [0, 1, 2].map(along);
        let path = p.dot(DVec3::new(x[0], y[0], z[0]));
        [x[0], y[0], z[0], x[1], y[1], z[1], path]
    };
    let take = |y: &[f64; 7], h: f64| -> [f64; 7] {
        let moved = |k: &[f64; 7], h: f64| from_fn(|i| y[i] + h * k[i]);
        let a = rates(y);
        let b = rates(&moved(&a, 0.5 * h));
        let c = rates(&moved(&b, 0.5 * h));
        let d = rates(&moved(&c, h));
        from_fn(|i| y[i] + h * (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0)
    };
    let height = |y: &[f64; 7]| (DVec3::new(y[0], y[1], y[2]).abs() - HALF).max_element();
    let (r, p) = (ray.position, ray.wave_vector);
    let mut state = [r.x, r.y, r.z, p.x, p.y, p.z, 0.0];
    loop {
        let next = take(&state, h);
        if height(&next) < 0.0 {
            state = next;
            continue;
        }
        let (mut low, mut high) = (0.0, h);
        while high - low > 1e-14 * h {
            let middle = 0.5 * (low + high);
            if height(&take(&state, middle)) < 0.0 { low = middle } else { high = middle }
        }
        return take(&state, high);
    }
}

/// Rays from points inside, in any direction.
fn rays(flow: &SpatialFlow, mode: ModeKind, count: u32) -> impl Iterator<Item = SpatialRay> {
    (0..count).map(move |k| {
        let part = |turns: f64| 2.0 * (turns * f64::from(k + 1)).fract() - 1.0;
        let position = HALF * DVec3::new(part(0.618), part(0.414), part(0.732)) * 0.9;
        let direction = DVec3::new(part(0.271), part(0.177), part(0.913)).normalize();
        let p = direction * 1.5;
        // The Hamiltonian is a form of second order in p, less a constant.
        let constant = hamiltonian(flow, mode, position, DVec3::ZERO);
        let form = hamiltonian(flow, mode, position, p) - constant;
        SpatialRay { position, wave_vector: p * (-constant / form).sqrt(), mode }
    })
}

fn end(flow: &SpatialFlow, ray: &SpatialRay) -> PathEnd<u16> {
    flow.advance(ray, 1e-10).expect("it comes out")
}

#[test]
fn rays_are_those_of_a_slow_integrator() {
    let (one, two) = (isotropic(), birefringent());
    let modes =
        [(&one, ModeKind::Shared), (&two, ModeKind::Ordinary), (&two, ModeKind::Extraordinary)];
    for (flow, mode) in modes {
        for ray in rays(flow, mode, 12) {
            let found = end(flow, &ray);
            let [x, y, z, px, py, pz, path] = slowly(flow, &ray, 0.01);
            let off = [
                (found.position - DVec3::new(x, y, z)).length(),
                (found.wave_vector - DVec3::new(px, py, pz)).length(),
                (found.optical_path - path).abs(),
            ];
            assert!(off.iter().all(|off| *off < 1e-8), "{mode:?} {ray:?} {off:?}");
        }
    }
}

#[test]
fn the_hamiltonian_is_kept_and_the_way_back_is_the_way() {
    let (one, two) = (isotropic(), birefringent());
    let modes =
        [(&one, ModeKind::Shared), (&two, ModeKind::Ordinary), (&two, ModeKind::Extraordinary)];
    for (flow, mode) in modes {
        for ray in rays(flow, mode, 40) {
            let found = end(flow, &ray);
            let kept = hamiltonian(flow, mode, found.position, found.wave_vector);
            assert!(kept.abs() < 1e-13, "{kept}");
            let back =
                SpatialRay { position: found.position, wave_vector: -found.wave_vector, mode };
            let first = end(flow, &back);
            let again = end(
                flow,
                &SpatialRay { position: first.position, wave_vector: -first.wave_vector, mode },
            );
            let off = (again.position - found.position).length()
                + (again.wave_vector - found.wave_vector).length()
                + (again.optical_path - first.optical_path).abs();
            assert!(off < 1e-9, "{mode:?} {ray:?} {off}");
        }
    }
}

#[test]
fn fields_are_those_of_the_local_waves_or_carried_parallel() {
    let flow = birefringent();
    for mode in [ModeKind::Ordinary, ModeKind::Extraordinary] {
        for ray in rays(&flow, mode, 20) {
            let found = end(&flow, &ray);
            let field = |at: DVec3, p: DVec3| {
                let (across, along, axis) = permittivity(&flow, at);
                let u = p.cross(axis).normalize();
                // D of the extraordinary wave is across p, in the plane of the axis.
                let d = p.cross(u);
                let tensor =
                    |v: DVec3| v / across + axis * (axis.dot(v) * (1.0 / along - 1.0 / across));
                let field = if mode == ModeKind::Extraordinary { tensor(d) } else { u };
                let medium = Medium::uniaxial_electric(1.0, across, along, axis).expect("a medium");
                field / medium.poynting(p, field.into()).length().sqrt()
            };
            let start = field(ray.position, ray.wave_vector);
            let expected = field(found.position, found.wave_vector);
            let carried = found.transport * start;
            let off = (carried - expected).length().min((carried + expected).length());
            assert!(off < 1e-12, "{mode:?} {carried} {expected}");
        }
    }
    let flow = isotropic();
    for ray in rays(&flow, ModeKind::Shared, 12) {
        let field = ray.wave_vector.normalize().any_orthonormal_vector();
        let medium = |at| {
            let look = flow.medium().square.look(at);
            SquaredIndex { value: look.value[0], gradient: look.gradient[0] }
        };
        let start = ReferenceRay {
            position: ray.position,
            wave_vector: ray.wave_vector,
            electric_field: field,
            optical_path: 0.0,
        };
        let inside = |at: DVec3| (HALF - at.abs()).min_element();
        let slow = reference::follow(start, 2e-3, 100_000, medium, inside).expect("it arrives");
        let found = end(&flow, &ray);
        let size = (medium(ray.position).value / medium(found.position).value).powf(0.25);
        let carried = found.transport * field;
        assert!((carried - slow.electric_field * size).length() < 1e-8, "{ray:?}");
        assert!((slow.position - found.position).length() < 1e-8);
        assert!((slow.optical_path - found.optical_path).abs() < 1e-8);
    }
}

#[test]
fn a_twist_that_starts_along_the_ray_parts_the_waves() {
    // The axis turns from z towards x, and then about z: the waves part in the plane in which it
    // sets out.
    let axis = |at: DVec3| {
        let (tilt, turn) = (0.1 * (at.z + HALF.z), 0.3 * (at.z + HALF.z));
        [tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), tilt.cos()]
    };
    let anisotropy = Anisotropy {
        extraordinary: Extraordinary::Ratio(1.2),
        axis: AxisField::Spline(spline(axis)),
    };
    let medium = SpatialMedium { square: spline(|_| [2.25]), anisotropy: Some(anisotropy) };
    let flow = SpatialFlow::new(medium, planes(), 12.0);
    let start = DVec3::new(0.0, 0.0, -HALF.z);
    let [(_, ordinary), (_, extraordinary)] =
        flow.parted(start, DVec3::Z * 1.5).expect("they part");
    // The axis sets out along x, but for what the spline is off.
    let Some(Anisotropy { axis: AxisField::Spline(spline), .. }) = &flow.medium().anisotropy else {
        panic!("a field of axes")
    };
    let slope = DVec3::from_array(spline.look(start).gradient.map(|gradient| gradient.z));
    assert!((slope - 0.1 * DVec3::X).length() < 5e-3, "{slope}");
    let across = slope.with_z(0.0);
    assert!(ordinary.dot(across).abs() < 1e-12 && extraordinary.cross(across).length() < 1e-12);
    let ray = SpatialRay { position: start, wave_vector: DVec3::Z * 1.5, mode: ModeKind::Ordinary };
    let found = end(&flow, &ray);
    assert!((found.position - DVec3::new(0.0, 0.0, HALF.z)).length() < 1e-12);
    assert!((found.optical_path - 3.0 * HALF.z).abs() < 1e-9);
    // By 2.4 radians about z, with the axis.
    let carried = found.transport * ordinary.normalize();
    let (_, _, axis) = permittivity(&flow, found.position);
    assert!(carried.dot(axis).abs() < 1e-12 && carried.z.abs() < 1e-12);
    assert!(carried.dot(ordinary) < 0.0);
}

#[test]
fn a_pulse_takes_no_less_than_causality_allows() {
    // n = 1.5 below z = 0 and far below 1 above it, over a smooth slope: ∫ max(n, 1/n) ds.
    let index = |z: f64| 1.1 - 0.4 * (0.5 * z).tanh();
    let medium = SpatialMedium { square: spline(|at| [index(at.z).powi(2)]), anisotropy: None };
    let flow = SpatialFlow::new(medium, planes(), 12.0);
    let start = DVec3::new(0.3, 0.1, -HALF.z);
    let n = |z: f64| flow.medium().square.look(start.with_z(z)).value[0].sqrt();
    let steps = 400_000;
    let sum: f64 = (0..steps)
        .map(|k| n(-HALF.z + 2.0 * HALF.z * (f64::from(k) + 0.5) / f64::from(steps)))
        .map(|n| n.max(n.recip()))
        .sum();
    let expected = sum * 2.0 * HALF.z / f64::from(steps);
    let ray =
        SpatialRay { position: start, wave_vector: DVec3::Z * n(start.z), mode: ModeKind::Shared };
    let found = flow.causal_group_path(&ray, 1e-9).expect("it comes out");
    assert!((found - expected).abs() < 1e-8, "{found} {expected}");
}

#[test]
fn round_borders_are_met() {
    // A straight way through a ball and through a tube.
    let medium = SpatialMedium { square: spline(|_| [1.44]), anisotropy: None };
    let sphere = FlatOrRound::from(Sphere { radius: 3.0 });
    for (border, expected) in [
        (SpatialBorder::FlatOrRound(sphere), DVec3::new(8f64.sqrt(), 1.0, 0.0)),
        (SpatialBorder::Tube(sphere), DVec3::new(8f64.sqrt(), 1.0, 0.0)),
    ] {
        let flow = SpatialFlow::new(medium.clone(), vec![border], 6.0);
        let start = DVec3::new(-8f64.sqrt(), 1.0, 0.0);
        let ray =
            SpatialRay { position: start, wave_vector: DVec3::X * 1.2, mode: ModeKind::Shared };
        let found = end(&flow, &ray);
        assert!((found.position - expected).length() < 1e-13);
        assert!((found.outward - expected / 3.0).length() < 1e-13);
        assert!((found.optical_path - 1.2 * 32f64.sqrt()).abs() < 1e-11);
        // Along the axis nothing ends in a tube.
        let along = SpatialRay { wave_vector: DVec3::Z * 1.2, ..ray };
        if border == SpatialBorder::Tube(sphere) {
            let inner = SpatialRay { position: DVec3::ZERO, ..along };
            assert!(flow.advance(&inner, 1e-9).is_err());
        }
    }
}
