//! Which pictures are made on the way to a finished one, and how coarse they are: as fine as time
//! allows.

use crate::protocol::Look;
use std::time::Duration;

/// How long a coarse picture should take: twenty a second, for the browser shows one while the next is made.
const BRISK: Duration = Duration::from_millis(48);

/// How long it may take where it would be very coarse otherwise.
const SLOW: Duration = Duration::from_millis(72);

/// A picture that is smaller by as much, each way, is very coarse.
const VERY_COARSE: f64 = 2.5;

/// A full picture of one sample that takes longer than this is preceded by a coarse one.
const PATIENCE: Duration = Duration::from_millis(120);

/// By how much coarse pictures are smaller, each way.
const DIVISORS: [f64; 9] = [1.0, 1.25, 1.6, 2.0, 2.5, 3.2, 4.0, 5.0, 6.4];

/// That of the first one, when nothing is known.
const FIRST: f64 = 4.0;

/// A size is kept while its pictures take these shares of their time: it should not change from
/// picture to picture.
const KEPT: std::ops::RangeInclusive<f64> = 0.6..=1.15;

/// One picture on the way to the finished one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pass {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub samples: u32,
    /// Whether weak branches are left out, too.
    pub coarse: bool,
    /// Whether it is the last one.
    pub finished: bool,
}

/// How long pictures have taken.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pace {
    /// Nanoseconds a pixel of coarse pictures.
    coarse: Option<f64>,
    /// The same of full pictures of one sample.
    full: Option<f64>,
    /// By how much the last coarse picture was smaller.
    divisor: Option<f64>,
}

impl Pace {
    /// Takes in how long a picture has taken.
    pub fn add(&mut self, pass: Pass, time: Duration) {
        let pixels = f64::from(pass.size[0]) * f64::from(pass.size[1]);
        let each = time.as_nanos() as f64 / pixels;
        match pass {
            // A single one may have been held up.
            Pass { coarse: true, .. } => {
                self.coarse = Some(self.coarse.map_or(each, |before| (before * each).sqrt()));
            }
            Pass { samples: 1, .. } => self.full = Some(each),
            _ => {}
        }
    }

    /// The pictures on the way to a finished one.
    pub fn passes(&mut self, look: &Look) -> Vec<Pass> {
        let pixels = f64::from(look.size[0]) * f64::from(look.size[1]);
        let divisor = self.divisor(pixels);
        let size = look.size.map(|side| ((f64::from(side) / divisor).round() as u32).max(1));
        let coarse = Pass { size, samples: 1, coarse: true, finished: false };
        if look.moving {
            self.divisor = Some(divisor);
            return vec![coarse];
        }
        let quick = self.full.is_some_and(|each| each * pixels < PATIENCE.as_nanos() as f64);
        let mut passes = if quick { Vec::new() } else { vec![coarse] };
        let steps = std::iter::successors(Some(1), |samples| Some(samples * 4));
        let steps = steps.take_while(|samples| *samples < look.samples);
        for samples in steps.chain([look.samples]) {
            let finished = samples == look.samples;
            passes.push(Pass { size: look.size, samples, coarse: false, finished });
        }
        passes
    }

    /// By how much a coarse picture is to be smaller than one of so many pixels.
    fn divisor(&self, pixels: f64) -> f64 {
        let Some(each) = self.coarse else { return FIRST };
        let allowed = |divisor: f64| if divisor < VERY_COARSE { BRISK } else { SLOW };
        let share =
            |divisor: f64| each * pixels / (divisor * divisor) / allowed(divisor).as_nanos() as f64;
        if let Some(last) = self.divisor.filter(|last| KEPT.contains(&share(*last))) {
            return last;
        }
        let fits = |divisor: &f64| share(*divisor) <= 1.0;
        DIVISORS.into_iter().find(fits).unwrap_or(DIVISORS[DIVISORS.len() - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::Beside;

    fn look(moving: bool, samples: u32) -> Look {
        let scene = crate::protocol::SceneTables::new();
        Look {
            id: 1,
            scene,
            size: [640, 480],
            samples,
            moving,
            beside: Beside::Nothing,
            moment: None,
        }
    }

    /// After a full picture, or none, that took so many nanoseconds a pixel.
    fn after(full: Option<f64>) -> Pace {
        Pace { full, ..Pace::default() }
    }

    #[test]
    fn pictures_get_better_step_by_step() {
        let samples = |passes: Vec<Pass>| passes.iter().map(|p| p.samples).collect::<Vec<_>>();
        let first = after(None).passes(&look(false, 16));
        assert!(first[0].coarse && first[0].size == [160, 120]);
        assert_eq!(samples(first), [1, 1, 4, 16]);
        // Quick scenes need no coarse picture.
        assert_eq!(samples(after(Some(100.0)).passes(&look(false, 16))), [1, 4, 16]);
        let last = after(Some(1e5)).passes(&look(false, 10));
        assert_eq!(samples(last.clone()), [1, 1, 4, 10]);
        assert_eq!(last.iter().filter(|pass| pass.finished).count(), 1);
        assert_eq!(samples(after(Some(100.0)).passes(&look(false, 1))), [1]);
    }

    #[test]
    fn what_moves_is_as_fine_as_time_allows() {
        let size = |each| {
            let mut pace = Pace { coarse: Some(each), ..Pace::default() };
            let passes = pace.passes(&look(true, 16));
            assert_eq!(passes.len(), 1);
            passes[0].size
        };
        assert_eq!(size(80.0), [640, 480]);
        assert_eq!(size(150.0), [640, 480]);
        assert_eq!(size(300.0), [400, 300]);
        // 72 ms rather than fewer pixels, and no fewer than these.
        assert_eq!(size(1000.0), [256, 192]);
        assert_eq!(size(2000.0), [200, 150]);
        assert_eq!(size(1e9), [100, 75]);
    }

    #[test]
    fn the_size_is_that_of_the_last_picture_if_that_will_do() {
        let mut pace = Pace::default();
        let mut step = |milliseconds: u64| {
            let pass = pace.passes(&look(true, 16))[0];
            pace.add(pass, Duration::from_millis(milliseconds));
            pass.size[0]
        };
        // 160 x 120 pixels in 10 ms: 320 x 240 would take 40, and stay while their time does not
        // change much.
        let sizes = [10, 40, 45, 52, 48, 38, 500].map(&mut step);
        assert_eq!(sizes, [160, 320, 320, 320, 320, 320, 320]);
        assert!(step(60) < 320);
    }
}
