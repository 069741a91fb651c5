//! Values of keys as JSON.

use crate::keys::Value;

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
