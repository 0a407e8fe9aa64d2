//! Every passage of rays through surfaces, in order: the definition.
//!
//! A ray that goes exactly through an edge hits both triangles that share it, one through a vertex all around it. Of such
//! hits, which share their edge or vertex (by the places of its ends) and their side, as many are kept as the ray hits
//! when it is moved aside by an infinitesimal amount ([`geometry::passage`](crate::geometry)): one where the surface
//! goes on, and two or none where the ray only touches it. The first of them are kept, so that the first of all hits is
//! the closest hit, unless that is a touch. A line that touches a sphere passes it as often as it is moved into it:
//! even, counted as not at all.

use super::goal::Goal;
use super::query::{CHUNK, chunks};
use super::{Counts, Filter, Query, Scratch};
use crate::geometry::{Kind, Seam, ShearedRay};
use crate::ray::{Hit, HitLists, NONE, Ray, Rays};
use std::cmp::Ordering;

/// A primitive that a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    /// The number of the ray in its chunk.
    ray: u16,
    t: f32,
    primitive: u32,
}

const _: () = assert!(CHUNK - 1 <= u16::MAX as usize, "ray numbers fit 16 bits");

impl Found {
    fn order(&self, other: &Self) -> Ordering {
        self.ray.cmp(&other.ray).then(self.t.total_cmp(&other.t)).then(self.primitive.cmp(&other.primitive))
    }
}

/// Keeps everything that is offered.
struct Every<'a> {
    found: &'a mut Vec<Found>,
    first: usize,
    filter: Option<Filter<'a>>,
}

impl Goal for Every<'_> {
    const EVERY_CROSSING: bool = true;

    #[inline(always)]
    fn offer(&mut self, ray: usize, t: f32, primitive: u32, _: f32) -> Option<f32> {
        if self.filter.is_none_or(|sees| sees(self.first + ray, primitive)) {
            self.found.push(Found { ray: ray as u16, t, primitive });
        }
        None
    }
}

/// Memory for one ray's hits.
#[derive(Debug, Default)]
pub(super) struct Sieve {
    found: Vec<Found>,
    /// Which of a ray's hits are kept.
    kept: Vec<bool>,
    /// Of a ray's hits those at edges and vertices: where, number, and whether the moved ray hits too.
    seams: Vec<(Seam, usize, bool)>,
}

impl Query<'_> {
    /// Every passage of each ray through a surface, in the order of (t, primitive): one list for each ray is appended to
    /// `lists`. t never decreases in a list: where two surfaces lie within its rounding, the later takes the t of the
    /// earlier.
    ///
    /// An edge or vertex that triangles share counts once where the surface goes on beyond it; where a ray only touches
    /// a surface, at an edge or vertex that all triangles there leave to the same side or at the outline of a sphere,
    /// it passes twice or not at all. So a closed surface is passed an odd number of times by exactly those rays that
    /// begin inside it and go on for ever.
    pub fn all_hits<'r>(
        &self,
        rays: impl Into<Rays<'r>>,
        filter: Option<Filter<'_>>,
        lists: &mut HitLists,
        scratch: &mut Scratch,
    ) -> Counts {
        let rays = rays.into();
        let mut sieve = std::mem::take(&mut scratch.sieve);
        let mut counts = Counts::default();
        for chunk in chunks(rays.len()) {
            sieve.found.clear();
            let mut goal = Every { found: &mut sieve.found, first: chunk.start, filter };
            counts += self.walk(rays, chunk.clone(), &mut goal, scratch);
            // Spatial splits offer a primitive once for each part that a ray meets.
            sieve.found.sort_unstable_by(Found::order);
            sieve.found.dedup();
            let mut next = 0;
            for index in chunk.clone() {
                let start = next;
                let of_ray = |found: &&Found| usize::from(found.ray) == index - chunk.start;
                next += sieve.found[start..].iter().take_while(of_ray).count();
                if next > start {
                    let ray = rays.get(index);
                    sieve.sift(self, &ray, start..next);
                    self.append(&ray, &sieve, start..next, lists);
                }
                lists.end();
            }
        }
        scratch.sieve = sieve;
        counts
    }

    /// Append the hits that are kept.
    fn append(&self, ray: &Ray, sieve: &Sieve, range: std::ops::Range<usize>, lists: &mut HitLists) {
        for (found, _) in sieve.found[range].iter().zip(&sieve.kept).filter(|(_, kept)| **kept) {
            let refined = self.primitives.refine(ray, found.t, found.primitive);
            let t = lists.last().map_or(refined.t, |before| refined.t.max(before.t));
            lists.push(Hit { t, u: refined.u, v: refined.v, primitive: found.primitive, instance: NONE });
        }
    }

    /// How often the line of `ray` meets a primitive without edges at `t`, in single precision.
    fn meetings(&self, ray: &Ray, found: &Found) -> usize {
        let crossings = super::brute_force::crossings_of(self.tree, self.primitives, ray, found.primitive);
        crossings.as_slice().iter().filter(|&&t| t as f32 == found.t).count()
    }
}

impl Sieve {
    /// Decide which of the hits `range`, all those of `ray`, are kept.
    fn sift(&mut self, query: &Query<'_>, ray: &Ray, range: std::ops::Range<usize>) {
        let scale = query.tree.scale();
        let sheared = ShearedRay::new(ray.origin * scale, ray.direction * scale);
        self.kept.clear();
        self.seams.clear();
        for (index, found) in self.found[range].iter().enumerate() {
            self.kept.push(match query.primitives.kind(found.primitive) {
                Kind::Triangle(triangle) => {
                    let passage = query.primitives.triangle(triangle).passage(&sheared, scale);
                    self.seams.extend(passage.seam.map(|seam| (seam, index, passage.passes)));
                    passage.seam.is_none()
                }
                // A surface that is met twice at the same place is left as soon as it is entered.
                Kind::Sphere(_) | Kind::Shape(_) | Kind::Plane(_) => query.meetings(ray, found) % 2 == 1,
            });
        }
        self.seams.sort_unstable();
        for seam in self.seams.chunk_by(|a, b| a.0 == b.0) {
            let passes = seam.iter().filter(|(_, _, passes)| *passes).count();
            seam.iter().take(passes).for_each(|&(_, index, _)| self.kept[index] = true);
        }
    }
}
