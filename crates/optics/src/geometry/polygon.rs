//! Simple polygons in the xy-plane, and the convex parts they can be cut into.

use super::Outline;
use glam::DVec2;

/// Points closer than this are one point, cm. Coordinates are written with a few digits: rounded to
/// six decimals, a corner may be off by 0.71e-6, and as much again the side on which it lies.
pub const SAME_POINT: f64 = 2e-6;

/// A polygon that does not cross itself, its corners in counterclockwise order, none of them
/// straight.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    corners: Vec<DVec2>,
}

/// Why a list of points is no simple polygon.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PolygonError {
    /// The corners lie on a line.
    #[error(
        "the corners lie on one line, or are fewer than three that are {SAME_POINT} cm apart or more: they bound no area"
    )]
    Flat,
    /// Two sides meet that are not neighbours.
    #[error(
        "the side from corner {first} crosses or touches the side from corner {second} (corners are \
         counted from 0)"
    )]
    Crossing {
        /// The corner at which one side starts, in the list as given.
        first: usize,
        /// The corner at which the other starts.
        second: usize,
    },
}

/// A convex part of a polygon: the numbers of its corners, counterclockwise. Its edge from corner i
/// to corner i + 1 is a side of the polygon; any other edge is a cut, on whose other side is
/// another part.
pub type ConvexPart = Vec<usize>;

impl Polygon {
    /// The polygon with the given corners (cm), in either order. Corners that repeat the one before
    /// or lie straight between their neighbours are left out.
    ///
    /// # Errors
    ///
    /// If the corners bound no area, or two sides cross or touch.
    pub fn new(corners: &[DVec2]) -> Result<Self, PolygonError> {
        let mut kept: Vec<(usize, DVec2)> = corners.iter().copied().enumerate().collect();
        // Each corner that goes makes its neighbours look at new neighbours.
        while let Some(index) = superfluous(&kept) {
            kept.remove(index);
        }
        if kept.len() < 3 {
            return Err(PolygonError::Flat);
        }
        if let Some((first, second)) = crossing(&kept) {
            return Err(PolygonError::Crossing { first, second });
        }
        let mut corners: Vec<DVec2> = kept.into_iter().map(|(_, corner)| corner).collect();
        if doubled_area(&corners) < 0.0 {
            corners.reverse();
        }
        Ok(Self { corners })
    }

    /// The corners, counterclockwise.
    #[must_use]
    pub fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// The enclosed area, cm².
    #[must_use]
    pub fn area(&self) -> f64 {
        0.5 * doubled_area(&self.corners)
    }

    /// Convex parts that make up the polygon, at most four times as many as need be: the ears of
    /// the polygon cut off one by one, and joined again where that makes no bend inwards (Hertel &
    /// Mehlhorn, FCT 1983).
    #[must_use]
    pub fn convex_parts(&self) -> Vec<ConvexPart> {
        let n = self.corners.len();
        let whole: ConvexPart = (0..n).collect();
        if self.is_convex(&whole) {
            return vec![whole];
        }
        let mut parts = self.ears();
        let is_cut = |i: usize, j: usize| (i + 1) % n != j && (j + 1) % n != i;
        let cuts: Vec<[usize; 2]> = parts
            .iter()
            .flat_map(|part| edges(part).collect::<Vec<_>>())
            .filter(|&[i, j]| i < j && is_cut(i, j))
            .collect();
        for [i, j] in cuts {
            let with = |edge: [usize; 2]| parts.iter().position(|p| edges(p).any(|e| e == edge));
            if let (Some(one), Some(other)) = (with([i, j]), with([j, i])) {
                let joined = joined(&parts[one], &parts[other], [i, j]);
                if self.is_convex(&joined) {
                    parts[one] = joined;
                    parts.swap_remove(other);
                }
            }
        }
        parts
    }

    /// A convex part as an outline.
    pub fn outline(&self, part: &ConvexPart) -> Outline {
        Outline { corners: part.iter().map(|&i| self.corners[i]).collect() }
    }

    /// Triangles that make up the polygon.
    fn ears(&self) -> Vec<ConvexPart> {
        let mut rest: Vec<usize> = (0..self.corners.len()).collect();
        let mut parts = Vec::new();
        while rest.len() > 3 {
            let n = rest.len();
            let around = |at: usize| around(n, at).map(|k| rest[k]);
            // A simple polygon has two ears at least; where rounding hides them, the corner that
            // bends most is as good.
            let at = (0..n).find(|&at| self.is_ear(around(at), &rest)).unwrap_or_else(|| {
                let bend = |at: &usize| self.bend(around(*at));
                (0..n).max_by(|a, b| bend(a).total_cmp(&bend(b))).unwrap_or(0)
            });
            parts.push(around(at).to_vec());
            rest.remove(at);
        }
        parts.push(rest);
        parts
    }

    fn is_ear(&self, triangle: [usize; 3], rest: &[usize]) -> bool {
        let [a, b, c] = triangle.map(|i| self.corners[i]);
        let holds = |p: DVec2| {
            [(a, b), (b, c), (c, a)].iter().all(|(from, to)| (to - from).perp_dot(p - from) >= 0.0)
        };
        self.turns_left(triangle)
            && !rest.iter().any(|i| !triangle.contains(i) && holds(self.corners[*i]))
    }

    fn is_convex(&self, part: &[usize]) -> bool {
        let n = part.len();
        (0..n).all(|i| self.turns_left(around(n, i).map(|k| part[k])))
    }

    fn turns_left(&self, corners: [usize; 3]) -> bool {
        self.bend(corners) > 0.0
    }

    fn bend(&self, corners: [usize; 3]) -> f64 {
        let [a, b, c] = corners.map(|i| self.corners[i]);
        (b - a).perp_dot(c - b)
    }
}

/// A corner of `n`, with the one before and the one after.
fn around(n: usize, at: usize) -> [usize; 3] {
    [(at + n - 1) % n, at, (at + 1) % n]
}

fn edges(part: &[usize]) -> impl Iterator<Item = [usize; 2]> + '_ {
    (0..part.len()).map(|i| [part[i], part[(i + 1) % part.len()]])
}

/// Two parts as one, without the cut [i, j] of the first, which is [j, i] in the second.
fn joined(one: &[usize], other: &[usize], [i, j]: [usize; 2]) -> ConvexPart {
    let from = |part: &[usize], start: usize| {
        let (before, after) =
            part.split_at(part.iter().position(|&corner| corner == start).unwrap_or(0));
        [after, before].concat()
    };
    // j ... i of the first, then what lies between i and j in the second.
    let mut corners = from(one, j);
    let second = from(other, i);
    corners.extend(&second[1..second.len() - 1]);
    corners
}

/// A corner on the way from the one before to the one after.
fn superfluous(corners: &[(usize, DVec2)]) -> Option<usize> {
    let n = corners.len();
    (0..n).find(|&i| {
        let [a, b, c] = around(n, i).map(|k| corners[k].1);
        n > 1 && (a.distance(b) <= SAME_POINT || segment_distance(b, [a, c]) <= SAME_POINT)
    })
}

/// The first two sides that meet and are not neighbours.
fn crossing(corners: &[(usize, DVec2)]) -> Option<(usize, usize)> {
    let n = corners.len();
    let side = |i: usize| [corners[i].1, corners[(i + 1) % n].1];
    let mut pairs = (2..n).flat_map(|j| (0..j - 1).map(move |i| (i, j)));
    pairs
        .find(|&(i, j)| (j + 1) % n != i && segments_meet(side(i), side(j)))
        .map(|(i, j)| (corners[i].0, corners[j].0))
}

fn segments_meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let straddles = |[a, b]: [DVec2; 2], [c, d]: [DVec2; 2]| {
        let along = b - a;
        (along.perp_dot(c - a) < 0.0) != (along.perp_dot(d - a) < 0.0)
    };
    let near = [(a, [c, d]), (b, [c, d]), (c, [a, b]), (d, [a, b])]
        .into_iter()
        .any(|(corner, side)| segment_distance(corner, side) <= SAME_POINT);
    near || (straddles([a, b], [c, d]) && straddles([c, d], [a, b]))
}

fn segment_distance(point: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let length = along.length_squared();
    let share = if length > 0.0 { ((point - a).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
    point.distance(a + along * share)
}

fn doubled_area(corners: &[DVec2]) -> f64 {
    let n = corners.len();
    (0..n).map(|i| corners[i].perp_dot(corners[(i + 1) % n])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polygon(corners: &[[f64; 2]]) -> Result<Polygon, PolygonError> {
        Polygon::new(&corners.iter().map(|c| DVec2::from(*c)).collect::<Vec<_>>())
    }

    /// The parts are convex, cover the area, and each side belongs to one of them.
    fn check(polygon: &Polygon) {
        let parts = polygon.convex_parts();
        let n = polygon.corners().len();
        let mut area = 0.0;
        let mut sides = vec![0; n];
        for part in &parts {
            assert!(polygon.is_convex(part), "{part:?}");
            area += 0.5 * doubled_area(&polygon.outline(part).corners);
            for [i, j] in edges(part) {
                if (i + 1) % n == j {
                    sides[i] += 1;
                } else {
                    let twins = parts.iter().flat_map(|p| edges(p)).filter(|e| *e == [j, i]);
                    assert_eq!(twins.count(), 1, "cut {i} {j}");
                }
            }
        }
        assert!((area - polygon.area()).abs() < 1e-9 * polygon.area());
        assert!(sides.iter().all(|count| *count == 1), "{sides:?}");
    }

    #[test]
    fn a_letter_is_cut_into_convex_parts() {
        let letter = polygon(&[
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [3.0, 2.0],
            [3.0, 3.0],
            [0.0, 3.0],
        ])
        .expect("a C");
        check(&letter);
        assert_eq!(letter.area(), 7.0);
        assert_eq!(letter.convex_parts().len(), 3);
    }

    #[test]
    fn order_and_superfluous_corners_do_not_matter() {
        let square = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]).expect("a square");
        let same = polygon(&[
            [0.0, 2.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 0.0],
            [2.0, 0.0],
            [0.0, 0.0],
            [0.0, 2.0],
        ])
        .expect("a square");
        assert_eq!(same.area(), 4.0);
        assert_eq!(same.corners().len(), 4);
        assert_eq!(square.convex_parts(), [vec![0, 1, 2, 3]]);
        check(&same);
    }

    #[test]
    fn what_is_no_polygon_is_refused() {
        assert_eq!(polygon(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]), Err(PolygonError::Flat));
        assert_eq!(polygon(&[]), Err(PolygonError::Flat));
        assert_eq!(polygon(&[[0.0, 0.0]; 5]), Err(PolygonError::Flat));
        let bow = polygon(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(bow, Err(PolygonError::Crossing { first: 0, second: 2 }));
        // A corner on a far side.
        let touching = polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 0.0], [0.0, 3.0]]);
        assert!(matches!(touching, Err(PolygonError::Crossing { .. })));
    }

    proptest! {
        #[test]
        fn stars_are_cut_into_convex_parts(
            radii in proptest::collection::vec(0.2_f64..3.0, 5..30), turn in 0.0_f64..6.0,
        ) {
            let step = std::f64::consts::TAU / radii.len() as f64;
            let corners: Vec<DVec2> = (0u32..)
                .zip(&radii)
                .map(|(i, r)| DVec2::from_angle(turn + step * f64::from(i)) * *r)
                .collect();
            check(&Polygon::new(&corners).expect("a star"));
        }
    }
}
