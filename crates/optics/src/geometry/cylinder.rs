//! A round cylinder about the z axis, and its flat ends.

use super::Extent;
use super::sphere::time_to_leave;
use glam::DVec3;

/// A round cylinder about the z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Its radius, cm.
    pub radius: f64,
    /// From where to where it reaches along z.
    pub extent: Extent,
}

/// A part of the border of a cylinder or a ball, or of a shell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    /// The outer radius.
    Outer,
    /// The radius of the hole.
    Inner,
    /// The end at the least z.
    Bottom,
    /// The end at the largest z.
    Top,
}

impl Cylinder {
    /// The distance at which a ray that comes from outside meets the round side. A ray that leaves
    /// a point of it does not meet it again.
    #[must_use]
    pub fn hit_side(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let (o, d) = (origin.truncate(), direction.truncate());
        let speed = d.length();
        let along = o.dot(d) / speed;
        let beside = d.perp_dot(o) / speed;
        let half_chord = self.radius * self.radius - beside * beside;
        // From within the radius a ray comes that passes an end: only by rounding may it start
        // there.
        let outside = o.length_squared() >= self.radius * self.radius * (1.0 - 1e-12);
        if !(along < 0.0 && half_chord >= 0.0 && outside) {
            return None;
        }
        let t = (-along - half_chord.sqrt()).max(0.0) / speed;
        self.extent.contains(origin.z + t * direction.z).then_some(t)
    }

    /// The distance at which a ray meets the round side from within, wherever it starts.
    #[must_use]
    pub fn hit_side_within(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let (o, d) = (origin.truncate(), direction.truncate());
        let speed = d.length();
        let beside = d.perp_dot(o) / speed;
        let half_chord = self.radius * self.radius - beside * beside;
        let t = (half_chord.max(0.0).sqrt() - o.dot(d) / speed) / speed;
        let met = half_chord >= 0.0 && t >= 0.0 && self.extent.contains(origin.z + t * direction.z);
        met.then_some(t)
    }

    /// How long a point inside or on the cylinder takes to leave it with a velocity, and through
    /// which part; infinitely long if it never does.
    #[must_use]
    pub fn time_to_leave(&self, position: DVec3, velocity: DVec3) -> (f64, Border) {
        let (x, v) = (position.truncate(), velocity.truncate());
        let inside = self.radius * self.radius - x.length_squared();
        let side = time_to_leave(v.length_squared(), x.dot(v), inside);
        let (end, part) = self.time_to_end(position.z, velocity.z);
        if end < side { (end, part) } else { (side, Border::Outer) }
    }

    /// How long it takes to an end at a velocity along z.
    pub(crate) fn time_to_end(&self, z: f64, velocity: f64) -> (f64, Border) {
        let (end, part) = if velocity < 0.0 {
            (self.extent.min, Border::Bottom)
        } else {
            (self.extent.max, Border::Top)
        };
        let time = if velocity == 0.0 { f64::INFINITY } else { ((end - z) / velocity).max(0.0) };
        (time, part)
    }

    /// The unit normal of a part at a point near it, away from the axis or the middle.
    #[must_use]
    pub fn outward(&self, part: Border, position: DVec3) -> DVec3 {
        match part {
            Border::Outer | Border::Inner => {
                position.with_z(0.0).try_normalize().unwrap_or(DVec3::X)
            }
            Border::Bottom => DVec3::NEG_Z,
            Border::Top => DVec3::Z,
        }
    }

    /// Its two flat ends, if it has ends.
    #[must_use]
    pub fn ends(&self) -> Option<[Disc; 2]> {
        let [bottom, top] = self.extent.ends()?;
        let disc = |z: f64, normal: DVec3| Disc { radius: self.radius, z, normal };
        Some([disc(bottom, DVec3::NEG_Z), disc(top, DVec3::Z)])
    }
}

/// A disc about the z axis in a plane of constant z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its radius, cm.
    pub radius: f64,
    /// Where it lies, cm.
    pub z: f64,
    /// Outward unit normal, z or -z.
    pub normal: DVec3,
}

impl Disc {
    /// The distance at which a ray that comes from outside meets the disc.
    #[must_use]
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        if direction.dot(self.normal) >= 0.0 {
            return None;
        }
        let t = (self.z - origin.z) / direction.z;
        let within = (origin + direction * t).truncate().length_squared() <= self.radius.powi(2);
        (t >= 0.0 && within).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_cylinder_is_met_at_its_side_or_end() {
        let cylinder = Cylinder { radius: 2.0, extent: Extent::centred(Some(6.0)) };
        let from = DVec3::new(-10.0, 0.0, 0.0);
        assert_eq!(cylinder.hit_side(from, DVec3::X), Some(8.0));
        let aimed = |target: DVec3| {
            let direction = (target - from).normalize();
            (from, direction, (target - from).length())
        };
        let (o, d, _) = aimed(DVec3::new(-2.0, 0.0, 3.1));
        assert_eq!(cylinder.hit_side(o, d), None);
        assert_eq!(cylinder.hit_side(from, DVec3::Z), None);
        for from in [from, DVec3::X] {
            assert_eq!(cylinder.hit_side_within(from, DVec3::X), Some(2.0 - from.x));
        }
        assert_eq!(cylinder.hit_side_within(DVec3::X * 2.5, DVec3::X), None);
        assert_eq!(cylinder.hit_side_within(DVec3::X, DVec3::new(0.1, 0.0, 0.9)), None);
        assert_eq!(cylinder.hit_side_within(DVec3::X, DVec3::Z), None);
        let from_end = DVec3::new(-1.0, 0.0, 3.0);
        assert_eq!(cylinder.hit_side(from_end, DVec3::new(0.6, 0.0, 0.8)), None);
        let above = DVec3::new(1.0, 0.5, 9.0);
        let [bottom, top] = cylinder.ends().expect("it has ends");
        assert_eq!(top.hit(above, DVec3::NEG_Z), Some(6.0));
        assert_eq!(bottom.hit(above, DVec3::NEG_Z), None);
        assert_eq!(top.hit(above + DVec3::X, DVec3::NEG_Z), None);
    }

    #[test]
    fn points_leave_through_the_part_ahead() {
        let cylinder = Cylinder { radius: 2.0, extent: Extent::centred(Some(6.0)) };
        let from = DVec3::new(1.0, 0.0, 0.0);
        assert_eq!(cylinder.time_to_leave(from, DVec3::X), (1.0, Border::Outer));
        let steep = DVec3::new(1.0, 0.0, -6.0);
        assert_eq!(cylinder.time_to_leave(from, steep), (0.5, Border::Bottom));
        assert_eq!(cylinder.time_to_leave(from, DVec3::Z * 2.0), (1.5, Border::Top));
    }
}
