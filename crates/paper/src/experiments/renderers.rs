//! The renderers that the tables compare.

use super::stock::Stock;
use crate::measure::{Bound, Contestant, Rendered, Spread, Threads};
use crate::session::Session;
use simd::Level;
use whitted::classic::{Caster, Grid, KdTree, Math, Objects, Split, Structure, TriangleTest, Walk};
use whitted::render::{
    Cancelled, Classic, Execution, Method, PixelRect, Region, Silent, Statistics, Unwatched, render_classic,
    render_rect,
};
use whitted::scene::{Prepared, Settings};
use whitted::tree::WalkKind;

/// Side of the tiles that renderers of batches trace where not the whole picture: a region.
const BATCH_TILE: u32 = 64;

/// Side of the tiles that recursive renderers trace where not the whole picture: small, for an even spread.
pub(super) const RAY_TILE: u32 = 8;

/// The region that the paper finds best.
pub(super) const REGION: Region = Region::Rectangle(64, 64);

/// The paper's structures over one scene.
pub(super) struct Classics<'a> {
    pub(super) stock: &'a Stock,
    objects: Objects,
    naive: Structure,
    pub(super) grid: Structure,
    pub(super) median: Structure,
    pub(super) sah: Structure,
    /// CPU seconds of the busiest thread for grid, median and surface area heuristic.
    pub(super) build_seconds: [f64; 3],
}

impl<'a> Classics<'a> {
    /// Builds all, with triangles tested like this.
    pub(super) fn new(
        session: &Session,
        stock: &'a Stock,
        test: TriangleTest,
        threads: &Threads,
    ) -> Result<Self, Cancelled> {
        let primitives = stock.prepared.geometry().primitives();
        let stop = || session.cancel.is_cancelled();
        let kd = |split| {
            let built = threads.seconds(|| Structure::Kd(KdTree::build_until(primitives, split, &stop)));
            // A tree that was not finished must not be measured.
            session.go_on().map(|()| built)
        };
        let (grid, grid_seconds) = threads.seconds(|| Structure::Grid(Grid::build(primitives)));
        let ((median, median_seconds), (sah, sah_seconds)) = (kd(Split::Median)?, kd(Split::Sah)?);
        Ok(Self {
            stock,
            objects: Objects::new(primitives, test),
            naive: Structure::Naive,
            grid,
            median,
            sah,
            build_seconds: [grid_seconds, median_seconds, sah_seconds],
        })
    }

    fn caster<'s>(&'s self, structure: &'s Structure, walk: Walk, math: Math) -> Classic<'s> {
        let prepared = &self.stock.prepared;
        let primitives = prepared.geometry().primitives();
        Classic { prepared, caster: Caster { primitives, objects: &self.objects, structure, walk, math } }
    }

    /// What a picture takes whose rays all ask this structure; `prepared` has the shapes over which it was built.
    pub(super) fn count(
        &self,
        session: &Session,
        (structure, walk): (&Structure, Walk),
        prepared: &Prepared,
        settings: &Settings,
    ) -> Result<Statistics, Cancelled> {
        let classic = Classic { prepared, ..self.caster(structure, walk, Math::sse()) };
        let (execution, rect) = (Execution::default(), PixelRect::whole(settings.size));
        let work = || render_classic(&classic, settings, &execution, &rect, &Silent, session.cancel, &Unwatched);
        Ok(session.several.seconds(work).0?.statistics)
    }

    /// The paper's renderer in this configuration.
    pub(super) fn contestant(
        &'a self,
        session: &'a Session,
        name: impl Into<String>,
        structure: &'a Structure,
        (walk, math): (Walk, Math),
        region: Region,
    ) -> Contestant<'a> {
        let classic = self.caster(structure, walk, math);
        let (settings, cancel) = (&self.stock.scene.settings, session.cancel);
        let execution = Execution { region, method: Method::Recursive, ..Execution::default() };
        let render = move |rect: &PixelRect| -> Result<Rendered, Cancelled> {
            Ok(render_classic(&classic, settings, &execution, rect, &Silent, cancel, &Unwatched)?.into())
        };
        Contestant {
            name: name.into(),
            of_paper: true,
            bound: Bound::Equal,
            threads: &session.one,
            spread: Spread::Tiles(RAY_TILE),
            render: Box::new(render),
        }
    }

    /// The rows of Table 1, in the paper's order, with what it only mentions.
    pub(super) fn rows(&'a self, session: &'a Session) -> Vec<Contestant<'a>> {
        let one =
            |name, structure, walk, math| self.contestant(session, name, structure, (walk, math), Region::Scanline);
        let (sequential, sse) = (Walk::Sequential, Math::sse());
        let tree = |name, walk, region| self.contestant(session, name, &self.sah, (walk, sse), region);
        vec![
            one("naive", &self.naive, sequential, Math::Scalar),
            one("SSE math", &self.naive, sequential, sse),
            one("grid + SSE", &self.grid, sequential, sse),
            one("median kd-tree + SSE", &self.median, sequential, sse),
            Contestant { spread: Spread::Bands, ..tree("kd-tree + SSE", sequential, Region::Scanline) },
            Contestant { spread: Spread::Bands, ..tree("kd-tree + SSE + region", sequential, REGION) },
            Contestant { spread: Spread::Bands, ..tree("the same, stack walk", Walk::Stack, REGION) },
        ]
    }

    /// Every configuration, for what it computes.
    pub(super) fn all(&'a self, session: &'a Session, maths: &[(&str, Math, Bound)]) -> Vec<Contestant<'a>> {
        let structures = [
            ("naive", &self.naive, Walk::Stack),
            ("grid", &self.grid, Walk::Stack),
            ("median kd-tree, sequential", &self.median, Walk::Sequential),
            ("median kd-tree, stack", &self.median, Walk::Stack),
            ("kd-tree, sequential", &self.sah, Walk::Sequential),
            ("kd-tree, stack", &self.sah, Walk::Stack),
        ];
        let each = |&(math_name, math, bound): &(&str, Math, Bound)| {
            structures.map(|(name, structure, walk)| {
                let name = format!("{name}, {math_name}");
                Contestant { bound, ..self.contestant(session, name, structure, (walk, math), REGION) }
            })
        };
        maths.iter().flat_map(each).collect()
    }
}

/// Our renderer, executed this way.
pub(super) fn ours<'a>(
    session: &'a Session,
    stock: &'a Stock,
    name: impl Into<String>,
    execution: Execution,
    threads: &'a Threads,
) -> Contestant<'a> {
    let tile = if execution.method == Method::Recursive { RAY_TILE } else { BATCH_TILE };
    let (settings, cancel) = (&stock.scene.settings, session.cancel);
    let render = move |rect: &PixelRect| -> Result<Rendered, Cancelled> {
        Ok(render_rect(&stock.prepared, settings, &execution, rect, &Silent, cancel, &Unwatched)?.into())
    };
    let (name, spread) = (name.into(), Spread::Tiles(tile));
    Contestant { name, of_paper: false, bound: Bound::Equal, threads, spread, render: Box::new(render) }
}

/// What the default renderer is called in tables, before its instruction set.
pub(super) const BEST: &str = "streams + frusta";

/// What came after the paper, one step after the other; by the widest instruction set where none is named.
pub(super) fn ladder<'a>(session: &'a Session, stock: &'a Stock) -> Vec<Contestant<'a>> {
    let best = Execution::default();
    let one = |name: &str, execution| ours(session, stock, name, execution, &session.one);
    let mut all = vec![
        one("wide tree, ray by ray", Execution { method: Method::Recursive, walk: WalkKind::Single, ..best }),
        one("batches, each ray alone", Execution { walk: WalkKind::Single, ..best }),
        one("batches, streams", Execution { walk: WalkKind::Stream, ..best }),
    ];
    // The last one is the default.
    for level in Level::available() {
        all.push(one(&format!("{BEST}, {level}"), Execution { level, ..best }));
    }
    let threads = session.effort.threads;
    if threads > 1 {
        let all_threads = ours(session, stock, format!("the same, {threads} threads"), best, &session.several);
        all.push(Contestant { spread: Spread::Whole, ..all_threads });
    }
    all
}
