//! What a batch of samples has gathered.

use super::film::Film;
use super::first_pass::FirstSample;
use super::statistics::Statistics;
use crate::math::Vec3f;

/// The results of a batch of samples, filled in any order by whoever traces them.
#[derive(Debug, Default)]
pub(super) struct Samples {
    film: Film,
    first: Vec<FirstSample>,
    /// Counts over all batches since they were last taken.
    pub(super) statistics: Statistics,
}

impl Samples {
    /// Start over with `len` samples that saw nothing yet. The statistics go on.
    pub(super) fn reset(&mut self, len: usize) {
        self.film.reset(len);
        self.first.clear();
        self.first.resize(len, FirstSample::NOTHING);
    }

    /// Add light to a sample.
    #[inline]
    pub(super) fn add(&mut self, sample: u32, light: Vec3f) {
        self.film.add(sample, light);
    }

    /// Note what the camera ray of a sample hit.
    pub(super) fn see(&mut self, sample: u32, object: u32, normal: Vec3f, depth: f32) {
        let first = &mut self.first[sample as usize];
        (first.object, first.normal, first.depth) = (object, normal, depth);
    }

    /// Note that a secondary ray of a sample was not traced because of its weight.
    pub(super) fn cut(&mut self, sample: u32) {
        self.first[sample as usize].cut = true;
    }

    /// The colour of every sample, in order.
    pub(super) fn colors(&self) -> impl ExactSizeIterator<Item = Vec3f> {
        self.film.colors()
    }

    /// What every camera ray saw, in the order of samples.
    pub(super) fn first(&self) -> &[FirstSample] {
        &self.first
    }
}
