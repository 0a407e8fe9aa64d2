//! The viewer as a person meets it: a real window on a display without a screen, real mouse and keys; and scripts.
//!
//! Needs Xvfb, xdotool and import (ImageMagick). Without them the tests of the window say loudly that they were skipped;
//! with `WHITTED_REQUIRE_DISPLAY` set, as in CI, that is a failure.

#![cfg(feature = "viewer")]

mod window;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use window::panel::Shot;
use window::{Desk, Viewer, wait_for};

const SIZE: &str = "320x240";

/// A scene whose ball has this colour, seen by this camera.
fn scene(color: &str, camera: &str) -> String {
    format!(
        "version = 1\n{camera}\n[render]\nbackground = \"#203040\"\n[[light]]\npoint = [4, 6, 5]\n\
         [material.ball]\ncolor = \"{color}\"\nreflect = 0.3\n[material.floor]\ncolor = {{ checker = [\"#e8e2d6\", \
         \"#8c2f2b\"], size = 1 }}\n[[plane]]\npoint = [0, 0, 0]\nmaterial = \"floor\"\n[[sphere]]\ncenter = [0, 1, 0]\n\
         radius = 1\nmaterial = \"ball\"\n"
    )
}

const CAMERA: &str = "[camera]\neye = [0, 1.5, 6]\nlook_at = [0, 1, 0]";

/// A folder of its own for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn whitted() -> Command {
    Command::new(env!("CARGO_BIN_EXE_whitted"))
}

/// The pixels that `whitted render` gives for a scene, in the usual size or another.
fn rendered(folder: &Path, scene: &str) -> Vec<u8> {
    rendered_at(folder, scene, SIZE)
}

fn rendered_at(folder: &Path, scene: &str, size: &str) -> Vec<u8> {
    let (file, picture) = (folder.join("expected.toml"), folder.join("expected.png"));
    fs::write(&file, scene).unwrap();
    let status = whitted().args(["render", "-q", "--size", size, "-o"]).args([&picture, &file]).status();
    assert!(status.unwrap().success());
    window::pixels(&fs::read(picture).unwrap())
}

#[test]
fn a_person_looks_around_edits_and_closes() {
    let folder = folder("window");
    let Some(desk) = Desk::start() else { return };
    let file = folder.join("scene.toml");
    let first = scene("#c04020", CAMERA);
    fs::write(&file, &first).unwrap();
    let mut viewer = Viewer::open(&desk, &folder, &["--size", SIZE], &file);

    // The finished picture is that of a render, to the byte.
    viewer.key("o");
    let expected = rendered(&folder, &first);
    viewer.wait_for_picture("the first picture", |picture| picture == expected);
    let busy = viewer.cpu_share();
    assert!(busy < 0.05, "{busy} of a core is busy at rest");

    // Orbit; the camera that is printed gives the picture that is shown.
    viewer.drag(1, [160, 120], [90, 100]);
    viewer.wait_for_picture("another picture", |picture| picture != expected);
    viewer.wait_until_at_rest();
    viewer.key("p");
    let block = viewer.printed_block("[camera]");
    let turned = rendered(&folder, &scene("#c04020", &block));
    viewer.wait_for_picture("the picture of the camera that was printed", |picture| picture == turned);

    // An edit is followed, the camera stays.
    fs::write(&file, scene("#2040c0", CAMERA)).unwrap();
    let blue = rendered(&folder, &scene("#2040c0", &block));
    viewer.wait_for_picture("the edited material", |picture| picture == blue);

    // A broken edit is told over the last good picture; mended, all is well again.
    fs::write(&file, scene("#2040c0", CAMERA).replace("radius", "radios")).unwrap();
    viewer.wait_for_picture("the card about what is wrong", |picture| picture != blue);
    fs::write(&file, scene("#2040c0", CAMERA)).unwrap();
    viewer.wait_for_picture("the mended scene", |picture| picture == blue);

    // Save, reset, pick, fly, resize.
    viewer.key("F12");
    let saved = folder.join("scene.png");
    wait_for("the saved picture", || saved.exists());
    assert!(window::pixels(&fs::read(saved).unwrap()) == blue);
    viewer.key("Return");
    let home = rendered(&folder, &scene("#2040c0", CAMERA));
    viewer.wait_for_picture("the scene's own camera", |picture| picture == home);
    viewer.click(2, [150, 120]);
    viewer.wait_for_picture("the picked point in the middle", |picture| picture != home);
    viewer.resize([200, 150]);
    viewer.hold("w", 0.2);
    viewer.wait_until_at_rest();

    // Views and panels come and go.
    viewer.key("o");
    viewer.key("Tab");
    viewer.key("h");
    viewer.wait_until_at_rest();
    viewer.key("Escape");
    viewer.key("Escape");
    viewer.key("Escape");
    assert_eq!(viewer.exit_code(), 0);
}

#[test]
fn a_light_is_added_with_the_mouse_and_written_into_the_file() {
    const WIDTH: usize = 700;
    const SIZE: &str = "700x580";
    /// Places of sections in the panel. Those below the lights move, and leave the window, when more of them are shown.
    const PICTURE: usize = 0;
    const LIGHTS: usize = 3;
    let folder = folder("panel");
    let Some(desk) = Desk::start() else { return };
    let file = folder.join("scene.toml");
    let dark = scene("#c04020", CAMERA).replace("[[light]]\npoint = [4, 6, 5]\n", "# Lights are missing.\n");
    fs::write(&file, &dark).unwrap();
    let viewer = Viewer::open(&desk, &folder, &["--size", SIZE], &file);
    let shot = || Shot { width: WIDTH, pixels: viewer.picture() };

    // The section of the lights is closed at first: its title comes with buttons below.
    viewer.key("Tab");
    wait_for("the panel", || shot().titles().len() > LIGHTS);
    viewer.wait_until_at_rest();
    let (left, lights) = shot().titles().swap_remove(LIGHTS);
    assert!(shot().button_below(lights.end).is_none(), "nothing to press below the closed section");
    viewer.click(1, [left as u32 + 10, (lights.start + lights.end) as u32 / 2]);
    wait_for("the open section", || shot().button_below(lights.end).is_some());
    viewer.wait_until_at_rest();
    let before = shot();

    // A point light is the first that can be added; it shines from the camera.
    viewer.click(1, before.button_below(lights.end).expect("a button"));
    viewer.key("o");
    let lit = rendered_at(&folder, &format!("{dark}[[light]]\npoint = [0, 1.5, 6]\n"), SIZE);
    viewer.wait_for_picture("the picture in the new light", |picture| picture == lit);
    assert_eq!(fs::read_to_string(&file).unwrap(), dark, "nobody asked for it to be written");

    // What could not be pressed before has become bright.
    viewer.key("o");
    wait_for("the panel again", || shot().titles().len() > LIGHTS);
    viewer.wait_until_at_rest();
    let titles = before.titles();
    let rows = titles[PICTURE].1.end..titles[PICTURE + 1].1.start;
    let button = shot().changed(&before, left, rows).expect("a button");
    viewer.click(1, button);
    wait_for("the light in the file", || fs::read_to_string(&file).is_ok_and(|text| text.contains("[[light]]")));
    let written = fs::read_to_string(&file).unwrap();
    let mut lines = written.lines();
    assert!(dark.lines().all(|line| lines.any(|other| other == line)), "{written}");
    assert!(rendered_at(&folder, &written, SIZE) == lit, "{written}");
}

#[test]
fn the_window_can_be_closed_while_it_is_busy() {
    let folder = folder("closing");
    let Some(desk) = Desk::start() else { return };
    let file = folder.join("many.toml");
    let many = "[[generate]]\nkind = \"sphere-cube\"\ncount = 300000\nseed = 1\nmaterial = \"ball\"\n";
    fs::write(&file, scene("#c04020", CAMERA) + many).unwrap();
    let mut viewer = Viewer::open(&desk, &folder, &["--size", SIZE], &file);
    viewer.key("Escape");
    assert_eq!(viewer.exit_code(), 0);
}

#[test]
fn files_may_come_and_go_and_sizes_change() {
    let folder = folder("storms");
    let Some(mut desk) = Desk::start() else { return };
    desk.scale = 2;
    let (file, mesh) = (folder.join("scene.toml"), folder.join("wall.obj"));
    let wall = |height: u32| format!("v -2 0 -1\nv 2 0 -1\nv 2 {height} -1\nf 1 2 3\n");
    let text = scene("#c04020", CAMERA) + "[[mesh]]\nfile = \"wall.obj\"\nmaterial = \"ball\"\n";
    fs::write(&mesh, wall(3)).unwrap();
    fs::write(&file, &text).unwrap();
    let mut viewer = Viewer::open(&desk, &folder, &["--size", SIZE], &file);
    viewer.key("o");
    let high = rendered(&folder, &text);
    viewer.wait_for_picture("the first picture", |picture| picture == high);

    // Sizes follow each other faster than pictures do.
    for step in 0..20 {
        viewer.resize([200 + 30 * (step % 7), 150 + 40 * (step % 5)]);
    }
    viewer.resize([320, 240]);
    viewer.wait_for_picture("the picture after many sizes", |picture| picture == high);

    // A mesh that the scene reads is changed, lost, and comes back.
    fs::write(&mesh, wall(2)).unwrap();
    let low = rendered(&folder, &text);
    assert!(low != high);
    viewer.wait_for_picture("the changed mesh", |picture| picture == low);
    fs::remove_file(&mesh).unwrap();
    viewer.wait_for_picture("the card about the lost mesh", |picture| picture != low);
    fs::write(&mesh, wall(3)).unwrap();
    viewer.wait_for_picture("the mesh again", |picture| picture == high);

    // So is the scene itself.
    fs::remove_file(&file).unwrap();
    viewer.wait_for_picture("the card about the lost scene", |picture| picture != high);
    fs::write(&file, "version = 1\n").unwrap();
    viewer.wait_for_picture("a scene with nothing in it", |picture| picture != high);
    fs::write(&file, &text).unwrap();
    viewer.wait_for_picture("the scene again", |picture| picture == high);

    // Closed while it saves, it saves to the end.
    viewer.wait_until_at_rest();
    viewer.key("F12");
    viewer.key("Escape");
    assert_eq!(viewer.exit_code(), 0);
    assert!(window::pixels(&fs::read(folder.join("scene.png")).unwrap()) == high);
}

#[test]
fn a_window_that_is_covered_takes_no_time() {
    let folder = folder("covered");
    let Some(desk) = Desk::start() else { return };
    let file = folder.join("scene.toml");
    fs::write(&file, scene("#c04020", CAMERA)).unwrap();
    let viewer = Viewer::open(&desk, &folder, &["--size", SIZE], &file);
    viewer.key("space");
    wait_for("the turntable", || viewer.cpu_share() > 0.2);
    let mut above = Viewer::open(&desk, &folder, &["--size", "800x600"], &file);
    wait_for("rest below the other window", || viewer.cpu_share() < 0.03);
    above.key("Escape");
    assert_eq!(above.exit_code(), 0);
    wait_for("the turntable again", || viewer.cpu_share() > 0.2);
    viewer.set_mapped(false);
    wait_for("rest off the display", || viewer.cpu_share() < 0.03);
    viewer.set_mapped(true);
    wait_for("the turntable on the display", || viewer.cpu_share() > 0.2);
}

#[test]
fn without_a_display_it_says_so() {
    let folder = folder("no-display");
    let file = folder.join("scene.toml");
    fs::write(&file, scene("#c04020", CAMERA)).unwrap();
    let output = whitted().arg("view").arg(&file).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("no window can be opened") && text.contains("whitted render"), "{text}");
}

#[test]
fn a_script_needs_no_display() {
    let folder = folder("script");
    let text = scene("#c04020", CAMERA);
    fs::write(folder.join("scene.toml"), &text).unwrap();
    let script = "wait refined\nsave first.png\nsave first.exr\norbit 160 120 90 100\nwait refined\nkey p\nkey h\n\
                  screenshot help.png\nkey escape\nreport\nquit\nsave never.png\n";
    fs::write(folder.join("look.txt"), script).unwrap();
    let arguments = ["view", "scene.toml", "--size", SIZE, "--script", "look.txt"];
    let output = whitted().args(arguments).current_dir(&folder).env_remove("DISPLAY").output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(printed.starts_with("[camera]\neye = [") && printed.contains(" fps, "), "{printed}");
    let first = window::pixels(&fs::read(folder.join("first.png")).unwrap());
    assert!(first == rendered(&folder, &text));
    assert!(window::pixels(&fs::read(folder.join("help.png")).unwrap()) != first);
    assert!(fs::read(folder.join("first.exr")).unwrap().starts_with(b"\x76\x2f\x31\x01"), "an EXR file");
    assert!(!folder.join("never.png").exists(), "a script ends with 'quit'");
}

#[test]
fn in_tiny_windows_cards_stay_inside_and_can_be_scrolled() {
    const SIZE: [usize; 2] = [160, 120];
    /// Pixels between cards and the edge of the window.
    const EDGE: usize = 6;
    let folder = folder("tiny");
    fs::write(folder.join("scene.toml"), scene("#c04020", CAMERA)).unwrap();
    let mut script = "size 160x120\nwait refined\nkey o\nscreenshot clean.png\nkey o\n".to_owned();
    let cards = [("panel", "key tab", "key tab"), ("help", "key h", "key h"), ("pixel", "click 80 60", "key escape")];
    for (name, open, close) in cards {
        script += &format!(
            "{open}\nmove 80 75\nwait 0.5\nscreenshot {name}.png\nwheel -2\nwait 0.5\nscreenshot {name}-below.png\n{close}\n"
        );
    }
    fs::write(folder.join("look.txt"), script).unwrap();
    let arguments = ["view", "scene.toml", "--script", "look.txt"];
    let output = whitted().args(arguments).current_dir(&folder).env_remove("DISPLAY").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let picture = |name: &str| window::pixels(&fs::read(folder.join(format!("{name}.png"))).unwrap());
    let clean = picture("clean");
    for (name, ..) in cards {
        let (top, below) = (picture(name), picture(&format!("{name}-below")));
        assert!(top != clean && below != top, "{name} cannot be scrolled");
        if name == "pixel" {
            // Its rays are drawn all over the picture.
            continue;
        }
        for (index, (is, was)) in top.chunks(3).zip(clean.chunks(3)).enumerate() {
            let at = [index % SIZE[0], index / SIZE[0]];
            let is_inside = (0..2).all(|axis| (EDGE..SIZE[axis] - EDGE).contains(&at[axis]));
            assert!(is_inside || is == was, "{name} reaches {at:?}");
        }
    }
}

#[test]
fn wrong_scripts_are_told_with_their_line() {
    let folder = folder("wrong-script");
    fs::write(folder.join("scene.toml"), scene("#c04020", CAMERA)).unwrap();
    fs::write(folder.join("look.txt"), "wait refined\nfly north\n").unwrap();
    let output = whitted().args(["view", "scene.toml", "--script", "look.txt"]).current_dir(&folder).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("look.txt: line 2: there is no step 'fly'"), "{text}");
}
