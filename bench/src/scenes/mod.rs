//! The scenes that are measured: those of files, and spheres and meshes made here.

mod files;
mod meshes;
mod spheres;

use std::error::Error;
use std::path::{Path, PathBuf};
use whitted::geometry::{Primitives, Sphere};
use whitted::math::{Aabb, Vec3f};

/// Vertices and the triangles between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mesh {
    /// Corners, in scene units.
    pub vertices: Vec<Vec3f>,
    /// Three numbers of vertices each.
    pub triangles: Vec<[u32; 3]>,
}

/// From where a scene is looked at, and its light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// The camera.
    pub eye: Vec3f,
    /// The point in the middle of the picture.
    pub at: Vec3f,
    /// Upward.
    pub up: Vec3f,
    /// Vertical field of view in degrees.
    pub fov: f32,
    /// The point light.
    pub light: Vec3f,
    /// Where random rays start; the box around the scene if unset.
    pub bounds: Option<Aabb>,
}

/// A scene with its view.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    /// Short name, for tables.
    pub name: String,
    /// All triangles.
    pub mesh: Mesh,
    /// All spheres.
    pub spheres: Vec<Sphere>,
    /// Camera and light.
    pub view: View,
}

impl Scene {
    /// The primitives in the library's shape: triangles first, then spheres.
    pub(crate) fn primitives(&self) -> Primitives {
        let mut primitives = Primitives::new();
        let Mesh { vertices, triangles } = &self.mesh;
        primitives.push_mesh(vertices, triangles, &[], &[]).expect("scenes name only vertices that they have");
        self.spheres.iter().for_each(|&sphere| primitives.push_sphere(sphere));
        primitives
    }

    /// Number of primitives.
    pub(crate) fn len(&self) -> usize {
        self.mesh.triangles.len() + self.spheres.len()
    }
}

/// A scene that can be had: loaded or made on demand, since the large ones fill memory.
pub(crate) struct Source {
    /// Short name, for tables and `--scene`.
    pub name: String,
    make: Make,
}

enum Make {
    File(PathBuf),
    Generate(Generator, u32),
}

/// Makes a scene of a size: a number of spheres, levels, cells or tubes.
type Generator = fn(u32) -> Scene;

impl Source {
    /// The file at `path`, named after it.
    fn file(path: &Path) -> Self {
        let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        Self { name, make: Make::File(path.to_owned()) }
    }

    fn generated(name: &str, make: Generator, size: u32) -> Self {
        Self { name: name.into(), make: Make::Generate(make, size) }
    }

    /// Load or make the scene.
    ///
    /// # Errors
    /// What is wrong with its file.
    pub(crate) fn scene(&self) -> Result<Scene, Box<dyn Error>> {
        match &self.make {
            Make::File(path) => files::load(path, &self.name),
            Make::Generate(make, size) => Ok(Scene { name: self.name.clone(), ..make(*size) }),
        }
    }
}

/// The scenes made here, by name.
const GENERATED: &[(&str, Generator, u32)] = &[
    ("spheres10", spheres::cube, 10),
    ("spheres100", spheres::cube, 100),
    ("spheres1000", spheres::cube, 1000),
    ("spheres50000", spheres::cube, 50_000),
    ("spheres1M", spheres::cube, 1_000_000),
    ("flake7k", spheres::flake, 4),
    ("flake66k", spheres::flake, 5),
    ("terrain2M", meshes::terrain, 1024),
    ("hairball2M9", meshes::hairball, 12_000),
];

/// A scene to come, and how many primitives it will have.
pub(crate) type Growing = (u32, Source);

/// Families of scenes that differ in nothing but their number of primitives, from a thousand tenfold to ten millions;
/// terrains have about as many.
pub(crate) fn growing() -> [(&'static str, [Growing; 5]); 2] {
    let cubes = [1000, 10_000, 100_000, 1_000_000, 10_000_000];
    // Along a side, and each is two triangles.
    let cells = [22, 71, 224, 707, 2236];
    let sized = |family: &str, count: u32, make: Generator, size: u32| {
        (count, Source::generated(&format!("{family}{count}"), make, size))
    };
    [
        ("spheres", cubes.map(|count| sized("spheres", count, spheres::cube, count))),
        ("terrain", cells.map(|side| sized("terrain", 2 * side * side, meshes::terrain, side))),
    ]
}

/// Every scene of the standard list: the files of the folder `scenes` in `shared`, small ones first, and what is made
/// here.
pub(crate) fn standard(shared: Option<&Path>) -> Vec<Source> {
    let mut files: Vec<PathBuf> = shared.map(|shared| files::ply_files(&shared.join("scenes"))).unwrap_or_default();
    files.sort_by_key(|path| std::fs::metadata(path).map_or(0, |data| data.len()));
    let files = files.iter().map(|path| Source::file(path));
    let generated = GENERATED.iter().map(|&(name, make, size)| Source::generated(name, make, size));
    files.chain(generated).collect()
}

/// The scenes that `names` ask for, each the name of a standard scene or the path of a scene file; all for none.
///
/// # Errors
/// A name that is neither.
pub(crate) fn select(names: &[String], shared: Option<&Path>) -> Result<Vec<Source>, String> {
    if names.is_empty() {
        return Ok(standard(shared));
    }
    names.iter().map(|name| find(name, shared)).collect()
}

fn find(name: &str, shared: Option<&Path>) -> Result<Source, String> {
    if let Some(source) = standard(shared).into_iter().find(|source| source.name == name) {
        return Ok(source);
    }
    let path = Path::new(name);
    if path.is_file() {
        return Ok(Source::file(path));
    }
    let known: Vec<String> = standard(shared).into_iter().map(|source| source.name).collect();
    Err(format!("no scene or file `{name}`; scenes are {}", known.join(", ")))
}
