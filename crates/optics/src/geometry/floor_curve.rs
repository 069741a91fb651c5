//! The bare metal of a conformal cloak: the curve x + iy = f(X), and what closes it from below.

use glam::DVec2;
use num_complex::Complex64;

use super::Outline;
use crate::transformation::{ConformalMap, root_in_bracket};

/// The outline of the metal below the floor f(X) of a conformal map, cut at two x: the floor, the
/// back, and the blunt ends between the two. Lengths in cm.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorCurve {
    map: ConformalMap,
    back: MetalBack,
    /// From end to end; between neighbours the curve bends one way.
    knots: Vec<Knot>,
    /// The lowest and the highest y of the metal's bounding box.
    box_y: [f64; 2],
}

/// What closes the metal below a floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MetalBack {
    /// The mirror image of the floor under y -> -y: a double cloak's.
    MirrorImage,
    /// A plane of this y, nowhere above the floor: a carpet's.
    Flat(f64),
}

/// A curved side of a metal with a mirror image for its back.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum CurvedSide {
    /// The floor.
    Floor,
    /// Its mirror image.
    Image,
}

/// A ray, the least t that counts of its points origin + t direction, and which way it is to cross
/// the outline.
#[derive(Clone, Copy)]
struct Ray {
    origin: DVec2,
    direction: DVec2,
    t_min: f64,
    leaving: bool,
}

/// Where a ray meets the metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloorHit {
    /// Distance along the ray, in units of its direction's length.
    pub t: f64,
    /// Unit normal out of the metal.
    pub normal: DVec2,
}

/// A point of the curve and its derivative by the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    parameter: f64,
    point: Complex64,
    tangent: Complex64,
}

/// Pieces of a floor between two of its inflection points, or one and an end: a ray is known to miss nearly
/// all of them by their ends alone, and from those of the others its root is near.
const PIECES: usize = 32;

impl FloorCurve {
    /// The metal between physical `x_min` and `x_max`.
    #[must_use]
    pub fn new(map: ConformalMap, back: MetalBack, x_min: f64, x_max: f64) -> Self {
        let (start, end) = (map.profile_parameter(x_min), map.profile_parameter(x_max));
        let mut bends = vec![start];
        bends.extend(map.profile_inflections(start, end));
        bends.push(end);
        let between = |pair: &[f64]| {
            let (from, to) = (pair[0], pair[1]);
            (0..PIECES).map(move |k| from + (to - from) * k as f64 / PIECES as f64)
        };
        let parameters = bends.windows(2).flat_map(between).chain([end]);
        let knots: Vec<Knot> = parameters.map(|parameter| knot(&map, parameter)).collect();
        let peak = map.peak();
        let bottom = match back {
            MetalBack::MirrorImage => -peak,
            MetalBack::Flat(y) => y,
        };
        Self { map, back, knots, box_y: [bottom, peak] }
    }

    /// Its first and its last knot.
    fn ends(&self) -> [&Knot; 2] {
        [&self.knots[0], &self.knots[self.knots.len() - 1]]
    }

    /// The parameter at a share of the way from end to end.
    fn parameter_at(&self, share: f64) -> f64 {
        let [first, last] = self.ends();
        first.parameter + (last.parameter - first.parameter) * share
    }

    /// Whether a point lies inside the metal.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        let [first, last] = self.ends();
        let height = || self.map.profile(self.map.profile_parameter(point.x)).f.im;
        point.x > first.point.re
            && point.x < last.point.re
            && point.y > self.box_y[0]
            && point.y < self.box_y[1]
            && match self.back {
                MetalBack::MirrorImage => point.y.abs() < height(),
                MetalBack::Flat(_) => point.y < height(),
            }
    }

    /// A curved side from left to right in that many straight pieces.
    #[must_use]
    pub fn side_line(&self, side: CurvedSide, pieces: u32) -> Vec<DVec2> {
        let point = |k: u32| {
            let share = f64::from(k) / f64::from(pieces.max(1));
            let point = self.map.profile(self.parameter_at(share)).f;
            match side {
                CurvedSide::Floor => DVec2::new(point.re, point.im),
                CurvedSide::Image => DVec2::new(point.re, -point.im),
            }
        };
        (0..=pieces).map(point).collect()
    }

    /// The outline of the metal from the left end of its floor on, the floor and its mirror image
    /// in that many straight pieces each.
    #[must_use]
    pub fn outline(&self, pieces: u32) -> Vec<DVec2> {
        let floor = self.side_line(CurvedSide::Floor, pieces);
        let back: Vec<DVec2> = match self.back {
            MetalBack::MirrorImage => {
                self.side_line(CurvedSide::Image, pieces).into_iter().rev().collect()
            }
            MetalBack::Flat(y) => {
                let [first, last] = self.ends();
                [last, first].map(|end| DVec2::new(end.point.re, y)).to_vec()
            }
        };
        floor.into_iter().chain(back).collect()
    }

    /// The first point with t >= `t_min` where the ray `origin + t direction` enters the metal;
    /// points where it leaves do not count, so a ray may start on the metal (where the metal is
    /// thinner than rounding, far out, only a positive `t_min` keeps such a ray off the other
    /// side). None if there is none.
    #[must_use]
    pub fn first_hit(&self, origin: DVec2, direction: DVec2, t_min: f64) -> Option<FloorHit> {
        let ray = Ray { origin, direction, t_min, leaving: false };
        if !self.may_hit(ray) {
            return None;
        }
        let lower = match self.back {
            MetalBack::MirrorImage => self.first_on_side(CurvedSide::Image, ray),
            MetalBack::Flat(y) => self.first_on_plane(y, ray),
        };
        let hits = [self.first_on_curve(ray), lower, self.first_on_ends(ray)];
        hits.into_iter().flatten().min_by(|a, b| a.t.total_cmp(&b.t))
    }

    /// The first point with t >= `t_min` where a ray leaves the outline through its floor, or
    /// through the mirror image of it: the outline taken for that of a hollow, open at its ends.
    /// The normal points out of it.
    #[must_use]
    pub fn first_way_out(
        &self,
        side: CurvedSide,
        origin: DVec2,
        direction: DVec2,
        t_min: f64,
    ) -> Option<FloorHit> {
        let ray = Ray { origin, direction, t_min, leaving: true };
        self.may_hit(ray).then(|| self.first_on_side(side, ray))?
    }

    /// Whether an outline lies inside as a whole.
    pub(super) fn encloses(&self, outline: &Outline) -> bool {
        // What leaves between two corners comes back before the second.
        outline.corners.iter().all(|corner| self.contains(*corner))
            && outline.sides().all(|(from, to)| {
                self.first_hit(from, to - from, 0.0).is_none_or(|hit| hit.t > 1.0)
            })
    }

    /// How far a point inside a metal with a mirror image for its back lies from its curved sides.
    pub(super) fn depth(&self, point: DVec2) -> f64 {
        const SAMPLES: u32 = 512;
        let [first, last] = self.ends();
        // No point of the image is nearer than its own image to a point above the line between the
        // two.
        let here = Complex64::new(point.x, point.y.abs());
        let slope = |parameter: f64| {
            let jet = self.map.profile(parameter);
            let way = jet.f - here;
            ((jet.f1.conj() * way).re, jet.f1.norm_sqr() + (jet.f2.conj() * way).re)
        };
        let sample = |k: u32| self.parameter_at(f64::from(k) / f64::from(SAMPLES));
        let distance = |parameter: f64| (self.map.profile(parameter).f - here).norm();
        let ends = distance(first.parameter).min(distance(last.parameter));
        (0..SAMPLES)
            .filter_map(|k| {
                let (a, b) = (sample(k), sample(k + 1));
                let (at_a, at_b) = (slope(a).0, slope(b).0);
                (at_a <= 0.0 && at_b >= 0.0)
                    .then(|| distance(root_in_bracket((a, at_a), (b, at_b), slope)))
            })
            .fold(ends, f64::min)
    }

    /// Whether it is a ray, and its line meets the bounding box.
    fn may_hit(&self, Ray { origin, direction, .. }: Ray) -> bool {
        let inverse_square = direction.length_squared().recip();
        if !(inverse_square.is_finite() && origin.is_finite()) {
            return false;
        }
        let [first, last] = self.ends();
        let [bottom, top] = self.box_y;
        let (low, high) =
            (DVec2::new(first.point.re, bottom) - origin, DVec2::new(last.point.re, top) - origin);
        let sides = [low, high, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y)]
            .map(|v| v.perp_dot(direction));
        let slack = 1e-12 * top.max(-bottom) * direction.length();
        sides.iter().any(|s| *s >= -slack) && sides.iter().any(|s| *s <= slack)
    }

    /// The first crossing of the floor or of its mirror image.
    fn first_on_side(&self, side: CurvedSide, ray: Ray) -> Option<FloorHit> {
        if side == CurvedSide::Floor {
            return self.first_on_curve(ray);
        }
        let mirrored = |v: DVec2| DVec2::new(v.x, -v.y);
        let [origin, direction] = [ray.origin, ray.direction].map(mirrored);
        self.first_on_curve(Ray { origin, direction, ..ray })
            .map(|hit| FloorHit { normal: mirrored(hit.normal), ..hit })
    }

    /// The first crossing of the floor.
    ///
    /// On the ray, F(X) = cross(f(X) - origin, direction) vanishes. Its slope vanishes where the
    /// curve is parallel to the ray: at most once between two knots. So F is monotone on known
    /// intervals, and no root can be missed. Between two knots the curve lies in the triangle that its
    /// tangents there make with the chord: where all three corners are on one side of the ray, so is it.
    fn first_on_curve(&self, ray: Ray) -> Option<FloorHit> {
        let Ray { origin, direction, t_min, leaving } = ray;
        let along = Complex64::new(direction.x, direction.y);
        let cross = |v: Complex64| (v.conj() * along).im;
        let offset = Complex64::new(origin.x, origin.y);
        let height = |knot: &Knot| cross(knot.point - offset);
        let mut best: Option<FloorHit> = None;
        let mut consider = |a: &Knot, b: &Knot| {
            let ends = ((a.parameter, height(a)), (b.parameter, height(b)));
            let root = root_in_bracket(ends.0, ends.1, |x| {
                let here = knot(&self.map, x);
                (height(&here), cross(here.tangent))
            });
            let here = knot(&self.map, root);
            let t = ((here.point - offset) * along.conj()).re / along.norm_sqr();
            let normal = Complex64::i() * here.tangent / here.tangent.norm();
            let outward = (normal.conj() * along).re;
            let counts = if leaving { outward > 0.0 } else { outward < 0.0 };
            if counts && t >= t_min && best.is_none_or(|hit| t < hit.t) {
                let normal = DVec2::new(normal.re, normal.im);
                best = Some(FloorHit { t, normal });
            }
        };
        // Between knots from which on F only rises, or only falls.
        let mut cross_once = |knots: &[Knot]| {
            let [first, .., last] = knots else { return };
            let start = height(first);
            if start * height(last) <= 0.0 {
                let beyond = knots.partition_point(|knot| height(knot) * start > 0.0).max(1);
                consider(&knots[beyond - 1], &knots[beyond]);
            }
        };
        for bend in 0..self.knots.len() / PIECES {
            let knots = &self.knots[bend * PIECES..=(bend + 1) * PIECES];
            let rises = |knot: &Knot| cross(knot.tangent) > 0.0;
            let turned = knots.partition_point(|knot| rises(knot) == rises(&knots[0]));
            let (before, after) = knots.split_at(turned);
            cross_once(before);
            if let ([.., a], [b, ..]) = (before, after) {
                let (slope, twist) = (cross(a.tangent), |v: Complex64| (v.conj() * b.tangent).im);
                let corner = height(a) + slope * twist(b.point - a.point) / twist(a.tangent);
                let misses = height(a) * height(b) > 0.0 && height(a) * corner > 0.0;
                if !misses {
                    let ends = ((a.parameter, slope), (b.parameter, cross(b.tangent)));
                    let turning = root_in_bracket(ends.0, ends.1, |x| {
                        let jet = self.map.profile(x);
                        (cross(jet.f1), cross(jet.f2))
                    });
                    let turning = knot(&self.map, turning);
                    cross_once(&[*a, turning]);
                    cross_once(&[turning, *b]);
                }
                cross_once(after);
            }
        }
        best
    }

    /// A hit of the flat back from below.
    fn first_on_plane(
        &self,
        y: f64,
        Ray { origin, direction, t_min, .. }: Ray,
    ) -> Option<FloorHit> {
        let [first, last] = self.ends();
        let t = (y - origin.y) / direction.y;
        let x = origin.x + t * direction.x;
        let inside = x >= first.point.re && x <= last.point.re;
        let hit = FloorHit { t, normal: DVec2::NEG_Y };
        (direction.y > 0.0 && t >= t_min && inside).then_some(hit)
    }

    /// A hit of the vertical cuts through the metal.
    fn first_on_ends(&self, Ray { origin, direction, t_min, .. }: Ray) -> Option<FloorHit> {
        let [first, last] = self.ends();
        [(first, -1.0), (last, 1.0)]
            .into_iter()
            .filter(|(_, outward)| outward * direction.x < 0.0)
            .map(|(end, outward)| {
                let t = (end.point.re - origin.x) / direction.x;
                let y = origin.y + t * direction.y;
                let bottom = match self.back {
                    MetalBack::MirrorImage => -end.point.im,
                    MetalBack::Flat(y) => y,
                };
                let normal = DVec2::new(outward, 0.0);
                (y > bottom && y < end.point.im, FloorHit { t, normal })
            })
            .find(|(inside, hit)| *inside && hit.t >= t_min)
            .map(|(_, hit)| hit)
    }
}

fn knot(map: &ConformalMap, parameter: f64) -> Knot {
    let jet = map.profile(parameter);
    Knot { parameter, point: jet.f, tangent: jet.f1 }
}

#[cfg(test)]
mod tests;
