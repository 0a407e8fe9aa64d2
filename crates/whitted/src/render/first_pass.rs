//! What the first sample of every pixel saw.

use super::region::PixelRect;
use crate::math::Vec3f;
use crate::ray::NONE;
use simd::advise_huge_pages;
use std::sync::{Mutex, PoisonError};

/// What the first sample of a pixel saw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstSample {
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
    /// A sample that saw nothing.
    pub(super) const NOTHING: Self = Self { object: NONE, normal: Vec3f::ZERO, depth: f32::INFINITY, cut: false };
}

/// The first samples of a rectangle of pixels, row by row.
#[derive(Debug)]
pub(super) struct FirstPass {
    rect: PixelRect,
    colors: Vec<Vec3f>,
    samples: Vec<FirstSample>,
}

impl FirstPass {
    /// A pass over `rect` that has seen nothing yet.
    pub(super) fn new(rect: PixelRect) -> Self {
        Self { rect, colors: filled(rect.len(), Vec3f::ZERO), samples: filled(rect.len(), FirstSample::NOTHING) }
    }

    /// The pixels that it covers.
    pub(super) fn rect(&self) -> PixelRect {
        self.rect
    }

    /// The first sample of `pixel`, which must lie in the rectangle.
    pub(super) fn get(&self, pixel: [u32; 2]) -> &FirstSample {
        &self.samples[self.rect.index(pixel)]
    }

    /// The linear colour of the first sample of `pixel`, which must lie in the rectangle.
    pub(super) fn color(&self, pixel: [u32; 2]) -> Vec3f {
        self.colors[self.rect.index(pixel)]
    }

    /// Open it for threads to write.
    pub(super) fn rows(&mut self) -> PassRows<'_> {
        // Not zero, which has no chunks: there are no rows then either.
        let width = self.rect.width.max(1) as usize;
        let rows = self.colors.chunks_mut(width).zip(self.samples.chunks_mut(width));
        PassRows { rect: self.rect, rows: rows.map(|(colors, samples)| Mutex::new(Row { colors, samples })).collect() }
    }

    /// The colours and the samples of `rect`, which lies in the rectangle, row by row.
    pub(super) fn into_part(self, rect: &PixelRect) -> (Vec<Vec3f>, Vec<FirstSample>) {
        if self.rect == *rect {
            return (self.colors, self.samples);
        }
        (cut(&self.colors, &self.rect, rect), cut(&self.samples, &self.rect, rect))
    }
}

/// `len` copies of a value in large pages: pages of the usual size cost as much as tracing simple pictures.
fn filled<T: Copy>(len: usize, value: T) -> Vec<T> {
    let mut all = Vec::with_capacity(len);
    advise_huge_pages(all.spare_capacity_mut());
    all.resize(len, value);
    all
}

/// The part of `all`, which covers `whole`, that covers `part`.
fn cut<T: Copy>(all: &[T], whole: &PixelRect, part: &PixelRect) -> Vec<T> {
    let row = |y| {
        let start = whole.index([part.x, y]);
        &all[start..start + part.width as usize]
    };
    (part.y..part.y + part.height).flat_map(row).copied().collect()
}

/// A pass that threads write, each row by one at a time.
#[derive(Debug)]
pub(super) struct PassRows<'a> {
    rect: PixelRect,
    rows: Vec<Mutex<Row<'a>>>,
}

#[derive(Debug)]
struct Row<'a> {
    colors: &'a mut [Vec3f],
    samples: &'a mut [FirstSample],
}

impl PassRows<'_> {
    /// Fill in colours and samples of `part`, which lies in the rectangle, given row by row.
    pub(super) fn set(&self, part: &PixelRect, colors: impl Iterator<Item = Vec3f>, samples: &[FirstSample]) {
        let (mut colors, width) = (colors, part.width as usize);
        let left = (part.x - self.rect.x) as usize;
        for (y, samples) in (part.y - self.rect.y..).zip(samples.chunks_exact(width)) {
            // A panic elsewhere leaves the row usable: it holds plain numbers.
            let mut row = self.rows[y as usize].lock().unwrap_or_else(PoisonError::into_inner);
            row.samples[left..left + width].copy_from_slice(samples);
            row.colors[left..left + width].iter_mut().zip(&mut colors).for_each(|(to, color)| *to = color);
        }
    }
}
