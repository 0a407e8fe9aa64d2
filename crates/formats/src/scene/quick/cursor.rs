//! A place in a TOML text, and what is read from there. Whatever is not understood is `None`.

use std::borrow::Cow;

use super::growing::Growing;
use crate::scene::document::{Key, Node, Span, Value};
use crate::scene::toml;

/// `[name]`, or `[[name]]` if it begins an item.
#[derive(Debug)]
pub(super) struct Header<'t> {
    pub(super) span: Span,
    pub(super) is_item: bool,
    /// The parts of the name.
    pub(super) first: Key<'t>,
    pub(super) more: Vec<Key<'t>>,
}

/// A place in a text.
#[derive(Debug)]
pub(super) struct Cursor<'t> {
    text: &'t str,
    at: usize,
}

/// The most parts of a name after the first, and the deepest nesting of lists and tables in one value: more than any scene has, and
/// less than the oracle allows.
const DEEPEST: usize = 16;

impl<'t> Cursor<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        Self { text, at: 0 }
    }

    fn peek(&self) -> Option<u8> {
        self.rest().first().copied()
    }

    fn rest(&self) -> &'t [u8] {
        &self.text.as_bytes()[self.at..]
    }

    /// Pass over `byte` if it is next.
    fn eat(&mut self, byte: u8) -> bool {
        let is_next = self.peek() == Some(byte);
        self.at += usize::from(is_next);
        is_next
    }

    fn skip_blanks(&mut self) {
        self.at += self.rest().iter().take_while(|b| matches!(b, b' ' | b'\t')).count();
    }

    /// Pass over blanks, line ends and comments. Gives the byte after them, if there is one.
    pub(super) fn skip_gaps(&mut self) -> Option<Option<u8>> {
        loop {
            match self.peek() {
                Some(b' ' | b'\t' | b'\n') => self.at += 1,
                Some(b'\r') if self.rest().starts_with(b"\r\n") => self.at += 2,
                Some(b'#') => self.comment()?,
                other => return Some(other),
            }
        }
    }

    /// Pass over the rest of the line, which must be empty but for a comment. The line end itself may be left.
    pub(super) fn end_line(&mut self) -> Option<()> {
        self.skip_blanks();
        match self.peek() {
            None | Some(b'\n') => Some(()),
            Some(b'\r') => self.rest().starts_with(b"\r\n").then_some(()),
            Some(b'#') => self.comment(),
            Some(_) => None,
        }
    }

    fn comment(&mut self) -> Option<()> {
        let length = self.rest().iter().position(|&b| is_control(b)).unwrap_or(self.rest().len());
        self.at += length;
        match self.rest() {
            [] | [b'\n', ..] | [b'\r', b'\n', ..] => Some(()),
            _ => None,
        }
    }

    pub(super) fn header(&mut self) -> Option<Header<'t>> {
        let start = self.at;
        let is_item = self.rest().starts_with(b"[[");
        self.at += if is_item { 2 } else { 1 };
        let (first, mut more) = (self.key()?, Vec::new());
        while self.eat(b'.') {
            more.push(self.key()?);
        }
        let is_closed = self.eat(b']') && (!is_item || self.eat(b']'));
        let is_header = is_closed && more.len() <= DEEPEST;
        is_header.then_some(Header { span: start..self.at, is_item, first, more })
    }

    /// Add `key = value`, which stands within `depth` values, to `table`.
    pub(super) fn entry(&mut self, table: &mut Growing<'t>, depth: usize) -> Option<()> {
        let first = self.key()?;
        let second = if self.eat(b'.') { Some(self.key()?) } else { None };
        if !self.eat(b'=') {
            return None;
        }
        self.skip_blanks();
        let node = self.value(depth)?;
        match second {
            None => table.add(first, node),
            Some(second) => table.add_dotted(first, second, node),
        }
    }

    /// A part of a key, and blanks around it.
    fn key(&mut self) -> Option<Key<'t>> {
        self.skip_blanks();
        let start = self.at;
        let name = match self.peek()? {
            quote @ (b'"' | b'\'') if !self.rest().starts_with(&[quote; 3]) => match self.string(quote)? {
                Value::Text(name @ Cow::Borrowed(_)) => name,
                _ => return None,
            },
            _ => Cow::Borrowed(self.bare_key()?),
        };
        let span = start..self.at;
        self.skip_blanks();
        Some(Key { span, name })
    }

    fn bare_key(&mut self) -> Option<&'t str> {
        let is_bare = |b: &&u8| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'-');
        let length = self.rest().iter().take_while(is_bare).count();
        self.take(length).filter(|name| !name.is_empty())
    }

    /// Pass over `length` bytes.
    fn take(&mut self, length: usize) -> Option<&'t str> {
        let word = self.text.get(self.at..self.at + length);
        self.at += length;
        word
    }

    fn value(&mut self, depth: usize) -> Option<Node<'t>> {
        let start = self.at;
        let value = match self.peek()? {
            _ if depth == DEEPEST => return None,
            b'[' => self.list(depth)?,
            b'{' => self.table(depth)?,
            quote @ (b'"' | b'\'') => self.string(quote)?,
            _ => self.atom()?,
        };
        Some(Node { span: start..self.at, value })
    }

    /// `[value, value]`.
    fn list(&mut self, depth: usize) -> Option<Value<'t>> {
        let mut items = Vec::new();
        self.at += 1;
        while self.skip_gaps()?? != b']' {
            items.push(self.value(depth + 1)?);
            self.end_item(b']')?;
        }
        self.at += 1;
        Some(Value::List(items))
    }

    /// `{ key = value, key = value }`.
    fn table(&mut self, depth: usize) -> Option<Value<'t>> {
        let mut entries = Growing::default();
        self.at += 1;
        while self.skip_gaps()?? != b'}' {
            self.entry(&mut entries, depth + 1)?;
            self.end_item(b'}')?;
        }
        self.at += 1;
        entries.finish().map(Value::Table)
    }

    /// Pass over what separates two items, or stay before the end of all of them.
    fn end_item(&mut self, end: u8) -> Option<()> {
        let next = self.skip_gaps()??;
        (self.eat(b',') || next == end).then_some(())
    }

    /// A number, or true or false.
    fn atom(&mut self) -> Option<Value<'t>> {
        let ends = |b: &u8| matches!(b, b' ' | b'\t' | b'\n' | b'\r' | b',' | b']' | b'}' | b'#');
        let rest = self.rest();
        let word = self.take(rest.iter().position(ends).unwrap_or(rest.len()))?;
        match word {
            "true" => Some(Value::Bool(true)),
            "false" => Some(Value::Bool(false)),
            _ => number(word),
        }
    }

    /// A text in any quotes, of which the first one is `quote`.
    fn string(&mut self, quote: u8) -> Option<Value<'t>> {
        let start = self.at;
        if self.rest().starts_with(&[quote; 3]) {
            self.skip_long(quote)?;
            return toml::scalar(self.text.get(start..self.at)?);
        }
        let mut is_plain = true;
        self.at += 1;
        loop {
            match self.peek()? {
                byte if byte == quote => break,
                b'\\' if quote == b'"' => {
                    is_plain = false;
                    self.escape()?;
                }
                byte if is_control(byte) => return None,
                _ => self.at += 1,
            }
        }
        let text = self.text.get(start + 1..self.at)?;
        self.at += 1;
        match is_plain {
            true => Some(Value::Text(Cow::Borrowed(text))),
            false => toml::scalar(self.text.get(start..self.at)?),
        }
    }

    /// Pass over a text in three quotes.
    fn skip_long(&mut self, quote: u8) -> Option<()> {
        self.at += 3;
        while !self.rest().starts_with(&[quote; 3]) {
            match self.peek()? {
                b'\\' if quote == b'"' => self.escape()?,
                _ => self.at += 1,
            }
        }
        self.at += 3;
        // Up to two quotes before the closing ones belong to the text.
        for _ in 0..2 {
            self.eat(quote);
        }
        Some(())
    }

    /// Pass over a backslash and the byte after it.
    fn escape(&mut self) -> Option<()> {
        self.at += 2;
        (self.at <= self.text.len()).then_some(())
    }
}

/// A byte that no line contains.
fn is_control(byte: u8) -> bool {
    byte < b' ' && byte != b'\t' || byte == 0x7F
}

/// The value of a number.
fn number(word: &str) -> Option<Value<'_>> {
    match is_whole(word.as_bytes()) {
        Some(true) => word.parse().ok().map(Value::Integer),
        Some(false) => word.parse().ok().map(Value::Float),
        None => toml::scalar(word),
    }
}

/// Whether a number in decimal digits is an integer; none if it is written in another way.
fn is_whole(word: &[u8]) -> Option<bool> {
    let unsigned = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(word);
    let (whole, mut rest) = split_digits(unsigned)?;
    if whole.len() > 1 && whole[0] == b'0' {
        return None;
    }
    let is_whole = rest.is_empty();
    if let [b'.', fraction @ ..] = rest {
        (_, rest) = split_digits(fraction)?;
    }
    if let [b'e' | b'E', exponent @ ..] = rest {
        let unsigned = exponent.strip_prefix(b"-").or(exponent.strip_prefix(b"+")).unwrap_or(exponent);
        (_, rest) = split_digits(unsigned)?;
    }
    rest.is_empty().then_some(is_whole)
}

/// The digits, of which there must be one at least, and what follows them.
fn split_digits(word: &[u8]) -> Option<(&[u8], &[u8])> {
    let count = word.iter().take_while(|b| b.is_ascii_digit()).count();
    (count > 0).then(|| word.split_at(count))
}
