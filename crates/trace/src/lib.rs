//! The engine of cloakroom: light in invisibility cloaks and other devices of transformation
//! optics.
//!
//! A typed [`Device`](device::Device) builds a [`Structure`](device::Structure): regions filled
//! with media, and the surfaces that bound them. An [`Assembly`](assembly::Assembly) has structures
//! at their places, in any pose, next to and within one another. A [`Tracer`](walk::Tracer) walks
//! the tree of a ray through it: to the next surface; there it splits by the interface solver of
//! [`optics`]; and so on until each branch is a [`Leaf`](walk::Leaf), is absorbed or is too weak to
//! follow. What the leaves carry, what is absorbed and what is pruned add up to what was launched.
//!
//! Lengths are in cm, angles of keys in degrees, others in radians; axes and signs are those of
//! [`optics::wave`]. The crate reads no files, draws no pictures and starts no threads, unless its
//! feature `rayon` is asked for.
//!
//! # Example
//!
//! Rays along x pass the square cloak as if it were not there, beside it and through it.
//!
//! ```
//! use cloakroom_trace::assembly::{Assembly, Placed};
//! use cloakroom_trace::device::{Device, Request, SquareCloak};
//! use cloakroom_trace::walk::{Launch, LeafTable, Limits, Stopped};
//! use glam::DVec3;
//! use optics::geometry::Pose;
//! use std::sync::atomic::AtomicBool;
//!
//! let cloak = SquareCloak { side: 10.0, ..SquareCloak::default() };
//! let structure = cloak.build(Request::default())?;
//! let assembly = Assembly::new(vec![Placed::new(Pose::new(DVec3::ZERO, 0.0), structure)]);
//!
//! // A batch of rays, side by side along y.
//! let ray = |number: usize| -> Result<Launch<1>, Stopped> {
//!     let origin = DVec3::new(-50.0, 0.25 + number as f64, 0.0);
//!     Ok(Launch { origin, direction: DVec3::X, electric: [DVec3::Y.into()] })
//! };
//! let limits = Limits { min_power: 1e-9, tolerance: 1e-6 };
//! let leaves = LeafTable::<1>::trace(&assembly, limits, 10, &ray, &|_| {}, &AtomicBool::new(false))?;
//!
//! assert_eq!(leaves.ray.len(), 10);
//! for (number, direction) in leaves.direction.iter().enumerate() {
//!     assert!(DVec3::from_array(*direction).distance(DVec3::X) < 1e-12);
//!     assert!((leaves.power[number][0] - 1.0).abs() < 1e-12);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod assembly;
pub mod device;
pub mod keys;
mod parallel;
pub mod split_mix;
pub mod walk;
