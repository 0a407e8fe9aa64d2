//! Materials as the user describes them.

use crate::math::Vec3f;

/// A Whitted material: ambient + diffuse + specular + reflected + transmitted light.
///
/// All strengths are plain factors: the diffuse part is *not* scaled by one minus the transmittance, as some programs
/// do. Colours are linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Base colour of the ambient and diffuse parts.
    pub color: Texture,
    /// Strength of ambient light.
    pub ambient: f32,
    /// Strength of Lambert's diffuse reflection (light falling at right angles gives `diffuse · color · light`).
    pub diffuse: f32,
    /// Strength of the highlight, per colour component.
    pub specular: Vec3f,
    /// Exponent of the highlight, ≥ 0.
    pub exponent: f32,
    /// The form of the highlight.
    pub specular_model: SpecularModel,
    /// Mirror reflection.
    pub reflect: Vec3f,
    /// How `reflect` and `transmit` depend on the angle.
    pub reflectance: Reflectance,
    /// Fraction of light that passes the surface, per colour component.
    pub transmit: Vec3f,
    /// Index of refraction of the inside, > 0; 1 bends nothing.
    pub ior: f32,
    /// Absorption coefficient of the inside per scene unit (Beer–Lambert: light is multiplied by `exp(−absorb · d)`).
    pub absorb: Vec3f,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            color: Texture::Color(Vec3f::new(0.8, 0.8, 0.8)),
            ambient: 0.1,
            diffuse: 0.8,
            specular: Vec3f::ZERO,
            exponent: 40.0,
            specular_model: SpecularModel::Phong,
            reflect: Vec3f::ZERO,
            reflectance: Reflectance::Constant,
            transmit: Vec3f::ZERO,
            ior: 1.0,
            absorb: Vec3f::ZERO,
        }
    }
}

/// The form of a highlight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpecularModel {
    /// Cosine between the mirrored light and the view (Phong 1975), to the power of the exponent.
    Phong,
    /// Cosine between the normal and the half vector (Blinn 1977), to the power of the exponent.
    Blinn,
}

/// How reflection and transmission depend on the angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reflectance {
    /// `reflect` and `transmit` as given at every angle.
    Constant,
    /// `reflect` is multiplied by the Fresnel reflectance R of unpolarised light, `transmit` by 1 − R.
    Fresnel,
    /// As `Fresnel`, with Schlick's approximation (1994).
    Schlick,
}

/// A colour that may depend on where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Texture {
    /// The same linear colour everywhere.
    Color(Vec3f),
    /// A solid checkerboard of cubes in world space.
    Checker {
        /// Colour of the cube at the origin.
        even: Vec3f,
        /// Colour of its neighbours.
        odd: Vec3f,
        /// Edge length of a cube in scene units, > 0.
        size: f32,
    },
}

impl Material {
    /// True if light passes its surface.
    pub fn is_transmissive(&self) -> bool {
        self.transmit.max_component() > 0.0
    }

    /// True if it mirrors.
    pub fn is_reflective(&self) -> bool {
        self.reflect.max_component() > 0.0
    }

    /// What makes the material impossible, if anything: a number that is not finite, a negative strength, an index of
    /// refraction or size of checkers that is not positive.
    pub fn fault(&self) -> Option<&'static str> {
        let strengths =
            [Vec3f::splat(self.ambient), Vec3f::splat(self.diffuse), self.specular, self.reflect, self.transmit];
        [
            (!strengths.into_iter().all(is_amount), "a strength is negative or not finite"),
            (!self.color.colors().into_iter().all(is_amount), "its colour is negative or not finite"),
            (!is_amount(Vec3f::splat(self.exponent)), "the exponent of its highlight is negative or not finite"),
            (!(self.ior > 0.0 && self.ior.is_finite()), "its index of refraction must be finite and above 0"),
            (!is_amount(self.absorb), "its absorption is negative or not finite"),
            (!self.color.has_size(), "the cubes of its checkerboard need a finite size above 0"),
        ]
        .into_iter()
        .find_map(|(is_wrong, fault)| is_wrong.then_some(fault))
    }
}

impl Texture {
    /// All colours in it.
    fn colors(&self) -> [Vec3f; 2] {
        match *self {
            Self::Color(color) => [color, color],
            Self::Checker { even, odd, .. } => [even, odd],
        }
    }

    fn has_size(&self) -> bool {
        match *self {
            Self::Color(_) => true,
            Self::Checker { size, .. } => size > 0.0 && size.is_finite(),
        }
    }
}

/// True if all components are finite and not negative.
fn is_amount(amount: Vec3f) -> bool {
    amount.to_array().into_iter().all(|a| a >= 0.0 && a.is_finite())
}
