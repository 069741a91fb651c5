//! A sphere that turns every ray by one angle (Hannay & Haeusser, J. Mod. Opt. 40, 1437 (1993)).

use super::round::{ball, lens_alone};
use super::{Device, Fact, Request, Structure};
use crate::keys::{KeyError, ValueRange};
use optics::propagation::{CentralLens, RadialFlow};

crate::table! {
    /// A ball of graded index that turns every ray that meets it by the same angle towards its
    /// centre: 90 degrees by default. Hannay & Haeusser 1993.
    pub struct BendingSphere {
        /// Radius of the ball.
        radius: f64 = 10.0, "cm", in ValueRange::LENGTH,
        /// By how much each ray is turned; 180 is Eaton's lens and 360 the invisible sphere.
        angle: f64 = 90.0, "degrees", in ValueRange::Within(0.0, 720.0),
    }
}

impl BendingSphere {
    fn lens(&self) -> CentralLens {
        CentralLens::eaton(self.radius, self.angle.to_radians())
    }
}

impl Device for BendingSphere {
    const KIND: &'static str = "bending-sphere";
    const TITLE: &'static str = "Bending sphere";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        lens_alone(request)?;
        Ok(ball(self.radius, RadialFlow::Lens(self.lens()), None))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        let (radius, angle) = (self.radius, self.angle);
        vec![
            Fact::number("index_min", 1.0),
            Fact::number("index_at_half_radius", self.lens().index(radius / 2.0)),
            Fact::number("bending_angle_deg", angle),
            Fact::number("optical_path_beyond_chord_cm", angle.to_radians() * radius),
        ]
    }
}
