//! What is said between the worker that leads and its hands: an order as two texts of JSON, what it is about and what is to
//! be done, and what comes of it as bytes.

use cloakroom::output::{Channel, Picture, Samples};
use cloakroom_viewer::end::{Problem, Recipe, Survey, Wanted};
use cloakroom_viewer::{Look, Ray};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What an order is about. Orders with the same text are about the same scene, which is built once.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct About {
    pub look: Look,
    pub recipe: Recipe,
}

/// What is to be done.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Work {
    /// Render these rows, `[top, height]`.
    Rows([u32; 2], Wanted),
    Times,
    Section,
    Survey,
    Ray(Ray),
}

/// What has come of it.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Outcome {
    Picture(Shape),
    Times(Option<[f64; 2]>),
    Section(Value),
    Survey(Survey),
    Ray(Value),
    Problem(Problem),
}

/// A picture without its numbers, which follow as bytes.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Shape {
    width: usize,
    height: usize,
    /// Names of the channels, and what they hold.
    channels: Vec<(String, Kind)>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
enum Kind {
    F32,
    F64,
}

/// A band of a picture and the bytes that followed.
pub(crate) type Band = (Shape, Vec<u8>);

/// A picture as an outcome and the bytes after it. There are no images of light in bins on the page.
pub(crate) fn pack(picture: &Picture) -> (Outcome, Vec<u8>) {
    let mut bytes = Vec::new();
    let mut channels = Vec::new();
    for channel in &picture.channels {
        let kind = match &channel.samples {
            Samples::F32(values) => {
                bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
                Kind::F32
            }
            Samples::F64(values) => {
                bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
                Kind::F64
            }
            Samples::Rgb(_) | Samples::Bins(_) => continue,
        };
        channels.push((channel.name.clone(), kind));
    }
    let (width, height) = (picture.width, picture.height);
    (Outcome::Picture(Shape { width, height, channels }), bytes)
}

/// Appends bands to each other, from top to bottom.
pub(crate) fn join(bands: Vec<Band>) -> Picture {
    let mut whole = Picture { width: 0, height: 0, channels: Vec::new(), metadata: Vec::new() };
    for (shape, bytes) in bands {
        let Shape { width, height, channels } = shape;
        whole.width = width;
        whole.height += height;
        if whole.channels.is_empty() {
            let blank = |(name, kind): &(String, Kind)| {
                let samples = match kind {
                    Kind::F32 => Samples::F32(Vec::new()),
                    Kind::F64 => Samples::F64(Vec::new()),
                };
                Channel { name: name.clone(), samples }
            };
            whole.channels = channels.iter().map(blank).collect();
        }
        let mut rest = &bytes[..];
        for channel in &mut whole.channels {
            match &mut channel.samples {
                Samples::F32(values) => {
                    let (own, others) = rest.split_at(4 * width * height);
                    values.extend(own.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)));
                    rest = others;
                }
                Samples::F64(values) => {
                    let (own, others) = rest.split_at(8 * width * height);
                    values.extend(own.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes)));
                    rest = others;
                }
                Samples::Rgb(_) | Samples::Bins(_) => {}
            }
        }
    }
    whole
}

/// An outcome as bytes: the length of its JSON, that, and the numbers.
pub(crate) fn encode(outcome: &Outcome, numbers: &[u8]) -> Vec<u8> {
    // What is encoded here are texts, numbers and lists of them.
    let text = serde_json::to_vec(outcome).unwrap_or_default();
    let mut bytes = Vec::with_capacity(4 + text.len() + numbers.len());
    bytes.extend((text.len() as u32).to_le_bytes());
    bytes.extend(text);
    bytes.extend(numbers);
    bytes
}

/// The outcome that bytes hold, and the numbers after it.
pub(crate) fn decode(mut bytes: Vec<u8>) -> Result<(Outcome, Vec<u8>), Problem> {
    let (length, rest) = bytes.split_first_chunk().ok_or_else(broken)?;
    let text = rest.get(..u32::from_le_bytes(*length) as usize).ok_or_else(broken)?;
    let outcome = serde_json::from_slice(text).map_err(|_| broken())?;
    bytes.drain(..4 + text.len());
    Ok((outcome, bytes))
}

/// A hand has ended instead of answering.
pub(crate) fn broken() -> Problem {
    Problem::of("this scene could not be rendered: a mistake in the program, or no memory left")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_that_went_as_bytes_are_the_picture() {
        let whole = |rows: std::ops::Range<usize>| {
            let numbers = || (3 * rows.start..3 * rows.end).map(|i| i as f64 / 7.0);
            let channel = |name: &str, samples| Channel { name: name.to_owned(), samples };
            Picture {
                width: 3,
                height: rows.len(),
                channels: vec![
                    channel("R", Samples::F32(numbers().map(|x| x as f32).collect())),
                    channel("time_of_flight", Samples::F64(numbers().collect())),
                ],
                metadata: Vec::new(),
            }
        };
        let sent = |picture: Picture| {
            let (outcome, numbers) = pack(&picture);
            match decode(encode(&outcome, &numbers)) {
                Ok((Outcome::Picture(shape), numbers)) => (shape, numbers),
                other => panic!("{other:?}"),
            }
        };
        let bands = [0..4, 4..8, 8..9].map(|rows| sent(whole(rows)));
        assert_eq!(join(bands.into()), whole(0..9));
    }

    #[test]
    fn what_is_cut_short_is_no_outcome() {
        let bytes = encode(&Outcome::Problem(Problem::Stopped), &[]);
        for length in 0..bytes.len() {
            assert_eq!(decode(bytes[..length].to_vec()).err(), Some(broken()));
        }
        assert!(decode(bytes).is_ok());
    }
}
