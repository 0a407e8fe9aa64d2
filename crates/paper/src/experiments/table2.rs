//! Table 2: rendering times by size of the region.

use super::renderers::{self, Classics};
use super::stock::Stock;
use crate::draw::{Bar, Group, bar_chart};
use crate::measure::{Contestant, Measured, Spread, Stage, contest};
use crate::published;
use crate::report::{Block, Cell, Column, Drawing, Row, Section, Table, spaced};
use crate::session::Session;
use whitted::classic::{Math, TriangleTest, Walk};
use whitted::render::{Cancelled, Execution, Region};
use whitted::scene::generate::PaperFamily;

/// Times of one renderer in one scene, by region.
struct Times {
    name: String,
    of_paper: bool,
    seconds: Vec<Option<Measured>>,
}

pub(crate) fn run(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows =
        "Seconds to render a picture in square regions of so many pixels on a side, one region after another, \
        then line by line and as a whole."
            .into();
    section.differs = "The paper does not name the scene of this table. It finds 64 best, 27 % faster than single pixels, \
        because neighbouring rays find the tree in the cache. Today the whole tree of a thousand spheres fits into the \
        cache of a core, so the order matters less to a renderer that follows single rays. To one that traces the rays of a \
        region together the region is the batch: too small leaves nothing to do at once."
        .into();
    let counts = &session.effort.region_spheres;
    let mut all: Vec<Times> = Vec::new();
    let mut outcome = Ok(());
    for (index, &count) in counts.iter().enumerate() {
        let span = [index, index + 1].map(|turn| turn as f64 / counts.len() as f64);
        outcome = session.at(span[0], "scenes").and_then(|()| scene(session, count, span, &mut all));
        if outcome.is_err() {
            break;
        }
    }
    section.blocks.push(Block::Table(table(&regions(session), &all)));
    section.blocks.push(Block::Drawing(drawing(&regions(session), &all)));
    outcome
}

/// The regions: their names, their sizes, and what the paper has for them.
fn regions(session: &Session) -> Vec<(String, Region, Option<f64>)> {
    let square =
        |&side: &u32| (spaced(side.into()), Region::Rectangle(side, side), published::at(published::REGIONS, side));
    let whole = [("scanline".to_owned(), Region::Scanline, None), ("whole picture".to_owned(), Region::Frame, None)];
    session.effort.regions.iter().map(square).chain(whole).collect()
}

fn scene(session: &Session, count: u32, span: [f64; 2], all: &mut Vec<Times>) -> Result<(), Cancelled> {
    let stock = Stock::spheres(PaperFamily::Mix, count, session.effort.size, &session.one);
    let reference = stock.reference(session)?;
    let stage = Stage { scene: &stock.name, reference: &reference, span };
    let regions = regions(session);
    let classics = Classics::new(session, &stock, TriangleTest::Watertight, &session.one)?;
    let contestants: Vec<Contestant> = regions.iter().flat_map(|region| both(session, &classics, region)).collect();
    let (seconds, outcome) = contest(session, &stage, &contestants);
    let columns = contestants.len() / regions.len();
    for column in 0..columns {
        let of_paper = contestants[column].of_paper;
        let name = if of_paper { "the paper's renderer" } else { "ours" };
        let seconds = seconds.iter().skip(column).step_by(columns).copied().collect();
        all.push(Times { name: format!("{name}, {}", stock.name), of_paper, seconds });
    }
    outcome
}

/// The paper's renderer and ours, in this region.
fn both<'a>(
    session: &'a Session,
    classics: &'a Classics,
    (name, region, _): &(String, Region, Option<f64>),
) -> [Contestant<'a>; 2] {
    let execution = Execution { region: *region, ..Execution::default() };
    let ours = renderers::ours(session, classics.stock, format!("region {name}, ours"), execution, &session.one);
    let means = (Walk::Sequential, Math::sse());
    let classic = classics.contestant(session, format!("region {name}, kd-tree"), &classics.sah, means, *region);
    [classic, ours].map(|contestant| Contestant { spread: Spread::Bands, ..contestant })
}

fn table(regions: &[(String, Region, Option<f64>)], all: &[Times]) -> Table {
    let names = all.iter().map(|times| times.name.clone()).chain(["the paper".to_owned()]);
    let row = |(index, (name, _, paper)): (usize, &(String, Region, Option<f64>))| {
        let own = all.iter().map(|times| Cell::beside(times.seconds.get(index).copied().flatten(), None));
        Row { name: name.clone(), of_paper: true, cells: own.chain([Cell::beside(None, *paper)]).collect() }
    };
    Table {
        id: "table2".into(),
        caption: "Rendering times by region, spheres of “mix”".into(),
        corner: "region",
        columns: names.map(|name| Column::new(name, "s")).collect(),
        rows: regions.iter().enumerate().map(row).collect(),
    }
}

fn drawing(regions: &[(String, Region, Option<f64>)], all: &[Times]) -> Drawing {
    let group = |(index, times): (usize, &Times)| {
        let bar = |(region, (name, _, paper)): (usize, &(String, Region, Option<f64>))| Bar {
            name: name.clone(),
            of_paper: times.of_paper,
            measured: times.seconds.get(region).copied().flatten(),
            paper: paper.filter(|_| index == 0),
        };
        Group { name: times.name.clone(), bars: regions.iter().enumerate().map(bar).collect() }
    };
    Drawing {
        id: "table2-chart".into(),
        caption: "Seconds for a picture by region; logarithmic scale. The paper's scene is unknown.".into(),
        alt: "Bars of the rendering times in the table above, by size of the region.".into(),
        svg: bar_chart(&all.iter().enumerate().map(group).collect::<Vec<_>>(), "seconds"),
    }
}
