//! Values that were changed are written back; nothing else is touched.

use std::fs;
use std::path::Path;

use formats::{ErrorKind, Format, LoadOptions, camera_block, parse, write_back};
use whitted::math::{SplitMix64, Vec3d, Vec3f};
use whitted::scene::{
    Antialias, Background, Camera, Change, Light, LightKind, NamedCamera, NamedMaterial, Scene, Tone, difference,
};
use whitted::shading::{Material, Reflectance, SpecularModel, Texture};

fn read(text: &str) -> Scene {
    let loaded = parse(Format::Toml, Path::new("scene.toml"), text.as_bytes().to_vec(), &LoadOptions::default());
    loaded.unwrap_or_else(|error| panic!("{error}\n{text}")).scene
}

fn write(text: &str, old: &Scene, new: &Scene) -> Result<String, formats::Error> {
    write_back(Path::new("scene.toml"), text, old, new)
}

/// `text` after `edit`, which must be read as what was asked for.
#[track_caller]
fn edited(text: &str, edit: impl FnOnce(&mut Scene)) -> String {
    let old = read(text);
    let mut new = old.clone();
    edit(&mut new);
    let written = write(text, &old, &new).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(difference(&read(&written), &new), Change::Nothing, "{written}");
    written
}

/// Every way to write down a value that a scene has, with comments in odd places.
const EVERYTHING: &str = r##"# A scene.
version = 1 # the first

[camera.front] # seen from the front
eye = [0, 1, 5]
look_at = [
  0, # in the middle
  0, 0,
]

[camera."from above"]
  eye = [0, 5, 0]
  look_at = [0, 0, 0]
  up = [0, 0, -1]
  # A narrow view.
  vfov = 30

[render]
size = [64, 48]
aa = 4
background = { up = "#6f93c4", down = "#f2e9dc" } # sky

[[light]]
point = [3, 4, 5] # a lamp
intensity = 2

[[light]]
# The sun.
direction = [-1, -2, -1]
color = "#ffd9a0"

[[light]]
spot = [0, 5, 0]
look_at = [0, 0, 0]
outer = 20

[material]
plain = { }
inline = { diffuse = 0.5, specular = { strength = 0.3, exponent = 7 }, reflect = "schlick" } # one line
dotted.color = "#808080"

[material.floor]
color = { checker = ["#e8e2d6", [0.1, 0.2, 0.3]], size = 0.5 }
reflect = 0.25 # a little

[material."all of it"]
ambient = 0.2
diffuse = 0.1
transmit = [0.9, 0.8, 0.7]
absorb = { color = [0.9, 0.1, 0.15], distance = 0.5 }

[material."all of it".specular]
strength = 0.5
model = "blinn"

[[sphere]]
center = [0, 0.5, 0]
radius = 0.5
material = "inline"

[[plane]]
point = [0, 0, 0]
material = "floor"

[[generate]]
kind = "sphere-cube"
count = 10
# The end.
"##;

struct Random(SplitMix64);

impl Random {
    /// In single precision: short, long, large or tiny.
    fn strength(&mut self) -> f32 {
        let value = self.0.next_f64() as f32;
        match self.0.below(4) {
            0 => (value * 16.0).floor() / 16.0,
            1 => value * 1e-9,
            2 => value * 1e9,
            _ => value,
        }
    }

    fn color(&mut self) -> Vec3f {
        Vec3f::new(self.strength(), self.strength(), self.strength())
    }

    fn point(&mut self) -> Vec3d {
        let coordinate = |random: &mut Self| {
            let value = random.0.uniform(-100.0, 100.0);
            if random.0.below(2) == 0 { value.round() } else { value }
        };
        Vec3d::new(coordinate(self), coordinate(self), coordinate(self))
    }

    /// Change one value of the scene.
    fn edit(&mut self, scene: &mut Scene) {
        let materials = scene.materials.iter().position(|named| named.name == "all of it").unwrap() as u32 + 1;
        let index = self.0.below(materials) as usize;
        let strength = self.strength();
        let color = self.color();
        let material = &mut scene.materials[index].material;
        match self.0.below(24) {
            0 => material.ambient = strength,
            1 => material.diffuse = strength,
            2 => material.transmit = color,
            3 => material.ior = 1.0 + strength,
            4 => material.specular = if self.0.below(2) == 0 { Vec3f::splat(strength) } else { color },
            5 => material.exponent = strength,
            6 => material.specular_model = SpecularModel::Blinn,
            7 => material.reflect = color,
            8 => {
                material.reflectance =
                    [Reflectance::Constant, Reflectance::Fresnel, Reflectance::Schlick][self.0.below(3) as usize];
            }
            9 => material.color = Texture::Color(color),
            10 => material.color = Texture::Checker { even: color, odd: self.color(), size: 0.1 + strength },
            11 => scene.settings.depth = self.0.below(20),
            12 => scene.settings.antialias = [Antialias::Paper, Antialias::Uniform(9)][self.0.below(2) as usize],
            13 => scene.settings.exposure = -strength,
            14 => scene.settings.tone = Tone::Reinhard,
            15 => scene.background = Background::Color(color),
            16 => scene.ambient = color,
            22 => material.absorb = color,
            17 => scene.cameras[self.0.below(2) as usize].camera.eye = self.point() + Vec3d::splat(200.0),
            18 => scene.cameras[self.0.below(2) as usize].camera.vfov = self.0.uniform(1.0, 179.0),
            19 => scene.lights[self.0.below(3) as usize].color = color,
            20 => scene.lights[self.0.below(3) as usize].inverse_square ^= true,
            21 => match &mut scene.lights[self.0.below(3) as usize].kind {
                LightKind::Point { position } | LightKind::Spot { position, .. } => *position = self.point(),
                LightKind::Directional { direction } => *direction = self.point() + Vec3d::splat(1000.0),
            },
            _ => {
                if let LightKind::Spot { outer, inner, .. } = &mut scene.lights[2].kind {
                    *outer = inner.max(self.0.uniform(30.0, 90.0));
                }
            }
        }
    }
}

#[test]
fn what_is_written_back_is_read_as_what_was_changed() {
    let old = read(EVERYTHING);
    let (mut written, mut refused) = (0, 0);
    for seed in 0..3000 {
        let mut random = Random(SplitMix64::new(seed));
        let mut new = old.clone();
        let edits = 1 + random.0.below(4);
        (0..edits).for_each(|_| random.edit(&mut new));
        match write(EVERYTHING, &old, &new) {
            Ok(text) => {
                let found = read(&text);
                assert_eq!(difference(&found, &new), Change::Nothing, "seed {seed}:\n{text}");
                assert_untouched(&text, edits as usize);
                written += 1;
            }
            // A section of dotted keys takes no new ones, and a section of its own no plain value.
            Err(error) => {
                assert_eq!(error.kind(), ErrorKind::Unsupported);
                refused += 1;
            }
        }
    }
    assert!(refused * 2 < written, "{refused} of {} edits were refused", written + refused);
}

/// Comments are all there in their order, and no more lines differ than were edited.
fn assert_untouched(text: &str, edits: usize) {
    let comments = |text: &str| -> Vec<String> {
        let comment = |line: &str| line.split_once("# ").map(|(_, comment)| comment.to_owned());
        text.lines().filter_map(comment).collect()
    };
    assert_eq!(comments(text), comments(EVERYTHING));
    // A light's colour and intensity, a material's reflection and index: an edit changes at most two lines.
    let lines: Vec<&str> = EVERYTHING.lines().collect();
    let kept = text.lines().filter(|line| lines.contains(line)).count();
    assert!(kept + 2 * edits >= lines.len(), "{kept} of {} lines are left:\n{text}", lines.len());
}

#[test]
fn nothing_changed_is_nothing_written() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut texts = vec![EVERYTHING.to_owned(), EVERYTHING.replace('\n', "\r\n"), format!("\u{feff}{EVERYTHING}")];
    for entry in fs::read_dir(scenes).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            texts.push(fs::read_to_string(path).unwrap());
        }
    }
    assert!(texts.len() > 5);
    for text in texts {
        let scene = read(&text);
        assert_eq!(write(&text, &scene, &scene).unwrap(), text);
        // Something was changed and changed back.
        let mut other = scene.clone();
        other.settings.depth += 1;
        other.cameras[0].camera.vfov += 0.125;
        let there = write(&text, &scene, &other).unwrap();
        assert_ne!(there, text);
        let back = write(&there, &other, &scene).unwrap();
        assert_eq!(difference(&read(&back), &scene), Change::Nothing);
    }
}

#[test]
fn values_are_replaced_and_added_where_they_belong() {
    let text = edited(EVERYTHING, |scene| {
        scene.cameras[0].camera.vfov = 25.0;
        scene.lights[0].color = Vec3f::splat(3.0);
        scene.materials.iter_mut().find(|m| m.name == "floor").unwrap().material.diffuse = 0.7;
        scene.settings.depth = 3;
    });
    for (before, after) in [
        ("  0, 0,\n]\n", "  0, 0,\n]\nvfov = 25\n"),
        ("intensity = 2\n", "intensity = 3\n"),
        ("reflect = 0.25 # a little\n", "reflect = 0.25 # a little\ndiffuse = 0.7\n"),
        (" # sky\n", " # sky\ndepth = 3\n"),
    ] {
        assert!(EVERYTHING.contains(before) && text.contains(after), "{after}:\n{text}");
    }
    assert_eq!(text.len(), EVERYTHING.len() + "vfov = 25\ndiffuse = 0.7\ndepth = 3\n".len());
}

#[test]
fn inner_tables_change_inside() {
    let text = edited(EVERYTHING, |scene| {
        for named in &mut scene.materials {
            match named.name.as_str() {
                "inline" => named.material.exponent = 9.0,
                "all of it" => named.material.specular = Vec3f::splat(0.25),
                "plain" => named.material.reflectance = Reflectance::Fresnel,
                _ => {}
            }
        }
    });
    assert!(text.contains("specular = { strength = 0.3, exponent = 9 }, reflect = \"schlick\" } # one line"), "{text}");
    assert!(text.contains(".specular]\nstrength = 0.25\nmodel"), "{text}");
    // Fresnel's reflection would bring another index with it.
    assert!(text.contains("plain = { ior = 1"), "{text}");
}

#[test]
fn settings_that_stand_in_for_those_of_the_file_stay_out_of_it() {
    let old = {
        let mut old = read(EVERYTHING);
        old.settings.size = [1920, 1080];
        old
    };
    let mut new = old.clone();
    new.settings.seed = 5;
    let text = write(EVERYTHING, &old, &new).unwrap();
    assert!(text.contains("size = [64, 48]") && text.contains("seed = 5"));
}

#[test]
fn sections_that_are_not_there_are_appended() {
    let text = "version = 1\n[camera]\neye = [0, 0, 5] # here\nlook_at = [0, 0, 0]";
    let with_depth = edited(text, |scene| scene.settings.depth = 2);
    assert_eq!(with_depth, format!("{text}\n\n[render]\ndepth = 2\n"));
    let eye = Vec3d::new(0.1, 2.0, 1e20);
    let added = NamedCamera { name: "new one".into(), camera: Camera { eye, vfov: 33.5, ..Camera::default() } };
    let with_camera = edited(text, |scene| scene.cameras.push(added.clone()));
    let block = "[camera.\"new one\"]\neye = [0.1, 2, 1e20]\nlook_at = [0, 0, 0]\nvfov = 33.5\n";
    assert_eq!(with_camera, format!("{}\n\n{block}", text.replace("[camera]", "[camera.default]")));
    assert_eq!(camera_block("new one", &added.camera), block);
    let single = camera_block("", &added.camera);
    let camera = &read(&format!("version = 1\n{single}")).cameras[0];
    assert_eq!(camera.camera, added.camera);
}

const TWO_LIGHTS: &str = "\
version = 1
camera = { eye = [0, 0, 5], look_at = [0, 0, 0] }

# The lamp.
[[light]]
point = [1, 2, 3] # here
# as bright as the sun
intensity = 2

# The sun.
[[light]]
direction = [0, -1, 0]

# The end.
";

fn lamp(x: f64) -> Light {
    Light { kind: LightKind::Point { position: Vec3d::new(x, 0.5, 0.0) }, color: Vec3f::ONE, inverse_square: false }
}

#[test]
fn lights_come_and_go() {
    let lamp_text = "[[light]]\npoint = [1, 2, 3] # here\n# as bright as the sun\nintensity = 2\n\n";
    let sun_text = "[[light]]\ndirection = [0, -1, 0]\n\n";
    let new_text = "[[light]]\npoint = [7, 0.5, 0]\n\n";
    let without = |part: &str| TWO_LIGHTS.replace(part, "");
    assert_eq!(edited(TWO_LIGHTS, |scene| _ = scene.lights.remove(0)), without(lamp_text));
    assert_eq!(edited(TWO_LIGHTS, |scene| _ = scene.lights.remove(1)), without(sun_text));
    let none = edited(TWO_LIGHTS, |scene| scene.lights.clear());
    assert_eq!(none, without(lamp_text).replace(sun_text, ""));
    let only = edited(TWO_LIGHTS, |scene| scene.lights = vec![Light { inverse_square: true, ..lamp(7.0) }]);
    assert!(only.contains("[[light]]\npoint = [7, 0.5, 0] # here\n") && only.contains("intensity = 1\n"), "{only}");
    assert_eq!(
        edited(TWO_LIGHTS, |s| s.lights.push(lamp(7.0))),
        TWO_LIGHTS.replace("\n# The end", &format!("\n{new_text}# The end"))
    );
    let between = format!("{lamp_text}{new_text}");
    assert_eq!(edited(TWO_LIGHTS, |s| s.lights.insert(1, lamp(7.0))), TWO_LIGHTS.replace(lamp_text, &between));
    // The first one by far is another kind of light now.
    let spot = LightKind::Spot { position: Vec3d::ONE, look_at: Vec3d::ZERO, inner: 10.0, outer: 20.0 };
    let other = edited(TWO_LIGHTS, |scene| scene.lights[0] = Light { kind: spot, ..lamp(0.0) });
    let spot_text = "[[light]]\nspot = [1, 1, 1]\nlook_at = [0, 0, 0]\ninner = 10\nouter = 20\n\n";
    assert!(other.contains(spot_text) && other.contains(sun_text) && !other.contains("point"), "{other}");
    let first = edited("version = 1\ncamera = { eye = [0, 0, 5], look_at = [0, 0, 0] }", |s| s.lights.push(lamp(7.0)));
    assert!(first.ends_with("}\n\n[[light]]\npoint = [7, 0.5, 0]\n"), "{first}");
}

#[test]
fn whatever_becomes_of_the_lights_is_read_as_that() {
    for text in [EVERYTHING.to_owned(), TWO_LIGHTS.to_owned(), TWO_LIGHTS.replace('\n', "\r\n")] {
        for seed in 0..500 {
            let mut random = Random(SplitMix64::new(seed));
            edited(&text, |scene| {
                for _ in 0..1 + random.0.below(5) {
                    let (count, color) = (scene.lights.len() as u32, random.color());
                    let index = random.0.below(count.max(1)) as usize;
                    let kind = match random.0.below(2) {
                        0 => LightKind::Point { position: random.point() },
                        _ => LightKind::Directional { direction: random.point() + Vec3d::splat(1000.0) },
                    };
                    match random.0.below(4) {
                        0 => scene.lights.insert(index, Light { kind, color, inverse_square: random.0.below(2) == 0 }),
                        1 if count > 0 => _ = scene.lights.remove(index),
                        2 if count > 0 => scene.lights[index].kind = kind,
                        _ if count > 0 => scene.lights[index].color = color,
                        _ => {}
                    }
                }
            });
        }
    }
}

#[test]
fn materials_that_things_get_by_themselves_can_be_stated() {
    let text = "version = 1 # one\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n[[sphere]]\ncenter = [0, 0, 0]\n\
                radius = 1\n[[generate]]\nkind = \"sphere-cube\"\ncount = 10\nfamily = \"mix\"\n";
    let old = read(text);
    let mut new = old.clone();
    let names: Vec<&str> = old.materials.iter().map(|named| named.name.as_str()).collect();
    assert!(names.len() > 2 && names.contains(&"default") && names.contains(&"mix.m0"), "{names:?}");
    for named in new.materials.iter_mut().filter(|named| ["default", "mix.m0"].contains(&named.name.as_str())) {
        named.material.reflectance = Reflectance::Fresnel;
        named.material.diffuse = 0.25;
        named.material.color = Texture::Color(Vec3f::new(1.0, 0.5, 0.25));
    }
    let written = write(text, &old, &new).unwrap();
    assert!(written.starts_with(text) && written.contains("\n[material.default]\n"), "{written}");
    assert!(written.contains("\n[material.\"mix.m0\"]\n") && written.matches("[material").count() == 2, "{written}");
    let found = read(&written);
    for named in &new.materials {
        let found = found.materials.iter().find(|found| found.name == named.name);
        assert_eq!(found, Some(named), "{written}");
    }
}

#[test]
fn line_breaks_stay_what_they_are() {
    let text = EVERYTHING.replace('\n', "\r\n");
    let written = edited(&text, |scene| {
        scene.settings.seed = 9;
        scene.cameras.push(NamedCamera { name: "x".into(), camera: Camera::default() });
    });
    assert_eq!(written.matches('\n').count(), written.matches("\r\n").count());
}

#[test]
fn what_the_file_does_not_state_is_refused() {
    let refused = |text: &str, edit: fn(&mut Scene), word: &str| {
        let old = read(text);
        let mut new = old.clone();
        edit(&mut new);
        let error = write(text, &old, &new).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unsupported);
        assert!(error.to_string().contains(word), "no '{word}' in: {error}");
    };
    refused(EVERYTHING, |scene| scene.spheres[0].1 = 2.0, "shapes");
    refused(
        EVERYTHING,
        |scene| {
            scene.cameras.pop();
        },
        "from above",
    );
    refused(EVERYTHING, |scene| scene.materials[0].name.push('x'), "renamed");
    let furnished = "version = 1\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    refused(furnished, |scene| scene.cameras[0].camera.vfov = 20.0, "no camera");
    refused(furnished, |scene| scene.lights[0].color = Vec3f::ZERO, "lights");
    let listed = "version = 1\nlight = [{ point = [0, 1, 2] }]\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    refused(listed, |scene| scene.lights.clear(), "header of its own");
    refused(listed, |scene| scene.lights.push(scene.lights[0]), "header of its own");
    // A material of a mesh's own file.
    let old = {
        let mut old = read(EVERYTHING);
        old.materials.push(NamedMaterial { name: "wall.obj:brick".into(), material: Material::default() });
        old
    };
    let mut new = old.clone();
    new.materials.last_mut().unwrap().material.diffuse = 0.123;
    let error = write(EVERYTHING, &old, &new).unwrap_err().to_string();
    assert!(error.contains("does not stand"), "{error}");
    assert_eq!(write("nonsense", &Scene::default(), &Scene::default()).unwrap_err().kind(), ErrorKind::Input);
}
