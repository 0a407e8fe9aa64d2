//! The box test: one ray against the sixteen boxes of a node.

use super::prepared::NodeRay;
use crate::geometry::splat;
use crate::tree::node::Node;
use simd::{F32Lanes, MaskLanes, Simd};

/// The planes of a node as rays of one octant meet them: three where they enter a box, three where they leave it.
pub(super) struct Slabs<S: Simd> {
    near: [S::F32x16; 3],
    far: [S::F32x16; 3],
    boxes: u16,
}

/// What the box test needs of a ray, in all lanes: as [`NodeRay`], without the limit.
pub(super) struct SlabRay<F> {
    pub(super) inverse: [F; 3],
    pub(super) near: [F; 3],
    /// As `near`, for the planes where the ray leaves.
    pub(super) far: [F; 3],
    pub(super) t_min: F,
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
    /// `far_offset` is the ray's offset for the planes where it leaves.
    #[inline(always)]
    pub(super) fn enter(&self, token: S, ray: NodeRay<'_>, far_offset: [f32; 3]) -> (u16, S::F32x16) {
        let in_lanes = SlabRay {
            inverse: splat(token, ray.inverse()),
            near: splat(token, ray.near()),
            far: splat(token, far_offset),
            t_min: S::F32x16::splat(token, ray.t_min()),
        };
        self.entered_by(&in_lanes, S::F32x16::splat(token, ray.limit()))
    }

    /// As [`enter`](Self::enter), for a ray that is in lanes. A NaN from a plane is passed over.
    #[inline(always)]
    pub(super) fn entered_by(&self, ray: &SlabRay<S::F32x16>, limit: S::F32x16) -> (u16, S::F32x16) {
        let [x, y, z] = met(self.near, ray.inverse, ray.near);
        let entry = x.max(y).max(z.max(ray.t_min));
        let [x, y, z] = met(self.far, ray.inverse, ray.far);
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
