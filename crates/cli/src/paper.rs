//! `whitted paper`: the paper's experiments, repeated, and the folder with their report.

use crate::args::PaperArguments;
use crate::exit::Failure;
use crate::interrupt;
use crate::output::Target;
use crate::progress::Display;
use paper::report::{Ending, File, Report};
use paper::{Effort, Experiment, Plan};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Where figures lie in the folder.
const FIGURES: &str = "figures";

pub(crate) fn run(arguments: &PaperArguments) -> Result<(), Failure> {
    let folder = Folder::prepare(&arguments.output)?;
    let cancel = interrupt::install();
    let display = Display::for_steps(arguments.quiet);
    let report = paper::run(&plan(arguments), &display, cancel);
    display.finish();
    let report = report.map_err(|error| Failure::Io(error.to_string()))?;
    folder.write(&report.files())?;
    end(&report, &folder, arguments.quiet)
}

fn plan(arguments: &PaperArguments) -> Plan {
    let effort = if arguments.quick { Effort::quick() } else { Effort::full() };
    let effort = Effort { threads: arguments.threads.unwrap_or(effort.threads), ..effort };
    let wanted = |experiment: &Experiment| arguments.only.is_empty() || arguments.only.contains(experiment);
    Plan { experiments: Experiment::ALL.into_iter().filter(wanted).collect(), effort }
}

/// Says where the report is, or what was wrong.
fn end(report: &Report, folder: &Folder, quiet: bool) -> Result<(), Failure> {
    let page = folder.path.join("report.html");
    match report.ending {
        Ending::Complete if quiet => Ok(()),
        Ending::Complete => {
            eprintln!("wrote '{}' in {:.0} s", page.display(), report.head.seconds);
            Ok(())
        }
        Ending::Interrupted => Err(Failure::InterruptedAfter(format!("what was measured is in '{}'", page.display()))),
        Ending::Wrong => Err(Failure::Wrong(wrong(report, &page))),
    }
}

/// The variants that computed something else, a line each.
fn wrong(report: &Report, page: &Path) -> String {
    let line = |check: &paper::Check| {
        let paper::Check { variant, scene, pixels, differing, allowed, .. } = check;
        format!("\n  {variant}, {scene}: {differing} of {pixels} pixels differ, {allowed} may")
    };
    let lines: String = report.checks.iter().filter(|check| !check.holds()).map(line).collect();
    format!("not every variant computed the same picture, see '{}':{lines}", page.display())
}

/// The folder of a report.
struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes the folder, unless it is there, and checks that it can be written into: what is measured for minutes shall
    /// not be lost.
    fn prepare(path: &Path) -> Result<Self, Failure> {
        make(path)?;
        make(&path.join(FIGURES))?;
        let folder = Self { path: path.to_owned() };
        for name in ["report.html", "report.md", "report.csv", "report.json"] {
            Target::check(&folder.path.join(name))?;
        }
        Target::check(&folder.path.join(FIGURES).join("figure1.svg"))?;
        Ok(folder)
    }

    fn write(&self, files: &[File]) -> Result<(), Failure> {
        files.iter().try_for_each(|file| Target::check(&self.path.join(&file.path))?.write(&file.bytes))
    }
}

fn make(path: &Path) -> Result<(), Failure> {
    match fs::create_dir(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists && path.is_dir() => Ok(()),
        Err(error) => {
            let reason = match error.kind() {
                ErrorKind::AlreadyExists => "it is a file, not a folder".to_owned(),
                ErrorKind::NotFound => "the folder in which it should lie is not there".to_owned(),
                _ => error.to_string(),
            };
            Err(Failure::Io(format!("cannot make the folder '{}': {reason}", path.display())))
        }
        Ok(()) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitted::render::Cancel;

    /// A report of nothing that ended like this.
    fn report(ending: Ending) -> Report {
        let plan = Plan { experiments: Vec::new(), effort: Effort::quick() };
        let nothing = paper::run(&plan, &Display::for_steps(true), &Cancel::new()).unwrap();
        let check = paper::Check {
            variant: "grid, SSE".into(),
            of_paper: true,
            scene: "mix-10".into(),
            pixels: 100,
            differing: 3,
            largest: 1.0,
            allowed: 2,
        };
        Report { ending, checks: vec![check], ..nothing }
    }

    #[test]
    fn a_variant_that_computes_something_else_fails_the_run() {
        let folder = Folder { path: "out".into() };
        let Err(Failure::Wrong(text)) = end(&report(Ending::Wrong), &folder, true) else { panic!("it is wrong") };
        assert!(text.contains("grid, SSE, mix-10: 3 of 100 pixels differ, 2 may"), "{text}");
        assert!(text.contains("report.html"), "{text}");
        assert!(matches!(end(&report(Ending::Interrupted), &folder, true), Err(Failure::InterruptedAfter(_))));
        assert_eq!(end(&report(Ending::Complete), &folder, true), Ok(()));
    }
}
