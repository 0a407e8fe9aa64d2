//! `[material.NAME]`.

use serde::Deserialize;
use whitted::math::Vec3f;
use whitted::shading::{Material, Reflectance, SpecularModel, Texture};

use super::render::unknown;
use crate::scene::loose::{FromLoose, Loose, read_loosely};
use crate::scene::values::{Color, NotNegative, Positive, Strength};

/// A material: ambient + diffuse + highlight + reflected + transmitted light, each with its own strength. No strength
/// is scaled by another: what they add up to is the scene's care.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(rename = "Material"))]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct MaterialSection {
    /// The colour of the ambient and diffuse parts. Default: [0.8, 0.8, 0.8].
    color: Option<TextureValue>,
    /// Strength of ambient light. Default: 0.1.
    ambient: Option<NotNegative>,
    /// Strength of diffuse reflection. Default: 0.8.
    diffuse: Option<NotNegative>,
    /// Strength of the highlight, or a table. Default: 0.
    specular: Option<SpecularValue>,
    /// Mirror reflection. Default: 0.
    reflect: Option<ReflectValue>,
    /// Share of the light that passes the surface. Default: 0.
    transmit: Option<Strength>,
    /// Index of refraction of the inside; 1 bends nothing. Default: 1, and 1.5 with "fresnel" or "schlick".
    ior: Option<Positive>,
    /// What the inside absorbs (Beer-Lambert). Default: nothing.
    absorb: Option<AbsorbValue>,
}

impl MaterialSection {
    pub(in crate::scene) fn material(&self) -> Material {
        let default = Material::default();
        let specular = self.specular.as_ref();
        let (reflect, reflectance) =
            self.reflect.as_ref().map_or((default.reflect, default.reflectance), |r| (r.strength, r.reflectance));
        Material {
            color: self.color.as_ref().map_or(default.color, |texture| texture.0),
            ambient: self.ambient.map_or(default.ambient, |x| x.single()),
            diffuse: self.diffuse.map_or(default.diffuse, |x| x.single()),
            specular: specular.map_or(default.specular, |s| s.strength),
            exponent: specular.map_or(default.exponent, |s| s.exponent),
            specular_model: specular.map_or(default.specular_model, |s| s.model),
            reflect,
            reflectance,
            transmit: self.transmit.map_or(default.transmit, |strength| strength.0),
            ior: self.ior.map_or(plain_ior(reflectance), |x| x.single()),
            absorb: self.absorb.as_ref().map_or(default.absorb, |absorb| absorb.0),
        }
    }
}

/// The index of refraction of a material that states none.
pub(in crate::scene) fn plain_ior(reflectance: Reflectance) -> f32 {
    /// Window glass, for materials that reflect like a dielectric.
    const GLASS: f32 = 1.5;
    if reflectance == Reflectance::Constant { Material::default().ior } else { GLASS }
}

/// A colour, or a checkerboard.
#[derive(Debug)]
struct TextureValue(Texture);

/// A solid checkerboard of cubes in world space.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct Checker {
    /// The two colours; the first is that of the cube at the origin.
    checker: [Color; 2],
    /// The edge length of a cube. Default: 1.
    size: Option<Positive>,
}

impl FromLoose for TextureValue {
    const EXPECTED: &'static str = "a colour, or { checker = [colour, colour], size = number }";
    const SCHEMA: &'static str = Color::SCHEMA;
    type Table = Checker;

    fn from_loose(loose: Loose<Checker>) -> Result<Self, String> {
        Ok(Self(match loose {
            Loose::Table(Checker { checker: [even, odd], size }) => {
                Texture::Checker { even: even.0, odd: odd.0, size: size.map_or(1.0, |x| x.single()) }
            }
            Loose::Triple(rgb) => Texture::Color(Color::from_loose(Loose::Triple(rgb))?.0),
            Loose::Word(word) => Texture::Color(Color::from_loose(Loose::Word(word))?.0),
            Loose::Number(_) => return Err(String::new()),
        }))
    }
}

/// A highlight.
#[derive(Debug)]
struct SpecularValue {
    strength: Vec3f,
    exponent: f32,
    model: SpecularModel,
}

/// A highlight.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct Specular {
    /// How strong it is. Default: 0.5.
    strength: Option<Strength>,
    /// The larger, the smaller the highlight. Default: 40.
    exponent: Option<NotNegative>,
    /// Its form. Default: "phong".
    model: Option<Model>,
}

/// The form of a highlight.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
enum Model {
    /// By the angle between the mirrored light and the view (Phong 1975).
    Phong,
    /// By the angle between the normal and the half vector (Blinn 1977).
    Blinn,
}

impl FromLoose for SpecularValue {
    const EXPECTED: &'static str = "a strength, or { strength, exponent, model }";
    const SCHEMA: &'static str = Strength::SCHEMA;
    type Table = Specular;

    fn from_loose(loose: Loose<Specular>) -> Result<Self, String> {
        const DEFAULT_STRENGTH: f32 = 0.5;
        let default = Material::default();
        let table = match loose {
            Loose::Table(table) => table,
            Loose::Number(x) => plain(Strength::from_loose(Loose::Number(x))?),
            Loose::Word(word) => plain(Strength::from_loose(Loose::Word(word))?),
            Loose::Triple(rgb) => plain(Strength::from_loose(Loose::Triple(rgb))?),
        };
        Ok(Self {
            strength: table.strength.map_or(Vec3f::splat(DEFAULT_STRENGTH), |strength| strength.0),
            exponent: table.exponent.map_or(default.exponent, |x| x.single()),
            model: match table.model {
                Some(Model::Blinn) => SpecularModel::Blinn,
                Some(Model::Phong) => SpecularModel::Phong,
                None => default.specular_model,
            },
        })
    }
}

fn plain(strength: Strength) -> Specular {
    Specular { strength: Some(strength), exponent: None, model: None }
}

/// Mirror reflection.
#[derive(Debug)]
struct ReflectValue {
    strength: Vec3f,
    reflectance: Reflectance,
}

/// Mirror reflection that depends on the angle.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct Reflect {
    /// How strong it is. Default: 1.
    strength: Option<Strength>,
    /// How it depends on the angle.
    model: Dependence,
}

/// How reflection depends on the angle; what is not reflected is what "transmit" is multiplied by.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
enum Dependence {
    /// Not at all.
    Constant,
    /// By Fresnel's equations for unpolarised light.
    Fresnel,
    /// By Schlick's approximation of them (1994).
    Schlick,
}

impl FromLoose for ReflectValue {
    const EXPECTED: &'static str = "a strength, \"fresnel\", \"schlick\", or { strength, model }";
    const SCHEMA: &'static str = r##"{"anyOf": [
        {"enum": ["fresnel", "schlick"]},
        {"type": "number", "minimum": 0},
        {"type": "array", "items": {"type": "number", "minimum": 0}, "minItems": 3, "maxItems": 3},
        {"type": "string", "pattern": "^#[0-9a-fA-F]{6}$"}
    ]}"##;
    type Table = Reflect;

    fn from_loose(loose: Loose<Reflect>) -> Result<Self, String> {
        let constant = |strength: Strength| Self { strength: strength.0, reflectance: Reflectance::Constant };
        let full = |reflectance| Self { strength: Vec3f::ONE, reflectance };
        match loose {
            Loose::Table(Reflect { strength, model }) => Ok(Self {
                strength: strength.map_or(Vec3f::ONE, |strength| strength.0),
                reflectance: match model {
                    Dependence::Constant => Reflectance::Constant,
                    Dependence::Fresnel => Reflectance::Fresnel,
                    Dependence::Schlick => Reflectance::Schlick,
                },
            }),
            Loose::Word(word) => match word.as_str() {
                "fresnel" => Ok(full(Reflectance::Fresnel)),
                "schlick" => Ok(full(Reflectance::Schlick)),
                color if color.starts_with('#') => Strength::from_loose(Loose::Word(word)).map(constant),
                other => Err(unknown(other, Self::EXPECTED, &["fresnel", "schlick"])),
            },
            Loose::Number(x) => Strength::from_loose(Loose::Number(x)).map(constant),
            Loose::Triple(rgb) => Strength::from_loose(Loose::Triple(rgb)).map(constant),
        }
    }
}

/// Absorption coefficients per scene unit.
#[derive(Debug)]
struct AbsorbValue(Vec3f);

/// What is left of white light after a distance within the material.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct Absorb {
    /// The colour that white light has after the distance, each component greater than 0 and at most 1.
    color: Color,
    /// The distance in scene units. Default: 1.
    distance: Option<Positive>,
}

impl FromLoose for AbsorbValue {
    const EXPECTED: &'static str =
        "{ color, distance }: the colour left of white light after a distance; or three coefficients, not negative";
    const SCHEMA: &'static str = COEFFICIENTS;
    type Table = Absorb;

    fn from_loose(loose: Loose<Absorb>) -> Result<Self, String> {
        let Absorb { color: Color(color), distance } = match loose {
            Loose::Table(absorb) => absorb,
            Loose::Triple(coefficients) => return Self::from_coefficients(coefficients),
            _ => return Err(String::new()),
        };
        if color.min_component() <= 0.0 || color.max_component() > 1.0 {
            return Err("each component of the colour left must be greater than 0 and at most 1".to_owned());
        }
        let distance = distance.map_or(1.0, |x| x.single());
        let coefficients = color.map(|left| -simd::math::ln(left) / distance);
        match coefficients.is_finite() {
            true => Ok(Self(coefficients)),
            false => Err("the distance is too small".to_owned()),
        }
    }
}

/// The schema of coefficients.
#[cfg_attr(not(feature = "schema"), allow(dead_code, reason = "only the schema reads it; schemas name each other"))]
const COEFFICIENTS: &str =
    r#"{"type": "array", "items": {"type": "number", "minimum": 0}, "minItems": 3, "maxItems": 3}"#;

impl AbsorbValue {
    fn from_coefficients(coefficients: [f64; 3]) -> Result<Self, String> {
        let single = Vec3f::from(coefficients.map(|x| x as f32));
        let is_possible = single.is_finite() && coefficients.iter().all(|&x| x >= 0.0);
        is_possible.then_some(Self(single)).ok_or_else(String::new)
    }
}

read_loosely!(TextureValue, SpecularValue, ReflectValue, AbsorbValue);
