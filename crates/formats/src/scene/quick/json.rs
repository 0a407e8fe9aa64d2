//! JSON as sections, by the crate that reads it for the oracle.
//!
//! The oracle makes a document of all there is, and scans each level of nesting once more than the level above, since the
//! crate tells places by giving the texts of values. Here items of lists go from the crate to their sections with nothing
//! in between, and only values whose place is asked for ([`At`](crate::scene::decode::At)), and whose kind is not known
//! before, are scanned twice.
//!
//! Unusual, and left to the oracle, are keys of the scene with escapes.

use std::borrow::Cow;
use std::fmt;

use serde::de::value::BorrowedStrDeserializer;
use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde::forward_to_deserialize_any;
use serde_json::value::RawValue;

use super::growing::all_differ;
use super::sections_of;
use crate::scene::decode::{AT, Placed};
use crate::scene::document::{Key, Node, Value};
use crate::scene::json::{convert, number, span_of};
use crate::scene::sections::{Lists, SceneFile};

/// The list whose sections are told apart by a key that may come last: they need all of their table at once.
const OF_KINDS: &str = "generate";

/// What the scene `text` says; none if something is wrong with it, or not understood here.
pub(in crate::scene) fn read(text: &str) -> Option<SceneFile> {
    let mut json = serde_json::Deserializer::from_str(text);
    let mut lists = Lists::default();
    let entries = json.deserialize_map(Root { text, lists: &mut lists }).ok()?;
    json.end().ok()?;
    all_differ(&entries)?;
    sections_of(entries, lists)
}

/// Puts items of lists into `lists`, and gives everything else; lists that were put there are empty.
struct Root<'de, 'l> {
    text: &'de str,
    lists: &'l mut Lists,
}

impl<'de> Visitor<'de> for Root<'de, '_> {
    type Value = Vec<(Key<'de>, Node<'de>)>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a scene")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let Root { text, lists } = self;
        let mut entries = Vec::new();
        while let Some(name) = map.next_key::<&str>()? {
            let node = if Lists::has(name) && name != OF_KINDS {
                map.next_value_seed(Items { text, name, lists })?;
                Node { span: 0..0, value: Value::List(Vec::new()) }
            } else {
                convert(text, map.next_value()?, 1).map_err(A::Error::custom)?
            };
            entries.push((Key { span: span_of(text, name), name: Cow::Borrowed(name) }, node));
        }
        Ok(entries)
    }
}

/// Puts the items of the list `name` into `lists`; one of them, or all.
struct Items<'de, 'l> {
    text: &'de str,
    name: &'de str,
    lists: &'l mut Lists,
}

impl<'de> DeserializeSeed<'de> for Items<'de, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, list: D) -> Result<(), D::Error> {
        list.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Items<'de, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<(), A::Error> {
        let Items { text, name, lists } = self;
        while items.next_element_seed(Item(Items { text, name, lists }))?.is_some() {}
        Ok(())
    }
}

/// Puts one item into its list.
struct Item<'de, 'l>(Items<'de, 'l>);

impl<'de> DeserializeSeed<'de> for Item<'de, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, item: D) -> Result<(), D::Error> {
        let Items { text, name, lists } = self.0;
        lists.push(name, Placing { text, inner: item }).ok_or_else(|| D::Error::custom("not an item of this list"))
    }
}

/// A part of serde's protocol that gives places in `text` to who asks for them, and otherwise what `inner` gives; numbers are
/// those of the oracle.
struct Placing<'de, I> {
    text: &'de str,
    inner: I,
}

impl<'de, D: Deserializer<'de>> Deserializer<'de> for Placing<'de, D> {
    type Error = D::Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        let text = self.text;
        let raw = <&RawValue>::deserialize(self.inner)?;
        let value = match raw.get().as_bytes().first() {
            Some(b'-' | b'0'..=b'9') => match number(raw.get()) {
                Some(Value::Integer(number)) => return visitor.visit_i64(number),
                Some(Value::Float(number)) => return visitor.visit_f64(number),
                _ => return Err(D::Error::custom("not a number")),
            },
            _ => raw.deserialize_any(Placing { text, inner: visitor }),
        };
        value.map_err(D::Error::custom)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.inner.deserialize_option(Placing { text: self.text, inner: visitor })
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, D::Error> {
        self.inner.deserialize_struct(name, fields, Placing { text: self.text, inner: visitor })
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.inner.deserialize_string(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, D::Error> {
        if name != AT {
            return self.deserialize_any(visitor);
        }
        let text = self.text;
        let raw = <&RawValue>::deserialize(self.inner)?;
        let span = span_of(text, raw.get());
        visitor.visit_seq(Placed::new(&span, Placing { text, inner: raw })).map_err(D::Error::custom)
    }

    /// A word; the oracle's tables of kinds are not known here.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, D::Error> {
        visitor.visit_enum(BorrowedStrDeserializer::new(<&str>::deserialize(self.inner)?))
    }

    /// Nobody would see that a name is there twice.
    fn deserialize_map<V: Visitor<'de>>(self, _: V) -> Result<V::Value, D::Error> {
        Err(D::Error::custom("tables of names are no part of an item"))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str bytes byte_buf unit unit_struct newtype_struct seq
        tuple identifier ignored_any
    }
}

impl<'de, V: Visitor<'de>> Visitor<'de> for Placing<'de, V> {
    type Value = V::Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.inner.expecting(f)
    }

    fn visit_bool<E: serde::de::Error>(self, value: bool) -> Result<V::Value, E> {
        self.inner.visit_bool(value)
    }

    fn visit_unit<E: serde::de::Error>(self) -> Result<V::Value, E> {
        self.inner.visit_unit()
    }

    fn visit_none<E: serde::de::Error>(self) -> Result<V::Value, E> {
        self.inner.visit_none()
    }

    fn visit_some<D: Deserializer<'de>>(self, value: D) -> Result<V::Value, D::Error> {
        self.inner.visit_some(Placing { text: self.text, inner: value })
    }

    fn visit_borrowed_str<E: serde::de::Error>(self, value: &'de str) -> Result<V::Value, E> {
        self.inner.visit_borrowed_str(value)
    }

    fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<V::Value, E> {
        self.inner.visit_str(value)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, items: A) -> Result<V::Value, A::Error> {
        self.inner.visit_seq(Placing { text: self.text, inner: items })
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<V::Value, A::Error> {
        self.inner.visit_map(Placing { text: self.text, inner: entries })
    }
}

impl<'de, A: SeqAccess<'de>> SeqAccess<'de> for Placing<'de, A> {
    type Error = A::Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, A::Error> {
        self.inner.next_element_seed(Placing { text: self.text, inner: seed })
    }
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for Placing<'de, A> {
    type Error = A::Error;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, A::Error> {
        self.inner.next_key_seed(seed)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, A::Error> {
        self.inner.next_value_seed(Placing { text: self.text, inner: seed })
    }
}

impl<'de, S: DeserializeSeed<'de>> DeserializeSeed<'de> for Placing<'de, S> {
    type Value = S::Value;

    fn deserialize<D: Deserializer<'de>>(self, value: D) -> Result<S::Value, D::Error> {
        self.inner.deserialize(Placing { text: self.text, inner: value })
    }
}
