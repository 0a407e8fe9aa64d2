//! The picture in memory.

use crate::math::{Vec3, Vec3f};
use crate::scene::{Settings, Tone};
use simd::{F32Lanes, Kernel, Level, Simd};

/// A picture: linear colours, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width · height` linear colours before exposure; finite.
    pub pixels: Vec<Vec3f>,
}

impl Image {
    /// A black picture.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![Vec3f::ZERO; width as usize * height as usize] }
    }

    /// Eight bits per component, RGB row by row, by the exposure and tone curve of `settings`; NaN gives 0.
    pub fn to_rgb8(&self, settings: &Settings) -> Vec<u8> {
        simd::dispatch(Level::best(), Encode { pixels: &self.pixels, settings })
    }
}

/// Pixels in a step of [`Encode`].
const STEP: usize = 16;

/// Encodes sixteen pixels at a time.
struct Encode<'a> {
    pixels: &'a [Vec3f],
    settings: &'a Settings,
}

impl Kernel for Encode<'_> {
    type Output = Vec<u8>;

    #[inline(always)]
    fn run<S: Simd>(self, token: S) -> Vec<u8> {
        let gain = S::F32x16::splat(token, simd::math::exp2(self.settings.exposure));
        let mut bytes = Vec::with_capacity(3 * self.pixels.len());
        for pixels in self.pixels.chunks(STEP) {
            let mut rows = [[0.0; STEP]; 3];
            for (lane, pixel) in pixels.iter().enumerate() {
                (rows[0][lane], rows[1][lane], rows[2][lane]) = (pixel.x, pixel.y, pixel.z);
            }
            let color = load(token, &rows) * gain;
            let color = encode(token, color, self.settings.tone);
            color.x.store(&mut rows[0]);
            color.y.store(&mut rows[1]);
            color.z.store(&mut rows[2]);
            for lane in 0..pixels.len() {
                bytes.extend([rows[0][lane] as u8, rows[1][lane] as u8, rows[2][lane] as u8]);
            }
        }
        bytes
    }
}

#[inline(always)]
fn load<S: Simd>(token: S, [red, green, blue]: &[[f32; STEP]; 3]) -> Vec3<S::F32x16> {
    Vec3::new(S::F32x16::load(token, red), S::F32x16::load(token, green), S::F32x16::load(token, blue))
}

/// Display colours from linear ones, 0 to 255, to be truncated.
#[inline(always)]
fn encode<F: F32Lanes>(token: F::Token, color: Vec3<F>, tone: Tone) -> Vec3<F> {
    let color = if tone == Tone::Reinhard { compressed(token, color) } else { color };
    let linear = tone == Tone::Linear;
    Vec3::new(quantized(token, color.x, linear), quantized(token, color.y, linear), quantized(token, color.z, linear))
}

/// Reinhard et al. 2002, equation 3, by luminance of linear sRGB (Rec. 709).
#[inline(always)]
fn compressed<F: F32Lanes>(token: F::Token, color: Vec3<F>) -> Vec3<F> {
    let weights = Vec3::new(F::splat(token, 0.2126), F::splat(token, 0.7152), F::splat(token, 0.0722));
    color / (F::splat(token, 1.0) + color.dot(weights))
}

/// One component clamped, transferred and scaled; NaN gives 0.
#[inline(always)]
fn quantized<F: F32Lanes>(token: F::Token, component: F, linear: bool) -> F {
    // `max` passes over a NaN in its first operand.
    let clamped = component.max(F::splat(token, 0.0)).min(F::splat(token, 1.0));
    let encoded = if linear { clamped } else { srgb_transfer(token, clamped) };
    encoded * F::splat(token, 255.0) + F::splat(token, 0.5)
}

/// The sRGB transfer function (IEC 61966-2-1) on [0, 1].
#[inline(always)]
fn srgb_transfer<F: F32Lanes>(token: F::Token, a: F) -> F {
    let power = simd::math::lanes::pow(token, a, F::splat(token, 1.0 / 2.4));
    let curve = power * F::splat(token, 1.055) - F::splat(token, 0.055);
    F::select(a.le(F::splat(token, 0.003_130_8)), a * F::splat(token, 12.92), curve)
}
