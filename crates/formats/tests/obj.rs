//! OBJ and MTL by small files written here.

use std::path::{Path, PathBuf};

use formats::{Error, ErrorKind, Format, LoadOptions, Loaded};
use whitted::math::Vec3f;
use whitted::scene::Mesh;
use whitted::shading::{Reflectance, Texture};

fn load(text: &str) -> Result<Loaded, Error> {
    formats::parse(Format::Obj, Path::new("t.obj"), text.as_bytes().to_vec(), &LoadOptions::default())
}

fn mesh(text: &str) -> Mesh {
    load(text).unwrap().scene.meshes.remove(0)
}

/// An empty folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn faces_become_fans_in_file_order() {
    let mesh = mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 .5 0\nf 1 2 3 4 5\nf -3 -2 -1\n");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [2, 3, 4]]);
    assert_eq!(mesh.positions.len(), 5);
}

#[test]
fn all_line_ends_and_joined_lines_are_read() {
    for end in ["\n", "\r\n", "\r"] {
        let text = "\u{feff}v 0 0 0\nv 1 0 \\\n0 # comment\n\nv 0 1 0 0.5\nf 1 2\\\n 3".replace('\n', end);
        let mesh = mesh(&text);
        assert_eq!((mesh.positions[1], mesh.triangles), ([1.0, 0.0, 0.0], vec![[0, 1, 2]]), "{end:?}");
    }
}

#[test]
fn indices_may_refer_to_what_comes_later() {
    assert_eq!(mesh("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles, [[0, 1, 2]]);
}

#[test]
fn corners_with_other_normals_become_other_vertices() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 2\nvt 0.5\nf 1/1/1 2//1 3//1\nf 1/1/1 2//2 3\n";
    let mesh = mesh(text);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 3, 4]]);
    assert_eq!((mesh.uvs[0], mesh.uvs[1]), ([0.5, 0.0], [0.0, 0.0]));
    assert_eq!(mesh.normals[3], [0.0, 0.0, 2.0]);
    assert_eq!(mesh.normals[4], [0.0, 0.0, 1.0], "a missing normal is made from the faces around");
}

#[test]
fn errors_show_the_place() {
    let error = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n").unwrap_err();
    let text = "t.obj:4:7: vertex 4 does not exist: there are 3\n  f 1 2 4\n        ^";
    assert_eq!((error.to_string().as_str(), error.kind()), (text, ErrorKind::Input));
}

#[test]
fn materials_follow_the_illumination_model() {
    let folder = folder("obj-materials");
    let library = "newmtl red\nKd 1 0 0\nillum 1\nKs 1 1 1\nnewmtl clear glass\nKd 0 0 0\nKs .9 .9 .9\nNs 50\n\
                   Ni 1.5\nTf .8 .9 1\nillum 7\nnewmtl half\nd 0.25\nmap_Kd x.png\n";
    std::fs::write(folder.join("my library.mtl"), library).unwrap();
    let object = "mtllib my library.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl clear glass\n\
                  f 1 2 3\nusemtl half\nf 1 2 3\nusemtl nowhere\nf 1 2 3\n";
    let path = folder.join("t.obj");
    std::fs::write(&path, object).unwrap();
    let loaded = formats::load(&path, &LoadOptions::default()).unwrap();
    let materials: Vec<_> = loaded.scene.materials.iter().map(|m| &m.material).collect();
    assert_eq!(loaded.scene.meshes[0].triangle_materials, [0, 1, 2, 3]);
    assert_eq!(materials[0].color, Texture::Color(Vec3f::new(1.0, 0.0, 0.0)));
    assert_eq!(materials[0].specular, Vec3f::ZERO, "illumination model 1 has no highlight");
    assert_eq!((materials[1].transmit, materials[1].ior), (Vec3f::new(0.8, 0.9, 1.0), 1.5));
    assert_eq!(materials[1].reflectance, Reflectance::Fresnel);
    assert_eq!((materials[2].transmit, materials[2].diffuse, materials[2].ior), (Vec3f::splat(0.75), 0.25, 1.0));
    let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(warnings[0].contains("map_Kd") && warnings[1].contains("nowhere"), "{warnings:?}");
    assert_eq!(loaded.files.len(), 2);
}

#[test]
fn libraries_outside_the_folder_are_not_opened() {
    let folder = folder("obj-outside");
    std::fs::create_dir_all(folder.join("inside/below")).unwrap();
    std::fs::write(folder.join("secret.mtl"), "newmtl m\nKd 1 0 0\n").unwrap();
    std::fs::write(folder.join("inside/fine.mtl"), "newmtl m\nKd 0 1 0\n").unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("../secret.mtl", folder.join("inside/link.mtl")).unwrap();
    let absolute = folder.join("secret.mtl");
    let path = folder.join("inside/t.obj");
    let files_read = |library: &str, options: &LoadOptions| {
        let text = format!("mtllib {library}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
        std::fs::write(&path, text).unwrap();
        formats::load(&path, options).unwrap().files.len()
    };
    let everything = LoadOptions { allow_outside: true, ..LoadOptions::default() };
    for library in ["../secret.mtl", "below/../../secret.mtl", "..\\secret.mtl", absolute.to_str().unwrap()] {
        assert_eq!(files_read(library, &LoadOptions::default()), 1, "{library}");
        assert_eq!(files_read(library, &everything), 2, "{library}");
    }
    #[cfg(unix)]
    assert_eq!(files_read("link.mtl", &LoadOptions::default()), 1, "a link leads out");
    assert_eq!(files_read("below/../fine.mtl", &LoadOptions::default()), 2);
}

#[test]
fn limits_are_kept() {
    let folder = folder("obj-limits");
    let path = folder.join("t.obj");
    std::fs::write(&path, "v 0 0 0\n".repeat(100)).unwrap();
    let options = LoadOptions { max_file_bytes: 799, ..LoadOptions::default() };
    assert_eq!(formats::load(&path, &options).unwrap_err().kind(), ErrorKind::Limit);
    let options = LoadOptions { max_file_bytes: 800, ..LoadOptions::default() };
    assert!(formats::load(&path, &options).is_ok());
    assert_eq!(formats::load(&folder.join("none.obj"), &options).unwrap_err().kind(), ErrorKind::Io);
    assert_eq!(formats::load(&folder.join("t.stl"), &options).unwrap_err().kind(), ErrorKind::Unsupported);
}
