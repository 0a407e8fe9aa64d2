//! A table that entries are added to.

use std::collections::HashSet;

use crate::scene::document::{Key, Node, Value};

/// The entries of a table, as far as they are known.
#[derive(Debug, Default)]
pub(super) struct Growing<'t> {
    entries: Vec<(Key<'t>, Node<'t>)>,
    /// The last entry is a table that was begun by a key of two parts, and may be added to by another one.
    is_dotted: bool,
}

impl<'t> Growing<'t> {
    /// An empty table in the memory of one that is not needed any more.
    pub(super) fn reuse(node: Node<'t>) -> Self {
        let Value::Table(mut entries) = node.value else { return Self::default() };
        entries.clear();
        Self { entries, is_dotted: false }
    }

    pub(super) fn entries(&self) -> &[(Key<'t>, Node<'t>)] {
        &self.entries
    }

    /// Where the entry of this name is.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.entries.iter().position(|(key, _)| key.name == name)
    }

    /// Add an entry.
    pub(super) fn add(&mut self, key: Key<'t>, node: Node<'t>) -> Option<()> {
        self.settle()?;
        self.entries.push((key, node));
        Some(())
    }

    /// Add an entry to a table that is known by keys of two parts only.
    pub(super) fn add_dotted(&mut self, first: Key<'t>, second: Key<'t>, node: Node<'t>) -> Option<()> {
        match self.entries.last_mut() {
            Some((key, table)) if self.is_dotted && key.name == first.name => {
                table.entries_mut()?.push((second, node));
            }
            _ => {
                let table = Node { span: first.span.clone(), value: Value::Table(vec![(second, node)]) };
                self.add(first, table)?;
                self.is_dotted = true;
            }
        }
        Some(())
    }

    /// Add the entries of the table `more` to the table that is entry `at`.
    pub(super) fn extend(&mut self, at: usize, more: Node<'t>) -> Option<()> {
        let (_, table) = self.entries.get_mut(at)?;
        let Value::Table(more) = more.value else { return None };
        table.entries_mut()?.extend(more);
        Some(())
    }

    /// End the table that keys of two parts were adding to.
    fn settle(&mut self) -> Option<()> {
        if !std::mem::take(&mut self.is_dotted) {
            return Some(());
        }
        let (_, table) = self.entries.last()?;
        all_differ(table.entries()?)
    }

    /// All entries; none if two have the same name.
    pub(super) fn finish(mut self) -> Option<Vec<(Key<'t>, Node<'t>)>> {
        self.settle()?;
        all_differ(&self.entries)?;
        Some(self.entries)
    }
}

/// None if two entries have the same name.
pub(super) fn all_differ(entries: &[(Key<'_>, Node<'_>)]) -> Option<()> {
    /// So many names are compared with each other faster than they are hashed.
    const FEW: usize = 8;
    let differ = if entries.len() <= FEW {
        let is_new = |(at, (key, _)): (usize, &(Key<'_>, _))| entries[..at].iter().all(|(old, _)| old.name != key.name);
        entries.iter().enumerate().all(is_new)
    } else {
        let mut names = HashSet::with_capacity(entries.len());
        entries.iter().all(|(key, _)| names.insert(&*key.name))
    };
    differ.then_some(())
}
