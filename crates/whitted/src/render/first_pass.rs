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
    /// Empty if only colours are kept.
    samples: Vec<FirstSample>,
}

/// Memory of a pass that is over.
#[derive(Debug, Default)]
pub(super) struct Spare {
    pub(super) colors: Vec<Vec3f>,
    pub(super) samples: Vec<FirstSample>,
}

impl FirstPass {
    /// A pass over `rect` that has seen nothing yet; it keeps no more than colours unless `keeps_samples`.
    pub(super) fn new(rect: PixelRect, keeps_samples: bool, spare: Spare) -> Self {
        let samples = if keeps_samples { rect.len() } else { 0 };
        let Spare { colors, samples: spare } = spare;
        Self {
            rect,
            colors: filled(colors, rect.len(), Vec3f::ZERO),
            samples: filled(spare, samples, FirstSample::NOTHING),
        }
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
        let mut samples = self.samples.chunks_mut(width);
        let row = |colors| Mutex::new(Row { colors, samples: samples.next().unwrap_or_default() });
        PassRows { rect: self.rect, rows: self.colors.chunks_mut(width).map(row).collect() }
    }

    /// The colours and the samples of `rect`, which lies in the rectangle, row by row.
    pub(super) fn into_part(self, rect: &PixelRect) -> (Vec<Vec3f>, Vec<FirstSample>) {
        if self.rect == *rect {
            return (self.colors, self.samples);
        }
        let samples = if self.samples.is_empty() { Vec::new() } else { cut(&self.samples, &self.rect, rect) };
        (cut(&self.colors, &self.rect, rect), samples)
    }
}

/// `len` copies of a value, in `memory` if that is large enough, else in large pages: pages of the usual size cost as much as
/// tracing simple pictures.
fn filled<T: Copy>(mut memory: Vec<T>, len: usize, value: T) -> Vec<T> {
    memory.clear();
    if memory.capacity() < len {
        memory = Vec::with_capacity(len);
        advise_huge_pages(memory.spare_capacity_mut());
    }
    memory.resize(len, value);
    memory
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
    /// Fill in colours and samples of `part`, which lies in the rectangle, given row by row; samples only if they are kept.
    pub(super) fn set(&self, part: &PixelRect, colors: &[Vec3f], samples: &[FirstSample]) {
        let (left, width) = ((part.x - self.rect.x) as usize, part.width as usize);
        let mut samples = samples.chunks_exact(width);
        for (y, colors) in (part.y - self.rect.y..).zip(colors.chunks_exact(width)) {
            // A panic elsewhere leaves the row usable: it holds plain numbers.
            let mut row = self.rows[y as usize].lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(samples) = samples.next() {
                row.samples[left..left + width].copy_from_slice(samples);
            }
            row.colors[left..left + width].copy_from_slice(colors);
        }
    }
}
