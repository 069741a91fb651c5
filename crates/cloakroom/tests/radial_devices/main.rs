//! Balls and round cylinders, whole, against what is known of them from elsewhere.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod cloaks;
mod lenses;
mod places;
#[path = "../rays/mod.rs"]
mod rays;
mod uniaxial_cylinder;

use cloakroom::render::StudioError;
use cloakroom::trace::{Bench, Launch, Leaf, Limits, Rarities, Tracer};
use rays::{Numbers, launch};

const LIMITS: Limits = Limits { min_power: 1e-9, tolerance: 1e-9 };

fn try_bench(device: &str) -> Result<Bench, StudioError> {
    rays::try_bench(&format!("[[device]]\nkind = {device}\n"))
}

fn bench(device: &str) -> Bench {
    try_bench(device).unwrap()
}

/// The leaves of a ray of which nothing was lost.
fn leaves(bench: &Bench, launch: &Launch<2>) -> Vec<Leaf<2>> {
    let mut tracer = Tracer::new(bench, LIMITS);
    let (leaves, outcome) = tracer.trace(launch);
    assert_eq!(outcome.rarities, Rarities::default(), "{launch:?}");
    leaves.to_vec()
}

/// The one leaf of a ray that is not divided.
fn leaf(bench: &Bench, launch: &Launch<2>) -> Leaf<2> {
    let leaves = leaves(bench, launch);
    assert_eq!(leaves.len(), 1, "{launch:?} {leaves:?}");
    for power in leaves[0].power {
        assert!((power - 1.0).abs() < 1e-12, "{launch:?} {power}");
    }
    leaves[0]
}

/// A ray from 50 cm away that passes the origin at a distance of up to 10 cm, and that distance.
fn random_launch(numbers: &mut Numbers) -> (Launch<2>, f64) {
    let direction = numbers.direction();
    let across = direction.cross(numbers.direction()).normalize();
    let impact = 10.0 * numbers.next().sqrt();
    (launch(across * impact - direction * 50.0, direction), impact)
}
