//! Solids with flat faces: closed surfaces of triangles, convex or not.
//!
//! Whether a ray passes a triangle on one side of an edge or on the other is decided by one exact
//! expression that is the same for both triangles of the edge (Woop, Benthin & Wald, J. Comput. Graph.
//! Tech. 2(1), 65 (2013), with exact predicates after Shewchuk, Discrete Comput. Geom. 18, 305 (1997)):
//! no ray slips through between two of them, also where it goes through a corner. Near the point where
//! a ray starts rounding hides whether it has crossed a face already; there the next face further on
//! tells whether it is inside.

mod closed;
mod hull;
mod overlap;
#[cfg(test)]
mod tests;
mod tree;

pub use closed::MeshFault;
pub use hull::{PlanesFault, convex_hull, within_planes};

use super::{Outline, Plane, TOUCHING};
use glam::{DMat3, DVec2, DVec3};
use robust::{Coord, Coord3D, orient2d, orient3d};
use std::collections::HashMap;
use std::sync::LazyLock;
use tree::{Aabb, Tree};

/// A direction along no edge that anybody draws.
static SOMEWHERE: LazyLock<DVec3> =
    LazyLock::new(|| DVec3::new(0.518_273_645_1, 0.289_471_836_5, 0.804_718_236_4).normalize());

/// Triangles as a file lists them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// The corners, cm.
    pub corners: Vec<DVec3>,
    /// The numbers of the corners of each triangle, counterclockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A solid bounded by flat faces.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    corners: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The unit normal of each triangle, outwards.
    normals: Vec<DVec3>,
    /// Which face each triangle is of: a face is all that is joined and lies in one plane.
    faces: Vec<u32>,
    tree: Tree,
    volume: f64,
    is_convex: bool,
    /// How near the start of a ray rounding hides faces, cm.
    hidden: f64,
}

/// Where a ray meets the border of a polyhedron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceHit {
    /// How far along the ray, cm.
    pub distance: f64,
    /// Which face.
    pub face: u32,
    /// Its outward unit normal.
    pub outward: DVec3,
}

/// Which way a ray crosses the border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    In,
    Out,
}

impl PartialEq for Polyhedron {
    fn eq(&self, other: &Self) -> bool {
        self.corners == other.corners && self.triangles == other.triangles
    }
}

/// The exact sign of the volume between three points and a fourth: positive if that lies behind them
/// where they are seen counterclockwise.
fn behind([a, b, c]: [DVec3; 3], point: DVec3) -> f64 {
    let coord = |v: DVec3| Coord3D { x: v.x, y: v.y, z: v.z };
    orient3d(coord(a), coord(b), coord(c), coord(point))
}

impl Polyhedron {
    /// The solid within a closed surface.
    ///
    /// # Errors
    ///
    /// If the triangles are no such surface.
    pub fn new(mesh: &Triangles) -> Result<Self, MeshFault> {
        let Triangles { corners, triangles } = closed::surface(mesh)?;
        let at = |[a, b, c]: [u32; 3]| [a, b, c].map(|i| corners[i as usize]);
        let normal = |triangle: &[u32; 3]| {
            let [a, b, c] = at(*triangle);
            (b - a).cross(c - a).normalize_or_zero()
        };
        let normals: Vec<DVec3> = triangles.iter().map(normal).collect();
        let boxes: Vec<Aabb> =
            triangles.iter().map(|triangle| Aabb::around(at(*triangle))).collect();
        let tree = Tree::new(&boxes);
        let neighbours = closed::neighbours(&triangles);
        let opposite = |own: [u32; 3], other: u32| {
            let apex = triangles[other as usize].into_iter().find(|corner| !own.contains(corner));
            apex.map(|corner| corners[corner as usize])
        };
        let bulges = |(triangle, around): (&[u32; 3], &[u32; 3])| {
            let mut apexes = around.iter().filter_map(|other| opposite(*triangle, *other));
            apexes.all(|apex| behind(at(*triangle), apex) >= 0.0)
        };
        let shells = closed::shells(&neighbours);
        let is_convex =
            shells.iter().all(|shell| *shell == 0) && triangles.iter().zip(&neighbours).all(bulges);
        let faces = faces(&normals, &neighbours);
        let volume = triangles.iter().map(|triangle| closed::volume(at(*triangle))).sum();
        let Aabb { low, high } = tree.around();
        let hidden = TOUCHING.max(1e-14 * low.abs().max(high.abs()).max_element());
        let solid = Self { corners, triangles, normals, faces, tree, volume, is_convex, hidden };
        solid.check_crossings()?;
        solid.check_shells(&shells)?;
        Ok(solid)
    }

    /// Its corners, cm.
    #[must_use]
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// The numbers of the corners of its triangles.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of each triangle.
    pub fn pieces(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        (0..self.triangles.len() as u32).map(|triangle| self.piece(triangle))
    }

    #[inline]
    fn piece(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|corner| self.corners[corner as usize])
    }

    /// Whether it is convex.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.is_convex
    }

    /// Its volume, cm³.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// How many flat faces it has.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.faces.iter().max().map_or(0, |most| *most as usize + 1)
    }

    /// Where a ray that is outside enters: from zero on.
    #[must_use]
    #[inline]
    pub fn entry(&self, origin: DVec3, direction: DVec3) -> Option<FaceHit> {
        self.crossing(origin, direction, Way::In)
    }

    /// Where a ray that is inside or on the border leaves: from zero on.
    #[must_use]
    #[inline]
    pub fn exit(&self, origin: DVec3, direction: DVec3) -> Option<FaceHit> {
        self.crossing(origin, direction, Way::Out)
    }

    fn crossing(&self, origin: DVec3, direction: DVec3, way: Way) -> Option<FaceHit> {
        let [found, else_found] = self.found(origin, direction, way);
        let grazed = || match way {
            Way::In => None,
            Way::Out => self.grazed(origin, direction),
        };
        let (distance, triangle) = found.or_else(grazed).or(else_found)?;
        let (face, outward) = (self.faces[triangle as usize], self.normals[triangle as usize]);
        Some(FaceHit { distance: distance.max(0.0), face, outward })
    }

    /// How far along a ray which triangle is crossed that way, and which one is if none is where the
    /// faces further on say that one must be.
    #[inline]
    fn found(&self, origin: DVec3, direction: DVec3, way: Way) -> [Option<(f64, u32)>; 2] {
        let ray = ShearedRay::new(origin, direction);
        let hidden = self.hidden;
        // The nearest face that is crossed the right way, the nearest that is crossed the wrong way,
        // and the last of those that rounding hides.
        let mut nearest: Option<(f64, u32)> = None;
        let mut wrong = f64::INFINITY;
        let mut passed: Option<(f64, u32)> = None;
        self.tree.along(&self.tree.ray(origin, direction, -hidden), |triangle, to| {
            let Some((distance, crossed)) = ray.crosses(self.piece(triangle)) else { return };
            if distance > hidden {
                if crossed != way {
                    wrong = wrong.min(distance);
                } else if distance < *to {
                    *to = distance;
                    nearest = Some((distance, triangle));
                }
            } else if crossed == way
                && distance >= -hidden
                && passed.is_none_or(|(last, _)| distance > last)
            {
                passed = Some((distance, triangle));
            }
        });
        let inside_out = match nearest {
            Some((distance, _)) => wrong < distance - hidden,
            None => way == Way::Out || wrong.is_finite(),
        };
        if inside_out { [passed, nearest] } else { [nearest, None] }
    }

    /// The face by which a ray leaves that rounding has put outside, at an edge, so that it crosses
    /// none: at once, or if it runs along the border where it would from a little further in.
    #[cold]
    fn grazed(&self, origin: DVec3, direction: DVec3) -> Option<(f64, u32)> {
        /// What leaves a face less steeply runs along it.
        const ALONG: f64 = 1e-9;
        let mut steepest: Option<(f64, u32)> = None;
        let mut outwards = DVec3::ZERO;
        let here = Aabb { low: origin, high: origin };
        self.tree.near(&here, self.hidden, |triangle| {
            let normal = self.normals[triangle as usize];
            let out = normal.dot(direction);
            let [a, b, c] = self.piece(triangle);
            let beside = |from: DVec3, to: DVec3| {
                (to - from).cross(normal).normalize_or_zero().dot(origin - from)
            };
            let off = [normal.dot(origin - a).abs(), beside(a, b), beside(b, c), beside(c, a)];
            if off.iter().all(|off| *off <= self.hidden) {
                outwards += normal;
                if out > steepest.map_or(ALONG, |(most, _)| most) {
                    steepest = Some((out, triangle));
                }
            }
        });
        match steepest {
            Some((_, triangle)) => Some((0.0, triangle)),
            None => {
                let further_in = origin - outwards * (2.0 * self.hidden);
                let [found, else_found] = self.found(further_in, direction, Way::Out);
                found.or(else_found)
            }
        }
    }

    /// Whether a point lies inside; on the border either may be said.
    #[must_use]
    pub fn holds(&self, point: DVec3) -> bool {
        let Aabb { low, high } = self.tree.around();
        if point.cmplt(low).any() || point.cmpgt(high).any() {
            return false;
        }
        let ray = ShearedRay::new(point, *SOMEWHERE);
        let mut nearest = None;
        self.tree.along(&self.tree.ray(point, *SOMEWHERE, 0.0), |triangle, to| {
            if let Some((distance, crossed)) = ray.crosses(self.piece(triangle))
                && (0.0..*to).contains(&distance)
            {
                *to = distance;
                nearest = Some(crossed);
            }
        });
        nearest == Some(Way::Out)
    }

    /// How often one crosses those triangles that are asked for on the way from a point out of all.
    fn crossings(&self, point: DVec3, asked: impl Fn(u32) -> bool) -> usize {
        let ray = ShearedRay::new(point, *SOMEWHERE);
        let mut count = 0;
        self.tree.along(&self.tree.ray(point, *SOMEWHERE, 0.0), |triangle, _| {
            let crossed = asked(triangle).then(|| ray.crosses(self.piece(triangle))).flatten();
            count += usize::from(crossed.is_some_and(|(distance, _)| distance >= 0.0));
        });
        count
    }

    /// The least and the greatest coordinates.
    #[must_use]
    pub fn bounds(&self) -> [DVec3; 2] {
        let Aabb { low, high } = self.tree.around();
        [low, high]
    }

    /// How far it reaches along a direction from the origin.
    #[must_use]
    pub fn support(&self, direction: DVec3) -> f64 {
        self.greatest(|at| direction.dot(at))
    }

    /// The greatest value of a convex function over it.
    pub fn greatest(&self, value: impl Fn(DVec3) -> f64) -> f64 {
        self.corners.iter().map(|at| value(*at)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The least distance between two parallel planes, one of them along a face, that it fits between,
    /// cm; of one that has many faces, along some of them.
    #[must_use]
    pub fn thickness(&self) -> f64 {
        const MOST: usize = 400;
        let step = self.normals.len().div_ceil(MOST);
        let normals = self.normals.iter().step_by(step).filter(|normal| **normal != DVec3::ZERO);
        normals.map(|n| self.support(*n) + self.support(-*n)).fold(f64::INFINITY, f64::min)
    }

    /// The least width of its triangles, cm: what stands out of one that is not convex is no narrower.
    #[must_use]
    pub fn least_width(&self) -> f64 {
        let width = |[a, b, c]: [DVec3; 3]| {
            let longest = (b - a).length().max((c - b).length()).max((a - c).length());
            (b - a).cross(c - a).length() / longest
        };
        self.pieces().map(width).fold(f64::INFINITY, f64::min)
    }

    /// What it is cut along the plane z = 0: lines, joined nowhere.
    pub fn section(&self) -> Vec<[DVec2; 2]> {
        // Corners in the plane count as above it, unless all are.
        let standing = self.bounds()[0].z >= 0.0;
        let is_above = |at: DVec3| at.z > 0.0 || (at.z == 0.0 && !standing);
        let mut lines = Vec::new();
        for corners in self.pieces() {
            let above = corners.map(is_above);
            let crossing = |i: usize| {
                let (a, b) = (corners[i], corners[(i + 1) % 3]);
                // The same point whichever way the edge runs.
                let (a, b) = if a.z <= b.z { (a, b) } else { (b, a) };
                (is_above(a) != is_above(b)).then(|| a.lerp(b, a.z / (a.z - b.z)).truncate())
            };
            if above.contains(&true) && above.contains(&false) {
                let mut ends = (0..3).filter_map(crossing);
                if let (Some(a), Some(b)) = (ends.next(), ends.next()) {
                    lines.push([a, b]);
                }
            }
        }
        lines
    }

    /// Its edges: those at which two faces meet.
    pub fn edges(&self) -> Vec<[DVec3; 2]> {
        let mut owners: HashMap<[u32; 2], u32> = HashMap::new();
        let mut edges = Vec::new();
        for (triangle, face) in self.triangles.iter().zip(&self.faces) {
            for i in 0..3 {
                let [a, b] = [triangle[i], triangle[(i + 1) % 3]];
                match owners.remove(&[b, a]) {
                    Some(other) if other != *face => {
                        edges.push([a, b].map(|corner| self.corners[corner as usize]));
                    }
                    Some(_) => {}
                    None => {
                        owners.insert([a, b], *face);
                    }
                }
            }
        }
        edges
    }

    /// The outline of what it hides of the xy-plane, seen along z and placed by `place`.
    pub fn shadow(&self, place: impl Fn(DVec3) -> DVec3) -> Outline {
        Outline::hull(self.corners.iter().map(|at| place(*at).truncate()).collect())
    }

    /// The planes of its faces, each once.
    pub(super) fn planes(&self) -> Vec<Plane> {
        let mut known = vec![false; self.face_count()];
        let mut planes = Vec::new();
        for (triangle, face) in (0u32..).zip(&self.faces) {
            let normal = self.normals[triangle as usize];
            if normal != DVec3::ZERO && !std::mem::replace(&mut known[*face as usize], true) {
                let offset = self.piece(triangle).map(|at| normal.dot(at));
                planes.push(Plane { normal, offset: offset.into_iter().fold(offset[0], f64::max) });
            }
        }
        planes
    }

    /// An ellipsoid around it: its middle, and a matrix that makes it of the unit ball.
    pub(super) fn ellipsoid(&self) -> (DVec3, DMat3) {
        let Aabb { low, high } = self.tree.around();
        // Around a box.
        let half = 0.5 * 3f64.sqrt() * (high - low) * (1.0 + 1e-12);
        (0.5 * (low + high), DMat3::from_diagonal(half.max(DVec3::splat(TOUCHING))))
    }
}

/// Numbers the faces: triangles that are joined, and whose normals differ by no more than rounding.
fn faces(normals: &[DVec3], neighbours: &[[u32; 3]]) -> Vec<u32> {
    /// Of unit vectors, and their squares; a few times what rounding makes.
    const SAME: f64 = 1e-12;
    let mut faces = vec![u32::MAX; normals.len()];
    let mut count = 0;
    for start in 0..normals.len() {
        if faces[start] != u32::MAX {
            continue;
        }
        faces[start] = count;
        let mut waiting = vec![start];
        while let Some(triangle) = waiting.pop() {
            for other in neighbours[triangle].map(|other| other as usize) {
                // All of a face are like its first.
                let same = normals[other].distance_squared(normals[start]) <= SAME * SAME;
                if faces[other] == u32::MAX && same {
                    faces[other] = count;
                    waiting.push(other);
                }
            }
        }
        count += 1;
    }
    faces
}

/// A ray, and how points look along it: sheared so that it is an axis.
struct ShearedRay {
    origin: DVec3,
    /// Two axes across it and the one along which it goes most, right-handed with that turned to go
    /// with the ray.
    axes: [usize; 3],
    shear: DVec3,
}

impl ShearedRay {
    fn new(origin: DVec3, direction: DVec3) -> Self {
        let size = direction.abs();
        let z = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(2);
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let (x, y) = if direction[z] < 0.0 { (y, x) } else { (x, y) };
        let shear = DVec3::new(direction[x], direction[y], 1.0) / direction[z];
        Self { origin, axes: [x, y, z], shear }
    }

    /// Where the ray is ahead of or behind its origin when it crosses a triangle, edges included, and
    /// which way.
    #[inline]
    fn crosses(&self, corners: [DVec3; 3]) -> Option<(f64, Way)> {
        let [x, y, z] = self.axes;
        let [a, b, c] = corners.map(|corner| corner - self.origin);
        let seen =
            |v: DVec3| Coord { x: v[x] - self.shear.x * v[z], y: v[y] - self.shear.y * v[z] };
        let (at_a, at_b, at_c) = (seen(a), seen(b), seen(c));
        let side = |one: Coord<f64>, other: Coord<f64>| {
            // The sign of one × other, exactly.
            orient2d(one, other, Coord { x: 0.0, y: 0.0 })
        };
        let (u, v, w) = (side(at_b, at_c), side(at_c, at_a), side(at_a, at_b));
        let way = if u >= 0.0 && v >= 0.0 && w >= 0.0 {
            Way::Out
        } else if u <= 0.0 && v <= 0.0 && w <= 0.0 {
            Way::In
        } else {
            return None;
        };
        let sum = u + v + w;
        // Edge on.
        if sum == 0.0 {
            return None;
        }
        let along = (u * a[z] + v * b[z] + w * c[z]) / sum;
        Some((self.shear.z * along, way))
    }
}
