//! What a scene file consists of, section by section: the keys, and what they become.

mod camera;
mod generate;
mod light;
mod material;
mod mesh;
mod objects;
mod render;

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};

use super::decode::At;
use super::document::{Key, Node, Value};
use super::values::Count;

pub(super) use camera::{CameraSection, is_single_camera, name_cameras};
pub(super) use generate::{GenerateSection, Materials};
pub(super) use light::LightSection;
pub(super) use material::{MaterialSection, plain_ior};
pub(super) use mesh::MeshSection;
pub(super) use objects::{BoxSection, ConeSection, CylinderSection, DiscSection, PlaneSection, SphereSection};
pub(super) use render::RenderSection;

/// A scene: cameras, lights, materials and things, and what the picture shall be like.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(rename = "Scene"))]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneFile {
    /// The version of this format: 1.
    pub(super) version: At<Count>,
    /// One camera, or several by name ([camera.NAME]). Without any, one is placed automatically.
    #[serde(default)]
    #[cfg_attr(feature = "schema", schemars(schema_with = "camera::schema"))]
    pub(super) camera: Named<At<CameraSection>>,
    /// What the picture shall be like.
    #[serde(default)]
    pub(super) render: RenderSection,
    /// Lights.
    #[serde(default)]
    pub(super) light: Vec<At<LightSection>>,
    /// Materials by name. Things without a material, or with the material "default", are light grey unless the scene
    /// has its own "default".
    #[serde(default)]
    pub(super) material: Named<MaterialSection>,
    /// Spheres.
    #[serde(default)]
    pub(super) sphere: Vec<SphereSection>,
    /// Unbounded planes.
    #[serde(default)]
    pub(super) plane: Vec<PlaneSection>,
    /// Flat round plates.
    #[serde(default)]
    pub(super) disc: Vec<At<DiscSection>>,
    /// Axis-aligned boxes.
    #[serde(default, rename = "box")]
    pub(super) boxes: Vec<At<BoxSection>>,
    /// Round tubes.
    #[serde(default)]
    pub(super) cylinder: Vec<At<CylinderSection>>,
    /// Cones and frustums.
    #[serde(default)]
    pub(super) cone: Vec<At<ConeSection>>,
    /// Triangle meshes from files.
    #[serde(default)]
    pub(super) mesh: Vec<MeshSection>,
    /// Many spheres from a few numbers.
    #[serde(default)]
    pub(super) generate: Vec<At<GenerateSection>>,
}

/// The lists of a scene file, to be filled item by item.
macro_rules! lists {
    ($($key:literal $field:ident: $section:ty,)*) => {
        /// Sections as they are read, of all the keys of [`SceneFile`] that have lists.
        #[derive(Debug, Default)]
        pub(super) struct Lists {
            $($field: Vec<$section>,)*
        }

        impl Lists {
            /// Whether there is a list of the key `key`.
            pub(super) fn has(key: &str) -> bool {
                matches!(key, $($key)|*)
            }

            /// Append an item to the list of the key `key`. None if the item is wrong, or there is no such list.
            pub(super) fn push<'de>(&mut self, key: &str, item: impl Deserializer<'de>) -> Option<()> {
                match key {
                    $($key => self.$field.push(<$section>::deserialize(item).ok()?),)*
                    _ => return None,
                }
                Some(())
            }

            /// Make these the lists of `file`.
            pub(super) fn move_to(self, file: &mut SceneFile) {
                $(file.$field = self.$field;)*
            }
        }
    };
}

lists! {
    "light" light: At<LightSection>,
    "sphere" sphere: SphereSection,
    "plane" plane: PlaneSection,
    "disc" disc: At<DiscSection>,
    "box" boxes: At<BoxSection>,
    "cylinder" cylinder: At<CylinderSection>,
    "cone" cone: At<ConeSection>,
    "mesh" mesh: MeshSection,
    "generate" generate: At<GenerateSection>,
}

/// A table of named things, in the order of the text.
#[derive(Debug)]
pub(super) struct Named<T>(pub(super) Vec<(At<String>, T)>);

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NamedVisitor<T>(std::marker::PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for NamedVisitor<T> {
            type Value = Named<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table of names")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Named(entries))
            }
        }
        deserializer.deserialize_map(NamedVisitor(std::marker::PhantomData))
    }
}
