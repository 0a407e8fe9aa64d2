//! Which pixels are traced where all would take too long.

use std::collections::BTreeSet;
use whitted::render::{PixelRect, Region};

/// Some of a picture's pixels.
#[derive(Clone, Debug)]
pub(crate) struct Sample {
    /// Rectangles that do not overlap, row by row.
    pub(crate) rects: Vec<PixelRect>,
    /// The part of the picture's pixels in them.
    pub(crate) part: f64,
}

impl Sample {
    /// All pixels.
    pub(crate) fn whole(size: [u32; 2]) -> Self {
        Self { rects: vec![PixelRect::whole(size)], part: 1.0 }
    }

    /// About `part` of the pixels (0 to 1), at least one tile, in square tiles of `side` pixels that are spread evenly.
    pub(crate) fn tiles(size: [u32; 2], side: u32, part: f64) -> Self {
        Self::some(size, [side, side], part)
    }

    /// Height of a band, in pixels: that of the region that the paper finds best.
    pub(crate) const BAND: u32 = 64;

    /// As [`tiles`](Self::tiles), in bands as wide as the picture.
    pub(crate) fn bands(size: [u32; 2], part: f64) -> Self {
        Self::some(size, [size[0], Self::BAND], part)
    }

    fn some(size: [u32; 2], [width, height]: [u32; 2], part: f64) -> Self {
        let all = PixelRect::whole(size).regions(Region::Rectangle(width, height));
        let wanted = ((all.len() as f64 * part).ceil() as usize).max(1);
        if 2 * wanted > all.len() {
            return Self::whole(size);
        }
        let columns = size[0].div_ceil(width) as usize;
        let rows = all.len() / columns;
        let mut chosen = BTreeSet::new();
        for step in 0_u32.. {
            let [x, y] = spread(step);
            chosen.insert((y * rows as f64) as usize * columns + (x * columns as f64) as usize);
            if chosen.len() == wanted {
                break;
            }
        }
        let rects: Vec<PixelRect> = chosen.into_iter().map(|index| all[index]).collect();
        let traced: usize = rects.iter().map(PixelRect::len).sum();
        Self { part: traced as f64 / PixelRect::whole(size).len() as f64, rects }
    }
}

/// Points of the unit square that fill it evenly, however many are taken: the additive recurrence of the plastic number
/// (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
fn spread(step: u32) -> [f64; 2] {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];
    STEPS.map(|length| (0.5 + length * f64::from(step)).fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_apart_and_as_many_as_asked() {
        for (size, side, part) in [([640, 480], 4, 0.001), ([640, 480], 64, 0.2), ([10, 7], 4, 0.0), ([33, 65], 8, 0.3)]
        {
            let sample = Sample::tiles(size, side, part);
            let whole = PixelRect::whole(size);
            let mut seen = vec![false; whole.len()];
            for pixel in sample.rects.iter().flat_map(PixelRect::pixels) {
                assert!(!std::mem::replace(&mut seen[whole.index(pixel)], true), "{size:?}: {pixel:?} twice");
            }
            let traced = seen.iter().filter(|&&seen| seen).count();
            assert_eq!(sample.part, traced as f64 / whole.len() as f64);
            // Tiles at the right and lower edge are smaller, and there is always one.
            assert!(sample.part > 0.5 * part && sample.part < part.max(0.25) * 1.2, "{size:?}: {}", sample.part);
        }
    }

    #[test]
    fn bands_reach_across() {
        let Sample { rects, part } = Sample::bands([640, 480], 0.2);
        assert!(rects.iter().all(|rect| (rect.x, rect.width, rect.height) == (0, 640, 64)), "{rects:?}");
        assert_eq!((rects.len(), part), (2, 128.0 / 480.0));
    }

    #[test]
    fn more_than_half_is_all() {
        assert!(Sample::tiles([64, 64], 8, 0.6).part == 1.0);
        assert!(Sample::tiles([8, 8], 64, 0.01).part == 1.0);
    }
}
