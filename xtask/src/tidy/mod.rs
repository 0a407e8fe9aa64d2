//! Rules about the repository's text that neither the compiler nor clippy can check.
//!
//! Each rule is a function from one [`Source`] (or one text) to [`Complaint`]s. The rules read masked text, in which
//! comments and strings are blank, so that a word in a comment never counts as code.

mod confined;
mod layers;
mod lengths;
mod literals;
mod source;
mod words;

use source::Source;
use std::fmt;
use std::path::Path;
use std::process::Command;

/// One broken rule, shown as `file:line: message`.
#[derive(Debug, PartialEq)]
pub(crate) struct Complaint {
    path: String,
    line: usize,
    message: String,
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.path, self.line, self.message)
    }
}

/// Applies every rule to every file of the working tree that git would track.
pub(crate) fn check(root: &Path) -> std::io::Result<Vec<Complaint>> {
    let mut complaints = Vec::new();
    for path in tracked_files(root)? {
        // A file deleted but not yet committed, or one that is not text, has nothing to check.
        let Ok(text) = std::fs::read_to_string(root.join(&path)) else { continue };
        complaints.extend(check_file(&path, &text));
    }
    Ok(complaints)
}

fn check_file(path: &str, text: &str) -> Vec<Complaint> {
    let mut complaints = words::check(path, text);
    if path.ends_with("Cargo.toml") {
        complaints.extend(layers::check_manifest(path, text));
    }
    if path.ends_with(".rs") {
        let source = Source::new(path, text);
        for rule in [confined::check, layers::check, lengths::check, literals::check] {
            complaints.extend(rule(&source));
        }
    }
    complaints
}

fn tracked_files(root: &Path) -> std::io::Result<Vec<String>> {
    let listing = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard"])
        .current_dir(root)
        .output()?;
    if !listing.status.success() {
        return Err(std::io::Error::other(String::from_utf8_lossy(&listing.stderr).into_owned()));
    }
    let mut files: Vec<String> = String::from_utf8_lossy(&listing.stdout).lines().map(str::to_owned).collect();
    files.sort();
    files.dedup();
    Ok(files)
}
