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

/// `DIVIDED[n]` is a 2⁻¹⁶th of what divides by `n`: exact for sums of up to three bytes.
const DIVIDED: [u32; 4] = [0, 1 << 16, 1 << 15, (1 << 16) / 3 + 1];

/// The brightness of a small picture, as it is and smoothed, row by row.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    bright: Vec<i16>,
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
        Self { bright, smooth, width }
    }

    /// As it is, and smoothed.
    fn row(&self, y: usize) -> [&[i16]; 2] {
        [&self.bright, &self.smooth].map(|all| &all[y * self.width..][..self.width])
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
        let ([bright_above, above], [bright_below, below]) = (outline.row(low), outline.row(high));
        let four =
            |above: &[i16], below: &[i16], x: usize| [above[x], above[x + 1], below[x], below[x + 1]].map(i32::from);
        for x in 0..upper.len() - 1 {
            let bright = four(bright_above, bright_below, x);
            let range = Range::of(bright);
            if range.high - range.low >= STEP {
                self.found.push((x, range.corners(bright, four(above, below, x))));
                let step = range.step([upper[x], upper[x + 1], lower[x], lower[x + 1]], bright);
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

    fn corners(self, bright: [i32; 4], smooth: [i32; 4]) -> Corners {
        let share = bright.map(|bright| u32::from(self.is_bright(bright)) * UNIT);
        // One division for all four.
        let units = (UNIT << 16).div_ceil((self.high - self.low) as u32);
        let mut level = smooth.map(|smooth| ((smooth.clamp(self.low, self.high) - self.low) as u32 * units) >> 16);
        // Half of it as it is: lines as thin as a pixel would vanish.
        level.iter_mut().zip(share).for_each(|(level, share)| *level = (*level + share) / 2);
        Corners { share, level }
    }

    /// The mean of the bright corners less that of the dark ones: red, green, blue.
    fn step(self, corners: [u32; 4], bright: [i32; 4]) -> [i32; 3] {
        let (mut count, mut all, mut brights) = (0, [0; 2], [0; 2]);
        for (corner, bright) in corners.into_iter().zip(bright) {
            let is_bright = u32::from(self.is_bright(bright));
            count += is_bright as usize;
            // Red and blue in one word: sums of four bytes do not meet.
            for (axis, parts) in [corner & 0x00ff_00ff, corner >> 8 & 0xff].into_iter().enumerate() {
                all[axis] += parts;
                brights[axis] += parts * is_bright;
            }
        }
        let mean = |sum: u32, count: usize| ((sum * DIVIDED[count]) >> 16) as i32;
        let step = |all: u32, bright: u32| mean(bright, count) - mean(all - bright, 4 - count);
        let [red, blue] = [16, 0].map(|shift| step(all[0] >> shift & 0xffff, brights[0] >> shift & 0xffff));
        [red, step(all[1], brights[1]), blue]
    }
}
