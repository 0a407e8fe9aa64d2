//! The head of NumPy's array format, versions 1 to 3: `\x93NUMPY`, version, length, and a Python dictionary that says
//! how numbers are stored (`descr`), in which order (`fortran_order`), and the array's `shape`.

use super::binary::{Number, Records, at_byte};
use super::fill;
use crate::error::{Error, quoted};
use std::io::Read;
use std::path::Path;

const MAGIC: &[u8] = b"\x93NUMPY";

/// Heads are padded to multiples of this.
const ALIGNMENT: usize = 64;

/// No head of an array of numbers is longer.
const MAX_HEAD: usize = 1 << 16;

/// Read the head of an array of rays.
pub(super) fn begin(file: &Path, input: &mut impl Read) -> Result<Records, Error> {
    let mut start = [0; 8];
    let len = fill(file, input, &mut start)?;
    if len < start.len() || &start[..MAGIC.len()] != MAGIC {
        let what = "this is no NumPy file: it does not begin with \\x93NUMPY";
        return Err(at_byte(file, 0, what).hint("write it with numpy.save"));
    }
    let length_bytes = match start[6] {
        1 => 2,
        2 | 3 => 4,
        version => return Err(at_byte(file, 6, format!("version {version} of the format is not known"))),
    };
    let mut length = [0; 4];
    if fill(file, input, &mut length[..length_bytes])? < length_bytes {
        return Err(at_byte(file, 8, "the file ends within its head"));
    }
    let length = u32::from_le_bytes(length) as usize;
    let first = 8 + length_bytes;
    if length > MAX_HEAD {
        return Err(at_byte(file, 8, format!("a head of {length} bytes is no head of an array of rays")));
    }
    let mut head = vec![0; length];
    if fill(file, input, &mut head)? < length {
        return Err(at_byte(file, first, "the file ends within its head"));
    }
    let head = String::from_utf8_lossy(&head).into_owned();
    records(&head, first + length).map_err(|what| {
        let hint = "save an array of rays by numpy.save(file, numpy.ascontiguousarray(rays, numpy.float32)), \
                    of shape (n, 6) or (n, 8)";
        at_byte(file, first, what).hint(hint)
    })
}

/// What the dictionary announces.
fn records(head: &str, offset: usize) -> Result<Records, String> {
    let number = number(value(head, "descr")?)?;
    match value(head, "fortran_order")? {
        order if order.starts_with("False") => {}
        order if order.starts_with("True") => {
            return Err("the array is stored by columns (Fortran order), which cannot be read ray by ray".to_owned());
        }
        other => return Err(format!("fortran_order must be True or False, not {}", quoted(first_word(other)))),
    }
    let (count, columns) = shape(value(head, "shape")?)?;
    Ok(Records::counted(number, columns, count, offset))
}

/// What follows a key of the dictionary.
fn value<'h>(head: &'h str, key: &str) -> Result<&'h str, String> {
    let found = ["'", "\""].iter().find_map(|quote| head.split_once(&format!("{quote}{key}{quote}")));
    let rest = found.and_then(|(_, rest)| rest.trim_start().strip_prefix(':'));
    rest.map(str::trim_start).ok_or_else(|| format!("the head does not tell {key}"))
}

fn first_word(text: &str) -> &str {
    text.split([',', '}']).next().unwrap_or(text).trim()
}

fn number(descr: &str) -> Result<Number, String> {
    let name = first_word(descr);
    let (order, kind) = name.trim_matches(['\'', '"']).split_at_checked(1).unwrap_or_default();
    let bytes = match kind {
        "f4" => 4,
        "f8" => 8,
        _ => return Err(format!("numbers must be float32 or float64, not {}", quoted(name.trim_matches(['\'', '"'])))),
    };
    match order {
        "<" | "=" => Ok(Number { bytes, is_big_endian: false }),
        ">" => Ok(Number { bytes, is_big_endian: true }),
        other => Err(format!("{} is no byte order", quoted(other))),
    }
}

fn shape(shape: &str) -> Result<(u64, usize), String> {
    let inner = shape.strip_prefix('(').and_then(|rest| rest.split_once(')')).map(|(inner, _)| inner);
    let inner = inner.ok_or_else(|| format!("the shape {} is not in parentheses", quoted(first_word(shape))))?;
    let sides: Vec<&str> = inner.split(',').map(str::trim).filter(|side| !side.is_empty()).collect();
    let wrong = || format!("the shape must be (n, 6) or (n, 8), not ({inner})");
    let [count, columns] = sides[..] else { return Err(wrong()) };
    let count: u64 = count.parse().map_err(|_| wrong())?;
    match columns {
        "6" => Ok((count, 6)),
        "8" => Ok((count, 8)),
        _ => Err(wrong()),
    }
}

/// A head, as long whatever the count, for records described by `descr`.
pub(super) fn head(descr: &str, count: u64) -> Vec<u8> {
    let dictionary = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({count},), }}");
    let start = MAGIC.len() + 4;
    // The count may be replaced by a longer one.
    const MAX_DIGITS: usize = 20;
    let longest = start + dictionary.len() - count.to_string().len() + MAX_DIGITS + 1;
    let length = longest.next_multiple_of(ALIGNMENT) - start;
    let mut bytes = MAGIC.to_vec();
    bytes.extend([1, 0]);
    bytes.extend((length as u16).to_le_bytes());
    bytes.extend(dictionary.bytes());
    bytes.resize(start + length - 1, b' ');
    bytes.push(b'\n');
    bytes
}
