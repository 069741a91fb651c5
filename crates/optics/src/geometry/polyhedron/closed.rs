//! Whether triangles are a closed surface around a solid.

use super::tree::Aabb;
use super::{Polyhedron, Triangles, behind};
use glam::DVec3;
use robust::{Coord, orient2d};
use std::collections::HashMap;

/// A surface of more triangles is taken for a mistake.
const MOST_TRIANGLES: usize = 1 << 22;

/// Why triangles bound no solid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshFault {
    /// There are fewer than four.
    #[error("it has {} triangles; a solid has four at least", if *.0 == 0 { "no".to_owned() } else { .0.to_string() })]
    TooFew(usize),
    /// There are too many.
    #[error("it has {0} triangles; at most {MOST_TRIANGLES} are taken")]
    TooMany(usize),
    /// A triangle names a corner that is not there, or one that is no point.
    #[error("triangle {0} (counted from 0) has a corner that is no point")]
    NoPoint(usize),
    /// Something is open.
    #[error(
        "it is not closed: {count} edges are of one triangle only, as the one from {} to {}; fill its \
         holes", text(edge[0]), text(edge[1])
    )]
    Open {
        /// How many edges are open.
        count: usize,
        /// One of them.
        edge: [DVec3; 2],
    },
    /// More than two triangles meet at an edge.
    #[error(
        "{count} triangles meet at the edge from {} to {}; a surface has two there", text(edge[0]),
        text(edge[1])
    )]
    Branching {
        /// How many.
        count: usize,
        /// The edge.
        edge: [DVec3; 2],
    },
    /// Two neighbours have their corners in opposite order.
    #[error(
        "the triangles at the edge from {} to {} have their corners in opposite order: one shows its inside; \
         turn it round", text(edge[0]), text(edge[1])
    )]
    Turned {
        /// The edge.
        edge: [DVec3; 2],
    },
    /// It bounds no volume.
    #[error("it is flat: it bounds no volume")]
    Flat,
    /// Two triangles cross.
    #[error("it crosses itself near {}; make one surface of what overlaps there", text(*.0))]
    Crossing(DVec3),
    /// One part of it lies in another, and shows the wrong side.
    #[error(
        "the part of it around {} {}; turn its triangles round, or leave it out", text(*at),
        if *inside { "lies within another part, and both show their outsides" }
        else { "shows its inside, and lies within no other part" }
    )]
    Shell {
        /// A corner of it.
        at: DVec3,
        /// Whether it lies within another.
        inside: bool,
    },
}

/// A point for people.
fn text(point: DVec3) -> String {
    let short = |x: f64| format!("{}", (x * 1e6).round() / 1e6 + 0.0);
    format!("({})", point.to_array().map(short).join(", "))
}

/// Six times the volume between a triangle and the origin, over six.
pub(super) fn volume([a, b, c]: [DVec3; 3]) -> f64 {
    a.dot(b.cross(c)) / 6.0
}

/// The closed surface that triangles are: each point once, outsides shown.
pub(super) fn surface(mesh: &Triangles) -> Result<Triangles, MeshFault> {
    let count = mesh.triangles.len();
    if count > MOST_TRIANGLES {
        return Err(MeshFault::TooMany(count));
    }
    let mut known: HashMap<[u64; 3], u32> = HashMap::new();
    let mut corners: Vec<DVec3> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for (number, triangle) in mesh.triangles.iter().enumerate() {
        let mut own = [0; 3];
        for (own, corner) in own.iter_mut().zip(triangle) {
            let found = mesh.corners.get(*corner as usize).filter(|at| at.is_finite());
            // Two zeros are one.
            let at = *found.ok_or(MeshFault::NoPoint(number))? + 0.0;
            *own = *known.entry(at.to_array().map(f64::to_bits)).or_insert_with(|| {
                corners.push(at);
                corners.len() as u32 - 1
            });
        }
        // What has two corners in one point is an edge, and no surface.
        let [a, b, c] = own;
        if a != b && b != c && c != a {
            triangles.push(own);
        }
    }
    if triangles.len() < 4 {
        return Err(MeshFault::TooFew(triangles.len()));
    }
    check_edges(&corners, &triangles)?;
    // About the first corner, where numbers are small.
    let at = |corner: u32| corners[corner as usize] - corners[0];
    let volume: f64 = triangles.iter().map(|triangle| volume(triangle.map(at))).sum();
    if volume < 0.0 {
        // All are the other way round.
        triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    let size = Aabb::around(corners.iter().copied());
    let around: f64 = (size.high - size.low).to_array().into_iter().product();
    if volume.abs() <= 1e-12 * around || around == 0.0 {
        return Err(MeshFault::Flat);
    }
    Ok(Triangles { corners, triangles })
}

/// Refuses surfaces on which edges are not each of two triangles, once each way.
fn check_edges(corners: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), MeshFault> {
    // How often each edge runs from its lower to its higher corner, and back.
    let mut edges: HashMap<[u32; 2], [usize; 2]> = HashMap::new();
    for triangle in triangles {
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            edges.entry([a.min(b), a.max(b)]).or_default()[usize::from(a > b)] += 1;
        }
    }
    let wrong = |test: &dyn Fn([usize; 2]) -> bool| {
        let found = edges.iter().filter(|(_, counts)| test(**counts));
        let first = found.clone().min_by_key(|(edge, _)| **edge)?;
        let ends = first.0.map(|corner| corners[corner as usize]);
        Some((found.count(), ends, first.1.iter().sum::<usize>()))
    };
    if let Some((count, edge, _)) = wrong(&|[one, other]| one + other == 1) {
        return Err(MeshFault::Open { count, edge });
    }
    if let Some((_, edge, count)) = wrong(&|[one, other]| one + other > 2) {
        return Err(MeshFault::Branching { count, edge });
    }
    match wrong(&|[one, other]| one != other) {
        Some((_, edge, _)) => Err(MeshFault::Turned { edge }),
        None => Ok(()),
    }
}

/// The neighbours of each triangle, across its edges.
pub(super) fn neighbours(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let ends = |triangle: &[u32; 3], i: usize| [triangle[i], triangle[(i + 1) % 3]];
    let mut owners: HashMap<[u32; 2], u32> = HashMap::new();
    for (number, triangle) in (0u32..).zip(triangles) {
        owners.extend((0..3).map(|i| (ends(triangle, i), number)));
    }
    let across = |[a, b]: [u32; 2]| owners.get(&[b, a]).copied().unwrap_or(0);
    triangles.iter().map(|triangle| [0, 1, 2].map(|i| across(ends(triangle, i)))).collect()
}

/// The number of the shell, of triangles that are joined, that each triangle is of.
pub(super) fn shells(neighbours: &[[u32; 3]]) -> Vec<u32> {
    let mut shells = vec![u32::MAX; neighbours.len()];
    let mut count = 0;
    for start in 0..neighbours.len() {
        if shells[start] != u32::MAX {
            continue;
        }
        let mut waiting = vec![start];
        while let Some(triangle) = waiting.pop() {
            if std::mem::replace(&mut shells[triangle], count) == u32::MAX {
                waiting.extend(neighbours[triangle].map(|other| other as usize));
            }
        }
        count += 1;
    }
    shells
}

impl Polyhedron {
    /// Refuses parts that cross, and those that show the wrong side: an outer one stands in no other, and a hollow is
    /// in one.
    pub(super) fn check_shells(&self, shells: &[u32]) -> Result<(), MeshFault> {
        let count = shells.iter().max().map_or(0, |most| most + 1);
        if count == 1 {
            return Ok(());
        }
        let mut volumes = vec![0.0; count as usize];
        // A point of each, and whether it lies within others.
        let mut sides: Vec<Option<(DVec3, bool)>> = vec![None; count as usize];
        let mut looked_at = vec![false; self.corners.len()];
        for (triangle, &shell) in (0u32..).zip(shells) {
            let piece = self.piece(triangle);
            volumes[shell as usize] += volume(piece);
            let corners = self.triangles[triangle as usize].into_iter().zip(piece);
            let corners = corners
                .filter(|(corner, _)| !std::mem::replace(&mut looked_at[*corner as usize], true));
            let middle = (piece[0] + piece[1] + piece[2]) / 3.0;
            let points: Vec<DVec3> = corners.map(|(_, at)| at).chain([middle]).collect();
            for at in points.into_iter().filter(|at| !self.touches_other(*at, shell, shells)) {
                // Hollows show their insides: only how often they are crossed tells on which side one is.
                let other = |triangle: u32| shells[triangle as usize] != shell;
                let inside = self.crossings(at, other) % 2 == 1;
                // Where edges meet edges, parts cross and no edge goes through a triangle.
                match sides[shell as usize] {
                    None => sides[shell as usize] = Some((at, inside)),
                    Some((_, known)) if known != inside => return Err(MeshFault::Crossing(at)),
                    Some(_) => {}
                }
            }
        }
        for (side, volume) in sides.into_iter().zip(volumes) {
            if let Some((at, inside)) = side.filter(|(_, inside)| *inside != (volume < 0.0)) {
                return Err(MeshFault::Shell { at, inside });
            }
        }
        Ok(())
    }

    /// Whether a point of a shell lies on another one.
    fn touches_other(&self, at: DVec3, shell: u32, shells: &[u32]) -> bool {
        let mut touches = false;
        self.tree.near(&Aabb::around([at]), 0.0, |triangle| {
            touches |= shells[triangle as usize] != shell && {
                let [a, b, c] = self.piece(triangle);
                let normal = self.normals[triangle as usize];
                let is_left =
                    |(from, to): (DVec3, DVec3)| (to - from).cross(at - from).dot(normal) >= 0.0;
                behind([a, b, c], at) == 0.0 && [(a, b), (b, c), (c, a)].into_iter().all(is_left)
            };
        });
        touches
    }

    /// Refuses surfaces that cross themselves: an edge of one triangle goes through another, two
    /// neighbours lie on each other, or two in one plane do that have the solid on the same side. What only touches
    /// passes.
    pub(super) fn check_crossings(&self) -> Result<(), MeshFault> {
        for (number, triangle) in (0u32..).zip(&self.triangles) {
            let piece = self.piece(number);
            let mut crossing = None;
            self.tree.near(&Aabb::around(piece), 0.0, |other| {
                // An edge through the other one is found from either.
                if other == number || crossing.is_some() {
                    return;
                }
                let third = self.triangles[other as usize];
                for i in 0..3 {
                    let ends = [third[i], third[(i + 1) % 3]];
                    let [a, b] = ends.map(|corner| self.corners[corner as usize]);
                    if ends.iter().all(|end| !triangle.contains(end)) && pierces(a, b, piece) {
                        crossing = Some(0.5 * (a + b));
                    }
                }
                let other_piece = third.map(|corner| self.corners[corner as usize]);
                let alike = self.normals[number as usize].dot(self.normals[other as usize]) > 0.0;
                if alike && other_piece.iter().all(|at| behind(piece, *at) == 0.0) {
                    let normal = self.normals[number as usize];
                    if overlap_in_plane(piece, other_piece, normal) {
                        crossing = Some(other_piece[0]);
                    }
                }
                let shared = third.iter().filter(|corner| triangle.contains(corner)).count();
                let apex = third.iter().find(|corner| !triangle.contains(corner));
                if shared == 2
                    && let Some(apex) = apex.map(|corner| self.corners[*corner as usize])
                    && self.normals[number as usize].dot(self.normals[other as usize]) < 0.0
                    && behind(piece, apex) == 0.0
                {
                    crossing = Some(apex);
                }
            });
            if let Some(at) = crossing {
                return Err(MeshFault::Crossing(at));
            }
        }
        Ok(())
    }
}

/// Whether a line from point to point goes through the inside of a triangle.
pub(super) fn pierces(from: DVec3, to: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let sides = [from, to].map(|end| behind([a, b, c], end));
    let opposite = sides[0] > 0.0 && sides[1] < 0.0 || sides[0] < 0.0 && sides[1] > 0.0;
    opposite && {
        let turns = [(a, b), (b, c), (c, a)].map(|(a, b)| behind([from, to, a], b));
        turns.iter().all(|turn| *turn > 0.0) || turns.iter().all(|turn| *turn < 0.0)
    }
}

/// Whether the insides of two triangles in one plane meet; `normal` is that of both, exactly by the signs.
fn overlap_in_plane(one: [DVec3; 3], other: [DVec3; 3], normal: DVec3) -> bool {
    // Seen along the axis nearest to the normal, which loses no digits.
    let axis = normal.abs().max_position();
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    let flat = |triangle: [DVec3; 3]| triangle.map(|at| Coord { x: at[u], y: at[v] });
    let (one, other) = (flat(one), flat(other));
    // An edge with all of the other one behind it.
    let separates = |a: [Coord<f64>; 3], b: [Coord<f64>; 3]| {
        let turn = orient2d(a[0], a[1], a[2]);
        (0..3).any(|i| b.iter().all(|at| orient2d(a[i], a[(i + 1) % 3], *at) * turn <= 0.0))
    };
    !separates(one, other) && !separates(other, one)
}
