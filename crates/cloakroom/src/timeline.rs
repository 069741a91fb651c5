//! Which keys of a scene change from frame to frame, and how.

use crate::measure::{Sweep, SweepError};
use crate::scene_file::Override;

/// Most frames of a film.
pub const MOST_FRAMES: usize = 100_000;

/// Keys of a scene that change together, a value a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline {
    sweeps: Vec<Sweep>,
}

/// Why there is no timeline.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TimelineError {
    /// A sweep cannot be read.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// A way from point to point cannot be read.
    #[error(
        "--sweep {text}: {problem}; write KEY=START..END, with points on the way as in \
         device.0.rotation=0..25..0"
    )]
    Way {
        /// The sweep as it was written.
        text: String,
        /// What is wrong with it.
        problem: String,
    },
    /// It is not said how many frames there are for this sweep, as it was written.
    #[error("--sweep {0} says where to go but not in how many frames; give --frames")]
    NoCount(String),
    /// There are too many frames, or none.
    #[error("a film has 1 to {MOST_FRAMES} frames, not {0}")]
    Count(usize),
    /// A sweep has another number of values.
    #[error("--sweep {key} has {values} values, but the film has {frames} frames")]
    Uneven {
        /// The swept key.
        key: String,
        /// How many values it has.
        values: usize,
        /// How many frames there are.
        frames: usize,
    },
    /// Nothing changes.
    #[error("nothing changes from frame to frame; give a --sweep")]
    Still,
}

impl Timeline {
    /// Reads sweeps: `KEY=START..END`, with points on the way if there are more, spread evenly over
    /// `frames` frames; or `KEY=START..END:STEP` or `KEY=VALUE,VALUE,...`, a frame for each value.
    ///
    /// Both ends are among the frames, but a `rotation` over whole turns leaves out its end: it is
    /// its beginning, and the film goes round without a stop.
    ///
    /// # Errors
    ///
    /// If a sweep cannot be read, or they do not agree in the number of frames.
    pub fn new(texts: &[String], frames: Option<usize>) -> Result<Self, TimelineError> {
        if let Some(frames) = frames.filter(|frames| !(1..=MOST_FRAMES).contains(frames)) {
            return Err(TimelineError::Count(frames));
        }
        let mut sweeps: Vec<Sweep> = Vec::new();
        for text in texts {
            let sweep = match way(text)? {
                Some((key, points)) => {
                    let frames = frames.ok_or_else(|| TimelineError::NoCount(text.clone()))?;
                    let values = spread(&key, &points, frames);
                    Sweep::written(key, values)
                }
                None => Sweep::parse(text)?,
            };
            if sweeps.iter().any(|other| other.key == sweep.key) {
                return Err(SweepError::Twice(sweep.key).into());
            }
            sweeps.push(sweep);
        }
        let first = sweeps.first().ok_or(TimelineError::Still)?;
        let frames = frames.unwrap_or(first.values.len());
        if let Some(sweep) = sweeps.iter().find(|sweep| sweep.values.len() != frames) {
            let (key, values) = (sweep.key.clone(), sweep.values.len());
            return Err(TimelineError::Uneven { key, values, frames });
        }
        Ok(Self { sweeps })
    }

    /// How many frames there are.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.sweeps.first().map_or(0, |sweep| sweep.values.len())
    }

    /// What a frame, counted from 0, changes in the scene, as in `device.0.rotation=3`.
    #[must_use]
    pub fn overrides(&self, frame: usize) -> Vec<Override> {
        self.sweeps.iter().map(|sweep| sweep.set(frame)).collect()
    }
}

/// The key and the points of a sweep written as a way, `KEY=POINT..POINT`; `None` if it is written
/// otherwise.
fn way(text: &str) -> Result<Option<(String, Vec<f64>)>, TimelineError> {
    let Some((key, values)) = text.split_once('=') else { return Ok(None) };
    if !values.contains("..") || values.contains([':', ',', '"', '\'', '[']) {
        return Ok(None);
    }
    let refuse = |problem: String| TimelineError::Way { text: text.to_owned(), problem };
    if key.trim().is_empty() {
        return Err(refuse("there is no key before the =".to_owned()));
    }
    let points = values.split("..").map(|point| {
        let number = point.trim().parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| refuse(format!("`{}` is not a finite number", point.trim())))
    });
    Ok(Some((key.trim().to_owned(), points.collect::<Result<_, _>>()?)))
}

/// Values spread evenly over the pieces of a way.
fn spread(key: &str, points: &[f64], frames: usize) -> Vec<String> {
    let (first, last) = (points[0], points[points.len() - 1]);
    let turns = (last - first) / 360.0;
    let round =
        points.len() == 2 && key.ends_with("rotation") && turns != 0.0 && turns.fract() == 0.0;
    let steps = if round { frames } else { frames - 1 }.max(1) as f64;
    let pieces = points.len() - 1;
    (0..frames)
        .map(|frame| {
            let place = frame as f64 / steps * pieces as f64;
            let piece = (place as usize).min(pieces - 1);
            let share = place - piece as f64;
            let value = points[piece] * (1.0 - share) + points[piece + 1] * share;
            // Without the last digits, where rounding shows.
            let digits = format!("{value:.12e}");
            digits.parse().map_or(digits, |value: f64| value.to_string())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str, frames: usize) -> Vec<f64> {
        let timeline = Timeline::new(&[text.to_owned()], Some(frames)).expect("a timeline");
        let number = |i| timeline.overrides(i)[0].to_string().split_once('=')?.1.parse().ok();
        (0..timeline.frames()).map(|i| number(i).expect("a number")).collect()
    }

    #[test]
    fn whole_turns_leave_out_their_end() {
        let turn = values("device.0.rotation=0..360", 120);
        assert_eq!((turn.len(), turn[1], turn[119]), (120, 3.0, 357.0));
        assert_eq!(values("device.0.rotation=90..-270", 4), [90.0, 0.0, -90.0, -180.0]);
        // Other keys and other angles have both ends.
        assert_eq!(values("device.0.rotation=0..45", 4), [0.0, 15.0, 30.0, 45.0]);
        assert_eq!(values("device.0.angle=0..360", 3), [0.0, 180.0, 360.0]);
    }

    #[test]
    fn ways_go_through_their_points() {
        assert_eq!(values("a=0..25..0", 5), [0.0, 12.5, 25.0, 12.5, 0.0]);
        assert_eq!(values("a=0..1", 11)[3], 0.3);
        assert_eq!(values("a = -1 .. 1e-9", 2), [-1.0, 1e-9]);
        assert_eq!(values("a=7..9", 1), [7.0]);
    }

    #[test]
    fn keys_move_together() {
        let texts = ["a=0..1", "b=5,6,7", "c=1..3:1"].map(str::to_owned);
        let timeline = Timeline::new(&texts, Some(3)).expect("a timeline");
        let written = |frame| timeline.overrides(frame).into_iter().map(|each| each.to_string());
        assert!(written(1).eq(["a=0.5", "b=6", "c=2"]));
        let timeline = Timeline::new(&texts[1..], None).expect("a timeline");
        let written = |frame| timeline.overrides(frame).into_iter().map(|each| each.to_string());
        assert!(written(2).eq(["b=7", "c=3"]));
    }

    #[test]
    fn what_is_no_timeline_is_refused() {
        for (texts, frames, part) in [
            (&["a=0..1"][..], None, "give --frames"),
            (&["a=0..1"], Some(0), "1 to 100000 frames"),
            (&["a=0..x"], Some(2), "`x` is not a finite"),
            (&["a=0....1"], Some(2), "`` is not a finite"),
            (&["=0..1"], Some(2), "no key"),
            (&["a"], Some(2), "no = in it"),
            (&["a=1,2", "b=1,2,3"], None, "b has 3 values, but the film has 2"),
            (&["a=1,2"], Some(5), "a has 2 values, but the film has 5"),
            (&["a=1,2", "a=3,4"], None, "a is swept twice"),
            (&[], Some(2), "nothing changes"),
        ] {
            let texts: Vec<String> = texts.iter().map(|&text| text.to_owned()).collect();
            let message = Timeline::new(&texts, frames).expect_err("none").to_string();
            assert!(message.contains(part), "{message}");
        }
    }
}
