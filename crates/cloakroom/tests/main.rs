//! All tests of scenes, devices and pictures, in one program: one is linked faster than many.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod adaptive;
mod any_pose;
mod birefringent_square_cloak;
mod birefringent_square_cloak_tree;
mod body;
mod carpet_cloaks;
mod closed_form;
mod coatings;
mod coherence;
mod conformance;
mod devices;
mod double_gaussian_cloak;
mod equation_of_motion;
mod first_face;
mod flight;
mod glass_prism;
mod graded;
mod group_delay;
mod immersed;
mod imperfection;
mod lens;
#[path = "../../optics/tests/long.rs"]
mod long;
mod material;
mod materials;
mod mirror_detour;
mod mirrors;
mod open_core;
mod photograph_border;
mod pictured_bodies;
mod pictures;
mod plain_tree;
mod polyhedra;
mod prisms;
mod pruning;
mod pulses;
mod quality;
mod radial_devices;
mod rays;
mod real_cloaks;
mod square_cloak;
mod stokes;
mod touching;
mod transfer_matrix;
