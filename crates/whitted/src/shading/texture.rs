//! Colours that depend on where.

use super::Texture;
use crate::math::{Vec3, Vec3d, Vec3f, select};
use simd::F32Lanes;

/// A texture, ready for points of internal space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PreparedTexture {
    /// The same everywhere.
    Color(Vec3f),
    /// Cubes of two colours.
    Checker {
        /// Colours of even and odd cubes.
        colors: [Vec3f; 2],
        /// Cubes per internal length.
        frequency: f32,
        /// Added to the coordinate in cubes; within ±2, the period.
        shift: Vec3f,
    },
}

/// Checkers are moved by this part of a cube, so that a floor that lies in a boundary (y = 0 above all) has one colour
/// on each square though its points are rounded to either side.
const OFF_BOUNDARY: f64 = 1.0 / 1024.0;

impl PreparedTexture {
    /// `texture` in a space where the world's origin lies at `origin` and world lengths are multiplied by `scale`.
    pub fn new(texture: &Texture, origin: Vec3d, scale: f64) -> Self {
        match *texture {
            Texture::Color(color) => Self::Color(color),
            Texture::Checker { even, odd, size } => {
                let frequency = 1.0 / (f64::from(size) * scale);
                let shift = origin.map(|a| (OFF_BOUNDARY - (a * frequency) % 2.0) as f32);
                Self::Checker { colors: [even, odd], frequency: frequency as f32, shift }
            }
        }
    }

    /// The colours at these points. Checkers hold as long as single precision tells neighbouring cubes apart; beyond
    /// that, and for NaN, the colour is one of the two.
    #[inline(always)]
    pub fn at<L: F32Lanes>(&self, token: L::Token, position: Vec3<L>) -> Vec3<L> {
        let splat = |value| L::splat(token, value);
        match *self {
            Self::Color(color) => color.map(splat),
            Self::Checker { colors: [even, odd], frequency, shift } => {
                checker(token, even.map(splat), odd.map(splat), splat(frequency), shift.map(splat), position)
            }
        }
    }
}

/// The colour of the cube in which a point lies; see [`PreparedTexture::Checker`].
#[inline(always)]
pub(super) fn checker<L: F32Lanes>(
    token: L::Token,
    even: Vec3<L>,
    odd: Vec3<L>,
    frequency: L,
    shift: Vec3<L>,
    position: Vec3<L>,
) -> Vec3<L> {
    let cube = position * frequency + shift;
    let sum = parity(token, cube.x.floor()) + parity(token, cube.y.floor()) + parity(token, cube.z.floor());
    select(parity(token, sum).gt(L::splat(token, 0.5)), odd, even)
}

/// 0 for even and 1 for odd integers of any size, exactly.
#[inline(always)]
fn parity<L: F32Lanes>(token: L::Token, n: L) -> L {
    n - (n * L::splat(token, 0.5)).floor() * L::splat(token, 2.0)
}
