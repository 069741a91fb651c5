//! Values as they are handed over, before they are held against a key.

use glam::DVec3;
use std::fmt;

/// A value as a scene file, the command line or the Python package hands it over.
///
/// [`Key::check`](super::Key::check) holds it against the key it is meant for: a whole number
/// does where a number is asked for, a text where one of a few words is.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A whole number.
    Integer(i64),
    /// True or false.
    Flag(bool),
    /// A text or a word.
    Text(String),
    /// A date or a time, which no key takes.
    Date(String),
    /// Several values, such as the components of a vector.
    List(Vec<Value>),
    /// A table: names and their values.
    Table(Vec<(String, Value)>),
}

impl Value {
    /// The number it is, whole or not.
    pub fn as_number(&self) -> Option<f64> {
        match *self {
            Value::Number(number) => Some(number),
            Value::Integer(integer) => Some(integer as f64),
            _ => None,
        }
    }

    /// The whole number it is; 4.0 counts as one.
    pub fn as_integer(&self) -> Option<i64> {
        // Above 2^53 a float no longer says which whole number was meant.
        const EXACT: f64 = 9_007_199_254_740_992.0;
        match *self {
            Value::Integer(integer) => Some(integer),
            Value::Number(n) if n.fract() == 0.0 && n.abs() <= EXACT => Some(n as i64),
            _ => None,
        }
    }

    /// Whether it is true, if it is true or false.
    pub fn as_flag(&self) -> Option<bool> {
        if let Value::Flag(flag) = self { Some(*flag) } else { None }
    }

    /// The text it is.
    pub fn as_text(&self) -> Option<&str> {
        if let Value::Text(text) = self { Some(text) } else { None }
    }

    /// The values of a list.
    pub fn as_list(&self) -> Option<&[Value]> {
        if let Value::List(items) = self { Some(items) } else { None }
    }

    /// The value of that name, if it is a table that has it.
    pub fn entry(&self, name: &str) -> Option<&Value> {
        self.as_table()?.iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }

    /// The names and values of a table.
    pub fn as_table(&self) -> Option<&[(String, Value)]> {
        if let Value::Table(entries) = self { Some(entries) } else { None }
    }
}

/// The items of a list of so many.
pub(super) fn items_of<T, const N: usize>(
    value: &Value,
    item: impl Fn(&Value) -> Option<T>,
) -> Option<[T; N]> {
    let items: &[Value; N] = value.as_list()?.try_into().ok()?;
    let items: Option<Vec<T>> = items.iter().map(item).collect();
    items?.try_into().ok()
}

/// As messages write it: `-3`, `"text"`, `[1, 2, 3]`, long ones cut short.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const MOST_ITEMS: usize = 6;
        match self {
            Value::Number(number) => f.write_str(&number_text(*number)),
            Value::Integer(integer) => write!(f, "{integer}"),
            Value::Flag(flag) => write!(f, "{flag}"),
            Value::Text(text) => f.write_str(&quoted(text, '"')),
            Value::Date(_) => f.write_str("a date or a time"),
            Value::List(items) if items.iter().any(|item| item.as_table().is_some()) => {
                f.write_str("a list of tables")
            }
            Value::List(items) if items.iter().any(|item| matches!(item, Value::Date(_))) => {
                f.write_str("a date or a time")
            }
            Value::List(items) => {
                f.write_str("[")?;
                for (i, item) in items.iter().take(MOST_ITEMS).enumerate() {
                    write!(f, "{}{item}", if i == 0 { "" } else { ", " })?;
                }
                f.write_str(if items.len() > MOST_ITEMS { ", ...]" } else { "]" })
            }
            Value::Table(_) => f.write_str("a table"),
        }
    }
}

/// Makes values of a type that is one of their kinds.
macro_rules! from {
    ($type:ty, $kind:ident) => {
        impl From<$type> for Value {
            fn from(value: $type) -> Self {
                Value::$kind(value.into())
            }
        }
    };
}

from!(f64, Number);
from!(i64, Integer);
from!(bool, Flag);
from!(&str, Text);
from!(String, Text);

impl<T: Into<Value>, const N: usize> From<[T; N]> for Value {
    fn from(items: [T; N]) -> Self {
        Value::List(items.into_iter().map(Into::into).collect())
    }
}

/// A number for people: the shortest digits that mean it, with an exponent for very large and
/// very small ones.
pub fn number_text(number: f64) -> String {
    let size = number.abs();
    if number.is_finite() && number != 0.0 && !(1e-4..1e9).contains(&size) {
        format!("{number:e}")
    } else {
        format!("{number}")
    }
}

/// A vector for people: `[1, 2, 3]`.
pub fn vector_text(vector: DVec3) -> String {
    let [x, y, z] = vector.to_array().map(number_text);
    format!("[{x}, {y}, {z}]")
}

/// A text between quotes, control characters escaped, long ones cut short.
pub fn quoted(text: &str, quote: char) -> String {
    const LONGEST: usize = 60;
    let mut shown: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if quote == '`' {
        shown = shown.replace("\\\"", "\"");
    }
    shown = shown.replace("\\'", "'");
    let cut = if text.chars().nth(LONGEST).is_some() { "..." } else { "" };
    format!("{quote}{shown}{cut}{quote}")
}
