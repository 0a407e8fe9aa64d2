//! The node of the paper (§2.3.2): a plane or a leaf in 8 bytes, children in pairs, four pairs to a cache line.

/// One node: a plane with an index of the children, or a leaf with an index of its objects.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(super) struct Node {
    /// Position of the plane as the bits of an `f32`, or the number of objects of a leaf.
    value: u32,
    /// In the two lowest bits the axis, or [`LEAF`]; above them the pair of the children, or the first object.
    tagged: u32,
}

/// Two children, the right one after the left, at a boundary of 16 bytes.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
pub(super) struct Pair(pub(super) [Node; 2]);

/// Four pairs: a cache line, at its boundary.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Line(pub(super) [Pair; PAIRS]);

/// Pairs in a cache line.
pub(super) const PAIRS: usize = 4;

const _: () = assert!(size_of::<Node>() == 8 && align_of::<Node>() == 4);
const _: () = assert!(size_of::<Pair>() == 16 && align_of::<Pair>() == 16);
const _: () = assert!(size_of::<Line>() == 64 && align_of::<Line>() == 64);

const TAG_BITS: u32 = 2;
const LEAF: u32 = 3;

/// The largest number of pairs and of references to objects.
pub(super) const MAX_INDEX: usize = 1 << (u32::BITS - TAG_BITS);

/// What a node says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Content {
    /// A plane across `axis`; `pair` holds what lies below and above it.
    Interior { axis: usize, plane: f32, pair: usize },
    /// A range of the references.
    Leaf { first: usize, count: usize },
}

impl Node {
    /// `pair` < [`MAX_INDEX`], `axis` < 3.
    pub(super) fn interior(axis: usize, plane: f32, pair: usize) -> Self {
        Self { value: plane.to_bits(), tagged: (pair as u32) << TAG_BITS | axis as u32 }
    }

    /// `first` < [`MAX_INDEX`].
    pub(super) fn leaf(first: usize, count: usize) -> Self {
        Self { value: count as u32, tagged: (first as u32) << TAG_BITS | LEAF }
    }

    #[inline(always)]
    pub(super) fn content(self) -> Content {
        let (tag, index) = (self.tagged & LEAF, (self.tagged >> TAG_BITS) as usize);
        match tag {
            LEAF => Content::Leaf { first: index, count: self.value as usize },
            axis => Content::Interior { axis: axis as usize, plane: f32::from_bits(self.value), pair: index },
        }
    }
}

/// A node's place: twice the number of its pair, plus one for the right child. The root is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub u32);

impl NodeId {
    /// Where every walk begins.
    pub const ROOT: Self = Self(0);

    /// The lower or the upper child in `pair`.
    #[inline(always)]
    pub(super) fn child(pair: usize, upper: bool) -> Self {
        Self((pair as u32) << 1 | u32::from(upper))
    }

    /// Line, pair in it, node in that.
    #[inline(always)]
    pub(super) fn place(self) -> (usize, usize, usize) {
        let id = self.0 as usize;
        (id / (2 * PAIRS), id / 2 % PAIRS, id % 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_keep_what_they_are_given() {
        for axis in 0..3 {
            for (plane, pair) in [(-0.0, 0), (1.5, 7), (f32::MIN_POSITIVE, MAX_INDEX - 1)] {
                assert_eq!(Node::interior(axis, plane, pair).content(), Content::Interior { axis, plane, pair });
            }
        }
        for (first, count) in [(0, 0), (5, 3), (MAX_INDEX - 1, u32::MAX as usize)] {
            assert_eq!(Node::leaf(first, count).content(), Content::Leaf { first, count });
        }
    }
}
