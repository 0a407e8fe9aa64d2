//! The native scene format, version 1, as TOML and as JSON: `docs/scene-format.md`.
//!
//! A text becomes a [`document`] in which every value knows its place; the document becomes [`sections`] by serde, and
//! the sections a scene. Each step tells its faults at their place. Texts without faults take a [`quick`] way.

mod build;
mod color;
mod decode;
mod document;
mod json;
mod loose;
mod quick;
#[cfg(feature = "schema")]
mod schema;
mod sections;
mod toml;
mod values;
mod write;

#[cfg(feature = "schema")]
pub(crate) use schema::schema;

pub use write::{camera_block, write_back};

use whitted::scene::Scene;

use crate::error::Error;
use crate::files::Context;
use crate::source::{Source, utf8};
use document::{Fault, Node};
use sections::SceneFile;

/// Read a scene written in TOML.
pub(crate) fn read_toml(source: Source<'_>, context: &mut Context<'_>) -> Result<Scene, Error> {
    build::build(&decode(&source, &TOML)?, source, context)
}

/// Read a scene written in JSON.
pub(crate) fn read_json(source: Source<'_>, context: &mut Context<'_>) -> Result<Scene, Error> {
    build::build(&decode(&source, &JSON)?, source, context)
}

/// What a scene written in TOML says about cameras, lights, materials and the picture; nothing that it names is opened.
fn look_of(source: Source<'_>) -> Result<Scene, Error> {
    build::look(&decode(&source, &TOML)?, source)
}

/// A language that scenes are written in.
struct Language {
    /// The quick way, which answers as the other one or not at all.
    quick: fn(&str) -> Option<SceneFile>,
    /// The way that knows all of the language and all that can be wrong.
    parse: fn(&str) -> Result<Node<'_>, Fault>,
}

const TOML: Language = Language { quick: quick::toml::read, parse: toml::parse };
const JSON: Language = Language { quick: quick::json::read, parse: json::parse };

fn decode(source: &Source<'_>, language: &Language) -> Result<SceneFile, Error> {
    let text = utf8(source)?;
    if let Some(file) = (language.quick)(text) {
        return Ok(file);
    }
    let document = (language.parse)(text).map_err(|fault| error(source, fault))?;
    if document.get("version").is_none() {
        return Err(source.error_whole("the key \"version\" is missing").hint("a scene begins with version = 1"));
    }
    sections_of(document).map_err(|fault| error(source, fault))
}

fn sections_of(mut document: Node<'_>) -> Result<SceneFile, Fault> {
    sections::name_cameras(&mut document);
    decode::decode(&document)
}

/// The error about a fault of the text `source`.
fn error(source: &Source<'_>, fault: Fault) -> Error {
    let error = match fault.span {
        // The place of the document as a whole.
        None | Some(document::Span { start: 0, end: 0 }) => source.error_whole(fault.what),
        Some(span) => source.error(span, fault.what),
    };
    match fault.hint {
        Some(hint) => error.hint(hint),
        None => error,
    }
}
