//! Values that may be written in several ways: a number, a word, three numbers or a table.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};

/// A value in one of the ways in which scenes write values.
#[derive(Debug)]
pub(super) enum Loose<T> {
    Number(f64),
    Word(String),
    Triple([f64; 3]),
    Table(T),
}

/// A type that is read from a [`Loose`] value.
pub(super) trait FromLoose: Sized {
    /// What is expected, for errors.
    const EXPECTED: &'static str;
    /// The JSON schema of the ways to write it, tables apart; empty if it must be a table.
    #[cfg_attr(not(feature = "schema"), allow(dead_code, reason = "only the schema reads it; schemas name each other"))]
    const SCHEMA: &'static str;
    /// The table that is one of the ways, or [`NoTable`].
    type Table;

    /// The value; an error is a sentence, or empty for "expected …".
    fn from_loose(loose: Loose<Self::Table>) -> Result<Self, String>;
}

/// No table will do.
#[derive(Debug)]
pub(super) enum NoTable {}

impl<'de> Deserialize<'de> for NoTable {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(D::Error::custom(""))
    }
}

/// Read a [`FromLoose`] type.
pub(super) fn deserialize<'de, X, D>(deserializer: D) -> Result<X, D::Error>
where
    X: FromLoose,
    X::Table: Deserialize<'de>,
    D: Deserializer<'de>,
{
    let loose = deserializer.deserialize_any(LooseVisitor::<X>(PhantomData))?;
    X::from_loose(loose).map_err(|what| match what.is_empty() {
        true => D::Error::custom(format_args!("expected {}", X::EXPECTED)),
        false => D::Error::custom(what),
    })
}

struct LooseVisitor<X>(PhantomData<X>);

impl<'de, X: FromLoose> Visitor<'de> for LooseVisitor<X>
where
    X::Table: Deserialize<'de>,
{
    type Value = Loose<X::Table>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(X::EXPECTED)
    }

    fn visit_i64<E>(self, number: i64) -> Result<Self::Value, E> {
        Ok(Loose::Number(number as f64))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Self::Value, E> {
        Ok(Loose::Number(number))
    }

    fn visit_str<E>(self, word: &str) -> Result<Self::Value, E> {
        Ok(Loose::Word(word.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Self::Value, A::Error> {
        let wrong = || A::Error::custom(format_args!("expected {}", X::EXPECTED));
        let mut triple = [0.0; 3];
        for number in &mut triple {
            *number = items.next_element()?.ok_or_else(wrong)?;
        }
        match items.next_element::<f64>()? {
            None => Ok(Loose::Triple(triple)),
            Some(_) => Err(wrong()),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
        Ok(Loose::Table(X::Table::deserialize(MapAccessDeserializer::new(map))?))
    }
}

/// Read the types by [`deserialize`], and give them the schema that they state.
macro_rules! read_loosely {
    ($($name:ident),* $(,)?) => {$(
        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $crate::scene::loose::deserialize(deserializer)
            }
        }

        #[cfg(feature = "schema")]
        impl schemars::JsonSchema for $name {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                $crate::scene::schema::of_loose::<$name>(generator)
            }
        }
    )*};
}
pub(super) use read_loosely;
