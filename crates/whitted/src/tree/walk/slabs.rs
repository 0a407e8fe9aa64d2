//! The box test: one ray against the sixteen boxes of a node.

use super::prepared::NodeRay;
use crate::tree::node::Node;
use simd::{F32Lanes, MaskLanes, Simd};

/// The planes of a node as rays of one octant meet them: three where they enter a box, three where they leave it.
pub(super) struct Slabs<S: Simd> {
    near: [S::F32x16; 3],
    far: [S::F32x16; 3],
    boxes: u16,
}

impl<S: Simd> Slabs<S> {
    /// The planes for rays whose direction is negative along the axes of the set bits of `octant`.
    #[inline(always)]
    pub(super) fn load(token: S, node: &Node, octant: usize) -> Self {
        let [x, y, z] = [octant & 1, octant >> 1 & 1, octant >> 2 & 1];
        Self {
            near: [node.planes(token, 3 * x), node.planes(token, 1 + 3 * y), node.planes(token, 2 + 3 * z)],
            far: [node.planes(token, 3 - 3 * x), node.planes(token, 4 - 3 * y), node.planes(token, 5 - 3 * z)],
            boxes: node.boxes(),
        }
    }

    /// The boxes that the ray enters within its range, and where it enters them.
    ///
    /// `far_offset` is the ray's offset for the planes where it leaves. A NaN from a plane is passed over.
    #[inline(always)]
    pub(super) fn enter(&self, token: S, ray: NodeRay<'_>, far_offset: [f32; 3]) -> (u16, S::F32x16) {
        let inverse = crate::geometry::splat(token, ray.inverse());
        let near = crate::geometry::splat(token, ray.near());
        let far = crate::geometry::splat(token, far_offset);
        let (t_min, limit) = (S::F32x16::splat(token, ray.t_min()), S::F32x16::splat(token, ray.limit()));
        let [x, y, z] = met(self.near, inverse, near);
        let entry = x.max(y).max(z.max(t_min));
        let [x, y, z] = met(self.far, inverse, far);
        let exit = x.min(y).min(z.min(limit));
        (entry.le(exit).bits() as u16 & self.boxes, entry)
    }
}

/// Where a ray meets planes: `plane·inverse + offset`.
#[inline(always)]
fn met<F: F32Lanes>(plane: [F; 3], inverse: [F; 3], offset: [F; 3]) -> [F; 3] {
    [
        plane[0].mul_add_fast(inverse[0], offset[0]),
        plane[1].mul_add_fast(inverse[1], offset[1]),
        plane[2].mul_add_fast(inverse[2], offset[2]),
    ]
}
