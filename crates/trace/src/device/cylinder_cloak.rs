//! The cylindrical cloak, impedance matched (Pendry, Schurig & Smith, Science 312, 1780 (2006);
//! Schurig et al., Science 314, 977 (2006)) or of a uniaxial dielectric (after Cai et al., Nature
//! Photon. 1, 224 (2007)).

use super::round::{check_radii, metal_cylinder, tube};
use super::{Device, Fact, Request, Show, Structure};
use crate::key;
use crate::keys::{KeyError, ValueRange};
use glam::DVec3;
use optics::geometry::Extent;
use optics::propagation::{OpticAxis, RadialFlow, TransformedShell, UniaxialCylinder};
use optics::transformation::{RadialMap, Symmetry};
use std::f64::consts::PI;

crate::choice! {
    /// What the shell of a [`CylinderCloak`] is made of.
    pub enum ShellMaterial {
        /// eps = mu.
        ImpedanceMatched = "impedance-matched",
        /// A uniaxial dielectric with its optic axis along the radius.
        RadialUniaxial = "radial-uniaxial",
        /// A uniaxial dielectric with its optic axis around the cylinder.
        AzimuthalUniaxial = "azimuthal-uniaxial",
    }
}

crate::table! {
    /// Shell around a metal cylinder along z. Impedance matched it is perfect in three dimensions;
    /// of a uniaxial dielectric it guides vertically polarized light in the plane across it, and
    /// reflects at its border. Pendry, Schurig & Smith 2006, Cai et al. 2007.
    pub struct CylinderCloak {
        /// Radius of the metal cylinder; below outer.
        inner: f64 = 4.0, "cm", in ValueRange::LENGTH,
        /// Radius of the cloak.
        outer: f64 = 10.0, "cm", in ValueRange::LENGTH,
        /// What the shell is made of: eps = mu, or a uniaxial dielectric with its optic axis along
        /// the radius or around the cylinder.
        material: ShellMaterial,
    }
}

impl CylinderCloak {
    /// The radii of the core and of the border.
    fn radii(&self) -> Result<(f64, f64), KeyError> {
        check_radii(key!(Self.inner), self.inner, self.outer)?;
        Ok((self.inner, self.outer))
    }

    /// The optic axis, if it has one.
    fn optic_axis(&self) -> Option<OpticAxis> {
        match self.material {
            ShellMaterial::ImpedanceMatched => None,
            ShellMaterial::RadialUniaxial => Some(OpticAxis::Radial),
            ShellMaterial::AzimuthalUniaxial => Some(OpticAxis::Azimuthal),
        }
    }
}

impl Device for CylinderCloak {
    const KIND: &'static str = "cylinder-cloak";
    const TITLE: &'static str = "Cylindrical cloak";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        let (inner, outer) = self.radii()?;
        let extent = Extent::centred(request.length);
        Ok(match request.show {
            Show::Cloak => {
                let flow = match self.optic_axis() {
                    None => {
                        let map = RadialMap::new(inner, outer, Symmetry::Axis);
                        RadialFlow::Transformed(TransformedShell { map, extent })
                    }
                    Some(axis) => {
                        RadialFlow::Uniaxial(UniaxialCylinder::new(inner, outer, axis, extent))
                    }
                };
                tube(inner, outer, extent, flow, request.has_open_core())
            }
            Show::Bare => metal_cylinder(inner, extent),
            Show::Mirror | Show::Empty => Structure::empty(),
        })
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let Ok((inner, outer)) = self.radii() else { return Vec::new() };
        let border = DVec3::X * outer;
        let mut facts = vec![Fact::number("cloaked_area_cm2", PI * inner * inner)];
        match self.optic_axis() {
            None => {
                let tensor = RadialMap::new(inner, outer, Symmetry::Axis).tensor(border);
                facts.push(Fact::principal_values("border_tensor_principal_values", &tensor));
                facts.push(Fact::number("time_of_flight_difference_ns", 0.0));
            }
            Some(axis) => {
                let shell = UniaxialCylinder::new(inner, outer, axis, Extent::ENDLESS);
                if let Some(medium) = shell.medium(border) {
                    let name = "border_permittivity_principal_values";
                    facts.push(Fact::principal_values(name, medium.permittivity()));
                }
                let reflectance = (inner / (2.0 * outer - inner)).powi(2);
                facts.push(Fact::number("normal_reflectance_vertical", reflectance));
            }
        }
        facts
    }
}
