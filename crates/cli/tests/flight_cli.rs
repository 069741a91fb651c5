//! One.
#![allow(clippy::unwrap_used, dead_code)]
mod flying;
mod running;
