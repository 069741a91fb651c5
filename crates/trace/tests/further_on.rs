//! Branches followed from where they are, instead of from the start of their ray.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom_trace::assembly::{Assembly, Placed};
use cloakroom_trace::device::{
    Device, PrismOfMedium, Prisms, Request, SegmentMaterial, SquareCloak, Structure,
};
use cloakroom_trace::walk::{
    Branch, FourTracers, Launch, Leaf, Limits, PathRecorder, PathSegment, Tracer,
};
use glam::{DMat3, DVec3};
use optics::geometry::Pose;
use optics::medium::Tensor;

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

/// Takes branches to all planes around their region, and launched rays to a surface, as far as ways
/// are known.
#[derive(Clone, Debug, Default)]
struct Beside {
    known: Vec<u64>,
    surface: Option<(u16, u16)>,
}

impl PathRecorder<2> for Beside {
    fn record(&mut self, _: impl FnOnce() -> PathSegment<2>) {}

    fn planes(&self, path: u64) -> Option<u64> {
        Some(if path == 0 { 1 } else { 0b1111 })
    }

    fn first_surface(&self, _: u16) -> Option<(u16, u16)> {
        self.surface
    }

    fn went_on(&mut self, _: u64, to: u64, _: f64) -> bool {
        self.known.contains(&to)
    }
}

/// A plate of a biaxial crystal from x = 0 to 4, from y = -1 up to a height.
fn plate(height: f64) -> Structure {
    let re = DMat3::from_cols_array(&[2.4, 0.2, 0.1, 0.2, 2.2, -0.1, 0.1, -0.1, 2.6]);
    let prism = PrismOfMedium {
        corners: Some(vec![[0.0, -1.0], [4.0, -1.0], [4.0, height], [0.0, height]]),
        permittivity: Tensor { re, im: DMat3::ZERO }.into(),
        ..PrismOfMedium::default()
    };
    Prisms { prism: vec![prism], ..Prisms::default() }.build(Request::default()).unwrap()
}

/// A ray that is taken to a plane which it does not meet does there what it would do in a larger body.
#[test]
fn a_ray_taken_beyond_an_edge_goes_on_as_in_a_larger_body() {
    let placed = |height| {
        Assembly::new(vec![Placed::new(Pose::new(DVec3::new(1.0, -0.5, 0.2), 0.1), plate(height))])
    };
    let [small, large] = [1.0, 9.0].map(placed);
    let mut tried = 0;
    for (height, slope) in [(0.0, 0.6), (0.2, 0.5), (1.5, 0.2), (2.5, -0.1), (3.0, 0.3)] {
        let direction = DVec3::new(1.0, slope, 0.1).normalize();
        let electric =
            [direction.cross(DVec3::Z).normalize(), DVec3::Z.reject_from(direction).normalize()];
        let origin = DVec3::new(-2.0, height - 2.0 * slope, 0.4);
        let launch = Launch { origin, direction, electric: electric.map(Into::into) };
        let mut whole = Tracer::new(&large, LIMITS).watched(Watcher::default());
        let surface = whole.first_surface(origin, direction);
        let (leaves, _) = whole.trace(&launch);
        let leaves = by_path(leaves);
        let known = whole.watcher().came_of.iter().map(|(to, _)| *to).collect();
        let beside = Beside { known, surface };
        let mut taken = Tracer::new(&small, LIMITS).watched(beside);
        let found = by_path(taken.trace(&launch).0);
        // Without planes it goes another way.
        let mut real = Tracer::<2>::new(&small, LIMITS);
        let real = by_path(real.trace(&launch).0);
        let straight = |leaf: &&Leaf<2>| leaf.largest_power() > 0.1;
        for leaf in leaves.iter().filter(straight) {
            let same = found.iter().find(|found| found.path == leaf.path).unwrap();
            assert!(same.position.distance(leaf.position) < 1e-12, "{same:?} {leaf:?}");
            assert!(same.direction.distance(leaf.direction) < 1e-12, "{same:?} {leaf:?}");
            assert!((same.optical_path - leaf.optical_path).abs() < 1e-12, "{same:?} {leaf:?}");
            for (one, other) in same.electric.iter().zip(leaf.electric) {
                assert!((*one - other).norm_squared() < 1e-24, "{same:?} {leaf:?}");
            }
            tried += u32::from(real.iter().all(|real| real.path != leaf.path));
        }
    }
    assert!(tried > 5, "{tried} leaves are hardly a trial");
}

/// Which plane a ray meets is decided by straight lines, for rays beyond the planes, too: two parallel
/// ones that meet the same have none between them that meets another. What is met for sure is met
/// from wherever so near.
#[test]
fn parallel_rays_between_two_that_meet_a_plane_meet_it_too() {
    let assembly = Assembly::new(vec![Placed::new(Pose::IDENTITY, plate(1.0))]);
    let mut tracer = Tracer::new(&assembly, LIMITS).watched(Watcher::default());
    let electric = [DVec3::Y.into(), DVec3::Z.into()];
    tracer.trace(&Launch { origin: -DVec3::X, direction: DVec3::X, electric });
    let known = tracer.watcher().branches[0];
    let places: Vec<DVec3> = (0..12)
        .flat_map(|x| (0..9).map(move |y| DVec3::new(0.5 * f64::from(x), 0.37 * f64::from(y), 0.0)))
        .map(|place| place - DVec3::new(0.7, 1.9, 0.1))
        .collect();
    let (mut tried, mut sure) = (0, 0);
    for (x, y) in [(1.0, 0.3), (1.0, -0.8), (-0.2, 1.0), (-1.0, -0.1)] {
        let direction = DVec3::new(x, y, 0.2).normalize();
        let met = |position: DVec3, slack: f64| {
            let mut branch = known;
            (branch.position, branch.direction) = (position, direction);
            tracer.plane_met(&branch, slack)
        };
        for one in &places {
            for other in places.iter().filter(|other| met(**other, 0.0) == met(*one, 0.0)) {
                assert_eq!(met(one.lerp(*other, 0.4), 0.0), met(*one, 0.0), "{one} {other}");
                tried += 1;
            }
            if let Some(face) = met(*one, 0.05) {
                for moved in [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y] {
                    assert_eq!(met(*one + 0.0499 * moved, 0.0), Some(face), "{one}");
                }
                sure += 1;
            }
        }
    }
    assert!(tried > 10_000 && sure > 200, "{tried} {sure}");
}
