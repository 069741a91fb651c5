//! Two views held against each other.

use super::{
    BestShift, DEFAULT_PIXELS_PER_DEGREE, MeasureError, PixelMask, View, best_shift, correlation,
    flip, structural_similarity,
};
use serde::Serialize;

/// How alike two views are, over the whole picture and over a part of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Width of the pictures.
    pub width_pixels: usize,
    /// Height of the pictures.
    pub height_pixels: usize,
    /// Over the whole picture.
    pub picture: Figures,
    /// Over the part, if there is one.
    pub region: Option<Figures>,
}

/// How alike two views are over a region. Triples are of red, green and blue.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// How many pixels the region has.
    pub pixels: usize,
    /// Zero-mean normalized cross-correlation in linear light; `None` without contrast.
    pub correlation: [Option<f64>; 3],
    /// Its maximum over shifts of whole pixels, and where that is.
    pub correlation_maximum: Shifted,
    /// Root mean square of the difference in linear light.
    pub rms_difference: [f64; 3],
    /// Mean structural similarity ([`structural_similarity`]).
    pub structural_similarity: f64,
    /// Mean FLIP at the standard distance ([`flip`](super::flip())).
    pub flip: f64,
    /// Second less first time of flight, where both views have one.
    pub time_of_flight_difference: Option<FlightFigures>,
    /// Mean share of the power that reaches the photograph, first and second view.
    pub delivered: [Option<f64>; 2],
}

/// The best shift of each channel.
pub type Shifted = [Option<BestShift>; 3];

/// What a map of differences of times of flight shows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FlightFigures {
    /// In how many pixels there is a difference.
    pub pixels: usize,
    /// The largest difference, of either sign, ns.
    pub maximum_ns: f64,
    /// The largest share, of either sign, that a difference is of the time of flight in its pixel.
    pub maximum_relative: f64,
    /// The mean, ns.
    pub mean_ns: f64,
    /// Root mean square about the mean, ns: a constant delay is no flaw of a cloak.
    pub rms_about_mean_ns: f64,
}

impl FlightFigures {
    /// How late a view is against the empty one over a region; `None` where it has no times.
    #[must_use]
    pub fn delays(view: &View, region: &PixelMask) -> Option<Self> {
        let times = view.time_of_flight.as_ref()?;
        let differences = view.time_of_flight_difference.as_ref()?;
        Self::of(region.indices().map(|i| (differences[i], times[i] - differences[i])))
    }

    /// The figures of differences and the times of flight that they are to be held against, ns;
    /// what is not finite is left out, and `None` is what remains of nothing.
    fn of(pairs: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let pairs: Vec<(f64, f64)> =
            pairs.filter(|(difference, flight)| difference.is_finite() && *flight > 0.0).collect();
        let pixels = pairs.len();
        let count = pixels as f64;
        let mean_ns = pairs.iter().map(|(difference, _)| difference).sum::<f64>() / count;
        let squares: f64 = pairs.iter().map(|(difference, _)| (difference - mean_ns).powi(2)).sum();
        let largest = |value: &dyn Fn(&(f64, f64)) -> f64| {
            pairs.iter().map(value).max_by(|a, b| a.abs().total_cmp(&b.abs()))
        };
        Some(Self {
            pixels,
            maximum_ns: largest(&|pair| pair.0)?,
            maximum_relative: largest(&|pair| pair.0 / pair.1)?,
            mean_ns,
            rms_about_mean_ns: (squares / count).sqrt(),
        })
    }
}

/// Compares two views, over the whole picture and, if given, over a region. The region is what is
/// looked at in the second view; with shifts, it is looked for in all of the first.
///
/// # Errors
///
/// If the sizes differ, or there is not enough memory.
pub fn compare(a: &View, b: &View, region: Option<&PixelMask>) -> Result<Comparison, MeasureError> {
    let size = [a.width, a.height];
    let others = [Some([b.width, b.height]), region.map(PixelMask::size)];
    if let Some(second) = others.into_iter().flatten().find(|other| *other != size) {
        return Err(MeasureError::SizesDiffer { first: size, second });
    }
    // Nothing else takes as much.
    correlation::check_memory(a)?;
    let differences = flip(a, b, DEFAULT_PIXELS_PER_DEGREE);
    let over = |region: &PixelMask| figures(a, b, region, &differences);
    Ok(Comparison {
        width_pixels: a.width,
        height_pixels: a.height,
        picture: over(&PixelMask::whole(a))?,
        region: region.map(over).transpose()?,
    })
}

fn figures(
    a: &View,
    b: &View,
    region: &PixelMask,
    differences: &[f64],
) -> Result<Figures, MeasureError> {
    let channels = [0, 1, 2].map(|color| (&a.light[color], &b.light[color]));
    let flights = a.time_of_flight.as_ref().zip(b.time_of_flight.as_ref());
    let delivered = |view: &View| view.delivered.as_ref().map(|power| region.mean(|i| power[i]));
    Ok(Figures {
        pixels: region.pixels(),
        correlation: channels.map(|(a, b)| correlation(a, b, region)),
        correlation_maximum: best_shift(a, b, region)?,
        rms_difference: channels.map(|(a, b)| region.mean(|i| (a[i] - b[i]).powi(2)).sqrt()),
        structural_similarity: structural_similarity(a, b, region),
        flip: region.mean(|i| differences[i]),
        time_of_flight_difference: flights
            .and_then(|(a, b)| FlightFigures::of(region.indices().map(|i| (b[i] - a[i], a[i])))),
        delivered: [delivered(a), delivered(b)],
    })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A picture of one gray.
    pub fn even(light: f64) -> View {
        View::new(20, 16, std::array::from_fn(|_| vec![light; 320])).expect("a view")
    }

    /// Two colored patterns, one of them moved and changed.
    pub fn patterns() -> [View; 2] {
        let (width, height) = (56, 40);
        [(0.0, 0.0), (2.0, 1.0)].map(|(shift, k)| {
            let plane = |value: &dyn Fn(f64, f64) -> f64| {
                let place = |i: usize| ((i % width) as f64 - shift, (i / width) as f64);
                // In single precision, as the pictures for the numbers in the tests were.
                (0..width * height)
                    .map(|i| f64::from(value(place(i).0, place(i).1) as f32))
                    .collect::<Vec<f64>>()
            };
            let light = [
                plane(&|u, y| 0.5 + 0.45 * (0.31 * u + 0.17 * y + 0.2 * k).sin()),
                plane(&|u, y| 0.5 + 0.4 * (0.23 * u - 0.29 * y).cos()),
                plane(&|u, y| {
                    let tile = (u / 6.0).floor() + (y / 5.0).floor();
                    0.8 * tile.rem_euclid(2.0) + 0.1
                }),
            ];
            View::new(width, height, light).expect("a view")
        })
    }

    #[test]
    fn a_view_is_like_itself() {
        let [a, b] = patterns();
        let figures = compare(&a, &a, None).expect("one size").picture;
        assert!(figures.correlation.iter().all(|c| (c.expect("contrast") - 1.0).abs() < 1e-14));
        assert_eq!((figures.rms_difference, figures.flip), ([0.0; 3], 0.0));
        assert_eq!(figures.time_of_flight_difference, None);
        let other = compare(&a, &b, None).expect("one size").picture;
        assert!(other.structural_similarity < 0.9 && other.flip > 0.1);
        // The checks have moved by two pixels and nothing else.
        let moved = other.correlation_maximum[2].expect("contrast");
        assert_eq!(moved.shift_pixels, [2, 0]);
    }

    #[test]
    fn figures_of_a_part_are_those_of_the_part_alone() {
        let [a, mut b] = patterns();
        b.light = a.light.clone();
        // Something happens in the left upper corner only.
        for plane in &mut b.light {
            plane[57] = 1.0 - plane[57];
        }
        let right = PixelMask::rectangle(&a, [30, 0, 26, 40]).expect("inside");
        let comparison = compare(&a, &b, Some(&right)).expect("one size");
        assert!(comparison.picture.flip > 0.0 && comparison.picture.rms_difference[0] > 0.0);
        let part = comparison.region.expect("a region");
        assert_eq!((part.pixels, part.flip, part.rms_difference), (1040, 0.0, [0.0; 3]));
    }

    #[test]
    fn times_are_compared_where_both_are_there() {
        let mut a = even(0.5);
        let mut b = even(0.5);
        a.time_of_flight = Some(vec![5.0; 320]);
        let mut late = vec![5.25; 320];
        late[7] = f64::NAN;
        late[9] = 4.5;
        b.time_of_flight = Some(late);
        b.delivered = Some(vec![0.5; 320]);
        let figures = compare(&a, &b, None).expect("one size").picture;
        let flight = figures.time_of_flight_difference.expect("times");
        assert_eq!((flight.pixels, flight.maximum_ns, flight.maximum_relative), (319, -0.5, -0.1));
        let mean = (318.0 * 0.25 - 0.5) / 319.0;
        assert!((flight.mean_ns - mean).abs() < 1e-12);
        let square: f64 = (318.0 * 0.0625 + 0.25) / 319.0 - mean * mean;
        assert!((flight.rms_about_mean_ns - square.sqrt()).abs() < 1e-12);
        assert_eq!(figures.delivered, [None, Some(0.5)]);
    }

    #[test]
    fn sizes_must_agree() {
        let [a, _] = patterns();
        let message = compare(&a, &even(0.0), None).expect_err("must fail").to_string();
        assert!(message.contains("56 x 40") && message.contains("20 x 16"), "{message}");
        let region = PixelMask::whole(&even(0.0));
        assert!(compare(&a, &a, Some(&region)).is_err());
    }
}
