//! Convex regions of a medium that is given on a grid in space.

use super::{Coating, Convex, FarSide, Hull, InnerRay, NoPassage, Passage, Region, Shape};
use super::{Structure, Surface};
use glam::DVec3;
use optics::geometry::{Plane, TOUCHING};
use optics::propagation::{
    FlowError, PathPoint, SpatialBorder, SpatialFlow, SpatialMedium, SpatialRay,
};
use std::sync::Arc;

/// A convex region of a medium that is given on a grid in space; around it is what is around the
/// device.
#[derive(Clone, Debug)]
pub struct SpatialRegion {
    /// How rays run in it.
    pub flow: Arc<SpatialFlow>,
    /// Where it ends.
    pub shape: Convex,
    /// What lies beyond the lower border along y of a box.
    pub floor: FarSide,
    /// How the medium meets what is outside.
    pub coating: Coating,
}

/// A device that is one box, ball or round cylinder of a medium on a grid, of about that size, cm.
pub(super) fn filled(shape: Convex, medium: SpatialMedium, size: f64) -> Structure {
    let flow = Arc::new(SpatialFlow::new(medium, bounds(&shape), size));
    let region = SpatialRegion { flow, shape, floor: FarSide::Outside, coating: Coating::None };
    let surfaces = vec![Surface::new(Shape::Convex(shape), FarSide::Region(0))];
    Structure::new(vec![Region::Spatial(region)], surfaces, Hull::new(shape.solid()))
}

/// The number of the lower border along y among those of a box.
const FLOOR: u16 = 2;

/// The surfaces between which a shape is.
fn bounds(shape: &Convex) -> Vec<SpatialBorder> {
    let plane = |normal: DVec3, offset: f64| {
        let plane = SpatialBorder::FlatOrRound(Plane { normal, offset }.into());
        offset.is_finite().then_some(plane)
    };
    let bounds: Vec<Option<SpatialBorder>> = match shape {
        Convex::Box { half } => {
            let side =
                |side: usize| plane([-1.0, 1.0][side % 2] * DVec3::AXES[side / 2], half[side / 2]);
            (0..6).map(side).collect()
        }
        Convex::Ball(sphere) => vec![Some(SpatialBorder::FlatOrRound((*sphere).into()))],
        Convex::CutBall(ball) => vec![
            Some(SpatialBorder::FlatOrRound(ball.plane.into())),
            Some(SpatialBorder::FlatOrRound(ball.sphere.into())),
        ],
        Convex::Cylinder(cylinder) => {
            let sphere = optics::geometry::Sphere { radius: cylinder.radius };
            let extent = cylinder.extent;
            vec![
                Some(SpatialBorder::Tube(sphere.into())),
                plane(DVec3::NEG_Z, -extent.min),
                plane(DVec3::Z, extent.max),
            ]
        }
    };
    bounds.into_iter().flatten().collect()
}

impl SpatialRegion {
    /// Whether a point lies in it or, but for rounding, on its border.
    pub(super) fn holds(&self, point: DVec3) -> bool {
        self.flow.height(point) <= TOUCHING
    }

    pub(super) fn advance(&self, ray: &InnerRay, tolerance: f64) -> Result<Passage, NoPassage> {
        match self.flow.advance(&spatial(ray), tolerance) {
            Ok(end) => {
                let far = if end.surface == FLOOR { self.floor } else { FarSide::Outside };
                let coating = if far.is_metal() { Coating::None } else { self.coating };
                Ok(Passage { coating, ..Passage::graded(ray, &end, end.surface, far) })
            }
            Err(FlowError::StepLimit) => Err(NoPassage::Endless),
            Err(_) => Err(NoPassage::Lost),
        }
    }

    /// Points along the way of a ray to the border.
    pub(super) fn path(&self, ray: &InnerRay, tolerance: f64) -> Option<Vec<PathPoint>> {
        self.flow.path(&spatial(ray), tolerance).ok()
    }

    /// What a pulse takes on that way, cm, at the least dispersion that causality allows.
    pub(super) fn causal_group_path(&self, ray: &InnerRay, tolerance: f64) -> f64 {
        self.flow.causal_group_path(&spatial(ray), tolerance).unwrap_or(f64::NAN)
    }
}

fn spatial(ray: &InnerRay) -> SpatialRay {
    SpatialRay { position: ray.position, wave_vector: ray.wave_vector, mode: ray.mode }
}
