//! What is at a pixel, asked of the tree directly: takes microseconds, whatever the painter is doing.

use simd::Level;
use whitted::math::Vec3d;
use whitted::ray::{HitBatch, NONE, RayBatch};
use whitted::scene::{Camera, CameraRays, Prepared, Sampling};
use whitted::tree::{Query, Scratch, WalkKind};

/// What a pixel shows first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Picked {
    /// The point, in the scene's coordinates.
    pub(crate) point: Vec3d,
    /// The distance from the eye, in scene units.
    pub(crate) distance: f64,
    /// Number of the primitive.
    pub(crate) primitive: u32,
}

/// The unit direction from the eye of `camera` through the place (`x`, `y`), in pixels from the top left corner of a
/// picture of this size.
pub(crate) fn direction(camera: &Camera, size: [u32; 2], sampling: Sampling, [x, y]: [f64; 2]) -> Vec3d {
    CameraRays::new(camera, size, sampling).ray(x as f32, y as f32).direction.to_f64()
}

/// What is first on the ray from `eye` in a direction; `None` if nothing is.
pub(crate) fn pick(prepared: &Prepared, eye: Vec3d, direction: Vec3d) -> Option<Picked> {
    let geometry = prepared.geometry();
    let space = geometry.space();
    let ray = whitted::ray::Ray::new(space.point(eye).to_f32(), direction.to_f32());
    let mut rays = RayBatch::default();
    rays.push(&ray);
    let query = Query {
        tree: geometry.tree(),
        primitives: geometry.primitives(),
        level: Level::best(),
        walk: WalkKind::Single,
    };
    let mut hits = HitBatch::default();
    query.closest_hit(&rays, &mut hits, &mut Scratch::default());
    let (t, primitive) = (f64::from(hits.t[0]), hits.primitive[0]);
    let distance = t / space.scale();
    (primitive != NONE).then(|| Picked { point: eye + direction * distance, distance, primitive })
}
