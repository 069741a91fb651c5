//! The map of cylindrical and spherical cloaks: it opens an axis or a centre into a hole.

use glam::{DMat3, DVec3};

/// About what a radial map turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// The z axis.
    Axis,
    /// The origin.
    Centre,
}

/// The linear radial map of Pendry, Schurig & Smith, Science 312, 1780 (2006):
/// r = a + r' (b - a)/b, primes being virtual. It takes the cylinder (or ball) of radius b to the
/// shell between a and b and is the identity on its border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialMap {
    /// Radius of the hole, cm.
    pub inner: f64,
    /// Radius of the border, cm.
    pub outer: f64,
    /// What it turns about.
    pub(crate) symmetry: Symmetry,
}

/// Closer to the hole than this share of the radius the medium is that of here: at its border the
/// tensors are singular.
const NEAREST: f64 = 1e-9;

impl RadialMap {
    /// The map that opens a hole of radius `inner` (cm) within the radius `outer`, 0 < inner <
    /// outer.
    #[must_use]
    pub fn new(inner: f64, outer: f64, symmetry: Symmetry) -> Self {
        debug_assert!(0.0 < inner && inner < outer);
        Self { inner, outer, symmetry }
    }

    /// k = b/(b - a): the virtual lengths along r over the physical ones.
    #[must_use]
    pub fn stretch(&self) -> f64 {
        self.outer / (self.outer - self.inner)
    }

    /// The part of a point that the map changes, and the rest.
    fn parts(&self, point: DVec3) -> (DVec3, DVec3) {
        match self.symmetry {
            Symmetry::Axis => (point.with_z(0.0), DVec3::new(0.0, 0.0, point.z)),
            Symmetry::Centre => (point, DVec3::ZERO),
        }
    }

    /// The unit vector of the radius at a point; x where there is none.
    #[must_use]
    pub fn radial(&self, point: DVec3) -> DVec3 {
        self.parts(point).0.try_normalize().unwrap_or(DVec3::X)
    }

    /// The distance from the axis or the centre.
    #[must_use]
    pub fn radius(&self, point: DVec3) -> f64 {
        self.parts(point).0.length()
    }

    /// The virtual point of a physical one of the shell; points in the hole go to its axis or
    /// centre.
    #[must_use]
    pub fn to_virtual(&self, point: DVec3) -> DVec3 {
        let (across, along) = self.parts(point);
        let radius = self.stretch() * (across.length() - self.inner);
        self.radial(point) * radius.max(0.0) + along
    }

    /// The physical point of a virtual one.
    #[must_use]
    pub fn to_physical(&self, point: DVec3) -> DVec3 {
        let (across, along) = self.parts(point);
        self.radial(point) * (self.inner + across.length() / self.stretch()) + along
    }

    /// s = (r - a)/r at a physical point, kept off zero at the hole.
    #[must_use]
    pub fn shrinkage(&self, point: DVec3) -> f64 {
        let radius = self.radius(point);
        ((radius - self.inner) / radius).max(NEAREST)
    }

    /// The tensor radial r̂r̂ + around (the rest across z, or all of the rest) + axial zz at a
    /// point.
    fn tensor_of(&self, point: DVec3, radial: f64, around: f64, axial: f64) -> DMat3 {
        let r = self.radial(point);
        let dyad = DMat3::from_cols(r * r.x, r * r.y, r * r.z);
        let last = match self.symmetry {
            Symmetry::Axis => axial,
            Symmetry::Centre => around,
        };
        let rest = DMat3::from_diagonal(DVec3::new(around, around, last));
        rest + dyad * (radial - around)
    }

    /// The Jacobian ∂(x, y, z)/∂(X, Y, Z), which is symmetric, at a physical point.
    #[must_use]
    pub fn jacobian(&self, point: DVec3) -> DMat3 {
        let k = self.stretch();
        self.tensor_of(point, 1.0 / k, 1.0 / (k * self.shrinkage(point)), 1.0)
    }

    /// The inverse of the Jacobian at a physical point.
    #[must_use]
    pub fn inverse_jacobian(&self, point: DVec3) -> DMat3 {
        let k = self.stretch();
        self.tensor_of(point, k, k * self.shrinkage(point), 1.0)
    }

    /// The determinant of the Jacobian at a physical point.
    #[must_use]
    pub fn determinant(&self, point: DVec3) -> f64 {
        let (k, s) = (self.stretch(), self.shrinkage(point));
        match self.symmetry {
            Symmetry::Axis => 1.0 / (k * k * s),
            Symmetry::Centre => 1.0 / (k * k * k * s * s),
        }
    }

    /// The tensor J Jᵀ/det J that permittivity and permeability must equal at a physical point:
    /// diag(s, 1/s, k² s) along r, around and along z, or diag(k s², k, k) about a centre.
    #[must_use]
    pub fn tensor(&self, point: DVec3) -> DMat3 {
        let [radial, around, axial] = self.values(point);
        self.tensor_of(point, radial, around, axial)
    }

    /// Its principal values along r, around and along z, or along r and twice across.
    fn values(&self, point: DVec3) -> [f64; 3] {
        let (k, s) = (self.stretch(), self.shrinkage(point));
        match self.symmetry {
            Symmetry::Axis => [s, 1.0 / s, k * k * s],
            Symmetry::Centre => [k * s * s, k, k],
        }
    }

    /// Its principal values and axes.
    pub(crate) fn principal_values(&self, point: DVec3) -> ([f64; 3], [DVec3; 3]) {
        let radial = self.radial(point);
        let [around, last] = match self.symmetry {
            Symmetry::Axis => [DVec3::Z.cross(radial), DVec3::Z],
            Symmetry::Centre => radial.any_orthonormal_pair().into(),
        };
        (self.values(point), [radial, around, last])
    }

    /// The inverse of the tensor at a physical point.
    #[must_use]
    pub fn inverse_tensor(&self, point: DVec3) -> DMat3 {
        let (k, s) = (self.stretch(), self.shrinkage(point));
        match self.symmetry {
            Symmetry::Axis => self.tensor_of(point, 1.0 / s, s, 1.0 / (k * k * s)),
            Symmetry::Centre => self.tensor_of(point, 1.0 / (k * s * s), 1.0 / k, 1.0 / k),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAPS: [RadialMap; 2] = [
        RadialMap { inner: 4.0, outer: 10.0, symmetry: Symmetry::Axis },
        RadialMap { inner: 1.0, outer: 2.5, symmetry: Symmetry::Centre },
    ];

    fn virtual_points() -> impl Iterator<Item = DVec3> {
        (1..40).map(|n| {
            let t = f64::from(n);
            DVec3::new((1.3 * t).sin(), (2.1 * t).cos(), (0.7 * t).sin()) * 1.2
        })
    }

    #[test]
    fn the_map_has_its_inverse_and_keeps_its_border() {
        for map in MAPS {
            for point in virtual_points() {
                let there = map.to_physical(point);
                assert!(map.radius(there) > map.inner);
                assert!((map.to_virtual(there) - point).length() < 1e-14);
                let border = map.radial(point) * map.outer;
                assert!((map.to_physical(border) - border).length() < 1e-14);
            }
        }
    }

    #[test]
    fn the_jacobian_is_the_derivative_of_the_map() {
        let h = 1e-5;
        for map in MAPS {
            for point in virtual_points() {
                let j = map.jacobian(map.to_physical(point));
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    let ahead = map.to_physical(point + axis * h);
                    let slope = (ahead - map.to_physical(point - axis * h)) / (2.0 * h);
                    assert!((slope - j * axis).length() < 1e-8 * (1.0 + slope.length()));
                }
            }
        }
    }

    #[test]
    fn the_tensor_is_that_of_the_jacobian() {
        for map in MAPS {
            for point in virtual_points().map(|point| map.to_physical(point)) {
                let j = map.jacobian(point);
                let m = j * j.transpose() * (1.0 / j.determinant());
                assert!(m.abs_diff_eq(map.tensor(point), 1e-12 * m.x_axis.length()));
                assert!((j.determinant() / map.determinant(point) - 1.0).abs() < 1e-13);
                assert!((j * map.inverse_jacobian(point)).abs_diff_eq(DMat3::IDENTITY, 1e-13));
                assert!((m * map.inverse_tensor(point)).abs_diff_eq(DMat3::IDENTITY, 1e-12));
                assert!((m.determinant() * map.determinant(point) - 1.0).abs() < 1e-12);
            }
        }
    }
}
