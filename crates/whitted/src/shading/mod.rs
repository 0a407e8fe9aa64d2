//! What a surface does with light at one point; knows no scene.

mod material;

pub use material::{Material, Reflectance, SpecularModel, Texture};
