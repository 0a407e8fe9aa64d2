//! Watching a walk, at no cost where nobody does.

use super::NodeId;
use std::ops::AddAssign;

/// Told what a walk does with one ray. `t` are parameters of the ray.
pub trait Observer {
    /// A plane of the tree is compared with the ray, which is in its cell between these parameters.
    #[inline(always)]
    fn step(&mut self, _node: NodeId, _interval: [f32; 2]) {}
    /// A leaf, or a cell of a grid (which has its number as its node), is reached.
    #[inline(always)]
    fn leaf(&mut self, _node: NodeId, _interval: [f32; 2]) {}
    /// A primitive is tested.
    #[inline(always)]
    fn test(&mut self, _primitive: u32) {}
    /// A hit becomes the best so far.
    #[inline(always)]
    fn accept(&mut self, _t: f32, _primitive: u32) {}
}

/// Watches nothing.
impl Observer for () {}

/// Counts of what walks did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Steps {
    /// Planes compared, or for a grid cells entered.
    pub steps: u64,
    /// Leaves, or cells of a grid, reached.
    pub leaves: u64,
    /// Primitives tested.
    pub tests: u64,
}

impl Observer for Steps {
    #[inline(always)]
    fn step(&mut self, _: NodeId, _: [f32; 2]) {
        self.steps += 1;
    }

    #[inline(always)]
    fn leaf(&mut self, _: NodeId, _: [f32; 2]) {
        self.leaves += 1;
    }

    #[inline(always)]
    fn test(&mut self, _: u32) {
        self.tests += 1;
    }
}

impl AddAssign for Steps {
    fn add_assign(&mut self, other: Self) {
        self.steps += other.steps;
        self.leaves += other.leaves;
        self.tests += other.tests;
    }
}
