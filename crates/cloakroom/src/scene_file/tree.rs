//! The text of a scene as values, with the places where they were written.

use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::SceneFileError;
use super::locations::{Locations, Origin, Place, join};
use crate::keys::Value;

/// A longer list has no places for its numbers.
const LONGEST_TOLD: usize = 64;

/// Bytes of the text, and what is wrong there.
type Fault = (Range<usize>, String);

/// Reads the text of a scene file; the places go into `locations`, whose text it is.
pub(super) fn parse(locations: &mut Locations) -> Result<Value, SceneFileError> {
    let text = Arc::clone(&locations.text);
    let document = DeTable::parse(&text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        // The parser says what it expected, but not which key is there twice.
        let message = match (error.message(), text.get(span.clone())) {
            ("duplicate key", Some(key)) => format!("`{key}` is given twice"),
            // By its first letter the parser takes a word for a number.
            (message, Some(word)) if is_float_of(message, word) => {
                format!("text must be quoted: {word:?}")
            }
            (message, _) => message.to_owned(),
        };
        locations.error(&Origin::File(span), message)
    })?;
    table(document.into_inner(), "", locations)
        .map_err(|(span, message)| locations.error(&Origin::File(span), message))
}

/// Whether a message is that of a number, such as `nan`, and what stands there a word.
fn is_float_of(message: &str, word: &str) -> bool {
    message.starts_with("invalid float") && word.starts_with(|c: char| c.is_alphabetic())
}

/// Reads the value of an override; what is no TOML is a bare text.
pub(super) fn parse_value(text: &str) -> Result<Value, String> {
    let Ok(value) = DeValue::parse(text) else { return Ok(text.into()) };
    let mut nowhere = Locations::new("", text, &[]);
    let value = self::value(value, None, &mut nowhere).map_err(|(_, message)| message)?;
    Ok(if let Value::Date(_) = value { text.into() } else { value })
}

/// A value as TOML has it.
pub(super) fn to_toml(value: &Value) -> toml::Value {
    match value {
        Value::Number(number) => (*number).into(),
        Value::Integer(integer) => (*integer).into(),
        Value::Flag(flag) => (*flag).into(),
        Value::Text(text) | Value::Date(text) => text.as_str().into(),
        Value::List(items) => items.iter().map(to_toml).collect::<Vec<_>>().into(),
        Value::Table(entries) => {
            let entries = entries.iter().map(|(name, value)| (name.clone(), to_toml(value)));
            toml::Value::Table(entries.collect())
        }
    }
}

/// Reads a table; the paths and the places of all that is in it go into `locations`.
fn table(table: DeTable<'_>, path: &str, locations: &mut Locations) -> Result<Value, Fault> {
    // The parser sorts keys by name; messages and the written scene keep the order of the file.
    let mut entries: Vec<_> = table.into_iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    let entry = |(key, inner): (Spanned<std::borrow::Cow<'_, str>>, Spanned<DeValue<'_>>)| {
        let [key_origin, origin] = [key.span(), inner.span()].map(Origin::File);
        let key = key.into_inner().into_owned();
        let path = join(path, &key);
        locations.tell(&path, Place { key: key_origin, value: origin });
        Ok((key, value(inner, Some(&path), locations)?))
    };
    Ok(Value::Table(entries.into_iter().map(entry).collect::<Result<_, _>>()?))
}

/// Reads a value; `path` is absent within lists of lists, of which nothing is told.
fn value(
    value: Spanned<DeValue<'_>>,
    path: Option<&str>,
    locations: &mut Locations,
) -> Result<Value, Fault> {
    let span = value.span();
    Ok(match value.into_inner() {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Boolean(flag) => Value::Flag(flag),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) => Value::Integer(integer),
            Err(_) => return Err((span, "whole numbers must fit into 64 bits".to_owned())),
        },
        DeValue::Float(float) => match float.as_str().parse() {
            Ok(number) => Value::Number(number),
            Err(_) => return Err((span, "this is not a number".to_owned())),
        },
        DeValue::Array(items) => {
            let told = path.filter(|_| {
                items.len() <= LONGEST_TOLD || items.iter().any(|item| item.get_ref().is_table())
            });
            let item = |(number, item): (usize, Spanned<DeValue<'_>>)| {
                let path = told.map(|path| join(path, &number.to_string()));
                if let Some(path) = &path {
                    let [key, value] = [item.span(), item.span()].map(Origin::File);
                    locations.tell(path, Place { key, value });
                }
                let path = path.as_deref().filter(|_| item.get_ref().is_table());
                self::value(item, path, locations)
            };
            Value::List(items.into_iter().enumerate().map(item).collect::<Result<_, _>>()?)
        }
        DeValue::Table(inner) => table(inner, path.unwrap_or(""), locations)?,
    })
}
