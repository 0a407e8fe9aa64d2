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

impl Session<'_> {
    /// Tells how far the present experiment is (0 to 1), and ends it if the user wants.
    pub(crate) fn at(&self, part: f64, what: &str) -> Result<(), Cancelled> {
        let (start, length) = self.span.get();
        self.watch.at(start + length * part.clamp(0.0, 1.0), what);
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
    let (one, several) = (Threads::new(1).map_err(NoThreads)?, Threads::new(plan.effort.threads).map_err(NoThreads)?);
    let (span, checks) = (Cell::default(), RefCell::default());
    let session = Session { effort: &plan.effort, cancel, one, several, watch, span, checks };
    let mut sections = Vec::new();
    let whole: f64 = plan.experiments.iter().map(|experiment| experiment.weight()).sum();
    for &experiment in &plan.experiments {
        let (begun, taken) = session.span.get();
        session.span.set((begun + taken, experiment.weight() / whole));
        let section = section(&session, experiment);
        let complete = section.complete;
        sections.push(section);
        if !complete {
            break;
        }
    }
    let checks = session.checks.into_inner();
    let ending = match sections.iter().all(|section| section.complete) {
        _ if checks.iter().any(|check| !check.holds()) => Ending::Wrong,
        true => Ending::Complete,
        false => Ending::Interrupted,
    };
    head.seconds = start.elapsed().as_secs_f64();
    Ok(Report { head, ending, sections, checks })
}

fn section(session: &Session, experiment: Experiment) -> Section {
    let mut section = Section::new(experiment);
    section.complete = (experiment.run())(session, &mut section).is_ok();
    section
}
