//! Where a device stands and how it is turned.

use crate::wave::{ComplexVector, unit};
use glam::{DMat3, DVec2, DVec3};

/// A rotation followed by a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The device's origin in the world, cm.
    pub origin: DVec3,
    turn: Turn,
}

/// A rotation that takes vectors of a device's frame to the world.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Turn {
    /// About z, which stays upright: most devices are, and two products less a coordinate are their
    /// fast path.
    Upright { cos: f64, sin: f64 },
    /// Any other.
    Tilted(DMat3),
}

impl Pose {
    /// At the origin, not turned.
    pub const IDENTITY: Self =
        Self { origin: DVec3::ZERO, turn: Turn::Upright { cos: 1.0, sin: 0.0 } };

    /// A device whose origin is at `origin` (cm), turned counterclockwise seen from +z by the angle
    /// `rotation`, in radians. Quarter turns are exact.
    #[must_use]
    pub fn new(origin: DVec3, rotation: f64) -> Self {
        // What rounding the angle leaves of a zero.
        let exact = |x: f64| if x.abs() < 1e-15 { 0.0 } else { x };
        let (sin, cos) = rotation.sin_cos();
        Self { origin, turn: Turn::Upright { cos: exact(cos), sin: exact(sin) } }
    }

    /// A device that is first turned by `rotation` about its own z axis, as by [`Pose::new`], and
    /// then by the shortest turn of z to `axis`, a vector of any length; for -z, to which there are
    /// many, by 180 degrees about x. For the zero vector, which is no direction, its axis stays z.
    ///
    /// Along z it is [`Pose::new`]; axes along x, y and -z are exact, too.
    #[must_use]
    pub fn with_axis(origin: DVec3, rotation: f64, axis: DVec3) -> Self {
        let upright = Self::new(origin, rotation);
        // A part that is nothing beside the others, whose square is not even a number.
        let exact = |x: f64| if x.abs() < 1e-100 { 0.0 } else { x };
        let axis = unit(axis).map_or(DVec3::Z, |axis| axis.map(exact));
        let aside = axis.truncate();
        let sin = aside.length();
        if sin == 0.0 && axis.z > 0.0 {
            return upright;
        }
        // Rodrigues' formula about the horizontal z x axis; where that vanishes, about x.
        let DVec2 { x, y } = if sin > 0.0 { aside / sin } else { DVec2::NEG_Y };
        let versine = 1.0 - axis.z;
        let tilt = DMat3::from_cols(
            DVec3::new(1.0 - x * x * versine, -x * y * versine, -axis.x),
            DVec3::new(-x * y * versine, 1.0 - y * y * versine, -axis.y),
            axis,
        );
        Self { origin, turn: Turn::Tilted(tilt * upright.rotation()) }
    }

    /// The frame at `origin` whose axes are the columns of a rotation matrix.
    #[must_use]
    pub fn from_rotation(origin: DVec3, rotation: DMat3) -> Self {
        let turn = if rotation.z_axis == DVec3::Z {
            Turn::Upright { cos: rotation.x_axis.x, sin: rotation.x_axis.y }
        } else {
            Turn::Tilted(rotation)
        };
        Self { origin, turn }
    }

    /// The place of what is at `first` in the frame that is at this pose.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        let origin = self.to_world(first.origin);
        let turn = match (self.turn, first.turn) {
            (Turn::Upright { cos, sin }, Turn::Upright { cos: c, sin: s }) => {
                Turn::Upright { cos: cos * c - sin * s, sin: sin * c + cos * s }
            }
            _ => Turn::Tilted(self.rotation() * first.rotation()),
        };
        Self { origin, turn }
    }

    /// The world in the device's frame: what undoes the pose.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let turn = match self.turn {
            Turn::Upright { cos, sin } => Turn::Upright { cos, sin: -sin },
            Turn::Tilted(rotation) => Turn::Tilted(rotation.transpose()),
        };
        Self { origin: self.vector_to_local(-self.origin), turn }
    }

    /// Where the device's z axis points, a unit vector of the world.
    #[must_use]
    pub fn axis(&self) -> DVec3 {
        self.vector_to_world(DVec3::Z)
    }

    /// Whether the device's z axis is that of the world.
    #[must_use]
    pub fn is_upright(&self) -> bool {
        matches!(self.turn, Turn::Upright { .. })
    }

    /// The rotation that takes vectors of the device's frame to the world.
    #[must_use]
    pub fn rotation(&self) -> DMat3 {
        match self.turn {
            Turn::Upright { cos, sin } => {
                DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z)
            }
            Turn::Tilted(rotation) => rotation,
        }
    }

    /// A point of the world in the device's frame.
    #[must_use]
    #[inline]
    pub fn to_local(&self, point: DVec3) -> DVec3 {
        self.vector_to_local(point - self.origin)
    }

    /// A point of the device's frame in the world.
    #[must_use]
    #[inline]
    pub fn to_world(&self, point: DVec3) -> DVec3 {
        self.vector_to_world(point) + self.origin
    }

    /// A vector of the world in the device's frame.
    #[must_use]
    #[inline]
    pub fn vector_to_local(&self, v: DVec3) -> DVec3 {
        match self.turn {
            Turn::Upright { cos, sin } => {
                DVec3::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z)
            }
            Turn::Tilted(DMat3 { x_axis, y_axis, z_axis }) => {
                DVec3::new(x_axis.dot(v), y_axis.dot(v), z_axis.dot(v))
            }
        }
    }

    /// A vector of the device's frame in the world.
    #[must_use]
    #[inline]
    pub fn vector_to_world(&self, v: DVec3) -> DVec3 {
        match self.turn {
            Turn::Upright { cos, sin } => {
                DVec3::new(cos * v.x - sin * v.y, cos * v.y + sin * v.x, v.z)
            }
            Turn::Tilted(rotation) => rotation * v,
        }
    }

    /// A field of the world in the device's frame.
    #[inline]
    pub fn field_to_local(&self, field: ComplexVector) -> ComplexVector {
        ComplexVector::new(self.vector_to_local(field.re), self.vector_to_local(field.im))
    }

    /// A field of the device's frame in the world.
    #[inline]
    pub fn field_to_world(&self, field: ComplexVector) -> ComplexVector {
        ComplexVector::new(self.vector_to_world(field.re), self.vector_to_world(field.im))
    }

    /// A point of the device's cross-section in the world's xy-plane.
    #[must_use]
    pub fn point_to_world(&self, point: DVec2) -> DVec2 {
        self.to_world(point.extend(0.0)).truncate()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    fn poses() -> impl Strategy<Value = Pose> {
        let vector = || prop::array::uniform3(-5.0..5.0).prop_map(DVec3::from_array);
        (vector(), -7.0..7.0, vector())
            .prop_map(|(origin, rotation, axis)| Pose::with_axis(origin, rotation, axis))
    }

    proptest! {
        #[test]
        fn a_pose_is_a_proper_rotation_and_there_and_back_is_where_one_was(
            pose in poses(),
            other in poses(),
            at in prop::array::uniform3(-50.0..50.0),
        ) {
            let at = DVec3::from_array(at);
            let rotation = pose.rotation();
            prop_assert!((rotation.determinant() - 1.0).abs() < 4e-15);
            prop_assert!((rotation.transpose() * rotation).abs_diff_eq(DMat3::IDENTITY, 4e-15));
            prop_assert!(pose.to_local(pose.to_world(at)).abs_diff_eq(at, 1e-13));
            prop_assert!((rotation * at).abs_diff_eq(pose.vector_to_world(at), 1e-13));
            let both = pose.after(&other).to_world(at);
            prop_assert!(both.abs_diff_eq(pose.to_world(other.to_world(at)), 1e-13));
            prop_assert!(pose.inverse().to_world(at).abs_diff_eq(pose.to_local(at), 1e-13));
        }

        #[test]
        fn the_axis_takes_the_shortest_turn(
            axis in prop::array::uniform3(-5.0..5.0),
            rotation in -7.0..7.0,
            exponent in -300..300,
        ) {
            let axis = DVec3::from_array(axis);
            let pose = Pose::with_axis(DVec3::ZERO, rotation, axis * 10f64.powi(exponent));
            let unit = axis.normalize();
            prop_assert!(pose.axis().abs_diff_eq(unit, 1e-15));
            // What is across both stays where the turn about z has put it.
            let across = DVec3::Z.cross(unit);
            let turned = Pose::new(DVec3::ZERO, rotation);
            let same = pose.vector_to_world(turned.vector_to_local(across));
            prop_assert!(same.abs_diff_eq(across, 1e-15), "{same} {across}");
        }
    }

    #[test]
    fn quarter_turns_are_exact() {
        for (degrees, x) in
            [(0.0, DVec3::X), (90.0, DVec3::Y), (180.0, -DVec3::X), (270.0, -DVec3::Y)]
        {
            for degrees in [degrees, degrees - 360.0] {
                let pose = Pose::new(DVec3::ZERO, f64::to_radians(degrees));
                assert_eq!(pose.vector_to_world(DVec3::X), x, "{degrees}");
            }
        }
    }

    #[test]
    fn axes_along_the_axes_are_exact() {
        let at = |rotation: f64, axis: DVec3| Pose::with_axis(DVec3::ONE, rotation, axis);
        assert_eq!(at(0.6, DVec3::Z * 7.0), Pose::new(DVec3::ONE, 0.6));
        assert!(at(0.6, DVec3::Z).is_upright() && !at(0.0, DVec3::NEG_Z).is_upright());
        let columns = |axis: DVec3| {
            let DMat3 { x_axis, y_axis, z_axis } = at(0.0, axis).rotation();
            [x_axis, y_axis, z_axis]
        };
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        assert_eq!(columns(x * 3.0), [-z, y, x]);
        assert_eq!(columns(-x), [z, y, -x]);
        assert_eq!(columns(y), [x, -z, y]);
        assert_eq!(columns(-y), [x, z, -y]);
        assert_eq!(columns(-z * 1e-310), [x, -y, -z]);
        assert_eq!(at(FRAC_PI_2, y).rotation().x_axis, -z);
        assert_eq!(at(FRAC_PI_2, -z).rotation().x_axis, -y);
        // On the way to -z the turn is about the axis across, and the frame stays one.
        for aside in [1e-3, 1e-8, 1e-15, 1e-200, 1e-308] {
            let pose = at(0.35, DVec3::new(aside, -2.0 * aside, -1.0));
            assert!((pose.rotation().determinant() - 1.0).abs() < 4e-15, "{aside}");
        }
    }
}
