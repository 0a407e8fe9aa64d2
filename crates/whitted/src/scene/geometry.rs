//! Where everything is: primitives in internal space, their tree, and whose they are.

use super::{Scene, SceneError, Space};
use crate::geometry::Primitives;
use crate::math::{Aabb, Affine, Vec3, Vec3d, Vec3f};
use crate::scene::Mesh;
use crate::tree::{BuildOptions, Stop, Tree};

/// The part of a prepared scene that is costly to make and that no colour, light or camera changes.
#[derive(Debug)]
pub struct Geometry {
    pub(crate) space: Space,
    pub(crate) primitives: Primitives,
    pub(crate) tree: Tree,
    /// For each mesh, the number of triangles in it and the meshes before it.
    mesh_ends: Vec<u32>,
    /// Around everything bounded.
    bounds: Aabb,
    dropped: usize,
}

impl Geometry {
    /// Bring the shapes of `scene` into internal space and build the tree. `None` if `stop` said so.
    ///
    /// # Errors
    /// A mesh with impossible indices or attributes, or more primitives than can be numbered. Primitives that are
    /// degenerate or not finite are no error: they are never hit, and [`dropped`](Self::dropped) counts them.
    pub(super) fn new(scene: &Scene, options: &BuildOptions, stop: Stop<'_>) -> Result<Option<Self>, SceneError> {
        let (primitives, space) = scene.primitives()?;
        let dropped = (0..primitives.bounded_count() as u32).filter(|&id| primitives.primitive_bounds(id).is_none());
        let dropped = dropped.count();
        let mesh_ends = scene.meshes.iter().scan(0, |end, mesh| {
            *end += mesh.triangles.len() as u32;
            Some(*end)
        });
        let mesh_ends = mesh_ends.collect();
        let bounds = primitives.bounds();
        let tree = Tree::build_until(&primitives, options, stop);
        Ok(tree.map(|tree| Self { space, tree, bounds, mesh_ends, dropped, primitives }))
    }

    /// The primitives, in internal space.
    pub fn primitives(&self) -> &Primitives {
        &self.primitives
    }

    /// The tree over them.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The box around everything bounded, in internal space; empty if there is nothing.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The map from world space to internal space.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// Bounded primitives that can never be hit: zero extent, or a coordinate that is not finite.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// The object to which a primitive belongs: meshes first, then spheres, shapes and planes, each in the scene's
    /// order.
    pub fn object(&self, primitive: u32) -> u32 {
        let triangles = self.mesh_ends.last().copied().unwrap_or(0);
        if primitive < triangles {
            return self.mesh_ends.partition_point(|&end| end <= primitive) as u32;
        }
        self.mesh_ends.len() as u32 + (primitive - triangles)
    }
}

impl Scene {
    /// Triangles, spheres, shapes and planes together.
    pub fn primitive_count(&self) -> usize {
        let triangles: usize = self.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        triangles + self.spheres.len() + self.shapes.len() + self.planes.len()
    }

    /// The shapes alone, in internal space, and the map to it: for queries about a scene that nobody renders.
    ///
    /// # Errors
    /// A mesh with impossible indices or attributes, or more primitives than can be numbered.
    pub fn primitives(&self) -> Result<(Primitives, Space), SceneError> {
        let (lo, hi) = bounds(self);
        let space = Space::around(lo, hi);
        Ok((primitives(self, &space)?, space))
    }
}

/// The corners of a box around everything bounded and finite, in world space; an empty box if there is nothing.
fn bounds(scene: &Scene) -> (Vec3d, Vec3d) {
    let spheres = scene.spheres.iter().flat_map(|&(center, radius, _)| {
        let corner = Vec3d::splat(radius.abs());
        [center - corner, center + corner]
    });
    let shapes = scene.shapes.iter().map(|(shape, _)| shape.bounds()).flat_map(|b| [b.lo.to_f64(), b.hi.to_f64()]);
    let vertices = scene.meshes.iter().flat_map(|mesh| mesh.positions.iter().map(|p| world_position(mesh, *p)));
    let empty = (Vec3d::splat(f64::INFINITY), Vec3d::splat(f64::NEG_INFINITY));
    spheres.chain(shapes).chain(vertices).filter(|p| p.is_finite()).fold(empty, |(lo, hi), p| (lo.min(p), hi.max(p)))
}

fn world_position(mesh: &Mesh, position: [f32; 3]) -> Vec3d {
    let local = Vec3::from(position).to_f64() + mesh.origin;
    // The identity is common, and not all its products are: 0 · ∞ would spread one bad coordinate to the others.
    if mesh.transform == Affine::IDENTITY { local } else { mesh.transform.point(local) }
}

fn primitives(scene: &Scene, space: &Space) -> Result<Primitives, SceneError> {
    let mut primitives = Primitives::new();
    for mesh in &scene.meshes {
        push_mesh(&mut primitives, mesh, space).map_err(|error| SceneError::Mesh { mesh: mesh.name.clone(), error })?;
    }
    scene.spheres.iter().for_each(|&(center, radius, _)| primitives.push_sphere(space.sphere(center, radius)));
    scene.shapes.iter().for_each(|(shape, _)| primitives.push_shape(space.shape(shape)));
    scene.planes.iter().for_each(|(plane, _)| primitives.push_plane(space.plane(plane)));
    if primitives.len() > i32::MAX as usize {
        return Err(SceneError::TooManyPrimitives(primitives.len()));
    }
    Ok(primitives)
}

fn push_mesh(primitives: &mut Primitives, mesh: &Mesh, space: &Space) -> Result<(), crate::geometry::MeshError> {
    let positions: Vec<Vec3f> = mesh.positions.iter().map(|p| space.point_f32(world_position(mesh, *p))).collect();
    // A reflection turns the mesh inside out: its triangles turn with it (their vertices are where they are), and so do
    // its normals, by the cofactor matrix.
    let normals: Vec<Vec3f> = match mesh.transform == Affine::IDENTITY {
        true => mesh.normals.iter().map(|&n| n.into()).collect(),
        false => mesh.normals.iter().map(|&n| world_normal(&mesh.transform, n)).collect(),
    };
    primitives.push_mesh(&positions, &mesh.triangles, &normals, &mesh.uvs)
}

/// The normal after the transform, normalised so that it fits single precision; zero where there is none.
fn world_normal(transform: &Affine, normal: [f32; 3]) -> Vec3f {
    let turned = transform.normal(Vec3::from(normal).to_f64());
    let turned = turned / turned.abs().max_component();
    let unit = turned.normalize();
    if unit.is_finite() { unit.to_f32() } else { Vec3f::ZERO }
}
