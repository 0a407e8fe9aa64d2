//! Every crossing of rays with primitives, by one walk.

use super::goal::Goal;
use super::query::CHUNK;
use super::{Counts, Filter, Query, Scratch};
use crate::ray::Rays;
use std::cmp::Ordering;
use std::ops::Range;

/// A place where a ray crosses a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Crossing {
    pub(crate) t: f32,
    pub(crate) primitive: u32,
}

impl Crossing {
    fn order(&self, other: &Self) -> Ordering {
        let t = self.t.partial_cmp(&other.t).expect("no NaN is in a ray's range");
        t.then(self.primitive.cmp(&other.primitive))
    }
}

/// The crossings of each ray of a chunk, in the order of (t, primitive), each once.
#[derive(Debug, Default)]
pub(crate) struct CrossingLists {
    offered: Vec<(u16, Crossing)>,
    sorted: Vec<Crossing>,
    /// Where in `sorted` the crossings of each ray lie.
    places: Vec<Range<u32>>,
}

const _: () = assert!(CHUNK - 1 <= u16::MAX as usize, "ray numbers fit 16 bits");

impl CrossingLists {
    /// The crossings of the ray with this number in its chunk.
    pub(crate) fn of(&self, ray: usize) -> &[Crossing] {
        let Range { start, end } = self.places[ray];
        &self.sorted[start as usize..end as usize]
    }

    /// Bring what was offered for so many rays into order.
    fn sort(&mut self, rays: usize) {
        self.places.clear();
        self.places.resize(rays, 0..0);
        for &(ray, _) in &self.offered {
            self.places[usize::from(ray)].end += 1;
        }
        let mut start = 0;
        for place in &mut self.places {
            let count = place.end;
            *place = start..start;
            start += count;
        }
        self.sorted.clear();
        self.sorted.resize(self.offered.len(), Crossing::default());
        for &(ray, crossing) in &self.offered {
            let place = &mut self.places[usize::from(ray)];
            self.sorted[place.end as usize] = crossing;
            place.end += 1;
        }
        for place in &mut self.places {
            let list = &mut self.sorted[place.start as usize..place.end as usize];
            list.sort_unstable_by(Crossing::order);
            place.end = place.start + without_repetitions(list) as u32;
        }
    }
}

/// Keep the first of equal neighbours; returns how many are kept, at the beginning. Spatial splits offer a primitive once
/// for each part that a ray meets.
fn without_repetitions(list: &mut [Crossing]) -> usize {
    let mut kept = 0;
    for index in 0..list.len() {
        if kept == 0 || list[index] != list[kept - 1] {
            list[kept] = list[index];
            kept += 1;
        }
    }
    kept
}

/// Keeps everything that is offered, as far as there is room.
struct Every<'a> {
    offered: &'a mut Vec<(u16, Crossing)>,
    room: usize,
    first: usize,
    filter: Option<Filter<'a>>,
}

impl Goal for Every<'_> {
    const EVERY_CROSSING: bool = true;

    #[inline(always)]
    fn offer(&mut self, ray: usize, t: f32, primitive: u32, _: f32) -> Option<f32> {
        if self.filter.is_some_and(|sees| !sees(self.first + ray, primitive)) {
            return None;
        }
        self.offered.push((ray as u16, Crossing { t, primitive }));
        (self.offered.len() > self.room).then_some(f32::NEG_INFINITY)
    }
}

impl Query<'_> {
    /// Every crossing of the rays `chunk`, at most [`CHUNK`], of `rays`; `None` if the walk finds more than `room`, of
    /// which some may be found repeatedly. Then `lists` is not to be used.
    pub(crate) fn crossings(
        &self,
        rays: Rays<'_>,
        chunk: Range<usize>,
        filter: Option<Filter<'_>>,
        room: usize,
        lists: &mut CrossingLists,
        scratch: &mut Scratch,
    ) -> Option<Counts> {
        lists.offered.clear();
        let mut goal = Every { offered: &mut lists.offered, room, first: chunk.start, filter };
        let counts = self.walk(rays, chunk.clone(), &mut goal, scratch);
        if lists.offered.len() > room {
            return None;
        }
        lists.sort(chunk.len());
        Some(counts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Primitives, Sphere};
    use crate::math::Vec3f;
    use crate::ray::{HitBatch, Ray, RayBatch};
    use crate::tree::{Tree, TreeKind, WalkKind};
    use simd::Level;

    /// Concentric shells, each of them twice.
    fn shells(count: u32) -> Primitives {
        let mut primitives = Primitives::new();
        for shell in (0..count).chain(0..count) {
            primitives.push_sphere(Sphere { center: Vec3f::ZERO, radius: 1.0 + shell as f32 });
        }
        primitives
    }

    fn rays() -> RayBatch {
        let mut rays = RayBatch::default();
        for index in 0..100u32 {
            let origin = Vec3f::new(index as f32 * 0.1 - 5.0, 0.3, -20.0);
            rays.push(&Ray { t_max: 5.0 + index as f32, ..Ray::new(origin, Vec3f::new(0.0, 0.0, 1.0)) });
        }
        rays
    }

    fn with_query<T>(primitives: &Primitives, work: impl FnOnce(&Query<'_>) -> T) -> T {
        let tree = Tree::build(primitives, &TreeKind::Best.into());
        work(&Query { tree: &tree, primitives, level: Level::best(), walk: WalkKind::Auto })
    }

    #[test]
    fn lists_are_what_is_found_hit_by_hit() {
        let (primitives, rays) = (shells(12), rays());
        with_query(&primitives, |query| {
            let (mut lists, mut scratch) = (CrossingLists::default(), Scratch::default());
            let all = Rays::from(&rays);
            assert!(query.crossings(all, 0..all.len(), None, usize::MAX, &mut lists, &mut scratch).is_some());
            let mut after = vec![(f32::NEG_INFINITY, 0); all.len()];
            let (mut hits, mut places) = (HitBatch::default(), vec![0; all.len()]);
            loop {
                query.next_hit(all, &mut after, &mut hits, &mut scratch);
                let mut any = false;
                for index in (0..all.len()).filter(|&index| hits.get(index).is_hit()) {
                    let crossing = lists.of(index)[places[index]];
                    assert_eq!((crossing.t, crossing.primitive), after[index], "ray {index}");
                    places[index] += 1;
                    any = true;
                }
                if !any {
                    break;
                }
            }
            assert!((0..all.len()).all(|index| places[index] == lists.of(index).len()));
            assert!(places.iter().any(|&count| count > 20));
        });
    }

    #[test]
    fn what_has_no_room_is_given_up() {
        let (primitives, rays) = (shells(12), rays());
        with_query(&primitives, |query| {
            let (mut lists, mut scratch) = (CrossingLists::default(), Scratch::default());
            let all = Rays::from(&rays);
            assert!(query.crossings(all, 0..all.len(), None, 100, &mut lists, &mut scratch).is_none());
            assert!(lists.offered.len() <= 100 + all.len() + 1, "rays end when there is no room left");
        });
    }
}
