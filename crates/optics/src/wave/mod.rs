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

mod complex_vector;
mod frame;
mod linear_system;
mod number;
mod plane_wave;
mod polarization;

pub use complex_vector::ComplexVector;
pub(crate) use frame::Frame;
pub(crate) use linear_system::solve;
pub(crate) use number::{Number, cross, dot};
pub use plane_wave::{PlaneWave, poynting};
pub use polarization::{transverse_basis, turn_transverse};
