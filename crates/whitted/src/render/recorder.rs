//! Listening to what happens to rays.

use super::lighting::Sent;
use super::queue::TaggedRays;
use super::scatter::Scattered;
use super::vertex::Vertex;
use crate::math::{Vec3, Vec3f};
use crate::shading::one::One;
use crate::tree::Occlusion;
use simd::F32Lanes;

/// Which of the two rays that leave a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Branch {
    Reflected,
    Refracted,
}

/// Why a ray that leaves a surface is not traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Untraced {
    /// It could contribute less than the settings ask for.
    Weight,
    /// The surface is as deep as the settings allow.
    Depth,
    /// Its sample has no rays left.
    Budget,
    /// The surface reflects totally: there is no such ray, and its direction means nothing.
    TotalReflection,
}

/// Told which rays that leave surfaces are not traced, and why.
pub(super) trait Cuts<L: F32Lanes> {
    /// The rays of these lanes are not traced.
    fn untraced(&mut self, branch: Branch, lanes: L::Mask, rays: &TaggedRays<L>, why: Untraced);
}

/// Told everything that happens to rays which are traced one after the other, in this order.
pub(super) trait Recorder: Cuts<One> {
    /// A sample begins at this place, in pixels from the upper left corner of the picture.
    fn begins(&mut self, place: [f32; 2]);
    /// The ray that waited last is traced.
    fn visits(&mut self, rays: &TaggedRays<One>);
    /// It hits nothing; its sample gains `light`.
    fn misses(&mut self, light: Vec3<One>);
    /// It hits a surface; its sample gains `light`, whatever the lamps do.
    fn hits(&mut self, vertex: &Vertex<One>, light: Vec3<One>);
    /// A lamp, by its number, sends light there; `outcome` is none if the surface looks away from it.
    fn lit(&mut self, lamp: usize, sent: &Sent<One>, outcome: Option<Occlusion>, light: Vec3f);
    /// These rays leave the surface and wait; `None` if there are none.
    fn scatters(&mut self, scattered: Option<&Scattered<One>>);
}

/// Listens to nothing and costs nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Unrecorded;

impl<L: F32Lanes> Cuts<L> for Unrecorded {
    #[inline(always)]
    fn untraced(&mut self, _: Branch, _: L::Mask, _: &TaggedRays<L>, _: Untraced) {}
}

impl Recorder for Unrecorded {
    #[inline(always)]
    fn begins(&mut self, _: [f32; 2]) {}
    #[inline(always)]
    fn visits(&mut self, _: &TaggedRays<One>) {}
    #[inline(always)]
    fn misses(&mut self, _: Vec3<One>) {}
    #[inline(always)]
    fn hits(&mut self, _: &Vertex<One>, _: Vec3<One>) {}
    #[inline(always)]
    fn lit(&mut self, _: usize, _: &Sent<One>, _: Option<Occlusion>, _: Vec3f) {}
    #[inline(always)]
    fn scatters(&mut self, _: Option<&Scattered<One>>) {}
}
