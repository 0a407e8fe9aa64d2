//! Normals for meshes whose files have none: smooth, but for creases.

use whitted::math::{Vec3, Vec3d, Vec3f, sin_cos_degrees};
use whitted::scene::Mesh;

/// Neighbouring faces whose normals differ by more than this many degrees meet in a crease.
const CREASE: f64 = 40.0;

/// Faces around one vertex beyond which creases are not looked for: the work grows with the square of their number.
const MOST_FACES: usize = 256;

/// Give `mesh` normals: each corner of a triangle gets the mean, by area, of the faces around its vertex that meet it
/// without a [`CREASE`]. A vertex in a crease becomes several in the same place; triangles keep their order.
pub(crate) fn smooth(mesh: &mut Mesh) {
    let faces = Faces::new(mesh);
    let corners = Corners::new(mesh);
    mesh.normals = vec![[0.0; 3]; mesh.positions.len()];
    let mut around = Vec::new();
    for vertex in 0..mesh.positions.len() {
        faces.normals(corners.of(vertex), &mut around);
        split(mesh, vertex, &around);
    }
}

/// Give `vertex` the first of the normals of its corners, and the corners with other normals vertices of their own.
fn split(mesh: &mut Mesh, vertex: usize, around: &[(u32, Vec3f)]) {
    let Some(&(_, first)) = around.first() else {
        mesh.normals[vertex] = [0.0, 0.0, 1.0];
        return;
    };
    mesh.normals[vertex] = first.to_array();
    let new_from = mesh.positions.len();
    for &(corner, normal) in around.iter().filter(|(_, normal)| *normal != first) {
        let known = mesh.normals[new_from..].iter().position(|n| *n == normal.to_array());
        let number = new_from + known.unwrap_or(mesh.positions.len() - new_from);
        // Beyond what a number holds, creases are smoothed over.
        let Ok(name) = u32::try_from(number) else { return };
        if known.is_none() {
            mesh.positions.push(mesh.positions[vertex]);
            mesh.normals.push(normal.to_array());
            if !mesh.uvs.is_empty() {
                mesh.uvs.push(mesh.uvs[vertex]);
            }
        }
        mesh.triangles[corner as usize / 3][corner as usize % 3] = name;
    }
}

/// The faces of a mesh.
struct Faces {
    /// Unit normals; zero for a face without area.
    units: Vec<Vec3f>,
    /// Normals as long as twice the area, all scaled alike.
    areas: Vec<Vec3f>,
    /// Cosine of [`CREASE`], and of half of it.
    crease: f32,
    half_crease: f32,
}

impl Faces {
    fn new(mesh: &Mesh) -> Self {
        let point = |v: u32| Vec3::from(mesh.positions[v as usize]).to_f64();
        let normal = |&[a, b, c]: &[u32; 3]| (point(b) - point(a)).cross(point(c) - point(a));
        let normals: Vec<Vec3d> = mesh.triangles.iter().map(normal).collect();
        let largest = normals.iter().map(|n| n.abs().max_component()).fold(0.0, f64::max);
        let unit = |n: &Vec3d| Some(n.direction().to_f32()).filter(|n| n.is_finite());
        Self {
            units: normals.iter().map(|n| unit(n).unwrap_or(Vec3f::ZERO)).collect(),
            areas: normals.iter().map(|n| (*n / largest).to_f32()).collect(),
            crease: sin_cos_degrees(CREASE).1 as f32,
            half_crease: sin_cos_degrees(0.5 * CREASE).1 as f32,
        }
    }

    /// The normals of all `corners` of a vertex, with their corners.
    fn normals(&self, corners: &[u32], normals: &mut Vec<(u32, Vec3f)>) {
        normals.clear();
        let Some(&first) = corners.first() else { return };
        let unit = self.units[first as usize / 3];
        // All near one are near each other: the case of most vertices.
        if corners.iter().all(|&corner| unit.dot(self.units[corner as usize / 3]) > self.half_crease) {
            let normal = self.normal(first, corners);
            normals.extend(corners.iter().map(|&corner| (corner, normal)));
        } else {
            normals.extend(corners.iter().map(|&corner| (corner, self.normal(corner, corners))));
        }
    }

    /// The normal of a corner among all corners `around` its vertex.
    fn normal(&self, corner: u32, around: &[u32]) -> Vec3f {
        let unit = self.units[corner as usize / 3];
        let meets = |face: usize| around.len() > MOST_FACES || unit.dot(self.units[face]) >= self.crease;
        let faces = around.iter().map(|&other| other as usize / 3);
        let sum = faces.filter(|&face| meets(face)).fold(Vec3f::ZERO, |sum, face| sum + self.areas[face]);
        let normal = sum.to_f64().direction().to_f32();
        match () {
            () if normal.is_finite() => normal,
            // The areas cancel or are too small beside the largest.
            () if unit != Vec3f::ZERO => unit,
            () => Vec3f::new(0.0, 0.0, 1.0),
        }
    }
}

/// The corners of triangles by the vertex they lie at: corner 3t + k is corner k of triangle t.
struct Corners {
    /// Where the corners of each vertex begin in `list`; one more for the end.
    starts: Vec<u32>,
    list: Vec<u32>,
}

impl Corners {
    fn new(mesh: &Mesh) -> Self {
        let vertices = || mesh.triangles.iter().flatten().map(|&v| v as usize);
        let mut starts = vec![0; mesh.positions.len() + 1];
        vertices().for_each(|v| starts[v + 1] += 1);
        for vertex in 0..mesh.positions.len() {
            starts[vertex + 1] += starts[vertex];
        }
        let mut next = starts.clone();
        let mut list = vec![0; 3 * mesh.triangles.len()];
        for (corner, vertex) in vertices().enumerate() {
            list[next[vertex] as usize] = corner as u32;
            next[vertex] += 1;
        }
        Self { starts, list }
    }

    fn of(&self, vertex: usize) -> &[u32] {
        &self.list[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of two triangles a side, or a ball with as many as `n` squared, twice.
    fn grid(n: u32, place: impl Fn(f64, f64) -> [f32; 3]) -> Mesh {
        let share = |i: u32| f64::from(i) / f64::from(n);
        let positions = (0..=n).flat_map(|y| (0..=n).map(move |x| (x, y))).map(|(x, y)| place(share(x), share(y)));
        let square = |x: u32, y: u32| {
            let at = y * (n + 1) + x;
            [[at, at + 1, at + n + 2], [at, at + n + 2, at + n + 1]]
        };
        let triangles = (0..n).flat_map(|y| (0..n).flat_map(move |x| square(x, y)));
        Mesh { positions: positions.collect(), triangles: triangles.collect(), ..Mesh::default() }
    }

    #[test]
    fn gentle_bends_are_smoothed() {
        let bowl =
            |x: f64, y: f64| [x as f32, y as f32, (0.5 * ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5))) as f32];
        let flat = grid(16, bowl);
        let mut smoothed = flat.clone();
        smooth(&mut smoothed);
        assert_eq!((&smoothed.positions, &smoothed.triangles), (&flat.positions, &flat.triangles));
        for (position, normal) in smoothed.positions.iter().zip(&smoothed.normals) {
            let exact = Vec3f::new(0.5 - position[0], 0.5 - position[1], 1.0).normalize();
            assert!(exact.dot((*normal).into()) > 0.998, "{position:?} {normal:?} {exact:?}");
        }
    }

    #[test]
    fn creases_stay_sharp() {
        // A roof of 90 degrees over y.
        let roof = |x: f64, y: f64| [x as f32, y as f32, -(x - 0.5).abs() as f32];
        let mut mesh = grid(2, roof);
        let before: Vec<[[f32; 3]; 3]> = mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])).collect();
        smooth(&mut mesh);
        let after: Vec<[[f32; 3]; 3]> = mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])).collect();
        assert_eq!(before, after, "triangles stay where they are");
        assert_eq!(mesh.positions.len(), 9 + 3, "the three vertices of the ridge are doubled");
        let slope = 0.5_f32.sqrt();
        for n in mesh.normals {
            assert!((n[0].abs() - slope).abs() < 1e-6 && n[1].abs() < 1e-6 && (n[2] - slope).abs() < 1e-6, "{n:?}");
        }
    }

    #[test]
    fn faces_without_area_are_harmless() {
        let mut mesh = Mesh {
            positions: vec![[0.0; 3], [1e-30, 0.0, 0.0], [0.0, 1e-30, 0.0], [0.0; 3]],
            triangles: vec![[0, 0, 0], [0, 1, 1], [0, 1, 2], [3, 3, 3]],
            ..Mesh::default()
        };
        smooth(&mut mesh);
        assert!(mesh.normals.iter().all(|n| (Vec3f::from(*n).length() - 1.0).abs() < 1e-6), "{:?}", mesh.normals);
    }
}
