//! Where the pictures of two surfaces meet.
//!
//! Bilinear interpolation spreads an edge over a whole pixel of the small picture. Where the four pixels around a place
//! fall into a dark and a bright group, the line at which it gives as much of the one as of the other is a good guess of
//! the edge. It is a better one if the groups are smoothed first: else it follows the stairs of the small picture. The
//! step between the groups is made at that line, and added to what is bilinear: so nothing jumps between one cell of four
//! pixels and the next.

use super::UNIT;

/// The least step, in brightness from 0 to four times 255, that is an edge.
const STEP: i32 = 48;

/// The brightness of a small picture, smoothed, row by row.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    smooth: Vec<i16>,
    width: usize,
}

impl Outline {
    /// That of a picture of this width.
    pub(super) fn new(pixels: &[u32], width: usize) -> Self {
        let bright: Vec<i16> = pixels.iter().map(|&pixel| brightness(pixel) as i16).collect();
        let last = bright.len() / width - 1;
        let row = |y: usize| &bright[y * width..][..width];
        let mut down = vec![0; width];
        let mut smooth = vec![0; bright.len()];
        for (y, out) in smooth.chunks_exact_mut(width).enumerate() {
            let rows = row(y.saturating_sub(1)).iter().zip(row(y)).zip(row((y + 1).min(last)));
            down.iter_mut().zip(rows).for_each(|(down, ((a, b), c))| *down = binomial(*a, *b, *c));
            out.copy_from_slice(&down);
            for (out, three) in out[1..].iter_mut().zip(down.windows(3)) {
                *out = binomial(three[0], three[1], three[2]);
            }
        }
        Self { smooth, width }
    }

    fn row(&self, y: usize) -> &[i16] {
        &self.smooth[y * self.width..][..self.width]
    }
}

fn binomial(a: i16, b: i16, c: i16) -> i16 {
    (a + 2 * b + c) / 4
}

/// How bright a pixel is, about: 0 to four times 255.
fn brightness(pixel: u32) -> i32 {
    component(pixel, 16) + 2 * component(pixel, 8) + component(pixel, 0)
}

fn component(pixel: u32, shift: usize) -> i32 {
    (pixel >> shift & 0xff) as i32
}

/// The cells between two rows of a small picture, column by column.
#[derive(Clone, Debug, Default)]
pub(super) struct Edges {
    /// The columns in which there is an edge, with its corners.
    found: Vec<(usize, Corners)>,
    /// The step from dark to bright, red, green and blue, in two's complement; zero where there is no edge.
    pub(super) step: [Vec<u32>; 3],
    /// How bright the left and the right side of the cell are in the present row of the large picture, in [`UNIT`]s, in
    /// the lower and the upper half of the word: of whole pixels, and smoothed.
    pub(super) share: Vec<u32>,
    pub(super) level: Vec<u32>,
}

/// How bright the corners of a cell are, in [`UNIT`]s: upper left, upper right, lower left, lower right.
#[derive(Clone, Copy, Debug)]
struct Corners {
    share: [u32; 4],
    level: [u32; 4],
}

impl Edges {
    /// Find the edges between two rows of a picture; none without an outline.
    pub(super) fn find(&mut self, [upper, lower]: [&[u32]; 2], outline: &Outline, [low, high]: [usize; 2]) {
        self.clear(upper.len());
        if outline.smooth.is_empty() {
            return;
        }
        let (above, below) = (outline.row(low), outline.row(high));
        for x in 0..upper.len() - 1 {
            let corners = [upper[x], upper[x + 1], lower[x], lower[x + 1]];
            let bright = corners.map(brightness);
            let range = Range::of(bright);
            if range.high - range.low >= STEP {
                let smooth = [above[x], above[x + 1], below[x], below[x + 1]];
                self.found.push((x, range.corners(bright, smooth)));
                let step = range.step(corners, bright);
                self.step.iter_mut().zip(step).for_each(|(steps, step)| steps[x] = step as u32);
            }
        }
    }

    fn clear(&mut self, width: usize) {
        self.found.clear();
        for column in self.step.iter_mut().chain([&mut self.share, &mut self.level]) {
            column.clear();
            column.resize(width, 0);
        }
    }

    /// True if there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// Go to the row of the large picture that has this share of the lower corners.
    pub(super) fn cross(&mut self, share: u32) {
        let down = |upper: u32, lower: u32| (upper * (UNIT - share) + lower * share) / UNIT;
        let sides = |[a, b, c, d]: [u32; 4]| down(a, c) | down(b, d) << 16;
        for (x, corners) in &self.found {
            self.share[*x] = sides(corners.share);
            self.level[*x] = sides(corners.level);
        }
    }
}

/// The brightness of a cell: from dark to bright.
#[derive(Clone, Copy, Debug)]
struct Range {
    low: i32,
    high: i32,
}

impl Range {
    fn of([a, b, c, d]: [i32; 4]) -> Self {
        Self { low: a.min(b).min(c.min(d)), high: a.max(b).max(c.max(d)) }
    }

    fn is_bright(self, brightness: i32) -> bool {
        2 * brightness > self.low + self.high
    }

    fn corners(self, bright: [i32; 4], smooth: [i16; 4]) -> Corners {
        let share = bright.map(|bright| u32::from(self.is_bright(bright)) * UNIT);
        let mut level = smooth.map(|smooth| {
            let above = (i32::from(smooth) - self.low).clamp(0, self.high - self.low);
            above as u32 * UNIT / (self.high - self.low) as u32
        });
        // Half of it as it is: lines as thin as a pixel would vanish.
        level.iter_mut().zip(share).for_each(|(level, share)| *level = (*level + share) / 2);
        Corners { share, level }
    }

    /// The mean of the bright corners less that of the dark ones: red, green, blue.
    fn step(self, corners: [u32; 4], bright: [i32; 4]) -> [i32; 3] {
        let is_bright = bright.map(|bright| self.is_bright(bright));
        let count = is_bright.iter().filter(|&&is| is).count() as i32;
        [16, 8, 0].map(|shift| {
            let mut sums = [0; 2];
            corners.iter().zip(is_bright).for_each(|(corner, is)| sums[usize::from(is)] += component(*corner, shift));
            sums[1] / count - sums[0] / (4 - count)
        })
    }
}
