//! Rays and hits, one by one and as structures of arrays.

mod hits;
mod view;

pub use hits::{HitLists, HitsMut};
pub(crate) use view::lanes;
pub use view::{Rays, Row};

use crate::math::{Vec3, Vec3f};
use std::ops::Range;

/// No primitive, no instance.
pub const NONE: u32 = u32::MAX;

/// A half-line or segment `origin + t·direction`, `t_min ≤ t ≤ t_max`.
///
/// The direction need not be normalised; `t` is measured in its length. A ray with a NaN, a zero or infinite
/// direction, or an infinite origin hits nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray starts.
    pub origin: Vec3f,
    /// Where it goes.
    pub direction: Vec3f,
    /// Hits before this parameter do not count.
    pub t_min: f32,
    /// Hits beyond this parameter do not count.
    pub t_max: f32,
}

impl Ray {
    /// The half-line from `origin` along `direction`: `t` from 0 to infinity.
    pub fn new(origin: impl Into<Vec3f>, direction: impl Into<Vec3f>) -> Self {
        Self { origin: origin.into(), direction: direction.into(), t_min: 0.0, t_max: f32::INFINITY }
    }

    /// The segment between two points: `t` is 0 at `from` and 1 at `to`.
    pub fn between(from: impl Into<Vec3f>, to: impl Into<Vec3f>) -> Self {
        let (origin, to) = (from.into(), to.into());
        Self { origin, direction: to - origin, t_min: 0.0, t_max: 1.0 }
    }

    /// The ray with a mask: it sees only what has a bit in common with it.
    pub const fn with_mask(self, mask: u32) -> MaskedRay {
        MaskedRay { ray: self, mask }
    }

    /// The point at parameter `t`.
    #[inline(always)]
    pub fn at(&self, t: f32) -> Vec3f {
        self.origin + self.direction * t
    }
}

/// A ray that sees only what has a bit in common with its mask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaskedRay {
    /// The ray.
    pub ray: Ray,
    /// What it sees.
    pub mask: u32,
}

impl From<Ray> for MaskedRay {
    fn from(ray: Ray) -> Self {
        ray.with_mask(u32::MAX)
    }
}

impl From<&Ray> for MaskedRay {
    fn from(ray: &Ray) -> Self {
        (*ray).into()
    }
}

/// What a query finds: where, and which primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter; infinite for a miss.
    pub t: f32,
    /// First barycentric or surface coordinate; for a triangle the weight of its second vertex.
    pub u: f32,
    /// Second coordinate; for a triangle the weight of its third vertex.
    pub v: f32,
    /// Number of the primitive, or [`NONE`] for a miss.
    pub primitive: u32,
    /// Number of the instance, or [`NONE`] where the primitive is not instanced.
    pub instance: u32,
}

impl Hit {
    /// No hit.
    pub const MISS: Self = Self { t: f32::INFINITY, u: 0.0, v: 0.0, primitive: NONE, instance: NONE };

    /// True if something was hit.
    #[inline(always)]
    pub fn is_hit(&self) -> bool {
        self.primitive != NONE
    }
}

/// Many rays, row by row.
///
/// Rays are born in this shape and stay in it. All rows have the same length.
#[derive(Clone, Debug, Default)]
pub struct RayBatch {
    /// Origins.
    pub origin: Vec3<Vec<f32>>,
    /// Directions.
    pub direction: Vec3<Vec<f32>>,
    /// Lower ends of the parameter ranges.
    pub t_min: Vec<f32>,
    /// Upper ends of the parameter ranges.
    pub t_max: Vec<f32>,
}

impl RayBatch {
    /// An empty batch.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of rays.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.t_max.len()
    }

    /// True if there are no rays.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.t_max.is_empty()
    }

    /// Remove all rays, keep the memory.
    pub fn clear(&mut self) {
        self.rows().into_iter().for_each(Vec::clear);
    }

    /// Keep the first `len` rays.
    pub fn truncate(&mut self, len: usize) {
        self.rows().into_iter().for_each(|row| row.truncate(len));
    }

    /// Make every row `len` long; new rays are zero and hit nothing.
    pub fn resize(&mut self, len: usize) {
        self.rows().into_iter().for_each(|row| row.resize(len, 0.0));
    }

    /// Append one ray.
    #[inline(always)]
    pub fn push(&mut self, ray: &Ray) {
        self.origin.x.push(ray.origin.x);
        self.origin.y.push(ray.origin.y);
        self.origin.z.push(ray.origin.z);
        self.direction.x.push(ray.direction.x);
        self.direction.y.push(ray.direction.y);
        self.direction.z.push(ray.direction.z);
        self.t_min.push(ray.t_min);
        self.t_max.push(ray.t_max);
    }

    /// Ray number `index`.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Ray {
        let at = |rows: &Vec3<Vec<f32>>| Vec3::new(rows.x[index], rows.y[index], rows.z[index]);
        Ray {
            origin: at(&self.origin),
            direction: at(&self.direction),
            t_min: self.t_min[index],
            t_max: self.t_max[index],
        }
    }

    fn rows(&mut self) -> [&mut Vec<f32>; 8] {
        let (o, d) = (&mut self.origin, &mut self.direction);
        [&mut o.x, &mut o.y, &mut o.z, &mut d.x, &mut d.y, &mut d.z, &mut self.t_min, &mut self.t_max]
    }
}

impl<'a> FromIterator<&'a Ray> for RayBatch {
    fn from_iter<I: IntoIterator<Item = &'a Ray>>(rays: I) -> Self {
        let mut batch = Self::new();
        rays.into_iter().for_each(|ray| batch.push(ray));
        batch
    }
}

/// Many hits, row by row: the answers to a [`RayBatch`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HitBatch {
    /// Ray parameters; infinite for a miss.
    pub t: Vec<f32>,
    /// First surface coordinates.
    pub u: Vec<f32>,
    /// Second surface coordinates.
    pub v: Vec<f32>,
    /// Primitives, or [`NONE`].
    pub primitive: Vec<u32>,
    /// Instances, or [`NONE`].
    pub instance: Vec<u32>,
}

impl HitBatch {
    /// Number of hits.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// True if there are none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// Make every row `len` long; new hits are misses.
    pub fn resize(&mut self, len: usize) {
        self.t.resize(len, Hit::MISS.t);
        self.u.resize(len, Hit::MISS.u);
        self.v.resize(len, Hit::MISS.v);
        self.primitive.resize(len, Hit::MISS.primitive);
        self.instance.resize(len, Hit::MISS.instance);
    }

    /// Make the hits in a range misses.
    ///
    /// # Panics
    /// If the range is not within the batch.
    pub fn reset(&mut self, range: Range<usize>) {
        HitsMut::from(&mut *self).clear(range.clone());
        self.instance[range].fill(Hit::MISS.instance);
    }

    /// Hit number `index`.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Hit {
        Hit {
            t: self.t[index],
            u: self.u[index],
            v: self.v[index],
            primitive: self.primitive[index],
            instance: self.instance[index],
        }
    }

    /// Replace hit number `index`.
    #[inline(always)]
    pub fn set(&mut self, index: usize, hit: Hit) {
        self.t[index] = hit.t;
        self.u[index] = hit.u;
        self.v[index] = hit.v;
        self.primitive[index] = hit.primitive;
        self.instance[index] = hit.instance;
    }
}
