//! Affine maps of space.

use super::{Vec3, Vec3d};

/// `p ↦ linear · p + translation`, with the linear part by columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Images of the unit vectors.
    pub columns: [Vec3d; 3],
    /// Image of the origin.
    pub translation: Vec3d,
}

impl Affine {
    /// The map that moves nothing.
    pub const IDENTITY: Self = Self {
        columns: [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)],
        translation: Vec3d::ZERO,
    };

    /// Move by `by`.
    pub fn translate(by: Vec3d) -> Self {
        Self { translation: by, ..Self::IDENTITY }
    }

    /// Scale each axis about the origin.
    pub fn scale(by: Vec3d) -> Self {
        let [x, y, z] = Self::IDENTITY.columns;
        Self { columns: [x * by.x, y * by.y, z * by.z], translation: Vec3d::ZERO }
    }

    /// Rotate about the unit vector `axis` by an angle given as its sine and cosine (right-handed).
    pub fn rotate(axis: Vec3d, sin: f64, cos: f64) -> Self {
        let turn = |p: Vec3d| p * cos + axis.cross(p) * sin + axis * (axis.dot(p) * (1.0 - cos));
        Self { columns: Self::IDENTITY.columns.map(turn), translation: Vec3d::ZERO }
    }

    /// First `self`, then `next`.
    pub fn then(self, next: Self) -> Self {
        Self { columns: self.columns.map(|c| next.vector(c)), translation: next.point(self.translation) }
    }

    /// The image of a point.
    pub fn point(&self, p: Vec3d) -> Vec3d {
        self.vector(p) + self.translation
    }

    /// The image of a vector (no translation).
    pub fn vector(&self, v: Vec3d) -> Vec3d {
        let [x, y, z] = self.columns;
        x * v.x + y * v.y + z * v.z
    }

    /// The image of a normal, not normalised: the cofactor matrix, right for any invertible map and mirrored with it.
    pub fn normal(&self, n: Vec3d) -> Vec3d {
        let [x, y, z] = self.columns;
        y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z
    }

    /// Determinant of the linear part: negative for a reflection, 0 if space collapses.
    pub fn determinant(&self) -> f64 {
        let [x, y, z] = self.columns;
        x.dot(y.cross(z))
    }
}
