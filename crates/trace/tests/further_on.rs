//! Branches followed from where they are, instead of from the start of their ray.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom_trace::assembly::{Assembly, Placed};
use cloakroom_trace::device::{Device, Request, SegmentMaterial, SquareCloak};
use cloakroom_trace::walk::{
    Branch, FourTracers, Launch, Leaf, Limits, PathRecorder, PathSegment, Tracer,
};
use glam::DVec3;
use optics::geometry::Pose;

const LIMITS: Limits = Limits { min_power: 1e-4, tolerance: 1e-9 };

/// Every branch in a homogeneous medium, what came of what, and which one is left out.
#[derive(Clone, Debug, Default)]
struct Watcher {
    branches: Vec<Branch<2>>,
    came_of: Vec<(u64, u64)>,
    left_out: Option<u64>,
}

impl PathRecorder<2> for Watcher {
    fn record(&mut self, _: impl FnOnce() -> PathSegment<2>) {}

    fn begins(&mut self, branch: &Branch<2>) {
        self.branches.push(*branch);
    }

    fn went_on(&mut self, from: u64, to: u64, _: f64) -> bool {
        self.came_of.push((to, from));
        self.left_out != Some(to)
    }
}

fn by_path(leaves: &[Leaf<2>]) -> Vec<Leaf<2>> {
    let mut leaves = leaves.to_vec();
    leaves.sort_by_key(|leaf| leaf.path);
    leaves
}

/// What comes of a branch is the same, whether its ray or it alone is followed; and what is left
/// out is that, and nothing else.
#[test]
fn a_branch_taken_further_on_ends_where_its_ray_does() {
    let cloak =
        SquareCloak { material: SegmentMaterial::PositiveUniaxial, ..SquareCloak::default() };
    let structure = cloak.build(Request::default()).unwrap();
    let assembly = Assembly::new(vec![Placed::new(Pose::new(DVec3::ZERO, 0.2), structure)]);
    let tracer = Tracer::new(&assembly, LIMITS).watched(Watcher::default());
    let mut four = FourTracers::new(&tracer);
    let mut whole = tracer.clone();
    let mut tried = 0;
    for height in [-4.1, -1.3, 0.6, 3.2] {
        let origin = DVec3::new(-60.0, height, 0.4);
        let electric = [DVec3::Y.into(), DVec3::Z.into()];
        let launch = Launch { origin, direction: DVec3::X, electric };
        *whole.recorder() = Watcher::default();
        let (leaves, outcome) = whole.trace(&launch);
        let (leaves, pruned) = (by_path(leaves), outcome.pruned);
        let Watcher { branches, came_of, .. } = whole.recorder().clone();
        let comes_of = |mut path: u64, start: u64| {
            while path != start {
                match came_of.iter().find(|(to, _)| *to == path) {
                    Some((_, from)) => path = *from,
                    None => return false,
                }
            }
            true
        };
        for branch in branches.iter().filter(|branch| branch.is_movable()).step_by(2) {
            let (part, rest): (Vec<_>, Vec<_>) =
                leaves.iter().copied().partition(|leaf| comes_of(leaf.path, branch.path));
            // One from there, one all but that, one both together, and one nothing.
            let [alone, without, both, nothing] = &mut four.tracers;
            *alone.recorder() = Watcher::default();
            *without.recorder() = Watcher { left_out: Some(branch.path), ..Watcher::default() };
            *both.recorder() = without.recorder().clone();
            *nothing.recorder() = Watcher::default();
            let launches = [launch; 4];
            let further_on = [vec![*branch], vec![], vec![*branch], vec![]];
            four.trace_further_on(&launches, [false; 4], &further_on);
            assert_eq!(by_path(four.tracers[0].traced().0), part);
            assert!(four.tracers[1].traced().0.is_empty());
            four.trace_further_on(&launches, [true; 4], &further_on);
            assert_eq!(by_path(four.tracers[1].traced().0), rest);
            let (found, outcome) = four.tracers[2].traced();
            assert_eq!(by_path(found), leaves);
            assert!((outcome.pruned[0] - pruned[0]).abs() < 1e-15);
            tried += 1;
        }
    }
    assert!(tried > 20, "{tried}");
}

/// A branch that is moved out of its region is lost, and counted.
#[test]
fn a_branch_out_of_its_region_is_lost() {
    let cloak = SquareCloak::default().build(Request::default()).unwrap();
    let assembly = Assembly::new(vec![Placed::new(Pose::IDENTITY, cloak)]);
    let tracer = Tracer::new(&assembly, LIMITS).watched(Watcher::default());
    let mut whole = tracer.clone();
    let origin = DVec3::new(-60.0, 2.0, 0.0);
    let electric = [DVec3::Y.into(), DVec3::Z.into()];
    let launch = Launch { origin, direction: DVec3::X, electric };
    whole.trace(&launch);
    let mut branch = *whole.recorder().branches.iter().find(|branch| branch.is_movable()).unwrap();
    branch.position.x -= 1.0;
    let mut four = FourTracers::new(&tracer);
    four.trace_further_on(&[launch; 4], [false; 4], &[vec![branch], vec![], vec![], vec![]]);
    let (leaves, outcome) = four.tracers[0].traced();
    assert_eq!((leaves.len(), outcome.stats.lost), (0, 1));
    assert_eq!(outcome.pruned, branch.power);
}
