//! What the user said, as plain data, and what the renderer needs, prepared from it.
//!
//! [`Scene`] has no invariants beyond its types: readers fill it, people edit it. [`Prepared`] is checked and immutable:
//! geometry with its tree, and the [`Look`] (materials, lights, camera), so that a changed colour rebuilds nothing.

mod auto;
mod camera;
mod change;
mod check;
mod description;
mod entered;
pub mod generate;
mod geometry;
mod light;
mod look;
mod prepared;
mod settings;
mod space;

pub use auto::clay;
pub use camera::{Camera, CameraRays};
pub use change::{Change, difference};
pub use check::SceneError;
pub use description::{Background, Light, LightKind, Mesh, NamedCamera, NamedMaterial, Scene};
pub use entered::EnteredBox;
pub use geometry::Geometry;
pub use look::Look;
pub(crate) use look::ShadowOrigin;
pub use prepared::Prepared;
pub use settings::{Antialias, Sampling, Settings, Shadows, Tone};
pub use space::Space;
