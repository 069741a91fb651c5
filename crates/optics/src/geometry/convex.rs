//! Prisms and round cylinders in any pose: whether they are in each other's way.

use super::{ConicFace, CutBall, Extent, Outline, Pose, Solid};
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

/// A bound on how deep a point lies in a convex body: positive inside, at most its distance to the
/// border.
#[derive(Clone, Copy)]
pub(super) enum Bound {
    /// `offset` - `normal`·p.
    Plane { normal: DVec3, offset: f64 },
    /// `radius` less the distance from the line through `point` along the unit vector `axis`.
    Tube { point: DVec3, axis: DVec3, radius: f64 },
    /// `radius` less the distance from `centre`.
    Ball { centre: DVec3, radius: f64 },
    /// What lies behind a face of a lens that is not hollow, about the x axis of a frame, and within
    /// `radius` of that: see [`ConicFace::depth`].
    Behind { face: ConicFace, radius: f64, pose: Pose },
}

impl Bound {
    /// How deep a point lies, and the gradient of that.
    fn depth(&self, at: DVec3) -> (f64, DVec3) {
        let (aside, radius) = match *self {
            Self::Plane { normal, offset } => return (offset - normal.dot(at), -normal),
            Self::Behind { face, radius, pose } => {
                let (depth, gradient) = face.depth(pose.to_local(at), radius);
                return (depth, pose.vector_to_world(gradient));
            }
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
            Solid::Prism { outline, .. } if outline.corners.is_empty() => None,
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

    /// Bounds that hold together just inside. A sheet counts as thin as `thickness`, and steep:
    /// where more than half of that is left in it, no point is farther from its plane than an
    /// eighth.
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
            Section::Outline(outline) if outline.corners.len() == 2 => {
                let (a, b) = (outline.corners[0], outline.corners[1]);
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
                let corners = &outline.corners;
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

    /// The plane of a sheet: its unit normal, and n·p of its points.
    fn sheet_plane(&self) -> Option<(DVec3, f64)> {
        let Section::Outline(Outline { corners }) = self.section else { return None };
        let [a, b] = corners[..] else { return None };
        let across = (b - a).normalize_or_zero().perp();
        let normal = self.pose.vector_to_world(across.extend(0.0));
        Some((normal, across.dot(a) + normal.dot(self.pose.origin)))
    }

    /// Whether two sheets cross: on the line where their planes meet is a point deeper than half of
    /// `slack` within the edges of both. Off that line they are apart, however small the angle
    /// between them.
    fn crosses(&self, other: &Self, slack: f64) -> Option<bool> {
        let [(normal, offset), (second, beyond)] = [self.sheet_plane()?, other.sheet_plane()?];
        let along = normal.cross(second);
        let squared = along.length_squared();
        if squared < SAME_AXIS * SAME_AXIS {
            return Some(false);
        }
        let point = (second.cross(along) * offset + along.cross(normal) * beyond) / squared;
        let along = along / squared.sqrt();
        let edges = |sheet: &Self, normal: DVec3| {
            let planes = sheet.bounds(0.0).into_iter().filter_map(|bound| match bound {
                Bound::Plane { normal, offset } => Some((normal, offset)),
                Bound::Tube { .. } | Bound::Ball { .. } | Bound::Behind { .. } => None,
            });
            planes.filter(|(edge, _)| edge.dot(normal).abs() < 0.5).collect::<Vec<_>>()
        };
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for (edge, end) in [edges(self, normal), edges(other, second)].concat() {
            let (depth, rate) = (end - 0.5 * slack - edge.dot(point), edge.dot(along));
            if rate.abs() < SAME_AXIS {
                high = if depth > 0.0 { high } else { f64::NEG_INFINITY };
            } else if rate > 0.0 {
                high = high.min(depth / rate);
            } else {
                low = low.max(depth / rate);
            }
        }
        Some(low < high)
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
        if let Some(crosses) = from.crosses(&to, slack) {
            return crosses;
        }
        let mut bounds = from.bounds(slack);
        bounds.extend(to.bounds(slack));
        meet_deep(&bounds, from.ellipsoid(), slack)
    }

    /// The greatest value of a convex function over the part of the body that lies between two z of
    /// its common frame: it is at a corner or on a rim. Rims are sampled and the greatest sample
    /// refined.
    pub fn greatest(&self, slab: Extent, value: impl Fn(DVec3) -> f64) -> f64 {
        let Extremes { corners, curves } = self.outermost(slab);
        let around = |curve: &Curve<'_>| {
            greatest_around(&|angle| curve(angle).map_or(f64::NEG_INFINITY, &value))
        };
        let on_curves = curves.iter().map(around);
        corners.into_iter().map(&value).chain(on_curves).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Points between which all of the part of the body lies that is between two z, curves as many
    /// points.
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

    /// Whether a body of which the support function (the greatest n·p over its points p) and the
    /// greatest value of convex functions are known lies within this one, but for `slack`.
    pub fn holds(
        &self,
        slack: f64,
        support: impl Fn(DVec3) -> f64,
        greatest: impl Fn(&dyn Fn(DVec3) -> f64) -> f64,
    ) -> bool {
        self.bounds(0.0).iter().all(|bound| match bound {
            Bound::Plane { normal, offset } => support(*normal) <= offset + slack,
            round => greatest(&|at| -round.depth(at).0) <= slack,
        })
    }

    /// How far it reaches along a unit vector from the origin; endless where it has no end that
    /// way.
    pub fn support(&self, direction: DVec3) -> f64 {
        let own = self.pose.vector_to_local(direction);
        let beside = match self.section {
            Section::Disc { centre, radius } => {
                own.truncate().dot(centre) + radius * own.truncate().length()
            }
            Section::Outline(outline) => {
                let corners = outline.corners.iter();
                corners.map(|corner| own.truncate().dot(*corner)).fold(f64::NEG_INFINITY, f64::max)
            }
        };
        let end = if own.z > 0.0 { self.extent.max } else { self.extent.min };
        // What is endless across the direction but for rounding does not reach along it.
        let along = if own.z.abs() < SAME_AXIS { 0.0 } else { own.z * end };
        beside + along + direction.dot(self.pose.origin)
    }
}

/// Bounds of a convex body, and an ellipsoid around it; of a lens with hollow faces those of its
/// convex hull. `None` for what has neither.
pub(super) fn bounded(solid: &Solid, slack: f64) -> Option<Bounded> {
    let (mut bounds, centre, radius) = match solid {
        Solid::Ball { centre, radius } => (Vec::new(), *centre, *radius),
        Solid::CutBall { centre, ball: CutBall { sphere, plane } } => {
            let offset = plane.offset + plane.normal.dot(*centre);
            (vec![Bound::Plane { normal: plane.normal, offset }], *centre, sphere.radius)
        }
        Solid::Lens { lens, pose } => return Some(lens.bounded(pose)),
        Solid::Polyhedron { solid, pose } => return solid.bounded(pose),
        _ => {
            let own = Convex::of(solid)?;
            return Some(Bounded { bounds: own.bounds(slack), ellipsoid: own.ellipsoid() });
        }
    };
    bounds.push(Bound::Ball { centre, radius });
    let ellipsoid = (centre, DMat3::from_diagonal(DVec3::splat(radius)));
    Some(Bounded { bounds, ellipsoid })
}

/// Bounds of a convex body, and an ellipsoid around it: its middle, and a matrix that makes it of the
/// unit ball.
#[derive(Clone)]
pub(super) struct Bounded {
    pub bounds: Vec<Bound>,
    pub ellipsoid: (DVec3, DMat3),
}

impl Bounded {
    /// Whether it and another press into each other by more than `slack`, within bounds of both.
    pub fn presses(&self, other: &Self, more: &[Bound], slack: f64) -> bool {
        let first = self.ellipsoid.1.determinant() < other.ellipsoid.1.determinant();
        let smaller = if first { self } else { other };
        let bounds = self.bounds.iter().chain(&other.bounds).chain(more);
        meet_deep(&bounds.copied().collect::<Vec<_>>(), smaller.ellipsoid, slack)
    }
}

/// Whether two bodies, one of them a cut ball, press into each other by more than `slack`.
pub(super) fn press(one: &Solid, other: &Solid, slack: f64) -> bool {
    let both = bounded(one, slack).zip(bounded(other, slack));
    both.is_some_and(|(one, other)| one.presses(&other, &[], slack))
}

/// Whether there is a point in an ellipsoid that lies deeper than half of `slack` in all of some
/// bounds.
///
/// How deep a point lies in both bodies is a concave function of it, and its maximum is looked for
/// by the ellipsoid method with deep cuts (Grötschel, Lovász, Schrijver, Geometric Algorithms and
/// Combinatorial Optimization, chapter 3): the ellipsoid holds all points that may be deep enough,
/// and each step halves it at least by a linear bound on the depth. It needs no case for faces,
/// edges, rims and what else may meet, and it ends with a proof: such a point, or none left. The
/// ellipsoid is kept as a matrix that makes it of the unit ball, so that a thin one is as exact as
/// a round one.
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
pub(super) fn greatest_around(value: &dyn Fn(f64) -> f64) -> f64 {
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
mod tests;
