//! The command `whitted`: renders scenes, explains pixels, checks scenes, traces rays for other programs, and repeats the
//! experiments of the paper that it follows.
//!
//! It knows arguments, files' final names, progress and reports. What a scene means is `formats`' to say, and how a
//! picture is computed the library's.
//!
//! # Invariants
//! * A picture, or a table of hits, is under its final name only when it is whole.
//! * What could be known to fail before rendering fails before rendering.
//! * Standard output carries only what was asked for (a picture, hits, statistics); everything else goes to standard error.

#![forbid(unsafe_code)]

mod args;
mod check;
mod exit;
mod explain;
mod interrupt;
mod load;
mod output;
mod paper;
mod picture;
mod progress;
mod render;
mod report;
mod settings;
mod stopwatch;
mod trace;
mod variant;
#[cfg(feature = "viewer")]
mod view;
#[cfg(not(feature = "viewer"))]
#[path = "no_view.rs"]
mod view;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    exit::finish(match args::Arguments::parse().command {
        args::Command::Render(arguments) => render::run(&arguments),
        args::Command::Check(arguments) => check::run(&arguments),
        args::Command::Explain(arguments) => explain::run(&arguments),
        args::Command::Trace(arguments) => trace::run(&arguments),
        args::Command::View(arguments) => view::run(&arguments),
        args::Command::Paper(arguments) => paper::run(&arguments),
    })
}
