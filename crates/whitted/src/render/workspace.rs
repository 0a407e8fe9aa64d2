//! The memory of one thread, and what it does with one region.

use super::context::Context;
use super::execution::Method;
use super::first_pass::{FirstPass, PassRows};
use super::jitter::{MIDDLE, PixelHash, Stratification};
use super::media::Media;
use super::probe::{Phase, Probe, watched};
use super::progress::Cancelled;
use super::queue::Tag;
use super::recursive::Recursive;
use super::region::PixelRect;
use super::samples::Samples;
use super::scatter::RAYS_PER_SAMPLE;
use super::statistics::Statistics;
use super::wavefront::{CHUNK, Wavefront};
use crate::math::{Vec3d, Vec3f};
use crate::ray::RayBatch;
use crate::scene::Antialias;
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
    /// Numbers of the samples of the batch in the order in which they are traced.
    numbers: Vec<u32>,
    /// Where the samples of the batch lie in the picture, in pixels from its upper left corner.
    places: [Vec<f32>; 2],
    rays: RayBatch,
}

impl Workspace {
    /// What was done since this was last asked.
    pub(super) fn take_statistics(&mut self) -> Statistics {
        std::mem::take(&mut self.samples.statistics)
    }

    /// Take the first sample of every pixel of `region` and write it to `rows`.
    pub(super) fn first_samples<P: Probe>(
        &mut self,
        context: &Context,
        region: &PixelRect,
        rows: &PassRows,
        probe: &P,
    ) -> Result<(), Cancelled> {
        for part in region.parts(CHUNK) {
            watched(probe, Phase::Queue, || {
                self.begin();
                part.for_each_in_tiles(|pixel| self.place(part.index(pixel) as u32, pixel, MIDDLE));
            });
            self.trace(context, probe)?;
            watched(probe, Phase::Queue, || rows.set(&part, self.samples.colors(), self.samples.first()));
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
        let samples = match context.settings.antialias {
            Antialias::Uniform(samples) => samples,
            _ => context.settings.antialias_max,
        };
        let strata = Stratification::new(samples);
        let seed = context.settings.seed;
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
                self.begin();
                for (number, &(_, pixel, sample)) in (0..).zip(&batch) {
                    self.place(number, pixel, strata.place(PixelHash::new(pixel[0], pixel[1], seed), sample));
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

    /// Begin a batch.
    fn begin(&mut self) {
        self.places.iter_mut().for_each(Vec::clear);
        self.numbers.clear();
    }

    /// Add sample `number` to the batch, at a place in a pixel. Numbers count from 0; they come in any order.
    fn place(&mut self, number: u32, pixel: [u32; 2], place: [f32; 2]) {
        self.numbers.push(number);
        for axis in 0..2 {
            self.places[axis].push(pixel[axis] as f32 + place[axis]);
        }
    }

    /// Trace the samples of the batch.
    fn trace<P: Probe>(&mut self, context: &Context, probe: &P) -> Result<(), Cancelled> {
        let count = self.places[0].len();
        self.samples.reset(count);
        self.samples.statistics.camera_rays += count as u64;
        watched(probe, Phase::Queue, || {
            let [x, y] = &self.places;
            context.camera.fill(context.execution.level, x, y, &mut self.rays);
        });
        match context.execution.method {
            Method::Wavefront => self.wavefront.run(context, &mut self.rays, &self.numbers, &mut self.samples, probe),
            Method::Recursive => {
                let Self { recursive, numbers, rays, samples, .. } = self;
                let mut run = |(i, &number)| recursive.run(context, &rays.get(i), camera_tag(number), samples);
                watched(probe, Phase::Trace, || numbers.iter().enumerate().try_for_each(&mut run))
            }
        }
    }
}

/// What the camera ray of a sample carries.
pub(super) fn camera_tag(sample: u32) -> Tag {
    Tag { sample, weight: Vec3f::ONE, media: Media::default(), budget: RAYS_PER_SAMPLE }
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
