//! Values on the command line, read.

use cloakroom::material::Resolution;
use cloakroom::render::{Gate, GateError};
use std::str::FromStr;

/// At which times a pulse is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PulseTimes {
    /// While it is seen.
    Seen,
    /// At one, ns.
    At(f64),
    /// In the middle of each bin.
    Bins(Gate),
}

impl FromStr for PulseTimes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.is_empty() {
            return Ok(Self::Seen);
        }
        if text.contains("..") {
            return text.parse().map(Self::Bins).map_err(|error: GateError| error.to_string());
        }
        let time = numbers(text).map(|[time]: [f64; 1]| Self::At(time));
        time.ok_or_else(|| {
            "write ns, as in 1.2, or START..END:STEP, as in -0.5..1.5:0.02".to_owned()
        })
    }
}

/// Reads a point such as -30,0,0.
pub(super) fn point(text: &str) -> Result<[f64; 3], &'static str> {
    numbers(text).ok_or("write X,Y,Z in cm, as in -30,0,0")
}

/// Reads from where space is seen, such as 30,20.
pub(super) fn view(text: &str) -> Result<[f64; 2], &'static str> {
    numbers(text).ok_or("write AZIMUTH,ELEVATION in degrees, as in 30,20")
}

/// Reads where and when the sun is, such as 49,23.44.
pub(super) fn sun(text: &str) -> Result<[f64; 2], &'static str> {
    numbers(text)
        .filter(|[latitude, declination]| latitude.abs().max(declination.abs()) <= 90.0)
        .ok_or("write LATITUDE,DECLINATION, each from -90 to 90 degrees, as in 49,23.44")
}

/// Reads an angle of incidence in degrees.
pub(super) fn tilt(text: &str) -> Result<f64, &'static str> {
    numbers(text)
        .map(|[angle]: [f64; 1]| angle)
        .filter(|angle| angle.abs() < 90.0)
        .ok_or("write degrees, more than -90 and less than 90, as in 30")
}

/// Reads angles such as -60..60:5, or a single one: first, last and step.
pub(super) fn angles(text: &str) -> Result<[f64; 3], &'static str> {
    let parts = text.split_once("..").and_then(|(from, rest)| {
        let (to, step) = rest.split_once(':')?;
        numbers(&format!("{from},{to},{step}"))
    });
    let single = || numbers(text).map(|[angle]| [angle, angle, 1.0]);
    parts
        .or_else(single)
        .filter(|[from, to, step]| *step > 0.0 && to >= from && (to - from) / step < 10_000.0)
        .ok_or(
            "write FROM..TO:STEP in degrees, as in -60..60:5, the step above 0, the end not before the beginning, \
             at most 10000 angles, or a single angle",
        )
}

/// Reads how long a pulse is, ns.
pub(super) fn pulse(text: &str) -> Result<f64, &'static str> {
    numbers(text)
        .map(|[width]: [f64; 1]| width)
        .filter(|width| (0.0..=1e6).contains(width))
        .ok_or("write ns, from 0 to 1000000, as in 0.02")
}

/// Reads how bright a flash is.
pub(super) fn exposure(text: &str) -> Result<f64, &'static str> {
    numbers(text)
        .map(|[factor]: [f64; 1]| factor)
        .filter(|factor| *factor > 0.0)
        .ok_or("write a factor above 0, as in 2")
}

/// Reads the first and the last of some frames, such as 0..29.
pub(super) fn frames_only(text: &str) -> Result<[usize; 2], &'static str> {
    parsed(text, "..")
        .filter(|[first, last]| first <= last)
        .ok_or("write FIRST..LAST, counted from 0, as in 0..29")
}

/// Reads a part of the xy-plane, such as -20,-10,20,10.
pub(super) fn window(text: &str) -> Result<[f64; 4], &'static str> {
    numbers(text)
        .filter(|[x0, y0, x1, y1]| x0 < x1 && y0 < y1)
        .ok_or("write X0,Y0,X1,Y1 in cm, the lower left corner first, as in -20,-10,20,10")
}

/// Reads the range of a map, such as -0.1,0.1.
pub(super) fn map_range(text: &str) -> Result<[f64; 2], &'static str> {
    numbers(text)
        .filter(|[low, high]| low < high)
        .ok_or("write LOW,HIGH, the smaller number first, as in -0.1,0.1")
}

/// Reads a grid such as 200x200x1 or 0.1.
pub(super) fn grid(text: &str) -> Result<Resolution, &'static str> {
    if let Some(counts) = parsed(text, "x") {
        return Ok(Resolution::Cells(counts));
    }
    text.parse().map(Resolution::Spacing).map_err(
        |_| "write how many cells along x, y and z, as in 200x200x1, or the side of a cell in cm, as in 0.1",
    )
}

/// Reads a pixel such as 512,384.
pub(super) fn pixel(text: &str) -> Result<[u32; 2], &'static str> {
    parsed(text, ",").ok_or("write COLUMN,ROW, counted from 0 at the top left, as in 512,384")
}

/// Reads a rectangle such as 100,50,200,150.
pub(super) fn rectangle(text: &str) -> Result<[usize; 4], &'static str> {
    parsed(text, ",")
        .ok_or("write X,Y,W,H in pixels: left column, top row, width, height, as in 100,50,200,150")
}

/// Reads a size such as 1024x768.
pub(super) fn size(text: &str) -> Result<[u32; 2], &'static str> {
    parsed(text, "x")
        .filter(|sides| sides.iter().all(|side| (1..=65536).contains(side)))
        .ok_or("write WIDTHxHEIGHT in pixels, each from 1 to 65536, as in 1024x768")
}

/// Finite numbers between commas.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    parsed(text, ",").filter(|numbers: &[f64; N]| numbers.iter().all(|n| n.is_finite()))
}

/// What stands between separators, so many of them.
fn parsed<T: FromStr, const N: usize>(text: &str, separator: &str) -> Option<[T; N]> {
    let parts: Option<Vec<T>> =
        text.split(separator).map(|part| part.trim().parse().ok()).collect();
    parts?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::angles;

    #[test]
    fn angles_are_a_range_or_a_single_one() {
        assert_eq!(angles("-60..60:5"), Ok([-60.0, 60.0, 5.0]));
        assert_eq!(angles("-30.5"), Ok([-30.5, -30.5, 1.0]));
        for wrong in ["", "a", "1,2", "0..9", "9..0:1", "0..9:0", "0..9:-1", "nan", "0..inf:1"] {
            assert!(angles(wrong).is_err(), "{wrong}");
        }
    }
}
