//! A run: the experiments one after the other, what they all need, and how the run ends.

use crate::measure::{Check, Threads};
use crate::report::{Ending, Head, Report, Section};
use crate::{Effort, Experiment, Plan};
use std::cell::{Cell, RefCell};
use std::time::Instant;
use whitted::render::{Cancel, Cancelled};

/// Is told how far the run is.
pub trait Watch {
    /// `part` of the work is done (0 to 1, never less than before); `what` is being measured.
    fn at(&self, part: f64, what: &str);
}

/// Why a run could not begin.
#[derive(Debug)]
pub struct NoThreads(rayon::ThreadPoolBuildError);

impl std::fmt::Display for NoThreads {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "cannot start threads: {}", self.0)
    }
}

impl std::error::Error for NoThreads {}

/// What the experiments of a run share.
pub(crate) struct Session<'a> {
    pub(crate) effort: &'a Effort,
    pub(crate) cancel: &'a Cancel,
    /// A single one: for all that is compared with the paper.
    pub(crate) one: Threads,
    pub(crate) several: Threads,
    watch: &'a dyn Watch,
    /// Parts of the whole run at which the present experiment began, and that it takes.
    span: Cell<(f64, f64)>,
    checks: RefCell<Vec<Check>>,
}

impl<'a> Session<'a> {
    /// # Errors
    /// If the system gives no threads.
    pub(crate) fn new(effort: &'a Effort, watch: &'a dyn Watch, cancel: &'a Cancel) -> Result<Self, NoThreads> {
        let threads = |count| Threads::new(count).map_err(NoThreads);
        let (one, several) = (threads(1)?, threads(effort.threads)?);
        let (span, checks) = (Cell::default(), RefCell::default());
        Ok(Self { effort, cancel, one, several, watch, span, checks })
    }

    /// Tells how far the present experiment is (0 to 1), and ends it if the user wants.
    pub(crate) fn at(&self, part: f64, what: &str) -> Result<(), Cancelled> {
        let (start, length) = self.span.get();
        self.watch.at(start + length * part.clamp(0.0, 1.0), what);
        self.go_on()
    }

    /// Ends the experiment if the user wants.
    pub(crate) fn go_on(&self) -> Result<(), Cancelled> {
        if self.cancel.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Remembers what a variant computed. Parts of one picture are put together.
    pub(crate) fn checked(&self, check: Check) {
        let mut checks = self.checks.borrow_mut();
        match checks.iter_mut().find(|known| known.variant == check.variant && known.scene == check.scene) {
            Some(known) => known.add(&check),
            None => checks.push(check),
        }
    }

    /// Looks at what was computed so far.
    pub(crate) fn checks(&self) -> Vec<Check> {
        self.checks.borrow().clone()
    }
}

/// Measures everything in `plan`. Once `cancel` is set the run ends soon, with a report of what was measured until then.
///
/// # Errors
/// If the system gives no threads.
pub fn run(plan: &Plan, watch: &dyn Watch, cancel: &Cancel) -> Result<Report, NoThreads> {
    let start = Instant::now();
    let mut head = Head::new(&plan.effort);
    let session = Session::new(&plan.effort, watch, cancel)?;
    let mut sections = Vec::new();
    let whole: f64 = plan.experiments.iter().map(|experiment| experiment.weight(&plan.effort)).sum();
    for &experiment in &plan.experiments {
        let (begun, taken) = session.span.get();
        session.span.set((begun + taken, experiment.weight(&plan.effort) / whole));
        let section = section(&session, experiment);
        let complete = section.complete;
        sections.push(section);
        if !complete {
            break;
        }
    }
    let checks = session.checks.into_inner();
    let ending = ending(&sections, &checks);
    head.seconds = start.elapsed().as_secs_f64();
    Ok(Report { head, ending, sections, checks })
}

/// What is wrong comes before what is missing.
fn ending(sections: &[Section], checks: &[Check]) -> Ending {
    match sections.iter().all(|section| section.complete) {
        _ if checks.iter().any(|check| !check.holds()) => Ending::Wrong,
        true => Ending::Complete,
        false => Ending::Interrupted,
    }
}

fn section(session: &Session, experiment: Experiment) -> Section {
    let mut section = Section::new(experiment);
    section.complete = (experiment.run())(session, &mut section).is_ok();
    section
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_comes_before_what_is_missing() {
        let section = |complete| Section { complete, ..Section::new(Experiment::Table1) };
        let check = |differing| Check {
            variant: "grid".into(),
            of_paper: true,
            scene: "mix-10".into(),
            pixels: 10,
            differing,
            largest: 1.0,
            allowed: 0,
        };
        assert_eq!(ending(&[section(true)], &[check(0)]), Ending::Complete);
        assert_eq!(ending(&[section(true), section(false)], &[check(0)]), Ending::Interrupted);
        assert_eq!(ending(&[section(true)], &[check(0), check(1)]), Ending::Wrong);
        assert_eq!(ending(&[section(false)], &[check(1)]), Ending::Wrong);
    }
}
