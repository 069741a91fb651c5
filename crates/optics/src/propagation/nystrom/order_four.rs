//! Nyström's method of order 4, for short steps.

use pulp::Simd;

use super::{Field, Motion, Stage};
use crate::lanes::{ComplexLanes, Lanes};

/// The end of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step<S: Simd, J, const Q: usize> {
    /// Where the step ends.
    pub end: Motion<S>,
    /// The field of force there.
    pub stage: Stage<S, J>,
    /// The growth of the quadratures over the step, by Simpson's rule with the place and velocity in its middle
    /// known to order 2.
    pub quadrature: [Lanes<S>; Q],
}

/// Steps of length `h` (negative: backwards) from `start`, where the force is known; three evaluations of it.
#[inline(always)]
pub(crate) fn step<S: Simd, F: Field<S, Q>, const Q: usize>(
    field: &F,
    start: Motion<S>,
    first: Stage<S, F::Jet>,
    h: Lanes<S>,
) -> Step<S, F::Jet, Q> {
    let square = h * h;
    let f0 = first.force;
    let middle = field.look(start.coasted(h, 0.5) + f0 * (square * 0.125));
    let f1 = middle.force;
    let f2 = field.look(start.coasted(h, 1.0) + f1 * (square * 0.5)).force;
    let position = start.coasted(h, 1.0) + (f0 + f1 * 2.0) * (square * (1.0 / 6.0));
    let velocity: ComplexLanes<S> = start.velocity + (f0 + f1 * 4.0 + f2) * (h * (1.0 / 6.0));
    let stage = field.look(position);
    let between = start.velocity + (f0 + f1) * (h * 0.25);
    let g0 = field.rates(&first.jet, start.velocity);
    let g1 = field.rates(&middle.jet, between);
    let mut quadrature = field.rates(&stage.jet, velocity);
    for (k, growth) in quadrature.iter_mut().enumerate() {
        *growth = (g0[k] + g1[k] * 4.0 + *growth) * (h * (1.0 / 6.0));
    }
    Step { end: Motion { position, velocity }, stage, quadrature }
}

#[cfg(test)]
mod tests {
    use std::array;
    use std::f64::consts::TAU;

    use pulp::WithSimd;

    use super::*;
    use crate::lanes::{Complexes, LANES, side_by_side};
    use crate::propagation::nystrom::kepler::{Place, Sun, distance, start};

    struct Orbits {
        start: [Place; LANES],
        h: [f64; LANES],
    }

    impl WithSimd for Orbits {
        type Output = ([Place; LANES], [f64; LANES]);

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let mut places = [Complexes::default(); 2];
            for (k, place) in places.iter_mut().enumerate() {
                for i in 0..LANES {
                    place.put(i, self.start[i][k]);
                }
            }
            let [position, velocity] = places;
            let start = Motion { position: position.load(simd), velocity: velocity.load(simd) };
            let first = Sun.look(start.position);
            let step = step(&Sun, start, first, Lanes::new(simd, self.h));
            let (position, velocity) = (step.end.position.values(), step.end.velocity.values());
            (array::from_fn(|i| [position[i], velocity[i]]), step.quadrature[0].values())
        }
    }

    /// Errors of state and of quadrature after one revolution in `count` steps, in each direction.
    fn revolution(count: u32) -> [(f64, f64); 2] {
        let h = TAU / f64::from(count);
        let mut places = [start(); LANES];
        let mut action = [0.0; LANES];
        for _ in 0..count {
            let step = side_by_side(Orbits { start: places, h: [h, -h, h, -h] });
            places = step.0;
            action = array::from_fn(|i| action[i] + step.1[i]);
        }
        [0, 1].map(|i| (distance(places[i], start()), (action[i].abs() - TAU).abs()))
    }

    #[test]
    fn converges_with_order_four_forwards_and_backwards() {
        for (coarse, fine) in revolution(400).into_iter().zip(revolution(800)) {
            let order = (coarse.0 / fine.0).log2();
            assert!(order > 3.8 && order < 5.2, "{order} {coarse:?} {fine:?}");
            let order = (coarse.1 / fine.1).log2();
            assert!(order > 2.8, "{order} {coarse:?} {fine:?}");
            assert!(fine.0 < 1e-6, "{fine:?}");
        }
    }
}
