//! Where a ray meets the border: the first crossing within a step, and the refinement of that root.

use pulp::Simd;

use super::Boundary;
use super::points::{Point, PointLanes};
use crate::geometry::Extent;
use crate::lanes::Lanes;
use crate::transformation::{Truncation, root_in_bracket};

#[cfg(test)]
mod tests;

/// Rates below this count as going along the border.
const ALONG: f64 = 1e-14;

/// Steps are not split at less than this share of the map's scale: the interpolation is exact
/// there.
const SHORTEST_SPLIT: f64 = 1e-3;

/// A border that has been passed by so little, in units of the map's scale and of the step, is
/// found from the end.
const NEAR: f64 = 0.03;

/// Where the interpolation puts an end of the step.
const AT_END: f64 = 1.0 - 1e-3;

/// A root this near to the border is exact, relative to the lengths at hand.
const ROOT_FOUND: f64 = 1e-15;

/// What counts as having missed another part of the border, relative to the map's scale.
const MISSED: f64 = 1e-11;

const MAX_CORRECTIONS: u32 = 12;

/// A coordinate's value and its first two derivatives by τ.
#[derive(Clone, Copy, Debug)]
struct EventJet<T = f64> {
    value: T,
    rate: T,
    bend: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Coordinate {
    X,
    Y,
    VirtualY,
    Z,
    /// The distance from the z axis, as (r²/l + l)/2 with the limit l: it has a derivative on the
    /// axis, too.
    Radius,
}

/// The distance of a coordinate from its limit, positive inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EventFunction {
    boundary: Boundary,
    coordinate: Coordinate,
    sign: f64,
    limit: f64,
}

impl EventFunction {
    fn at(&self, point: &Point, p_z: f64) -> EventJet {
        let (value, rate, bend) = match self.coordinate {
            Coordinate::X => (point.jet.f.re, point.velocity.re, point.bend.re),
            Coordinate::Y => (point.jet.f.im, point.velocity.im, point.bend.im),
            Coordinate::VirtualY => (point.zeta.im, point.momentum.im, point.force.im),
            Coordinate::Z => {
                let f1 = point.jet.f1;
                let bend = 2.0 * p_z * (f1.conj() * point.jet.f2 * point.momentum).re;
                (point.z, p_z * f1.norm_sqr(), bend)
            }
            Coordinate::Radius => {
                let (f, velocity, near) = (point.jet.f, point.velocity, self.limit.recip());
                let bend = velocity.norm_sqr() + (f.conj() * point.bend).re;
                let value = 0.5 * (f.norm_sqr() * near + self.limit);
                (value, (f.conj() * velocity).re * near, bend * near)
            }
        };
        let sign = self.sign;
        EventJet { value: sign * (value - self.limit), rate: sign * rate, bend: sign * bend }
    }

    #[inline(always)]
    fn motions<S: Simd>(&self, at: &PointLanes<S>, p_z: Lanes<S>) -> EventJet<Lanes<S>> {
        let (value, rate, bend) = match self.coordinate {
            Coordinate::X => (at.jet.f.re, at.velocity.re, at.bend.re),
            Coordinate::Y => (at.jet.f.im, at.velocity.im, at.bend.im),
            Coordinate::VirtualY => (at.zeta.im, at.momentum.im, at.force.im),
            Coordinate::Z => (at.z, p_z * at.jet.f1.norm_squared(), at.axial_bend(p_z)),
            Coordinate::Radius => {
                let (f, velocity, near) = (at.jet.f, at.velocity, self.limit.recip());
                let bend = velocity.norm_squared() + (f.conj() * at.bend).re;
                let value = f.norm_squared() * (0.5 * near) + p_z.all(0.5 * self.limit);
                (value, (f.conj() * velocity).re * near, bend * near)
            }
        };
        let sign = self.sign;
        EventJet {
            value: (value - value.all(self.limit)) * sign,
            rate: rate * sign,
            bend: bend * sign,
        }
    }
}

impl<S: Simd> EventJet<Lanes<S>> {
    /// When the value next falls through zero, by extrapolation; infinity for never.
    #[inline(always)]
    fn time_ahead(&self) -> Lanes<S> {
        let Self { value, rate, bend } = *self;
        let (zero, never) = (value.all(0.0), value.all(f64::INFINITY));
        let discriminant = rate * rate - value * bend * 2.0;
        let root = discriminant.sqrt();
        let falling = rate.less_than(zero);
        let time =
            falling.choose(value * 2.0, rate + root).divided_by(falling.choose(root - rate, -bend));
        // Without a real root it is not a number, and less than nothing.
        let falls = falling.or(bend.less_than(zero)).and(time.less_than(never));
        falls.choose(time, never)
    }
}

impl EventJet {
    /// The time (of any sign) to the nearest zero; to the nearest extremum where there is none.
    fn time_to_zero(&self) -> f64 {
        let Self { value, rate, bend } = *self;
        let discriminant = rate * rate - 2.0 * value * bend;
        if discriminant >= 0.0 {
            let steep = rate + discriminant.sqrt().copysign(rate);
            if steep == 0.0 { 0.0 } else { -2.0 * value / steep }
        } else {
            -rate / bend
        }
    }
}

/// What a step has to do with the border.
pub(super) enum Crossing {
    /// It stays inside.
    None,
    /// It may touch the border at this share of the step: go there and look.
    Unclear { share: f64 },
    /// It crosses, first at about this share of the step.
    At { event: EventFunction, share: f64 },
}

/// The last moves of a ray, onto the border.
#[derive(Clone, Copy, Debug)]
pub(super) struct RootRefinement {
    /// How far to move next.
    pub ahead: f64,
    pub event: EventFunction,
    /// The limit of each correction.
    pub reach: f64,
    pub corrections: u32,
}

/// Where the refinement is after a move.
pub(super) enum RootStatus {
    /// It is not there yet.
    Continue,
    Found(Boundary),
    Lost,
}

/// The distances from all parts of the border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EventFunctions {
    all: [EventFunction; 8],
    /// The length over which the map varies.
    scale: f64,
}

impl EventFunctions {
    /// Those of a cut map, the space within the first and beyond the second of two radii about the
    /// z axis, which are infinite where there is none.
    pub fn new(cut: &Truncation, extent: Extent, rim: f64, core: f64, scale: f64) -> Self {
        let event =
            |boundary, coordinate, sign, limit| EventFunction { boundary, coordinate, sign, limit };
        Self {
            all: [
                event(Boundary::Floor, Coordinate::VirtualY, 1.0, 0.0),
                event(Boundary::XMin, Coordinate::X, 1.0, cut.x_min),
                event(Boundary::XMax, Coordinate::X, -1.0, cut.x_max),
                event(Boundary::YMax, Coordinate::Y, -1.0, cut.y_max),
                event(Boundary::ZMin, Coordinate::Z, 1.0, extent.min),
                event(Boundary::ZMax, Coordinate::Z, -1.0, extent.max),
                event(Boundary::Rim, Coordinate::Radius, -1.0, rim),
                event(Boundary::Core, Coordinate::Radius, 1.0, core),
            ],
            scale,
        }
    }

    fn finite(&self) -> impl Iterator<Item = &EventFunction> {
        self.all.iter().filter(|event| event.limit.is_finite())
    }

    /// The part of the border a ray starts on if it goes outwards from there.
    pub fn leaving_at(&self, p_z: f64, point: &Point, slack: f64) -> Option<Boundary> {
        self.finite()
            .map(|event| (event, event.at(point, p_z)))
            .filter(|(_, motion)| motion.value <= slack && motion.rate < -ALONG)
            .min_by(|a, b| a.1.rate.total_cmp(&b.1.rate))
            .map(|(event, _)| event.boundary)
    }

    /// What can be seen of the border at both ends of a move of four rays: when they next meet it,
    /// by extrapolation from the end, infinity for never; and numbers that are not zero if they may
    /// have crossed it on the way: see [`Self::first_crossing`].
    #[inline(always)]
    pub fn outlook<S: Simd>(
        &self,
        from: &PointLanes<S>,
        to: &PointLanes<S>,
        p_z: Lanes<S>,
    ) -> [Lanes<S>; 2] {
        let zero = p_z.all(0.0);
        let (mut ahead, mut crossed) = (p_z.all(f64::INFINITY), zero);
        for event in self.finite() {
            let (before, after) = (event.motions(from, p_z), event.motions(to, p_z));
            let time = after.time_ahead();
            ahead = time.less_than(ahead).choose(time, ahead);
            let dips = before.rate.less_than(zero).and(zero.less_than(after.rate));
            let leaves = after.value.less_than(zero);
            crossed = dips.or(leaves).choose(zero.all(1.0), crossed);
        }
        [ahead, crossed]
    }

    /// The first crossing of the border in a step of length `reach` from `a` to `b`.
    pub fn first_crossing(&self, p_z: f64, a: &Point, b: &Point, reach: f64) -> Crossing {
        let (mut first, mut earliest) = (Crossing::None, f64::INFINITY);
        for &event in self.finite() {
            let (from, to) = (event.at(a, p_z), event.at(b, p_z));
            let (share, clear) = if to.value < 0.0 {
                let back = to.time_to_zero();
                let near = from.rate < 0.0 && to.rate < 0.0 && -back < NEAR * self.scale.min(reach);
                let share = if near && from.value > 0.0 {
                    1.0 + back.min(0.0) / reach
                } else {
                    Hermite::new(from, to, reach).first_fall()
                };
                (share, true)
            } else if from.rate < 0.0 && to.rate > 0.0 {
                let hermite = Hermite::new(from, to, reach);
                let (share, least) = hermite.minimum();
                let relative = reach / self.scale;
                let unclear = share * relative > SHORTEST_SPLIT;
                // The interpolation is not trusted beyond this.
                let margin = if unclear { 2e-3 * self.scale * relative.powi(4) } else { 0.0 };
                // At its end it has been looked at: it is not beyond.
                if least >= margin || unclear && share > AT_END {
                    continue;
                }
                (share, !unclear)
            } else {
                continue;
            };
            if share < earliest {
                earliest = share;
                let at = Crossing::At { event, share };
                first = if clear { at } else { Crossing::Unclear { share } };
            }
        }
        first
    }
}

impl RootRefinement {
    /// What is left to do after a move, the ray being `here`.
    pub fn check(&mut self, here: &Point, events: &EventFunctions, p_z: f64) -> RootStatus {
        self.corrections += 1;
        let motion = self.event.at(here, p_z);
        let remaining = motion.time_to_zero();
        if remaining.abs() > self.reach || remaining.is_nan() {
            return RootStatus::Lost;
        }
        if self.corrections >= MAX_CORRECTIONS {
            // Grazing incidence: as near as rounding allows.
            return RootStatus::Found(self.event.boundary);
        }
        let exact = ROOT_FOUND * (events.scale + self.event.limit.abs());
        if motion.value.abs() > exact && remaining != 0.0 {
            self.ahead = remaining;
            return RootStatus::Continue;
        }
        // Near an edge the interpolation may have taken the later of two crossings for the first.
        let missed = events.finite().find(|other| {
            let motion = other.at(here, p_z);
            motion.value < -MISSED * events.scale && motion.rate < 0.0
        });
        let Some(&other) = missed else { return RootStatus::Found(self.event.boundary) };
        self.event = other;
        self.ahead = other.at(here, p_z).time_to_zero().max(-self.reach);
        RootStatus::Continue
    }
}

/// The polynomial of degree five with given values and two derivatives at both ends of a step, over
/// the share 0 <= s <= 1 of the step.
struct Hermite([f64; 6]);

impl Hermite {
    fn new(from: EventJet, to: EventJet, reach: f64) -> Self {
        let scaled = |m: EventJet| (m.value, m.rate * reach, 0.5 * m.bend * reach * reach);
        let ((v0, r0, b0), (v1, r1, b1)) = (scaled(from), scaled(to));
        let (value, rate, bend) = (v1 - v0 - r0 - b0, r1 - r0 - 2.0 * b0, b1 - b0);
        let third = 10.0 * value - 4.0 * rate + bend;
        let fourth = -15.0 * value + 7.0 * rate - 2.0 * bend;
        let fifth = 6.0 * value - 3.0 * rate + bend;
        Self([v0, r0, b0, third, fourth, fifth])
    }

    /// Where it first falls through zero, being negative at the end.
    fn first_fall(&self) -> f64 {
        let c = &self.0;
        let end: f64 = c.iter().sum();
        if c[0] > 0.0 {
            return root_in_bracket((0.0, c[0]), (1.0, end), |s| horner(c, s));
        }
        // It starts at zero, and that root is divided out.
        let deflated = &c[1..];
        if deflated[0] <= 0.0 {
            return 0.0;
        }
        root_in_bracket((0.0, deflated[0]), (1.0, end - c[0]), |s| horner(deflated, s))
    }

    /// Place and value of the minimum between a falling start and a rising end.
    fn minimum(&self) -> (f64, f64) {
        let c = &self.0;
        let slope = [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 5.0 * c[5]];
        let share =
            root_in_bracket((0.0, slope[0]), (1.0, slope.iter().sum()), |s| horner(&slope, s));
        (share, horner(c, share).0)
    }
}

/// Value and slope of a polynomial, its coefficients in rising order.
fn horner(coefficients: &[f64], s: f64) -> (f64, f64) {
    coefficients
        .iter()
        .rev()
        .fold((0.0, 0.0), |(value, slope), c| (value * s + c, slope * s + value))
}
