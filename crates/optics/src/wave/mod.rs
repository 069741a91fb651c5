//! Plane waves: wave vectors, fields, polarization and Poynting vectors.
//!
//! # Conventions
//!
//! These hold throughout the project and are stated here once.
//!
//! - Right-handed frame, **x** forward, **y** up, **z** right. Lengths in cm.
//! - Fields vary as exp(i(k0 p·r - ωt)); wave vectors `p` are dimensionless, p = k/k0, so that
//!   |p| = 1 in air. Tensors are relative ones.
//! - A plane wave obeys p × E = µH and p × H = -εE; H is scaled by the vacuum impedance.
//! - The ray direction is that of the Poynting vector Re(E × H*), not that of p. The factor 1/2 of
//!   the time average is left out: only ratios of powers are ever used.
//! - The optical path length of a straight piece dr is p·dr.
//! - Horizontal and vertical polarization are the unit vectors of [`transverse_basis`]. A polarizer
//!   at angle ψ passes cos ψ e_H + sin ψ e_V: ψ counts from horizontal, counterclockwise to one
//!   who looks along the camera ray, against the light that arrives.
//! - Stokes parameters are those of light that arrives, as its observer sees them: S1 > 0 is
//!   horizontal, S2 > 0 is at +45°, S3 > 0 is right-handed: the field at one place turns clockwise
//!   to the observer, who faces the light, E_V = -i E_H (Born & Wolf, Principles of Optics, 1.4).
//!
//! # Why rays are traced backwards
//!
//! A camera ray is launched from the camera, against the light that it stands for. For symmetric
//! tensors, as all media here have, the scattering matrix of an interface between modes normalized
//! to their flux is symmetric: S_ij(k_t) = S_ji(-k_t). So the amplitude of a path is that of the
//! reversed path, and its 2 x 2 matrix between the polarizations at both ends is transposed. The
//! étendue of a bundle of rays is conserved along it, and both ends lie in air, so the radiance
//! that arrives along a path is that of its far end, times the share of power the path carries.
//!
//! With a detector behind a polarizer that passes the field **e** and an unpolarized scene, the
//! picture is therefore the sum over leaves of P_j L_j: P_j the power of leaf j of the ray launched
//! with the field **e***, L_j the radiance that it meets. (A real polarizer passes half of that;
//! the factor is left out, so that the empty view is the same through every polarizer.) Paths that
//! leave a device at different places differ by many wavelengths: their powers add up, not their
//! fields.

/// Speed of light in vacuum, cm/ns.
pub const SPEED_OF_LIGHT: f64 = 29.979_245_8;

mod complex_vector;
mod frame;
mod linear_system;
mod number;
mod polarization;
mod stokes;

pub use complex_vector::{ComplexVector, poynting};
pub(crate) use frame::Frame;
pub(crate) use linear_system::solve;
pub(crate) use number::{Number, cross, dot};
pub use polarization::transverse_basis;
pub(crate) use polarization::turn_transverse;
pub use stokes::{arriving_stokes, stokes_of_coherency};

use glam::DVec3;

/// The unit vector along a vector of any length, however large or small; `None` for zero.
#[must_use]
pub fn unit(vector: DVec3) -> Option<DVec3> {
    // In two steps: the inverse of a denormal number is infinite.
    (vector / vector.abs().max_element()).try_normalize()
}
