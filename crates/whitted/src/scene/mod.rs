//! What the user said, as plain data, and what the renderer needs, prepared from it.
//!
//! [`Scene`] has no invariants beyond its types: readers fill it, people edit it. [`Prepared`] is checked and immutable:
//! geometry with its tree, and the [`Look`] (materials, lights, camera), so that a changed colour rebuilds nothing.

mod camera;
mod description;
pub mod generate;
mod light;
mod settings;

pub use camera::{Camera, CameraRays};
pub use description::{Background, Light, LightKind, Mesh, NamedCamera, NamedMaterial, Scene};
pub use settings::{Antialias, Sampling, Settings, Shadows, Tone};
