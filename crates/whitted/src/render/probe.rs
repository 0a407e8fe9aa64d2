//! Letting the caller watch where time goes: the library itself asks no clock.

/// What a thread is doing with a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Making camera rays and sorting queues.
    Queue,
    /// Finding what rays hit.
    Trace,
    /// Finding what lies between points and lights.
    Shadow,
    /// Surfaces: their light and the rays that leave them.
    Shade,
    /// Deciding which pixels need more samples, and averaging them.
    Refine,
}

/// Told when a phase begins and ends, once per batch, on the thread that does the work. Phases do not nest.
pub trait Probe: Sync {
    /// A phase begins.
    fn enter(&self, phase: Phase);
    /// The phase entered last on this thread ends.
    fn leave(&self, phase: Phase);
}

/// Watches nothing and costs nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwatched;

impl Probe for Unwatched {
    #[inline(always)]
    fn enter(&self, _: Phase) {}
    #[inline(always)]
    fn leave(&self, _: Phase) {}
}

/// Do `work` as `phase` of `probe`.
#[inline(always)]
pub(super) fn watched<P: Probe, R>(probe: &P, phase: Phase, work: impl FnOnce() -> R) -> R {
    probe.enter(phase);
    let result = work();
    probe.leave(phase);
    result
}
