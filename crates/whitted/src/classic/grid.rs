//! The uniform grid that the paper's kd-tree is four times as fast as.

use super::kd_tree::multiplied;
use crate::geometry::Primitives;
use crate::math::{Aabb, Vec3f};
use crate::tree::Fit;
use std::ops::RangeInclusive;

/// Boxes grow by this times the largest coordinate of the scene: covers the rounding of rays that start up to 127 times
/// as far away ([`Fit::error`]). Rays from farther away test every object.
const PADDING: f32 = 1.0 / (1 << 12) as f32;

/// Cells for each object (Wald et al., "Ray Tracing Animated Scenes Using Coherent Grid Traversal", 2006, §4: about 5).
const DENSITY: f64 = 5.0;

/// No more cells along an axis: each is then at least eight paddings wide.
const MAX_RESOLUTION: usize = 1024;

/// References for each object, on average; a grid that would have more is made coarser.
const MAX_REFERENCES: usize = 32;

/// Fewer references than this are never too many.
const FREE_REFERENCES: usize = 4096;

/// A uniform grid over a scene's bounded primitives.
#[derive(Clone, Debug)]
pub struct Grid {
    pub(super) bounds: Aabb,
    pub(super) fit: Fit,
    resolution: [usize; 3],
    size: Vec3f,
    /// Where each cell's objects begin; one more than cells.
    starts: Vec<u32>,
    objects: Vec<u32>,
}

/// What was built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GridReport {
    /// Cells along each axis.
    pub resolution: [usize; 3],
    /// References to objects from all cells.
    pub references: usize,
    /// Bytes of cells and references.
    pub bytes: usize,
}

impl Grid {
    /// Build the grid. Bounded in time and memory for any input.
    pub fn build(primitives: &Primitives) -> Self {
        let fit = Fit::new(primitives.bounds());
        let padding = PADDING * primitives.bounds().max_abs() * fit.scale();
        let padded = |id| primitives.primitive_bounds(id).map(|b| multiplied(b, fit.scale()).grown(padding));
        let boxes: Vec<Option<Aabb>> = (0..primitives.bounded_count() as u32).map(padded).collect();
        let bounds = boxes.iter().flatten().fold(Aabb::EMPTY, |sum, &b| sum.union(b));
        let mut grid =
            Self { bounds, fit, resolution: [1; 3], size: Vec3f::ONE, starts: vec![0; 2], objects: Vec::new() };
        if bounds.is_empty() {
            return grid;
        }
        let count = boxes.iter().flatten().count();
        let mut cells = DENSITY * count as f64;
        loop {
            grid.resolve(cells);
            let references: usize = boxes.iter().flatten().map(|b| grid.cells_of(b).count()).sum();
            if references <= (MAX_REFERENCES * count).max(FREE_REFERENCES) || grid.resolution == [1; 3] {
                break;
            }
            cells *= 0.5;
        }
        grid.fill(&boxes);
        grid
    }

    /// The least number of nearly cubic cells that is not below `cells`, within the limits.
    fn resolve(&mut self, cells: f64) {
        let extent = self.bounds.size();
        let longest = extent.max_component();
        for along_longest in 1..=MAX_RESOLUTION {
            let along = |axis: usize| ((extent[axis] / longest * along_longest as f32).round() as usize).max(1);
            self.resolution = [0, 1, 2].map(along);
            if self.resolution.iter().map(|&count| count as f64).product::<f64>() >= cells {
                break;
            }
        }
        let [x, y, z] = self.resolution.map(|count| count as f32);
        self.size = extent.zip(Vec3f::new(x, y, z), |length, count| length / count);
    }

    /// Sort the objects into the cells: count, then place.
    fn fill(&mut self, boxes: &[Option<Aabb>]) {
        let cells: usize = self.resolution.iter().product();
        let mut ends = vec![0_u32; cells + 1];
        for bounds in boxes.iter().flatten() {
            self.cells_of(bounds).for_each(|cell| ends[cell] += 1);
        }
        let mut total = 0;
        for end in &mut ends {
            total += *end;
            *end = total;
        }
        let mut objects = vec![0; total as usize];
        // From behind, so that ends become starts and objects ascend within their cells.
        for (id, bounds) in boxes.iter().enumerate().rev().filter_map(|(id, b)| Some((id, b.as_ref()?))) {
            self.cells_of(bounds).for_each(|cell| {
                ends[cell] -= 1;
                objects[ends[cell] as usize] = id as u32;
            });
        }
        (self.starts, self.objects) = (ends, objects);
    }

    /// What was built.
    pub fn report(&self) -> GridReport {
        let bytes = size_of_val(&self.starts[..]) + size_of_val(&self.objects[..]);
        GridReport { resolution: self.resolution, references: self.objects.len(), bytes }
    }

    /// The box of all cells, in the coordinates of the primitives.
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.bounds.lo / self.fit.scale(), self.bounds.hi / self.fit.scale())
    }

    #[inline(always)]
    pub(super) fn resolution(&self) -> [usize; 3] {
        self.resolution
    }

    /// Whether boxes are large enough for rays whose origin has no larger coordinate than `distance`.
    #[inline(always)]
    pub(super) fn covers(&self, distance: f32) -> bool {
        self.fit.error(distance) <= PADDING * self.fit.max_coordinate()
    }

    /// Number of a cell in the order of memory.
    #[inline(always)]
    pub(super) fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.resolution[1] + y) * self.resolution[0] + x
    }

    /// The objects of a cell.
    #[inline(always)]
    pub(super) fn objects(&self, cell: usize) -> &[u32] {
        &self.objects[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Lower border of a layer of cells across `axis`.
    #[inline(always)]
    pub(super) fn plane(&self, axis: usize, layer: usize) -> f32 {
        self.bounds.lo[axis] + self.size[axis] * layer as f32
    }

    /// The cell of a point; the nearest one for a point outside, anything for NaN.
    #[inline(always)]
    pub(super) fn cell_of(&self, point: Vec3f) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.layer(axis, point[axis]))
    }

    #[inline(always)]
    fn layer(&self, axis: usize, position: f32) -> usize {
        // Negative numbers and NaN become 0.
        (((position - self.bounds.lo[axis]) / self.size[axis]) as usize).min(self.resolution[axis] - 1)
    }

    /// Numbers of all cells that a box reaches into.
    fn cells_of(&self, bounds: &Aabb) -> impl Iterator<Item = usize> {
        let layers = |axis: usize| -> RangeInclusive<usize> {
            self.layer(axis, bounds.lo[axis])..=self.layer(axis, bounds.hi[axis])
        };
        let (xs, ys, [row, plane]) =
            (layers(0), layers(1), [self.resolution[0], self.resolution[0] * self.resolution[1]]);
        layers(2).flat_map(move |z| {
            let xs = xs.clone();
            ys.clone().flat_map(move |y| xs.clone().map(move |x| z * plane + y * row + x))
        })
    }
}
