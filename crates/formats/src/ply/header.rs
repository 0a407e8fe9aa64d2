//! The header of a PLY file: what the body holds, and how.

use crate::error::{Error, ErrorKind, Warning, printable, quoted};
use crate::source::{Source, lossy};
use crate::suggest;
use crate::text::{Words, trim};

/// How numbers are written in the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    /// The two names of each type.
    const NAMES: [(&'static str, Self); 16] = [
        ("char", Self::I8),
        ("int8", Self::I8),
        ("uchar", Self::U8),
        ("uint8", Self::U8),
        ("short", Self::I16),
        ("int16", Self::I16),
        ("ushort", Self::U16),
        ("uint16", Self::U16),
        ("int", Self::I32),
        ("int32", Self::I32),
        ("uint", Self::U32),
        ("uint32", Self::U32),
        ("float", Self::F32),
        ("float32", Self::F32),
        ("double", Self::F64),
        ("float64", Self::F64),
    ];

    /// Bytes in a binary body.
    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// True if single precision holds every value of the type.
    pub(super) const fn fits_f32(self) -> bool {
        !matches!(self, Self::I32 | Self::U32 | Self::F64)
    }
}

/// One number or one list of numbers of an item.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Property<'a> {
    pub(super) name: &'a [u8],
    /// The type of the list's length, if it is a list.
    pub(super) list: Option<Type>,
    /// The type of the number or of the list's items.
    pub(super) item: Type,
}

/// A kind of things that the body lists.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Element<'a> {
    pub(super) name: &'a [u8],
    /// How many things.
    pub(super) count: usize,
    /// Where the header says so, for messages.
    pub(super) count_word: &'a [u8],
    pub(super) properties: Vec<Property<'a>>,
}

/// What the body holds.
#[derive(Clone, Debug)]
pub(super) struct Header<'a> {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element<'a>>,
    /// The bytes after the header.
    pub(super) body: &'a [u8],
    pub(super) warnings: Vec<Warning>,
}

/// The lines of a header. They all end like the first: the first byte of a binary body may look like a line end.
struct HeaderLines<'a> {
    rest: &'a [u8],
    end: u8,
}

impl<'a> Iterator for HeaderLines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let end = self.rest.iter().position(|&b| b == self.end)?;
        let line = &self.rest[..end];
        self.rest = &self.rest[end + 1..];
        Some(trim(line))
    }
}

impl<'a> Header<'a> {
    pub(super) fn parse(source: &Source<'a>) -> Result<Self, Error> {
        let first = source.bytes.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(source.bytes.len());
        if trim(&source.bytes[..first]) != b"ply" {
            return Err(source.error_whole("not a PLY file: its first line is not \"ply\""));
        }
        let lines_feed = source.bytes[first..].starts_with(b"\n") || source.bytes[first..].starts_with(b"\r\n");
        let mut lines = HeaderLines { rest: source.bytes, end: if lines_feed { b'\n' } else { b'\r' } };
        lines.next();
        let mut encoding = None;
        let mut header = Self { encoding: Encoding::Ascii, elements: Vec::new(), body: &[], warnings: Vec::new() };
        loop {
            let Some(line) = lines.next() else {
                return Err(source.error_whole("the header never ends: \"end_header\" is missing"));
            };
            let mut words = Words::new(line);
            match words.next().unwrap_or_default() {
                b"end_header" => break,
                b"" | b"comment" | b"obj_info" => {}
                b"format" => encoding = Some(parse_format(source, line, words)?),
                b"element" => header.elements.push(parse_element(source, line, words)?),
                b"property" => header.add_property(source, line, words)?,
                word => {
                    let what = format!("{} is no word of a PLY header; the line was passed over", quoted(word));
                    header.warnings.push(source.error_at(word, what).into_warning());
                }
            }
        }
        header.encoding = encoding.ok_or_else(|| source.error_whole("the header has no \"format\" line"))?;
        header.body = lines.rest;
        Ok(header)
    }

    fn add_property(&mut self, source: &Source<'a>, line: &'a [u8], mut words: Words<'a>) -> Result<(), Error> {
        let Some(element) = self.elements.last_mut() else {
            return Err(source.error_at(line, "a property before any element"));
        };
        let mut kind = words.next();
        let list = kind == Some(b"list");
        let list = if list { Some(parse_type(source, line, words.next())?) } else { None };
        if list.is_some() {
            kind = words.next();
        }
        let item = parse_type(source, line, kind)?;
        let name = words.next().ok_or_else(|| source.error_at(line, "a property without a name"))?;
        if let Some(count @ (Type::F32 | Type::F64)) = list {
            return Err(source.error_at(line, format!("the length of a list cannot be a {count:?}")));
        }
        element.properties.push(Property { name, list, item });
        Ok(())
    }
}

fn parse_format(source: &Source<'_>, line: &[u8], mut words: Words<'_>) -> Result<Encoding, Error> {
    let encoding = match words.next() {
        Some(b"ascii") => Encoding::Ascii,
        Some(b"binary_little_endian") => Encoding::LittleEndian,
        Some(b"binary_big_endian") => Encoding::BigEndian,
        other => {
            let word = other.unwrap_or(line);
            return Err(source
                .error_at(word, format!("{} is no PLY format", quoted(word)))
                .hint("the formats are ascii, binary_little_endian and binary_big_endian"));
        }
    };
    match words.next() {
        Some(b"1.0") => Ok(encoding),
        other => {
            let word = other.unwrap_or(line);
            let what = format!("PLY version {} is not supported, only 1.0", quoted(word));
            Err(source.error_at(word, what).blame(ErrorKind::Unsupported))
        }
    }
}

fn parse_element<'a>(source: &Source<'a>, line: &'a [u8], mut words: Words<'a>) -> Result<Element<'a>, Error> {
    let (Some(name), Some(count_word)) = (words.next(), words.next()) else {
        return Err(source.error_at(line, "an element needs a name and a count"));
    };
    let count = std::str::from_utf8(count_word).ok().and_then(|count| count.parse().ok()).ok_or_else(|| {
        let what = format!("the count of {} is no whole number that fits: {}", lossy_name(name), quoted(count_word));
        source.error_at(count_word, what)
    })?;
    Ok(Element { name, count, count_word, properties: Vec::new() })
}

fn parse_type(source: &Source<'_>, line: &[u8], word: Option<&[u8]>) -> Result<Type, Error> {
    let Some(word) = word else {
        return Err(source.error_at(line, "a property without a type"));
    };
    let found = Type::NAMES.iter().find(|(name, _)| name.as_bytes() == word);
    found.map(|(_, kind)| *kind).ok_or_else(|| {
        let error = source.error_at(word, format!("{} is no PLY type", quoted(word)));
        match suggest::hint(&lossy(word), Type::NAMES.map(|(name, _)| name)) {
            Some(hint) => error.hint(hint),
            None => error,
        }
    })
}

/// The name of an element for a sentence.
pub(super) fn lossy_name(name: &[u8]) -> String {
    const LONGEST: usize = 40;
    printable(&lossy(&name[..name.len().min(LONGEST)]))
}
