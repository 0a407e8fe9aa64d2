//! Light on its way from a lamp to a surface.

use super::context::Context;
use super::lighting::Sent;
use super::packing::Packing;
use super::rows::{BLOCK, Rows, lengthen};
use super::samples::Samples;
use crate::math::{Vec3, Vec3f};
use crate::ray::{Hit, HitBatch, Ray, RayBatch, Rays};
use crate::scene::Shadows;
use crate::tree::{BitSet, CrossingLists, Occlusion, Scratch};
use simd::{F32Lanes, Kernel, Level, MaskLanes, Simd, U32Lanes};
use std::ops::Range;

/// Light passes at most this many surfaces; what would pass more is lost. Bounds the work of a shadow ray.
const MAX_FILTERS: usize = 256;

/// Where the walk over all hits of a ray begins.
const BEFORE_ALL: (f32, u32) = (f32::NEG_INFINITY, 0);

/// The primitives that let no light pass; `None` if none does.
pub(super) fn opaque_primitives<'a>(context: &Context<'a>) -> Option<&'a BitSet> {
    match context.settings.shadows {
        Shadows::Opaque => None,
        Shadows::Filter => context.look.opaque(),
    }
}

/// Shadow rays towards one light.
#[derive(Debug, Default)]
pub(super) struct ShadowBatch {
    /// Origin, direction, end of the range, light; sample.
    rows: Rows<10, 1>,
    packed: Packed,
    occlusion: Vec<Occlusion>,
    /// 1 for each ray that nothing is in the way of, in the order of the rows.
    clear: Vec<u32>,
    filtered: FilteredBatch,
}

impl ShadowBatch {
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Forget all rays.
    pub(super) fn clear(&mut self) {
        self.rows.clear();
    }

    /// Queue the segments between surfaces and the lamp, in the lanes `mask`; their samples gain light if nothing is in
    /// between.
    #[inline(always)]
    pub(super) fn append<L: F32Lanes>(&mut self, mask: L::Mask, sample: L::U32, sent: &Sent<L>) {
        let (o, d, light) = (sent.origin, sent.direction, sent.light);
        let floats = [o.x, o.y, o.z, d.x, d.y, d.z, sent.t_max, light.x, light.y, light.z];
        self.rows.append::<L>(mask, floats, [sample]);
    }

    /// Trace the rays, add the light that arrives, and forget the rays.
    pub(super) fn resolve(&mut self, context: &Context, scratch: &mut Scratch, samples: &mut Samples) {
        if self.rows.is_empty() {
            return;
        }
        samples.statistics.shadow_rays += self.rows.len() as u64;
        self.packed.fill(context.execution.level, &self.rows);
        let rays = self.packed.rays();
        let opaque = opaque_primitives(context);
        samples.statistics += context.query.occluded(rays, opaque, &mut self.occlusion, scratch);
        self.sort_out();
        simd::dispatch(context.execution.level, Deliver { rows: &self.rows, clear: &self.clear, samples });
        self.filtered.resolve(context, scratch, samples);
        self.rows.clear();
    }

    /// Note which rays nothing is in the way of, in the order of the rows, and keep those that transparent things are.
    fn sort_out(&mut self) {
        let [r, g, b] = [7, 8, 9].map(|row| self.rows.floats(row));
        let (sample, rays) = (self.rows.integers(0), self.packed.rays());
        self.clear.clear();
        lengthen(&mut self.clear, self.rows.len().next_multiple_of(BLOCK));
        for (place, (&occlusion, &index)) in self.occlusion.iter().zip(self.packed.packing.order()).enumerate() {
            let index = index as usize;
            self.clear[index] = u32::from(occlusion == Occlusion::Clear);
            if occlusion == Occlusion::Filtered {
                self.filtered.push(&rays.get(place), sample[index], Vec3f::new(r[index], g[index], b[index]));
            }
        }
    }
}

/// Adds the light of the rays that nothing is in the way of.
struct Deliver<'a> {
    rows: &'a Rows<10, 1>,
    /// 1 for each such ray.
    clear: &'a [u32],
    samples: &'a mut Samples,
}

impl Kernel for Deliver<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let none = <S::F32x16 as F32Lanes>::U32::splat(token, 0);
        for at in (0..self.rows.len()).step_by(BLOCK) {
            let clear = !<S::F32x16 as F32Lanes>::U32::load_slice(token, &self.clear[at..]).eq(none);
            if clear.any() {
                let ([.., r, g, b], [sample]) = self.rows.load::<S::F32x16>(token, at);
                self.samples.add_lanes(token, clear, sample, Vec3::new(r, g, b));
            }
        }
    }
}

/// The rays of a batch in the order in which they are traced.
#[derive(Debug, Default)]
struct Packed {
    packing: Packing,
    /// Origin, direction, end of the range.
    rows: [Vec<f32>; 7],
}

impl Packed {
    fn fill(&mut self, level: Level, batch: &Rows<10, 1>) {
        let row = |row| batch.floats(row);
        self.packing.sort(level, [row(3), row(4), row(5)]);
        simd::dispatch(level, Permute { order: self.packing.order(), batch, rows: &mut self.rows });
    }

    fn rays(&self) -> Rays<'_> {
        let [ox, oy, oz, dx, dy, dz, t_max] = &self.rows;
        Rays::new([ox, oy, oz], [dx, dy, dz]).with_t_max(t_max)
    }
}

/// Brings rays into an order.
struct Permute<'a> {
    order: &'a [u32],
    batch: &'a Rows<10, 1>,
    rows: &'a mut [Vec<f32>; 7],
}

impl Kernel for Permute<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { order, batch, rows } = self;
        let (whole, rest) = order.as_chunks::<BLOCK>();
        for (row, out) in rows.iter_mut().enumerate() {
            let from = batch.floats(row);
            lengthen(out, order.len());
            let (to, to_rest) = out.as_chunks_mut::<BLOCK>();
            for (to, order) in to.iter_mut().zip(whole) {
                let index = <S::F32x16 as F32Lanes>::U32::load(token, order);
                S::F32x16::gather(from, index).store(to);
            }
            for (to, &index) in to_rest.iter_mut().zip(rest) {
                *to = from[index as usize];
            }
        }
    }
}

/// Shadow rays that meet only transparent surfaces.
#[derive(Debug, Default)]
struct FilteredBatch {
    rays: RayBatch,
    gains: Vec<(u32, Vec3f)>,
    crossings: CrossingLists,
}

/// Rays whose crossings are found together.
const FILTERED: usize = 4096;

impl FilteredBatch {
    fn push(&mut self, ray: &Ray, sample: u32, light: Vec3f) {
        self.rays.push(ray);
        self.gains.push((sample, light));
    }

    /// Deliver what of the light arrives, and forget the rays.
    fn resolve(&mut self, context: &Context, scratch: &mut Scratch, samples: &mut Samples) {
        for start in (0..self.gains.len()).step_by(FILTERED) {
            let chunk = start..self.gains.len().min(start + FILTERED);
            let (rays, room) = (Rays::from(&self.rays), FILTERED * MAX_FILTERS);
            match context.query.crossings(rays, chunk.clone(), None, room, &mut self.crossings, scratch) {
                Some(counts) => samples.statistics += counts,
                None => {
                    self.one_by_one(chunk, context, scratch, samples);
                    continue;
                }
            }
            for index in chunk.clone() {
                let crossings = self.crossings.of(index - chunk.start);
                if crossings.len() < MAX_FILTERS {
                    let (sample, light) = self.gains[index];
                    samples
                        .add(sample, crossings.iter().fold(light, |light, c| light.times(context.filter(c.primitive))));
                }
            }
        }
        self.rays.truncate(0);
        self.gains.clear();
    }

    /// As [`resolve`](Self::resolve), in no memory, for rays of a chunk which crosses more than anybody sees through.
    #[cold]
    fn one_by_one(&self, chunk: Range<usize>, context: &Context, scratch: &mut Scratch, samples: &mut Samples) {
        for index in chunk {
            let (ray, (sample, light)) = (self.rays.get(index), self.gains[index]);
            let mut hits = HitBatch::default();
            let light = filtered(context, light, |after| {
                samples.statistics += context.query.next_hit(&ray, std::slice::from_mut(after), &mut hits, scratch);
                hits.get(0)
            });
            samples.add(sample, light);
        }
    }
}

/// `light` after all surfaces on the way of a ray, of which `next` finds the one after the last.
pub(super) fn filtered(context: &Context, mut light: Vec3f, mut next: impl FnMut(&mut (f32, u32)) -> Hit) -> Vec3f {
    let mut after = BEFORE_ALL;
    for _ in 0..MAX_FILTERS {
        let hit = next(&mut after);
        if !hit.is_hit() {
            return light;
        }
        light = light.times(context.filter(hit.primitive));
    }
    Vec3f::ZERO
}
