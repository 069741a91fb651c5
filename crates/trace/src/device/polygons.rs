//! Devices of polygonal cross-section: parts of homogeneous media or metal that extend along z and
//! meet without gaps.
//!
//! Concave cross-sections are cut into convex regions; the cuts are no interfaces.

use super::coating::reversed;
use super::{
    Coating, DispersiveMedium, Face, FarSide, HomogeneousRegion, Hull, Region, RegionBorder, Shape,
    Structure, Surface,
};
use glam::DVec2;
use optics::geometry::{Cap, ConvexPart, Extent, Outline, Plane, Polygon, SAME_POINT, Solid, Wall};
use optics::interface::FilmLayer;
use optics::medium::Medium;
use std::collections::HashMap;

/// A part of a device, of one medium or of metal.
pub(super) struct PolygonPart {
    pub polygon: Polygon,
    /// What fills it; `None` for metal.
    pub medium: Option<DispersiveMedium>,
    /// What its metal is of; `None` for a perfect conductor.
    pub metal: Option<Medium>,
    /// The layers on all of its surfaces, from the outside inwards.
    pub film: Vec<FilmLayer>,
}

impl PolygonPart {
    /// A bare part of a medium, or of a perfect conductor.
    pub fn new(polygon: Polygon, medium: Option<Medium>) -> Self {
        let medium = medium.map(DispersiveMedium::from);
        Self { polygon, medium, metal: None, film: Vec::new() }
    }
}

/// A convex piece of a part.
struct Piece {
    /// The part it is of.
    part: usize,
    corners: ConvexPart,
    outline: Outline,
    /// What it is to its neighbours.
    itself: FarSide,
}

/// A stretch of one edge of a piece, and what lies beyond it.
struct Stretch {
    from: DVec2,
    to: DVec2,
    far: FarSide,
    /// The part beyond it, if it is another one.
    beyond: Option<usize>,
}

/// The films of a device by the parts from and to which they lead, outside where there is none.
struct Films<'a> {
    parts: &'a [PolygonPart],
    known: HashMap<[Option<usize>; 2], Coating>,
    films: Vec<Vec<FilmLayer>>,
}

impl Films<'_> {
    fn between(&mut self, from: Option<usize>, to: Option<usize>) -> Coating {
        let film = |part: Option<usize>| part.map_or(&[][..], |part| &self.parts[part].film);
        let (leaving, entering) = (film(from), film(to));
        if leaving.is_empty() && entering.is_empty() {
            return Coating::None;
        }
        *self.known.entry([from, to]).or_insert_with(|| {
            // Fewer than sides, of which there are a few thousand.
            let number = self.films.len() as u16;
            self.films.push([&reversed(leaving), entering].concat());
            Coating::Film(number)
        })
    }
}

/// The device of the parts, whose corners may be off by `rounding` (cm), at least [`SAME_POINT`].
///
/// Sides of two parts that lie along each other no farther apart than that are one. A gap that is as
/// wide at both of its ends, and as wide as a step of the last digit may make it, is none of
/// rounding, and stays a gap.
///
/// # Errors
///
/// If two parts overlap: their numbers.
pub(super) fn polygonal(
    parts: &[PolygonPart],
    extent: Extent,
    rounding: f64,
) -> Result<Structure, [usize; 2]> {
    let pieces = pieces(parts, rounding)?;
    let (mut regions, mut surfaces) = (Vec::new(), Vec::new());
    let mut films = Films { parts, known: HashMap::new(), films: Vec::new() };
    for (index, piece) in pieces.iter().enumerate() {
        let mut faces = Vec::new();
        let (leaving, entering) =
            (films.between(Some(piece.part), None), films.between(None, Some(piece.part)));
        for (edge, (from, to)) in piece.outline.sides().enumerate() {
            let normal = Wall::new(from, to, extent).normal;
            let plane = Plane { normal, offset: normal.truncate().dot(from) };
            let along = (to - from).normalize();
            let stretches = stretches(parts, &pieces, [index, edge], rounding);
            let last = stretches.len() - 1;
            for (number, Stretch { from, to, far, beyond }) in stretches.into_iter().enumerate() {
                let until = if number == last { f64::INFINITY } else { along.dot(to) };
                let coating = match far {
                    FarSide::Outside => leaving,
                    FarSide::Seam(_) => Coating::None,
                    _ => films.between(Some(piece.part), beyond),
                };
                let side = Some([from, to]);
                faces.push(Face { until, coating, side, ..Face::new(plane, far) });
                if far == FarSide::Outside {
                    let wall = Surface::wall(Wall::new(from, to, extent), piece.itself);
                    surfaces.push(Surface { coating: entering, ..wall });
                }
            }
        }
        for cap in extent.ends().into_iter().flat_map(|ends| Cap::both(&piece.outline, ends)) {
            let plane = Plane { normal: cap.normal, offset: cap.z * cap.normal.z };
            faces.push(Face { coating: leaving, ..Face::new(plane, FarSide::Outside) });
            let cap = Surface::new(Shape::Cap(cap), piece.itself);
            surfaces.push(Surface { coating: entering, ..cap });
        }
        if let Some(medium) = parts[piece.part].medium {
            let region = HomogeneousRegion::new(medium, RegionBorder::Faces(faces));
            regions.push(Region::Homogeneous(region));
        }
    }
    let solids =
        pieces.into_iter().map(|piece| Solid::Prism { outline: piece.outline, extent }).collect();
    let metals = parts.iter().filter_map(|part| part.metal).collect();
    let hull = Hull::of_parts(solids);
    Ok(Structure { films: films.films, metals, ..Structure::new(regions, surfaces, hull) })
}

/// The convex pieces of all parts, which must not overlap.
fn pieces(parts: &[PolygonPart], rounding: f64) -> Result<Vec<Piece>, [usize; 2]> {
    let mut pieces: Vec<Piece> = Vec::new();
    let (mut regions, mut metals) = (0, 0);
    for (index, part) in parts.iter().enumerate() {
        let metal = match part.metal {
            Some(_) => FarSide::Metal(metals),
            None => FarSide::Conductor,
        };
        metals += u16::from(part.metal.is_some());
        for corners in part.polygon.convex_parts() {
            let outline = part.polygon.outline(&corners);
            let overlapped = pieces
                .iter()
                .find(|other| other.part != index && other.outline.overlaps(&outline, rounding));
            if let Some(other) = overlapped {
                return Err([other.part, index]);
            }
            let itself = match part.medium {
                Some(_) => FarSide::Region(regions),
                None => metal,
            };
            regions += u16::from(part.medium.is_some());
            pieces.push(Piece { part: index, corners, outline, itself });
        }
    }
    Ok(pieces)
}

/// Ends of a gap that differ by no more than this share make it a gap with parallel sides.
const PARALLEL: f64 = 1e-6;

/// The least gap that is meant, as a share of the rounding, which is 1.5 steps of the last digit: a
/// step along x or y is 0.71 of it across a side at 45 degrees. Rounded sides of one line may be
/// parallel, too.
const NARROWEST_GAP: f64 = 0.7 / 1.5;

/// The stretches of an edge of a piece, in order from its first corner to its second.
fn stretches(
    parts: &[PolygonPart],
    pieces: &[Piece],
    [index, edge]: [usize; 2],
    rounding: f64,
) -> Vec<Stretch> {
    let piece = &pieces[index];
    let ends = |piece: &Piece, edge: usize| {
        [piece.corners[edge], piece.corners[(edge + 1) % piece.corners.len()]]
    };
    let [i, j] = ends(piece, edge);
    let polygon = &parts[piece.part].polygon;
    let (from, to) = (polygon.corners()[i], polygon.corners()[j]);
    let whole = |far| vec![Stretch { from, to, far, beyond: None }];
    if (i + 1) % polygon.corners().len() != j {
        // A cut: the piece on its other side is of the same prism.
        let twin = pieces.iter().find(|other| {
            other.part == piece.part
                && (0..other.corners.len()).any(|edge| ends(other, edge) == [j, i])
        });
        return whole(twin.map_or(FarSide::Outside, |twin| seam(twin.itself)));
    }
    let along = (to - from).normalize();
    let length = from.distance(to);
    // What touches the side from without: from where to where, in cm from its first corner.
    let mut touching: Vec<(f64, f64, Stretch)> = Vec::new();
    for other in pieces.iter().filter(|other| other.part != piece.part) {
        for (there, back) in other.outline.sides() {
            let place = |p: DVec2| ((p - from).dot(along), (p - from).perp_dot(along));
            let ((start, off_start), (end, off_end)) = (place(back), place(there));
            let (low, high) = (start.max(0.0), end.min(length));
            // How far off it is where the two are side by side: further on, rounded corners lead
            // astray.
            let off = |at: f64| off_start + (off_end - off_start) * (at - start) / (end - start);
            let [first, last] = [low, high].map(off);
            let farther = first.abs().max(last.abs());
            let is_gap = first.min(last) > SAME_POINT.max(NARROWEST_GAP * rounding)
                && (first - last).abs() <= PARALLEL * farther;
            if farther <= rounding && !is_gap && high - low > rounding {
                let clamped = |p: DVec2, at: f64| match at {
                    at if at <= rounding => from,
                    at if at >= length - rounding => to,
                    _ => p,
                };
                let same = !other.itself.is_metal()
                    && parts[other.part].medium == parts[piece.part].medium
                    && [other, piece].iter().all(|piece| parts[piece.part].film.is_empty());
                let far = if same { seam(other.itself) } else { other.itself };
                let (from, to) = (clamped(back, start), clamped(there, end));
                let beyond = Some(other.part);
                touching.push((low, high, Stretch { from, to, far, beyond }));
            }
        }
    }
    touching.sort_by(|a, b| a.0.total_cmp(&b.0));
    let outside = |from, to| Stretch { from, to, far: FarSide::Outside, beyond: None };
    let mut stretches = Vec::new();
    let (mut at, mut reached) = (from, 0.0);
    for (low, high, stretch) in touching {
        if low - reached > rounding {
            stretches.push(outside(at, stretch.from));
        }
        (at, reached) = (stretch.to, high);
        stretches.push(stretch);
    }
    if length - reached > rounding {
        stretches.push(outside(at, to));
    }
    stretches
}

/// A neighbour of the same medium.
fn seam(far: FarSide) -> FarSide {
    match far {
        FarSide::Region(region) => FarSide::Seam(region),
        other => other,
    }
}
