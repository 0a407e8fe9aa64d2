//! Light on its way from a lamp to a surface.

use super::context::Context;
use super::lighting::Sent;
use super::rows::Rows;
use super::samples::Samples;
use crate::math::Vec3f;
use crate::ray::{HitBatch, Ray, RayBatch, Rays};
use crate::scene::Shadows;
use crate::tree::{BitSet, Occlusion, Scratch};
use simd::F32Lanes;

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

/// The shadow rays of a batch towards one light.
#[derive(Debug, Default)]
pub(super) struct ShadowBatch {
    /// Origin, direction, end of the range, light; sample.
    rows: Rows<10, 1>,
    occlusion: Vec<Occlusion>,
    filtered: FilteredBatch,
}

impl ShadowBatch {
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
        samples.statistics +=
            context.query.occluded(rays(&self.rows), opaque_primitives(context), &mut self.occlusion, scratch);
        let [r, g, b] = [7, 8, 9].map(|row| self.rows.floats(row));
        for (index, (&occlusion, &sample)) in self.occlusion.iter().zip(self.rows.integers(0)).enumerate() {
            let light = Vec3f::new(r[index], g[index], b[index]);
            match occlusion {
                Occlusion::Clear => samples.add(sample, light),
                Occlusion::Filtered => self.filtered.push(&rays(&self.rows).get(index), sample, light),
                Occlusion::Blocked => {}
            }
        }
        self.filtered.resolve(context, scratch, samples);
        self.rows.clear();
    }
}

fn rays(rows: &Rows<10, 1>) -> Rays<'_> {
    let row = |row| rows.floats(row);
    Rays::new([row(0), row(1), row(2)], [row(3), row(4), row(5)]).with_t_max(row(6))
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
