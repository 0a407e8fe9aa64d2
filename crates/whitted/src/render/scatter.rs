//! The rays that leave vertices, in lanes: mirrored and refracted, their weights and their media.

use super::context::Context;
use super::media::Media;
use super::queue::{Tag, TaggedRays};
use super::recorder::{Branch, Cuts, Untraced};
use super::rows::{array, array_f32, lanes_of};
use super::samples::Samples;
use super::vertex::Vertex;
use crate::math::{Vec3, select};
use crate::ray::NONE;
use crate::shading::{Scattering, lanes};
use simd::{F32Lanes, MaskLanes, U32Lanes};

/// Rays that may descend from one camera ray, itself included.
///
/// Bounds the work of a sample whatever the depth; up to depth 15 nothing is ever lost to it. A vertex divides what is
/// left among its rays by their weights, so that the bound does not depend on the order of work, and long paths of
/// glass keep most of it.
pub(super) const RAYS_PER_SAMPLE: u32 = 1 << 16;

/// Rays that leave vertices, in the lanes where there are any.
pub(super) struct Child<L: F32Lanes> {
    pub(super) exists: L::Mask,
    pub(super) rays: TaggedRays<L>,
}

/// The rays that leave vertices.
pub(super) struct Scattered<L: F32Lanes> {
    pub(super) reflected: Child<L>,
    pub(super) refracted: Child<L>,
}

impl<L: F32Lanes> Scattered<L> {
    /// The rays of one branch.
    pub(super) fn branch(&self, branch: Branch) -> &Child<L> {
        match branch {
            Branch::Reflected => &self.reflected,
            Branch::Refracted => &self.refracted,
        }
    }
}

/// What is on the two sides of surfaces.
struct Interface<L: F32Lanes> {
    /// Index of refraction on the side of the viewer, divided by that of the other side.
    eta: L,
    /// What a ray is inside of after crossing.
    beyond: Media<L::U32>,
}

impl<L: F32Lanes> Vertex<L> {
    /// The rays that leave the surfaces here and are worth tracing; `generation` is that of the arriving rays. Counts
    /// what is traced and what is not, and tells `cuts` why not. `None` if nothing leaves.
    #[inline(always)]
    pub(super) fn scatter(
        &self,
        token: L::Token,
        context: &Context,
        generation: u32,
        samples: &mut Samples,
        cuts: &mut impl Cuts<L>,
    ) -> Option<Scattered<L>> {
        let scatters = self.active & self.finish.scatters(token);
        if !scatters.any() {
            return None;
        }
        // Two variables, and no loop over them: as one in memory they were copied for 3 % of a picture's time.
        let Scattered { mut reflected, mut refracted } = self.scatter_all(token, context, scatters, cuts);
        if generation >= context.settings.depth {
            reflected.end(Branch::Reflected, samples, cuts);
            refracted.end(Branch::Refracted, samples, cuts);
            return None;
        }
        samples.statistics.media_overflows += count(refracted.exists & refracted.rays.tag.media.overflowed(token));
        let least = L::splat(token, context.settings.min_weight);
        reflected.cut_light(Branch::Reflected, least, samples, cuts);
        refracted.cut_light(Branch::Refracted, least, samples, cuts);
        let left = self.tag.budget - L::U32::splat(token, 1);
        share_budget(token, left, &mut reflected, &mut refracted, context.settings.depth - generation);
        reflected.cut_starved(token, Branch::Reflected, samples, cuts);
        refracted.cut_starved(token, Branch::Refracted, samples, cuts);
        samples.statistics.reflected_rays += count(reflected.exists);
        samples.statistics.refracted_rays += count(refracted.exists);
        Some(Scattered { reflected, refracted })
    }

    /// Both rays in the lanes `scatters`, whatever their weight.
    #[inline(always)]
    fn scatter_all(
        &self,
        token: L::Token,
        context: &Context,
        scatters: L::Mask,
        cuts: &mut impl Cuts<L>,
    ) -> Scattered<L> {
        let material = context.look.table().scattering::<L>(self.material);
        let transparent = scatters & self.finish.is_transparent(token);
        let interface = self.interface(token, context, transparent, &material);
        let (through, refracts) = self.refracted(token, transparent, interface.eta);
        let total = transparent & !refracts;
        let (reflect, transmit) = material.split(token, self.n_s.dot(self.view), interface.eta, total);
        let up = self.off_surface(self.error);
        let down = self.off_surface(self.error * L::splat(token, -1.0));
        let all = Scattered {
            reflected: self.child(token, scatters, reflect, up, self.mirrored(token), self.tag.media),
            refracted: self.child(token, refracts, transmit, down, through, interface.beyond),
        };
        cuts.untraced(Branch::Refracted, total, &all.refracted.rays, Untraced::TotalReflection);
        all
    }

    /// The rays from `origin` along `direction` that carry a share of the light, where that is not zero.
    #[inline(always)]
    fn child(
        &self,
        token: L::Token,
        exists: L::Mask,
        share: Vec3<L>,
        origin: Vec3<L>,
        direction: Vec3<L>,
        media: Media<L::U32>,
    ) -> Child<L> {
        let tag = Tag { weight: self.tag.weight.times(share), media, ..self.tag };
        let exists = exists & share.largest().gt(L::splat(token, 0.0));
        Child { exists, rays: TaggedRays { origin, direction, tag } }
    }

    /// What the surfaces separate. Opaque bodies are never entered: their index serves Fresnel's equations only.
    #[inline(always)]
    fn interface(
        &self,
        token: L::Token,
        context: &Context,
        transparent: L::Mask,
        material: &Scattering<L>,
    ) -> Interface<L> {
        let here = &self.tag.media;
        if !context.look.table().has_transparent() {
            return Interface { eta: L::splat(token, 1.0) / material.ior, beyond: *here };
        }
        let crossed =
            Media::select(self.entering, &here.entered(token, self.material), &here.left(token, self.material));
        let beyond = Media::select(transparent, &crossed, here);
        let index_beyond = L::select(transparent, self.index_in(token, context, &beyond), material.ior);
        Interface { eta: self.index_in(token, context, here) / index_beyond, beyond }
    }

    /// The index of refraction of the innermost medium; 1 outside of all.
    #[inline(always)]
    fn index_in(&self, token: L::Token, context: &Context, media: &Media<L::U32>) -> L {
        let medium = media.innermost();
        let inside = self.active & !medium.eq(L::U32::splat(token, NONE));
        context.look.table().ior(token, inside, medium)
    }

    /// The mirrored directions. Where the shading normal would send one below the surface, the geometric one is taken.
    #[inline(always)]
    fn mirrored(&self, token: L::Token) -> Vec3<L> {
        let direction = lanes::mirrored(token, -self.view, self.n_s);
        let above = direction.dot(self.n_g).gt(L::splat(token, 0.0));
        select(above, direction, lanes::mirrored(token, -self.view, self.n_g))
    }

    /// The refracted directions and the lanes of `transparent` that have one: the others reflect totally. Where the
    /// shading normal would send one above the surface, the geometric one is taken.
    #[inline(always)]
    fn refracted(&self, token: L::Token, transparent: L::Mask, eta: L) -> (Vec3<L>, L::Mask) {
        if !transparent.any() {
            return (self.view, transparent);
        }
        let (direction, refracts) = lanes::refracted(token, -self.view, self.n_s, eta);
        let refracts = transparent & refracts;
        let below = direction.dot(self.n_g).lt(L::splat(token, 0.0));
        if !(refracts & !below).any() {
            return (direction, refracts);
        }
        let (other, other_refracts) = lanes::refracted(token, -self.view, self.n_g, eta);
        (select(below, direction, other), refracts & (below | other_refracts))
    }
}

impl<L: F32Lanes> Child<L> {
    /// None of them is traced: their surfaces are as deep as the settings allow.
    #[inline(always)]
    fn end(&self, branch: Branch, samples: &mut Samples, cuts: &mut impl Cuts<L>) {
        samples.statistics.cut_by_depth += count(self.exists);
        cuts.untraced(branch, self.exists, &self.rays, Untraced::Depth);
    }

    /// Those that could contribute less than `least` are not traced.
    #[inline(always)]
    fn cut_light(&mut self, branch: Branch, least: L, samples: &mut Samples, cuts: &mut impl Cuts<L>) {
        let heavy = self.rays.tag.weight.largest().ge(least);
        let cut = self.exists & !heavy;
        if cut.any() {
            samples.cut::<L>(cut, self.rays.tag.sample);
            cuts.untraced(branch, cut, &self.rays, Untraced::Weight);
        }
        self.exists = self.exists & heavy;
    }

    /// Those without budget are not traced.
    #[inline(always)]
    fn cut_starved(&mut self, token: L::Token, branch: Branch, samples: &mut Samples, cuts: &mut impl Cuts<L>) {
        let starved = self.exists & self.rays.tag.budget.eq(L::U32::splat(token, 0));
        samples.statistics.cut_by_budget += count(starved);
        cuts.untraced(branch, starved, &self.rays, Untraced::Budget);
        self.exists = self.exists & !starved;
    }
}

/// Divide the budget `left` of the arriving rays among their children by weight. A child gets at least one ray, or is not
/// traced, and none gets more than all its descendants could need.
#[inline(always)]
fn share_budget<L: F32Lanes>(token: L::Token, left: L::U32, a: &mut Child<L>, b: &mut Child<L>, generations_left: u32) {
    let both = a.exists & b.exists;
    let most = L::U32::splat(token, most_rays(generations_left));
    let scarce = both & left.shr::<1>().lt(most);
    let each = L::U32::select(both, most, left);
    let [for_a, for_b] = match scarce.any() {
        false => [each, each],
        true => {
            let weights = [a.rays.tag.weight.largest(), b.rays.tag.weight.largest()];
            share_scarce(token, scarce, left, weights, each, generations_left)
        }
    };
    (a.rays.tag.budget, b.rays.tag.budget) = (for_a, for_b);
}

/// Divide budgets that do not suffice, lane by lane: only paths deeper than 15 meet this. The others get `each`.
#[inline(never)]
fn share_scarce<L: F32Lanes>(
    token: L::Token,
    scarce: L::Mask,
    left: L::U32,
    weights: [L; 2],
    each: L::U32,
    generations_left: u32,
) -> [L::U32; 2] {
    let (left, weights) = (array::<L>(left), weights.map(array_f32));
    let mut budgets = [each; 2].map(array::<L>);
    for lane in lanes_of(scarce.bits()) {
        let weights = [weights[0].as_ref()[lane], weights[1].as_ref()[lane]];
        let [first, second] = shares(left.as_ref()[lane], weights, generations_left);
        (budgets[0].as_mut()[lane], budgets[1].as_mut()[lane]) = (first, second);
    }
    [L::U32::load(token, &budgets[0]), L::U32::load(token, &budgets[1])]
}

#[inline(always)]
fn count<M: MaskLanes>(mask: M) -> u64 {
    u64::from(mask.bits().count_ones())
}

/// All rays of a full binary tree of so many generations.
fn most_rays(generations: u32) -> u32 {
    1u32.checked_shl(generations).map_or(u32::MAX, |nodes| nodes - 1)
}

/// `left` rays divided among two that may have `generations_left` generations, themselves included, by their weights.
fn shares(left: u32, [a, b]: [f32; 2], generations_left: u32) -> [u32; 2] {
    let most = most_rays(generations_left);
    if left / 2 >= most {
        return [most, most];
    }
    if left < 2 {
        return if a >= b { [left, 0] } else { [0, left] };
    }
    let proportional = f64::from(left) * (f64::from(a) / (f64::from(a) + f64::from(b)));
    let share = (proportional as u32).clamp(left.saturating_sub(most).max(1), most.min(left - 1));
    [share, left - share]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shallow_trees_get_all_they_need() {
        let mut budget = RAYS_PER_SAMPLE;
        for generations_left in (1..=15).rev() {
            let [light, heavy] = shares(budget - 1, [1e-30, 1.0], generations_left);
            assert_eq!([light, heavy], [(1 << generations_left) - 1; 2]);
            budget = light;
        }
    }

    #[test]
    fn deep_trees_are_bounded_and_follow_the_weight() {
        let (mut budget, mut depth) = (RAYS_PER_SAMPLE, 0);
        while budget > 1 {
            let [light, heavy] = shares(budget - 1, [0.04, 0.96], 1000 - depth);
            assert!(light + heavy < budget);
            (budget, depth) = (heavy, depth + 1);
        }
        assert!(depth > 100, "only {depth} generations");
    }

    #[test]
    fn the_last_ray_goes_to_the_heavier() {
        assert_eq!(shares(1, [0.5, 0.4], 20), [1, 0]);
        assert_eq!(shares(1, [0.3, 0.4], 20), [0, 1]);
        assert_eq!(shares(0, [0.3, 0.4], 20), [0, 0]);
        assert_eq!(shares(2, [0.0, f32::NAN], 20), [1, 1]);
    }
}
