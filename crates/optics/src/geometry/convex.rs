//! Prisms and round cylinders in any pose: whether they are in each other's way.

use super::{CutBall, Extent, Outline, Pose, Solid};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::TAU;

/// How far what has no end is drawn, and is in the way of others, cm from its own origin.
pub const REACH: f64 = 1e5;

/// A prism or a round cylinder at its place.
#[derive(Clone, Copy)]
pub(super) struct Convex<'s> {
    section: Section<'s>,
    extent: Extent,
    pose: Pose,
}

/// The cross-section of a convex body along its axis.
#[derive(Clone, Copy)]
enum Section<'s> {
    Outline(&'s Outline),
    Disc { centre: DVec2, radius: f64 },
}

/// A bound on how deep a point lies in a convex body: positive inside, at most its distance to the border.
enum Bound {
    /// `offset` - `normal`·p.
    Plane { normal: DVec3, offset: f64 },
    /// `radius` less the distance from the line through `point` along the unit vector `axis`.
    Tube { point: DVec3, axis: DVec3, radius: f64 },
    /// `radius` less the distance from `centre`.
    Ball { centre: DVec3, radius: f64 },
}

impl Bound {
    /// How deep a point lies, and the gradient of that.
    fn depth(&self, at: DVec3) -> (f64, DVec3) {
        let (aside, radius) = match *self {
            Self::Plane { normal, offset } => return (offset - normal.dot(at), -normal),
            Self::Tube { point, axis, radius } => {
                ((at - point).reject_from_normalized(axis), radius)
            }
            Self::Ball { centre, radius } => (at - centre, radius),
        };
        let distance = aside.length();
        (radius - distance, -aside / distance.max(f64::MIN_POSITIVE))
    }
}

impl<'s> Convex<'s> {
    /// A solid that is a prism or a cylinder.
    pub fn of(solid: &'s Solid) -> Option<Self> {
        let upright = |section, extent| Self { section, extent, pose: Pose::IDENTITY };
        match solid {
            Solid::Prism { outline, .. } if outline.corners().is_empty() => None,
            Solid::Prism { outline, extent } => Some(upright(Section::Outline(outline), *extent)),
            Solid::Cylinder { centre, radius, extent } => {
                Some(upright(Section::Disc { centre: *centre, radius: *radius }, *extent))
            }
            Solid::Tilted { solid, pose } => {
                Self::of(solid).map(|own| Self { pose: pose.after(&own.pose), ..own })
            }
            _ => None,
        }
    }

    pub fn seen_from(self, frame: &Pose) -> Self {
        Self { pose: frame.inverse().after(&self.pose), ..self }
    }

    pub fn is_tilted(&self) -> bool {
        !self.pose.is_upright()
    }

    /// Its ends, those of endless ones at [`REACH`].
    fn ends(&self) -> [f64; 2] {
        [self.extent.min.max(-REACH), self.extent.max.min(REACH)]
    }

    /// Bounds that hold together just inside. A sheet counts as thin as `thickness`, and steep: where more
    /// than half of that is left in it, no point is farther from its plane than an eighth.
    fn bounds(&self, thickness: f64) -> Vec<Bound> {
        let plane = |normal: DVec3, offset: f64| {
            let normal = self.pose.vector_to_world(normal);
            Bound::Plane { normal, offset: offset + normal.dot(self.pose.origin) }
        };
        let ends = [(DVec3::Z, self.extent.max), (DVec3::NEG_Z, -self.extent.min)];
        let ends = ends.into_iter().filter(|(_, offset)| offset.is_finite());
        let mut bounds: Vec<Bound> = ends.map(|(normal, offset)| plane(normal, offset)).collect();
        match self.section {
            Section::Disc { centre, radius } => bounds.push(Bound::Tube {
                point: self.pose.to_world(centre.extend(0.0)),
                axis: self.pose.axis(),
                radius,
            }),
            Section::Outline(outline) if outline.corners().len() == 2 => {
                let (a, b) = (outline.corners()[0], outline.corners()[1]);
                let along = (b - a).normalize_or_zero();
                let across = 4.0 * along.perp();
                for (normal, offset) in [
                    (along, along.dot(b)),
                    (-along, -along.dot(a)),
                    (across, across.dot(a) + thickness),
                    (-across, -across.dot(a) + thickness),
                ] {
                    bounds.push(plane(normal.extend(0.0), offset));
                }
            }
            Section::Outline(outline) => {
                for (a, b) in outline.sides() {
                    let outward = -(b - a).perp().normalize_or_zero();
                    bounds.push(plane(outward.extend(0.0), outward.dot(a)));
                }
            }
        }
        bounds
    }

    /// An ellipsoid around it: its middle, and a matrix that makes it of the unit ball.
    fn ellipsoid(&self) -> (DVec3, DMat3) {
        let (middle, radius) = match self.section {
            Section::Disc { centre, radius } => (centre, radius),
            Section::Outline(outline) => {
                let corners = outline.corners();
                let middle = corners.iter().sum::<DVec2>() / corners.len() as f64;
                let far = corners.iter().map(|corner| corner.distance(middle));
                (middle, far.fold(0.0, f64::max))
            }
        };
        let [low, high] = self.ends();
        let half = DVec3::new(radius, radius, 0.5 * (high - low)) * 2f64.sqrt();
        let matrix = self.pose.rotation() * DMat3::from_diagonal(half);
        (self.pose.to_world(middle.extend(0.5 * (low + high))), matrix)
    }

    /// Whether two of them press into each other by more than `slack`: see [`meet_deep`].
    pub fn overlaps(&self, other: &Self, slack: f64) -> bool {
        let (from, to) = if self.ellipsoid().1.determinant() < other.ellipsoid().1.determinant() {
            (self, other)
        } else {
            (other, self)
        };
        // In the frame of the smaller one, where its coordinates are small.
        let frame = from.pose;
        let (from, to) = (from.seen_from(&frame), to.seen_from(&frame));
        let mut bounds = from.bounds(slack);
        bounds.extend(to.bounds(slack));
        meet_deep(&bounds, from.ellipsoid(), slack)
    }

    /// The greatest value of a convex function over the part of the body that lies between two z of its common
    /// frame: it is at a corner or on a rim. Rims are sampled and the greatest sample refined.
    pub fn greatest(&self, slab: Extent, value: impl Fn(DVec3) -> f64) -> f64 {
        let Extremes { corners, curves } = self.outermost(slab);
        let around = |curve: &Curve<'_>| {
            greatest_around(&|angle| curve(angle).map_or(f64::NEG_INFINITY, &value))
        };
        let on_curves = curves.iter().map(around);
        corners.into_iter().map(&value).chain(on_curves).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Points between which all of the part of the body lies that is between two z, curves as many points.
    pub fn extremes(&self, slab: Extent) -> Vec<DVec3> {
        let Extremes { corners: mut points, curves } = self.outermost(slab);
        for curve in curves {
            let angles = (0..SAMPLES).map(|k| TAU * f64::from(k) / f64::from(SAMPLES));
            points.extend(angles.filter_map(curve));
        }
        points
    }

    fn outermost(&self, slab: Extent) -> Extremes<'_> {
        let ends = self.ends();
        let levels = [slab.min, slab.max].into_iter().filter(|z| z.is_finite());
        // Where the line of an edge passes through a level.
        let crossing = |[a, b]: [DVec3; 2], z: f64| {
            let share = (z - a.z) / (b.z - a.z);
            (0.0..=1.0).contains(&share).then(|| (a + (b - a) * share).with_z(z))
        };
        let mut extremes = Extremes { corners: Vec::new(), curves: Vec::new() };
        match self.section {
            Section::Outline(outline) => {
                let place = |corner: DVec2, z: f64| self.pose.to_world(corner.extend(z));
                for (a, b) in outline.sides() {
                    let [low, high] = ends.map(|z| [place(a, z), place(b, z)]);
                    for edge in [ends.map(|z| place(a, z)), low, high] {
                        let inside = edge.into_iter().filter(|at| slab.contains(at.z));
                        extremes.corners.extend(inside);
                        extremes.corners.extend(levels.clone().filter_map(|z| crossing(edge, z)));
                    }
                }
            }
            Section::Disc { centre, radius } => {
                let place = move |angle: f64, z: f64| {
                    let beside = centre + radius * DVec2::from_angle(angle);
                    self.pose.to_world(beside.extend(z))
                };
                for end in ends {
                    let rim = move |angle| Some(place(angle, end)).filter(|at| slab.contains(at.z));
                    extremes.curves.push(Box::new(rim));
                }
                for z in levels {
                    let cut = move |angle| crossing(ends.map(|end| place(angle, end)), z);
                    extremes.curves.push(Box::new(cut));
                }
            }
        }
        extremes
    }

    /// Whether a body of which the support function (the greatest n·p over its points p) and the greatest
    /// value of convex functions are known lies within this one, but for `slack`.
    pub fn holds(
        &self,
        slack: f64,
        support: impl Fn(DVec3) -> f64,
        greatest: impl Fn(&dyn Fn(DVec3) -> f64) -> f64,
    ) -> bool {
        self.bounds(0.0).iter().all(|bound| match bound {
            Bound::Plane { normal, offset } => support(*normal) <= offset + slack,
            round @ (Bound::Tube { .. } | Bound::Ball { .. }) => {
                greatest(&|at| -round.depth(at).0) <= slack
            }
        })
    }

    /// How far it reaches along a unit vector from the origin; endless where it has no end that way.
    pub fn support(&self, direction: DVec3) -> f64 {
        let own = self.pose.vector_to_local(direction);
        let beside = match self.section {
            Section::Disc { centre, radius } => {
                own.truncate().dot(centre) + radius * own.truncate().length()
            }
            Section::Outline(outline) => {
                let corners = outline.corners().iter();
                corners.map(|corner| own.truncate().dot(*corner)).fold(f64::NEG_INFINITY, f64::max)
            }
        };
        let end = if own.z > 0.0 { self.extent.max } else { self.extent.min };
        // What is endless across the direction but for rounding does not reach along it.
        let along = if own.z.abs() < SAME_AXIS { 0.0 } else { own.z * end };
        beside + along + direction.dot(self.pose.origin)
    }
}

/// Whether two bodies, one of them a cut ball, press into each other by more than `slack`.
pub(super) fn press(one: &Solid, other: &Solid, slack: f64) -> bool {
    let bounded = |solid: &Solid| {
        let (mut bounds, centre, radius) = match solid {
            Solid::Ball { centre, radius } => (Vec::new(), *centre, *radius),
            Solid::CutBall { centre, ball: CutBall { sphere, plane } } => {
                let offset = plane.offset + plane.normal.dot(*centre);
                (vec![Bound::Plane { normal: plane.normal, offset }], *centre, sphere.radius)
            }
            _ => return Convex::of(solid).map(|own| (own.bounds(slack), own.ellipsoid())),
        };
        bounds.push(Bound::Ball { centre, radius });
        Some((bounds, (centre, DMat3::from_diagonal(DVec3::splat(radius)))))
    };
    let (Some(one), Some(other)) = (bounded(one), bounded(other)) else { return false };
    let first = one.1.1.determinant() < other.1.1.determinant();
    let (smaller, larger) = if first { (one, other) } else { (other, one) };
    let bounds: Vec<Bound> = smaller.0.into_iter().chain(larger.0).collect();
    meet_deep(&bounds, smaller.1, slack)
}

/// Whether there is a point in an ellipsoid that lies deeper than half of `slack` in all of some bounds.
///
/// How deep a point lies in both bodies is a concave function of it, and its maximum is looked for by the ellipsoid
/// method with deep cuts (Grötschel, Lovász, Schrijver, Geometric Algorithms and Combinatorial Optimization,
/// chapter 3): the ellipsoid holds all points that may be deep enough, and each step halves it at least by a
/// linear bound on the depth. It needs no case for faces, edges, rims and what else may meet, and it ends with
/// a proof: such a point, or none left. The ellipsoid is kept as a matrix that makes it of the unit ball, so
/// that a thin one is as exact as a round one.
fn meet_deep(bounds: &[Bound], ellipsoid: (DVec3, DMat3), slack: f64) -> bool {
    /// From the largest ellipsoid to the smallest it takes some 800 steps.
    const MOST_STEPS: u32 = 5000;
    let needed = 0.5 * slack;
    let (mut at, mut shape) = ellipsoid;
    for _ in 0..MOST_STEPS {
        let depths = bounds.iter().map(|bound| bound.depth(at));
        let Some((depth, gradient)) = depths.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return false;
        };
        if depth > needed {
            return true;
        }
        let most = shape.transpose() * gradient;
        let reach = most.length();
        let cut = (needed - depth) / reach;
        if cut.is_nan() || cut >= 1.0 {
            return false;
        }
        let towards = most / reach;
        let step = shape * towards;
        at += 0.25 * (1.0 + 3.0 * cut) * step;
        let squeeze = (0.5 * (1.0 - cut) / (1.0 + cut)).sqrt() - 1.0;
        let [x, y, z] = towards.to_array().map(|share| squeeze * share * step);
        let stretch = (1.125 * (1.0 - cut * cut)).sqrt();
        shape = (shape + DMat3::from_cols(x, y, z)) * stretch;
    }
    false
}

/// Axes whose directions differ by no more are parallel but for rounding.
pub(super) const SAME_AXIS: f64 = 1e-14;

/// How many samples of a curve are looked at.
const SAMPLES: u32 = 96;

/// A closed curve by an angle; part of it may be missing.
type Curve<'c> = Box<dyn Fn(f64) -> Option<DVec3> + 'c>;

/// Extreme points of a body, and curves of such points.
struct Extremes<'c> {
    corners: Vec<DVec3>,
    curves: Vec<Curve<'c>>,
}

/// The greatest value over all angles of a function that is smooth between samples.
fn greatest_around(value: &dyn Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let step = TAU / f64::from(SAMPLES);
    let samples = (0..SAMPLES).map(|k| step * f64::from(k)).map(|angle| (angle, value(angle)));
    let Some((best, sampled)) = samples.max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return f64::NEG_INFINITY;
    };
    let (mut low, mut high) = (best - step, best + step);
    for _ in 0..40 {
        let span = GOLDEN * (high - low);
        let (left, right) = (high - span, low + span);
        if value(left) < value(right) { low = left } else { high = right }
    }
    sampled.max(value(0.5 * (low + high)))
}

#[cfg(test)]
mod tests {
    use super::super::{Hole, TOUCHING};
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    fn cuboid(half: DVec3) -> Solid {
        let extent = Extent { min: -half.z, max: half.z };
        Solid::Prism { outline: Outline::rectangle(half.x, half.y), extent }
    }

    fn poses() -> impl Strategy<Value = Pose> {
        let vector = || prop::array::uniform3(-3.0..3.0).prop_map(DVec3::from_array);
        (vector(), -PI..PI, vector())
            .prop_map(|(origin, rotation, axis)| Pose::with_axis(origin, rotation, axis))
    }

    /// Sheets, prisms and cylinders, endless ones among them, and balls.
    fn solids() -> impl Strategy<Value = Solid> {
        let extent = || {
            prop_oneof![
                3 => (0.3..4.0).prop_map(|length| Extent::centred(Some(length))),
                1 => Just(Extent::ENDLESS),
            ]
        };
        let corner = || prop::array::uniform2(-2.0..2.0).prop_map(DVec2::from_array);
        let prism = (prop::collection::vec(corner(), 2..8), extent())
            .prop_map(|(points, extent)| Solid::Prism { outline: Outline::hull(points), extent });
        let cylinder = (corner(), 0.3..2.0, extent())
            .prop_map(|(centre, radius, extent)| Solid::Cylinder { centre, radius, extent });
        let ball = (corner(), 0.3..2.0)
            .prop_map(|(at, radius)| Solid::Ball { centre: at.extend(0.2), radius });
        prop_oneof![4 => prism, 3 => cylinder, 1 => ball]
    }

    fn moved(solid: &Solid, by: DVec3) -> Solid {
        solid.placed(&Pose::new(by, 0.0))
    }

    /// How far a solid reaches along a unit vector, from the definition.
    fn support(solid: &Solid, direction: DVec3) -> f64 {
        match solid {
            Solid::Ball { centre, radius } => direction.dot(*centre) + radius,
            other => Convex::of(other).expect("convex").support(direction),
        }
    }

    /// The directions of the edges of a prism, and of the axis of a prism or a cylinder.
    fn edges(solid: &Solid) -> Vec<DVec3> {
        let Some(convex) = Convex::of(solid) else { return Vec::new() };
        let mut edges = vec![convex.pose.axis()];
        if let Section::Outline(outline) = convex.section {
            let side = |(a, b): (DVec2, DVec2)| convex.pose.vector_to_world((b - a).extend(0.0));
            edges.extend(outline.sides().map(side));
        }
        edges
    }

    /// How far one must be moved along a unit vector until the other is free: the least over all directions of how
    /// far the planes across them must go. Of prisms these planes lie along two edges; else they are searched for, and what is
    /// found is at least the true distance.
    fn way_out(a: &Solid, b: &Solid, towards: DVec3) -> f64 {
        let needed = |direction: DVec3| {
            let share = direction.dot(towards);
            let press = support(a, direction) + support(b, -direction);
            if share > 1e-9 && press.is_finite() { press / share } else { f64::INFINITY }
        };
        // Endless ones part only across their axes.
        let axes: Vec<DVec3> = [a, b]
            .into_iter()
            .filter_map(Convex::of)
            .filter(|convex| !convex.extent.min.is_finite())
            .map(|convex| convex.pose.axis())
            .collect();
        let allowed = |direction: DVec3| match axes[..] {
            [] => direction.normalize_or_zero(),
            [axis] => direction.reject_from_normalized(axis).normalize_or_zero(),
            [one, other, ..] => {
                let both = one.cross(other).normalize_or_zero();
                both * both.dot(towards).signum()
            }
        };
        let golden = |k: u32| {
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 800.0;
            let beside = DVec2::from_angle(2.399_963_229_728_653 * f64::from(k));
            (beside * (1.0 - z * z).sqrt()).extend(z)
        };
        let edges = [edges(a), edges(b)].concat();
        let pairs = edges.iter().flat_map(|one| edges.iter().map(|other| one.cross(*other)));
        let along = edges.iter().flat_map(|edge| [*edge, -*edge]);
        let starts = (0..800).map(golden).chain(pairs).chain(along).map(allowed);
        let mut best = (f64::INFINITY, DVec3::ZERO);
        let mut few: Vec<(f64, DVec3)> = starts.map(|n| (needed(n), n)).collect();
        few.sort_by(|x, y| x.0.total_cmp(&y.0));
        for (mut least, mut direction) in few.into_iter().take(5) {
            let mut step = 0.05;
            while step > 1e-12 && least.is_finite() {
                let (x, y) = direction.any_orthonormal_pair();
                let tries = (0..12).map(|k| DVec2::from_angle(TAU * f64::from(k) / 12.0));
                let tries = tries.map(|way| allowed(direction + step * (x * way.x + y * way.y)));
                let better = tries.map(|n| (needed(n), n)).min_by(|x, y| x.0.total_cmp(&y.0));
                match better {
                    Some(better) if better.0 < least => (least, direction) = better,
                    _ => step *= 0.7,
                }
            }
            if least < best.0 {
                best = (least, direction);
            }
        }
        best.0
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn they_overlap_until_one_has_been_moved_out_of_the_other(
            a in solids(),
            b in solids(),
            pose in poses(),
            other in poses(),
            towards in poses(),
        ) {
            // Two sheets have no common depth, however they cross.
            let sheet = |solid: &Solid| {
                matches!(solid, Solid::Prism { outline, .. } if outline.corners().len() < 3)
            };
            prop_assume!(!sheet(&a) || !sheet(&b));
            let (a, b) = (a.placed(&pose), b.placed(&other));
            let towards = towards.axis();
            let far = way_out(&a, &b, towards);
            // Not in one plane, and not along what is endless.
            prop_assume!((1e-3..50.0).contains(&far));
            let meet = |way: f64| {
                let b = moved(&b, towards * way);
                let both = [a.overlaps(&b, TOUCHING), b.overlaps(&a, TOUCHING)];
                assert_eq!(both[0], both[1], "{a:?} {b:?}");
                both[0]
            };
            prop_assert!(!meet(far), "{a:?} {b:?} {towards} {far}");
            prop_assert!(meet(far - 1e-3) || meet(far - 0.03 * far), "{a:?} {b:?} {towards} {far}");
        }

        #[test]
        fn what_holds_a_common_point_overlaps(
            a in solids(),
            b in solids(),
            pose in poses(),
            other in poses(),
            seed in prop::collection::vec(prop::array::uniform3(-4.0..4.0), 200),
        ) {
            let (a, b) = (a.placed(&pose), b.placed(&other));
            for at in seed {
                let at = DVec3::from_array(at);
                if a.holds(at) && b.holds(at) {
                    prop_assert!(a.overlaps(&b, TOUCHING));
                }
                let [low, high] = a.bounds().expect("bounds");
                if a.contains(at) {
                    prop_assert!((low - 1e-12).cmple(at).all() && (high + 1e-12).cmpge(at).all());
                }
                if a.is_within(&b) && a.holds(at) {
                    prop_assert!(b.contains(at), "{a:?} {b:?} {at}");
                }
            }
        }

        #[test]
        fn bodies_that_touch_at_odd_angles_do_not_overlap(pose in poses(), turn in -180.0..180.0) {
            let up = Pose::new(DVec3::ZERO, f64::to_radians(turn));
            let slab = cuboid(DVec3::new(4.0, 3.0, 0.5)).placed(&up);
            // A cube on its corner, one on its edge, one flat; a cylinder on its rim, its side, its end.
            let cube = cuboid(DVec3::ONE);
            let rod = Solid::cylinder(0.7, Extent::centred(Some(2.0)));
            let endless = Solid::cylinder(0.7, Extent::ENDLESS);
            let sheet = Solid::Prism {
                outline: Outline::new(vec![DVec2::new(0.0, -0.9), DVec2::new(0.0, 0.9)]),
                extent: Extent::centred(Some(2.0)),
            };
            let standing = [DVec3::new(1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, -2.0), DVec3::ONE];
            let [x, y, z] = standing.map(DVec3::normalize);
            let standing = DMat3::from_cols(x, y, z).transpose();
            let corner = up.after(&Pose::from_rotation(DVec3::ZERO, standing));
            let tilt = |degrees: f64| {
                let (sin, cos) = degrees.to_radians().sin_cos();
                Pose::with_axis(DVec3::ZERO, f64::to_radians(turn), DVec3::new(sin, 0.0, cos))
            };
            let lying = |degrees: f64| {
                let (sin, cos) = degrees.to_radians().sin_cos();
                Pose::with_axis(DVec3::ZERO, 0.0, DVec3::new(cos, sin, 0.0))
            };
            let (sin, cos) = 40f64.to_radians().sin_cos();
            let cases = [
                (cube.placed(&corner), 3f64.sqrt()),
                (cube.placed(&Pose::with_axis(DVec3::ZERO, FRAC_PI_4, DVec3::Y)), 2f64.sqrt()),
                (cube.placed(&Pose::with_axis(DVec3::ZERO, FRAC_PI_2, DVec3::X)), 1.0),
                (rod.placed(&tilt(40.0)), 0.7 * sin + cos),
                (rod.placed(&lying(turn)), 0.7),
                (endless.placed(&lying(turn)), 0.7),
                (rod.clone(), 1.0),
                (sheet.placed(&Pose::with_axis(DVec3::ZERO, 0.0, DVec3::X)), 0.0),
                (sheet.placed(&tilt(0.0)), 1.0),
                (Solid::ball(1.3).placed(&tilt(30.0)), 1.3),
            ];
            for (body, reach) in &cases {
                // What is lowest in the middle touches a rod below, too.
                let low = body.bounds().is_some_and(|[low, _]| body.contains(low * DVec3::Z * (1.0 - 1e-9)));
                let rod = endless.placed(&lying(0.3 * turn));
                for (slab, top) in [(&slab, 0.5), (&rod, 0.7)].into_iter().take(1 + usize::from(low)) {
                    let meet = |way: f64| {
                        let body = moved(body, DVec3::Z * way).placed(&pose);
                        let slab = slab.placed(&pose);
                        let both = [body.overlaps(&slab, TOUCHING), slab.overlaps(&body, TOUCHING)];
                        assert_eq!(both[0], both[1], "{body:?} {slab:?}");
                        both[0]
                    };
                    let touch = reach + top;
                    prop_assert!(!meet(touch) && !meet(touch + 1e-6), "{body:?} {slab:?}");
                    prop_assert!(meet(touch - 1e-6), "{body:?} {slab:?}");
                }
            }
        }

        #[test]
        fn what_stands_in_something_does_so_wherever_both_are(pose in poses()) {
            let glass = cuboid(DVec3::new(4.0, 3.0, 2.0));
            let rod = Solid::cylinder(3.0, Extent::ENDLESS);
            let within = |inner: &Solid, by: DVec3, around: &Solid| {
                moved(inner, by).placed(&pose).is_within(&around.placed(&pose))
            };
            let cube = cuboid(DVec3::ONE);
            let across = Pose::with_axis(DVec3::ZERO, FRAC_PI_4, DVec3::Y);
            let small = Solid::cylinder(1.0, Extent::centred(Some(2.0))).placed(&across);
            let rim = 3.0 - 2f64.sqrt();
            for (inner, around, by) in [
                (&cube, &glass, DVec3::new(3.0, 2.0, 1.0)),
                (&cube, &rod, DVec3::X * (8f64.sqrt() - 1.0)),
                (&Solid::ball(1.0), &glass, DVec3::Y * 2.0),
                (&Solid::ball(1.0), &rod, DVec3::Y * 2.0),
                (&Solid::ball(1.0), &Solid::ball(3.0), DVec3::Z * 2.0),
                (&cube.placed(&across), &rod, DVec3::X * (8f64.sqrt() - 2f64.sqrt())),
                (&small, &glass, DVec3::new(3.0, 2.0, 1.0)),
                (&small, &Solid::ball(2f64.sqrt()), DVec3::ZERO),
                (&small, &rod, DVec3::Y * rim.max(8f64.sqrt() - 1.0)),
                (&Solid::cylinder(2.0, Extent::ENDLESS), &rod, DVec3::X),
            ] {
                prop_assert!(within(inner, by, around), "{inner:?} {by}");
                prop_assert!(within(inner, by * (1.0 - 1e-6), around), "{inner:?} {by}");
                let out = by + 1e-6 * by.try_normalize().unwrap_or(DVec3::Y);
                prop_assert!(!within(inner, out, around), "{inner:?} {out}");
            }
            prop_assert!(!within(&rod, DVec3::ZERO, &glass) && !within(&glass, DVec3::ZERO, &cube));
            prop_assert!(within(&Solid::Nothing, DVec3::ZERO, &glass));
        }

        #[test]
        fn others_may_be_in_a_tilted_hole(pose in poses(), turn in -PI..PI) {
            let hole = Solid::cylinder(3.0, Extent::ENDLESS);
            let tube = Solid::cylinder(5.0, Extent::ENDLESS).with_hole(Hole::Round(hole));
            let short = Extent::centred(Some(1.0));
            let ring = Solid::cylinder(5.0, short)
                .with_hole(Hole::Round(Solid::cylinder(3.0, short)));
            let shell = Solid::ball(5.0).with_hole(Hole::Round(Solid::ball(3.0)));
            let across = Pose::with_axis(DVec3::ZERO, turn, DVec3::Y);
            let rod = Solid::cylinder(1.0, Extent::centred(Some(2.0))).placed(&across);
            let long = Solid::cylinder(1.0, Extent::ENDLESS)
                .placed(&Pose::with_axis(DVec3::ZERO, 0.0, DVec3::new(3.0, 0.0, 4.0)));
            let meet = |hollow: &Solid, body: &Solid, by: DVec3| {
                let (hollow, body) = (hollow.placed(&pose), moved(body, by).placed(&pose));
                let both = [hollow.overlaps(&body, TOUCHING), body.overlaps(&hollow, TOUCHING)];
                assert_eq!(both[0], both[1], "{hollow:?} {body:?}");
                both[0]
            };
            // A rod along y, half as long as wide, is a square to the tube.
            let free = 8f64.sqrt() - 1.0;
            for (hollow, way) in [(&tube, DVec3::X), (&shell, DVec3::X), (&shell, DVec3::Z)] {
                prop_assert!(!meet(hollow, &rod, way * (free - 1e-6)));
                prop_assert!(meet(hollow, &rod, way * (free + 1e-6)));
            }
            // One that leans at 3 : 4 through the ring is an ellipse 2.5 long at each end of it, 0.75 apart.
            prop_assert!(meet(&tube, &long, DVec3::ZERO) && !meet(&ring, &long, DVec3::ZERO));
            let free = 3.0 - 0.5 * 0.75 - 1.25;
            prop_assert!(!meet(&ring, &long, DVec3::X * (free - 1e-6)));
            prop_assert!(meet(&ring, &long, DVec3::X * (free + 1e-6)));
        }

        #[test]
        fn sheets_lie_on_each_other_wherever_both_are(pose in poses(), turn in -180.0..180.0) {
            let sheet = |half: f64, extent: Extent| Solid::Prism {
                outline: Outline::new(vec![DVec2::new(-half, 0.0), DVec2::new(half, 0.0)]),
                extent,
            };
            let large = sheet(5.0, Extent::centred(Some(10.0))).placed(&pose);
            let small = |by: DVec3| {
                let turned = Pose::with_axis(DVec3::ZERO, 0.0, DVec3::new(turn, 0.0, 90.0));
                moved(&sheet(1.0, Extent::centred(Some(2.0))).placed(&turned), by).placed(&pose)
            };
            let lie = |by: DVec3| {
                let both = [large.coincides(&small(by), TOUCHING), small(by).coincides(&large, TOUCHING)];
                assert_eq!(both[0], both[1], "{by}");
                both[0]
            };
            prop_assert!(lie(DVec3::ZERO) && lie(DVec3::new(4.0, 0.0, 4.0)));
            prop_assert!(!lie(DVec3::Y * 1e-6) && !lie(DVec3::X * 7.0) && !lie(DVec3::Z * 7.0));
            let endless = sheet(5.0, Extent::ENDLESS).placed(&pose);
            prop_assert!(endless.coincides(&large, TOUCHING));
            prop_assert!(!large.coincides(&Solid::ball(1.0), TOUCHING));
        }
    }

    #[test]
    fn a_device_on_its_head_is_an_upright_one() {
        let roof = Outline::new(vec![DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(0.0, 1.0)]);
        let solid = Solid::Prism { outline: roof, extent: Extent { min: 0.0, max: 3.0 } };
        let turned = solid.placed(&Pose::with_axis(DVec3::X, 0.0, DVec3::NEG_Z));
        let Solid::Prism { outline, extent } = &turned else { panic!("{turned:?}") };
        assert_eq!(*extent, Extent { min: -3.0, max: 0.0 });
        assert!(
            outline.contains(DVec2::new(1.5, -0.3)) && turned.holds(DVec3::new(1.5, -0.3, -2.0))
        );
    }

    #[test]
    fn shadows_are_hulls_of_what_is_there() {
        let lying = Pose::with_axis(DVec3::new(1.0, 2.0, 3.0), 0.0, DVec3::Y);
        let shadow = Solid::cylinder(1.0, Extent::centred(Some(4.0))).placed(&lying).shadow();
        for corner in [(0.0, 0.0), (2.0, 0.0), (2.0, 4.0), (0.0, 4.0)].map(DVec2::from) {
            assert!(
                shadow.distance(corner) < 1e-12 && !shadow.contains((corner - 1.0) * 1.01 + 1.0)
            );
        }
        let cube = cuboid(DVec3::ONE).placed(&Pose::with_axis(DVec3::ZERO, FRAC_PI_4, DVec3::X));
        assert!((cube.shadow().radius() - 3f64.sqrt()).abs() < 1e-12);
        let endless = Solid::ball(2.0).placed(&lying).shadow();
        assert!(
            endless.contains(DVec2::new(1.0, 3.99)) && !endless.contains(DVec2::new(1.0, 4.01))
        );
    }
}
