//! Rays that wait to be traced, each with what it carries.

use super::media::Media;
use crate::math::{Vec3, Vec3f};
use crate::ray::{Ray, RayBatch};

/// What a ray carries beside its geometry.
///
/// Whitted's shading is linear: light found at the end of a ray counts in its sample with the product of all
/// coefficients on the way, so that the ray needs to remember nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tag {
    /// Sample to which its light goes.
    pub(super) sample: u32,
    /// Share of its light, per colour component.
    pub(super) weight: Vec3f,
    /// What the ray is inside of.
    pub(super) media: Media,
    /// Rays that may still descend from it, itself included.
    pub(super) budget: u32,
}

/// A queue of rays of one generation.
#[derive(Debug, Default)]
pub(super) struct RayQueue {
    /// The rays.
    pub(super) rays: RayBatch,
    /// What they carry, one for each ray.
    pub(super) tags: Vec<Tag>,
}

impl RayQueue {
    pub(super) fn len(&self) -> usize {
        self.tags.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.tags.is_empty()
    }

    pub(super) fn clear(&mut self) {
        self.rays.clear();
        self.tags.clear();
    }

    pub(super) fn push(&mut self, ray: &Ray, tag: Tag) {
        self.rays.push(ray);
        self.tags.push(tag);
    }

    /// Move the last `at_most` rays, or all if there are fewer, to `chunk`, which is replaced.
    pub(super) fn take(&mut self, at_most: usize, chunk: &mut Self) {
        chunk.clear();
        if self.len() <= at_most {
            std::mem::swap(self, chunk);
            return;
        }
        let from = self.len() - at_most;
        append_from(&mut chunk.rays, &self.rays, from);
        chunk.tags.extend_from_slice(&self.tags[from..]);
        self.rays.truncate(from);
        self.tags.truncate(from);
    }
}

/// Append the rays of `source` from number `from` on.
fn append_from(target: &mut RayBatch, source: &RayBatch, from: usize) {
    let vectors = [(&mut target.origin, &source.origin), (&mut target.direction, &source.direction)];
    for (Vec3 { x, y, z }, rows) in vectors {
        x.extend_from_slice(&rows.x[from..]);
        y.extend_from_slice(&rows.y[from..]);
        z.extend_from_slice(&rows.z[from..]);
    }
    target.t_min.extend_from_slice(&source.t_min[from..]);
    target.t_max.extend_from_slice(&source.t_max[from..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn queue(len: u32) -> RayQueue {
        let mut queue = RayQueue::default();
        for sample in 0..len {
            let tag = Tag { sample, weight: Vec3f::ONE, media: Media::default(), budget: 1 };
            queue.push(&Ray::new(Vec3f::splat(sample as f32), Vec3f::ONE), tag);
        }
        queue
    }

    #[test]
    fn chunks_are_taken_from_the_end_and_nothing_is_lost() {
        let (mut all, mut chunk) = (queue(10), RayQueue::default());
        for expected in [6..10, 2..6, 0..2, 0..0] {
            all.take(4, &mut chunk);
            let samples: Vec<_> = chunk.tags.iter().map(|tag| tag.sample).collect();
            assert_eq!(samples, expected.clone().collect::<Vec<u32>>());
            let origins: Vec<_> = (0..chunk.rays.len()).map(|i| chunk.rays.get(i).origin.y as u32).collect();
            assert_eq!(origins, samples);
        }
        assert!(all.is_empty());
    }
}
