//! An ideal polarizer: a sheet that passes the field along its axis and absorbs the rest.

use super::{Device, Fact, FarSide, Hull, Request, Shape, Structure, Surface};
use crate::keys::{KeyError, ValueRange};
use glam::{DVec2, DVec3};
use optics::geometry::{Extent, Outline, Solid, Wall};

crate::table! {
    /// An ideal polarizer: a sheet across x that passes the part of the electric field along its
    /// axis, projected across the ray, and absorbs the rest, without reflection and without
    /// thickness. It stands in air.
    pub struct Polarizer {
        /// Width along y.
        width: f64 = 20.0, "cm", in ValueRange::LENGTH,
        /// Where its axis points: at 0 along z, what a camera that looks along x calls horizontal,
        /// at 90 along y. The same angle as that of the camera's polarizer.
        angle: f64, "degrees", in ValueRange::ANGLE,
    }
}

impl Polarizer {
    /// The unit vector along which light passes.
    fn axis(&self) -> DVec3 {
        let (sin, cos) = self.angle.to_radians().sin_cos();
        DVec3::new(0.0, sin, cos)
    }
}

impl Device for Polarizer {
    const KIND: &'static str = "polarizer";
    const TITLE: &'static str = "Polarizer";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        super::refuse_other_views(request, "a polarizer is no cloak")?;
        let extent = Extent::centred(request.length);
        let corners = [-0.5, 0.5].map(|side| DVec2::new(0.0, side * self.width));
        let wall = Wall::new(corners[0], corners[1], extent);
        let shape = Shape::Polarizer { wall, axis: self.axis() };
        let outline = Outline { corners: corners.to_vec() };
        let hull = Hull::of_parts(vec![Solid::Prism { outline, extent }]);
        Ok(Structure::new(Vec::new(), vec![Surface::new(shape, FarSide::Polarizer)], hull))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        vec![Fact::numbers("passes_along", self.axis().to_array())]
    }
}
