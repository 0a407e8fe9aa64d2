//! Where the recursive renderer's hits come from.

use super::statistics::Statistics;
use crate::classic::{Caster, Steps};
use crate::ray::{Hit, HitBatch, Ray};
use crate::tree::{BitSet, Counts, Occlusion, Query, Scratch};

/// Answers questions about one ray, and counts what that took. All sources give the same answers.
pub(super) trait Source {
    /// The first hit.
    fn closest_hit(&mut self, ray: &Ray, statistics: &mut Statistics) -> Hit;
    /// The first hit after `after`, which advances to it.
    fn next_hit(&mut self, ray: &Ray, after: &mut (f32, u32), statistics: &mut Statistics) -> Hit;
    /// What lies within the range of the ray; primitives outside `opaque` do not block.
    fn occluded(&mut self, ray: &Ray, opaque: Option<&BitSet>, statistics: &mut Statistics) -> Occlusion;
}

/// Memory of the production walks for rays that come alone.
#[derive(Debug, Default)]
pub(super) struct Alone {
    hit: HitBatch,
    occlusion: Vec<Occlusion>,
    scratch: Scratch,
}

/// The production tree, in batches of one ray.
pub(super) struct Production<'a> {
    pub(super) query: Query<'a>,
    pub(super) alone: &'a mut Alone,
}

impl Source for Production<'_> {
    fn closest_hit(&mut self, ray: &Ray, statistics: &mut Statistics) -> Hit {
        let Alone { hit, scratch, .. } = self.alone;
        *statistics += self.query.closest_hit(ray, hit, scratch);
        hit.get(0)
    }

    fn next_hit(&mut self, ray: &Ray, after: &mut (f32, u32), statistics: &mut Statistics) -> Hit {
        let Alone { hit, scratch, .. } = self.alone;
        *statistics += self.query.next_hit(ray, std::slice::from_mut(after), hit, scratch);
        hit.get(0)
    }

    fn occluded(&mut self, ray: &Ray, opaque: Option<&BitSet>, statistics: &mut Statistics) -> Occlusion {
        let Alone { occlusion, scratch, .. } = self.alone;
        *statistics += self.query.occluded(ray, opaque, occlusion, scratch);
        occlusion[0]
    }
}

impl Source for Caster<'_> {
    fn closest_hit(&mut self, ray: &Ray, statistics: &mut Statistics) -> Hit {
        counted(statistics, |steps| Caster::closest_hit(self, ray, steps))
    }

    fn next_hit(&mut self, ray: &Ray, after: &mut (f32, u32), statistics: &mut Statistics) -> Hit {
        counted(statistics, |steps| Caster::next_hit(self, ray, after, steps))
    }

    fn occluded(&mut self, ray: &Ray, opaque: Option<&BitSet>, statistics: &mut Statistics) -> Occlusion {
        counted(statistics, |steps| Caster::occluded(self, ray, opaque, steps))
    }
}

fn counted<R>(statistics: &mut Statistics, cast: impl FnOnce(&mut Steps) -> R) -> R {
    let mut steps = Steps::default();
    let result = cast(&mut steps);
    *statistics += Counts { primitive_tests: steps.tests, node_steps: steps.steps, ..Counts::default() };
    result
}
