//! Numbers on a grid, as a scene writes them: rows of numbers.

use super::{Key, Value};
use std::sync::Arc;

/// Numbers on a grid of two dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    count: [usize; 2],
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
        if first == 0 {
            return Err("there are no numbers in it".to_owned());
        }
        if let Some((row, odd)) = rows.iter().enumerate().find(|(_, row)| row.len() != first) {
            let count = odd.len();
            return Err(format!(
                "row {row} has {count} numbers, row 0 has {first}; all must have as many"
            ));
        }
        Ok(Self { count: [rows.len(), first], values: rows.concat().into() })
    }

    /// The grid that rows of numbers are.
    pub(super) fn from_value(value: &Value) -> Option<Self> {
        let row = |row: &Value| row.as_list()?.iter().map(Value::as_number).collect();
        let rows: Option<Vec<Vec<f64>>> = value.as_list()?.iter().map(row).collect();
        rows.and_then(|rows| Self::new(&rows).ok())
    }

    /// Holds each number against the limits of a key.
    ///
    /// # Errors
    ///
    /// A message at the first number that is not allowed.
    pub fn check(&self, key: &Key) -> Result<(), String> {
        let refused = |number: &f64| !key.limits.allow(*number);
        let Some(at) = self.values.iter().position(refused) else { return Ok(()) };
        let [row, column] = [at / self.count[1], at % self.count[1]];
        key.limit(&format!("{}[{row}][{column}]", key.name), self.values[at])
    }

    /// How many rows there are, and numbers in each.
    #[must_use]
    pub fn count(&self) -> [usize; 2] {
        self.count
    }

    /// The numbers, row by row.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

impl From<&Samples> for Value {
    fn from(samples: &Samples) -> Self {
        let row = |row: &[f64]| Value::List(row.iter().copied().map(Value::Number).collect());
        Value::List(samples.values.chunks(samples.count[1]).map(row).collect())
    }
}
