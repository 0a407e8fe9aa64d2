//! Borrowed rays: the caller's own arrays as a batch.

use super::{Ray, RayBatch};
use crate::math::Vec3;
use simd::F32Lanes;
use std::ops::{Index, Range};

/// One value for each ray, or the same for all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Row<'a, T> {
    /// A value for each ray.
    Each(&'a [T]),
    /// The same value for all rays.
    All(T),
}

impl<'a, T> Row<'a, T> {
    fn slice(self, range: Range<usize>) -> Self {
        match self {
            Self::Each(values) => Self::Each(&values[range]),
            all => all,
        }
    }
}

impl Row<'_, f32> {
    /// The values of a range that is no longer than the lanes.
    #[inline(always)]
    pub(crate) fn lanes<F: F32Lanes>(self, token: F::Token, range: Range<usize>) -> F {
        match self {
            Self::Each(values) => lanes(token, values, range),
            Self::All(value) => F::splat(token, value),
        }
    }
}

/// The values of a range of a row that is no longer than the lanes; 0 beyond it.
#[inline(always)]
pub(crate) fn lanes<F: F32Lanes>(token: F::Token, row: &[f32], range: Range<usize>) -> F {
    let row = &row[range];
    if row.len() == F::WIDTH {
        return F::load_slice(token, row);
    }
    let mut padded = F::Array::default();
    padded.as_mut()[..row.len()].copy_from_slice(row);
    F::load(token, &padded)
}

impl<T> Index<usize> for Row<'_, T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, index: usize) -> &T {
        match self {
            Self::Each(values) => &values[index],
            Self::All(value) => value,
        }
    }
}

/// Many rays in somebody's arrays, one array for each component: a view that is cheap to copy and to divide.
///
/// ```
/// use whitted::ray::Rays;
///
/// // A hundred rays straight down from a height of 10.
/// let x: Vec<f32> = (0..100).map(|i| i as f32 * 0.1).collect();
/// let (height, zero, down) = ([10.0; 100], [0.0; 100], [-1.0; 100]);
/// let rays = Rays::new([&x, &height, &zero], [&zero, &down, &zero]);
/// assert_eq!(rays.len(), 100);
/// assert_eq!(rays.with_t_max(&[5.0; 100]).get(3).t_max, 5.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Rays<'a> {
    pub(crate) origin: Vec3<&'a [f32]>,
    pub(crate) direction: Vec3<&'a [f32]>,
    pub(crate) t_min: Row<'a, f32>,
    pub(crate) t_max: Row<'a, f32>,
    pub(crate) mask: Row<'a, u32>,
}

impl<'a> Rays<'a> {
    /// Half-lines: `t` from 0 to infinity, seeing everything.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn new(origin: [&'a [f32]; 3], direction: [&'a [f32]; 3]) -> Self {
        for row in origin.into_iter().chain(direction) {
            assert_eq!(row.len(), origin[0].len(), "a value of each component for each ray");
        }
        let (origin, direction) = (origin.into(), direction.into());
        Self { origin, direction, t_min: Row::All(0.0), t_max: Row::All(f32::INFINITY), mask: Row::All(u32::MAX) }
    }

    /// The same rays with ranges that begin at `t_min`: a slice with a value for each, or one value for all.
    ///
    /// # Panics
    /// If a slice is not as long as the rays are many.
    pub fn with_t_min(self, t_min: impl Into<Row<'a, f32>>) -> Self {
        Self { t_min: self.checked(t_min.into()), ..self }
    }

    /// The same rays with ranges that end at `t_max`: a slice with a value for each, or one value for all.
    ///
    /// # Panics
    /// If a slice is not as long as the rays are many.
    pub fn with_t_max(self, t_max: impl Into<Row<'a, f32>>) -> Self {
        Self { t_max: self.checked(t_max.into()), ..self }
    }

    /// The same rays with masks: a ray sees what has a bit in common with its mask. A slice with a mask for each, or
    /// one for all.
    ///
    /// # Panics
    /// If a slice is not as long as the rays are many.
    pub fn with_mask(self, mask: impl Into<Row<'a, u32>>) -> Self {
        Self { mask: self.checked(mask.into()), ..self }
    }

    fn checked<T>(&self, row: Row<'a, T>) -> Row<'a, T> {
        if let Row::Each(values) = row {
            assert_eq!(values.len(), self.len(), "a value for each ray");
        }
        row
    }

    /// Number of rays.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.origin.x.len()
    }

    /// True if there are no rays.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Ray number `index`, without its mask.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Ray {
        let at = |rows: Vec3<&[f32]>| Vec3::new(rows.x[index], rows.y[index], rows.z[index]);
        Ray {
            origin: at(self.origin),
            direction: at(self.direction),
            t_min: self.t_min[index],
            t_max: self.t_max[index],
        }
    }

    /// The mask of ray number `index`.
    #[inline(always)]
    pub fn mask(&self, index: usize) -> u32 {
        self.mask[index]
    }

    /// The rays `range`.
    ///
    /// # Panics
    /// If there are not so many.
    pub fn slice(self, range: Range<usize>) -> Self {
        let cut = |rows: Vec3<&'a [f32]>| rows.map(|row| &row[range.clone()]);
        Self {
            origin: cut(self.origin),
            direction: cut(self.direction),
            t_min: self.t_min.slice(range.clone()),
            t_max: self.t_max.slice(range.clone()),
            mask: self.mask.slice(range),
        }
    }

    /// The first `middle` rays and the others.
    ///
    /// # Panics
    /// If there are not so many.
    pub fn split_at(self, middle: usize) -> (Self, Self) {
        (self.slice(0..middle), self.slice(middle..self.len()))
    }
}

impl<T> From<T> for Row<'_, T> {
    fn from(value: T) -> Self {
        Self::All(value)
    }
}

impl<'a, T> From<&'a [T]> for Row<'a, T> {
    fn from(values: &'a [T]) -> Self {
        Self::Each(values)
    }
}

impl<'a, T> From<&'a Vec<T>> for Row<'a, T> {
    fn from(values: &'a Vec<T>) -> Self {
        Self::Each(values)
    }
}

impl<'a, T, const N: usize> From<&'a [T; N]> for Row<'a, T> {
    fn from(values: &'a [T; N]) -> Self {
        Self::Each(values)
    }
}

impl<'a> From<&'a RayBatch> for Rays<'a> {
    fn from(batch: &'a RayBatch) -> Self {
        let (o, d) = (&batch.origin, &batch.direction);
        Rays::new([&o.x, &o.y, &o.z], [&d.x, &d.y, &d.z]).with_t_min(&batch.t_min).with_t_max(&batch.t_max)
    }
}

/// One ray as a batch.
impl<'a> From<&'a Ray> for Rays<'a> {
    fn from(ray: &'a Ray) -> Self {
        let slice = std::slice::from_ref;
        let (o, d) = (&ray.origin, &ray.direction);
        Self {
            origin: Vec3::new(slice(&o.x), slice(&o.y), slice(&o.z)),
            direction: Vec3::new(slice(&d.x), slice(&d.y), slice(&d.z)),
            t_min: Row::All(ray.t_min),
            t_max: Row::All(ray.t_max),
            mask: Row::All(u32::MAX),
        }
    }
}
