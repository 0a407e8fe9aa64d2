//! The native scene format: what it says, and how it complains.

use std::path::{Path, PathBuf};

use formats::{Error, ErrorKind, Format, LoadOptions, Loaded};
use whitted::geometry::Shape;
use whitted::math::{Vec3d, Vec3f};
use whitted::scene::generate::{PaperFamily, paper_scene};
use whitted::scene::{Antialias, Background, LightKind, Scene, Settings, Tone};
use whitted::shading::{Reflectance, SpecularModel, Texture};

fn load(format: Format, text: &str) -> Result<Loaded, Error> {
    let name = if format == Format::Json { "t.json" } else { "t.toml" };
    formats::parse(format, Path::new(name), text.as_bytes().to_vec(), &LoadOptions::default())
}

/// A camera for scenes that are not to be furnished.
const CAMERA: &str = "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";

fn scene(text: &str) -> Scene {
    load(Format::Toml, &format!("version = 1\n{text}")).unwrap_or_else(|e| panic!("{e}")).scene
}

/// The whole message about a scene whose first line is `version = 1`.
fn complaint(text: &str) -> String {
    load(Format::Toml, &format!("version = 1\n{text}")).unwrap_err().to_string()
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn a_scene_without_a_camera_is_furnished_and_one_with_is_not() {
    let stage = scene("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1");
    assert_eq!((stage.cameras.len(), stage.lights.len(), stage.planes.len()), (1, 3, 1));
    let text = "version = 1\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]";
    let loaded = load(Format::Toml, text).unwrap();
    assert_eq!(loaded.scene.settings, Settings::default());
    assert_eq!((loaded.scene.background, loaded.scene.ambient), (Background::Color(Vec3f::ZERO), Vec3f::ONE));
    assert!(loaded.scene.lights.is_empty() && loaded.scene.planes.is_empty());
    assert!(loaded.warnings[0].to_string().contains("no light"));
}

#[test]
fn cameras_have_names_if_they_are_given() {
    let one = scene("[camera]\neye = [1, 2, 3]\nlook_at = [0, 0, 0]\nvfov = 36");
    assert_eq!((one.cameras.len(), one.cameras[0].name.as_str()), (1, "default"));
    assert_eq!((one.cameras[0].camera.eye, one.cameras[0].camera.vfov), (Vec3d::new(1.0, 2.0, 3.0), 36.0));
    let two =
        scene("[camera.b]\neye = [1, 0, 0]\nlook_at = [0, 0, 0]\n[camera.a]\neye = [2, 0, 0]\nlook_at = [0, 0, 0]");
    assert_eq!(two.cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["b", "a"], "in the order of the text");
}

#[test]
fn render_settings_are_taken_over() {
    let scene = scene(&format!(
        "{CAMERA}[render]\nsize = [64, 32]\ndepth = 3\nmin_weight = 0.25\naa = 9\naa_max = 4\nsampling = \"corners\"\n\
         shadows = \"opaque\"\nexposure = -1.5\ntone = \"reinhard\"\nseed = 7\n\
         background = {{ up = \"#ffffff\", down = [0, 0.5, 1] }}\nambient = [0.5, 0.5, 0.5]",
    ));
    let Settings { size, depth, min_weight, antialias, antialias_max, exposure, tone, seed, .. } = scene.settings;
    assert_eq!((size, depth, min_weight, antialias_max), ([64, 32], 3, 0.25, 4));
    assert_eq!((antialias, exposure, tone, seed), (Antialias::Uniform(9), -1.5, Tone::Reinhard, 7));
    assert_eq!(scene.background, Background::Gradient { up: Vec3f::ONE, down: Vec3f::new(0.0, 0.5, 1.0) });
    assert_eq!(scene.ambient, Vec3f::splat(0.5));
}

#[test]
fn lights_of_all_kinds() {
    let scene = scene(
        "[[light]]\npoint = [1, 2, 3]\ncolor = [1, 0.5, 0]\nintensity = 2\nfalloff = \"inverse-square\"\n\
         [[light]]\ndirection = [0, -1, 0]\n\
         [[light]]\nspot = [0, 5, 0]\nlook_at = [0, 0, 0]\nouter = 20\n",
    );
    assert_eq!(scene.lights[0].kind, LightKind::Point { position: Vec3d::new(1.0, 2.0, 3.0) });
    assert_eq!((scene.lights[0].color, scene.lights[0].inverse_square), (Vec3f::new(2.0, 1.0, 0.0), true));
    assert_eq!(scene.lights[1].kind, LightKind::Directional { direction: Vec3d::new(0.0, -1.0, 0.0) });
    assert!(!scene.lights[1].inverse_square, "no fall-off unless asked for");
    let LightKind::Spot { inner, outer, .. } = scene.lights[2].kind else { panic!("a spot") };
    assert_eq!((inner, outer), (18.0, 20.0));
}

#[test]
fn materials_may_be_written_short_or_long() {
    let scene = scene(
        "[material.short]\ncolor = \"#ffffff\"\nspecular = 0.25\nreflect = \"fresnel\"\ntransmit = 0.5\n\
         [material.long]\ncolor = { checker = [[1, 0, 0], \"#000000\"], size = 2 }\nambient = 0.3\ndiffuse = 0.4\n\
         specular = { strength = [1, 0.5, 0], exponent = 9, model = \"blinn\" }\n\
         reflect = { strength = 0.5, model = \"schlick\" }\ntransmit = [0.1, 0.2, 0.3]\nior = 1.25\n\
         absorb = { color = [0.25, 0.5, 1], distance = 2 }\n",
    );
    let [short, long] = [&scene.materials[0].material, &scene.materials[1].material];
    assert_eq!((short.color, short.specular), (Texture::Color(Vec3f::ONE), Vec3f::splat(0.25)));
    assert_eq!((short.reflect, short.reflectance, short.ior), (Vec3f::ONE, Reflectance::Fresnel, 1.5));
    assert_eq!(long.color, Texture::Checker { even: Vec3f::new(1.0, 0.0, 0.0), odd: Vec3f::ZERO, size: 2.0 });
    assert_eq!((long.specular, long.exponent), (Vec3f::new(1.0, 0.5, 0.0), 9.0));
    assert_eq!((long.specular_model, long.reflectance), (SpecularModel::Blinn, Reflectance::Schlick));
    assert_eq!((long.reflect, long.transmit, long.ior), (Vec3f::splat(0.5), Vec3f::new(0.1, 0.2, 0.3), 1.25));
    let expected = Vec3f::new(4.0_f32.ln() / 2.0, 2.0_f32.ln() / 2.0, 0.0);
    assert!((long.absorb - expected).length() < 1e-6, "{:?}", long.absorb);
}

#[test]
fn absorption_may_be_given_by_its_coefficients() {
    let found = scene("[material.a]\nabsorb = [0, 0.1, 7]\n");
    assert_eq!(found.materials[0].material.absorb, Vec3f::new(0.0, 0.1, 7.0));
}

#[test]
fn things_of_all_kinds() {
    let scene = scene(&format!(
        "{CAMERA}[material.red]\ncolor = [1, 0, 0]\n\
         [[sphere]]\ncenter = [0, 1, 0]\nradius = 0.5\nmaterial = \"red\"\n\
         [[plane]]\npoint = [0, -1, 0]\n\
         [[disc]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 2]\nradius = 2\ninner_radius = 1\n\
         [[box]]\nmin = [0, 0, 0]\nmax = [1, 2, 3]\nmaterial = \"red\"\n\
         [[cylinder]]\nbase = [0, 0, 0]\napex = [0, 1, 0]\nradius = 0.1\ncapped = false\n\
         [[cone]]\nbase = [0, 0, 0]\napex = [0, 1, 0]\nbase_radius = 0.1\n",
    ));
    assert_eq!(scene.materials.iter().map(|m| m.name.as_str()).collect::<Vec<_>>(), ["red", "default"]);
    assert_eq!(scene.spheres, [(Vec3d::new(0.0, 1.0, 0.0), 0.5, 0)]);
    assert_eq!((scene.planes[0].0.normal, scene.planes[0].1), (Vec3d::new(0.0, 1.0, 0.0), 1));
    assert_eq!(scene.shapes.iter().map(|s| s.1).collect::<Vec<_>>(), [1, 0, 1, 1]);
    assert!(matches!(scene.shapes[0].0, Shape::Disc(disc) if disc.inner_radius == 1.0 && disc.normal.z == 2.0));
    assert!(matches!(scene.shapes[1].0, Shape::Boxed(boxed) if boxed.hi == Vec3d::new(1.0, 2.0, 3.0)));
    assert!(matches!(scene.shapes[2].0, Shape::Cylinder(cylinder) if !cylinder.capped));
    assert!(matches!(scene.shapes[3].0, Shape::Cone(cone) if cone.capped && cone.apex_radius == 0.0));
}

#[test]
fn meshes_are_placed_and_painted() {
    let folder = folder("scene-mesh");
    std::fs::create_dir_all(folder.join("models")).unwrap();
    std::fs::write(folder.join("models/t.mtl"), "newmtl green\nKd 0 1 0\n").unwrap();
    let object = "mtllib t.mtl\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl green\nf 1 2 3\n";
    std::fs::write(folder.join("models/t.obj"), object).unwrap();
    let path = folder.join("scene.toml");
    std::fs::write(
        &path,
        "version = 1\n[material.red]\ncolor = [1, 0, 0]\n[[mesh]]\nfile = \"models/t.obj\"\n[[mesh]]\n\
         file = \"models/t.obj\"\nmaterial = \"red\"\nsmooth = true\ntranslate = [0, 0, 5]\nrotate = [0, 0, 90]\n\
         scale = 2\n[[mesh]]\nfile = \"models/t.obj\"\nrotate = { axis = [0, 1, 0], angle = 90 }\n",
    )
    .unwrap();
    let loaded = formats::load(&path, &LoadOptions::default()).unwrap();
    let [own, red, turned] = loaded.scene.meshes.as_slice() else { panic!("three meshes") };
    let name = |number: u32| loaded.scene.materials[number as usize].name.as_str();
    assert_eq!((name(own.triangle_materials[0]), name(red.material)), ("models/t.obj:green", "red"));
    assert_eq!(own.triangle_materials, turned.triangle_materials, "the file's materials are added once");
    assert!(red.triangle_materials.is_empty() && red.normals.len() == 3 && own.normals.is_empty());
    let x = Vec3d::new(1.0, 0.0, 0.0);
    assert_eq!(red.transform.point(x), Vec3d::new(0.0, 2.0, 5.0), "scaled, turned, moved");
    assert_eq!(turned.transform.point(x), Vec3d::new(0.0, 0.0, -1.0));
    assert_eq!(loaded.files.len(), 3, "each file is read once");
}

#[test]
fn the_papers_scenes_are_the_generators() {
    for (file, family, count) in [("mix-1000", PaperFamily::Mix, 1000), ("all4-10", PaperFamily::All4, 10)] {
        let path = repository().join("scenes").join(file).with_extension("toml");
        let loaded = formats::load(&path, &LoadOptions::default()).unwrap().scene;
        let generated = paper_scene(family, count).unwrap();
        assert_eq!(loaded.spheres, generated.spheres);
        assert_eq!((&loaded.lights, loaded.ambient), (&generated.lights, generated.ambient));
        assert_eq!((loaded.background, loaded.cameras[0].camera), (generated.background, generated.cameras[0].camera));
        let Settings { size, depth, min_weight, .. } = generated.settings;
        assert_eq!(
            (loaded.settings.size, loaded.settings.depth, loaded.settings.min_weight),
            (size, depth, min_weight)
        );
        let materials = |scene: &Scene| scene.materials.iter().map(|m| m.material.clone()).collect::<Vec<_>>();
        assert_eq!(materials(&loaded), materials(&generated));
    }
}

#[test]
fn generators_take_materials_and_places() {
    let scene = scene(&format!(
        "{CAMERA}[material.a]\n[material.b]\n\
         [[generate]]\nkind = \"sphereflake\"\ndepth = 1\nmaterials = [\"b\", \"a\"]\ncenter = [1, 2, 3]\nscale = 2\n\
         [[generate]]\nkind = \"grid\"\nper_edge = 2\nfamily = \"all4\"\n",
    ));
    assert_eq!(scene.spheres[0], (Vec3d::new(1.0, 2.0, 3.0), 1.0, 1));
    assert!(scene.spheres[1..10].iter().all(|s| s.2 == 0));
    assert_eq!((scene.spheres.len(), scene.materials.len()), (1 + 9 + 8, 2 + 12));
}

#[test]
fn all_scenes_of_the_repository_load() {
    let mut count = 0;
    for entry in std::fs::read_dir(repository().join("scenes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "toml") {
            let loaded = formats::load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(loaded.warnings, [], "{}", path.display());
            assert!(loaded.scene.materials.iter().all(|m| m.material.fault().is_none()));
            assert!(loaded.scene.lights.iter().all(|l| l.fault().is_none()));
            count += 1;
        }
    }
    assert!(count >= 11, "{count}");
}

#[test]
fn json_says_the_same() {
    let toml = "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n[material.\"a b\"]\nreflect = 0.5\n\
                [[sphere]]\ncenter = [0.25, 1e2, -3]\nradius = 1\nmaterial = \"a b\"";
    let json = r#"{"version": 1, "camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}, "render": {},
        "material": {"a\u0020b": {"reflect": 0.5, "ior": null}},
        "sphere": [{"center": [0.25, 1e2, -3.0], "radius": 1, "material": "a b"}]}"#;
    let (toml, json) = (scene(toml), load(Format::Json, json).unwrap().scene);
    assert_eq!(format!("{toml:?}"), format!("{json:?}"));
}

#[test]
fn complaints_show_the_place_and_a_way_out() {
    for (text, message) in [
        (
            "[camra]",
            "t.toml:2:2: the key \"camra\" is not known here\n  [camra]\n   ^^^^^\nhint: did you mean \"camera\"?",
        ),
        (
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = -1",
            "t.toml:4:10: expected a number greater than 0, found -1\n  radius = -1\n           ^^",
        ),
        (
            "[material.glass]\n[[plane]]\npoint = [0, 0, 0]\nmaterial = \"glas\"",
            "t.toml:5:12: there is no material \"glas\"\n  material = \"glas\"\n             ^^^^^^\nhint: did you mean \"glass\"?",
        ),
        (
            "[[box]]\nmin = [0, 0, 1]\nmax = [1, 1, 0]",
            "t.toml:2:1: a coordinate of \"min\" exceeds that of \"max\"\n  [[box]]\n  ^^^^^^^",
        ),
        ("[render]\nsize = [1, 2", "t.toml:3:13: unclosed array, expected `]`\n  size = [1, 2\n              ^"),
        ("sphere = 3", "t.toml:2:10: expected a list, found 3\n  sphere = 3\n           ^"),
        (
            "[[mesh]]\nfile = \"../secret.ply\"",
            "t.toml:3:8: a scene that is not loaded from a file cannot name files\n  file = \"../secret.ply\"\n         ^^^^^^^^^^^^^^^",
        ),
        ("[camera]", "t.toml:2:1: the key \"eye\" is missing\n  [camera]\n  ^^^^^^^^"),
    ] {
        let found = complaint(text);
        assert!(found.starts_with(message), "expected\n{message}\nfound\n{found}");
    }
}

#[test]
fn every_wrong_value_is_refused_with_its_line() {
    let sphere = |line: &str| format!("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n{line}");
    for (line, text) in [
        (2, "version = 1".to_owned()),
        (4, "[[sphere]]\ncenter = [0, 0, 0]\nradius = nan".to_owned()),
        (5, sphere("colour = 3")),
        (5, sphere("material = 3")),
        (3, "[[sphere]]\ncenter = [0, 0]\nradius = 1".to_owned()),
        (3, "[[sphere]]\ncenter = [0, 0, 0, 0]\nradius = 1".to_owned()),
        (3, "[[sphere]]\ncenter = [0, 0, inf]\nradius = 1".to_owned()),
        (3, "[render]\nsize = [0, 1]".to_owned()),
        (3, "[render]\nsize = [1, 1, 1]".to_owned()),
        (3, "[render]\nsize = [1000000, 1000000]".to_owned()),
        (3, "[render]\nsize = 3".to_owned()),
        (3, "[render]\ndepth = 1001".to_owned()),
        (3, "[render]\ndepth = 1.5".to_owned()),
        (3, "[render]\naa = 0".to_owned()),
        (3, "[render]\ntone = \"film\"".to_owned()),
        (3, "[render]\nbackground = [0, -1, 0]".to_owned()),
        (3, "[render]\nbackground = { up = [0, 0, 0] }".to_owned()),
        (3, "[material.a]\nior = 0".to_owned()),
        (3, "[material.a]\nabsorb = { color = [0, 1, 1] }".to_owned()),
        (3, "[material.a]\nabsorb = [0, -1, 1]".to_owned()),
        (3, "[material.a]\nreflect = \"mirror\"".to_owned()),
        (3, "[material.a]\ntransmit = -0.1".to_owned()),
        (3, "[material.a]\nspecular = { exponent = -1 }".to_owned()),
        (3, "[material.a]\ncolor = \"#12345g\"".to_owned()),
        (2, "[[light]]\ncolor = [1, 1, 1]".to_owned()),
        (2, "[[light]]\npoint = [0, 0, 0]\nouter = 3".to_owned()),
        (2, "[[light]]\nspot = [0, 0, 0]\nlook_at = [0, 0, 0]".to_owned()),
        (3, "[[light]]\ndirection = [0, 0, 0]".to_owned()),
        (2, "[[disc]]\ncenter = [0, 0, 0]\nradius = 1\ninner_radius = 1".to_owned()),
        (2, "[[cylinder]]\nbase = [0, 0, 0]\napex = [0, 0, 0]\nradius = 1".to_owned()),
        (2, "[[cone]]\nbase = [0, 0, 0]\napex = [0, 1, 0]\nbase_radius = 0".to_owned()),
        (2, "[[generate]]\ncount = 3".to_owned()),
        (2, "[[generate]]\nkind = \"sphere-cube\"\ncount = 3\nfill = 0.9".to_owned()),
        (2, "[[generate]]\nkind = \"grid\"\nper_edge = 1000".to_owned()),
        (2, "[[generate]]\nkind = \"sphereflake\"\ndepth = 4000000000".to_owned()),
        (3, "[[mesh]]\nfile = \"a.gltf\"".to_owned()),
        (2, "when = 2020-01-01".to_owned()),
    ] {
        let found = complaint(&text);
        assert!(found.starts_with(&format!("t.toml:{line}:")), "{text}\n{found}");
    }
}

#[test]
fn versions_are_checked() {
    assert_eq!(load(Format::Toml, "").unwrap_err().report().hint.as_deref(), Some("a scene begins with version = 1"));
    assert_eq!(load(Format::Toml, "version = 2").unwrap_err().kind(), ErrorKind::Unsupported);
    assert_eq!(load(Format::Json, "[1]").unwrap_err().kind(), ErrorKind::Input);
}

#[test]
fn nesting_cannot_exhaust_the_stack() {
    let deep = 100_000;
    for (format, text) in [
        (Format::Toml, format!("a = {}", "[".repeat(deep))),
        (Format::Toml, format!("{}a = 1", "a.".repeat(deep))),
        (Format::Json, "[".repeat(deep)),
        (Format::Json, format!("{}{}", "[".repeat(deep), "]".repeat(deep))),
        (Format::Json, format!("{}1{}", "{\"a\":".repeat(deep), "}".repeat(deep))),
    ] {
        assert!(load(format, &text).is_err());
    }
}

/// `WHITTED_BLESS=1 cargo test -p whitted-formats` writes the schema anew.
#[test]
fn the_published_schema_is_current() {
    let path = repository().join("docs/scene.schema.json");
    let schema = formats::scene_schema();
    if std::env::var_os("WHITTED_BLESS").is_some() {
        std::fs::write(&path, &schema).unwrap();
    }
    let published = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(published == schema, "docs/scene.schema.json is stale: run this test with WHITTED_BLESS=1");
}

#[test]
fn meshes_outside_the_folder_are_opened_only_if_allowed() {
    let folder = folder("scene-outside");
    std::fs::create_dir_all(folder.join("inside/deep")).unwrap();
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(folder.join("t.obj"), mesh).unwrap();
    std::fs::write(folder.join("inside/t.obj"), mesh).unwrap();
    let path = folder.join("inside/t.toml");
    let everything = LoadOptions { allow_outside: true, ..LoadOptions::default() };
    let absolute = folder.join("t.obj").display().to_string();
    for name in ["../t.obj", "deep/../../t.obj", "..\\\\t.obj", absolute.as_str(), "../nowhere.obj"] {
        std::fs::write(&path, format!("version = 1\n[[mesh]]\nfile = \"{name}\"\n")).unwrap();
        let error = formats::load(&path, &LoadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("t.toml:3:8: the file lies outside the scene's folder"), "{name}: {error}");
        assert_eq!(formats::load(&path, &everything).is_ok(), name != "../nowhere.obj", "{name}");
    }
    std::fs::write(&path, "version = 1\n[[mesh]]\nfile = \"deep/../t.obj\"\n").unwrap();
    assert!(formats::load(&path, &LoadOptions::default()).is_ok());
}
