//! `[[generate]]`.

use serde::Deserialize;
use whitted::math::Vec3d;
use whitted::scene::NamedMaterial;
use whitted::scene::generate::{self, GenerateError, GeneratedSphere, PAPER_FILL, PaperFamily};

use crate::scene::decode::At;
use crate::scene::values::{Count, Point, Positive};

/// Many spheres from a few numbers; "kind" says how they are placed.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(rename = "Generate", tag = "kind"))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(in crate::scene) enum GenerateSection {
    /// Spheres of random places and sizes that do not overlap, in the cube from -1 to 1: the paper's scenes.
    SphereCube {
        /// How many.
        count: Count,
        /// The seed of the random numbers. Default: the count.
        seed: Option<Count>,
        /// The part of the cube that they fill, at most 0.3. Default: 0.12.
        fill: Option<Positive>,
        /// Twelve materials. Default: "mix".
        family: Option<Family>,
        /// Names of materials to use instead, in turn.
        materials: Option<Vec<At<String>>>,
        /// Where the middle of the cube comes to lie. Default: [0, 0, 0].
        center: Option<Point>,
        /// Half the edge of the cube. Default: 1.
        scale: Option<Positive>,
    },
    /// Equal spheres on a lattice in the cube from -1 to 1.
    Grid {
        /// How many along each edge.
        per_edge: Count,
        /// The part of the cube that they fill, at most 0.5. Default: 0.12.
        fill: Option<Positive>,
        /// Twelve materials. Default: "mix".
        family: Option<Family>,
        /// Names of materials to use instead, in turn.
        materials: Option<Vec<At<String>>>,
        /// Where the middle of the cube comes to lie. Default: [0, 0, 0].
        center: Option<Point>,
        /// Half the edge of the cube. Default: 1.
        scale: Option<Positive>,
    },
    /// A sphere of radius 1/2 with nine children of a third of its size, each with nine, and so on.
    Sphereflake {
        /// How many generations of children, at most 7.
        depth: Count,
        /// Names of materials, one for each generation, in turn. Default: "default".
        materials: Option<Vec<At<String>>>,
        /// Where the middle of the largest sphere comes to lie. Default: [0, 0, 0].
        center: Option<Point>,
        /// Multiplies all lengths. Default: 1.
        scale: Option<Positive>,
    },
}

/// Twelve materials, chosen at random for each sphere.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(in crate::scene) enum Family {
    /// Half of the spheres matte, a quarter mirrors, a quarter glass.
    Mix,
    /// Every sphere diffuse, shiny, reflective and transparent.
    All4,
}

/// The materials of generated things.
pub(in crate::scene) enum Materials<'a> {
    /// Those of the scene by name.
    Named(&'a [At<String>]),
    /// Those of a family.
    Family(Vec<NamedMaterial>),
    /// That of all things without a material.
    Default,
}

/// Where generated things come to lie.
pub(in crate::scene) struct Placement {
    pub(in crate::scene) center: Vec3d,
    pub(in crate::scene) scale: f64,
}

impl GenerateSection {
    /// How many spheres there will be.
    pub(in crate::scene) fn count(&self) -> u64 {
        match self {
            Self::SphereCube { count, .. } => count.whole().into(),
            Self::Grid { per_edge, .. } => u64::from(per_edge.whole()).saturating_pow(3),
            Self::Sphereflake { depth, .. } => {
                // Beyond this depth the sum leaves 64 bits.
                let depth = depth.whole().min(20);
                (0..=depth).map(|level| 9_u64.pow(level)).sum()
            }
        }
    }

    pub(in crate::scene) fn spheres(&self) -> Result<Vec<GeneratedSphere>, GenerateError> {
        let part = |fill: &Option<Positive>| fill.map_or(PAPER_FILL, |fill| fill.0);
        match self {
            Self::SphereCube { count, seed, fill, .. } => {
                generate::sphere_cube(count.whole(), seed.unwrap_or(*count).whole().into(), part(fill))
            }
            Self::Grid { per_edge, fill, .. } => generate::grid(per_edge.whole(), part(fill)),
            Self::Sphereflake { depth, .. } => generate::sphereflake(depth.whole()),
        }
    }

    pub(in crate::scene) fn materials(&self) -> Materials<'_> {
        match self {
            Self::SphereCube { materials: Some(names), .. }
            | Self::Grid { materials: Some(names), .. }
            | Self::Sphereflake { materials: Some(names), .. }
                if !names.is_empty() =>
            {
                Materials::Named(names)
            }
            Self::SphereCube { family, .. } | Self::Grid { family, .. } => {
                Materials::Family(family.unwrap_or(Family::Mix).materials())
            }
            Self::Sphereflake { .. } => Materials::Default,
        }
    }

    pub(in crate::scene) fn place(&self) -> Placement {
        let (Self::SphereCube { center, scale, .. }
        | Self::Grid { center, scale, .. }
        | Self::Sphereflake { center, scale, .. }) = self;
        Placement { center: center.map_or(Vec3d::ZERO, |c| c.0), scale: scale.map_or(1.0, |s| s.0) }
    }
}

impl Family {
    /// The materials with names that tell the family.
    fn materials(self) -> Vec<NamedMaterial> {
        let (family, name) = match self {
            Self::Mix => (PaperFamily::Mix, "mix"),
            Self::All4 => (PaperFamily::All4, "all4"),
        };
        let named = |m: NamedMaterial| NamedMaterial { name: format!("{name}.{}", m.name), ..m };
        generate::paper_materials(family).into_iter().map(named).collect()
    }
}
