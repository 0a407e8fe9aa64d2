//! Rectangles of pixels, and the division of a picture into regions.

use super::execution::Region;
use std::ops::Range;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
}

impl PixelRect {
    /// The whole of a picture of this size.
    pub const fn whole([width, height]: [u32; 2]) -> Self {
        Self { x: 0, y: 0, width, height }
    }

    /// Number of pixels.
    pub fn len(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// True if there are no pixels.
    pub fn is_empty(&self) -> bool {
        self.width == 0 || self.height == 0
    }

    /// The rectangle without pixels.
    pub const EMPTY: Self = Self { x: 0, y: 0, width: 0, height: 0 };

    /// The pixels that both have; [`EMPTY`](Self::EMPTY) if there are none.
    pub fn intersection(&self, other: &Self) -> Self {
        let (x, width) = common(self.x, self.width, other.x, other.width);
        let (y, height) = common(self.y, self.height, other.y, other.height);
        let common = Self { x, y, width, height };
        if common.is_empty() { Self::EMPTY } else { common }
    }

    /// Row by row, the coordinates of every pixel.
    pub fn pixels(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let Self { x, y, width, height } = *self;
        (y..y + height).flat_map(move |y| (x..x + width).map(move |x| [x, y]))
    }

    /// Tile by tile, call `visit` with the coordinates of every pixel: rays in this order have close neighbours, and the
    /// 64 of a tile that is not cut off make a packet, often with those of its neighbours.
    pub(super) fn for_each_in_tiles(&self, mut visit: impl FnMut([u32; 2])) {
        self.for_each_row_of_tiles(|y, columns| columns.for_each(|x| visit([x, y])));
    }

    /// As [`for_each_in_tiles`](Self::for_each_in_tiles), the pixels of a row of a tile at once.
    pub(super) fn for_each_row_of_tiles(&self, mut visit: impl FnMut(u32, Range<u32>)) {
        let (right, bottom) = (self.x + self.width, self.y + self.height);
        for top in (self.y..bottom).step_by(TILE) {
            for left in (self.x..right).step_by(TILE) {
                for y in top..bottom.min(top + TILE as u32) {
                    visit(y, left..right.min(left + TILE as u32));
                }
            }
        }
    }

    /// Rectangles of at most `at_most` ≥ 1 pixels that together are this one.
    pub(super) fn parts(&self, at_most: usize) -> Vec<Self> {
        let at_most = at_most.min(u32::MAX as usize) as u32;
        let width = self.width.clamp(1, at_most);
        self.regions(Region::Rectangle(width, at_most / width))
    }

    /// Position of a pixel of this rectangle in row-major order.
    pub fn index(&self, [x, y]: [u32; 2]) -> usize {
        (y - self.y) as usize * self.width as usize + (x - self.x) as usize
    }

    /// True if the pixel lies in the rectangle.
    pub fn contains(&self, [x, y]: [u32; 2]) -> bool {
        x >= self.x && x - self.x < self.width && y >= self.y && y - self.y < self.height
    }

    /// The rectangle with a margin of one pixel, as far as it lies within a picture of this size.
    pub(super) fn with_apron(&self, size: [u32; 2]) -> Self {
        let (x, y) = (self.x.saturating_sub(1), self.y.saturating_sub(1));
        let right = self.x.saturating_add(self.width).saturating_add(1);
        let bottom = self.y.saturating_add(self.height).saturating_add(1);
        Self { x, y, width: right - x, height: bottom - y }.intersection(&Self::whole(size))
    }

    /// The rectangles that make this one `outer`, which contains it: above, below, left and right.
    pub(super) fn strips_to(&self, outer: &Self) -> [Self; 4] {
        let (below, right) = (self.y + self.height, self.x + self.width);
        let (above, left) = (self.y - outer.y, self.x - outer.x);
        [
            Self { height: above, ..*outer },
            Self { y: below, height: outer.y + outer.height - below, ..*outer },
            Self { x: outer.x, width: left, ..*self },
            Self { x: right, width: outer.x + outer.width - right, ..*self },
        ]
    }

    /// The regions of this rectangle, row by row. They do not overlap and leave nothing out.
    pub fn regions(&self, region: Region) -> Vec<Self> {
        let [width, height] = match region {
            Region::Rectangle(width, height) => [width.max(1), height.max(1)],
            Region::Scanline => [self.width.max(1), 1],
            Region::Frame => [self.width.max(1), self.height.max(1)],
        };
        if self.is_empty() {
            return Vec::new();
        }
        let starts = |first: u32, len: u32, step: u32| (first..first + len).step_by(step as usize);
        starts(self.y, self.height, height)
            .flat_map(|y| starts(self.x, self.width, width).map(move |x| Self { x, y, width, height }))
            .map(|rect| rect.intersection(self))
            .collect()
    }
}

/// Side of a tile in pixels.
const TILE: usize = 8;

/// Start and length of the common part of two ranges given by start and length.
fn common(a: u32, a_len: u32, b: u32, b_len: u32) -> (u32, u32) {
    let start = a.max(b);
    let end = a.saturating_add(a_len).min(b.saturating_add(b_len));
    (start, end.saturating_sub(start))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_cover_each_pixel_once() {
        let rect = PixelRect { x: 3, y: 5, width: 70, height: 33 };
        let kinds = [Region::Rectangle(64, 64), Region::Rectangle(1, 1), Region::Rectangle(7, 200), Region::Scanline];
        for kind in kinds.into_iter().chain([Region::Frame, Region::Rectangle(0, u32::MAX)]) {
            let mut seen = vec![0; rect.len()];
            let regions = rect.regions(kind);
            regions.iter().flat_map(PixelRect::pixels).for_each(|pixel| seen[rect.index(pixel)] += 1);
            assert!(seen.iter().all(|&times| times == 1), "{kind:?}");
        }
        assert!(PixelRect { width: 0, ..rect }.regions(Region::Frame).is_empty());
    }

    #[test]
    fn tiles_and_parts_cover_each_pixel_once() {
        let rect = PixelRect { x: 3, y: 5, width: 70, height: 33 };
        for at_most in [1, 7, 64, 69, 70, 71, 4096] {
            let mut seen = vec![0; rect.len()];
            for part in rect.parts(at_most) {
                assert!(part.len() <= at_most, "{part:?}");
                part.for_each_in_tiles(|pixel| seen[rect.index(pixel)] += 1);
            }
            assert!(seen.iter().all(|&times| times == 1), "{at_most}");
        }
    }

    #[test]
    fn aprons_stay_within_the_picture() {
        let rect = PixelRect { x: 0, y: 4, width: 3, height: 6 };
        assert_eq!(rect.with_apron([10, 10]), PixelRect { x: 0, y: 3, width: 4, height: 7 });
    }

    #[test]
    fn strips_and_rectangle_cover_the_outer_one() {
        let rect = PixelRect { x: 2, y: 4, width: 3, height: 5 };
        let outer = rect.with_apron([5, 20]);
        let mut seen = vec![0; outer.len()];
        let parts = rect.strips_to(&outer).into_iter().chain([rect]);
        parts.flat_map(|part| part.pixels()).for_each(|pixel| seen[outer.index(pixel)] += 1);
        assert!(seen.iter().all(|&times| times == 1));
    }

    #[test]
    fn far_apart_rectangles_share_nothing() {
        let a = PixelRect { x: 0, y: 0, width: 4, height: 4 };
        let b = PixelRect { x: u32::MAX, y: 2, width: u32::MAX, height: 4 };
        assert_eq!(a.intersection(&b), PixelRect::EMPTY);
    }
}
