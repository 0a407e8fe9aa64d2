//! `whitted paper` as its user meets it.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// An empty folder of its own for one test.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("paper").join(test);
    // It may be left from an earlier run.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_whitted"));
    command.arg("paper").args(arguments).current_dir(folder).stdin(Stdio::null());
    command
}

#[track_caller]
fn expect(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) -> Output {
    let output = command(folder, arguments).output().unwrap();
    let messages = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {messages}");
    for word in words {
        assert!(messages.contains(word), "{arguments:?}: no '{word}' in: {messages}");
    }
    output
}

#[test]
fn wrong_usage_is_2_and_suggests_what_was_meant() {
    let folder = folder("usage");
    expect(&folder, &["--only", "tabel1"], 2, &["tabel1", "'table1'"]);
    expect(&folder, &["--only", "table1,figur5"], 2, &["figur5", "'figure5'"]);
    expect(&folder, &["--threads", "0"], 2, &["1 to"]);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn a_folder_that_cannot_be_is_1_before_anything_is_measured() {
    let folder = folder("output");
    fs::write(folder.join("taken"), "").unwrap();
    expect(&folder, &["-o", "taken"], 1, &["'taken'", "not a folder"]);
    expect(&folder, &["-o", "no/such"], 1, &["'no/such'", "is not there"]);
    fs::create_dir_all(folder.join("odd/report.html")).unwrap();
    expect(&folder, &["-o", "odd"], 1, &["report.html", "it is a folder"]);
}

#[test]
fn a_run_leaves_its_files_and_nothing_else() {
    let folder = folder("run");
    let output = expect(&folder, &["--quick", "--only", "figure5", "-o", "out"], 0, &["wrote 'out", "report.html"]);
    assert!(output.stdout.is_empty());
    let mut names: Vec<String> = fs::read_dir(folder.join("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["figures", "report.csv", "report.html", "report.json", "report.md"]);
    assert!(fs::read(folder.join("out/figures/figure5.png")).unwrap().starts_with(b"\x89PNG"));
    // Again, over what is there.
    let output = expect(&folder, &["--quick", "--only", "figure5", "-o", "out", "-q"], 0, &[]);
    assert!(output.stderr.is_empty());
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_a_report_of_what_was_measured() {
    let folder = folder("interrupt");
    let arguments = ["--only", "figure5,table1", "-o", "out"];
    let mut child = command(&folder, &arguments).stderr(Stdio::piped()).spawn().unwrap();
    let mut messages = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(messages.any(|line| line.unwrap().contains("all4-10")));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let rest: Vec<String> = messages.map(Result::unwrap).collect();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{rest:?}");
    assert!(rest.iter().any(|line| line.contains("what was measured is in")), "{rest:?}");
    let page = fs::read_to_string(folder.join("out/report.html")).unwrap();
    assert!(page.contains("The run was interrupted") && page.ends_with("</html>"));
    assert!(fs::read_to_string(folder.join("out/report.json")).unwrap().contains("\"ending\": \"interrupted\""));
}
