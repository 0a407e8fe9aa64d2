//! Scenes of spheres: the paper's random cube, and the sphereflake.

use super::{Mesh, Scene, View};
use std::f64::consts::PI;
use whitted::geometry::Sphere;
use whitted::math::{SplitMix64, Vec3d, Vec3f};

/// `count` spheres that do not overlap, of 0.7 to 1.3 times the radius with which they fill 12 % of the cube [−1, 1]³.
///
/// The numbers are drawn as for the scenes `mix-N` and `all4-N` of the comparison with other renderers, so that
/// spheres, camera and first light are theirs.
pub(super) fn cube(count: usize) -> Scene {
    const FILLED: f64 = 0.12;
    const CUBE_VOLUME: f64 = 8.0;
    let mean = (FILLED * CUBE_VOLUME * 3.0 / (4.0 * PI * count as f64)).cbrt();
    let mut rng = SplitMix64::new(count as u64);
    let mut grid = Grid::new(1.3 * mean);
    let mut spheres = Vec::with_capacity(count);
    while spheres.len() < count {
        let radius = mean * (0.7 + 0.6 * rng.next_f64());
        let coordinate = |rng: &mut SplitMix64| (-1.0 + radius) + (2.0 - 2.0 * radius) * rng.next_f64();
        let center = Vec3d::new(coordinate(&mut rng), coordinate(&mut rng), coordinate(&mut rng));
        // The material, which rays do not ask for.
        rng.next_f64();
        if grid.place(center, radius) {
            spheres.push(Sphere { center: center.to_f32(), radius: radius as f32 });
        }
    }
    Scene { name: String::new(), mesh: Mesh::default(), spheres, view: VIEW }
}

/// The view of the comparison with other renderers.
const VIEW: View = View {
    eye: Vec3f::new(2.2, 1.5, 3.4),
    at: Vec3f::ZERO,
    up: Vec3f::new(0.0, 1.0, 0.0),
    fov: 36.0,
    light: Vec3f::new(12.0, 14.0, 10.0),
    bounds: None,
};

/// Spheres by the cell of a grid that their centre lies in; touching ones lie in neighbouring cells.
struct Grid {
    cells: Vec<Vec<(Vec3d, f64)>>,
    side: usize,
    cell_size: f64,
}

impl Grid {
    fn new(max_radius: f64) -> Self {
        let side = ((2.0 / (2.0 * max_radius)) as usize).max(1);
        Self { cells: vec![Vec::new(); side.pow(3)], side, cell_size: 2.0 / side as f64 }
    }

    /// Add the sphere unless it touches another.
    fn place(&mut self, center: Vec3d, radius: f64) -> bool {
        const APART: f64 = 1.0002;
        let cell = center.map(|c| (((c + 1.0) / self.cell_size) as usize).min(self.side - 1));
        let span = |c: usize| c.saturating_sub(1)..(c + 2).min(self.side);
        for (x, y, z) in span(cell.x).flat_map(|x| span(cell.y).flat_map(move |y| span(cell.z).map(move |z| (x, y, z))))
        {
            let touches =
                |&(other, r): &(Vec3d, f64)| (other - center).length_squared() < (r + radius) * (r + radius) * APART;
            if self.cells[self.index(x, y, z)].iter().any(touches) {
                return false;
            }
        }
        let index = self.index(cell.x, cell.y, cell.z);
        self.cells[index].push((center, radius));
        true
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        (x * self.side + y) * self.side + z
    }
}

/// Haines' sphereflake of `levels` levels below the first sphere, (9^(levels+1) − 1) / 8 spheres, over a floor.
pub(super) fn flake(levels: u32) -> Scene {
    let mut spheres = Vec::new();
    grow(&mut spheres, Vec3d::ZERO, 0.5, Vec3d::new(0.0, 0.0, 1.0), levels);
    let corner = |x, y| Vec3f::new(x, y, -0.5);
    let vertices = vec![corner(-6.0, -6.0), corner(6.0, -6.0), corner(6.0, 6.0), corner(-6.0, 6.0)];
    let mesh = Mesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] };
    let view = View {
        eye: Vec3f::new(2.1, 1.3, 1.7),
        at: Vec3f::ZERO,
        up: Vec3f::new(0.0, 0.0, 1.0),
        fov: 45.0,
        light: Vec3f::new(4.0, 3.0, 2.0),
        bounds: None,
    };
    Scene { name: String::new(), mesh, spheres, view }
}

/// A sphere with nine of a third its size around the pole `up`: six along the equator, three above.
fn grow(spheres: &mut Vec<Sphere>, center: Vec3d, radius: f64, up: Vec3d, levels: u32) {
    spheres.push(Sphere { center: center.to_f32(), radius: radius as f32 });
    if levels == 0 {
        return;
    }
    let other = if up.x.abs() < 0.5 { Vec3d::new(1.0, 0.0, 0.0) } else { Vec3d::new(0.0, 1.0, 0.0) };
    let east = up.cross(other).normalize();
    let north = up.cross(east);
    let equator = (0..6).map(|k| (f64::from(k) * PI / 3.0, 0.0));
    let above = (0..3).map(|k| (f64::from(k) * PI / 1.5 + PI / 6.0, PI / 3.0));
    for (turn, height) in equator.chain(above) {
        let away = (east * turn.cos() + north * turn.sin()) * f64::cos(height) + up * f64::sin(height);
        grow(spheres, center + away * (radius * 4.0 / 3.0), radius / 3.0, away, levels - 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_of_the_cube_stay_inside_and_apart() {
        let spheres = cube(300).spheres;
        for (i, a) in spheres.iter().enumerate() {
            assert!(a.center.abs().max_component() + a.radius <= 1.0001);
            assert!(spheres[..i].iter().all(|b| (a.center - b.center).length() > a.radius + b.radius));
        }
    }

    #[test]
    fn a_flake_has_nine_children_each() {
        assert_eq!(flake(3).spheres.len(), 820);
    }
}
