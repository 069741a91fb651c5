//! Everything in front of the camera, and what a ray meets there.

use crate::hair;
use crate::hierarchy::Hierarchy;
use crate::materials::{Surface, surface};
use crate::person::Person;
use crate::shapes::Ray;
use crate::shelf;

/// How finely the scene is built.
#[derive(Debug, Clone, Copy)]
pub struct Detail {
    /// Cell size of the person's distance grid, in centimetres.
    pub cell: f32,
    /// Share of the hairs that is grown.
    pub hair: f32,
}

impl Detail {
    /// For the finished picture.
    pub const FINE: Self = Self { cell: 0.3, hair: 1.0 };
    /// For tests.
    #[cfg(test)]
    pub const COARSE: Self = Self { cell: 1.5, hair: 0.05 };
}

/// The shelf, the room and the person.
#[derive(Debug)]
pub struct Scene {
    solids: Hierarchy,
    person: Person,
}

impl Scene {
    /// Builds the scene.
    pub fn new(detail: Detail) -> Self {
        let mut shapes = Vec::new();
        shelf::furnish(&mut shapes);
        hair::grow(detail.hair, &mut shapes);
        Self { solids: Hierarchy::new(shapes), person: Person::new(detail.cell) }
    }

    /// The first surface along the ray within `reach`.
    pub fn meet(&self, ray: &Ray, reach: f32) -> Option<Surface> {
        let person = self.person.enter(ray, reach);
        let solid = self.solids.meet(ray, person.unwrap_or(reach), false);
        match (solid, person) {
            (Some((t, shape)), _) => Some(surface(shape, ray, t)),
            (None, Some(t)) => Some(self.person.surface(ray, t)),
            (None, None) => None,
        }
    }

    /// Whether anything lies on the ray within `reach`.
    pub fn blocked(&self, ray: &Ray, reach: f32) -> bool {
        self.person.enter(ray, reach).is_some() || self.solids.meet(ray, reach, true).is_some()
    }
}
