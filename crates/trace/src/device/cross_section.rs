//! What a device looks like cut in the plane z = 0 of its own frame, or, where that is not along
//! the plane of a drawing, the outline of what it hides of that plane.
//!
//! A new kind of [`Region`] or [`Shape`] says here, and nowhere else, what it looks like: its sides
//! as lines, and for a region whether its medium is graded. The rest follows.

use super::structure::segments;
use super::{
    Body, ConformalRegion, Convex, Face, FarSide, HomogeneousRegion, Region, RegionBorder, Shape,
    Structure, Surface,
};
use glam::DVec2;
use optics::geometry::{Cylinder, Lens, LensPart, Outline, Polyhedron, Pose, REACH, Solid, Sphere};
use optics::medium::Medium;

/// Straight pieces that a curve is drawn with.
const PIECES: u32 = 256;

/// A piece of the border of a region, or of the surfaces.
#[derive(Clone, Debug, PartialEq)]
struct Edge {
    /// From point to point, cm.
    points: Vec<DVec2>,
    /// What lies on its other side.
    far: FarSide,
}

/// A line from point to point, cm.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// The points; the first is not repeated at the end.
    pub points: Vec<DVec2>,
    /// Whether the last is joined to the first.
    pub closed: bool,
}

/// The cross-section of one region, or of all pieces of a concave one.
#[derive(Clone, Debug)]
pub struct Section<'s> {
    /// Its border; what is inside an odd number of contours is inside.
    pub border: Vec<Contour>,
    /// The region; of a concave one its first piece.
    pub region: &'s Region,
}

/// The cross-section of a device, in its own frame.
#[derive(Clone, Debug)]
pub struct CrossSection<'s> {
    /// What light outside meets.
    pub outlines: Vec<Contour>,
    /// The regions; none of a body, which fills its outlines.
    pub regions: Vec<Section<'s>>,
    /// The surfaces of metal: closed contours are full of it, open ones are thin mirrors.
    pub metal: Vec<Contour>,
    /// The lines of polarizers.
    pub polarizers: Vec<Contour>,
    /// The medium that fills the outlines, if the device is a body of one.
    pub body_medium: Option<&'s Medium>,
    /// The body that fills the outlines, if the device is one that is not of metal.
    pub body: Option<Body>,
    /// Whether it is only seen from afar: its outlines are projections, and nothing is known of
    /// within.
    pub is_shadow: bool,
}

impl Structure {
    /// The cross-section in the plane z = 0.
    #[must_use]
    pub fn cross_section(&self) -> CrossSection<'_> {
        let outside: Vec<Edge> = self.surfaces.iter().flat_map(Surface::edges).collect();
        let regions: Vec<Vec<Edge>> = self.regions.iter().map(Region::edges).collect();
        let metal = regions.iter().flatten().chain(&outside);
        let metal = metal.filter(|edge| edge.far.is_metal());
        // What is cut into convex pieces is whole again: cuts are no borders.
        let segments = segments(&self.regions);
        let border = |segment: usize| {
            let pieces = regions.iter().zip(&segments).filter(|(_, of)| **of == segment);
            let edges = pieces.flat_map(|(edges, _)| edges);
            joined(edges.filter(|edge| !matches!(edge.far, FarSide::Seam(_))))
        };
        let sections = self
            .regions
            .iter()
            .enumerate()
            .filter(|(number, _)| segments[*number] == *number && self.hull.body.is_none());
        CrossSection {
            body_medium: self.body_medium(),
            body: self.drawn_body(),
            is_shadow: false,
            metal: joined(metal),
            polarizers: joined(outside.iter().filter(|edge| edge.far == FarSide::Polarizer)),
            regions: sections
                .map(|(number, region)| Section { border: border(number), region })
                .collect(),
            outlines: joined(&outside),
        }
    }

    /// The medium that fills it, if it is a body of one.
    #[must_use]
    pub fn body_medium(&self) -> Option<&Medium> {
        match self.regions.first() {
            Some(Region::Homogeneous(region)) => self.hull.body.map(|_| &region.medium),
            _ => None,
        }
    }

    /// The body that it is, unless that is of metal, which is drawn as other metal is.
    fn drawn_body(&self) -> Option<Body> {
        self.hull.body.filter(|_| !self.is_metal())
    }

    /// What the device looks like at a place, drawn on the xy-plane of the world, and the place of
    /// that drawing: cut in its own plane z = 0 where its axis is along z, the outline of its
    /// projection where it is not.
    #[must_use]
    pub fn drawn_at(&self, pose: &Pose) -> (CrossSection<'_>, Pose) {
        if pose.axis().truncate() == DVec2::ZERO {
            return (self.cross_section(), *pose);
        }
        let origin = pose.origin;
        let contour = |corners: &[DVec2]| Contour {
            points: corners.iter().map(|corner| *corner - origin.truncate()).collect(),
            closed: corners.len() > 2,
        };
        let shadow = |solid: &Solid| solid.placed(pose).shadow().corners;
        let parts: Vec<Vec<DVec2>> = self.hull.solids.iter().map(shadow).collect();
        let whole = Outline::hull(parts.concat());
        let (body, is_metal) = (self.drawn_body(), self.is_metal());
        let mirror = self.hull.thin_mirror.as_ref().map(shadow);
        let metal = parts.iter().filter(|_| is_metal).chain(&mirror);
        let metal: Vec<Contour> = metal.map(|part| contour(part)).collect();
        let outlines = if is_metal { metal.clone() } else { vec![contour(&whole.corners)] };
        let polarizers = parts.iter().filter(|_| self.polarizes()).map(|part| contour(part));
        let section = CrossSection {
            outlines,
            regions: Vec::new(),
            metal,
            polarizers: polarizers.collect(),
            body_medium: self.body_medium(),
            body,
            is_shadow: true,
        };
        (section, Pose::new(origin, 0.0))
    }
}

impl Region {
    /// The border of the region in the plane z = 0.
    fn edges(&self) -> Vec<Edge> {
        match self {
            Self::Homogeneous(region) => region.edges(),
            Self::Conformal(region) => region.edges(),
            Self::Radial(region) => {
                let [inner, outer] = region.flow.radii();
                let outer = Edge { points: circle(outer), far: FarSide::Outside };
                let inner =
                    (inner > 0.0).then(|| Edge { points: circle(inner), far: region.inner });
                std::iter::once(outer).chain(inner).collect()
            }
            Self::ClosedForm(region) => {
                vec![Edge { points: region.border.convex().around(), far: FarSide::Outside }]
            }
            Self::Spatial(region) => {
                vec![Edge { points: region.shape.around(), far: FarSide::Outside }]
            }
        }
    }

    /// Whether the medium varies from point to point.
    #[must_use]
    pub fn is_graded(&self) -> bool {
        !matches!(self, Self::Homogeneous(_))
    }

    /// The medium at a point of the plane z = 0 that lies in the region or on its border; a graded
    /// medium has none elsewhere.
    #[must_use]
    pub fn medium_at(&self, point: DVec2) -> Option<Medium> {
        self.enter(point.extend(0.0), &mut None).map(|(_, medium)| *medium)
    }
}

impl Surface {
    /// The surface in the plane z = 0: nothing for the ends of a device, two sides of the edge of a
    /// lens, a line for each triangle of a solid with flat faces.
    fn edges(&self) -> Vec<Edge> {
        let points = match &self.shape {
            Shape::Wall(wall) | Shape::Sheet(wall) | Shape::Polarizer { wall, .. } => {
                wall.ends().to_vec()
            }
            Shape::Convex(shape) => shape.around(),
            Shape::BallHole(sphere) => circle(sphere.radius),
            Shape::Round(cylinder) | Shape::RoundHole(cylinder) => circle(cylinder.radius),
            Shape::Curve { curve, side: Some(side), .. } => curve.side_line(*side, PIECES),
            Shape::Curve { curve, side: None, .. } => closed(curve.outline(PIECES)),
            Shape::OfLens { lens, part } => return lens_edges(lens, *part, self.far),
            Shape::OfPolyhedron(solid) => return section_edges(solid, self.far),
            Shape::Cap(_) | Shape::Disc(_) => return Vec::new(),
        };
        vec![Edge { points, far: self.far }]
    }
}

impl Convex {
    /// Its surface in the plane z = 0, joined to its beginning.
    fn around(&self) -> Vec<DVec2> {
        match self {
            Self::Ball(Sphere { radius }) | Self::Cylinder(Cylinder { radius, .. }) => {
                circle(*radius)
            }
            Self::CutBall(ball) => closed(ball.section(PIECES)),
            Self::Box { half } => {
                let corner = half.truncate().min(DVec2::splat(REACH));
                closed(Outline::rectangle(corner.x, corner.y).corners)
            }
        }
    }
}

/// A piece of the border of a lens in the plane z = 0.
fn lens_edges(lens: &Lens, part: LensPart, far: FarSide) -> Vec<Edge> {
    let line = |points: Vec<[f64; 2]>| Edge {
        points: points.into_iter().map(DVec2::from_array).collect(),
        far,
    };
    match part {
        LensPart::Front => vec![line(lens.face_line(&lens.front, PIECES))],
        LensPart::Back => vec![line(lens.face_line(&lens.back, PIECES))],
        LensPart::Edge => {
            let ends = lens.between(lens.radius);
            let side = |y: f64| line(ends.map(|x| [x, y]).to_vec());
            vec![side(lens.radius), side(-lens.radius)]
        }
    }
}

/// The border of a solid with flat faces in the plane z = 0.
fn section_edges(solid: &Polyhedron, far: FarSide) -> Vec<Edge> {
    solid.section().into_iter().map(|ends| Edge { points: ends.to_vec(), far }).collect()
}

/// Points around something, joined to their beginning.
fn closed(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.extend(points.first().copied());
    points
}

/// A circle about the origin, joined to its beginning.
fn circle(radius: f64) -> Vec<DVec2> {
    let step = std::f64::consts::TAU / f64::from(PIECES);
    closed((0..PIECES).map(|i| DVec2::from_angle(step * f64::from(i)) * radius).collect())
}

impl HomogeneousRegion {
    fn edges(&self) -> Vec<Edge> {
        let side =
            |face: &Face| face.side.map(|side| Edge { points: side.to_vec(), far: face.far });
        match &self.border {
            RegionBorder::Convex(shape) => {
                vec![Edge { points: shape.around(), far: FarSide::Outside }]
            }
            RegionBorder::Lens(lens) => Lens::PARTS
                .into_iter()
                .flat_map(|part| lens_edges(lens, part, FarSide::Outside))
                .collect(),
            RegionBorder::Polyhedron(solid) => section_edges(solid, FarSide::Outside),
            RegionBorder::Faces(faces) => faces.iter().filter_map(side).collect(),
        }
    }
}

impl ConformalRegion {
    fn edges(&self) -> Vec<Edge> {
        let cut = self.flow.cut();
        let map = self.flow.map();
        let mirrored = |p: DVec2| self.half.mirrored(p.extend(0.0)).truncate();
        let side = |points: Vec<DVec2>, far| Edge {
            points: points.into_iter().map(mirrored).collect(),
            far,
        };
        let [core, rim] = self.flow.radii();
        let core = core.map(|core| side(circle(core), self.core));
        if let Some(rim) = rim {
            return std::iter::once(side(circle(rim), FarSide::Outside)).chain(core).collect();
        }
        let floor = map.floor_line(cut.x_min, cut.x_max, PIECES);
        let upright = |x: f64| {
            // Below the floor's level, in the troughs of a grating, the ends are metal.
            let (low, high) = (map.floor_height_at(x), cut.y_max);
            let level = low.max(map.level());
            let piece = |a: f64, b: f64| vec![DVec2::new(x, a), DVec2::new(x, b)];
            let buried = (low < level).then(|| side(piece(low, level), FarSide::Conductor));
            buried.into_iter().chain([side(piece(level, high), FarSide::Outside)])
        };
        let top = [cut.x_max, cut.x_min].map(|x| DVec2::new(x, cut.y_max)).to_vec();
        [side(floor, self.floor), side(top, FarSide::Outside)]
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

impl Section<'_> {
    /// Whether a point lies within.
    #[must_use]
    pub fn holds(&self, point: DVec2) -> bool {
        self.border.iter().filter(|contour| contour.surrounds(point)).count() % 2 == 1
    }
}

/// Whether two ends of edges are one point.
fn near(a: DVec2, b: DVec2) -> bool {
    a.distance(b) <= 1e-9 * (1.0 + a.length())
}

/// Edges joined where their ends meet, in whichever direction they run.
fn joined<'e>(edges: impl IntoIterator<Item = &'e Edge>) -> Vec<Contour> {
    let lines = edges.into_iter().map(|edge| edge.points.clone());
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
