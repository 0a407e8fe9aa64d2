//! A file in memory, and places in it.

use std::borrow::Cow;
use std::ops::Range;
use std::path::Path;

use crate::error::{Error, ErrorKind, Excerpt, Place, Report};

/// The bytes of a file and its name: whatever is wrong with them is reported through here.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source<'a> {
    /// The name for messages.
    pub(crate) file: &'a Path,
    /// The content.
    pub(crate) bytes: &'a [u8],
}

impl<'a> Source<'a> {
    /// A fault of the text at the bytes `at`.
    pub(crate) fn error(&self, at: Range<usize>, what: impl Into<String>) -> Error {
        let start = at.start.min(self.bytes.len());
        let (line, line_start) = self.line_of(start);
        let line_bytes = &self.bytes[line_start..line_end(self.bytes, line_start)];
        let before = String::from_utf8_lossy(&self.bytes[line_start..start]).chars().count();
        let marked = &self.bytes[start..at.end.clamp(start, (line_start + line_bytes.len()).max(start))];
        let carets = String::from_utf8_lossy(marked).chars().count();
        let report = Report {
            file: self.file.to_owned(),
            place: Place::Text { line, column: before + 1 },
            what: what.into(),
            hint: None,
            excerpt: excerpt(&String::from_utf8_lossy(line_bytes), before, carets),
        };
        Error::from_report(ErrorKind::Input, report)
    }

    /// A fault of the text at `word`, which must be a part of this source; else of the text as a whole.
    pub(crate) fn error_at(&self, word: &[u8], what: impl Into<String>) -> Error {
        let offset = (word.as_ptr() as usize).wrapping_sub(self.bytes.as_ptr() as usize);
        match offset <= self.bytes.len() {
            true => self.error(offset..offset + word.len(), what),
            false => self.error_whole(what),
        }
    }

    /// A fault of binary data at the byte `at`.
    pub(crate) fn error_byte(&self, at: usize, what: impl Into<String>) -> Error {
        let report =
            Report { file: self.file.to_owned(), place: Place::Byte(at), what: what.into(), ..Report::default() };
        Error::from_report(ErrorKind::Input, report)
    }

    /// A fault of the file as a whole.
    pub(crate) fn error_whole(&self, what: impl Into<String>) -> Error {
        Error::new(ErrorKind::Input, self.file, what)
    }

    /// The number of the line with byte `offset`, from 1, and where that line starts. Lines end with LF, CR or both.
    fn line_of(&self, offset: usize) -> (usize, usize) {
        let (mut line, mut start) = (1, 0);
        for at in 0..offset {
            let ends = match self.bytes[at] {
                b'\n' => true,
                b'\r' => self.bytes.get(at + 1) != Some(&b'\n'),
                _ => false,
            };
            if ends {
                (line, start) = (line + 1, at + 1);
            }
        }
        (line, start)
    }
}

fn line_end(bytes: &[u8], start: usize) -> usize {
    bytes[start..].iter().position(|b| matches!(b, b'\n' | b'\r')).map_or(bytes.len(), |len| start + len)
}

/// The part of `line` around character `column`, with control characters shown as spaces.
fn excerpt(line: &str, column: usize, carets: usize) -> Option<Excerpt> {
    const WIDTH: usize = 100;
    let skipped = if column < WIDTH { 0 } else { column - WIDTH / 2 };
    let shown: String = line.chars().skip(skipped).take(WIDTH).map(|c| if c.is_control() { ' ' } else { c }).collect();
    let indent = column - skipped;
    let carets = carets.clamp(1, WIDTH.saturating_sub(indent).max(1));
    let text = shown.trim_end().to_owned();
    (!text.is_empty()).then_some(Excerpt { text, indent, carets })
}

/// Text in UTF-8, whatever byte-order mark `bytes` begin with; bytes without a mark are left as they are.
pub(crate) fn decode(file: &Path, bytes: Vec<u8>) -> Result<Vec<u8>, Error> {
    let utf16 = |unit: fn([u8; 2]) -> u16| {
        let units = bytes[2..].as_chunks::<2>().0.iter().map(|&pair| unit(pair));
        char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect::<String>().into_bytes()
    };
    match bytes.as_slice() {
        [0xEF, 0xBB, 0xBF, rest @ ..] => Ok(rest.to_vec()),
        [0xFF, 0xFE, ..] => Ok(utf16(u16::from_le_bytes)),
        [0xFE, 0xFF, ..] => Ok(utf16(u16::from_be_bytes)),
        [0, b, ..] | [b, 0, ..] if *b != 0 => {
            let error = Error::new(ErrorKind::Unsupported, file, "the text is UTF-16 without a byte-order mark");
            Err(error.hint("save it as UTF-8"))
        }
        _ => Ok(bytes),
    }
}

/// `source` as text.
pub(crate) fn utf8<'a>(source: &Source<'a>) -> Result<&'a str, Error> {
    std::str::from_utf8(source.bytes).map_err(|e| {
        let at = e.valid_up_to();
        source.error(at..at + 1, "the text is not UTF-8")
    })
}

/// A word as text, with anything that is not UTF-8 replaced.
pub(crate) fn lossy(word: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(word)
}
