//! Lengths of files and functions.

use super::Complaint;
use super::source::{Source, closing, line_of};

const MAX_FILE_LINES: usize = 500;
const MAX_FUNCTION_LINES: usize = 80;

/// The comment that permits a longer function; what follows it is the reason why it is one piece.
const EXCUSE: &str = "// long:";

pub(super) fn check(source: &Source) -> Vec<Complaint> {
    let mut complaints = Vec::new();
    let lines = source.text.lines().count();
    if lines > MAX_FILE_LINES {
        complaints
            .push(source.complaint(0, format!("{lines} lines, at most {MAX_FILE_LINES}: one noun a file, split it")));
    }
    complaints.extend(source.find_word("fn").filter_map(|at| check_function(source, at)));
    complaints
}

fn check_function(source: &Source, at: usize) -> Option<Complaint> {
    let masked = &source.masked;
    // A declaration or a function type ends before any body opens.
    let open = at + masked[at..].find(['{', ';', ','])?;
    let open = if masked.as_bytes()[open] == b',' { body_after_parameters(masked, at)? } else { open };
    if masked.as_bytes()[open] != b'{' {
        return None;
    }
    let lines = source.line(closing(masked, open) - 1) - source.line(at) + 1;
    let excused = lines <= MAX_FUNCTION_LINES || has_excuse(source.text, at);
    (!excused).then(|| {
        let message = format!(
            "function of {lines} lines, at most {MAX_FUNCTION_LINES}: split it, or say `{EXCUSE} why it is one piece` above it"
        );
        source.complaint(at, message)
    })
}

/// The body's `{` (or the `;`) behind the parameter list of the function whose `fn` is at `at`.
fn body_after_parameters(masked: &str, at: usize) -> Option<usize> {
    let parameters = at + masked[at..].find('(')?;
    let end = closing(masked, parameters);
    Some(end + masked[end..].find(['{', ';'])?)
}

/// Whether the comments and attributes directly above the function contain the excuse with a reason.
fn has_excuse(text: &str, at: usize) -> bool {
    let above = line_of(text, at) - 1;
    let lines: Vec<&str> = text.lines().take(above).collect();
    let attached = lines
        .iter()
        .rev()
        .map(|line| line.trim())
        .take_while(|line| line.starts_with("//") || line.starts_with("#[") || line.ends_with(")]"));
    attached.into_iter().any(|line| line.strip_prefix(EXCUSE).is_some_and(|reason| !reason.trim().is_empty()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn function(above: &str, body_lines: usize) -> String {
        format!("{above}fn f<const N: usize>(a: u8, b: [u8; 2]) {{\n{}}}\n", "    x();\n".repeat(body_lines))
    }

    fn count(text: &str) -> usize {
        check(&Source::new("a.rs", text)).len()
    }

    #[test]
    fn long_functions_need_a_reason() {
        assert_eq!(count(&function("", 78)), 0);
        assert_eq!(count(&function("", 79)), 1);
        assert_eq!(count(&function("// long: one table of cases.\n#[inline]\n", 200)), 0);
        assert_eq!(count(&function("// long:\n", 200)), 1);
        assert_eq!(count(&function("// long: not attached.\nstatic X: u8 = 1;\n", 200)), 1);
    }

    #[test]
    fn declarations_and_function_types_have_no_body() {
        assert_eq!(
            count(&format!("trait T {{ fn f(a: u8, b: u8); }}\nstruct S {{ f: fn(u8), }}\n{}", "\n".repeat(100))),
            0
        );
    }

    #[test]
    fn long_files_are_refused() {
        assert_eq!(count(&"//\n".repeat(500)), 0);
        assert_eq!(count(&"//\n".repeat(501)), 1);
    }
}
