//! A ball of which a plane has cut something off.

use super::{Plane, Sphere};
use glam::{DVec2, DVec3};

/// The part of a ball about the origin behind a plane: half of it, or more, or less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutBall {
    /// The ball.
    pub sphere: Sphere,
    /// The plane, its normal pointing to what is cut off. It cuts the ball.
    pub plane: Plane,
}

impl CutBall {
    /// The radius of the rim, where the plane meets the sphere.
    #[must_use]
    pub fn rim(&self) -> f64 {
        let Self { sphere: Sphere { radius }, plane: Plane { offset, .. } } = *self;
        ((radius - offset) * (radius + offset)).max(0.0).sqrt()
    }

    /// How far a point lies outside of the plane or the sphere, whichever is more; negative inside,
    /// cm.
    #[must_use]
    pub fn height(&self, at: DVec3) -> f64 {
        let above = self.plane.normal.dot(at) - self.plane.offset;
        above.max(at.length() - self.sphere.radius)
    }

    /// Where a ray that is outside enters: the distance, from zero on, and the outward unit normal.
    #[must_use]
    pub fn entry(&self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        let Self { sphere, plane } = self;
        let above = plane.normal.dot(origin) - plane.offset;
        let approach = -plane.normal.dot(direction);
        if above >= 0.0 && approach > 0.0 {
            let distance = above / approach;
            if (origin + direction * distance).length_squared() <= sphere.radius * sphere.radius {
                return Some((distance, plane.normal));
            }
        }
        let distance = sphere.hit(origin, direction)?;
        let point = origin + direction * distance;
        (plane.normal.dot(point) <= plane.offset).then(|| (distance, sphere.outward(point)))
    }

    /// Where a ray that is inside or on the border leaves: the distance, from zero on, and the
    /// outward unit normal.
    #[must_use]
    pub fn exit(&self, origin: DVec3, direction: DVec3) -> (f64, DVec3) {
        let distance = self.sphere.time_to_leave(origin, direction);
        match self.plane.distance(origin, direction) {
            Some(to_plane) if to_plane < distance => (to_plane, self.plane.normal),
            _ => (distance, self.sphere.outward(origin + direction * distance)),
        }
    }

    /// The farthest point along a unit vector.
    #[must_use]
    pub fn farthest_along(&self, direction: DVec3) -> DVec3 {
        let Self { sphere: Sphere { radius }, plane: Plane { normal, offset } } = *self;
        if normal.dot(direction) * radius <= offset {
            return direction * radius;
        }
        let aside = direction.reject_from_normalized(normal).try_normalize();
        normal * offset + aside.unwrap_or(normal.any_orthonormal_vector()) * self.rim()
    }

    /// How far its farthest point is from a point.
    #[must_use]
    pub fn farthest_from(&self, point: DVec3) -> f64 {
        let away = -point.try_normalize().unwrap_or(self.plane.normal);
        point.distance(self.farthest_along(away))
    }

    /// Its cross-section in the plane z = 0 as corners, one after the other, `pieces` of them on a
    /// whole circle.
    #[must_use]
    pub fn section(&self, pieces: u32) -> Vec<DVec2> {
        let Self { sphere: Sphere { radius }, plane: Plane { normal, offset } } = *self;
        let aside = normal.truncate();
        let reach = aside.length() * radius;
        if reach <= offset.abs() {
            return if offset > 0.0 { circle(radius, 0.0, 1.0, pieces) } else { Vec::new() };
        }
        // From where the cut ends on around to where it starts.
        let half = (offset / reach).clamp(-1.0, 1.0).acos() / std::f64::consts::TAU;
        circle(radius, aside.to_angle() / std::f64::consts::TAU + half, 1.0 - 2.0 * half, pieces)
    }
}

/// Points of a circle from a share of a turn on, over a share of it, both ends included.
fn circle(radius: f64, from: f64, share: f64, pieces: u32) -> Vec<DVec2> {
    let turn = |k: u32| from + share * f64::from(k) / f64::from(pieces);
    let at = |k: u32| radius * DVec2::from_angle(std::f64::consts::TAU * turn(k));
    (0..=pieces).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(offset: f64) -> CutBall {
        let normal = DVec3::new(2.0, -1.0, 2.0) / 3.0;
        CutBall { sphere: Sphere { radius: 2.0 }, plane: Plane { normal, offset } }
    }

    /// Points of its inside and border, from a lattice.
    fn points(ball: &CutBall) -> Vec<DVec3> {
        let lattice = (0..61 * 61 * 61).map(|k| {
            DVec3::new(f64::from(k % 61), f64::from(k / 61 % 61), f64::from(k / 3721)) / 15.0 - 2.0
        });
        lattice.filter(|at| ball.height(*at) <= 0.0).collect()
    }

    #[test]
    fn rays_go_in_and_out_where_points_say() {
        for offset in [-1.2, 0.0, 0.7] {
            let ball = cut(offset);
            for k in 0..400 {
                let angle = f64::from(k);
                let origin = 5.0 * DVec3::new(angle.sin(), angle.cos(), (1.7 * angle).sin());
                let goal =
                    DVec3::new((3.1 * angle).sin(), (2.3 * angle).cos(), (0.9 * angle).cos());
                let direction = (goal - origin).normalize();
                let along = (0..12000).map(|step| f64::from(step) * 1e-3);
                let inside: Vec<f64> =
                    along.filter(|t| ball.height(origin + direction * t) < 0.0).collect();
                let Some((enter, normal)) = ball.entry(origin, direction) else {
                    assert!(inside.len() < 3, "{offset} {k}");
                    continue;
                };
                assert!(ball.height(origin + direction * enter).abs() < 1e-12);
                assert!(normal.dot(direction) < 0.0);
                let middle = inside[inside.len() / 2];
                let (exit, outward) = ball.exit(origin + direction * middle, direction);
                assert!((inside[0] - enter).abs() < 1.1e-3);
                assert!((inside[inside.len() - 1] - middle - exit).abs() < 1.1e-3);
                assert!(outward.dot(direction) > 0.0);
            }
        }
    }

    #[test]
    fn its_farthest_points_are_those_of_all() {
        for offset in [-1.2, 0.0, 0.7] {
            let ball = cut(offset);
            let points = points(&ball);
            for k in 0..40 {
                let angle = f64::from(k);
                let v = DVec3::new(angle.sin(), angle.cos(), (1.7 * angle).sin());
                let direction = v.normalize();
                let tip = ball.farthest_along(direction);
                assert!(ball.height(tip).abs() < 1e-12);
                let most = points.iter().map(|at| at.dot(direction)).fold(f64::MIN, f64::max);
                assert!((0.0..0.15).contains(&(tip.dot(direction) - most)), "{offset} {k}");
                let far = points.iter().map(|at| at.distance(v)).fold(0.0, f64::max);
                assert!((0.0..0.15).contains(&(ball.farthest_from(v) - far)), "{offset} {k}");
            }
        }
    }

    #[test]
    fn its_section_is_what_is_left_of_the_circle() {
        for offset in [-1.2, 0.0, 0.7, 1.9, -1.9] {
            let ball = cut(offset);
            let corners = ball.section(64);
            assert!(corners.iter().all(|at| ball.height(at.extend(0.0)) < 1e-12), "{offset}");
            let area: f64 = (0..corners.len())
                .map(|k| 0.5 * corners[k].perp_dot(corners[(k + 1) % corners.len()]))
                .sum();
            let cells = (0..400 * 400).map(|k| DVec2::new(f64::from(k % 400), f64::from(k / 400)));
            let cells = cells.map(|at| (at + 0.5) / 100.0 - 2.0);
            let inside = cells.filter(|at| ball.height(at.extend(0.0)) < 0.0).count();
            assert!((area - inside as f64 * 1e-4).abs() < 0.03, "{offset} {area}");
        }
    }
}
