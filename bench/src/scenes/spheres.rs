//! Scenes of spheres: the paper's random cube, and the sphereflake over a floor.

use super::{Mesh, Scene, View};
use whitted::geometry::Sphere;
use whitted::math::Vec3f;
use whitted::scene::generate::{GeneratedSphere, PAPER_FILL, sphere_cube, sphereflake};

/// The spheres, camera and first light of the pictures `mix-N` and `all4-N`, N = `count`.
pub(super) fn cube(count: u32) -> Scene {
    let spheres = sphere_cube(count, count.into(), PAPER_FILL).expect("the paper's cubes can be filled");
    Scene { name: String::new(), mesh: Mesh::default(), spheres: singles(&spheres), view: VIEW }
}

/// As the library prepares them.
fn singles(spheres: &[GeneratedSphere]) -> Vec<Sphere> {
    spheres.iter().map(|s| Sphere { center: s.center.to_f32(), radius: s.radius as f32 }).collect()
}

/// The view of the comparison with other renderers.
pub(super) const VIEW: View = View {
    eye: Vec3f::new(2.2, 1.5, 3.4),
    at: Vec3f::ZERO,
    up: Vec3f::new(0.0, 1.0, 0.0),
    fov: 36.0,
    light: Vec3f::new(12.0, 14.0, 10.0),
    bounds: None,
};

/// Haines' sphereflake of `depth` levels below the first sphere, over a floor.
pub(super) fn flake(depth: u32) -> Scene {
    let spheres = sphereflake(depth).expect("the flakes of the benchmark are small");
    let corner = |x, z| Vec3f::new(x, -0.5, z);
    let vertices = vec![corner(-6.0, -6.0), corner(6.0, -6.0), corner(6.0, 6.0), corner(-6.0, 6.0)];
    let mesh = Mesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] };
    let view = View {
        eye: Vec3f::new(2.1, 1.7, 1.3),
        at: Vec3f::ZERO,
        up: Vec3f::new(0.0, 1.0, 0.0),
        fov: 45.0,
        light: Vec3f::new(4.0, 3.0, 2.0),
        bounds: None,
    };
    Scene { name: String::new(), mesh, spheres: singles(&spheres), view }
}
