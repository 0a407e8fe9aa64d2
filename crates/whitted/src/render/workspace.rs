//! The memory of one thread, and what it does with one region.

use super::context::Context;
use super::execution::Method;
use super::first_pass::FirstPass;
use super::jitter::{Jitter, MIDDLE};
use super::probe::{Phase, Probe, watched};
use super::progress::Cancelled;
use super::recorder::Recorder;
use super::recursive::Recursive;
use super::region::PixelRect;
use super::samples::Samples;
use super::statistics::Statistics;
use super::wavefront::{CHUNK, Wavefront};
use crate::math::{Vec3d, Vec3f};
use simd::{F32Lanes, U32Lanes};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// A pixel's final colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Refined {
    pub(super) pixel: [u32; 2],
    pub(super) color: Vec3f,
}

/// The memory of one thread, reused from region to region.
#[derive(Debug, Default)]
pub(super) struct Workspace {
    wavefront: Wavefront,
    recursive: Recursive,
    samples: Samples,
    places: Places,
}

/// Where the samples of a batch lie in the picture, in the order in which they are traced.
#[derive(Debug, Default)]
pub(super) struct Places {
    /// In pixels from the upper left corner.
    axes: [Vec<f32>; 2],
    /// Numbers of the samples: each of 0.. once.
    numbers: Vec<u32>,
}

impl Places {
    pub(super) fn len(&self) -> usize {
        self.numbers.len()
    }

    fn clear(&mut self) {
        self.axes.iter_mut().for_each(Vec::clear);
        self.numbers.clear();
    }

    /// The middles of the pixels of `part`, tile by tile; their numbers go row by row.
    fn fill_with_middles(&mut self, part: &PixelRect) {
        self.clear();
        part.for_each_row_of_tiles(|y, columns| {
            let first = part.index([columns.start, y]) as u32;
            self.numbers.extend(first..first + columns.len() as u32);
            self.axes[0].extend(columns.clone().map(|x| x as f32 + MIDDLE[0]));
            self.axes[1].extend(columns.map(|_| y as f32 + MIDDLE[1]));
        });
    }

    /// Append sample `number`, at a place in a pixel.
    fn push(&mut self, number: u32, pixel: [u32; 2], place: [f32; 2]) {
        self.numbers.push(number);
        for axis in 0..2 {
            self.axes[axis].push(pixel[axis] as f32 + place[axis]);
        }
    }

    /// The places `at` and following with their numbers, in lanes; zero beyond the end.
    #[inline(always)]
    pub(super) fn load<L: F32Lanes>(&self, token: L::Token, at: usize) -> ([L; 2], L::U32) {
        let end = self.len().min(at + L::WIDTH);
        if end == at + L::WIDTH {
            let [x, y] = &self.axes;
            let axes = [L::load_slice(token, &x[at..]), L::load_slice(token, &y[at..])];
            return (axes, L::U32::load_slice(token, &self.numbers[at..]));
        }
        let (mut axes, mut numbers) = ([L::Array::default(); 2], <L::U32 as U32Lanes>::Array::default());
        for axis in 0..2 {
            axes[axis].as_mut()[..end - at].copy_from_slice(&self.axes[axis][at..end]);
        }
        numbers.as_mut()[..end - at].copy_from_slice(&self.numbers[at..end]);
        ([L::load(token, &axes[0]), L::load(token, &axes[1])], L::U32::load(token, &numbers))
    }
}

impl Workspace {
    /// What was done since this was last asked.
    pub(super) fn take_statistics(&mut self) -> Statistics {
        std::mem::take(&mut self.samples.statistics)
    }

    /// Take the first sample of every pixel of `region` and hand them over, a part of the region at a time.
    pub(super) fn first_samples<P: Probe>(
        &mut self,
        context: &Context,
        region: &PixelRect,
        probe: &P,
        hand_over: impl Fn(&PixelRect, &Samples),
    ) -> Result<(), Cancelled> {
        for part in region.parts(CHUNK) {
            watched(probe, Phase::Queue, || self.places.fill_with_middles(&part));
            self.trace(context, probe)?;
            watched(probe, Phase::Queue, || hand_over(&part, &self.samples));
        }
        Ok(())
    }

    /// The mean of all samples of each of `pixels`, the first of which is in `pass`.
    pub(super) fn refine<P: Probe>(
        &mut self,
        context: &Context,
        pass: &FirstPass,
        pixels: &[[u32; 2]],
        probe: &P,
    ) -> Result<Vec<Refined>, Cancelled> {
        let jitter = Jitter::new(context.settings);
        let samples = jitter.samples();
        // Sample by sample within each pixel, so that sums are formed in the order of samples.
        let mut queue = pixels
            .iter()
            .enumerate()
            .flat_map(|(index, &pixel)| (1..samples).map(move |sample| (index, pixel, sample)));
        let mut sums: Vec<Vec3d> = pixels.iter().map(|&pixel| pass.color(pixel).to_f64()).collect();
        loop {
            let batch: Vec<(usize, [u32; 2], u32)> = queue.by_ref().take(CHUNK).collect();
            if batch.is_empty() {
                break;
            }
            watched(probe, Phase::Refine, || {
                self.places.clear();
                for (number, &(_, pixel, sample)) in (0..).zip(&batch) {
                    self.places.push(number, pixel, jitter.place(pixel, sample));
                }
            });
            self.trace(context, probe)?;
            watched(probe, Phase::Refine, || {
                for (&(index, ..), color) in batch.iter().zip(self.samples.colors()) {
                    sums[index] += color.to_f64();
                }
            });
        }
        let mean = |sum: Vec3d| (sum / f64::from(samples)).to_f32();
        Ok(pixels.iter().zip(sums).map(|(&pixel, sum)| Refined { pixel, color: mean(sum) }).collect())
    }

    /// What is done for the first `samples` samples of one pixel, one ray after the other.
    pub(super) fn statistics_of(
        &mut self,
        context: &Context,
        jitter: &Jitter,
        pixel: [u32; 2],
        samples: u32,
    ) -> Result<Statistics, Cancelled> {
        self.place(jitter, pixel, 0..samples);
        self.take_statistics();
        self.samples.reset(self.places.len(), true);
        self.recursive.run(context, &self.places, &mut self.samples)?;
        Ok(self.take_statistics())
    }

    /// The colours of some samples of one pixel; `recorder` is told everything about their rays.
    pub(super) fn record<R: Recorder>(
        &mut self,
        context: &Context,
        jitter: &Jitter,
        pixel: [u32; 2],
        samples: Range<u32>,
        recorder: &mut R,
    ) -> Result<Vec<Vec3f>, Cancelled> {
        self.place(jitter, pixel, samples);
        self.samples.reset(self.places.len(), true);
        self.recursive.record(context, &self.places, &mut self.samples, recorder)?;
        self.samples.develop(context.execution.level);
        Ok(self.samples.colors().to_vec())
    }

    /// Make a batch of some samples of one pixel.
    fn place(&mut self, jitter: &Jitter, pixel: [u32; 2], samples: Range<u32>) {
        self.places.clear();
        for (number, sample) in (0..).zip(samples) {
            self.places.push(number, pixel, jitter.place(pixel, sample));
        }
    }

    /// Trace the samples of the batch.
    fn trace<P: Probe>(&mut self, context: &Context, probe: &P) -> Result<(), Cancelled> {
        let Self { wavefront, recursive, samples, places } = self;
        samples.reset(places.len(), context.keeps_first_samples());
        samples.statistics.camera_rays += places.len() as u64;
        match context.execution.method {
            Method::Wavefront => wavefront.run(context, places, samples, probe)?,
            Method::Recursive => watched(probe, Phase::Trace, || recursive.run(context, places, samples))?,
        }
        watched(probe, Phase::Queue, || samples.develop(context.execution.level));
        Ok(())
    }
}

/// Workspaces that no thread is using at the moment: there are never more than threads.
#[derive(Debug, Default)]
pub(super) struct Workspaces(Mutex<Vec<Workspace>>);

impl Workspaces {
    /// Do `work` with a workspace that nobody else uses.
    pub(super) fn with<R>(&self, work: impl FnOnce(&mut Workspace) -> R) -> R {
        // A workspace is only put back whole, so a panic elsewhere leaves nothing broken behind.
        let taken = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut workspace = taken.unwrap_or_default();
        let result = work(&mut workspace);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(workspace);
        result
    }
}
