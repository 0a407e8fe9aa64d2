//! The command as its user meets it: exit codes, messages, and what lies in the folder afterwards.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A folder of its own for one test, holding `scene.nff`.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    // It may be left from an earlier run.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("scene.nff"), SCENE).unwrap();
    folder
}

const SCENE: &str = "\
v
from 0 1 6
at 0 0 0
up 0 1 0
angle 40
hither 1
resolution 48 32
l 4 6 5
f 0.8 0.8 0.8 0.2 0.7 30 0 1
s -1.1 0 0 1
f 0.8 0.8 0.8 0.05 0.1 30 0.85 1.5
s 1.1 0 0.5 1
";

fn whitted(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_whitted"));
    command.args(arguments).current_dir(folder).stdin(Stdio::null()).output().unwrap()
}

/// Runs the command and checks its exit code and that its messages contain each of `words`.
#[track_caller]
fn expect(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) -> Output {
    let output = whitted(folder, arguments);
    let messages = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {messages}");
    for word in words {
        assert!(messages.contains(word), "{arguments:?}: no '{word}' in: {messages}");
    }
    output
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Width and height from a PNG's header.
#[track_caller]
fn png_size(bytes: &[u8]) -> [u32; 2] {
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()))
}

#[test]
fn help_and_version_succeed() {
    let folder = folder("help");
    for arguments in
        [&["--help"][..], &["--version"], &["render", "--help"], &["check", "--help"], &["explain", "--help"]]
    {
        assert!(!expect(&folder, arguments, 0, &[]).stdout.is_empty());
    }
}

#[test]
fn wrong_usage_is_2_and_says_what_was_expected() {
    let folder = folder("usage");
    for (arguments, word) in [
        (&[][..], "Usage"),
        (&["paint"], "paint"),
        (&["render"], "<SCENE>"),
        (&["render", "scene.nff", "--aa", "best"], "off, paper, edge or a number"),
        (&["render", "scene.nff", "--size", "640"], "640x480"),
        (&["render", "scene.nff", "--simd", "mmx"], "scalar"),
        (&["render", "scene.nff", "--tree", "oak"], "best, fast, kd, none, kd8, median or grid"),
        (&["render", "scene.nff", "--tree", "kd8"], "add --render recursive"),
        (&["render", "scene.nff", "--walk", "stack"], "add --tree kd8"),
        (&["render", "scene.nff", "--tree", "grid", "--render", "recursive", "--walk", "stack"], "add --tree kd8"),
        (&["render", "scene.nff", "--tree", "grid", "--render", "recursive", "--walk", "auto"], "leave --walk out"),
        (&["render", "scene.nff", "--tree", "kd8", "--render", "recursive", "--walk", "auto"], "--walk sequential"),
        (&["render", "scene.nff", "--math", "sse"], "add --render recursive"),
        (&["render", "scene.nff", "--render", "recursive", "--triangle", "projection"], "--tree kd8"),
        (&["render", "scene.nff", "-t", "0"], "from 1"),
        (&["render", "scene.nff", "-q", "-v"], "cannot be used with"),
        (&["render", "scene.nff", "-o", "a.bmp"], ".png"),
        (&["render", "scene.nff", "-o", "noextension"], ".png"),
        (&["render", "scene.nff", "-o", "-", "--stats", "json"], "standard output"),
        (&["render", "scene.nff", "-o", "a.png", "--stats", "json=./a.png"], "same file"),
        (&["render", "scene.nff", "--aov", "color"], "normal, depth, id"),
        (&["render", "scene.nff", "-o", "-", "--aov", "depth"], "standard output"),
        (&["render", "scene.nff", "-o", "a.png", "--aov", "id", "--stats", "json=./a.id.png"], "same file"),
        (&["explain", "scene.nff", "3"], "X,Y"),
        (&["explain", "scene.nff", "48,0"], "48x32"),
        (&["explain", "scene.nff", "0,0", "--crop", "0,0,4x4"], "--crop"),
        (&["render", "scene.nff", "--crop", "40,0,9x1"], "48x32"),
        (&["render", "scene.nff", "--camera", "front"], "front"),
    ] {
        expect(&folder, arguments, 2, &[word]);
    }
    assert_eq!(names(&folder), ["scene.nff"]);
}

#[test]
fn files_that_cannot_be_read_or_written_are_1() {
    let folder = folder("files");
    fs::create_dir(folder.join("taken.png")).unwrap();
    expect(&folder, &["render", "none.nff", "-o", "a.png"], 1, &["none.nff"]);
    expect(&folder, &["check", "none.nff"], 1, &["none.nff"]);
    expect(&folder, &["render", "scene.nff", "-o", "none/a.png"], 1, &["none/a.png", "no folder"]);
    expect(&folder, &["render", "scene.nff", "-o", "taken.png"], 1, &["it is a folder"]);
    expect(&folder, &["render", "scene.nff", "-o", "a.png", "--stats", "json=none/a.json"], 1, &["no folder"]);
    assert_eq!(names(&folder), ["scene.nff", "taken.png"]);
}

#[test]
fn other_pictures_stand_beside_the_picture() {
    let folder = folder("aovs");
    let all = "normal,depth,id,primitive,importance,supersampled,nodes,tests,time";
    let output = expect(&folder, &["render", "scene.nff", "--aov", all], 0, &["a ray was cut", "(dark) to"]);
    assert_eq!(String::from_utf8_lossy(&output.stderr).matches("wrote 'scene.").count(), 10);
    let expected =
        all.split(',').map(|name| format!("scene.{name}.png")).chain(["scene.nff", "scene.png"].map(String::from));
    let mut expected: Vec<String> = expected.collect();
    expected.sort();
    assert_eq!(names(&folder), expected);
    let depth = fs::read(folder.join("scene.depth.png")).unwrap();
    assert_eq!(png_size(&depth), [48, 32]);
    assert!(String::from_utf8_lossy(&depth).contains("distance from the eye"), "the file says what it shows");
}

#[test]
fn a_pixel_is_explained_to_people_and_to_programs() {
    let folder = folder("explain");
    // The middle of the left ball, which mirrors.
    let output = expect(&folder, &["explain", "scene.nff", "13,17"], 0, &[]);
    let text = String::from_utf8(output.stdout).unwrap();
    for words in
        ["pixel 13,17: ", "sample 0 at 13.5,17.5", "camera hits sphere 1", "├─ light 1 arrives", "└─ reflected × "]
    {
        assert!(text.contains(words), "no '{words}' in:\n{text}");
    }
    let output = expect(&folder, &["explain", "scene.nff", "13,17", "--json", "--aa", "4", "--all-samples"], 0, &[]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&json["sample_count"], json["samples"].as_array().unwrap().len()), (&4.into(), 4));
    let rays = json["samples"][0]["rays"].as_array().unwrap();
    assert_eq!(
        (&rays[0]["kind"], &rays[0]["end"], &rays[0]["parent"]),
        (&"camera".into(), &"hit".into(), &serde_json::Value::Null)
    );
    assert_eq!((&rays[1]["kind"], &rays[1]["light"], &rays[1]["parent"]), (&"shadow".into(), &0.into(), &0.into()));
    assert_eq!(rays[0]["hit"]["object"], "sphere 1");
}

#[test]
fn how_rays_are_walked_is_told_to_whom_asks() {
    let folder = folder("walk");
    let arguments = ["render", "scene.nff", "-v", "-o", "a.png"];
    let camera = "rays from the camera and to lights: in packets of 64";
    let others = "reflected and refracted rays: in lists, short ones in turns, because";
    expect(&folder, &arguments, 0, &[camera, others]);
    expect(&folder, &[&arguments[..], &["--walk", "single"]].concat(), 0, &["one by one, because it was asked for"]);
    expect(&folder, &[&arguments[..], &["--render", "recursive"]].concat(), 0, &["because there is only one"]);
}

#[test]
fn a_read_only_picture_is_not_replaced() {
    let folder = folder("read_only");
    let picture = folder.join("a.png");
    fs::write(&picture, "mine").unwrap();
    let mut permissions = fs::metadata(&picture).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&picture, permissions).unwrap();
    expect(&folder, &["render", "scene.nff", "-o", "a.png"], 1, &["read-only"]);
    assert_eq!(fs::read(&picture).unwrap(), b"mine");
}

#[test]
fn an_output_problem_is_told_before_the_scene_is_read() {
    let folder = folder("before");
    expect(&folder, &["render", "none.nff", "-o", "a.bmp"], 2, &["a.bmp"]);
    expect(&folder, &["render", "none.nff", "-o", "none/a.png"], 1, &["none/a.png"]);
}

#[test]
fn errors_in_a_scene_are_3_and_name_the_line() {
    let folder = folder("scene_errors");
    fs::write(folder.join("typo.nff"), SCENE.replace("0.5 1", "0.5 one")).unwrap();
    for command in ["check", "render"] {
        expect(&folder, &[command, "typo.nff"], 3, &["typo.nff:12:13", "one", "^"]);
    }
    fs::write(folder.join("cut.nff"), &SCENE[..SCENE.len() - 5]).unwrap();
    expect(&folder, &["check", "cut.nff"], 3, &["cut.nff:"]);
    assert_eq!(names(&folder), ["cut.nff", "scene.nff", "typo.nff"]);
}

#[test]
fn a_picture_is_written_whole_and_nothing_else() {
    let folder = folder("picture");
    let output = expect(&folder, &["render", "scene.nff"], 0, &["scene.png", "48x32"]);
    assert!(output.stdout.is_empty());
    assert_eq!(names(&folder), ["scene.nff", "scene.png"]);
    let picture = fs::read(folder.join("scene.png")).unwrap();
    assert_eq!(png_size(&picture), [48, 32]);
    // An existing picture is replaced, and standard output carries the same bytes and no others.
    fs::write(folder.join("scene.png"), "old").unwrap();
    expect(&folder, &["render", "scene.nff"], 0, &[]);
    assert!(fs::read(folder.join("scene.png")).unwrap() == picture);
    assert!(expect(&folder, &["render", "scene.nff", "-o", "-"], 0, &[]).stdout == picture);
}

#[test]
fn execution_options_do_not_change_the_picture() {
    let folder = folder("execution");
    let render = |options: &str| {
        let arguments: Vec<&str> = ["render", "scene.nff", "-o", "-"].into_iter().chain(options.split(' ')).collect();
        expect(&folder, &arguments, 0, &[]).stdout
    };
    let picture = render("-v");
    for options in [
        "-t 1",
        "-t 3 --region 7x5",
        "--region scanline",
        "--region frame",
        "--tree none",
        "--tree kd",
        "--tree fast --walk stream",
        "--walk single",
        "--simd scalar",
        "--render recursive",
    ] {
        assert!(render(options) == picture, "{options}");
    }
    for [one, other] in [
        ["--depth 0", "--depth 5"],
        ["--aa off", "--aa edge"],
        ["--sampling centers", "--sampling corners"],
        ["--shadows filter", "--shadows opaque"],
        ["--size 32x32", "--size 48x32"],
        ["--min-weight 0", "--min-weight 0.5"],
    ] {
        assert!(render(one) != render(other), "{one}, {other}");
    }
}

#[test]
fn a_crop_is_that_part_of_the_picture() {
    let folder = folder("crop");
    let decode = |options: &str| {
        let arguments: Vec<&str> = ["render", "scene.nff", "-o", "-"].into_iter().chain(options.split(' ')).collect();
        let output = expect(&folder, &arguments, 0, &[]).stdout;
        let mut reader = png::Decoder::new(std::io::Cursor::new(output)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        pixels
    };
    let (whole, part) = (decode("-v"), decode("--crop 11,7,20x13"));
    for (y, row) in part.chunks(3 * 20).enumerate() {
        let start = 3 * (48 * (7 + y) + 11);
        assert!(*row == whole[start..start + 3 * 20], "row {y}");
    }
}

#[test]
fn quiet_says_nothing() {
    let folder = folder("quiet");
    let output = expect(&folder, &["render", "scene.nff", "-q"], 0, &[]);
    assert!(output.stderr.is_empty() && output.stdout.is_empty());
}

#[test]
fn statistics_have_stable_keys() {
    let folder = folder("stats");
    let text = expect(&folder, &["render", "scene.nff", "--stats", "text"], 0, &[]).stdout;
    let text = String::from_utf8(text).unwrap();
    let keys: Vec<&str> = text.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    let expected = "rays.camera rays.shadow rays.reflected rays.refracted hits.camera tests_per_ray steps_per_ray \
                    tree.nodes tree.leaves tree.references seconds.load seconds.build seconds.trace seconds.aov seconds.write \
                    cpu_seconds.load cpu_seconds.build cpu_seconds.trace cpu_seconds.aov cpu_seconds.write \
                    percent.trace percent.shadow percent.shade percent.queue percent.refine \
                    pixels.supersampled cut.weight cut.depth cut.budget peak_memory_bytes";
    assert_eq!(keys, expected.split(' ').collect::<Vec<_>>());
    expect(&folder, &["render", "scene.nff", "--aa", "off", "--stats", "json=stats.json"], 0, &[]);
    let json = fs::read_to_string(folder.join("stats.json")).unwrap();
    assert!(json.contains(r#""rays": { "camera": 1536,"#), "{json}");
}

#[test]
fn check_reports_what_it_read() {
    let folder = folder("check");
    let output = expect(&folder, &["check", "scene.nff"], 0, &[]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("2 spheres"));
    assert_eq!(names(&folder), ["scene.nff"]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_no_picture() {
    let folder = folder("interrupt");
    let mut child = Command::new(env!("CARGO_BIN_EXE_whitted"))
        .args(["render", "scene.nff", "-v", "--size", "4000x4000", "--aa", "256"])
        .current_dir(&folder)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // With -v the command tells its threads just before it begins to trace, for minutes if nobody stops it.
    let mut messages = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(messages.any(|line| line.unwrap().contains("threads")));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let rest: Vec<String> = messages.map(Result::unwrap).collect();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{rest:?}");
    assert_eq!(names(&folder), ["scene.nff"]);
}
