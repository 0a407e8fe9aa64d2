//! How everything looks: materials, lights, camera, background.

use super::{Background, Camera, Geometry, Scene, SceneError, Space, check};
use crate::math::{Aabb, Vec3, Vec3f};
use crate::shading::{MaterialTable, PreparedLight, PreparedMaterial};
use crate::tree::BitSet;
use simd::F32Lanes;
use std::sync::Arc;

/// Where shadow rays start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ShadowOrigin {
    /// At the light, the same point for all of them: coherent walks apply.
    Light(Vec3f),
    /// At the surface: the light is infinitely far, or so far that rays from it would be too coarse.
    Surface,
}

/// Shadow rays do not start at a light that is farther from the scene than this many extents: the surface points at
/// which they end would have to be moved by more than 2⁻¹² of the extent.
const DISTANT: f32 = 64.0;

/// The part of a prepared scene that can be changed without touching its [`Geometry`]; in internal space.
#[derive(Clone, Debug)]
pub struct Look {
    materials: Vec<PreparedMaterial>,
    /// Material of each primitive.
    primitive_materials: Arc<[u32]>,
    table: MaterialTable,
    lights: Vec<(PreparedLight, ShadowOrigin)>,
    ambient: Vec3f,
    background: Background,
    camera: Camera,
    /// Primitives that let no light pass; `None` if there are no others.
    opaque: Option<Arc<BitSet>>,
}

impl Look {
    /// The look of a scene that has passed [`check::scene`], in which the primitives have these materials by number.
    pub(super) fn new(scene: &Scene, geometry: &Geometry, primitive_materials: Arc<[u32]>) -> Result<Self, SceneError> {
        check::material_indices(&primitive_materials, scene.materials.len())?;
        let space = geometry.space();
        let prepare = |material| PreparedMaterial::new(material, space.origin(), space.scale());
        let materials: Vec<_> = scene.materials.iter().map(|named| prepare(&named.material)).collect();
        let lights = scene.lights.iter().map(|light| {
            let light = light.prepare(|point| space.point(point), space.scale());
            (light, shadow_origin(&light, geometry.bounds()))
        });
        let camera = &scene.cameras.first().ok_or(SceneError::NoCamera)?.camera;
        Ok(Self {
            lights: lights.collect(),
            ambient: scene.ambient,
            background: scene.background,
            camera: internal_camera(camera, space),
            opaque: opaque(&primitive_materials, &materials).map(Arc::new),
            table: MaterialTable::new(&materials),
            materials,
            primitive_materials,
        })
    }

    /// The same look to another camera without a [fault](Camera::fault), in world space.
    pub(super) fn with_camera(&self, camera: &Camera, space: &Space) -> Self {
        Self { camera: internal_camera(camera, space), ..self.clone() }
    }

    /// The number of the material of each primitive.
    #[inline(always)]
    pub(crate) fn primitive_materials(&self) -> &Arc<[u32]> {
        &self.primitive_materials
    }

    /// Material `index`, which must exist.
    #[inline]
    pub(crate) fn material(&self, index: u32) -> &PreparedMaterial {
        &self.materials[index as usize]
    }

    /// The lights, and where shadow rays to them start.
    pub(crate) fn lights(&self) -> &[(PreparedLight, ShadowOrigin)] {
        &self.lights
    }

    /// Light that reaches every point from everywhere.
    pub(crate) fn ambient(&self) -> Vec3f {
        self.ambient
    }

    /// Primitives that let no light pass; `None` if there are no others.
    pub(crate) fn opaque(&self) -> Option<&BitSet> {
        self.opaque.as_deref()
    }

    /// All materials, for lanes.
    pub(crate) fn table(&self) -> &MaterialTable {
        &self.table
    }

    /// What rays see that hit nothing. `direction` need not be normalised.
    #[inline(always)]
    pub(crate) fn background<L: F32Lanes>(&self, token: L::Token, direction: Vec3<L>) -> Vec3<L> {
        match self.background {
            Background::Color(color) => Vec3::lanes(token, color),
            Background::Gradient { down, up } => {
                let half = L::splat(token, 0.5);
                let share = direction.y / direction.length_squared().sqrt() * half + half;
                let (down, up) = (Vec3::lanes(token, down), Vec3::lanes(token, up));
                down * (L::splat(token, 1.0) - share) + up * share
            }
        }
    }

    /// The camera, in internal space.
    pub(crate) fn camera(&self) -> &Camera {
        &self.camera
    }
}

fn shadow_origin(light: &PreparedLight, scene: Aabb) -> ShadowOrigin {
    let extent = scene.size().max_component().max(0.0);
    match light.position() {
        Some(position) if (position - scene.center()).abs().max_component() > DISTANT * extent => ShadowOrigin::Surface,
        // Also where there is nothing bounded: NaN and infinities compare as false.
        Some(position) => ShadowOrigin::Light(position),
        None => ShadowOrigin::Surface,
    }
}

fn internal_camera(camera: &Camera, space: &Space) -> Camera {
    Camera { eye: space.point(camera.eye), look_at: space.point(camera.look_at), ..*camera }
}

fn opaque(primitive_materials: &[u32], materials: &[PreparedMaterial]) -> Option<BitSet> {
    let is_opaque = |&material: &u32| !materials[material as usize].is_transparent();
    let all = primitive_materials.iter().all(is_opaque);
    (!all).then(|| primitive_materials.iter().map(is_opaque).collect())
}

/// The material of each primitive, in the order of their numbers.
pub(super) fn primitive_materials(scene: &Scene) -> Arc<[u32]> {
    let triangles = scene.meshes.iter().flat_map(|mesh| {
        (0..mesh.triangles.len()).map(|i| mesh.triangle_materials.get(i).copied().unwrap_or(mesh.material))
    });
    let spheres = scene.spheres.iter().map(|sphere| sphere.2);
    let shapes = scene.shapes.iter().map(|shape| shape.1);
    let planes = scene.planes.iter().map(|plane| plane.1);
    triangles.chain(spheres).chain(shapes).chain(planes).collect()
}
