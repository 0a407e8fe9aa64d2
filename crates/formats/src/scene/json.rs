//! JSON as a document.
//!
//! The parser gives no places, but it gives the text of each value: where that lies in the whole text is its place.
//! Each level of nesting is scanned once more than the level above; a scene has five.

use std::borrow::Cow;
use std::collections::HashSet;
use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;

use super::document::{DEEPEST, Fault, Key, Node, Span, Value};

/// Parse a text.
pub(super) fn parse(text: &str) -> Result<Node<'_>, Fault> {
    let raw: &RawValue =
        serde_json::from_str(text).map_err(|e| Fault { span: Some(place(text, &e)), what: message(&e), hint: None })?;
    convert(text, raw, 0)
}

/// The value `raw`, a part of `text`, which lies in `depth` others.
pub(super) fn convert<'t>(text: &'t str, raw: &'t RawValue, depth: usize) -> Result<Node<'t>, Fault> {
    let raw = raw.get();
    let span = span_of(text, raw);
    if depth > DEEPEST {
        return Err(Fault::new(span, format!("lists and tables are nested deeper than {DEEPEST}")));
    }
    let fault = |e: serde_json::Error| {
        let inner = place(raw, &e);
        Fault::new(span.start + inner.start..span.start + inner.end, message(&e))
    };
    let value = match raw.as_bytes().first() {
        Some(b'n') => Value::Null,
        Some(b't' | b'f') => Value::Bool(raw == "true"),
        Some(b'"') => Value::Text(serde_json::from_str(raw).map_err(fault)?),
        Some(b'[') => {
            let items: Vec<&RawValue> = serde_json::from_str(raw).map_err(fault)?;
            Value::List(items.into_iter().map(|item| convert(text, item, depth + 1)).collect::<Result<_, _>>()?)
        }
        Some(b'{') => {
            let Entries(entries) = serde_json::from_str(raw).map_err(fault)?;
            convert_entries(text, entries, depth)?
        }
        _ => number(raw).ok_or_else(|| Fault::new(span.clone(), "this is not a number"))?,
    };
    Ok(Node { span, value })
}

/// The value of a number.
pub(super) fn number(raw: &str) -> Option<Value<'static>> {
    raw.parse().map(Value::Integer).or_else(|_| raw.parse().map(Value::Float)).ok()
}

fn convert_entries<'t>(
    text: &'t str,
    entries: Vec<(Name<'t>, &'t RawValue)>,
    depth: usize,
) -> Result<Value<'t>, Fault> {
    let mut seen = HashSet::new();
    let mut table = Vec::with_capacity(entries.len());
    for (Name(name), raw) in entries {
        let node = convert(text, raw, depth + 1)?;
        // A name with escapes is not a part of the text: its value stands for it.
        let span = if let Cow::Borrowed(name) = name { span_of(text, name) } else { node.span.clone() };
        if !seen.insert(name.clone()) {
            return Err(Fault::new(span, format!("the key \"{name}\" is given twice")));
        }
        table.push((Key { span, name }, node));
    }
    Ok(Value::Table(table))
}

/// Where `part` lies in `text`, of which it must be a part.
pub(super) fn span_of(text: &str, part: &str) -> Span {
    let start = (part.as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
    start..start + part.len()
}

/// Where the parser stopped.
fn place(text: &str, error: &serde_json::Error) -> Span {
    let line: usize = text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
    let at = (line + error.column().saturating_sub(1)).min(text.len());
    at..at + 1
}

/// What the parser says, without the place.
fn message(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.rsplit_once(" at line ").map_or(text.as_str(), |(what, _)| what).to_owned()
}

/// The entries of a table in order, twins included.
struct Entries<'a>(Vec<(Name<'a>, &'a RawValue)>);

/// A key, borrowed from the text unless it contains escapes.
struct Name<'a>(Cow<'a, str>);

impl<'de> Deserialize<'de> for Entries<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EntriesVisitor;
        impl<'de> Visitor<'de> for EntriesVisitor {
            type Value = Entries<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(EntriesVisitor)
    }
}

impl<'de> Deserialize<'de> for Name<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameVisitor;
        impl<'de> Visitor<'de> for NameVisitor {
            type Value = Name<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a key")
            }

            fn visit_borrowed_str<E>(self, name: &'de str) -> Result<Self::Value, E> {
                Ok(Name(Cow::Borrowed(name)))
            }

            fn visit_str<E>(self, name: &str) -> Result<Self::Value, E> {
                Ok(Name(Cow::Owned(name.to_owned())))
            }
        }
        deserializer.deserialize_str(NameVisitor)
    }
}
