//! Light on its way from a lamp to a surface.

use super::context::Context;
use super::lighting::Sent;
use super::packing::Packing;
use super::rows::{BLOCK, Rows};
use super::samples::Samples;
use crate::math::Vec3f;
use crate::ray::{HitBatch, Ray, RayBatch, Rays};
use crate::scene::Shadows;
use crate::tree::{BitSet, Occlusion, Scratch};
use simd::{F32Lanes, Kernel, Level, Simd, U32Lanes};

/// Light passes at most this many surfaces; what would pass more is lost. Bounds the work of a shadow ray.
pub(super) const MAX_FILTERS: usize = 256;

/// Where the walk over all hits of a ray begins.
pub(super) const BEFORE_ALL: (f32, u32) = (f32::NEG_INFINITY, 0);

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
        let [r, g, b] = [7, 8, 9].map(|row| self.rows.floats(row));
        let (sample, order) = (self.rows.integers(0), self.packed.packing.order());
        for (place, &occlusion) in self.occlusion.iter().enumerate() {
            if occlusion == Occlusion::Blocked {
                continue;
            }
            let index = order[place] as usize;
            let (sample, light) = (sample[index], Vec3f::new(r[index], g[index], b[index]));
            match occlusion {
                Occlusion::Filtered => self.filtered.push(&rays.get(place), sample, light),
                _ => samples.add(sample, light),
            }
        }
        self.filtered.resolve(context, scratch, samples);
        self.rows.clear();
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
            out.resize(order.len(), 0.0);
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

/// Shadow rays that meet only transparent surfaces: each round finds the next surface of every ray that is left.
#[derive(Debug, Default)]
struct FilteredBatch {
    rays: RayBatch,
    gains: Vec<(u32, Vec3f)>,
    after: Vec<(f32, u32)>,
    hits: HitBatch,
}

impl FilteredBatch {
    fn push(&mut self, ray: &Ray, sample: u32, light: Vec3f) {
        self.rays.push(ray);
        self.gains.push((sample, light));
        self.after.push(BEFORE_ALL);
    }

    fn resolve(&mut self, context: &Context, scratch: &mut Scratch, samples: &mut Samples) {
        for _ in 0..MAX_FILTERS {
            if self.gains.is_empty() {
                break;
            }
            let counts = context.query.next_hit(&self.rays, &mut self.after, &mut self.hits, scratch);
            samples.statistics += counts;
            self.filter(context, samples);
        }
        self.keep_first(0);
    }

    /// Reduce the light of every ray by the surface that it met; deliver that of rays which met nothing more, and keep
    /// the others.
    fn filter(&mut self, context: &Context, samples: &mut Samples) {
        let mut kept = 0;
        for index in 0..self.gains.len() {
            let (sample, light) = self.gains[index];
            let hit = self.hits.get(index);
            if !hit.is_hit() {
                samples.add(sample, light);
                continue;
            }
            self.gains[kept] = (sample, light.times(context.filter(hit.primitive)));
            self.after[kept] = self.after[index];
            self.rays.copy_within(index, kept);
            kept += 1;
        }
        self.keep_first(kept);
    }

    fn keep_first(&mut self, len: usize) {
        self.rays.truncate(len);
        self.gains.truncate(len);
        self.after.truncate(len);
    }
}
