//! A scene as a tree whose nodes know where they come from.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::SceneFileError;
use crate::keys::Value;

/// Where a part of the tree was written.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Origin {
    /// Bytes of the scene file.
    File(Range<usize>),
    /// The override of this number.
    Override(usize),
}

/// A value and where it was written; the place of a table is its header.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub origin: Origin,
    pub item: Item,
}

/// What a node is.
#[derive(Clone, Debug)]
pub(super) enum Item {
    Number(f64),
    Integer(i64),
    Flag(bool),
    Text(String),
    /// No key takes dates; the text is kept for overrides, where it may be a bare word.
    Date(String),
    List(Vec<Node>),
    Table(Table),
}

/// The entries of a table in the order in which they were written.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    pub entries: Vec<Entry>,
}

/// A key and its value.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub key: String,
    pub key_origin: Origin,
    pub node: Node,
}

impl Table {
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    /// The node of a key, made by `default` if it is not there yet.
    pub fn get_or_insert(
        &mut self,
        key: &str,
        origin: &Origin,
        default: impl FnOnce() -> Item,
    ) -> &mut Node {
        let index = self.entries.iter().position(|entry| entry.key == key);
        let index = index.unwrap_or_else(|| {
            let node = Node { origin: origin.clone(), item: default() };
            let key_origin = origin.clone();
            self.entries.push(Entry { key: key.to_owned(), key_origin, node });
            self.entries.len() - 1
        });
        &mut self.entries[index].node
    }
}

impl Item {
    /// The value, to be held against a key; `Err` says what it is if no key takes such a thing.
    pub fn to_value(&self) -> Result<Value, &'static str> {
        Ok(match self {
            Item::Number(number) => Value::Number(*number),
            Item::Integer(integer) => Value::Integer(*integer),
            Item::Flag(flag) => Value::Flag(*flag),
            Item::Text(text) => Value::Text(text.clone()),
            Item::List(items) => Value::List(
                items.iter().map(|node| node.item.to_value()).collect::<Result<_, _>>()?,
            ),
            Item::Date(_) => return Err("a date or a time"),
            Item::Table(_) => return Err("a table"),
        })
    }

    /// What it is, to be read after "is".
    pub fn describe(&self) -> String {
        match (self, self.to_value()) {
            (Item::List(items), _) if items.iter().any(|n| matches!(n.item, Item::Table(_))) => {
                "a list of tables".to_owned()
            }
            (_, Ok(value)) => value.to_string(),
            (_, Err(what)) => what.to_owned(),
        }
    }

    /// TOML's own value, without places.
    pub fn to_toml(&self) -> toml::Value {
        match self {
            Item::Number(number) => toml::Value::Float(*number),
            Item::Integer(integer) => toml::Value::Integer(*integer),
            Item::Flag(flag) => toml::Value::Boolean(*flag),
            Item::Text(text) | Item::Date(text) => toml::Value::String(text.clone()),
            Item::List(items) => {
                toml::Value::Array(items.iter().map(|node| node.item.to_toml()).collect())
            }
            Item::Table(table) => toml::Value::Table(table.to_toml()),
        }
    }
}

impl Table {
    /// The table as TOML's own, without places.
    pub fn to_toml(&self) -> toml::Table {
        self.entries.iter().map(|entry| (entry.key.clone(), entry.node.item.to_toml())).collect()
    }
}

/// Reads the text of a scene file.
pub(super) fn parse(name: &str, text: &str) -> Result<Table, SceneFileError> {
    let at = |span, message: String| SceneFileError::in_text(name, text, span, message);
    let document = DeTable::parse(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        // The parser says what it expected, but not which key is there twice.
        let message = match (error.message(), text.get(span.clone())) {
            ("duplicate key", Some(key)) => format!("`{key}` is given twice"),
            (message, _) => message.to_owned(),
        };
        at(span, message)
    })?;
    table(document.into_inner(), &Origin::File).map_err(|(origin, message)| match origin {
        Origin::File(span) => at(span, message),
        Origin::Override(_) => SceneFileError::whole(name, message),
    })
}

/// Reads the value of an override; what is no TOML is a bare text.
pub(super) fn parse_value(text: &str, origin: &Origin) -> Result<Node, String> {
    let everywhere = |_: Range<usize>| origin.clone();
    let value = match DeValue::parse(text) {
        Ok(value) => node(value, &everywhere).map_err(|(_, message)| message)?,
        Err(_) => Node { origin: origin.clone(), item: Item::Text(text.to_owned()) },
    };
    Ok(match value.item {
        Item::Date(_) => Node { item: Item::Text(text.to_owned()), ..value },
        _ => value,
    })
}

/// A place and what is wrong there.
type Fault = (Origin, String);

fn table(table: DeTable<'_>, origin: &dyn Fn(Range<usize>) -> Origin) -> Result<Table, Fault> {
    // The parser sorts keys by name; messages and the written scene keep the order of the file.
    let mut entries: Vec<_> = table.into_iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    let entry = |(key, value): (Spanned<_>, Spanned<_>)| {
        let key_origin = origin(key.span());
        let key: std::borrow::Cow<'_, str> = key.into_inner();
        Ok(Entry { key: key.into_owned(), key_origin, node: node(value, origin)? })
    };
    Ok(Table { entries: entries.into_iter().map(entry).collect::<Result<_, _>>()? })
}

fn node(
    value: Spanned<DeValue<'_>>,
    origin: &dyn Fn(Range<usize>) -> Origin,
) -> Result<Node, Fault> {
    let place = origin(value.span());
    let item = match value.into_inner() {
        DeValue::String(text) => Item::Text(text.into_owned()),
        DeValue::Boolean(flag) => Item::Flag(flag),
        DeValue::Datetime(date) => Item::Date(date.to_string()),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) => Item::Integer(integer),
            Err(_) => {
                let message = "whole numbers must fit into 64 bits".to_owned();
                return Err((place, message));
            }
        },
        DeValue::Float(float) => match float.as_str().parse() {
            Ok(number) => Item::Number(number),
            Err(_) => return Err((place, "this is not a number".to_owned())),
        },
        DeValue::Array(items) => {
            let items = items.into_iter().map(|item| node(item, origin));
            Item::List(items.collect::<Result<_, _>>()?)
        }
        DeValue::Table(inner) => Item::Table(table(inner, origin)?),
    };
    Ok(Node { origin: place, item })
}
