//! Vectors, boxes, transforms and deterministic random numbers.

mod aabb;
mod affine;
mod random;
mod vec3;

pub use aabb::Aabb;
pub use affine::Affine;
pub use random::{SplitMix64, hash32};
pub use vec3::{Vec3, Vec3d, Vec3f};
