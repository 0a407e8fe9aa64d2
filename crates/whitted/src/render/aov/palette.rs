//! Colours for amounts and for numbers.

use crate::math::hash32;

/// Ten equal steps of *viridis* (Smith and van der Walt 2015, CC0): from dark blue over green to yellow in steps that
/// look equal, also in grey and to the colour-blind.
const VIRIDIS: [[u8; 3]; 10] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x28, 0x78],
    [0x3e, 0x4a, 0x89],
    [0x31, 0x68, 0x8e],
    [0x26, 0x82, 0x8e],
    [0x1f, 0x9e, 0x89],
    [0x35, 0xb7, 0x79],
    [0x6d, 0xcd, 0x59],
    [0xb4, 0xde, 0x2c],
    [0xfd, 0xe7, 0x25],
];

/// The sRGB colour of an amount: 0 dark blue, 1 yellow, linear between the steps of viridis. Amounts beyond count as the
/// nearest of the two, NaN as 0.
pub fn heat(amount: f32) -> [u8; 3] {
    let last = VIRIDIS.len() - 1;
    // The comparison is false for NaN.
    let place = if amount > 0.0 { amount.min(1.0) * last as f32 } else { 0.0 };
    let step = (place as usize).min(last - 1);
    let share = place - step as f32;
    let between = |channel: usize| {
        let [from, to] = [VIRIDIS[step], VIRIDIS[step + 1]].map(|color| f32::from(color[channel]));
        super::paint::byte(from + (to - from) * share)
    };
    [0, 1, 2].map(between)
}

/// 2³² divided by the golden ratio: its multiples spread over the circle of 2³² as evenly as can be.
const GOLDEN: u32 = 0x9E37_79B9;

/// The sRGB colour of a number: neighbours differ much in hue, and no colour is dark.
pub(super) fn of_number(number: u32) -> [u8; 3] {
    let hue = number.wrapping_mul(GOLDEN);
    let bits = hash32(number);
    let (brightest, darkest) = (255 - (bits & 63), 30 + (bits >> 8 & 63));
    [0, u32::MAX / 3, u32::MAX / 3 * 2].map(|turn| {
        let height = u64::from(wheel(hue.wrapping_add(turn)));
        (u64::from(darkest) + height * u64::from(brightest - darkest) / u64::from(PEAK)) as u8
    })
}

/// The top of [`wheel`].
const PEAK: u32 = u32::MAX / 6;

/// A channel around the colour wheel: rises for a sixth, stays for a third, falls for a sixth, is 0 for a third.
fn wheel(hue: u32) -> u32 {
    let (sixth, along) = (hue / PEAK, hue % PEAK);
    match sixth {
        0 => along,
        1 | 2 => PEAK,
        3 => PEAK - along,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_goes_through_all_steps_and_ends() {
        for (index, step) in VIRIDIS.iter().enumerate() {
            assert_eq!(heat(index as f32 / 9.0), *step);
        }
        assert_eq!(heat(-1.0), VIRIDIS[0]);
        assert_eq!(heat(f32::NAN), VIRIDIS[0]);
        assert_eq!(heat(f32::INFINITY), VIRIDIS[9]);
        let luma = |color: [u8; 3]| 2126 * u32::from(color[0]) + 7152 * u32::from(color[1]) + 722 * u32::from(color[2]);
        let brightness: Vec<u32> = (0..=100).map(|i| luma(heat(i as f32 / 100.0))).collect();
        assert!(brightness.windows(2).all(|pair| pair[0] <= pair[1]), "more is brighter");
    }

    #[test]
    fn numbers_near_each_other_have_colours_far_apart() {
        let distance = |a: [u8; 3], b: [u8; 3]| (0..3).map(|i| u32::from(a[i].abs_diff(b[i]))).sum::<u32>();
        for number in 0..10_000 {
            let color = of_number(number);
            assert!(color.iter().any(|&channel| channel >= 190), "{color:?} is dark");
            assert!(distance(color, of_number(number + 1)) > 60, "{number}: {color:?} and {:?}", of_number(number + 1));
        }
    }
}
