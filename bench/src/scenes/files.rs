//! Scenes from files of any format that `whitted` reads.

use super::{Mesh, Scene, View};
use formats::LoadOptions;
use std::error::Error;
use std::path::{Path, PathBuf};
use whitted::math::{Aabb, Vec3d, Vec3f};
use whitted::scene::{self, Camera, LightKind, Space};

/// The mesh files in a folder; none if there is no such folder.
pub(super) fn ply_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "ply")).collect()
}

/// Load triangles, spheres and a view, in the coordinates in which `whitted` traces them.
///
/// The view is that of a text file of the same name that ends in `.cam`; without one that of the file's first camera and
/// first light with a place; what the file does not say is chosen so that everything is seen. Shapes that Embree does not
/// know are left out, and standard error says so.
///
/// # Errors
/// What is wrong with the file, or with its `.cam`.
pub(super) fn load(path: &Path, name: &str) -> Result<Scene, Box<dyn Error>> {
    let options = LoadOptions { furnish: false, ..LoadOptions::default() };
    let mut scene = formats::load(path, &options)?.scene;
    let left_out = scene.shapes.len() + scene.planes.len();
    if left_out > 0 {
        eprintln!("{name}: left out {left_out} planes, discs, boxes, cylinders and cones, which Embree does not know");
        (scene.shapes, scene.planes) = (Vec::new(), Vec::new());
    }
    let (primitives, space) = scene.primitives()?;
    let view = match std::fs::read_to_string(path.with_extension("cam")) {
        Ok(text) => parse_view(&text).ok_or(format!("{name}.cam lacks a line or a number"))?.moved(&space),
        Err(_) => View::of(&scene, primitives.bounds(), &space),
    };
    let mesh =
        Mesh { vertices: primitives.vertices().iter().map(|&v| v.into()).collect(), triangles: triangles(&scene) };
    Ok(Scene { name: name.into(), mesh, spheres: primitives.spheres().to_vec(), view })
}

/// The triangles of all meshes, by the numbers of their vertices among all.
fn triangles(scene: &scene::Scene) -> Vec<[u32; 3]> {
    let mut first = 0;
    let mut triangles = Vec::new();
    for mesh in &scene.meshes {
        triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        first += mesh.positions.len() as u32;
    }
    triangles
}

impl View {
    /// How a scene shows itself; `bounds` are those of its primitives, in the coordinates of `space`.
    fn of(scene: &scene::Scene, bounds: Aabb, space: &Space) -> Self {
        const SQUARE: f64 = 1.0;
        let place = |light: &scene::Light| match light.kind {
            LightKind::Point { position } | LightKind::Spot { position, .. } => Some(space.point_f32(position)),
            LightKind::Directional { .. } => None,
        };
        let camera = match scene.cameras.first().map(|named| named.camera) {
            Some(camera) => Camera { eye: space.point(camera.eye), look_at: space.point(camera.look_at), ..camera },
            None => Camera::framing(bounds.lo.to_f64(), bounds.hi.to_f64(), SQUARE),
        };
        let above = bounds.center() + Vec3f::new(1.5, 2.5, 2.0) * bounds.size().max_component();
        let [eye, at, up] = [camera.eye, camera.look_at, camera.up].map(Vec3d::to_f32);
        let light = scene.lights.iter().find_map(place).unwrap_or(above);
        Self { eye, at, up, fov: camera.vfov as f32, light, bounds: None }
    }

    /// The same view of a scene that is moved to `space`.
    fn moved(self, space: &Space) -> Self {
        let point = |p: Vec3f| space.point_f32(p.to_f64());
        let bounds = self.bounds.map(|bounds| Aabb::new(point(bounds.lo), point(bounds.hi)));
        Self { eye: point(self.eye), at: point(self.at), light: point(self.light), bounds, ..self }
    }
}

/// Lines of a word and its numbers: `eye`, `at`, `up`, `fovy`, `light`, `bounds`.
fn parse_view(text: &str) -> Option<View> {
    let numbers = |word: &str| -> Option<Vec<f32>> {
        let line = text.lines().find(|line| line.split_whitespace().next() == Some(word))?;
        line.split_whitespace().skip(1).map(|number| number.parse().ok()).collect()
    };
    let point = |word| <[f32; 3]>::try_from(numbers(word)?).ok().map(Vec3f::from);
    let bounds = <[f32; 6]>::try_from(numbers("bounds")?).ok()?;
    let [lo_x, lo_y, lo_z, hi_x, hi_y, hi_z] = bounds;
    Some(View {
        eye: point("eye")?,
        at: point("at")?,
        up: point("up")?,
        fov: *numbers("fovy")?.first()?,
        light: point("light")?,
        bounds: Some(Aabb::new(Vec3f::new(lo_x, lo_y, lo_z), Vec3f::new(hi_x, hi_y, hi_z))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_needs_all_its_lines() {
        let text = "eye 1 2 3\nat 0 0 0\nup 0 1 0\nfovy 40\nlight 3 5 4\nbounds -1 -1 -1 1 1 2";
        assert_eq!(parse_view(text).unwrap().bounds.unwrap().hi.z, 2.0);
        assert!(parse_view(&text.replace("up", "down")).is_none());
    }

    #[test]
    fn meshes_share_one_numbering_of_vertices() {
        let mesh = scene::Mesh { positions: vec![[0.0; 3]; 4], triangles: vec![[0, 1, 3]], ..scene::Mesh::default() };
        let scene = scene::Scene { meshes: vec![mesh.clone(), mesh], ..scene::Scene::default() };
        assert_eq!(triangles(&scene), [[0, 1, 3], [4, 5, 7]]);
    }

    #[test]
    fn a_scene_file_brings_its_own_view() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/mix-1000.toml");
        let scene = load(&path, "mix").unwrap();
        assert_eq!((scene.len(), scene.mesh.triangles.len()), (1000, 0));
        assert_eq!(scene.view.eye, super::super::spheres::VIEW.eye);
        assert!(load(Path::new("nothing.ply"), "nothing").is_err());
    }

    #[test]
    fn everything_is_seen_where_the_file_says_nothing() {
        let bounds = Aabb::new(Vec3f::new(1e6, 0.0, 0.0), Vec3f::new(1e6 + 2.0, 1.0, 1.0));
        let space = Space::around(bounds.lo.to_f64(), bounds.hi.to_f64());
        let moved = Aabb::new(space.point_f32(bounds.lo.to_f64()), space.point_f32(bounds.hi.to_f64()));
        let view = View::of(&scene::Scene::default(), moved, &space);
        assert!((view.at - moved.center()).length() < 1e-3 && (view.eye - view.at).length() < 10.0, "{view:?}");
    }
}
