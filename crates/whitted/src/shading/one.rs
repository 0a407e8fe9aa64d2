//! One ray as a vector of one lane: the same code, and so the same bits, as for many.

use crate::math::{Vec3, Vec3f};
use simd::{F32Lanes, Scalar, ScalarF32};

/// A single number in the vocabulary of lanes.
pub(crate) type One = ScalarF32<1>;

pub(crate) fn one(value: f32) -> One {
    One::splat(Scalar, value)
}

pub(crate) fn ones(vector: Vec3f) -> Vec3<One> {
    vector.map(one)
}

pub(crate) fn value(one: One) -> f32 {
    let mut value = [0.0];
    one.store(&mut value);
    value[0]
}

pub(crate) fn values(ones: Vec3<One>) -> Vec3f {
    ones.map(value)
}
