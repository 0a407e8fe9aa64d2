//! Primitives: what they are, where they are, how a ray meets them.
//!
//! One primitive a file: bounds, clipped bounds, intersection, error bound, surface point. [`Shape`] is the closed list
//! of those that are neither triangle nor sphere; [`Primitives`] holds all of a scene in one number space.

mod boxed;
mod cone;
mod cylinder;
mod disc;
mod frustum;
mod passage;
mod plane;
pub(crate) mod primitives;
mod refine;
mod shape;
pub(crate) mod sphere;
mod surface;
pub(crate) mod surfaces;
pub(crate) mod triangle;

pub use boxed::Boxed;
pub use cone::Cone;
pub use cylinder::Cylinder;
pub use disc::Disc;
pub use plane::Plane;
pub use primitives::{Kind, MeshError, Primitives};

pub(crate) use passage::Seam;
pub(crate) use refine::{refine, refine_one_by_one};
pub use shape::{Crossings, Shape};

pub use sphere::Sphere;
pub use surface::{ShapePoint, SurfacePoint};
pub use triangle::{ShearedRay, Triangle};

/// Three scalars as lanes.
///
/// Kernels pass lanes through functions like this one and never through closures: a closure cannot be forced to be
/// inlined, and lane operations that are left outside the dispatched function cost ten times as much.
#[inline(always)]
pub(crate) fn splat<F: simd::F32Lanes>(token: F::Token, [x, y, z]: [f32; 3]) -> [F; 3] {
    [F::splat(token, x), F::splat(token, y), F::splat(token, z)]
}
