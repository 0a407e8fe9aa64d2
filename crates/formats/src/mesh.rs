//! What the readers of meshes have in common: placing vertices in single precision, and repairing what cannot be drawn.

use whitted::math::{Vec3, Vec3d};
use whitted::scene::{Mesh, NamedMaterial};

/// A mesh as a file holds it.
#[derive(Debug, Default)]
pub(crate) struct MeshFile {
    pub(crate) mesh: Mesh,
    /// The file's own materials, to which the mesh's numbers refer; empty if it has none.
    pub(crate) materials: Vec<NamedMaterial>,
}

/// Double-precision points as a mesh keeps them: `origin + position` in single precision.
///
/// The origin is 0 unless the points lie far from it, measured by their own extent: near it the positions are the
/// file's numbers, rounded once.
pub(crate) fn place(points: &[Vec3d]) -> (Vec<[f32; 3]>, Vec3d) {
    /// Distance from 0 over extent from which the origin moves: six bits of every position would be lost.
    const FAR: f64 = 64.0;
    let finite = || points.iter().copied().filter(|p| p.is_finite());
    let lo = finite().fold(Vec3d::splat(f64::INFINITY), Vec3d::min);
    let hi = finite().fold(Vec3d::splat(f64::NEG_INFINITY), Vec3d::max);
    let distance = lo.abs().max(hi.abs()).max_component();
    let far = distance.is_finite() && distance > FAR * (hi - lo).max_component();
    let origin = if far { lo * 0.5 + hi * 0.5 } else { Vec3d::ZERO };
    (points.iter().map(|&p| (p - origin).to_f32().to_array()).collect(), origin)
}

/// Make `mesh` drawable: drop triangles with vertices that are not finite, and compute normals that are zero or not
/// finite from the faces around them. Gives a sentence about what was dropped.
pub(crate) fn repair(mesh: &mut Mesh) -> Option<String> {
    let dropped = drop_non_finite(mesh);
    for uv in mesh.uvs.iter_mut().filter(|uv| !uv.iter().all(|a| a.is_finite())) {
        *uv = [0.0; 2];
    }
    repair_normals(mesh);
    (dropped > 0).then(|| format!("{dropped} triangles have a vertex that is not finite and were left out"))
}

/// The number of triangles dropped because a vertex is not finite. Such vertices become copies of a finite one.
fn drop_non_finite(mesh: &mut Mesh) -> usize {
    let good: Vec<bool> = mesh.positions.iter().map(|p| p.iter().all(|a| a.is_finite())).collect();
    if good.iter().all(|&g| g) {
        return 0;
    }
    let keep: Vec<bool> = mesh.triangles.iter().map(|t| t.iter().all(|&v| good[v as usize])).collect();
    retain(&mut mesh.triangles, &keep);
    retain(&mut mesh.triangle_materials, &keep);
    let stand_in = good.iter().position(|&g| g).map_or([0.0; 3], |first| mesh.positions[first]);
    for (position, _) in mesh.positions.iter_mut().zip(&good).filter(|(_, good)| !**good) {
        *position = stand_in;
    }
    keep.iter().filter(|&&k| !k).count()
}

/// Keep the items of `items` whose number is marked; an empty list stays empty.
fn retain<T>(items: &mut Vec<T>, keep: &[bool]) {
    let mut number = 0;
    items.retain(|_| {
        number += 1;
        keep[number - 1]
    });
}

fn repair_normals(mesh: &mut Mesh) {
    let usable = |n: &[f32; 3]| n.iter().all(|a| a.is_finite()) && n.iter().any(|&a| a != 0.0);
    if mesh.normals.iter().all(usable) {
        return;
    }
    let computed = vertex_normals(mesh);
    for (normal, computed) in mesh.normals.iter_mut().zip(computed) {
        if !usable(normal) {
            *normal = computed;
        }
    }
}

/// Unit normals of the vertices: the mean of the faces around each, by area. (0, 0, 1) where there is no area.
fn vertex_normals(mesh: &Mesh) -> Vec<[f32; 3]> {
    let mut sums = vec![Vec3d::ZERO; mesh.positions.len()];
    let point = |v: u32| Vec3::from(mesh.positions[v as usize]).to_f64();
    for &[a, b, c] in &mesh.triangles {
        let normal = (point(b) - point(a)).cross(point(c) - point(a));
        for v in [a, b, c] {
            sums[v as usize] += normal;
        }
    }
    sums.into_iter().map(unit_or_z).collect()
}

fn unit_or_z(sum: Vec3d) -> [f32; 3] {
    // Scaled first: the squares of tiny or huge areas would leave the range of numbers.
    let largest = sum.abs().max_component();
    if largest > 0.0 && largest.is_finite() { (sum / largest).normalize().to_f32().to_array() } else { [0.0, 0.0, 1.0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_points_keep_their_numbers() {
        let (positions, origin) = place(&[Vec3d::new(0.1, 2.0, -3.0), Vec3d::ZERO]);
        assert_eq!((positions[0], origin), ([0.1, 2.0, -3.0], Vec3d::ZERO));
    }

    #[test]
    fn far_points_keep_their_differences() {
        let far = Vec3d::splat(1e6);
        let points = [far, far + Vec3d::new(0.001, 0.0, 0.0)];
        let (positions, origin) = place(&points);
        for (position, point) in positions.iter().zip(points) {
            let error = (origin + Vec3::from(*position).to_f64() - point).length();
            assert!(error < 1e-9, "{error}");
        }
    }

    #[test]
    fn broken_vertices_take_only_their_triangles_along() {
        let mut mesh = Mesh {
            positions: vec![[f32::NAN; 3], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2], [1, 2, 3]],
            triangle_materials: vec![7, 8],
            normals: vec![[0.0; 3]; 4],
            ..Mesh::default()
        };
        assert!(repair(&mut mesh).unwrap().starts_with("1 triangles"));
        assert_eq!((mesh.triangles, mesh.triangle_materials), (vec![[1, 2, 3]], vec![8]));
        assert!(mesh.positions.iter().flatten().all(|a| a.is_finite()));
        assert_eq!(mesh.normals[3], [0.0, 0.0, 1.0]);
    }
}
