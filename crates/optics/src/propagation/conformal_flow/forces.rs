//! The forces on four rays in virtual space.
//!
//! Where the index is ρ(x, y) c/|f'|, H = (|P|² + p_z² |f'|² - c² ρ²)/2, with the gradient g of ρ²
//! in physical space as a complex number:
//!
//! dP/dτ = -p_z² f' conj(f'') + c² conj(f') g/2,  d(optical path)/dτ = c² ρ².
//!
//! The field turns about the ray as [`super::frame`] says, now with ∇ln n = -conj(f''/f') + γ, γ =
//! conj(f') g/(2ρ²), in virtual space. Besides the turn p_z |f'| z × ∇ln n about an axis across z,
//! of the turn about z there remains Im(conj(P) γ), as the map turns its frame by Im(P f''/f')
//! alone. Against the frame bound to the ray, with σ = p_z |f'|/(c ρ),
//!
//! dθ/dτ = (sign(p_z) Im(conj(P) γ) - σ Im(P f''/f'))/(1 + |σ|).

use num_complex::Complex64;
use pulp::{Simd, WithSimd};

use super::index_perturbation::IndexPerturbation;
use super::points::PointLanes;
use crate::lanes::{ComplexLanes, LANES, Lanes};
use crate::propagation::nystrom::{Field, Stage};
use crate::transformation::{JetLanes, LaneMap};

/// A force on rays, with the quadratures z, θ and, unless it grows with τ, the optical path over
/// c².
pub(super) trait Force<S: Simd, const Q: usize>: Field<S, Q> {
    /// What is found where the map is known; to be inlined, as all of these.
    fn found(&self, map: JetLanes<S>) -> Self::Jet;

    /// The map in what is found.
    fn map(jet: &Self::Jet) -> JetLanes<S>;

    /// What |P|² must be.
    fn momentum_squared(&self, jet: &Self::Jet) -> Lanes<S>;

    /// Adds to the rate of the optical path by how much it grows over `time`, if it is among the
    /// quadratures.
    fn bend_path(&self, _: &PointLanes<S>, _: &Self::Jet, _time: Lanes<S>, _: &mut [Lanes<S>; Q]) {}
}

/// That of the medium of a map.
pub(super) struct EvenForce<'w, S: Simd, M> {
    pub map: &'w M,
    pub p_z: Lanes<S>,
    pub index_scale: Lanes<S>,
}

/// Where the index is uneven, too.
pub(super) struct PerturbedForce<'w, S: Simd, M> {
    pub even: EvenForce<'w, S, M>,
    pub index_perturbation: &'w IndexPerturbation,
}

/// Looks at the perturbation of four rays.
struct Looks<'w> {
    index_perturbation: &'w IndexPerturbation,
    places: [Complex64; LANES],
}

impl WithSimd for Looks<'_> {
    /// ρ², and both parts of g.
    type Output = [[f64; LANES]; 3];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.index_perturbation.look_at_four(self.places)
    }
}

/// What is found at virtual points.
#[derive(Clone, Copy)]
pub(super) struct UnevenJet<S: Simd> {
    map: JetLanes<S>,
    /// ρ² and g.
    square: Lanes<S>,
    gradient: ComplexLanes<S>,
}

impl<S: Simd, M: LaneMap> Field<S, 2> for EvenForce<'_, S, M> {
    type Jet = JetLanes<S>;

    #[inline(always)]
    fn look(&self, zeta: ComplexLanes<S>) -> Stage<S, JetLanes<S>> {
        let jet = self.map.jets(zeta);
        Stage { force: jet.f1 * jet.f2.conj() * -(self.p_z * self.p_z), jet }
    }

    /// dz/dτ = p_z |f'|², and dθ/dτ: with σ = p_z |f'|/c the sine of the ray's angle to the virtual
    /// plane, -σ/(1 + |σ|) Im(P f''/f').
    #[inline(always)]
    fn rates(&self, jet: &JetLanes<S>, momentum: ComplexLanes<S>) -> [Lanes<S>; 2] {
        let square = jet.f1.norm_squared();
        let stretch = square.sqrt();
        let turn = (momentum * (jet.f2 * jet.f1.conj())).im;
        let slowness = stretch * (self.index_scale + self.p_z.abs() * stretch);
        [self.p_z * square, (-self.p_z * turn).divided_by(slowness)]
    }
}

impl<S: Simd, M: LaneMap> Force<S, 2> for EvenForce<'_, S, M> {
    #[inline(always)]
    fn found(&self, map: JetLanes<S>) -> JetLanes<S> {
        map
    }

    #[inline(always)]
    fn map(jet: &JetLanes<S>) -> JetLanes<S> {
        *jet
    }

    /// c² - p_z² |f'|².
    #[inline(always)]
    fn momentum_squared(&self, jet: &JetLanes<S>) -> Lanes<S> {
        self.index_scale * self.index_scale - self.p_z * self.p_z * jet.f1.norm_squared()
    }
}

impl<S: Simd, M: LaneMap> Field<S, 3> for PerturbedForce<'_, S, M> {
    type Jet = UnevenJet<S>;

    #[inline(always)]
    fn look(&self, zeta: ComplexLanes<S>) -> Stage<S, UnevenJet<S>> {
        let Stage { force, jet } = self.even.look(zeta);
        let jet = self.found(jet);
        let index_scale = self.even.index_scale;
        let uphill = jet.map.f1.conj() * jet.gradient * (index_scale * index_scale * 0.5);
        Stage { force: force + uphill, jet }
    }

    /// dz/dτ, dθ/dτ and the growth of the optical path over c².
    #[inline(always)]
    fn rates(&self, jet: &UnevenJet<S>, momentum: ComplexLanes<S>) -> [Lanes<S>; 3] {
        let EvenForce { p_z, index_scale, .. } = self.even;
        let JetLanes { f1, f2, .. } = jet.map;
        let square = f1.norm_squared();
        let stretch = square.sqrt();
        let turn = (momentum * (f2 * f1.conj())).im;
        let root = index_scale * jet.square.sqrt();
        let across = ((momentum * f1).conj() * jet.gradient).im;
        let about_z = (p_z.signs() * root * across).divided_by(jet.square * 2.0);
        let bent = about_z - (p_z * turn).divided_by(stretch);
        let theta = bent.divided_by(root + p_z.abs() * stretch);
        [p_z * square, theta, jet.square]
    }
}

impl<S: Simd, M: LaneMap> Force<S, 3> for PerturbedForce<'_, S, M> {
    #[inline(always)]
    fn found(&self, map: JetLanes<S>) -> UnevenJet<S> {
        let looks = Looks { index_perturbation: self.index_perturbation, places: map.f.values() };
        let [squares, re, im] = map.f.re.apart(looks);
        let gradient = ComplexLanes { re: map.f.re.with(re), im: map.f.re.with(im) };
        UnevenJet { map, square: map.f.re.with(squares), gradient }
    }

    #[inline(always)]
    fn map(jet: &UnevenJet<S>) -> JetLanes<S> {
        jet.map
    }

    /// c² ρ² - p_z² |f'|².
    #[inline(always)]
    fn momentum_squared(&self, jet: &UnevenJet<S>) -> Lanes<S> {
        let EvenForce { p_z, index_scale, .. } = self.even;
        index_scale * index_scale * jet.square - p_z * p_z * jet.map.f1.norm_squared()
    }

    #[inline(always)]
    fn bend_path(
        &self,
        from: &PointLanes<S>,
        jet: &UnevenJet<S>,
        time: Lanes<S>,
        rates: &mut [Lanes<S>; 3],
    ) {
        rates[2] = rates[2] + (from.velocity.conj() * jet.gradient).re * time;
    }
}
