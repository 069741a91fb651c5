//! Nyström's method of order 4, for short steps.

use pulp::Simd;

use super::{Field, Motion, Stage, Step};
use crate::lanes::{ComplexLanes, Lanes};

/// Steps of length `h` (negative: backwards) from `start`, where the force is known; three
/// evaluations of it. The quadratures are by Simpson's rule with the place and velocity in the
/// middle known to order 2.
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
    use pulp::WithSimd;

    use super::*;
    use crate::lanes::{LANES, portably, side_by_side};
    use crate::propagation::nystrom::kepler::{OrbitState, Sun, apart, revolution, together};

    struct Orbits {
        start: [OrbitState; LANES],
        h: [f64; LANES],
    }

    impl WithSimd for Orbits {
        type Output = ([OrbitState; LANES], [f64; LANES]);

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let start = together(simd, self.start);
            let step = step(&Sun, start, Sun.look(start.position), Lanes::new(simd, self.h));
            (apart(step.end), step.quadrature[0].values())
        }
    }

    #[test]
    fn converges_with_order_four_forwards_and_backwards() {
        let errors = |count| {
            revolution(count, |start, h| side_by_side(Orbits { start, h }).unwrap_or_else(portably))
        };
        for (coarse, fine) in errors(400).into_iter().zip(errors(800)) {
            let order = (coarse.0 / fine.0).log2();
            assert!(order > 3.8 && order < 5.2, "{order} {coarse:?} {fine:?}");
            let order = (coarse.1 / fine.1).log2();
            assert!(order > 2.8, "{order} {coarse:?} {fine:?}");
            assert!(fine.0 < 1e-6, "{fine:?}");
        }
    }
}
