//! Cylindrical cloaks of graded uniaxial dielectric.

use super::core_integrals::RadialQuadratic;
use super::transformed_shell::VirtualLine;
use super::uniaxial_wave::{UniaxialPoint, transport};
use super::{PathEnd, PathPoint};
use crate::geometry::{Border, Cylinder, Extent};
use crate::medium::{Medium, ModeKind};
use crate::transformation::{RadialMap, Symmetry, root_in_bracket};
use glam::{DVec2, DVec3};

/// Where the optic axis of a cylindrical cloak points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpticAxis {
    /// Along the radius.
    Radial,
    /// Around the cylinder.
    Azimuthal,
}

/// A cylindrical shell of non-magnetic uniaxial dielectric (after Cai et al., Nature Photon. 1, 224
/// (2007)) between the radii a and b, with k = b/(b - a) and s = (r - a)/r: ε_θ = k², ε_r = k² s²,
/// and ε_z = k² for the radial optic axis, ε_z = k² s² for the azimuthal one.
///
/// It has the in-plane refraction of the impedance-matched cloak for light with its magnetic field
/// along z, not its impedance. With L the angular momentum about z and p_z, both kept, the
/// waves run so (r' = k (r - a)):
///
/// - azimuthal axis, extraordinary: straight lines in virtual space with P² + p_z²/k² = 1;
/// - radial axis, extraordinary: P_r'² = 1 - L²/r'² - p_z² (1/k + a/r')²;
/// - azimuthal axis, ordinary: isotropic of index k s;
/// - radial axis, ordinary: straight, of index k; it comes to the core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniaxialCylinder {
    /// The map that gives its refraction in the plane.
    pub map: RadialMap,
    axis: OpticAxis,
    extent: Extent,
}

/// The medium at the core, where it is singular, is taken for that with this s: the one wave that
/// comes there, the ordinary wave of the radial axis, does not feel it.
const LEAST_S: f64 = 1e-6;

/// Rays this close to the axis, relative to the outer radius, are aimed at it.
const CENTRAL: f64 = 1e-12;

impl UniaxialCylinder {
    /// The shell between the radii `inner` and `outer`, cm, within `extent` along z.
    #[must_use]
    pub fn new(inner: f64, outer: f64, axis: OpticAxis, extent: Extent) -> Self {
        Self { map: RadialMap::new(inner, outer, Symmetry::Axis), axis, extent }
    }

    /// Whether a wave comes to the core: the ordinary one of the radial axis.
    pub(super) fn comes_to_core(&self, mode: ModeKind) -> bool {
        self.axis == OpticAxis::Radial && mode != ModeKind::Extraordinary
    }

    pub(super) fn point(&self, position: DVec3) -> UniaxialPoint {
        let large = self.map.stretch() * self.map.stretch();
        let s = self.map.shrinkage(position).max(LEAST_S);
        let small = large * s * s;
        let radial = self.map.radial(position);
        let (ordinary, extraordinary, axis) = match self.axis {
            OpticAxis::Radial => (large, small, radial),
            OpticAxis::Azimuthal => (small, large, DVec3::Z.cross(radial)),
        };
        UniaxialPoint { ordinary, extraordinary, axis }
    }

    /// The local medium.
    #[must_use]
    pub fn medium(&self, position: DVec3) -> Option<Medium> {
        let UniaxialPoint { ordinary, extraordinary, axis } = self.point(position);
        Medium::uniaxial_electric(1.0, ordinary, extraordinary, axis).ok()
    }

    /// The electric fields of both waves, of unit power.
    #[must_use]
    pub fn parted(&self, position: DVec3, wave_vector: DVec3) -> [(ModeKind, DVec3); 2] {
        let point = self.point(position);
        [ModeKind::Ordinary, ModeKind::Extraordinary]
            .map(|mode| (mode, point.field(wave_vector, mode)))
    }

    /// Follows a ray of either wave from a point of the border to the next point of it.
    pub fn advance(&self, position: DVec3, wave_vector: DVec3, mode: ModeKind) -> PathEnd<Border> {
        let end = if self.comes_to_core(mode) {
            self.straight(position, wave_vector)
        } else if let Some(path) = self.turning_path(position, wave_vector, mode) {
            self.turning(position, wave_vector, path)
        } else {
            // Those of the other axis that are aimed at the axis, too, as their neighbours in the
            // plane.
            self.virtually_straight(position, wave_vector)
        };
        let (here, there) = (self.point(position), self.point(end.position));
        let direction = if mode == ModeKind::Extraordinary {
            there.extraordinary_ray(end.wave_vector)
        } else {
            end.wave_vector
        };
        let field = there.field(end.wave_vector, mode);
        PathEnd {
            virtual_point: (),
            surface: end.border,
            position: end.position,
            wave_vector: end.wave_vector,
            direction: direction.normalize(),
            optical_path: end.optical_path,
            group_path: None,
            transport: transport(here.field(wave_vector, mode), field),
            outward: end.outward,
        }
    }

    /// The path of a wave that turns back before the core, if it is one.
    pub(super) fn turning_path(
        &self,
        position: DVec3,
        wave_vector: DVec3,
        mode: ModeKind,
    ) -> Option<TurningPath> {
        let turns = match (self.axis, mode == ModeKind::Extraordinary) {
            (OpticAxis::Radial, true) => {
                // Unless it is aimed at the axis.
                let momentum = position.truncate().perp_dot(wave_vector.truncate());
                let off = momentum.hypot(wave_vector.z * self.map.inner);
                off.is_nan() || off >= CENTRAL * self.map.outer
            }
            (axis, extraordinary) => axis == OpticAxis::Azimuthal && !extraordinary,
        };
        turns.then(|| TurningPath::new(self, position, wave_vector))
    }

    /// The ordinary wave of the radial axis.
    fn straight(&self, position: DVec3, wave_vector: DVec3) -> PathSegment {
        let direction = wave_vector.normalize();
        let [core, whole] =
            [self.map.inner, self.map.outer].map(|radius| Cylinder { radius, extent: self.extent });
        let (distance, part) = whole.time_to_leave(position, direction);
        let to_core = core.hit_side(position, direction).filter(|to_core| *to_core < distance);
        let distance = to_core.unwrap_or(distance);
        let end = position + direction * distance;
        let (border, outward, position) = if to_core.is_some() {
            let radial = core.outward(Border::Inner, end);
            (Border::Inner, -radial, radial * self.map.inner + DVec3::Z * end.z)
        } else {
            (part, whole.outward(part, end), self.on_border(part, end))
        };
        let optical_path = distance * wave_vector.length();
        PathSegment { border, position, outward, wave_vector, optical_path }
    }

    /// The extraordinary wave of the azimuthal axis.
    fn virtually_straight(&self, position: DVec3, wave_vector: DVec3) -> PathSegment {
        let map = &self.map;
        let momentum = map.jacobian(position) * wave_vector;
        let velocity = momentum.with_z(momentum.z / (map.stretch() * map.stretch()));
        let line = VirtualLine::new(map, self.extent, position, velocity);
        PathSegment {
            border: line.border,
            position: line.position,
            outward: line.outward,
            wave_vector: map.inverse_jacobian(line.position) * momentum,
            optical_path: line.time * momentum.dot(velocity),
        }
    }

    /// Waves that turn back before the core.
    fn turning(&self, position: DVec3, wave_vector: DVec3, path: TurningPath) -> PathSegment {
        let TurningPath { motion, radial, border, etas: [start, eta] } = path;
        let momentum = motion.momentum;
        let (begin, end) = (motion.integrals(start), motion.integrals(eta));
        let (rho, root) = motion.quadratic.radius(eta);
        let radius = if border == Border::Outer { self.map.outer } else { motion.radius(rho) };
        let turned = DVec2::from_angle(end.angle - begin.angle).rotate(radial.truncate());
        let outward_radial = turned.normalize().extend(0.0);
        let z = position.z + end.z - begin.z;
        let position = self.on_border(border, outward_radial * radius + DVec3::Z * z);
        let p_r = root / rho * motion.scale;
        let around = DVec3::Z.cross(outward_radial) * (momentum / radius);
        PathSegment {
            border,
            position,
            outward: match border {
                Border::Bottom => DVec3::NEG_Z,
                Border::Top => DVec3::Z,
                Border::Outer | Border::Inner => outward_radial,
            },
            wave_vector: outward_radial * p_r + around + DVec3::Z * wave_vector.z,
            optical_path: end.optical_path - begin.optical_path,
        }
    }

    /// A point put on the border to the last bit.
    fn on_border(&self, border: Border, point: DVec3) -> DVec3 {
        match border {
            Border::Bottom => point.with_z(self.extent.min),
            Border::Top => point.with_z(self.extent.max),
            Border::Outer => (self.map.radial(point) * self.map.outer).with_z(point.z),
            Border::Inner => point,
        }
    }
}

/// The way from border to border.
struct PathSegment {
    border: Border,
    position: DVec3,
    outward: DVec3,
    wave_vector: DVec3,
    optical_path: f64,
}

/// The way of a ray that turns back before the core.
pub(super) struct TurningPath {
    motion: RadialMotion,
    /// The unit vector away from the axis at its start.
    radial: DVec3,
    /// Where it ends.
    border: Border,
    /// The parameters of its start and its end.
    etas: [f64; 2],
}

impl TurningPath {
    fn new(cylinder: &UniaxialCylinder, position: DVec3, wave_vector: DVec3) -> Self {
        let radial = cylinder.map.radial(position);
        let momentum = position.truncate().perp_dot(wave_vector.truncate());
        let motion = RadialMotion::new(cylinder, momentum, wave_vector.z);
        let radius = cylinder.map.radius(position);
        let start = motion.quadratic.parameter(motion.rho(radius));
        let start = if wave_vector.dot(radial) < 0.0 { -start } else { start };
        let begin = motion.integrals(start);
        let last = motion.quadratic.parameter(motion.rho(cylinder.map.outer));
        let mut border = Border::Outer;
        let mut eta = last.max(start);
        let end = motion.integrals(eta);
        let whole = Cylinder { radius: cylinder.map.outer, extent: cylinder.extent };
        let (share, part) = whole.time_to_end(position.z, end.z - begin.z);
        if share < 1.0 {
            border = part;
            let goal = begin.z + share * (end.z - begin.z);
            let off = |eta: f64| (motion.integrals(eta).z - goal, motion.z_slope(eta));
            eta = root_in_bracket((start, begin.z - goal), (eta, end.z - goal), off);
        }
        Self { motion, radial, border, etas: [start, eta] }
    }

    /// The point at a share of the way from a position.
    pub fn way_point(&self, position: DVec3, share: f64) -> PathPoint {
        let [start, end] = self.etas;
        let eta = start + share * (end - start);
        let (begin, here) = (self.motion.integrals(start), self.motion.integrals(eta));
        let radius = self.motion.radius(self.motion.quadratic.radius(eta).0);
        let turned = DVec2::from_angle(here.angle - begin.angle).rotate(self.radial.truncate());
        PathPoint {
            position: (turned * radius).extend(position.z + here.z - begin.z),
            optical_path: here.optical_path - begin.optical_path,
        }
    }
}

/// What a ray that turns has done since its turning point.
struct PathIntegrals {
    angle: f64,
    z: f64,
    optical_path: f64,
}

/// The radial motion of a ray that turns: in τ with dr/dτ = ∂H/∂p_r, ρ dρ/dτ = √Q.
struct RadialMotion {
    quadratic: RadialQuadratic,
    /// ρ = scale (r - origin), p_r = scale √Q/ρ.
    scale: f64,
    origin: f64,
    momentum: f64,
    /// Weights of the integrals for z and for the optical path: first, zeroth, inverse.
    z: [f64; 3],
    path: [f64; 3],
}

impl RadialMotion {
    fn new(cylinder: &UniaxialCylinder, momentum: f64, p_z: f64) -> Self {
        let (a, k) = (cylinder.map.inner, cylinder.map.stretch());
        let (k2, l2, pz2) = (k * k, momentum * momentum, p_z * p_z);
        match cylinder.axis {
            // Extraordinary: ρ = r', r'² P_r'² = r'² - L² - p_z² (r'/k + a)².
            OpticAxis::Radial => {
                let rest = 1.0 - pz2 / k2;
                let pull = l2 + pz2 * a * a;
                let discriminant = 4.0 * (l2 * rest + pz2 * a * a);
                Self {
                    quadratic: RadialQuadratic::new(rest, -2.0 * pz2 * a / k, -pull, discriminant),
                    scale: k,
                    origin: a,
                    momentum,
                    z: [p_z / k2, 2.0 * p_z * a / k, p_z * a * a],
                    path: [1.0, 0.0, 0.0],
                }
            }
            // Ordinary: ρ = r, r² p_r² = k² (r - a)² - L² - p_z² r².
            OpticAxis::Azimuthal => {
                let ka2 = k2 * a * a;
                let discriminant = 4.0 * (l2 * (k2 - pz2) + pz2 * ka2);
                let b = -2.0 * k2 * a;
                Self {
                    quadratic: RadialQuadratic::new(k2 - pz2, b, ka2 - l2, discriminant),
                    scale: 1.0,
                    origin: 0.0,
                    momentum,
                    z: [p_z, 0.0, 0.0],
                    path: [k2, b, ka2],
                }
            }
        }
    }

    fn rho(&self, radius: f64) -> f64 {
        self.scale * (radius - self.origin)
    }

    fn radius(&self, rho: f64) -> f64 {
        self.origin + rho / self.scale
    }

    fn integrals(&self, eta: f64) -> PathIntegrals {
        let [first, zeroth, inverse] = self.quadratic.integrals(eta);
        let sum = |[f, z, i]: [f64; 3]| f * first + z * zeroth + i * inverse;
        PathIntegrals {
            angle: self.momentum * inverse,
            z: sum(self.z),
            optical_path: sum(self.path),
        }
    }

    /// dz/dη.
    fn z_slope(&self, eta: f64) -> f64 {
        let rho = self.quadratic.radius(eta).0;
        (self.z[0] * rho + self.z[1] + self.z[2] / rho) / self.quadratic.a.sqrt()
    }
}
