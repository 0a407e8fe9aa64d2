//! Where in its pixel a sample lies.

use crate::math::hash32;
use crate::scene::{Antialias, Settings};

/// Dimensions of the random numbers of one sample. Each use of randomness has its own, so that a new one changes no
/// old picture.
#[derive(Clone, Copy, Debug)]
enum Dimension {
    /// Horizontal place in the pixel.
    PixelX = 0,
    /// Vertical place in the pixel.
    PixelY = 1,
}

/// Places of the samples of all pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jitter {
    strata: Stratification,
    seed: u32,
}

impl Jitter {
    /// The places that `settings` ask for.
    pub(super) fn new(settings: &Settings) -> Self {
        let samples = match settings.antialias {
            Antialias::Uniform(samples) => samples,
            _ => settings.antialias_max,
        };
        Self { strata: Stratification::new(samples), seed: settings.seed }
    }

    /// Samples of a pixel that is supersampled.
    pub(super) fn samples(&self) -> u32 {
        self.strata.samples
    }

    /// Place of sample `sample < samples` in a pixel; both coordinates in [0, 1].
    pub(super) fn place(&self, [x, y]: [u32; 2], sample: u32) -> [f32; 2] {
        if sample == 0 { MIDDLE } else { self.strata.place(PixelHash::new(x, y, self.seed), sample) }
    }
}

/// Places of the samples of one pixel, in units of the pixel from its upper left corner.
///
/// The pixel is divided into n cells of equal area, in rows of equal or nearly equal numbers; each sample is random
/// within its own cell. The first sample, in the middle of the pixel, was taken before and stands for the cell that it
/// lies in.
#[derive(Clone, Copy, Debug)]
struct Stratification {
    samples: u32,
    rows: u32,
    /// The cell of the first sample.
    middle: u32,
}

/// The first sample of every pixel.
pub(super) const MIDDLE: [f32; 2] = [0.5, 0.5];

impl Stratification {
    /// `samples` ≥ 1 samples in a pixel.
    fn new(samples: u32) -> Self {
        let samples = samples.max(1);
        let rows = samples.isqrt();
        let mut new = Self { samples, rows, middle: 0 };
        new.middle = (0..samples).find(|&cell| new.cell(cell).contains(MIDDLE)).unwrap_or(0);
        new
    }

    /// Place of sample `1 ≤ sample < samples` of the pixel with this hash; both coordinates in [0, 1].
    fn place(&self, pixel: PixelHash, sample: u32) -> [f32; 2] {
        // Samples 1, 2, … take the cells in order, without that of sample 0.
        let cell = self.cell(if sample <= self.middle { sample - 1 } else { sample });
        let random = [Dimension::PixelX, Dimension::PixelY].map(|dimension| pixel.uniform(sample, dimension));
        [0, 1].map(|axis| cell.lo[axis] + (cell.hi[axis] - cell.lo[axis]) * random[axis])
    }

    fn cell(&self, cell: u32) -> Cell {
        let row_start = |row: u32| (u64::from(self.samples) * u64::from(row) / u64::from(self.rows)) as u32;
        // The row of the cell: cells come row by row, and row r begins with cell row_start(r).
        let row = (0..self.rows).rfind(|&row| row_start(row) <= cell).unwrap_or(0);
        let (first, next) = (row_start(row), row_start(row + 1));
        let share = |part: u32, whole: u32| part as f32 / whole as f32;
        let in_row = next - first;
        Cell {
            lo: [share(cell - first, in_row), share(first, self.samples)],
            hi: [share(cell - first + 1, in_row), share(next, self.samples)],
        }
    }
}

/// A rectangle within the unit pixel.
#[derive(Clone, Copy, Debug)]
struct Cell {
    lo: [f32; 2],
    hi: [f32; 2],
}

impl Cell {
    fn contains(&self, place: [f32; 2]) -> bool {
        (0..2).all(|axis| self.lo[axis] <= place[axis] && place[axis] < self.hi[axis])
    }
}

/// The hash of a pixel's coordinates and the user's seed.
#[derive(Clone, Copy, Debug)]
struct PixelHash(u32);

impl PixelHash {
    /// The hash of pixel (`x`, `y`) of the whole picture.
    fn new(x: u32, y: u32, seed: u32) -> Self {
        Self(hash32(x ^ hash32(y ^ hash32(seed))))
    }

    /// A number uniform in [0, 1) with 24 bits.
    fn uniform(self, sample: u32, dimension: Dimension) -> f32 {
        const UNIT: f32 = 1.0 / (1u32 << 24) as f32;
        (hash32(self.0 ^ hash32((sample << 8) | dimension as u32)) >> 8) as f32 * UNIT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_equal_areas_and_cover_the_pixel() {
        for samples in 1..70 {
            let strata = Stratification::new(samples);
            let area = |cell: Cell| f64::from((cell.hi[0] - cell.lo[0]) * (cell.hi[1] - cell.lo[1]));
            let expected = 1.0 / f64::from(samples);
            for cell in 0..samples {
                assert!((area(strata.cell(cell)) - expected).abs() < 1e-6, "cell {cell} of {samples}");
            }
        }
    }

    #[test]
    fn each_sample_has_its_own_cell() {
        for samples in 1..40 {
            let strata = Stratification::new(samples);
            let pixel = PixelHash::new(11, 23, samples);
            let places: Vec<_> = (1..samples).map(|sample| strata.place(pixel, sample)).chain([MIDDLE]).collect();
            for cell in (0..samples).map(|cell| strata.cell(cell)) {
                assert_eq!(places.iter().filter(|&&place| cell.contains(place)).count(), 1, "{cell:?} of {samples}");
            }
        }
    }

    #[test]
    fn pixels_samples_and_seeds_differ() {
        let strata = Stratification::new(16);
        let places = [(1, 2, 0), (2, 1, 0), (1, 2, 1)].map(|(x, y, seed)| strata.place(PixelHash::new(x, y, seed), 3));
        assert_ne!(places[0], places[1]);
        assert_ne!(places[0], places[2]);
    }
}
