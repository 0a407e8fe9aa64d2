//! The viewer: looks around in a scene that is ray traced as it moves, and follows its file.
//!
//! # What this crate knows
//! Cameras that move, pictures that are good enough in time and get better at rest, a window, and what lies over the
//! picture. [`Session`] is all of it but the window: it can be driven without a display, by tests and scripts. The window
//! and the panels are behind the feature `window`, which brings everything heavy.
//!
//! | thread | does |
//! | --- | --- |
//! | window | takes in what the person does, shows the picture, draws panels over it; waits for nobody |
//! | painter | drafts while things move, then the whole picture, with all threads of a pool |
//! | opener | reads the scene, builds its tree, watches its files |
//! | errands | saves pictures, renders recorded frames |
//!
//! # Invariants
//! * The finished picture is, to the byte, the one that `whitted render` gives with the same settings.
//! * The thread of the window never waits for rendering, reading or writing.
//! * At rest, and while the window cannot be seen, nothing runs but the watch over the scene's files.
//! * It opens no file but to look at its time stamp: its [`Host`] reads and writes.

#![forbid(unsafe_code)]

mod action;
#[cfg(feature = "window")]
mod app;
mod camera;
mod enlarge;
mod errands;
mod host;
mod input;
#[cfg(feature = "window")]
mod mapped;
mod opener;
mod options;
#[cfg(feature = "window")]
mod overlay;
mod painter;
mod pick;
mod quality;
mod screen;
#[cfg(feature = "window")]
pub mod script;
mod session;
#[cfg(feature = "window")]
mod sight;
#[cfg(feature = "window")]
mod window;

pub use action::{Action, GESTURES, KEYS, Side};
pub use host::{Host, Opened, Shot};
pub use input::{Button, Input, Key, Modifiers};
pub use opener::Activity;
pub use options::Options;
pub use quality::Draft;
pub use screen::{Finished, Picture, Stage};
pub use session::{Destination, Effect, Inspection, Note, Session, Shown};
#[cfg(feature = "window")]
pub use window::{WindowError, run};
