//! A small picture enlarged to the size of the window: bilinear between the middles of pixels, and sharp where two
//! surfaces meet.

mod edges;
mod row;

use edges::{Edges, Outline};
use rayon::prelude::*;
use row::Row;
use simd::Level;

/// Fixed-point unit of the weights: their product with a byte, squared, fits 32 bits.
const UNIT: u32 = 256;

/// A pixel as windows want it: `0x00RRGGBB`.
pub(crate) fn packed(rgb8: &[u8]) -> u32 {
    u32::from(rgb8[0]) << 16 | u32::from(rgb8[1]) << 8 | u32::from(rgb8[2])
}

/// All pixels of an RGB picture as windows want them.
pub(crate) fn pack(rgb8: &[u8]) -> Vec<u32> {
    rgb8.chunks_exact(3).map(packed).collect()
}

/// Where the rows or columns of the large picture lie in the small one: after pixel `low`, so near to the next one.
#[derive(Clone, Debug, Default, PartialEq)]
struct Places {
    low: Vec<u32>,
    /// In [`UNIT`]s; 0 behind the middle of the last pixel.
    share: Vec<u32>,
}

impl Places {
    fn new(from: u32, to: u32) -> Self {
        let ratio = f64::from(from) / f64::from(to);
        let last = from - 1;
        let place = |at: u32| {
            let x = ((f64::from(at) + 0.5) * ratio - 0.5).clamp(0.0, f64::from(last));
            (x as u32, (x.fract() * f64::from(UNIT)) as u32)
        };
        let (low, share) = (0..to).map(place).unzip();
        Self { low, share }
    }
}

/// `pixels` (`0x00RRGGBB`, row by row) of a picture of size `from` enlarged to size `to`, into `large`, whose memory is
/// used again; in the current rayon pool.
///
/// # Panics
/// If a side is 0 or there are not as many pixels as `from` says.
pub(crate) fn enlarge(pixels: &[u32], from: [u32; 2], to: [u32; 2], large: &mut Vec<u32>) {
    assert_eq!(pixels.len(), from[0] as usize * from[1] as usize, "the pixels of the small picture");
    large.resize(to[0] as usize * to[1] as usize, 0);
    let width = from[0] as usize;
    let sharpness = sharpness(from, to);
    let outline = if sharpness > 1 { Outline::new(pixels, width) } else { Outline::default() };
    let (columns, rows) = (Places::new(from[0], to[0]), Places::new(from[1], to[1]));
    let bands = bands(large, &rows, to[0] as usize);
    bands.into_par_iter().for_each_init(
        || (Row::default(), Edges::default()),
        |(row, edges), (out, shares, low)| {
            let high = (low + 1).min(from[1] as usize - 1);
            let pair = [low, high].map(|y| &pixels[y * width..][..width]);
            edges.find(pair, &outline, [low, high]);
            for (out, &share) in out.chunks_exact_mut(to[0] as usize).zip(shares) {
                edges.cross(share);
                simd::dispatch(Level::best(), row.fill(pair, share, &columns, edges, sharpness, out));
            }
        },
    );
}

/// Over how many pixels of the large picture one of the small one is spread, about: 1 if it is hardly enlarged.
fn sharpness(from: [u32; 2], to: [u32; 2]) -> u32 {
    let times = |axis: usize| (to[axis] + from[axis] / 2) / from[axis];
    times(0).max(times(1)).clamp(1, UNIT)
}

/// The rows of the large picture that lie after the same row of the small one, with their shares, and that row.
fn bands<'a>(mut large: &'a mut [u32], rows: &'a Places, width: usize) -> Vec<(&'a mut [u32], &'a [u32], usize)> {
    let mut shares = &rows.share[..];
    let mut bands = Vec::new();
    for same in rows.low.chunk_by(|a, b| a == b) {
        let (band, rest) = large.split_at_mut(same.len() * width);
        let (share, other_shares) = shares.split_at(same.len());
        bands.push((band, share, same[0] as usize));
        (large, shares) = (rest, other_shares);
    }
    bands
}

/// Fill `to` with the nearest pixels of `from`: for the moment between a new size and a picture of that size.
///
/// # Panics
/// If a side is 0 or there are not as many pixels as the sizes say.
#[cfg(feature = "window")]
pub(crate) fn stretch(from: &[u32], from_size: [u32; 2], to: &mut [u32], to_size: [u32; 2]) {
    let place = |at: usize, axis: usize| at * from_size[axis] as usize / to_size[axis] as usize;
    let columns: Vec<usize> = (0..to_size[0] as usize).map(|x| place(x, 0)).collect();
    for (y, row) in to.chunks_exact_mut(to_size[0] as usize).enumerate() {
        let source = &from[place(y, 1) * from_size[0] as usize..][..from_size[0] as usize];
        row.iter_mut().zip(&columns).for_each(|(to, &x)| *to = source[x]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn enlarged(pixels: &[u32], from: [u32; 2], to: [u32; 2]) -> Vec<u32> {
        let mut large = Vec::new();
        enlarge(pixels, from, to, &mut large);
        large
    }

    #[test]
    fn the_same_size_is_the_same_picture() {
        let pixels: Vec<u32> = (0..12).map(|i| i * 0x0001_0203).collect();
        assert_eq!(enlarged(&pixels, [4, 3], [4, 3]), pixels);
    }

    #[test]
    fn what_is_even_stays_so_and_corners_stay() {
        let even = vec![0x00fe_8001; 6];
        assert!(enlarged(&even, [3, 2], [37, 29]).iter().all(|&pixel| pixel == 0x00fe_8001));
        let corners = enlarged(&[0x00ff_0000, 0x0000_ff00, 0x0000_00ff, 0x00ff_ffff], [2, 2], [16, 16]);
        assert_eq!([corners[0], corners[15], corners[240], corners[255]], [0xff_0000, 0xff00, 0xff, 0xff_ffff]);
    }

    #[test]
    fn what_is_smooth_stays_smooth() {
        let line = enlarged(&[0x0060_6060, 0x0068_6868], [2, 1], [400, 1]);
        let values: Vec<u32> = line.iter().map(|pixel| pixel & 0xff).collect();
        assert!(values.is_sorted() && values.windows(2).all(|pair| pair[1] - pair[0] <= 1));
        assert!((0x63..=0x65).contains(&values[200]), "{}", values[200]);
        assert!(line.iter().all(|p| p >> 16 == p & 0xff && p >> 8 & 0xff == p & 0xff), "grey stays grey");
    }

    #[test]
    fn edges_stay_sharp() {
        let (dark, bright) = (0x0010_2030, 0x00e0_c0a0);
        for times in [2_u32, 4, 9] {
            let line = enlarged(&[dark, dark, bright, bright], [4, 1], [4 * times, 1]);
            let is_near = |pixel: u32, other: u32| (pixel & 0xff).abs_diff(other & 0xff) <= 2;
            let between = line.iter().filter(|&&pixel| !is_near(pixel, dark) && !is_near(pixel, bright)).count();
            assert!(between <= 2, "{times}: {line:x?}");
            let middle = line.iter().position(|&pixel| is_near(pixel, bright)).unwrap();
            assert!(middle.abs_diff(2 * times as usize) <= 1, "{times}: {line:x?}");
        }
    }

    #[test]
    fn a_slanted_edge_becomes_a_line() {
        // Bright above the line y = x / 2 + 1.
        let (small, times) = (16_u32, 4);
        let is_bright = |x: f32, y: f32| y < x / 2.0 + 1.0;
        let pixel =
            |i: u32| if is_bright((i % small) as f32 + 0.5, (i / small) as f32 + 0.5) { 0x00ff_ffff } else { 0 };
        let pixels: Vec<u32> = (0..small * small).map(pixel).collect();
        let size = small * times;
        let large = enlarged(&pixels, [small; 2], [size; 2]);
        let wrong = (0..size * size).filter(|i| {
            let place = |at: u32| (at as f32 + 0.5) / times as f32;
            is_bright(place(i % size), place(i / size)) != (large[*i as usize] & 0xff >= 0x80)
        });
        // Squares of whole pixels would have a quarter of a pixel on both sides of the line: 128.
        assert!(wrong.count() < 80);
    }

    #[test]
    fn reductions_are_possible_too() {
        assert_eq!(enlarged(&[7; 100], [10, 10], [3, 1]), [7; 3]);
        assert_eq!(enlarged(&[7], [1, 1], [2, 2]), [7; 4]);
        assert_eq!(enlarged(&[7, 7], [2, 1], [1, 900]), [7; 900]);
    }
}
