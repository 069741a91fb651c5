//! The bodies of a scene at their places, which may overlap: what is where, and where rays cross from one into
//! another.

use super::Placed;
use crate::device::{Body, Filling};
use glam::DVec3;
use optics::geometry::Pose;
use optics::medium::Medium;

/// The most bodies a scene may have: a ray keeps track of those around it in the bits of one word.
pub const MOST_BODIES: usize = 64;

/// Surfaces that a ray crosses within this distance are one surface, cm.
pub(super) const ONE_SURFACE: f64 = 1e-9;

/// The bodies around a point, one bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Around(u64);

impl Around {
    pub fn nothing(self) -> bool {
        self.0 == 0
    }

    fn holds(self, index: usize) -> bool {
        self.0 >> index & 1 == 1
    }

    fn with(self, index: usize) -> Self {
        Self(self.0 | 1 << index)
    }

    /// The bodies on the other side of a surface of these.
    fn crossed(self, surface: Self) -> Self {
        Self(self.0 ^ surface.0)
    }
}

/// A body at its place.
#[derive(Clone, Debug)]
pub(super) struct PlacedBody {
    /// Its number among the devices of the scene.
    pub device: u16,
    pose: Pose,
    body: Body,
    /// What fills it, turned into the world's frame.
    filling: Filling,
}

/// All bodies of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Bodies {
    bodies: Vec<PlacedBody>,
}

/// Where a ray crosses the surface of a body, or of several at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// How far along the ray, cm.
    pub distance: f64,
    /// Unit normal of the surface, along the ray.
    pub onward: DVec3,
    /// The first of the bodies whose surface it is.
    pub body: usize,
    surface: Around,
}

/// What is on one side of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Inside<'a> {
    /// No body: air.
    Air,
    /// A medium with its group index, if one is given.
    Medium(&'a Medium, Option<f64>),
    /// An opaque body, by its number among the devices.
    Opaque(u16),
}

impl Bodies {
    /// The bodies among the devices; the first [`MOST_BODIES`] of them.
    pub fn of(devices: &[Placed]) -> Self {
        let body = |(device, placed): (u16, &Placed)| {
            let body = placed.structure.hull.body()?.clone();
            let filling = turned(&body.filling, &placed.pose);
            Some(PlacedBody { device, pose: placed.pose, body, filling })
        };
        Self { bodies: (0u16..).zip(devices).filter_map(body).take(MOST_BODIES).collect() }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// The nearest surface that a ray crosses, `around` being the bodies that it is in.
    pub fn crossing(&self, around: Around, origin: DVec3, direction: DVec3) -> Option<Crossing> {
        let mut nearest: Option<Crossing> = None;
        for (index, placed) in self.bodies.iter().enumerate() {
            let (o, d) = (placed.pose.to_local(origin), placed.pose.vector_to_local(direction));
            let inside = around.holds(index);
            let shape = &placed.body.shape;
            let hit = if inside { shape.exit(o, d) } else { shape.entry(o, d) };
            let Some((distance, outward)) = hit else { continue };
            let outward = placed.pose.vector_to_world(outward);
            let onward = if inside { outward } else { -outward };
            let surface = Around::default().with(index);
            let crossing = Crossing { distance, onward, body: index, surface };
            nearest = Some(match nearest {
                Some(least) if distance > least.distance + ONE_SURFACE => least,
                Some(least) if distance >= least.distance - ONE_SURFACE => {
                    Crossing { surface: least.surface.with(index), ..least }
                }
                _ => crossing,
            });
        }
        nearest
    }

    /// The bodies beyond a crossing.
    pub fn beyond(around: Around, crossing: &Crossing) -> Around {
        around.crossed(crossing.surface)
    }

    /// What is where the given bodies are: the one of the largest priority.
    pub fn inside(&self, around: Around) -> Inside<'_> {
        let there = self.bodies.iter().enumerate().filter(|(index, _)| around.holds(*index));
        match there.max_by_key(|(_, placed)| placed.body.priority).map(|(_, placed)| placed) {
            None => Inside::Air,
            Some(PlacedBody { filling: Filling::Medium { medium, group_index }, .. }) => {
                Inside::Medium(medium, *group_index)
            }
            Some(placed) => Inside::Opaque(placed.device),
        }
    }
}

/// A filling in the world's frame.
fn turned(filling: &Filling, pose: &Pose) -> Filling {
    let Filling::Medium { medium, group_index } = filling else { return filling.clone() };
    let turn = pose.rotation();
    let (permittivity, permeability) = medium.tensors();
    // A medium stays one when it is turned.
    let medium =
        Medium::new(permittivity.turned(&turn), permeability.turned(&turn)).unwrap_or(*medium);
    Filling::Medium { medium, group_index: *group_index }
}
