//! Whether a polyhedron and something else are in each other's way.

use super::Polyhedron;
use super::closed::pierces;
use super::tree::Aabb;
use crate::geometry::convex::{Bound, Bounded, bounded};
use crate::geometry::{Plane, Pose, Solid};
use glam::{DMat3, DVec3};

impl Polyhedron {
    /// Bounds of a convex one at a place, and an ellipsoid around it.
    pub(in crate::geometry) fn bounded(&self, pose: &Pose) -> Option<Bounded> {
        let plane = |Plane { normal, offset }: Plane| {
            let normal = pose.vector_to_world(normal);
            Bound::Plane { normal, offset: offset + normal.dot(pose.origin) }
        };
        let (middle, matrix) = self.ellipsoid();
        let ellipsoid = (pose.to_world(middle), pose.rotation() * matrix);
        let bounds = || self.planes().into_iter().map(plane).collect();
        self.is_convex.then(|| Bounded { bounds: bounds(), ellipsoid })
    }

    /// Whether it and another solid, no hollow one, given in its frame, press into each other by more
    /// than `slack` (cm).
    ///
    /// Of convex ones that is known exactly, but for slack. Elsewhere triangles are asked one by
    /// one, and with sheets and other polyhedra their edges: there, what only presses into a corner by
    /// less than slack may pass. A lens with hollow faces is its convex hull to a polyhedron that is not
    /// convex.
    pub(in crate::geometry) fn overlaps(&self, other: &Solid, slack: f64) -> bool {
        let own = self.bounded(&Pose::IDENTITY);
        let near = other
            .bounds()
            .is_some_and(|[low, high]| self.tree.around().meets(&Aabb { low, high }, -slack));
        if !near {
            return false;
        }
        if let Some(corners) = other.sheet().filter(|_| !self.is_convex) {
            let [a, b, c, d] = corners;
            let pieces = [[a, b, c], [a, c, d]];
            return self.holds(0.25 * (a + b + c + d)) || self.crosses(&pieces, slack);
        }
        if let Solid::Polyhedron { solid, pose } = other
            && !(self.is_convex && solid.is_convex)
        {
            let pieces: Vec<[DVec3; 3]> =
                solid.pieces().map(|piece| piece.map(|at| pose.to_world(at))).collect();
            let deep = |one: &Self, other: &Self, place: &dyn Fn(DVec3) -> DVec3| {
                one.inner_point(slack).is_some_and(|point| other.holds(place(point)))
            };
            return self.crosses(&pieces, slack)
                || deep(self, solid, &|at| pose.to_local(at))
                || deep(solid, self, &|at| pose.to_world(at));
        }
        let Some(second) = bounded(other, slack) else { return false };
        match own {
            Some(own) => own.presses(&second, &[], slack),
            None => {
                let around = other.bounds().map(|[low, high]| Aabb { low, high });
                let presses = |piece: [DVec3; 3]| {
                    let near =
                        around.is_none_or(|around| around.meets(&Aabb::around(piece), slack));
                    near && thin(piece, slack).is_some_and(|it| it.presses(&second, &[], slack))
                };
                self.pieces().any(presses) || self.holds(second.ellipsoid.0)
            }
        }
    }

    /// Whether an edge of it goes through one of some triangles, or one of theirs through it, both ends
    /// being more than `slack` away.
    fn crosses(&self, others: &[[DVec3; 3]], slack: f64) -> bool {
        let through = |edges: [DVec3; 3], piece: [DVec3; 3]| {
            let [a, b, c] = piece;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            (0..3).any(|i| {
                let ends = [edges[i], edges[(i + 1) % 3]];
                ends.iter().all(|end| normal.dot(*end - a).abs() > slack)
                    && pierces(ends[0], ends[1], piece)
            })
        };
        others.iter().any(|other| {
            let mut found = false;
            self.tree.near(&Aabb::around(*other), 0.0, |triangle| {
                let own = self.piece(triangle);
                found = found || through(own, *other) || through(*other, own);
            });
            found
        })
    }

    /// A point inside, more than `slack` from the face behind it.
    fn inner_point(&self, slack: f64) -> Option<DVec3> {
        let mut triangles = 0..self.triangles.len() as u32;
        triangles.find_map(|triangle| {
            let [a, b, c] = self.piece(triangle);
            let (middle, inward) = ((a + b + c) / 3.0, -self.normals[triangle as usize]);
            let across = self.exit(middle, inward)?.distance;
            (across > 4.0 * slack).then(|| middle + inward * (0.5 * across))
        })
    }
}

/// Bounds of a triangle as thick as `thickness`, and steep, and an ellipsoid around it; `None` of one
/// without an area.
fn thin([a, b, c]: [DVec3; 3], thickness: f64) -> Option<Bounded> {
    let normal = (b - a).cross(c - a).try_normalize()?;
    let plane = |normal: DVec3, offset: f64| Bound::Plane { normal, offset };
    let edge = |from: DVec3, to: DVec3| {
        let outward = (to - from).cross(normal).normalize_or_zero();
        plane(outward, outward.dot(from))
    };
    let steep = 4.0 * normal;
    let mut bounds = vec![edge(a, b), edge(b, c), edge(c, a)];
    bounds.push(plane(steep, steep.dot(a) + thickness));
    bounds.push(plane(-steep, -steep.dot(a) + thickness));
    let middle = (a + b + c) / 3.0;
    let radius = [a, b, c].map(|at| at.distance(middle)).into_iter().fold(0.0, f64::max);
    let (x, y) = normal.any_orthonormal_pair();
    let half = (radius * 1.5).max(thickness);
    let matrix = DMat3::from_cols(x * half, y * half, normal * (4.0 * thickness));
    Some(Bounded { bounds, ellipsoid: (middle, matrix) })
}
