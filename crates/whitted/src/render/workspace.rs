//! The memory of one thread, and what it does with one region.

use super::context::Context;
use super::execution::Method;
use super::first_pass::{FirstPass, FirstSample};
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
    /// Where the samples of the batch lie in the picture, in pixels from its upper left corner.
    places: [Vec<f32>; 2],
    rays: RayBatch,
}

impl Workspace {
    /// What was done since this was last asked.
    pub(super) fn take_statistics(&mut self) -> Statistics {
        std::mem::take(&mut self.samples.statistics)
    }

    /// The first sample of every pixel of `region`, row by row.
    pub(super) fn first_samples<P: Probe>(
        &mut self,
        context: &Context,
        region: &PixelRect,
        probe: &P,
    ) -> Result<Vec<FirstSample>, Cancelled> {
        let mut pixels = region.pixels();
        let mut results = Vec::with_capacity(region.len());
        while results.len() < region.len() {
            self.place(pixels.by_ref().take(CHUNK).map(|pixel| (pixel, MIDDLE)));
            self.trace(context, probe)?;
            results.extend(self.samples.first_samples());
        }
        Ok(results)
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
        let mut sums: Vec<Vec3d> = pixels.iter().map(|&pixel| pass.get(pixel).color.to_f64()).collect();
        loop {
            let batch: Vec<(usize, [u32; 2], u32)> = queue.by_ref().take(CHUNK).collect();
            if batch.is_empty() {
                break;
            }
            self.place(
                batch
                    .iter()
                    .map(|&(_, pixel, sample)| (pixel, strata.place(PixelHash::new(pixel[0], pixel[1], seed), sample))),
            );
            self.trace(context, probe)?;
            for (&(index, ..), color) in batch.iter().zip(self.samples.colors()) {
                sums[index] += color.to_f64();
            }
        }
        let mean = |sum: Vec3d| (sum / f64::from(samples)).to_f32();
        Ok(pixels.iter().zip(sums).map(|(&pixel, sum)| Refined { pixel, color: mean(sum) }).collect())
    }

    /// Begin a batch with these samples, given by their pixel and their place in it.
    fn place(&mut self, places: impl Iterator<Item = ([u32; 2], [f32; 2])>) {
        self.places.iter_mut().for_each(Vec::clear);
        for (pixel, place) in places {
            for axis in 0..2 {
                self.places[axis].push(pixel[axis] as f32 + place[axis]);
            }
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
            Method::Wavefront => self.wavefront.run(context, &mut self.rays, &mut self.samples, probe),
            Method::Recursive => {
                let Self { recursive, rays, samples, .. } = self;
                watched(probe, Phase::Trace, || {
                    (0..count).try_for_each(|i| recursive.run(context, &rays.get(i), camera_tag(i), samples))
                })
            }
        }
    }
}

/// What the camera ray of a sample carries.
pub(super) fn camera_tag(sample: usize) -> Tag {
    Tag { sample: sample as u32, weight: Vec3f::ONE, media: Media::default(), budget: RAYS_PER_SAMPLE }
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
