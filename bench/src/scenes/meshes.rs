//! Large meshes: a fractal terrain and a ball of hair.

use super::{Mesh, Scene, View};
use crate::ray_sets::on_sphere;
use std::f64::consts::TAU;
use whitted::math::{Aabb, SplitMix64, Vec3d, Vec3f};

const UP: Vec3f = Vec3f::new(0.0, 1.0, 0.0);

/// A square of `cells` × `cells` cells of two triangles whose heights are displaced midpoints, over [−1, 1]².
pub(super) fn terrain(cells: u32) -> Scene {
    let cells = cells as usize;
    // Midpoints need a power of two: other numbers of cells take the nearest points of the next larger lattice.
    let lattice = cells.next_power_of_two();
    let heights = midpoint_heights(lattice);
    let coordinate = |i: usize| 2.0 * i as f32 / lattice as f32 - 1.0;
    let rows = cells + 1;
    let vertex = |i: usize| {
        let [x, z] = [i % rows, i / rows].map(|i| i * lattice / cells);
        Vec3f::new(coordinate(x), heights[z * (lattice + 1) + x], coordinate(z))
    };
    let vertices = (0..rows * rows).map(vertex).collect();
    let cell = |i: usize| {
        let a = (i / cells * rows + i % cells) as u32;
        let (b, c, d) = (a + 1, a + rows as u32, a + rows as u32 + 1);
        [[a, c, b], [b, c, d]]
    };
    let triangles = (0..cells * cells).flat_map(cell).collect();
    let view = View {
        eye: Vec3f::new(0.3, 0.7, 1.9),
        at: Vec3f::new(0.0, 0.1, 0.0),
        up: UP,
        fov: 45.0,
        light: Vec3f::new(2.0, 1.2, 1.0),
        bounds: None,
    };
    Scene { name: String::new(), mesh: Mesh { vertices, triangles }, spheres: Vec::new(), view }
}

/// Heights of a square lattice by diamond and square steps (Fournier, Fussell, Carpenter 1982); `cells` is a power of
/// two. Displacements halve with the step, a little less for a rough surface.
fn midpoint_heights(cells: usize) -> Vec<f32> {
    const ROUGHNESS: f64 = 0.55;
    let rows = cells + 1;
    let mut heights = vec![0.0_f32; rows * rows];
    let mut rng = SplitMix64::new(cells as u64);
    let (mut step, mut amplitude) = (cells, 0.5);
    while step > 1 {
        let half = step / 2;
        for (y, x) in lattice(half, half, step, cells) {
            heights[y * rows + x] = mean_around(&heights, rows, y, x, half, [(-1, -1), (-1, 1), (1, -1), (1, 1)])
                + rng.uniform(-amplitude, amplitude) as f32;
        }
        for (y, x) in lattice(0, half, step, cells).chain(lattice(half, 0, step, cells)) {
            heights[y * rows + x] = mean_around(&heights, rows, y, x, half, [(-1, 0), (1, 0), (0, -1), (0, 1)])
                + rng.uniform(-amplitude, amplitude) as f32;
        }
        (step, amplitude) = (half, amplitude * ROUGHNESS);
    }
    heights
}

/// The points `(y + i·step, x + j·step)` up to `cells`.
fn lattice(y: usize, x: usize, step: usize, cells: usize) -> impl Iterator<Item = (usize, usize)> {
    (y..=cells).step_by(step).flat_map(move |y| (x..=cells).step_by(step).map(move |x| (y, x)))
}

/// The mean of those of four neighbours that lie within the square.
fn mean_around(heights: &[f32], rows: usize, y: usize, x: usize, step: usize, around: [(isize, isize); 4]) -> f32 {
    let at = |c: usize, sign: isize| c.checked_add_signed(sign * step as isize).filter(|&c| c < rows);
    let found = around.iter().filter_map(|&(dy, dx)| Some(heights[at(y, dy)? * rows + at(x, dx)?]));
    let (sum, count) = found.fold((0.0, 0.0), |(sum, count), height| (sum + height, count + 1.0));
    sum / count
}

/// Bent tubes of 20 rings with 6 corners, 240 triangles each, from the middle to the surface of a ball.
pub(super) fn hairball(tubes: u32) -> Scene {
    let mut rng = SplitMix64::new(u64::from(tubes));
    let mut mesh = Mesh::default();
    (0..tubes).for_each(|_| tube(&mut mesh, &mut rng));
    let bounds = Some(Aabb::around(mesh.vertices.iter().copied()));
    let view = View {
        eye: Vec3f::new(0.5, 0.6, 3.2),
        at: Vec3f::ZERO,
        up: UP,
        fov: 40.0,
        light: Vec3f::new(3.0, 5.0, 4.0),
        bounds,
    };
    Scene { name: String::new(), mesh, spheres: Vec::new(), view }
}

const SEGMENTS: u32 = 20;
const SIDES: u32 = 6;

/// Append a tube that starts near the middle and wanders outward, thinner toward its end.
fn tube(mesh: &mut Mesh, rng: &mut SplitMix64) {
    const LENGTH: f64 = 1.1;
    const RADIUS: f64 = 0.003;
    const BEND: f64 = 0.35;
    let mut direction = on_sphere(rng);
    let mut center = direction * 0.05;
    let first = mesh.vertices.len() as u32;
    for ring in 0..=SEGMENTS {
        let radius = RADIUS * (1.0 - 0.7 * f64::from(ring) / f64::from(SEGMENTS));
        let side = direction.cross(Vec3d::new(0.31, 0.83, -0.47)).normalize();
        let other = direction.cross(side);
        mesh.vertices.extend((0..SIDES).map(|k| {
            let turn = f64::from(k) * TAU / f64::from(SIDES);
            (center + (side * turn.cos() + other * turn.sin()) * radius).to_f32()
        }));
        center += direction * (LENGTH / f64::from(SEGMENTS));
        direction = (direction + on_sphere(rng) * BEND).normalize();
    }
    for (ring, k) in (0..SEGMENTS).flat_map(|ring| (0..SIDES).map(move |k| (ring, k))) {
        let corner = |ring: u32, k: u32| first + ring * SIDES + k % SIDES;
        let [a, b, c, d] = [corner(ring, k), corner(ring, k + 1), corner(ring + 1, k), corner(ring + 1, k + 1)];
        mesh.triangles.extend([[a, b, c], [b, d, c]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_have_the_triangles_that_their_names_say() {
        for (scene, triangles) in [(terrain(1024), 2_097_152), (terrain(71), 10_082), (hairball(12_000), 2_880_000)] {
            assert_eq!(scene.mesh.triangles.len(), triangles);
            let vertices = scene.mesh.vertices.len() as u32;
            assert!(scene.mesh.triangles.iter().flatten().all(|&vertex| vertex < vertices));
            assert!(scene.mesh.vertices.iter().all(|vertex| vertex.is_finite()));
        }
    }
}
