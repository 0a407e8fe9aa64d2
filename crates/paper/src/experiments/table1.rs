//! Table 1: rendering times by technique and number of objects.

use super::renderers::{self, Classics};
use super::stock::{FAMILIES, Stock};
use crate::Effort;
use crate::draw::{Bar, Group, bar_chart};
use crate::measure::{Measured, Stage, contest};
use crate::published::{self, Times};
use crate::report::{Block, Cell, Column, Drawing, Row, Section, Table, number, spaced};
use crate::session::Session;
use whitted::classic::TriangleTest;
use whitted::render::Cancelled;
use whitted::scene::generate::PaperFamily;

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
        Whitted adds, one step after the other, by the widest instruction set where none is named."
        .into();
    section.differs = DIFFERS.into();
    let spheres = &session.effort.spheres;
    let whole: f64 = FAMILIES.iter().flat_map(|(family, _)| spheres.iter().map(|&count| weight(*family, count))).sum();
    let mut done = 0.0;
    for (family, name) in FAMILIES {
        let mut measured = Family::default();
        let mut outcome = Ok(());
        for &count in spheres {
            let span = [done, done + weight(family, count) / whole];
            let stock = || Stock::spheres(family, count, session.effort.size, &session.one);
            outcome = session
                .at(span[0], &format!("{name}-{count}"))
                .and_then(|()| scene(session, &stock(), span, &mut measured));
            if outcome.is_err() {
                break;
            }
            done = span[1];
        }
        add(section, name, spheres, &measured);
        outcome?;
        // Both families say the same: the last one speaks.
        section.differs = DIFFERS.to_owned() + &words(session.effort, name, &measured.rows).unwrap_or_default();
    }
    Ok(())
}

/// How long a scene takes among the others: the more spheres, the more rows take all the time that they may.
fn weight(family: PaperFamily, spheres: u32) -> f64 {
    let rays = if family == PaperFamily::All4 { 2.0 } else { 1.0 };
    rays * f64::from(spheres).log10()
}

/// Why the absolute times cannot be compared.
const DIFFERS: &str = "The paper names neither its scenes nor its depth of recursion. Both families stand here, since they \
    differ by an order of magnitude in rays; compare the ratios.";

/// Spheres of the scene about which the text speaks: the largest that the paper measured naively.
const SPOKEN: u32 = 1_000;

/// What came out, in a few sentences; `None` if the run did not come so far.
fn words(effort: &Effort, family: &str, rows: &[Technique]) -> Option<String> {
    /// Pixels of the paper's pictures.
    const PRINTED: f64 = 640.0 * 480.0;
    let (spheres, scale) = (&effort.spheres, PRINTED / effort.size.map(f64::from).iter().product::<f64>());
    let index = spheres.iter().position(|&count| count == SPOKEN)?;
    let median = |name: &str| median(rows, name, index);
    let faster = |slow: &str, fast: &str| Some(number(median(slow)? / median(fast)?));
    let printed = |times: Times| published::at(times, SPOKEN).unwrap_or(f64::NAN);
    let default = rows.iter().rev().find(|row| row.name.starts_with(renderers::BEST))?;
    let since = |times: Times, name: &str| Some(number(printed(times) / (median(name)? * scale)));
    Some(format!(
        " In {family}-{SPOKEN} SSE makes the naive renderer {} times as fast (the paper: {}); the kd-tree {} times ({}), \
         regions {} times ({}).{} The tree is worth less than it was, since every ray against every object is a loop without \
         surprises, and CPUs became better at those than at walks, which wait for one plane after the other: a naive \
         picture of the paper's size is {} times as fast as the paper's, one by the tree {} times. The kd-tree is {} times as fast as the grid, where the \
         paper has four: see “Kd-tree or grid”. What brought more since is to trace the rays of a region together, in a wide \
         tree and by wide registers: the default renderer is {} times as fast as the paper's best on the same core.",
        faster("naive", "SSE math")?,
        number(printed(published::NAIVE) / printed(published::SSE)),
        faster("SSE math", "kd-tree + SSE")?,
        number(printed(published::SSE) / printed(published::KD)),
        faster("kd-tree + SSE", "kd-tree + SSE + region")?,
        number(printed(published::KD) / printed(published::KD_REGION)),
        few(spheres, rows).unwrap_or_default(),
        since(published::NAIVE, "naive")?,
        since(published::KD, "kd-tree + SSE")?,
        faster("grid + SSE", "kd-tree + SSE")?,
        faster("kd-tree + SSE + region", &default.name)?,
    ))
}

/// The median of the row of this name in a scene.
fn median(rows: &[Technique], name: &str, scene: usize) -> Option<f64> {
    let row = rows.iter().find(|row| row.name == name)?;
    Some((*row.seconds.get(scene)?)?.median)
}

/// What SSE does among few spheres, if it does not pay there.
fn few(spheres: &[u32], rows: &[Technique]) -> Option<String> {
    let gain = median(rows, "naive", 0)? / median(rows, "SSE math", 0)?;
    (gain < 1.0).then(|| {
        format!(
            " Among {} spheres SSE is only {} times as fast as plain code: its register holds one point, and each of the two \
             dot products of a test ends in two turns and sums across it, which many tests hide behind each other and few do \
             not; shading is the same in both rows, and plain code runs on the same unit, where GCC 3.4 had the x87.",
            spheres[0],
            number(gain),
        )
    })
}

/// All techniques in one scene.
fn scene(session: &Session, stock: &Stock, span: [f64; 2], measured: &mut Family) -> Result<(), Cancelled> {
    let reference = stock.reference(session)?;
    let stage = Stage { scene: &stock.name, reference: &reference, span };
    let classics = Classics::new(session, stock, TriangleTest::Watertight, &session.one)?;
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
