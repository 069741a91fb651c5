//! The structural similarity of two pictures: Wang, Bovik, Sheikh & Simoncelli, IEEE Trans. Image
//! Process. 13, 600 (2004), in a window of 11 x 11 pixels with a Gaussian weight of 1.5 pixels.

use super::plane::{Plane, gaussian};
use super::{PixelMask, View};
use crate::photograph::encode;

/// The constants K1 and K2 of the paper, and the range L of the signal.
const K: [f64; 2] = [0.01, 0.03];

/// The mean structural similarity of the luminance of two views over a region, 1 for equal ones.
/// Luminance is that of sRGB, encoded as for a display and held to what that can show; windows end
/// at the picture's edge, which goes on beyond itself.
///
/// Views and region must be of one size.
#[must_use]
pub fn structural_similarity(a: &View, b: &View, region: &PixelMask) -> f64 {
    let [a, b] = [a, b].map(|view| Plane { width: view.width, values: luminance(view) });
    let kernel = gaussian(1.5, 5);
    let blur = |plane: &Plane| plane.filtered(&kernel, &kernel).values;
    let product = |a: &Plane, b: &Plane| blur(&a.zip(b, |a, b| a * b));
    let (mean_a, mean_b) = (blur(&a), blur(&b));
    let (aa, bb, ab) = (product(&a, &a), product(&b, &b), product(&a, &b));
    let [c1, c2] = K.map(|k| k * k);
    region.mean(|i| {
        let (ma, mb) = (mean_a[i], mean_b[i]);
        let (va, vb, cov) = (aa[i] - ma * ma, bb[i] - mb * mb, ab[i] - ma * mb);
        (2.0 * ma * mb + c1) * (2.0 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2))
    })
}

/// The luminance of each pixel, encoded as sRGB, from 0 to 1.
fn luminance(view: &View) -> Vec<f64> {
    let [red, green, blue] = &view.light;
    (0..view.pixels())
        .map(|i| encode((0.2126 * red[i] + 0.7152 * green[i] + 0.0722 * blue[i]).clamp(0.0, 1.0)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::comparison::tests::{even, patterns};
    use super::*;

    #[test]
    fn it_is_that_of_scikit_image() {
        // skimage.metrics.structural_similarity 0.26, gaussian_weights=True, sigma=1.5,
        // use_sample_covariance=False, data_range=1, of the encoded luminances; it leaves out the
        // windows that reach beyond the picture.
        let [a, b] = patterns();
        let inner = PixelMask::rectangle(&a, [5, 5, a.width - 10, a.height - 10]).expect("inside");
        let similarity = structural_similarity(&a, &b, &inner);
        assert!((similarity - 0.821_930_126_820_459_7).abs() < 1e-6, "{similarity}");
        assert!((structural_similarity(&a, &a, &inner) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn even_pictures_differ_by_their_luminance_alone() {
        // (2 x y + C1) / (x² + y² + C1) with x = 1 and y = 0.5 after encoding.
        let (white, gray) = (even(1.0), even(crate::photograph::decode(0.5)));
        let similarity = structural_similarity(&white, &gray, &PixelMask::whole(&white));
        assert!((similarity - (1.0 + 1e-4) / (1.25 + 1e-4)).abs() < 1e-9, "{similarity}");
    }
}
