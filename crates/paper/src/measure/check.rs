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
        let (differing, largest) = compare(own, pixels);
        let allowed = match contestant.bound {
            Bound::Equal => 0,
            Bound::Part(part) => (part * rect.len() as f64).ceil() as usize,
        };
        let Contestant { name, of_paper, .. } = contestant;
        let (variant, scene) = (name.clone(), scene.to_owned());
        Check { variant, of_paper: *of_paper, scene, pixels: rect.len(), differing, largest, allowed }
    }
}

/// In how many pixels any bit differs, those that only one side has included, and the largest difference.
fn compare(expected: impl Iterator<Item = Vec3f>, found: &[Vec3f]) -> (usize, f64) {
    let (mut found, mut differing, mut largest) = (found.iter(), 0, 0.0_f64);
    for own in expected {
        let other = found.next();
        differing += usize::from(other.is_none_or(|other| bits(own) != bits(*other)));
        largest = other.map_or(largest, |other| largest.max(difference(own, *other)));
    }
    (differing + found.len(), largest)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_counts_and_every_pixel() {
        let (black, red) = (Vec3f::ZERO, Vec3f::new(1.0, 0.0, 0.0));
        let expected = [black, red, red];
        let compare = |found: &[Vec3f]| compare(expected.into_iter(), found);
        assert_eq!(compare(&expected), (0, 0.0));
        assert_eq!(compare(&[-black, red, red]), (1, 0.0), "another zero is another picture");
        assert_eq!(compare(&[black, red, Vec3f::new(1.0, 0.2, 0.0)]), (1, 255.0 * f64::from(0.2_f32)));
        assert_eq!(compare(&[black, red, Vec3f::splat(f32::NAN)]).0, 1);
        assert_eq!(compare(&expected[..1]).0, 2, "what is missing is wrong");
        assert_eq!(compare(&[black, red, red, red]).0, 1, "what is too much is wrong");
    }

    #[test]
    fn parts_of_a_picture_add_up_to_what_is_allowed() {
        let part = |differing| Check {
            variant: String::new(),
            of_paper: true,
            scene: String::new(),
            pixels: 10,
            differing,
            largest: 0.0,
            allowed: 1,
        };
        let mut check = part(2);
        assert!(!check.holds());
        check.add(&part(0));
        assert!(check.holds() && (check.pixels, check.allowed) == (20, 2));
        check.add(&part(2));
        assert!(!check.holds());
    }
}
