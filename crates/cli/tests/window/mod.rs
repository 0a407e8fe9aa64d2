//! A display without a screen, and a viewer on it with hands and eyes.

pub(crate) mod panel;

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A machine that is busy elsewhere is given this long for anything.
const PATIENCE: Duration = Duration::from_secs(180);

/// Wait until it is so.
pub(crate) fn wait_for(what: &str, is_so: impl Fn() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < PATIENCE, "waited in vain for {what}");
        sleep(Duration::from_millis(20));
    }
}

/// The pixels of a PNG file, RGB.
pub(crate) fn pixels(png: &[u8]) -> Vec<u8> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(png));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().expect("a PNG file");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut bytes).expect("pixels");
    bytes.truncate(info.buffer_size());
    match info.color_type {
        png::ColorType::Rgba => bytes.chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect(),
        png::ColorType::Grayscale => bytes.iter().flat_map(|&grey| [grey; 3]).collect(),
        _ => bytes,
    }
}

/// A display of its own.
pub(crate) struct Desk {
    server: Child,
    display: String,
    /// Physical pixels for each unit of layout.
    pub(crate) scale: u32,
}

impl Desk {
    /// Start a display; `None`, with a loud word, if this machine lacks what is needed.
    pub(crate) fn start() -> Option<Self> {
        let missing: Vec<&str> =
            ["Xvfb", "xdotool", "import"].into_iter().filter(|program| !is_installed(program)).collect();
        if !missing.is_empty() {
            assert!(std::env::var_os("WHITTED_REQUIRE_DISPLAY").is_none(), "{missing:?} must be installed here");
            eprintln!("SKIPPED: no test of the window, for {missing:?} is not installed");
            return None;
        }
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = 100 + std::process::id() % 400 + 500 * COUNT.fetch_add(1, Ordering::Relaxed);
        let display = format!(":{number}");
        let mut server = Command::new("Xvfb");
        server.args([&display, "-screen", "0", "800x600x24", "-nolisten", "tcp", "-noreset"]);
        let server = server.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("a display");
        let desk = Self { server, display, scale: 1 };
        wait_for("the display", || desk.command("xdotool", &["getdisplaygeometry"]).status().unwrap().success());
        Some(desk)
    }

    fn command(&self, program: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.args(arguments).env("DISPLAY", &self.display).env_remove("WAYLAND_DISPLAY");
        command.env("WINIT_X11_SCALE_FACTOR", self.scale.to_string());
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

fn is_installed(program: &str) -> bool {
    std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()).any(|folder| folder.join(program).exists())
}

/// A viewer on a display.
pub(crate) struct Viewer<'a> {
    desk: &'a Desk,
    program: Child,
    window: String,
    printed: Arc<Mutex<String>>,
}

impl<'a> Viewer<'a> {
    /// Open a scene, in `folder`.
    pub(crate) fn open(desk: &'a Desk, folder: &Path, options: &[&str], scene: &Path) -> Self {
        let mut command = desk.command(env!("CARGO_BIN_EXE_whitted"), &["view"]);
        command.args(options).arg(scene).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::inherit());
        let mut program = command.spawn().expect("the viewer");
        let printed = Arc::<Mutex<String>>::default();
        let (mut stdout, collected) = (program.stdout.take().expect("a pipe"), Arc::clone(&printed));
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = stdout.read(&mut bytes) {
                collected.lock().unwrap().push_str(&String::from_utf8_lossy(&bytes[..count]));
            }
        });
        let mut viewer = Self { desk, program, window: String::new(), printed };
        let start = Instant::now();
        while viewer.window.is_empty() {
            assert!(start.elapsed() < PATIENCE, "no window");
            let pid = viewer.program.id().to_string();
            let mut search = desk.command("xdotool", &["search", "--onlyvisible", "--pid", &pid]);
            let found = search.stdout(Stdio::piped()).output().unwrap().stdout;
            viewer.window = String::from_utf8(found).unwrap().lines().next().unwrap_or_default().to_owned();
        }
        viewer.tell(&["windowfocus", "--sync", &viewer.window.clone()]);
        viewer
    }

    fn tell(&self, arguments: &[&str]) {
        let status = self.desk.command("xdotool", arguments).status().unwrap();
        assert!(status.success(), "xdotool {arguments:?}");
    }

    /// Press and release a key.
    pub(crate) fn key(&self, key: &str) {
        self.tell(&["key", key]);
        // Keys that follow each other at once are one key too many for some servers.
        sleep(Duration::from_millis(60));
    }

    /// Hold a key for some seconds.
    pub(crate) fn hold(&self, key: &str, seconds: f64) {
        self.tell(&["keydown", key, "sleep", &seconds.to_string(), "keyup", key]);
    }

    fn move_to(&self, [x, y]: [u32; 2]) {
        self.tell(&["mousemove", "--window", &self.window, &x.to_string(), &y.to_string()]);
        sleep(Duration::from_millis(60));
    }

    /// Drag with a button (1 left, 2 middle, 3 right).
    pub(crate) fn drag(&self, button: u32, from: [u32; 2], to: [u32; 2]) {
        let button = button.to_string();
        self.move_to(from);
        self.tell(&["mousedown", &button]);
        for step in 1..=5 {
            let at = |axis: usize| (from[axis] * (5 - step) + to[axis] * step) / 5;
            self.move_to([at(0), at(1)]);
        }
        self.tell(&["mouseup", &button]);
    }

    /// Click with a button.
    pub(crate) fn click(&self, button: u32, at: [u32; 2]) {
        self.move_to(at);
        self.tell(&["click", &button.to_string()]);
    }

    /// Take the window off the display behind its back, as no window manager does; or put it back.
    pub(crate) fn set_mapped(&self, is_mapped: bool) {
        self.tell(&[if is_mapped { "windowmap" } else { "windowunmap" }, &self.window]);
    }

    /// Give the window another size.
    pub(crate) fn resize(&self, [width, height]: [u32; 2]) {
        self.tell(&["windowsize", &self.window, &width.to_string(), &height.to_string()]);
    }

    /// What the window shows.
    pub(crate) fn picture(&self) -> Vec<u8> {
        let mut import = self.desk.command("import", &["-window", &self.window, "png:-"]);
        pixels(&import.stdout(Stdio::piped()).output().unwrap().stdout)
    }

    pub(crate) fn wait_for_picture(&self, what: &str, is_it: impl Fn(&[u8]) -> bool) {
        wait_for(what, || is_it(&self.picture()));
    }

    /// Wait until the program does nothing for a while.
    pub(crate) fn wait_until_at_rest(&self) {
        wait_for("rest", || self.cpu_share() < 0.03);
    }

    /// The share of one core that the program uses.
    pub(crate) fn cpu_share(&self) -> f64 {
        const TICKS: f64 = 100.0;
        let (start, before) = (Instant::now(), self.ticks());
        sleep(Duration::from_millis(1000));
        (self.ticks() - before) / TICKS / start.elapsed().as_secs_f64()
    }

    /// Processor time that the program has used, in hundredths of a second.
    fn ticks(&self) -> f64 {
        let stat = fs::read_to_string(format!("/proc/{}/stat", self.program.id())).unwrap();
        let fields: Vec<&str> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
        fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()
    }

    /// The lines that were printed, from this one on.
    pub(crate) fn printed_block(&self, first: &str) -> String {
        wait_for("the camera on standard output", || self.printed.lock().unwrap().contains("look_at"));
        // It is printed at once, but need not arrive at once.
        sleep(Duration::from_millis(200));
        let printed = self.printed.lock().unwrap();
        printed[printed.find(first).unwrap()..].trim_end().to_owned()
    }

    /// Wait until the program has ended.
    pub(crate) fn exit_code(&mut self) -> i32 {
        let start = Instant::now();
        loop {
            if let Some(status) = self.program.try_wait().unwrap() {
                return status.code().expect("no signal");
            }
            assert!(start.elapsed() < PATIENCE, "it does not end");
            sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Viewer<'_> {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}
