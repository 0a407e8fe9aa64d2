//! The picture in memory.

use crate::math::Vec3f;
use crate::scene::{Settings, Tone};

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

    /// Eight bits per component, RGB row by row, by the exposure and tone curve of `settings`.
    pub fn to_rgb8(&self, settings: &Settings) -> Vec<u8> {
        let gain = simd::math::exp2(settings.exposure);
        self.pixels.iter().flat_map(|&color| encode(color * gain, settings.tone).to_array()).collect()
    }
}

/// One display colour from one linear colour; NaN gives 0.
fn encode(color: Vec3f, tone: Tone) -> crate::math::Vec3<u8> {
    let color = match tone {
        Tone::Clamp | Tone::Linear => color,
        Tone::Reinhard => {
            // Luminance of linear sRGB (Rec. 709).
            let luminance = color.dot(Vec3f::new(0.2126, 0.7152, 0.0722));
            color / (1.0 + luminance)
        }
    };
    let transfer = if tone == Tone::Linear { |a| a } else { srgb_transfer };
    color.map(|a| {
        let clamped = if a > 0.0 { a.min(1.0) } else { 0.0 };
        (transfer(clamped) * 255.0 + 0.5) as u8
    })
}

/// The sRGB transfer function (IEC 61966-2-1) on [0, 1].
fn srgb_transfer(a: f32) -> f32 {
    if a <= 0.003_130_8 { a * 12.92 } else { 1.055 * simd::math::pow(a, 1.0 / 2.4) - 0.055 }
}
