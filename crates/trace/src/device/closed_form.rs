//! Convex regions of a medium whose rays are known in closed form.

use super::{Convex, FarSide, Hull, InnerRay, Passage, Region, Shape, Structure, Surface};
use glam::DVec3;
use optics::geometry::TOUCHING;
use optics::medium::Medium;
use optics::propagation::{ClosedForm, CurvedRay, PathPoint, follow};
use std::sync::Arc;

/// A convex region of a medium whose rays are known in closed form; around it is what is around the device.
#[derive(Clone, Debug)]
pub struct ClosedFormRegion {
    /// What fills it.
    pub medium: Arc<dyn ClosedForm>,
    /// Where it ends: at planes and spheres.
    pub border: Convex,
}

/// A device that is one convex region of a medium whose rays are known in closed form, between planes and spheres: no
/// cylinder.
pub(super) fn filled(border: Convex, medium: impl ClosedForm + 'static) -> Structure {
    debug_assert!(!matches!(border, Convex::Cylinder(_)), "its side is neither plane nor sphere");
    let region = ClosedFormRegion { medium: Arc::new(medium), border };
    Structure {
        regions: vec![Region::ClosedForm(region)],
        surfaces: vec![Surface::new(Shape::Convex(border), FarSide::Region(0))],
        hull: Hull::new(border.solid()),
    }
}

impl ClosedFormRegion {
    /// The medium at a point of the region or its border.
    pub(super) fn medium(&self, position: DVec3) -> Medium {
        Medium::dielectric(self.medium.squared_index(position).value.sqrt())
    }

    /// Whether a point lies in it or, but for rounding, on its border.
    pub(super) fn holds(&self, point: DVec3) -> bool {
        self.border.bounds().all(|bound| bound.height(point) <= TOUCHING)
    }

    pub(super) fn advance(&self, ray: &InnerRay) -> Option<Passage> {
        let end = follow(self.medium.as_ref(), &curved(ray), self.border.bounds())?;
        Some(Passage {
            wave_vector: end.ray.wave_vector,
            direction: end.ray.wave_vector.normalize(),
            transport: Some(end.transport),
            optical_path: end.optical_path,
            ..Passage::straight(ray, end.ray.position, end.surface, end.outward, FarSide::Outside)
        })
    }

    /// Points along the way of a ray to the border, in that many pieces.
    pub(super) fn path(&self, ray: &InnerRay, pieces: u32) -> Vec<PathPoint> {
        let start = curved(ray);
        let end = follow(self.medium.as_ref(), &start, self.border.bounds());
        let last = end.map_or(0.0, |end| end.parameter);
        let at = |piece: u32| {
            let parameter = last * f64::from(piece) / f64::from(pieces);
            let (CurvedRay { position, .. }, optical_path) =
                self.medium.way_point(&start, parameter);
            PathPoint { position, optical_path }
        };
        (0..=pieces).map(at).collect()
    }
}

fn curved(ray: &InnerRay) -> CurvedRay {
    CurvedRay { position: ray.position, wave_vector: ray.wave_vector }
}
