//! Every scene of `scenes/` looks as it did when somebody last looked at it.
//!
//! Pictures are byte-equal on every CPU and with any number of threads, so the tolerance is zero, and each scene is
//! rendered in three ways that share as little as possible. After an intended change, run this test with
//! `WHITTED_BLESS=1`, look at the new pictures, and give the reason in the commit.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Small enough to be kept in the repository, large enough to show what is wrong.
const SIZE: [usize; 2] = [128, 96];

/// One thread with scalar lanes, and two with the widest that the machine has.
const WAYS: [&[&str]; 2] = [&["--simd", "scalar", "--threads", "1"], &["--threads", "2"]];

/// The paper's renderer, which shares even less with them: each scene that it can render in seconds is rendered by one of
/// these as well.
const CLASSIC_WAYS: [&[&str]; 6] = [
    &["--render", "recursive", "--tree", "kd8", "--walk", "sequential"],
    &["--render", "recursive", "--tree", "grid", "--math", "sse"],
    &["--render", "recursive", "--tree", "kd8", "--math", "sse"],
    &["--render", "recursive", "--tree", "median"],
    &["--render", "recursive", "--tree", "median", "--walk", "sequential", "--math", "sse"],
    &["--render", "recursive", "--tree", "grid"],
];

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

fn decode(png: &[u8]) -> Vec<u8> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    assert_eq!([reader.info().width as usize, reader.info().height as usize], SIZE);
    let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut rgb).unwrap();
    rgb
}

fn encode(rgb: &[u8]) -> Vec<u8> {
    formats::png::encode(SIZE[0] as u32, SIZE[1] as u32, rgb).unwrap()
}

/// Renders a scene as its reader would, but small, and in one of the [`WAYS`].
fn render(scene: &Path, way: &[&str]) -> Vec<u8> {
    let [width, height] = SIZE;
    let mut command = Command::new(env!("CARGO_BIN_EXE_whitted"));
    command.arg("render").arg(scene).args(["-q", "-o", "-", "--aa-max", "4", "--size", &format!("{width}x{height}")]);
    command.args(way);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}: {}", scene.display(), String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// Leaves the picture and its difference where a person can look at them, and says how they differ.
fn report(name: &str, actual: &[u8], golden: &[u8]) -> String {
    let differences: Vec<u8> = actual.iter().zip(golden).map(|(a, b)| a.abs_diff(*b)).collect();
    let pixels = differences.chunks(3).filter(|pixel| pixel.iter().any(|&d| d > 0)).count();
    let largest = differences.iter().max().copied().unwrap_or(0);
    let shown: Vec<u8> = differences.iter().map(|d| d.saturating_mul(16)).collect();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let files = [("actual", actual), ("difference-16x", &shown)].map(|(kind, rgb)| {
        let file = folder.join(format!("{name}-{kind}.png"));
        fs::write(&file, encode(rgb)).unwrap();
        file.display().to_string()
    });
    format!("{name}: {pixels} pixels differ, by at most {largest}/255; see {}", files.join(" and "))
}

#[test]
fn scenes_look_as_they_did() {
    let bless = std::env::var_os("WHITTED_BLESS").is_some();
    let mut complaints = Vec::new();
    // In the order of their names, so that a scene is rendered in the same ways everywhere.
    let mut paths: Vec<PathBuf> = fs::read_dir(scenes()).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    for (number, scene) in paths.into_iter().enumerate() {
        let name = scene.file_stem().unwrap().to_string_lossy().into_owned();
        let golden = scenes().join("golden").join(format!("{name}.png"));
        let mut ways = WAYS.to_vec();
        if !name.ends_with("50000") {
            ways.push(CLASSIC_WAYS[number % CLASSIC_WAYS.len()]);
        }
        let pictures: Vec<_> = std::thread::scope(|scope| {
            let started: Vec<_> = ways.iter().map(|way| scope.spawn(|| render(&scene, way))).collect();
            started.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        if bless {
            fs::write(&golden, &pictures[0]).unwrap();
        }
        let golden = fs::read(&golden).unwrap_or_else(|error| panic!("{}: {error}", golden.display()));
        let golden = decode(&golden);
        for (way, picture) in ways.iter().zip(&pictures) {
            let actual = decode(picture);
            if actual != golden {
                complaints.push(format!("{}: {}", way.join(" "), report(&name, &actual, &golden)));
            }
        }
    }
    let how = "if that was intended, run again with WHITTED_BLESS=1 and look at scenes/golden";
    assert!(complaints.is_empty(), "{}\n{how}", complaints.join("\n"));
}
