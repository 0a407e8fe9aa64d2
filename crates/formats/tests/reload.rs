//! A scene that is loaded again is what a first load would give, whatever was changed meanwhile.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use formats::{Error, LoadOptions, Loaded, Loader, load};
use whitted::scene::{Change, difference};

const SCENE: &str = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n[[mesh]]\nfile = \"a.obj\"\n";
const MESH: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
const MATERIAL: &str = "newmtl red\nKd 1 0 0\n";

/// A folder with a scene, its mesh and its materials, changed long ago.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    // It may be left from an earlier run.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    write(&folder.join("a.obj"), MESH, 1000);
    write(&folder.join("a.mtl"), MATERIAL, 1000);
    write(&folder.join("scene.toml"), SCENE, 100);
    folder
}

/// Write a file as if so many seconds ago.
fn write(path: &Path, text: &str, seconds_ago: u64) {
    fs::write(path, text).unwrap();
    let time = SystemTime::now() - Duration::from_secs(seconds_ago);
    File::options().write(true).open(path).unwrap().set_modified(time).unwrap();
}

/// Loads with `loader`, which must give what a first load gives.
#[track_caller]
fn loaded(loader: &mut Loader, folder: &Path) -> Loaded {
    let again: Result<Loaded, Error> = loader.load(&folder.join("scene.toml"), &LoadOptions::default());
    let anew = load(&folder.join("scene.toml"), &LoadOptions::default());
    match (again, anew) {
        (Ok(again), Ok(anew)) => {
            assert_eq!(difference(&again.scene, &anew.scene), Change::Nothing);
            assert_eq!((&again.files, &again.warnings), (&anew.files, &anew.warnings));
            again
        }
        (again, anew) => panic!("{again:?} {anew:?}"),
    }
}

#[test]
fn changes_of_any_file_are_seen() {
    let folder = folder("changes_of_any_file");
    let mut loader = Loader::default();
    let first = loaded(&mut loader, &folder);
    assert_eq!(first.files.len(), 3);
    write(&folder.join("scene.toml"), &format!("{SCENE}smooth = true\n"), 50);
    assert_eq!(difference(&first.scene, &loaded(&mut loader, &folder).scene), Change::Geometry);
    write(&folder.join("a.mtl"), &MATERIAL.replace("1 0 0", "0 1 0"), 40);
    write(&folder.join("scene.toml"), SCENE, 30);
    assert_eq!(difference(&first.scene, &loaded(&mut loader, &folder).scene), Change::Look);
    write(&folder.join("a.obj"), &MESH.replace("0 1 0", "0 2 0"), 20);
    assert_eq!(difference(&first.scene, &loaded(&mut loader, &folder).scene), Change::Geometry);
}

/// Another mesh under the name, the length and the time of the old one: only who does not read it does not see it.
fn change_behind_the_back(folder: &Path) {
    let file = folder.join("a.obj");
    let time = file.metadata().unwrap().modified().unwrap();
    fs::write(&file, MESH.replace("0 1 0", "0 2 0")).unwrap();
    File::options().write(true).open(&file).unwrap().set_modified(time).unwrap();
}

#[test]
fn what_did_not_change_is_not_read() {
    let folder = folder("what_did_not_change");
    let mut loader = Loader::default();
    let first = loaded(&mut loader, &folder);
    change_behind_the_back(&folder);
    let (path, options) = (folder.join("scene.toml"), LoadOptions::default());
    let again = loader.load(&path, &options).unwrap();
    assert_eq!(difference(&first.scene, &again.scene), Change::Nothing);
    assert_eq!(first.files, again.files);
    assert_eq!(difference(&first.scene, &load(&path, &options).unwrap().scene), Change::Geometry);
}

#[test]
fn errors_forget_nothing_and_are_those_of_a_first_load() {
    let folder = folder("errors_forget_nothing");
    let mut loader = Loader::default();
    let first = loaded(&mut loader, &folder);
    let (path, options) = (folder.join("scene.toml"), LoadOptions::default());
    write(&path, "version = 1\n[camera\n", 50);
    assert_eq!(loader.load(&path, &options).unwrap_err(), load(&path, &options).unwrap_err());
    write(&path, SCENE, 40);
    change_behind_the_back(&folder);
    assert_eq!(difference(&first.scene, &loader.load(&path, &options).unwrap().scene), Change::Nothing);
}

#[test]
fn a_mesh_that_was_just_changed_is_read_again() {
    let folder = folder("just_changed");
    let mut loader = Loader::default();
    write(&folder.join("a.obj"), MESH, 101);
    let first = loaded(&mut loader, &folder);
    // As if within the same tick of the clock.
    change_behind_the_back(&folder);
    assert_eq!(difference(&first.scene, &loaded(&mut loader, &folder).scene), Change::Geometry);
}

#[test]
fn a_mesh_outside_is_refused_though_it_is_known() {
    let folder = folder("known_outside");
    fs::create_dir(folder.join("inner")).unwrap();
    write(&folder.join("inner/scene.toml"), &SCENE.replace("a.obj", "../a.obj"), 100);
    let mut loader = Loader::default();
    let path = folder.join("inner/scene.toml");
    let outside = LoadOptions { allow_outside: true, ..LoadOptions::default() };
    loader.load(&path, &outside).unwrap();
    assert!(loader.load(&path, &LoadOptions::default()).is_err());
}
