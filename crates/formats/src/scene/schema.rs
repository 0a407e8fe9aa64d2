//! The JSON Schema of the format, for editors and tests.

use std::borrow::Cow;
use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};

use super::decode::At;
use super::loose::{FromLoose, NoTable};
use super::sections::{Named, SceneFile};

/// The schema of a scene.
pub(crate) fn schema() -> serde_json::Value {
    schemars::schema_for!(SceneFile).to_value()
}

/// The schema of all ways to write an `X`.
pub(super) fn of_loose<X: FromLoose>(generator: &mut SchemaGenerator) -> Schema
where
    X::Table: JsonSchema,
{
    let plain = serde_json::from_str::<serde_json::Value>(X::SCHEMA).ok();
    let plain = plain.and_then(|plain| Schema::try_from(plain).ok());
    let table = X::Table::schema_name() != NoTable::schema_name();
    let mut schema = match (plain, table) {
        (Some(plain), false) => plain,
        (Some(plain), true) => json_schema!({ "anyOf": [plain, generator.subschema_for::<X::Table>()] }),
        (None, _) => generator.subschema_for::<X::Table>(),
    };
    schema.insert("description".to_owned(), X::EXPECTED.into());
    schema
}

impl JsonSchema for NoTable {
    fn schema_name() -> Cow<'static, str> {
        "NoTable".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        false.into()
    }
}

impl<T: JsonSchema> JsonSchema for At<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

impl<T: JsonSchema> JsonSchema for Named<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        <BTreeMap<String, T>>::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        <BTreeMap<String, T>>::json_schema(generator)
    }
}
