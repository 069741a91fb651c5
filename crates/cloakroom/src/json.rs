//! JSON: values of keys, and long lists.

use crate::keys::Value;
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// Reads an array and hands each item over as it comes, with its number, for all of them together
/// may take many times the memory of the text.
///
/// # Errors
///
/// If the text is no such array; what `each` says is told with the place in the text.
pub(crate) fn read_list<T: for<'de> Deserialize<'de>>(
    text: &str,
    each: impl FnMut(usize, T) -> Result<(), String>,
) -> serde_json::Result<()> {
    struct Items<T, F>(F, PhantomData<T>);

    impl<'de, T: Deserialize<'de>, F: FnMut(usize, T) -> Result<(), String>> Visitor<'de>
        for Items<T, F>
    {
        type Value = ();

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a sequence")
        }

        fn visit_seq<A: SeqAccess<'de>>(mut self, mut items: A) -> Result<(), A::Error> {
            let mut number = 0;
            while let Some(item) = items.next_element()? {
                (self.0)(number, item).map_err(A::Error::custom)?;
                number += 1;
            }
            Ok(())
        }
    }

    let mut deserializer = serde_json::Deserializer::from_str(text);
    deserializer.deserialize_seq(Items(each, PhantomData))?;
    deserializer.end()
}

/// The value that JSON says.
///
/// # Errors
///
/// A message if it is none of a scene: nothing, or a number that is too large.
pub fn value(json: &serde_json::Value) -> Result<Value, String> {
    Ok(match json {
        serde_json::Value::Null => {
            return Err("null stands for nothing in a scene; leave the key out".to_owned());
        }
        serde_json::Value::Bool(flag) => (*flag).into(),
        serde_json::Value::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(integer), _) => integer.into(),
            (None, Some(float)) => float.into(),
            (None, None) => return Err(format!("{number} is no number of a scene")),
        },
        serde_json::Value::String(text) => text.as_str().into(),
        serde_json::Value::Array(items) => {
            Value::List(items.iter().map(value).collect::<Result<_, _>>()?)
        }
        serde_json::Value::Object(entries) => {
            let entries = entries.iter().map(|(name, json)| Ok((name.clone(), value(json)?)));
            Value::Table(entries.collect::<Result<_, String>>()?)
        }
    })
}

/// The same value in JSON.
#[must_use]
pub fn json(value: Value) -> serde_json::Value {
    match value {
        Value::Number(number) => number.into(),
        Value::Integer(integer) => integer.into(),
        Value::Flag(flag) => flag.into(),
        Value::Text(text) | Value::Date(text) => text.into(),
        Value::List(items) => items.into_iter().map(json).collect(),
        Value::Table(entries) => {
            entries.into_iter().map(|(name, value)| (name, json(value))).collect()
        }
    }
}
