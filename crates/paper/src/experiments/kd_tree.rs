//! Figures 1 and 2: a slice through the kd-tree, and a ray on its way through it.

use super::stock::Stock;
use crate::draw::{Path, Plan, Rect, Role, plan};
use crate::report::{Block, Drawing, Section, plural};
use crate::session::Session;
use std::ops::RangeInclusive;
use whitted::classic::{
    Caster, CellContent, Event, KdTree, Math, NodeId, Objects, Split, Structure, Trace, TriangleTest, Walk,
};
use whitted::geometry::{Primitives, Sphere};
use whitted::math::Vec3f;
use whitted::ray::Ray;
use whitted::render::Cancelled;
use whitted::scene::generate::PaperFamily;

/// Spheres in the drawn scene: as many as a slice shows clearly.
const SPHERES: u32 = 100;

/// Where the slice lies on the axis towards the viewer: a plane through the cube in which spheres are cut near their
/// middle.
const HEIGHT: f32 = 0.1;

/// The scene, and the tree over it.
struct Sliced {
    stock: Stock,
    structure: Structure,
}

impl Sliced {
    fn new(session: &Session) -> Self {
        let stock = Stock::spheres(PaperFamily::Mix, SPHERES, session.effort.size, &session.one);
        let structure = Structure::Kd(KdTree::build(stock.prepared.geometry().primitives(), Split::Sah));
        Self { stock, structure }
    }

    fn primitives(&self) -> &Primitives {
        self.stock.prepared.geometry().primitives()
    }

    fn tree(&self) -> &KdTree {
        match &self.structure {
            Structure::Kd(tree) => tree,
            Structure::Naive | Structure::Grid(_) => unreachable!("a kd-tree was built"),
        }
    }

    /// The leaves that the plane cuts: what they are, and whether they are among `visited`.
    fn cells(&self, visited: &[NodeId]) -> Vec<Rect> {
        let cells = self.tree().cells().filter_map(|cell| {
            let CellContent::Leaf { primitives } = cell.content else { return None };
            let (lo, hi) = (cell.bounds.lo, cell.bounds.hi);
            let is_visited = visited.contains(&cell.node);
            let rect = Rect {
                corners: [flat(lo), flat(hi)],
                class: class(primitives.len(), is_visited),
                tip: plural(primitives.len() as u64, "object"),
            };
            (lo.z <= HEIGHT && HEIGHT < hi.z).then_some((is_visited, rect))
        });
        let mut cells: Vec<(bool, Rect)> = cells.collect();
        // The outlines of visited ones go over their neighbours'.
        cells.sort_by_key(|(is_visited, _)| *is_visited);
        cells.into_iter().map(|(_, rect)| rect).collect()
    }

    /// The circles in which the plane cuts spheres.
    fn circles(&self, role: impl Fn(u32) -> Role) -> Vec<([f64; 2], f64, Role)> {
        let spheres = self.primitives().spheres().iter().enumerate();
        let cut = spheres.filter_map(|(id, sphere)| Some((flat(sphere.center), cut_radius(sphere)?, role(id as u32))));
        let mut circles: Vec<_> = cut.collect();
        circles.sort_by_key(|(_, _, role)| *role as u8);
        circles
    }

    fn bounds(&self) -> [[f64; 2]; 2] {
        let bounds = self.tree().bounds();
        [flat(bounds.lo), flat(bounds.hi)]
    }
}

/// What is left of a point in the slice.
fn flat(point: Vec3f) -> [f64; 2] {
    [f64::from(point.x), f64::from(point.y)]
}

/// The radius of the circle in which the plane cuts a sphere.
fn cut_radius(sphere: &Sphere) -> Option<f64> {
    let away = sphere.center.z - HEIGHT;
    let squared = sphere.radius * sphere.radius - away * away;
    (squared > 0.0).then(|| f64::from(squared).sqrt())
}

/// Darker with more objects.
fn class(objects: usize, is_visited: bool) -> &'static str {
    match (objects, is_visited) {
        (0, false) => "cell cell0",
        (1, false) => "cell cell1",
        (2, false) => "cell cell2",
        (3, false) => "cell cell3",
        (_, false) => "cell cell4",
        (0, true) => "cell cell0 visited",
        (1, true) => "cell cell1 visited",
        (2, true) => "cell cell2 visited",
        (3, true) => "cell cell3 visited",
        (_, true) => "cell cell4 visited",
    }
}

/// Figure 1.
pub(crate) fn slice(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows =
        "A flat slice through the kd-tree of a hundred spheres: each rectangle is a leaf that the slice cuts, \
        the bluer the more objects it refers to; circles are the spheres where the slice cuts them."
            .into();
    section.differs =
        "These are the planes that the surface area heuristic chose in this run. Leaves without colour are empty space, cut \
        off early. A leaf may be blue without a circle in it: its object is above or below the slice."
            .into();
    session.at(0.0, "figure 1")?;
    let sliced = Sliced::new(session);
    let (cells, circles) = (sliced.cells(&[]), sliced.circles(|_| Role::Ignored));
    let report = sliced.tree().report();
    let (shown, cut) = (cells.len(), circles.len());
    let caption = format!(
        "{}: {}, {} of them leaves, {} deep; the slice cuts {shown} leaves and {}.",
        sliced.stock.name,
        plural(report.nodes as u64, "node"),
        report.leaves,
        report.depth,
        plural(cut as u64, "sphere")
    );
    let alt = format!("{shown} rectangles of many sizes without gaps, small ones around {cut} circles.");
    let svg = plan(&Plan { bounds: sliced.bounds(), cells, circles }, None);
    section.blocks.push(Block::Drawing(Drawing { id: "figure1".into(), caption, alt, svg }));
    Ok(())
}

/// Figure 2.
pub(crate) fn traversal(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows =
        "The way of one ray through the leaves of the same slice, in the order of their numbers: objects that it \
        is tested against are amber, the one that it hits is red."
            .into();
    section.differs =
        "As in the paper the ray finds each leaf from the root, once for each number; with a stack of what was \
        left behind it visits the same leaves with fewer steps."
            .into();
    session.at(0.0, "figure 2")?;
    let sliced = Sliced::new(session);
    let ways = rays(&sliced).map(|ray| Way::of(&sliced, &ray));
    let shown = ways.filter(|way| way.hit.is_some() && READABLE.contains(&way.leaves.len()));
    let Some(way) = shown.max_by(|a, b| a.room().total_cmp(&b.room())) else { return Ok(()) };
    let nodes: Vec<NodeId> = way.leaves.iter().map(|(node, _)| *node).collect();
    let role = |id| match () {
        () if way.hit.is_some_and(|(primitive, _)| primitive == id) => Role::Hit,
        () if way.tested.contains(&id) => Role::Tested,
        () => Role::Ignored,
    };
    let point = |t| flat(way.ray.at(t));
    let end = way.hit.map_or(f32::NAN, |(_, t)| t);
    let path = Path { from: point(0.0), to: point(end), stations: way.stations().into_iter().map(point).collect() };
    let caption = format!(
        "{} leaves, reached from the root each time by {}; {}, that of the hit included.",
        nodes.len(),
        plural(way.steps as u64, "step"),
        plural(way.tests as u64, "test")
    );
    let alt = format!("An arrow through {} rectangles that ends at a circle.", nodes.len());
    let cells = sliced.cells(&nodes);
    let svg = plan(&Plan { bounds: sliced.bounds(), cells, circles: sliced.circles(role) }, Some(&path));
    section.blocks.push(Block::Drawing(Drawing { id: "figure2".into(), caption, alt, svg }));
    Ok(())
}

/// Leaves on the way of the drawn ray: enough to see something, few enough to number them.
const READABLE: RangeInclusive<usize> = 6..=9;

/// Rays within the slice, from its left edge to its right.
fn rays(sliced: &Sliced) -> impl Iterator<Item = Ray> {
    const STARTS: u16 = 24;
    let [low, high] = sliced.bounds().map(|corner| corner.map(|c| c as f32));
    let height = move |part: u16| low[1] + (high[1] - low[1]) * (f32::from(part) + 0.5) / f32::from(STARTS);
    let place = move |x: f32, part: u16| Vec3f::new(x, height(part), HEIGHT);
    (0..STARTS).flat_map(move |from| (0..STARTS).map(move |to| Ray::between(place(low[0], from), place(high[0], to))))
}

/// What a ray met.
struct Way {
    ray: Ray,
    /// Leaves and where the ray is in them.
    leaves: Vec<(NodeId, [f32; 2])>,
    steps: usize,
    tests: usize,
    tested: Vec<u32>,
    /// The object and where.
    hit: Option<(u32, f32)>,
}

impl Way {
    fn of(sliced: &Sliced, ray: &Ray) -> Self {
        let objects = Objects::new(sliced.primitives(), TriangleTest::Watertight);
        let structure = &sliced.structure;
        let caster = Caster {
            primitives: sliced.primitives(),
            objects: &objects,
            structure,
            walk: Walk::Sequential,
            math: Math::Scalar,
        };
        let mut trace = Trace::default();
        let hit = caster.closest_hit(ray, &mut trace);
        let hit = hit.is_hit().then_some((hit.primitive, hit.t));
        let mut way = Self { ray: *ray, leaves: Vec::new(), steps: 0, tests: 0, tested: Vec::new(), hit };
        for event in trace.events {
            match event {
                Event::Step { .. } => way.steps += 1,
                Event::Leaf { node, interval } => way.leaves.push((node, interval)),
                Event::Test { primitive } => {
                    way.tests += 1;
                    way.tested.push(primitive);
                }
                Event::Accept { .. } => {}
            }
        }
        way
    }

    /// Where the numbers of the leaves stand: half-way through each, as far as the ray goes.
    fn stations(&self) -> Vec<f32> {
        let end = self.hit.map_or(f32::INFINITY, |(_, t)| t);
        self.leaves.iter().map(|&(_, [from, to])| 0.5 * (from + to.min(end))).collect()
    }

    /// The least distance between two numbers.
    fn room(&self) -> f32 {
        let length = self.ray.direction.length_squared().sqrt();
        self.stations().windows(2).map(|pair| (pair[1] - pair[0]) * length).fold(f32::INFINITY, f32::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Effort, Watch};
    use whitted::render::Cancel;

    struct Unwatched;

    impl Watch for Unwatched {
        fn at(&self, _: f64, _: &str) {}
    }

    fn sliced() -> Sliced {
        let (effort, cancel) = (Effort::quick(), Cancel::new());
        Sliced::new(&Session::new(&effort, &Unwatched, &cancel).unwrap())
    }

    #[test]
    fn leaves_of_a_slice_fill_it_once() {
        let sliced = sliced();
        let area = |[low, high]: [[f64; 2]; 2]| (high[0] - low[0]) * (high[1] - low[1]);
        let leaves: f64 = sliced.cells(&[]).into_iter().map(|cell| area(cell.corners)).sum();
        let whole = area(sliced.bounds());
        assert!((leaves / whole - 1.0).abs() < 1e-5, "{leaves} of {whole}");
        for ([x, y], radius, _) in sliced.circles(|_| Role::Ignored) {
            assert!(radius > 0.0 && x.abs() + radius <= 1.01 && y.abs() + radius <= 1.01, "{x} {y} {radius}");
        }
    }

    #[test]
    fn a_way_goes_from_leaf_to_leaf_to_its_hit() {
        let sliced = sliced();
        let mut hits = 0;
        for way in rays(&sliced).map(|ray| Way::of(&sliced, &ray)) {
            let Some((primitive, t)) = way.hit else { continue };
            hits += 1;
            assert!(way.tests > 0 && way.tested.contains(&primitive) && way.tests == way.tested.len());
            assert!(way.steps >= way.leaves.len() - 1, "each leaf is found from the root");
            for pair in way.leaves.windows(2) {
                assert_eq!(pair[0].1[1], pair[1].1[0], "a leaf begins where the one before ends");
            }
            let (_, [from, to]) = way.leaves[way.leaves.len() - 1];
            assert!(from <= t * 1.001 && t <= to * 1.001, "the hit at {t} is in the last leaf, {from} to {to}");
            assert!(way.stations().is_sorted() && way.room() >= 0.0);
        }
        assert!(hits > 100, "{hits}");
    }
}
