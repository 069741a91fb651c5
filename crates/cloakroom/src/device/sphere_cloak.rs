//! The spherical cloak (Pendry, Schurig & Smith, Science 312, 1780 (2006)).

use super::round::{ball, hollow_ball, metal_ball, no_length, radii};
use super::{Entry, Fact, FactValue, Request, Show, Structure};
use crate::keys::{Key, KeyError, KeyKind, Limits, Values};
use glam::DVec3;
use optics::geometry::Extent;
use optics::propagation::{RadialFlow, TransformedShell};
use optics::transformation::{RadialMap, Symmetry};
use std::f64::consts::PI;

pub(super) static ENTRY: Entry = Entry {
    kind: "sphere-cloak",
    title: "Spherical cloak",
    summary: "Impedance-matched shell around a metal ball, perfect for every direction, polarization and \
              time of flight. Pendry, Schurig & Smith 2006.",
    keys: &[
        Key {
            name: "inner",
            doc: "Radius of the metal ball; below outer.",
            kind: KeyKind::Number { default: Some(4.0), unit: "cm", limits: Limits::Positive },
        },
        Key {
            name: "outer",
            doc: "Radius of the cloak.",
            kind: KeyKind::Number { default: Some(10.0), unit: "cm", limits: Limits::Positive },
        },
    ],
    build,
    facts,
};

fn build(values: &Values, request: Request) -> Result<Structure, KeyError> {
    no_length(request)?;
    let (inner, outer) = radii(values)?;
    Ok(match request.show {
        Show::Cloak => {
            let map = RadialMap::new(inner, outer, Symmetry::Centre);
            let shell = TransformedShell::new(map, Extent::ENDLESS);
            let flow = RadialFlow::Transformed(shell);
            if request.open_core { hollow_ball(inner, outer, flow) } else { ball(outer, flow) }
        }
        Show::Bare => metal_ball(inner),
        Show::Mirror => Structure::empty(),
    })
}

fn facts(values: &Values) -> Vec<Fact> {
    let Ok((inner, outer)) = radii(values) else { return Vec::new() };
    let map = RadialMap::new(inner, outer, Symmetry::Centre);
    let tensor = map.tensor(DVec3::X * outer);
    vec![
        Fact::number("cloaked_volume_cm3", 4.0 / 3.0 * PI * inner.powi(3)),
        Fact {
            name: "border_tensor_principal_values",
            value: FactValue::Numbers(vec![tensor.x_axis.x, tensor.y_axis.y, tensor.z_axis.z]),
        },
        Fact::number("time_of_flight_difference_ns", 0.0),
    ]
}
