//! Which pixels need more than one sample, decided by the finished first pass.

use super::first_pass::{FirstPass, FirstSample};
use super::region::PixelRect;
use crate::math::Vec3f;
use crate::scene::{Antialias, Settings};

/// The decision for a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeRule {
    antialias: Antialias,
    /// Factor of exposure.
    gain: f32,
}

/// Neighbours whose shading normals enclose a larger angle than 20° (by its cosine) lie across an edge.
const SMOOTH_COSINE: f32 = 0.94;

/// Neighbours one of which is farther by more than this factor lie across an edge.
const DEPTH_RATIO: f32 = 1.1;

/// Neighbours of which a component differs by more than this lie across an edge: of the square root of what the
/// display shows, which is near to equal steps for the eye. 1/16 is 16 of 255 steps.
const CONTRAST: f32 = 1.0 / 16.0;

impl EdgeRule {
    /// The rule of `settings`.
    pub(super) fn new(settings: &Settings) -> Self {
        Self { antialias: settings.antialias, gain: simd::math::exp2(settings.exposure) }
    }

    /// True if no pixel can need more samples.
    pub(super) fn never(&self) -> bool {
        matches!(self.antialias, Antialias::Off | Antialias::Uniform(0..=1))
    }

    /// True if the pixel needs more samples. Neighbours outside `pass` do not exist.
    pub(super) fn flags(&self, pass: &FirstPass, pixel: [u32; 2]) -> bool {
        let [x, y] = pixel;
        let differs = |x: u32, y: u32, rule: fn(&Self, &FirstPass, [u32; 2], [u32; 2]) -> bool| {
            pass.rect().contains([x, y]) && rule(self, pass, pixel, [x, y])
        };
        // Wrapped coordinates are outside every picture.
        let (left, up) = (x.wrapping_sub(1), y.wrapping_sub(1));
        match self.antialias {
            Antialias::Off => false,
            Antialias::Uniform(samples) => samples > 1,
            Antialias::Paper => differs(left, y, Self::object_switches) || differs(x, up, Self::object_switches),
            Antialias::Edge => {
                [(left, y), (x, up), (x + 1, y), (x, y + 1)].into_iter().any(|(x, y)| differs(x, y, Self::is_edge))
            }
        }
    }

    fn object_switches(&self, pass: &FirstPass, a: [u32; 2], b: [u32; 2]) -> bool {
        pass.get(a).object != pass.get(b).object
    }

    fn is_edge(&self, pass: &FirstPass, a: [u32; 2], b: [u32; 2]) -> bool {
        let bends_or_jumps = |a: &FirstSample, b: &FirstSample| bends(a, b) || jumps(a, b);
        self.object_switches(pass, a, b)
            || bends_or_jumps(pass.get(a), pass.get(b))
            || self.contrasts(pass.color(a), pass.color(b))
    }

    fn contrasts(&self, a: Vec3f, b: Vec3f) -> bool {
        let shown = |color: Vec3f| (color * self.gain).map(|c| c.min(1.0).sqrt());
        (shown(a) - shown(b)).abs().max_component() > CONTRAST
    }
}

/// The surface turns between the samples. False where both saw nothing: their normals are zero.
fn bends(a: &FirstSample, b: &FirstSample) -> bool {
    a.normal != b.normal && a.normal.dot(b.normal) < SMOOTH_COSINE
}

/// One sample is much farther than the other. False where both saw nothing: ∞ > ∞ is false.
fn jumps(a: &FirstSample, b: &FirstSample) -> bool {
    a.depth.max(b.depth) > a.depth.min(b.depth) * DEPTH_RATIO
}

/// The pixels of `rect` that `rule` flags, tile by tile: neighbours stay together.
pub(super) fn flagged(rule: &EdgeRule, pass: &FirstPass, rect: &PixelRect) -> Vec<[u32; 2]> {
    let mut flagged = Vec::new();
    rect.for_each_in_tiles(|pixel| {
        if rule.flags(pass, pixel) {
            flagged.push(pixel);
        }
    });
    flagged
}
