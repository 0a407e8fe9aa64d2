//! Questions about many rays at a time.

use super::RayScene;
use super::memory::{self, Memory};
use crate::ray::{HitBatch, HitLists, HitsMut, Rays};
use crate::tree::{Filter, Occlusion, WalkKind};
use rayon::prelude::*;

/// Rays are divided among threads after multiples of this, the chunk of the walks.
const GRAIN: usize = 4 * 4096;

/// Parts for each thread: the more there are, the shorter do threads wait for the last one, and the fewer neighbours do
/// rays have that are put in order.
const PARTS: usize = 2;

impl RayScene {
    /// The first hit of each ray, by all threads of the current rayon pool; as [`closest_hit`](Self::closest_hit).
    ///
    /// ```
    /// # use whitted::{query::RayScene, ray::Rays};
    /// let scene = RayScene::builder().spheres(&[([0.0; 3], 1.0)]).build()?;
    /// let (x, zero, z, back) = ([-2.0, 0.0, 2.0], [0.0; 3], [5.0; 3], [-1.0; 3]);
    /// let rays = Rays::new([&x, &zero, &z], [&zero, &zero, &back]);
    /// let hits = scene.closest_hit_batch(rays);
    /// assert_eq!(hits.t, [f32::INFINITY, 4.0, f32::INFINITY]);
    /// // Each ray may have its own range.
    /// assert!(!scene.closest_hit_batch(rays.with_t_max(&[9.0, 3.0, 9.0])).get(1).is_hit());
    /// # Ok::<(), whitted::query::RaySceneError>(())
    /// ```
    pub fn closest_hit_batch<'r>(&self, rays: impl Into<Rays<'r>>) -> HitBatch {
        let rays = rays.into();
        let mut hits = HitBatch::default();
        hits.resize(rays.len());
        self.closest_hit_divided(rays, (&mut hits).into(), part(rays.len()));
        hits
    }

    /// As [`closest_hit_batch`](Self::closest_hit_batch), into the caller's arrays, on this thread.
    ///
    /// # Panics
    /// If `hits` has not room for exactly as many as there are `rays`.
    pub fn closest_hit_into<'r, 'h>(&self, rays: impl Into<Rays<'r>>, hits: impl Into<HitsMut<'h>>) {
        let (rays, hits) = (rays.into(), hits.into());
        let sees = |index: usize, primitive: u32| self.sees(rays.mask(index), primitive);
        memory::with(|memory| {
            let filter = self.batch_filter(&rays, &sees);
            self.query(WalkKind::Auto).closest_hit_into(rays, filter, hits, &mut memory.scratch);
        });
    }

    fn closest_hit_divided(&self, rays: Rays<'_>, hits: HitsMut<'_>, part: usize) {
        if rays.len() <= part {
            return self.closest_hit_into(rays, hits);
        }
        let middle = middle(rays.len(), part);
        let ((left, right), (left_hits, right_hits)) = (rays.split_at(middle), hits.split_at(middle));
        rayon::join(
            || self.closest_hit_divided(left, left_hits, part),
            || self.closest_hit_divided(right, right_hits, part),
        );
    }

    /// Whether anything lies within the range of each ray, by all threads of the current rayon pool; as
    /// [`occluded`](Self::occluded).
    pub fn occluded_batch<'r>(&self, rays: impl Into<Rays<'r>>) -> Vec<bool> {
        let rays = rays.into();
        let mut occluded = vec![false; rays.len()];
        self.occluded_divided(rays, &mut occluded, part(rays.len()));
        occluded
    }

    /// As [`occluded_batch`](Self::occluded_batch), into the caller's array, on this thread.
    ///
    /// # Panics
    /// If `occluded` is not as long as the rays are many.
    pub fn occluded_into<'r>(&self, rays: impl Into<Rays<'r>>, occluded: &mut [bool]) {
        let rays = rays.into();
        assert_eq!(occluded.len(), rays.len(), "room for one answer to each ray");
        memory::with(|Memory { scratch, occlusion, .. }| {
            let sees = |index: usize, primitive: u32| self.sees(rays.mask(index), primitive);
            let filter = self.batch_filter(&rays, &sees);
            occlusion.resize(rays.len(), Occlusion::Clear);
            self.query(WalkKind::Auto).occluded_into(rays, None, filter, occlusion, scratch);
            for (occluded, occlusion) in occluded.iter_mut().zip(occlusion.iter()) {
                *occluded = *occlusion == Occlusion::Blocked;
            }
        });
    }

    fn occluded_divided(&self, rays: Rays<'_>, occluded: &mut [bool], part: usize) {
        if rays.len() <= part {
            return self.occluded_into(rays, occluded);
        }
        let middle = middle(rays.len(), part);
        let ((left, right), (left_out, right_out)) = (rays.split_at(middle), occluded.split_at_mut(middle));
        rayon::join(|| self.occluded_divided(left, left_out, part), || self.occluded_divided(right, right_out, part));
    }

    /// Every hit of each ray, by all threads of the current rayon pool; as [`all_hits`](Self::all_hits).
    ///
    /// ```
    /// # use whitted::{query::RayScene, ray::Rays};
    /// let scene = RayScene::builder().spheres(&[([0.0; 3], 1.0)]).build()?;
    /// let (x, zero, z, back) = ([-2.0, 0.0], [0.0; 2], [5.0; 2], [-1.0; 2]);
    /// let lists = scene.all_hits_batch(Rays::new([&x, &zero, &z], [&zero, &zero, &back]));
    /// assert!(lists.of(0).is_empty());
    /// assert_eq!([lists.of(1)[0].t, lists.of(1)[1].t], [4.0, 6.0]);
    /// # Ok::<(), whitted::query::RaySceneError>(())
    /// ```
    pub fn all_hits_batch<'r>(&self, rays: impl Into<Rays<'r>>) -> HitLists {
        let rays = rays.into();
        let parts = (0..rays.len().div_ceil(GRAIN)).into_par_iter().map(|part| {
            let rays = rays.slice(part * GRAIN..rays.len().min((part + 1) * GRAIN));
            let mut lists = HitLists::new();
            self.all_hits_into(rays, &mut lists);
            lists
        });
        let mut parts = parts.collect::<Vec<_>>().into_iter();
        let mut all = parts.next().unwrap_or_default();
        parts.for_each(|part| all.append(&part));
        all
    }

    /// As [`all_hits_batch`](Self::all_hits_batch), appended to `lists`, on this thread.
    pub fn all_hits_into<'r>(&self, rays: impl Into<Rays<'r>>, lists: &mut HitLists) {
        let rays = rays.into();
        let sees = |index: usize, primitive: u32| self.sees(rays.mask(index), primitive);
        memory::with(|memory| {
            let filter = self.batch_filter(&rays, &sees);
            self.query(WalkKind::Auto).all_hits(rays, filter, lists, &mut memory.scratch);
        });
    }

    /// The geometric unit normal of each hit, as [`normal`](Self::normal), one row for each component; 0 for a miss.
    ///
    /// # Panics
    /// If there are not as many hits as rays, or they are not from this scene.
    pub fn normal_batch<'r>(&self, rays: impl Into<Rays<'r>>, hits: &HitBatch) -> [Vec<f32>; 3] {
        let rays = rays.into();
        assert_eq!(hits.len(), rays.len(), "a hit for each ray");
        let mut rows = [(); 3].map(|()| Vec::with_capacity(hits.len()));
        for index in 0..hits.len() {
            let hit = hits.get(index);
            let normal = if hit.is_hit() { self.normal(&rays.get(index), &hit) } else { [0.0; 3] };
            rows.iter_mut().zip(normal).for_each(|(row, component)| row.push(component));
        }
        rows
    }

    fn batch_filter<'f>(&self, rays: &Rays<'_>, sees: Filter<'f>) -> Option<Filter<'f>> {
        (!self.all_seen(rays)).then_some(sees)
    }
}

/// How many of `len` rays a thread of the current pool takes at a time, at most.
fn part(len: usize) -> usize {
    len.div_ceil(PARTS * rayon::current_num_threads()).next_multiple_of(GRAIN)
}

/// Where to divide `len` rays: after whole parts, about half.
fn middle(len: usize, part: usize) -> usize {
    len.div_ceil(part) / 2 * part
}
