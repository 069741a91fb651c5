//! Lenses that touch: by a common face, by a point, in a body; the account of the power, and what is
//! refused.

use super::LIMITS;
use crate::long::count;
use crate::rays::{Numbers, assembly, launch, placed, refusal, try_bench};
use cloakroom::trace::Tracer;
use glam::DVec3;

/// A lens whose front is at x = 0 of a pose.
struct Element {
    radii: [f64; 2],
    thickness: f64,
    diameter: f64,
    index: f64,
}

impl Element {
    fn text(&self, at: DVec3, turn: &glam::DMat3) -> String {
        let place = placed(at + turn.x_axis * (0.5 * self.thickness), turn);
        format!(
            "[[device]]\nkind = \"lens\"\nfront_radius = {:?}\nback_radius = {:?}\nthickness = {:?}\n\
             diameter = {:?}\nindex = {:?}\n{place}",
            self.radii[0], self.radii[1], self.thickness, self.diameter, self.index
        )
    }
}

#[test]
fn power_is_accounted_for_where_lenses_share_faces() {
    let mut numbers = Numbers(5);
    let mut met = 0;
    for _ in 0..count(60, 2000) {
        let pose = numbers.pose();
        let turn = pose.rotation();
        let mut radius = || {
            let size = numbers.between(6.0, 30.0);
            [size, -size, 0.0][(3.0 * numbers.next()) as usize]
        };
        let radii: Vec<f64> = (0..4).map(|_| radius()).collect();
        let (mut at, mut scene) = (pose.origin, String::new());
        for pair in radii.windows(2) {
            let sag = |radius: f64| if radius == 0.0 { 0.0 } else { 0.55 * 4.0 / radius };
            let thickness = numbers.between(0.3, 1.0) + (sag(pair[0]) - sag(pair[1])).abs();
            let element = Element {
                radii: [pair[0], pair[1]],
                thickness,
                diameter: numbers.between(2.0, 4.0),
                index: numbers.between(1.3, 2.0),
            };
            scene += &element.text(at, &turn);
            at += turn.x_axis * thickness;
        }
        if numbers.next() < 0.3 {
            // All of it under water.
            scene += "[[device]]\nkind = \"body\"\nshape = \"sphere\"\nradius = 60\nindex = 1.33\n";
        }
        let bench = assembly(&scene);
        let mut tracer = Tracer::new(&bench, LIMITS);
        let middle = pose.origin.midpoint(at);
        for _ in 0..20 {
            let origin = middle + numbers.direction() * numbers.between(0.0, 40.0);
            if bench.device_containing(origin).is_some_and(|device| device < 3) {
                continue;
            }
            let ray = launch(origin, middle + numbers.direction() * 1.8 - origin);
            let (leaves, outcome) = tracer.trace(&ray);
            outcome.assert_balanced(leaves, 1e-11, &(&ray, &scene));
            met += u32::from(leaves.len() > 3);
        }
    }
    assert!(met > 400, "{met}");
}

#[test]
fn lenses_of_the_same_glass_that_share_a_face_are_one() {
    let turn = glam::DMat3::IDENTITY;
    let one = |radii: [f64; 2], thickness: f64, x: f64| {
        Element { radii, thickness, diameter: 5.0, index: 1.6 }.text(DVec3::X * x, &turn)
    };
    let whole = assembly(&one([9.0, -14.0], 2.5, 0.0));
    let halves = assembly(&(one([9.0, -7.0], 1.2, 0.0) + &one([-7.0, -14.0], 1.3, 1.2)));
    let mut numbers = Numbers(8);
    for _ in 0..200 {
        let origin = DVec3::new(-12.0, numbers.between(-3.0, 3.0), numbers.between(-3.0, 3.0));
        let goal = DVec3::new(0.0, numbers.between(-2.0, 2.0), numbers.between(-2.0, 2.0));
        let ray = launch(origin, goal - origin);
        let [mut one, mut two] = [&whole, &halves].map(|bench| Tracer::new(bench, LIMITS));
        let ((one, _), (two, _)) = (one.trace(&ray), two.trace(&ray));
        assert_eq!(one.len(), two.len());
        for (a, b) in one.iter().zip(two) {
            assert!(a.position.distance(b.position) < 1e-11, "{a:?} {b:?}");
            assert!((a.power[0] - b.power[0]).abs() < 1e-12);
        }
    }
}

#[test]
fn lenses_in_one_another_are_refused() {
    let turn = glam::DMat3::IDENTITY;
    let lens = |x: f64| {
        Element { radii: [9.0, -9.0], thickness: 2.0, diameter: 5.0, index: 1.6 }
            .text(DVec3::X * x, &turn)
    };
    assert!(try_bench(&(lens(0.0) + &lens(2.0))).is_ok());
    assert!(refusal(&(lens(0.0) + &lens(1.99))).contains("overlap"));
    // Partly in a body.
    let water = "[[device]]\nkind = \"body\"\nshape = \"box\"\nsize = [3, 9, 9]\nindex = 1.33\n";
    assert!(refusal(&(lens(0.0) + water)).contains("overlap"));
    assert!(try_bench(&(lens(-1.0) + water)).is_ok());
}

#[test]
fn what_is_no_lens_is_refused_with_its_place() {
    let lens = |keys: &str| refusal(&format!("[[device]]\nkind = \"lens\"\n{keys}"));
    for (keys, words) in [
        ("thickness = 1", "the faces meet at the edge: it must be 2.6"),
        (
            "diameter = 50\nthickness = 40",
            "it must be 40 cm at most, which is where the face of front_radius = 20 ends",
        ),
        ("length = 3", "a lens has its `thickness` and `diameter`"),
        ("show = \"mirror\"", "a lens hides no metal"),
        ("index = 1.5\npermittivity = 2", "take one of them"),
    ] {
        let message = lens(keys);
        assert!(message.contains(words), "{message}");
    }
}
