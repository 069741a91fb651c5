//! An image wrapped around the scene.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::{Edges, LinearImage, Pyramid};

/// Largest ratio of a patch's axes: large, for near the poles a round patch of directions is a long
/// one of the image.
const MAX_RATIO: f32 = 64.0;

/// Closest distance to the poles at which derivatives are taken, in radians.
const POLE: f64 = 1e-6;

/// An image of all directions. Its middle column looks along +x, columns further right towards +z,
/// the top row along +y, the bottom row along -y.
#[derive(Clone, Debug)]
pub struct Equirectangular {
    pyramid: Pyramid,
}

impl Equirectangular {
    /// Prepares an image; any aspect ratio is stretched to all directions.
    pub fn new(image: LinearImage) -> Self {
        Self { pyramid: Pyramid::new(image, Edges::WrapHorizontally).with_max_ratio(MAX_RATIO) }
    }

    /// Linear RGB seen along the unit vector `direction`, averaged over the patch that a sample
    /// covers; `dx` and `dy` are the derivatives of the direction per sample spacing along the two
    /// axes of the camera's picture (1 per spacing). Derivatives may be zero.
    pub fn sample(&self, direction: DVec3, dx: DVec3, dy: DVec3) -> [f32; 3] {
        let horizontal = direction.x.hypot(direction.z);
        let position =
            [0.5 + direction.z.atan2(direction.x) / TAU, horizontal.atan2(direction.y) / PI];
        let near = horizontal.max(POLE);
        let derivative = |change: DVec3| {
            let along = (direction.x * change.z - direction.z * change.x) / (near * near);
            let outward = (direction.x * change.x + direction.z * change.z) / near;
            let down = direction.y * outward - horizontal * change.y;
            // More than once around is no wider than once.
            [(along / TAU).clamp(-1.0, 1.0), down / PI]
        };
        self.pyramid.sample(position, derivative(dx), derivative(dy))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Texels;
    use super::*;

    /// Red counts columns, green rows, from 0 to 1.
    fn coordinates(width: usize, height: usize) -> Equirectangular {
        let texels = (0..width * height)
            .flat_map(|i| {
                let (x, y) = (i % width, i / width);
                [(x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32, 0.0]
            })
            .collect();
        Equirectangular::new(LinearImage { width, height, texels: Texels::Linear(texels) })
    }

    fn near(actual: f32, expected: f32) -> bool {
        (actual - expected).abs() < 2e-3
    }

    #[test]
    fn directions_find_their_pixels() {
        let image = coordinates(512, 256);
        let look = |x: f64, y: f64, z: f64| {
            image.sample(DVec3::new(x, y, z).normalize(), DVec3::ZERO, DVec3::ZERO)
        };
        let ahead = look(1.0, 0.0, 0.0);
        assert!(near(ahead[0], 0.5) && near(ahead[1], 0.5), "{ahead:?}");
        let right = look(0.0, 0.0, 1.0);
        assert!(near(right[0], 0.75) && near(right[1], 0.5), "{right:?}");
        let left_up = look(0.0, 1.0, -1.0);
        assert!(near(left_up[0], 0.25) && near(left_up[1], 0.25), "{left_up:?}");
        assert!(look(0.0, 1.0, 0.0)[1] < 0.01);
        assert!(look(0.0, -1.0, 0.0)[1] > 0.99);
    }

    #[test]
    fn no_seam_behind_the_viewer() {
        // The same picture turned by a quarter: what lay at the seam now lies in its middle.
        let (width, height) = (64, 32);
        let wrapped = |shift: usize| {
            let texels = (0..width * height)
                .flat_map(|i| {
                    let (x, y) = ((i % width + shift) % width, i / width);
                    [((x * 29 + y * 17) % 31) as f32 / 31.0; 3]
                })
                .collect();
            Equirectangular::new(LinearImage { width, height, texels: Texels::Linear(texels) })
        };
        let (image, turned) = (wrapped(0), wrapped(width / 4));
        for step in -40..40 {
            let (sin, cos) = (f64::from(step) * 0.01).sin_cos();
            for spread in [0.0, 0.1, 0.5] {
                let look = |image: &Equirectangular, ahead: DVec3, right: DVec3| {
                    let direction = ahead * cos + right * sin;
                    let along = (right * cos - ahead * sin) * spread;
                    image.sample(direction, along, DVec3::Y * spread)[0]
                };
                let at_seam = look(&image, DVec3::NEG_X, DVec3::NEG_Z);
                let inside = look(&turned, DVec3::Z, DVec3::NEG_X);
                assert!((at_seam - inside).abs() < 1e-5, "{step} {spread}: {at_seam} {inside}");
            }
        }
    }

    #[test]
    fn poles_and_bad_derivatives_are_harmless() {
        let image = coordinates(128, 64);
        for direction in [DVec3::Y, DVec3::NEG_Y, DVec3::X] {
            for spread in [0.0, 1e-3, 1.0, 1e6, f64::NAN] {
                let dx = DVec3::new(spread, 0.0, 0.0);
                let dy = DVec3::new(0.0, 0.0, spread);
                let light = image.sample(direction, dx, dy);
                assert!(light.iter().all(|value| (-1e-4..=1.001).contains(value)), "{light:?}");
            }
        }
    }
}
