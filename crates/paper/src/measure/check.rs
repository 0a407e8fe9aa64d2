//! What a variant computed, beside what it must compute.

use super::Contestant;
use serde::Serialize;
use whitted::math::Vec3f;
use whitted::render::{Frame, PixelRect};

/// The pixels of one variant in one scene beside the default's.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// The variant.
    pub variant: String,
    /// True if it is one of the paper's.
    pub of_paper: bool,
    /// The scene.
    pub scene: String,
    /// Pixels that were compared.
    pub pixels: usize,
    /// Of these, pixels in which any bit differs.
    pub differing: usize,
    /// The largest difference of a colour component, in 1/255 of white.
    pub largest: f64,
    /// The most pixels that may differ.
    pub allowed: usize,
}

/// How much a variant may differ from the default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bound {
    /// Not in a single bit.
    Equal,
    /// In this part of the pixels.
    Part(f64),
}

impl Check {
    /// Whether it computed what it must.
    pub fn holds(&self) -> bool {
        self.differing <= self.allowed
    }

    /// Takes in another part of the same picture.
    pub(crate) fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.differing += other.differing;
        self.allowed += other.allowed;
        self.largest = self.largest.max(other.largest);
    }
}

/// The whole picture by the default renderer.
pub(crate) struct Reference {
    pub(crate) frame: Frame,
}

impl Reference {
    /// Compares the pixels of `rect` with the same of the default's.
    pub(crate) fn check(&self, contestant: &Contestant, scene: &str, rect: &PixelRect, pixels: &[Vec3f]) -> Check {
        let own = rect.pixels().map(|pixel| self.frame.image.pixels[self.frame.rect.index(pixel)]);
        let (mut differing, mut largest) = (0, 0.0_f64);
        for (own, other) in own.zip(pixels) {
            differing += usize::from(bits(own) != bits(*other));
            largest = largest.max(difference(own, *other));
        }
        let allowed = match contestant.bound {
            Bound::Equal => 0,
            Bound::Part(part) => (part * rect.len() as f64).ceil() as usize,
        };
        let Contestant { name, of_paper, .. } = contestant;
        let (variant, scene) = (name.clone(), scene.to_owned());
        Check { variant, of_paper: *of_paper, scene, pixels: rect.len(), differing, largest, allowed }
    }
}

fn bits(color: Vec3f) -> [u32; 3] {
    color.to_array().map(f32::to_bits)
}

/// The largest difference of a component in 1/255 of white.
fn difference(a: Vec3f, b: Vec3f) -> f64 {
    const STEPS: f64 = 255.0;
    let apart = a.to_array().into_iter().zip(b.to_array()).map(|(a, b)| f64::from((a - b).abs()));
    STEPS * apart.fold(0.0, f64::max)
}
