//! The invisible sphere: every ray leaves it on its own line, late (Miñano, Opt. Express 14, 9627
//! (2006); made regular by transmutation, Tyc & Leonhardt, New J. Phys. 10, 115038 (2008)).

use super::round::{ball, lens_alone};
use super::{Device, Fact, Request, Structure};
use crate::keys::{KeyError, ValueRange};
use optics::propagation::{CentralLens, RadialFlow, TransmutedSphere};
use optics::wave::SPEED_OF_LIGHT;
use std::f64::consts::TAU;

crate::choice! {
    /// What an [`InvisibleSphere`] is made of.
    pub enum SphereMaterial {
        /// A graded index that is infinite at the centre.
        Graded = "graded",
        /// A uniaxial dielectric with its axis along the radius.
        Regularized = "regularized",
    }
}

crate::table! {
    /// A ball of graded index that every ray loops through once, to leave it on its own line, late
    /// by the ball's circumference; it hides nothing but itself. Minano 2006, regularized after Tyc
    /// & Leonhardt 2008.
    pub struct InvisibleSphere {
        /// Radius of the ball.
        radius: f64 = 10.0, "cm", in ValueRange::LENGTH,
        /// A graded index that is infinite at the centre, or its regularized form, a uniaxial
        /// dielectric with its axis along the radius: then the extraordinary wave sees the
        /// invisible sphere and the ordinary one a ball of glass.
        material: SphereMaterial,
    }
}

impl Device for InvisibleSphere {
    const KIND: &'static str = "invisible-sphere";
    const TITLE: &'static str = "Invisible sphere";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        lens_alone(request)?;
        let radius = self.radius;
        let flow = match self.material {
            SphereMaterial::Regularized => RadialFlow::Transmuted(TransmutedSphere::new(radius)),
            SphereMaterial::Graded => RadialFlow::Lens(CentralLens::eaton(radius, TAU)),
        };
        Ok(ball(radius, flow, None))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let radius = self.radius;
        let delay = Fact::number("time_of_flight_difference_ns", TAU * radius / SPEED_OF_LIGHT);
        if self.material == SphereMaterial::Regularized {
            let ordinary = TransmutedSphere::ORDINARY_INDEX;
            return vec![
                Fact::number("ordinary_index", ordinary),
                Fact::numbers(
                    "extraordinary_index_at_surface_and_centre",
                    [1.0, TransmutedSphere::CENTRAL_EXTRAORDINARY_INDEX],
                ),
                Fact::number("normal_reflectance", ((ordinary - 1.0) / (ordinary + 1.0)).powi(2)),
                delay,
            ];
        }
        let lens = CentralLens::eaton(radius, TAU);
        vec![
            Fact::number("index_min", 1.0),
            Fact::number("index_at_half_radius", lens.index(radius / 2.0)),
            delay,
        ]
    }
}
