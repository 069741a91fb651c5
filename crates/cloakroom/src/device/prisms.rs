//! A device of one's own: prisms of any cross-section, each of a homogeneous medium or of metal.
//!
//! Prisms that share a side, whole or in part, meet there without a gap. Concave cross-sections are cut into
//! convex cells; the cuts are no interfaces.

use super::{Beyond, Cell, Entry, Face, Fact, Finish, Hull, Prism, Request, Show, Skin, Structure};
use crate::keys::{Key, KeyError, KeyKind, Values};
use glam::DVec2;
use optics::geometry::{
    Cap, ConvexPart, Extent, Outline, Plane, Polygon, PolygonError, SAME_POINT, Solid, Wall,
};
use optics::medium::Medium;

pub(super) static ENTRY: Entry = Entry {
    kind: "prisms",
    title: "Prisms of one's own",
    summary: "A device of one's own: prisms of any cross-section and of any homogeneous media, \
              anisotropic, magnetic, negative or absorbing, or of metal.",
    keys: &[Key {
        name: "prism",
        doc: "The prisms, each a table [[device.prism]]; those that share a side, whole or in part, \
              meet there without a gap.",
        kind: KeyKind::Tables { keys: PRISM_KEYS },
    }],
    build,
    facts,
};

static PRISM_KEYS: &[Key] = &[
    Key {
        name: "corners",
        doc: "The corners of its cross-section in the xy-plane, one after the other; it may be concave.",
        kind: KeyKind::Polygon { unit: "cm" },
    },
    super::PERMITTIVITY_KEY,
    super::PERMEABILITY_KEY,
    Key {
        name: "metal",
        doc: "Whether it is metal, a perfect conductor.",
        kind: KeyKind::Flag { default: false },
    },
];

/// More corners than this, all prisms together, are no device.
const MOST_CORNERS: usize = 4096;

/// A prism as the scene gives it.
struct Part {
    polygon: Polygon,
    /// What fills it; `None` for metal.
    medium: Option<Medium>,
}

/// A convex piece of a prism.
struct Piece {
    /// The prism it is of.
    part: usize,
    corners: ConvexPart,
    outline: Outline,
    /// What it is to its neighbours.
    beyond: Beyond,
}

/// A stretch of one edge of a piece, and what lies beyond it.
struct Stretch {
    from: DVec2,
    to: DVec2,
    beyond: Beyond,
}

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    let mut parts = parts(values)?;
    match request.show {
        Show::Cloak => {}
        Show::Bare => {
            parts.retain(|part| part.medium.is_none());
            if parts.is_empty() {
                return Err(KeyError::at("show", "no prism is metal, so nothing of it is bare"));
            }
        }
        Show::Mirror => super::refuse_other_views(request, "prisms imitate no mirror")?,
    }
    let pieces = pieces(&parts)?;
    let extent = Extent::centred(request.length);
    let mut cells = Vec::new();
    let mut skin = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let mut faces = Vec::new();
        for (edge, (from, to)) in piece.outline.sides().enumerate() {
            let wall = Wall::new(from, to, extent);
            let along = (to - from).extend(0.0).normalize();
            let stretches = stretches(&parts, &pieces, index, edge);
            let last = stretches.len() - 1;
            for (number, stretch) in stretches.into_iter().enumerate() {
                let plane =
                    Plane { normal: wall.normal(), offset: wall.normal().truncate().dot(from) };
                let until =
                    if number == last { f64::INFINITY } else { along.truncate().dot(stretch.to) };
                let beyond = stretch.beyond;
                faces.push(Face { until, ..Face::new(plane, beyond) });
                if beyond == Beyond::Air {
                    skin.push(Skin::Wall {
                        wall: Wall::new(stretch.from, stretch.to, extent),
                        beyond: piece.beyond,
                        finish: Finish::Bare,
                    });
                }
            }
        }
        for cap in extent.ends().into_iter().flat_map(|ends| Cap::both(&piece.outline, ends)) {
            let plane = Plane { normal: cap.normal, offset: cap.z * cap.normal.z };
            faces.push(Face::new(plane, Beyond::Air));
            skin.push(Skin::Cap { cap, beyond: piece.beyond, finish: Finish::Bare });
        }
        if let Some(medium) = parts[piece.part].medium {
            cells.push(Cell::Prism(Prism { medium, faces }));
        }
    }
    let solids =
        pieces.into_iter().map(|piece| Solid::Prism { outline: piece.outline, extent }).collect();
    Ok(Structure { cells, skin, hull: Hull::of_parts(solids) })
}

/// The prisms of the scene, each sound in itself.
fn parts(values: &Values) -> Result<Vec<Part>, KeyError> {
    let tables = values.tables("prism");
    if tables.is_empty() {
        let message = "there is no prism; give each one a table [[device.prism]] with `corners` and \
                       `permittivity` or `metal = true`";
        return Err(KeyError::general(message));
    }
    let mut known: Vec<DVec2> = Vec::new();
    let mut parts = Vec::new();
    for (number, table) in tables.iter().enumerate() {
        let part = part(table, &mut known).map_err(|error| error.within("prism", number))?;
        parts.push(part);
    }
    Ok(parts)
}

/// One prism; its corners are moved onto those of earlier ones, `known`, that are the same but for rounding.
fn part(table: &Values, known: &mut Vec<DVec2>) -> Result<Part, KeyError> {
    let corners = table
        .polygon("corners")
        .ok_or_else(|| KeyError::general("this prism has no `corners`: three or more [x, y]"))?;
    if known.len() + corners.len() > MOST_CORNERS {
        let message = format!("all prisms together have more than {MOST_CORNERS} corners");
        return Err(KeyError::at("corners", message));
    }
    let corners: Vec<DVec2> = corners
        .iter()
        .map(|corner| {
            let corner = DVec2::from(*corner);
            let same = known.iter().copied().find(|other| other.distance(corner) <= SAME_POINT);
            same.unwrap_or_else(|| {
                known.push(corner);
                corner
            })
        })
        .collect();
    let polygon = Polygon::new(&corners)
        .map_err(|error: PolygonError| KeyError::at("corners", error.to_string()))?;
    let metal = table.flag("metal");
    let given = ["permittivity", "permeability"].into_iter().find(|key| table.is_given(key));
    let medium = match given {
        Some(key) if metal => {
            let message = format!("metal is a perfect conductor; it has no {key}");
            return Err(KeyError::at(key, message));
        }
        _ if metal => None,
        None => {
            let message = "this prism has neither `permittivity` nor `permeability` nor `metal = true`; \
                           a prism of air is left out";
            return Err(KeyError::general(message));
        }
        Some(_) => Some(super::medium(table)?),
    };
    Ok(Part { polygon, medium })
}

/// The convex pieces of all prisms, which must not overlap.
fn pieces(parts: &[Part]) -> Result<Vec<Piece>, KeyError> {
    let mut pieces: Vec<Piece> = Vec::new();
    let mut cells = 0;
    for (index, part) in parts.iter().enumerate() {
        for corners in part.polygon.convex_parts() {
            let outline = part.polygon.outline(&corners);
            let overlapped = pieces
                .iter()
                .find(|other| other.part != index && other.outline.overlaps(&outline, SAME_POINT));
            if let Some(other) = overlapped {
                let message = format!(
                    "prism {index} overlaps prism {} (counted from 0); cut one of them",
                    other.part
                );
                return Err(KeyError::at("corners", message).within("prism", index));
            }
            let beyond = match part.medium {
                Some(_) => Beyond::Cell(cells),
                None => Beyond::Conductor,
            };
            cells += u16::from(part.medium.is_some());
            pieces.push(Piece { part: index, corners, outline, beyond });
        }
    }
    Ok(pieces)
}

/// The stretches of an edge of a piece, in order from its first corner to its second.
fn stretches(parts: &[Part], pieces: &[Piece], index: usize, edge: usize) -> Vec<Stretch> {
    let piece = &pieces[index];
    let ends = |piece: &Piece, edge: usize| {
        [piece.corners[edge], piece.corners[(edge + 1) % piece.corners.len()]]
    };
    let [i, j] = ends(piece, edge);
    let polygon = &parts[piece.part].polygon;
    let (from, to) = (polygon.corners()[i], polygon.corners()[j]);
    let whole = |beyond| vec![Stretch { from, to, beyond }];
    if (i + 1) % polygon.corners().len() != j {
        // A cut: the piece on its other side is of the same prism.
        let twin = pieces.iter().find(|other| {
            other.part == piece.part
                && (0..other.corners.len()).any(|edge| ends(other, edge) == [j, i])
        });
        return whole(twin.map_or(Beyond::Air, |twin| seam(twin.beyond)));
    }
    let along = (to - from).normalize();
    let length = from.distance(to);
    // What touches the side from without: from where to where, in cm from its first corner.
    let mut touching: Vec<(f64, f64, Stretch)> = Vec::new();
    for other in pieces.iter().filter(|other| other.part != piece.part) {
        for (there, back) in other.outline.sides() {
            let place = |p: DVec2| ((p - from).dot(along), (p - from).perp_dot(along).abs());
            let ((start, off_start), (end, off_end)) = (place(back), place(there));
            let beside = off_start <= SAME_POINT && off_end <= SAME_POINT;
            let (low, high) = (start.max(0.0), end.min(length));
            if beside && high - low > SAME_POINT {
                let clamped = |p: DVec2, at: f64| {
                    if at <= SAME_POINT {
                        from
                    } else if at >= length - SAME_POINT {
                        to
                    } else {
                        p
                    }
                };
                let same = other.beyond != Beyond::Conductor
                    && parts[other.part].medium == parts[piece.part].medium;
                let beyond = if same { seam(other.beyond) } else { other.beyond };
                let (from, to) = (clamped(back, start), clamped(there, end));
                touching.push((low, high, Stretch { from, to, beyond }));
            }
        }
    }
    touching.sort_by(|a, b| a.0.total_cmp(&b.0));
    let air = |from, to| Stretch { from, to, beyond: Beyond::Air };
    let mut stretches = Vec::new();
    let (mut at, mut reached) = (from, 0.0);
    for (low, high, stretch) in touching {
        if low - reached > SAME_POINT {
            stretches.push(air(at, stretch.from));
        }
        (at, reached) = (stretch.to, high);
        stretches.push(stretch);
    }
    if length - reached > SAME_POINT {
        stretches.push(air(at, to));
    }
    stretches
}

/// A neighbour of the same medium.
fn seam(beyond: Beyond) -> Beyond {
    match beyond {
        Beyond::Cell(cell) => Beyond::Seam(cell),
        other => other,
    }
}

fn facts(values: &Values) -> Vec<Fact> {
    let parts = parts(values).unwrap_or_default();
    let area = |metal: bool| {
        let chosen = parts.iter().filter(|part| part.medium.is_none() == metal);
        chosen.map(|part| part.polygon.area()).sum::<f64>()
    };
    vec![
        Fact::number("prism_count", parts.len() as f64),
        Fact::number("medium_area_cm2", area(false)),
        Fact::number("metal_area_cm2", area(true)),
    ]
}
