//! The rays that leave a vertex: mirrored and refracted, their weights and their media.

use super::context::Context;
use super::media::Media;
use super::queue::Tag;
use super::samples::Samples;
use super::vertex::Vertex;
use crate::math::Vec3f;
use crate::ray::Ray;
use crate::shading::{PreparedMaterial, mirrored, refracted};

/// Rays that may descend from one camera ray, itself included.
///
/// Bounds the work of a sample whatever the depth; up to depth 15 nothing is ever lost to it. A vertex divides what is
/// left among its rays by their weights, so that the bound does not depend on the order of work, and long paths of
/// glass keep most of it.
pub(super) const RAYS_PER_SAMPLE: u32 = 1 << 16;

/// A ray that leaves a vertex, with what it carries.
pub(super) type Child = (Ray, Tag);

/// The rays that leave a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Scattered {
    pub(super) reflected: Option<Child>,
    pub(super) refracted: Option<Child>,
}

/// What is on the two sides of a surface.
struct Interface {
    /// Index of refraction on the side of the viewer, divided by that of the other side.
    eta: f32,
    /// What a ray is inside of after crossing.
    beyond: Media,
}

impl Vertex {
    /// The rays that leave the surface here and are worth tracing; `generation` is that of the arriving ray. Counts
    /// what is traced and what is not.
    pub(super) fn scatter(&self, context: &Context, generation: u32, samples: &mut Samples) -> Scattered {
        let material = context.look.material(self.material);
        if !material.scatters() {
            return Scattered::default();
        }
        let all = self.scatter_all(context, material);
        let counts = &mut samples.statistics;
        if generation >= context.settings.depth {
            counts.cut_by_depth += u64::from(all.reflected.is_some()) + u64::from(all.refracted.is_some());
            return Scattered::default();
        }
        counts.media_overflows += u64::from(all.refracted.is_some_and(|(_, tag)| tag.media.overflowed()));
        let min_weight = context.settings.min_weight;
        let mut heavy = |child: Option<Child>| {
            let kept = child.filter(|(_, tag)| tag.weight.max_component() >= min_weight);
            if child.is_some() && kept.is_none() {
                samples.statistics.cut_by_weight += 1;
                samples.cut(self.tag.sample);
            }
            kept
        };
        let kept = Scattered { reflected: heavy(all.reflected), refracted: heavy(all.refracted) };
        let kept = self.share_budget(kept, context.settings.depth - generation, samples);
        samples.statistics.reflected_rays += u64::from(kept.reflected.is_some());
        samples.statistics.refracted_rays += u64::from(kept.refracted.is_some());
        kept
    }

    /// Both rays, whatever their weight.
    fn scatter_all(&self, context: &Context, material: &PreparedMaterial) -> Scattered {
        let interface = self.interface(context, material);
        let through = if material.is_transparent() { self.refracted(interface.eta) } else { None };
        let (reflect, transmit) = material.split(self.n_s.dot(self.view), interface.eta, through.is_none());
        let child = |share: Vec3f, direction: Vec3f, side: f32, media: Media| {
            let tag = Tag { weight: self.tag.weight.times(share), media, ..self.tag };
            (share.max_component() > 0.0).then(|| (Ray::new(self.off_surface(self.error * side), direction), tag))
        };
        Scattered {
            reflected: child(reflect, self.mirrored(), 1.0, self.tag.media),
            refracted: through.and_then(|direction| child(transmit, direction, -1.0, interface.beyond)),
        }
    }

    /// What the surface separates. Opaque bodies are never entered: their index serves Fresnel's equations only.
    fn interface(&self, context: &Context, material: &PreparedMaterial) -> Interface {
        let index = |media: &Media| media.innermost().map_or(1.0, |medium| context.look.material(medium).ior());
        let here = &self.tag.media;
        if !material.is_transparent() {
            return Interface { eta: index(here) / material.ior(), beyond: *here };
        }
        let beyond = if self.entering { here.entered(self.material) } else { here.left(self.material) };
        Interface { eta: index(here) / index(&beyond), beyond }
    }

    /// The mirrored direction. Where the shading normal would send it below the surface, the geometric one is taken.
    fn mirrored(&self) -> Vec3f {
        let direction = mirrored(-self.view, self.n_s);
        if direction.dot(self.n_g) > 0.0 { direction } else { mirrored(-self.view, self.n_g) }
    }

    /// The refracted direction; `None` for total reflection. Where the shading normal would send it above the surface,
    /// the geometric one is taken.
    fn refracted(&self, eta: f32) -> Option<Vec3f> {
        let direction = refracted(-self.view, self.n_s, eta)?;
        if direction.dot(self.n_g) < 0.0 { Some(direction) } else { refracted(-self.view, self.n_g, eta) }
    }

    /// Divide the budget of the arriving ray, less that ray, among its children by weight. A child gets at least one
    /// ray, or is not traced, and none gets more than all its descendants could need.
    fn share_budget(&self, mut children: Scattered, generations_left: u32, samples: &mut Samples) -> Scattered {
        let left = self.tag.budget - 1;
        let Scattered { reflected, refracted } = &mut children;
        match (reflected.as_mut(), refracted.as_mut()) {
            (Some((_, a)), Some((_, b))) => {
                let weights = [a.weight, b.weight].map(Vec3f::max_component);
                [a.budget, b.budget] = shares(left, weights, generations_left);
            }
            (Some((_, only)), None) | (None, Some((_, only))) => only.budget = left,
            (None, None) => {}
        }
        for child in [reflected, refracted] {
            if child.take_if(|(_, tag)| tag.budget == 0).is_some() {
                samples.statistics.cut_by_budget += 1;
            }
        }
        children
    }
}

/// `left` rays divided among two that may have `generations_left` generations, themselves included, by their weights.
fn shares(left: u32, [a, b]: [f32; 2], generations_left: u32) -> [u32; 2] {
    // All nodes of a full binary tree.
    let most = 1u32.checked_shl(generations_left).map_or(u32::MAX, |nodes| nodes - 1);
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
