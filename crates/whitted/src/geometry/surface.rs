//! What a surface is like at one point: made once per hit, after traversal.

use crate::math::Vec3f;

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where, as near to the true surface as `f32` allows.
    pub position: Vec3f,
    /// Geometric unit normal: out of a closed shape, or by the right-hand rule of a triangle's vertices.
    pub n_g: Vec3f,
    /// Shading unit normal: interpolated where the mesh has normals, else [`n_g`](Self::n_g); on the same side as it.
    pub n_s: Vec3f,
    /// Texture coordinates; 0 where the primitive has none.
    pub uv: [f32; 2],
    /// A bound on the distance, in scene units, within which intersection arithmetic for a ray that starts near
    /// `position` can mistake on which side of the surface it starts. Secondary rays leave from an offset by it.
    pub error: f32,
}
