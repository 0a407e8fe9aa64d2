//! Numbers without a name: in the hot layers a float literal stands in a `const`, with its unit and source.

use super::Complaint;
use super::source::{Source, closing, is_identifier};
use std::ops::Range;

const NAMED_ONLY: &[&str] =
    &["crates/whitted/src/tree/", "crates/whitted/src/geometry/", "crates/whitted/src/classic/"];

/// Values that need no name: identities, one half and doubling.
const PLAIN: &[&str] = &["0.0", "0.5", "1.0", "2.0"];

pub(super) fn check(source: &Source) -> Vec<Complaint> {
    if !NAMED_ONLY.iter().any(|folder| source.path.starts_with(folder)) {
        return Vec::new();
    }
    let constants = constant_items(source);
    float_literals(&source.masked)
        .into_iter()
        .filter(|range| !source.is_test(range.start) && !constants.iter().any(|item| item.contains(&range.start)))
        .filter(|range| !PLAIN.contains(&value(&source.masked[range.clone()])))
        .filter(|range| !is_field(&source.masked, range.start))
        .map(|range| {
            let text = &source.masked[range.clone()];
            source.complaint(range.start, format!("`{text}` has no name: make it a `const` that says unit and source"))
        })
        .collect()
}

/// Whether the literal is the value of a field, as in `BuildOptions { traversal_cost: 1.2 }`: the field is its name.
fn is_field(masked: &str, at: usize) -> bool {
    let before = masked[..at].trim_end();
    before.ends_with(':') && !before.ends_with("::")
}

/// The literal without its type suffix.
fn value(literal: &str) -> &str {
    literal.trim_end_matches("f32").trim_end_matches("f64").trim_end_matches('_')
}

/// Spans of `const` and `static` items and of `const { … }` blocks.
fn constant_items(source: &Source) -> Vec<Range<usize>> {
    let masked = &source.masked;
    let keywords = source.find_word("const").chain(source.find_word("static"));
    keywords.filter_map(|at| constant_end(masked, at).map(|end| at..end)).collect()
}

fn constant_end(masked: &str, at: usize) -> Option<usize> {
    let rest = masked[at..].trim_start_matches("const").trim_start();
    if rest.starts_with('{') {
        return Some(closing(masked, masked.len() - rest.len()));
    }
    let is_function = rest.starts_with("fn ") || rest.starts_with("unsafe ");
    // `<const N: usize>`, `*const T` and `&'static T`.
    let is_type = masked[..at].trim_end().ends_with(['<', ',', '*', '\'']);
    (!is_function && !is_type).then(|| item_end(masked, at))
}

/// The first `;` from `at` on outside every bracket; array types such as `[f32; 3]` hold inner ones.
fn item_end(masked: &str, at: usize) -> usize {
    let mut offset = at;
    while let Some(step) = masked[offset..].find([';', '{', '(', '[']) {
        offset += step;
        if masked.as_bytes()[offset] == b';' {
            return offset;
        }
        offset = closing(masked, offset);
    }
    masked.len()
}

/// Spans of the float literals: digits with a point, an exponent or a float suffix.
fn float_literals(masked: &str) -> Vec<Range<usize>> {
    let bytes = masked.as_bytes();
    let mut literals = Vec::new();
    let mut offset = 0;
    while offset < bytes.len() {
        let starts = bytes[offset].is_ascii_digit() && !previous_joins(masked, offset);
        let end = if starts { number_end(bytes, offset) } else { offset + 1 };
        if starts && is_float(&masked[offset..end]) {
            literals.push(offset..end);
        }
        offset = end;
    }
    literals
}

/// Whether the digit at `offset` continues a name (`x1`), a field (`pair.0`) or a number.
fn previous_joins(masked: &str, offset: usize) -> bool {
    let before = &masked[..offset];
    before.ends_with(is_identifier) || (before.ends_with('.') && !before.ends_with(".."))
}

fn number_end(bytes: &[u8], start: usize) -> usize {
    let mut end = start;
    while end < bytes.len() {
        let next = bytes.get(end + 1).copied().unwrap_or(b' ');
        let belongs = match bytes[end] {
            // A range `0..n` and a method call `1.max(n)` are not fractions.
            b'.' => next != b'.' && next != b'_' && !next.is_ascii_alphabetic(),
            b'-' | b'+' => matches!(bytes[end - 1], b'e' | b'E') && next.is_ascii_digit(),
            byte => byte.is_ascii_alphanumeric() || byte == b'_',
        };
        if !belongs {
            break;
        }
        end += 1;
    }
    end
}

fn is_float(number: &str) -> bool {
    let is_prefixed = ["0x", "0b", "0o"].iter().any(|prefix| number.starts_with(prefix));
    let is_integer = ["u", "i"].iter().any(|suffix| number.contains(suffix));
    !is_prefixed && !is_integer && number.contains(['.', 'e', 'E', 'f'])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offenders(text: &str) -> Vec<String> {
        let complaints = check(&Source::new("crates/whitted/src/tree/cost.rs", text));
        complaints.iter().map(|c| c.message.split('`').nth(1).unwrap().to_owned()).collect()
    }

    #[test]
    fn unnamed_floats_are_found() {
        let text =
            "fn f() { a(1.5, 1e-4, 3f32, 2.0, 1.0_f32, 7, 0..3, x.0, 1.max(2), 0x1e3, 12_u32, 4., S { cost: 5.5 }); }";
        assert_eq!(offenders(text), ["1.5", "1e-4", "3f32", "4."]);
    }

    #[test]
    fn constants_and_tests_may_hold_any() {
        assert!(offenders("const A: [f32; 2] = [\n    1.5,\n    2.5,\n];\n").is_empty());
        assert!(offenders("static A: f32 = f(1.5);\nfn f() { const B: f32 = 3.5; }").is_empty());
        assert!(offenders("#[cfg(test)]\nmod tests { fn f() -> f32 { 1.5 } }").is_empty());
        assert!(offenders("const { assert!(A < 1.5) }").is_empty());
        assert_eq!(offenders("const fn f() -> f32 { 1.5 }\nconst A: f32 = 1.5; fn g() { h(2.5); }"), ["1.5", "2.5"]);
    }

    #[test]
    fn const_generics_do_not_hide_a_body() {
        assert_eq!(offenders("fn f<const N: usize>() -> f32 { 1.5 }"), ["1.5"]);
    }

    #[test]
    fn other_folders_are_free() {
        assert!(check(&Source::new("crates/whitted/src/shading/phong.rs", "fn f() { a(1.5); }")).is_empty());
    }
}
