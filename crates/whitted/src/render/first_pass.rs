//! What the first sample of every pixel saw.

use super::region::PixelRect;
use crate::math::Vec3f;
use crate::ray::NONE;

/// What the first sample of a pixel saw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstSample {
    /// Its linear colour.
    pub color: Vec3f,
    /// Object (mesh, sphere, shape or plane, numbered in this order), or [`NONE`].
    pub object: u32,
    /// Shading normal on the side of the viewer; zero where nothing was hit.
    pub normal: Vec3f,
    /// Distance from the eye in scene units; infinite where nothing was hit.
    pub depth: f32,
    /// True if a secondary ray was cut by its weight before the depth limit: the paper's figure 3.
    pub cut: bool,
}

impl FirstSample {
    /// A sample that saw nothing, in black.
    pub(super) const NOTHING: Self =
        Self { color: Vec3f::ZERO, object: NONE, normal: Vec3f::ZERO, depth: f32::INFINITY, cut: false };
}

/// The first samples of a rectangle of pixels.
#[derive(Debug)]
pub(super) struct FirstPass {
    rect: PixelRect,
    samples: Vec<FirstSample>,
}

impl FirstPass {
    /// A pass over `rect` that has seen nothing yet.
    pub(super) fn new(rect: PixelRect) -> Self {
        Self { rect, samples: vec![FirstSample::NOTHING; rect.len()] }
    }

    /// The pixels that it covers.
    pub(super) fn rect(&self) -> PixelRect {
        self.rect
    }

    /// The first sample of `pixel`, which must lie in the rectangle.
    pub(super) fn get(&self, pixel: [u32; 2]) -> &FirstSample {
        &self.samples[self.rect.index(pixel)]
    }

    /// Fill in the samples of a region, given row by row.
    pub(super) fn set(&mut self, region: &PixelRect, samples: &[FirstSample]) {
        for (y, row) in samples.chunks_exact(region.width as usize).enumerate() {
            let start = self.rect.index([region.x, region.y + y as u32]);
            self.samples[start..start + row.len()].copy_from_slice(row);
        }
    }

    /// The samples of `rect`, which lies in the rectangle, row by row.
    pub(super) fn part(&self, rect: &PixelRect) -> Vec<FirstSample> {
        let row = |y| {
            let start = self.rect.index([rect.x, y]);
            &self.samples[start..start + rect.width as usize]
        };
        (rect.y..rect.y + rect.height).flat_map(row).copied().collect()
    }
}
