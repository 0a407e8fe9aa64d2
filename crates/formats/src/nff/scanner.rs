//! The words of an NFF file: separated by white space, without comments.

use whitted::math::Vec3d;

use crate::error::{Error, quoted};
use crate::source::Source;
use crate::text;

/// A place in the text.
#[derive(Clone, Copy)]
pub(super) struct Scanner<'a> {
    pub(super) source: Source<'a>,
    rest: &'a [u8],
}

impl<'a> Scanner<'a> {
    pub(super) fn new(source: Source<'a>) -> Self {
        Self { source, rest: source.bytes }
    }

    /// The next word, wherever it is.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.word_in_line() {
                return Some(word);
            }
            self.rest = self.rest.get(1..)?;
        }
    }

    /// The next word of the line; none, and nothing is passed over but white space, at its end.
    pub(super) fn word_in_line(&mut self) -> Option<&'a [u8]> {
        let is_end = |b: u8| matches!(b, b'\n' | b'\r');
        let space = self.rest.iter().position(|&b| !text::is_space(b) || is_end(b)).unwrap_or(self.rest.len());
        self.rest = &self.rest[space..];
        if self.rest.first() == Some(&b'#') {
            let comment = self.rest.iter().position(|&b| is_end(b)).unwrap_or(self.rest.len());
            self.rest = &self.rest[comment..];
        }
        let end = self.rest.iter().position(|&b| text::is_space(b) || b == b'#').unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        (!word.is_empty()).then_some(word)
    }

    /// The next word without taking it.
    pub(super) fn peek(&self) -> Option<&'a [u8]> {
        Self { ..*self }.word()
    }

    /// Bytes not read yet.
    pub(super) fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    /// The next finite number, called `what` in errors.
    pub(super) fn number(&mut self, what: &str) -> Result<f64, Error> {
        match self.word() {
            Some(word) => text::finite(&self.source, word, what),
            None => Err(self.source.error_at(self.rest, format!("the file ends where {what} is expected"))),
        }
    }

    /// The next three finite numbers.
    pub(super) fn vector(&mut self, what: &str) -> Result<Vec3d, Error> {
        Ok(Vec3d::new(self.number(what)?, self.number(what)?, self.number(what)?))
    }

    /// The finite numbers up to the end of the line or to the first word that begins like none.
    pub(super) fn numbers_in_line(&mut self, what: &str) -> Result<Vec<f64>, Error> {
        let mut numbers = Vec::new();
        loop {
            let before = *self;
            match self.word_in_line() {
                Some(word) if !word[0].is_ascii_alphabetic() || text::float(word).is_some() => {
                    numbers.push(text::finite(&self.source, word, what)?);
                }
                word => {
                    if word.is_some() {
                        *self = before;
                    }
                    return Ok(numbers);
                }
            }
        }
    }

    /// The next whole number ≥ 0.
    pub(super) fn count(&mut self, what: &str) -> Result<usize, Error> {
        let Some(word) = self.word() else {
            return Err(self.source.error_at(self.rest, format!("the file ends where {what} is expected")));
        };
        let count = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
        count.ok_or_else(|| self.source.error_at(word, format!("{what} must be a whole number, not {}", quoted(word))))
    }
}
