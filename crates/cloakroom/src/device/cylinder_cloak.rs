//! The cylindrical cloak, impedance matched (Pendry, Schurig & Smith, Science 312, 1780 (2006); Schurig et
//! al., Science 314, 977 (2006)) or of a uniaxial dielectric (after Cai et al., Nature Photon. 1, 224 (2007)).

use super::round::{OUTER_KEY, hollow_tube, inner_key, metal_cylinder, radii, tube};
use super::{Entry, Fact, Request, Show, Structure};
use crate::keys::{Key, KeyError, KeyKind, Values};
use glam::DVec3;
use optics::geometry::Extent;
use optics::propagation::{OpticAxis, RadialFlow, TransformedShell, UniaxialCylinder};
use optics::transformation::{RadialMap, Symmetry};
use std::f64::consts::PI;

pub(super) static ENTRY: Entry = Entry {
    kind: "cylinder-cloak",
    title: "Cylindrical cloak",
    summary: "Shell around a metal cylinder along z. Impedance matched it is perfect in three dimensions; of \
              a uniaxial dielectric it guides vertically polarized light in the plane across it, \
              and reflects at its border. Pendry, Schurig & Smith 2006, Cai et al. 2007.",
    keys: &[
        inner_key("Radius of the metal cylinder; below outer."),
        OUTER_KEY,
        Key {
            name: "material",
            doc: "What the shell is made of: eps = mu, or a uniaxial dielectric with its optic axis along \
                  the radius or around the cylinder.",
            kind: KeyKind::Choice {
                options: &["impedance-matched", "radial-uniaxial", "azimuthal-uniaxial"],
            },
        },
    ],
    build,
    facts,
};

/// The optic axis, if it has one.
fn optic_axis(values: &Values) -> Option<OpticAxis> {
    match values.choice("material") {
        "radial-uniaxial" => Some(OpticAxis::Radial),
        "azimuthal-uniaxial" => Some(OpticAxis::Azimuthal),
        _ => None,
    }
}

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    let (inner, outer) = radii(values)?;
    let extent = Extent::centred(request.length);
    Ok(match request.show {
        Show::Cloak => {
            let flow = match optic_axis(values) {
                None => {
                    let map = RadialMap::new(inner, outer, Symmetry::Axis);
                    RadialFlow::Transformed(TransformedShell::new(map, extent))
                }
                Some(axis) => {
                    RadialFlow::Uniaxial(UniaxialCylinder::new(inner, outer, axis, extent))
                }
            };
            let shell = if request.open_core { hollow_tube } else { tube };
            shell(inner, outer, extent, flow)
        }
        Show::Bare => metal_cylinder(inner, extent),
        Show::Mirror => Structure::empty(),
    })
}

fn facts(values: &Values) -> Vec<Fact> {
    let Ok((inner, outer)) = radii(values) else { return Vec::new() };
    let border = DVec3::X * outer;
    let area = Fact::number("cloaked_area_cm2", PI * inner * inner);
    match optic_axis(values) {
        None => {
            let tensor = RadialMap::new(inner, outer, Symmetry::Axis).tensor(border);
            vec![
                area,
                Fact::principal_values("border_tensor_principal_values", &tensor),
                Fact::number("time_of_flight_difference_ns", 0.0),
            ]
        }
        Some(axis) => {
            let shell = UniaxialCylinder::new(inner, outer, axis, Extent::ENDLESS);
            let mut facts = vec![area];
            if let Some(medium) = shell.medium(border) {
                let name = "border_permittivity_principal_values";
                facts.push(Fact::principal_values(name, medium.permittivity()));
            }
            let reflectance = (inner / (2.0 * outer - inner)).powi(2);
            facts.push(Fact::number("normal_reflectance_vertical", reflectance));
            facts
        }
    }
}
