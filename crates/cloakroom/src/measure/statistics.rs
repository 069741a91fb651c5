//! Means over draws, with their standard errors.

/// Sums over draws of a list of numbers, by Welford's method (Technometrics 4, 419 (1962)).
#[derive(Clone, Debug, Default)]
pub(super) struct Statistics {
    draws: u32,
    sums: Vec<Sum>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    count: f64,
    mean: f64,
    squares: f64,
}

impl Statistics {
    /// Adds a draw; numbers that are not finite do not count.
    pub fn add(&mut self, numbers: &[f64]) {
        self.draws += 1;
        self.sums.resize(numbers.len(), Sum::default());
        for (sum, number) in self.sums.iter_mut().zip(numbers) {
            if number.is_finite() {
                sum.count += 1.0;
                let off = number - sum.mean;
                sum.mean += off / sum.count;
                sum.squares += off * (number - sum.mean);
            }
        }
    }

    /// The means; NaN where nothing counts.
    pub fn means(&self) -> impl Iterator<Item = f64> {
        self.sums.iter().map(|sum| if sum.count > 0.0 { sum.mean } else { f64::NAN })
    }

    /// The standard errors of the means: the sample's standard deviation over the root of the
    /// number; 0 for one draw, NaN where only one of several, or none, counts.
    pub fn standard_errors(&self) -> impl Iterator<Item = f64> {
        self.sums.iter().map(|sum| match sum.count {
            1.0 if self.draws == 1 => 0.0,
            0.0 | 1.0 => f64::NAN,
            count => (sum.squares / (count - 1.0) / count).sqrt(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_errors_are_those_of_the_textbook() {
        let mut statistics = Statistics::default();
        for numbers in
            [[2.0, 1e9 + 4.0, f64::NAN], [4.0, 1e9 + 7.0, 5.0], [9.0, 1e9 + 13.0, f64::NAN]]
        {
            statistics.add(&numbers);
        }
        let means: Vec<f64> = statistics.means().collect();
        assert_eq!(means, [5.0, 1e9 + 8.0, 5.0]);
        let errors: Vec<f64> = statistics.standard_errors().collect();
        // Variances 13 and 21 of three.
        assert!((errors[0] - (13.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((errors[1] - 7f64.sqrt()).abs() < 1e-12);
        // One number of three draws does not know its error.
        assert!(errors[2].is_nan());
        let mut single = Statistics::default();
        single.add(&[2.0]);
        assert!(single.standard_errors().eq([0.0]));
        let mut nothing = Statistics::default();
        nothing.add(&[f64::NAN]);
        assert!(nothing.means().chain(nothing.standard_errors()).all(f64::is_nan));
    }
}
