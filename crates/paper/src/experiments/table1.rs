//! Table 1: rendering times by technique and number of objects.

use super::renderers::{self, Classics};
use super::stock::{FAMILIES, Stock};
use crate::draw::{Bar, Group, bar_chart};
use crate::measure::{Measured, Stage, contest};
use crate::published::{self, Times};
use crate::report::{Block, Cell, Column, Drawing, Row, Section, Table, number, spaced};
use crate::session::Session;
use whitted::classic::TriangleTest;
use whitted::render::Cancelled;

/// The paper's row for a technique of this name.
fn printed(name: &str) -> Option<Times> {
    match name {
        "naive" => Some(published::NAIVE),
        "SSE math" => Some(published::SSE),
        "kd-tree + SSE" => Some(published::KD),
        "kd-tree + SSE + region" => Some(published::KD_REGION),
        _ => None,
    }
}

/// What was measured in the scenes of one family.
#[derive(Default)]
struct Family {
    rows: Vec<Technique>,
    /// CPU seconds that building took, scene by scene: grid, median, surface area heuristic, wide tree.
    builds: Vec<[f64; 4]>,
}

/// The times of one technique.
struct Technique {
    name: String,
    of_paper: bool,
    /// By number of spheres, as far as the run went.
    seconds: Vec<Option<Measured>>,
}

pub(crate) fn run(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows = "Seconds to render a picture, by technique and number of spheres: first the paper's renderer, which \
        follows one ray after the other, by every ray against every object, by SSE, by the kd-tree and by regions; then what \
        Whitted adds, one step after the other."
        .into();
    section.differs = DIFFERS.into();
    for (index, (family, name)) in FAMILIES.into_iter().enumerate() {
        let mut measured = Family::default();
        let span = [index as f64 / FAMILIES.len() as f64, (index + 1) as f64 / FAMILIES.len() as f64];
        let mut outcome = Ok(());
        for (turn, &count) in session.effort.spheres.iter().enumerate() {
            let scenes = session.effort.spheres.len() as f64;
            let at = |turn: f64| span[0] + (span[1] - span[0]) * turn / scenes;
            let span = [at(turn as f64), at(turn as f64 + 1.0)];
            let stock = || Stock::spheres(family, count, session.effort.size, &session.one);
            outcome = session
                .at(span[0], &format!("{name}-{count}"))
                .and_then(|()| scene(session, &stock(), span, &mut measured));
            if outcome.is_err() {
                break;
            }
        }
        add(section, name, &session.effort.spheres, &measured);
        outcome?;
        // Both families say the same: the last one speaks.
        section.differs =
            DIFFERS.to_owned() + &words(name, &session.effort.spheres, &measured.rows).unwrap_or_default();
    }
    Ok(())
}

/// Why the absolute times cannot be compared.
const DIFFERS: &str = "The paper names neither its scenes nor its depth of recursion. Both families stand here, since they \
    differ by an order of magnitude in rays; compare the ratios.";

/// Spheres of the scene about which the text speaks: the largest that the paper measured naively.
const SPOKEN: u32 = 1_000;

/// What came out, in a few sentences; `None` if the run did not come so far.
fn words(family: &str, spheres: &[u32], rows: &[Technique]) -> Option<String> {
    let index = spheres.iter().position(|&count| count == SPOKEN)?;
    let median = |name: &str| {
        let row = rows.iter().find(|row| row.name == name)?;
        Some((*row.seconds.get(index)?)?.median)
    };
    let faster = |slow: &str, fast: &str| Some(number(median(slow)? / median(fast)?));
    let printed = |slow: Times, fast: Times| {
        let both = published::at(slow, SPOKEN).zip(published::at(fast, SPOKEN));
        number(both.map_or(f64::NAN, |(slow, fast)| slow / fast))
    };
    let default = rows.iter().rev().find(|row| row.name.starts_with("+ packets"))?;
    let why = if median("naive")? < median("SSE math")? { LOSES } else { "" };
    Some(format!(
        " In {family}-{SPOKEN} SSE makes the naive renderer {} times as fast (the paper: {}){why}; the kd-tree {} times ({}), \
         regions {} times ({}). The kd-tree is {} times as fast as the grid, where the paper has four: these spheres lie evenly, \
         as a grid likes them. What brought more since is to trace the rays of a region together, in a wide tree and by wide \
         registers: the default renderer is {} times as fast as the paper's best on the same core.",
        faster("naive", "SSE math")?,
        printed(published::NAIVE, published::SSE),
        faster("SSE math", "kd-tree + SSE")?,
        printed(published::SSE, published::KD),
        faster("kd-tree + SSE", "kd-tree + SSE + region")?,
        printed(published::KD, published::KD_REGION),
        faster("grid + SSE", "kd-tree + SSE")?,
        faster("kd-tree + SSE + region", &default.name)?,
    ))
}

/// Why SSE does not pay where it does not.
const LOSES: &str = ": a register of four holds the three numbers of one vector and must be summed across, while a CPU of \
    today does several plain operations at once";

/// All techniques in one scene.
fn scene(session: &Session, stock: &Stock, span: [f64; 2], measured: &mut Family) -> Result<(), Cancelled> {
    let reference = stock.reference(session)?;
    let stage = Stage { scene: &stock.name, reference: &reference, span };
    let classics = Classics::new(stock, TriangleTest::Watertight, &session.one);
    let mut contestants = classics.rows(session);
    contestants.extend(renderers::ladder(session, stock));
    let (seconds, outcome) = contest(session, &stage, &contestants);
    for (contestant, seconds) in contestants.iter().zip(seconds) {
        match measured.rows.iter_mut().find(|row| row.name == contestant.name) {
            Some(row) => row.seconds.push(seconds),
            None => {
                let (name, of_paper) = (contestant.name.clone(), contestant.of_paper);
                measured.rows.push(Technique { name, of_paper, seconds: vec![seconds] });
            }
        }
    }
    let [grid, median, sah] = classics.build_seconds;
    measured.builds.push([grid, median, sah, stock.build_seconds]);
    outcome
}

fn add(section: &mut Section, family: &str, spheres: &[u32], Family { rows, builds }: &Family) {
    section.blocks.push(Block::Table(table(family, spheres, rows)));
    section.blocks.push(Block::Table(speed_ups(family, spheres, rows)));
    section.blocks.push(Block::Drawing(drawing(family, spheres, rows)));
    section.blocks.push(Block::Table(build_table(family, spheres, builds)));
}

fn columns(spheres: &[u32], unit: &'static str) -> Vec<Column> {
    spheres.iter().map(|&count| Column::new(spaced(count.into()), unit)).collect()
}

fn paper(row: &Technique, count: u32) -> Option<f64> {
    printed(&row.name).and_then(|times| published::at(times, count))
}

fn table(family: &str, spheres: &[u32], rows: &[Technique]) -> Table {
    let row = |row: &Technique| {
        let cell =
            |(index, &count): (usize, &u32)| Cell::beside(row.seconds.get(index).copied().flatten(), paper(row, count));
        Row { name: row.name.clone(), of_paper: row.of_paper, cells: spheres.iter().enumerate().map(cell).collect() }
    };
    Table {
        id: format!("table1-{family}"),
        caption: format!("Rendering times, spheres of “{family}”"),
        corner: "technique",
        columns: columns(spheres, "s"),
        rows: rows.iter().map(row).collect(),
    }
}

/// What building took, once, on one thread.
fn build_table(family: &str, spheres: &[u32], builds: &[[f64; 4]]) -> Table {
    const NAMES: [(&str, bool); 4] =
        [("grid", true), ("median kd-tree", true), ("kd-tree, exact sweep", true), ("wide tree", false)];
    let row = |(index, (name, of_paper)): (usize, (&str, bool))| {
        let cell = |scene: usize| builds.get(scene).map_or(Cell::Empty, |seconds| Cell::exact(seconds[index]));
        Row { name: name.to_owned(), of_paper, cells: (0..spheres.len()).map(cell).collect() }
    };
    Table {
        id: format!("table1-{family}-build"),
        caption: format!("Building, spheres of “{family}”: not part of the times above"),
        corner: "structure",
        columns: columns(spheres, "s"),
        rows: NAMES.into_iter().enumerate().map(row).collect(),
    }
}

/// How many times faster than the first row.
fn speed_ups(family: &str, spheres: &[u32], rows: &[Technique]) -> Table {
    let first = rows.first();
    let row = |row: &Technique| {
        let cell = |(index, &count): (usize, &u32)| {
            let own = |row: &Technique| row.seconds.get(index).copied().flatten().map(|m| m.median);
            let measured = first.and_then(own).zip(own(row)).map(|(first, own)| Measured::exact(first / own));
            let printed = first.and_then(|first| paper(first, count)).zip(paper(row, count));
            Cell::beside(measured, printed.map(|(first, own)| first / own))
        };
        Row { name: row.name.clone(), of_paper: row.of_paper, cells: spheres.iter().enumerate().map(cell).collect() }
    };
    Table {
        id: format!("table1-{family}-ratio"),
        caption: format!("Times faster than the first row, spheres of “{family}”"),
        corner: "technique",
        columns: columns(spheres, "×"),
        rows: rows.iter().map(row).collect(),
    }
}

/// The scenes whose times are drawn: the largest that the paper measured naively, and the largest of all.
fn drawn(spheres: &[u32]) -> Vec<usize> {
    const LARGE: u32 = 1_000;
    (0..spheres.len()).filter(|&index| spheres[index] >= LARGE || spheres.len() == 1).collect()
}

fn drawing(family: &str, spheres: &[u32], rows: &[Technique]) -> Drawing {
    let group = |index: usize| {
        let bar = |row: &Technique| Bar {
            name: row.name.clone(),
            of_paper: row.of_paper,
            measured: row.seconds.get(index).copied().flatten(),
            paper: paper(row, spheres[index]),
        };
        Group { name: format!("{} spheres", spaced(spheres[index].into())), bars: rows.iter().map(bar).collect() }
    };
    Drawing {
        id: format!("table1-{family}-chart"),
        caption: format!("Seconds for a picture of “{family}”; logarithmic scale."),
        alt: format!("Bars of the rendering times in the table of “{family}”, the paper's below ours."),
        svg: bar_chart(&drawn(spheres).into_iter().map(group).collect::<Vec<_>>(), "seconds"),
    }
}
