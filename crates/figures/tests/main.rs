//! The gallery as rays see it, and the paper, statement by statement, in one program.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod gallery;
mod validation;
