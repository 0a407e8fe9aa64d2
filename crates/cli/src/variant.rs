//! The paper's own structures, walks and tests as options of a render: which of them make sense together.

use crate::args::{ExecutionArguments, MathChoice, TreeChoice, WalkChoice};
use crate::exit::Failure;
use whitted::classic::{Caster, Grid, KdTree, Math, Objects, Split, Structure, TriangleTest, Walk};
use whitted::geometry::Primitives;
use whitted::render::Method;
use whitted::tree::{TreeKind, TreeReport};

/// What the paper's renderer is to use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Variant {
    structure: Kind,
    walk: Walk,
    math: Math,
    triangle: TriangleTest,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Naive,
    Kd(Split),
    Grid,
}

/// It, built.
pub(crate) struct Built {
    variant: Variant,
    objects: Objects,
    structure: Structure,
}

impl ExecutionArguments {
    /// The splits of the production tree; none where another structure takes its place.
    pub(crate) fn tree_kind(&self) -> TreeKind {
        match self.tree {
            None => TreeKind::default(),
            Some(TreeChoice::Wide(kind)) => kind,
            Some(TreeChoice::Kd8(_) | TreeChoice::Grid) => TreeKind::None,
        }
    }

    /// The paper's variant that is asked for, if one is.
    ///
    /// # Errors
    /// Options that contradict each other.
    pub(crate) fn variant(&self) -> Result<Option<Variant>, Failure> {
        let recursive = self.render == Some(Method::Recursive);
        let structure = match self.tree {
            Some(TreeChoice::Kd8(split)) => Some(Kind::Kd(split)),
            Some(TreeChoice::Grid) => Some(Kind::Grid),
            Some(TreeChoice::Wide(TreeKind::None)) if recursive => Some(Kind::Naive),
            _ => None,
        };
        if structure.is_some() && !recursive {
            return wrong("kd8, median and grid take one ray at a time: add --render recursive");
        }
        let walk = self.classic_walk(structure)?;
        let Some(structure) = structure else {
            if self.math.is_some() || self.triangle == Some(TriangleTest::Projection) {
                return wrong(
                    "--math and --triangle projection belong to the paper's renderer: \
                     add --render recursive and --tree kd8, median, grid or none",
                );
            }
            return Ok(None);
        };
        let math = match self.math.unwrap_or(MathChoice::Scalar) {
            MathChoice::Scalar => Math::Scalar,
            MathChoice::Sse => Math::sse(),
            MathChoice::Rsqrt => Math::rsqrt(),
        };
        Ok(Some(Variant { structure, walk, math, triangle: self.triangle.unwrap_or_default() }))
    }

    /// The walk through the paper's kd-tree.
    fn classic_walk(&self, structure: Option<Kind>) -> Result<Walk, Failure> {
        match (self.walk, structure) {
            (None, _) | (Some(WalkChoice::Wide(_)), None) => Ok(Walk::default()),
            (Some(WalkChoice::Kd8(walk)), Some(Kind::Kd(_))) => Ok(walk),
            (Some(WalkChoice::Kd8(_)), _) => {
                wrong("the walks sequential and stack go through the paper's kd-tree: add --tree kd8 or --tree median")
            }
            (Some(WalkChoice::Wide(_)), Some(Kind::Kd(_))) => {
                wrong("the paper's kd-tree is walked with --walk sequential or --walk stack")
            }
            (Some(WalkChoice::Wide(_)), Some(Kind::Naive | Kind::Grid)) => {
                wrong("there is but one way through a grid, or without a tree: leave --walk out")
            }
        }
    }
}

fn wrong<T>(text: &str) -> Result<T, Failure> {
    Err(Failure::Usage(text.to_owned()))
}

impl Variant {
    /// Build what it needs over these primitives.
    pub(crate) fn build(self, primitives: &Primitives) -> Built {
        let structure = match self.structure {
            Kind::Naive => Structure::Naive,
            Kind::Kd(split) => Structure::Kd(KdTree::build(primitives, split)),
            Kind::Grid => Structure::Grid(Grid::build(primitives)),
        };
        Built { variant: self, objects: Objects::new(primitives, self.triangle), structure }
    }
}

impl Built {
    /// Finds hits among the primitives over which it was built.
    pub(crate) fn caster<'a>(&'a self, primitives: &'a Primitives) -> Caster<'a> {
        let Variant { walk, math, .. } = self.variant;
        Caster { primitives, objects: &self.objects, structure: &self.structure, walk, math }
    }

    /// What was built; a grid's cells are its leaves.
    pub(crate) fn report(&self) -> TreeReport {
        match &self.structure {
            Structure::Naive => TreeReport::default(),
            Structure::Kd(tree) => {
                let report = tree.report();
                let (nodes, leaves, references) = (report.nodes - report.leaves, report.leaves, report.references);
                TreeReport { nodes, leaves, references, depth: report.depth, bytes: report.bytes, dropped: 0 }
            }
            Structure::Grid(grid) => {
                let report = grid.report();
                let (leaves, references) = (report.resolution.iter().product(), report.references);
                TreeReport { leaves, references, bytes: report.bytes, ..TreeReport::default() }
            }
        }
    }
}
