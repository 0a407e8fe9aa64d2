//! Rays that have little in common with their neighbours, put in order before they are walked.
//!
//! A list of rays goes down the tree together for as long as it is long. Sixteen thousand rays that start anywhere and run
//! anywhere part after two or three levels; but of a million such rays, those that start in one of 64 cells and run into
//! one octant stay together for much longer. To sort rays before they are traced is an old idea (Pharr, Kolb, Gershbein,
//! Hanrahan, "Rendering Complex Scenes with Memory-Coherent Ray Tracing", SIGGRAPH 1997; Garanzha, Loop, "Fast Ray
//! Sorting and Breadth-First Packet Traversal for GPU Ray Tracing", Eurographics 2010).
//!
//! It must cost little, for a ray takes a tenth of a microsecond. A sorted list of ray numbers would have every ray and
//! every answer come from a cache line and a page of its own. Instead the rays are moved, in one pass that reads
//! them as they come and writes to 512 places in turn; and the answers return in a pass that goes through the same cells
//! in the same sequence, and so reads from 512 places in turn (docs/decisions/0011).

use super::query::chunks;
use super::walk::{load, sign, transposed};
use crate::math::Vec3;
use crate::ray::{HitBatch, HitsMut, RayBatch, Rays};
use crate::tree::Occlusion;
use simd::{F32Lanes, Kernel, Level, Octet, Simd, U32Lanes};
use std::ops::Range;

/// Most rays that are put in order together: what they need beside the caller's arrays is 50 bytes each.
pub(super) const MOST: usize = 1 << 20;

/// Cells of the grid over the origins, each with eight octants of directions.
const GRID: u32 = 64;
const OCTANTS: u32 = 8;
const CELLS: usize = (GRID * OCTANTS) as usize;

/// How far ahead of need the memory is asked for the place of a ray and for a hit: a cache line.
const PLACES_AHEAD: usize = 2;
const HITS_AHEAD: usize = 4;

const LANES: usize = 16;
type U32<S> = <<S as Simd>::F32x16 as F32Lanes>::U32;

/// Rays in order and their answers; memory that is kept from call to call.
#[derive(Debug, Default)]
pub(super) struct Reorder {
    /// The cell of each ray, in the caller's order.
    cells: Vec<u16>,
    /// Where the rays of each cell begin.
    starts: Vec<u32>,
    /// Origin, direction, range.
    rays: Vec<Octet>,
    /// t, u, v and the bits of the primitive.
    hits: Vec<[f32; 4]>,
    occlusion: Vec<Occlusion>,
    chunk: RayBatch,
    chunk_hits: HitBatch,
}

impl Reorder {
    /// Put rays in order, at most [`MOST`].
    pub(super) fn sort(&mut self, level: Level, rays: Rays<'_>) {
        assert!(rays.len() <= MOST, "their numbers fit, and their memory is bounded");
        self.cells.resize(rays.len().next_multiple_of(LANES), 0);
        self.starts.resize(CELLS, 0);
        make_room(&mut self.rays, rays.len());
        simd::dispatch(level, Sort { to: self, rays });
    }

    /// Find the first hits of the rays in order, chunk by chunk, with `find`, and give them back in the caller's order.
    pub(super) fn hits(&mut self, level: Level, mut out: HitsMut<'_>, mut find: impl FnMut(Rays<'_>, HitsMut<'_>)) {
        make_room(&mut self.hits, out.len());
        for chunk in chunks(out.len()) {
            self.take(level, chunk.clone());
            self.chunk_hits.resize(chunk.len());
            find((&self.chunk).into(), (&mut self.chunk_hits).into());
            simd::dispatch(level, KeepHits { from: &self.chunk_hits, to: &mut self.hits[chunk] });
        }
        simd::dispatch(level, ReturnHits { cursor: &mut self.cursor(), from: self, to: &mut out });
    }

    /// As [`hits`](Self::hits), for what blocks rays.
    pub(super) fn occlusion(
        &mut self,
        level: Level,
        out: &mut [Occlusion],
        mut find: impl FnMut(Rays<'_>, &mut [Occlusion]),
    ) {
        self.occlusion.resize(out.len(), Occlusion::Clear);
        for chunk in chunks(out.len()) {
            self.take(level, chunk.clone());
            find((&self.chunk).into(), &mut self.occlusion[chunk]);
        }
        let mut cursor = self.cursor();
        for (out, &cell) in out.iter_mut().zip(&self.cells) {
            *out = self.occlusion[cursor.next(cell)];
        }
    }

    /// Make a chunk of the rays in order the one at hand.
    fn take(&mut self, level: Level, chunk: Range<usize>) {
        self.chunk.resize(chunk.len());
        simd::dispatch(level, Take { from: &self.rays[chunk], to: &mut self.chunk });
    }

    fn cursor(&self) -> Cursor {
        Cursor(*self.starts.first_chunk().expect("a start for each cell"))
    }
}

/// Make a table so long. Its memory had better be of few pages, since 512 places in it are in use at a time.
fn make_room<T: Clone + Default>(table: &mut Vec<T>, len: usize) {
    if table.capacity() < len {
        *table = Vec::with_capacity(len);
        simd::advise_huge_pages(table.spare_capacity_mut());
    }
    table.resize(len, T::default());
}

/// The place of the next ray of each cell.
struct Cursor([u32; CELLS]);

impl Cursor {
    /// The place of the next ray of a cell.
    #[inline(always)]
    fn next(&mut self, cell: u16) -> usize {
        let next = &mut self.0[usize::from(cell) % CELLS];
        *next += 1;
        *next as usize - 1
    }
}

/// A grid over the origins of rays, its cells about as wide as they are high and deep.
struct Grid {
    lo: [f32; 3],
    /// Cells per unit, and cells.
    scale: [f32; 3],
    sides: [f32; 3],
}

impl Grid {
    /// Around a sixteenth of the rays: those outside count to the cells at the border.
    #[inline(always)]
    fn around<S: Simd>(token: S, origin: Vec3<&[f32]>) -> Self {
        let (mut lo, mut extent) = ([0.0; 3], [0.0; 3]);
        for (axis, row) in [origin.x, origin.y, origin.z].into_iter().enumerate() {
            let (mut least, mut most) =
                (S::F32x16::splat(token, f32::INFINITY), S::F32x16::splat(token, f32::NEG_INFINITY));
            for some in row.chunks_exact(LANES).step_by(16) {
                let some = S::F32x16::load_slice(token, some);
                let finite = some.abs().lt(S::F32x16::splat(token, f32::INFINITY));
                least = S::F32x16::select(finite, some, least).min(least);
                most = S::F32x16::select(finite, some, most).max(most);
            }
            lo[axis] = least.reduce_min();
            extent[axis] = most.reduce_max() - lo[axis];
        }
        let sides = sides(extent);
        let scale = std::array::from_fn(|axis| sides[axis] / extent[axis].max(f32::MIN_POSITIVE));
        Self { lo, scale, sides }
    }

    /// The cells of rays that start at `origin` in directions with these signs.
    #[inline(always)]
    fn cells<S: Simd>(&self, token: S, origin: Vec3<S::F32x16>, direction: Vec3<S::F32x16>) -> U32<S> {
        let (x, y, z) = (self.step(token, 0, origin.x), self.step(token, 1, origin.y), self.step(token, 2, origin.z));
        let (rows, columns) = (S::F32x16::splat(token, self.sides[1]), S::F32x16::splat(token, self.sides[2]));
        let octant = sign(direction.x) | sign(direction.y).shl::<1>() | sign(direction.z).shl::<2>();
        ((x * rows + y) * columns + z).round_to_int().shl::<3>() | octant
    }

    /// The step of the grid along an axis.
    #[inline(always)]
    fn step<F: F32Lanes>(&self, token: F::Token, axis: usize, at: F) -> F {
        let at = (at - F::splat(token, self.lo[axis])) * F::splat(token, self.scale[axis]);
        // A NaN becomes 0.
        at.max(F::splat(token, 0.0)).min(F::splat(token, self.sides[axis] - 1.0)).floor()
    }
}

/// How many cells a grid has along each axis: the longest is halved until there are enough.
fn sides(mut extent: [f32; 3]) -> [f32; 3] {
    let mut sides = [1.0; 3];
    for _ in 0..GRID.ilog2() {
        let longest = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).expect("three axes");
        sides[longest] *= 2.0;
        extent[longest] /= 2.0;
    }
    sides
}

/// Moves rays to where those of their cells are.
struct Sort<'a> {
    to: &'a mut Reorder,
    rays: Rays<'a>,
}

impl Kernel for Sort<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { to: Reorder { cells, starts, rays: records, .. }, rays } = self;
        let grid = Grid::around(token, rays.origin);
        let mut counts = [0u32; CELLS];
        for first in (0..rays.len()).step_by(LANES) {
            let step = first..rays.len().min(first + LANES);
            let origin = load(token, rays.origin, step.clone());
            let direction = load(token, rays.direction, step.clone());
            let mut stored = [0; LANES];
            grid.cells(token, origin, direction).store(&mut stored);
            for (cell, stored) in cells[first..first + LANES].iter_mut().zip(stored) {
                *cell = stored as u16;
            }
            for &cell in &stored[..step.len()] {
                counts[cell as usize % CELLS] += 1;
            }
        }
        let mut sum = 0;
        for (start, count) in starts.iter_mut().zip(counts) {
            *start = sum;
            sum += count;
        }
        let mut cursor = Cursor(*starts.first_chunk().expect("a start for each cell"));
        for first in (0..rays.len()).step_by(LANES) {
            let step = first..rays.len().min(first + LANES);
            let (o, d) = (load(token, rays.origin, step.clone()), load(token, rays.direction, step.clone()));
            let range = [rays.t_min.lanes(token, step.clone()), rays.t_max.lanes(token, step.clone())];
            let columns = transposed(token, [o.x, o.y, o.z, d.x, d.y, d.z, range[0], range[1]]);
            for (column, &cell) in columns[..step.len()].iter().zip(&cells[step]) {
                let place = cursor.next(cell);
                column.store(&mut records[place].0);
                simd::prefetch(records, place + PLACES_AHEAD);
            }
        }
    }
}

/// Makes rows of records.
struct Take<'a> {
    from: &'a [Octet],
    to: &'a mut RayBatch,
}

impl Kernel for Take<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        const STEP: usize = 8;
        let Self { from, to: RayBatch { origin: o, direction: d, t_min, t_max } } = self;
        let (steps, rest) = from.as_chunks::<STEP>();
        for (records, first) in steps.iter().zip((0..).step_by(STEP)) {
            let mut columns = [S::F32x8::splat(token, 0.0); STEP];
            for (column, record) in columns.iter_mut().zip(records) {
                *column = S::F32x8::load(token, &record.0);
            }
            let rows = token.transpose(columns);
            let to = [&mut o.x, &mut o.y, &mut o.z, &mut d.x, &mut d.y, &mut d.z, t_min, t_max];
            for (row, to) in rows.into_iter().zip(to) {
                row.store_slice(&mut to[first..]);
            }
        }
        for (index, record) in (steps.len() * STEP..).zip(rest) {
            let [ox, oy, oz, dx, dy, dz, start, end] = record.0;
            (o.x[index], o.y[index], o.z[index]) = (ox, oy, oz);
            (d.x[index], d.y[index], d.z[index]) = (dx, dy, dz);
            (t_min[index], t_max[index]) = (start, end);
        }
    }
}

/// Makes records of the hits of a chunk.
struct KeepHits<'a> {
    from: &'a HitBatch,
    to: &'a mut [[f32; 4]],
}

impl Kernel for KeepHits<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        const STEP: usize = 8;
        let Self { from, to } = self;
        let zero = S::F32x8::splat(token, 0.0);
        let (steps, rest) = to.as_chunks_mut::<STEP>();
        let whole = steps.len() * STEP;
        for (records, first) in steps.iter_mut().zip((0..).step_by(STEP)) {
            let t = S::F32x8::load_slice(token, &from.t[first..]);
            let u = S::F32x8::load_slice(token, &from.u[first..]);
            let v = S::F32x8::load_slice(token, &from.v[first..]);
            let primitive = <S::F32x8 as F32Lanes>::U32::load_slice(token, &from.primitive[first..]);
            let rows = [t, u, v, S::F32x8::from_bits(primitive), zero, zero, zero, zero];
            for (record, column) in records.iter_mut().zip(token.transpose(rows)) {
                let mut stored = [0.0; 8];
                column.store(&mut stored);
                *record = *stored.first_chunk().expect("eight numbers");
            }
        }
        for (index, record) in (whole..).zip(rest) {
            *record = [from.t[index], from.u[index], from.v[index], f32::from_bits(from.primitive[index])];
        }
    }
}

/// Gives hits back in the caller's order.
struct ReturnHits<'a, 'h> {
    cursor: &'a mut Cursor,
    from: &'a Reorder,
    to: &'a mut HitsMut<'h>,
}

impl Kernel for ReturnHits<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, token: S) {
        let Self { cursor, from: Reorder { cells, hits, .. }, to } = self;
        let len = to.len();
        for first in (0..len / LANES * LANES).step_by(LANES) {
            let mut places = [0; LANES];
            for (place, &cell) in places.iter_mut().zip(&cells[first..first + LANES]) {
                *place = cursor.next(cell) as u32;
                simd::prefetch(hits, *place as usize + HITS_AHEAD);
            }
            let [t, u, v, primitive] = S::F32x16::gather_x4(hits, U32::<S>::load(token, &places));
            t.store_slice(&mut to.t[first..]);
            u.store_slice(&mut to.u[first..]);
            v.store_slice(&mut to.v[first..]);
            primitive.to_bits().store_slice(&mut to.primitive[first..]);
        }
        for index in len / LANES * LANES..len {
            let [t, u, v, primitive] = hits[cursor.next(cells[index])];
            (to.t[index], to.u[index], to.v[index]) = (t, u, v);
            to.primitive[index] = primitive.to_bits();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SplitMix64;
    use crate::ray::Ray;
    use simd::Level;

    const LEN: usize = 50_001;

    /// Rays from all over a box, some from nowhere; their ranges end at their numbers.
    fn rays() -> RayBatch {
        let mut random = SplitMix64::new(1);
        let mut component = || random.uniform(-1.0, 1.0) as f32;
        let mut batch: RayBatch = RayBatch::new();
        for number in 0..LEN {
            let mut ray =
                Ray::new([component(), 3.0 * component(), component()], [component(), component(), component()]);
            match number % 1000 {
                17 => ray.origin.x = f32::NAN,
                18 => ray.origin.y = f32::INFINITY,
                19 => ray.direction.z = f32::NEG_INFINITY,
                _ => {}
            }
            (ray.t_min, ray.t_max) = (-1.0, number as f32);
            batch.push(&ray);
        }
        batch
    }

    #[test]
    fn hits_return_to_their_rays() {
        let rays = rays();
        for level in Level::available() {
            let mut reorder = Reorder::default();
            for len in [LEN, 0, 1, 15, 33, 40_000] {
                let rays = Rays::from(&rays).slice(0..len);
                let mut hits = HitBatch::default();
                hits.resize(len);
                reorder.sort(level, rays);
                reorder.hits(level, (&mut hits).into(), |rays, hits| {
                    for index in 0..rays.len() {
                        let ray = rays.get(index);
                        (hits.t[index], hits.u[index], hits.v[index]) = (ray.t_max, ray.origin.x, ray.direction.y);
                        hits.primitive[index] = ray.direction.z.to_bits();
                        assert_eq!(ray.t_min, -1.0);
                    }
                });
                for index in 0..len {
                    let (ray, hit) = (rays.get(index), hits.get(index));
                    let bits = [hit.t, hit.u, hit.v].map(f32::to_bits);
                    assert_eq!(bits, [index as f32, ray.origin.x, ray.direction.y].map(f32::to_bits));
                    assert_eq!(hit.primitive, ray.direction.z.to_bits());
                }
            }
        }
    }

    #[test]
    fn occlusion_returns_to_its_rays() {
        let rays = rays();
        let is_blocked = |ray: Ray| if ray.t_max % 3.0 == 0.0 { Occlusion::Blocked } else { Occlusion::Clear };
        let mut out = vec![Occlusion::Filtered; LEN];
        let mut reorder = Reorder::default();
        reorder.sort(Level::best(), (&rays).into());
        reorder.occlusion(Level::best(), &mut out, |rays, out| {
            for (index, out) in out.iter_mut().enumerate() {
                *out = is_blocked(rays.get(index));
            }
        });
        assert!(out.iter().enumerate().all(|(index, &out)| out == is_blocked(rays.get(index))));
    }

    #[test]
    fn neighbours_have_much_in_common() {
        let rays = rays();
        let mut reorder = Reorder::default();
        reorder.sort(Level::best(), (&rays).into());
        let (mut apart, mut turns) = (0.0, 0);
        for pair in reorder.rays.windows(2) {
            let [a, b] = [pair[0].0, pair[1].0];
            let along =
                |axis: usize| if a[axis].is_finite() && b[axis].is_finite() { (a[axis] - b[axis]).abs() } else { 0.0 };
            apart += along(0) + along(1) / 3.0 + along(2);
            turns += usize::from((3..6).any(|axis| a[axis].is_sign_negative() != b[axis].is_sign_negative()));
        }
        let mean = apart / LEN as f32;
        assert!(mean < 0.7, "of rays in no order 2: {mean}");
        assert!(turns < CELLS, "of one octant, until the next cell: {turns}");
    }

    #[test]
    fn cells_are_cubes() {
        assert_eq!(sides([1.0; 3]), [4.0; 3]);
        assert_eq!(sides([10.0, 9.0, 0.1]), [8.0, 8.0, 1.0]);
        assert_eq!(sides([0.0; 3]).iter().product::<f32>(), GRID as f32);
        assert_eq!(sides([f32::NAN, f32::NEG_INFINITY, 1.0]).iter().product::<f32>(), GRID as f32);
    }
}
