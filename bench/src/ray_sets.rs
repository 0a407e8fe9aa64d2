//! The ray sets: camera rays, and the rays that a renderer would send from their hits.
//!
//! | set | rays |
//! | --- | --- |
//! | primary | 1024 × 1024 from the camera, in tiles of 8 × 8 pixels: tiles by rows, pixels in a tile by rows |
//! | shadow | from each primary hit to the point light, and the same segments from the light |
//! | mirror | the reflected ray of each primary hit |
//! | diffuse | a cosine-distributed random ray of each primary hit |
//! | random | 1 048 576 from anywhere in the bounds in any direction |
//!
//! The order of the primary rays is kept. Secondary rays leave from the hit, moved along the geometric normal to the
//! side of the viewer.

use crate::scenes::{Scene, View};
use clap::ValueEnum;
use std::f64::consts::TAU;
use std::fmt;
use whitted::geometry::{Primitives, SurfacePoint};
use whitted::math::{SplitMix64, Vec3d, Vec3f};
use whitted::ray::{HitBatch, Ray, RayBatch};

/// Pixels along a side of the picture.
const SIDE: usize = 1024;
/// Pixels along a side of a tile.
const TILE: usize = 8;
/// Number of random rays.
const RANDOM: usize = 1 << 20;
/// Shadow segments end this part of their length before the light.
const BEFORE_LIGHT: f32 = 1e-4;
/// By how much of the scene's size secondary rays are moved off their surface, or by twice the error bound of the hit
/// where that is more: enough for Embree's default mode, which has no bound of its own.
const OFFSET: f32 = 1e-5;

/// A set of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RayKind {
    /// From the camera.
    Primary,
    /// Between hits and the light.
    Shadow,
    /// Reflected.
    Mirror,
    /// Cosine-distributed.
    Diffuse,
    /// Anywhere.
    Random,
}

impl RayKind {
    /// Whether any hit will do.
    pub(crate) fn is_occlusion(self) -> bool {
        self == Self::Shadow
    }
}

impl fmt::Display for RayKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.to_possible_value().expect("no kind is hidden").get_name())
    }
}

/// The rays of one set.
#[derive(Clone, Debug)]
pub(crate) struct RaySet {
    /// Which set.
    pub kind: RayKind,
    /// The rays; for shadow rays toward the light.
    pub rays: RayBatch,
    /// The same segments from their other end, where the caller is free to choose: shadow rays.
    pub reversed: Option<RayBatch>,
}

impl RaySet {
    /// The rays, and where a caller may choose the same segments turned round, each with a note for tables.
    pub(crate) fn orientations(&self) -> Vec<(&RayBatch, &'static str)> {
        let turned = self.reversed.as_ref().map(|rays| (rays, " from light"));
        std::iter::once((&self.rays, "")).chain(turned).collect()
    }

    /// Keep at most `count` rays: runs of 4096 neighbours, evenly spread.
    pub(crate) fn thin(&mut self, count: usize) {
        const RUN: usize = 4096;
        let len = self.rays.len();
        let runs = count.div_ceil(RUN).max(1);
        if count >= len {
            return;
        }
        let keep = |index: usize| {
            let run = index / RUN;
            run * runs % len.div_ceil(RUN) < runs
        };
        for rays in [Some(&mut self.rays), self.reversed.as_mut()].into_iter().flatten() {
            *rays = (0..len)
                .filter(|&index| keep(index))
                .take(count)
                .map(|index| rays.get(index))
                .collect::<Vec<_>>()
                .iter()
                .collect();
        }
    }
}

/// The primary hits of a scene, from which all sets are made.
pub(crate) struct Origins<'a> {
    primitives: &'a Primitives,
    view: View,
    primary: RayBatch,
    surfaces: Vec<(Ray, SurfacePoint)>,
    offset: f32,
}

impl<'a> Origins<'a> {
    /// Send the camera rays of a scene; `closest_hit` answers them.
    pub(crate) fn new(
        scene: &Scene,
        primitives: &'a Primitives,
        closest_hit: impl FnOnce(&RayBatch) -> HitBatch,
    ) -> Self {
        let primary = camera_rays(&scene.view);
        let hits = closest_hit(&primary);
        let surface = |index: usize| {
            let (ray, hit) = (primary.get(index), hits.get(index));
            hit.is_hit().then(|| (ray, primitives.surface_point(&ray, &hit)))
        };
        let surfaces = (0..hits.len()).filter_map(surface).collect();
        let offset = OFFSET * primitives.bounds().size().length();
        Self { primitives, view: scene.view, primary, surfaces, offset }
    }

    /// The set of this kind.
    pub(crate) fn set(&self, kind: RayKind) -> RaySet {
        let rays = match kind {
            RayKind::Primary => self.primary.clone(),
            RayKind::Shadow => {
                self.shadow(|from, light| Ray { t_max: 1.0 - BEFORE_LIGHT, ..Ray::new(from, light - from) })
            }
            RayKind::Mirror => self.leaving(|ray, normal| {
                let direction = ray.direction.to_f64();
                direction - normal * (2.0 * direction.dot(normal))
            }),
            RayKind::Diffuse => {
                let mut rng = SplitMix64::new(self.surfaces.len() as u64);
                self.leaving(move |_, normal| normal + on_sphere(&mut rng))
            }
            RayKind::Random => self.random(),
        };
        let reversed = (kind == RayKind::Shadow)
            .then(|| self.shadow(|to, light| Ray { t_min: BEFORE_LIGHT, t_max: 1.0, ..Ray::new(light, to - light) }));
        RaySet { kind, rays, reversed }
    }

    /// The point of a hit, moved to the viewer's side, and the normal on that side.
    fn departure(&self, ray: &Ray, surface: &SurfacePoint) -> (Vec3f, Vec3f) {
        let normal = if surface.n_g.dot(ray.direction) > 0.0 { -surface.n_g } else { surface.n_g };
        (surface.position + normal * self.offset.max(2.0 * surface.error), normal)
    }

    fn shadow(&self, segment: impl Fn(Vec3f, Vec3f) -> Ray) -> RayBatch {
        let departures = self.surfaces.iter().map(|(ray, surface)| self.departure(ray, surface).0);
        departures.map(|point| segment(point, self.view.light)).collect::<Vec<_>>().iter().collect()
    }

    fn leaving(&self, mut direction: impl FnMut(&Ray, Vec3d) -> Vec3d) -> RayBatch {
        let leave = |(ray, surface): &(Ray, SurfacePoint)| {
            let (point, normal) = self.departure(ray, surface);
            Ray::new(point, direction(ray, normal.to_f64()).normalize().to_f32())
        };
        self.surfaces.iter().map(leave).collect::<Vec<_>>().iter().collect()
    }

    fn random(&self) -> RayBatch {
        let mut rng = SplitMix64::new(RANDOM as u64);
        let bounds = self.view.bounds.unwrap_or(self.primitives.bounds());
        let uniform =
            |axis: usize, rng: &mut SplitMix64| rng.uniform(bounds.lo[axis].into(), bounds.hi[axis].into()) as f32;
        let mut ray = |_| {
            let origin = Vec3f::new(uniform(0, &mut rng), uniform(1, &mut rng), uniform(2, &mut rng));
            Ray::new(origin, on_sphere(&mut rng).to_f32())
        };
        (0..RANDOM).map(&mut ray).collect::<Vec<_>>().iter().collect()
    }
}

fn camera_rays(view: &View) -> RayBatch {
    let forward = (view.at - view.eye).to_f64().normalize();
    let right = forward.cross(view.up.to_f64()).normalize();
    let up = right.cross(forward);
    let half_height = (f64::from(view.fov).to_radians() / 2.0).tan();
    let ray = |index: usize| {
        let (tile, pixel) = (index / (TILE * TILE), index % (TILE * TILE));
        let x = tile % (SIDE / TILE) * TILE + pixel % TILE;
        let y = tile / (SIDE / TILE) * TILE + pixel / TILE;
        let screen = |pixel: usize| (2.0 * (pixel as f64 + 0.5) / SIDE as f64 - 1.0) * half_height;
        Ray::new(view.eye, (forward + right * screen(x) - up * screen(y)).normalize().to_f32())
    };
    (0..SIDE * SIDE).map(ray).collect::<Vec<_>>().iter().collect()
}

/// A uniform random unit vector.
pub(crate) fn on_sphere(rng: &mut SplitMix64) -> Vec3d {
    let z = rng.uniform(-1.0, 1.0);
    let turn = rng.uniform(0.0, TAU);
    let radius = (1.0 - z * z).max(0.0).sqrt();
    Vec3d::new(radius * turn.cos(), radius * turn.sin(), z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixty_four_camera_rays_make_a_tile() {
        let up = Vec3f::new(0.0, 1.0, 0.0);
        let eye = Vec3f::new(0.0, 0.0, 1.0);
        let view = View { eye, at: Vec3f::ZERO, up, fov: 90.0, light: up, bounds: None };
        let rays = camera_rays(&view);
        let pixel = |index: usize| {
            let d = rays.get(index).direction;
            let at = |s: f32| ((s / -d.z + 1.0) * SIDE as f32 / 2.0) as usize;
            (at(d.x), at(-d.y))
        };
        assert_eq!([pixel(0), pixel(7), pixel(8), pixel(64)], [(0, 0), (7, 0), (0, 1), (8, 0)]);
        assert_eq!(pixel(SIDE * TILE), (0, 8));
    }

    #[test]
    fn thinning_keeps_runs_from_everywhere() {
        let rays: Vec<Ray> = (0..40_960).map(|i| Ray::new(Vec3f::splat(i as f32), Vec3f::ONE)).collect();
        let mut set = RaySet { kind: RayKind::Random, rays: rays.iter().collect(), reversed: None };
        set.thin(8192);
        assert_eq!(set.rays.len(), 8192);
        assert_eq!([set.rays.origin.x[0], set.rays.origin.x[8191]], [0.0, 24_575.0]);
    }
}
