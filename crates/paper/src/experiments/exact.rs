//! What each variant computes, beside the default renderer: every one in a small picture, whole.

use super::mesh;
use super::renderers::{Classics, ladder, ours};
use super::stock::Stock;
use crate::measure::{Bound, Check, Contestant};
use crate::report::{Block, Cell, Column, Row, Section, Table};
use crate::session::Session;
use whitted::classic::{Math, TriangleTest};
use whitted::render::{Cancelled, Execution, Method, PixelRect, Region};
use whitted::scene::generate::PaperFamily;

/// Size of the pictures, in pixels.
const SIZE: [u32; 2] = [160, 120];

/// Spheres of the first scene, and balls of triangles of the second.
const SPHERES: u32 = 100;
const BALLS: u32 = 10;

/// The part of the pixels in which estimated roots may show: where two surfaces are so close that they change places.
const ESTIMATED: Bound = Bound::Part(0.001);

/// The part of the pixels in which the projected triangle test may show: along edges.
const PROJECTED: Bound = Bound::Part(0.02);

pub(crate) fn run(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows =
        "Every pixel that a variant computed in this run, compared bit by bit with the same pixel of the default \
        renderer: trees, walks, regions, instruction sets and threads must not change any."
            .into();
    section.differs = "What the paper's projected triangle test and the estimated square root may change is bounded: the \
        former decides otherwise at edges, where it can also let rays through; the latter only orders hits, and what is seen is \
        refined in double precision."
        .into();
    let outcome = spheres(session).and_then(|()| triangles(session));
    let checks = session.checks();
    let (free, equal): (Vec<Check>, Vec<Check>) = checks.into_iter().partition(|check| check.allowed > 0);
    section.blocks.push(Block::Table(table("exact-equal", "What must not differ", &equal)));
    section.blocks.push(Block::Table(table("exact-bounded", "What may differ, within bounds", &free)));
    outcome
}

fn spheres(session: &Session) -> Result<(), Cancelled> {
    let stock = Stock::spheres(PaperFamily::Mix, SPHERES, SIZE, &session.one);
    let classics = Classics::new(session, &stock, TriangleTest::Watertight, &session.one)?;
    let maths = [
        ("scalar", Math::Scalar, Bound::Equal),
        ("SSE", Math::sse(), Bound::Equal),
        ("estimated root", Math::rsqrt(), ESTIMATED),
    ];
    let mut all = classics.all(session, &maths);
    all.extend(ladder(session, &stock));
    all.extend(regions(session, &stock));
    compare(session, &stock, &all, [0.0, 0.8])
}

/// Both renderers of ours, in regions that do not divide the picture.
fn regions<'a>(session: &'a Session, stock: &'a Stock) -> Vec<Contestant<'a>> {
    let regions = [
        ("1 × 1", Region::Rectangle(1, 1)),
        ("7 × 5", Region::Rectangle(7, 5)),
        ("scanline", Region::Scanline),
        ("whole picture", Region::Frame),
    ];
    let each = |(name, region)| {
        [("batches", Method::Wavefront), ("ray by ray", Method::Recursive)].map(|(method_name, method)| {
            let execution = Execution { region, method, ..Execution::default() };
            ours(session, stock, format!("{method_name}, region {name}"), execution, &session.one)
        })
    };
    regions.into_iter().flat_map(each).collect()
}

fn triangles(session: &Session) -> Result<(), Cancelled> {
    let mut scene = mesh::scene(BALLS);
    scene.settings.size = SIZE;
    let stock = Stock::new(format!("mix-{BALLS} in triangles"), scene, &session.one);
    let watertight = Classics::new(session, &stock, TriangleTest::Watertight, &session.one)?;
    let projection = Classics::new(session, &stock, TriangleTest::Projection, &session.one)?;
    // Without a tree every ray would meet twenty thousand triangles.
    let by_tree = |contestant: &Contestant| !contestant.name.starts_with("naive");
    let mut all = watertight.all(session, &[("scalar", Math::Scalar, Bound::Equal)]);
    all.extend(projection.all(session, &[("projection", Math::Scalar, PROJECTED)]));
    all.retain(by_tree);
    compare(session, &stock, &all, [0.8, 1.0])
}

fn compare(session: &Session, stock: &Stock, all: &[Contestant], [from, to]: [f64; 2]) -> Result<(), Cancelled> {
    let reference = stock.reference(session)?;
    let rect = PixelRect::whole(SIZE);
    for (index, contestant) in all.iter().enumerate() {
        let part = index as f64 / all.len() as f64;
        session.at(from + (to - from) * part, &format!("{}, {}", stock.name, contestant.name))?;
        let (rendered, _) = contestant.threads.seconds(|| (contestant.render)(&rect));
        session.checked(reference.check(contestant, &stock.name, &rect, &rendered?.pixels));
    }
    Ok(())
}

fn table(id: &str, caption: &str, checks: &[Check]) -> Table {
    let row = |check: &Check| Row {
        name: check.variant.clone(),
        of_paper: check.of_paper,
        cells: vec![
            Cell::Text(check.scene.clone()),
            Cell::Count(check.pixels as u64),
            Cell::Count(check.differing as u64),
            Cell::Count(check.allowed as u64),
            Cell::exact(check.largest),
        ],
    };
    Table {
        id: id.to_owned(),
        caption: caption.to_owned(),
        corner: "variant",
        columns: vec![
            Column::new("scene", ""),
            Column::new("pixels", ""),
            Column::new("differing", ""),
            Column::new("allowed", ""),
            Column::new("largest", "1/255"),
        ],
        rows: checks.iter().map(row).collect(),
    }
}
