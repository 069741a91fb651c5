//! Everything in front of the camera, and what a ray meets there.

use glam::Vec3;

use crate::hair;
use crate::hierarchy::Hierarchy;
use crate::materials::{Surface, surface};
use crate::person::Person;
use crate::room;
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
    room: Option<Room>,
}

/// What the panorama shows besides.
#[derive(Debug)]
struct Room {
    furniture: Hierarchy,
    /// Walls, floor and ceiling, which light comes through.
    shell: Hierarchy,
}

impl Scene {
    /// Builds what the photograph shows.
    pub fn new(detail: Detail) -> Self {
        let mut shapes = Vec::new();
        shelf::furnish(&mut shapes);
        hair::grow(detail.hair, &mut shapes);
        Self { solids: Hierarchy::new(shapes), person: Person::new(detail.cell), room: None }
    }

    /// Builds the whole room.
    pub fn with_room(detail: Detail) -> Self {
        let furniture = Hierarchy::new(room::furniture());
        let room = Room { furniture, shell: Hierarchy::new(room::shell()) };
        Self { room: Some(room), ..Self::new(detail) }
    }

    /// Whether this is the whole room.
    pub fn has_room(&self) -> bool {
        self.room.is_some()
    }

    /// What the camera sees along the ray.
    pub fn see(&self, ray: &Ray, reach: f32) -> Option<Surface> {
        let seen = self.meet(ray, reach);
        let Some(room) = &self.room else { return seen };
        let mut nearest = seen.map_or(reach, |s| (s.point - ray.origin).dot(ray.direction));
        let mut found = seen;
        for part in [&room.furniture, &room.shell] {
            if let Some((t, shape)) = part.meet(ray, nearest, false) {
                (nearest, found) = (t, Some(surface(shape, ray, t)));
            }
        }
        found
    }

    /// The furniture, as far as it matters for the light at a point: at what the photograph shows,
    /// light is as in the photograph, or one would see where it ends.
    fn furniture(&self, from: Vec3) -> Option<&Hierarchy> {
        self.room.as_ref().filter(|_| !room::in_photograph(from)).map(|room| &room.furniture)
    }

    /// The first surface that light comes from along a ray from `from`, the walls aside.
    pub fn meet_from(&self, from: Vec3, ray: &Ray, reach: f32) -> Option<Surface> {
        let met = self.meet(ray, reach);
        let Some(furniture) = self.furniture(from) else { return met };
        let nearest = met.map_or(reach, |s| (s.point - ray.origin).dot(ray.direction));
        furniture.meet(ray, nearest, false).map(|(t, shape)| surface(shape, ray, t)).or(met)
    }

    /// Whether anything but walls lies on the ray from `from` within `reach`.
    pub fn shaded(&self, from: Vec3, ray: &Ray, reach: f32) -> bool {
        self.blocked(ray, reach)
            || self
                .furniture(from)
                .is_some_and(|furniture| furniture.meet(ray, reach, true).is_some())
    }

    /// The first surface along the ray within `reach`.
    fn meet(&self, ray: &Ray, reach: f32) -> Option<Surface> {
        let person = self.person.enter(ray, reach);
        let solid = self.solids.meet(ray, person.unwrap_or(reach), false);
        match (solid, person) {
            (Some((t, shape)), _) => Some(surface(shape, ray, t)),
            (None, Some(t)) => Some(self.person.surface(ray, t)),
            (None, None) => None,
        }
    }

    /// Whether anything lies on the ray within `reach`.
    fn blocked(&self, ray: &Ray, reach: f32) -> bool {
        self.person.enter(ray, reach).is_some() || self.solids.meet(ray, reach, true).is_some()
    }
}
