//! Tables 3 and 4: fifty million vector operations.

use super::kernels::{Data, Rows, VECTORS, one_at_a_time, passes};
use crate::draw::{Bar, Group, bar_chart};
use crate::measure::{Measured, Rounds, interleaved, thread_seconds};
use crate::published;
use crate::report::{Block, Cell, Column, Drawing, Row, Section, Table, number};
use crate::session::Session;
use simd::{Level, dispatch};
use whitted::classic::{Alignment, Operation, Workload};
use whitted::render::Cancelled;

/// A way to do the operations.
struct Means {
    name: String,
    of_paper: bool,
    /// The paper's number for it.
    paper: Option<f64>,
    how: How,
}

#[derive(Clone, Copy)]
enum How {
    OneAtATime(Operation),
    Vectors(Level, Operation, Alignment),
    Rows(Level, Operation),
}

impl How {
    /// CPU seconds of `operations`.
    fn seconds(self, data: &mut Data, workload: &mut Workload, operations: u64) -> f64 {
        match self {
            Self::OneAtATime(operation) => thread_seconds(|| one_at_a_time(data, operation, operations)),
            Self::Vectors(level, operation, alignment) => thread_seconds(|| {
                for _ in 0..passes(operations) {
                    workload.run(operation, level, alignment);
                }
            }),
            Self::Rows(level, operation) => thread_seconds(|| dispatch(level, Rows { data, operation, operations })),
        }
    }
}

fn means(name: impl Into<String>, paper: Option<f64>, how: How) -> Means {
    Means { name: name.into(), of_paper: paper.is_some(), paper, how }
}

/// Sixteen vectors at a time, by each instruction set that has lanes.
fn rows(operation: Operation) -> impl Iterator<Item = Means> {
    let wide = Level::available().into_iter().filter(|level| level.name() != "scalar");
    wide.map(move |level| means(format!("lane per vector, {level}"), None, How::Rows(level, operation)))
}

/// Table 3.
pub(crate) fn multiplications(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    let operation = Operation::Multiply;
    let [c, sse, aligned] = published::MULTIPLICATIONS.map(Some);
    let mut all = vec![means("C", c, How::OneAtATime(operation))];
    if let Some(level) = Level::by_name("sse4.2") {
        let by = |alignment| How::Vectors(level, operation, alignment);
        all.push(means("SSE", sse, by(Alignment::Misaligned)));
        all.push(means("SSE + alignment", aligned, by(Alignment::Aligned)));
    }
    all.extend(plain(operation));
    all.extend(rows(operation));
    section.shows =
        "How long fifty million products of two vectors take: plain code, one component after the other; the \
        four components in a register; vectors that lie at multiples of 16 bytes."
            .into();
    let (said, outcome) = measure(session, section, &all, "µs, as printed");
    section.differs = format!(
        "The paper prints microseconds. Fifty million operations in 409 µs would be 122 for each nanosecond, on a CPU of \
         1.8 GHz: the unit cannot be right, so only the ratios can be compared. {said} A misaligned vector costs today where it \
         crosses a cache line, which one in four does here. The compiler makes vector code of the plain loop by itself, unless \
         it is kept from it, as it was for the row “C”."
    );
    outcome
}

/// Table 4.
pub(crate) fn normalisations(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    let [c, sse, aligned] = published::NORMALISATIONS.map(Some);
    let mut all = vec![means("C", c, How::OneAtATime(Operation::Normalize))];
    if let Some(level) = Level::by_name("sse4.2") {
        let by = |operation, alignment| How::Vectors(level, operation, alignment);
        all.push(means("SSE", sse, by(Operation::NormalizeEstimated, Alignment::Misaligned)));
        all.push(means("SSE + alignment", aligned, by(Operation::NormalizeEstimated, Alignment::Aligned)));
        all.push(means("SSE, one Newton step", None, by(Operation::NormalizeRefined, Alignment::Aligned)));
        all.push(means("SSE, exact", None, by(Operation::Normalize, Alignment::Aligned)));
    }
    all.extend(plain(Operation::Normalize));
    all.extend(rows(Operation::Normalize));
    section.shows =
        "How long it takes to bring fifty million vectors to length one; as in the paper, SSE multiplies by the \
        hardware's estimate of the reciprocal square root, which has 12 bits."
            .into();
    let (said, outcome) = measure(session, section, &all, "s");
    section.differs = format!(
        "{said} The paper's gain is as much that of the estimate as that of the registers: see the row with an exact root and \
         division. No picture of ours uses the estimate, since its bits differ from CPU to CPU; the rows with a lane for each \
         vector are exact."
    );
    outcome
}

/// The vector type without registers, as today's compiler likes it.
fn plain(operation: Operation) -> Option<Means> {
    let scalar = Level::by_name("scalar")?;
    let how = How::Vectors(scalar, operation, Alignment::Aligned);
    Some(means("C, vectorised by rustc", None, how))
}

fn measure(
    session: &Session,
    section: &mut Section,
    all: &[Means],
    printed_unit: &'static str,
) -> (String, Result<(), Cancelled>) {
    let (mut data, mut workload) = (Data::new(), Workload::new(VECTORS));
    let (operations, rounds) = (session.effort.operations, session.effort.rounds);
    let mut contestants: Vec<&Means> = all.iter().collect();
    let (taken, outcome) = interleaved(&mut contestants, rounds, |means, index, round| {
        let part = (round * all.len() + index) as f64 / (rounds * all.len()) as f64;
        session.at(part, &format!("{}, {}, round {} of {rounds}", section.id, means.name, round + 1))?;
        Ok(means.how.seconds(&mut data, &mut workload, operations))
    });
    let measured: Vec<Option<Measured>> = taken.iter().map(Rounds::measured).collect();
    section.blocks.push(Block::Table(table(section.id, all, &measured, operations, printed_unit)));
    section.blocks.push(Block::Drawing(drawing(section.id, all, &measured, operations)));
    (words(all, &measured), outcome)
}

/// What came out, in a sentence; nothing if the run did not come so far.
fn words(all: &[Means], measured: &[Option<Measured>]) -> String {
    let speed_up = |index: usize| Some(number(measured[0]?.median / measured[index]?.median));
    let aligned = all.iter().position(|means| means.name == "SSE + alignment");
    let said = aligned.and_then(|index| {
        let last = all.len() - 1;
        let (own, widest, printed) = (speed_up(index)?, speed_up(last)?, number(all[0].paper? / all[index].paper?));
        let name = &all[last].name;
        Some(format!(
            "SSE with alignment is {own} times as fast as C here, where the paper has {printed}; “{name}” is {widest} times as \
             fast."
        ))
    });
    said.unwrap_or_default()
}

fn table(id: &str, all: &[Means], measured: &[Option<Measured>], operations: u64, printed_unit: &'static str) -> Table {
    let columns = vec![
        Column::new("time", "ms"),
        Column::new("each", "ns"),
        Column::new("speed-up", "×"),
        Column::new("paper", printed_unit),
        Column::new("its speed-up", "×"),
    ];
    let c = (measured[0].map(|m| m.median), all[0].paper);
    let rows = all.iter().zip(measured).map(|(means, measured)| {
        let scaled = |factor: f64| Cell::beside(measured.map(|m| m.extrapolated(factor, 1.0)), None);
        let ratio = measured.and_then(|m| Some(Measured::exact(c.0? / m.median)));
        let printed_ratio = means.paper.and_then(|paper| Some(c.1? / paper));
        Row {
            name: means.name.clone(),
            of_paper: means.of_paper,
            cells: vec![
                scaled(1e3),
                scaled(1e9 / operations as f64),
                Cell::beside(ratio, None),
                Cell::beside(None, means.paper),
                Cell::beside(None, printed_ratio),
            ],
        }
    });
    let caption = format!("{} million operations on vectors of four numbers", number(operations as f64 / 1e6));
    Table { id: id.to_owned(), caption, corner: "means", columns, rows: rows.collect() }
}

fn drawing(id: &str, all: &[Means], measured: &[Option<Measured>], operations: u64) -> Drawing {
    let each = |measured: &Option<Measured>| measured.map(|m| m.extrapolated(1e9 / operations as f64, 1.0));
    let bar = |(means, measured): (&Means, &Option<Measured>)| Bar {
        name: means.name.clone(),
        of_paper: means.of_paper,
        measured: each(measured),
        paper: None,
    };
    let group =
        Group { name: "nanoseconds for each operation".into(), bars: all.iter().zip(measured).map(bar).collect() };
    Drawing {
        id: format!("{id}-chart"),
        caption: "Logarithmic scale; the black line reaches from the fastest round to the slowest.".into(),
        alt: "Bars of the time that one operation takes by each means, as in the table above.".into(),
        svg: bar_chart(&[group], "ns"),
    }
}
