//! Vectors, boxes, transforms and deterministic random numbers.

mod aabb;
mod affine;
mod angle;
mod random;
mod vec3;

pub use aabb::Aabb;
pub use affine::Affine;
pub use angle::{atan2, sin_cos_degrees};
pub use random::{SplitMix64, hash32};
pub(crate) use vec3::select;
pub use vec3::{Vec3, Vec3d, Vec3f};
