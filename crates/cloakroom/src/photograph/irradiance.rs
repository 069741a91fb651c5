//! The light that a matt surface gets from an image all around.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::Equirectangular;

/// Directions that the light is looked at in, around and from pole to pole: plenty for what varies
/// as slowly as the functions of degree 2.
const DIRECTIONS: [usize; 2] = [128, 64];

/// The light on a surface from all directions, as a function of the surface's normal.
///
/// A matt surface averages over a hemisphere, which leaves of the surroundings' spherical harmonics
/// little but those up to degree 2: on average over directions the error is below 3 % (Ramamoorthi
/// & Hanrahan, Proc. SIGGRAPH 2001, 497).
#[derive(Clone, Debug)]
pub struct Irradiance {
    /// Red, green and blue of each of the nine functions, with the weight of its degree.
    coefficients: [[f64; 3]; 9],
}

/// The real spherical harmonics up to degree 2 at a unit vector.
fn harmonics(DVec3 { x, y, z }: DVec3) -> [f64; 9] {
    let c = [0.282_094_791_773_878_14, 0.488_602_511_902_919_9, 1.092_548_430_592_079_2];
    let (half, zonal) = (0.546_274_215_296_039_6, 0.315_391_565_252_520_05);
    [
        c[0],
        c[1] * x,
        c[1] * y,
        c[1] * z,
        c[2] * x * y,
        c[2] * y * z,
        c[2] * z * x,
        half * (x * x - y * y),
        zonal * (3.0 * z * z - 1.0),
    ]
}

/// What the average over a hemisphere, weighted by the cosine, leaves of the functions of degree 0,
/// 1 and 2.
const DEGREES: [f64; 9] = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25];

impl Irradiance {
    /// From an image of all directions.
    pub fn new(image: &Equirectangular) -> Self {
        let [around, down] = DIRECTIONS;
        let (width, height) = (TAU / around as f64, PI / down as f64);
        let mut coefficients = [[0.0; 3]; 9];
        for row in 0..down {
            let polar = (row as f64 + 0.5) * height;
            let (sin, cos) = polar.sin_cos();
            // The solid angle of a cell.
            let share = 2.0 * (0.5 * height).sin() * sin * width;
            for column in 0..around {
                let azimuth = (column as f64 + 0.5) * width;
                let (across, along) = azimuth.sin_cos();
                let direction = DVec3::new(sin * along, cos, sin * across);
                let right = DVec3::new(-across, 0.0, along) * (sin * width);
                let lower = DVec3::new(cos * along, -sin, cos * across) * height;
                let light = image.sample(direction, right, lower).map(f64::from);
                for (sum, value) in coefficients.iter_mut().zip(harmonics(direction)) {
                    for (sum, light) in sum.iter_mut().zip(light) {
                        *sum += light * value * share;
                    }
                }
            }
        }
        for (sum, weight) in coefficients.iter_mut().zip(DEGREES) {
            *sum = sum.map(|value| value * weight);
        }
        Self { coefficients }
    }

    /// Linear RGB that a white matt surface with this unit normal sends out: its irradiance over pi.
    pub fn at(&self, normal: DVec3) -> [f64; 3] {
        let mut light = [0.0; 3];
        for (coefficient, value) in self.coefficients.iter().zip(harmonics(normal)) {
            for (light, coefficient) in light.iter_mut().zip(coefficient) {
                *light += coefficient * value;
            }
        }
        // Beside a very bright spot the nine functions dip below zero.
        light.map(|light| light.max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{LinearImage, Texels};
    use super::*;

    /// An image whose light depends on the direction.
    fn image(light: impl Fn(DVec3) -> [f32; 3]) -> Equirectangular {
        let (width, height) = (256, 128);
        let texels = (0..width * height)
            .flat_map(|i| {
                let azimuth = TAU * (((i % width) as f64 + 0.5) / width as f64 - 0.5);
                let polar = PI * ((i / width) as f64 + 0.5) / height as f64;
                let (sin, cos) = polar.sin_cos();
                light(DVec3::new(sin * azimuth.cos(), cos, sin * azimuth.sin()))
            })
            .collect();
        Equirectangular::new(LinearImage { width, height, texels: Texels::Linear(texels) })
    }

    fn normals() -> impl Iterator<Item = DVec3> {
        (0..40).map(|k| {
            let (k, turn) = (f64::from(k), f64::from(k) * 2.4);
            let y = (k + 0.5) / 20.0 - 1.0;
            DVec3::new((1.0 - y * y).sqrt() * turn.cos(), y, (1.0 - y * y).sqrt() * turn.sin())
        })
    }

    #[test]
    fn an_even_light_is_the_same_on_all_sides() {
        let even = Irradiance::new(&image(|_| [0.25, 1.0, 3.0]));
        for normal in normals() {
            for (light, expected) in even.at(normal).into_iter().zip([0.25, 1.0, 3.0]) {
                assert!((light / expected - 1.0).abs() < 1e-3, "{light} {expected}");
            }
        }
    }

    /// Of a bright hemisphere, a surface sees a share of (1 + cos) / 2, cosine law included.
    #[test]
    fn half_a_sky_lights_by_the_cosine() {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_Y] {
            let sky = Irradiance::new(&image(|d| [if d.dot(axis) > 0.0 { 2.0 } else { 0.0 }; 3]));
            for normal in normals() {
                let expected = 1.0 + normal.dot(axis);
                let light = sky.at(normal)[1];
                assert!((light - expected).abs() < 0.02, "{axis} {normal}: {light} {expected}");
            }
        }
    }

    /// The integral itself, over a picture with structure of degree 2.
    #[test]
    fn it_is_the_integral_over_the_hemisphere() {
        let light = |d: DVec3| 1.0 + 0.8 * d.x * d.y - 0.5 * d.z * d.z + 0.6 * d.z * d.x;
        let around = Irradiance::new(&image(|d| [light(d) as f32; 3]));
        for normal in normals() {
            let (side, up) = normal.any_orthonormal_pair();
            let (mut sum, count) = (0.0, 200);
            for i in 0..count {
                // Even in the square of the sine: the cosine law.
                let sin = ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
                for k in 0..64 {
                    let (y, x) = (TAU * f64::from(k) / 64.0).sin_cos();
                    let flat = (side * x + up * y) * sin;
                    sum += light(flat + normal * (1.0 - sin * sin).sqrt());
                }
            }
            let expected = sum / f64::from(count * 64);
            let got = around.at(normal)[0];
            assert!((got - expected).abs() < 3e-3, "{normal}: {got} {expected}");
        }
    }
}
