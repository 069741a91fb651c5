//! The square cloak of homogeneous anisotropic segments (Landy & Smith, Nature Mater. 12, 25
//! (2013); designs (i)-(iii) of Halimeh & Wegener, Opt. Express 21, 9457 (2013)).
//!
//! A square standing on its corner around a metal rhombus; the space between is four triangles,
//! each filled with one homogeneous medium. The map behind it is
//! [`optics::transformation::StripToRhombus`].

use super::{
    Beyond, Cell, Entry, Face, Fact, FactValue, Finish, Hull, Prism, Request, Show, Skin, Structure,
};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use glam::{DMat3, DVec2, DVec3};
use optics::geometry::{Cap, Extent, Outline, Plane, Wall};
use optics::medium::Medium;
use optics::transformation::StripToRhombus;

pub(super) static ENTRY: Entry = Entry {
    kind: "square-cloak",
    title: "Square cloak",
    summary: "Unidirectional cloak of four homogeneous anisotropic segments around a metal \
              rhombus; seen along x it is invisible, turned it is a flat mirror. Landy & Smith \
              2013, designs (i)-(iii) of Halimeh & Wegener 2013.",
    keys: &[
        Key {
            name: "material",
            doc: "What the segments are made of; impedance-matched is design (iii).",
            kind: KeyKind::Choice { options: &["impedance-matched"] },
        },
        Key {
            name: "side",
            doc: "Side of the square.",
            kind: KeyKind::Number { default: Some(14.1), unit: "cm", limits: Limits::Positive },
        },
        Key {
            name: "kappa",
            doc: "Ratio of the rhombus's diagonals; 1/sqrt(3) gives corners of 60 and 120 degrees.",
            kind: KeyKind::Number {
                default: Some(0.577_350_269_189_625_8),
                unit: "",
                limits: Limits::Between(0.0, 1.0),
            },
        },
        Key {
            name: "rounded",
            doc: "Use the paper's rounded material values 3.27, 0.31, 2.366 and 33.54 degrees \
                  instead of the exact ones.",
            kind: KeyKind::Flag { default: false },
        },
    ],
    build,
    facts,
};

/// The signs of x and y in the four quadrants, counterclockwise.
const QUADRANTS: [DVec2; 4] =
    [DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0), DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0)];

fn map(values: &Values) -> StripToRhombus {
    StripToRhombus::new(values.number("side") * 0.5f64.sqrt(), values.number("kappa"))
}

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    let map = map(values);
    let extent = Extent::centred(request.length);
    match request.show {
        Show::Cloak => cloak(&map, values.flag("rounded"), extent),
        Show::Bare => Ok(bare(&map, extent)),
        Show::Mirror => {
            let half = map.half_diagonal();
            Ok(super::flat_strip(half, extent))
        }
    }
}

/// The corners of the square or the rhombus, counterclockwise from +x.
fn corners(half_width: f64, half_height: f64) -> [DVec2; 4] {
    [(half_width, 0.0), (0.0, half_height), (-half_width, 0.0), (0.0, -half_height)]
        .map(DVec2::from)
}

fn bare(map: &StripToRhombus, extent: Extent) -> Structure {
    let outline = Outline::new(corners(map.half_diagonal(), map.half_height()).to_vec());
    let mut skin: Vec<Skin> = outline
        .sides()
        .map(|(from, to)| Skin::Wall {
            wall: Wall::new(from, to, extent),
            beyond: Beyond::Conductor,
            finish: Finish::Bare,
        })
        .collect();
    if let Some(ends) = extent.ends() {
        skin.extend(Cap::both(&outline, ends).map(|cap| Skin::Cap {
            cap,
            beyond: Beyond::Conductor,
            finish: Finish::Bare,
        }));
    }
    Structure { cells: Vec::new(), skin, hull: Hull::new(outline, extent) }
}

fn cloak(map: &StripToRhombus, rounded: bool, extent: Extent) -> Result<Structure, KeyError> {
    let (d, b) = (map.half_diagonal(), map.half_height());
    let square = corners(d, d);
    let rhombus = corners(d, b);
    let mut cells = Vec::new();
    let mut skin = Vec::new();
    for (index, quadrant) in (0u16..).zip(QUADRANTS) {
        let medium = medium(map, rounded, quadrant)?;
        let inner = DVec2::new(quadrant.x / d, quadrant.y / b).extend(0.0);
        let diagonal = quadrant.extend(0.0) * 0.5f64.sqrt();
        // The neighbour across x = 0.
        let neighbour = Beyond::Cell(index ^ 1);
        let face = |normal: DVec3, offset: f64, beyond: Beyond| Face {
            plane: Plane { normal, offset },
            beyond,
        };
        let mut faces = vec![
            face(diagonal, d * 0.5f64.sqrt(), Beyond::Air),
            face(-inner.normalize(), -inner.length_recip(), Beyond::Conductor),
            face(DVec3::new(-quadrant.x, 0.0, 0.0), 0.0, neighbour),
        ];
        let (from, to) = (usize::from(index), (usize::from(index) + 1) % 4);
        skin.push(Skin::Wall {
            wall: Wall::new(square[from], square[to], extent),
            beyond: Beyond::Cell(index),
            finish: Finish::Bare,
        });
        if let Some(ends) = extent.ends() {
            let tip = if quadrant.y > 0.0 { square[1] } else { square[3] };
            let side = if quadrant.x > 0.0 { square[0] } else { square[2] };
            let blunt = if quadrant.y > 0.0 { rhombus[1] } else { rhombus[3] };
            let mut triangle = vec![side, tip, blunt];
            if (tip - side).perp_dot(blunt - side) < 0.0 {
                triangle.reverse();
            }
            for cap in Cap::both(&Outline::new(triangle), ends) {
                faces.push(face(cap.normal, cap.z * cap.normal.z, Beyond::Air));
                skin.push(Skin::Cap { cap, beyond: Beyond::Cell(index), finish: Finish::Bare });
            }
        }
        cells.push(Cell::Prism(Prism { medium, faces }));
    }
    if let Some(ends) = extent.ends() {
        let hole = Outline::new(rhombus.to_vec());
        skin.extend(Cap::both(&hole, ends).map(|cap| Skin::Cap {
            cap,
            beyond: Beyond::Conductor,
            finish: Finish::Bare,
        }));
    }
    let hull = Hull::new(Outline::new(square.to_vec()), extent);
    Ok(Structure { cells, skin, hull })
}

/// The medium of one segment.
fn medium(map: &StripToRhombus, rounded: bool, quadrant: DVec2) -> Result<Medium, KeyError> {
    let tensor = if rounded { rounded_tensor(quadrant) } else { map.tensor(quadrant) };
    Medium::impedance_matched(tensor)
        .map_err(|error| KeyError { key: Some("kappa"), message: error.to_string() })
}

/// The tensor printed in the paper: 3.27 along u, 0.31 along v, 2.366 along z.
fn rounded_tensor(quadrant: DVec2) -> DMat3 {
    let angle = -33.54f64.to_radians() * quadrant.x * quadrant.y;
    let turn = DMat3::from_rotation_z(angle);
    let tensor = turn * DMat3::from_diagonal(DVec3::new(3.27, 0.31, 2.366)) * turn.transpose();
    // Symmetric to the last bit.
    (tensor + tensor.transpose()) * 0.5
}

fn facts(values: &Values) -> Vec<Fact> {
    let map = map(values);
    let (d, b) = (map.half_diagonal(), map.half_height());
    let (principal, angle) = if values.flag("rounded") {
        (DVec3::new(3.27, 0.31, 2.366), -33.54)
    } else {
        map.principal_values()
    };
    vec![
        Fact::number("cloaked_area_cm2", 2.0 * d * b),
        Fact::number("rhombus_side_cm", d.hypot(b)),
        Fact::number("mirror_width_cm", 2.0 * d),
        Fact {
            name: "permittivity_principal_values",
            value: FactValue::Numbers(principal.to_array().to_vec()),
        },
        Fact {
            name: "permeability_principal_values",
            value: FactValue::Numbers(principal.to_array().to_vec()),
        },
        Fact::number("axis_u_angle_deg", angle),
    ]
}
