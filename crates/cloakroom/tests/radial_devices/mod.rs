//! Balls and round cylinders, whole, against what is known of them from elsewhere.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod cloaks;
mod lenses;
mod places;
mod uniaxial_cylinder;

use crate::rays::{self, Numbers, launch};
use cloakroom::assembly::Assembly;
use cloakroom::render::PreparedSceneError;
use cloakroom::trace::{Launch, Leaf, Limits, TraceStats, Tracer};

const LIMITS: Limits = Limits { min_power: 1e-9, tolerance: 1e-9 };

fn try_bench(device: &str) -> Result<Assembly, PreparedSceneError> {
    rays::try_bench(&format!("[[device]]\nkind = {device}\n"))
}

fn assembly(device: &str) -> Assembly {
    try_bench(device).unwrap()
}

/// The leaves of a ray whose power is accounted for, and in whose tree nothing was rare.
fn leaves(assembly: &Assembly, launch: &Launch<2>) -> Vec<Leaf<2>> {
    let mut tracer = Tracer::new(assembly, LIMITS);
    let (leaves, outcome) = tracer.trace(launch);
    assert_eq!(outcome.stats, TraceStats::default(), "{launch:?}");
    outcome.assert_balanced(leaves, 1e-9, launch);
    leaves.to_vec()
}

/// The one leaf of a ray that is not divided.
fn leaf(assembly: &Assembly, launch: &Launch<2>) -> Leaf<2> {
    let leaves = leaves(assembly, launch);
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
