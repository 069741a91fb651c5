//! Numbers on a grid, as a scene writes them: rows of numbers, and lists of rows.

use super::{Key, Value};
use std::sync::Arc;

/// Numbers on a grid of any dimension, a single number being of none.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    shape: Vec<usize>,
    values: Arc<[f64]>,
}

impl Samples {
    /// The grid of rows of numbers.
    ///
    /// # Errors
    ///
    /// A message if the rows are not of one length, or there is nothing in them.
    pub fn new(rows: &[Vec<f64>]) -> Result<Self, String> {
        let first = rows.first().map_or(0, Vec::len);
        if let Some((row, odd)) = rows.iter().enumerate().find(|(_, row)| row.len() != first) {
            return Err(uneven(2, &[row], [odd.len(), first]));
        }
        Self::of(&[rows.len(), first], rows.concat())
    }

    /// The grid of a shape, with its numbers, the last axis running fastest.
    ///
    /// # Errors
    ///
    /// A message if there are no numbers, or not as many as the shape has.
    pub fn of(shape: &[usize], values: Vec<f64>) -> Result<Self, String> {
        if values.is_empty() {
            return Err("there are no numbers in it".to_owned());
        }
        let count = shape.iter().try_fold(1_usize, |count, side| count.checked_mul(*side));
        if count != Some(values.len()) {
            return Err(format!("{} numbers are not {}", values.len(), shape_text(shape)));
        }
        Ok(Self { shape: shape.to_vec(), values: values.into() })
    }

    /// The grid that lists in lists are, `number` giving the number at a place of it; `None` if
    /// they are none of so many dimensions.
    ///
    /// # Errors
    ///
    /// A message if the lists are not of one length, there is nothing in them, or as `number` says.
    pub(super) fn gather(
        value: &Value,
        [least, most]: [usize; 2],
        mut number: impl FnMut(&[usize], &Value) -> Result<f64, String>,
    ) -> Result<Option<Self>, String> {
        let (mut shape, mut inner) = (Vec::new(), value);
        while let Some(items) = inner.as_list() {
            shape.push(items.len());
            match items.first() {
                Some(first) => inner = first,
                None if shape.len() <= most => return Err("there are no numbers in it".to_owned()),
                None => return Ok(None),
            }
        }
        if !(least..=most).contains(&shape.len()) {
            return Ok(None);
        }
        let mut values = Vec::new();
        let whole = fill(value, &shape, &mut Vec::new(), &mut |at, item| {
            values.push(number(at, item)?);
            Ok(())
        })?;
        if !whole {
            return Ok(None);
        }
        Self::of(&shape, values).map(Some)
    }

    /// Holds each number against the limits of a key.
    ///
    /// # Errors
    ///
    /// A message at the first number that is not allowed.
    pub fn check(&self, key: &Key) -> Result<(), String> {
        let refused = |number: &f64| !key.limits.allow(*number);
        let Some(at) = self.values.iter().position(refused) else { return Ok(()) };
        key.limit(&format!("{}{}", key.name, self.place(at)), self.values[at])
    }

    /// How many numbers there are along each axis.
    #[must_use]
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// The numbers, the last axis running fastest.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The place of the number of that position, for messages: `[0][3]`.
    #[must_use]
    pub fn place(&self, at: usize) -> String {
        place_text(&self.place_of(at))
    }

    fn place_of(&self, at: usize) -> Vec<usize> {
        let mut rest = at;
        let mut place: Vec<usize> = self
            .shape
            .iter()
            .rev()
            .map(|side| {
                let along = rest % side;
                rest /= side;
                along
            })
            .collect();
        place.reverse();
        place
    }
}

/// A shape for people: `4 x 5 x 3`.
#[must_use]
pub fn shape_text(shape: &[usize]) -> String {
    if shape.is_empty() {
        return "one number".to_owned();
    }
    shape.iter().map(usize::to_string).collect::<Vec<_>>().join(" x ")
}

pub(super) fn place_text(place: &[usize]) -> String {
    place.iter().map(|at| format!("[{at}]")).collect()
}

/// That a list in a grid of so many dimensions is not as long as the first one.
fn uneven(dimensions: usize, at: &[usize], [count, first]: [usize; 2]) -> String {
    if let (2, [row]) = (dimensions, at) {
        return format!("row {row} has {count} numbers, row 0 has {first}; all must have as many");
    }
    let [at, origin] = [at, &vec![0; at.len()]].map(place_text);
    format!("{at} has {count} entries, {origin} has {first}; all must have as many")
}

/// Goes through lists in lists of a shape; whether they are such.
fn fill(
    value: &Value,
    shape: &[usize],
    at: &mut Vec<usize>,
    visit: &mut impl FnMut(&[usize], &Value) -> Result<(), String>,
) -> Result<bool, String> {
    let Some(side) = shape.get(at.len()) else {
        visit(at, value)?;
        return Ok(true);
    };
    let Some(items) = value.as_list() else { return Ok(false) };
    if items.len() != *side {
        return Err(uneven(shape.len(), at, [items.len(), *side]));
    }
    for (i, item) in items.iter().enumerate() {
        at.push(i);
        let whole = fill(item, shape, at, visit)?;
        at.pop();
        if !whole {
            return Ok(false);
        }
    }
    Ok(true)
}

impl From<&Samples> for Value {
    fn from(samples: &Samples) -> Self {
        fn nested(values: &[f64], shape: &[usize]) -> Value {
            match shape {
                [] => values[0].into(),
                [_, rest @ ..] => {
                    let part = rest.iter().product();
                    Value::List(values.chunks(part).map(|values| nested(values, rest)).collect())
                }
            }
        }
        nested(&samples.values, &samples.shape)
    }
}
