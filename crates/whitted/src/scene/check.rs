//! What a scene and its settings must fulfil before anything is made of them.

use super::{Antialias, Background, NamedCamera, Scene, Settings};
use crate::geometry::MeshError;
use crate::math::Vec3f;

/// Why a scene cannot be rendered.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SceneError {
    /// There is no camera.
    #[error("the scene has no camera")]
    NoCamera,
    /// A camera that sees nothing or everything.
    #[error("camera '{camera}': {fault}")]
    Camera {
        /// Its name.
        camera: String,
        /// What is wrong.
        fault: &'static str,
    },
    /// A light that cannot shine.
    #[error("light {light} (counted from 1): {fault}")]
    Light {
        /// Its number, from 1.
        light: usize,
        /// What is wrong.
        fault: &'static str,
    },
    /// A material with an impossible value.
    #[error("material '{material}': {fault}")]
    Material {
        /// Its name.
        material: String,
        /// What is wrong.
        fault: &'static str,
    },
    /// An object refers to a material that is not there.
    #[error("an object refers to material {index}, but there are {materials} (numbers begin with 0)")]
    MaterialIndex {
        /// The number.
        index: u32,
        /// Number of materials.
        materials: usize,
    },
    /// Ambient light or background is not finite.
    #[error("{0} is not a finite colour")]
    Color(&'static str),
    /// A mesh is inconsistent.
    #[error("mesh '{mesh}': {error}")]
    Mesh {
        /// Its name.
        mesh: String,
        /// What is wrong.
        error: MeshError,
    },
    /// More primitives than can be numbered.
    #[error("{0} primitives, at most 2147483647 are possible")]
    TooManyPrimitives(usize),
    /// A new look for other shapes.
    #[error("a look for {found} primitives cannot be given to {expected}")]
    OtherShapes {
        /// Primitives of the prepared scene.
        expected: usize,
        /// Primitives of the new one.
        found: usize,
    },
    /// A setting out of range.
    #[error("{0}")]
    Setting(&'static str),
}

/// Pictures may have this many pixels: two gigabytes in memory while they are made.
const MAX_PIXELS: u64 = 1 << 26;

/// The most samples of a pixel, and the deepest generation.
const MAX_SAMPLES: u32 = 1 << 16;
const MAX_DEPTH: u32 = 1 << 10;

impl Settings {
    /// Whether a picture can be made with these settings.
    ///
    /// # Errors
    /// [`SceneError::Setting`] for an empty picture or more than 2²⁶ pixels, a depth above 1024, more than 65536
    /// samples, and for numbers that are not finite or negative where that means nothing.
    pub fn check(&self) -> Result<(), SceneError> {
        let [width, height] = self.size;
        let samples = match self.antialias {
            Antialias::Uniform(samples) => samples,
            _ => self.antialias_max,
        };
        let faults = [
            (width == 0 || height == 0, "the picture has no pixels"),
            (u64::from(width) * u64::from(height) > MAX_PIXELS, "the picture has more than 67108864 pixels"),
            (self.depth > MAX_DEPTH, "depth is above 1024"),
            (samples == 0, "a pixel needs at least one sample"),
            (samples > MAX_SAMPLES, "more than 65536 samples in a pixel"),
            (!(self.min_weight >= 0.0 && self.min_weight.is_finite()), "the minimal weight must be finite and ≥ 0"),
            (!self.exposure.is_finite(), "exposure is not finite"),
        ];
        first_fault(&faults).map_or(Ok(()), |fault| Err(SceneError::Setting(fault)))
    }
}

/// Everything that can be said without looking at the shapes.
pub(super) fn scene(scene: &Scene) -> Result<(), SceneError> {
    scene.settings.check()?;
    camera(scene.cameras.first().ok_or(SceneError::NoCamera)?)?;
    for (index, light) in scene.lights.iter().enumerate() {
        if let Some(fault) = light.fault() {
            return Err(SceneError::Light { light: index + 1, fault });
        }
    }
    for named in &scene.materials {
        if let Some(fault) = named.material.fault() {
            return Err(SceneError::Material { material: named.name.clone(), fault });
        }
    }
    colors(scene)
}

/// A camera must see something and not everything.
pub(super) fn camera(camera: &NamedCamera) -> Result<(), SceneError> {
    match camera.camera.fault() {
        Some(fault) => Err(SceneError::Camera { camera: camera.name.clone(), fault }),
        None => Ok(()),
    }
}

/// Every material number that is used must exist.
pub(super) fn material_indices(used: &[u32], materials: usize) -> Result<(), SceneError> {
    match used.iter().find(|&&index| index as usize >= materials) {
        Some(&index) => Err(SceneError::MaterialIndex { index, materials }),
        None => Ok(()),
    }
}

fn colors(scene: &Scene) -> Result<(), SceneError> {
    let background = match scene.background {
        Background::Color(color) => [color, color],
        Background::Gradient { down, up } => [down, up],
    };
    if !background.into_iter().all(Vec3f::is_finite) {
        return Err(SceneError::Color("the background"));
    }
    if !scene.ambient.is_finite() {
        return Err(SceneError::Color("the ambient light"));
    }
    Ok(())
}

fn first_fault(faults: &[(bool, &'static str)]) -> Option<&'static str> {
    faults.iter().find(|fault| fault.0).map(|fault| fault.1)
}
