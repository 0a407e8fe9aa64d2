//! What pixels cost.

use crate::render::context::Context;
use crate::render::frame::Frame;
use crate::render::jitter::Jitter;
use crate::render::progress::Cancelled;
use crate::render::region::PixelRect;
use crate::render::statistics::Statistics;
use crate::render::workspace::Workspaces;
use rayon::prelude::*;

/// What all samples of a pixel cost.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cost {
    pub(super) nodes: u64,
    pub(super) tests: u64,
    pub(super) nanoseconds: u64,
}

/// Tells how many nanoseconds have passed since any moment.
pub type Clock<'a> = &'a (dyn Fn() -> u64 + Sync);

/// How often a pixel is traced for its time: the least of these times is the one least disturbed.
const TIMINGS: usize = 3;

/// What the pixels of `frame` cost, row by row; times are 0 without a clock.
pub(super) fn of_pixels(context: &Context, frame: &Frame, clock: Option<Clock>) -> Result<Vec<Cost>, Cancelled> {
    let jitter = Jitter::new(context.settings);
    let workspaces = Workspaces::default();
    let of_region = |region: &PixelRect| {
        workspaces.with(|workspace| {
            let of_pixel = |pixel| {
                let samples = if frame.supersampled[frame.rect.index(pixel)] { jitter.samples() } else { 1 };
                of_pixel(|| workspace.statistics_of(context, &jitter, pixel, samples), clock)
            };
            region.pixels().map(of_pixel).collect::<Result<Vec<Cost>, Cancelled>>()
        })
    };
    let regions = frame.rect.regions(context.execution.region);
    let found = regions.par_iter().map(of_region).collect::<Result<Vec<_>, Cancelled>>()?;
    let mut costs = vec![Cost::default(); frame.rect.len()];
    for (region, found) in regions.iter().zip(found) {
        region.pixels().zip(found).for_each(|(pixel, cost)| costs[frame.rect.index(pixel)] = cost);
    }
    Ok(costs)
}

/// What `trace`, which traces a pixel, does and how long it takes.
fn of_pixel(mut trace: impl FnMut() -> Result<Statistics, Cancelled>, clock: Option<Clock>) -> Result<Cost, Cancelled> {
    let Some(clock) = clock else { return trace().map(|statistics| Cost::of(&statistics, 0)) };
    let mut least = Cost { nanoseconds: u64::MAX, ..Cost::default() };
    for _ in 0..TIMINGS {
        let start = clock();
        let statistics = trace()?;
        least = Cost::of(&statistics, least.nanoseconds.min(clock().saturating_sub(start)));
    }
    Ok(least)
}

impl Cost {
    fn of(statistics: &Statistics, nanoseconds: u64) -> Self {
        Self { nodes: statistics.node_steps, tests: statistics.primitive_tests, nanoseconds }
    }
}
