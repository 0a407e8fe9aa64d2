//! A document of nested tables, lists and values, each with its place in the text: what TOML and JSON have in common.

use std::borrow::Cow;
use std::ops::Range;

/// A range of bytes of the text.
pub(super) type Span = Range<usize>;

/// A value of the text `'t` and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node<'t> {
    pub(super) span: Span,
    pub(super) value: Value<'t>,
}

/// What a document is made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value<'t> {
    Null,
    Bool(bool),
    Integer(i64),
    Float(f64),
    Text(Cow<'t, str>),
    List(Vec<Node<'t>>),
    /// Keys in the order of the text, no two alike.
    Table(Vec<(Key<'t>, Node<'t>)>),
}

/// A key of a table and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Key<'t> {
    pub(super) span: Span,
    pub(super) name: Cow<'t, str>,
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

impl<'t> Node<'t> {
    /// The entries, if this is a table.
    pub(super) fn entries(&self) -> Option<&[(Key<'t>, Self)]> {
        match &self.value {
            Value::Table(entries) => Some(entries),
            _ => None,
        }
    }

    /// As [`entries`](Self::entries), to be changed.
    pub(super) fn entries_mut(&mut self) -> Option<&mut Vec<(Key<'t>, Self)>> {
        match &mut self.value {
            Value::Table(entries) => Some(entries),
            _ => None,
        }
    }

    /// The value of a key, if this is a table that has it.
    pub(super) fn get(&self, name: &str) -> Option<&Self> {
        self.entries()?.iter().find(|(key, _)| key.name == name).map(|(_, node)| node)
    }
}
