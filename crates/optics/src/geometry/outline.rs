//! Convex outlines in the xy-plane, and flat ends of bodies that extend along z.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A convex polygon, its corners in counterclockwise order; two corners make a line.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Outline {
    /// The corners.
    pub corners: Vec<DVec2>,
}

impl Outline {
    /// A rectangle centred on the origin.
    pub fn rectangle(half_width: f64, half_height: f64) -> Self {
        let (w, h) = (half_width, half_height);
        Self { corners: [(-w, -h), (w, -h), (w, h), (-w, h)].map(DVec2::from).to_vec() }
    }

    /// A circle, with corners on it.
    pub fn circle(centre: DVec2, radius: f64) -> Self {
        let corner = |k: u32| centre + radius * DVec2::from_angle(TAU * f64::from(k) / 96.0);
        Self { corners: (0..96).map(corner).collect() }
    }

    /// The smallest convex polygon around points.
    pub fn hull(mut points: Vec<DVec2>) -> Self {
        // Andrew's monotone chain: the lower side from left to right, then the upper one back.
        points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        points.dedup();
        if points.len() < 3 {
            return Self { corners: points };
        }
        let chain = |points: &mut dyn Iterator<Item = DVec2>| {
            let mut chain: Vec<DVec2> = Vec::new();
            for point in points {
                while let [.., a, b] = chain[..]
                    && (b - a).perp_dot(point - b) <= 0.0
                {
                    chain.pop();
                }
                chain.push(point);
            }
            chain.pop();
            chain
        };
        let mut corners = chain(&mut points.iter().copied());
        corners.extend(chain(&mut points.iter().rev().copied()));
        Self { corners }
    }

    /// The sides, from corner to corner.
    pub fn sides(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        let n = self.corners.len();
        (0..n).map(move |i| (self.corners[i], self.corners[(i + 1) % n]))
    }

    /// Whether a point lies within, border included; never in a line.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        self.corners.len() > 2 && self.sides().all(|(a, b)| (b - a).perp_dot(point - a) >= 0.0)
    }

    /// How far a point lies outside, 0 within; infinite for no outline at all.
    #[must_use]
    pub fn distance(&self, point: DVec2) -> f64 {
        if self.contains(point) {
            return 0.0;
        }
        let to_side = |(a, b): (DVec2, DVec2)| {
            let side = b - a;
            let share = (point - a).dot(side) / side.length_squared();
            point.distance(a + side * share.clamp(0.0, 1.0))
        };
        self.sides().map(to_side).fold(f64::INFINITY, f64::min)
    }

    /// The largest distance of a corner from the origin.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.corners.iter().map(|corner| corner.length()).fold(0.0, f64::max)
    }

    /// Whether the insides of two outlines meet: no line separates them. Outlines that only touch
    /// do not overlap; `slack` (cm) is how deep they may press into each other by rounding.
    #[must_use]
    pub fn overlaps(&self, other: &Self, slack: f64) -> bool {
        let separated_by = |a: &Self, b: &Self| {
            a.sides().any(|(from, to)| {
                let side = to - from;
                if side.length_squared() == 0.0 {
                    return false;
                }
                let outward = DVec2::new(side.y, -side.x).normalize();
                let reach = a.corners.iter().map(|c| outward.dot(*c)).fold(f64::MIN, f64::max);
                let start = b.corners.iter().map(|c| outward.dot(*c)).fold(f64::MAX, f64::min);
                start >= reach - slack
            })
        };
        !separated_by(self, other) && !separated_by(other, self)
    }
}

/// The flat end of a prism: an outline in a plane of constant z.
#[derive(Clone, Debug, PartialEq)]
pub struct Cap {
    /// The shape of the end.
    pub outline: Outline,
    /// Where it lies, cm.
    pub z: f64,
    /// Outward unit normal, z or -z.
    pub normal: DVec3,
}

impl Cap {
    /// The two ends of a prism.
    #[must_use]
    pub fn both(outline: &Outline, ends: [f64; 2]) -> [Self; 2] {
        let cap = |z: f64, normal: DVec3| Self { outline: outline.clone(), z, normal };
        [cap(ends[0], -DVec3::Z), cap(ends[1], DVec3::Z)]
    }

    /// The distance at which a ray that comes from outside meets the cap, from zero on.
    #[must_use]
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        if direction.dot(self.normal) >= 0.0 {
            return None;
        }
        let t = (self.z - origin.z) / direction.z;
        (t >= 0.0 && self.outline.contains((origin + direction * t).truncate())).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_that_touch_do_not_overlap() {
        let square = Outline::rectangle(1.0, 1.0);
        let moved =
            |by: DVec2| Outline { corners: square.corners.iter().map(|c| *c + by).collect() };
        assert!(!square.overlaps(&moved(DVec2::new(2.0, 0.5)), 1e-9));
        assert!(square.overlaps(&moved(DVec2::new(1.99, 0.5)), 1e-9));
        assert!(!square.overlaps(&moved(DVec2::new(0.0, -2.5)), 1e-9));
        let strip = Outline::hull(vec![DVec2::new(3.0, 0.0), DVec2::ZERO, DVec2::new(-3.0, 0.0)]);
        assert_eq!(strip.corners, [DVec2::new(-3.0, 0.0), DVec2::new(3.0, 0.0)]);
        assert!(square.overlaps(&strip, 1e-9));
        assert!(!moved(DVec2::new(0.0, 1.5)).overlaps(&strip, 1e-9));
    }
}
