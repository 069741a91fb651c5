//! The trials for a moment each, and what the soak has found.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod briefly;
#[path = "../../optics/tests/long.rs"]
mod long;
mod soaked;
mod touching;
