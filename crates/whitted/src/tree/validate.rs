//! The tree checks itself.

use super::leaf::LeafKind;
use super::node::{Child, ChildKind, Node, WIDTH};
use super::wide::Tree;
use crate::geometry::{Kind, Primitives};
use crate::math::{Aabb, Vec3f};

/// Check every invariant of `tree` over `primitives`; the first violation is the error.
pub(super) fn validate(tree: &Tree, primitives: &Primitives) -> Result<(), String> {
    if tree.kind() == super::TreeKind::None {
        return Ok(());
    }
    let mut covered = vec![Aabb::EMPTY; primitives.bounded_count()];
    let mut visited = vec![false; tree.nodes.len()];
    let mut pending = vec![(0, Aabb::EMPTY, 1)];
    while let Some((index, outer, level)) = pending.pop() {
        check_visit(tree, &mut visited, index, level)?;
        let node = &tree.nodes[index];
        check_orders(node, index)?;
        for lane in 0..WIDTH {
            let bounds = node.bounds(lane);
            if node.child(lane) == Child::UNUSED {
                continue;
            }
            // The grids of parent and child differ: either may round outward by a step.
            if level > 1 && !bounds.is_empty() && !outer.contains(shrunk(bounds, node.step())) {
                return Err(format!("node {index} lane {lane}: box {bounds:?} leaves its parent's {outer:?}"));
            }
            match node.child(lane).decode() {
                ChildKind::Interior(child) => pending.push((child, bounds, level + 1)),
                ChildKind::Leaf { kind, first, count } => {
                    for id in tree.leaves.primitives(kind, first, count) {
                        check_kind(primitives, id, kind)?;
                        covered[id as usize] = covered[id as usize].union(bounds);
                    }
                }
            }
        }
    }
    if let Some(index) = visited.iter().position(|&v| !v) {
        return Err(format!("node {index} is not reachable"));
    }
    check_cover(tree, primitives, &covered)
}

fn check_visit(tree: &Tree, visited: &mut [bool], index: usize, level: usize) -> Result<(), String> {
    if index >= visited.len() || std::mem::replace(&mut visited[index], true) {
        return Err(format!("node {index} of {} is missing or has two parents", tree.nodes.len()));
    }
    if level > tree.depth() {
        return Err(format!("node {index} lies on level {level}, beyond the depth {}", tree.depth()));
    }
    Ok(())
}

fn check_orders(node: &Node, index: usize) -> Result<(), String> {
    for order in (0..8).map(|octant| node.order(octant)) {
        let seen = order.iter().fold(0u32, |seen, &lane| seen | 1 << lane);
        if seen != 0xffff {
            return Err(format!("node {index}: {order:?} is not a permutation"));
        }
    }
    let stray = |lane: &usize| node.child(*lane) == Child::UNUSED && !node.bounds(*lane).is_empty();
    if let Some(lane) = (0..WIDTH).find(stray) {
        return Err(format!("node {index} lane {lane}: a box without a child"));
    }
    Ok(())
}

/// A box less a step on all sides; a point if that is more than there is.
fn shrunk(bounds: Aabb, step: [f32; 3]) -> Aabb {
    let step = Vec3f::from(step);
    let (lo, hi) = (bounds.lo + step, bounds.hi - step);
    Aabb::new(lo.min(bounds.center()), hi.max(bounds.center()))
}

fn check_kind(primitives: &Primitives, id: u32, kind: LeafKind) -> Result<(), String> {
    let right = matches!(
        (primitives.kind(id), kind),
        (Kind::Triangle(_), LeafKind::Triangles)
            | (Kind::Sphere(_), LeafKind::Spheres)
            | (Kind::Shape(_), LeafKind::Shapes)
    );
    if right { Ok(()) } else { Err(format!("primitive {id} lies in a leaf of {kind:?}")) }
}

/// Every sound primitive must be inside the union of the boxes of its leaves; cut ones are covered piecewise.
fn check_cover(tree: &Tree, primitives: &Primitives, covered: &[Aabb]) -> Result<(), String> {
    for (id, covered) in covered.iter().enumerate() {
        let Some(bounds) = primitives.primitive_bounds(id as u32) else {
            // It may be in the tree: it was sound before a refit.
            continue;
        };
        let scaled = Aabb::new(bounds.lo * tree.scale(), bounds.hi * tree.scale());
        if !covered.contains(scaled) {
            return Err(format!("primitive {id}: {scaled:?} is not covered by {covered:?}"));
        }
    }
    Ok(())
}
