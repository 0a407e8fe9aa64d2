//! From a document to Rust types by serde, with every fault at its place.
//!
//! A fault is told by whoever notices it and gets the place of the innermost value it passes on its way out.
//! Keys that a type does not know get a "did you mean". [`At`] hands the place of a value on to its user.

use std::fmt;

use serde::de::value::StrDeserializer;
use serde::de::{
    self, DeserializeSeed, Deserializer, EnumAccess, Error as _, Expected, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, VariantAccess, Visitor,
};
use serde::{Deserialize, forward_to_deserialize_any};

use super::document::{Fault, Key, Node, Span, Value};
use crate::suggest;

/// The value of the document as a `T`.
pub(super) fn decode<'de, T: Deserialize<'de>>(document: &'de Node<'_>) -> Result<T, Fault> {
    T::deserialize(document)
}

/// A value and where it stands in the text.
#[derive(Clone, Debug)]
pub(super) struct At<T> {
    pub(super) span: Span,
    pub(super) value: T,
}

/// The name by which [`At`] asks this deserialiser for the place of a value.
pub(super) const AT: &str = "$at";

/// The key that chooses the variant of an enum whose variants are tables.
const KIND: &str = "kind";

impl de::Error for Fault {
    fn custom<T: fmt::Display>(what: T) -> Self {
        Self { span: None, what: what.to_string(), hint: None }
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::custom(format_args!("expected {}, found {}", expected_name(&expected.to_string()), found_name(found)))
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn unknown_field(field: &str, known: &'static [&'static str]) -> Self {
        Self::custom(format_args!("the key \"{field}\" is not known here"))
            .hint(suggest::hint(field, known.iter().copied()))
    }

    fn unknown_variant(variant: &str, known: &'static [&'static str]) -> Self {
        Self::custom(format_args!("\"{variant}\" is not known here"))
            .hint(suggest::hint(variant, known.iter().copied()))
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        Self::custom(format_args!("expected {expected}, found {length}"))
    }

    fn missing_field(field: &'static str) -> Self {
        Self::custom(format_args!("the key \"{field}\" is missing"))
    }
}

impl std::error::Error for Fault {}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)
    }
}

/// What was expected, in the words of scenes.
fn expected_name(expected: &str) -> &str {
    match expected {
        "f64" => "a number",
        "a boolean" => "true or false",
        "a string" => "a text in quotes",
        "a sequence" => "a list",
        table if table.starts_with("struct ") => "a table",
        other => other,
    }
}

/// What was found, in the words of scenes.
fn found_name(found: Unexpected<'_>) -> String {
    match found {
        Unexpected::Bool(value) => value.to_string(),
        Unexpected::Signed(number) => number.to_string(),
        Unexpected::Unsigned(number) => number.to_string(),
        Unexpected::Float(number) => number.to_string(),
        Unexpected::Str(text) => crate::error::quoted(text),
        Unexpected::Seq => "a list".to_owned(),
        Unexpected::Map => "a table".to_owned(),
        Unexpected::Unit => "nothing".to_owned(),
        other => other.to_string(),
    }
}

impl<'de> Deserializer<'de> for &'de Node<'_> {
    type Error = Fault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        let value = match &self.value {
            Value::Null => visitor.visit_unit(),
            Value::Bool(value) => visitor.visit_bool(*value),
            Value::Integer(number) => visitor.visit_i64(*number),
            Value::Float(number) => visitor.visit_f64(*number),
            Value::Text(text) => visitor.visit_borrowed_str(text),
            Value::List(items) => visit_list(items, visitor),
            Value::Table(entries) => visitor.visit_map(Entries::all(entries)),
        };
        value.map_err(|fault| fault.at(&self.span))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        if self.value == Value::Null { visitor.visit_none() } else { visitor.visit_some(self) }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Fault> {
        visitor.visit_newtype_struct(self).map_err(|fault| fault.at(&self.span))
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Fault> {
        match name {
            AT => visitor.visit_seq(Placed::new(&self.span, self)),
            _ => self.deserialize_any(visitor),
        }
    }

    /// A word, or a table whose `kind` is the word.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        let chosen = match &self.value {
            Value::Text(word) => Chosen { word, span: &self.span, entries: None },
            Value::Table(entries) => {
                let kind = self.get(KIND).ok_or_else(|| Fault::missing_field(KIND).at(&self.span))?;
                let Value::Text(word) = &kind.value else {
                    return Err(Fault::new(kind.span.clone(), "the kind must be a word in quotes"));
                };
                Chosen { word, span: &kind.span, entries: Some(entries) }
            }
            _ => return Err(Fault::new(self.span.clone(), "expected a word in quotes")),
        };
        visitor.visit_enum(chosen).map_err(|fault| fault.at(&self.span))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        map struct identifier ignored_any
    }
}

/// Visit all items of a list: a visitor that wants fewer would leave the rest unseen.
fn visit_list<'de, V: Visitor<'de>>(items: &'de [Node<'_>], visitor: V) -> Result<V::Value, Fault> {
    let mut rest = Items(items.iter());
    let value = visitor.visit_seq(&mut rest)?;
    let unseen = rest.0.len();
    if unseen > 0 {
        let what = format!("expected a list of {} values, found {}", items.len() - unseen, items.len());
        return Err(Fault::custom(what));
    }
    Ok(value)
}

/// The items of a list.
struct Items<'de, 't>(std::slice::Iter<'de, Node<'t>>);

impl<'de> SeqAccess<'de> for &mut Items<'de, '_> {
    type Error = Fault;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Fault> {
        self.0.next().map(|node| seed.deserialize(node)).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// The entries of a table, but for one key.
struct Entries<'de, 't> {
    rest: std::slice::Iter<'de, (Key<'t>, Node<'t>)>,
    without: Option<&'static str>,
    value: Option<&'de Node<'t>>,
}

impl<'de, 't> Entries<'de, 't> {
    fn all(entries: &'de [(Key<'t>, Node<'t>)]) -> Self {
        Self { rest: entries.iter(), without: None, value: None }
    }
}

impl<'de> MapAccess<'de> for Entries<'de, '_> {
    type Error = Fault;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Fault> {
        let without = self.without;
        let Some((key, value)) = self.rest.find(|(key, _)| Some(&*key.name) != without) else {
            return Ok(None);
        };
        self.value = Some(value);
        seed.deserialize(key).map(Some).map_err(|fault| fault.at(&key.span))
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, Fault> {
        let value = self.value.take().ok_or_else(|| Fault::custom("a value without a key"))?;
        seed.deserialize(value).map_err(|fault| fault.at(&value.span))
    }
}

impl<'de> Deserializer<'de> for &'de Key<'_> {
    type Error = Fault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        visitor.visit_borrowed_str(&self.name)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Fault> {
        visitor.visit_seq(Placed::new(&self.span, self))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple map struct enum identifier ignored_any
    }
}

/// The variant of an enum: its name, and the table it was found in, if it is one.
struct Chosen<'de, 't> {
    word: &'de str,
    span: &'de Span,
    entries: Option<&'de [(Key<'t>, Node<'t>)]>,
}

impl<'de> EnumAccess<'de> for Chosen<'de, '_> {
    type Error = Fault;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Fault> {
        let word: StrDeserializer<'_, Fault> = self.word.into_deserializer();
        let variant = seed.deserialize(word).map_err(|fault| fault.at(self.span))?;
        Ok((variant, self))
    }
}

impl<'de> VariantAccess<'de> for Chosen<'de, '_> {
    type Error = Fault;

    fn unit_variant(self) -> Result<(), Fault> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Fault> {
        let entries = self.entries.unwrap_or_default();
        let entries = Entries { without: Some(KIND), ..Entries::all(entries) };
        seed.deserialize(de::value::MapAccessDeserializer::new(entries))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Fault> {
        Err(Fault::custom("a scene has no tuples"))
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Fault> {
        let entries = self.entries.unwrap_or_default();
        visitor.visit_map(Entries { without: Some(KIND), ..Entries::all(entries) })
    }
}

/// Start, end and value of what [`At`] asked for.
pub(super) struct Placed<'s, D> {
    span: &'s Span,
    value: Option<D>,
    given: usize,
}

impl<'s, D> Placed<'s, D> {
    pub(super) fn new(span: &'s Span, value: D) -> Self {
        Self { span, value: Some(value), given: 0 }
    }
}

impl<'de, D: Deserializer<'de>> SeqAccess<'de> for Placed<'_, D> {
    type Error = D::Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, D::Error> {
        self.given += 1;
        match self.given {
            1 => seed.deserialize(self.span.start.into_deserializer()).map(Some),
            2 => seed.deserialize(self.span.end.into_deserializer()).map(Some),
            _ => self.value.take().map(|value| seed.deserialize(value)).transpose(),
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AtVisitor<T>(std::marker::PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for AtVisitor<T> {
            type Value = At<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a value with its place")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<At<T>, A::Error> {
                let missing = || A::Error::custom("a value without a place");
                let start = parts.next_element()?.ok_or_else(missing)?;
                let end = parts.next_element()?.ok_or_else(missing)?;
                let value = parts.next_element()?.ok_or_else(missing)?;
                Ok(At { span: start..end, value })
            }
        }
        deserializer.deserialize_tuple_struct(AT, 3, AtVisitor(std::marker::PhantomData))
    }
}
