//! What the report says about the program itself: its compiler, its target, its commit.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    tell("WHITTED_RUSTC", first_line(&rustc, &["--version"]));
    tell("WHITTED_TARGET", std::env::var("TARGET").ok());
    tell("WHITTED_OPT_LEVEL", std::env::var("OPT_LEVEL").ok());
    tell("WHITTED_COMMIT", commit());
}

/// Sets a variable for `option_env!`, if its value is known.
fn tell(name: &str, value: Option<String>) {
    if let Some(value) = value {
        println!("cargo::rustc-env={name}={value}");
    }
}

/// The commit from which this is built. None where this file is not one of the repository's: an unpacked package may
/// lie inside somebody else's.
fn commit() -> Option<String> {
    first_line("git", &["ls-files", "--error-unmatch", "build.rs"])?;
    // Grows whenever another commit is checked out.
    let log = first_line("git", &["rev-parse", "--git-path", "logs/HEAD"])?;
    println!("cargo::rerun-if-changed={log}");
    first_line("git", &["rev-parse", "--short=10", "HEAD"])
}

fn first_line(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?;
    text.lines().next().map(str::to_owned)
}
