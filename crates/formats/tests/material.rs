//! Files from elsewhere, most of them broken: each must give the outcome its folder states, in time, without panic.
//!
//! The files are not part of the repository: `WHITTED_SHARED` names the folder that holds `material/`.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use formats::{Error, Format, LoadOptions, Loaded};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Outcome {
    Ok,
    Error,
    Either,
}

/// The folder with the files, if there is one.
fn material() -> Option<PathBuf> {
    match std::env::var_os("WHITTED_SHARED") {
        Some(folder) => Some(PathBuf::from(folder).join("material")),
        None => {
            eprintln!("SKIPPED: WHITTED_SHARED is not set, the outside files were not loaded");
            None
        }
    }
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
            let path = entry.unwrap().path();
            if path.is_dir() { folders.push(path) } else { files.push(path) }
        }
    }
    files.sort();
    files
}

/// What is wrong with what `load` did with `path`, if anything.
fn judge(path: &Path, expected: Outcome) -> Option<String> {
    const LONGEST: Duration = Duration::from_secs(5);
    let start = Instant::now();
    let result = formats::load(path, &LoadOptions::default());
    let time = start.elapsed();
    let fault = match (&result, expected) {
        (Ok(_), Outcome::Error) => Some("was accepted".to_owned()),
        (Err(e), Outcome::Ok) => Some(format!("was refused: {e}")),
        (Err(e), _) => unclear(e, path),
        (Ok(loaded), _) => unsound(loaded),
    };
    let slow = (time > LONGEST).then(|| format!("took {time:?}"));
    fault.or(slow).map(|what| format!("{}: {what}", path.display()))
}

/// An error must name its file and say what is wrong in one line.
fn unclear(error: &Error, path: &Path) -> Option<String> {
    let text = error.to_string();
    let first = text.lines().next().unwrap_or_default();
    let clear = first.starts_with(&path.display().to_string()) && !error.report().what.is_empty() && first.len() < 1000;
    (!clear).then(|| format!("unclear message: {text}"))
}

/// What is loaded must hold what the scene types promise.
fn unsound(loaded: &Loaded) -> Option<String> {
    let scene = &loaded.scene;
    let materials = scene.materials.len() as u32;
    let mesh_is_sound = |mesh: &whitted::scene::Mesh| {
        let vertices = mesh.positions.len() as u32;
        mesh.triangles.iter().flatten().all(|&v| v < vertices)
            && mesh.positions.iter().flatten().all(|a| a.is_finite())
            && mesh.normals.iter().flatten().all(|a| a.is_finite())
            && mesh.uvs.iter().flatten().all(|a| a.is_finite())
            && mesh.origin.is_finite()
            && [0, mesh.positions.len()].contains(&mesh.normals.len())
            && [0, mesh.positions.len()].contains(&mesh.uvs.len())
            && [0, mesh.triangles.len()].contains(&mesh.triangle_materials.len())
            && mesh.triangle_materials.iter().chain([&mesh.material]).all(|&m| m < materials)
    };
    let objects = scene.spheres.iter().map(|s| s.2).chain(scene.shapes.iter().map(|s| s.1));
    let sound = scene.meshes.iter().all(mesh_is_sound)
        && objects.chain(scene.planes.iter().map(|p| p.1)).all(|m| m < materials)
        && scene.settings.size.iter().all(|&n| n > 0);
    (!sound).then(|| "the scene breaks a promise of its types".to_owned())
}

fn check(cases: impl IntoIterator<Item = (PathBuf, Outcome)>) {
    let (mut loaded, mut faults) = (0, Vec::new());
    for (path, expected) in cases {
        loaded += 1;
        faults.extend(judge(&path, expected));
    }
    println!("{loaded} files");
    assert!(loaded > 0, "no file was found");
    assert!(faults.is_empty(), "{} of {loaded}:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn broken_and_hard_files_give_the_stated_outcome() {
    let Some(folder) = material() else { return };
    let folder = folder.join("broken/made");
    let table = std::fs::read_to_string(folder.join("EXPECTED.csv")).unwrap();
    let cases = table.lines().skip(1).filter_map(|row| {
        let mut fields = row.splitn(3, ',');
        let path = folder.join(fields.next()?);
        let expected = match fields.next()? {
            "ok" => Outcome::Ok,
            "error" => Outcome::Error,
            _ => Outcome::Either,
        };
        Format::of(&path).is_ok().then_some((path, expected))
    });
    check(cases);
}

/// The rules of the material's description for each folder of meshes.
fn mesh_outcome(path: &Path) -> Outcome {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    let folder = |part: &str| path.components().any(|c| c.as_os_str() == part);
    match () {
        () if folder("assimp-invalid") => Outcome::Error,
        () if folder("trimesh") && has(&["empty", "nancolor", "notenoughindices", "emptyIO"]) => Outcome::Either,
        () if folder("tinyobjloader") && has(&["invalid"]) => Outcome::Error,
        () if folder("tinyobjloader") && has(&["test-nan"]) => Outcome::Either,
        // Index 0 of a position, which `broken/made/obj/index_zero.obj` wants refused.
        () if has(&["issue-140-zero-face-idx"]) => Outcome::Error,
        // Points or lines only; the second lost the line that begins its faces.
        () if folder("assimp") && has(&["points", "testline", "issue623"]) => Outcome::Either,
        () => Outcome::Ok,
    }
}

#[test]
fn meshes_of_other_projects_load() {
    let Some(folder) = material() else { return };
    let files = ["mesh", "broken/assimp-invalid"].iter().flat_map(|part| files_below(&folder.join(part)));
    // An empty file has nothing wrong with it but that nothing is there.
    let known = files.filter(|path| Format::of(path).is_ok() && !path.ends_with("assimp-invalid/empty.obj"));
    check(known.map(|path| (path.clone(), mesh_outcome(&path))));
}

#[test]
fn neutral_files_load() {
    let Some(folder) = material() else { return };
    // These use words that only one other program knows.
    let dialect = ["dodecahedron", "hexahedron", "octahedron", "tetrahedron", "positionTest", "cone"];
    let outcome = |path: &Path| match dialect.iter().any(|name| path.file_stem().unwrap() == *name) {
        true => Outcome::Either,
        false => Outcome::Ok,
    };
    let files = ["spd", "nff"].iter().flat_map(|part| files_below(&folder.join(part)));
    let known = files.filter(|path| path.extension().is_some_and(|e| e == "nff"));
    check(known.map(|path| (path.clone(), outcome(&path))));
}

#[test]
fn the_standard_databases_have_their_number_of_primitives() {
    let Some(folder) = material() else { return };
    let counts = std::fs::read_to_string(folder.join("spd/COUNTS.txt")).unwrap();
    for line in counts.lines() {
        let (file, rest) = line.split_once(" prims=").unwrap();
        let stated: usize = rest.split(' ').next().unwrap().parse().unwrap();
        let lights: usize = rest.split("lights=").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        let loaded = formats::load(&folder.join("spd").join(file), &LoadOptions::default()).unwrap();
        let scene = &loaded.scene;
        let polygons = scene.meshes.iter().map(polygon_count).sum::<usize>();
        assert_eq!(scene.spheres.len() + scene.shapes.len() + polygons, stated, "{file}");
        assert_eq!((scene.lights.len(), loaded.warnings.len()), (lights, 0), "{file}");
    }
}

/// The number of polygons that the triangles of a mesh were cut from: each has its own vertices.
fn polygon_count(mesh: &whitted::scene::Mesh) -> usize {
    let mut first_vertices: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    for t in &mesh.triangles {
        let lowest = t.iter().map(|&v| first_vertices[v as usize]).min().unwrap();
        t.iter().for_each(|&v| first_vertices[v as usize] = lowest);
    }
    // Ears come in any order: follow each vertex to the first of its polygon.
    let root = |mut v: u32| {
        while first_vertices[v as usize] != v {
            v = first_vertices[v as usize];
        }
        v
    };
    (0..mesh.positions.len() as u32).filter(|&v| root(v) == v).count()
}
