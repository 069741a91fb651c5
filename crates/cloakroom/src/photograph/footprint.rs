//! The patch of an image that a sample covers, as a row of round probes.

/// Ratio of the axes up to which one round probe stands for the patch. Above, the probe's width
/// stays and a row of probes grows from its middle, so that nothing jumps.
const ROUND: f32 = 1.2;

/// Largest derivative taken seriously, in texels: wider than any image.
const WIDEST: f64 = 1e8;

/// A patch of an image: an ellipse with the axes `major >= minor`, in texels.
///
/// The ellipse is the image of a sample's disc under the derivatives of the texture coordinates, or has the second moments of
/// several such steps.
/// What the patch looks like is the average over probes of one width along the major axis; along
/// both axes the variance is that of an average over the exact patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Footprint {
    /// Square of each probe's width, in texels; at least 1.
    pub(super) width_squared: f32,
    /// Square of the major axis' true length, below 1 where the image is magnified.
    pub(super) major_squared: f32,
    /// The row of probes; `None` for one probe.
    pub(super) row: Option<ProbeRow>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ProbeRow {
    /// In texels.
    length: f32,
    /// A unit vector.
    direction: [f32; 2],
}

impl Footprint {
    /// The patch spanned by derivatives, in texels per sample spacing, and by what draws it out further, with at most
    /// `max_ratio` between its axes: thinner patches are blurred across.
    ///
    /// Steps that are not numbers count as zero.
    #[inline]
    pub(super) fn new<const N: usize>(steps: [[f64; 2]; N], max_ratio: f32) -> Self {
        // Single precision is plenty for a shape, and its roots take half the time.
        let clean =
            |value: f64| if value.is_nan() { 0.0 } else { value.clamp(-WIDEST, WIDEST) as f32 };
        let steps = steps.map(|step| step.map(clean));
        // The axes are the singular values of the matrix whose columns the steps are. Few roots and
        // divisions: this is computed for every sample.
        let (mut uu, mut uv, mut vv) = (0.0, 0.0, 0.0);
        // The square of their product: by Cauchy and Binet the sum over all pairs of columns.
        let mut determinant_squared = 0.0;
        for (i, [ax, ay]) in steps.into_iter().enumerate() {
            (uu, uv, vv) = (uu + ax * ax, uv + ax * ay, vv + ay * ay);
            for [bx, by] in &steps[i + 1..] {
                determinant_squared += (ax * by - ay * bx) * (ax * by - ay * bx);
            }
        }
        let half_difference = 0.5 * (uu - vv);
        let root = (half_difference * half_difference + uv * uv).sqrt();
        let major_squared = 0.5 * (uu + vv) + root;
        if major_squared < 1.0 {
            return Self { width_squared: 1.0, major_squared, row: None };
        }
        let major = major_squared;
        // The true minor axis, where it is above one texel.
        let minor = (determinant_squared / major).max(major / (max_ratio * max_ratio)).max(1.0);
        let round = ROUND * ROUND * minor;
        let width_squared = 0.5 * (minor + major.min(round));
        let row = (major > round).then(|| {
            // The better conditioned of the two expressions for the eigenvector. The axes differ
            // enough for one of them.
            let (x, y) =
                if uu >= vv { (half_difference + root, uv) } else { (uv, root - half_difference) };
            let norm = (x * x + y * y).sqrt();
            ProbeRow { length: (major - round).sqrt(), direction: [x / norm, y / norm] }
        });
        Self { width_squared, major_squared, row }
    }

    /// Calls `visit` with the offset from the middle, in texels, and the weight of each probe. The
    /// weights add up to 1.
    ///
    /// Each half of the row is cut into cells one probe wide, counted from the middle; the last
    /// one is as long as what is left, so that a new cell begins without weight.
    #[inline]
    pub(super) fn probes(&self, mut visit: impl FnMut([f32; 2], f32)) {
        let Some(ProbeRow { length, direction }) = self.row else {
            return visit([0.0, 0.0], 1.0);
        };
        let (half, cell) = (0.5 * length, self.width_squared.sqrt());
        let mut start = 0.0;
        while start < half {
            let end = (start + cell).min(half);
            let weight = (end - start) / length;
            let [x, y] = direction.map(|component| component * 0.5 * (start + end));
            visit([x, y], weight);
            visit([-x, -y], weight);
            start += cell;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn probes(footprint: &Footprint) -> Vec<([f32; 2], f32)> {
        let mut list = Vec::new();
        footprint.probes(|offset, weight| list.push((offset, weight)));
        list
    }

    #[test]
    fn round_patch_is_one_probe() {
        let footprint = Footprint::new([[3.0, 0.0], [0.0, 3.0]], 16.0);
        assert!((footprint.width_squared - 9.0).abs() < 1e-5);
        assert_eq!(probes(&footprint), vec![([0.0, 0.0], 1.0)]);
    }

    #[test]
    fn long_patch_is_a_row_along_its_major_axis() {
        // Rotated by 30 degrees: major axis 12 along (cos, sin), minor 3.
        let (sin, cos) = 30.0_f64.to_radians().sin_cos();
        let footprint = Footprint::new([[12.0 * cos, 12.0 * sin], [-3.0 * sin, 3.0 * cos]], 16.0);
        let list = probes(&footprint);
        assert!((list.iter().map(|(_, weight)| weight).sum::<f32>() - 1.0).abs() < 1e-5);
        let mut variance = 0.0;
        for ([x, y], weight) in &list {
            assert!((f64::from(*x) * sin - f64::from(*y) * cos).abs() < 1e-5, "off the axis");
            variance += weight * (x * x + y * y);
        }
        // Variance of a uniform average over 12 texels, less what each probe's own width adds.
        let expected = (144.0 - footprint.width_squared) / 12.0;
        assert!((variance / expected - 1.0).abs() < 0.1, "{variance} {expected}");
    }

    #[test]
    fn what_draws_a_patch_out_adds_to_its_second_moments() {
        // A disc of 3 texels, drawn out by 4 along (cos, sin): axes of 5 and 3.
        let (sin, cos) = 40.0_f64.to_radians().sin_cos();
        let drawn = Footprint::new([[0.0, 3.0], [-3.0, 0.0], [4.0 * cos, 4.0 * sin]], 16.0);
        let same = Footprint::new([[5.0 * cos, 5.0 * sin], [-3.0 * sin, 3.0 * cos]], 16.0);
        assert!((drawn.major_squared - 25.0).abs() < 1e-4);
        assert!((drawn.width_squared - same.width_squared).abs() < 1e-4);
        let [one, other] = [drawn, same].map(|patch| probes(&patch));
        assert_eq!(one.len(), other.len());
        for (one, other) in one.iter().zip(&other) {
            assert!((one.0[0] - other.0[0]).abs() < 1e-4 && (one.0[1] - other.0[1]).abs() < 1e-4);
        }
        // Nothing more is nothing.
        let plain = [[1.7, 0.3], [-0.2, 2.9]];
        let more = [plain[0], plain[1], [0.0; 2]];
        assert_eq!(Footprint::new(plain, 16.0), Footprint::new(more, 16.0));
    }

    #[test]
    fn ratio_is_limited_and_degenerate_patches_are_harmless() {
        let line = Footprint::new([[160.0, 0.0], [0.0, 0.0]], 16.0);
        assert!(line.width_squared >= 100.0);
        assert!(probes(&line).len() <= 20);
        for bad in [0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 5e-324] {
            for other in [0.0, 1.0, f64::NAN] {
                let footprint = Footprint::new([[bad, other], [other, bad]], 16.0);
                let list = probes(&footprint);
                assert!(list.len() <= 40, "{bad} {other}: {}", list.len());
                assert!(footprint.width_squared.is_finite());
                assert!(list.iter().all(|(at, weight)| at[0].is_finite() && weight.is_finite()));
            }
        }
    }
}
