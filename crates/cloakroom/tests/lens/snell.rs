//! Lenses against a trace of its own: Newton's method for the faces, Snell's law for the directions.

use super::LIMITS;
use crate::rays::{Numbers, assembly, launch, placed};
use cloakroom::trace::Tracer;
use glam::DVec3;
use optics::geometry::Pose;

/// A face as textbooks give it.
#[derive(Clone, Copy, Debug)]
struct Face {
    apex: f64,
    radius: f64,
    conic: f64,
}

impl Face {
    fn sag(&self, r: f64) -> f64 {
        let c = self.radius.recip();
        c * r * r / (1.0 + (1.0 - (1.0 + self.conic) * c * c * r * r).sqrt())
    }

    fn slope(&self, r: f64) -> f64 {
        let c = self.radius.recip();
        c * r / (1.0 - (1.0 + self.conic) * c * c * r * r).sqrt()
    }

    /// How far ahead a ray meets it, by Newton's method from the plane through the apex.
    fn distance(&self, from: DVec3, along: DVec3) -> Option<f64> {
        let mut t = (self.apex - from.x) / along.x;
        for _ in 0..60 {
            let at = from + along * t;
            let r = at.y.hypot(at.z);
            let off = at.x - self.apex - self.sag(r);
            let turn = if r > 0.0 { (at.y * along.y + at.z * along.z) / r } else { 0.0 };
            t -= off / (along.x - self.slope(r) * turn);
        }
        let at = from + along * t;
        let off = at.x - self.apex - self.sag(at.y.hypot(at.z));
        (off.abs() < 1e-11).then_some(t)
    }

    /// Refracts a unit vector that goes to larger x.
    fn refract(&self, at: DVec3, along: DVec3, ratio: f64) -> Option<DVec3> {
        let r = at.y.hypot(at.z);
        let slope = if r > 0.0 { self.slope(r) / r } else { 0.0 };
        let normal = DVec3::new(1.0, -slope * at.y, -slope * at.z).normalize();
        let cos = normal.dot(along);
        let across = (along - normal * cos) * ratio;
        let left = 1.0 - across.length_squared();
        (left > 0.0 && cos > 0.0).then(|| across + normal * left.sqrt())
    }
}

#[test]
fn random_lenses_refract_by_snells_law() {
    let mut numbers = Numbers(11);
    let mut compared = 0;
    for _ in 0..60 {
        let mut face = |apex: f64| {
            let radius = numbers.between(5.0, 30.0) * if numbers.next() < 0.5 { 1.0 } else { -1.0 };
            Face { apex, radius, conic: numbers.between(-4.0, 0.8) }
        };
        let mut faces = [face(0.0), face(0.0)];
        let radius = numbers.between(1.0, 3.0);
        let gap = |r: f64| faces[1].sag(r) - faces[0].sag(r);
        let least = (0..=100).map(|k| gap(radius * f64::from(k) / 100.0)).fold(0.0, f64::min);
        let thickness = numbers.between(0.2, 1.5) - least;
        faces[0].apex = -0.5 * thickness;
        faces[1].apex = 0.5 * thickness;
        let index = numbers.between(1.2, 2.2);
        let pose: Pose = numbers.pose();
        let bench = assembly(&format!(
            "[[device]]\nkind = \"lens\"\nfront_radius = {:?}\nfront_conic = {:?}\n\
             back_radius = {:?}\nback_conic = {:?}\nthickness = {thickness:?}\ndiameter = {:?}\n\
             index = {index:?}\n{}",
            faces[0].radius,
            faces[0].conic,
            faces[1].radius,
            faces[1].conic,
            2.0 * radius,
            placed(pose.origin, &pose.rotation())
        ));
        let mut tracer = Tracer::new(&bench, LIMITS);
        for _ in 0..40 {
            let from = DVec3::new(-25.0, numbers.between(-6.0, 6.0), numbers.between(-6.0, 6.0));
            let goal =
                DVec3::new(0.0, numbers.between(-0.8, 0.8), numbers.between(-0.8, 0.8)) * radius;
            let along = (goal - from).normalize();
            let ray = launch(pose.to_world(from), pose.vector_to_world(along));
            let (leaves, outcome) = tracer.trace(&ray);
            outcome.assert_balanced(leaves, 1e-11, &ray);
            let by_hand = || {
                let first = faces[0].distance(from, along)?;
                let front = from + along * first;
                let inner = faces[0].refract(front, along, 1.0 / index)?;
                let second = faces[1].distance(front, inner)?;
                let back = front + inner * second;
                let onward = faces[1].refract(back, inner, index)?;
                let within = |at: DVec3| at.y.hypot(at.z) < 0.999 * radius;
                let sound = first > 0.0 && second > 0.0 && within(front) && within(back);
                sound.then_some((back, onward, first + index * second))
            };
            let Some((back, onward, path)) = by_hand() else { continue };
            let (back, onward) = (pose.to_world(back), pose.vector_to_world(onward));
            let near = leaves.iter().any(|leaf| {
                // A leaf is somewhere on its way out.
                let beyond = (leaf.position - back).dot(onward);
                leaf.position.distance(back + onward * beyond) < 1e-10
                    && leaf.direction.distance(onward) < 1e-10
                    && (leaf.optical_path - beyond - path).abs() < 1e-10
            });
            // What comes out may come back into a hollow at the rim.
            assert!(near, "{faces:?} {radius} {index}\n{ray:?}\n{leaves:?}");
            compared += 1;
        }
    }
    assert!(compared > 1200, "{compared}");
}
