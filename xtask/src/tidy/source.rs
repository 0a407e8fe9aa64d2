//! A Rust file as the rules see it: its text, the same text with comments and strings blanked, and which lines are tests.

use super::Complaint;
use std::ops::Range;

/// A Rust file prepared for the rules.
pub(super) struct Source<'a> {
    /// Path from the repository's root, with `/`.
    pub(super) path: &'a str,
    /// The file as it is.
    pub(super) text: &'a str,
    /// Same length and lines as `text`; every byte of a comment, string or character literal is a space.
    pub(super) masked: String,
    tests: Vec<Range<usize>>,
}

impl<'a> Source<'a> {
    pub(super) fn new(path: &'a str, text: &'a str) -> Self {
        let masked = mask(text);
        let tests = test_modules(&masked);
        Self { path, text, masked, tests }
    }

    /// Whether the byte at `offset` belongs to tests: a `#[cfg(test)]` module, `tests.rs`, or a `tests` or `benches` folder.
    pub(super) fn is_test(&self, offset: usize) -> bool {
        let in_test_file =
            self.path.split('/').any(|part| matches!(part, "tests" | "benches" | "tests.rs" | "examples"));
        in_test_file || self.tests.iter().any(|range| range.contains(&offset))
    }

    /// Offsets of the identifier `word` in the masked text, whole words only.
    pub(super) fn find_word<'s>(&'s self, word: &'s str) -> impl Iterator<Item = usize> + 's {
        let is_whole = move |offset: usize| {
            let before = self.masked[..offset].chars().next_back();
            let after = self.masked[offset + word.len()..].chars().next();
            !before.is_some_and(is_identifier) && !after.is_some_and(is_identifier)
        };
        self.masked.match_indices(word).map(|(offset, _)| offset).filter(move |&offset| is_whole(offset))
    }

    /// The 1-based line of a byte offset.
    pub(super) fn line(&self, offset: usize) -> usize {
        line_of(self.text, offset)
    }

    pub(super) fn complaint(&self, offset: usize, message: impl Into<String>) -> Complaint {
        Complaint { path: self.path.to_owned(), line: self.line(offset), message: message.into() }
    }
}

/// The 1-based line of a byte offset.
pub(super) fn line_of(text: &str, offset: usize) -> usize {
    text.as_bytes()[..offset].iter().filter(|&&byte| byte == b'\n').count() + 1
}

pub(super) fn is_identifier(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The offset just behind the bracket that closes the one at `open` (`{`, `(` or `[`), or the end of the text.
pub(super) fn closing(masked: &str, open: usize) -> usize {
    let mut depth = 0;
    for (offset, byte) in masked.bytes().enumerate().skip(open) {
        match byte {
            b'{' | b'(' | b'[' => depth += 1,
            b'}' | b')' | b']' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return offset + 1;
        }
    }
    masked.len()
}

fn test_modules(masked: &str) -> Vec<Range<usize>> {
    let marks = masked.match_indices("#[cfg(test)]").map(|(offset, _)| offset);
    marks
        .filter_map(|start| {
            let open = start + masked[start..].find(['{', ';'])?;
            (masked.as_bytes()[open] == b'{').then(|| start..closing(masked, open))
        })
        .collect()
}

/// Replaces comments, strings and character literals by spaces, keeping every offset and line break.
fn mask(text: &str) -> String {
    let mut masked = text.as_bytes().to_vec();
    let mut offset = 0;
    while offset < masked.len() {
        let length = hidden_length(&text.as_bytes()[offset..], offset > 0 && is_word_byte(masked[offset - 1]));
        for byte in &mut masked[offset..offset + length] {
            if *byte != b'\n' {
                *byte = b' ';
            }
        }
        offset += length.max(1);
    }
    // Only whole literals and comments were overwritten, each with ASCII.
    String::from_utf8(masked).expect("masking keeps UTF-8")
}

fn is_word_byte(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Length of the comment or literal that `rest` starts with; 0 if it starts with code.
fn hidden_length(rest: &[u8], after_word: bool) -> usize {
    match rest {
        [b'/', b'/', ..] => rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len()),
        [b'/', b'*', ..] => block_comment_length(rest),
        [b'"', ..] => string_length(rest),
        [b'\'', ..] => character_length(rest),
        [b'r', b'"' | b'#', ..] if !after_word => raw_string_length(rest, 1),
        [b'b' | b'c', b'r', b'"' | b'#', ..] if !after_word => raw_string_length(rest, 2),
        _ => 0,
    }
}

fn block_comment_length(rest: &[u8]) -> usize {
    let (mut depth, mut offset) = (0, 0);
    while offset < rest.len() {
        match &rest[offset..] {
            [b'/', b'*', ..] => (depth, offset) = (depth + 1, offset + 2),
            [b'*', b'/', ..] => (depth, offset) = (depth - 1, offset + 2),
            _ => offset += 1,
        }
        if depth == 0 {
            return offset;
        }
    }
    rest.len()
}

fn string_length(rest: &[u8]) -> usize {
    let mut offset = 1;
    while offset < rest.len() {
        match rest[offset] {
            b'\\' => offset += 2,
            b'"' => return offset + 1,
            _ => offset += 1,
        }
    }
    rest.len()
}

/// A raw string after a prefix of `prefix` bytes; 0 for a raw identifier such as `r#type`.
fn raw_string_length(rest: &[u8], prefix: usize) -> usize {
    let hashes = rest[prefix..].iter().take_while(|&&byte| byte == b'#').count();
    if rest.get(prefix + hashes) != Some(&b'"') {
        return 0;
    }
    let end: Vec<u8> = std::iter::once(b'"').chain(std::iter::repeat_n(b'#', hashes)).collect();
    let body = prefix + hashes + 1;
    rest[body..].windows(end.len()).position(|window| window == end).map_or(rest.len(), |at| body + at + end.len())
}

/// A character literal; 0 for a lifetime or a loop label.
fn character_length(rest: &[u8]) -> usize {
    if rest.get(1) == Some(&b'\\') {
        return rest[2..].iter().skip(1).position(|&byte| byte == b'\'').map_or(rest.len(), |at| at + 4);
    }
    let character = std::str::from_utf8(&rest[1..rest.len().min(5)]).map_or_else(
        |error| std::str::from_utf8(&rest[1..1 + error.valid_up_to()]).ok().and_then(|s| s.chars().next()),
        |s| s.chars().next(),
    );
    match character {
        Some(c) if rest.get(1 + c.len_utf8()) == Some(&b'\'') => c.len_utf8() + 2,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_comments_and_literals_but_not_code() {
        for (text, expected) in [
            ("a // b\nc", "a     \nc"),
            ("a /* b /* c */ d */ e", "a                   e"),
            (r#"f("un\"safe", x)"#, "f(          , x)"),
            (r##"f(r#"a"b"#, x)"##, "f(        , x)"),
            ("fn f<'a>(x: &'a str) {}", "fn f<'a>(x: &'a str) {}"),
            ("['{', '\\'', '\\u{7f}', 'é']", "[   ,     ,         ,     ]"),
            ("r#type + br", "r#type + br"),
            ("\"open", "     "),
            ("'label: loop {}", "'label: loop {}"),
        ] {
            assert_eq!(mask(text), expected, "{text}");
        }
    }

    #[test]
    fn finds_whole_words_outside_strings() {
        let source = Source::new("a.rs", "unsafe_code \"unsafe\" unsafe {} // unsafe");
        assert_eq!(source.find_word("unsafe").collect::<Vec<_>>(), [21]);
    }

    #[test]
    fn knows_test_modules_and_test_files() {
        let source = Source::new("src/a.rs", "fn a() {}\n#[cfg(test)]\nmod tests {\n    fn b() {}\n}\nfn c() {}\n");
        let is_test = |needle: &str| source.is_test(source.text.find(needle).unwrap());
        assert!(!is_test("fn a") && is_test("fn b") && !is_test("fn c"));
        assert!(Source::new("crates/x/tests/a.rs", "fn a() {}").is_test(0));
    }
}
