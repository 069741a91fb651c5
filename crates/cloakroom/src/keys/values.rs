//! The validated values of one table.

use super::check::Fitted;
use super::nearest::unknown;
use super::{Key, KeyKind, Samples, Value};
use crate::photograph::ImageSource;
use optics::medium::Tensor;

/// Why a table cannot be had: which key is impossible, and how.
///
/// A device whose keys are each allowed but impossible together (an inner radius larger than the
/// outer one) refuses with the same error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct KeyError {
    /// The key at fault; `None` if no single one is.
    pub key: Option<&'static str>,
    /// The list of tables and the number of the table in it (counted from 0) that has the key; `None` if
    /// it is a key of the device itself.
    pub entry: Option<(&'static str, usize)>,
    /// What is wrong: quantity, value, unit, and what is allowed.
    pub message: String,
}

impl KeyError {
    /// An error of one key.
    pub fn at(key: &'static str, message: impl Into<String>) -> Self {
        KeyError { key: Some(key), entry: None, message: message.into() }
    }

    /// An error of no single key.
    pub fn general(message: impl Into<String>) -> Self {
        KeyError { key: None, entry: None, message: message.into() }
    }

    /// The same error in a table of a list: of the list `list` the table of that number, counted from 0.
    #[must_use]
    pub fn within(self, list: &'static str, number: usize) -> Self {
        KeyError { entry: Some((list, number)), ..self }
    }

    /// Where the error is, of a table such as `device.0`: `device.0.side`, `device.0.prism.2.corners`; the table
    /// itself if it is nowhere in particular.
    #[must_use]
    pub fn path_in(&self, table: &str) -> String {
        let entry = self.entry.map(|(list, number)| format!("{list}.{number}"));
        [Some(table), entry.as_deref(), self.key]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(".")
    }
}

/// What a key that takes a word or a number was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChoiceOrNumber {
    /// One of the key's words.
    Choice(&'static str),
    /// A finite number, in the key's unit.
    Number(f64),
}

/// What a key that takes numbers on a grid was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampled<'v> {
    /// The numbers.
    Here(&'v Samples),
    /// The name of a file that holds them.
    InFile(&'v str),
}

/// The values of one table: every key of a list has its value, given or by default, and every
/// value fits its key.
///
/// # Panics
///
/// Every getter panics if its key is not in the list or is of another type: that is a mistake in
/// the program, not in a scene.
#[derive(Clone, Debug)]
pub struct Values {
    keys: &'static [Key],
    /// One for each key, in the same order.
    slots: Vec<Slot>,
}

#[derive(Clone, Debug, PartialEq)]
struct Slot {
    value: Option<Fitted>,
    given: bool,
}

/// Values of the same list of keys are equal if they say the same.
impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.keys, other.keys) && self.slots == other.slots
    }
}

impl Values {
    /// Every key at its default.
    pub fn defaults(keys: &'static [Key]) -> Self {
        let slots = keys.iter().map(|key| Slot { value: key.default_fitted(), given: false });
        Values { keys, slots: slots.collect() }
    }

    /// The list of keys.
    pub fn keys(&self) -> &'static [Key] {
        self.keys
    }

    /// Gives a key a value.
    ///
    /// # Errors
    ///
    /// If there is no such key, the value is of the wrong type or outside the limits; the old
    /// value then stays.
    pub fn set(&mut self, name: &str, value: impl Into<Value>) -> Result<(), KeyError> {
        let Some(index) = self.keys.iter().position(|key| key.name == name) else {
            let known: Vec<_> = self.keys.iter().map(|key| key.name).collect();
            return Err(KeyError::general(unknown("key", name, "", &known)));
        };
        let key = &self.keys[index];
        let fitted = key.check(&value.into()).map_err(|message| KeyError::at(key.name, message))?;
        self.slots[index] = Slot { value: Some(fitted), given: true };
        Ok(())
    }

    /// Gives a key of the kind [`KeyKind::Image`] its image.
    pub(crate) fn set_image(&mut self, name: &str, image: ImageSource) {
        self.put(name, Fitted::Image(image));
    }

    /// Gives a key of the kind [`KeyKind::Tables`] its tables, held against their keys before.
    pub(crate) fn set_tables(&mut self, name: &str, tables: Vec<Values>) {
        self.put(name, Fitted::Tables(tables));
    }

    /// Gives a key of the kind [`KeyKind::Table`] its table, held against its keys before.
    pub(crate) fn set_table(&mut self, name: &str, table: Values) {
        self.put(name, Fitted::Table(table));
    }

    fn put(&mut self, name: &str, value: Fitted) {
        if let Some(index) = self.keys.iter().position(|key| key.name == name) {
            self.slots[index] = Slot { value: Some(value), given: true };
        }
    }

    /// The keys that were given, with their values.
    pub(super) fn given(&self) -> Vec<(String, Value)> {
        let given = self.keys.iter().zip(&self.slots).filter(|(_, slot)| slot.given);
        let value = |slot: &Slot| slot.value.as_ref().map(Value::from);
        given.filter_map(|(key, slot)| Some((key.name.to_owned(), value(slot)?))).collect()
    }

    /// Whether the key was given a value, rather than left at its default.
    pub fn is_given(&self, name: &str) -> bool {
        self.slot(name).1.given
    }

    /// The value of any key, as one would hand it over; `None` where it is absent and its absence
    /// means something.
    pub fn get(&self, name: &str) -> Option<Value> {
        self.slot(name).1.value.as_ref().map(Value::from)
    }

    /// A number that has a default, in its key's unit.
    pub fn number(&self, name: &str) -> f64 {
        match self.slot(name) {
            // A key without default is refused even where it was given: the mistake should show
            // in the first run, not in the first scene without it.
            (Key { kind: KeyKind::Number { default: Some(_), .. }, .. }, slot) => {
                match slot.value {
                    Some(Fitted::Number(number)) => number,
                    _ => mistaken(name, "number with a default"),
                }
            }
            _ => mistaken(name, "number with a default"),
        }
    }

    /// A number, in its key's unit; `None` where it is absent and has no default.
    pub fn optional_number(&self, name: &str) -> Option<f64> {
        match (self.slot(name).0.kind, &self.slot(name).1.value) {
            (KeyKind::Number { .. }, Some(Fitted::Number(number))) => Some(*number),
            (KeyKind::Number { .. }, None) => None,
            _ => mistaken(name, "number"),
        }
    }

    /// A whole number.
    pub fn integer(&self, name: &str) -> i64 {
        match self.slot(name).1.value {
            Some(Fitted::Integer(integer)) => integer,
            _ => mistaken(name, "whole number"),
        }
    }

    /// True or false.
    pub fn flag(&self, name: &str) -> bool {
        match self.slot(name).1.value {
            Some(Fitted::Flag(flag)) => flag,
            _ => mistaken(name, "flag"),
        }
    }

    /// One of the key's words.
    pub fn choice(&self, name: &str) -> &'static str {
        match (self.slot(name).0.kind, &self.slot(name).1.value) {
            (KeyKind::Choice { .. }, Some(Fitted::Choice(word))) => word,
            _ => mistaken(name, "choice"),
        }
    }

    /// Those of the key's words that are listed.
    pub fn choices(&self, name: &str) -> &[&'static str] {
        match &self.slot(name).1.value {
            Some(Fitted::Choices(words)) => words,
            _ => mistaken(name, "list of choices"),
        }
    }

    /// One of the key's words, or a number in its unit.
    pub fn choice_or_number(&self, name: &str) -> ChoiceOrNumber {
        match (self.slot(name).0.kind, &self.slot(name).1.value) {
            (KeyKind::ChoiceOrNumber { .. }, Some(Fitted::Choice(word))) => {
                ChoiceOrNumber::Choice(word)
            }
            (KeyKind::ChoiceOrNumber { .. }, Some(Fitted::Number(number))) => {
                ChoiceOrNumber::Number(*number)
            }
            _ => mistaken(name, "choice or number"),
        }
    }

    /// Three numbers, in the key's unit.
    pub fn vector(&self, name: &str) -> [f64; 3] {
        match self.slot(name).1.value {
            Some(Fitted::Vector(vector)) => vector,
            _ => mistaken(name, "vector"),
        }
    }

    /// Two whole numbers.
    pub fn integer_pair(&self, name: &str) -> [i64; 2] {
        match self.slot(name).1.value {
            Some(Fitted::IntegerPair(pair)) => pair,
            _ => mistaken(name, "pair of whole numbers"),
        }
    }

    /// An image that has a default.
    pub fn image(&self, name: &str) -> &ImageSource {
        match (self.slot(name).0.kind, &self.slot(name).1.value) {
            (KeyKind::Image { default: Some(_) }, Some(Fitted::Image(image))) => image,
            _ => mistaken(name, "image with a default"),
        }
    }

    /// An image; `None` where it is absent and has no default.
    pub fn optional_image(&self, name: &str) -> Option<&ImageSource> {
        match (self.slot(name).0.kind, &self.slot(name).1.value) {
            (KeyKind::Image { .. }, Some(Fitted::Image(image))) => Some(image),
            (KeyKind::Image { .. }, None) => None,
            _ => mistaken(name, "image"),
        }
    }

    /// A permittivity or permeability.
    pub fn tensor(&self, name: &str) -> Tensor {
        match self.slot(name).1.value {
            Some(Fitted::Tensor(tensor)) => tensor,
            _ => mistaken(name, "tensor"),
        }
    }

    /// The corners of a polygon, in the key's unit; `None` where it is absent.
    pub fn polygon(&self, name: &str) -> Option<&[[f64; 2]]> {
        match (self.slot(name).0.kind, &self.slot(name).1.value) {
            (KeyKind::Polygon { .. }, Some(Fitted::Polygon(corners))) => Some(corners),
            (KeyKind::Polygon { .. }, None) => None,
            _ => mistaken(name, "polygon"),
        }
    }

    /// Numbers on a grid; `None` where they are absent.
    pub fn samples(&self, name: &str) -> Option<Sampled<'_>> {
        match (self.slot(name).0.kind, &self.slot(name).1.value) {
            (KeyKind::Samples { .. }, Some(Fitted::Samples(samples))) => {
                Some(Sampled::Here(samples))
            }
            (KeyKind::Samples { .. }, Some(Fitted::File(name))) => Some(Sampled::InFile(name)),
            (KeyKind::Samples { .. }, None) => None,
            _ => mistaken(name, "grid of numbers"),
        }
    }

    /// A table; `None` where it is absent.
    pub fn table(&self, name: &str) -> Option<&Values> {
        match (self.slot(name).0.kind, &self.slot(name).1.value) {
            (KeyKind::Table { .. }, Some(Fitted::Table(table))) => Some(table),
            (KeyKind::Table { .. }, None) => None,
            _ => mistaken(name, "table"),
        }
    }

    /// A list of tables.
    pub fn tables(&self, name: &str) -> &[Values] {
        match &self.slot(name).1.value {
            Some(Fitted::Tables(tables)) => tables,
            _ => mistaken(name, "list of tables"),
        }
    }

    fn slot(&self, name: &str) -> (&'static Key, &Slot) {
        let index = self.keys.iter().position(|key| key.name == name);
        let Some(index) = index else { mistaken(name, "key of this table") };
        (&self.keys[index], &self.slots[index])
    }
}

/// A getter was asked for what its table does not have.
fn mistaken(name: &str, what: &str) -> ! {
    panic!("`{name}` is not a {what}")
}
