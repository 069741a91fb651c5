//! Impedance-matched cylindrical and spherical cloaks.

use super::{Border, PathEnd};
use crate::geometry::{Cylinder, Extent, Sphere};
use crate::medium::Medium;
use crate::transformation::{RadialMap, Symmetry};
use glam::DVec3;

/// The shell ε = µ = J Jᵀ/det J of a radial map. In virtual space, X and P = Jᵀ p, rays are
/// straight lines, and fields are those of empty space: E = J⁻ᵀ E', H = J⁻ᵀ H'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransformedShell {
    /// The map.
    pub map: RadialMap,
    /// From where to where a cylindrical one reaches along z.
    pub extent: Extent,
}

/// How far from the hole, relative to its radius, a point is at its border.
const AT_HOLE: f64 = 1e-9;

/// There the medium, which is singular, is taken for that so far away, of which double precision
/// can hold the tensor: waves of the hole come to it, but for those across its border they cannot
/// get in anywhere.
const BESIDE_HOLE: f64 = 1e-5;

impl TransformedShell {
    /// The local medium.
    pub fn medium(&self, position: DVec3) -> Medium {
        let map = &self.map;
        let position = self.beside_hole(position);
        // det (J Jᵀ/det J) = 1/det J.
        let determinant = map.determinant(position).recip();
        Medium::transformed(map.tensor(position), map.inverse_tensor(position), determinant)
    }

    /// A point, kept off the hole.
    pub(super) fn beside_hole(&self, position: DVec3) -> DVec3 {
        let map = &self.map;
        if map.radius(position) <= map.inner * (1.0 + AT_HOLE) {
            map.radial(position) * (map.inner * (1.0 + BESIDE_HOLE))
        } else {
            position
        }
    }

    /// Follows a ray from a point of the border to where it comes out. It never comes to the hole.
    pub fn advance(&self, position: DVec3, wave_vector: DVec3) -> PathEnd<Border> {
        let map = &self.map;
        let momentum = map.jacobian(position) * wave_vector;
        let line = VirtualLine::new(map, self.extent, position, momentum);
        let inverse = map.inverse_jacobian(line.position);
        // S = J S'/det J, and |S| is to stay.
        let power = |at: DVec3| (map.jacobian(at) * momentum).length() / map.determinant(at);
        let factor = (power(position) / power(line.position)).sqrt();
        PathEnd {
            virtual_point: (),
            surface: line.border,
            position: line.position,
            wave_vector: inverse * momentum,
            direction: (map.jacobian(line.position) * momentum).normalize(),
            optical_path: line.time * momentum.length_squared(),
            group_path: None,
            transport: inverse * map.jacobian(position) * factor,
            outward: line.outward,
        }
    }
}

/// A straight line in virtual space from a point of the shell to its outer border or ends.
pub(super) struct VirtualLine {
    /// The time it takes at the given velocity.
    pub time: f64,
    /// The part of the border where it ends.
    pub border: Border,
    /// The physical end point.
    pub position: DVec3,
    /// The outward normal there.
    pub outward: DVec3,
}

impl VirtualLine {
    /// From a physical point with a virtual velocity.
    pub fn new(map: &RadialMap, extent: Extent, position: DVec3, velocity: DVec3) -> Self {
        let start = map.to_virtual(position);
        let radius = map.outer;
        match map.symmetry {
            Symmetry::Centre => {
                let sphere = Sphere { radius };
                let time = sphere.time_to_leave(start, velocity);
                let outward = sphere.outward(start + velocity * time);
                Self { time, border: Border::Outer, position: outward * radius, outward }
            }
            Symmetry::Axis => {
                let cylinder = Cylinder { radius, extent };
                let (time, part) = cylinder.time_to_leave(start, velocity);
                let end = start + velocity * time;
                let outward = cylinder.outward(part, end);
                let position = match part {
                    Border::Outer | Border::Inner => outward * radius + DVec3::Z * end.z,
                    Border::Bottom => map.to_physical(end).with_z(extent.min),
                    Border::Top => map.to_physical(end).with_z(extent.max),
                };
                Self { time, border: part, position, outward }
            }
        }
    }
}
