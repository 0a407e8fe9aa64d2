//! Options of `whitted paper`.

use super::parse_threads;
use ::paper::Experiment;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;

/// What a run of the experiments leaves, shown below the help of `paper`.
pub(super) const HELP: &str = "\
Ctrl-C ends the run and leaves a report of what was measured until then.

Exit codes: 0 done, 1 a file could not be written or a variant computed another picture than the default, 2 wrong usage, \
130 interrupted.";

#[derive(Debug, Args)]
pub(crate) struct PaperArguments {
    /// Folder for the report: report.html, the same as .md, .csv and .json, and figures/
    #[arg(short, long, value_name = "DIR", default_value = "paper-report")]
    pub(crate) output: PathBuf,
    /// Take a minute instead of a quarter of an hour: smaller pictures, fewer scenes, fewer rounds
    #[arg(long)]
    pub(crate) quick: bool,
    /// Only these experiments
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = experiments())]
    pub(crate) only: Vec<Experiment>,
    /// Threads of the rows that use several [default: one per core]
    #[arg(short, long, value_name = "N", value_parser = parse_threads)]
    pub(crate) threads: Option<usize>,
    /// Show errors only
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// The experiments by name.
fn experiments() -> impl TypedValueParser<Value = Experiment> {
    let names = PossibleValuesParser::new(Experiment::ALL.map(Experiment::name));
    names.try_map(|name| Experiment::by_name(&name).ok_or("is no experiment"))
}
