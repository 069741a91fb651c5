//! What cloakroom must stand: any input, any scene, any ray.
//!
//! A [`Trial`] takes bytes, makes something of them (a text, an image, a scene with rays), hands it
//! to the program, and panics where something comes out that must not: a panic, a number that is
//! none, power out of nowhere. The folder `fuzz/` has libFuzzer choose the bytes; the tests of this
//! crate do so briefly, and repeat every input that once found a fault (`regressions/`). The
//! program `soak` traces random rays through random devices and counts.

mod birefringence;
mod cuts;
mod draws;
mod flights;
mod interpolation;
mod page;
mod rays;
mod scenes;
mod stacks;
mod touching;
mod trials;

pub use birefringence::hardly_birefringent;
pub use cuts::cut_glass;
pub use draws::Draws;
pub use flights::fly;
pub use interpolation::{interpolate, interpolate_small, interpolate_straight};
pub use rays::{Fault, examine, launch, starts_in_air, timed};
pub use scenes::{SoundScene, sound_scene};
pub use stacks::stack;
pub use touching::{touch, touch_any, touching_kinds};
pub use trials::{TRIALS, Trial};

/// Runs the trial of a name.
///
/// # Panics
///
/// If something is wrong, or there is no such trial.
pub fn run(name: &str, bytes: &[u8]) {
    let trial = TRIALS.iter().find(|trial| trial.name == name);
    (trial.unwrap_or_else(|| panic!("there is no trial {name}")).run)(bytes);
}
