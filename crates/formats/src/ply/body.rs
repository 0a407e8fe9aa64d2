//! The numbers after the header, one after the other, in any of the three encodings.

use super::header::Type;
use crate::error::{Error, quoted};
use crate::source::Source;
use crate::text::{Words, float};

/// A stream of numbers. Errors say where the file ends too early or has no number.
pub(super) trait Body {
    /// The next number.
    fn number(&mut self, kind: Type) -> Result<f64, Error>;

    /// The next number as an integer.
    fn integer(&mut self, kind: Type) -> Result<i64, Error>;

    /// Pass over `count` numbers.
    fn skip(&mut self, kind: Type, count: usize) -> Result<(), Error>;

    /// The item is complete. In a text, what else stands in its last line is passed over: writers are known to put
    /// numbers there that the header does not mention.
    fn end_item(&mut self);

    /// The least bytes that a number of this type takes.
    fn size(kind: Type) -> usize;

    /// Bytes not read yet.
    fn bytes_left(&self) -> usize;

    /// An upper bound on how many numbers of this type can still follow.
    #[inline]
    fn at_most(&self, kind: Type) -> usize {
        self.bytes_left() / Self::size(kind)
    }

    /// A fault of the number read last.
    fn fault(&self, what: String) -> Error;
}

/// A body of text.
pub(super) struct Ascii<'a> {
    source: Source<'a>,
    words: Words<'a>,
    last: &'a [u8],
}

impl<'a> Ascii<'a> {
    pub(super) fn new(source: Source<'a>, body: &'a [u8]) -> Self {
        Self { source, words: Words::new(body), last: body }
    }

    fn word(&mut self) -> Result<&'a [u8], Error> {
        match self.words.next() {
            Some(word) => {
                self.last = word;
                Ok(word)
            }
            None => Err(self.source.error_at(self.words.rest(), "the file ends before its last element")),
        }
    }
}

impl Body for Ascii<'_> {
    fn number(&mut self, kind: Type) -> Result<f64, Error> {
        let word = self.word()?;
        // Rounded once, so that a text and its binary twin are equal.
        let value = match kind {
            Type::F32 => std::str::from_utf8(word).ok().and_then(|w| w.parse::<f32>().ok()).map(f64::from),
            _ => float(word),
        };
        value.ok_or_else(|| self.fault(format!("{} is not a number", quoted(word))))
    }

    fn integer(&mut self, _: Type) -> Result<i64, Error> {
        let word = self.word()?;
        let value = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
        value.ok_or_else(|| self.fault(format!("{} is not a whole number", quoted(word))))
    }

    fn skip(&mut self, _: Type, count: usize) -> Result<(), Error> {
        (0..count).try_for_each(|_| self.word().map(drop))
    }

    fn end_item(&mut self) {
        self.words.skip_line();
    }

    fn size(_: Type) -> usize {
        // A digit and a separator.
        2
    }

    fn bytes_left(&self) -> usize {
        // The last number needs no separator.
        self.words.rest().len() + 1
    }

    fn fault(&self, what: String) -> Error {
        self.source.error_at(self.last, what)
    }
}

/// A binary body; `BIG` for the most significant byte first.
pub(super) struct Binary<'a, const BIG: bool> {
    source: Source<'a>,
    rest: &'a [u8],
    /// Size of the number read last.
    last: usize,
}

impl<'a, const BIG: bool> Binary<'a, BIG> {
    pub(super) fn new(source: Source<'a>, body: &'a [u8]) -> Self {
        Self { source, rest: body, last: 0 }
    }

    #[inline]
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        match self.rest.split_first_chunk::<N>() {
            Some((&bytes, rest)) => {
                self.rest = rest;
                self.last = N;
                Ok(bytes)
            }
            None => Err(self.ended()),
        }
    }

    #[cold]
    fn ended(&self) -> Error {
        self.source.error_byte(self.source.bytes.len(), "the file ends before its last element")
    }
}

/// A number from bytes in the order of `BIG`.
macro_rules! read {
    ($body:ident, $kind:ident) => {{
        let bytes = $body.bytes()?;
        if BIG { $kind::from_be_bytes(bytes) } else { $kind::from_le_bytes(bytes) }
    }};
}

impl<const BIG: bool> Body for Binary<'_, BIG> {
    #[inline]
    fn number(&mut self, kind: Type) -> Result<f64, Error> {
        Ok(match kind {
            Type::F32 => f64::from(read!(self, f32)),
            Type::F64 => read!(self, f64),
            _ => self.integer(kind)? as f64,
        })
    }

    #[inline]
    fn integer(&mut self, kind: Type) -> Result<i64, Error> {
        Ok(match kind {
            Type::I8 => i64::from(read!(self, i8)),
            Type::U8 => i64::from(read!(self, u8)),
            Type::I16 => i64::from(read!(self, i16)),
            Type::U16 => i64::from(read!(self, u16)),
            Type::I32 => i64::from(read!(self, i32)),
            Type::U32 => i64::from(read!(self, u32)),
            Type::F32 | Type::F64 => {
                let value = self.number(kind)?;
                if value.fract() != 0.0 {
                    return Err(self.fault(format!("{value} is not a whole number")));
                }
                value as i64
            }
        })
    }

    fn skip(&mut self, kind: Type, count: usize) -> Result<(), Error> {
        let bytes = count.checked_mul(kind.size()).filter(|&bytes| bytes <= self.rest.len());
        self.rest = &self.rest[bytes.ok_or_else(|| self.ended())?..];
        Ok(())
    }

    #[inline]
    fn end_item(&mut self) {}

    #[inline]
    fn size(kind: Type) -> usize {
        kind.size()
    }

    #[inline]
    fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    fn fault(&self, what: String) -> Error {
        self.source.error_byte(self.source.bytes.len() - self.rest.len() - self.last, what)
    }
}
