//! Where the rays of a diagram come from.

use super::DiagramSettings;
use super::view::Scenery;
use cloakroom::scene::Scene;
use cloakroom::trace::Launch;
use glam::{DVec2, DVec3};
use optics::wave::transverse_basis;
use std::f64::consts::TAU;

/// Where rays come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// A bundle of parallel rays, all across the devices.
    Parallel {
        /// Their direction in the xy-plane, degrees from x, counterclockwise.
        degrees: f64,
    },
    /// A fan from a point, across the devices; all around if the point is among them.
    Point(DVec3),
    /// A fan from the scene's camera, over the height of its picture.
    Camera,
}

/// How much of a fan goes beside the devices.
const AROUND: f64 = 1.08;

impl Source {
    /// The rays, each with horizontal and vertical polarization, in order across the bundle.
    pub(super) fn launches(
        &self,
        scene: &Scene,
        settings: &DiagramSettings,
        scenery: &Scenery,
    ) -> Vec<Launch<2>> {
        let count = settings.rays;
        let layer = |k: u32| {
            let share = (f64::from(k) + 0.5) / f64::from(settings.layers) - 0.5;
            scenery.z + share * scenery.depth()
        };
        (0..settings.layers)
            .flat_map(|k| (0..count).map(move |i| (k, i)))
            .map(|(k, i)| {
                let share = (f64::from(i) + 0.5) / f64::from(count) - 0.5;
                let (origin, direction) = match *self {
                    Self::Parallel { degrees } => {
                        let along = DVec2::from_angle(degrees.to_radians());
                        let across = along.perp();
                        let width = settings.width.unwrap_or_else(|| scenery.width(across));
                        let from =
                            scenery.middle() - along * scenery.start() + across * width * share;
                        (from.extend(layer(k)), along.extend(0.0))
                    }
                    Self::Point(from) => {
                        let way = scenery.middle() - from.truncate();
                        let sine = AROUND * scenery.radius() / way.length();
                        let (toward, spread) = if sine < 1.0 {
                            (way.normalize(), 2.0 * sine.asin())
                        } else {
                            (DVec2::X, TAU)
                        };
                        let direction = DVec2::from_angle(share * spread).rotate(toward);
                        let rise = (layer(k) - from.z) / way.length().max(1e-9);
                        let rise = if settings.layers == 1 { 0.0 } else { rise };
                        (from, direction.extend(rise).normalize())
                    }
                    Self::Camera => {
                        let [width, height] = scene.camera.resolution.map(f64::from);
                        let column = (f64::from(k) + 0.5) / f64::from(settings.layers) * width;
                        let ray = scene.camera.ray(column, (0.5 - share) * height);
                        (ray.origin, ray.direction)
                    }
                };
                let (horizontal, vertical) = transverse_basis(direction, DVec3::Z, DVec3::X);
                Launch { origin, direction, electric: [horizontal.into(), vertical.into()] }
            })
            .collect()
    }
}
