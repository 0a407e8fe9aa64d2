//! All materials of a scene in the form that lanes want: a row of numbers for each.

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

/// The materials, row by row.
#[derive(Clone, Debug, Default)]
pub(crate) struct MaterialTable {
    bits: Vec<u32>,
    /// Even colour, strengths of ambient and diffuse light, highlight, exponent, form.
    local: Vec<[f32; 10]>,
    /// Odd colour, frequency, shift.
    checkers: Vec<[f32; 7]>,
    /// Reflected and transmitted shares, index of refraction, reflectance.
    scattering: Vec<[f32; 8]>,
    /// Indices of refraction.
    iors: Vec<f32>,
    /// Halvings of light per internal length.
    absorption: Vec<[f32; 3]>,
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
        self.bits.push(bits);
        let (ambient, diffuse) = (material.ambient(), local.diffuse);
        self.local.push([even.x, even.y, even.z, ambient, diffuse, s.x, s.y, s.z, local.exponent, is_blinn]);
        self.checkers.push([odd.x, odd.y, odd.z, frequency, shift.x, shift.y, shift.z]);
        self.scattering.push(material.scattering_row());
        self.iors.push(material.ior());
        self.absorption.push(material.absorb().to_array());
        self.absorbs |= material.absorb().max_component() > 0.0;
        self.has_transparent |= material.is_transparent();
    }

    /// True if something can be entered.
    pub(crate) fn has_transparent(&self) -> bool {
        self.has_transparent
    }

    /// The parameters of the material of each lane that local light needs, at these points. `active` is not empty, and
    /// only those lanes mean anything.
    #[inline(always)]
    pub(crate) fn finish<L: F32Lanes>(
        &self,
        token: L::Token,
        active: L::Mask,
        material: L::U32,
        position: Vec3<L>,
    ) -> Finish<L> {
        let index = Index::<L>::new(token, active, material);
        let bits = L::U32::gather(&self.bits, index.lanes);
        let [r, g, b, ambient, diffuse, sr, sg, sb, exponent, is_blinn] = index.rows(token, &self.local);
        let mut color = Vec3::new(r, g, b);
        let mut finish = Finish { bits, color, ambient, diffuse, specular: Vec3::new(sr, sg, sb), exponent, is_blinn };
        if (finish.has(token, bits::CHECKERED) & active).any() {
            let [r, g, b, frequency, x, y, z] = index.rows(token, &self.checkers);
            color = texture::checker(token, color, Vec3::new(r, g, b), frequency, Vec3::new(x, y, z), position);
        }
        finish.color = color;
        finish
    }

    /// The shares of light that surfaces reflect and transmit, as for [`finish`](Self::finish).
    #[inline(always)]
    pub(crate) fn scattering<L: F32Lanes>(&self, token: L::Token, active: L::Mask, material: L::U32) -> Scattering<L> {
        let index = Index::<L>::new(token, active, material);
        Scattering::from_row(index.rows(token, &self.scattering))
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
        let [r, g, b] = Index::<L>::new(token, inside, medium).rows(token, &self.absorption);
        select(inside, optics::transmittance(token, Vec3::new(r, g, b), distance), one)
    }

    /// Index of refraction of `medium` where a ray is `inside` one, else 1.
    #[inline(always)]
    pub(crate) fn ior<L: F32Lanes>(&self, token: L::Token, inside: L::Mask, medium: L::U32) -> L {
        let index = L::U32::select(inside, medium, L::U32::splat(token, 0));
        L::select(inside, L::gather(&self.iors, index), L::splat(token, 1.0))
    }
}

/// Which row each lane wants: valid in all lanes.
struct Index<L: F32Lanes> {
    lanes: L::U32,
    numbers: <L::U32 as U32Lanes>::Array,
    /// All lanes want the same row.
    uniform: bool,
}

impl<L: F32Lanes> Index<L> {
    /// Lanes that are not active get the row of one that is.
    #[inline(always)]
    fn new(token: L::Token, active: L::Mask, wanted: L::U32) -> Self {
        let mut numbers = <L::U32 as U32Lanes>::Array::default();
        wanted.store(&mut numbers);
        let first = active.bits().trailing_zeros() as usize % L::WIDTH;
        let first = L::U32::splat(token, numbers.as_ref()[first]);
        let lanes = L::U32::select(active, wanted, first);
        lanes.store(&mut numbers);
        Self { lanes, numbers, uniform: lanes.eq(first).all() }
    }

    /// The numbers of each lane's row.
    #[inline(always)]
    fn rows<const N: usize>(&self, token: L::Token, table: &[[f32; N]]) -> [L; N] {
        let numbers = self.numbers.as_ref();
        let mut out = [L::splat(token, 0.0); N];
        if self.uniform {
            let row = &table[numbers[0] as usize];
            for i in 0..N {
                out[i] = L::splat(token, row[i]);
            }
            return out;
        }
        // Scalar copies: as fast as sixteen gathers by hardware, and tables stay one row for each material.
        let mut columns = [L::Array::default(); N];
        for lane in 0..L::WIDTH {
            let row = &table[numbers[lane] as usize];
            for i in 0..N {
                columns[i].as_mut()[lane] = row[i];
            }
        }
        for i in 0..N {
            out[i] = L::load(token, &columns[i]);
        }
        out
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
    /// From rows like those of [`PreparedMaterial::scattering_row`].
    #[inline(always)]
    pub(super) fn from_row([r, g, b, tr, tg, tb, ior, reflectance]: [L; 8]) -> Self {
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
