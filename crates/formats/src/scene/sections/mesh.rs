//! `[[mesh]]`.

use serde::Deserialize;
use whitted::math::{Affine, Vec3d, sin_cos_degrees};

use crate::scene::decode::At;
use crate::scene::loose::{FromLoose, Loose, read_loosely};
use crate::scene::values::{Direction, Point, Real, Scale};

/// A triangle mesh from a file. It is scaled first, then rotated, then moved, in whatever order the keys stand.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(rename = "Mesh"))]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct MeshSection {
    /// An OBJ or PLY file, relative to the folder of the scene and not outside it.
    pub(in crate::scene) file: At<String>,
    /// The name of a material for the whole mesh. Default: the materials of the file; "default" if it has none.
    pub(in crate::scene) material: Option<At<String>>,
    /// True: shade smoothly, with normals computed from the triangles if the file has none; edges sharper than 40 degrees
    /// stay sharp. False: shade each triangle flat. Default: as the file says.
    pub(in crate::scene) smooth: Option<bool>,
    /// A factor about the origin, or one for each axis. Default: 1.
    scale: Option<Scale>,
    /// A turn: degrees about the x axis, then about y, then about z; or { axis, angle }. Default: none.
    rotate: Option<Rotation>,
    /// Added to every point. Default: [0, 0, 0].
    translate: Option<Point>,
}

impl MeshSection {
    pub(in crate::scene) fn transform(&self) -> Affine {
        let scale = self.scale.map_or(Affine::IDENTITY, |scale| Affine::scale(scale.0));
        let rotate = self.rotate.as_ref().map_or(Affine::IDENTITY, |rotation| rotation.0);
        let translate = self.translate.map_or(Vec3d::ZERO, |by| by.0);
        scale.then(rotate).then(Affine::translate(translate))
    }
}

/// A turn about the origin.
#[derive(Debug)]
struct Rotation(Affine);

/// A turn about an axis through the origin.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct AxisAngle {
    /// The direction of the axis.
    axis: Direction,
    /// Degrees, counter-clockwise for who looks against the axis.
    angle: Real,
}

impl FromLoose for Rotation {
    const EXPECTED: &'static str = "degrees about the axes [x, y, z], or { axis, angle }";
    const SCHEMA: &'static str = Point::SCHEMA;
    type Table = AxisAngle;

    fn from_loose(loose: Loose<AxisAngle>) -> Result<Self, String> {
        match loose {
            Loose::Table(AxisAngle { axis, angle }) => Ok(Self(about(axis.0, angle.0))),
            Loose::Triple(degrees) if degrees.iter().all(|a| a.is_finite()) => {
                let axes = Affine::IDENTITY.columns;
                let turns = axes.into_iter().zip(degrees).map(|(axis, degrees)| about(axis, degrees));
                Ok(Self(turns.fold(Affine::IDENTITY, Affine::then)))
            }
            _ => Err(String::new()),
        }
    }
}

/// A turn about a direction, which is not zero.
fn about(axis: Vec3d, degrees: f64) -> Affine {
    let (sin, cos) = sin_cos_degrees(degrees);
    Affine::rotate(axis.direction(), sin, cos)
}

read_loosely!(Rotation);
