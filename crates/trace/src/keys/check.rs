//! A value held against its key: type, limits, and the message if it does not fit.

use super::field::{MESH_ENDINGS, is_material_file};
use super::nearest::{hint, nearest};
use super::samples::place_text;
use super::value::{Value, items_of, number_text, quoted};
use super::{BUILT_IN_IMAGES, BUILT_IN_PREFIX, Key, KeyKind, Samples, ValueRange, find, tensor};
use glam::DVec3;
use optics::material::Material;
use optics::wave::unit;

/// The longest name that a scene can give.
const LONGEST_NAME: usize = 64;

/// Whether a text can be a name.
fn is_name(text: &str) -> bool {
    let mut rest = text.chars();
    rest.next().is_some_and(char::is_alphabetic)
        && rest.all(|c| c.is_alphanumeric() || c == '-' || c == '_')
        && text.chars().count() <= LONGEST_NAME
}

impl ValueRange {
    /// Whether a number is allowed; NaN and the infinities never are.
    pub fn allow(&self, number: f64) -> bool {
        number.is_finite()
            && match *self {
                ValueRange::Finite => true,
                ValueRange::Positive => number > 0.0,
                ValueRange::Between(low, high) => number > low && number < high,
                ValueRange::Within(low, high) => number >= low && number <= high,
                ValueRange::Whole(low, high) => (low as f64..=high as f64).contains(&number),
            }
    }

    /// What is allowed, to be read after "must be": "above 0", "from 0 to 1".
    pub fn describe(&self) -> String {
        match *self {
            ValueRange::Finite => "a finite number".to_owned(),
            ValueRange::Positive => "above 0".to_owned(),
            ValueRange::Between(low, high) => {
                format!("above {} and below {}", number_text(low), number_text(high))
            }
            ValueRange::Within(low, high) => {
                format!("from {} to {}", number_text(low), number_text(high))
            }
            ValueRange::Whole(low, i64::MAX) => format!("{low} or above"),
            ValueRange::Whole(low, high) => format!("from {low} to {high}"),
        }
    }
}

impl Key {
    /// What the key takes, to be read after "must be": "a number (cm)", "true or false".
    pub fn describe(&self) -> String {
        let unit = in_brackets(self.unit);
        match self.kind {
            KeyKind::Number => format!("a number{unit}"),
            KeyKind::Integer => "a whole number".to_owned(),
            KeyKind::Flag => "true or false".to_owned(),
            KeyKind::Choice { options } => words(options),
            KeyKind::Choices { options } => format!("a list of words, each {}", words(options)),
            KeyKind::Vector => format!("three numbers{unit}"),
            KeyKind::IntegerPair => "two whole numbers".to_owned(),
            KeyKind::Interval => format!("two numbers{unit}, the lower one first"),
            KeyKind::Image => "the name of an image".to_owned(),
            KeyKind::ChoiceOrNumber { options } => {
                let options = options.iter().map(|option| quoted(option, '"'));
                format!("{} or a number{unit}", options.collect::<Vec<_>>().join(", "))
            }
            KeyKind::ChoiceNumberOrTable { options, keys } => {
                let options = options.iter().map(|option| quoted(option, '"'));
                let options = options.collect::<Vec<_>>().join(", ");
                format!("{options}, a number{unit}, or a table with {}", key_names(keys))
            }
            KeyKind::Tensor => "a number, [re, im], or 3 x 3 of either".to_owned(),
            KeyKind::Complex => "a number or [re, im]".to_owned(),
            KeyKind::Direction => format!("three numbers, or an angle in the x, y plane{unit}"),
            KeyKind::Axes => "three directions at right angles, [x, y, z] each".to_owned(),
            KeyKind::Material => "the name of a material or of a .yml file".to_owned(),
            KeyKind::MaterialOrTable { keys } => {
                format!(
                    "the name of a material or of a .yml file, or a table with {}",
                    key_names(keys)
                )
            }
            KeyKind::Mesh => format!("the name of a file that ends with {}", MESH_ENDINGS.join(", ")),
            KeyKind::Name => "a name: a letter, then letters, digits, - and _".to_owned(),
            KeyKind::Polygon => format!("three or more corners [x, y]{unit}"),
            KeyKind::Samples { dimensions } => match dimensions {
                [2, 2] => "rows of numbers, or the name of a file",
                [2, _] => "rows of numbers, a list of such rows for each x, or the name of a file",
                [_, 3] => "a number, or as many as the grid has, or the name of a file",
                _ => "an angle or [x, y, z], or as many of either as the grid has, or the name of a file",
            }
            .to_owned(),
            KeyKind::Table { keys } => format!("a table with {}", key_names(keys)),
            KeyKind::FlagOrTable { keys } => {
                format!("true, false or a table with {}", key_names(keys))
            }
            KeyKind::Tables { keys } => format!("a list of tables with {}", key_names(keys)),
        }
    }

    /// Holds a value against the key, and gives it back as the key has it: 3 is 3.0 where a number
    /// is asked for.
    ///
    /// # Errors
    ///
    /// A message that says what the value is and what it must be.
    pub fn check(&self, value: &Value) -> Result<Value, String> {
        Ok(match self.kind {
            KeyKind::Number => {
                let number = self.of_type(value, value.as_number())?;
                self.limit(self.name, number)?;
                number.into()
            }
            KeyKind::Integer => {
                let integer = self.of_type(value, value.as_integer())?;
                self.limit_integer(self.name, integer)?;
                integer.into()
            }
            KeyKind::Flag => self.of_type(value, value.as_flag())?.into(),
            KeyKind::Choice { options } => self.choose(value, options)?,
            KeyKind::Choices { options } => {
                let chosen = self.of_type(value, value.as_list())?.iter().map(|item| {
                    choose(item, options).map(Value::from).map_err(|hint| {
                        format!("{} holds {item}; it must be {}{hint}", self.name, self.describe())
                    })
                });
                Value::List(chosen.collect::<Result<_, _>>()?)
            }
            KeyKind::Vector => {
                let numbers: [f64; 3] = self.of_type(value, items_of(value, Value::as_number))?;
                for (number, axis) in numbers.iter().zip(["first", "second", "third"]) {
                    self.limit(&format!("the {axis} component of {}", self.name), *number)?;
                }
                numbers.into()
            }
            KeyKind::IntegerPair => {
                let integers: [i64; 2] = self.of_type(value, items_of(value, Value::as_integer))?;
                for (integer, place) in integers.iter().zip(["first", "second"]) {
                    self.limit_integer(&format!("the {place} number of {}", self.name), *integer)?;
                }
                integers.into()
            }
            KeyKind::Interval => {
                let ends: [f64; 2] = self.of_type(value, items_of(value, Value::as_number))?;
                for (end, name) in ends.iter().zip(["lower", "upper"]) {
                    self.limit(&format!("the {name} end of {}", self.name), *end)?;
                }
                self.of_type(value, (ends[0] < ends[1]).then(|| ends.into()))?
            }
            KeyKind::Image | KeyKind::Samples { .. } if *value == Value::from("") => {
                return Err(format!("{} is empty", self.name));
            }
            KeyKind::Image => {
                check_image_name(self.of_type(value, value.as_text())?)?;
                value.clone()
            }
            KeyKind::Samples { dimensions } => {
                if !matches!(value, Value::Text(_)) {
                    self.samples(value, dimensions)?;
                }
                value.clone()
            }
            KeyKind::ChoiceNumberOrTable { keys, .. } if value.as_table().is_some() => {
                self.table(value, keys)?
            }
            KeyKind::ChoiceOrNumber { options } | KeyKind::ChoiceNumberOrTable { options, .. } => {
                match value.as_number() {
                    Some(number) => {
                        self.limit(self.name, number)?;
                        number.into()
                    }
                    None => self.choose(value, options)?,
                }
            }
            KeyKind::Tensor => {
                let tensor = self.of_type(value, tensor::from_value(value))?;
                for number in tensor::parts(&tensor) {
                    self.limit(&format!("an entry of {}", self.name), number)?;
                }
                tensor::to_value(&tensor)
            }
            KeyKind::Complex => {
                let number = self.of_type(value, tensor::entry(value))?;
                for (part, name) in [(number.re, "real"), (number.im, "imaginary")] {
                    self.limit(&format!("the {name} part of {}", self.name), part)?;
                }
                value.clone()
            }
            KeyKind::Direction => match value.as_number() {
                Some(number) => {
                    self.limit(self.name, number)?;
                    number.into()
                }
                None => self.direction(self.name, value)?.into(),
            },
            KeyKind::Axes => {
                let items: &[Value; 3] =
                    self.of_type(value, value.as_list().and_then(|items| items.try_into().ok()))?;
                let name = format!("an axis of {}", self.name);
                let axes = [0, 1, 2].map(|i| self.direction(&name, &items[i]));
                let [x, y, z] = axes;
                let axes = [x?, y?, z?].map(DVec3::from_array);
                right_angles(self.name, axes)?;
                value.clone()
            }
            KeyKind::Material => {
                check_material_name(self.of_type(value, value.as_text())?)?;
                value.clone()
            }
            KeyKind::MaterialOrTable { keys } => match value {
                Value::Table(_) => self.table(value, keys)?,
                _ => {
                    check_material_name(self.of_type(value, value.as_text())?)?;
                    value.clone()
                }
            },
            KeyKind::Mesh => {
                let name = self.of_type(value, value.as_text())?.to_ascii_lowercase();
                let known = MESH_ENDINGS.iter().any(|ending| name.ends_with(ending));
                self.of_type(value, known.then_some(()))?;
                value.clone()
            }
            KeyKind::Name => {
                let name = self.of_type(value, value.as_text())?;
                self.of_type(value, is_name(name).then_some(()))?;
                value.clone()
            }
            KeyKind::Polygon => self.polygon(value)?,
            KeyKind::Table { keys } => self.table(value, keys)?,
            KeyKind::FlagOrTable { keys } => match value {
                Value::Table(_) => self.table(value, keys)?,
                Value::Text(word) if find(keys, "material").is_ok() => {
                    let (name, word) = (self.name, quoted(word, '"'));
                    return Err(format!(
                        "{name} is {word}; a material is written {name} = {{ material = {word} }}, a perfect \
                         conductor {name} = true"
                    ));
                }
                _ => self.of_type(value, value.as_flag())?.into(),
            },
            KeyKind::Tables { keys } => {
                let items = self.of_type(value, value.as_list())?;
                let tables = items.iter().map(|item| self.table(item, keys));
                Value::List(tables.collect::<Result<_, _>>()?)
            }
        })
    }

    /// Three finite numbers that are not all zero.
    fn direction(&self, name: &str, value: &Value) -> Result<[f64; 3], String> {
        let numbers: [f64; 3] = self.of_type(value, items_of(value, Value::as_number))?;
        if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
            return Err(format!("{name} holds {number}; numbers must be finite"));
        }
        match unit(DVec3::from_array(numbers)) {
            Some(_) => Ok(numbers),
            None => Err(format!("{name} is {value}; it must be a direction")),
        }
    }

    fn polygon(&self, value: &Value) -> Result<Value, String> {
        let items = value.as_list().filter(|items| items.len() >= 3);
        let items = self.of_type(value, items)?;
        let corner = |item: &Value| -> Result<Value, String> {
            let corner: [f64; 2] = items_of(item, Value::as_number)
                .ok_or_else(|| format!("a corner of {} is {item}; it must be [x, y]", self.name))?;
            for number in corner {
                self.limit(&format!("a coordinate of {}", self.name), number)?;
            }
            Ok(corner.into())
        };
        items.iter().map(corner).collect::<Result<_, _>>().map(Value::List)
    }

    fn samples(&self, value: &Value, dimensions: [usize; 2]) -> Result<Samples, String> {
        let mut refused = None;
        let gathered = Samples::gather(value, dimensions, |at, item| {
            let name = format!("{}{}", self.name, place_text(at));
            let number = match item.as_number() {
                Some(number) => self.limit(&name, number).map(|()| number),
                None => Err(format!("{name} is {item}; it must be a number")),
            };
            number.inspect_err(|message| refused = Some(message.clone()))
        });
        match (gathered, refused) {
            (_, Some(message)) => Err(message),
            (Err(error), None) => Err(format!("{} is no grid: {error}", self.name)),
            (Ok(samples), None) => self.of_type(value, samples),
        }
    }

    /// The entries that are given, in the order of the keys.
    fn table(&self, value: &Value, keys: &'static [Key]) -> Result<Value, String> {
        let mut given = Vec::new();
        for (name, value) in self.of_type(value, value.as_table())? {
            let key = find(keys, name).map_err(|error| error.message);
            let value = key.and_then(|key| key.check(value));
            given.push((
                name.clone(),
                value.map_err(|message| format!("in {}: {message}", self.name))?,
            ));
        }
        given.sort_by_key(|(name, _)| keys.iter().position(|key| key.name == name));
        Ok(Value::Table(given))
    }

    /// The message about a value of a wrong type: what it is, and what it must be.
    pub fn wrong_type(&self, value: &Value) -> String {
        // A list without its brackets is a word.
        let numbers = value.as_text().and_then(|text| {
            let number = |part: &str| part.trim().parse().ok().map(Value::Number);
            text.split(',').map(number).collect()
        });
        let list = numbers.map(Value::List).filter(|list| self.check(list).is_ok());
        let hint = match list {
            Some(list) => format!(", in brackets: {list}"),
            None if value.as_text().is_some_and(is_range) => {
                ", one alone; a range is for --sweep, of `cloakroom quality` and `animate`"
                    .to_owned()
            }
            None => String::new(),
        };
        format!("{} is {value}; it must be {}{hint}", self.name, self.describe())
    }

    fn choose(&self, value: &Value, options: &[&'static str]) -> Result<Value, String> {
        choose(value, options).map(Value::from).map_err(|hint| self.wrong_type(value) + &hint)
    }

    /// What a value has been read as, if it is of the type of the key.
    fn of_type<T>(&self, value: &Value, read: Option<T>) -> Result<T, String> {
        read.ok_or_else(|| self.wrong_type(value))
    }

    /// Refuses a number outside the limits, by the name `name`.
    pub(super) fn limit(&self, name: &str, number: f64) -> Result<(), String> {
        if self.limits.allow(number) {
            return Ok(());
        }
        if !number.is_finite() {
            let what = if number.is_nan() { "not a number (nan)" } else { "infinite" };
            return Err(format!("{name} is {what}; numbers must be finite"));
        }
        let space = if self.unit.is_empty() { "" } else { " " };
        let (shown, unit) = (number_text(number), self.unit);
        Err(format!("{name} is {shown}{space}{unit}; it must be {}", self.limits.describe()))
    }

    fn limit_integer(&self, name: &str, integer: i64) -> Result<(), String> {
        match self.limits {
            ValueRange::Whole(min, max) if !(min..=max).contains(&integer) => {
                Err(format!("{name} is {integer}; it must be {}", self.limits.describe()))
            }
            _ => Ok(()),
        }
    }
}

/// Refuses axes that are not at right angles but for the digits that people type.
fn right_angles(name: &str, axes: [DVec3; 3]) -> Result<(), String> {
    const RIGHT: f64 = 1e-6;
    let [x, y, z] = axes.map(|axis| unit(axis).unwrap_or_default());
    let largest = [x.dot(y), y.dot(z), z.dot(x)].into_iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    if largest <= RIGHT {
        return Ok(());
    }
    let off = largest.asin().to_degrees();
    Err(format!("{name} are {} degrees off right angles", number_text((off * 1e6).round() / 1e6)))
}

/// Refuses names of materials that do not come with the program; whether a file is there is not
/// looked at.
fn check_material_name(name: &str) -> Result<(), String> {
    if is_material_file(name) || Material::NAMES.contains(&name) {
        return Ok(());
    }
    let hint = hint(name, &Material::NAMES, "there are");
    Err(format!("there is no material {} (a file's name ends in .yml){hint}", quoted(name, '`')))
}

/// Refuses names of built-in images that do not exist; whether a file is there is not looked at.
fn check_image_name(name: &str) -> Result<(), String> {
    if !name.starts_with(BUILT_IN_PREFIX) || BUILT_IN_IMAGES.contains(&name) {
        return Ok(());
    }
    let known = BUILT_IN_IMAGES.map(|known| quoted(known, '`')).join(", ");
    Err(format!("there is no built-in image {}; there is {known}", quoted(name, '`')))
}

/// The option that a word is; else a hint which one may have been meant.
fn choose(value: &Value, options: &[&'static str]) -> Result<&'static str, String> {
    let Value::Text(word) = value else { return Err(String::new()) };
    options.iter().copied().find(|option| option == word).ok_or_else(|| {
        let meant = nearest(word, options.iter().copied());
        meant.map(|meant| format!("; did you mean {}?", quoted(meant, '"'))).unwrap_or_default()
    })
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

/// Whether a text is two numbers with dots between them, and perhaps a step: `0..20:5`.
fn is_range(text: &str) -> bool {
    let is_number = |part: &str| part.trim().parse::<f64>().is_ok();
    text.split_once("..").is_some_and(|(from, to)| is_number(from) && to.split(':').all(is_number))
}

fn in_brackets(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" ({unit})") }
}
