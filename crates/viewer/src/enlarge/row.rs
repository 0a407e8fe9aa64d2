//! A row of the large picture, sixteen pixels at a time.

use super::edges::Edges;
use super::{Places, UNIT};
use simd::{F32Lanes, Kernel, MaskLanes, Simd, U32Lanes};

type Words<S> = <<S as Simd>::F32x16 as F32Lanes>::U32;

/// Pixels in a step.
const WIDTH: usize = 16;

/// Red and blue of a pixel, and green moved down: each with eight bits of room above.
const TWO: u32 = 0x00ff_00ff;
const ONE: u32 = 0x0000_00ff;

/// Room for a row of the small picture, and one more pixel.
#[derive(Clone, Debug, Default)]
pub(super) struct Row(Vec<u32>);

impl Row {
    /// A kernel that fills `out`, which lies between two rows of the small picture with this share of the lower one.
    pub(super) fn fill<'a>(
        &'a mut self,
        pair: [&'a [u32]; 2],
        share: u32,
        columns: &'a Places,
        edges: &'a Edges,
        sharpness: u32,
        out: &'a mut [u32],
    ) -> Fill<'a> {
        // Behind the last pixel is nothing of which there could be a share.
        self.0.resize(pair[0].len() + 1, 0);
        Fill { mixed: &mut self.0, pair, share, columns, edges, sharpness, out }
    }
}

/// Fills a row.
pub(super) struct Fill<'a> {
    mixed: &'a mut [u32],
    pair: [&'a [u32]; 2],
    share: u32,
    columns: &'a Places,
    edges: &'a Edges,
    sharpness: u32,
    out: &'a mut [u32],
}

impl Kernel for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let [upper, lower] = self.pair;
        let width = upper.len();
        let share = Words::<S>::splat(token, self.share);
        let mut x = 0;
        while x < width {
            let (a, b) = (load::<S>(token, upper, x), load::<S>(token, lower, x));
            store::<S>(mix::<S>(token, a, b, share), self.mixed, x, width);
            x += WIDTH;
        }
        let length = self.out.len();
        let mut x = 0;
        while x < length {
            let low = load::<S>(token, &self.columns.low, x);
            let share = load::<S>(token, &self.columns.share, x);
            let next = low + Words::<S>::splat(token, 1);
            let (a, b) = (Words::<S>::gather(self.mixed, low), Words::<S>::gather(self.mixed, next));
            let mut pixels = mix::<S>(token, a, b, share);
            if !self.edges.is_empty() {
                pixels = sharpened::<S>(token, pixels, low, share, self.edges, self.sharpness);
            }
            store::<S>(pixels, self.out, x, length);
            x += WIDTH;
        }
    }
}

/// Sixteen words from `at` on; behind the end, zeros.
#[inline(always)]
fn load<S: Simd>(token: S, from: &[u32], at: usize) -> Words<S> {
    if at + WIDTH <= from.len() {
        return Words::<S>::load_slice(token, &from[at..]);
    }
    let mut last = [0; WIDTH];
    last[..from.len() - at].copy_from_slice(&from[at..]);
    Words::<S>::load(token, &last)
}

/// Write words from `at` on, as far as there is room before `end`.
#[inline(always)]
fn store<S: Simd>(words: Words<S>, to: &mut [u32], at: usize, end: usize) {
    if at + WIDTH <= end {
        words.store_slice(&mut to[at..]);
        return;
    }
    let mut last = [0; WIDTH];
    words.store(&mut last);
    to[at..end].copy_from_slice(&last[..end - at]);
}

/// `a` and `b` by shares; `share` of [`UNIT`] is that of `b`.
#[inline(always)]
fn mix<S: Simd>(token: S, a: Words<S>, b: Words<S>, share: Words<S>) -> Words<S> {
    let rest = Words::<S>::splat(token, UNIT) - share;
    let (two, one) = (Words::<S>::splat(token, TWO), Words::<S>::splat(token, ONE));
    let red_blue = ((a & two) * rest + (b & two) * share).shr::<8>() & two;
    let green = ((a.shr::<8>() & one) * rest + (b.shr::<8>() & one) * share).shr::<8>() & one;
    red_blue | green.shl::<8>()
}

/// The pixels with the steps of the edges in whose cells they lie.
#[inline(always)]
fn sharpened<S: Simd>(
    token: S,
    pixels: Words<S>,
    cell: Words<S>,
    across: Words<S>,
    edges: &Edges,
    sharpness: u32,
) -> Words<S> {
    let sides = Words::<S>::gather(&edges.level, cell);
    let zero = Words::<S>::splat(token, 0);
    // Cells without an edge have no steps either.
    if zero.lt(sides).bits() == 0 {
        return pixels;
    }
    let share = between::<S>(token, Words::<S>::gather(&edges.share, cell), across);
    let level = between::<S>(token, sides, across);
    let half = Words::<S>::splat(token, UNIT / 2);
    let steep = half + (level - half) * Words::<S>::splat(token, sharpness);
    let change = clamped::<S>(token, steep, UNIT) - share;
    let red = stepped::<S>(token, pixels.shr::<16>(), change, &edges.step[0], cell);
    let green = stepped::<S>(token, pixels.shr::<8>(), change, &edges.step[1], cell);
    let blue = stepped::<S>(token, pixels, change, &edges.step[2], cell);
    red.shl::<16>() | green.shl::<8>() | blue
}

/// Between the left side, in the lower half of a word, and the right side, in the upper half.
#[inline(always)]
fn between<S: Simd>(token: S, sides: Words<S>, share: Words<S>) -> Words<S> {
    let left = sides & Words::<S>::splat(token, 0xffff);
    let unit = Words::<S>::splat(token, UNIT);
    (left * (unit - share) + sides.shr::<16>() * share).shr::<8>()
}

/// The lowest component of the pixels, with a part of a step.
#[inline(always)]
fn stepped<S: Simd>(token: S, pixels: Words<S>, part: Words<S>, steps: &[u32], cell: Words<S>) -> Words<S> {
    let component = pixels & Words::<S>::splat(token, ONE);
    let step = Words::<S>::gather(steps, cell);
    clamped::<S>(token, component + (part * step).sar::<8>(), ONE)
}

/// From 0 to `most`, taken as numbers with a sign.
#[inline(always)]
fn clamped<S: Simd>(token: S, value: Words<S>, most: u32) -> Words<S> {
    let most = Words::<S>::splat(token, most);
    let positive = value & !value.sar::<31>();
    let is_more = (most - positive).sar::<31>();
    (positive & !is_more) | (most & is_more)
}
