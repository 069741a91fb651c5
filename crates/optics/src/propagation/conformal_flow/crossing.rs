//! Where a ray meets the border: the first crossing within a step, and landing on it.

use super::Boundary;
use super::course::{Course, Point};
use crate::geometry::Extent;
use crate::transformation::{Truncation, root_in_bracket};

/// Rates below this count as going along the border.
const ALONG: f64 = 1e-14;

/// Steps are not split at less than this share of the map's scale: the interpolation is exact there.
const SHORTEST_SPLIT: f64 = 1e-3;

/// A landing this near to the border is exact, relative to the lengths at hand.
const LANDED: f64 = 1e-15;

/// What counts as having missed another part of the border, relative to the map's scale.
const MISSED: f64 = 1e-11;

const MAX_CORRECTIONS: u32 = 12;

/// A coordinate's value and its first two derivatives by τ.
#[derive(Clone, Copy, Debug)]
struct Motion {
    value: f64,
    rate: f64,
    bend: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Coordinate {
    X,
    Y,
    VirtualY,
    Z,
}

/// The distance of a coordinate from its limit, positive inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gauge {
    boundary: Boundary,
    coordinate: Coordinate,
    sign: f64,
    limit: f64,
}

impl Gauge {
    fn at(&self, point: &Point, p_z: f64) -> Motion {
        let (value, rate, bend) = match self.coordinate {
            Coordinate::X => (point.jet.f.re, point.velocity.re, point.bend.re),
            Coordinate::Y => (point.jet.f.im, point.velocity.im, point.bend.im),
            Coordinate::VirtualY => (point.zeta.im, point.momentum.im, point.force.im),
            Coordinate::Z => {
                let f1 = point.jet.f1;
                let bend = 2.0 * p_z * (f1.conj() * point.jet.f2 * point.momentum).re;
                (point.z, p_z * f1.norm_sqr(), bend)
            }
        };
        let sign = self.sign;
        Motion { value: sign * (value - self.limit), rate: sign * rate, bend: sign * bend }
    }
}

impl Motion {
    /// When the value next falls through zero, by extrapolation; infinity for never.
    fn time_ahead(&self) -> f64 {
        let Self { value, rate, bend } = *self;
        let discriminant = rate * rate - 2.0 * value * bend;
        if discriminant < 0.0 || discriminant.is_nan() {
            return f64::INFINITY;
        }
        let root = discriminant.sqrt();
        if rate < 0.0 {
            2.0 * value / (root - rate)
        } else if bend < 0.0 {
            (rate + root) / -bend
        } else {
            f64::INFINITY
        }
    }

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
    At { gauge: Gauge, share: f64 },
}

/// The last moves of a ray, onto the border.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing {
    /// How far to move next.
    pub ahead: f64,
    gauge: Gauge,
    /// The limit of each correction.
    reach: f64,
    corrections: u32,
}

/// What a landing ray finds after a move.
pub(super) enum Look {
    /// It is not there yet.
    Move,
    Landed(Boundary),
    Missed,
}

/// The distances from all parts of the border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gauges {
    all: [Gauge; 6],
}

impl Gauges {
    pub fn new(cut: &Truncation, extent: Extent) -> Self {
        let gauge = |boundary, coordinate, sign, limit| Gauge { boundary, coordinate, sign, limit };
        Self {
            all: [
                gauge(Boundary::Floor, Coordinate::VirtualY, 1.0, 0.0),
                gauge(Boundary::XMin, Coordinate::X, 1.0, cut.x_min),
                gauge(Boundary::XMax, Coordinate::X, -1.0, cut.x_max),
                gauge(Boundary::YMax, Coordinate::Y, -1.0, cut.y_max),
                gauge(Boundary::ZMin, Coordinate::Z, 1.0, extent.min),
                gauge(Boundary::ZMax, Coordinate::Z, -1.0, extent.max),
            ],
        }
    }

    fn finite(&self) -> impl Iterator<Item = &Gauge> {
        self.all.iter().filter(|gauge| gauge.limit.is_finite())
    }

    /// The part of the border a ray starts on if it goes outwards from there.
    pub fn leaving_at(&self, course: &Course, point: &Point, slack: f64) -> Option<Boundary> {
        self.finite()
            .map(|gauge| (gauge, gauge.at(point, course.p_z)))
            .filter(|(_, motion)| motion.value <= slack && motion.rate < -ALONG)
            .min_by(|a, b| a.1.rate.total_cmp(&b.1.rate))
            .map(|(gauge, _)| gauge.boundary)
    }

    /// When the ray next meets the border, by extrapolation.
    pub fn time_ahead(&self, course: &Course, point: &Point) -> f64 {
        self.finite()
            .map(|gauge| gauge.at(point, course.p_z).time_ahead())
            .fold(f64::INFINITY, f64::min)
    }

    /// The first crossing of the border in a step of length `reach` from `a` to `b`.
    pub fn first_crossing(&self, course: &Course, a: &Point, b: &Point, reach: f64) -> Crossing {
        let (mut first, mut earliest) = (Crossing::None, f64::INFINITY);
        for &gauge in self.finite() {
            let (from, to) = (gauge.at(a, course.p_z), gauge.at(b, course.p_z));
            let (share, found) = if to.value < 0.0 {
                let share = Hermite::new(from, to, reach).first_fall();
                (share, Crossing::At { gauge, share })
            } else if from.rate < 0.0 && to.rate > 0.0 {
                let hermite = Hermite::new(from, to, reach);
                let (share, least) = hermite.minimum();
                // The interpolation is not trusted beyond this.
                let relative = reach / course.scale;
                let margin = 2e-3 * course.scale * relative.powi(4);
                if share * relative > SHORTEST_SPLIT {
                    if least >= margin {
                        continue;
                    }
                    (share, Crossing::Unclear { share })
                } else {
                    if least >= 0.0 {
                        continue;
                    }
                    (share, Crossing::At { gauge, share })
                }
            } else {
                continue;
            };
            if share < earliest {
                (first, earliest) = (found, share);
            }
        }
        first
    }
}

impl Landing {
    /// On a border that is `ahead`, at the given gauge, as far as interpolation can tell.
    pub fn new(ahead: f64, gauge: Gauge, reach: f64) -> Self {
        Self { ahead, gauge, reach, corrections: 0 }
    }

    /// Looks where the ray is after a move, that is `here`.
    pub fn look(&mut self, here: &Point, gauges: &Gauges, course: &Course) -> Look {
        self.corrections += 1;
        let motion = self.gauge.at(here, course.p_z);
        let remaining = motion.time_to_zero();
        if remaining.abs() > self.reach || remaining.is_nan() {
            return Look::Missed;
        }
        if self.corrections >= MAX_CORRECTIONS {
            // Grazing incidence: as near as rounding allows.
            return Look::Landed(self.gauge.boundary);
        }
        let exact = LANDED * (course.scale + self.gauge.limit.abs());
        if motion.value.abs() > exact && remaining != 0.0 {
            self.ahead = remaining;
            return Look::Move;
        }
        // Near an edge the interpolation may have taken the later of two crossings for the first.
        let missed = gauges.finite().find(|other| {
            let motion = other.at(here, course.p_z);
            motion.value < -MISSED * course.scale && motion.rate < 0.0
        });
        let Some(&other) = missed else { return Look::Landed(self.gauge.boundary) };
        self.gauge = other;
        self.ahead = other.at(here, course.p_z).time_to_zero().max(-self.reach);
        Look::Move
    }
}

/// The polynomial of degree five with given values and two derivatives at both ends of a step, over
/// the share 0 <= s <= 1 of the step.
struct Hermite([f64; 6]);

impl Hermite {
    fn new(from: Motion, to: Motion, reach: f64) -> Self {
        let scaled = |m: Motion| (m.value, m.rate * reach, 0.5 * m.bend * reach * reach);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// (s - a)(s - b)(s - c) and its derivatives at s.
    fn cubic(s: f64, [a, b, c]: [f64; 3]) -> Motion {
        let (p, q, r) = (s - a, s - b, s - c);
        Motion { value: p * q * r, rate: p * q + q * r + r * p, bend: 2.0 * (p + q + r) }
    }

    #[test]
    fn the_first_fall_is_found_and_a_root_at_the_start_passed_over() {
        let fall =
            |roots: [f64; 3]| Hermite::new(cubic(0.0, roots), cubic(1.0, roots), 1.0).first_fall();
        assert!((fall([-0.5, 0.4, 2.0]) - 0.4).abs() < 1e-14);
        assert!((fall([0.0, 0.7, 3.0]) - 0.7).abs() < 1e-14);
        assert!((fall([0.0, 1e-6, 3.0]) - 1e-6).abs() < 1e-14);
    }

    #[test]
    fn a_dip_is_seen_from_its_ends() {
        let roots = [-1.0, 0.4, 0.6];
        let (share, least) = Hermite::new(cubic(0.0, roots), cubic(1.0, roots), 1.0).minimum();
        assert!(share > 0.4 && share < 0.6 && least < 0.0);
        assert!(
            (cubic(share, roots).rate).abs() < 1e-13
                && (cubic(share, roots).value - least).abs() < 1e-14
        );
    }

    #[test]
    fn extrapolation_sees_the_next_fall_only() {
        let time = |value, rate, bend| Motion { value, rate, bend }.time_ahead();
        assert_eq!(time(2.0, -1.0, 0.0), 2.0);
        assert_eq!(time(2.0, 1.0, 0.0), f64::INFINITY);
        assert_eq!(time(2.0, 0.0, -1.0), 2.0);
        assert_eq!(time(0.0, 1.0, -1.0), 2.0);
        assert_eq!(time(2.0, -1.0, 5.0), f64::INFINITY);
        assert_eq!(time(f64::NAN, 1.0, 1.0), f64::INFINITY);
    }
}
