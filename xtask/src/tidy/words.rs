//! Words that must not be committed: paths of one machine and hosts of package registries.

use super::Complaint;
use super::source::line_of;

/// Split so that this file passes its own rule.
const FORBIDDEN: &[(&str, &str)] = &[
    (concat!("/wo", "rk/"), "a path of one machine: find data by an environment variable"),
    (concat!("/ro", "ot/"), "a path of one machine: find data by an environment variable"),
    (concat!("/ho", "me/"), "a path of one machine: find data by an environment variable"),
    (concat!("pypi.", "org"), "a registry's host: name the package only"),
    (concat!("npmjs.", "org"), "a registry's host: name the package only"),
    (concat!("static.crates.", "io"), "a registry's host: name the package only"),
    (concat!("index.crates.", "io"), "a registry's host: name the package only"),
];

/// The only place a lock file may name: cargo's own name for its default registry, whatever mirror served it.
const DEFAULT_REGISTRY: &str = "source = \"registry+https://github.com/rust-lang/crates.io-index\"";

pub(super) fn check(path: &str, text: &str) -> Vec<Complaint> {
    let complaint = |line, message: String| Complaint { path: path.to_owned(), line, message };
    let mut complaints = Vec::new();
    for (word, why) in FORBIDDEN {
        let found = text.match_indices(word).filter(|(at, _)| !continues_a_path(text, *at));
        complaints.extend(found.map(|(at, _)| complaint(line_of(text, at), format!("`{word}`: {why}"))));
    }
    if path.ends_with("Cargo.lock") {
        let strange = |line: &str| line.starts_with("source = ") && line != DEFAULT_REGISTRY;
        let strange = text.lines().enumerate().filter(|(_, line)| strange(line));
        complaints.extend(strange.map(|(i, _)| complaint(i + 1, "not the default registry".to_owned())));
    }
    complaints
}

/// Whether the match is the middle of a longer relative path, such as `frame` followed by the word.
fn continues_a_path(text: &str, at: usize) -> bool {
    text[at..].starts_with('/')
        && text[..at].ends_with(|c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '}'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn machine_paths_are_refused_anywhere() {
        let text = format!("fine\nsee {}wo{}/main\nand net/wo{}/x\n", '/', "rk", "rk");
        let lines: Vec<usize> = check("docs/a.md", &text).iter().map(|complaint| complaint.line).collect();
        assert_eq!(lines, [2]);
    }

    #[test]
    fn lock_files_name_the_default_registry_only() {
        let text = format!("{DEFAULT_REGISTRY}\nsource = \"registry+https://mirror.example/index\"\n");
        let lines: Vec<usize> = check("Cargo.lock", &text).iter().map(|complaint| complaint.line).collect();
        assert_eq!(lines, [2]);
    }
}
