//! Which colour a number gets.

use cloakroom::scene::{Colormap, PictureSettings};
use image::Rgb;

/// The colours for a set of numbers.
///
/// The range goes from the least to the greatest of the finite numbers, unless a few outliers
/// would leave the rest without contrast: where the extreme 0.1 % on one side stretch further than
/// the 99.8 % in the middle, the range ends at the 0.1 or 99.9 percentile on that side, and
/// numbers beyond get the colour of its end ([`is_clipped`](Self::is_clipped)).
///
/// The colours are viridis unless others are asked for: it is perceptually uniform, and reads in
/// gray and with most deficiencies of colour vision. Diverging colours are centred on 0.
///
/// Numbers that are not finite are gray. Numbers that all agree get the colour in the middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorScale {
    /// The least and the greatest number that have a colour of their own; equal if all numbers
    /// agree, none if no number is finite.
    pub range: Option<(f64, f64)>,
    /// Whether there are numbers below and above the range.
    pub is_clipped: (bool, bool),
    /// Whether there are numbers that are not finite.
    pub has_gaps: bool,
    /// The colours; never [`Colormap::Auto`] as it is made here.
    pub colors: Colormap,
}

/// The share of the numbers on each side that may be outliers.
const OUTLIERS: f64 = 1e-3;

/// The colour where there is no number: a neutral gray that is not in the map.
pub(super) const NOTHING: Rgb<u8> = Rgb([160, 160, 160]);

impl ColorScale {
    /// The colours for those numbers. Numbers that differ by no more than `rounding`, relative to
    /// the largest, count as equal.
    #[must_use]
    pub fn new(numbers: impl Iterator<Item = f64>, rounding: f64) -> Self {
        Self::of(numbers, rounding, &PictureSettings::default())
    }

    /// The same, with what a scene says of the range and the colours.
    #[must_use]
    pub fn of(
        numbers: impl Iterator<Item = f64>,
        rounding: f64,
        settings: &PictureSettings,
    ) -> Self {
        let mut has_gaps = false;
        let is_finite = |number: &f64| {
            has_gaps |= !number.is_finite();
            number.is_finite()
        };
        let mut finite: Vec<f64> = numbers.filter(is_finite).collect();
        let colors = match settings.colormap {
            Colormap::Auto => Colormap::Viridis,
            colors => colors,
        };
        let scale = Self { range: None, is_clipped: (false, false), has_gaps, colors };
        let Some(last) = finite.len().checked_sub(1) else { return scale };
        let least = finite.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut middle = |share_beside: f64| {
            let rank = (last as f64 * share_beside) as usize;
            let from = *finite.select_nth_unstable_by(rank, f64::total_cmp).1;
            (from, *finite.select_nth_unstable_by(last - rank, f64::total_cmp).1)
        };
        let (low, high) = match (settings.map_range, settings.map_percentile) {
            (Some([low, high]), _) => (low, high),
            (None, Some(percent)) => middle((100.0 - percent) / 200.0),
            (None, None) => {
                let (from, to) = middle(OUTLIERS);
                let most = to - from;
                let low = if most > 0.0 && from - least > most { from } else { least };
                (low, if most > 0.0 && greatest - to > most { to } else { greatest })
            }
        };
        let size = low.abs().max(high.abs());
        let (low, high) = if colors == Colormap::BlueRed { (-size, size) } else { (low, high) };
        let (low, high) = if high - low <= rounding * size {
            let middle = low / 2.0 + high / 2.0;
            (middle, middle)
        } else {
            (low, high)
        };
        let is_clipped = if low < high { (least < low, greatest > high) } else { (false, false) };
        Self { range: Some((low, high)), is_clipped, ..scale }
    }

    /// Whether the range goes to both sides of 0, by a hundredth of it at least.
    pub(super) fn has_both_signs(&self) -> bool {
        let least = |(low, high): (f64, f64)| 0.01 * low.abs().max(high.abs());
        self.range.is_some_and(|range| range.0 < -least(range) && range.1 > least(range))
    }

    /// The colour of a number.
    #[must_use]
    pub fn color(&self, number: f64) -> Rgb<u8> {
        match self.range {
            Some((low, high)) if number.is_finite() => {
                // Halves, for the difference may be beyond the largest number.
                let width = high / 2.0 - low / 2.0;
                let place = (number / 2.0 - low / 2.0) / width;
                self.color_at(if width > 0.0 { place } else { 0.5 })
            }
            _ => NOTHING,
        }
    }

    /// The colour at a place in the range, 0 being its lower and 1 its upper end.
    #[must_use]
    pub fn color_at(&self, place: f64) -> Rgb<u8> {
        let place = match self.range {
            None => return NOTHING,
            Some((low, high)) if low == high => 0.5,
            Some(_) => place,
        };
        let (colors, place) = match self.colors {
            Colormap::Auto | Colormap::Viridis => (colorous::VIRIDIS, place),
            Colormap::Cividis => (colorous::CIVIDIS, place),
            Colormap::Magma => (colorous::MAGMA, place),
            Colormap::BlueRed => (colorous::RED_BLUE, 1.0 - place),
        };
        Rgb(colors.eval_continuous(place).into_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(numbers: &[f64]) -> ColorScale {
        ColorScale::new(numbers.iter().copied(), 1e-15)
    }

    fn lightness(Rgb([r, g, b]): Rgb<u8>) -> f64 {
        0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
    }

    #[test]
    fn the_range_is_that_of_the_finite_numbers() {
        let scale = scale(&[3.0, f64::NAN, 1.0, f64::INFINITY, 2.0]);
        assert_eq!(scale.range, Some((1.0, 3.0)));
        assert_eq!(scale.color(f64::NAN), NOTHING);
        assert_eq!(scale.color(f64::NEG_INFINITY), NOTHING);
        assert_eq!(scale.color(1.0), Rgb(colorous::VIRIDIS.eval_continuous(0.0).into_array()));
        assert_eq!(scale.color(9.0), scale.color(3.0));
    }

    #[test]
    fn more_is_lighter() {
        let scale = scale(&[1e-15, 2e-15]);
        let steps: Vec<f64> =
            (0..=20).map(|i| lightness(scale.color(1e-15 + f64::from(i) * 5e-17))).collect();
        assert!(steps.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn degenerate_sets_have_colours() {
        assert_eq!(scale(&[]).range, None);
        assert_eq!(scale(&[f64::NAN]).color(1.0), NOTHING);
        for number in [0.0, -0.0, 7.0, 1e-300, f64::MAX] {
            let same = scale(&[number; 4]);
            assert_eq!(same.range, Some((number, number)));
            assert_eq!(same.color(number), same.color_at(0.0));
            assert_eq!(same.is_clipped, (false, false));
        }
        let noise = scale(&[1.0, 1.0 + f64::EPSILON]);
        assert!(noise.range.is_some_and(|(low, high)| low == high));
        let all = scale(&[-f64::MAX, f64::MAX]);
        assert_eq!(all.color(0.0), all.color_at(0.5));
    }

    #[test]
    fn scenes_say_the_range_and_the_colours() {
        let numbers: Vec<f64> = (0..=1000).map(f64::from).collect();
        let of =
            |settings: PictureSettings| ColorScale::of(numbers.iter().copied(), 0.0, &settings);
        let settings = PictureSettings::default();
        let given = of(PictureSettings { map_range: Some([-5.0, 100.0]), ..settings.clone() });
        assert_eq!((given.range, given.is_clipped), (Some((-5.0, 100.0)), (false, true)));
        let middle = of(PictureSettings { map_percentile: Some(90.0), ..settings.clone() });
        assert_eq!((middle.range, middle.is_clipped), (Some((50.0, 950.0)), (true, true)));
        let diverging = of(PictureSettings { colormap: Colormap::BlueRed, ..settings });
        assert_eq!(diverging.range, Some((-1000.0, 1000.0)));
        // White at 0, blue below and red above.
        let [blue, white, red] = [-900.0, 0.0, 900.0].map(|number| diverging.color(number).0);
        assert!(blue[2] > blue[0] && red[0] > red[2] && white.iter().all(|part| *part > 230));
    }

    #[test]
    fn outliers_do_not_take_the_contrast() {
        let mut numbers: Vec<f64> = (0..10_000).map(f64::from).collect();
        assert_eq!(scale(&numbers).range, Some((0.0, 9999.0)));
        numbers[17] = 1e9;
        let clipped = scale(&numbers);
        assert_eq!(clipped.is_clipped, (false, true));
        assert!(clipped.range.is_some_and(|(low, high)| low == 0.0 && high < 10_000.0));
        // Where nearly all agree, the exceptions are what there is to see.
        let mut few = vec![1.0; 10_000];
        few[3] = 0.0;
        assert_eq!(scale(&few).range, Some((0.0, 1.0)));
    }
}
