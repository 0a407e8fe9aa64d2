//! What the repository shows its readers works: the scenes in its documents and those in `scenes/`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[track_caller]
fn check(scene: &Path) {
    let output = Command::new(env!("CARGO_BIN_EXE_whitted")).arg("check").arg(scene).output().unwrap();
    assert!(output.status.success(), "{}: {}", scene.display(), String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty(), "{}: {}", scene.display(), String::from_utf8_lossy(&output.stderr));
}

#[test]
fn scenes_in_documents_are_right() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("documents");
    fs::create_dir_all(&folder).unwrap();
    // The mesh of an example.
    fs::write(folder.join("example.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    for document in ["README.md", "docs/scene-format.md"] {
        let text = fs::read_to_string(repository().join(document)).unwrap();
        let scenes: Vec<&str> = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
        assert!(!scenes.is_empty(), "{document} shows no scene");
        for (index, scene) in scenes.iter().enumerate() {
            let file = folder.join(format!("{}-{index}.toml", document.replace(['/', '.'], "-")));
            fs::write(&file, scene).unwrap();
            check(&file);
        }
    }
}

#[test]
fn the_gallery_is_right() {
    let scenes = fs::read_dir(repository().join("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let scenes: Vec<PathBuf> = scenes.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    assert!(scenes.len() >= 8, "{scenes:?}");
    scenes.iter().for_each(|scene| check(scene));
}
