//! Numbers as people read them.

/// Three significant digits, thousands set apart by a thin space; a dash for what is not finite.
pub(crate) fn number(value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    // Rounded before its digits are counted: 9.996 is 10.0.
    let magnitude = |value: f64| value.abs().log10().floor() as i32;
    let scale = 10_f64.powi(2 - magnitude(value));
    let rounded = (value * scale).round() / scale;
    let digits = usize::try_from(2 - magnitude(rounded)).unwrap_or(0).min(MAX_DECIMALS);
    grouped(&format!("{rounded:.digits$}"))
}

/// Decimals after which a number of seconds means nothing.
const MAX_DECIMALS: usize = 6;

/// A whole number, thousands set apart.
pub(crate) fn spaced(count: u64) -> String {
    grouped(&count.to_string())
}

/// A part of one as percent.
pub(crate) fn percent(part: f64) -> String {
    format!("{}\u{202f}%", number(100.0 * part))
}

/// `1 pixel`, `2 pixels`.
pub(crate) fn plural(count: u64, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{} {noun}{ending}", spaced(count))
}

/// With a narrow no-break space between groups of three digits before the point, from five digits on.
fn grouped(text: &str) -> String {
    let (whole, rest) = text.split_at(text.find('.').unwrap_or(text.len()));
    let digits = whole.trim_start_matches('-').len();
    if digits < 5 {
        return text.to_owned();
    }
    let gap = |at: usize| at > 0 && (digits - at).is_multiple_of(3);
    let sign = &whole[..whole.len() - digits];
    let mut out = sign.to_owned();
    for (at, digit) in whole[sign.len()..].chars().enumerate() {
        if gap(at) {
            out.push('\u{202f}');
        }
        out.push(digit);
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_say_enough() {
        for (value, text) in [
            (0.0, "0"),
            (0.012_34, "0.0123"),
            (9.996, "10.0"),
            (0.0999_96, "0.100"),
            (161.49, "161"),
            (1234.0, "1230"),
            (123_456.0, "123\u{202f}000"),
            (-12_345.0, "-12\u{202f}300"),
            (1e-9, "0.000000"),
            (f64::NAN, "–"),
        ] {
            assert_eq!(number(value), text, "{value}");
        }
        assert_eq!(spaced(1_000_000), "1\u{202f}000\u{202f}000");
        assert_eq!((percent(0.005), plural(1, "ray")), ("0.500\u{202f}%".to_owned(), "1 ray".to_owned()));
    }
}
