//! A small picture enlarged to the size of the window: bilinear, between the middles of pixels.

use rayon::prelude::*;

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

/// Where a row or column of the large picture lies in the small one: between `low` and `high`, and its share of `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    low: usize,
    high: usize,
    share: u32,
}

/// The places of all rows or columns.
fn places(from: u32, to: u32) -> Vec<Place> {
    let ratio = f64::from(from) / f64::from(to);
    let last = from as usize - 1;
    let place = |at: u32| {
        let x = ((f64::from(at) + 0.5) * ratio - 0.5).max(0.0);
        let low = (x as usize).min(last);
        Place { low, high: (low + 1).min(last), share: ((x - low as f64).clamp(0.0, 1.0) * f64::from(UNIT)) as u32 }
    };
    (0..to).map(place).collect()
}

/// `pixels` (`0x00RRGGBB`, row by row) of a picture of size `from` enlarged to size `to`; in the current rayon pool.
///
/// # Panics
/// If a side is 0 or there are not as many pixels as `from` says.
pub(crate) fn enlarge(pixels: &[u32], from: [u32; 2], to: [u32; 2]) -> Vec<u32> {
    assert_eq!(pixels.len(), from[0] as usize * from[1] as usize, "the pixels of the small picture");
    if from == to {
        return pixels.to_vec();
    }
    let width = from[0] as usize;
    let (columns, rows) = (places(from[0], to[0]), places(from[1], to[1]));
    let mut large = vec![0; to[0] as usize * to[1] as usize];
    large.par_chunks_mut(to[0] as usize).zip(&rows).for_each_init(
        || vec![[0; 2]; width],
        |line, (out, row)| {
            let (upper, lower) = (&pixels[row.low * width..][..width], &pixels[row.high * width..][..width]);
            for (mixed, (&a, &b)) in line.iter_mut().zip(upper.iter().zip(lower)) {
                *mixed = mix(spread(a), spread(b), row.share);
            }
            for (out, column) in out.iter_mut().zip(&columns) {
                *out = gather(mix(line[column.low], line[column.high], column.share));
            }
        },
    );
    large
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

/// Red and blue, and green, each with eight bits of room above.
fn spread(pixel: u32) -> [u32; 2] {
    [pixel & 0x00ff_00ff, pixel & 0x0000_ff00]
}

fn gather([red_blue, green]: [u32; 2]) -> u32 {
    red_blue | green
}

/// `a` and `b` by shares; `share` of [`UNIT`] is that of `b`.
fn mix(a: [u32; 2], b: [u32; 2], share: u32) -> [u32; 2] {
    let rest = UNIT - share;
    [((a[0] * rest + b[0] * share) >> 8) & 0x00ff_00ff, (((a[1] >> 8) * rest + (b[1] >> 8) * share) >> 8) << 8]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_size_is_the_same_picture() {
        let pixels: Vec<u32> = (0..12).map(|i| i * 0x0001_0203).collect();
        assert_eq!(enlarge(&pixels, [4, 3], [4, 3]), pixels);
    }

    #[test]
    fn what_is_even_stays_so_and_corners_stay() {
        let even = vec![0x00fe_8001; 6];
        assert!(enlarge(&even, [3, 2], [37, 29]).iter().all(|&pixel| pixel == 0x00fe_8001));
        let corners = enlarge(&[0x00ff_0000, 0x0000_ff00, 0x0000_00ff, 0x00ff_ffff], [2, 2], [16, 16]);
        assert_eq!([corners[0], corners[15], corners[240], corners[255]], [0xff_0000, 0xff00, 0xff, 0xff_ffff]);
    }

    #[test]
    fn between_two_pixels_lies_their_mean() {
        let line = enlarge(&[0, 0x00ff_ffff], [2, 1], [400, 1]);
        let values: Vec<u32> = line.iter().map(|pixel| pixel & 0xff).collect();
        assert!(values.is_sorted());
        assert!((126..=129).contains(&values[200]), "{}", values[200]);
        assert!(line.iter().all(|p| p >> 16 == p & 0xff && p >> 8 & 0xff == p & 0xff), "grey stays grey");
    }

    #[test]
    fn reductions_are_possible_too() {
        assert_eq!(enlarge(&[7; 100], [10, 10], [3, 1]), [7; 3]);
        assert_eq!(enlarge(&[7], [1, 1], [2, 2]), [7; 4]);
    }
}
