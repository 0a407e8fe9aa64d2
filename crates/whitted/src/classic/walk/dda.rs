//! The walk through a grid, cell by cell (Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987).
//!
//! Unlike theirs it adds nothing up: where a ray leaves a cell is computed from the cell's own plane, so that errors do
//! not grow along the way.

use super::Walker;
use crate::classic::grid::Grid;
use crate::classic::math::Arithmetic;
use crate::classic::node::NodeId;
use crate::classic::observer::Observer;
use crate::classic::ray::PlaneRay;
use crate::ray::NONE;
use crate::tree::Goal;

/// Walk the grid, in which the ray is during `interval`.
#[inline(always)]
pub(in crate::classic) fn walk<M: Arithmetic, G: Goal, O: Observer>(
    grid: &Grid,
    ray: &PlaneRay,
    [start, end]: [f32; 2],
    walker: &mut Walker<'_, M, G, O>,
) {
    let mut mailbox = Mailbox::default();
    let mut cell = grid.cell_of(walker.ray.origin + walker.ray.direction * start);
    let mut exits = [0, 1, 2].map(|axis| leaves(grid, ray, axis, cell[axis]));
    let mut entry = start;
    loop {
        let axis = earliest(exits);
        let (exit, number) = (exits[axis], grid.number(cell));
        walker.observer.step(NodeId(number as u32), [entry, exit]);
        walker.observer.leaf(NodeId(number as u32), [entry, exit]);
        for &id in grid.objects(number) {
            if !(G::ENDS_RAYS && walker.has_ended()) && mailbox.is_new(id) {
                walker.test(id);
            }
        }
        // What was hit may lie in another cell: it ends the ray only within this one.
        if !(exit < end && exit < walker.limit) {
            return;
        }
        let next = if ray.inverse[axis] > 0.0 { cell[axis] + 1 } else { cell[axis].wrapping_sub(1) };
        if next >= grid.resolution()[axis] {
            return;
        }
        (cell[axis], entry) = (next, exit);
        exits[axis] = leaves(grid, ray, axis, next);
    }
}

/// Where the ray leaves a layer of cells; infinite if it runs along it.
#[inline(always)]
fn leaves(grid: &Grid, ray: &PlaneRay, axis: usize, layer: usize) -> f32 {
    let inverse = ray.inverse[axis];
    if inverse.is_infinite() {
        return f32::INFINITY;
    }
    let upper = usize::from(inverse > 0.0);
    (grid.plane(axis, layer + upper) - ray.origin[axis]) * inverse
}

/// The axis of the smallest one.
#[inline(always)]
fn earliest([x, y, z]: [f32; 3]) -> usize {
    let y_first = usize::from(y < x);
    if z < if y < x { y } else { x } { 2 } else { y_first }
}

/// The last objects that were tested, so that one which lies in many cells is tested about once (Amanatides and Woo
/// note the ray with the object; this notes objects with the ray, which threads can share).
struct Mailbox([u32; SLOTS]);

const SLOTS: usize = 16;

impl Default for Mailbox {
    fn default() -> Self {
        Self([NONE; SLOTS])
    }
}

impl Mailbox {
    /// Whether an object was not tested lately; it is now.
    #[inline(always)]
    fn is_new(&mut self, id: u32) -> bool {
        std::mem::replace(&mut self.0[id as usize % SLOTS], id) != id
    }
}
