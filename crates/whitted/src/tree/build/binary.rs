//! The binary tree that the builder makes, before it becomes wide.

use super::plan::Plan;
use crate::math::Aabb;
use crate::tree::leaf::LeafKind;

/// A node of the binary tree. All nodes lie in one array, children before parents: first everything under the left child
/// and the child itself, then the same of the right one, then the parent. So an array can be joined from pieces.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    pub bounds: Aabb,
    pub content: Content,
}

/// What is in a node.
#[derive(Clone, Copy, Debug)]
pub(super) enum Content {
    /// `right`: number of nodes under and including the right child.
    Interior { right: u32, plan: Plan },
    /// A range of references, all of one kind.
    Leaf { first: u32, count: u32, kind: LeafKind },
}

const _: () = assert!(size_of::<BinaryNode>() == 40, "no padding");

/// A node with everything under it: the nodes from `index + 1 - len` to `index`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Subtree {
    pub index: usize,
    pub len: usize,
}

impl Subtree {
    /// Left and right child of an interior node.
    pub(super) fn children(self, right: u32) -> [Self; 2] {
        let right = right as usize;
        [Self { index: self.index - 1 - right, len: self.len - 1 - right }, Self { index: self.index - 1, len: right }]
    }
}
