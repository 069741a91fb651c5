//! Pairs of devices of all kinds that touch, in any pose: all power is accounted for, and no light
//! is in metal.

use crate::draws::Draws;
use crate::rays::launch_along;
use crate::scenes::assembly;
use cloakroom::assembly::{Assembly, Placed};
use cloakroom::trace::{Launch, LeafEnd, Limits, PathRecorder, PathSegment, Tracer};
use glam::{DMat3, DQuat, DVec2, DVec3};
use optics::geometry::{Pose, Solid};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};
use std::sync::LazyLock;

const LIMITS: Limits = Limits { min_power: 1e-3, tolerance: 1e-6 };

/// How deep in metal rounding may put light, cm.
const DEEP: f64 = 1e-6;

/// Convex metal about the origin of a device's frame, or what is surely in it.
#[derive(Clone, Copy, Debug)]
enum Metal {
    None,
    Box(DVec3),
    Ball(f64),
    Cylinder(f64, f64),
    /// Half its diagonals along x and y; as all devices here, 12 cm long.
    Rhombus(DVec2),
    /// Half its base, the height of its tip, and the level of its base.
    Triangle(DVec2, f64),
}

impl Metal {
    /// How deep a point lies in it, cm, less than 0 outside.
    fn depth(self, at: DVec3) -> f64 {
        let below_sides = |half: DVec2, at: DVec3| {
            let beside = 1.0 - at.x.abs() / half.x - at.y.abs() / half.y;
            (beside / half.recip().length()).min(6.0 - at.z.abs())
        };
        match self {
            Self::None => f64::NEG_INFINITY,
            Self::Box(half) => (half - at.abs()).min_element(),
            Self::Ball(radius) => radius - at.length(),
            Self::Cylinder(radius, half) => {
                (radius - at.truncate().length()).min(half - at.z.abs())
            }
            Self::Rhombus(half) => below_sides(half, at),
            Self::Triangle(half, level) => {
                below_sides(half, at - DVec3::Y * level).min(at.y - level)
            }
        }
    }

    /// How deep a straight way gets into it.
    fn deepest(self, mut from: DVec3, mut to: DVec3) -> f64 {
        // The depth is concave along it, and grows no faster than the way.
        while self.depth(from.midpoint(to)) + 0.5 * from.distance(to) > DEEP
            && from.distance(to) > 1e-8
        {
            let [a, b] = [from.lerp(to, 0.4), from.lerp(to, 0.6)];
            if self.depth(a) < self.depth(b) { from = a } else { to = b }
        }
        self.depth(from.midpoint(to))
    }
}

/// A device in its own frame.
struct Sort {
    text: String,
    metal: Metal,
    device: Placed,
    /// How far from its border light may be that has come there, cm.
    border: f64,
}

impl Sort {
    fn new(text: impl Into<String>, metal: Metal) -> Self {
        let text = text.into();
        let device = assembly(&format!("[[device]]\n{text}")).devices()[0].clone();
        // The floor of a quasi-conformal map is that of its device to 1e-4 of the bump's height.
        let border = if text.contains("quasi-conformal") { 1.7e-4 } else { 0.0 };
        Self { text, metal, device, border }
    }

    /// From where to where its parts reach along a direction.
    fn reaches(&self, normal: DVec3) -> impl Iterator<Item = [f64; 2]> {
        let turn = DMat3::from_quat(DQuat::from_rotation_arc(normal, DVec3::X));
        let pose = Pose::from_rotation(DVec3::ZERO, turn);
        let hull = &self.device.structure.hull;
        let bounds = move |solid: &Solid| solid.placed(&pose).bounds();
        let solids = hull.solids.iter().chain(&hull.thin_mirror);
        solids.filter_map(bounds).map(|ends| ends.map(|end| end.x))
    }

    /// How far it reaches along a direction.
    fn reach(&self, normal: DVec3) -> f64 {
        self.reaches(normal).map(|[_, high]| high).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether it has a sheet without thickness there.
    fn ends_in_sheet(&self, (normal, reach): Side) -> bool {
        self.reaches(normal).any(|[low, high]| high - low < 1e-9 && reach - high < 1e-9)
    }
}

/// A side of a device by which it touches: its normal and how far out it is.
type Side = (DVec3, f64);

/// All kinds, some 10 cm large and of finite length.
fn all_sorts() -> Vec<Sort> {
    let d = 14.1 * FRAC_1_SQRT_2;
    let rhombus = Metal::Rhombus(DVec2::new(d, d / 3f64.sqrt()));
    let lens = Metal::Rhombus(DVec2::new(4.0, 2.5));
    let (rod, ball) = (Metal::Cylinder(2.0, 6.0), Metal::Ball(2.0));
    let glass = "permittivity = 2.25";
    let rows = (0..8).map(|i| {
        let index = |j: i32| 1.2 + 0.02 * f64::from(i * (7 - i) + j);
        format!("{:?}", (0..8).map(index).collect::<Vec<_>>())
    });
    let index =
        format!("index = [{}]\nwidth = 10\nheight = 10", rows.collect::<Vec<_>>().join(", "));
    let in_space = |number: &dyn Fn(i32, i32, i32) -> String| {
        let list = |items: Vec<String>| format!("[{}]", items.join(", "));
        let row = |i, j| list((0..4).map(|k| number(i, j, k)).collect());
        list((0..4).map(|i| list((0..4).map(|j| row(i, j)).collect())).collect())
    };
    let numbers = in_space(&|i, j, k| format!("{:?}", 1.2 + 0.02 * f64::from(i * (3 - i) + j + k)));
    let index_in_space = format!("index = {numbers}\nwidth = 10\nheight = 10");
    let axes_in_space = in_space(&|i, j, k| format!("[1, {:?}, {j}]", 0.3 * f64::from(i - k)));
    let tensor = "permittivity = [[2.2, 0.1, 0], [0.1, 2.4, 0], [0, 0, 2.7]]";
    let lossy = "permittivity = [2.25, 1e-6]";
    let carpet = "width = 16\nheight = 8\nlength = 12\nfloor";
    let sorts = [
        ("square-cloak", "length = 12".to_owned(), rhombus),
        ("square-cloak", "length = 12\nmaterial = \"positive-uniaxial\"".into(), rhombus),
        ("square-cloak", "length = 12\nmaterial = \"negative-uniaxial\"".into(), rhombus),
        ("square-cloak", "length = 12\ncore = \"open\"".into(), Metal::None),
        ("square-cloak", "length = 12\nshow = \"bare\"".into(), rhombus),
        (
            "double-gaussian-cloak",
            "w = 6\nh = 2.5\nwidth = 20\nheight = 20\nlength = 12".into(),
            lens,
        ),
        ("cylinder-cloak", "inner = 2\nouter = 5\nlength = 12".into(), rod),
        (
            "cylinder-cloak",
            "inner = 2\nouter = 5\nlength = 12\nmaterial = \"radial-uniaxial\"".into(),
            rod,
        ),
        (
            "cylinder-cloak",
            "inner = 2\nouter = 5\nlength = 12\nmaterial = \"azimuthal-uniaxial\"".into(),
            rod,
        ),
        ("sphere-cloak", "inner = 2\nouter = 5".into(), ball),
        ("invisible-sphere", "radius = 5".into(), Metal::None),
        ("invisible-sphere", "radius = 5\nmaterial = \"regularized\"".into(), Metal::None),
        ("bending-sphere", "radius = 5".into(), Metal::None),
        ("bending-sphere", "radius = 5\nangle = 45".into(), Metal::None),
        ("eaton-lens", "radius = 5".into(), Metal::None),
        ("luneburg-lens", "radius = 5".into(), Metal::None),
        ("fisheye-lens", "radius = 5".into(), Metal::None),
        ("fisheye-hemisphere", "radius = 5\ncut_distance = 1".into(), Metal::None),
        ("mirror-detour", "offset = 3\nhalf_length = 6\nlength = 12".into(), Metal::None),
        (
            "prisms",
            format!(
                "length = 8\n[[device.prism]]\ncorners = [[0, 0], [4, -2], [0, 5], [-4, -2]]\n{glass}\n\
                 [[device.prism]]\ncorners = [[0, 0], [-4, -2], [4, -2]]\n{tensor}"
            ),
            Metal::None,
        ),
        ("graded", format!("{index}\nlength = 12"), Metal::None),
        ("graded", format!("{index}\nlength = 12\nshape = \"circle\"\ninner = 2"), rod),
        ("graded", format!("{index_in_space}\nlength = 12\nshape = \"ball\""), Metal::None),
        (
            "graded",
            format!("{index}\nlength = 12\nratio = 1.1\noptic_axis = [1, 2, 0.5]"),
            Metal::None,
        ),
        (
            "graded",
            format!("{index_in_space}\nlength = 12\nratio = 0.9\noptic_axis = {axes_in_space}"),
            Metal::None,
        ),
        ("graded-box", "sides = [8, 10, 12]".into(), Metal::None),
        ("body", format!("shape = \"sphere\"\n{glass}"), Metal::None),
        ("body", format!("shape = \"box\"\n{tensor}"), Metal::None),
        ("body", format!("shape = \"cylinder\"\nradius = 3\nlength = 8\n{lossy}"), Metal::None),
        (
            "body",
            "shape = \"box\"\nsize = [6, 8, 10]\npermittivity = -1.5\npermeability = -1".into(),
            Metal::None,
        ),
        ("mirror", "width = 8\nheight = 10".into(), Metal::None),
        (
            "polyhedron",
            format!(
                "vertices = [[-4, -4, -3], [4, -4, -3], [0, 5, -3], [0, 0, 5], [3, 3, 0]]\n{glass}"
            ),
            Metal::None,
        ),
        (
            "polyhedron",
            format!(
                "planes = [[1, 0, 0, 4], [-1, 0, 0, 4], [0, 1, 1, 4], [0, -1, 1, 4], [0, 0, -1, 3]]\n{tensor}"
            ),
            Metal::None,
        ),
        (
            "lens",
            "front_radius = 9\nback_radius = -7\nthickness = 4\ndiameter = 9".into(),
            Metal::None,
        ),
        (
            "lens",
            format!("front_radius = -9\nback_radius = 12\nthickness = 2\ndiameter = 10\n{lossy}"),
            Metal::None,
        ),
        (
            "lens",
            format!(
                "front_radius = 6\nback_radius = 8\nback_conic = -2\nthickness = 2\ndiameter = 9\n{tensor}"
            ),
            Metal::None,
        ),
        (
            "gaussian-carpet",
            format!("w = 4\nh = 1.7\n{carpet} = 0"),
            Metal::Triangle(DVec2::new(2.5, 1.7), 0.0),
        ),
        (
            "gaussian-carpet",
            format!("w = 4\nh = 1.7\n{carpet} = 18\nshow = \"bare\""),
            Metal::Triangle(DVec2::new(2.5, 1.7), 0.0),
        ),
        (
            "grating-carpet",
            format!("h = 0.5\nperiod = 8\n{carpet} = 20"),
            Metal::Triangle(DVec2::new(0.7, 0.5), 0.0),
        ),
        (
            "quasi-conformal-carpet",
            format!("w = 10\nh = 1.7\n{carpet} = 0"),
            Metal::Triangle(DVec2::new(2.5, 1.7), 0.0),
        ),
        ("polarizer", "width = 10\nlength = 12\nangle = 30".into(), Metal::None),
    ];
    sorts
        .into_iter()
        .map(|(kind, keys, metal)| Sort::new(format!("kind = \"{kind}\"\n{keys}\n"), metal))
        .collect()
}

/// A block of metal or of what is opaque, of sizes of one decimal, and a side of it.
fn metal_block(draws: &mut Draws<'_>) -> (Sort, Side) {
    let half = DVec3::from_array([0; 3].map(|_| draws.tenths(0.1, 4.0)));
    let DVec3 { x, y, z } = half;
    let opaque = "surface = { color = [1, 1, 1] }";
    let prism = format!(
        "[[device.prism]]\nmetal = true\ncorners = [[{x}, {y}], [-{x}, {y}], [-{x}, -{y}], [{x}, -{y}]]"
    );
    let body = |shape: &str| format!("kind = \"body\"\nshape = \"{shape}\"\n{opaque}\n");
    let length = format!("length = {:.1}", 2.0 * z);
    let round = Metal::Cylinder(x, z);
    let (text, metal, side) = match draws.below(6) {
        0 => {
            let endless = half.with_z(f64::INFINITY);
            (format!("kind = \"prisms\"\n{prism}\n"), Metal::Box(endless), (DVec3::X, x))
        }
        1 => {
            let side = *draws.pick(&[(DVec3::X, x), (DVec3::NEG_Y, y), (DVec3::Z, z)]);
            (format!("kind = \"prisms\"\n{length}\n{prism}\n"), Metal::Box(half), side)
        }
        2 => {
            let side = *draws.pick(&[(DVec3::NEG_X, x), (DVec3::Y, y), (DVec3::NEG_Z, z)]);
            let size = format!("size = [{:.1}, {:.1}, {:.1}]\n", 2.0 * x, 2.0 * y, 2.0 * z);
            (body("box") + &size, Metal::Box(half), side)
        }
        3 => {
            let side = (draws.direction(), x);
            (format!("{}radius = {x}\n", body("sphere")), Metal::Ball(x), side)
        }
        4 => (format!("{}radius = {x}\n{length}\n", body("cylinder")), round, (DVec3::NEG_Z, z)),
        _ => (format!("{}radius = {x}\n{length}\n", body("cylinder")), round, (DVec3::NEG_Y, x)),
    };
    (Sort::new(text, metal), side)
}

/// A direction by which a device may touch another: often that of a face of it, or across its axis.
fn normal(draws: &mut Draws<'_>) -> DVec3 {
    let sign = draws.pick(&[1.0, -1.0]);
    match draws.below(4) {
        0 => *draws.pick(&DVec3::AXES) * *sign,
        1 => DVec3::new(FRAC_1_SQRT_2, FRAC_1_SQRT_2 * sign, 0.0) * *draws.pick(&[1.0, -1.0]),
        2 => DVec2::from_angle(draws.between(0.0, TAU)).extend(0.0),
        _ => draws.direction(),
    }
}

/// Two devices that touch at a plane.
struct Pair<'a> {
    sorts: [&'a Sort; 2],
    assembly: Assembly,
    /// The frame in which they touch at the plane x = `at`.
    pose: Pose,
    at: f64,
}

impl std::fmt::Debug for Pair<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (sort, device) in self.sorts.iter().zip(self.assembly.devices()) {
            write!(f, "[[device]]\n{}{:?}\n", sort.text, device.pose)?;
        }
        Ok(())
    }
}

impl<'a> Pair<'a> {
    /// Devices side by side along x, each touching by a side, at a place of one decimal; half of
    /// the pairs upright, half turned about any axis. None if sheets lie on each other, which is
    /// refused.
    fn new(sorts: [&'a Sort; 2], sides: [Side; 2], draws: &mut Draws<'_>) -> Option<Self> {
        let at = draws.tenths(-5.0, 5.0);
        let is_turned = draws.share() < 0.5;
        let pose = if is_turned { draws.pose() } else { Pose::IDENTITY };
        let devices = [0, 1].map(|i| {
            let (normal, reach) = sides[i];
            let along = if i == 0 { DVec3::X } else { DVec3::NEG_X };
            let roll = if is_turned { draws.between(0.0, TAU) } else { 0.0 };
            let turn = DMat3::from_rotation_x(roll)
                * DMat3::from_quat(DQuat::from_rotation_arc(normal, along));
            // A number as one writes it, where that is short.
            let x = ((at - along.x * reach) * 1e12).round() / 1e12;
            let own = Pose::from_rotation(DVec3::X * x, turn);
            Placed::new(pose.after(&own), sorts[i].device.structure.clone())
        });
        let pair = Self { sorts, assembly: Assembly::new(devices.to_vec()), pose, at };
        let are_sheets = sorts.iter().zip(sides).all(|(sort, side)| sort.ends_in_sheet(side));
        let overlap = pair.assembly.overlap();
        assert!(are_sheets || overlap.is_none(), "{pair:?}");
        overlap.is_none().then_some(pair)
    }

    /// A ray onto the plane, from before it or from beyond.
    fn ray(&self, before: bool, draws: &mut Draws<'_>) -> Launch<2> {
        let mut across =
            |half: f64| DVec2::new(draws.between(-half, half), draws.between(-half, half));
        let (target, from) = (across(3.0), across(60.0));
        let far = if before { -80.0 } else { 80.0 };
        let (target, from) = (target.extend(self.at), from.extend(self.at + far));
        let [target, from] = [target, from].map(|p| self.pose.to_world(DVec3::new(p.z, p.x, p.y)));
        launch_along(from, target - from)
    }

    /// Follows a ray: all of its power is accounted for, and none of it is in metal.
    fn follow(&self, ray: &Launch<2>) {
        let guard = Guard { pair: self, deepest: (0.0, None) };
        let mut tracer = Tracer::new(&self.assembly, LIMITS).watched(guard);
        let (leaves, outcome) = tracer.trace(ray);
        outcome.assert_balanced(leaves, 1e-9, &(self, ray));
        let away = leaves.iter().filter(|leaf| leaf.end == LeafEnd::Away);
        let ways: Vec<_> =
            away.map(|leaf| [leaf.position, leaf.position + leaf.direction * 1000.0]).collect();
        let guard = tracer.recorder();
        ways.iter().for_each(|way| guard.see(way, None));
        let (deepest, place) = guard.deepest;
        let deep = self.sorts.iter().map(|sort| sort.border).fold(DEEP, f64::max);
        assert!(deepest <= deep, "{deepest} deep in metal at {place:?}\n{self:?}{ray:?}");
    }
}

/// Watches how deep light gets into metal.
struct Guard<'a> {
    pair: &'a Pair<'a>,
    deepest: (f64, Option<[DVec3; 2]>),
}

impl Guard<'_> {
    /// A way in the world, in a device or in air.
    fn see(&mut self, way: &[DVec3], inside: Option<usize>) {
        let devices = self.pair.assembly.devices();
        for (number, (sort, device)) in self.pair.sorts.iter().zip(devices).enumerate() {
            // In a graded medium only the points of the drawn way are exact.
            let bent = inside == Some(number) && way.len() > 2;
            for ends in way.windows(2) {
                let [from, to] = [ends[0], ends[1]].map(|at| device.pose.to_local(at));
                let depth = if bent {
                    sort.metal.depth(from).max(sort.metal.depth(to))
                } else {
                    sort.metal.deepest(from, to)
                };
                if depth > self.deepest.0 {
                    self.deepest = (depth, Some([ends[0], ends[1]]));
                }
            }
        }
    }
}

impl PathRecorder<2> for Guard<'_> {
    fn record(&mut self, leg: impl FnOnce() -> PathSegment<2>) {
        let leg = leg();
        let inside = leg.inside.map(|(device, _)| usize::from(device));
        let pose = inside.map(|device| self.pair.assembly.devices()[device].pose);
        let world = |at: DVec3| pose.map_or(at, |pose| pose.to_world(at));
        let way: Vec<_> = leg.path.iter().map(|at| world(at.position)).collect();
        self.see(&way, inside);
    }
}

/// All kinds of devices that may touch.
static SORTS: LazyLock<Vec<Sort>> = LazyLock::new(all_sorts);

/// How many kinds there are.
#[must_use]
pub fn touching_kinds() -> usize {
    SORTS.len()
}

/// Has two devices of any kinds touch, or one and a block of metal, and sends rays there; how many.
///
/// # Panics
///
/// As [`touch`].
pub fn touch_any(draws: &mut Draws<'_>) -> u64 {
    let kinds = touching_kinds();
    let (kind, other) = (draws.below(kinds), draws.below(2 * kinds));
    touch(kind, (other < kinds).then_some(other), draws)
}

/// Has a device of a kind touch one of another, or a block of metal, anywhere, and sends rays there;
/// how many.
///
/// # Panics
///
/// If light is in metal, or power is not accounted for.
pub fn touch(kind: usize, other: Option<usize>, draws: &mut Draws<'_>) -> u64 {
    const RAYS: u64 = 4;
    let side = |sort: &Sort, draws: &mut Draws<'_>| {
        let normal = normal(draws);
        (normal, sort.reach(normal))
    };
    let one = &SORTS[kind % SORTS.len()];
    let at_one = side(one, draws);
    let block;
    let (other, at_other) = match other {
        Some(other) => {
            let other = &SORTS[other % SORTS.len()];
            (other, side(other, draws))
        }
        None => {
            let (made, side) = metal_block(draws);
            block = made;
            (&block, side)
        }
    };
    let Some(pair) = Pair::new([one, other], [at_one, at_other], draws) else { return 0 };
    for number in 0..RAYS {
        pair.follow(&pair.ray(number % 2 == 0, draws));
    }
    RAYS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_in_metal_is_seen() {
        let sorts = [Sort::new(
            "kind = \"body\"\npermittivity = 2.25\nshape = \"box\"\n",
            Metal::Ball(2.0),
        )];
        let side = |normal| (normal, 5.0);
        let mut draws = Draws::Seed(3);
        let pair = Pair::new([&sorts[0], &sorts[0]], [side(DVec3::X), side(DVec3::X)], &mut draws)
            .expect("no sheets");
        let mut guard = Guard { pair: &pair, deepest: (0.0, None) };
        let way = [-20.0, 20.0].map(|x| pair.pose.to_world(DVec3::new(x, 0.5, 0.0)));
        guard.see(&way, None);
        assert!((guard.deepest.0 - 1.5).abs() < 1e-9, "{:?}", guard.deepest);
    }

    #[test]
    fn bare_metal_beside_another_device_sends_light_back_twice() {
        // From the flank of the bump to its slope, and on: the same curved surface is met again.
        let metal = Metal::Triangle(DVec2::new(2.5, 1.7), 0.0);
        let carpet = "kind = \"gaussian-carpet\"\nw = 4\nh = 1.7\nwidth = 16\nheight = 8\nlength = 12\n\
                      floor = 0\nshow = \"bare\"\n";
        let block = "kind = \"body\"\nshape = \"box\"\nposition = [0, -60, 0]\nsize = [1, 1, 1]\n";
        for scene in
            [format!("[[device]]\n{carpet}"), format!("[[device]]\n{carpet}[[device]]\n{block}")]
        {
            let assembly = assembly(&scene);
            let from = DVec3::new(-75.65248864504684, 8.861979943570812, -8.55665947216152);
            let along = DVec3::new(0.9883195716285171, -0.1274860746435289, 0.08349685687502995);
            let mut tracer = Tracer::new(&assembly, LIMITS);
            let ray = launch_along(from, along);
            let (leaves, outcome) = tracer.trace(&ray);
            outcome.assert_balanced(leaves, 1e-9, &ray);
            for leaf in leaves {
                let end = leaf.position + leaf.direction * 100.0;
                assert!(metal.deepest(leaf.position, end) < DEEP, "{scene}{leaf:?}");
            }
        }
    }
}
