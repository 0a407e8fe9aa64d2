//! Rays as comma-separated values.

use crate::error::{Error, ErrorKind, Warning, quoted};
use crate::source::Source;
use crate::text::{float32, trim};
use std::io::{BufRead, Read};
use std::ops::Range;
use std::path::Path;
use whitted::math::Vec3;
use whitted::ray::{Ray, RayBatch};

/// The columns, in the order of their values.
const NAMES: [&str; 8] = ["ox", "oy", "oz", "dx", "dy", "dz", "t_min", "t_max"];

/// Columns that must be there.
const NEEDED: usize = 6;

/// Longest line in bytes.
const MAX_LINE: usize = 1 << 16;

const HEAD_HINT: &str = "the first line names the columns: ox,oy,oz,dx,dy,dz and, if wanted, t_min,t_max";

/// Where in the table a reader is.
#[derive(Debug)]
pub(super) struct Table {
    /// For each column of the file, which value it holds, if any.
    columns: Vec<Option<usize>>,
    /// Number of the line read last, from 1.
    line: usize,
    bytes: Vec<u8>,
}

impl Table {
    /// Read the line that names the columns.
    pub(super) fn begin(file: &Path, input: &mut impl BufRead, warnings: &mut Vec<Warning>) -> Result<Self, Error> {
        let mut table = Self { columns: Vec::new(), line: 0, bytes: Vec::new() };
        if !table.next_line(file, input)? {
            return Err(Error::new(ErrorKind::Input, file, "the file is empty").hint(HEAD_HINT));
        }
        if table.bytes.starts_with(&[0xFF, 0xFE]) || table.bytes.starts_with(&[0xFE, 0xFF]) || table.bytes.contains(&0)
        {
            return Err(Error::new(ErrorKind::Unsupported, file, "this is no text in UTF-8").hint("save it as UTF-8"));
        }
        if let Some(rest) = table.bytes.strip_prefix(b"\xEF\xBB\xBF") {
            table.bytes = rest.to_vec();
        }
        // NumPy writes the names as a comment.
        let comment = table.bytes.iter().take_while(|&&b| b == b'#').count();
        table.columns = table.name_columns(file, comment, warnings)?;
        Ok(table)
    }

    fn name_columns(
        &self,
        file: &Path,
        start: usize,
        warnings: &mut Vec<Warning>,
    ) -> Result<Vec<Option<usize>>, Error> {
        let mut columns = Vec::new();
        for range in fields(&self.bytes[start..]) {
            let field = &self.bytes[start..][range];
            let name = unquoted(field);
            let value = NAMES.iter().position(|known| known.as_bytes() == name);
            if value.is_some() && columns.contains(&value) {
                return Err(self.error(file, field, format!("the column {} occurs twice", quoted(name))));
            }
            if value.is_none() && float32(name).is_some() {
                return Err(self.error(file, field, "a number where a column's name should be").hint(HEAD_HINT));
            }
            if value.is_none() {
                let error = self.error(file, field, format!("the column {} is not read", quoted(name)));
                warnings.push(error.into_warning());
            }
            columns.push(value);
        }
        let missing: Vec<&str> = (0..NEEDED).filter(|&i| !columns.contains(&Some(i))).map(|i| NAMES[i]).collect();
        match missing[..] {
            [] => Ok(columns),
            _ => Err(self.error(file, &self.bytes, format!("no column {}", missing.join(", "))).hint(HEAD_HINT)),
        }
    }

    pub(super) fn read(
        &mut self,
        file: &Path,
        input: &mut impl BufRead,
        rays: &mut RayBatch,
        max: usize,
    ) -> Result<(), Error> {
        while rays.len() < max && self.next_line(file, input)? {
            rays.push(&self.ray(file)?);
        }
        Ok(())
    }

    /// The ray in the line at hand.
    fn ray(&self, file: &Path) -> Result<Ray, Error> {
        let mut values = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, f32::INFINITY];
        let mut count = 0;
        for range in fields(&self.bytes) {
            let field = &self.bytes[range];
            if let Some(&Some(value)) = self.columns.get(count) {
                let text = unquoted(field);
                // An empty end of a range is the usual one.
                if !(text.is_empty() && value >= NEEDED) {
                    values[value] = float32(text).ok_or_else(|| self.not_a_number(file, field, NAMES[value]))?;
                }
            }
            count += 1;
        }
        if count != self.columns.len() {
            let what = format!("{count} values, but {} columns were named", self.columns.len());
            return Err(self.error(file, &self.bytes, what));
        }
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = values;
        Ok(Ray { t_min, t_max, ..Ray::new(Vec3::new(ox, oy, oz), Vec3::new(dx, dy, dz)) })
    }

    fn not_a_number(&self, file: &Path, field: &[u8], name: &str) -> Error {
        let error = self.error(file, field, format!("{name} must be a number, not {}", quoted(unquoted(field))));
        match self.bytes.contains(&b';') || self.bytes.contains(&b'\t') {
            true => error.hint("values are separated by commas"),
            false => error,
        }
    }

    /// Read the next line that is not blank; false at the end.
    fn next_line(&mut self, file: &Path, input: &mut impl BufRead) -> Result<bool, Error> {
        loop {
            self.bytes.clear();
            let mut limited = Read::take(&mut *input, MAX_LINE as u64 + 1);
            let len = limited.read_until(b'\n', &mut self.bytes).map_err(|e| Error::io(file, "read the rays", &e))?;
            self.line += 1;
            if len == 0 {
                return Ok(false);
            }
            while self.bytes.last().is_some_and(|b| matches!(b, b'\n' | b'\r')) {
                self.bytes.pop();
            }
            if self.bytes.len() > MAX_LINE {
                let what = format!("the line is longer than {MAX_LINE} bytes");
                return Err(self.error(file, &self.bytes[..1], what).hint("lines end with LF or CR LF"));
            }
            if !trim(&self.bytes).is_empty() {
                return Ok(true);
            }
        }
    }

    /// A fault of the line at hand at `field`, a part of it.
    fn error(&self, file: &Path, field: &[u8], what: impl Into<String>) -> Error {
        let field = if trim(field).is_empty() { field } else { trim(field) };
        Source { file, bytes: &self.bytes }.error_at(field, what).on_line(self.line)
    }
}

/// Where the fields of a line lie.
fn fields(line: &[u8]) -> impl Iterator<Item = Range<usize>> {
    let mut start = 0;
    line.split(|&b| b == b',').map(move |field| {
        let range = start..start + field.len();
        start = range.end + 1;
        range
    })
}

/// A field without white space and quotes around it.
fn unquoted(field: &[u8]) -> &[u8] {
    let field = trim(field);
    field.strip_prefix(b"\"").and_then(|rest| rest.strip_suffix(b"\"")).map_or(field, trim)
}
