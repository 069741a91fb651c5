//! The camera's gate: bins of time, and how a pulse falls into them.

use std::f64::consts::PI;
use std::fmt;
use std::str::FromStr;

/// Most bins of a gate.
pub const MOST_BINS: usize = 100_000;

/// When the camera's gate is open: bins of equal length, one after the other.
///
/// A bin takes all of the light at its middle, and less and less of it, in proportion, up to the
/// middles of the bins beside it. So the bins together take each pulse whole, and the mean of
/// their middles, weighted by what is in them, is when it arrives: nothing is rounded to a bin.
///
/// It is written `START..END:STEP` in ns, as in `5.0..5.4:0.005`: the middles of the first and of
/// the last bin, which is the last one that is not beyond END, and the length of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    start: f64,
    step: f64,
    bins: usize,
}

/// What is wrong with a gate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GateError {
    /// It is not written as one.
    #[error("`{0}` is no gate; write START..END:STEP in ns, as in 5.0..5.4:0.005")]
    Unreadable(String),
    /// Its end is not after its start, or its step is not above 0.
    #[error("the gate {0} has no bins: END comes after START, and STEP is above 0")]
    Empty(String),
    /// It has too many bins.
    #[error("the gate {0} has more than {MOST_BINS} bins; take a longer STEP")]
    TooMany(String),
}

impl Gate {
    /// The bins whose middles are `start`, `start + step` and so on, up to `end`, ns.
    ///
    /// # Errors
    ///
    /// If there are none, or too many.
    pub fn new([start, end]: [f64; 2], step: f64) -> Result<Self, GateError> {
        let text = || format!("{start}..{end}:{step}");
        // No comparison holds of what is no number.
        if !(start.is_finite() && end.is_finite() && end >= start && step > 0.0) {
            return Err(GateError::Empty(text()));
        }
        // The end belongs to it, whatever rounding makes of it.
        const ROUNDING: f64 = 1e-6;
        let steps = ((end - start) / step + ROUNDING).floor();
        if steps >= MOST_BINS as f64 {
            return Err(GateError::TooMany(text()));
        }
        Ok(Self { start, step, bins: steps as usize + 1 })
    }

    /// About so many bins, of a round length, that hold all of this range of times (ns).
    #[must_use]
    pub fn around([first, last]: [f64; 2], bins: usize) -> Self {
        /// Light takes so long for 0.3 mm.
        const SHORTEST: f64 = 1e-3;
        let least = ((last - first) / bins.max(1) as f64).max(SHORTEST);
        let decade = 10_f64.powf(least.log10().floor());
        let round = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * decade);
        let step = round.into_iter().find(|step| *step >= least * (1.0 - 1e-9)).unwrap_or(least);
        // A bin before and one after.
        let start = (first / step).floor() - 1.0;
        let end = (last / step).ceil() + 1.0;
        let bins = (end - start).clamp(0.0, MOST_BINS as f64 - 1.0) as usize + 1;
        Self { start: start * step, step, bins }
    }

    /// How many bins it has.
    #[must_use]
    pub fn bins(&self) -> usize {
        self.bins
    }

    /// How long a bin is, ns.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// How exact a clock is that shows the middles of all bins, ns: to the length of a bin, or further where the gate starts
    /// between its multiples.
    #[must_use]
    pub fn clock(&self) -> f64 {
        let is_multiple = |time: f64, unit: f64| {
            let count = time / unit;
            (count - count.round()).abs() < 1e-6
        };
        let decade = 10_f64.powf(self.step.log10().floor());
        let finer = [1.0, 0.1, 0.01, 1e-3].map(|part| part * decade);
        let shows_all = |unit: &f64| [self.start, self.step].iter().all(|t| is_multiple(*t, *unit));
        [self.step].into_iter().chain(finer).find(shows_all).unwrap_or(self.step)
    }

    /// The middle of a bin, counted from 0, ns.
    #[must_use]
    pub fn middle(&self, bin: usize) -> f64 {
        self.start + self.step * bin as f64
    }

    /// The middles of all bins, ns.
    #[must_use]
    pub fn middles(&self) -> Vec<f64> {
        (0..self.bins).map(|bin| self.middle(bin)).collect()
    }

    /// Gives `take` the share of each bin that gets something of a pulse which arrives at a time
    /// (ns) and is so long at half its height (ns); the share that comes before all bins, and the one
    /// after them. All shares add up to 1.
    pub fn shares(&self, time: f64, width: f64, mut take: impl FnMut(usize, f64)) -> [f64; 2] {
        let place = (time - self.start) / self.step;
        let width = width / self.step;
        // The bins from the first that gets something to the last.
        let [first, last] = [(place - width).floor(), (place + width).floor() + 1.0];
        if last < 0.0 {
            return [1.0, 0.0];
        }
        if first >= self.bins as f64 {
            return [0.0, 1.0];
        }
        // What all bins up to one get: the mean, over the length of a bin, of what has arrived.
        let up_to = |bin: f64| {
            let [from, to] = [bin - place, bin + 1.0 - place];
            if to <= -width {
                0.0
            } else if from >= width {
                1.0
            } else {
                arrived(to, width) - arrived(from, width)
            }
        };
        let first = first.max(0.0);
        let last = last.min(self.bins as f64 - 1.0);
        let before = up_to(first - 1.0);
        let mut sum = before;
        for bin in first as usize..=last as usize {
            let next = up_to(bin as f64);
            take(bin, next - sum);
            sum = next;
        }
        [before, 1.0 - sum]
    }

    /// The share of a pulse of that width (ns) in a bin in whose middle it arrives.
    #[must_use]
    pub fn largest_share(&self, width: f64) -> f64 {
        let width = width / self.step;
        arrived(1.0, width) - 2.0 * arrived(0.0, width) + arrived(-1.0, width)
    }
}

/// The integral over time of what has arrived of a pulse of the shape cos², which is so long at
/// half its height, `after` its middle.
fn arrived(after: f64, width: f64) -> f64 {
    if after <= -width {
        0.0
    } else if after >= width {
        after
    } else {
        let from_start = after + width;
        from_start * from_start / (4.0 * width)
            - width / (2.0 * PI * PI) * ((PI * after / width).cos() + 1.0)
    }
}

impl fmt::Display for Gate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Without the rounding of the last digits.
        let number = |number: f64| {
            let digits = format!("{number:.12}");
            digits.trim_end_matches('0').trim_end_matches('.').to_owned()
        };
        let [start, end] = [self.start, self.middle(self.bins - 1)].map(number);
        write!(f, "{start}..{end}:{}", number(self.step))
    }
}

impl FromStr for Gate {
    type Err = GateError;

    fn from_str(text: &str) -> Result<Self, GateError> {
        let parts = || {
            let (range, step) = text.split_once(':')?;
            let (start, end) = range.split_once("..")?;
            let number = |text: &str| text.trim().parse::<f64>().ok();
            Some(([number(start)?, number(end)?], number(step)?))
        };
        let (range, step) = parts().ok_or_else(|| GateError::Unreadable(text.to_owned()))?;
        Self::new(range, step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn gates_are_read() {
        let gate: Gate = "5.0..5.4:0.005".parse().expect("a gate");
        assert_eq!((gate.bins(), gate.step()), (81, 0.005));
        assert!((gate.middle(80) - 5.4).abs() < 1e-12);
        assert_eq!("0..1:0.3".parse::<Gate>().map(|gate| gate.bins()), Ok(4));
        for text in ["5..6", "5:1", "a..b:c", "", "1..2:3:4"] {
            assert!(matches!(text.parse::<Gate>(), Err(GateError::Unreadable(_))), "{text}");
        }
        for text in ["5..4:0.1", "1..2:0", "1..2:-1", "nan..2:1", "0..inf:1"] {
            assert!(matches!(text.parse::<Gate>(), Err(GateError::Empty(_))), "{text}");
        }
        assert!(matches!("0..1:1e-9".parse::<Gate>(), Err(GateError::TooMany(_))));
    }

    #[test]
    fn a_range_of_times_gets_round_bins() {
        let gate = Gate::around([5.013, 5.397], 128);
        assert_eq!(gate.step(), 0.005);
        assert!(gate.middle(0) <= 5.013 - 0.005 && gate.middle(gate.bins() - 1) >= 5.397 + 0.005);
        assert!(gate.bins() <= 131);
        assert_eq!(Gate::around([5.0, 5.0], 128).step(), 1e-3);
        let gate = Gate::around([5.1004, 5.6451], 120);
        assert_eq!(gate.to_string(), "5.095..5.655:0.005");
        assert_eq!(gate.to_string().parse::<Gate>().map(|gate| gate.bins()), Ok(gate.bins()));
    }

    #[test]
    fn a_clock_shows_the_middles_of_all_bins() {
        for (gate, clock) in [
            ("5..5.4:0.005", 0.005),
            ("5.02..5.42:0.1", 0.01),
            ("4.85..6.85:0.1", 0.01),
            ("0.25..9:1", 0.01),
            ("0..1:0.0333333", 0.0333333),
            ("3..9:2", 1.0),
        ] {
            let found = gate.parse::<Gate>().expect("a gate").clock();
            assert!((found / clock - 1.0).abs() < 1e-9, "{gate}: {found}");
        }
    }

    #[test]
    fn a_pulse_is_shared_by_the_two_bins_beside_it() {
        let gate = Gate::new([0.0, 3.0], 1.0).expect("a gate");
        let mut shares = Vec::new();
        let outside = gate.shares(1.25, 0.0, |bin, share| shares.push((bin, share)));
        assert_eq!((outside, shares), ([0.0; 2], vec![(1, 0.75), (2, 0.25)]));
        assert_eq!(gate.shares(-0.25, 0.0, |_, _| ()), [0.25, 0.0]);
        assert_eq!(gate.shares(3.25, 0.0, |_, _| ()), [0.0, 0.25]);
        assert_eq!(gate.shares(-7.0, 0.0, |_, _| ()), [1.0, 0.0]);
        assert_eq!(gate.shares(70.0, 0.0, |_, _| ()), [0.0, 1.0]);
    }

    /// By Simpson's rule over the pulse times the bin.
    #[test]
    fn shares_of_a_long_pulse_are_its_integrals() {
        let gate = Gate::new([0.0, 9.0], 0.5).expect("a gate");
        let (time, width) = (3.17, 1.3);
        let pulse = |t: f64| {
            let x = (t - time) / width;
            if x.abs() < 1.0 { (0.5 * PI * x).cos().powi(2) / width } else { 0.0 }
        };
        assert!((pulse(time + width / 2.0) - 0.5 * pulse(time)).abs() < 1e-12);
        let mut all = 0.0;
        let outside = gate.shares(time, width, |bin, share| {
            let bin = |t: f64| pulse(t) * (1.0 - ((t - gate.middle(bin)) / 0.5).abs()).max(0.0);
            const STEPS: usize = 200_000;
            let step = 9.0 / STEPS as f64;
            let sum: f64 = (0..STEPS).map(|i| bin((i as f64 + 0.5) * step)).sum();
            assert!((sum * step - share).abs() < 1e-8, "{share} {}", sum * step);
            all += share;
        });
        assert!((all - 1.0).abs() < 1e-14 && outside == [0.0; 2], "{all} {outside:?}");
        let mut at_middle = 0.0;
        gate.shares(3.0, width, |bin, share| at_middle += if bin == 6 { share } else { 0.0 });
        assert!((gate.largest_share(width) - at_middle).abs() < 1e-14);
        assert_eq!(gate.largest_share(0.0), 1.0);
    }

    proptest! {
        #[test]
        fn nothing_is_lost_and_nothing_moved(
            time in -5.0..15.0_f64, width in 0.0..4.0_f64, step in 0.01..2.0_f64,
        ) {
            let gate = Gate::new([0.0, 10.0], step).expect("a gate");
            let (mut sum, mut moment) = (0.0, 0.0);
            let [before, after] = gate.shares(time, width, |bin, share| {
                assert!((-1e-13..=1.0 + 1e-13).contains(&share));
                sum += share;
                moment += share * gate.middle(bin);
            });
            prop_assert!((sum + before + after - 1.0).abs() < 1e-13);
            let last = gate.middle(gate.bins() - 1);
            if time - width > 0.0 && time + width < last {
                prop_assert!(before == 0.0 && after.abs() < 1e-13);
                prop_assert!((moment - time).abs() < 1e-12, "{} {}", moment, time);
            }
        }
    }
}
