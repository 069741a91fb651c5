//! A slow, plain integrator of rays in isotropic graded media, for tests.
//!
//! It knows an index and its gradient in physical space and nothing else: no map, no virtual space,
//! no error control. It solves the ray equation d/ds(n dr/ds) = ∇n (Born & Wolf, section 3.2),
//! which is the equation of motion of Halimeh & Wegener, Opt. Express 21, 9457 (2013), in another
//! parameter: with dσ = ds/n it reads r'' = ∇(n²)/2, p = r', and the optical path grows by n² dσ.
//! Along with it goes the polarization, de/ds = -(e·∇ln n) t (Rytov).

use std::array::from_fn;

use glam::DVec3;

/// A ray with its electric field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceRay {
    /// Where it is, cm.
    pub position: DVec3,
    /// The wave vector p, |p| = n.
    pub wave_vector: DVec3,
    /// A vector transverse to it, carried along.
    pub electric_field: DVec3,
    /// The optical path since the start, cm.
    pub optical_path: f64,
}

/// The square of an index and the gradient of that square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SquaredIndex {
    /// n².
    pub value: f64,
    /// ∇(n²), 1/cm.
    pub gradient: DVec3,
}

/// Follows a ray by the classical method of order 4 with steps `step` (in σ = ∫ ds/n, cm) until
/// `inside`, positive within the medium, changes its sign; None if it does not within `max_steps`.
///
/// `medium` must go on smoothly a step beyond the border.
pub fn follow(
    start: ReferenceRay,
    step: f64,
    max_steps: u32,
    mut medium: impl FnMut(DVec3) -> SquaredIndex,
    mut inside: impl FnMut(DVec3) -> f64,
) -> Option<ReferenceRay> {
    let mut ray = start;
    for _ in 0..max_steps {
        let next = runge_kutta(&ray, step, &mut medium);
        if inside(next.position) < 0.0 {
            let (mut low, mut high) = (0.0, step);
            while high - low > 1e-15 * step {
                let middle = 0.5 * (low + high);
                if inside(runge_kutta(&ray, middle, &mut medium).position) < 0.0 {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            return Some(runge_kutta(&ray, high, &mut medium));
        }
        ray = next;
    }
    None
}

fn runge_kutta(
    ray: &ReferenceRay,
    h: f64,
    medium: &mut impl FnMut(DVec3) -> SquaredIndex,
) -> ReferenceRay {
    type State = ([DVec3; 3], f64);
    let mut slope = |&([position, p, field], _): &State| {
        let index = medium(position);
        let turn = -0.5 * field.dot(index.gradient) / index.value * p;
        ([p, 0.5 * index.gradient, turn], index.value)
    };
    let y = ([ray.position, ray.wave_vector, ray.electric_field], ray.optical_path);
    let moved = |k: &State, h: f64| (from_fn(|i| y.0[i] + h * k.0[i]), y.1 + h * k.1);
    let k1 = slope(&y);
    let k2 = slope(&moved(&k1, 0.5 * h));
    let k3 = slope(&moved(&k2, 0.5 * h));
    let k4 = slope(&moved(&k3, h));
    let mean = from_fn(|i| (k1.0[i] + 2.0 * (k2.0[i] + k3.0[i]) + k4.0[i]) / 6.0);
    let mean_rate = (k1.1 + 2.0 * (k2.1 + k3.1) + k4.1) / 6.0;
    let ([position, wave_vector, electric_field], optical_path) = moved(&(mean, mean_rate), h);
    ReferenceRay { position, wave_vector, electric_field, optical_path }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_the_parabola_of_a_linear_squared_index() {
        // n² = 1 + 0.1 y: p_y = 0.05 σ + p_y0, a parabola as of a ball thrown upwards.
        let medium = |r: DVec3| SquaredIndex { value: 1.0 + 0.1 * r.y, gradient: 0.1 * DVec3::Y };
        let start = ReferenceRay {
            position: DVec3::ZERO,
            wave_vector: DVec3::new(0.6, -0.8, 0.0),
            electric_field: DVec3::new(0.8, 0.6, 0.0),
            optical_path: 0.0,
        };
        let end = follow(start, 0.1, 1000, medium, |r| 12.0 - r.x).expect("it arrives");
        let sigma = 20.0;
        let exact = DVec3::new(12.0, -0.8 * sigma + 0.025 * sigma * sigma, 0.0);
        assert!((end.position - exact).length() < 1e-12);
        assert!((end.wave_vector - DVec3::new(0.6, 0.2, 0.0)).length() < 1e-12);
        // ∫ n² dσ with y = -0.8 σ + 0.025 σ²
        let path = sigma + 0.1 * (-0.4 * sigma.powi(2) + 0.025 / 3.0 * sigma.powi(3));
        assert!((end.optical_path - path).abs() < 1e-12);
        // In a plane the field turns with the ray.
        let across = DVec3::new(-end.wave_vector.y, end.wave_vector.x, 0.0).normalize();
        assert!((end.electric_field - across).length() < 1e-8);
    }

    #[test]
    fn gives_up_on_a_ray_that_stays() {
        let medium = |_| SquaredIndex { value: 1.0, gradient: DVec3::ZERO };
        let start = ReferenceRay {
            position: DVec3::ZERO,
            wave_vector: DVec3::X,
            electric_field: DVec3::Y,
            optical_path: 0.0,
        };
        assert_eq!(follow(start, 0.1, 10, medium, |_| 1.0), None);
    }
}
