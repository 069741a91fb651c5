//! What the numbers of a channel are, and the units that suit their size.

/// What a channel holds, for its label.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// What it is called, as in `time-of-flight difference`.
    pub title: String,
    /// What its numbers count.
    pub dimension: Dimension,
}

/// What numbers count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Times in ns.
    Time,
    /// Shares of the power, 1 being all of it.
    Share,
    /// Anything else, which has no unit.
    Number,
}

/// A unit to print numbers in.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// How much it is in the channel's numbers: 1e-3 for ps in a channel in ns.
    pub size: f64,
    /// Its symbol; empty for plain numbers.
    pub symbol: String,
}

/// Units of time from 1e9 ns down, each a thousandth of the one before (SI prefixes down to
/// quecto).
const TIMES: [&str; 11] = ["s", "ms", "µs", "ns", "ps", "fs", "as", "zs", "ys", "rs", "qs"];

impl Quantity {
    /// What a channel of that name holds; its name with spaces if it is none of the known ones.
    #[must_use]
    pub fn of_channel(name: &str) -> Self {
        let (title, dimension) = match name {
            "time_of_flight" => ("time of flight", Dimension::Time),
            "time_of_flight_spread" => ("time-of-flight spread", Dimension::Time),
            "time_of_flight_difference" => ("time-of-flight difference", Dimension::Time),
            "group_delay" => ("group delay", Dimension::Time),
            "group_delay_spread" => ("group-delay spread", Dimension::Time),
            "group_delay_difference" => ("group-delay difference", Dimension::Time),
            "first_pulse_depth" => ("depth by the first pulse, cm", Dimension::Number),
            "strongest_pulse_depth" => ("depth by the strongest pulse, cm", Dimension::Number),
            "delivered" => ("power delivered", Dimension::Share),
            "escaped" => ("power escaped", Dimension::Share),
            "absorbed" => ("power absorbed", Dimension::Share),
            "pruned" => ("power pruned", Dimension::Share),
            "extraordinary_share" => ("share in the extraordinary wave", Dimension::Share),
            "first_face_reflectance" => ("first-face reflectance", Dimension::Share),
            other => (other, Dimension::Number),
        };
        Self { title: title.replace('_', " "), dimension }
    }

    /// Numbers whose unit, if they have one, is in the title.
    #[must_use]
    pub fn named(title: &str) -> Self {
        Self { title: title.to_owned(), dimension: Dimension::Number }
    }

    /// The unit for numbers of that size: that in which it lies between 1 and 1000 for times,
    /// percent down to 0.1 % for shares, and powers of a thousand beyond.
    #[must_use]
    pub fn unit(&self, size: f64) -> Unit {
        let size = size.abs();
        // Zero suits any unit.
        let size = if size > 0.0 && size.is_finite() { size } else { 1.0 };
        let power = exponent(size).div_euclid(3) * 3;
        match self.dimension {
            Dimension::Time => {
                let symbol = usize::try_from((9 - power) / 3).ok().and_then(|k| TIMES.get(k));
                let powers = || format!("1e{} s", power - 9);
                Unit {
                    size: power_of_ten(power),
                    symbol: symbol.map_or_else(powers, |s| (*s).into()),
                }
            }
            Dimension::Share if size >= 1e-3 => Unit { size: 1e-2, symbol: "%".to_owned() },
            Dimension::Number if (1e-3..1e4).contains(&size) => {
                Unit { size: 1.0, symbol: String::new() }
            }
            Dimension::Share | Dimension::Number => {
                Unit { size: power_of_ten(power), symbol: format!("1e{power}") }
            }
        }
    }
}

/// A label of that text with the unit in brackets, if it has one.
pub(super) fn with_unit(text: &str, unit: &str) -> String {
    if unit.is_empty() { text.to_owned() } else { format!("{text} ({unit})") }
}

/// The exponent of a number in scientific notation: 2 for 345; 0 if it is zero or not finite.
pub(super) fn exponent(number: f64) -> i32 {
    // By way of the digits, for logarithms may round across a power of ten.
    format!("{number:e}").split_once('e').and_then(|(_, digits)| digits.parse().ok()).unwrap_or(0)
}

/// The number nearest to a power of ten.
pub(super) fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::INFINITY)
}

/// The true minus sign.
pub(super) const MINUS: &str = "\u{2212}";

/// The digits of a number with the true minus sign.
pub(super) fn with_minus(digits: &str) -> String {
    digits.replace('-', MINUS)
}

/// A number with so many decimals at most.
#[must_use]
pub fn short(number: f64, decimals: usize) -> String {
    let digits = format!("{number:.decimals$}");
    let short = match digits.contains('.') {
        true => digits.trim_end_matches('0').trim_end_matches('.'),
        false => &digits,
    };
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_get_their_prefix() {
        let time = Quantity::of_channel("time_of_flight_difference");
        let symbol = |size| time.unit(size).symbol;
        assert_eq!(time.title, "time-of-flight difference");
        for (size, expected) in [
            (3.3, "ns"),
            (-0.5, "ps"),
            (0.0, "ns"),
            (1e-6, "fs"),
            (9.99e-7, "as"),
            (4e-12, "zs"),
            (1e-15, "ys"),
            (7e-18, "rs"),
            (7e-21, "qs"),
            (7e-23, "1e-33 s"),
            (5e3, "µs"),
            (5e6, "ms"),
            (5e9, "s"),
            (5e12, "1e3 s"),
            (f64::NAN, "ns"),
        ] {
            assert_eq!(symbol(size), expected, "{size}");
        }
        assert_eq!(time.unit(2e-15).size, 1e-15);
        assert_eq!(time.unit(7e-23).size, 1e-24);
    }

    #[test]
    fn shares_are_percentages() {
        let share = Quantity::of_channel("delivered");
        assert_eq!(share.unit(1.0), Unit { size: 0.01, symbol: "%".into() });
        assert_eq!(share.unit(2e-9), Unit { size: 1e-9, symbol: "1e-9".into() });
        assert_eq!(with_unit(&share.title, &share.unit(0.0).symbol), "power delivered (%)");
    }

    #[test]
    fn other_channels_are_numbers() {
        let number = Quantity::of_channel("horizontal.R_x");
        assert_eq!(number.title, "horizontal.R x");
        assert_eq!(with_unit("a", &number.unit(0.4).symbol), "a");
        assert_eq!(number.unit(5e6).symbol, "1e6");
    }

    #[test]
    fn short_numbers_keep_their_sign() {
        for (number, decimals, expected) in [
            (-0.5, 6, "-0.5"),
            (-0.001, 2, "0"),
            (-0.0, 0, "0"),
            (200.0, 0, "200"),
            (2.5, 3, "2.5"),
        ] {
            assert_eq!(short(number, decimals), expected);
        }
    }

    #[test]
    fn exponents_are_those_of_the_digits() {
        for (number, expected) in
            [(0.0, 0), (1.0, 0), (999.9, 2), (1000.0, 3), (1e-15, -15), (-0.02, -2), (5e-324, -324)]
        {
            assert_eq!(exponent(number), expected);
        }
        assert_eq!(exponent(f64::NAN), 0);
        assert_eq!(exponent(f64::INFINITY), 0);
        assert_eq!(power_of_ten(-24), 1e-24);
    }
}
