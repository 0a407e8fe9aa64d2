//! What lamps send to surfaces, before anything stands in the way: once for any number of points.

use super::shadow::ShadowBatch;
use crate::geometry::triangle::ERROR_ULPS;
use crate::math::{Vec3, Vec3f};
use crate::ray::Ray;
use crate::scene::ShadowOrigin;
use crate::shading::one::{one, value, values};
use crate::shading::{LocalSurface, PreparedLight, lanes};
use simd::{F32Lanes, Kernel, Level, MaskLanes, Scalar, Simd};

/// A point of a surface as lamps see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LitPoint<T> {
    pub(super) position: Vec3<T>,
    /// Geometric unit normal on the side of the viewer.
    pub(super) n_g: Vec3<T>,
    /// Shading unit normal on the side of the viewer.
    pub(super) n_s: Vec3<T>,
    /// Unit direction to the viewer.
    pub(super) view: Vec3<T>,
    /// How far from the surface secondary rays must start.
    pub(super) error: T,
    /// The local model, multiplied by the weight of the ray that came here.
    pub(super) surface: LocalSurface<T>,
}

/// What a lamp sends to a point, and the segment that must be free for it.
struct Sent<L: F32Lanes> {
    /// Lanes whose surface faces the lamp, by either normal.
    faces: L::Mask,
    /// Light that the sample gains.
    light: Vec3<L>,
    origin: Vec3<L>,
    direction: Vec3<L>,
    t_max: L,
}

impl<L: F32Lanes> LitPoint<L> {
    /// What `light` sends here.
    #[inline(always)]
    fn receive(&self, token: L::Token, light: &PreparedLight, origin: ShadowOrigin) -> Sent<L> {
        let splat = |value| L::splat(token, value);
        let arriving = light.at_lanes(token, self.position);
        let faces = |normal: Vec3<L>| normal.dot(arriving.direction).gt(splat(0.0));
        let answer = lanes::answer(token, &self.surface, self.n_s, arriving.direction, self.view);
        // Intersection is exact to a few ulp of distances from the ray's origin, so a ray that comes from the light
        // needs an end that lies farther off the surface than one that starts here.
        let (from, direction, t_max) = match origin {
            ShadowOrigin::Light(from) => {
                let from = from.map(splat);
                let error = self.error + splat(f32::EPSILON * ERROR_ULPS) * arriving.distance;
                (from, self.off_surface(error) - from, splat(1.0f32.next_down()))
            }
            ShadowOrigin::Surface => (self.off_surface(self.error), arriving.direction, arriving.distance),
        };
        Sent {
            faces: faces(self.n_g) & faces(self.n_s),
            light: answer.times(arriving.light),
            origin: from,
            direction,
            t_max,
        }
    }

    /// The point `by` above the surface, on the side of the viewer.
    #[inline(always)]
    fn off_surface(&self, by: L) -> Vec3<L> {
        self.position + self.n_g * by
    }
}

impl LitPoint<f32> {
    /// The shadow ray to a light and the light that arrives if nothing is in between; `None` if the surface is turned
    /// away from it.
    pub(super) fn toward(&self, light: &PreparedLight, origin: ShadowOrigin) -> Option<(Ray, Vec3f)> {
        let sent = self.map(one).receive(Scalar, light, origin);
        let ray = Ray {
            origin: values(sent.origin),
            direction: values(sent.direction),
            t_min: 0.0,
            t_max: value(sent.t_max),
        };
        sent.faces.any().then(|| (ray, values(sent.light)))
    }
}

impl<T: Copy> LitPoint<T> {
    /// `f` of every number.
    fn map<U>(self, mut f: impl FnMut(T) -> U) -> LitPoint<U> {
        LitPoint {
            position: self.position.map(&mut f),
            n_g: self.n_g.map(&mut f),
            n_s: self.n_s.map(&mut f),
            view: self.view.map(&mut f),
            error: f(self.error),
            surface: self.surface.map(&mut f),
        }
    }
}

/// Points that are lit together: the lanes of a kernel.
const BLOCK: usize = 16;

/// Points in the order of a structure of arrays, sixteen by sixteen.
#[derive(Debug, Default)]
pub(super) struct LitPoints {
    blocks: Vec<Block>,
    len: usize,
}

#[derive(Clone, Copy, Debug)]
struct Block {
    points: LitPoint<[f32; BLOCK]>,
    samples: [u32; BLOCK],
}

impl LitPoints {
    pub(super) fn clear(&mut self) {
        self.blocks.clear();
        self.len = 0;
    }

    /// Append a point of a sample.
    pub(super) fn push(&mut self, sample: u32, point: &LitPoint<f32>) {
        let lane = self.len % BLOCK;
        if lane == 0 {
            // Lanes that stay unused have no normal, and so face no light.
            self.blocks.push(Block { points: LitPoint::NOWHERE, samples: [0; BLOCK] });
        }
        if let Some(block) = self.blocks.last_mut() {
            block.points.set(lane, point);
            block.samples[lane] = sample;
        }
        self.len += 1;
    }

    /// Queue the shadow rays of all points that face `light`.
    pub(super) fn light(&self, level: Level, light: &PreparedLight, origin: ShadowOrigin, shadows: &mut ShadowBatch) {
        simd::dispatch(level, LightAll { blocks: &self.blocks, light, origin, shadows });
    }
}

impl LitPoint<[f32; BLOCK]> {
    const NOWHERE: Self = {
        const ROW: [f32; BLOCK] = [0.0; BLOCK];
        const ROWS: Vec3<[f32; BLOCK]> = Vec3::new(ROW, ROW, ROW);
        let surface = LocalSurface { diffuse: ROWS, specular: ROWS, exponent: ROW, is_blinn: ROW };
        Self { position: ROWS, n_g: ROWS, n_s: ROWS, view: ROWS, error: ROW, surface }
    };

    fn set(&mut self, lane: usize, point: &LitPoint<f32>) {
        let set3 = |rows: &mut Vec3<[f32; BLOCK]>, value: Vec3f| {
            (rows.x[lane], rows.y[lane], rows.z[lane]) = (value.x, value.y, value.z);
        };
        set3(&mut self.position, point.position);
        set3(&mut self.n_g, point.n_g);
        set3(&mut self.n_s, point.n_s);
        set3(&mut self.view, point.view);
        set3(&mut self.surface.diffuse, point.surface.diffuse);
        set3(&mut self.surface.specular, point.surface.specular);
        self.error[lane] = point.error;
        self.surface.exponent[lane] = point.surface.exponent;
        self.surface.is_blinn[lane] = point.surface.is_blinn;
    }

    #[inline(always)]
    fn load<S: Simd>(&self, token: S) -> LitPoint<S::F32x16> {
        let row = |row: &[f32; BLOCK]| S::F32x16::load(token, row);
        let rows = |rows: &Vec3<[f32; BLOCK]>| Vec3::new(row(&rows.x), row(&rows.y), row(&rows.z));
        LitPoint {
            position: rows(&self.position),
            n_g: rows(&self.n_g),
            n_s: rows(&self.n_s),
            view: rows(&self.view),
            error: row(&self.error),
            surface: LocalSurface {
                diffuse: rows(&self.surface.diffuse),
                specular: rows(&self.surface.specular),
                exponent: row(&self.surface.exponent),
                is_blinn: row(&self.surface.is_blinn),
            },
        }
    }
}

/// The kernel of [`LitPoints::light`].
struct LightAll<'a> {
    blocks: &'a [Block],
    light: &'a PreparedLight,
    origin: ShadowOrigin,
    shadows: &'a mut ShadowBatch,
}

impl Kernel for LightAll<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        for block in self.blocks {
            let sent = block.points.load(token).receive(token, self.light, self.origin);
            let mut faces = sent.faces.bits();
            if faces == 0 {
                continue;
            }
            let (light, origin, direction) = (stored(sent.light), stored(sent.origin), stored(sent.direction));
            let mut t_max = [0.0; BLOCK];
            sent.t_max.store(&mut t_max);
            while faces != 0 {
                let lane = faces.trailing_zeros() as usize;
                let at = |rows: &Vec3<[f32; BLOCK]>| Vec3f::new(rows.x[lane], rows.y[lane], rows.z[lane]);
                let ray = Ray { origin: at(&origin), direction: at(&direction), t_min: 0.0, t_max: t_max[lane] };
                self.shadows.push(&ray, block.samples[lane], at(&light));
                faces &= faces - 1;
            }
        }
    }
}

#[inline(always)]
fn stored<L: F32Lanes<Array = [f32; BLOCK]>>(lanes: Vec3<L>) -> Vec3<[f32; BLOCK]> {
    lanes.map(|row| {
        let mut array = [0.0; BLOCK];
        row.store(&mut array);
        array
    })
}
