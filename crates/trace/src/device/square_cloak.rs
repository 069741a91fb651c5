//! The square cloak of homogeneous anisotropic segments (Landy & Smith, Nature Mater. 12, 25
//! (2013); designs (i)-(iii) of Halimeh & Wegener, Opt. Express 21, 9457 (2013)).
//!
//! A square standing on its corner around a metal rhombus; the space between is four triangles,
//! each filled with one homogeneous medium. The map behind it is
//! [`optics::transformation::StripToRhombus`].

use super::polygons::{PolygonPart, polygonal};
use super::{Device, Fact, Hull, Request, Show, Structure};
use crate::key;
use crate::keys::{KeyError, ValueRange};
use glam::{DMat3, DVec2, DVec3};
use optics::geometry::{Extent, Outline, Polygon, SAME_POINT, Solid};
use optics::medium::{Medium, Tensor};
use optics::transformation::StripToRhombus;

crate::choice! {
    /// What the segments of a [`SquareCloak`] are made of.
    pub enum SegmentMaterial {
        /// eps = mu, for every polarization.
        ImpedanceMatched = "impedance-matched",
        /// A scalar eps and a positive uniaxial mu.
        PositiveUniaxial = "positive-uniaxial",
        /// A scalar eps and a negative uniaxial mu.
        NegativeUniaxial = "negative-uniaxial",
    }
}

crate::table! {
    /// Unidirectional cloak of four homogeneous anisotropic segments around a metal rhombus; seen
    /// along x it is invisible, turned it is a flat mirror. Landy & Smith 2013, designs (i)-(iii)
    /// of Halimeh & Wegener 2013.
    pub struct SquareCloak {
        /// What the segments are made of: eps = mu, design (iii), or a scalar eps and a uniaxial
        /// mu, positive (i) or negative (ii), which cloak horizontal polarization only.
        material: SegmentMaterial,
        /// Side of the square.
        side: f64 = 14.1, "cm", in ValueRange::LENGTH,
        /// Ratio of the rhombus's diagonals; 1/sqrt(3) gives corners of 60 and 120 degrees.
        // Beyond the limits, the tensors are too lopsided for double precision.
        kappa: f64 = 0.577_350_269_189_625_8, in ValueRange::Within(0.001, 0.999),
        /// Use the paper's rounded material values 3.27, 0.31, 2.366 and 33.54 degrees instead of
        /// the exact ones.
        rounded: bool,
    }
}

impl Device for SquareCloak {
    const KIND: &'static str = "square-cloak";
    const TITLE: &'static str = "Square cloak";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        let map = self.map();
        let extent = Extent::centred(request.length);
        match request.show {
            Show::Cloak => {
                square(&map, Some(&Recipe::new(self, &map)), extent, request.has_open_core())
            }
            Show::Bare => square(&map, None, extent, false),
            Show::Mirror => Ok(super::flat_strip(map.half_diagonal, extent)),
            Show::Empty => Ok(Structure::empty()),
        }
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let map = self.map();
        let (d, b) = (map.half_diagonal, map.half_height());
        let recipe = Recipe::new(self, &map);
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
}

impl SquareCloak {
    fn map(&self) -> StripToRhombus {
        StripToRhombus::new(self.side * 0.5f64.sqrt(), self.kappa)
    }
}

/// The signs of x and y in the four quadrants, counterclockwise.
const QUADRANTS: [DVec2; 4] =
    [DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0), DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0)];

/// The corners of the square or the rhombus, counterclockwise from +x.
fn corners(half_width: f64, half_height: f64) -> [DVec2; 4] {
    [(half_width, 0.0), (0.0, half_height), (-half_width, 0.0), (0.0, -half_height)]
        .map(DVec2::from)
}

/// The square with its segments and the rhombus in it, metal or open, or the rhombus alone.
fn square(
    map: &StripToRhombus,
    recipe: Option<&Recipe>,
    extent: Extent,
    open_core: bool,
) -> Result<Structure, KeyError> {
    let (d, b) = (map.half_diagonal, map.half_height());
    let (square, rhombus) = (corners(d, d), corners(d, b));
    let of_kappa = |error: String| KeyError::at(key!(SquareCloak.kappa), error);
    let part = |corners: &[DVec2], medium| {
        let polygon = Polygon::new(corners).map_err(|error| of_kappa(error.to_string()))?;
        Ok(PolygonPart::new(polygon, medium))
    };
    let mut parts = Vec::new();
    for (i, quadrant) in QUADRANTS.into_iter().enumerate() {
        let Some(recipe) = recipe else { break };
        let next = (i + 1) % 4;
        // Two corners of the square, and the one of the rhombus on the y axis.
        let blunt = if i % 2 == 0 { rhombus[next] } else { rhombus[i] };
        parts.push(part(&[square[i], square[next], blunt], Some(recipe.medium(quadrant)?))?);
    }
    if !open_core {
        parts.push(part(&rhombus, None)?);
    }
    let structure = polygonal(&parts, extent, SAME_POINT)
        .map_err(|_| of_kappa("the segments overlap by rounding".to_owned()))?;
    let outline = Outline { corners: if recipe.is_some() { square } else { rhombus }.to_vec() };
    let whole = Solid::Prism { outline, extent };
    let hull =
        if open_core { Hull { filled: Some(whole), ..structure.hull } } else { Hull::new(whole) };
    Ok(Structure { hull, ..structure })
}

/// What the segments are made of.
struct Recipe {
    material: SegmentMaterial,
    /// The tensor in the quadrant x, y > 0, unless it is given by its principal values.
    exact: Option<StripToRhombus>,
    /// Principal values along u, v and z.
    principal: DVec3,
    /// From x to u in the quadrant x, y > 0, degrees.
    angle: f64,
}

impl Recipe {
    fn new(cloak: &SquareCloak, map: &StripToRhombus) -> Self {
        let material = cloak.material;
        if cloak.rounded {
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
            SegmentMaterial::ImpedanceMatched => {
                let principal = Tensor::from(DMat3::from_diagonal(self.principal));
                let exact = self.exact.map(|map| map.tensor(quadrant));
                Medium::impedance_matched(exact.unwrap_or_else(|| principal.turned(&turn).re))
            }
            SegmentMaterial::PositiveUniaxial => {
                Medium::uniaxial_magnetic(along_z, along_v, along_u, u)
            }
            SegmentMaterial::NegativeUniaxial => {
                Medium::uniaxial_magnetic(along_z, along_u, along_v, v)
            }
        }
        .map_err(|error| KeyError::at(key!(SquareCloak.kappa), error.to_string()))
    }

    /// Principal values of permittivity and permeability along u, v and z.
    fn principal_values(&self) -> [DVec3; 2] {
        let DVec3 { x: along_u, y: along_v, z: along_z } = self.principal;
        let scalar = DVec3::splat(along_z);
        match self.material {
            SegmentMaterial::ImpedanceMatched => [self.principal; 2],
            SegmentMaterial::PositiveUniaxial => [scalar, DVec3::new(along_u, along_v, along_v)],
            SegmentMaterial::NegativeUniaxial => [scalar, DVec3::new(along_u, along_v, along_u)],
        }
    }
}
