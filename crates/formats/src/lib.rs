//! Scene, mesh and image files, read into the types of [`whitted`] and written from them.
//!
//! # What this crate knows
//! | extension | what | read by |
//! | --- | --- | --- |
//! | `.toml` | scene (the native format, `docs/scene-format.md`) | [`load`] |
//! | `.json` | scene (the same in JSON) | [`load`] |
//! | `.nff` | scene (Haines' Neutral File Format) | [`load`] |
//! | `.obj` | mesh with materials (Wavefront OBJ and MTL) | [`load`] |
//! | `.ply` | mesh | [`load`] |
//! | `.png` | picture | [`png::encode`] (writes only) |
//! | `.exr` | picture with linear colours (OpenEXR) | [`exr::encode`] (writes only) |
//! | `.csv`, `.npy`, `.f32`, `.f32x8` | rays and hits | [`rays::RayReader`], [`rays::HitFormat`] |
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
pub mod exr;
mod files;
mod mesh;
mod nff;
mod obj;
mod ply;
pub mod png;
mod polygon;
pub mod rays;
mod reload;
mod scene;
mod smooth;
mod source;
mod suggest;
mod text;

use std::path::{Path, PathBuf};

use whitted::scene::Scene;

pub use error::{Error, ErrorKind, Excerpt, Place, Report, Warning};
pub use files::LoadOptions;
pub use reload::Loader;
pub use scene::{camera_block, write_back};

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
    /// All files that the scene is made of, itself first: whoever shows it watches these.
    pub files: Vec<PathBuf>,
}

/// A file format that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A scene in the native format.
    Toml,
    /// A scene in the native format, written in JSON.
    Json,
    /// A scene of Haines' Neutral File Format.
    Nff,
    /// A mesh of Wavefront's object format.
    Obj,
    /// A mesh of Stanford's polygon file format.
    Ply,
}

impl Format {
    /// All formats with their extensions.
    pub const ALL: [(&'static str, Self); 5] =
        [("toml", Self::Toml), ("json", Self::Json), ("nff", Self::Nff), ("obj", Self::Obj), ("ply", Self::Ply)];

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

    /// True if files of the format hold a mesh and nothing else.
    pub fn is_mesh(self) -> bool {
        matches!(self, Self::Obj | Self::Ply)
    }
}

/// Load the scene or mesh in the file `path`; its extension tells the format. A scene without a camera gets what it lacks
/// to be seen: [`Scene::furnish`]; a bare mesh without normals is shaded smoothly, but for its creases. Neither if
/// [`LoadOptions::furnish`] is unset.
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
    let mut scene = match format {
        Format::Toml => scene::read_toml(Source { file, bytes: &source::decode(file, bytes)? }, &mut context)?,
        Format::Json => scene::read_json(Source { file, bytes: &source::decode(file, bytes)? }, &mut context)?,
        Format::Nff => {
            let source = Source { file, bytes: &source::decode(file, bytes)? };
            let options = context.options;
            nff::read(source, options, &mut |w| context.warn(w))?
        }
        Format::Obj | Format::Ply => {
            let MeshFile { mut mesh, materials } = read_mesh(format, file, bytes, &mut context)?;
            mesh.name = file.to_string_lossy().into_owned();
            if context.options.furnish && mesh.normals.is_empty() {
                smooth::smooth(&mut mesh);
            }
            Scene { meshes: vec![mesh], materials, ..Scene::default() }
        }
    };
    if context.options.furnish && scene.cameras.is_empty() {
        scene.furnish();
    }
    Ok(Loaded { scene, warnings: context.take_warnings(file), files: context.files })
}

/// Read a file of a [mesh format](Format::is_mesh).
fn read_mesh(format: Format, file: &Path, bytes: Vec<u8>, context: &mut Context<'_>) -> Result<MeshFile, Error> {
    let mesh = match format {
        Format::Ply => {
            let mesh = ply::read(Source { file, bytes: &bytes }, &mut |w| context.warn(w))?;
            MeshFile { mesh, materials: Vec::new() }
        }
        _ => obj::read(Source { file, bytes: &source::decode(file, bytes)? }, context)?,
    };
    if mesh.mesh.triangles.is_empty() {
        let what = "there is nothing to draw: the mesh has no triangles";
        context.warn(Error::new(ErrorKind::Input, file, what).into_warning());
    }
    Ok(mesh)
}

/// The JSON Schema of the native format, as `docs/scene.schema.json` holds it.
#[cfg(feature = "schema")]
pub fn scene_schema() -> String {
    format!("{:#}\n", scene::schema())
}
