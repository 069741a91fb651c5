//! Round numbers along a range, and how they are labelled.

use super::quantity::{MINUS, Quantity, exponent, power_of_ten, short, with_minus, with_unit};

/// The ticks of an axis and the label that says what they count.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Axis {
    /// From low to high.
    pub ticks: Vec<Tick>,
    /// The quantity with its unit.
    pub title: String,
}

/// A labelled place on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Where in the range, 0 being its lower and 1 its upper end.
    pub place: f64,
    /// What is written there.
    pub label: String,
}

/// A distance between ticks: `digits` times ten to the `exponent`.
#[derive(Clone, Copy)]
struct Step {
    digits: f64,
    exponent: i32,
}

/// Ranges narrower than this share of their numbers are labelled by the distance from one of them.
const NARROW: f64 = 1e-4;

/// The ticks for a range, no more than `most` (taken as 3 at least): 4 to 7 of them, 1, 2 or 5
/// times a power of ten apart (2.5 times where those do not give 4 to 7), or fewer where there is
/// room for fewer. A range without width gets one tick in its middle, and none at all a label `no
/// data` there.
pub(super) fn axis(quantity: &Quantity, range: Option<(f64, f64)>, most: usize) -> Axis {
    let Some((low, high)) = range else {
        let ticks = vec![Tick { place: 0.5, label: "no data".to_owned() }];
        return Axis { ticks, title: quantity.title.clone() };
    };
    let size = low.abs().max(high.abs());
    let unit = quantity.unit(size);
    let title = with_unit(&quantity.title, &unit.symbol);
    if low >= high {
        let ticks = vec![Tick { place: 0.5, label: with_minus(&significant(low / unit.size)) }];
        return Axis { ticks, title };
    }
    if high - low >= NARROW * size {
        return Axis { ticks: ticks(low / unit.size, high / unit.size, most), title };
    }
    let width = high - low;
    let decimals = usize::try_from(-exponent(width / unit.size)).unwrap_or(0);
    let origin = format!("{:.decimals$}", low.abs() / unit.size);
    let offset = origin.parse().map_or(low, |origin: f64| origin.copysign(low) * unit.size);
    let sign = if low < 0.0 { "+" } else { MINUS };
    let fine = quantity.unit(width);
    let title = format!("{} {sign} {origin} {}", quantity.title, unit.symbol);
    Axis {
        ticks: ticks((low - offset) / fine.size, (high - offset) / fine.size, most),
        title: with_unit(title.trim_end(), &fine.symbol),
    }
}

/// Ticks between two numbers in the unit of the labels.
fn ticks(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let Some(step) = step(low, high, most.max(3)) else {
        return Vec::new();
    };
    let size = step.size();
    let decimals = usize::try_from(i32::from(step.digits == 2.5) - step.exponent).unwrap_or(0);
    let (first, last) = step.ends(low, high);
    (first as i64..=last as i64)
        .map(|n| {
            let number = n as f64 * size;
            let place = ((number - low) / (high - low)).clamp(0.0, 1.0);
            Tick { place, label: with_minus(&format!("{number:.decimals$}")) }
        })
        .collect()
}

/// The step that gives the best number of ticks.
fn step(low: f64, high: f64, most: usize) -> Option<Step> {
    let largest = exponent(high - low) + 1;
    let steps = |digits: &'static [f64]| {
        (0..4).flat_map(move |down| {
            digits.iter().map(move |digits| Step { digits: *digits, exponent: largest - down })
        })
    };
    let count = |step: &Step| {
        let (first, last) = step.ends(low, high);
        (last - first + 1.0).max(0.0) as usize
    };
    let fits = |step: &Step| (4..=most.min(7)).contains(&count(step));
    let usual = [5.0, 2.0, 1.0].as_slice();
    steps(usual)
        .filter(fits)
        .min_by_key(|step| count(step).abs_diff(5))
        .or_else(|| steps(&[2.5]).find(fits))
        .or_else(|| {
            let few = steps(usual).filter(|step| (1..=most).contains(&count(step)));
            few.max_by_key(count)
        })
}

impl Step {
    /// The distance in numbers.
    fn size(self) -> f64 {
        self.digits * power_of_ten(self.exponent)
    }

    /// The first and the last multiple of the step between two numbers; those that rounding has
    /// moved just outside count.
    fn ends(self, low: f64, high: f64) -> (f64, f64) {
        let slack = 1e-6;
        ((low / self.size() - slack).ceil(), (high / self.size() + slack).floor())
    }
}

/// A number with six significant digits.
fn significant(number: f64) -> String {
    short(number, usize::try_from(5 - exponent(number)).unwrap_or(0).min(12))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(channel: &str, low: f64, high: f64) -> (String, Vec<String>) {
        let axis = axis(&Quantity::of_channel(channel), Some((low, high)), 7);
        (axis.title, axis.ticks.into_iter().map(|tick| tick.label).collect())
    }

    #[test]
    fn labels_are_round_and_in_fitting_units() {
        let (title, ticks) = labels("time_of_flight_difference", -4e-15, 4e-15);
        assert_eq!(title, "time-of-flight difference (ys)");
        assert_eq!(ticks, ["−4", "−2", "0", "2", "4"]);
        let (title, ticks) = labels("delivered", 0.0, 1.0);
        assert_eq!(title, "power delivered (%)");
        assert_eq!(ticks, ["0", "20", "40", "60", "80", "100"]);
        let (title, ticks) = labels("time_of_flight", 3.31, 3.39);
        assert_eq!(title, "time of flight (ns)");
        assert_eq!(ticks, ["3.32", "3.34", "3.36", "3.38"]);
        // Neither 5 nor 2 would give between 4 and 7.
        let ticks = labels("time_of_flight", 0.5, 19.5).1;
        assert_eq!(ticks, ["2.5", "5.0", "7.5", "10.0", "12.5", "15.0", "17.5"]);
        // Whole numbers stay whole.
        let ticks = labels("time_of_flight", 5.0, 195.0).1;
        assert_eq!(ticks, ["25", "50", "75", "100", "125", "150", "175"]);
    }

    #[test]
    fn narrow_ranges_are_counted_from_a_number() {
        let (title, ticks) = labels("time_of_flight", 3.335_640_95, 3.335_640_98);
        assert_eq!(title, "time of flight − 3.33564095 ns (as)");
        assert_eq!(ticks, ["0", "10", "20", "30"]);
        let (title, ticks) = labels("time_of_flight", -3.335_640_98, -3.335_640_95);
        assert_eq!(title, "time of flight + 3.33564098 ns (as)");
        assert_eq!(ticks, ["0", "10", "20", "30"]);
        let (title, _) = labels("other", 1.0, 1.000_01);
        assert_eq!(title, "other − 1.00000 (1e-6)");
    }

    #[test]
    fn a_single_number_is_labelled() {
        assert_eq!(
            labels("delivered", 1.0, 1.0),
            ("power delivered (%)".into(), vec!["100".into()])
        );
        assert_eq!(labels("pruned", 0.0, 0.0).1, ["0"]);
        assert_eq!(labels("pruned", -0.0, -0.0).1, ["0"]);
        assert_eq!(labels("time_of_flight", 3.123_456_789, 3.123_456_789).1, ["3.12346"]);
        assert_eq!(labels("time_of_flight", -0.5, -0.5).1, ["−500"]);
        assert_eq!(labels("other", -0.5, -0.5).1, ["−0.5"]);
        let nothing = axis(&Quantity::of_channel("pruned"), None, 7);
        assert_eq!(nothing.ticks[0].label, "no data");
    }

    #[test]
    fn little_room_gives_few_ticks() {
        for most in 0..8 {
            let quantity = Quantity::of_channel("delivered");
            let ticks = axis(&quantity, Some((0.07, 0.93)), most).ticks;
            assert!((1..=most.max(3)).contains(&ticks.len()));
        }
    }

    proptest! {
        #[test]
        fn every_range_gets_four_to_seven_ticks(
            middle in -1e3..1e3f64,
            width in 1e-6..1e3f64,
            scale in -30..10i32,
        ) {
            let scale = power_of_ten(scale);
            let (low, high) = ((middle - width / 2.0) * scale, (middle + width / 2.0) * scale);
            let axis = axis(&Quantity::of_channel("time_of_flight"), Some((low, high)), 7);
            prop_assert!((4..=7).contains(&axis.ticks.len()), "{axis:?}");
            let places: Vec<f64> = axis.ticks.iter().map(|tick| tick.place).collect();
            prop_assert!(places.windows(2).all(|pair| pair[0] < pair[1]));
            for pair in axis.ticks.windows(2) {
                prop_assert!(pair[0].label != pair[1].label, "{axis:?}");
            }
            for tick in &axis.ticks {
                prop_assert!(tick.label.chars().count() <= 8, "{axis:?}");
            }
        }

        #[test]
        fn no_range_panics(low in proptest::num::f64::ANY, high in proptest::num::f64::ANY) {
            let _ = axis(&Quantity::of_channel("time_of_flight"), Some((low, high)), 7);
            let _ = axis(&Quantity::of_channel("pruned"), Some((low, low)), 7);
        }
    }
}
