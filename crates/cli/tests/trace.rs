//! `whitted trace` as its user meets it: tables in every form, streams of any length, faults, interruption.

use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A square of two triangles at z = 0, seen by its front from above.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

const RAYS: &str = "\
ox,oy,oz,dx,dy,dz,t_min,t_max
0.75,0.25,2,0,0,-1,,
0.25,0.75,-1,0,0,0.5,,
2,2,2,0,0,-1,,
0.75,0.25,2,0,0,-1,0,1.5
0.5,0.5,2,0,0,-1,,
";

const HITS: &str = "\
t,primitive,u,v,nx,ny,nz
2.0,0,0.5,0.25,0.0,0.0,1.0
2.0,1,0.25,0.5,0.0,0.0,1.0
inf,,,,,,
inf,,,,,,
2.0,0,0.0,0.5,0.0,0.0,1.0
";

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("trace").join(test);
    // It may be left from an earlier run.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("square.obj"), SQUARE).unwrap();
    fs::write(folder.join("rays.csv"), RAYS).unwrap();
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_whitted"));
    command.arg("trace").args(arguments).current_dir(folder);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Runs the command with `input` on standard input.
fn trace(folder: &Path, arguments: &[&str], input: &[u8]) -> Output {
    let mut child = command(folder, arguments).spawn().unwrap();
    let (mut stdin, input) = (child.stdin.take().unwrap(), input.to_vec());
    // A command that does not read its input closes it.
    let writer = std::thread::spawn(move || drop(stdin.write_all(&input)));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    output
}

#[track_caller]
fn expect(folder: &Path, arguments: &[&str], input: &[u8], code: i32, words: &[&str]) -> Vec<u8> {
    let output = trace(folder, arguments, input);
    let messages = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {messages}");
    for word in words {
        assert!(messages.contains(word), "{arguments:?}: no '{word}' in: {messages}");
    }
    output.stdout
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn rays_in_text_give_hits_in_text() {
    let folder = folder("text");
    let shown = expect(&folder, &["square.obj", "rays.csv"], b"", 0, &["traced 5 rays, 3 hit, to standard output"]);
    assert_eq!(String::from_utf8(shown).unwrap(), HITS);
    let read = expect(&folder, &["square.obj", "-", "-o", "-", "-q"], RAYS.as_bytes(), 0, &[]);
    assert_eq!(String::from_utf8(read).unwrap(), HITS);
    expect(&folder, &["square.obj", "rays.csv", "-o", "hits.csv"], b"", 0, &["'hits.csv'"]);
    assert_eq!(fs::read_to_string(folder.join("hits.csv")).unwrap(), HITS);
    assert_eq!(names(&folder), ["hits.csv", "rays.csv", "square.obj"]);
    let windows = format!("\u{feff}{}", RAYS.trim_end().replace('\n', "\r\n"));
    assert_eq!(expect(&folder, &["square.obj", "-", "-q"], windows.as_bytes(), 0, &[]), HITS.as_bytes());
}

#[test]
fn how_rays_are_walked_is_told_to_whom_asks() {
    let folder = folder("walk");
    for (tree, words) in [("best", "rays go through the tree in packets of 64"), ("none", "there is no tree")] {
        let arguments = ["square.obj", "rays.csv", "-v", "--tree", tree];
        assert_eq!(expect(&folder, &arguments, b"", 0, &[words, ", because "]), HITS.as_bytes());
    }
}

#[test]
fn every_tree_and_number_of_threads_gives_the_same_bytes() {
    let folder = folder("execution");
    for options in [["--tree", "none"], ["--tree", "fast"], ["--tree", "kd"], ["-t", "1"], ["-t", "3"]] {
        let hits = expect(&folder, &["square.obj", "rays.csv", "-q", options[0], options[1]], b"", 0, &[]);
        assert_eq!(hits, HITS.as_bytes(), "{options:?}");
    }
}

/// The rays of `RAYS` as numbers.
fn numbers(columns: usize) -> Vec<f32> {
    let number = |(column, text): (usize, &str)| match text {
        "" if column == 7 => f32::INFINITY,
        "" => 0.0,
        text => text.parse().unwrap(),
    };
    let row = |line: &str| line.split(',').enumerate().take(columns).map(number).collect::<Vec<f32>>();
    RAYS.lines().skip(1).flat_map(row).collect()
}

fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// t and primitive of each record of raw hits.
fn records(hits: &[u8]) -> Vec<(f32, i32)> {
    assert_eq!(hits.len() % 28, 0);
    let number = |bytes: &[u8]| <[u8; 4]>::try_from(bytes).unwrap();
    hits.chunks(28).map(|hit| (f32::from_le_bytes(number(&hit[..4])), i32::from_le_bytes(number(&hit[4..8])))).collect()
}

const FOUND: [(f32, i32); 5] = [(2.0, 0), (2.0, 1), (f32::INFINITY, -1), (f32::INFINITY, -1), (2.0, 0)];

#[test]
fn every_form_of_rays_gives_every_form_of_hits() {
    let folder = folder("forms");
    let head = b"\x93NUMPY\x01\0\x46\0{'descr': '<f4', 'fortran_order': False, 'shape': (5, 8), }          \n";
    assert_eq!(head.len(), 80);
    fs::write(folder.join("rays.f32x8"), bytes(&numbers(8))).unwrap();
    fs::write(folder.join("rays.npy"), [&head[..], &bytes(&numbers(8))].concat()).unwrap();
    for rays in ["rays.csv", "rays.f32x8", "rays.npy"] {
        let text = expect(&folder, &["square.obj", rays, "--hits-format", "csv"], b"", 0, &[]);
        assert_eq!(text, HITS.as_bytes(), "{rays}");
        expect(&folder, &["square.obj", rays, "-o", "hits.npy"], b"", 0, &[]);
        let array = fs::read(folder.join("hits.npy")).unwrap();
        let length = 10 + usize::from(u16::from_le_bytes([array[8], array[9]]));
        assert!(String::from_utf8_lossy(&array[..length]).contains("'shape': (5,)"), "{rays}");
        assert_eq!(records(&array[length..]), FOUND, "{rays}");
        expect(&folder, &["square.obj", rays, "-o", "hits.f32"], b"", 0, &[]);
        assert_eq!(fs::read(folder.join("hits.f32")).unwrap(), array[length..], "{rays}");
    }
    // Without ranges, the ray that ended before the square reaches it; hits on standard output are as the rays are.
    let hits = expect(&folder, &["square.obj", "-", "--rays-format", "f32"], &bytes(&numbers(6)), 0, &[]);
    assert_eq!(records(&hits)[3], (2.0, 0));
    let array = expect(&folder, &["square.obj", "rays.npy"], b"", 0, &[]);
    assert!(array.starts_with(b"\x93NUMPY") && array.ends_with(&fs::read(folder.join("hits.f32")).unwrap()));
}

#[test]
fn scenes_of_any_kind_are_traced_without_floors_and_where_they_are() {
    let folder = folder("scenes");
    fs::write(
        folder.join("far.toml"),
        "version = 1\n[[sphere]]\ncenter = [1e9, 0, 0]\nradius = 1e6\n[[plane]]\npoint = [0, -2e6, 0]\n",
    )
    .unwrap();
    let rays = "ox,oy,oz,dx,dy,dz\n1e9,0,5e6,0,0,-1\n1e9,5e6,5e6,0,-1,0\n";
    let hits = expect(&folder, &["far.toml", "-", "-q"], rays.as_bytes(), 0, &[]);
    let hits = String::from_utf8(hits).unwrap();
    let lines: Vec<&str> = hits.lines().collect();
    assert!(lines[1].starts_with("4000000.0,0,") && lines[1].ends_with(",0.0,0.0,1.0"), "{hits}");
    assert!(lines[2].starts_with("7000000.0,1,") && lines[2].ends_with(",0.0,1.0,0.0"), "{hits}");
}

#[test]
fn faults_of_rays_are_3_name_the_place_and_leave_no_file() {
    let folder = folder("faults");
    fs::write(folder.join("bad.csv"), RAYS.replace("0.25,0.75,-1", "0.25,high,-1")).unwrap();
    fs::write(folder.join("bad.f32"), [0; 25]).unwrap();
    fs::write(folder.join("bad.npy"), "no array").unwrap();
    let before = names(&folder);
    for (rays, words) in [
        ("bad.csv", &["bad.csv:3:6: oy must be a number, not \"high\"", "^^^^"][..]),
        ("bad.f32", &["bad.f32: byte 25", "1 of 24 bytes"]),
        ("bad.npy", &["bad.npy: byte 0: this is no NumPy file", "hint:"]),
    ] {
        expect(&folder, &["square.obj", rays, "-o", "hits.csv"], b"", 3, words);
        assert_eq!(names(&folder), before, "{rays}");
    }
    fs::write(folder.join("hits.csv"), "mine").unwrap();
    expect(&folder, &["square.obj", "bad.csv", "-o", "hits.csv"], b"", 3, &[]);
    assert_eq!(fs::read(folder.join("hits.csv")).unwrap(), b"mine");
}

#[test]
fn what_is_asked_wrongly_is_told_before_anything_is_read() {
    let folder = folder("usage");
    for (arguments, code, words) in [
        (&["square.obj"][..], 2, "<RAYS>"),
        (&["none.obj", "rays.txt"], 2, ".csv, .npy, .f32, .f32x8"),
        (&["none.obj", "rays.csv", "-o", "hits.txt"], 2, ".csv, .npy, .f32"),
        (&["none.obj", "rays.csv", "--hits-format", "xml"], 2, "csv, npy or f32"),
        (&["none.obj", "rays.csv", "--hits-format", "npy"], 2, "name a file"),
        (&["none.obj", "rays.csv", "-o", "none/hits.csv"], 1, "no folder"),
        (&["none.obj", "none.csv"], 1, "none.csv"),
        (&["none.obj", "rays.csv"], 1, "none.obj"),
    ] {
        expect(&folder, arguments, b"", code, &[words]);
    }
    assert_eq!(names(&folder), ["rays.csv", "square.obj"]);
}

/// Traces `count` raw rays from a stream that is never in memory as a whole; gives peak memory in KiB.
fn peak_of_stream(folder: &Path, count: usize) -> u64 {
    let arguments = ["square.obj", "-", "--rays-format", "f32", "-v"];
    let mut child = command(folder, &arguments).spawn().unwrap();
    let (mut stdin, mut stdout) = (child.stdin.take().unwrap(), child.stdout.take().unwrap());
    let writer = std::thread::spawn(move || {
        let thousand = bytes(&[0.75, 0.25, 2.0, 0.0, 0.0, -1.0].repeat(1000));
        (0..count / 1000).for_each(|_| stdin.write_all(&thousand).unwrap());
    });
    let (mut piece, mut length) = (vec![0; 1 << 16], 0);
    loop {
        match stdout.read(&mut piece).unwrap() {
            0 => break,
            more => length += more,
        }
    }
    writer.join().unwrap();
    assert_eq!(length, 28 * count);
    let messages = String::from_utf8(child.wait_with_output().unwrap().stderr).unwrap();
    assert!(messages.contains(&format!("traced {count} rays, {count} hit")), "{messages}");
    let peak = messages.split("peak memory ").nth(1).and_then(|rest| rest.split(' ').next());
    peak.expect("a peak").parse().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn a_stream_of_any_length_takes_the_same_memory() {
    let folder = folder("stream");
    let (short, long) = (peak_of_stream(&folder, 300_000), peak_of_stream(&folder, 6_000_000));
    println!("peak {short} KiB for 300,000 rays, {long} KiB for 6,000,000 rays of 137 MiB");
    assert!(long < short + 16 * 1024, "{short} KiB, then {long} KiB");
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_no_hits() {
    let folder = folder("interrupt");
    let arguments = ["square.obj", "-", "--rays-format", "f32", "-o", "hits.f32", "-v"];
    let mut child = command(&folder, &arguments).stdout(Stdio::null()).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    // An endless stream; it ends when nobody reads it any more.
    let writer = std::thread::spawn(move || while stdin.write_all(&[0; 24 * 1000]).is_ok() {});
    let temporary = || names(&folder).iter().any(|name| name.starts_with(".hits.f32."));
    while !temporary() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(names(&folder), ["rays.csv", "square.obj"]);
}

/// A C hexadecimal float such as `-0x1.8p+3`.
fn hexadecimal(text: &str) -> f32 {
    let (sign, digits) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
    let (mantissa, exponent) = digits.strip_prefix("0x").and_then(|d| d.split_once('p')).expect("a hexadecimal float");
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let all = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap() as f64;
    (sign * all * 2f64.powi(exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32)) as f32
}

#[test]
fn the_exact_oracle_agrees() {
    let Some(shared) = std::env::var_os("WHITTED_SHARED") else {
        return eprintln!("SKIPPED: WHITTED_SHARED is not set, so no exact oracle was traced");
    };
    const T_BOUND: f64 = 1.0 / (1u64 << 23) as f64;
    let folder = folder("oracle");
    for mesh in ["suzanne", "teapot", "cow", "stanford-bunny", "homer", "fandisk", "beetle"] {
        let material = Path::new(&shared).join("material");
        let table = fs::read_to_string(material.join(format!("oracle/{mesh}.rays.csv"))).unwrap();
        let cases: Vec<Vec<&str>> = table.lines().skip(1).map(|line| line.split(',').collect()).collect();
        let rays: Vec<f32> = cases.iter().flat_map(|case| case[1..7].iter().map(|text| hexadecimal(text))).collect();
        let text: String =
            rays.chunks(6).map(|r| r.iter().map(f32::to_string).collect::<Vec<_>>().join(",") + "\n").collect();
        fs::write(folder.join("rays.f32"), bytes(&rays)).unwrap();
        let obj = material.join(format!("mesh/common-3d/{mesh}.obj"));
        let hits = expect(&folder, &[obj.to_str().unwrap(), "rays.f32"], b"", 0, &[]);
        let from_text = format!("ox,oy,oz,dx,dy,dz\n{text}");
        let arguments = [obj.to_str().unwrap(), "-", "--hits-format", "f32"];
        assert!(expect(&folder, &arguments, from_text.as_bytes(), 0, &[]) == hits, "{mesh}: text = binary");
        for (row, (case, (t, primitive))) in cases.iter().zip(records(&hits)).enumerate() {
            let (nearest, must_hit): (f64, bool) = (case[8].parse().unwrap(), case[12] == "1");
            if must_hit {
                assert!(f64::from(t) <= nearest * (1.0 + 1e-5), "{mesh} ray {row}: a leak, {t} for {nearest}");
            }
            if matches!(case[0], "0" | "3") && case[11] == "0" {
                assert_eq!(primitive, case[9].parse::<i32>().unwrap(), "{mesh} ray {row}");
                let wrong = primitive >= 0 && (f64::from(t) - nearest).abs() > T_BOUND * nearest.abs();
                assert!(!wrong, "{mesh} ray {row}: {t} for {nearest}");
            }
        }
    }
}
