//! Which binary nodes become wide nodes, and which leaves: the cheapest choice.
//!
//! A subtree of the binary tree may stand in a wide node as one child (a leaf, or a wide node of its own) or be opened and
//! stand as several. What that costs at best is known bottom-up for each number of children: as many as its two halves
//! have together, divided in the cheapest way (Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through
//! Compressed Wide BVHs", HPG 2017, §3.1, for 16 children instead of 8).

use super::cost;
use crate::tree::node::WIDTH;
use simd::{F32Lanes, Kernel, Level, Simd};

/// `[i]`: the expected cost of a subtree as at most `i + 1` children, times the half area of the root.
pub(super) type Costs = [f32; WIDTH];

/// The choices at an interior node, packed: bit 0 is set if it is a leaf where it stands alone; four bits from
/// `4·children − 4` on say how many of 2 to 16 children its left half takes, 0 if it is better off with one child less.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan([u32; 2]);

impl Plan {
    fn new(bits: u64) -> Self {
        Self([bits as u32, (bits >> 32) as u32])
    }

    fn bits(self) -> u64 {
        u64::from(self.0[0]) | u64::from(self.0[1]) << 32
    }

    /// True if a subtree that stands alone is a leaf.
    pub(super) fn is_leaf(self) -> bool {
        self.bits() & 1 != 0
    }

    /// How many of `children` (2 to 16) the left half takes; `None` to take one child less. Never `None` for 16.
    pub(super) fn left_share(self, children: usize) -> Option<usize> {
        let share = (self.bits() >> (4 * children - 4)) as usize % WIDTH;
        (share > 0).then_some(share)
    }
}

/// Plan an interior node of half area `area`, whose halves cost `left` and `right`. `left_leaves`: how many leaves are
/// under the left one; `leaf_cost`: the cost as one leaf, infinite if it cannot be one.
pub(super) fn join(
    level: Level,
    area: f32,
    [left, right]: [&Costs; 2],
    left_leaves: usize,
    leaf_cost: f32,
) -> (Costs, Plan) {
    let (mut costs, shares) = simd::dispatch(level, Shares { left, right, left_leaves });
    let node_cost = area * cost::WIDE_NODE + costs[WIDTH - 1];
    costs[0] = leaf_cost.min(node_cost);
    let mut bits = u64::from(leaf_cost <= node_cost);
    for children in 2..=WIDTH {
        let lane = children - 1;
        // A node that is opened as far as it goes has two children at least.
        if costs[lane] < costs[lane - 1] || children == WIDTH {
            bits |= (shares[lane] as u64) << (4 * lane);
        }
        costs[lane] = costs[lane].min(costs[lane - 1]);
    }
    (costs, Plan::new(bits))
}

/// The cheapest way to divide each number of children between two halves, and the left one's share.
struct Shares<'a> {
    left: &'a Costs,
    right: &'a Costs,
    left_leaves: usize,
}

impl Kernel for Shares<'_> {
    type Output = (Costs, [f32; WIDTH]);

    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Self::Output {
        // The right costs after infinite ones: a window that begins `share` earlier is shifted by `share`.
        let mut right = [f32::INFINITY; 2 * WIDTH];
        right[WIDTH..].copy_from_slice(self.right);
        let mut best = S::F32x16::splat(token, f32::INFINITY);
        let mut shares = S::F32x16::splat(token, 0.0);
        for share in 1..WIDTH.min(self.left_leaves + 1) {
            let cost = S::F32x16::splat(token, self.left[share - 1])
                + S::F32x16::load_slice(token, &right[WIDTH - share..2 * WIDTH - share]);
            let better = cost.lt(best);
            best = S::F32x16::select(better, cost, best);
            shares = S::F32x16::select(better, S::F32x16::splat(token, share as f32), shares);
        }
        let (mut costs, mut stored) = ([0.0; WIDTH], [0.0; WIDTH]);
        best.store(&mut costs);
        shares.store(&mut stored);
        (costs, stored)
    }
}
