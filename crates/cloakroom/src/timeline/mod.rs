//! Which keys of a scene change from frame to frame, and how.

mod keyframes;

use crate::measure::{Sweep, SweepError, Waypoint};
use crate::scene_file::Override;
pub use keyframes::Keyframes;

/// Most frames of a film.
pub const MOST_FRAMES: usize = 100_000;

/// Keys of a scene that change together, a value a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline {
    sweeps: Vec<Sweep>,
    /// What keyframes change, written as sweeps, and for each frame of the film that of the keyframe it is of.
    keyframes: Vec<(Sweep, Vec<f64>)>,
    /// The file of the keyframes.
    file: String,
    /// How far the camera has gone round its target, frame by frame, degrees.
    orbit: Option<Vec<f64>>,
    frames: usize,
}

/// How a film changes from frame to frame, as it is asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Changes<'c> {
    /// Sweeps of keys: `KEY=START..END`, with points on the way if there are more, spread evenly over
    /// the frames; or `KEY=START..END:STEP` or `KEY=VALUE,VALUE,...`, a frame for each value.
    pub sweeps: &'c [String],
    /// Keyframes.
    pub keyframes: Option<&'c Keyframes>,
    /// How the camera goes round its target, degrees: `START..END`, with points on the way.
    pub orbit: Option<&'c str>,
    /// How many frames there are, if that is said.
    pub frames: Option<usize>,
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
         device.0.rotation=0..25..0 or camera.position=[-100,0,0]..[-90,20,0]"
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
    /// The way round the target cannot be read.
    #[error("--orbit {text}: {problem}; write START..END in degrees, as in 0..360 or -20..20..-20")]
    Orbit {
        /// The way as it was written.
        text: String,
        /// What is wrong with it.
        problem: String,
    },
    /// It is not said how many frames the way round the target takes.
    #[error("--orbit {0} says where to go but not in how many frames; give --frames")]
    NoOrbitCount(String),
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
    #[error("nothing changes from frame to frame; give a --sweep, --keyframes or an --orbit")]
    Still,
}

impl Timeline {
    /// Reads how a film changes.
    ///
    /// Both ends of a way are among the frames, but a `rotation` or an orbit over whole turns leaves
    /// out its end: it is its beginning, and the film goes round without a stop.
    ///
    /// # Errors
    ///
    /// If something cannot be read, or they do not agree in the number of frames.
    pub fn new(changes: Changes<'_>) -> Result<Self, TimelineError> {
        let Changes { sweeps: texts, keyframes, orbit, frames } = changes;
        if let Some(frames) = frames.filter(|frames| !(1..=MOST_FRAMES).contains(frames)) {
            return Err(TimelineError::Count(frames));
        }
        let counted = frames.or(keyframes.map(Keyframes::frames));
        let mut sweeps: Vec<Sweep> = Vec::new();
        for text in texts {
            let sweep = match way(text)? {
                Some((key, points)) => {
                    let frames = counted.ok_or_else(|| TimelineError::NoCount(text.clone()))?;
                    let points = spread(&points, key.ends_with("rotation"), frames);
                    Sweep::written(key, points.iter().map(ToString::to_string).collect())
                }
                None => Sweep::parse(text)?,
            };
            sweeps.push(sweep);
        }
        let counted = counted.or(sweeps.first().map(|sweep| sweep.values.len()));
        let orbit = orbit.map(|text| azimuths(text, counted));
        let (orbit, frames) = (orbit.transpose()?, counted.ok_or(TimelineError::Still)?);
        let file = keyframes.map(|keyframes| keyframes.name.clone()).unwrap_or_default();
        let keyframes = keyframes.map(|keyframes| keyframes.sweeps(frames)).unwrap_or_default();
        let all = || sweeps.iter().chain(keyframes.iter().map(|(sweep, _)| sweep));
        for (number, sweep) in all().enumerate() {
            // An entry of a list, or the list that it is of, is the same key.
            let is_of =
                |a: &str, b: &str| b.strip_prefix(a).is_some_and(|rest| rest.starts_with('.'));
            let same = |other: &Sweep| {
                other.key == sweep.key
                    || is_of(&other.key, &sweep.key)
                    || is_of(&sweep.key, &other.key)
            };
            if all().take(number).any(same) {
                return Err(SweepError::Twice(sweep.key.clone()).into());
            }
            let values = sweep.values.len();
            if values != frames {
                return Err(TimelineError::Uneven { key: sweep.key.clone(), values, frames });
            }
        }
        if all().next().is_none() && orbit.is_none() {
            return Err(TimelineError::Still);
        }
        Ok(Self { sweeps, keyframes, file, orbit, frames })
    }

    /// How many frames there are.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// How far the camera has gone round its target in a frame, counted from 0, in degrees.
    #[must_use]
    pub fn azimuth(&self, frame: usize) -> Option<f64> {
        self.orbit.as_ref()?.get(frame).copied()
    }

    /// What a frame, counted from 0, changes in the scene, as in `device.0.rotation=3`.
    #[must_use]
    pub fn overrides(&self, frame: usize) -> Vec<Override> {
        let keyed = self.keyframes.iter().map(|(sweep, written)| {
            let set = sweep.set(frame);
            let words = format!("--keyframes {}, frame {}, {set}", self.file, written[frame]);
            set.by(words)
        });
        self.sweeps.iter().map(|sweep| sweep.set(frame)).chain(keyed).collect()
    }
}

/// The key and the points of a sweep written as a way, `KEY=POINT..POINT`; `None` if it is written
/// otherwise.
fn way(text: &str) -> Result<Option<(String, Vec<Waypoint>)>, TimelineError> {
    let Some((key, values)) = text.split_once('=') else { return Ok(None) };
    let refuse = |problem: String| TimelineError::Way { text: text.to_owned(), problem };
    let is_list = values.contains(',') && !values.contains('[');
    let mut numbers = values.split("..").flat_map(|point| point.split(','));
    if is_list && values.contains("..") && numbers.all(|part| part.trim().parse::<f64>().is_ok()) {
        return Err(refuse("a vector stands in brackets".to_owned()));
    }
    if !values.contains("..") || is_list || values.contains([':', '"', '\'']) {
        return Ok(None);
    }
    if key.trim().is_empty() {
        return Err(refuse("there is no key before the =".to_owned()));
    }
    Ok(Some((key.trim().to_owned(), Waypoint::way(values).map_err(refuse)?)))
}

/// The angles of a way round the target, frame by frame.
fn azimuths(text: &str, frames: Option<usize>) -> Result<Vec<f64>, TimelineError> {
    let refuse =
        |problem: &str| TimelineError::Orbit { text: text.to_owned(), problem: problem.to_owned() };
    if text.contains(':') {
        return Err(refuse("it takes no step: the frames are spread evenly over it"));
    }
    let points = Waypoint::way(text).map_err(|problem| refuse(&problem))?;
    if points.len() < 2 {
        return Err(refuse("there is no .. in it"));
    }
    let frames = frames.ok_or_else(|| TimelineError::NoOrbitCount(text.to_owned()))?;
    let angles = spread(&points, true, frames).iter().map(Waypoint::number).collect();
    let angles: Option<Vec<f64>> = angles;
    angles.ok_or_else(|| refuse("these are no angles"))
}

/// Points spread evenly over the pieces of a way; whole turns leave out their end.
fn spread(points: &[Waypoint], is_angle: bool, frames: usize) -> Vec<Waypoint> {
    let turns = match points {
        [first, last] => first.number().zip(last.number()).map(|(a, b)| (b - a) / 360.0),
        _ => None,
    };
    let is_round = is_angle && turns.is_some_and(|turns| turns != 0.0 && turns.fract() == 0.0);
    let steps = if is_round { frames } else { frames - 1 }.max(1) as f64;
    let pieces = points.len() - 1;
    (0..frames)
        .map(|frame| {
            let place = frame as f64 / steps * pieces as f64;
            let piece = (place as usize).min(pieces.saturating_sub(1));
            points[piece].toward(&points[(piece + 1).min(pieces)], place - piece as f64)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timeline(texts: &[&str], frames: Option<usize>) -> Result<Timeline, TimelineError> {
        let sweeps: Vec<String> = texts.iter().map(|&text| text.to_owned()).collect();
        Timeline::new(Changes { sweeps: &sweeps, frames, ..Changes::default() })
    }

    fn values(text: &str, frames: usize) -> Vec<f64> {
        let timeline = timeline(&[text], Some(frames)).expect("a timeline");
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
        let texts = ["a=0..1", "b=5,6,7", "c=1..3:1"];
        let written = |texts: &[&str], frames, frame| {
            let timeline = timeline(texts, frames).expect("a timeline");
            timeline.overrides(frame).iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        assert_eq!(written(&texts, Some(3), 1), ["a=0.5", "b=6", "c=2"]);
        assert_eq!(written(&texts[1..], None, 2), ["b=7", "c=3"]);
        let vectors = ["a=[0,0]..[1,-2]..[1,0]", "b=[0,0]..[2,0]:1"];
        assert_eq!(written(&vectors, Some(3), 1), ["a=[1, -2]", "b=[1, 0]"]);
    }

    #[test]
    fn a_camera_goes_round_with_keyframes_and_sweeps() {
        let keyframes = "[[keyframe]]\nframe = 0\na = 0\n[[keyframe]]\nframe = 3\na = 3";
        let keyframes = Keyframes::parse(keyframes, "k").expect("keyframes");
        let sweeps = ["b=0..6".to_owned()];
        let changes = Changes {
            sweeps: &sweeps,
            keyframes: Some(&keyframes),
            orbit: Some("0..360"),
            frames: None,
        };
        let timeline = Timeline::new(changes).expect("a timeline");
        assert_eq!((timeline.frames(), timeline.azimuth(3)), (4, Some(270.0)));
        let written: Vec<_> = timeline.overrides(1).iter().map(ToString::to_string).collect();
        assert_eq!(written, ["b=2", "a=1.0"]);
        let twice = ["a=0..6".to_owned()];
        let twice = Timeline::new(Changes { sweeps: &twice, ..changes });
        assert_eq!(twice, Err(SweepError::Twice("a".to_owned()).into()));
        for (orbit, frames, part) in [
            ("0..x", Some(2), "`x` is not"),
            ("5", Some(2), "no .."),
            ("0..9", None, "give --frames"),
        ] {
            let changes = Changes { orbit: Some(orbit), frames, ..Changes::default() };
            let message = Timeline::new(changes).expect_err("none").to_string();
            assert!(message.contains(part) && message.contains(orbit), "{message}");
        }
        let there_and_back =
            Changes { orbit: Some("0..9..0"), frames: Some(5), ..Changes::default() };
        let timeline = Timeline::new(there_and_back).expect("a timeline");
        assert_eq!((timeline.azimuth(1), timeline.azimuth(4)), (Some(4.5), Some(0.0)));
    }

    #[test]
    fn what_is_no_timeline_is_refused() {
        for (texts, frames, part) in [
            (&["a=0..1"][..], None, "give --frames"),
            (&["a=0..1"], Some(0), "1 to 100000 frames"),
            (&["a=0..x"], Some(2), "`x` is not a finite"),
            (&["a=0..[1]"], Some(2), "not alike"),
            (&["a=0....1"], Some(2), "`` is not a finite"),
            (&["=0..1"], Some(2), "no key"),
            (&["a"], Some(2), "no = in it"),
            (&["a=1,2", "b=1,2,3"], None, "b has 3 values, but the film has 2"),
            (&["a=1,2"], Some(5), "a has 2 values, but the film has 5"),
            (&["a=1,2", "a=3,4"], None, "a is swept twice"),
            (&["a.1=1,2", "a=[1,2]..[3,4]"], Some(2), "a is swept twice"),
            (&["a=-1,0,0..1,2,0"], Some(2), "a vector stands in brackets"),
            (&[], Some(2), "nothing changes"),
        ] {
            let message = timeline(texts, frames).expect_err("none").to_string();
            assert!(message.contains(part), "{message}");
        }
    }
}
