//! The square cloak of homogeneous anisotropic segments (Landy & Smith, Nature Mater. 12, 25
//! (2013); designs (i)-(iii) of Halimeh & Wegener, Opt. Express 21, 9457 (2013)).
//!
//! A square standing on its corner around a metal rhombus; the space between is four triangles,
//! each filled with one homogeneous medium. The map behind it is
//! [`optics::transformation::StripToRhombus`].

use super::{Beyond, Cell, Entry, Face, Fact, Finish, Hull, Prism, Request, Show, Skin, Structure};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use glam::{DMat3, DVec2, DVec3};
use optics::geometry::{Cap, Extent, Outline, Plane, Solid, Wall};
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
            doc: "What the segments are made of: eps = mu, design (iii), or a scalar eps and a uniaxial \
                  mu, positive (i) or negative (ii), which cloak horizontal polarization only.",
            kind: KeyKind::Choice {
                options: &["impedance-matched", "positive-uniaxial", "negative-uniaxial"],
            },
        },
        Key {
            name: "side",
            doc: "Side of the square.",
            kind: KeyKind::Number { default: Some(14.1), unit: "cm", limits: Limits::LENGTH },
        },
        Key {
            name: "kappa",
            doc: "Ratio of the rhombus's diagonals; 1/sqrt(3) gives corners of 60 and 120 degrees.",
            kind: KeyKind::Number {
                default: Some(0.577_350_269_189_625_8),
                unit: "",
                // Beyond, the tensors are too lopsided for double precision.
                limits: Limits::Within(0.001, 0.999),
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
        Show::Cloak => cloak(&map, &Recipe::new(values, &map), extent, request.open_core),
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
    Structure { cells: Vec::new(), skin, hull: Hull::prism(outline, extent) }
}

fn cloak(
    map: &StripToRhombus,
    recipe: &Recipe,
    extent: Extent,
    open_core: bool,
) -> Result<Structure, KeyError> {
    let (d, b) = (map.half_diagonal(), map.half_height());
    let square = corners(d, d);
    let rhombus = corners(d, b);
    let mut cells = Vec::new();
    let mut skin = Vec::new();
    let mut segments = Vec::new();
    let core = if open_core { Beyond::Air } else { Beyond::Conductor };
    for (index, quadrant) in (0u16..).zip(QUADRANTS) {
        let medium = recipe.medium(quadrant)?;
        let inner = DVec2::new(quadrant.x / d, quadrant.y / b).extend(0.0);
        let diagonal = quadrant.extend(0.0) * 0.5f64.sqrt();
        // The neighbour across x = 0.
        let neighbour = Beyond::Cell(index ^ 1);
        let face = |normal: DVec3, offset: f64, beyond: Beyond| {
            Face::new(Plane { normal, offset }, beyond)
        };
        let mut faces = vec![
            face(diagonal, d * 0.5f64.sqrt(), Beyond::Air),
            face(-inner.normalize(), -inner.length_recip(), core),
            face(DVec3::new(-quadrant.x, 0.0, 0.0), 0.0, neighbour),
        ];
        let (from, to) = (usize::from(index), (usize::from(index) + 1) % 4);
        skin.push(Skin::Wall {
            wall: Wall::new(square[from], square[to], extent),
            beyond: Beyond::Cell(index),
            finish: Finish::Bare,
        });
        if open_core {
            // Met from within the core.
            skin.push(Skin::Wall {
                wall: Wall::new(rhombus[to], rhombus[from], extent),
                beyond: Beyond::Cell(index),
                finish: Finish::Bare,
            });
        }
        let tip = if quadrant.y > 0.0 { square[1] } else { square[3] };
        let side = if quadrant.x > 0.0 { square[0] } else { square[2] };
        let blunt = if quadrant.y > 0.0 { rhombus[1] } else { rhombus[3] };
        let mut triangle = vec![side, tip, blunt];
        if (tip - side).perp_dot(blunt - side) < 0.0 {
            triangle.reverse();
        }
        let outline = Outline::new(triangle);
        if let Some(ends) = extent.ends() {
            for cap in Cap::both(&outline, ends) {
                faces.push(face(cap.normal, cap.z * cap.normal.z, Beyond::Air));
                skin.push(Skin::Cap { cap, beyond: Beyond::Cell(index), finish: Finish::Bare });
            }
        }
        segments.push(Solid::Prism { outline, extent });
        cells.push(Cell::Prism(Prism { medium, faces }));
    }
    if open_core {
        let filled = Solid::Prism { outline: Outline::new(square.to_vec()), extent };
        let hull = Hull::of_parts(segments).with_open_core(filled);
        return Ok(Structure { cells, skin, hull });
    }
    if let Some(ends) = extent.ends() {
        let hole = Outline::new(rhombus.to_vec());
        skin.extend(Cap::both(&hole, ends).map(|cap| Skin::Cap {
            cap,
            beyond: Beyond::Conductor,
            finish: Finish::Bare,
        }));
    }
    let hull = Hull::prism(Outline::new(square.to_vec()), extent);
    Ok(Structure { cells, skin, hull })
}

/// What the segments are made of.
struct Recipe {
    material: Material,
    /// The tensor in the quadrant x, y > 0, unless it is given by its principal values.
    exact: Option<StripToRhombus>,
    /// Principal values along u, v and z.
    principal: DVec3,
    /// From x to u in the quadrant x, y > 0, degrees.
    angle: f64,
}

enum Material {
    ImpedanceMatched,
    PositiveUniaxial,
    NegativeUniaxial,
}

impl Recipe {
    fn new(values: &Values, map: &StripToRhombus) -> Self {
        let material = match values.choice("material") {
            "positive-uniaxial" => Material::PositiveUniaxial,
            "negative-uniaxial" => Material::NegativeUniaxial,
            _ => Material::ImpedanceMatched,
        };
        if values.flag("rounded") {
            // As printed in the paper.
            let principal = DVec3::new(3.27, 0.31, 2.366);
            return Self { material, exact: None, principal, angle: -33.54 };
        }
        let (principal, angle) = map.principal_values();
        Self { material, exact: Some(*map), principal, angle }
    }

    /// The medium of one segment.
    fn medium(&self, quadrant: DVec2) -> Result<Medium, KeyError> {
        // u and v change sense from quadrant to quadrant.
        let turn = DMat3::from_rotation_z(self.angle.to_radians() * quadrant.x * quadrant.y);
        let (u, v) = (turn.x_axis, turn.y_axis);
        let DVec3 { x: along_u, y: along_v, z: along_z } = self.principal;
        match self.material {
            Material::ImpedanceMatched => {
                Medium::impedance_matched(self.exact.map_or_else(
                    || {
                        let m = turn * DMat3::from_diagonal(self.principal) * turn.transpose();
                        // Symmetric to the last bit.
                        (m + m.transpose()) * 0.5
                    },
                    |map| map.tensor(quadrant),
                ))
            }
            Material::PositiveUniaxial => Medium::uniaxial_magnetic(along_z, along_v, along_u, u),
            Material::NegativeUniaxial => Medium::uniaxial_magnetic(along_z, along_u, along_v, v),
        }
        .map_err(|error| KeyError::at("kappa", error.to_string()))
    }

    /// Principal values of permittivity and permeability along u, v and z.
    fn principal_values(&self) -> [DVec3; 2] {
        let DVec3 { x: along_u, y: along_v, z: along_z } = self.principal;
        let scalar = DVec3::splat(along_z);
        match self.material {
            Material::ImpedanceMatched => [self.principal; 2],
            Material::PositiveUniaxial => [scalar, DVec3::new(along_u, along_v, along_v)],
            Material::NegativeUniaxial => [scalar, DVec3::new(along_u, along_v, along_u)],
        }
    }
}

fn facts(values: &Values) -> Vec<Fact> {
    let map = map(values);
    let (d, b) = (map.half_diagonal(), map.half_height());
    let recipe = Recipe::new(values, &map);
    let [permittivity, permeability] = recipe.principal_values();
    vec![
        Fact::number("cloaked_area_cm2", 2.0 * d * b),
        Fact::number("rhombus_side_cm", d.hypot(b)),
        Fact::number("mirror_width_cm", 2.0 * d),
        Fact::numbers("permittivity_principal_values", permittivity.to_array()),
        Fact::numbers("permeability_principal_values", permeability.to_array()),
        Fact::number("axis_u_angle_deg", recipe.angle),
    ]
}
