//! What a surface is like at one point: made once per hit, after traversal.

use crate::math::{Vec3d, Vec3f};

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

/// A point of a shape in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapePoint {
    /// Where: on the surface to the precision of `f64`.
    pub position: Vec3d,
    /// Unit normal: out of a closed shape, away from the axis of an open one, to the front side of a flat one.
    pub normal: Vec3d,
    /// Texture coordinates; each shape says which.
    pub uv: [f64; 2],
}

impl ShapePoint {
    /// The point in single precision; `extent` is the size of the shape.
    ///
    /// Shapes are intersected in `f64`, so what can be mistaken is the start of the ray: `position` lies within
    /// √3/2 ulp of its largest coordinate from the surface and the offset point is rounded once more, together below
    /// 4 · 2⁻²⁴ of that coordinate. 2⁻⁴⁰ of the extent covers the arithmetic of `f64` thousands of times over and keeps
    /// the bound above zero at the origin.
    pub fn rounded(&self, extent: f64) -> SurfacePoint {
        const ROUNDING: f64 = 4.0 / (1u64 << 24) as f64;
        const ARITHMETIC: f64 = 1.0 / (1u64 << 40) as f64;
        let normal = self.normal.to_f32();
        SurfacePoint {
            position: self.position.to_f32(),
            n_g: normal,
            n_s: normal,
            uv: self.uv.map(|a| a as f32),
            error: (self.position.abs().max_component() * ROUNDING + extent * ARITHMETIC) as f32,
        }
    }
}
