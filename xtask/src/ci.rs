//! The steps that must pass before a change lands.

use crate::{root, tidy};
use std::process::{Command, ExitCode};
use std::time::Instant;

/// One check: a command of cargo's, or a function of this program.
pub(crate) struct Step {
    pub(crate) name: &'static str,
    pub(crate) purpose: &'static str,
    action: Action,
}

enum Action {
    /// Arguments for cargo and one environment variable for it.
    Cargo(&'static [&'static str], Option<(&'static str, &'static str)>),
    /// Returns the complaints, each `file:line: what and what instead`.
    Check(fn(&std::path::Path) -> std::io::Result<Vec<tidy::Complaint>>),
}

/// All steps, cheapest first where that is possible.
pub(crate) const STEPS: &[Step] = &[
    Step { name: "tidy", purpose: "layers, where `unsafe` may be, lengths, words", action: Action::Check(tidy::check) },
    Step { name: "fmt", purpose: "formatting", action: Action::Cargo(&["fmt", "--all", "--check"], None) },
    Step {
        name: "clippy",
        purpose: "lints, warnings are errors",
        action: Action::Cargo(&["clippy", "--locked", "--workspace", "--all-targets", "--", "-D", "warnings"], None),
    },
    Step {
        name: "doc",
        purpose: "documentation, warnings are errors",
        action: Action::Cargo(&["doc", "--workspace", "--no-deps"], Some(("RUSTDOCFLAGS", "-D warnings"))),
    },
    // The README gives this command to every reader: the CI must run the very same.
    Step { name: "test", purpose: "all tests", action: Action::Cargo(&["test", "--workspace"], None) },
    // By themselves: without them nobody compiles a window system to test a ray tracer.
    Step {
        name: "viewer-clippy",
        purpose: "lints of the window and its panels",
        action: Action::Cargo(
            &[
                "clippy",
                "--locked",
                "-p=whitted-viewer",
                "-p=whitted-cli",
                "--features=whitted-cli/viewer",
                "--all-targets",
                "--",
                "-D",
                "warnings",
            ],
            None,
        ),
    },
    Step {
        name: "viewer",
        purpose: "tests of the window with real mouse and keys (needs Xvfb, xdotool and ImageMagick)",
        action: Action::Cargo(
            &["test", "-p=whitted-viewer", "-p=whitted-cli", "--features=whitted-cli/viewer", "--lib", "--test=viewer"],
            None,
        ),
    },
    Step {
        name: "deny",
        purpose: "licences and duplicates of dependencies (needs cargo-deny)",
        action: Action::Cargo(&["deny", "check", "licenses", "bans"], None),
    },
];

/// Runs every step, stopping at the first that fails.
pub(crate) fn run_all() -> ExitCode {
    for step in STEPS {
        if !run(step) {
            eprintln!("xtask: `cargo xtask {}` failed", step.name);
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// Runs the step of this name; `None` if there is none.
pub(crate) fn run_one(name: &str) -> Option<ExitCode> {
    let step = STEPS.iter().find(|step| step.name == name)?;
    Some(if run(step) { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn run(step: &Step) -> bool {
    let start = Instant::now();
    let passed = match &step.action {
        Action::Cargo(arguments, variable) => run_cargo(arguments, *variable),
        Action::Check(check) => run_check(step.name, *check),
    };
    eprintln!(
        "xtask: {} {} in {:.1} s",
        step.name,
        if passed { "ok" } else { "FAILED" },
        start.elapsed().as_secs_f64()
    );
    passed
}

fn run_cargo(arguments: &[&str], variable: Option<(&str, &str)>) -> bool {
    eprintln!(
        "xtask: {}cargo {}",
        variable.map_or(String::new(), |(k, v)| format!("{k}=\"{v}\" ")),
        arguments.join(" ")
    );
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo).args(arguments).envs(variable).current_dir(root()).status();
    match status {
        Ok(status) => status.success(),
        Err(error) => {
            eprintln!("xtask: cannot start cargo: {error}");
            false
        }
    }
}

fn run_check(name: &str, check: fn(&std::path::Path) -> std::io::Result<Vec<tidy::Complaint>>) -> bool {
    eprintln!("xtask: {name}");
    match check(&root()) {
        Ok(complaints) => {
            complaints.iter().for_each(|complaint| eprintln!("{complaint}"));
            complaints.is_empty()
        }
        Err(error) => {
            eprintln!("xtask: cannot read the repository: {error}");
            false
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_readme_names_the_test_command() {
        let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
        let test = STEPS.iter().find(|step| step.name == "test").unwrap();
        let Action::Cargo(arguments, _) = &test.action else { panic!("the tests are run by cargo") };
        assert!(readme.contains(&format!("```sh\ncargo {}\n```", arguments.join(" "))));
    }
}
