//! Our rays in the shapes that Embree reads.

use crate::embree::{INVALID, Lanes, RayHits, Rays, Scene};
use whitted::ray::RayBatch;

/// A packet of rays, with or without room for hits.
pub(crate) trait Packet: Copy {
    /// Rays in a packet.
    const WIDTH: usize;
    /// A packet whose lanes hit nothing.
    const EMPTY: Self;

    /// Fill one lane.
    fn set(&mut self, lane: usize, rays: &RayBatch, index: usize);

    /// Undo what a query wrote into one lane.
    fn reset(&mut self, lane: usize, t_max: f32);

    /// The answer in one lane: t, infinite for a miss; 0 for a blocked ray.
    fn answer(&self, lane: usize) -> f32;

    /// Ask Embree: for closest hits where there is room for them, else for occlusion.
    fn query(scene: &Scene<'_>, packets: &mut [Self], last: &Lanes, coherent: bool);
}

impl<A: Copy, const N: usize> Packet for Rays<A, N> {
    const WIDTH: usize = N;
    const EMPTY: Self = Self {
        alignment: [],
        origin: [[0.0; N]; 3],
        t_min: [0.0; N],
        direction: [[0.0; N]; 3],
        time: [0.0; N],
        t_max: [f32::NEG_INFINITY; N],
        mask: [u32::MAX; N],
        id: [0; N],
        flags: [0; N],
    };

    fn set(&mut self, lane: usize, rays: &RayBatch, index: usize) {
        let ray = rays.get(index);
        for axis in 0..3 {
            self.origin[axis][lane] = ray.origin[axis];
            self.direction[axis][lane] = ray.direction[axis];
        }
        self.t_min[lane] = ray.t_min;
        self.t_max[lane] = ray.t_max;
    }

    fn reset(&mut self, lane: usize, t_max: f32) {
        self.t_max[lane] = t_max;
    }

    fn answer(&self, lane: usize) -> f32 {
        if self.t_max[lane] < 0.0 { 0.0 } else { f32::INFINITY }
    }

    fn query(scene: &Scene<'_>, packets: &mut [Self], last: &Lanes, coherent: bool) {
        scene.occluded(packets, last, coherent);
    }
}

impl<A: Copy, const N: usize> Packet for RayHits<A, N> {
    const WIDTH: usize = N;
    const EMPTY: Self = Self {
        rays: Rays::EMPTY,
        normal: [[0.0; N]; 3],
        u: [0.0; N],
        v: [0.0; N],
        primitive: [INVALID; N],
        geometry: [INVALID; N],
        instance: [[INVALID; N]; 2],
    };

    fn set(&mut self, lane: usize, rays: &RayBatch, index: usize) {
        self.rays.set(lane, rays, index);
    }

    fn reset(&mut self, lane: usize, t_max: f32) {
        self.rays.reset(lane, t_max);
        self.primitive[lane] = INVALID;
        self.geometry[lane] = INVALID;
    }

    fn answer(&self, lane: usize) -> f32 {
        if self.geometry[lane] == INVALID { f32::INFINITY } else { self.rays.t_max[lane] }
    }

    fn query(scene: &Scene<'_>, packets: &mut [Self], last: &Lanes, coherent: bool) {
        scene.closest_hits(packets, last, coherent);
    }
}

/// Packets made from a batch of rays.
pub(crate) struct Packets<P> {
    /// The packets, in the order of the rays.
    packets: Vec<P>,
    /// The lanes of the last packet that hold a ray.
    last: Lanes,
    t_max: Vec<f32>,
}

impl<P: Packet> Packets<P> {
    /// Transpose all rays.
    pub(crate) fn new(rays: &RayBatch) -> Self {
        let mut packets = vec![P::EMPTY; rays.len().div_ceil(P::WIDTH)];
        for index in 0..rays.len() {
            packets[index / P::WIDTH].set(index % P::WIDTH, rays, index);
        }
        let used = rays.len() - packets.len().saturating_sub(1) * P::WIDTH;
        Self { packets, last: Lanes::first(used), t_max: rays.t_max.clone() }
    }

    /// Make the packets as they were before any query.
    pub(crate) fn reset(&mut self) {
        for (index, &t_max) in self.t_max.iter().enumerate() {
            self.packets[index / P::WIDTH].reset(index % P::WIDTH, t_max);
        }
    }

    /// Ask Embree about all rays, packet by packet.
    pub(crate) fn query(&mut self, scene: &Scene<'_>, coherent: bool) {
        P::query(scene, &mut self.packets, &self.last, coherent);
    }

    /// The answers in the order of the rays.
    pub(crate) fn answers(&self) -> Vec<f32> {
        (0..self.t_max.len()).map(|index| self.packets[index / P::WIDTH].answer(index % P::WIDTH)).collect()
    }
}
