//! A plane mirror.

use super::{Device, Fact, Hull, Request, Structure, Surface};
use crate::key;
use crate::keys::{KeyError, ValueRange};
use glam::DVec2;
use optics::geometry::{Extent, Outline, Solid, Wall};

crate::table! {
    /// A plane mirror: a rectangle without thickness across its own x axis, a mirror on both sides.
    /// It is perfect, or of the `metal` that it is given; layers of a `coating` are on both sides,
    /// too.
    pub struct PlaneMirror {
        /// Its size along z, which a camera that looks along x calls horizontal.
        width: f64 = 20.0, "cm", in ValueRange::LENGTH,
        /// Its size along y.
        height: f64 = 20.0, "cm", in ValueRange::LENGTH,
    }
}

impl Device for PlaneMirror {
    const KIND: &'static str = "mirror";
    const TITLE: &'static str = "Plane mirror";

    fn structure(&self, request: Request) -> Result<Structure, KeyError> {
        super::refuse_other_views(request, "a plane mirror is no cloak")?;
        let message = "length is given; a plane mirror has its `width` and `height`";
        KeyError::refuse_if(request.length.is_some(), key!(Request.length), message)?;
        let extent = Extent::centred(Some(self.width));
        let corners = [-0.5, 0.5].map(|side| DVec2::new(0.0, side * self.height));
        let wall = Wall::new(corners[0], corners[1], extent);
        let outline = Outline { corners: corners.to_vec() };
        let hull = Hull::of_parts(vec![Solid::Prism { outline, extent }]);
        Ok(Structure::new(Vec::new(), vec![Surface::mirror(wall)], hull))
    }

    fn facts(&self, _: Request) -> Vec<Fact> {
        vec![Fact::number("area_cm2", self.width * self.height)]
    }
}
