//! TOML as sections, by a reader of what scenes consist of.
//!
//! Each table of a list becomes a section as soon as it has been read, and the next one takes its memory, so that there is
//! never more than one of them.
//!
//! Unusual, and left to the oracle, are keys with escapes or of more than two parts, and tables that are opened again after
//! others.

use super::cursor::{Cursor, Header};
use super::growing::{Growing, all_differ};
use super::sections_of;
use crate::scene::document::{Key, Node, Span, Value};
use crate::scene::sections::{Lists, SceneFile};

/// What the scene `text` says; none if something is wrong with it, or not understood here.
pub(in crate::scene) fn read(text: &str) -> Option<SceneFile> {
    let mut document = Document::begin(text);
    while let Some(byte) = document.cursor.skip_gaps()? {
        match byte {
            b'[' => document.header()?,
            _ => document.entry()?,
        }
    }
    document.end()
}

/// A text that is read as far as its cursor is.
#[derive(Debug)]
struct Document<'t> {
    cursor: Cursor<'t>,
    lists: Lists,
    root: Growing<'t>,
    /// How many entries of the root stand above the first header: no header can add to them. None as long as there is no
    /// header.
    closed: Option<usize>,
    /// The table that entries go to, last, after those that it lies in. Empty if they go to the root.
    open: Vec<Open<'t>>,
    /// The memory of an item that has become a section.
    spare: Growing<'t>,
}

/// A table to which the next line may add.
#[derive(Debug)]
struct Open<'t> {
    key: Key<'t>,
    span: Span,
    form: Form,
    entries: Growing<'t>,
}

/// How a table came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// By `[name]`.
    Stated,
    /// By `[[name]]`.
    Item,
    /// By `[name.other]`.
    Implied,
}

/// More keys than the root of any scene has. They are looked through at each header.
const MOST_ROOT_KEYS: usize = 32;

impl<'t> Document<'t> {
    fn begin(text: &'t str) -> Self {
        Self {
            cursor: Cursor::new(text),
            lists: Lists::default(),
            root: Growing::default(),
            closed: None,
            open: Vec::new(),
            spare: Growing::default(),
        }
    }

    /// `key = value` and the end of the line.
    fn entry(&mut self) -> Option<()> {
        let table = self.open.last_mut().map_or(&mut self.root, |open| &mut open.entries);
        self.cursor.entry(table, 0)?;
        self.cursor.end_line()
    }

    /// `[name]` or `[[name]]` and the end of the line.
    fn header(&mut self) -> Option<()> {
        let header = self.cursor.header()?;
        self.cursor.end_line()?;
        let above = self.root.entries().len();
        if above > MOST_ROOT_KEYS {
            return None;
        }
        self.closed.get_or_insert(above);
        match (header.is_item, header.more.is_empty()) {
            (true, true) => self.item(header.first, header.span),
            (true, false) => None,
            (false, _) => self.table(header),
        }
    }

    fn item(&mut self, key: Key<'t>, span: Span) -> Option<()> {
        self.close_to(0)?;
        if self.root.find(&key.name).is_some() {
            return None;
        }
        self.push(key, span, Form::Item);
        Some(())
    }

    fn table(&mut self, header: Header<'t>) -> Option<()> {
        let mut keys: Vec<_> = std::iter::once(header.first).chain(header.more).collect();
        let own = keys.pop()?;
        let kept = keys.iter().zip(&self.open).take_while(|(key, open)| key.name == open.key.name).count();
        self.close_to(kept)?;
        match keys.len() - kept {
            0 => {}
            1 if kept == 0 => {
                let parent = keys.pop()?;
                let span = parent.span.clone();
                self.push(parent, span, Form::Implied);
            }
            _ => return None,
        }
        self.push(own, header.span, Form::Stated);
        Some(())
    }

    fn push(&mut self, key: Key<'t>, span: Span, form: Form) {
        let entries = std::mem::take(&mut self.spare);
        self.open.push(Open { key, span, form, entries });
    }

    /// End tables until `count` of them are open.
    fn close_to(&mut self, count: usize) -> Option<()> {
        while self.open.len() > count {
            let Open { key, span, form, entries } = self.open.pop()?;
            let node = Node { span, value: Value::Table(entries.finish()?) };
            match (self.open.last_mut(), form) {
                (Some(parent), _) => parent.entries.add(key, node)?,
                (None, Form::Item) => {
                    self.lists.push(&key.name, &node)?;
                    self.spare = Growing::reuse(node);
                }
                (None, form) => self.attach(key, node, form)?,
            }
        }
        Some(())
    }

    /// Put a table into the root, where an earlier part of it may be.
    fn attach(&mut self, key: Key<'t>, node: Node<'t>, form: Form) -> Option<()> {
        match self.root.find(&key.name) {
            None => self.root.add(key, node),
            Some(at) if form == Form::Implied && self.closed.is_some_and(|closed| at >= closed) => {
                self.root.extend(at, node)
            }
            Some(_) => None,
        }
    }

    fn end(mut self) -> Option<SceneFile> {
        self.close_to(0)?;
        let root = self.root.finish()?;
        for (_, table) in root.iter().skip(self.closed.unwrap_or(root.len())) {
            // Its parts were looked at one by one.
            all_differ(table.entries()?)?;
        }
        sections_of(root, self.lists)
    }
}
