#![allow(clippy::unwrap_used, dead_code)]
#[path = "../../optics/tests/long.rs"]
mod long;
mod pictures;
mod prisms;
mod rays;
mod real_cloaks;
