//! Spheres made of triangles, for what spheres cannot show: the tests of triangles.

use whitted::math::{Vec3d, Vec3f};
use whitted::scene::generate::{PaperFamily, paper_scene};
use whitted::scene::{Mesh, Scene};

/// Times that each triangle of an octahedron is cut into four: 2048 triangles a sphere.
const CUTS: u32 = 4;

/// The scene `mix-count` with smooth meshes in place of its spheres.
pub(super) fn scene(count: u32) -> Scene {
    let mut scene = paper_scene(PaperFamily::Mix, count).expect("a few spheres are placed");
    let ball = octahedron().into_iter().flat_map(|triangle| cut(triangle, CUTS)).collect::<Vec<_>>();
    let spheres = std::mem::take(&mut scene.spheres);
    scene.meshes =
        spheres.into_iter().map(|(center, radius, material)| mesh(&ball, center, radius, material)).collect();
    scene
}

type Triangle = [Vec3f; 3];

/// One side in each octant, its corners counter-clockwise from outside.
fn octahedron() -> Vec<Triangle> {
    let side = |octant: u8| {
        let sign = |axis: u8| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 };
        let [x, y, z] = [Vec3f::new(sign(0), 0.0, 0.0), Vec3f::new(0.0, sign(1), 0.0), Vec3f::new(0.0, 0.0, sign(2))];
        if octant.count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] }
    };
    (0..8).map(side).collect()
}

/// The triangle in 4^`times` parts, their corners on the sphere.
fn cut([a, b, c]: Triangle, times: u32) -> Vec<Triangle> {
    if times == 0 {
        return vec![[a, b, c]];
    }
    let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].into_iter().flat_map(|part| cut(part, times - 1)).collect()
}

/// Half-way on the sphere. Sums do not depend on the order, so that neighbours share their corners bit by bit.
fn middle(a: Vec3f, b: Vec3f) -> Vec3f {
    let sum = a + b;
    sum * (1.0 / sum.length_squared().sqrt())
}

fn mesh(ball: &[Triangle], center: Vec3d, radius: f64, material: u32) -> Mesh {
    let normals: Vec<[f32; 3]> = ball.iter().flatten().map(|corner| corner.to_array()).collect();
    let place = |normal: &[f32; 3]| normal.map(|component| component * radius as f32);
    Mesh {
        name: "ball".to_owned(),
        positions: normals.iter().map(place).collect(),
        origin: center,
        triangles: (0..ball.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        normals,
        material,
        ..Mesh::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_round() {
        let scene = scene(1);
        let [mesh] = &scene.meshes[..] else { panic!("one ball") };
        assert_eq!(mesh.triangles.len(), 8 * 4_usize.pow(CUTS));
        for triangle in octahedron() {
            let [a, b, c] = triangle;
            assert!((b - a).cross(c - a).dot(a) > 0.0, "{triangle:?} is seen from inside");
        }
        assert!(mesh.normals.iter().all(|n| (n.iter().map(|x| x * x).sum::<f32>() - 1.0).abs() < 1e-6));
    }
}
