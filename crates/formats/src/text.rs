//! Lines, words and numbers of plain-text formats, without copying.

use crate::error::{Error, quoted};
use crate::source::Source;

/// The lines of a text, ended by LF, CR LF or CR alone. A line that ends in a backslash is joined to the next.
#[derive(Clone, Debug)]
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
}

impl<'a> Lines<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    /// The end of the first line of `bytes`, and where the next begins.
    fn split(bytes: &[u8]) -> (usize, usize) {
        match bytes.iter().position(|b| matches!(b, b'\n' | b'\r')) {
            Some(end) if bytes[end] == b'\r' && bytes.get(end + 1) == Some(&b'\n') => (end, end + 2),
            Some(end) => (end, end + 1),
            None => (bytes.len(), bytes.len()),
        }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        let (mut end, mut next) = Self::split(self.rest);
        while next < self.rest.len() && self.rest[..end].last() == Some(&b'\\') {
            let (more, after) = Self::split(&self.rest[next..]);
            (end, next) = (next + more, next + after);
        }
        let (line, rest) = (&self.rest[..end], &self.rest[next..]);
        self.rest = rest;
        Some(line)
    }
}

/// The words of a text: separated by white space, or by a backslash that ends a line.
#[derive(Clone, Debug)]
pub(crate) struct Words<'a> {
    rest: &'a [u8],
}

impl<'a> Words<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    /// What follows the words taken so far.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// Pass over the words that stand in the same line as the one taken last.
    pub(crate) fn skip_line(&mut self) {
        let end = self.rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(self.rest.len());
        self.rest = &self.rest[end..];
    }

    fn skip_space(&mut self) {
        loop {
            match self.rest {
                [b, rest @ ..] if is_space(*b) => self.rest = rest,
                [b'\\'] => self.rest = &[],
                [b'\\', b'\n' | b'\r', rest @ ..] => self.rest = rest,
                _ => return,
            }
        }
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    #[inline]
    fn next(&mut self) -> Option<&'a [u8]> {
        self.skip_space();
        let end = self.rest.iter().position(|&b| is_space(b)).unwrap_or(self.rest.len());
        let (mut word, mut rest) = self.rest.split_at(end);
        if let [before @ .., b'\\'] = word
            && matches!(rest, [] | [b'\n' | b'\r', ..])
        {
            (word, rest) = (before, &self.rest[before.len()..]);
        }
        self.rest = rest;
        (!word.is_empty()).then_some(word)
    }
}

/// White space that separates words, line ends included.
#[inline]
pub(crate) fn is_space(b: u8) -> bool {
    matches!(b, b' ' | b'\t' | b'\n' | b'\r' | 0x0B | 0x0C)
}

/// A number as text formats write it, `nan` and `inf` included; none for anything else.
#[inline]
pub(crate) fn float(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// As [`float`], in single precision, rounded once.
#[inline]
pub(crate) fn float32(word: &[u8]) -> Option<f32> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The number `word`; an error of `source` if it is none or not finite. `what` names it in the error.
pub(crate) fn finite(source: &Source<'_>, word: &[u8], what: &str) -> Result<f64, Error> {
    match float(word) {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(source.error_at(word, format!("{what} must be a finite number, not {}", quoted(word)))),
        None => Err(source.error_at(word, format!("{what} must be a number, not {}", quoted(word)))),
    }
}

/// `line` without leading and trailing white space.
pub(crate) fn trim(line: &[u8]) -> &[u8] {
    let start = line.iter().position(|&b| !is_space(b)).unwrap_or(line.len());
    let end = line.iter().rposition(|&b| !is_space(b)).map_or(start, |last| last + 1);
    &line[start..end]
}
