//! Runge-Kutta-Nyström methods: y'' = F(y), for a force that does not depend on the velocity. Four
//! steps are taken at once.

pub(crate) mod order_eight;
pub(crate) mod order_four;

use pulp::Simd;

use crate::lanes::{ComplexLanes, Lanes};

/// Places in the plane and their velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<S: Simd> {
    /// y.
    pub position: ComplexLanes<S>,
    /// y'.
    pub velocity: ComplexLanes<S>,
}

/// What is known of the field of force at one place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stage<S: Simd, J> {
    /// F.
    pub force: ComplexLanes<S>,
    /// What else was found there, for the quadratures.
    pub jet: J,
}

/// The end of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step<S: Simd, J, const Q: usize> {
    /// Where the step ends.
    pub end: Motion<S>,
    /// The field of force there.
    pub stage: Stage<S, J>,
    /// The growth of the quadratures ∫ g(y, y') over the step.
    pub quadrature: [Lanes<S>; Q],
}

/// A field of force, and what is to be integrated along the way.
pub(crate) trait Field<S: Simd, const Q: usize> {
    /// What is found at a place.
    type Jet: Copy;

    /// The force at a place; to be inlined.
    fn look(&self, place: ComplexLanes<S>) -> Stage<S, Self::Jet>;

    /// The integrands g of the quadratures ∫ g(y, y'); to be inlined.
    fn rates(&self, jet: &Self::Jet, velocity: ComplexLanes<S>) -> [Lanes<S>; Q];
}

impl<S: Simd> Motion<S> {
    /// The place after a share of the step, but for the force.
    #[inline(always)]
    fn coasted(&self, h: Lanes<S>, share: f64) -> ComplexLanes<S> {
        self.position.plus_real(self.velocity, h * share)
    }
}

/// Σ c_k f_k
#[inline(always)]
fn sum<S: Simd, const N: usize>(
    weights: &[f64; N],
    terms: [ComplexLanes<S>; N],
) -> ComplexLanes<S> {
    let mut sum = terms[0] * weights[0];
    for k in 1..N {
        sum = sum.plus_real(terms[k], terms[k].re.all(weights[k]));
    }
    sum
}

/// What the methods are tested with: orbits about a sun.
#[cfg(test)]
mod kepler {
    use std::array;
    use std::f64::consts::TAU;

    use num_complex::Complex64;
    use pulp::Simd;

    use super::{Field, Motion, Stage};
    use crate::lanes::{ComplexLanes, LANES, Lanes};

    /// Position and velocity.
    pub type OrbitState = [Complex64; 2];

    /// It pulls with 1/r²; the quadrature is the time integral of the speed squared.
    pub struct Sun;

    impl<S: Simd> Field<S, 1> for Sun {
        type Jet = ();

        #[inline(always)]
        fn look(&self, y: ComplexLanes<S>) -> Stage<S, ()> {
            let r = y.norm_squared().sqrt();
            Stage { force: y * r.all(-1.0).divided_by(r * r * r), jet: () }
        }

        #[inline(always)]
        fn rates(&self, (): &(), velocity: ComplexLanes<S>) -> [Lanes<S>; 1] {
            [velocity.norm_squared()]
        }
    }

    /// The perihelion of an orbit of eccentricity 0.3 and period 2π.
    pub fn start() -> OrbitState {
        [0.7.into(), Complex64::new(0.0, (1.3_f64 / 0.7).sqrt())]
    }

    /// Orbits side by side, as a step takes them.
    #[inline(always)]
    pub fn together<S: Simd>(simd: S, places: [OrbitState; LANES]) -> Motion<S> {
        let [position, velocity] =
            [0, 1].map(|k| ComplexLanes::new(simd, places.map(|place| place[k])));
        Motion { position, velocity }
    }

    #[inline(always)]
    pub fn apart<S: Simd>(motion: Motion<S>) -> [OrbitState; LANES] {
        let (position, velocity) = (motion.position.values(), motion.velocity.values());
        array::from_fn(|i| [position[i], velocity[i]])
    }

    /// Errors of state and of quadrature after one revolution in `count` steps, in each direction.
    /// `step` gives where steps of the given lengths end, and their quadrature.
    pub fn revolution(
        count: u32,
        step: impl Fn([OrbitState; LANES], [f64; LANES]) -> ([OrbitState; LANES], [f64; LANES]),
    ) -> [(f64, f64); 2] {
        let h = TAU / f64::from(count);
        let mut places = [start(); LANES];
        let mut action = [0.0; LANES];
        for _ in 0..count {
            let (ends, quadrature) = step(places, [h, -h, h, -h]);
            places = ends;
            action = array::from_fn(|i| action[i] + quadrature[i]);
        }
        // Virial theorem: the mean of v² is 1 for the unit period orbit.
        [0, 1].map(|i| (distance(places[i], start()), (action[i].abs() - TAU).abs()))
    }

    pub fn distance(a: OrbitState, b: OrbitState) -> f64 {
        (a[0] - b[0]).norm().hypot((a[1] - b[1]).norm())
    }
}
