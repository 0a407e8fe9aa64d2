//! The scene as the user described it.

use super::{Camera, Settings};
use crate::geometry::{Plane, Shape};
use crate::math::{Affine, Vec3d, Vec3f};
use crate::shading::Material;

/// A scene: plain data, nothing derived.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Cameras; the first is the default one. None: one is placed automatically.
    pub cameras: Vec<NamedCamera>,
    /// Lights. None: the readers of bare meshes add a rig, a renderer does not.
    pub lights: Vec<Light>,
    /// Light that reaches every point from everywhere; multiplies each material's `ambient`.
    pub ambient: Vec3f,
    /// What a ray sees that hits nothing.
    pub background: Background,
    /// Materials; objects refer to them by index.
    pub materials: Vec<NamedMaterial>,
    /// Spheres: centre, radius (a negative one counts by its size), material.
    pub spheres: Vec<(Vec3d, f64, u32)>,
    /// Discs, boxes, cylinders, cones with their materials.
    pub shapes: Vec<(Shape, u32)>,
    /// Unbounded planes with their materials.
    pub planes: Vec<(Plane, u32)>,
    /// Triangle meshes.
    pub meshes: Vec<Mesh>,
    /// What the picture shall be like.
    pub settings: Settings,
}

impl Scene {
    /// What to call an object, by the number that [`Geometry::object`](super::Geometry::object) gives it: `mesh 'cup.obj'`,
    /// `sphere 3` (counted from 1 within its kind).
    pub fn object_name(&self, object: u32) -> String {
        let mut index = object as usize;
        if let Some(mesh) = self.meshes.get(index) {
            return if mesh.name.is_empty() { format!("mesh {}", index + 1) } else { format!("mesh '{}'", mesh.name) };
        }
        index -= self.meshes.len();
        if index < self.spheres.len() {
            return format!("sphere {}", index + 1);
        }
        index -= self.spheres.len();
        if let Some((shape, _)) = self.shapes.get(index) {
            let alike = self.shapes[..=index].iter().filter(|(other, _)| other.kind() == shape.kind());
            return format!("{} {}", shape.kind(), alike.count());
        }
        format!("plane {}", index - self.shapes.len() + 1)
    }
}

/// A camera with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedCamera {
    /// The name by which the user chooses it.
    pub name: String,
    /// The camera.
    pub camera: Camera,
}

/// A material with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMaterial {
    /// The name by which objects refer to it.
    pub name: String,
    /// The material.
    pub material: Material,
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is or whence it comes.
    pub kind: LightKind,
    /// Linear colour times intensity, each component ≥ 0.
    pub color: Vec3f,
    /// False: intensity does not depend on distance (the paper's lights). True: divided by the square of the distance
    /// in scene units. Has no effect on directional lights.
    pub inverse_square: bool,
}

/// The kinds of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Shines from one point in all directions.
    Point {
        /// The point.
        position: Vec3d,
    },
    /// Shines from infinitely far.
    Directional {
        /// The direction in which the light travels; need not be normalised.
        direction: Vec3d,
    },
    /// Shines from one point into a cone.
    Spot {
        /// The point.
        position: Vec3d,
        /// A point in the middle of the cone.
        look_at: Vec3d,
        /// Half angle in degrees within which the light is full.
        inner: f64,
        /// Half angle in degrees beyond which there is no light; smooth between.
        outer: f64,
    },
}

/// What a ray sees that hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// One linear colour.
    Color(Vec3f),
    /// From `down` (direction −y) over the horizon to `up` (direction +y), linear in the y component of the direction.
    Gradient {
        /// Linear colour straight down.
        down: Vec3f,
        /// Linear colour straight up.
        up: Vec3f,
    },
}

impl Default for Background {
    fn default() -> Self {
        Self::Color(Vec3f::ZERO)
    }
}

/// An indexed triangle mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Where it came from, for messages.
    pub name: String,
    /// Vertex positions relative to [`origin`](Self::origin).
    pub positions: Vec<[f32; 3]>,
    /// Added to every position, in double precision: keeps meshes exact that lie far from the world's origin.
    pub origin: Vec3d,
    /// Triangles as vertex numbers, all below `positions.len()`.
    pub triangles: Vec<[u32; 3]>,
    /// One shading normal per vertex, need not be normalised; or empty for a faceted mesh.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates per vertex, or empty.
    pub uvs: Vec<[f32; 2]>,
    /// Applied to `origin + position`.
    pub transform: Affine,
    /// Material of every triangle that has none of its own.
    pub material: u32,
    /// Material of each triangle, or empty.
    pub triangle_materials: Vec<u32>,
}

impl Default for Mesh {
    fn default() -> Self {
        Self {
            name: String::new(),
            positions: Vec::new(),
            origin: Vec3d::ZERO,
            triangles: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
            transform: Affine::IDENTITY,
            material: 0,
            triangle_materials: Vec::new(),
        }
    }
}
