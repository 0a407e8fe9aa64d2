//! What differs between two scenes, so that no more is made anew than must be.

use super::{Mesh, Scene};

/// What differs between two scenes, by what must be made anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Change {
    /// Nothing.
    Nothing,
    /// Materials and whose they are, lights, cameras, ambient light, background, settings, names: the tree stays.
    Look,
    /// Shapes, their places or their order.
    Geometry,
}

/// What differs between `old` and `new`. Coordinates that are not numbers differ from themselves.
///
/// Compares every coordinate, in one pass over what both hold: nothing beside building a tree.
pub fn difference(old: &Scene, new: &Scene) -> Change {
    match (same_geometry(old, new), same_look(old, new)) {
        (false, _) => Change::Geometry,
        (true, false) => Change::Look,
        (true, true) => Change::Nothing,
    }
}

fn same_geometry(old: &Scene, new: &Scene) -> bool {
    let spheres = same(&old.spheres, &new.spheres, |a, b| (a.0, a.1) == (b.0, b.1));
    let shapes = same(&old.shapes, &new.shapes, |a, b| a.0 == b.0);
    let planes = same(&old.planes, &new.planes, |a, b| a.0 == b.0);
    spheres && shapes && planes && same(&old.meshes, &new.meshes, same_triangles)
}

fn same_triangles(old: &Mesh, new: &Mesh) -> bool {
    let place = (old.origin, old.transform) == (new.origin, new.transform);
    let vertices = place && old.positions == new.positions && old.normals == new.normals && old.uvs == new.uvs;
    vertices && old.triangles == new.triangles
}

/// Everything but [`same_geometry`], which is known to hold.
fn same_look(old: &Scene, new: &Scene) -> bool {
    let lights = old.lights == new.lights && old.ambient == new.ambient && old.background == new.background;
    let seen = old.cameras == new.cameras && old.settings == new.settings;
    lights && seen && old.materials == new.materials && same_owners(old, new)
}

/// Whether everything has the same material by number, and the same name.
fn same_owners(old: &Scene, new: &Scene) -> bool {
    let same_mesh = |a: &Mesh, b: &Mesh| {
        (&a.name, a.material) == (&b.name, b.material) && a.triangle_materials == b.triangle_materials
    };
    same(&old.spheres, &new.spheres, |a, b| a.2 == b.2)
        && same(&old.shapes, &new.shapes, |a, b| a.1 == b.1)
        && same(&old.planes, &new.planes, |a, b| a.1 == b.1)
        && same(&old.meshes, &new.meshes, same_mesh)
}

fn same<T>(old: &[T], new: &[T], alike: impl Fn(&T, &T) -> bool) -> bool {
    old.len() == new.len() && old.iter().zip(new).all(|(a, b)| alike(a, b))
}
