//! Materials ready for rendering.

use super::local::{self, LocalModel};
use super::one::{One, one, ones, value, values};
use super::table::Scattering;
use super::{Material, PreparedTexture, Reflectance, optics};
use crate::math::{Vec3d, Vec3f};
use simd::Scalar;
use std::f64::consts::LOG2_E;

/// A material in internal space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreparedMaterial {
    texture: PreparedTexture,
    ambient: f32,
    local: LocalModel,
    reflect: Vec3f,
    transmit: Vec3f,
    reflectance: Reflectance,
    ior: f32,
    /// Halvings of light per internal length.
    absorb: Vec3f,
}

impl PreparedMaterial {
    /// `material` in a space where the world's origin lies at `origin` and world lengths are multiplied by `scale`.
    pub fn new(material: &Material, origin: Vec3d, scale: f64) -> Self {
        Self {
            texture: PreparedTexture::new(&material.color, origin, scale),
            ambient: material.ambient,
            local: LocalModel {
                diffuse: material.diffuse,
                specular: material.specular,
                exponent: material.exponent,
                specular_model: material.specular_model,
            },
            reflect: material.reflect,
            transmit: material.transmit,
            reflectance: material.reflectance,
            ior: material.ior,
            absorb: material.absorb.map(|a| (f64::from(a) * LOG2_E / scale) as f32),
        }
    }

    /// True if light passes.
    pub fn is_transparent(&self) -> bool {
        self.transmit.max_component() > 0.0
    }

    /// True if rays may leave the surface.
    pub fn scatters(&self) -> bool {
        self.is_transparent() || self.reflect.max_component() > 0.0
    }

    /// True if [`answer`](Self::answer) is not zero for all directions.
    pub fn answers_to_lights(&self) -> bool {
        self.local.diffuse > 0.0 || self.local.specular.max_component() > 0.0
    }

    /// Strength of ambient light.
    pub fn ambient(&self) -> f32 {
        self.ambient
    }

    /// Index of refraction of the inside.
    pub fn ior(&self) -> f32 {
        self.ior
    }

    /// Fraction of light that passes the surface when angles do not matter, as for shadows.
    pub fn transmit(&self) -> Vec3f {
        self.transmit
    }

    /// What [`Scattering`] is made of.
    pub(super) fn scattering_rows(&self) -> [[f32; 4]; 2] {
        let (reflect, transmit) = (self.reflect, self.transmit);
        let code = match self.reflectance {
            Reflectance::Constant => Scattering::CONSTANT,
            Reflectance::Fresnel => Scattering::FRESNEL,
            Reflectance::Schlick => Scattering::SCHLICK,
        };
        [[reflect.x, reflect.y, reflect.z, self.ior], [transmit.x, transmit.y, transmit.z, code]]
    }

    /// Halvings of light per internal length of the inside.
    pub(super) fn absorb(&self) -> Vec3f {
        self.absorb
    }

    /// The parameters of the local model.
    pub fn local(&self) -> &LocalModel {
        &self.local
    }

    /// The texture of the base colour.
    pub fn texture(&self) -> &PreparedTexture {
        &self.texture
    }

    /// Base colour at a point.
    pub fn color(&self, position: Vec3f) -> Vec3f {
        values(self.texture.at::<One>(Scalar, ones(position)))
    }

    /// [`lanes::answer`](super::lanes::answer) for one ray.
    pub fn answer(&self, color: Vec3f, normal: Vec3f, to_light: Vec3f, view: Vec3f) -> Vec3f {
        let surface = self.local.surface(color).map(one);
        values(local::answer::<One>(Scalar, &surface, ones(normal), ones(to_light), ones(view)))
    }

    /// What is left of light after `distance` ≥ 0 inside (Beer, Lambert); 1 where nothing is absorbed, even at infinity.
    pub fn transmittance(&self, distance: f32) -> Vec3f {
        values(optics::transmittance::<One>(Scalar, ones(self.absorb), one(distance)))
    }

    /// The shares of light that are reflected and refracted, for a ray that arrives with `cos_i` ≥ 0 from the normal and
    /// for `eta`, the index of refraction on its side divided by the one beyond. `total`: there is no refracted
    /// direction; means nothing for opaque materials.
    ///
    /// Total reflection reflects what would have been refracted: constant shares are added, Fresnel's and Schlick's
    /// reflectance become 1.
    pub fn split(&self, cos_i: f32, eta: f32, total: bool) -> (Vec3f, Vec3f) {
        let total = simd::MaskLanes::from_bits(Scalar, u32::from(total && self.is_transparent()));
        let scattering = Scattering::from_rows(self.scattering_rows().map(|row| row.map(one)));
        let (reflect, transmit) = scattering.split(Scalar, one(cos_i), one(eta), total);
        (values(reflect), values(transmit))
    }
}

/// [`lanes::mirrored`](super::lanes::mirrored) for one ray.
pub fn mirrored(incident: Vec3f, normal: Vec3f) -> Vec3f {
    values(optics::mirrored::<One>(Scalar, ones(incident), ones(normal)))
}

/// [`lanes::refracted`](super::lanes::refracted) for one ray; `None` if reflection is total.
pub fn refracted(incident: Vec3f, normal: Vec3f, eta: f32) -> Option<Vec3f> {
    let (direction, refracts) = optics::refracted::<One>(Scalar, ones(incident), ones(normal), one(eta));
    simd::MaskLanes::any(refracts).then(|| values(direction))
}

/// [`lanes::fresnel`](super::lanes::fresnel) for one ray.
pub fn fresnel(cos_i: f32, eta: f32) -> f32 {
    value(optics::fresnel(Scalar, one(cos_i), one(eta)))
}

/// [`lanes::schlick`](super::lanes::schlick) for one ray.
pub fn schlick(cos_i: f32, eta: f32) -> f32 {
    value(optics::schlick(Scalar, one(cos_i), one(eta)))
}
