//! Every passage of rays through surfaces, in order: the definition.
//!
//! A ray that goes exactly through an edge hits both triangles that share it, one through a vertex all around it. Of such
//! hits, which share their edge or vertex (by the places of its ends) and their side, as many are kept as the ray hits
//! when it is moved aside by an infinitesimal amount ([`geometry::passage`](crate::geometry)): one where the surface
//! goes on, and two or none where the ray only touches it. The first of them are kept, so that the first of all hits is
//! the closest hit, unless that is a touch. A line that touches a sphere passes it as often as it is moved into it:
//! even, counted as not at all.

use super::crossings::Crossing;
use super::query::chunks;
use super::{Counts, Filter, Query, Scratch};
use crate::geometry::{Kind, Seam, ShearedRay};
use crate::ray::{Hit, HitLists, NONE, Ray, Rays};

/// Decides which crossings of a ray are hits.
#[derive(Debug, Default)]
pub(super) struct Sieve {
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
        let (mut crossings, mut sieve) = (std::mem::take(&mut scratch.crossings), std::mem::take(&mut scratch.sieve));
        let mut counts = Counts::default();
        for chunk in chunks(rays.len()) {
            let walked = self.crossings(rays, chunk.clone(), filter, usize::MAX, &mut crossings, scratch);
            counts += walked.expect("room without end");
            for index in chunk.clone() {
                let of_ray = crossings.of(index - chunk.start);
                if !of_ray.is_empty() {
                    let ray = rays.get(index);
                    sieve.sift(self, &ray, of_ray);
                    self.append(&ray, of_ray, &sieve.kept, lists);
                }
                lists.end();
            }
        }
        (scratch.crossings, scratch.sieve) = (crossings, sieve);
        counts
    }

    /// Append the hits that are kept.
    fn append(&self, ray: &Ray, crossings: &[Crossing], kept: &[bool], lists: &mut HitLists) {
        for (found, _) in crossings.iter().zip(kept).filter(|(_, kept)| **kept) {
            let refined = self.primitives.refine(ray, found.t, found.primitive);
            let t = lists.last().map_or(refined.t, |before| refined.t.max(before.t));
            lists.push(Hit { t, u: refined.u, v: refined.v, primitive: found.primitive, instance: NONE });
        }
    }

    /// How often the line of `ray` meets a primitive without edges at `t`, in single precision.
    fn meetings(&self, ray: &Ray, found: &Crossing) -> usize {
        let crossings = super::brute_force::crossings_of(self.tree, self.primitives, ray, found.primitive);
        crossings.as_slice().iter().filter(|&&t| t as f32 == found.t).count()
    }
}

impl Sieve {
    /// Decide which of all crossings of `ray` are kept.
    fn sift(&mut self, query: &Query<'_>, ray: &Ray, crossings: &[Crossing]) {
        let scale = query.tree.scale();
        let sheared = ShearedRay::new(ray.origin * scale, ray.direction * scale);
        self.kept.clear();
        self.seams.clear();
        for (index, found) in crossings.iter().enumerate() {
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
