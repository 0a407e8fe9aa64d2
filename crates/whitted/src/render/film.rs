//! The light that samples have gathered, in a form that does not depend on the order in which it came.

use crate::math::{Vec3, Vec3f};
use simd::{F32Lanes, Kernel, Level, Simd};

/// Light sums of a batch of samples, in 64-bit fixed point: integers add in any order to the same sum.
///
/// One unit is 2⁻³² of the light value 1; a single contribution counts as at most 2³⁰, a sum saturates at 2³¹. Negative
/// and NaN contributions count as 0, so a film never holds anything that is not a finite number ≥ 0.
#[derive(Debug, Default)]
pub(super) struct Film {
    /// Red, green, blue, and one number that is always 0 and makes rows fit registers.
    sums: Vec<[i64; 4]>,
}

/// Fixed-point units of the light value 1.
const UNIT: f32 = (1u64 << 32) as f32;

/// The largest contribution that is not cut.
const BRIGHTEST: f32 = (1u32 << 30) as f32;

impl Film {
    /// Start over with `samples` black samples.
    pub(super) fn reset(&mut self, samples: usize) {
        self.sums.clear();
        self.sums.resize(samples, [0; 4]);
    }

    /// Add `light` to a sample.
    ///
    /// # Panics
    /// If there is no such sample.
    #[inline]
    pub(super) fn add(&mut self, sample: u32, light: Vec3f) {
        let sum = &mut self.sums[sample as usize];
        // Saturation keeps the order free: all addends are ≥ 0, so the result is min(true sum, largest).
        for (sum, light) in sum.iter_mut().zip(light.to_array()) {
            *sum = sum.saturating_add(to_fixed(light));
        }
    }

    /// As [`add`](Self::add), for the samples of the lanes `mask`.
    ///
    /// # Panics
    /// If there is no such sample.
    #[inline(always)]
    pub(super) fn add_lanes<L: F32Lanes>(&mut self, token: L::Token, mask: L::Mask, sample: L::U32, light: Vec3<L>) {
        let addends = [units(token, light.x), units(token, light.y), units(token, light.z), L::splat(token, 0.0)];
        L::accumulate(addends, mask, sample, &mut self.sums);
    }

    /// Make the light of every sample, in order, a colour: finite and ≥ 0.
    pub(super) fn develop(&self, level: Level, colors: &mut Vec<Vec3f>) {
        simd::dispatch(level, Develop { sums: &self.sums, colors });
    }
}

/// The kernel of [`Film::develop`].
struct Develop<'a> {
    sums: &'a [[i64; 4]],
    colors: &'a mut Vec<Vec3f>,
}

impl Kernel for Develop<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        self.colors.resize(self.sums.len(), Vec3f::ZERO);
        for (color, &[r, g, b, _]) in self.colors.iter_mut().zip(self.sums) {
            *color = Vec3::new(to_float(r), to_float(g), to_float(b));
        }
    }
}

#[inline(always)]
fn to_float(sum: i64) -> f32 {
    (sum as f64 / f64::from(UNIT)) as f32
}

fn to_fixed(light: f32) -> i64 {
    // The comparison is false for NaN. The product is exact; the cast drops what is below one unit.
    if light > 0.0 { (light.min(BRIGHTEST) * UNIT) as i64 } else { 0 }
}

/// [`to_fixed`], but for the cast.
#[inline(always)]
fn units<L: F32Lanes>(token: L::Token, light: L) -> L {
    // The greater of NaN and 0 is 0.
    light.max(L::splat(token, 0.0)).min(L::splat(token, BRIGHTEST)) * L::splat(token, UNIT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shading::one::{One, one};
    use simd::{MaskLanes, Scalar, ScalarU32, U32Lanes};

    #[test]
    fn lanes_add_as_one_by_one() {
        for light in [f32::NAN, -1.0, f32::NEG_INFINITY, -0.0, 0.25, 3.7e-9, 1e9, f32::INFINITY, f32::MAX] {
            let mut film = Film::default();
            film.reset(1);
            let all = <One as F32Lanes>::Mask::from_bits(Scalar, 1);
            film.add_lanes(Scalar, all, ScalarU32::splat(Scalar, 0), Vec3::splat(one(light)));
            let sum = to_fixed(light);
            assert_eq!(film.sums[0], [sum, sum, sum, 0], "{light}");
        }
    }

    fn sum(lights: &[f32]) -> f32 {
        let mut film = Film::default();
        film.reset(1);
        lights.iter().for_each(|&light| film.add(0, Vec3f::splat(light)));
        let mut colors = Vec::new();
        film.develop(Level::best(), &mut colors);
        colors[0].x
    }

    #[test]
    fn poison_counts_as_nothing_and_brightness_ends_somewhere() {
        assert_eq!(sum(&[f32::NAN, -1.0, f32::NEG_INFINITY, 0.25, -0.0]), 0.25);
        assert_eq!(sum(&[f32::INFINITY]), BRIGHTEST);
        assert_eq!(sum(&[f32::MAX; 9]), 2.0 * BRIGHTEST);
    }

    #[test]
    fn order_does_not_matter() {
        let lights = [1e-9, 3.7, 1e9, f32::MAX, 0.1, 1e-3, f32::MAX, f32::MAX];
        let mut reversed = lights;
        reversed.reverse();
        assert_eq!(sum(&lights).to_bits(), sum(&reversed).to_bits());
        assert_eq!(sum(&lights[..3]).to_bits(), sum(&[3.7, 1e9, 1e-9]).to_bits());
    }
}
