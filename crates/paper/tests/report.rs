//! A whole run with tiny settings, its files read back.

use paper::report::{Block, Cell, Ending, Number, Report};
use paper::{Effort, Experiment, Plan, Watch};
use std::cell::RefCell;
use whitted::render::Cancel;

/// Takes seconds and proves nothing about speed.
fn tiny() -> Effort {
    Effort {
        name: "tiny",
        size: [64, 48],
        spheres: vec![10, 50],
        region_spheres: vec![10],
        regions: vec![1, 16],
        promise_spheres: vec![10, 100],
        rounds: 2,
        seconds: 0.005,
        operations: 10_000,
        threads: 2,
    }
}

/// Remembers how far the run was, and stops it at a step.
#[derive(Default)]
struct Log {
    parts: RefCell<Vec<f64>>,
    stop_after: Option<usize>,
    cancel: Cancel,
}

impl Watch for Log {
    fn at(&self, part: f64, what: &str) {
        assert!(!what.is_empty());
        let mut parts = self.parts.borrow_mut();
        parts.push(part);
        if self.stop_after.is_some_and(|stop| parts.len() > stop) {
            self.cancel.cancel();
        }
    }
}

fn run(experiments: &[Experiment], log: &Log) -> Report {
    let plan = Plan { experiments: experiments.to_vec(), effort: tiny() };
    paper::run(&plan, log, &log.cancel).unwrap()
}

#[test]
fn a_whole_run_is_complete_and_its_files_can_be_read() {
    let log = Log::default();
    let report = run(&Experiment::ALL, &log);
    assert_eq!(report.ending, Ending::Complete, "{:#?}", report.checks);
    assert_eq!(report.sections.len(), Experiment::ALL.len());
    assert!(!report.checks.is_empty());
    let parts = log.parts.borrow();
    assert!(parts.windows(2).all(|pair| pair[0] <= pair[1] + 1e-12), "{parts:?}");
    assert!(parts.iter().all(|part| (0.0..=1.0).contains(part)));

    let page = report.to_html();
    well_formed(&page);
    for section in &report.sections {
        assert!(section.complete && !section.shows.is_empty() && !section.blocks.is_empty(), "{}", section.id);
        assert!(page.contains(&format!("<section id=\"{}\">", section.id)), "{}", section.id);
    }
    // Nothing is fetched: what begins with a scheme is the name of the drawings' language, and data.
    for (at, _) in page.match_indices("://") {
        assert!(
            page[..at].ends_with("=\"http") && page[at..].starts_with("://www.w3.org/2000/svg\""),
            "{}",
            &page[at - 40..at + 40]
        );
    }
    assert!(!page.contains("<script") && !page.contains("@import") && !page.contains("url(http"));
    ids_are_unique(&page);
}

#[test]
fn all_forms_hold_the_same_numbers() {
    let report = run(&[Experiment::Table1, Experiment::Table3, Experiment::Figure4], &Log::default());
    let json: serde_json::Value = serde_json::from_str(&report.to_json()).unwrap();
    let markdown = report.to_markdown();
    let csv = report.to_csv();
    let mut lines = csv::Reader::from_reader(csv.as_bytes());
    let names = lines.headers().unwrap().clone();
    let records: Vec<csv::StringRecord> = lines.records().map(Result::unwrap).collect();
    let column = |name: &str| names.iter().position(|known| known == name).unwrap();
    let mut cells = 0;
    for (index, section) in report.sections.iter().enumerate() {
        assert_eq!(json["sections"][index]["id"], section.id);
        for table in section.tables() {
            assert!(markdown.contains(&format!("**{}**", table.caption)));
            for row in &table.rows {
                for (at, cell) in table.columns.iter().zip(&row.cells) {
                    let Some(measured) = cell.measured() else { continue };
                    let is_it = |record: &&csv::StringRecord| {
                        [&record[column("table")], &record[column("row")], &record[column("column")]]
                            == [table.id.as_str(), &row.name, &at.name]
                    };
                    let record = records.iter().find(is_it).unwrap();
                    assert_eq!(record[column("median")].parse::<f64>().unwrap(), measured.median);
                    cells += 1;
                }
            }
        }
    }
    assert!(cells > 30, "{cells}");
    assert_eq!(json["ending"], "complete");
    let files = report.files();
    for file in &files {
        let text = String::from_utf8_lossy(&file.bytes);
        match file.path.rsplit('.').next() {
            Some("svg") => well_formed(&text),
            Some("png") => assert!(file.bytes.starts_with(b"\x89PNG")),
            _ => assert!(!text.is_empty()),
        }
        assert!(!file.path.contains("figures") || markdown.contains(&file.path), "{}", file.path);
    }
    assert!(files.iter().any(|file| file.path == "report.html"));
}

/// What stands in a table at a row and a column.
fn number<'a>(report: &'a Report, table: &str, row: &str, column: &str) -> &'a Number {
    let tables = report.sections.iter().flat_map(|section| section.tables());
    let table = tables.into_iter().find(|known| known.id == table).expect("the table is there");
    let row = table.rows.iter().find(|known| known.name == row).expect("the row is there");
    let column = table.columns.iter().position(|known| known.name == column).expect("the column is there");
    let Cell::Number(number) = &row.cells[column] else { panic!("a number, not {:?}", row.cells[column]) };
    number
}

#[test]
fn the_papers_numbers_stand_beside_ours() {
    let report = run(&[Experiment::Table1, Experiment::Table2, Experiment::Table4], &Log::default());
    for (table, row, column, paper) in [
        ("table1-all4", "naive", "10", 2.2),
        ("table1-mix", "SSE math", "10", 1.1),
        ("table1-mix", "kd-tree + SSE + region", "10", 0.1),
        ("table1-mix-ratio", "kd-tree + SSE", "10", 22.0),
        ("table2", "16", "the paper", 1.69),
        ("table4", "SSE + alignment", "paper", 1.4),
    ] {
        let number = number(&report, table, row, column);
        let printed = number.paper.expect("the paper has it");
        assert!((printed - paper).abs() < 1e-9, "{table}, {row}, {column}: {printed}");
    }
    // What is measured is a time, and no more than all rounds took.
    let naive = number(&report, "table1-mix", "naive", "50").measured.expect("it was measured");
    assert!(
        0.0 < naive.low && naive.low <= naive.median && naive.median <= naive.high && naive.high < 60.0,
        "{naive:?}"
    );
    assert_eq!((naive.rounds, number(&report, "table1-mix", "naive", "50").paper), (2, None));
}

#[test]
fn every_technique_is_in_table_1_and_every_region_in_table_2() {
    let report = run(&[Experiment::Table1, Experiment::Table2], &Log::default());
    let rows = |id: &str| -> Vec<&str> {
        let table = report.sections.iter().flat_map(|section| section.tables()).find(|table| table.id == id).unwrap();
        assert!(
            table.rows.iter().flat_map(|row| &row.cells).all(|cell| !matches!(cell, Cell::Empty)) || id == "table2"
        );
        table.rows.iter().map(|row| row.name.as_str()).collect()
    };
    for family in ["table1-all4", "table1-mix"] {
        let rows = rows(family);
        let paper = ["naive", "SSE math", "kd-tree + SSE", "kd-tree + SSE + region"];
        assert!(paper.iter().all(|name| rows.contains(name)), "{rows:?}");
        assert!(rows.iter().any(|name| name.starts_with("streams + frusta")) && rows.contains(&"the same, 2 threads"));
    }
    assert_eq!(rows("table2"), ["1", "16", "scanline", "whole picture"]);
}

#[test]
fn tests_and_steps_of_rays_are_counted() {
    let report = run(&[Experiment::Promise], &Log::default());
    for structure in ["grid", "median", "SAH", "wide"] {
        for (spheres, most) in [("10", 40.0), ("100", 60.0)] {
            let of = |table| number(&report, table, structure, spheres).measured.unwrap().median;
            let (camera, tests, steps) = (of("promise-camera"), of("promise-tests"), of("promise-steps"));
            assert!(0.0 < camera && camera < most && 0.0 < tests && tests < most, "{structure}: {camera} {tests}");
            assert!(steps >= 1.0, "{structure}: {steps}");
        }
    }
}

#[test]
fn a_stopped_run_leaves_a_valid_report_wherever_it_is_stopped() {
    let experiments = [Experiment::Table3, Experiment::Table1, Experiment::Figure4];
    let log = Log::default();
    run(&experiments, &log);
    let steps = log.parts.borrow().len();
    let mut tables = 0;
    for stop in (0..steps).step_by(steps.div_ceil(12)) {
        let report = run(&experiments, &Log { stop_after: Some(stop), ..Log::default() });
        assert_eq!(report.ending, Ending::Interrupted, "{stop}");
        assert!(report.sections.last().is_some_and(|section| !section.complete));
        let page = report.to_html();
        well_formed(&page);
        assert!(page.contains("interrupted"));
        serde_json::from_str::<serde_json::Value>(&report.to_json()).unwrap();
        tables += report.sections.iter().flat_map(|section| section.tables()).count();
    }
    assert!(tables > 0);
}

#[test]
fn only_what_was_asked_for_is_measured() {
    let report = run(&[Experiment::Figure5], &Log::default());
    let [section] = &report.sections[..] else { panic!("one section") };
    assert!(matches!(&section.blocks[..], [Block::Picture(picture)] if picture.size == [640, 480]));
}

/// Elements that HTML leaves open.
const VOID: [&str; 4] = ["meta", "img", "br", "!DOCTYPE"];

/// Every element is closed in order, and attributes are quoted.
#[track_caller]
fn well_formed(page: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = page;
    while let Some(at) = rest.find('<') {
        rest = &rest[at + 1..];
        let end = tag_end(rest);
        let (tag, after) = (&rest[..end], &rest[end + 1..]);
        rest = after;
        let name = tag.trim_start_matches('/').split([' ', '\n', '/']).next().unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "closed out of order");
        } else if !tag.ends_with('/') && !VOID.contains(&name) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "not closed: {open:?}");
}

/// Where a tag ends: at the first `>` outside quotation marks.
#[track_caller]
fn tag_end(tag: &str) -> usize {
    let mut quoted = false;
    let end = tag.char_indices().find(|&(_, c)| {
        quoted ^= c == '"';
        c == '>' && !quoted
    });
    end.expect("a tag ends").0
}

#[track_caller]
fn ids_are_unique(page: &str) {
    let mut ids: Vec<&str> = page.split(" id=\"").skip(1).map(|rest| &rest[..rest.find('"').unwrap()]).collect();
    ids.sort_unstable();
    let all = ids.len();
    ids.dedup();
    assert_eq!(ids.len(), all);
}
