//! All primitives of a scene in one number space.

use super::triangle::Refined;
use super::{Plane, Shape, Sphere, SurfacePoint, Triangle};
use crate::math::{Aabb, Vec3f};
use crate::ray::{Hit, Ray};

/// Which kind a primitive is, with its index among its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A triangle.
    Triangle(usize),
    /// A sphere.
    Sphere(usize),
    /// A disc, box, cylinder or cone.
    Shape(usize),
    /// An unbounded plane.
    Plane(usize),
}

/// The primitives, numbered: first the triangles, then spheres, shapes and planes, each in order of insertion.
///
/// Ties in t go to the lower number.
#[derive(Clone, Debug, Default)]
pub struct Primitives {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    spheres: Vec<Sphere>,
    shapes: Vec<Shape>,
    planes: Vec<Plane>,
}

/// What [`Primitives::push_mesh`] refuses.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names vertex {index}, but the mesh has {vertices} vertices")]
    Index {
        /// The triangle, counted from 0 in its mesh.
        triangle: usize,
        /// The vertex that it names.
        index: u32,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// Normals or texture coordinates are neither absent nor one per vertex.
    #[error("{what}: {found} for {vertices} vertices")]
    Attributes {
        /// Which attribute.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// More than 2³¹ vertices or primitives.
    #[error("more than 2147483647 vertices or primitives")]
    TooMany,
}

/// The largest number of vertices and of primitives: numbers must leave room for a tag bit.
const MAX_COUNT: usize = i32::MAX as usize;

impl Primitives {
    /// No primitives.
    pub fn new() -> Self {
        Self::default()
    }

    /// Append a mesh. `normals` and `uvs` are empty or one per vertex; a zero or non-finite normal makes its
    /// triangles faceted.
    ///
    /// # Errors
    /// [`MeshError`]; then nothing is appended.
    pub fn push_mesh(
        &mut self,
        positions: &[Vec3f],
        triangles: &[[u32; 3]],
        normals: &[Vec3f],
        uvs: &[[f32; 2]],
    ) -> Result<(), MeshError> {
        self.check_mesh(positions.len(), triangles, normals.len(), uvs.len())?;
        let first = self.vertices.len();
        self.vertices.extend(positions.iter().map(|p| p.to_array()));
        self.triangles.extend(triangles.iter().map(|t| t.map(|index| index + first as u32)));
        let normals: Vec<_> = normals.iter().map(|n| n.to_array()).collect();
        extend_attribute(&mut self.normals, first, &normals, self.vertices.len(), [0.0; 3]);
        extend_attribute(&mut self.uvs, first, uvs, self.vertices.len(), [0.0; 2]);
        Ok(())
    }

    fn check_mesh(&self, vertices: usize, triangles: &[[u32; 3]], normals: usize, uvs: usize) -> Result<(), MeshError> {
        if self.vertices.len() + vertices > MAX_COUNT || self.len() + triangles.len() > MAX_COUNT {
            return Err(MeshError::TooMany);
        }
        for (what, found) in [("normals", normals), ("texture coordinates", uvs)] {
            if found != 0 && found != vertices {
                return Err(MeshError::Attributes { what, found, vertices });
            }
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= vertices) {
                return Err(MeshError::Index { triangle, index, vertices });
            }
        }
        Ok(())
    }

    /// Append a sphere.
    pub fn push_sphere(&mut self, sphere: Sphere) {
        self.spheres.push(sphere);
    }

    /// Append a disc, box, cylinder or cone.
    pub fn push_shape(&mut self, shape: Shape) {
        self.shapes.push(shape);
    }

    /// Append a plane.
    pub fn push_plane(&mut self, plane: Plane) {
        self.planes.push(plane);
    }

    /// Number of primitives.
    pub fn len(&self) -> usize {
        self.triangles.len() + self.spheres.len() + self.shapes.len() + self.planes.len()
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Number of bounded primitives: those that belong in a tree, numbers `0..bounded_count()`.
    #[inline]
    pub fn bounded_count(&self) -> usize {
        self.len() - self.planes.len()
    }

    /// The kind of primitive `id`.
    ///
    /// # Panics
    /// If there is no such primitive.
    #[inline]
    pub fn kind(&self, id: u32) -> Kind {
        if id < self.first_sphere() {
            Kind::Triangle(id as usize)
        } else if id < self.first_shape() {
            Kind::Sphere((id - self.first_sphere()) as usize)
        } else if id < self.first_plane() {
            Kind::Shape((id - self.first_shape()) as usize)
        } else {
            let index = (id - self.first_plane()) as usize;
            assert!(index < self.planes.len(), "primitive {id} of {}", self.len());
            Kind::Plane(index)
        }
    }

    /// Number of the first sphere.
    #[inline]
    pub(crate) fn first_sphere(&self) -> u32 {
        self.triangles.len() as u32
    }

    /// Number of the first shape.
    #[inline]
    pub(crate) fn first_shape(&self) -> u32 {
        self.first_sphere() + self.spheres.len() as u32
    }

    /// Number of the first plane.
    #[inline]
    pub(crate) fn first_plane(&self) -> u32 {
        self.bounded_count() as u32
    }

    /// Triangle `index`.
    #[inline(always)]
    pub fn triangle(&self, index: usize) -> Triangle {
        Triangle { vertices: self.triangles[index].map(|vertex| self.vertices[vertex as usize].into()) }
    }

    /// Ask the memory for a triangle's vertex numbers or a sphere; nothing for any other number.
    #[inline(always)]
    pub(crate) fn prefetch(&self, id: u32) {
        match id.checked_sub(self.first_sphere()) {
            None => simd::prefetch(&self.triangles, id as usize),
            Some(sphere) => simd::prefetch(&self.spheres, sphere as usize),
        }
    }

    /// The vertices of all meshes, one after the other.
    pub fn vertices(&self) -> &[[f32; 3]] {
        &self.vertices
    }

    /// Bytes of everything stored.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.vertices[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.normals[..])
            + size_of_val(&self.uvs[..])
            + size_of_val(&self.spheres[..])
            + size_of_val(&self.shapes[..])
            + size_of_val(&self.planes[..])
    }

    /// The vertices of all meshes, one after the other, to be moved; a tree over them must then be
    /// [refitted](crate::tree::Tree::refit) or built anew.
    pub fn vertices_mut(&mut self) -> &mut [[f32; 3]] {
        &mut self.vertices
    }

    /// The spheres, to be moved; see [`vertices_mut`](Self::vertices_mut).
    pub fn spheres_mut(&mut self) -> &mut [Sphere] {
        &mut self.spheres
    }

    /// True if some mesh has normals.
    pub(super) fn has_normals(&self) -> bool {
        !self.normals.is_empty()
    }

    /// The numbers of the corners of all triangles.
    pub(super) fn corners(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The normals of all vertices; empty if there are none.
    pub(super) fn normals(&self) -> &[[f32; 3]] {
        &self.normals
    }

    /// The spheres.
    pub fn spheres(&self) -> &[Sphere] {
        &self.spheres
    }

    /// The discs, boxes, cylinders and cones.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The planes.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// The box around primitive `id`, rounded outward; `None` if it is degenerate (never hit) or unbounded.
    pub fn primitive_bounds(&self, id: u32) -> Option<Aabb> {
        let bounds = match self.kind(id) {
            Kind::Triangle(i) => {
                let triangle = self.triangle(i);
                (!triangle.is_degenerate()).then(|| Aabb::around(triangle.vertices))
            }
            Kind::Sphere(i) => {
                let sphere = &self.spheres[i];
                let point = Aabb::new(sphere.center, sphere.center);
                (!sphere.is_degenerate()).then(|| point.grown(sphere.radius))
            }
            Kind::Shape(i) => (!self.shapes[i].is_degenerate()).then(|| self.shapes[i].bounds()),
            Kind::Plane(_) => None,
        };
        bounds.filter(|b| b.lo.is_finite() && b.hi.is_finite())
    }

    /// The box around all bounded primitives that are not degenerate.
    pub fn bounds(&self) -> Aabb {
        (0..self.bounded_count() as u32).filter_map(|id| self.primitive_bounds(id)).fold(Aabb::EMPTY, Aabb::union)
    }

    /// The parameter and the surface coordinates of a fresh hit at `t`, by double precision.
    #[inline(always)]
    pub(crate) fn refine(&self, ray: &Ray, t: f32, primitive: u32) -> Refined {
        match self.kind(primitive) {
            Kind::Triangle(i) => self.triangle(i).refine(ray, t),
            Kind::Sphere(i) => Refined { t: self.spheres[i].refine(ray, t), u: 0.0, v: 0.0 },
            Kind::Shape(_) | Kind::Plane(_) => Refined { t, u: 0.0, v: 0.0 },
        }
    }

    /// The surface where `ray` has `hit`.
    ///
    /// # Panics
    /// If `hit` is a miss.
    pub fn surface_point(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        match self.kind(hit.primitive) {
            Kind::Triangle(i) => self.triangle_point(i, hit),
            Kind::Sphere(i) => {
                let sphere = &self.spheres[i];
                let (position, n_g) = sphere.surface(ray, hit.t);
                // A root is off by twice as much as a vertex: it takes a product of distances.
                let error = error_bound(sphere.center.abs().max_component() + sphere.radius, 2.0 * sphere.radius);
                SurfacePoint { position, n_g, n_s: n_g, uv: [0.0; 2], error }
            }
            Kind::Shape(i) => self.shapes[i].surface_point(ray, hit.t),
            Kind::Plane(i) => self.planes[i].surface_point(ray, hit.t),
        }
    }

    fn triangle_point(&self, index: usize, hit: &Hit) -> SurfacePoint {
        let triangle = self.triangle(index);
        let (position, n_g) = triangle.surface(hit.u, hit.v);
        let error = error_bound(position.abs().max_component(), triangle.extent());
        let corners = self.triangles[index].map(|vertex| vertex as usize);
        let uv = interpolate_uv(&self.uvs, corners, hit);
        let n_s = interpolate_normal(&self.normals, corners, hit, n_g);
        SurfacePoint { position, n_g, n_s, uv, error }
    }
}

/// The unit of [`error_bound`], 2⁻²⁴, and how many there are for each length.
pub(super) const ROUNDING_UNIT: f32 = 1.0 / (1 << 24) as f32;
pub(super) const EXTENT_UNITS: f32 = 8.0;
pub(super) const COORDINATE_UNITS: f32 = 4.0;

/// The distance within which rays that start near a surface may be mistaken about their side of it.
///
/// In units of 2⁻²⁴: a vertex of a primitive of size `extent`, seen from a point of it, is misplaced by 4 roundings of
/// `extent` along either axis of the sheared plane, 5.7 together, and the triangle with it; the point itself by half an
/// ulp of its largest coordinate per axis, 1.8, and its offset by as much again.
pub(crate) fn error_bound(max_coordinate: f32, extent: f32) -> f32 {
    ROUNDING_UNIT * (EXTENT_UNITS * extent + COORDINATE_UNITS * max_coordinate)
}

fn extend_attribute<T: Copy>(all: &mut Vec<T>, first: usize, new: &[T], len: usize, none: T) {
    if all.is_empty() && new.is_empty() {
        return;
    }
    all.resize(first, none);
    all.extend_from_slice(new);
    all.resize(len, none);
}

fn interpolate_uv(uvs: &[[f32; 2]], corners: [usize; 3], hit: &Hit) -> [f32; 2] {
    if uvs.is_empty() {
        return [0.0; 2];
    }
    let [a, b, c] = corners.map(|i| uvs[i]);
    let w = 1.0 - hit.u - hit.v;
    [a[0] * w + b[0] * hit.u + c[0] * hit.v, a[1] * w + b[1] * hit.u + c[1] * hit.v]
}

/// The interpolated normal, turned to the side of `n_g`; `n_g` itself where there is none.
fn interpolate_normal(normals: &[[f32; 3]], corners: [usize; 3], hit: &Hit, n_g: Vec3f) -> Vec3f {
    if normals.is_empty() {
        return n_g;
    }
    let [a, b, c] = corners.map(|i| Vec3f::from(normals[i]));
    if a == Vec3f::ZERO || b == Vec3f::ZERO || c == Vec3f::ZERO {
        return n_g;
    }
    let n_s = (a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v).normalize();
    match n_s.is_finite() {
        false => n_g,
        true if n_s.dot(n_g) < 0.0 => -n_s,
        true => n_s,
    }
}
