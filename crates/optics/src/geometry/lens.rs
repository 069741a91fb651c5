//! Lenses: what lies between two conic sections turned about an axis, within a round edge.

use super::{Extent, Pose, Solid, TOUCHING, first_along};
use glam::DVec3;

/// A conic section turned about the x axis, of which the half about its apex counts: a plane, a
/// sphere, an ellipsoid, a paraboloid or one sheet of a hyperboloid. With the distance r from the
/// axis it is at x = apex + c r²/(1 + √(1 - (1 + K) c² r²)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConicFace {
    /// x of its apex, cm.
    pub apex: f64,
    /// Its curvature c at the apex, 1/cm: positive where the centre of curvature is at larger x.
    pub curvature: f64,
    /// Its conic constant K: 0 for a sphere, -1 for a paraboloid, less for a hyperboloid.
    pub conic: f64,
}

/// A piece of the border of a [`Lens`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LensPart {
    /// The face at smaller x.
    Front,
    /// The face at larger x.
    Back,
    /// The round edge.
    Edge,
}

/// What lies between two faces about the x axis and within a distance from it. The faces must not
/// meet within.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// How far it reaches from its axis, cm.
    pub radius: f64,
    /// The face at smaller x.
    pub front: ConicFace,
    /// The face at larger x.
    pub back: ConicFace,
}

/// Where a line goes through a face towards larger x, and where towards smaller x.
#[derive(Clone, Copy)]
struct Crossings {
    forward: f64,
    backward: f64,
}

/// How far past its rim a face is met, relative to the radius: nothing goes through between a face
/// and the edge.
const RIM: f64 = 1e-12;

/// How far behind its start a ray in a lens may leave it by rounding, cm.
const BEHIND: f64 = 1e-12;

impl ConicFace {
    /// How far from the axis it reaches, cm.
    #[must_use]
    pub fn reach(&self) -> f64 {
        let squeeze = 1.0 + self.conic;
        if squeeze > 0.0 { 1.0 / (self.curvature.abs() * squeeze.sqrt()) } else { f64::INFINITY }
    }

    /// Its x at a distance from the axis; beyond its reach that of its end.
    #[must_use]
    pub fn x_at(&self, r: f64) -> f64 {
        self.apex + self.curvature * r * r / (1.0 + self.root(r))
    }

    /// dx/dr at a distance from the axis.
    #[must_use]
    pub fn slope(&self, r: f64) -> f64 {
        self.curvature * r / self.root(r)
    }

    fn root(&self, r: f64) -> f64 {
        let bent = self.curvature * r;
        (1.0 - (1.0 + self.conic) * bent * bent).max(0.0).sqrt()
    }

    /// The gradient of x - apex - c/2 (r² + (1 + K) (x - apex)²), which vanishes on the face and
    /// grows towards larger x.
    fn gradient(&self, at: DVec3) -> DVec3 {
        let Self { apex, curvature, conic } = *self;
        DVec3::new(
            1.0 - (1.0 + conic) * curvature * (at.x - apex),
            -curvature * at.y,
            -curvature * at.z,
        )
    }

    /// The unit normal at a point of it, towards larger x.
    #[must_use]
    pub fn normal(&self, at: DVec3) -> DVec3 {
        self.gradient(at).try_normalize().unwrap_or(DVec3::X)
    }

    /// Where a line crosses the whole conic; NaN or infinite where it does not. Which of the two
    /// roots goes which way is known from the signs alone, so that rounding never turns it around.
    fn crossings(&self, origin: DVec3, direction: DVec3) -> Crossings {
        let Self { apex, curvature, conic } = *self;
        let (at, squeeze) = (origin.with_x(origin.x - apex), 1.0 + conic);
        let product = |a: DVec3, b: DVec3| squeeze * a.x * b.x + a.y * b.y + a.z * b.z;
        // x - c/2 (r² + (1 + K) x²) along the line is level + rate t - bend t².
        let level = at.x - 0.5 * curvature * product(at, at);
        let rate = direction.x - curvature * product(at, direction);
        let bend = 0.5 * curvature * product(direction, direction);
        let root = (rate * rate + 4.0 * bend * level).sqrt();
        if rate >= 0.0 {
            let sum = rate + root;
            Crossings { forward: -2.0 * level / sum, backward: sum / (2.0 * bend) }
        } else {
            let sum = rate - root;
            Crossings { forward: sum / (2.0 * bend), backward: -2.0 * level / sum }
        }
    }

    /// Whether a point of the whole conic is of the half about the apex.
    fn is_near(&self, at: DVec3) -> bool {
        1.0 - (1.0 + self.conic) * self.curvature * (at.x - self.apex) >= 0.0
    }

    /// The same face seen from the other end of the axis.
    pub(super) fn mirrored(&self) -> Self {
        Self { apex: -self.apex, curvature: -self.curvature, ..*self }
    }

    /// A bound on how deep a point lies behind a face that is not curved away from it (c >= 0), and
    /// the gradient of that: positive inside, concave, at most the distance to the face. `radius` is
    /// how far from the axis points are.
    pub(super) fn depth(&self, at: DVec3, radius: f64) -> (f64, DVec3) {
        let Self { apex, curvature, conic } = *self;
        let (s, aside) = (at.x - apex, at.with_x(0.0));
        let r = aside.length();
        let outward = aside / r.max(f64::MIN_POSITIVE);
        let squeeze = 1.0 + conic;
        if curvature == 0.0 {
            return (s, DVec3::X);
        }
        if squeeze > 0.0 {
            // An ellipsoid, and behind its middle a cylinder: how large a copy of it has the point.
            let (along, across) = (1.0 / (curvature * squeeze), self.reach());
            let (x, y) = ((along - s).max(0.0) / along, r / across);
            let size = x.hypot(y);
            let scale = along.min(across);
            let per = scale / size.max(f64::MIN_POSITIVE);
            let gradient = DVec3::X * (per * x / along) - outward * (per * y / across);
            return ((1.0 - size) * scale, gradient);
        }
        let steepest = self.slope(radius).hypot(1.0);
        let depth = s - (self.x_at(r) - apex);
        (depth / steepest, (DVec3::X - outward * self.slope(r)) / steepest)
    }
}

impl Lens {
    /// Whether light that has left it does not come back by itself.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.front.curvature >= 0.0 && self.back.curvature <= 0.0
    }

    /// Where it is along its axis at a distance from it: the x of its faces.
    #[must_use]
    pub fn between(&self, r: f64) -> [f64; 2] {
        [self.front.x_at(r), self.back.x_at(r)]
    }

    /// Where it is thinnest: the distance from the axis, and how thick it is there, along the axis.
    #[must_use]
    pub fn thinnest(&self) -> (f64, f64) {
        let gap = |r: f64| (r, self.back.x_at(r) - self.front.x_at(r));
        let ends = [gap(0.0), gap(self.radius)];
        // Where the slopes of the faces are the same.
        let [c, b] = [self.front, self.back].map(|face| face.curvature * face.curvature);
        let squared = (b - c) / (c * b * (self.front.conic - self.back.conic));
        let alike = squared.sqrt();
        let inner = (alike < self.radius).then(|| gap(alike));
        let thinner = |a: (f64, f64), b: (f64, f64)| if b.1 < a.1 { b } else { a };
        inner.into_iter().fold(thinner(ends[0], ends[1]), thinner)
    }

    /// From where to where it reaches along its axis.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        let low = self.front.apex.min(self.front.x_at(self.radius));
        [low, self.back.apex.max(self.back.x_at(self.radius))]
    }

    /// The pieces of its border.
    pub const PARTS: [LensPart; 3] = [LensPart::Front, LensPart::Back, LensPart::Edge];

    /// Whether a piece of its border is curved such that a ray that runs away from it may meet it
    /// again.
    #[must_use]
    pub fn is_hollow(&self, part: LensPart) -> bool {
        match part {
            LensPart::Front => self.front.curvature < 0.0,
            LensPart::Back => self.back.curvature > 0.0,
            LensPart::Edge => false,
        }
    }

    /// The outward unit normal at a point of a piece of its border.
    #[must_use]
    pub fn outward(&self, part: LensPart, at: DVec3) -> DVec3 {
        match part {
            LensPart::Front => -self.front.normal(at),
            LensPart::Back => self.back.normal(at),
            LensPart::Edge => at.with_x(0.0).try_normalize().unwrap_or(DVec3::Y),
        }
    }

    /// Whether a point of a face's whole conic, or of the endless edge, is of the lens.
    fn is_of(&self, part: LensPart, at: DVec3) -> bool {
        let face = match part {
            LensPart::Front => &self.front,
            LensPart::Back => &self.back,
            LensPart::Edge => {
                let [low, high] = self.between(self.radius);
                let slack = RIM * self.radius;
                return (low - slack..=high + slack).contains(&at.x);
            }
        };
        let reach = self.radius * (1.0 + RIM);
        at.y * at.y + at.z * at.z <= reach * reach && face.is_near(at)
    }

    /// Where a ray comes into the edge, without ends, and where it leaves it; NaN if it does not.
    fn through_edge(&self, origin: DVec3, direction: DVec3) -> [f64; 2] {
        let (o, d) = (origin.with_x(0.0), direction.with_x(0.0));
        let (speed, along) = (d.length_squared(), o.dot(d));
        let inside = self.radius * self.radius - o.length_squared();
        let root = (along * along + speed * inside).sqrt();
        if along >= 0.0 {
            [-(along + root) / speed, inside / (along + root)]
        } else {
            [-inside / (root - along), (root - along) / speed]
        }
    }

    /// Where a ray from outside goes in through a piece of the border: the distance, from zero on,
    /// and the outward unit normal.
    #[must_use]
    pub fn entry(&self, part: LensPart, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        // From the closest approach: the difference of squares would lose digits far away.
        let near = -direction.dot(origin);
        let origin = origin + direction * near;
        let own = match part {
            LensPart::Front => self.front.crossings(origin, direction).forward,
            LensPart::Back => self.back.crossings(origin, direction).backward,
            LensPart::Edge => self.through_edge(origin, direction)[0],
        };
        let (at, distance) = (origin + direction * own, near + own);
        let met = distance >= 0.0 && distance.is_finite() && self.is_of(part, at);
        met.then(|| (distance, self.outward(part, at)))
    }

    /// Where a ray that is inside or on the border leaves: the distance, from zero on, through
    /// which piece, and the outward unit normal. `None` if rounding has lost it.
    #[must_use]
    pub fn exit(&self, origin: DVec3, direction: DVec3) -> Option<(f64, LensPart, DVec3)> {
        let ways = [
            self.front.crossings(origin, direction).backward,
            self.back.crossings(origin, direction).forward,
            self.through_edge(origin, direction)[1],
        ];
        let met = Self::PARTS.into_iter().zip(ways).map(|(part, distance)| (distance, part));
        let met = met.filter(|(distance, part)| {
            distance.is_finite() && self.is_of(*part, origin + direction * *distance)
        });
        let ahead = first_along(met.clone().filter(|(distance, _)| *distance >= -BEHIND));
        let behind = || {
            let near = met.filter(|(distance, _)| *distance > -TOUCHING);
            near.max_by(|one, other| one.0.total_cmp(&other.0))
        };
        let (distance, part) = ahead.or_else(behind)?;
        let distance = distance.max(0.0);
        Some((distance, part, self.outward(part, origin + direction * distance)))
    }

    /// Whether a point lies inside, `below` telling of two numbers that are alike whether it is.
    pub(super) fn has(&self, at: DVec3, below: impl Fn(f64, f64) -> bool) -> bool {
        let r = at.y.hypot(at.z);
        let [low, high] = self.between(r);
        below(r, self.radius) && below(low, at.x) && below(at.x, high)
    }

    /// The greatest value of a function of x and r over its faces.
    fn greatest_on_profile(&self, value: impl Fn(f64, f64) -> f64) -> f64 {
        let on = |face: &ConicFace| greatest_between(self.radius, |r| value(face.x_at(r), r));
        on(&self.front).max(on(&self.back))
    }

    /// The greatest value of a convex function over it.
    pub(super) fn greatest(&self, value: impl Fn(DVec3) -> f64) -> f64 {
        self.greatest_on_profile(|x, r| {
            super::convex::greatest_around(&|angle: f64| {
                value(DVec3::new(x, r * angle.cos(), r * angle.sin()))
            })
        })
    }

    /// How far it reaches along a vector from the origin.
    #[must_use]
    pub fn support(&self, direction: DVec3) -> f64 {
        let aside = direction.y.hypot(direction.z);
        self.greatest_on_profile(|x, r| direction.x * x + aside * r)
    }

    /// How far its farthest point is from a point.
    #[must_use]
    pub fn farthest_from(&self, point: DVec3) -> f64 {
        let beside = point.y.hypot(point.z);
        self.greatest_on_profile(|x, r| (x - point.x).hypot(r + beside))
    }

    /// The line of a face from rim to rim in the plane z = 0, in that many pieces: x and y.
    #[must_use]
    pub fn face_line(&self, face: &ConicFace, pieces: u32) -> Vec<[f64; 2]> {
        let place = |k: u32| {
            let r = self.radius * (1.0 - 2.0 * f64::from(k) / f64::from(pieces));
            [face.x_at(r.abs()), r]
        };
        (0..=pieces).map(place).collect()
    }

    /// Points on rings around its faces, between which all of it lies.
    pub(super) fn rings(&self) -> Vec<DVec3> {
        const RINGS: u32 = 16;
        const TURNS: u32 = 96;
        let radius = self.radius;
        let point = move |face: &ConicFace, ring: u32, turn: u32| {
            let r = radius * f64::from(ring) / f64::from(RINGS);
            let (sin, cos) = (std::f64::consts::TAU * f64::from(turn) / f64::from(TURNS)).sin_cos();
            DVec3::new(face.x_at(r), r * cos, r * sin)
        };
        let faces = [self.front, self.back];
        let ring = |face: ConicFace| {
            (0..(RINGS + 1) * TURNS).map(move |k| point(&face, k / TURNS, k % TURNS))
        };
        faces.into_iter().flat_map(ring).collect()
    }

    /// The cylinder around it.
    pub(super) fn cylinder_around(&self) -> Solid {
        let [min, max] = self.ends();
        let pose = Pose::with_axis(DVec3::ZERO, 0.0, DVec3::X);
        Solid::cylinder(self.radius, Extent { min, max }).placed(&pose)
    }
}

/// The greatest value of a function from 0 to an end that is smooth between samples.
pub(super) fn greatest_between(end: f64, value: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    const SAMPLES: u32 = 96;
    let step = end / f64::from(SAMPLES);
    let samples = (0..=SAMPLES).map(|k| step * f64::from(k)).map(|r| (r, value(r)));
    let Some((best, sampled)) = samples.max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return f64::NEG_INFINITY;
    };
    let (mut low, mut high) = ((best - step).max(0.0), (best + step).min(end));
    for _ in 0..60 {
        let span = GOLDEN * (high - low);
        let (left, right) = (high - span, low + span);
        if value(left) < value(right) { low = left } else { high = right }
    }
    sampled.max(value(0.5 * (low + high)))
}

#[cfg(test)]
mod tests;
