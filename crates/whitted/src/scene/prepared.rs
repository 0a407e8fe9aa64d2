//! A scene that has been checked and is ready to be rendered.

use super::{Change, Geometry, Look, NamedCamera, Scene, SceneError, difference};
use super::{check, look};
use crate::tree::{BuildOptions, Stop};
use std::sync::Arc;

/// A checked scene: geometry with its tree, and how it looks.
#[derive(Clone, Debug)]
pub struct Prepared {
    geometry: Arc<Geometry>,
    look: Look,
}

impl Prepared {
    /// Check `scene`, move it to internal space, build the tree.
    ///
    /// # Errors
    /// What [`SceneError`] lists.
    pub fn new(scene: &Scene, options: &BuildOptions) -> Result<Self, SceneError> {
        Self::new_until(scene, options, &|_| false).map(|prepared| prepared.expect("nothing stops it"))
    }

    /// As [`new`](Self::new), until `stop` says so: then there is none. `stop` is told how far the tree is.
    ///
    /// # Errors
    /// What [`SceneError`] lists.
    pub fn new_until(scene: &Scene, options: &BuildOptions, stop: Stop<'_>) -> Result<Option<Self>, SceneError> {
        check::scene(scene)?;
        let Some(geometry) = Geometry::new(scene, options, stop)? else { return Ok(None) };
        let look = Look::new(scene, &geometry, look::primitive_materials(scene))?;
        Ok(Some(Self { geometry: Arc::new(geometry), look }))
    }

    /// The prepared scene after the change from `old`, from which this one was prepared, to `new`, and what that was:
    /// as [`new`](Self::new), but the tree stays if the shapes are the same.
    ///
    /// # Errors
    /// What [`SceneError`] lists.
    pub fn after_change(&self, old: &Scene, new: &Scene, options: &BuildOptions) -> Result<(Self, Change), SceneError> {
        let change = difference(old, new);
        let prepared = match change {
            Change::Nothing => self.clone(),
            Change::Look => self.with_look_of(new)?,
            Change::Geometry => Self::new(new, options)?,
        };
        Ok((prepared, change))
    }

    /// The same shapes with the materials, lights, first camera, ambient light and background of `scene`, whose shapes
    /// must be those of the scene from which this one was prepared, or which has none: nothing is rebuilt.
    ///
    /// # Errors
    /// What [`SceneError`] lists; also if the number of primitives differs.
    pub fn with_look_of(&self, scene: &Scene) -> Result<Self, SceneError> {
        check::scene(scene)?;
        let (expected, found) = (self.geometry.primitives().len(), scene.primitive_count());
        if found != 0 && expected != found {
            return Err(SceneError::OtherShapes { expected, found });
        }
        let owners = match found {
            0 => Arc::clone(self.look.primitive_materials()),
            _ => look::primitive_materials(scene),
        };
        let look = Look::new(scene, &self.geometry, owners)?;
        Ok(Self { geometry: Arc::clone(&self.geometry), look })
    }

    /// The same scene seen by another camera, in world space: only materials and lights are copied.
    ///
    /// # Errors
    /// [`SceneError::Camera`] if it sees nothing or everything.
    pub fn with_camera(&self, camera: &NamedCamera) -> Result<Self, SceneError> {
        check::camera(camera)?;
        let look = self.look.with_camera(&camera.camera, self.geometry.space());
        Ok(Self { geometry: Arc::clone(&self.geometry), look })
    }

    /// The shapes and their tree.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// Materials, lights, camera, background.
    pub fn look(&self) -> &Look {
        &self.look
    }
}
