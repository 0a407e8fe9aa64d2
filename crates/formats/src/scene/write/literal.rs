//! Values as TOML writes them.

use whitted::math::{Vec3d, Vec3f};

/// A number, with as few digits as tell it from others; it is finite.
pub(super) fn number(value: f64) -> String {
    // The debug form has a point or an exponent: without one, TOML would read an integer, which has a largest value and
    // no negative zero.
    let text = format!("{value:?}");
    match text.strip_suffix(".0") {
        Some(whole) if whole != "-0" => whole.to_owned(),
        _ => text,
    }
}

/// A single-precision number, with as few digits as make the reader find it.
pub(super) fn single(value: f32) -> String {
    let short: f64 = value.to_string().parse().unwrap_or(f64::from(value));
    // Rounding twice may miss by one.
    number(if short as f32 == value { short } else { f64::from(value) })
}

/// A point or direction.
pub(super) fn point(point: Vec3d) -> String {
    list(point.to_array().map(number))
}

/// A linear colour.
pub(super) fn color(color: Vec3f) -> String {
    list(color.to_array().map(single))
}

/// A strength: one number if its components are equal.
pub(super) fn strength(strength: Vec3f) -> String {
    let all_alike = strength == Vec3f::splat(strength.x);
    if all_alike { single(strength.x) } else { color(strength) }
}

/// A word of the format, which has nothing to escape.
pub(super) fn word(word: &str) -> String {
    format!("\"{word}\"")
}

/// A key: bare if TOML allows that, else in quotes.
pub(super) fn key(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(is_bare) {
        return name.to_owned();
    }
    let escaped = name.chars().map(|c| match c {
        '"' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\u{:04X}", u32::from(c)),
        c => c.to_string(),
    });
    format!("\"{}\"", escaped.collect::<String>())
}

/// A list of values.
pub(super) fn list<const N: usize>(values: [String; N]) -> String {
    format!("[{}]", values.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        for (value, text) in
            [(1.0, "1"), (-2.0, "-2"), (0.1, "0.1"), (1e20, "1e20"), (1e-7, "1e-7"), (-0.0, "-0.0"), (0.0, "0")]
        {
            assert_eq!(number(value), text);
        }
        assert_eq!(
            (single(0.1), single(16_777_216.0), strength(Vec3f::splat(0.3))),
            ("0.1".into(), "16777216".into(), "0.3".into())
        );
        assert_eq!(color(Vec3f::new(0.5, 1.0, 0.25)), "[0.5, 1, 0.25]");
    }

    #[test]
    fn keys_are_quoted_where_they_must_be() {
        for (name, text) in [("a-B_9", "a-B_9"), ("", "\"\""), ("a b", "\"a b\""), ("\"\\\n", r#""\"\\\u000A""#)] {
            assert_eq!(key(name), text);
        }
    }
}
