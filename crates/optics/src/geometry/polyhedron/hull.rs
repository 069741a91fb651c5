//! The convex solid around points, and the one behind planes.

use super::{Triangles, behind};
use crate::geometry::Plane;
use glam::{DMat3, DVec3};
use std::collections::HashSet;

/// The surface of the convex hull of points; `None` if they lie in a plane, to the last digit.
#[must_use]
pub fn convex_hull(points: &[DVec3]) -> Option<Triangles> {
    let first = *points.first()?;
    let far = |value: &dyn Fn(DVec3) -> f64| {
        points.iter().copied().max_by(|a, b| value(*a).total_cmp(&value(*b)))
    };
    let second = far(&|at| at.distance_squared(first))?;
    let third = far(&|at| (at - first).cross(second - first).length_squared())?;
    let fourth = far(&|at| behind([first, second, third], at).abs())?;
    let volume = behind([first, second, third], fourth);
    if volume == 0.0 {
        return None;
    }
    let [second, third] = if volume > 0.0 { [second, third] } else { [third, second] };
    let mut corners = vec![first, second, third, fourth];
    let mut triangles: Vec<[u32; 3]> = vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
    for point in points {
        let seen = |triangle: &[u32; 3]| {
            behind(triangle.map(|corner| corners[corner as usize]), *point) < 0.0
        };
        let (before, kept): (Vec<_>, Vec<_>) = triangles.iter().copied().partition(|t| seen(t));
        if before.is_empty() {
            continue;
        }
        let edges = |[a, b, c]: &[u32; 3]| [[*a, *b], [*b, *c], [*c, *a]];
        let own: HashSet<[u32; 2]> = before.iter().flat_map(edges).collect();
        let rim = before.iter().flat_map(edges).filter(|[a, b]| !own.contains(&[*b, *a]));
        let apex = corners.len() as u32;
        corners.push(*point);
        triangles = kept.into_iter().chain(rim.map(|[a, b]| [a, b, apex])).collect();
    }
    // Points that others have come before are no corners.
    let used: HashSet<u32> = triangles.iter().flatten().copied().collect();
    let mut numbers = vec![0; corners.len()];
    let mut left = Vec::new();
    for (number, corner) in (0u32..).zip(&corners) {
        if used.contains(&number) {
            numbers[number as usize] = left.len() as u32;
            left.push(*corner);
        }
    }
    let triangles =
        triangles.into_iter().map(|triangle| triangle.map(|corner| numbers[corner as usize]));
    Some(Triangles { triangles: triangles.collect(), corners: left })
}

/// Why there is no solid behind planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlanesFault {
    /// It has no end.
    #[error("the space behind the planes has no end; add planes that close it")]
    Endless,
    /// There is no such space.
    #[error(
        "there is no space behind all of the planes; their distances go the way of their normals"
    )]
    Empty,
}

/// The surface of the convex solid behind all of some planes, whose normals are unit vectors.
///
/// # Errors
///
/// If there is none.
pub fn within_planes(planes: &[Plane]) -> Result<Triangles, PlanesFault> {
    /// Three planes whose normals span less meet nowhere in particular.
    const PARALLEL: f64 = 1e-12;
    // It ends where the normals are all around.
    let normals: Vec<DVec3> = planes.iter().map(|plane| plane.normal).collect();
    let around = convex_hull(&normals).ok_or(PlanesFault::Endless)?;
    let at = |corner: u32| around.corners[corner as usize];
    if around.triangles.iter().any(|t| behind(t.map(at), DVec3::ZERO) <= 0.0) {
        return Err(PlanesFault::Endless);
    }
    let size = planes.iter().map(|plane| plane.offset.abs()).fold(0.0, f64::max);
    let slack = 1e-11 * size;
    let mut points: Vec<DVec3> = Vec::new();
    for i in 0..planes.len() {
        for j in 0..i {
            for k in 0..j {
                let three = [planes[i], planes[j], planes[k]];
                let [a, b, c] = three.map(|plane| plane.normal);
                let matrix = DMat3::from_cols(a, b, c).transpose();
                if matrix.determinant().abs() < PARALLEL {
                    continue;
                }
                let point = matrix.inverse() * DVec3::from_array(three.map(|plane| plane.offset));
                let outside = |plane: &Plane| plane.normal.dot(point) - plane.offset > slack;
                if !planes.iter().any(outside)
                    && !points.iter().any(|known| known.distance(point) <= 10.0 * slack)
                {
                    points.push(point);
                }
            }
        }
    }
    convex_hull(&points).ok_or(PlanesFault::Empty)
}
