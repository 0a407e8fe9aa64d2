//! The long form of the test that every tree, walk and instruction set finds the hits of brute force, to the bit.

use crate::root;
use std::process::{Command, ExitCode};

/// Ray walks that the project asks for once before a release.
pub(crate) const RAYS: &str = "100000000";

/// Runs the test with this many ray walks in all.
pub(crate) fn run(rays: &str) -> ExitCode {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["test", "--release", "--package", "whitted", "--test", "hits", "--", "--nocapture"];
    let status = Command::new(cargo).args(arguments).env("WHITTED_RAYS", rays).current_dir(root()).status();
    match status {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("xtask: cannot start cargo: {error}");
            ExitCode::FAILURE
        }
    }
}
