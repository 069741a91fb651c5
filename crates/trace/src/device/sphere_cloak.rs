//! The spherical cloak (Pendry, Schurig & Smith, Science 312, 1780 (2006)).

use super::round::{ball, check_radii, metal_ball, no_length};
use super::{Device, Fact, Request, Show, Structure};
use crate::key;
use crate::keys::{KeyError, ValueRange};
use glam::DVec3;
use optics::geometry::Extent;
use optics::propagation::{RadialFlow, TransformedShell};
use optics::transformation::{RadialMap, Symmetry};
use std::f64::consts::PI;

crate::table! {
    /// Impedance-matched shell around a metal ball, perfect for every direction, polarization and
    /// time of flight. Pendry, Schurig & Smith 2006.
    pub struct SphereCloak {
        /// Radius of the metal ball; below outer.
        inner: f64 = 4.0, "cm", in ValueRange::LENGTH,
        /// Radius of the cloak.
        outer: f64 = 10.0, "cm", in ValueRange::LENGTH,
    }
}

impl SphereCloak {
    fn map(&self) -> Result<RadialMap, KeyError> {
        check_radii(key!(Self.inner), self.inner, self.outer)?;
        Ok(RadialMap::new(self.inner, self.outer, Symmetry::Centre))
    }
}

impl Device for SphereCloak {
    const KIND: &'static str = "sphere-cloak";
    const TITLE: &'static str = "Spherical cloak";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        no_length(request)?;
        let map = self.map()?;
        Ok(match request.show {
            Show::Cloak => {
                let flow =
                    RadialFlow::Transformed(TransformedShell { map, extent: Extent::ENDLESS });
                ball(self.outer, flow, request.has_open_core().then_some(self.inner))
            }
            Show::Bare => metal_ball(self.inner),
            Show::Mirror | Show::Empty => Structure::empty(),
        })
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let Ok(map) = self.map() else { return Vec::new() };
        let tensor = map.tensor(DVec3::X * self.outer);
        vec![
            Fact::number("cloaked_volume_cm3", 4.0 / 3.0 * PI * self.inner.powi(3)),
            Fact::principal_values("border_tensor_principal_values", &tensor),
            Fact::number("time_of_flight_difference_ns", 0.0),
        ]
    }
}
