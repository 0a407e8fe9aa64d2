//! `whitted check`: reads a scene as `render` would, and says what is in it.

use crate::args::CheckArguments;
use crate::exit::Failure;
use crate::load::load;
use whitted::scene::{Prepared, Scene};
use whitted::tree::BuildOptions;

pub(crate) fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let loaded = load(&arguments.scene, &arguments.verbosity)?;
    let prepared = Prepared::new(&loaded.scene, &BuildOptions::default());
    let prepared = prepared.map_err(|error| Failure::Scene(format!("{}: {error}", arguments.scene.scene.display())))?;
    if !arguments.verbosity.quiet {
        println!("{}: {}", arguments.scene.scene.display(), contents(&loaded.scene));
        if prepared.geometry().dropped() > 0 {
            println!("{} degenerate primitives can never be hit", prepared.geometry().dropped());
        }
    }
    Ok(())
}

/// What is in a scene, in words: `2 spheres, 1 light, 3 materials`.
pub(crate) fn contents(scene: &Scene) -> String {
    let triangles = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let counts = [
        (scene.spheres.len(), "sphere"),
        (triangles, "triangle"),
        (scene.shapes.len(), "shape"),
        (scene.planes.len(), "plane"),
        (scene.lights.len(), "light"),
        (scene.materials.len(), "material"),
        (scene.cameras.len(), "camera"),
    ];
    let words = counts.iter().filter(|(count, _)| *count > 0);
    let words = words.map(|(count, noun)| format!("{count} {noun}{}", if *count == 1 { "" } else { "s" }));
    words.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use whitted::math::Vec3d;

    #[test]
    fn contents_count_what_is_there() {
        let scene = Scene { spheres: vec![(Vec3d::ZERO, 1.0, 0); 2], cameras: Vec::new(), ..Scene::default() };
        assert_eq!(contents(&scene), "2 spheres");
    }
}
