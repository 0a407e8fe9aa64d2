//! Scene, mesh and image files, read into the types of [`whitted`] and written from them.
//!
//! # What this crate knows
//! | extension | what | read by |
//! | --- | --- | --- |
//! | `.nff` | scene (Haines' Neutral File Format) | [`load`] |
//! | `.obj` | mesh with materials (Wavefront OBJ and MTL) | [`load`] |
//! | `.ply` | mesh | [`load`] |
//! | `.png` | picture | [`png::encode`] (writes only) |
//!
//! # Invariants
//! * Every file is untrusted: whatever its bytes, the answer is a scene or an [`Error`], in time and memory bounded by
//!   its length (a count is checked against the bytes that are left before anything is allocated for it).
//! * A file named by a scene is opened only if it lies in the scene's folder ([`LoadOptions::allow_outside`]).
//! * No `unsafe`; nothing is printed; no rendering.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), deny(clippy::disallowed_methods, clippy::print_stdout, clippy::print_stderr))]

mod check;
mod error;
mod files;
mod mesh;
mod nff;
mod obj;
mod ply;
pub mod png;
mod polygon;
mod source;
mod suggest;
mod text;

use std::path::{Path, PathBuf};

use whitted::scene::{NamedMaterial, Scene};
use whitted::shading::Material;

pub use error::{Error, ErrorKind, Excerpt, Place, Report, Warning};
pub use files::LoadOptions;

use files::Context;
use mesh::MeshFile;
use source::Source;

/// A scene and what came with it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// What was odd, but did not stop the loading.
    pub warnings: Vec<Warning>,
    /// All files that were read, the scene first.
    pub files: Vec<PathBuf>,
}

/// A file format that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A scene of Haines' Neutral File Format.
    Nff,
    /// A mesh of Wavefront's object format.
    Obj,
    /// A mesh of Stanford's polygon file format.
    Ply,
}

impl Format {
    /// All formats with their extensions.
    pub const ALL: [(&'static str, Self); 3] = [("nff", Self::Nff), ("obj", Self::Obj), ("ply", Self::Ply)];

    /// The format of the file `path` by its extension, in any case of letters.
    pub fn of(path: &Path) -> Result<Self, Error> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let found = Self::ALL.iter().find(|(known, _)| *known == extension);
        found.map(|(_, format)| *format).ok_or_else(|| {
            let known = Self::ALL.map(|(known, _)| format!(".{known}")).join(", ");
            let what = match extension.as_str() {
                "" => "the file has no extension that tells its format".to_owned(),
                other => format!("the format {} is not supported", error::quoted(format!(".{other}"))),
            };
            Error::new(ErrorKind::Unsupported, path, what).hint(format!("known here: {known}"))
        })
    }
}

/// Load the scene or mesh in the file `path`; its extension tells the format.
///
/// # Errors
/// If the file cannot be read, is wrong, uses what is not supported, or exceeds a limit of `options`.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, Error> {
    let format = Format::of(path)?;
    let mut context = Context::closed(options);
    let bytes = context.read_first(path)?;
    read(format, path, bytes, context)
}

/// Read a scene or mesh from memory. `name` stands for the file in messages. Other files that the scene names are not
/// opened.
///
/// # Errors
/// As [`load`].
pub fn parse(format: Format, name: &Path, bytes: Vec<u8>, options: &LoadOptions) -> Result<Loaded, Error> {
    read(format, name, bytes, Context::closed(options))
}

fn read(format: Format, file: &Path, bytes: Vec<u8>, mut context: Context<'_>) -> Result<Loaded, Error> {
    // Only PLY may be binary.
    let bytes = if format == Format::Ply { bytes } else { source::decode(file, bytes)? };
    let options = context.options;
    let source = Source { file, bytes: &bytes };
    let scene = match format {
        Format::Nff => nff::read(source, options, &mut |w| context.warn(w))?,
        Format::Obj => bare_mesh(obj::read(source, &mut context)?, source, &mut context),
        Format::Ply => {
            let mesh = ply::read(source, &mut |w| context.warn(w))?;
            bare_mesh(MeshFile { mesh, materials: Vec::new() }, source, &mut context)
        }
    };
    Ok(Loaded { scene, warnings: context.take_warnings(file), files: context.files })
}

/// A scene that holds nothing but a mesh.
fn bare_mesh(file: MeshFile, source: Source<'_>, context: &mut Context<'_>) -> Scene {
    let MeshFile { mut mesh, mut materials } = file;
    mesh.name = source.file.to_string_lossy().into_owned();
    if mesh.triangles.is_empty() {
        context.warn(source.error_whole("there is nothing to draw: the mesh has no triangles").into_warning());
    }
    if materials.is_empty() {
        materials.push(NamedMaterial { name: "default".to_owned(), material: Material::default() });
    }
    Scene { meshes: vec![mesh], materials, ..Scene::default() }
}
