//! What can be wrong with a file, and where.

use std::fmt;
use std::path::{Path, PathBuf};

/// Why a file could not be loaded or written: [`kind`](Self::kind) says who is to blame, [`report`](Self::report) what
/// is wrong and where.
///
/// `Display` gives `file:line:column: what` on its first line, then, where known, the source line with a caret and a
/// `hint:` line.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    kind: ErrorKind,
    report: Box<Report>,
}

/// Who is to blame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The file says something wrong.
    Input,
    /// The file may be right, but uses something that this program cannot do.
    Unsupported,
    /// The file asks for more than a limit of [`LoadOptions`](crate::LoadOptions) allows.
    Limit,
    /// The operating system refused.
    Io,
}

/// Something odd that did not stop the file from being loaded. `Display` as for [`Error`].
#[derive(Clone, Debug, PartialEq)]
pub struct Warning(pub Report);

/// What is wrong and where.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// The file, as its user named it; empty if there is none.
    pub file: PathBuf,
    /// The place in it.
    pub place: Place,
    /// What is wrong: one line without a full stop.
    pub what: String,
    /// What to do about it, if known.
    pub hint: Option<String>,
    /// The source line around the place, if it is text.
    pub excerpt: Option<Excerpt>,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Place {
    /// No place in particular.
    #[default]
    Whole,
    /// A character of a text.
    Text {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
    },
    /// A byte of a binary file, from 0.
    Byte(usize),
}

/// One line of a text, or the part of a long line that matters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The text, without control characters.
    pub text: String,
    /// Number of characters before the caret.
    pub indent: usize,
    /// Number of carets, ≥ 1.
    pub carets: usize,
}

impl Error {
    /// An error about a file as a whole.
    pub(crate) fn new(kind: ErrorKind, file: &Path, what: impl Into<String>) -> Self {
        Self::from_report(kind, Report { file: file.to_owned(), what: what.into(), ..Report::default() })
    }

    pub(crate) fn from_report(kind: ErrorKind, report: Report) -> Self {
        Self { kind, report: Box::new(report) }
    }

    /// The operating system's refusal to do `what` (an infinitive) with `file`.
    pub(crate) fn io(file: &Path, what: &str, error: &std::io::Error) -> Self {
        Self::new(ErrorKind::Io, file, format!("cannot {what}: {error}"))
    }

    /// The same error with this advice.
    pub(crate) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.report.hint = Some(hint.into());
        self
    }

    /// The same error, blamed on `kind`.
    pub(crate) fn blame(mut self, kind: ErrorKind) -> Self {
        self.kind = kind;
        self
    }

    /// The same error, in another line of its text.
    pub(crate) fn on_line(mut self, number: usize) -> Self {
        if let Place::Text { line, .. } = &mut self.report.place {
            *line = number;
        }
        self
    }

    /// The error as a warning.
    pub(crate) fn into_warning(self) -> Warning {
        Warning(*self.report)
    }

    /// Who is to blame.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// What is wrong and where.
    pub fn report(&self) -> &Report {
        &self.report
    }
}

impl std::error::Error for Error {}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.report.fmt(f)
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.file.as_os_str().is_empty() {
            write!(f, "{}:", printable(&self.file.to_string_lossy()))?;
        }
        match self.place {
            Place::Whole => {}
            Place::Text { line, column } => write!(f, "{line}:{column}:")?,
            Place::Byte(at) => write!(f, " byte {at}:")?,
        }
        let gap = if self.file.as_os_str().is_empty() && self.place == Place::Whole { "" } else { " " };
        write!(f, "{gap}{}", self.what)?;
        if let Some(Excerpt { text, indent, carets }) = &self.excerpt {
            write!(f, "\n  {text}\n  {:indent$}{}", "", "^".repeat(*carets))?;
        }
        match &self.hint {
            Some(hint) => write!(f, "\nhint: {hint}"),
            None => Ok(()),
        }
    }
}

/// `text` with control characters escaped: whatever a file contains, a message about it stays one harmless line.
pub(crate) fn printable(text: &str) -> String {
    text.chars().flat_map(|c| if c.is_control() { c.escape_default().collect::<Vec<_>>() } else { vec![c] }).collect()
}

/// A word of a file in quotes, for messages: escaped and cut to a readable length.
pub(crate) fn quoted(word: impl AsRef<[u8]>) -> String {
    const LONGEST: usize = 40;
    let text = printable(&String::from_utf8_lossy(word.as_ref().get(..4 * LONGEST).unwrap_or(word.as_ref())));
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("\"{}…\"", &text[..end]),
        None => format!("\"{text}\""),
    }
}
