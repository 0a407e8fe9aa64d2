//! The paper's claim that a kd-tree is four times as fast as a regular grid (§2.3.1): in which scenes it holds.
//!
//! A grid's cells have one size, whatever lies in them. So the same spheres are put into larger and larger boxes, whose
//! corners eight small spheres hold: the teapot in the stadium (Haines, "Spline Surface Rendering, and What's Wrong with
//! Octrees", Ray Tracing News 1(2), 1988).

use super::pictures::flake;
use super::renderers::{Classics, REGION, ours};
use super::stock::Stock;
use crate::draw::{Series, line_chart};
use crate::measure::{Contestant, Measured, Stage, contest};
use crate::report::{Block, Cell, Column, Drawing, Row, Section, Table, number, spaced};
use crate::session::Session;
use whitted::classic::{Math, Structure, TriangleTest, Walk};
use whitted::math::Vec3d;
use whitted::render::{Cancelled, Execution, Method};
use whitted::scene::generate::{PaperFamily, paper_scene};
use whitted::scene::{Antialias, Scene, Settings};
use whitted::tree::WalkKind;

/// How many times faster than a grid the paper's kd-tree is.
const CLAIM: f64 = 4.0;

/// Spheres in the cube.
const SPHERES: u32 = 10_000;

/// Sides of the box in sides of the cube.
const BOXES: [u32; 4] = [1, 4, 16, 32];

/// Size of the pictures whose steps and tests are counted: in the emptiest box each ray meets thousands of spheres.
const COUNTED: [u32; 2] = [160, 120];

/// Levels of the sphereflake: 7381 spheres.
const LEVELS: u32 = 4;

/// Names of the rows that the text speaks about.
const GRID: &str = "grid + SSE";
const KD: &str = "kd-tree + SSE";
const STACK: &str = "kd-tree + SSE, stack walk";

/// What was measured in one scene.
struct Measurement {
    name: String,
    seconds: Vec<Option<Measured>>,
    /// Steps and tests for a ray, row by row, of the paper's structures.
    counts: Vec<[f64; 2]>,
}

/// A row: its name, and whether the paper's renderer makes it.
type Technique = (String, bool);

pub(crate) fn run(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows = format!(
        "Seconds to render a picture by grid and by kd-tree: {} spheres of “mix” that fill a cube evenly, the same in a \
         box with 4, 16 and 32 times the side, which is empty otherwise, and a sphereflake, whose spheres crowd at its rim.",
        spaced(SPHERES.into())
    );
    let (mut rows, mut all) = (Vec::new(), Vec::new());
    let scenes = BOXES.len() + 1;
    let mut outcome = Ok(());
    for index in 0..scenes {
        let span = [index, index + 1].map(|turn| turn as f64 / scenes as f64);
        outcome = session.at(span[0], "scenes").and_then(|()| scene(session, index, span, &mut rows, &mut all));
        if outcome.is_err() {
            break;
        }
    }
    section.blocks.push(Block::Table(seconds(&rows, &all)));
    section.blocks.push(Block::Drawing(drawing(&rows, &all)));
    section.blocks.push(Block::Table(counts(&rows, &all)));
    section.differs = words(&rows, &all).unwrap_or_default();
    outcome
}

/// The scenes by number: boxes, then the flake.
fn stock(session: &Session, index: usize) -> Stock {
    let (name, mut scene) = match BOXES.get(index) {
        Some(&side) => (format!("box × {side}"), boxed(side)),
        None => ("sphereflake".to_owned(), flake(LEVELS)),
    };
    scene.settings.size = session.effort.size;
    scene.settings.antialias = Antialias::Off;
    Stock::new(name, scene, &session.one)
}

/// The cube in a box of so many times its side, held by a small sphere in each corner.
fn boxed(side: u32) -> Scene {
    const RADIUS: f64 = 0.01;
    let mut scene = paper_scene(PaperFamily::Mix, SPHERES).expect("ten thousand spheres are placed");
    if side > 1 {
        let corner = |octant: u8| {
            let sign = |axis: u8| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 };
            (Vec3d::new(sign(0), sign(1), sign(2)) * (f64::from(side) - RADIUS), RADIUS, 0)
        };
        scene.spheres.extend((0..8).map(corner));
    }
    scene
}

/// All techniques in one scene.
fn scene(
    session: &Session,
    index: usize,
    span: [f64; 2],
    rows: &mut Vec<Technique>,
    all: &mut Vec<Measurement>,
) -> Result<(), Cancelled> {
    let stock = stock(session, index);
    let reference = stock.reference(session)?;
    let stage = Stage { scene: &stock.name, reference: &reference, span };
    let classics = Classics::new(session, &stock, TriangleTest::Watertight, &session.one)?;
    let structures = [
        (GRID, &classics.grid, Walk::Stack),
        (KD, &classics.sah, Walk::Sequential),
        (STACK, &classics.sah, Walk::Stack),
    ];
    let classic = |(name, structure, walk): (&str, _, _)| {
        classics.contestant(session, name, structure, (walk, Math::sse()), REGION)
    };
    let wide = Execution { method: Method::Recursive, walk: WalkKind::Single, ..Execution::default() };
    let mut contestants: Vec<Contestant> = structures.into_iter().map(classic).collect();
    contestants.push(ours(session, &stock, "wide tree, ray by ray", wide, &session.one));
    let (seconds, outcome) = contest(session, &stage, &contestants);
    *rows = contestants.iter().map(|contestant| (contestant.name.clone(), contestant.of_paper)).collect();
    let mut measurement = Measurement { name: stock.name.clone(), seconds, counts: Vec::new() };
    let outcome = outcome.and_then(|()| {
        for (_, structure, walk) in structures {
            measurement.counts.push(per_ray(session, &stock, &classics, structure, walk)?);
        }
        Ok(())
    });
    all.push(measurement);
    outcome
}

/// Steps and tests for a ray of the picture.
fn per_ray(
    session: &Session,
    stock: &Stock,
    classics: &Classics,
    structure: &Structure,
    walk: Walk,
) -> Result<[f64; 2], Cancelled> {
    let settings = Settings { size: COUNTED, ..stock.scene.settings.clone() };
    let statistics = classics.count(session, (structure, walk), &stock.prepared, &settings)?;
    Ok([statistics.node_steps, statistics.primitive_tests].map(|count| count as f64 / statistics.rays().max(1) as f64))
}

/// How many times longer the first row takes than the second, in this scene.
fn ratio(rows: &[Technique], measurement: &Measurement, [slow, fast]: [&str; 2]) -> Option<f64> {
    let median = |name: &str| {
        let row = rows.iter().position(|(known, _)| known == name)?;
        Some((*measurement.seconds.get(row)?)?.median)
    };
    Some(median(slow)? / median(fast)?)
}

/// Where the claim holds and why; `None` if the run did not come so far.
fn words(rows: &[Technique], all: &[Measurement]) -> Option<String> {
    let even = all.first()?;
    let times = |measurement| ratio(rows, measurement, [GRID, KD]);
    let ([cells, cell_tests], [planes, plane_tests]) = (*even.counts.first()?, *even.counts.get(1)?);
    let boxes: Vec<f64> = all.iter().take(BOXES.len()).map_while(times).collect();
    let each: Vec<String> =
        boxes.iter().zip(BOXES).skip(1).map(|(t, side)| format!("{} times in box × {side}", number(*t))).collect();
    let holds = boxes.iter().zip(BOXES).find(|(times, _)| **times >= CLAIM);
    let verdict = holds.map_or("its four times are not reached here".to_owned(), |(_, side)| {
        format!("its four times are reached where a crowd lies in a space of {side} times its side")
    });
    let flake = all
        .get(BOXES.len())
        .and_then(times)
        .map_or(String::new(), |t| format!(", {} times in the sphereflake", number(t)));
    Some(format!(
        "The paper says that the kd-tree is four times as fast as a regular grid, and not in which scene. Where spheres fill \
         space evenly it is {} times as fast, with a stack {}: cells of one size suit such spheres, a ray goes through {} \
         cells and tests {} spheres, while in the tree it compares {} planes and tests {}, because the paper's walk begins at \
         the root for every leaf. Where most of the space is empty it is the tree that gains: beside the grid's its speed is {}{flake}. \
         So the paper's claim is one about scenes: {verdict}, since a grid that is fine enough for the crowd would have too \
         many cells, and all of the crowd shares a few.",
        number(*boxes.first()?),
        number(ratio(rows, even, [GRID, STACK])?),
        number(cells),
        number(cell_tests),
        number(planes),
        number(plane_tests),
        each.join(", "),
    ))
}

fn columns(all: &[Measurement], unit: &'static str) -> Vec<Column> {
    all.iter().map(|measurement| Column::new(&measurement.name, unit)).collect()
}

fn seconds(rows: &[Technique], all: &[Measurement]) -> Table {
    let row = |(index, (name, of_paper)): (usize, &Technique)| {
        let cell = |measurement: &Measurement| Cell::beside(measurement.seconds.get(index).copied().flatten(), None);
        Row { name: name.clone(), of_paper: *of_paper, cells: all.iter().map(cell).collect() }
    };
    let mut rows_of_table: Vec<Row> = rows.iter().enumerate().map(row).collect();
    let times =
        |measurement: &Measurement| Cell::beside(ratio(rows, measurement, [GRID, KD]).map(Measured::exact), None);
    let cells = all.iter().map(times).collect();
    rows_of_table.push(Row { name: "grid : kd-tree (the paper: 4)".to_owned(), of_paper: true, cells });
    Table {
        id: "grid".into(),
        caption: "Rendering times by grid and kd-tree".into(),
        corner: "technique",
        columns: columns(all, "s"),
        rows: rows_of_table,
    }
}

fn counts(rows: &[Technique], all: &[Measurement]) -> Table {
    let names = rows.iter().filter(|(_, of_paper)| *of_paper).enumerate();
    let two = |(index, (name, _)): (usize, &Technique)| {
        [("cells or planes", 0), ("tests", 1)].map(|(what, which)| {
            let cell = |measurement: &Measurement| {
                measurement.counts.get(index).map_or(Cell::Empty, |counts| Cell::exact(counts[which]))
            };
            Row { name: format!("{name}: {what}"), of_paper: true, cells: all.iter().map(cell).collect() }
        })
    };
    Table {
        id: "grid-counts".into(),
        caption: "Cells or planes met and objects tested, for each ray of the picture".into(),
        corner: "technique",
        columns: columns(all, ""),
        rows: names.flat_map(two).collect(),
    }
}

fn drawing(rows: &[Technique], all: &[Measurement]) -> Drawing {
    let series = |(index, (name, _)): (usize, &Technique)| {
        let point = |(side, measurement): (&u32, &Measurement)| {
            Some([f64::from(*side), (*measurement.seconds.get(index)?)?.median])
        };
        // Short enough to stand beside the line.
        let name = name.replace(" + SSE", "").replace(" walk", "").replace(", ray by ray", "");
        Series { name, points: BOXES.iter().zip(all).filter_map(point).collect() }
    };
    let series: Vec<Series> = rows.iter().enumerate().map(series).collect();
    Drawing {
        id: "grid-chart".into(),
        caption: "Seconds for a picture of the same spheres in larger and larger boxes; both scales are logarithmic."
            .into(),
        alt: "Lines of the table above: that of the grid climbs with the box, those of the trees stay level.".into(),
        svg: line_chart(&series, "side of the box, in sides of the filled cube", "seconds", None),
    }
}
