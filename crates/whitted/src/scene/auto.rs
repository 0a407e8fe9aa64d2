//! A stage for bare shapes: camera, lights, floor and background where the user gave none.

use super::{Background, Camera, Light, LightKind, NamedCamera, NamedMaterial, Scene};
use crate::geometry::Plane;
use crate::math::{Vec3d, Vec3f, sin_cos_degrees};
use crate::shading::{Material, Reflectance, SpecularModel, Texture};

/// Where the automatic camera stands: this far to the right of +z and above the horizon, in degrees. A three-quarter
/// view shows three sides of a thing; the horizon stays above the picture.
const AZIMUTH: f64 = 30.0;
const ELEVATION: f64 = 22.0;

/// Vertical field of view of the automatic camera in degrees: a portrait lens.
const VFOV: f64 = 30.0;

/// The part of the picture's width and height that the bounds may take.
const FRAME: f64 = 0.96;

/// Lights stand this many radii of the bounds away from its centre, so that a floor around it grows dark slowly.
const LIGHT_DISTANCE: f64 = 5.0;

/// Half angles in degrees of the key light's cone: all of the thing is in full light, the floor around it fades.
const KEY_CONE: [f64; 2] = [13.0, 44.0];

/// Gap between the bounds and the floor in radii: invisible, but no face of the thing lies in the floor.
const GAP: f64 = 1e-4;

impl Camera {
    /// A three-quarter view, y up, of the box between the corners `lo` and `hi`, which it fills but for a margin; for a
    /// picture of `aspect` = width / height. Points and boxes that are empty or not finite get some view, too.
    pub fn framing(lo: Vec3d, hi: Vec3d, aspect: f64) -> Self {
        let Some((center, half)) = center_and_half(lo, hi) else { return Self::default() };
        let toward_eye = direction(AZIMUTH, ELEVATION);
        let mut camera = Self { eye: center + toward_eye, look_at: center, vfov: VFOV, ..Self::default() };
        let [right, up, _] = camera.axes();
        let height = camera.half_height() * FRAME;
        let width = height * aspect;
        // Each corner must be so far away that its place in the picture lies within the frame.
        let distance = corners(half).map(|corner| {
            let needed = (corner.dot(right).abs() / width).max(corner.dot(up).abs() / height);
            needed + corner.dot(toward_eye)
        });
        camera.eye = center + toward_eye * distance.fold(0.0, f64::max);
        camera
    }
}

impl Scene {
    /// The corners of the box around all bounded objects; `None` if there are none with finite coordinates.
    pub fn bounds(&self) -> Option<(Vec3d, Vec3d)> {
        let mut bounds: Option<(Vec3d, Vec3d)> = None;
        let mut add = |lo: Vec3d, hi: Vec3d| {
            if lo.is_finite() && hi.is_finite() {
                let (old_lo, old_hi) = bounds.unwrap_or((lo, hi));
                bounds = Some((lo.min(old_lo), hi.max(old_hi)));
            }
        };
        for &(center, radius, _) in &self.spheres {
            let radius = Vec3d::splat(radius.abs());
            add(center - radius, center + radius);
        }
        for (shape, _) in &self.shapes {
            let bounds = shape.bounds();
            add(bounds.lo.to_f64(), bounds.hi.to_f64());
        }
        for mesh in &self.meshes {
            // Vertices that no triangle uses are not seen.
            for index in mesh.triangles.iter().flatten() {
                let Some(&position) = mesh.positions.get(*index as usize) else { continue };
                let p = mesh.transform.point(mesh.origin + Vec3d::from(position.map(f64::from)));
                add(p, p);
            }
        }
        bounds
    }

    /// Add what a renderer needs and the scene lacks: a camera, a material, and if there are no lights a stage of three
    /// lights, ambient light, a floor under the bounds and a background.
    pub fn furnish(&mut self) {
        let (lo, hi) = self.bounds().unwrap_or((Vec3d::splat(-1.0), Vec3d::ONE));
        if self.materials.is_empty() {
            self.materials.push(NamedMaterial { name: "clay".to_owned(), material: clay() });
        }
        if self.cameras.is_empty() {
            let [width, height] = self.settings.size.map(f64::from);
            let camera = Camera::framing(lo, hi, width / height);
            self.cameras.push(NamedCamera { name: "auto".to_owned(), camera });
        }
        if self.lights.is_empty() {
            self.add_stage(lo, hi);
        }
    }

    fn add_stage(&mut self, lo: Vec3d, hi: Vec3d) {
        let Some((center, half)) = center_and_half(lo, hi) else { return };
        self.lights = light_rig(center, half.length(), &self.cameras[0].camera);
        self.ambient = Vec3f::new(0.90, 0.95, 1.0);
        self.background = Background::Gradient { down: Vec3f::new(0.10, 0.10, 0.10), up: Vec3f::new(0.22, 0.23, 0.25) };
        let floor = Plane {
            point: Vec3d::new(center.x, center.y - half.y - GAP * half.length(), center.z),
            normal: Vec3d::new(0.0, 1.0, 0.0),
        };
        self.planes.push((floor, self.materials.len() as u32));
        self.materials.push(NamedMaterial { name: "floor".to_owned(), material: floor_material() });
    }
}

/// Key light from the left of the camera, weak fill from its right, rim light from behind; none falls off with distance.
fn light_rig(center: Vec3d, radius: f64, camera: &Camera) -> Vec<Light> {
    let to_eye = camera.eye - center;
    let [right, _, _] = Camera { look_at: center, ..*camera }.axes();
    let right = if right.is_finite() { right } else { Vec3d::new(1.0, 0.0, 0.0) };
    let up = Vec3d::new(0.0, 1.0, 0.0);
    let front = right.cross(up);
    let front = if front.dot(to_eye) < 0.0 { -front } else { front };
    let place = |azimuth: f64, elevation: f64| {
        let d = direction(azimuth, elevation);
        center + (right * d.x + up * d.y + front * d.z) * (LIGHT_DISTANCE * radius)
    };
    let light = |kind: LightKind, color: [f32; 3]| Light { kind, color: color.into(), inverse_square: false };
    let [inner, outer] = KEY_CONE;
    let key = LightKind::Spot { position: place(-56.0, 47.0), look_at: center, inner, outer };
    vec![
        light(key, [1.15, 1.06, 0.94]),
        light(LightKind::Point { position: place(62.0, 24.0) }, [0.10, 0.11, 0.14]),
        light(LightKind::Point { position: place(165.0, 40.0) }, [0.17, 0.18, 0.22]),
    ]
}

/// A warm matte body with a broad, faint highlight.
pub fn clay() -> Material {
    Material {
        color: Texture::Color(Vec3f::new(0.74, 0.40, 0.24)),
        ambient: 0.16,
        diffuse: 0.85,
        specular: Vec3f::splat(0.16),
        exponent: 32.0,
        specular_model: SpecularModel::Blinn,
        ..Material::default()
    }
}

/// A neutral polished floor, which mirrors more at grazing angles.
fn floor_material() -> Material {
    Material {
        color: Texture::Color(Vec3f::new(0.52, 0.51, 0.50)),
        ambient: 0.14,
        diffuse: 0.70,
        reflect: Vec3f::splat(0.9),
        reflectance: Reflectance::Schlick,
        ior: 1.45,
        ..Material::default()
    }
}

/// Middle and half diagonal of a box; a point gets some extent. `None` if the box is empty or not finite.
fn center_and_half(lo: Vec3d, hi: Vec3d) -> Option<(Vec3d, Vec3d)> {
    /// Extent of a point, relative to its distance from the origin where that is large.
    const POINT: f64 = 1e-3;
    let (center, half) = (lo * 0.5 + hi * 0.5, hi * 0.5 - lo * 0.5);
    if !(center.is_finite() && half.is_finite() && half.min_component() >= 0.0) {
        return None;
    }
    let distance = center.abs().max_component();
    let is_point = half.max_component() <= distance * f64::EPSILON;
    Some((center, if is_point { Vec3d::splat((distance * POINT).max(1.0)) } else { half }))
}

fn corners(half: Vec3d) -> impl Iterator<Item = Vec3d> {
    let signs = [-1.0, 1.0];
    signs.into_iter().flat_map(move |x| {
        signs.into_iter().flat_map(move |y| signs.into_iter().map(move |z| Vec3d::new(x, y, z).times(half)))
    })
}

/// The unit vector `azimuth` degrees to the right of +z and `elevation` degrees above the horizon.
fn direction(azimuth: f64, elevation: f64) -> Vec3d {
    let ((sin_a, cos_a), (sin_e, cos_e)) = (sin_cos_degrees(azimuth), sin_cos_degrees(elevation));
    Vec3d::new(sin_a * cos_e, sin_e, cos_a * cos_e)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Mesh;

    /// Place of `p` in the picture: ±1 at its edges.
    fn project(camera: &Camera, aspect: f64, p: Vec3d) -> [f64; 2] {
        let ([right, up, forward], height) = (camera.axes(), camera.half_height());
        let d = p - camera.eye;
        assert!(d.dot(forward) > 0.0, "{p:?} lies behind the camera");
        [right.dot(d) / d.dot(forward) / height / aspect, up.dot(d) / d.dot(forward) / height]
    }

    #[test]
    fn the_view_is_filled_by_any_box() {
        for scale in [1e-12, 1.0, 1e9] {
            for (size, aspect) in
                [([1.0, 1.0, 1.0], 1.5), ([1.0, 0.0, 1.0], 0.5), ([9.0, 0.1, 0.1], 2.0), ([0.0, 5.0, 0.0], 1.0)]
            {
                let (lo, size) = (Vec3d::new(3.0, -2.0, 1.0) * scale, Vec3d::from(size) * scale);
                let camera = Camera::framing(lo, lo + size, aspect);
                assert_eq!(camera.fault(), None);
                let center = lo + size * 0.5;
                let places = corners(size * 0.5).map(|corner| project(&camera, aspect, center + corner));
                let reach = places.flat_map(|[x, y]| [x.abs(), y.abs()]).fold(0.0, f64::max);
                assert!((reach - FRAME).abs() < 1e-6, "{reach} for {size:?}, {aspect}");
            }
        }
    }

    #[test]
    fn degenerate_bounds_get_a_view() {
        let (nan, inf) = (Vec3d::splat(f64::NAN), Vec3d::splat(f64::INFINITY));
        let far = Vec3d::splat(1e12);
        for (lo, hi) in [(nan, nan), (inf, -inf), (-inf, inf), (Vec3d::ZERO, Vec3d::ZERO), (far, far), (far, -far)] {
            assert_eq!(Camera::framing(lo, hi, 1.0).fault(), None, "{lo:?} {hi:?}");
        }
    }

    #[test]
    fn a_bare_mesh_becomes_a_scene() {
        let positions = vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 4.0, 1.0], [99.0, 0.0, 0.0]];
        let mesh =
            Mesh { positions, triangles: vec![[0, 1, 2]], origin: Vec3d::new(0.0, 10.0, 0.0), ..Mesh::default() };
        let mut scene = Scene { meshes: vec![mesh], ..Scene::default() };
        assert_eq!(scene.bounds(), Some((Vec3d::new(0.0, 10.0, 0.0), Vec3d::new(2.0, 14.0, 1.0))));
        scene.furnish();
        assert_eq!((scene.cameras.len(), scene.lights.len(), scene.planes.len()), (1, 3, 1));
        assert_eq!(scene.cameras[0].camera.fault(), None);
        assert!(scene.materials.iter().all(|named| named.material.fault().is_none()));
        assert!(scene.lights.iter().all(|light| light.fault().is_none()));
        let (floor, material) = scene.planes[0];
        assert!(floor.point.y < 10.0 && floor.point.y > 9.99 && material == 1);
        let complete = scene.clone();
        scene.furnish();
        assert_eq!(format!("{scene:?}"), format!("{complete:?}"), "what is there stays");
    }

    #[test]
    fn the_key_light_stands_left_of_any_camera() {
        for eye in [[0.0, 1.0, 5.0], [5.0, 0.0, 0.0], [0.0, -1.0, -5.0], [0.0, 5.0, 0.0]] {
            let camera = Camera { eye: eye.into(), look_at: Vec3d::ZERO, ..Camera::default() };
            let lights = light_rig(Vec3d::ZERO, 1.0, &camera);
            assert!(lights.iter().all(|light| light.fault().is_none()), "{eye:?}");
            let LightKind::Spot { position, .. } = lights[0].kind else { panic!("{lights:?}") };
            if camera.fault().is_none() {
                assert!(position.dot(camera.axes()[0]) < 0.0 && position.dot(camera.eye) > 0.0, "{eye:?}");
            }
        }
    }

    #[test]
    fn an_empty_scene_is_furnished() {
        let mut scene = Scene::default();
        assert_eq!(scene.bounds(), None);
        scene.furnish();
        assert_eq!((scene.cameras.len(), scene.lights.len()), (1, 3));
    }
}
