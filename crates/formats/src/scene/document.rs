//! A document of nested tables, lists and values, each with its place in the text: what TOML and JSON have in common.

use std::ops::Range;

/// A range of bytes of the text.
pub(super) type Span = Range<usize>;

/// A value and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    pub(super) span: Span,
    pub(super) value: Value,
}

/// What a document is made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Null,
    Bool(bool),
    Integer(i64),
    Float(f64),
    Text(String),
    List(Vec<Node>),
    /// Keys in the order of the text, no two alike.
    Table(Vec<(Key, Node)>),
}

/// A key of a table and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Key {
    pub(super) span: Span,
    pub(super) name: String,
}

/// What is wrong with a document, and where if that is known.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fault {
    pub(super) span: Option<Span>,
    pub(super) what: String,
    pub(super) hint: Option<String>,
}

/// Deepest nesting of lists and tables: more than any scene needs, less than any stack holds.
pub(super) const DEEPEST: usize = 64;

impl Fault {
    pub(super) fn new(span: Span, what: impl Into<String>) -> Self {
        Self { span: Some(span), what: what.into(), hint: None }
    }

    pub(super) fn hint(mut self, hint: Option<String>) -> Self {
        self.hint = hint;
        self
    }

    /// The fault at `span`, unless an inner place is known already.
    pub(super) fn at(mut self, span: &Span) -> Self {
        self.span.get_or_insert_with(|| span.clone());
        self
    }
}

impl Node {
    /// The value of a key, if this is a table that has it.
    pub(super) fn get(&self, name: &str) -> Option<&Self> {
        match &self.value {
            Value::Table(entries) => entries.iter().find(|(key, _)| key.name == name).map(|(_, node)| node),
            _ => None,
        }
    }
}
