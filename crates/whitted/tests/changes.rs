//! A changed scene is prepared with what is the same, and looks as if it had been prepared anew.

mod random_scene;

use random_scene::random_scene;
use whitted::math::{Affine, Vec3d, Vec3f};
use whitted::render::{Cancel, Execution, Silent, render};
use whitted::scene::{
    Background, Camera, Change, Light, LightKind, Mesh, NamedCamera, NamedMaterial, Prepared, Scene, difference,
};
use whitted::shading::Material;
use whitted::tree::BuildOptions;

fn options() -> BuildOptions {
    BuildOptions::default()
}

/// A scene with some of everything that the tests below change.
fn scene(seed: u64) -> Scene {
    let mut scene = random_scene(seed);
    scene.settings.size = [32, 24];
    let transmit = Vec3f::splat(0.7);
    let glass = Material { transmit, ior: 1.4, ..Material::default() };
    scene.materials.push(NamedMaterial { name: "glass".into(), material: glass });
    scene.spheres.push((Vec3d::ZERO, 0.5, 0));
    scene.lights.push(Light {
        kind: LightKind::Point { position: Vec3d::new(3.0, 4.0, 5.0) },
        color: Vec3f::splat(0.5),
        inverse_square: false,
    });
    scene.meshes.push(Mesh {
        positions: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    });
    scene
}

type Edit = fn(&mut Scene);

const LOOKS: [Edit; 11] = [
    |scene| scene.cameras[0].camera.vfov += 5.0,
    |scene| scene.cameras.push(NamedCamera { name: "other".into(), camera: Camera::default() }),
    |scene| scene.lights[0].color = Vec3f::new(0.9, 0.1, 0.3),
    |scene| scene.lights.clear(),
    |scene| scene.materials[0].material.diffuse = 0.31,
    |scene| scene.ambient = Vec3f::splat(0.77),
    |scene| scene.background = Background::Gradient { down: Vec3f::ZERO, up: Vec3f::ONE },
    |scene| scene.settings.depth += 1,
    |scene| scene.spheres.last_mut().expect("a sphere").2 = scene.materials.len() as u32 - 1,
    |scene| scene.meshes.last_mut().expect("a mesh").triangle_materials = vec![scene.materials.len() as u32 - 1],
    |scene| {
        // A material before all others: every number moves.
        scene.materials.insert(0, NamedMaterial { name: "new".into(), material: Material::default() });
        scene.spheres.iter_mut().for_each(|sphere| sphere.2 += 1);
        scene.shapes.iter_mut().for_each(|shape| shape.1 += 1);
        scene.planes.iter_mut().for_each(|plane| plane.1 += 1);
        for mesh in &mut scene.meshes {
            mesh.material += 1;
            mesh.triangle_materials.iter_mut().for_each(|material| *material += 1);
        }
    },
];

const SHAPES: [Edit; 6] = [
    |scene| scene.spheres.last_mut().expect("a sphere").1 *= 1.5,
    |scene| scene.spheres.last_mut().expect("a sphere").0.x += 0.25,
    |scene| scene.spheres.push((Vec3d::new(1.0, 0.0, 0.0), 0.25, 0)),
    |scene| scene.meshes.last_mut().expect("a mesh").positions[0][2] = 0.5,
    |scene| {
        scene.meshes.pop();
    },
    |scene| {
        scene.meshes.last_mut().expect("a mesh").transform =
            Affine { translation: Vec3d::new(0.0, 0.0, 1.0), ..Affine::IDENTITY };
    },
];

fn picture(prepared: &Prepared, scene: &Scene) -> Vec<[u32; 3]> {
    let frame = render(prepared, &scene.settings, &Execution::default(), &Silent, &Cancel::new());
    frame.expect("not cancelled").image.pixels.iter().map(|p| p.to_array().map(f32::to_bits)).collect()
}

#[test]
fn changes_are_followed() {
    for seed in 0..4 {
        let old = scene(seed);
        let prepared = Prepared::new(&old, &options()).expect("a valid scene");
        let before = picture(&prepared, &old);
        assert_eq!(difference(&old, &old.clone()), Change::Nothing);
        let edits = LOOKS.map(|edit| (edit, Change::Look)).into_iter().chain(SHAPES.map(|e| (e, Change::Geometry)));
        for (number, (edit, expected)) in edits.enumerate() {
            let mut new = old.clone();
            edit(&mut new);
            let (after, change) = prepared.after_change(&old, &new, &options()).expect("a valid scene");
            assert_eq!(change, expected, "scene {seed}, edit {number}");
            let same_tree = std::ptr::eq(after.geometry(), prepared.geometry());
            assert_eq!(same_tree, expected == Change::Look, "scene {seed}, edit {number}");
            let anew = Prepared::new(&new, &options()).expect("a valid scene");
            assert_eq!(picture(&after, &new), picture(&anew, &new), "scene {seed}, edit {number}");
            // And back again.
            let (back, _) = after.after_change(&new, &old, &options()).expect("a valid scene");
            assert_eq!(picture(&back, &old), before, "scene {seed}, edit {number}");
        }
    }
}

#[test]
fn a_camera_alone_is_changed_without_the_rest() {
    let mut scene = scene(5);
    let prepared = Prepared::new(&scene, &options()).expect("a valid scene");
    let camera = Camera { eye: Vec3d::new(2.0, 3.0, 9.0), look_at: Vec3d::ZERO, ..Camera::default() };
    let camera = NamedCamera { name: "moved".into(), camera };
    let moved = prepared.with_camera(&camera).expect("a camera");
    assert!(std::ptr::eq(moved.geometry(), prepared.geometry()));
    scene.cameras[0] = camera.clone();
    let anew = Prepared::new(&scene, &options()).expect("a valid scene");
    assert_eq!(picture(&moved, &scene), picture(&anew, &scene));
    let blind = NamedCamera { camera: Camera { look_at: camera.camera.eye, ..camera.camera }, ..camera };
    assert!(prepared.with_camera(&blind).is_err());
}

#[test]
fn a_look_with_a_missing_material_is_refused() {
    let old = scene(6);
    let prepared = Prepared::new(&old, &options()).expect("a valid scene");
    let mut new = old.clone();
    new.spheres[0].2 = 1000;
    assert!(prepared.after_change(&old, &new, &options()).is_err());
}
