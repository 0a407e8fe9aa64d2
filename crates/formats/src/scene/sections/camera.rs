//! `[camera]` and `[camera.NAME]`.

use serde::Deserialize;
use whitted::math::Vec3d;
use whitted::scene::Camera;

use super::{Key, Node, Value};
use crate::scene::values::{Angle, Direction, Point};

/// The name of a camera that the scene gives none.
const UNNAMED: &str = "default";

/// A pinhole camera in a right-handed world.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(rename = "Camera"))]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct CameraSection {
    /// Where the camera is.
    eye: Point,
    /// The point in the middle of the picture.
    look_at: Point,
    /// The direction that is up in the picture. Default: [0, 1, 0].
    up: Option<Direction>,
    /// The vertical field of view in degrees. Default: 40.
    vfov: Option<Angle>,
}

impl CameraSection {
    pub(in crate::scene) fn camera(&self) -> Camera {
        let default = Camera::default();
        Camera {
            eye: self.eye.0,
            look_at: self.look_at.0,
            up: self.up.map_or(Vec3d::new(0.0, 1.0, 0.0), |up| up.0),
            vfov: self.vfov.map_or(default.vfov, |angle| angle.0),
        }
    }
}

/// Give a camera without a name one, so that `camera` is always a table of names: a single camera is known by keys whose
/// values are no tables.
pub(in crate::scene) fn name_cameras(document: &mut Node<'_>) {
    let Value::Table(sections) = &mut document.value else { return };
    let Some((key, camera)) = sections.iter_mut().find(|(key, _)| key.name == "camera") else { return };
    if is_single_camera(camera) {
        let name = Key { span: key.span.clone(), name: UNNAMED.into() };
        let single = std::mem::replace(&mut camera.value, Value::Null);
        let single = Node { span: camera.span.clone(), value: single };
        camera.value = Value::Table(vec![(name, single)]);
    }
}

/// Whether the value of `camera` is a single camera without a name.
pub(in crate::scene) fn is_single_camera(camera: &Node<'_>) -> bool {
    let Value::Table(entries) = &camera.value else { return false };
    entries.is_empty() || !entries.iter().all(|(_, node)| matches!(node.value, Value::Table(_)))
}

/// One camera or a table of them.
#[cfg(feature = "schema")]
pub(super) fn schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
    let one = generator.subschema_for::<CameraSection>();
    schemars::json_schema!({ "anyOf": [one, { "type": "object", "additionalProperties": one }] })
}
