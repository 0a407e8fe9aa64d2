//! What the user said, as plain data, and what the renderer needs, prepared from it.
//!
//! [`Scene`] has no invariants beyond its types: readers fill it, people edit it. [`Prepared`] is checked and immutable:
//! geometry with its tree, and the [`Look`] (materials, lights, camera), so that a changed colour rebuilds nothing.

mod auto;
mod camera;
mod check;
mod description;
pub mod generate;
mod geometry;
mod light;
mod look;
mod prepared;
mod settings;
mod space;

pub use auto::clay;
pub use camera::{Camera, CameraRays};
pub use check::SceneError;
pub use description::{Background, Light, LightKind, Mesh, NamedCamera, NamedMaterial, Scene};
pub use geometry::Geometry;
pub use look::Look;
pub(crate) use look::ShadowOrigin;
pub use prepared::Prepared;
pub use settings::{Antialias, Sampling, Settings, Shadows, Tone};
pub use space::Space;
