//! Numbers and vectors on a straight way, as sweeps and films write them.

use crate::keys::quoted;
use std::fmt;

/// A number, or several in brackets: `5`, `[0, 1.5, 2]`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Waypoint {
    numbers: Vec<f64>,
    is_list: bool,
}

impl Waypoint {
    /// Reads one.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let inner = text.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
        let number = |part: &str| {
            let number = part.trim().parse().ok().filter(|number: &f64| number.is_finite());
            number.ok_or_else(|| format!("{} is not a finite number", quoted(part.trim(), '`')))
        };
        let numbers = match inner {
            Some(inner) => inner.split(',').map(number).collect::<Result<_, _>>()?,
            None => vec![number(text)?],
        };
        Ok(Self { numbers, is_list: inner.is_some() })
    }

    /// Reads the points of a way, `POINT..POINT..POINT`, which are all numbers or all as long.
    pub fn way(text: &str) -> Result<Vec<Self>, String> {
        let points = text.split("..").map(Self::parse).collect::<Result<Vec<_>, _>>()?;
        let shape = |point: &Self| (point.is_list, point.numbers.len());
        match points.windows(2).find(|pair| shape(&pair[0]) != shape(&pair[1])) {
            Some(pair) => Err(format!("{} and {} are not alike", pair[0], pair[1])),
            None => Ok(points),
        }
    }

    /// The number it is, if it is none in brackets.
    pub fn number(&self) -> Option<f64> {
        if self.is_list { None } else { self.numbers.first().copied() }
    }

    /// How far it is to another one.
    pub fn distance(&self, other: &Self) -> f64 {
        let squares = self.numbers.iter().zip(&other.numbers).map(|(a, b)| (b - a) * (b - a));
        squares.sum::<f64>().sqrt()
    }

    /// The point at that share of the way to another one.
    pub fn toward(&self, other: &Self, share: f64) -> Self {
        let between = |(a, b): (&f64, &f64)| a * (1.0 - share) + b * share;
        let numbers = self.numbers.iter().zip(&other.numbers).map(between).collect();
        Self { numbers, is_list: self.is_list }
    }
}

/// As a scene writes it.
impl fmt::Display for Waypoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers = self.numbers.iter().map(|number| without_rounding(*number).to_string());
        let text = numbers.collect::<Vec<_>>().join(", ");
        if self.is_list { write!(f, "[{text}]") } else { f.write_str(&text) }
    }
}

/// A number without the last digits, where rounding shows.
pub(crate) fn without_rounding(number: f64) -> f64 {
    format!("{number:.12e}").parse().unwrap_or(number)
}
