//! The spherical cloak (Pendry, Schurig & Smith, Science 312, 1780 (2006)).

use super::round::{OUTER_KEY, ball, hollow_ball, inner_key, metal_ball, no_length, radii};
use super::{Entry, Fact, Request, Show, Structure};
use crate::keys::{KeyError, Values};
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
    keys: &[inner_key("Radius of the metal ball; below outer."), OUTER_KEY],
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
        Fact::principal_values("border_tensor_principal_values", &tensor),
        Fact::number("time_of_flight_difference_ns", 0.0),
    ]
}
