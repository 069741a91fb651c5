//! Lenses against an independent trace by Snell's law, against textbooks near the axis, and where
//! conics and balls are known to form an exact image; and the account of the power of all of them.

mod conics;
mod paraxial;
mod rochester_cloak;
mod snell;
mod touching;

use crate::rays::{launch, strongest};
use cloakroom::assembly::Assembly;
use cloakroom::trace::{Leaf, Limits, Tracer};
use glam::DVec3;

const LIMITS: Limits = Limits { min_power: 1e-3, tolerance: 1e-9 };

/// The strongest leaf of a ray.
fn through(assembly: &Assembly, origin: DVec3, direction: DVec3) -> Leaf<2> {
    let mut tracer = Tracer::new(assembly, LIMITS);
    let ray = launch(origin, direction);
    let (leaves, outcome) = tracer.trace(&ray);
    outcome.assert_balanced(leaves, 1e-12, &ray);
    strongest(leaves)
}

/// Where a leaf crosses a plane of constant x.
fn at_plane(leaf: &Leaf<2>, x: f64) -> DVec3 {
    leaf.position + leaf.direction * ((x - leaf.position.x) / leaf.direction.x)
}

/// The paraxial matrix [[A, B], [C, D]] of what stands about the x axis, between two planes of constant
/// x in air: of heights and slopes of rays ever nearer to the axis, extrapolated to none.
fn matrix(assembly: &Assembly, [from, to]: [f64; 2]) -> [[f64; 2]; 2] {
    let column = |height: f64, slope: f64| {
        let at = |share: f64| {
            let origin = DVec3::new(from, height * share, 0.0);
            let leaf = through(assembly, origin, DVec3::new(1.0, slope * share, 0.0));
            let height = at_plane(&leaf, to).y;
            [height / share, leaf.direction.y / leaf.direction.x / share]
        };
        // An even function of the share: Richardson's scheme takes its powers away.
        let mut rows: Vec<[f64; 2]> = (0..5).map(|k| at(0.5f64.powi(k))).collect();
        let mut power = 1.0;
        while rows.len() > 1 {
            power *= 4.0;
            let better = |pair: &[[f64; 2]]| {
                [0, 1].map(|i| pair[1][i] + (pair[1][i] - pair[0][i]) / (power - 1.0))
            };
            rows = rows.windows(2).map(better).collect();
        }
        rows[0]
    };
    let [heights, slopes] = [column(0.2, 0.0), column(0.0, 0.01)].map(|[a, b]| [a, b]);
    [[heights[0] / 0.2, slopes[0] / 0.01], [heights[1] / 0.2, slopes[1] / 0.01]]
}

/// The first matrix after the second.
fn after(one: [[f64; 2]; 2], first: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let entry = |i: usize, j: usize| one[i][0] * first[0][j] + one[i][1] * first[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

/// The matrix of a way.
fn gap(length: f64) -> [[f64; 2]; 2] {
    [[1.0, length], [0.0, 1.0]]
}

/// The matrix of a face, of slopes.
fn face(radius: f64, from: f64, to: f64) -> [[f64; 2]; 2] {
    let power = if radius == 0.0 { 0.0 } else { (to - from) / radius };
    [[1.0, 0.0], [-power / to, from / to]]
}

fn assert_near(found: [[f64; 2]; 2], wanted: [[f64; 2]; 2], within: f64, what: &str) {
    for i in 0..2 {
        for j in 0..2 {
            let off = (found[i][j] - wanted[i][j]).abs();
            assert!(off < within * wanted[i][j].abs().max(1.0), "{what}: {found:?} {wanted:?}");
        }
    }
}
