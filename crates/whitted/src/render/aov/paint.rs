//! From numbers to bytes.

use super::Legend;
use super::palette::{heat, of_number};
use crate::math::Vec3f;
use crate::ray::NONE;
use crate::render::first_pass::FirstSample;

const BLACK: [u8; 3] = [0; 3];
const WHITE: [u8; 3] = [255; 3];

/// Greys of the nearest and the farthest depth; black is kept for what was not hit.
const NEAREST: f32 = 255.0;
const FARTHEST: f32 = 40.0;

/// Of 1000 pixels, those that may cost more than the brightest colour stands for: a few that cost a hundred times as
/// much as all others would make these look alike.
const COSTLIEST_PER_MILLE: usize = 5;

/// The nearest byte; NaN gives 0.
pub(super) fn byte(value: f32) -> u8 {
    (value + 0.5) as u8
}

fn paint(colors: impl Iterator<Item = [u8; 3]>) -> Vec<u8> {
    colors.flatten().collect()
}

/// Components from −1 to 1 as bytes.
pub(super) fn normals(samples: &[FirstSample]) -> Vec<u8> {
    const HALF: f32 = 127.5;
    let color = |normal: Vec3f| normal.to_array().map(|component| byte(component * HALF + HALF));
    paint(samples.iter().map(|first| if first.object == NONE { BLACK } else { color(first.normal) }))
}

/// Greys, linear in 1 / depth, and the depths between which they lie; none if nothing was hit.
pub(super) fn depths(samples: &[FirstSample]) -> (Vec<u8>, Option<Legend>) {
    let hit = samples.iter().filter(|first| first.object != NONE).map(|first| first.depth);
    let (near, far) = hit.fold((f32::INFINITY, 0.0f32), |(near, far), depth| (near.min(depth), far.max(depth)));
    let (first, last) = (near.recip(), far.recip());
    let grey = |depth: f32| {
        let share = (depth.recip() - last) / (first - last);
        // Everything may be equally far.
        let share = if first > last { share } else { 1.0 };
        [byte(FARTHEST + (NEAREST - FARTHEST) * share); 3]
    };
    let rgb8 = paint(samples.iter().map(|first| if first.object == NONE { BLACK } else { grey(first.depth) }));
    (rgb8, (near <= far).then_some(Legend { first: near, last: far }))
}

/// A colour for each number; black for [`NONE`].
pub(super) fn numbers(numbers: impl IntoIterator<Item = u32>) -> Vec<u8> {
    paint(numbers.into_iter().map(|number| if number == NONE { BLACK } else { of_number(number) }))
}

/// White where it is true.
pub(super) fn mask(mask: impl Iterator<Item = bool>) -> Vec<u8> {
    paint(mask.map(|is_set| if is_set { WHITE } else { BLACK }))
}

/// Colours for amounts ≥ 0, and what they stand for; none if there are no amounts.
pub(super) fn amounts(amounts: &[f32]) -> (Vec<u8>, Option<Legend>) {
    let mut sorted = amounts.to_vec();
    sorted.sort_unstable_by(f32::total_cmp);
    let beyond = sorted.len() * COSTLIEST_PER_MILLE / 1000;
    let Some(&last) = sorted.iter().rev().nth(beyond) else { return (Vec::new(), None) };
    // The division is 0/0 where nothing costs anything: NaN is painted as 0.
    (paint(amounts.iter().map(|amount| heat(amount / last))), Some(Legend { first: 0.0, last }))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTHING: FirstSample = FirstSample::NOTHING;

    fn seen(depth: f32, normal: Vec3f) -> FirstSample {
        FirstSample { object: 3, normal, depth, cut: false }
    }

    #[test]
    fn normals_span_the_bytes() {
        let sample = seen(1.0, Vec3f::new(-1.0, 0.0, 1.0));
        assert_eq!(normals(&[sample, NOTHING]), [0, 128, 255, 0, 0, 0]);
    }

    #[test]
    fn depths_are_linear_in_their_reciprocal() {
        let at = |depth| seen(depth, Vec3f::ZERO);
        let (rgb8, legend) = depths(&[at(2.0), NOTHING, at(4.0), at(f32::INFINITY)]);
        let greys: Vec<u8> = rgb8.chunks(3).map(|pixel| pixel[0]).collect();
        assert_eq!(greys, [255, 0, 148, 40]);
        assert_eq!(legend, Some(Legend { first: 2.0, last: f32::INFINITY }));
        assert_eq!(depths(&[at(7.0)]), (vec![255; 3], Some(Legend { first: 7.0, last: 7.0 })));
        assert_eq!(depths(&[NOTHING]), (vec![0; 3], None));
    }

    #[test]
    fn a_few_costly_pixels_do_not_darken_the_others() {
        let mut costs: Vec<f32> = (0..1000).map(|i| i as f32).collect();
        let (_, legend) = amounts(&costs);
        assert_eq!(legend, Some(Legend { first: 0.0, last: 994.0 }));
        costs[999] = 1e9;
        assert_eq!(amounts(&costs).1, legend);
        assert_eq!(amounts(&[]), (Vec::new(), None));
        assert_eq!(amounts(&[0.0]).0, heat(0.0));
    }
}
