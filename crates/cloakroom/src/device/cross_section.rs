//! What a device looks like cut in the plane z = 0 of its own frame.
//!
//! A new kind of [`Cell`], [`Skin`] or [`BodyShape`] says here, and nowhere else, what it looks like: its sides
//! as lines, and for a cell whether its medium is graded. The rest follows.

use super::{Beyond, Body, BodyShape, Cell, ConformalCell, Face, Prism, Skin, Structure};
use glam::DVec2;
use optics::geometry::{Cylinder, Sphere};
use optics::medium::Medium;
use optics::propagation::Half;

/// How far what has no end is drawn, and is in the way of other devices, cm from the device's origin.
pub const REACH: f64 = 1e5;

/// Straight pieces that a curve is drawn with.
const PIECES: u32 = 256;

/// A piece of the border of a cell, or of the skin.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// A line from point to point, cm.
    pub line: Vec<DVec2>,
    /// What lies on its other side.
    pub beyond: Beyond,
}

/// A line from point to point, cm.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// The points; the first is not repeated at the end.
    pub points: Vec<DVec2>,
    /// Whether the last is joined to the first.
    pub closed: bool,
}

/// The cross-section of one cell.
#[derive(Clone, Debug)]
pub struct Region<'s> {
    /// Its border; what is inside an odd number of contours is inside.
    pub border: Vec<Contour>,
    /// The cell.
    pub cell: &'s Cell,
}

/// The cross-section of a device, in its own frame.
#[derive(Clone, Debug)]
pub struct CrossSection<'s> {
    /// What light in air meets.
    pub outlines: Vec<Contour>,
    /// The cells.
    pub regions: Vec<Region<'s>>,
    /// The surfaces of metal: closed contours are full of it, open ones are thin mirrors.
    pub metal: Vec<Contour>,
    /// The body that fills the outlines, if the device is one.
    pub body: Option<&'s Body>,
}

impl Structure {
    /// The cross-section in the plane z = 0.
    #[must_use]
    pub fn cross_section(&self) -> CrossSection<'_> {
        let skin: Vec<Side> = self.skin.iter().flat_map(Skin::sides).collect();
        let cells: Vec<Vec<Side>> = self.cells.iter().map(Cell::sides).collect();
        let metal = cells.iter().flatten().chain(&skin);
        let metal = metal.filter(|side| side.beyond == Beyond::Conductor);
        let body = self.hull.body();
        let around = body.map(|body| body.shape.around());
        CrossSection {
            body,
            outlines: joined(skin.iter().map(|side| side.line.clone()).chain(around)),
            metal: joined(metal.map(|side| side.line.clone())),
            regions: (self.cells.iter().zip(cells))
                .map(|(cell, sides)| Region {
                    border: joined(sides.into_iter().map(|side| side.line)),
                    cell,
                })
                .collect(),
        }
    }
}

impl Cell {
    /// The border of the cell in the plane z = 0.
    #[must_use]
    pub fn sides(&self) -> Vec<Side> {
        match self {
            Self::Prism(prism) => prism.sides(),
            Self::Conformal(cell) => cell.sides(),
            Self::Radial(cell) => {
                let [inner, outer] = cell.flow.radii();
                let mut sides = vec![Side { line: circle(outer), beyond: Beyond::Air }];
                if inner > 0.0 {
                    sides.push(Side { line: circle(inner), beyond: cell.inner });
                }
                sides
            }
        }
    }

    /// Whether the medium varies from point to point.
    #[must_use]
    pub fn is_graded(&self) -> bool {
        match self {
            Self::Prism(_) => false,
            Self::Conformal(_) | Self::Radial(_) => true,
        }
    }

    /// The medium at a point of the plane z = 0 that lies in the cell or on its border; a graded
    /// medium has none elsewhere.
    #[must_use]
    pub fn medium_at(&self, point: DVec2) -> Option<Medium> {
        let point = point.extend(0.0);
        let entrance = self.enter(point)?;
        self.medium(point, entrance.foothold.as_ref(), &mut None).copied()
    }
}

impl Skin {
    /// The surface in the plane z = 0: nothing for the ends of a device.
    #[must_use]
    pub fn sides(&self) -> Vec<Side> {
        let metal = |line| Side { line, beyond: Beyond::Conductor };
        match self {
            Self::Wall { wall, beyond, .. } => {
                vec![Side { line: wall.ends().to_vec(), beyond: *beyond }]
            }
            Self::Strip(wall) => vec![metal(wall.ends().to_vec())],
            Self::Floor { curve, .. } => {
                // Back to its beginning.
                let mut around = curve.outline(PIECES);
                around.extend(around.first().copied());
                vec![metal(around)]
            }
            Self::Sphere { sphere: Sphere { radius }, beyond }
            | Self::Side { cylinder: Cylinder { radius, .. }, beyond }
            | Self::InnerSphere { sphere: Sphere { radius }, beyond }
            | Self::InnerSide { cylinder: Cylinder { radius, .. }, beyond } => {
                vec![Side { line: circle(*radius), beyond: *beyond }]
            }
            Self::InnerFloor { curve, side, beyond, .. } => {
                vec![Side { line: curve.side_line(*side, PIECES), beyond: *beyond }]
            }
            Self::Cap { .. }
            | Self::PiercedCap { .. }
            | Self::Disc { .. }
            | Self::ConformalCap { .. }
            | Self::FloorCap { .. } => Vec::new(),
        }
    }
}

impl BodyShape {
    /// Its surface in the plane z = 0, joined to its beginning.
    fn around(&self) -> Vec<DVec2> {
        match self {
            Self::Ball(Sphere { radius }) | Self::Cylinder(Cylinder { radius, .. }) => {
                circle(*radius)
            }
            Self::Box { half } => {
                let corner = half.truncate().min(DVec2::splat(REACH));
                let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
                signs.map(|sign| DVec2::from(sign) * corner).to_vec()
            }
        }
    }
}

/// A circle about the origin, joined to its beginning.
fn circle(radius: f64) -> Vec<DVec2> {
    let step = std::f64::consts::TAU / f64::from(PIECES);
    (0..=PIECES).map(|i| DVec2::from_angle(step * f64::from(i % PIECES)) * radius).collect()
}

impl Prism {
    fn sides(&self) -> Vec<Side> {
        // A large square, cut by one plane after the other; with each corner, the face whose side
        // starts there.
        let mut corners: Vec<(DVec2, Option<&Face>)> =
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|corner| (DVec2::from(corner) * REACH, None))
                .to_vec();
        for face in &self.faces {
            let height = |p: DVec2| face.plane.normal.truncate().dot(p) - face.plane.offset;
            let mut kept = Vec::new();
            for (i, &(a, on)) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()].0;
                let (at_a, at_b) = (height(a), height(b));
                let crossing = a + (b - a) * (at_a / (at_a - at_b));
                match (at_a <= 0.0, at_b <= 0.0) {
                    (true, true) => kept.push((a, on)),
                    (true, false) => kept.extend([(a, on), (crossing, Some(face))]),
                    (false, true) => kept.push((crossing, on)),
                    (false, false) => {}
                }
            }
            corners = kept;
        }
        // A corner that a plane just touches has made a side without length.
        let n = corners.len();
        let long = (0..n).filter(|&i| !near(corners[i].0, corners[(i + 1) % n].0));
        let corners: Vec<_> = long.map(|i| corners[i]).collect();
        let n = corners.len();
        // Cutting something so large has rounded much: the corners once more, from their two faces.
        let exact = |i: usize| {
            let (rough, on) = corners[i % n];
            let (Some(a), Some(b)) = (corners[(i + n - 1) % n].1, on) else { return rough };
            let (p, q) = (a.plane.normal.truncate(), b.plane.normal.truncate());
            (b.plane.offset * p.perp() - a.plane.offset * q.perp()) / p.perp_dot(q)
        };
        (0..n)
            .map(|i| Side {
                line: vec![exact(i), exact(i + 1)],
                beyond: corners[i].1.map_or(Beyond::Air, |face| face.beyond),
            })
            .collect()
    }
}

impl ConformalCell {
    fn sides(&self) -> Vec<Side> {
        let cut = self.flow.cut();
        let map = self.flow.map();
        let mirrored = |p: DVec2| match self.half {
            Half::Upper => p,
            Half::Lower => DVec2::new(p.x, -p.y),
        };
        let side = |line: Vec<DVec2>, beyond| Side {
            line: line.into_iter().map(mirrored).collect(),
            beyond,
        };
        let [core, rim] = self.flow.radii();
        let core = core.map(|core| side(circle(core), self.core));
        if let Some(rim) = rim {
            return std::iter::once(side(circle(rim), Beyond::Air)).chain(core).collect();
        }
        let floor = map.floor_line(cut.x_min, cut.x_max, PIECES);
        let upright = |x: f64| {
            // Below the floor's level, in the troughs of a grating, the ends are metal.
            let (low, high) = (map.floor_height_at(x), cut.y_max);
            let level = low.max(map.level());
            let piece = |a: f64, b: f64| vec![DVec2::new(x, a), DVec2::new(x, b)];
            let buried = (low < level).then(|| side(piece(low, level), Beyond::Conductor));
            buried.into_iter().chain([side(piece(level, high), Beyond::Air)])
        };
        let top = [cut.x_max, cut.x_min].map(|x| DVec2::new(x, cut.y_max)).to_vec();
        [side(floor, self.floor), side(top, Beyond::Air)]
            .into_iter()
            .chain(upright(cut.x_min))
            .chain(upright(cut.x_max))
            .chain(core)
            .collect()
    }
}

impl Contour {
    /// The corners: the points without those on a straight line between their neighbours.
    #[must_use]
    pub fn corners(&self) -> Vec<DVec2> {
        let n = self.points.len();
        let straight = |i: usize| {
            let [a, b, c] = [n - 1, 0, 1].map(|step| self.points[(i + step) % n]);
            let turn = (b - a).perp_dot(c - b);
            turn.abs() <= 1e-9 * (b - a).length() * (c - b).length() && (b - a).dot(c - b) > 0.0
        };
        let is_end = |i: usize| !self.closed && (i == 0 || i + 1 == n);
        (0..n).filter(|i| is_end(*i) || !straight(*i)).map(|i| self.points[i]).collect()
    }

    /// Whether a point lies within a closed contour.
    #[must_use]
    pub fn surrounds(&self, point: DVec2) -> bool {
        let n = self.points.len();
        let crossed = (0..n).filter(|&i| {
            let (a, b) = (self.points[i], self.points[(i + 1) % n]);
            let between = (a.y > point.y) != (b.y > point.y);
            between && point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y)
        });
        self.closed && crossed.count() % 2 == 1
    }
}

impl Region<'_> {
    /// Whether a point lies within.
    #[must_use]
    pub fn holds(&self, point: DVec2) -> bool {
        self.border.iter().filter(|contour| contour.surrounds(point)).count() % 2 == 1
    }
}

/// Whether two ends of lines are one point.
fn near(a: DVec2, b: DVec2) -> bool {
    a.distance(b) <= 1e-9 * (1.0 + a.length())
}

/// Lines joined where their ends meet, in whichever direction they run.
fn joined(lines: impl Iterator<Item = Vec<DVec2>>) -> Vec<Contour> {
    let mut rest: Vec<Vec<DVec2>> = lines.filter(|line| line.len() > 1).collect();
    let mut contours = Vec::new();
    while !rest.is_empty() {
        let mut points = rest.remove(0);
        // First on from its end, then from its beginning.
        for _ in 0..2 {
            while let Some(end) = points.last().copied()
                && !near(end, points[0])
                && let Some(next) = rest.iter().position(|line| {
                    near(line[0], end) || line.last().is_some_and(|last| near(*last, end))
                })
            {
                let mut line = rest.remove(next);
                if !near(line[0], end) {
                    line.reverse();
                }
                points.extend(line.into_iter().skip(1));
            }
            points.reverse();
        }
        let closed = points.len() > 2 && points.last().is_some_and(|last| near(*last, points[0]));
        if closed {
            points.pop();
        }
        contours.push(Contour { points, closed });
    }
    contours
}

#[cfg(test)]
mod tests;
