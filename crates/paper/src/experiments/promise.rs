//! Havran's promise: two or three intersection tests per ray, whatever the size of the scene (paper §2.3).

use super::renderers::Classics;
use super::stock::Stock;
use crate::draw::{Series, line_chart};
use crate::report::{Block, Cell, Column, Drawing, Row, Section, Table, number, spaced};
use crate::session::Session;
use whitted::classic::{TriangleTest, Walk};
use whitted::render::{Cancelled, Execution, Method, PixelRect, Silent, Statistics, Unwatched, render_rect};
use whitted::scene::generate::PaperFamily;
use whitted::scene::{Prepared, Settings};
use whitted::tree::WalkKind;

/// What the paper promises, in tests per ray.
const PROMISE: [f64; 2] = [2.0, 3.0];

/// Size of the pictures whose rays are counted: counts need no rounds, and a fourth of the rays gives them as well.
const SIZE: [u32; 2] = [320, 240];

/// Tests and steps per ray of one structure, by number of spheres.
struct Counted {
    name: String,
    of_paper: bool,
    per_ray: Vec<PerRay>,
}

/// Means over rays.
#[derive(Clone, Copy)]
struct PerRay {
    /// Tests of a camera ray.
    camera: f64,
    /// Tests and steps of all rays: camera, shadow, reflected, refracted.
    tests: f64,
    steps: f64,
}

pub(crate) fn run(session: &Session, section: &mut Section) -> Result<(), Cancelled> {
    section.shows =
        "How many objects are tested and how many nodes or cells visited for a ray, as the scene grows a hundred \
        thousand times."
            .into();
    let counts = &session.effort.promise_spheres;
    let mut all: Vec<Counted> = Vec::new();
    let mut outcome = Ok(());
    let mut done = 0.0;
    for &count in counts {
        let part = done / weight(counts);
        outcome = session.at(part, &format!("mix-{count}")).and_then(|()| scene(session, count, &mut all));
        if outcome.is_err() {
            break;
        }
        done += weight(&[count]);
    }
    add(section, counts, &all);
    section.differs = answer(counts, &all);
    outcome
}

/// About how many seconds scenes of so many spheres take on a core of 2025: rays, and building.
pub(crate) fn weight(counts: &[u32]) -> f64 {
    counts.iter().map(|&count| 0.5 + 1.5e-5 * f64::from(count)).sum()
}

fn scene(session: &Session, count: u32, all: &mut Vec<Counted>) -> Result<(), Cancelled> {
    let stock = Stock::spheres(PaperFamily::Mix, count, SIZE, &session.several);
    let unlit = stock.unlit();
    let classics = Classics::new(session, &stock, TriangleTest::Watertight, &session.several)?;
    for (name, structure) in [("grid", &classics.grid), ("median", &classics.median), ("SAH", &classics.sah)] {
        let count = |prepared: &Prepared, settings: &Settings| {
            classics.count(session, (structure, Walk::Stack), prepared, settings)
        };
        push(all, name, true, per_ray(&stock, &unlit, count)?);
    }
    push(all, "wide", false, per_ray(&stock, &unlit, |prepared, settings| wide(session, prepared, settings))?);
    Ok(())
}

fn push(all: &mut Vec<Counted>, name: &str, of_paper: bool, per_ray: PerRay) {
    match all.iter_mut().find(|counted| counted.name == name) {
        Some(counted) => counted.per_ray.push(per_ray),
        None => all.push(Counted { name: name.to_owned(), of_paper, per_ray: vec![per_ray] }),
    }
}

/// Renders the whole picture, then camera rays alone, without lights to ask for.
fn per_ray(
    stock: &Stock,
    unlit: &Prepared,
    render: impl Fn(&Prepared, &Settings) -> Result<Statistics, Cancelled>,
) -> Result<PerRay, Cancelled> {
    let settings = &stock.scene.settings;
    let all = render(&stock.prepared, settings)?;
    let camera = render(unlit, &Settings { depth: 0, ..settings.clone() })?;
    let mean = |count: u64, statistics: &Statistics| count as f64 / statistics.rays().max(1) as f64;
    Ok(PerRay {
        camera: mean(camera.primitive_tests, &camera),
        tests: mean(all.primitive_tests, &all),
        steps: mean(all.node_steps, &all),
    })
}

fn wide(session: &Session, prepared: &Prepared, settings: &Settings) -> Result<Statistics, Cancelled> {
    let (execution, rect) = (Execution::default(), PixelRect::whole(settings.size));
    let execution = Execution { method: Method::Recursive, walk: WalkKind::Single, ..execution };
    let work = || render_rect(prepared, settings, &execution, &rect, &Silent, session.cancel, &Unwatched);
    Ok(session.several.seconds(work).0?.statistics)
}

/// Whether it holds, from the numbers of the kd-tree alone.
fn answer(counts: &[u32], all: &[Counted]) -> String {
    let sah = all.iter().find(|counted| counted.name == "SAH").map_or(&[][..], |counted| &counted.per_ray);
    let (Some((first, last)), Some(most)) = (sah.first().zip(sah.last()), counts.get(sah.len().saturating_sub(1)))
    else {
        return String::new();
    };
    let least = counts[0];
    let verdict = match last.camera <= PROMISE[1] {
        true => "the promise holds for camera rays",
        false => "the promise does not hold to the letter",
    };
    format!(
        "With the paper's kd-tree a camera ray is tested against {} objects among {} spheres and {} among {}: {verdict}, but \
         its point does: the scene grew {}-fold, the tests {}-fold. Over all rays of the picture, of which many begin among the \
         spheres, it is {} and {}. An object that reaches into several leaves is tested in each. The wide tree tests more \
         objects, but up to eight at once, and visits far fewer nodes, which is what time goes to.",
        number(first.camera),
        spaced(least.into()),
        number(last.camera),
        spaced((*most).into()),
        spaced(u64::from(most / least.max(1))),
        number(last.camera / first.camera),
        number(first.tests),
        number(last.tests),
    )
}

fn add(section: &mut Section, counts: &[u32], all: &[Counted]) {
    type Of = fn(&PerRay) -> f64;
    let (camera, tests, steps): (Of, Of, Of) = (|p| p.camera, |p| p.tests, |p| p.steps);
    for (id, caption, of, unit) in [
        ("promise-camera", "Tests per ray, camera rays only", camera, "tests"),
        ("promise-tests", "Tests per ray, all rays of the picture", tests, "tests"),
        ("promise-steps", "Planes, cells or nodes met per ray, all rays of the picture", steps, "steps"),
    ] {
        section.blocks.push(Block::Table(table(id, caption, counts, all, of)));
        section.blocks.push(Block::Drawing(drawing(id, caption, unit, counts, all, of)));
    }
}

fn table(id: &str, caption: &str, counts: &[u32], all: &[Counted], of: fn(&PerRay) -> f64) -> Table {
    let row = |counted: &Counted| {
        let cell = |index: usize| counted.per_ray.get(index).map_or(Cell::Empty, |per_ray| Cell::exact(of(per_ray)));
        let cells = (0..counts.len()).map(cell).collect();
        Row { name: counted.name.clone(), of_paper: counted.of_paper, cells }
    };
    Table {
        id: id.to_owned(),
        caption: caption.to_owned(),
        corner: "structure",
        columns: counts.iter().map(|&count| Column::new(spaced(count.into()), "")).collect(),
        rows: all.iter().map(row).collect(),
    }
}

fn drawing(id: &str, caption: &str, unit: &str, counts: &[u32], all: &[Counted], of: fn(&PerRay) -> f64) -> Drawing {
    let series = |counted: &Counted| Series {
        name: counted.name.clone(),
        points: counts.iter().zip(&counted.per_ray).map(|(&count, per_ray)| [count.into(), of(per_ray)]).collect(),
    };
    let series: Vec<Series> = all.iter().map(series).collect();
    Drawing {
        id: format!("{id}-chart"),
        caption: format!(
            "{caption}; both scales are logarithmic.{}",
            if unit == "tests" { " The band is the paper's two to three." } else { "" }
        ),
        alt: format!(
            "Lines of the table above: {unit} per ray over the number of spheres, one line for each structure."
        ),
        svg: line_chart(&series, "spheres", &format!("{unit} per ray"), (unit == "tests").then_some(PROMISE)),
    }
}
