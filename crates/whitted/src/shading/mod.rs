//! What a surface does with light at one point; knows no scene.
//!
//! [`Material`] and [`Texture`] are what the user describes; `Prepared…` are the same in internal space, ready for
//! rendering. Everything per ray is written once, in [`lanes`], for any number of rays; the functions for one ray call
//! it with one lane and give the same bits.

mod light;
mod local;
mod material;
pub(crate) mod one;
mod optics;
mod prepared;
mod table;
mod texture;

pub use light::{Arriving, PreparedLight};
pub use local::{LocalModel, LocalSurface};
pub use material::{Material, Reflectance, SpecularModel, Texture};
pub use prepared::{PreparedMaterial, fresnel, mirrored, refracted, schlick};
pub(crate) use table::{Finish, MaterialTable, Scattering};
pub use texture::PreparedTexture;

/// The functions for many rays at once.
pub mod lanes {
    pub use super::local::answer;
    pub use super::optics::{fresnel, mirrored, refracted, schlick};
}
