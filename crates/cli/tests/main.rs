//! All tests of the command, in one program: one is linked faster than many.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod animating;
mod bad_input;
mod book;
mod commands;
mod everyday;
mod faults;
mod flying;
#[path = "../../optics/tests/long.rs"]
mod long;
mod measuring;
mod release;
mod running;
mod viewing;
