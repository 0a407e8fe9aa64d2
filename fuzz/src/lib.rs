//! What all targets do: read a file from memory, and look at what came of it.

#![forbid(unsafe_code)]

use std::path::Path;

use formats::rays::{RayFormat, RayReader};
use formats::{Format, LoadOptions};
use whitted::ray::RayBatch;

/// Read `bytes`. A panic, a second or 512 MiB is a finding; so is a scene that breaks a promise of its types.
pub fn read(format: Format, bytes: &[u8]) {
    // Generators may be asked for millions of spheres, which is no fault of the reader.
    let options = LoadOptions { max_generated: 1000, ..LoadOptions::default() };
    match formats::parse(format, Path::new("fuzz"), bytes.to_vec(), &options) {
        Ok(loaded) => {
            for mesh in &loaded.scene.meshes {
                let vertices = mesh.positions.len();
                assert!(mesh.triangles.iter().flatten().all(|&v| (v as usize) < vertices));
                assert!([0, vertices].contains(&mesh.normals.len()) && [0, vertices].contains(&mesh.uvs.len()));
                assert!([0, mesh.triangles.len()].contains(&mesh.triangle_materials.len()));
                assert!(mesh.positions.iter().flatten().all(|a| a.is_finite()));
            }
            loaded.warnings.iter().for_each(|warning| assert!(!warning.to_string().is_empty()));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// Read a table of rays in the format that the first byte chooses, a few at a time: every answer but a panic or a hang
/// will do.
pub fn read_rays(bytes: &[u8]) {
    let Some((&choice, rest)) = bytes.split_first() else { return };
    let (_, format) = RayFormat::ALL[usize::from(choice) % RayFormat::ALL.len()];
    let Ok(mut reader) = RayReader::new(format, Path::new("rays"), rest) else { return };
    let mut rays = RayBatch::new();
    while reader.read(&mut rays, 7).is_ok() && !rays.is_empty() {}
}
