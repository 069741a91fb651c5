//! What pulses take through graded media, against sums along the way that use Fermat's principle:
//! the group path is the derivative of ω times the path by ω, on the way as it is.

use crate::conformal_flow::rays::{CUT, Dice, H, flow};
use glam::{DVec2, DVec3};
use optics::geometry::Extent;
use optics::medium::ModeKind;
use optics::propagation::{
    ConformalEnd, ConformalFlow, Degree, GridSpline, Half, IndexPerturbation, OpticAxis, PathPoint,
    RadialFlow, TransformedShell, UniaxialCylinder,
};
use optics::transformation::{
    ConformalMap, FlatMap, GratingMap, QuasiConformalMap, RadialMap, Symmetry,
};

const INNER: f64 = 4.0;
const OUTER: f64 = 10.0;

/// ε at a frequency higher by a share: its least dispersion.
fn shifted(value: f64, share: f64) -> f64 {
    value + share * (value.max(2.0 - value) - value)
}

/// ∫ d(ωN)/dω ds over short chords, N being the index of rays of the given principal values at a
/// radius, by their squared parts along these.
fn along(
    path: &[PathPoint],
    axes: impl Fn(DVec3) -> [DVec3; 3],
    values: impl Fn(f64) -> [f64; 3],
    index: impl Fn([f64; 3], [f64; 3]) -> f64,
    radius: impl Fn(DVec3) -> f64,
) -> f64 {
    let chord = |ends: &[PathPoint]| {
        let [from, to] = [ends[0].position, ends[1].position];
        let (at, way) = (from.midpoint(to), to - from);
        let parts = axes(at).map(|axis| axis.dot(way.normalize()).powi(2));
        let index = |share: f64| {
            (1.0 + share) * index(values(radius(at)).map(|value| shifted(value, share)), parts)
        };
        let step = 1e-5;
        way.length() * (index(step) - index(-step)) / (2.0 * step)
    };
    path.windows(2).map(chord).sum()
}

fn around_z(at: DVec3) -> [DVec3; 3] {
    let radial = at.with_z(0.0).normalize();
    [radial, DVec3::Z.cross(radial), DVec3::Z]
}

fn around_centre(at: DVec3) -> [DVec3; 3] {
    let radial = at.normalize();
    let (a, b) = radial.any_orthonormal_pair();
    [radial, a, b]
}

/// Of ε = µ: N² = det ε · t ε⁻¹ t.
fn matched([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> f64 {
    (a * b * c * (x / a + y / b + z / c)).sqrt()
}

/// Of the extraordinary wave of a dielectric with the optic axis along the first, or the second:
/// the ordinary index along the axis, the extraordinary one across it.
fn extraordinary(axis: usize) -> impl Fn([f64; 3], [f64; 3]) -> f64 {
    move |values, parts| {
        let (ordinary, extraordinary) = (values[1 - axis], values[axis]);
        (ordinary * parts[axis] + extraordinary * (1.0 - parts[axis])).sqrt()
    }
}

#[test]
fn shells_delay_pulses_as_the_derivative_of_their_phase_says() {
    let k = OUTER / (OUTER - INNER);
    let s = |r: f64| (r - INNER) / r;
    let mut seen = 0.0;
    for (height, climb) in [(0.3_f64, 0.0), (2.0, 0.0), (-5.0, 0.4), (8.5, -0.2), (9.9, 0.1)] {
        let start = DVec3::new(-(OUTER * OUTER - height * height).sqrt(), height, 0.0);
        let p = DVec3::new(1.0, 0.0, climb).normalize();
        let cylinder = RadialMap::new(INNER, OUTER, Symmetry::Axis);
        let sphere = RadialMap::new(INNER, OUTER, Symmetry::Centre);
        let extent = Extent::ENDLESS;
        // A wave vector of the medium with that tangential part: that of the virtual space.
        let inside = |map: &RadialMap| map.inverse_jacobian(start) * p;
        let shell = |map| RadialFlow::Transformed(TransformedShell { map, extent });
        let check = |flow: RadialFlow, p: DVec3, mode, expected: &dyn Fn(&[PathPoint]) -> f64| {
            let group = flow.causal_group_path(start, p, mode, 1e-7);
            let expected = expected(&flow.path(start, p, mode, 20_000));
            assert!(
                (group - expected).abs() < 2e-4 * group,
                "{flow:?} {height}: {group} {expected}"
            );
            // The same with less effort, to what was asked for.
            let rough = flow.causal_group_path(start, p, mode, 1e-4);
            assert!((group - rough).abs() < 1e-4, "{group} {rough}");
            group - flow.advance(start, p, mode).optical_path
        };
        seen += check(shell(cylinder), inside(&cylinder), ModeKind::Shared, &|path| {
            let values = |r: f64| [s(r), 1.0 / s(r), k * k * s(r)];
            along(path, around_z, values, matched, |at| at.truncate().length())
        });
        seen += check(shell(sphere), inside(&sphere), ModeKind::Shared, &|path| {
            let values = |r: f64| [k * s(r) * s(r), k, k];
            along(path, around_centre, values, matched, DVec3::length)
        });
        for (axis, number) in [(OpticAxis::Radial, 0), (OpticAxis::Azimuthal, 1)] {
            let flow = RadialFlow::Uniaxial(UniaxialCylinder::new(INNER, OUTER, axis, extent));
            let medium = flow.medium(start).expect("a medium");
            let normal = -flow.outward(start);
            let modes = medium.modes(p, normal, optics::medium::Heading::Forward);
            let mode = modes.iter().find(|m| m.kind == ModeKind::Extraordinary).expect("a wave");
            let k2 = k * k;
            let small = |r: f64| k2 * s(r) * s(r);
            seen += check(flow, mode.wave_vector.re, ModeKind::Extraordinary, &|path| {
                let values = |r: f64| {
                    if number == 0 { [small(r), k2, k2] } else { [small(r), k2, small(r)] }
                };
                along(path, around_z, values, extraordinary(number), |at| at.truncate().length())
            });
        }
    }
    assert!(seen > 100.0, "{seen}");
}

/// Media of every map, as large as devices have them.
fn conformal_flows(extent: Extent) -> [ConformalFlow; 6] {
    let grating = ConformalMap::Grating(GratingMap::new(20.0, 1.5).expect("a map"));
    let sliding = QuasiConformalMap::new(28.0, H, &CUT).expect("a map");
    let index_scale = sliding.index_scale();
    let sliding = ConformalMap::QuasiConformal(sliding);
    let uneven = |square: &dyn Fn(DVec2) -> f64| {
        let (from, spacing) = (DVec2::new(-30.0, -5.0), DVec2::splat(2.0));
        let samples: Vec<f64> = (0..31 * 21)
            .map(|k| square(from + spacing * DVec2::new(f64::from(k % 31), f64::from(k / 31))))
            .collect();
        let spline =
            GridSpline::new(Degree::Three, from, spacing, [31, 21], &samples).expect("a spline");
        IndexPerturbation::new(spline).expect("a positive index")
    };
    let bumpy = uneven(&|at| 1.0 + 0.1 * (0.4 * at.x).sin() * (0.3 * at.y).cos());
    let graded = uneven(&|at| 1.0 + 0.7 * (0.15 * at.x).sin() * (0.2 * at.y).cos());
    let flat = ConformalMap::Flat(FlatMap::new(0.0, 4.0));
    [
        flow(extent, 1.0).with_index_perturbation(bumpy),
        ConformalFlow::new(flat, CUT, extent, 1.0).with_index_perturbation(graded),
        flow(extent, 1.0),
        flow(extent, 0.8),
        ConformalFlow::new(grating, CUT, extent, 1.0),
        ConformalFlow::new(sliding, CUT, extent, index_scale),
    ]
}

/// What pulses take in cm, and phases: Hamilton's equations dr/dσ = p, dp/dσ = n ∇n with dσ = ds/n, in physical space, by
/// the classical method of order 4 to the border.
fn by_small_steps(flow: &ConformalFlow, from: DVec3, p: DVec3) -> [f64; 2] {
    let square = |at: DVec3| flow.index(Half::Upper, at).unwrap_or(f64::NAN).powi(2);
    let force = |at: DVec3| {
        let difference = |axis: DVec3| (square(at + axis * 1e-4) - square(at - axis * 1e-4)) / 4e-4;
        DVec3::new(difference(DVec3::X), difference(DVec3::Y), 0.0)
    };
    // Place, wave vector, and what pulses take and phases.
    type State = (DVec3, DVec3, DVec2);
    let rates = |(at, p, _): State| {
        let square = square(at);
        (p, force(at), DVec2::new(square.max(1.0), square))
    };
    let moved = |(at, p, c): State, (v, f, g): State, h: f64| (at + v * h, p + f * h, c + g * h);
    let stepped = |state: State, h: f64| {
        let first = rates(state);
        let second = rates(moved(state, first, 0.5 * h));
        let third = rates(moved(state, second, 0.5 * h));
        let fourth = rates(moved(state, third, h));
        let outer = moved(moved(state, first, h / 6.0), fourth, h / 6.0);
        moved(moved(outer, second, h / 3.0), third, h / 3.0)
    };
    let inside = |(at, ..): State| {
        let floor = flow.map().floor_height_at(at.x);
        at.x.abs() < CUT.x_max && at.y < CUT.y_max && at.y > floor && at.z.abs() < 40.0
    };
    let (mut state, mut step) = ((from, p, DVec2::ZERO), 0.02);
    while step > 1e-12 {
        let next = stepped(state, step);
        if inside(next) {
            state = next;
        } else {
            step *= 0.5;
        }
    }
    state.2.to_array()
}

#[test]
fn conformal_media_delay_pulses_by_the_larger_of_n_and_its_reciprocal() {
    let extent = Extent { min: -40.0, max: 40.0 };
    for (number, flow) in conformal_flows(extent).iter().enumerate() {
        let (mut dice, mut seen, mut late) = (Dice(5), 0, 0.0);
        while seen < 6 {
            let from = DVec3::new(dice.between(-20.0, 20.0), dice.between(5.0, 15.0), 0.0);
            let across = if seen % 3 == 0 { 0.0 } else { dice.between(-1.0, 1.0) };
            let way = DVec3::new(dice.between(-1.0, 1.0), dice.between(0.0, 1.0), across);
            let start = flow.virtual_point(Half::Upper, from).expect("a point of the medium");
            let p = way.normalize() * start.index;
            let [_, end, ..] =
                flow.advance_four(&[None, Some((start, p)), None, None], 1e-8, Some(1e-7));
            let end = end.expect("a ray").expect("an end");
            let [pulse, phase] = by_small_steps(flow, from, p);
            assert!(
                (end.optical_path - phase).abs() < 1e-6,
                "{number} {} {phase}",
                end.optical_path
            );
            let found = end.group_path.expect("asked for");
            assert!((found - pulse).abs() < 2e-5, "{number} {found} {pulse} {phase}");
            late += found - end.optical_path;
            seen += 1;
        }
        assert!(late > 0.1, "{number} {late}");
    }
}

#[test]
fn what_a_pulse_takes_is_known_from_the_steps_of_its_way() {
    for flow in conformal_flows(Extent { min: -40.0, max: 40.0 }) {
        let (mut dice, mut late, mut count) = (Dice(8), 0.0, 0);
        while count < 600 {
            let from = DVec3::new(dice.between(-24.0, 24.0), dice.between(0.1, 28.0), 0.0);
            // In the plane, nearly so as seen from a camera, and steep.
            let across = [0.0, 1e-6, 0.03, 0.1, 0.3, 1.0][count % 6] * dice.between(-1.0, 1.0);
            let way = DVec3::new(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), across);
            let Ok(start) = flow.virtual_point(Half::Upper, from) else { continue };
            let p = way.normalize() * start.index;
            let to = |wanted: f64| {
                let starts = [None, Some((start, p)), None, None];
                let [with, without] = [Some(wanted), None].map(|pulses| {
                    let [_, end, ..] = flow.advance_four(&starts, 1e-6, pulses);
                    end.expect("a ray").expect("an end")
                });
                // The way is the same whether it is asked for or not.
                assert_eq!(ConformalEnd { group_path: None, ..with }, without);
                (with.group_path.expect("asked for"), with.optical_path)
            };
            let (exact, _) = to(1e-9);
            for wanted in [1e-3, 1e-4, 1e-6, 1e-7] {
                let (found, phase) = to(wanted);
                let error = (found - exact).abs();
                assert!(error < wanted, "{error} {wanted} {from} {p} {}", flow.is_uneven());
                late += found - phase;
            }
            count += 1;
        }
        assert!(late > 1.0, "{late}");
    }
}
