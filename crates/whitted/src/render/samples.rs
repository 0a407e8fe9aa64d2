//! What a batch of samples has gathered.

use super::context::Context;
use super::film::Film;
use super::first_pass::FirstSample;
use super::rows::{array, array_f32, lanes_of};
use super::statistics::Statistics;
use crate::math::{Vec3, Vec3f};
use simd::{F32Lanes, Level, MaskLanes};

/// The results of a batch of samples, filled in any order by whoever traces them.
#[derive(Debug, Default)]
pub(super) struct Samples {
    film: Film,
    colors: Vec<Vec3f>,
    /// Empty if nobody wants to know.
    first: Vec<FirstSample>,
    /// Counts over all batches since they were last taken.
    pub(super) statistics: Statistics,
}

impl Samples {
    /// Start over with `len` samples that saw nothing yet. The statistics go on.
    pub(super) fn reset(&mut self, len: usize, keeps_first: bool) {
        self.film.reset(len);
        self.first.clear();
        self.first.resize(if keeps_first { len } else { 0 }, FirstSample::NOTHING);
    }

    /// Add light to a sample.
    #[inline]
    pub(super) fn add(&mut self, sample: u32, light: Vec3f) {
        self.film.add(sample, light);
    }

    /// Add light to the samples of the lanes `mask`.
    #[inline(always)]
    pub(super) fn add_lanes<L: F32Lanes>(&mut self, token: L::Token, mask: L::Mask, sample: L::U32, light: Vec3<L>) {
        self.film.add_lanes(token, mask, sample, light);
    }

    /// Note what the camera rays of the samples of the lanes `mask` hit.
    #[inline(always)]
    pub(super) fn see<L: F32Lanes>(
        &mut self,
        context: &Context,
        mask: L::Mask,
        sample: L::U32,
        primitive: L::U32,
        normal: Vec3<L>,
        depth: L,
    ) {
        if self.first.is_empty() {
            return;
        }
        let (samples, primitives, depths) = (array::<L>(sample), array::<L>(primitive), array_f32(depth));
        let rows = [array_f32(normal.x), array_f32(normal.y), array_f32(normal.z)];
        let [x, y, z] = [rows[0].as_ref(), rows[1].as_ref(), rows[2].as_ref()];
        for lane in lanes_of(mask.bits()) {
            let first = &mut self.first[samples.as_ref()[lane] as usize];
            first.object = context.geometry.object(primitives.as_ref()[lane]);
            first.normal = Vec3::new(x[lane], y[lane], z[lane]);
            first.depth = depths.as_ref()[lane];
        }
    }

    /// Note that secondary rays of the samples of the lanes `mask` were not traced because of their weight.
    #[inline(always)]
    pub(super) fn cut<L: F32Lanes>(&mut self, mask: L::Mask, sample: L::U32) {
        self.statistics.cut_by_weight += u64::from(mask.bits().count_ones());
        if self.first.is_empty() {
            return;
        }
        let samples = array::<L>(sample);
        for lane in lanes_of(mask.bits()) {
            self.first[samples.as_ref()[lane] as usize].cut = true;
        }
    }

    /// All light has come: make colours of it.
    pub(super) fn develop(&mut self, level: Level) {
        self.film.develop(level, &mut self.colors);
    }

    /// The colour of every sample, in order, as of when it was developed.
    pub(super) fn colors(&self) -> &[Vec3f] {
        &self.colors
    }

    /// What every camera ray saw, in the order of samples; empty if that is not kept.
    pub(super) fn first(&self) -> &[FirstSample] {
        &self.first
    }
}
