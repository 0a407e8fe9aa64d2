//! All materials of a scene in the form that lanes want.

use super::local::LocalSurface;
use super::optics;
use super::{PreparedMaterial, PreparedTexture, SpecularModel, texture};
use crate::math::{Vec3, select};
use simd::{F32Lanes, MaskLanes, U32Lanes};

/// What a material does, as bits.
mod bits {
    pub(super) const ANSWERS_TO_LIGHTS: u32 = 1;
    pub(super) const SCATTERS: u32 = 2;
    pub(super) const TRANSPARENT: u32 = 4;
    pub(super) const CHECKERED: u32 = 8;
}

/// The materials, four numbers in each table, so that one read finds what a lane wants.
#[derive(Clone, Debug, Default)]
pub(crate) struct MaterialTable {
    /// Even colour, strength of ambient light.
    colors: Vec<[f32; 4]>,
    /// Highlight, strength of diffuse light.
    highlights: Vec<[f32; 4]>,
    /// Exponent and form of the highlight, what the material does, index of refraction.
    kinds: Vec<[f32; 4]>,
    /// Odd colour, frequency.
    checkers: Vec<[f32; 4]>,
    /// Shift of the checks.
    shifts: Vec<[f32; 4]>,
    /// Reflected share, index of refraction.
    reflected: Vec<[f32; 4]>,
    /// Transmitted share, reflectance.
    transmitted: Vec<[f32; 4]>,
    /// Halvings of light per internal length.
    absorption: Vec<[f32; 4]>,
    absorbs: bool,
    has_transparent: bool,
}

impl MaterialTable {
    pub(crate) fn new(materials: &[PreparedMaterial]) -> Self {
        let mut table = Self::default();
        materials.iter().for_each(|material| table.push(material));
        table
    }

    fn push(&mut self, material: &PreparedMaterial) {
        let local = material.local();
        let is_blinn = f32::from(local.specular_model == SpecularModel::Blinn);
        let (even, odd, frequency, shift) = match *material.texture() {
            PreparedTexture::Color(color) => (color, color, 0.0, Vec3::splat(0.0)),
            PreparedTexture::Checker { colors: [even, odd], frequency, shift } => (even, odd, frequency, shift),
        };
        let s = local.specular;
        let is_checkered = matches!(material.texture(), PreparedTexture::Checker { .. });
        let mut bits = 0;
        for (bit, is_set) in [
            (bits::ANSWERS_TO_LIGHTS, material.answers_to_lights()),
            (bits::SCATTERS, material.scatters()),
            (bits::TRANSPARENT, material.is_transparent()),
            (bits::CHECKERED, is_checkered),
        ] {
            bits |= if is_set { bit } else { 0 };
        }
        let absorb = material.absorb();
        let [reflected, transmitted] = material.scattering_rows();
        self.colors.push([even.x, even.y, even.z, material.ambient()]);
        self.highlights.push([s.x, s.y, s.z, local.diffuse]);
        self.kinds.push([local.exponent, is_blinn, f32::from_bits(bits), material.ior()]);
        self.checkers.push([odd.x, odd.y, odd.z, frequency]);
        self.shifts.push([shift.x, shift.y, shift.z, 0.0]);
        self.reflected.push(reflected);
        self.transmitted.push(transmitted);
        self.absorption.push([absorb.x, absorb.y, absorb.z, 0.0]);
        self.absorbs |= absorb.max_component() > 0.0;
        self.has_transparent |= material.is_transparent();
    }

    /// True if something can be entered.
    pub(crate) fn has_transparent(&self) -> bool {
        self.has_transparent
    }

    /// The parameters of the material of each lane that local light needs, at these points. `material` is one in all
    /// lanes, also those that are not `active`, which mean nothing.
    #[inline(always)]
    pub(crate) fn finish<L: F32Lanes>(
        &self,
        token: L::Token,
        active: L::Mask,
        material: L::U32,
        position: Vec3<L>,
    ) -> Finish<L> {
        let [r, g, b, ambient] = L::gather_x4(&self.colors, material);
        let [sr, sg, sb, diffuse] = L::gather_x4(&self.highlights, material);
        let [exponent, is_blinn, bits, _] = L::gather_x4(&self.kinds, material);
        let (color, specular) = (Vec3::new(r, g, b), Vec3::new(sr, sg, sb));
        let mut finish = Finish { bits: bits.to_bits(), color, ambient, diffuse, specular, exponent, is_blinn };
        if (finish.has(token, bits::CHECKERED) & active).any() {
            let [r, g, b, frequency] = L::gather_x4(&self.checkers, material);
            let [x, y, z, _] = L::gather_x4(&self.shifts, material);
            finish.color = texture::checker(token, color, Vec3::new(r, g, b), frequency, Vec3::new(x, y, z), position);
        }
        finish
    }

    /// The shares of light that surfaces reflect and transmit; `material` is one in all lanes.
    #[inline(always)]
    pub(crate) fn scattering<L: F32Lanes>(&self, material: L::U32) -> Scattering<L> {
        Scattering::from_rows([L::gather_x4(&self.reflected, material), L::gather_x4(&self.transmitted, material)])
    }

    /// What is left of light after `distance` ≥ 0 inside `medium` (Beer, Lambert); 1 where nothing is absorbed, even at
    /// infinity, and outside of `inside`.
    #[inline(always)]
    pub(crate) fn transmittance<L: F32Lanes>(
        &self,
        token: L::Token,
        inside: L::Mask,
        medium: L::U32,
        distance: L,
    ) -> Vec3<L> {
        let one = Vec3::splat(L::splat(token, 1.0));
        if !(self.absorbs && inside.any()) {
            return one;
        }
        let medium = L::U32::select(inside, medium, L::U32::splat(token, 0));
        let [r, g, b, _] = L::gather_x4(&self.absorption, medium);
        select(inside, optics::transmittance(token, Vec3::new(r, g, b), distance), one)
    }

    /// Index of refraction of `medium` where a ray is `inside` one, else 1.
    #[inline(always)]
    pub(crate) fn ior<L: F32Lanes>(&self, token: L::Token, inside: L::Mask, medium: L::U32) -> L {
        let medium = L::U32::select(inside, medium, L::U32::splat(token, 0));
        L::select(inside, L::gather_x4(&self.kinds, medium)[3], L::splat(token, 1.0))
    }
}

/// What local light needs to know of surfaces.
#[derive(Clone, Copy)]
pub(crate) struct Finish<L: F32Lanes> {
    bits: L::U32,
    /// Base colour at the point.
    pub(crate) color: Vec3<L>,
    /// Strength of ambient light.
    pub(crate) ambient: L,
    diffuse: L,
    specular: Vec3<L>,
    exponent: L,
    is_blinn: L,
}

impl<L: F32Lanes> Finish<L> {
    #[inline(always)]
    fn has(&self, token: L::Token, bit: u32) -> L::Mask {
        !(self.bits & L::U32::splat(token, bit)).eq(L::U32::splat(token, 0))
    }

    /// Lanes whose local model is not zero for all directions.
    #[inline(always)]
    pub(crate) fn answers_to_lights(&self, token: L::Token) -> L::Mask {
        self.has(token, bits::ANSWERS_TO_LIGHTS)
    }

    /// Lanes from whose surfaces rays may leave.
    #[inline(always)]
    pub(crate) fn scatters(&self, token: L::Token) -> L::Mask {
        self.has(token, bits::SCATTERS)
    }

    /// Lanes that let light pass.
    #[inline(always)]
    pub(crate) fn is_transparent(&self, token: L::Token) -> L::Mask {
        self.has(token, bits::TRANSPARENT)
    }

    /// The local model, multiplied by `weight`.
    #[inline(always)]
    pub(crate) fn local(&self, weight: Vec3<L>) -> LocalSurface<L> {
        LocalSurface {
            diffuse: (self.color * self.diffuse).times(weight),
            specular: self.specular.times(weight),
            exponent: self.exponent,
            is_blinn: self.is_blinn,
        }
    }
}

/// What a surface does with light that is not absorbed.
#[derive(Clone, Copy)]
pub(crate) struct Scattering<L> {
    reflect: Vec3<L>,
    transmit: Vec3<L>,
    /// Index of refraction of the inside.
    pub(crate) ior: L,
    /// How the shares depend on the angle: one of the numbers below.
    reflectance: L,
}

impl Scattering<()> {
    /// See [`Reflectance`](super::Reflectance).
    pub(super) const CONSTANT: f32 = 0.0;
    pub(super) const FRESNEL: f32 = 1.0;
    pub(super) const SCHLICK: f32 = 2.0;
}

impl<L: F32Lanes> Scattering<L> {
    /// From rows like those of [`PreparedMaterial::scattering_rows`].
    #[inline(always)]
    pub(super) fn from_rows([[r, g, b, ior], [tr, tg, tb, reflectance]]: [[L; 4]; 2]) -> Self {
        Self { reflect: Vec3::new(r, g, b), transmit: Vec3::new(tr, tg, tb), ior, reflectance }
    }

    /// See [`PreparedMaterial::split`]; `total` is unset for opaque materials.
    #[inline(always)]
    pub(crate) fn split(&self, token: L::Token, cos_i: L, eta: L, total: L::Mask) -> (Vec3<L>, Vec3<L>) {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let reflect = select(total, self.reflect + self.transmit, self.reflect);
        let transmit = select(total, Vec3::splat(zero), self.transmit);
        let is_constant = self.reflectance.eq(L::splat(token, Scattering::CONSTANT));
        if is_constant.all() {
            return (reflect, transmit);
        }
        let is_schlick = self.reflectance.eq(L::splat(token, Scattering::SCHLICK));
        let mut reflectance = optics::fresnel(token, cos_i, eta);
        if is_schlick.any() {
            reflectance = L::select(is_schlick, optics::schlick(token, cos_i, eta), reflectance);
        }
        let reflectance = L::select(total, one, reflectance);
        (
            select(is_constant, reflect, self.reflect * reflectance),
            select(is_constant, transmit, self.transmit * (one - reflectance)),
        )
    }
}
