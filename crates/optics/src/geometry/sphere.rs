//! A sphere about the origin.

use glam::DVec3;

/// The sphere of a given radius about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its radius, cm.
    pub radius: f64,
}

impl Sphere {
    /// The distance at which a ray (of unit direction) that comes from outside meets the sphere.
    /// A ray that leaves a point of it does not meet it again.
    #[must_use]
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let along = origin.dot(direction);
        // From the closest approach itself: the difference of squares would lose digits far away.
        let beside = origin - direction * along;
        let half_chord = self.radius * self.radius - beside.length_squared();
        // From within a ray does not come: only by rounding may it start there.
        let outside = origin.length_squared() >= self.radius * self.radius * (1.0 - 1e-12);
        if along >= 0.0 || half_chord < 0.0 || !outside {
            return None;
        }
        // Never negative: rounding may have put the origin a hair inside.
        Some((-along - half_chord.sqrt()).max(0.0))
    }

    /// The distance at which a ray (of unit direction) meets the sphere from within, wherever it
    /// starts.
    #[must_use]
    pub fn hit_within(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let along = origin.dot(direction);
        let beside = origin - direction * along;
        let half_chord = self.radius * self.radius - beside.length_squared();
        let distance = half_chord.max(0.0).sqrt() - along;
        (half_chord >= 0.0 && distance >= 0.0).then_some(distance)
    }

    /// How long a point inside or on the sphere takes to leave it with a velocity.
    #[must_use]
    pub fn time_to_leave(&self, position: DVec3, velocity: DVec3) -> f64 {
        let inside = self.radius * self.radius - position.length_squared();
        time_to_leave(velocity.length_squared(), position.dot(velocity), inside)
    }

    /// The outward unit normal at a point near the sphere; at its centre, where there is none, x.
    #[must_use]
    pub fn outward(&self, position: DVec3) -> DVec3 {
        position.try_normalize().unwrap_or(DVec3::X)
    }
}

/// The larger root of v² t² + 2 (x·v) t = R² - x², from zero on; infinite without motion.
pub(super) fn time_to_leave(speed_squared: f64, outward: f64, inside: f64) -> f64 {
    if speed_squared == 0.0 {
        return f64::INFINITY;
    }
    let inside = inside.max(0.0);
    let root = (outward * outward + speed_squared * inside).sqrt();
    if outward > 0.0 { inside / (root + outward) } else { (root - outward) / speed_squared }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_meet_the_near_side_once() {
        let sphere = Sphere { radius: 2.0 };
        assert_eq!(sphere.hit(DVec3::new(-5.0, 0.0, 0.0), DVec3::X), Some(3.0));
        assert_eq!(sphere.hit(DVec3::new(-5.0, 2.1, 0.0), DVec3::X), None);
        assert_eq!(sphere.hit(DVec3::new(5.0, 0.0, 0.0), DVec3::X), None);
        assert_eq!(sphere.hit(DVec3::new(2.0, 0.0, 0.0), DVec3::X), None);
        for x in [-5.0, 0.5] {
            let within = sphere.hit_within(DVec3::new(x, 0.0, 0.0), DVec3::X);
            assert_eq!(within, Some(2.0 - x));
        }
        assert_eq!(sphere.hit_within(DVec3::new(2.5, 0.0, 0.0), DVec3::X), None);
        assert_eq!(sphere.hit_within(DVec3::new(-5.0, 2.1, 0.0), DVec3::X), None);
        assert_eq!(sphere.hit(DVec3::new(-1.5, 0.0, 0.0), DVec3::X), None);
        let grazing = sphere.hit(DVec3::new(-5.0, 2.0, 0.0), DVec3::X);
        assert_eq!(grazing, Some(5.0));
    }

    #[test]
    fn chords_have_their_length() {
        let sphere = Sphere { radius: 2.0 };
        assert_eq!(sphere.time_to_leave(DVec3::new(-2.0, 0.0, 0.0), DVec3::X * 2.0), 2.0);
        assert_eq!(sphere.time_to_leave(DVec3::new(2.0, 0.0, 0.0), DVec3::X), 0.0);
        let slanted = sphere.time_to_leave(DVec3::new(0.0, 1.0, 0.0), DVec3::X);
        assert!((slanted - 3f64.sqrt()).abs() < 1e-15);
    }
}
