//! An index that is not that of a map alone.

use std::sync::Arc;

use glam::DVec2;
use num_complex::Complex64;

use super::step_control::StepControl;
use super::{ConformalFlow, MIRROR_TOLERANCE};
use crate::lanes::LANES;
use crate::propagation::GridSpline;
use crate::transformation::MapJet;

/// A smooth factor ρ(x, y) of the index of a conformal map, by its square on a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct IndexPerturbation {
    square: GridSpline,
    /// Of the square, where it counts.
    bounds: [f64; 2],
    scale: f64,
}

/// Grid cells over which a perturbation is taken to vary.
const CELLS_A_SCALE: f64 = 4.0;

impl IndexPerturbation {
    /// The perturbation whose factor ρ has the square `square`; `None` if that is not positive
    /// everywhere. The grid should reach a few cells beyond the device, and resolve what varies in
    /// about four cells.
    #[must_use]
    pub fn new(square: GridSpline) -> Option<Self> {
        let bounds = square.bounds();
        Self::bounded(square, bounds)
    }

    /// As [`Self::new`], where the square is positive in those cells of the grid whose distances
    /// from the z axis, the least and the largest (cm), `counts` accepts: what it is elsewhere is
    /// not looked at but in steps that are taken back.
    #[must_use]
    pub fn within(square: GridSpline, counts: impl Fn([f64; 2]) -> bool) -> Option<Self> {
        let bounds = square.bounds_within(counts);
        Self::bounded(square, bounds)
    }

    fn bounded(square: GridSpline, bounds: [f64; 2]) -> Option<Self> {
        let scale = CELLS_A_SCALE * square.spacing.min_element();
        (bounds[0] > 0.0).then_some(Self { square, bounds, scale })
    }

    /// Bounds of the factor.
    pub(super) fn bounds(&self) -> [f64; 2] {
        self.bounds.map(f64::sqrt)
    }

    /// ρ² and ∂ρ²/∂x + i ∂ρ²/∂y, 1/cm, at one place.
    // The page is to be small, and has no wide instructions.
    #[cfg_attr(target_arch = "wasm32", inline(never))]
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    pub(super) fn look(&self, z: Complex64) -> (f64, Complex64) {
        let (square, gradient) = self.square.look(DVec2::new(z.re, z.im));
        (square, Complex64::new(gradient.x, gradient.y))
    }

    /// The same at four places: ρ², and both parts of its gradient.
    #[cfg_attr(target_arch = "wasm32", inline(never))]
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    pub(super) fn look_at_four(&self, places: [Complex64; LANES]) -> [[f64; LANES]; 3] {
        let mut found = [[0.0; LANES]; 3];
        for (i, place) in places.into_iter().enumerate() {
            let (square, gradient) = self.look(place);
            (found[0][i], found[1][i], found[2][i]) = (square, gradient.re, gradient.im);
        }
        found
    }
}

impl ConformalFlow {
    /// The same medium with an index that is uneven: ρ times that of the map. The perturbation is
    /// that of the upper half plane, in which the lower half is looked at as its mirror image.
    pub fn with_index_perturbation(self, index_perturbation: IndexPerturbation) -> Self {
        Self { index_perturbation: Some(Arc::new(index_perturbation)), ..self }.with_events()
    }

    /// Whether the index is not that of the map alone.
    #[must_use]
    pub fn is_uneven(&self) -> bool {
        self.index_perturbation.is_some()
    }

    /// The length over which the medium varies, cm.
    pub(super) fn scale(&self) -> f64 {
        let own = self.map.scale();
        self.index_perturbation
            .as_ref()
            .map_or(own, |index_perturbation| index_perturbation.scale.min(own))
    }

    /// How exactly rays are to be followed for a tolerance, cm, that meet the mirror or do not.
    pub(super) fn step_control(&self, tolerance: f64, to_mirror: bool) -> StepControl {
        // Nothing can be counted on in a spline of low degree, nor that a ray meets the mirror where
        // a straight one would; and the errors of many short steps add up.
        let uneven = self.index_perturbation.as_ref();
        let smooth = uneven.map(|index_perturbation| index_perturbation.square.is_smooth());
        let smoothness = match smooth {
            None => self.map.smoothness(),
            Some(true) => 3.0,
            Some(false) => 0.3,
        };
        let share = if smooth == Some(false) || to_mirror { MIRROR_TOLERANCE } else { 1.0 };
        let uneven = uneven.is_some();
        StepControl::new(self.scale(), smoothness, share * tolerance, uneven)
    }

    /// c ρ at a physical point of the upper half.
    pub(super) fn index_scale_at(&self, z: Complex64) -> f64 {
        let square = self
            .index_perturbation
            .as_ref()
            .map_or(1.0, |index_perturbation| index_perturbation.look(z).0);
        self.index_scale * square.sqrt()
    }

    /// The index at a virtual point.
    pub(super) fn index_at(&self, jet: &MapJet) -> f64 {
        self.index_scale_at(jet.f) / jet.stretch()
    }
}
