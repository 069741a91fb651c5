//! Convex regions of a medium whose rays are known in closed form.

use super::{Coating, Convex, FarSide, Hull, InnerRay, Passage, Region, Shape, Structure, Surface};
use glam::DVec3;
use optics::geometry::{CutBall, FlatOrRound, Plane, TOUCHING};
use optics::medium::Medium;
use optics::propagation::{ClosedForm, CurvedRay, PathPoint, follow, group_path_along};
use std::sync::Arc;

/// A convex region of a medium whose rays are known in closed form; around it is what is around the
/// device.
#[derive(Clone, Debug)]
pub struct ClosedFormRegion {
    /// What fills it.
    pub medium: Arc<dyn ClosedForm>,
    /// Where it ends.
    pub border: ClosedFormBorder,
    /// How the medium meets what is outside.
    pub coating: Coating,
}

/// The convex shapes between planes and spheres: what a medium whose rays are known in closed form
/// can be cut to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClosedFormBorder {
    /// A box, by half its size along x, y and z, cm.
    Box(DVec3),
    /// A ball of which a plane has cut something off.
    CutBall(CutBall),
}

/// A device that is one convex region of a medium whose rays are known in closed form.
pub(super) fn filled(border: ClosedFormBorder, medium: impl ClosedForm + 'static) -> Structure {
    let region = ClosedFormRegion { medium: Arc::new(medium), border, coating: Coating::None };
    let shape = border.convex();
    let surfaces = vec![Surface::new(Shape::Convex(shape), FarSide::Region(0))];
    Structure::new(vec![Region::ClosedForm(region)], surfaces, Hull::new(shape.solid()))
}

impl ClosedFormBorder {
    /// The shape that is met from outside.
    pub(super) fn convex(self) -> Convex {
        match self {
            Self::Box(half) => Convex::Box { half },
            Self::CutBall(ball) => Convex::CutBall(ball),
        }
    }

    /// The planes and spheres between which it is.
    fn bounds(self) -> impl Iterator<Item = FlatOrRound> {
        let (half, ball) = match self {
            Self::Box(half) => (Some(half), None),
            Self::CutBall(ball) => (None, Some(ball)),
        };
        let side = |half: DVec3, side: usize| {
            let sign = [-1.0, 1.0][side % 2];
            Plane { normal: sign * DVec3::AXES[side / 2], offset: half[side / 2] }
        };
        let sides = half.into_iter().flat_map(move |half| (0..6).map(move |i| side(half, i)));
        let planes = sides.chain(ball.map(|ball| ball.plane));
        planes.map(FlatOrRound::from).chain(ball.map(|ball| ball.sphere.into()))
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
        let (end, _) = follow(self.medium.as_ref(), &curved(ray), self.border.bounds())?;
        let passage = Passage::graded(ray, &end, end.surface, FarSide::Outside);
        Some(Passage { coating: self.coating, ..passage })
    }

    /// Points along the way of a ray to the border, in that many pieces.
    pub(super) fn path(&self, ray: &InnerRay, pieces: u32) -> Vec<PathPoint> {
        let way = self.way(ray);
        (0..=pieces).map(|piece| way(f64::from(piece) / f64::from(pieces))).collect()
    }

    /// Points of that way, by shares of it.
    fn way(&self, ray: &InnerRay) -> impl Fn(f64) -> PathPoint {
        let start = curved(ray);
        let end = follow(self.medium.as_ref(), &start, self.border.bounds());
        let last = end.map_or(0.0, |(_, parameter)| parameter);
        move |share| {
            let (CurvedRay { position, .. }, optical_path) =
                self.medium.way_point(&start, last * share);
            PathPoint { position, optical_path }
        }
    }

    /// The speed of light times the time that a pulse takes on that way, cm, at the least
    /// dispersion that causality allows: the group index is n or 1/n, whichever is larger.
    pub(super) fn causal_group_path(&self, ray: &InnerRay, tolerance: f64) -> f64 {
        let square = |position: DVec3| self.medium.squared_index(position).value;
        let ratio = |position: DVec3, _| square(position).recip().max(1.0);
        let sides = |position: DVec3| u8::from(square(position) > 1.0);
        group_path_along(self.way(ray), ratio, sides, tolerance)
    }
}

fn curved(ray: &InnerRay) -> CurvedRay {
    CurvedRay { position: ray.position, wave_vector: ray.wave_vector }
}
