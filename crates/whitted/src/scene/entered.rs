//! Which boxes of the tree a ray enters, in world space: for pictures of the tree.

use super::{Geometry, Space};
use crate::math::Vec3d;
use crate::ray::Ray;
use crate::tree::Cell;

/// A box of the tree that a ray enters, in world space.
#[derive(Clone, Debug, PartialEq)]
pub struct EnteredBox {
    /// The corner of the smallest coordinates.
    pub lo: Vec3d,
    /// The corner of the largest coordinates.
    pub hi: Vec3d,
    /// Boxes of the tree around it.
    pub level: u32,
    /// Distance along the ray to where it enters.
    pub entry: f64,
    /// Distance along the ray to where it leaves or ends.
    pub exit: f64,
    /// The primitives that are tested there, if it is a leaf; a primitive may lie in several.
    pub primitives: Option<Vec<u32>>,
}

impl Geometry {
    /// The boxes of the tree that a ray from `origin` along the unit vector `direction` enters within `length`: each
    /// after the one around it, and the nearer of two in the same one first.
    ///
    /// With the distance of the first hit as length, these are the boxes that no walk can leave out; a walk may enter
    /// others before it knows of the hit. There are none if the tree is
    /// [`TreeKind::None`](crate::tree::TreeKind::None).
    pub fn boxes_entered(&self, origin: Vec3d, direction: Vec3d, length: f64) -> Vec<EnteredBox> {
        let space = self.space();
        let t_max = (length * space.scale()) as f32;
        let ray = Ray { origin: space.point_f32(origin), direction: direction.to_f32(), t_min: 0.0, t_max };
        self.tree.cells(&ray).into_iter().map(|cell| EnteredBox::new(cell, space)).collect()
    }
}

impl EnteredBox {
    fn new(cell: Cell, space: &Space) -> Self {
        Self {
            lo: space.world(cell.bounds.lo.to_f64()),
            hi: space.world(cell.bounds.hi.to_f64()),
            level: cell.level,
            entry: cell.entry / space.scale(),
            exit: cell.exit / space.scale(),
            primitives: cell.primitives,
        }
    }
}
