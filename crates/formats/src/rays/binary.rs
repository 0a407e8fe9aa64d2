//! Rays as records of numbers, one after the other.

use super::fill;
use crate::error::{Error, ErrorKind, Place, Report};
use std::io::Read;
use std::path::Path;
use whitted::math::Vec3;
use whitted::ray::{Ray, RayBatch};

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Number {
    /// 4 or 8.
    pub bytes: usize,
    pub is_big_endian: bool,
}

impl Number {
    const F32: Self = Self { bytes: 4, is_big_endian: false };

    /// The number in the first bytes, rounded to `f32`.
    fn decode(self, bytes: &[u8]) -> f32 {
        fn array<const N: usize>(bytes: &[u8], is_big_endian: bool) -> [u8; N] {
            let mut array: [u8; N] = bytes[..N].try_into().expect("a whole number");
            if is_big_endian {
                array.reverse();
            }
            array
        }
        match self.bytes {
            4 => f32::from_le_bytes(array(bytes, self.is_big_endian)),
            _ => f64::from_le_bytes(array(bytes, self.is_big_endian)) as f32,
        }
    }
}

/// Where in the records a reader is.
#[derive(Debug)]
pub(super) struct Records {
    number: Number,
    /// Numbers of a ray: 6 or 8.
    columns: usize,
    /// Records to come and records in all, if that is known.
    left: Option<u64>,
    total: Option<u64>,
    /// Offset of the next record in the input.
    offset: usize,
    bytes: Vec<u8>,
}

impl Records {
    /// Records of `f32` until the input ends.
    pub(super) fn endless(columns: usize) -> Self {
        Self { number: Number::F32, columns, left: None, total: None, offset: 0, bytes: Vec::new() }
    }

    /// `total` records from `offset` of the input.
    pub(super) fn counted(number: Number, columns: usize, total: u64, offset: usize) -> Self {
        Self { number, columns, left: Some(total), total: Some(total), offset, bytes: Vec::new() }
    }

    pub(super) fn total(&self) -> Option<u64> {
        self.total
    }

    pub(super) fn read(
        &mut self,
        file: &Path,
        input: &mut impl Read,
        rays: &mut RayBatch,
        max: usize,
    ) -> Result<(), Error> {
        let record = self.columns * self.number.bytes;
        let wanted = self.left.map_or(max, |left| left.min(max as u64) as usize);
        self.bytes.resize(wanted * record, 0);
        let len = fill(file, input, &mut self.bytes)?;
        for bytes in self.bytes[..len].chunks_exact(record) {
            rays.push(&self.decode(bytes));
        }
        let whole = len / record;
        self.offset += whole * record;
        if let Some(left) = &mut self.left {
            *left -= whole as u64;
        }
        if len % record != 0 || (self.left.is_some() && whole < wanted) {
            return Err(self.cut_off(file, len % record));
        }
        self.check_end(file, input)
    }

    fn decode(&self, bytes: &[u8]) -> Ray {
        let at = |column: usize| self.number.decode(&bytes[column * self.number.bytes..]);
        let ray = Ray::new(Vec3::new(at(0), at(1), at(2)), Vec3::new(at(3), at(4), at(5)));
        match self.columns {
            8 => Ray { t_min: at(6), t_max: at(7), ..ray },
            _ => ray,
        }
    }

    /// The error about an input that ends `rest` bytes into a record.
    fn cut_off(&self, file: &Path, rest: usize) -> Error {
        let record = self.columns * self.number.bytes;
        let what = match self.left {
            Some(left) => format!("the file ends, but {left} more rays were announced"),
            None => format!("the file ends within a ray: {rest} of {record} bytes"),
        };
        let error = at_byte(file, self.offset + rest, what);
        match self.columns {
            6 => error.hint("rays of eight numbers, with t_min and t_max, have the format f32x8"),
            _ => error.hint("rays of six numbers, without t_min and t_max, have the format f32"),
        }
    }

    /// After the last announced record nothing may follow.
    fn check_end(&self, file: &Path, input: &mut impl Read) -> Result<(), Error> {
        if self.left == Some(0) && fill(file, input, &mut [0])? > 0 {
            let total = self.total.unwrap_or(0);
            return Err(at_byte(file, self.offset, format!("the file goes on after the {total} rays announced")));
        }
        Ok(())
    }
}

/// A fault of a binary file at the byte `at`.
pub(super) fn at_byte(file: &Path, at: usize, what: impl Into<String>) -> Error {
    let report = Report { file: file.to_owned(), place: Place::Byte(at), what: what.into(), ..Report::default() };
    Error::from_report(ErrorKind::Input, report)
}
