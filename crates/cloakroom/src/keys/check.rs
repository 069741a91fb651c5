//! A value held against its key: type, limits, and the message if it does not fit.

use super::nearest::nearest;
use super::value::{Value, number_text, quoted};
use super::{Key, KeyKind, Limits, Samples, Values, tensor};
use crate::photograph::ImageSource;
use optics::medium::Tensor;
use std::path::Path;

/// A value that fits its key.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Fitted {
    Number(f64),
    Integer(i64),
    Flag(bool),
    Choice(&'static str),
    Choices(Vec<&'static str>),
    Vector([f64; 3]),
    IntegerPair([i64; 2]),
    Image(ImageSource),
    /// The name of a file of samples.
    File(String),
    Tensor(Tensor),
    Polygon(Vec<[f64; 2]>),
    Samples(Samples),
    Table(Values),
    Tables(Vec<Values>),
}

impl From<&Fitted> for Value {
    fn from(value: &Fitted) -> Self {
        match value {
            Fitted::Number(number) => Value::Number(*number),
            Fitted::Integer(integer) => Value::Integer(*integer),
            Fitted::Flag(flag) => Value::Flag(*flag),
            Fitted::Choice(word) => Value::from(*word),
            Fitted::Choices(words) => {
                Value::List(words.iter().map(|&word| Value::from(word)).collect())
            }
            Fitted::Vector(vector) => Value::from(*vector),
            Fitted::IntegerPair(pair) => Value::from(*pair),
            Fitted::Image(image) => Value::from(image.to_string()),
            Fitted::File(name) => Value::from(name.as_str()),
            Fitted::Tensor(tensor) => tensor::to_value(tensor),
            Fitted::Polygon(corners) => {
                Value::List(corners.iter().map(|corner| Value::from(*corner)).collect())
            }
            Fitted::Samples(samples) => Value::from(samples),
            Fitted::Table(table) => Value::Table(table.given()),
            Fitted::Tables(tables) => {
                Value::List(tables.iter().map(|table| Value::Table(table.given())).collect())
            }
        }
    }
}

impl Limits {
    /// Whether a number is allowed; NaN and the infinities never are.
    pub fn allow(&self, number: f64) -> bool {
        number.is_finite()
            && match *self {
                Limits::Finite => true,
                Limits::Positive => number > 0.0,
                Limits::Between(low, high) => number > low && number < high,
                Limits::Within(low, high) => number >= low && number <= high,
            }
    }

    /// What is allowed, to be read after "must be": "above 0", "from 0 to 1".
    pub fn describe(&self) -> String {
        match *self {
            Limits::Finite => "a finite number".to_owned(),
            Limits::Positive => "above 0".to_owned(),
            Limits::Between(low, high) => {
                format!("above {} and below {}", number_text(low), number_text(high))
            }
            Limits::Within(low, high) => {
                format!("from {} to {}", number_text(low), number_text(high))
            }
        }
    }
}

impl Key {
    /// What the key takes, to be read after "must be": "a number (cm)", "true or false".
    pub fn describe(&self) -> String {
        match self.kind {
            KeyKind::Number { unit, .. } => format!("a number{}", in_brackets(unit)),
            KeyKind::Integer { .. } => "a whole number".to_owned(),
            KeyKind::Flag { .. } => "true or false".to_owned(),
            KeyKind::Choice { options } => words(options),
            KeyKind::Choices { options } => format!("a list of words, each {}", words(options)),
            KeyKind::Vector { unit, .. } => format!("three numbers{}", in_brackets(unit)),
            KeyKind::IntegerPair { .. } => "two whole numbers".to_owned(),
            KeyKind::Image { .. } => "the name of an image".to_owned(),
            KeyKind::ChoiceOrNumber { options, unit } => {
                let options = options.iter().map(|option| quoted(option, '"'));
                let options = options.collect::<Vec<_>>().join(", ");
                format!("{options} or a number{}", in_brackets(unit))
            }
            KeyKind::Tensor => "a number, [re, im], or 3 x 3 of either".to_owned(),
            KeyKind::Polygon { unit } => {
                format!("three or more corners [x, y]{}", in_brackets(unit))
            }
            KeyKind::Samples { .. } => "rows of numbers, or the name of a file".to_owned(),
            KeyKind::Table { keys } => format!("a table with {}", key_names(keys)),
            KeyKind::Tables { keys } => format!("a list of tables with {}", key_names(keys)),
        }
    }

    /// The value where the key is absent; `None` if absence itself means something.
    pub fn default_value(&self) -> Option<Value> {
        self.default_fitted().as_ref().map(Value::from)
    }

    pub(super) fn default_fitted(&self) -> Option<Fitted> {
        match self.kind {
            KeyKind::Number { default, .. } => default.map(Fitted::Number),
            KeyKind::Integer { default, .. } => Some(Fitted::Integer(default)),
            KeyKind::Flag { default } => Some(Fitted::Flag(default)),
            KeyKind::Choices { .. } => Some(Fitted::Choices(Vec::new())),
            KeyKind::Vector { default, .. } => Some(Fitted::Vector(default)),
            KeyKind::IntegerPair { default, .. } => Some(Fitted::IntegerPair(default)),
            KeyKind::Image { default } => default.and_then(|name| image(name).ok()),
            KeyKind::Tensor => Some(Fitted::Tensor(1.0.into())),
            KeyKind::Polygon { .. } | KeyKind::Samples { .. } | KeyKind::Table { .. } => None,
            KeyKind::Tables { .. } => Some(Fitted::Tables(Vec::new())),
            KeyKind::Choice { options } | KeyKind::ChoiceOrNumber { options, .. } => {
                options.first().map(|option| Fitted::Choice(option))
            }
        }
    }

    /// Holds a value against the key; the message says what it is and what it must be.
    pub(super) fn check(&self, value: &Value) -> Result<Fitted, String> {
        match self.kind {
            KeyKind::Number { unit, limits, .. } => {
                let number = value.as_number().ok_or_else(|| self.wrong_type(value))?;
                limit(self.name, number, unit, limits)?;
                Ok(Fitted::Number(number))
            }
            KeyKind::Integer { min, max, .. } => {
                let integer = value.as_integer().ok_or_else(|| self.wrong_type(value))?;
                limit_integer(self.name, integer, min, max)?;
                Ok(Fitted::Integer(integer))
            }
            KeyKind::Flag { .. } => match *value {
                Value::Flag(flag) => Ok(Fitted::Flag(flag)),
                _ => Err(self.wrong_type(value)),
            },
            KeyKind::Choice { options } => self.choose(value, options).map(Fitted::Choice),
            KeyKind::Choices { options } => {
                let Value::List(items) = value else { return Err(self.wrong_type(value)) };
                let chosen = items.iter().map(|item| {
                    choose(item, options).map_err(|hint| {
                        format!("{} holds {item}; it must be {}{hint}", self.name, self.describe())
                    })
                });
                chosen.collect::<Result<_, _>>().map(Fitted::Choices)
            }
            KeyKind::Vector { unit, limits, .. } => {
                let numbers = self.list(value, Value::as_number)?;
                for (number, axis) in numbers.iter().zip(["first", "second", "third"]) {
                    let name = format!("the {axis} component of {}", self.name);
                    limit(&name, *number, unit, limits)?;
                }
                Ok(Fitted::Vector(numbers))
            }
            KeyKind::IntegerPair { min, max, .. } => {
                let integers = self.list(value, Value::as_integer)?;
                for (integer, place) in integers.iter().zip(["first", "second"]) {
                    let name = format!("the {place} number of {}", self.name);
                    limit_integer(&name, *integer, min, max)?;
                }
                Ok(Fitted::IntegerPair(integers))
            }
            KeyKind::Image { .. } | KeyKind::Samples { .. } if *value == Value::from("") => {
                Err(format!("{} is empty", self.name))
            }
            KeyKind::Image { .. } => match value {
                Value::Text(name) => image(name),
                _ => Err(self.wrong_type(value)),
            },
            KeyKind::Samples { limits } => match value {
                Value::Text(name) => Ok(Fitted::File(name.clone())),
                _ => self.samples(value, limits).map(Fitted::Samples),
            },
            KeyKind::ChoiceOrNumber { options, unit } => match value.as_number() {
                Some(number) => {
                    limit(self.name, number, unit, Limits::Finite)?;
                    Ok(Fitted::Number(number))
                }
                None => self.choose(value, options).map(Fitted::Choice),
            },
            KeyKind::Tensor => {
                let tensor = tensor::from_value(value).ok_or_else(|| self.wrong_type(value))?;
                for number in tensor::parts(&tensor) {
                    let name = format!("an entry of {}", self.name);
                    limit(&name, number, "", Limits::Finite)?;
                }
                Ok(Fitted::Tensor(tensor))
            }
            KeyKind::Polygon { unit } => self.polygon(value, unit).map(Fitted::Polygon),
            KeyKind::Table { keys } => self.table(value, keys).map(Fitted::Table),
            KeyKind::Tables { keys } => self.tables(value, keys).map(Fitted::Tables),
        }
    }

    fn polygon(&self, value: &Value, unit: &str) -> Result<Vec<[f64; 2]>, String> {
        let Value::List(items) = value else { return Err(self.wrong_type(value)) };
        if items.len() < 3 {
            return Err(self.wrong_type(value));
        }
        let corner = |item: &Value| -> Result<[f64; 2], String> {
            let corner: [f64; 2] = self
                .list(item, Value::as_number)
                .map_err(|_| format!("a corner of {} is {item}; it must be [x, y]", self.name))?;
            for number in corner {
                let name = format!("a coordinate of {}", self.name);
                limit(&name, number, unit, Limits::COORDINATE)?;
            }
            Ok(corner)
        };
        items.iter().map(corner).collect()
    }

    fn samples(&self, value: &Value, limits: Limits) -> Result<Samples, String> {
        let Value::List(rows) = value else { return Err(self.wrong_type(value)) };
        let number = |at: [usize; 2], item: &Value| -> Result<f64, String> {
            let name = format!("{}[{}][{}]", self.name, at[0], at[1]);
            let number =
                item.as_number().ok_or_else(|| format!("{name} is {item}; it must be a number"))?;
            limit(&name, number, "", limits)?;
            Ok(number)
        };
        let row = |(i, row): (usize, &Value)| -> Result<Vec<f64>, String> {
            let Value::List(items) = row else { return Err(self.wrong_type(value)) };
            items.iter().enumerate().map(|(j, item)| number([i, j], item)).collect()
        };
        let rows: Vec<Vec<f64>> = rows.iter().enumerate().map(row).collect::<Result<_, _>>()?;
        Samples::new(&rows).map_err(|error| format!("{} is no grid: {error}", self.name))
    }

    fn tables(&self, value: &Value, keys: &'static [Key]) -> Result<Vec<Values>, String> {
        let Value::List(items) = value else { return Err(self.wrong_type(value)) };
        items.iter().map(|item| self.table(item, keys)).collect()
    }

    fn table(&self, value: &Value, keys: &'static [Key]) -> Result<Values, String> {
        let Value::Table(entries) = value else { return Err(self.wrong_type(value)) };
        let mut values = Values::defaults(keys);
        for (name, value) in entries {
            values
                .set(name, value.clone())
                .map_err(|error| format!("in {}: {}", self.name, error.message))?;
        }
        Ok(values)
    }

    fn wrong_type(&self, value: &Value) -> String {
        format!("{} is {value}; it must be {}", self.name, self.describe())
    }

    fn choose(&self, value: &Value, options: &[&'static str]) -> Result<&'static str, String> {
        choose(value, options).map_err(|hint| self.wrong_type(value) + &hint)
    }

    fn list<T, const N: usize>(
        &self,
        value: &Value,
        item: impl Fn(&Value) -> Option<T>,
    ) -> Result<[T; N], String> {
        let Value::List(items) = value else { return Err(self.wrong_type(value)) };
        let fitted: Option<Vec<T>> = items.iter().map(item).collect();
        let fitted = fitted.and_then(|items| <[T; N]>::try_from(items).ok());
        fitted.ok_or_else(|| self.wrong_type(value))
    }
}

/// The image of a name that is relative to no folder.
fn image(name: &str) -> Result<Fitted, String> {
    let source = ImageSource::parse(name, Path::new(""));
    source.map(Fitted::Image).map_err(|error| error.to_string())
}

/// The option that a word is; else a hint which one may have been meant.
fn choose(value: &Value, options: &[&'static str]) -> Result<&'static str, String> {
    let Value::Text(word) = value else { return Err(String::new()) };
    options.iter().copied().find(|option| option == word).ok_or_else(|| {
        let meant = nearest(word, options.iter().copied());
        meant.map(|meant| format!("; did you mean {}?", quoted(meant, '"'))).unwrap_or_default()
    })
}

fn limit(name: &str, number: f64, unit: &str, limits: Limits) -> Result<(), String> {
    if limits.allow(number) {
        return Ok(());
    }
    if !number.is_finite() {
        let what = if number.is_nan() { "not a number (nan)" } else { "infinite" };
        return Err(format!("{name} is {what}; numbers must be finite"));
    }
    let space = if unit.is_empty() { "" } else { " " };
    let shown = number_text(number);
    Err(format!("{name} is {shown}{space}{unit}; it must be {}", limits.describe()))
}

fn limit_integer(name: &str, integer: i64, min: i64, max: i64) -> Result<(), String> {
    if (min..=max).contains(&integer) {
        return Ok(());
    }
    let allowed = match max {
        i64::MAX => format!("{min} or above"),
        _ => format!("from {min} to {max}"),
    };
    Err(format!("{name} is {integer}; it must be {allowed}"))
}

/// `"a", "b" or "c"`.
fn words(options: &[&str]) -> String {
    let quoted: Vec<_> = options.iter().map(|option| quoted(option, '"')).collect();
    match quoted.as_slice() {
        [] => "nothing".to_owned(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// "the key a", "the keys a, b".
fn key_names(keys: &[Key]) -> String {
    let names: Vec<_> = keys.iter().map(|key| key.name).collect();
    format!("the key{} {}", if names.len() == 1 { "" } else { "s" }, names.join(", "))
}

fn in_brackets(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" ({unit})") }
}
