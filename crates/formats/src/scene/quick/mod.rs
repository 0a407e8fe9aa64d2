//! Scenes as sections, several times as fast as by way of a [`document`](super::document) of the whole text.
//!
//! A large scene is large by its lists: a hundred thousand spheres. Each of their items becomes a section as soon as it has
//! been read; only what is no list (materials, cameras, settings) is kept until the end, as a document.
//!
//! These are fast paths beside [`toml`](super::toml) and [`json`](super::json), which are their oracles (`tests/`): they
//! answer as those do, or not at all. Whatever is wrong with a text, or merely unusual, is left to the oracles, which know
//! all of the languages and all messages.

mod cursor;
mod growing;
pub(super) mod json;
#[cfg(test)]
mod tests;
pub(super) mod toml;

use super::document::{Key, Node, Value};
use super::sections::{Lists, SceneFile};

/// The scene of the entries of a text, no two of them alike, and of those items of lists that are sections already.
fn sections_of(mut entries: Vec<(Key<'_>, Node<'_>)>, mut lists: Lists) -> Option<SceneFile> {
    for (key, list) in entries.extract_if(.., |(_, node)| matches!(node.value, Value::List(_))) {
        let Value::List(items) = &list.value else { return None };
        if !Lists::has(&key.name) {
            return None;
        }
        items.iter().try_for_each(|item| lists.push(&key.name, item))?;
    }
    let rest = Node { span: 0..0, value: Value::Table(entries) };
    let mut file = super::sections_of(rest).ok()?;
    lists.move_to(&mut file);
    Some(file)
}
