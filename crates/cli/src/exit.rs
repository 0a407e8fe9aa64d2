//! How the command ends: its exit codes and what it says before.

use std::fmt;
use std::process::ExitCode;

/// Why the command did not do what it was asked, sorted by who can help.
#[derive(Debug, PartialEq)]
pub(crate) enum Failure {
    /// A file could not be read or written, or the render failed.
    Io(String),
    /// The arguments make no sense together; clap reports those that make none by themselves.
    Usage(String),
    /// The scene is wrong; the text says where.
    Scene(String),
    /// The user stopped it, and nothing was written.
    Interrupted,
    /// The user stopped it; the text says what there is.
    InterruptedAfter(String),
    /// What was computed is not what it must be.
    Wrong(String),
}

/// What a shell reports for a process that SIGINT (2) ended: 128 + 2.
pub(crate) const INTERRUPTED: u8 = 130;

impl Failure {
    fn code(&self) -> u8 {
        match self {
            Self::Io(_) | Self::Wrong(_) => 1,
            Self::Usage(_) => 2,
            Self::Scene(_) => 3,
            Self::Interrupted | Self::InterruptedAfter(_) => INTERRUPTED,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(text) | Self::Scene(text) | Self::Wrong(text) => write!(f, "error: {text}"),
            Self::Usage(text) => write!(f, "error: {text}\n\nFor more information, try '--help'."),
            Self::Interrupted => write!(f, "interrupted: nothing was written"),
            Self::InterruptedAfter(text) => write!(f, "interrupted: {text}"),
        }
    }
}

/// Reports a failure on standard error and turns the outcome into the process's exit code.
pub(crate) fn finish(outcome: Result<(), Failure>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            ExitCode::from(failure.code())
        }
    }
}
