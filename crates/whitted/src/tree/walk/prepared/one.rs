//! A single ray, prepared in plain Rust: sixteen lanes and their transposition cost several times as much as one needs.
//!
//! The same formulas as for sixteen: the functions of lanes, at one lane.

use super::records::{Records, offsets, reciprocal, sign};
use super::{PreparedRays, distance, sound};
use crate::geometry::ShearedRay;
use crate::geometry::sphere::SphereRay;
use crate::math::{Vec3, Vec3f};
use crate::ray::Ray;
use crate::tree::Tree;
use simd::{F32Lanes, MaskLanes, Octet, Scalar, ScalarF32, U32Lanes};

type One = ScalarF32<1>;

fn lane(value: f32) -> One {
    One::splat(Scalar, value)
}

fn value(lane: One) -> f32 {
    let mut out = [0.0];
    lane.store(&mut out);
    out[0]
}

impl PreparedRays {
    /// [`begin`](Self::begin) for one ray.
    pub(super) fn begin_one(&mut self, tree: &Tree, ray: &Ray) {
        let scaled = |v: Vec3f| (v * tree.scale()).map(lane);
        let (origin, direction) = (scaled(ray.origin), scaled(ray.direction));
        self.limit[0] = if sound(Scalar, origin, direction).any() { ray.t_max } else { f32::NEG_INFINITY };
        self.any_slack = value(tree.slack(Scalar, distance(origin))) > 0.0;
    }

    /// [`record`](Self::record) for one ray.
    pub(super) fn record_one(&mut self, from: &Records<'_>) {
        let (ray, scale) = (from.rays.get(from.start), from.tree.scale());
        let (origin, direction) = (ray.origin * scale, ray.direction * scale);
        self.record_node(from.tree, origin.map(lane), direction.map(lane), ray.t_min);
        if from.primitives.triangle_count() > 0 {
            let ShearedRay { origin: [ox, oy, oz], shear: [sx, sy, sz], axis, .. } = ShearedRay::new(origin, direction);
            self.sheared[0] = Octet([ox, oy, oz, sx, sy, sz, f32::from_bits(axis), 0.0]);
        }
        if !from.primitives.spheres().is_empty() {
            let SphereRay { origin: [ox, oy, oz], direction: [dx, dy, dz], inverse_length_squared, .. } =
                SphereRay::new(origin, direction);
            self.spheres[0] = Octet([ox, oy, oz, dx, dy, dz, inverse_length_squared, 0.0]);
        }
        self.recorded.insert(0);
    }

    fn record_node(&mut self, tree: &Tree, origin: Vec3<One>, direction: Vec3<One>, t_min: f32) {
        let inverse = Vec3::new(
            reciprocal(Scalar, direction.x),
            reciprocal(Scalar, direction.y),
            reciprocal(Scalar, direction.z),
        );
        let slack = tree.slack(Scalar, distance(origin));
        let x = offsets(origin.x, inverse.x, slack);
        let y = offsets(origin.y, inverse.y, slack);
        let z = offsets(origin.z, inverse.z, slack);
        let [ix, iy, iz, nx, ny, nz] = [inverse.x, inverse.y, inverse.z, x.0, y.0, z.0].map(value);
        self.nodes[0] = Octet([ix, iy, iz, nx, ny, nz, t_min, self.limit[0]]);
        if self.any_slack {
            self.far[0] = [x.1, y.1, z.1].map(value);
        }
        let octant = sign(inverse.x) | sign(inverse.y).shl::<1>() | sign(inverse.z).shl::<2>();
        let mut lanes = [0];
        octant.store(&mut lanes);
        self.octant[0] = lanes[0] as u8;
    }
}
