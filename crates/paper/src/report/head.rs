//! Where and how a report was measured.

use crate::{Effort, machine, published};
use serde::Serialize;

/// What stands at the head of a report.
#[derive(Clone, Debug, Serialize)]
pub struct Head {
    /// Day of the run, UTC.
    pub date: String,
    /// Name of the CPU.
    pub cpu: String,
    /// Cores that this process may use.
    pub cores: usize,
    /// Instruction sets that were found.
    pub levels: Vec<&'static str>,
    /// The compiler, its target and its optimisation level.
    pub compiler: String,
    /// Version of the program.
    pub version: &'static str,
    /// The commit it was built from, if known.
    pub commit: Option<&'static str>,
    /// Full or quick, and what that means.
    pub effort: String,
    /// What all pictures have in common.
    pub settings: String,
    /// How times are taken.
    pub clock: &'static str,
    /// The load of the machine at the start, averaged over a minute; where the system tells.
    pub load: Option<f64>,
    /// Seconds that the whole run took, by the clock on the wall.
    pub seconds: f64,
    /// False if the program was built without optimisation: then the times mean nothing.
    pub optimised: bool,
}

/// How times are taken.
const CLOCK: &str = "CPU time of the busiest thread, so that other programs on the machine hardly count; all variants \
    of a scene in turn, round after round; medians, with the lowest and the highest";

impl Head {
    /// Asks the machine.
    pub(crate) fn new(effort: &Effort) -> Self {
        let known = |value: Option<&'static str>| value.unwrap_or("unknown");
        let (rustc, target) = (known(option_env!("WHITTED_RUSTC")), known(option_env!("WHITTED_TARGET")));
        let level = known(option_env!("WHITTED_OPT_LEVEL"));
        Self {
            date: machine::date(),
            cpu: machine::cpu(),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            levels: simd::Level::available().iter().map(|level| level.name()).collect(),
            compiler: format!("{rustc}, {target}, optimisation {level}"),
            version: env!("CARGO_PKG_VERSION"),
            commit: option_env!("WHITTED_COMMIT"),
            effort: words(effort),
            settings: settings(effort),
            clock: CLOCK,
            load: machine::load(),
            seconds: 0.0,
            optimised: !cfg!(debug_assertions),
        }
    }

    /// The rows of the head: what, and its value.
    pub(crate) fn rows(&self) -> Vec<(&'static str, String)> {
        let load = self.load.map_or(String::new(), |load| format!(", load {load:.1} at the start"));
        let commit = self.commit.map_or("unknown commit".to_owned(), |commit| format!("commit {commit}"));
        vec![
            ("Machine", format!("{}, {} cores{load}", self.cpu, self.cores)),
            ("Instruction sets", self.levels.join(", ")),
            ("Program", format!("whitted {}, {commit}", self.version)),
            ("Compiler", self.compiler.clone()),
            ("Run", format!("{}, {}, in {:.0} s", self.date, self.effort, self.seconds)),
            ("Times", self.clock.to_owned()),
            ("Pictures", self.settings.clone()),
            ("The paper", format!("{}; {}", published::CITATION, published::MACHINE)),
        ]
    }
}

fn words(effort: &Effort) -> String {
    let Effort { name, rounds, seconds, threads, .. } = effort;
    format!("{name}, {rounds} rounds, about {seconds} s for each round of each cell, {threads} threads where several")
}

fn settings(effort: &Effort) -> String {
    let [width, height] = effort.size;
    format!(
        "{width} × {height}, one sample a pixel, five generations of secondary rays, none below a weight of 1/255, two \
         point lights, opaque shadows; spheres fill 12 % of a cube: \"mix\" is half matte, a quarter mirror and a quarter \
         glass, in \"all4\" each sphere is diffuse, specular, reflecting and refracting at once"
    )
}
