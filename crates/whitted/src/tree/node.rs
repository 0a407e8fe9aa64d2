//! The nodes of the production tree: sixteen boxes on a grid.

use super::leaf::LeafKind;
use crate::math::{Aabb, Vec3f};
use simd::{F32Lanes, Simd};

/// Children of a node.
pub(super) const WIDTH: usize = 16;

/// A node: the boxes of 16 children as rows of 16-bit numbers, six cache lines.
///
/// Full coordinates would take nine lines, and rays that have little in common wait for memory most of the time. Bytes
/// would take four, but their grid is too coarse for the thin boxes of walls: mirror rays in Sponza lose a tenth, and in
/// scenes far larger than the caches nothing is gained over six lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Lower x, y, z, then upper x, y, z, as steps of the grid, rounded outward.
    planes: [[u16; WIDTH]; 6],
    /// Where the grid begins.
    origin: [f32; 3],
    /// Distance of its lines: of 8 bits, so that its products with 16-bit numbers are exact.
    step: [f32; 3],
    /// Bit `i` is set if lane `i` has a box.
    boxes: u16,
    /// What the boxes hold.
    child: [u32; WIDTH],
    /// For each octant of ray directions with z positive (bit a set: component a negative) the lanes from far to near.
    order: [[u8; WIDTH]; 4],
}

const _: () = assert!(size_of::<Node>() == 384 && align_of::<Node>() == 64, "six whole cache lines");

/// Lines of the grid, less one.
const LAST: f32 = 65535.0;

impl Node {
    /// No children.
    pub(super) const EMPTY: Self = Self {
        planes: [[0; WIDTH]; 6],
        origin: [0.0; 3],
        step: [1.0; 3],
        boxes: 0,
        child: [Child::UNUSED.0; WIDTH],
        order: [[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]; 4],
    };

    /// A node of these boxes, `children[i]` being what the i-th holds. No ray enters an empty box.
    pub(super) fn new(boxes: &[Aabb; WIDTH], children: &[Child; WIDTH]) -> Self {
        let mut node = Self { child: children.map(|child| child.0), ..Self::EMPTY };
        let all = boxes.iter().filter(|bounds| !bounds.is_empty()).fold(Aabb::EMPTY, |all, &one| all.union(one));
        for lane in (0..WIDTH).filter(|&lane| !boxes[lane].is_empty()) {
            node.boxes |= 1 << lane;
        }
        if node.boxes != 0 {
            for axis in 0..3 {
                node.fit_grid(axis, all);
                node.place(axis, boxes);
            }
        }
        node.sort();
        node
    }

    /// Choose the grid of an axis.
    fn fit_grid(&mut self, axis: usize, all: Aabb) {
        let (lo, hi) = (all.lo[axis], all.hi[axis]);
        let mut step = of_8_bits((hi - lo) / LAST);
        while lo + LAST * step < hi {
            step = of_8_bits(step.next_up());
        }
        (self.origin[axis], self.step[axis]) = (lo, step);
    }

    /// Round the boxes outward to the grid of an axis.
    fn place(&mut self, axis: usize, boxes: &[Aabb; WIDTH]) {
        let (origin, step) = (self.origin[axis], self.step[axis]);
        let line = |number: f32| origin + number * step;
        for lane in (0..WIDTH).filter(|&lane| !boxes[lane].is_empty()) {
            let (lo, hi) = (boxes[lane].lo[axis], boxes[lane].hi[axis]);
            let mut below = ((lo - origin) / step).floor().clamp(0.0, LAST);
            while line(below) > lo {
                below -= 1.0;
            }
            let mut above = ((hi - origin) / step).ceil().clamp(0.0, LAST);
            while line(above) < hi {
                above += 1.0;
            }
            self.planes[axis][lane] = below as u16;
            self.planes[3 + axis][lane] = above as u16;
        }
    }

    /// The lanes that have a box, as bits.
    #[inline(always)]
    pub(super) fn boxes(&self) -> u16 {
        self.boxes
    }

    /// The planes of a row of all boxes: lower x, y, z, then upper x, y, z. Lanes without a box may hold anything.
    #[inline(always)]
    pub(super) fn planes<S: Simd>(&self, token: S, row: usize) -> S::F32x16 {
        let axis = row % 3;
        let (step, origin) = (S::F32x16::splat(token, self.step[axis]), S::F32x16::splat(token, self.origin[axis]));
        // The product is exact: it does not matter how often this rounds.
        token.shorts(&self.planes[row]).mul_add_fast(step, origin)
    }

    /// The children as bits.
    #[inline(always)]
    pub(super) fn children(&self) -> &[u32; WIDTH] {
        &self.child
    }

    /// What the box of a lane holds.
    #[inline(always)]
    pub(super) fn child(&self, lane: usize) -> Child {
        Child(self.child[lane])
    }

    /// The lanes from far to near, for rays of an octant.
    #[inline(always)]
    pub(super) fn order(&self, octant: usize) -> [u8; WIDTH] {
        // What is far the one way is near the other way.
        const MIRRORED: usize = 7;
        let order = self.order[octant.min(MIRRORED - octant) % 4];
        let mut reversed = order;
        reversed.reverse();
        if octant < 4 { order } else { reversed }
    }

    /// The box of a lane as stored; empty if it has none.
    pub(super) fn bounds(&self, lane: usize) -> Aabb {
        if self.boxes >> lane & 1 == 0 {
            return Aabb::EMPTY;
        }
        let plane = |row: usize| self.origin[row % 3] + f32::from(self.planes[row][lane]) * self.step[row % 3];
        Aabb::new([0, 1, 2].map(plane).into(), [3, 4, 5].map(plane).into())
    }

    /// By how much a box may be larger than what it was made from.
    pub(super) fn step(&self) -> [f32; 3] {
        self.step
    }

    /// Sort the lanes by the distance of their centres along each octant's diagonal, far to near.
    fn sort(&mut self) {
        let centers: [Vec3f; WIDTH] = std::array::from_fn(|lane| self.bounds(lane).center());
        for octant in 0..4 {
            let mut distance = [0.0; WIDTH];
            for (distance, center) in distance.iter_mut().zip(&centers) {
                let along: f32 = (0..3).map(|a| if octant >> a & 1 == 0 { center[a] } else { -center[a] }).sum();
                // The centre of the empty box is NaN: any place will do.
                *distance = if along.is_nan() { 0.0 } else { along };
            }
            for lane in 0..WIDTH {
                self.order[octant][rank(&distance, lane)] = lane as u8;
            }
        }
    }
}

/// How many others lie farther than `lane`, or as far with a lower number: counting is faster than a sort.
fn rank(distance: &[f32; WIDTH], lane: usize) -> usize {
    let mut before = 0;
    for other in 0..WIDTH {
        let farther = distance[other] > distance[lane];
        before += u32::from(farther | ((distance[other] == distance[lane]) & (other < lane)));
    }
    before as usize
}

/// The smallest number of 8 bits that is positive, normal and not below `value`.
fn of_8_bits(value: f32) -> f32 {
    const DROPPED: u32 = (1 << 16) - 1;
    f32::from_bits((value.max(f32::MIN_POSITIVE).to_bits() + DROPPED) & !DROPPED)
}

/// An interior node or a run of leaf blocks, in 32 bits.
///
/// Interior: the node's index, below 2³¹. Leaf: bit 31, kind in bits 29–30, blocks less one in bits 25–28, first block
/// in bits 0–24.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Child(pub u32);

/// What a [`Child`] stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ChildKind {
    Interior(usize),
    Leaf { kind: LeafKind, first: usize, count: usize },
}

/// Most blocks that one leaf can hold; larger ones become several.
pub(super) const MAX_LEAF_BLOCKS: usize = 16;
const MAX_BLOCK: usize = 1 << 25;

impl Child {
    /// What a lane without a box holds.
    pub(super) const UNUSED: Self = Self(u32::MAX);

    pub(super) const fn interior(index: usize) -> Self {
        assert!(index < 1 << 31, "node index fits 31 bits");
        Self(index as u32)
    }

    pub(super) fn leaf(kind: LeafKind, first: usize, count: usize) -> Self {
        assert!(first < MAX_BLOCK && (1..=MAX_LEAF_BLOCKS).contains(&count), "leaf fits its fields");
        Self(1 << 31 | (kind as u32) << 29 | (count as u32 - 1) << 25 | first as u32)
    }

    #[inline(always)]
    pub(super) fn decode(self) -> ChildKind {
        if self.0 >> 31 == 0 {
            return ChildKind::Interior(self.0 as usize);
        }
        let kind = match self.0 >> 29 & 3 {
            0 => LeafKind::Triangles,
            1 => LeafKind::Spheres,
            _ => LeafKind::Shapes,
        };
        let count = (self.0 >> 25 & 15) as usize + 1;
        ChildKind::Leaf { kind, first: self.0 as usize & (MAX_BLOCK - 1), count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SplitMix64;

    fn nasty(rng: &mut SplitMix64) -> f32 {
        let scale = [0.0, 1e-30, 1e-6, 0.1, 1.0, 1.9][rng.below(6) as usize];
        (rng.uniform(-1.0, 1.0) * scale) as f32
    }

    #[test]
    fn boxes_on_the_grid_hold_the_boxes() {
        let mut rng = SplitMix64::new(3);
        for _ in 0..20_000 {
            let mut boxes = [Aabb::EMPTY; WIDTH];
            for bounds in &mut boxes[..1 + rng.below(16) as usize] {
                let [a, b] = [(), ()].map(|()| Vec3f::new(nasty(&mut rng), nasty(&mut rng), nasty(&mut rng)));
                *bounds = Aabb::new(a.min(b), a.max(b));
            }
            let node = Node::new(&boxes, &[Child::interior(0); WIDTH]);
            for lane in 0..WIDTH {
                let (stored, exact) = (node.bounds(lane), boxes[lane]);
                assert_eq!(stored.is_empty(), exact.is_empty());
                if exact.is_empty() {
                    continue;
                }
                assert!(stored.contains(exact), "{stored:?} {exact:?}");
                for axis in 0..3 {
                    // Two lines, and the rounding of the sum.
                    let most = 2.0 * node.step[axis] + 3e-7;
                    let gap = (exact.lo[axis] - stored.lo[axis]).max(stored.hi[axis] - exact.hi[axis]);
                    assert!(gap <= most, "{stored:?} {exact:?}");
                }
            }
        }
    }
}
