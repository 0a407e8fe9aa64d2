//! Shadow rays of one lamp in an order that makes packets.
//!
//! Points that light reaches lie in the order in which rays met them: after a bounce, sixty-four in a row are all over
//! the scene, and the pyramid around them holds most of it. Seen from the lamp, every point lies in some direction; rays
//! in the order of a space-filling curve over these directions fill narrow pyramids.

use super::rows::{BLOCK, array, first_lanes, lengthen};
use crate::math::{Vec3, Vec3f};
use simd::{F32Lanes, Kernel, Level, Simd, U32Lanes};

/// Cells on a side of the map of directions.
const SIDE: u32 = 64;

/// The key of directions that are not on the map.
const ELSEWHERE: u32 = SIDE * SIDE;

/// An order of rays, by the cells of their directions along Morton's curve.
#[derive(Debug, Default)]
pub(super) struct Packing {
    keys: Vec<u32>,
    /// Where the next ray of each cell goes.
    starts: Vec<u32>,
    order: Vec<u32>,
}

impl Packing {
    /// The numbers of the rays in order.
    pub(super) fn order(&self) -> &[u32] {
        &self.order
    }

    /// Find the order of rays with these directions, which need not be normalised.
    pub(super) fn sort(&mut self, level: Level, directions: [&[f32]; 3]) {
        simd::dispatch(level, Keys { directions: directions.into(), keys: &mut self.keys });
        self.starts.clear();
        self.starts.resize(ELSEWHERE as usize + 2, 0);
        for &key in &self.keys {
            self.starts[key as usize + 1] += 1;
        }
        let mut sum = 0;
        for start in &mut self.starts {
            sum += *start;
            *start = sum;
        }
        lengthen(&mut self.order, self.keys.len());
        for (index, &key) in (0..).zip(&self.keys) {
            let start = &mut self.starts[key as usize];
            self.order[*start as usize] = index;
            *start += 1;
        }
    }
}

/// Finds the cell of each direction.
struct Keys<'a> {
    directions: Vec3<&'a [f32]>,
    keys: &'a mut Vec<u32>,
}

/// The map of directions: the face of a cube that most of them meet, as far as they meet it.
struct Map<L> {
    axis: usize,
    /// 1 if the face lies towards larger coordinates, −1 if towards smaller ones.
    sense: L,
    lo: [L; 2],
    /// Cells per unit.
    scale: [L; 2],
}

/// Where directions meet a face.
struct Place<L: F32Lanes> {
    on_map: L::Mask,
    at: [L; 2],
}

impl Kernel for Keys<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { directions, keys } = self;
        let len = directions.x.len();
        keys.clear();
        if len == 0 {
            return;
        }
        keys.reserve(len + BLOCK);
        let map = Map::<S::F32x16>::around(token, directions);
        for at in (0..len).step_by(BLOCK) {
            let place = map.place(token, load(token, directions, at));
            let key = array::<S::F32x16>(map.key(token, &place));
            keys.extend_from_slice(key.as_ref());
        }
        keys.truncate(len);
    }
}

impl<L: F32Lanes> Map<L> {
    /// The map that holds most of the directions.
    #[inline(always)]
    fn around(token: L::Token, directions: Vec3<&[f32]>) -> Self {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let mut sum = Vec3::splat(zero);
        let len = directions.x.len();
        for at in (0..len).step_by(L::WIDTH) {
            sum += load(token, directions, at);
        }
        let sum = Vec3f::new(sum.x.reduce_add(), sum.y.reduce_add(), sum.z.reduce_add());
        let size = sum.abs();
        let axis = if size.z > size.x.max(size.y) { 2 } else { usize::from(size.y > size.x) };
        let sense = L::splat(token, if sum[axis] < 0.0 { -1.0 } else { 1.0 });
        let mut map = Self { axis, sense, lo: [zero; 2], scale: [one; 2] };
        map.fit(token, directions);
        map
    }

    /// Stretch the cells over the part of the face that is met.
    #[inline(always)]
    fn fit(&mut self, token: L::Token, directions: Vec3<&[f32]>) {
        let infinity = L::splat(token, f32::INFINITY);
        let (mut lo, mut hi) = ([infinity; 2], [-infinity; 2]);
        let len = directions.x.len();
        for at in (0..len).step_by(L::WIDTH) {
            let place = self.place(token, load(token, directions, at));
            let counts = place.on_map & first_lanes::<L>(token, len - at);
            for i in 0..2 {
                lo[i] = L::select(counts, place.at[i], infinity).min(lo[i]);
                hi[i] = L::select(counts, place.at[i], -infinity).max(hi[i]);
            }
        }
        for i in 0..2 {
            let (lo, hi) = (lo[i].reduce_min(), hi[i].reduce_max());
            self.lo[i] = L::splat(token, lo);
            // Where all directions are one, any scale will do that is finite.
            self.scale[i] = L::splat(token, SIDE as f32 / (hi - lo).max(f32::MIN_POSITIVE * SIDE as f32));
        }
    }

    /// Where directions meet the face.
    #[inline(always)]
    fn place(&self, token: L::Token, direction: Vec3<L>) -> Place<L> {
        let (x, y, z) = match self.axis {
            0 => (direction.y, direction.z, direction.x),
            1 => (direction.z, direction.x, direction.y),
            _ => (direction.x, direction.y, direction.z),
        };
        let ahead = z * self.sense;
        let on_map = L::splat(token, 0.0).lt(ahead) & x.abs().le(ahead) & y.abs().le(ahead);
        Place { on_map, at: [x / ahead, y / ahead] }
    }

    /// The cell of each place along the curve; [`ELSEWHERE`] for those off the map.
    #[inline(always)]
    fn key(&self, token: L::Token, place: &Place<L>) -> L::U32 {
        let x = cell::<L>(token, (place.at[0] - self.lo[0]) * self.scale[0]);
        let y = cell::<L>(token, (place.at[1] - self.lo[1]) * self.scale[1]);
        let key = spread(token, x) | spread(token, y).shl::<1>();
        L::U32::select(place.on_map, key, L::U32::splat(token, ELSEWHERE))
    }
}

/// The number of the cell, kept on the map.
#[inline(always)]
fn cell<L: F32Lanes>(token: L::Token, at: L) -> L::U32 {
    // A NaN becomes 0.
    at.max(L::splat(token, 0.0)).min(L::splat(token, SIDE as f32 - 1.0)).floor().round_to_int()
}

/// Six bits with a zero between each and the next.
#[inline(always)]
fn spread<U: U32Lanes>(token: U::Token, x: U) -> U {
    let x = (x | x.shl::<4>()) & U::splat(token, 0x0f0f);
    let x = (x | x.shl::<2>()) & U::splat(token, 0x3333);
    (x | x.shl::<1>()) & U::splat(token, 0x5555)
}

/// Directions `at` and following; zero, which is on no map, beyond the end.
#[inline(always)]
fn load<L: F32Lanes>(token: L::Token, directions: Vec3<&[f32]>, at: usize) -> Vec3<L> {
    Vec3::new(part(token, directions.x, at), part(token, directions.y, at), part(token, directions.z, at))
}

#[inline(always)]
fn part<L: F32Lanes>(token: L::Token, row: &[f32], at: usize) -> L {
    let row = &row[at..];
    if row.len() >= L::WIDTH {
        return L::load_slice(token, row);
    }
    let mut padded = L::Array::default();
    padded.as_mut()[..row.len()].copy_from_slice(row);
    L::load(token, &padded)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SplitMix64;

    fn order(directions: &[Vec3f]) -> Vec<u32> {
        let row = |axis: usize| directions.iter().map(|d| d[axis]).collect::<Vec<f32>>();
        let (x, y, z) = (row(0), row(1), row(2));
        let mut packing = Packing::default();
        packing.sort(Level::best(), [&x, &y, &z]);
        packing.order().to_vec()
    }

    #[test]
    fn every_ray_has_its_place() {
        let mut random = SplitMix64::new(1);
        for count in [0, 1, 15, 16, 17, 1000] {
            let mut number = || random.uniform(-1.0, 1.0) as f32;
            let mut directions: Vec<Vec3f> = (0..count).map(|_| Vec3f::new(number(), number(), number())).collect();
            directions.iter_mut().step_by(7).for_each(|d| d.x = f32::NAN);
            let mut order = order(&directions);
            order.sort_unstable();
            assert!(order.into_iter().eq(0..count));
        }
    }

    #[test]
    fn packets_are_narrow() {
        let mut random = SplitMix64::new(2);
        let mut slope = || random.uniform(-0.5, 0.5) as f32;
        let directions: Vec<Vec3f> = (0..4096).map(|_| Vec3f::new(slope(), -1.0, slope()) * 3.0).collect();
        let slopes = &directions;
        let area = |packet: &[u32]| {
            let along = |axis: usize| packet.iter().map(move |&i| slopes[i as usize][axis]);
            let extent = |axis| along(axis).fold(f32::MIN, f32::max) - along(axis).fold(f32::MAX, f32::min);
            extent(0) * extent(2) / 9.0
        };
        let order = order(&directions);
        let mean = order.chunks(64).map(area).sum::<f32>() / 64.0;
        assert!(mean < 3.0 / 64.0, "a packet covers {mean} of the map");
    }
}
