//! Parts of Maxwell's fish-eye.

use super::{LIMITS, check_by_integration, check_starts_inside, leaves};
use crate::rays::{Numbers, assembly, launch, refusal};
use cloakroom::device::{Device, FisheyeHemisphere, Request};
use cloakroom::trace::Tracer;
use glam::{DVec2, DVec3};
use optics::geometry::Pose;
use optics::propagation::reference::SquaredIndex;
use std::f64::consts::{FRAC_PI_2, TAU};

const RADIUS: f64 = 10.0;

/// A part whose cut looks along (2, -1, 2)/3.
fn part(index: f64, cut_distance: f64) -> FisheyeHemisphere {
    let cut_normal = DVec3::new(2.0, -1.0, 2.0);
    FisheyeHemisphere { radius: RADIUS, index, cut_normal, cut_distance }
}

fn height(part: &FisheyeHemisphere) -> impl Fn(DVec3) -> f64 {
    let (normal, offset) = (part.cut_normal.normalize(), part.cut_distance);
    move |at| (normal.dot(at) - offset).max(at.length() - RADIUS)
}

#[test]
fn rays_run_as_the_index_bends_them() {
    for (index, cut_distance) in [(1.0, 0.0), (1.4, 3.5), (0.8, -6.0)] {
        let part = part(index, cut_distance);
        // n = 2 m/(1 + (r/R)²)
        let square = |at: DVec3| {
            let share = 1.0 + at.length_squared() / (RADIUS * RADIUS);
            let value = (2.0 * index / share).powi(2);
            SquaredIndex { value, gradient: at * (-4.0 * value / (RADIUS * RADIUS * share)) }
        };
        let structure = part.build(Request::default()).unwrap();
        check_by_integration(&structure, &square, &height(&part));
    }
}

#[test]
fn rays_may_start_inside() {
    let part = part(1.2, 2.0);
    let scene = "[[device]]\nkind = 'fisheye-hemisphere'\nindex = 1.2\ncut_normal = [2, -1, 2]\n\
                 cut_distance = 2\nposition = [3, -1, 2]\nrotation = 20\naxis = [1, 1, 3]\n";
    check_starts_inside(scene, &height(&part));
}

#[test]
fn two_halves_are_the_whole_lens() {
    let whole = assembly("[[device]]\nkind = 'fisheye-lens'\nposition = [4, 5, -6]\n");
    let mut numbers = Numbers(13);
    for cut_distance in [0.0, 4.0] {
        let normal = numbers.direction();
        let mut scene = String::new();
        // Each in a pose of its own.
        for sign in [1.0, -1.0] {
            let (rotation, axis) = (numbers.between(0.0, 360.0), numbers.direction());
            let pose = Pose::with_axis(DVec3::ZERO, rotation.to_radians(), axis);
            let [normal, axis] = [pose.vector_to_local(normal * sign), axis].map(|v| v.to_array());
            scene += &format!(
                "[[device]]\nkind = 'fisheye-hemisphere'\nposition = [4, 5, -6]\nrotation = {rotation:?}\n\
                 axis = {axis:?}\ncut_normal = {normal:?}\ncut_distance = {:?}\n",
                sign * cut_distance
            );
        }
        let halves = assembly(&scene);
        let mut through_both = 0;
        for _ in 0..200 {
            let direction = numbers.direction();
            let aim = DVec3::new(4.0, 5.0, -6.0) + numbers.direction() * numbers.between(0.0, 9.0);
            let ray = launch(aim - direction * 40.0, direction);
            let [one, both] = [&whole, &halves].map(|assembly| leaves(assembly, &ray));
            let ([one], [both]) = (&one[..], &both[..]) else { panic!("{one:?} {both:?}") };
            through_both += u32::from(one.path != both.path);
            assert!(one.position.distance(both.position) < 1e-9, "{one:?} {both:?}");
            assert!(one.direction.distance(both.direction) < 1e-10);
            assert!((one.optical_path - both.optical_path).abs() < 1e-9);
            for i in 0..2 {
                assert!((both.power[i] - 1.0).abs() < 1e-9, "{both:?}");
                assert!((one.electric[i] - both.electric[i]).norm_squared() < 1e-18);
            }
        }
        assert!(through_both > 50, "{through_both}");
    }
}

#[test]
fn parallel_light_onto_the_cut_meets_at_the_pole() {
    let assembly = assembly("[[device]]\nkind = 'fisheye-hemisphere'\n");
    let mut tracer = Tracer::new(&assembly, LIMITS);
    for n in 0..50 {
        let r = 0.19 * f64::from(n);
        let beside = DVec2::from_angle(TAU * f64::from(n * n) / 50.0) * r;
        let ray = launch(DVec3::new(-30.0, beside.x, beside.y), DVec3::X);
        let out = tracer.trace(&ray).0.to_vec();
        let met = out.iter().find(|leaf| leaf.position.distance(DVec3::X * RADIUS) < 1e-9);
        let met = met.expect("the focus");
        assert!((met.optical_path - 30.0 - FRAC_PI_2 * RADIUS).abs() < 1e-9);
        // What is reflected goes by the index there.
        let index = 2.0 / (1.0 + r * r / (RADIUS * RADIUS));
        let share = ((index - 1.0) / (index + 1.0)).powi(2);
        let first = tracer.first_face(&ray).expect("a surface");
        for i in 0..2 {
            assert!((first.reflected[i] - share).abs() < 1e-12, "{n}");
            assert!((met.power[i] - (1.0 - share)).abs() < 1e-9);
        }
    }
}

#[test]
fn a_cut_beside_the_ball_is_refused() {
    let device = "[[device]]\nkind = 'fisheye-hemisphere'\n";
    let error = refusal(&format!("{device}cut_distance = -10\n"));
    assert!(error.contains("cut_distance is -10 cm; it must be from -9.99 to 9.99 cm"), "{error}");
    let error = refusal(&format!("{device}cut_normal = [0, 0, 0]\n"));
    assert!(error.contains("cut_normal is [0, 0, 0]"), "{error}");
    let overlapping = format!("{device}{device}cut_normal = [1, 0, 0]\ncut_distance = 0.1\n");
    assert!(refusal(&overlapping).contains("overlap"));
}
