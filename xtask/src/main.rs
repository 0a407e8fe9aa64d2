//! Project automation, run as `cargo xtask COMMAND`.
//!
//! `ci` is everything that must pass before a change lands, and exactly what the CI runs; each of its steps also runs
//! alone by its name. It knows cargo and the repository's text; it does not know what the program computes.

mod ci;
mod hits;
mod tidy;

use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["ci"] => ci::run_all(),
        ["hits"] => hits::run(hits::RAYS),
        ["hits", rays] => hits::run(rays),
        [name] => ci::run_one(name).unwrap_or_else(usage),
        _ => usage(),
    }
}

fn usage() -> ExitCode {
    eprintln!("usage: cargo xtask COMMAND\n\n  {:<8} every step below, in this order", "ci");
    for step in ci::STEPS {
        eprintln!("  {:<8} {}", step.name, step.purpose);
    }
    eprintln!("\n  {:<8} compares N rays [default: {}] of every tree and walk with brute force", "hits N", hits::RAYS);
    ExitCode::from(2)
}

/// The repository's root: the folder above this package.
fn root() -> PathBuf {
    // At run time, so that a build folder shared between checkouts never checks the wrong one.
    let package = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    PathBuf::from(package).parent().expect("xtask lies inside the repository").to_path_buf()
}
