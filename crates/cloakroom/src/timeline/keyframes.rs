//! Keyframes: what keys of a scene are at some frames of a film, and on the way between.

use super::MOST_FRAMES;
use crate::keys::Value;
use crate::measure::{Sweep, without_rounding};
use crate::scene_file::{SceneFileError, tables};

/// The list of keyframes in their file.
const LIST: &str = "keyframe";
/// When one is.
const FRAME: &str = "frame";
/// How the way between them is gone.
const WAY: &str = "way";

/// Keyframes as they are written.
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframes {
    /// The name of their file.
    pub(super) name: String,
    /// Keys, each with its values at frames.
    keys: Vec<(String, Vec<(f64, Value)>)>,
    is_smooth: bool,
    last: f64,
}

impl Keyframes {
    /// Reads keyframes from the text of a file, TOML: tables `[[keyframe]]`, each with its `frame`,
    /// counted from 0, and keys of a scene, as in `camera.position = [-100, 20, 0]`; `way` says how
    /// numbers and vectors go from one to the next, "smooth" by default, or "linear". What is no
    /// number stays until the next keyframe that changes it.
    ///
    /// # Errors
    ///
    /// If the text is no TOML or says something else.
    pub fn parse(text: &str, name: &str) -> Result<Self, SceneFileError> {
        let refuse = |message: String| SceneFileError::whole(name, message);
        let root = tables(text, name)?;
        let mut is_smooth = true;
        for (key, value) in root.as_table().unwrap_or_default() {
            match (key.as_str(), value.as_text()) {
                (LIST, _) => {}
                (WAY, Some("smooth")) => is_smooth = true,
                (WAY, Some("linear")) => is_smooth = false,
                (WAY, _) => {
                    return Err(refuse(format!(
                        "{WAY} is {value}; it must be \"smooth\" or \"linear\""
                    )));
                }
                _ => return Err(refuse(format!("`{key}` stands outside of a [[{LIST}]]"))),
            }
        }
        let list = root.entry(LIST).and_then(Value::as_list).unwrap_or_default();
        let mut frames = Self { name: name.to_owned(), keys: Vec::new(), is_smooth, last: -1.0 };
        for (number, keyframe) in list.iter().enumerate() {
            let refuse =
                |message: &str| refuse(format!("{LIST} {number} (counted from 0): {message}"));
            let frame = keyframe.entry(FRAME).and_then(Value::as_number);
            let frame = frame.ok_or_else(|| refuse("it needs its frame, a number"))?;
            if frame >= MOST_FRAMES as f64 {
                let message = format!("a film has at most {MOST_FRAMES} frames, counted from 0");
                return Err(refuse(&message));
            }
            if frame.is_nan() || frame <= frames.last {
                return Err(refuse("frames count from 0 and rise from keyframe to keyframe"));
            }
            frames.last = frame;
            let others = keyframe.as_table().unwrap_or_default().iter();
            for (key, value) in others.filter(|(key, _)| key != FRAME) {
                frames.add(key, value, frame);
            }
        }
        if frames.last < 0.0 || frames.keys.is_empty() {
            return Err(refuse(format!("there is no [[{LIST}]] with keys of a scene")));
        }
        Ok(frames)
    }

    /// Adds the value of a key at a frame; a table's, key by key.
    fn add(&mut self, key: &str, value: &Value, frame: f64) {
        if let Some(entries) = value.as_table() {
            for (name, value) in entries {
                self.add(&format!("{key}.{name}"), value, frame);
            }
            return;
        }
        let at = (frame, value.clone());
        match self.keys.iter_mut().find(|(known, _)| known == key) {
            Some((_, values)) => values.push(at),
            None => self.keys.push((key.to_owned(), vec![at])),
        }
    }

    /// How many frames there are up to the last keyframe.
    pub(super) fn frames(&self) -> usize {
        self.last as usize + 1
    }

    /// What each key is, frame by frame, and in which keyframe that is written: with more or fewer frames than
    /// are written all goes slower or faster.
    pub(super) fn sweeps(&self, frames: usize) -> Vec<(Sweep, Vec<f64>)> {
        let pace = if frames > 1 { self.last / (frames - 1) as f64 } else { 0.0 };
        let times = || (0..frames).map(|frame| frame as f64 * pace);
        let sweep = |(key, values): &(String, Vec<(f64, Value)>)| {
            let at_times: Vec<Value> =
                times().map(|time| value_at(values, time, self.is_smooth)).collect();
            let written = times().zip(&at_times).map(|(time, value)| origin(values, time, value));
            let written = written.collect();
            (Sweep::through(key.clone(), at_times), written)
        };
        self.keys.iter().map(sweep).collect()
    }
}

/// The frame of the keyframe that a value at a time is of: the last one that has it, else the one that it is
/// on its way to.
fn origin(values: &[(f64, Value)], time: f64, value: &Value) -> f64 {
    let next = values.partition_point(|(frame, _)| *frame <= time);
    let last = values[..next].last().filter(|(frame, held)| *frame == time || held == value);
    last.or_else(|| values[next..].first()).unwrap_or(&values[values.len() - 1]).0
}

/// The value at a time, given those at frames; lists go part by part.
fn value_at(values: &[(f64, Value)], time: f64, is_smooth: bool) -> Value {
    let numbers = values.iter().map(|(frame, value)| Some((*frame, value.as_number()?)));
    if let Some(numbers) = numbers.collect::<Option<Vec<_>>>() {
        return number_at(&numbers, time, is_smooth).into();
    }
    let length = |value: &Value| value.as_list().map(<[_]>::len);
    if let Some(count) = length(&values[0].1)
        && values.iter().all(|(_, value)| length(value) == Some(count))
    {
        let part = |i: usize| {
            let parts =
                values.iter().filter_map(|(f, value)| Some((*f, value.as_list()?[i].clone())));
            value_at(&parts.collect::<Vec<_>>(), time, is_smooth)
        };
        return Value::List((0..count).map(part).collect());
    }
    let begun = values.iter().take_while(|(frame, _)| *frame <= time).count();
    values[begun.saturating_sub(1)].1.clone()
}

/// The number at a time, given those at frames: on straight lines between them, or on a smooth curve
/// that never goes beyond them, Hermite's cubic with the slopes of F. N. Fritsch and J. Butland, SIAM
/// J. Sci. Stat. Comput. 5, 300 (1984).
fn number_at(numbers: &[(f64, f64)], time: f64, is_smooth: bool) -> f64 {
    let next = numbers.partition_point(|(frame, _)| *frame <= time);
    if next == 0 || next == numbers.len() {
        return numbers[next.saturating_sub(1)].1;
    }
    let ((from, start), (to, end)) = (numbers[next - 1], numbers[next]);
    let (length, share) = (to - from, (time - from) / (to - from));
    if !is_smooth {
        return without_rounding(start * (1.0 - share) + end * share);
    }
    let slope = |i: usize| {
        let ((from, start), (to, end)) = (numbers[i], numbers[i + 1]);
        (end - start) / (to - from)
    };
    let slope_at = |i: usize| match (i.checked_sub(1), i + 1 < numbers.len()) {
        (Some(before), true) => {
            let (before, after) = (slope(before), slope(i));
            if before * after > 0.0 { 2.0 * before * after / (before + after) } else { 0.0 }
        }
        (Some(before), false) => slope(before),
        (None, _) => slope(i),
    };
    let (one, other) = (slope_at(next - 1) * length, slope_at(next) * length);
    let rest = 1.0 - share;
    let ends =
        start * (1.0 + 2.0 * share) * rest * rest + end * (3.0 - 2.0 * share) * share * share;
    without_rounding(ends + share * rest * (one * rest - other * share))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keyframes(text: &str) -> Keyframes {
        Keyframes::parse(text, "path.toml").unwrap_or_else(|error| panic!("{error}"))
    }

    const PATH: &str = "[[keyframe]]\nframe = 0\ncamera.position = [-100, 0, 0]\ndevice.0.show = 'cloak'\n\
        [[keyframe]]\nframe = 10\ncamera.position = [-50, 10, 0]\n\
        [[keyframe]]\nframe = 20\ncamera.position = [-50, 0, 0]\ndevice.0.show = 'bare'\n";

    #[test]
    fn numbers_go_and_words_stay_until_the_next_keyframe() {
        let path = keyframes(&format!("way = 'linear'\n{PATH}"));
        assert_eq!(path.frames(), 21);
        let sweeps = path.sweeps(21);
        let at = |i: usize| sweeps.iter().map(|(s, _)| s.set(i).to_string()).collect::<Vec<_>>();
        assert_eq!(at(5), ["camera.position=[-75.0, 5.0, 0.0]", "device.0.show=\"cloak\""]);
        assert_eq!(at(20), ["camera.position=[-50.0, 0.0, 0.0]", "device.0.show=\"bare\""]);
        // Twice as fast.
        assert_eq!(path.sweeps(11)[0].0.set(5).to_string(), "camera.position=[-50.0, 10.0, 0.0]");
    }

    #[test]
    fn values_are_of_the_keyframe_that_writes_them() {
        let text = "[[keyframe]]\nframe = 2\na = 1\n[[keyframe]]\nframe = 4\na = 3\nb = \"x\"\n\
                    [[keyframe]]\nframe = 6\nb = \"y\"";
        let sweeps = Keyframes::parse(text, "path.toml").expect("keyframes").sweeps(7);
        // A number on its way is of the one where it goes to, a word of the one before.
        assert_eq!(sweeps[0].1, [2.0, 2.0, 2.0, 4.0, 4.0, 4.0, 4.0]);
        assert_eq!(sweeps[1].1, [4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 6.0]);
    }

    #[test]
    fn a_smooth_way_goes_through_its_keyframes_and_not_beyond() {
        let frames = [(0.0, 0.0), (10.0, 1.0), (25.0, 1.0), (30.0, -2.0)];
        for (frame, number) in frames {
            assert!((number_at(&frames, frame, true) - number).abs() < 1e-12);
        }
        let steps: Vec<f64> =
            (0..=300).map(|i| number_at(&frames, f64::from(i) / 10.0, true)).collect();
        assert!(steps[..101].is_sorted() && steps.iter().all(|n| (-2.0..=1.0).contains(n)));
        assert!(steps[100..=250].iter().all(|n| *n == 1.0));
        // No kink where it comes to rest.
        assert!((steps[100] - steps[99]).abs() < 0.1 * (steps[50] - steps[49]).abs());
    }

    #[test]
    fn what_is_no_keyframe_is_refused() {
        for (text, part) in [
            ("", "there is no [[keyframe]]"),
            ("[[keyframe]]\nframe = 1", "there is no [[keyframe]] with keys"),
            ("[[keyframe]]\ncamera.samples = 1", "keyframe 0 (counted from 0): it needs its frame"),
            ("[[keyframe]]\nframe = -1", "frames count from 0"),
            ("[[keyframe]]\nframe = 1\n[[keyframe]]\nframe = 1", "keyframe 1 (counted from 0)"),
            ("way = 'bent'", "\"smooth\" or \"linear\""),
            ("frame = 1", "`frame` stands outside"),
            ("[[keyframe]\n", "path.toml:1"),
        ] {
            let message = Keyframes::parse(text, "path.toml").expect_err(text).to_string();
            assert!(message.contains(part), "{message}");
        }
    }
}
