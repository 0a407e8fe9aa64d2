//! A session driven as a window would drive it, without a window.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use whitted::math::{Vec3d, Vec3f};
use whitted::render::{Aov, Cancel, Execution, Silent, aovs, render};
use whitted::scene::{Camera, Light, LightKind, NamedCamera, NamedMaterial, Prepared, Scene, Settings};
use whitted::shading::{Material, Texture};
use whitted::tree::BuildOptions;
use whitted_viewer::{
    Action, Activity, Button, Destination, Effect, Host, Input, Key, Opened, Options, Session, Shot, Side, Stage,
};

/// A machine that is busy elsewhere is given this long for anything.
const PATIENCE: Duration = Duration::from_secs(120);

/// A picture under its name, with its size.
type Saved = (PathBuf, [u32; 2], Vec<u8>);

/// A scene in memory; its file exists only to have a time stamp.
struct Desk {
    path: PathBuf,
    scene: Mutex<Result<Scene, String>>,
    opened: AtomicUsize,
    saved: Mutex<Vec<Saved>>,
}

impl Desk {
    fn new(scene: Scene) -> Arc<Self> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("whitted-viewer-{}-{}.toml", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let desk = Self {
            path: std::env::temp_dir().join(name),
            scene: Mutex::new(Ok(scene)),
            opened: AtomicUsize::new(0),
            saved: Mutex::default(),
        };
        desk.touch();
        Arc::new(desk)
    }

    /// Save another scene, or one that is broken.
    fn edit(&self, scene: Result<Scene, String>) {
        *self.scene.lock().unwrap() = scene;
        self.touch();
    }

    fn touch(&self) {
        let text = format!("{:?}", Instant::now());
        std::fs::write(&self.path, text.repeat(1 + self.opened.load(Ordering::Relaxed))).unwrap();
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

impl Host for Desk {
    fn path(&self) -> &Path {
        &self.path
    }

    fn open(&self) -> Result<Opened, String> {
        self.opened.fetch_add(1, Ordering::Relaxed);
        let scene = self.scene.lock().unwrap().clone()?;
        Ok(Opened { scene, files: vec![self.path.clone()], warnings: Vec::new() })
    }

    fn save(&self, path: &Path, shot: &Shot<'_>) -> Result<(), String> {
        self.saved.lock().unwrap().push((path.to_owned(), shot.size, shot.rgb8.to_vec()));
        Ok(())
    }

    fn write_back(&self, _: &Scene, new: &Scene) -> Result<(), String> {
        self.edit(Ok(new.clone()));
        Ok(())
    }

    fn camera_block(&self, camera: &NamedCamera) -> String {
        format!("{:?}", camera.camera)
    }
}

fn scene() -> Scene {
    let material = |color, reflect| Material {
        color: Texture::Color(color),
        reflect: Vec3f::splat(reflect),
        ..Material::default()
    };
    let named = |name: &str, material| NamedMaterial { name: name.to_owned(), material };
    let spheres = (0..40).map(|i| {
        let i = f64::from(i);
        (Vec3d::new((i * 1.7).sin() * 2.0, (i * 2.3).cos(), (i * 0.9).sin() * 2.0), 0.3, u32::from(i > 20.0))
    });
    Scene {
        cameras: vec![NamedCamera { name: "front".to_owned(), camera: Camera::default() }],
        lights: vec![Light {
            kind: LightKind::Point { position: Vec3d::new(4.0, 6.0, 5.0) },
            color: Vec3f::splat(1.0),
            inverse_square: false,
        }],
        materials: vec![
            named("red", material(Vec3f::new(0.8, 0.1, 0.1), 0.0)),
            named("mirror", material(Vec3f::splat(0.2), 0.7)),
        ],
        spheres: spheres.collect(),
        ..Scene::default()
    }
}

const SIZE: [u32; 2] = [160, 120];

fn session(desk: &Arc<Desk>) -> Session {
    let host: Arc<dyn Host> = Arc::<Desk>::clone(desk);
    Session::new(host, Options { threads: 2, ..Options::default() }, SIZE, || {}).unwrap()
}

/// Serve the session until this is so.
fn serve_until(session: &mut Session, what: &str, is_so: impl Fn(&Session) -> bool) {
    let start = Instant::now();
    loop {
        session.tick(Instant::now());
        if is_so(session) {
            return;
        }
        assert!(start.elapsed() < PATIENCE, "waited in vain for {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn rest(session: &mut Session) {
    serve_until(session, "rest", Session::is_at_rest);
}

/// What `whitted render` gives with these settings.
fn expected(scene: &Scene, camera: &Camera, settings: &Settings) -> Vec<u8> {
    let prepared = Prepared::new(scene, &BuildOptions::default()).unwrap();
    let prepared = prepared.with_camera(&NamedCamera { name: String::new(), camera: *camera }).unwrap();
    render(&prepared, settings, &Execution::default(), &Silent, &Cancel::new()).unwrap().image.to_rgb8(settings)
}

/// What the session shows.
fn shown(session: &Session) -> Vec<u8> {
    let picture = session.picture();
    picture.pixels.iter().flat_map(|pixel| pixel.to_be_bytes().into_iter().skip(1)).collect()
}

fn assert_is_exact(session: &Session, scene: &Scene) {
    assert!(shown(session) == expected(scene, session.camera(), session.settings()), "another picture");
}

fn drag(session: &mut Session, button: Button, by: [f64; 2]) {
    session.input(&Input::Pointer([80.0, 60.0]));
    session.input(&Input::Button(button, true));
    session.input(&Input::Pointer([80.0 + by[0], 60.0 + by[1]]));
    session.input(&Input::Button(button, false));
}

#[test]
fn the_finished_picture_is_that_of_a_render_with_the_same_settings() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    assert_is_exact(&session, &scene());
    // Also after moving, with other settings and in another size.
    drag(&mut session, Button::Left, [30.0, 11.0]);
    rest(&mut session);
    assert_ne!(*session.camera(), Camera::default());
    assert_is_exact(&session, &scene());
    session.set_settings(Settings { depth: 2, exposure: 0.5, antialias_max: 3, ..session.settings().clone() });
    session.resize([97, 61], Instant::now());
    rest(&mut session);
    assert_eq!(session.settings().size, [97, 61]);
    assert_is_exact(&session, &scene());
}

#[test]
fn drafts_are_shown_while_things_move_and_the_last_one_wins() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    session.act(Action::Turntable);
    let before = session.picture().drafts;
    serve_until(&mut session, "ten drafts", |session| session.picture().drafts > before + 10);
    assert!(session.finished().is_none() && !session.is_at_rest());
    session.act(Action::Turntable);
    rest(&mut session);
    assert_is_exact(&session, &scene());
}

#[test]
fn an_edited_material_is_shown_without_a_new_tree() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    let tree: *const _ = session.prepared().unwrap().geometry();
    let mut edited = scene();
    edited.materials[0].material.color = Texture::Color(Vec3f::new(0.1, 0.2, 0.9));
    desk.edit(Ok(edited.clone()));
    serve_until(&mut session, "the new scene", |session| {
        session.scene().is_some_and(|scene| scene.materials == edited.materials)
    });
    rest(&mut session);
    assert!(std::ptr::eq(tree, session.prepared().unwrap().geometry()), "the tree was built again");
    assert_is_exact(&session, &edited);
    // Other shapes need another one.
    edited.spheres.truncate(11);
    desk.edit(Ok(edited.clone()));
    serve_until(&mut session, "other shapes", |session| session.scene().is_some_and(|s| s.spheres.len() == 11));
    rest(&mut session);
    assert_is_exact(&session, &edited);
}

#[test]
fn the_camera_of_the_file_is_followed_when_it_is_edited_and_kept_when_it_is_not() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    drag(&mut session, Button::Left, [30.0, 0.0]);
    rest(&mut session);
    let mine = *session.camera();
    let mut edited = scene();
    edited.lights[0].color = Vec3f::splat(0.5);
    desk.edit(Ok(edited.clone()));
    serve_until(&mut session, "the new light", |session| session.scene().is_some_and(|s| s.lights == edited.lights));
    rest(&mut session);
    assert_eq!(*session.camera(), mine);
    edited.cameras[0].camera.eye = Vec3d::new(3.0, 3.0, 3.0);
    desk.edit(Ok(edited.clone()));
    serve_until(&mut session, "the new camera", |session| *session.camera() == edited.cameras[0].camera);
}

#[test]
fn a_broken_scene_is_told_and_the_last_good_picture_stays() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    let before = shown(&session);
    desk.edit(Err("scene.toml:3:7: unknown key".to_owned()));
    serve_until(&mut session, "trouble", |session| session.trouble().is_some());
    assert_eq!(session.trouble(), Some("scene.toml:3:7: unknown key"));
    assert!(shown(&session) == before);
    desk.edit(Ok(scene()));
    serve_until(&mut session, "recovery", |session| session.trouble().is_none());
    rest(&mut session);
    assert!(shown(&session) == before);
}

#[test]
fn a_scene_that_is_broken_from_the_start_can_be_mended() {
    let desk = Desk::new(scene());
    *desk.scene.lock().unwrap() = Err("no".to_owned());
    let mut session = session(&desk);
    rest(&mut session);
    assert_eq!((session.trouble(), session.picture().stage), (Some("no"), Stage::Blank));
    // Whatever is asked for meanwhile does no harm.
    for action in [Action::Reset, Action::FrameAll, Action::Side(Side::Top), Action::NextCamera, Action::CopyCamera] {
        session.act(action);
    }
    drag(&mut session, Button::Middle, [0.0, 0.0]);
    desk.edit(Ok(scene()));
    serve_until(&mut session, "a picture", |session| session.finished().is_some());
}

/// The scene with so many spheres more.
fn with_many(count: u32) -> Scene {
    let place = |i: f64| Vec3d::new((i * 1.7).sin(), (i * 2.3).cos(), (i * 0.9).sin()) * 3.0;
    let mut scene = scene();
    scene.spheres.extend((0..count).map(|i| (place(i.into()), 0.01, 0)));
    scene
}

#[test]
fn a_tree_tells_how_far_it_is() {
    let desk = Desk::new(with_many(60_000));
    let mut session = session(&desk);
    let shares = std::cell::RefCell::new(Vec::new());
    serve_until(&mut session, "the tree", |session| {
        let share = session.built_share();
        if matches!(session.activity(), Activity::Building(60_040, _)) {
            shares.borrow_mut().push(share);
        }
        session.scene().is_some()
    });
    let shares = shares.into_inner();
    assert!(shares.is_sorted() && shares.iter().any(|&share| share > 0.0 && share < 1.0), "{shares:?}");
    assert_eq!(session.built_share(), 1.0);
}

#[test]
fn a_tree_that_is_out_of_date_is_given_up() {
    let desk = Desk::new(with_many(200_000));
    let mut session = session(&desk);
    serve_until(&mut session, "some of the tree", |session| {
        matches!(session.activity(), Activity::Building(..)) && session.built_share() > 0.0
    });
    desk.edit(Ok(scene()));
    serve_until(&mut session, "a scene", |session| session.scene().is_some());
    assert_eq!(session.scene().unwrap().spheres.len(), 40, "the scene of before was built to its end");
    rest(&mut session);
    assert_is_exact(&session, &scene());
}

#[test]
fn keys_do_what_the_cheat_sheet_says() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    let press = |session: &mut Session, key| {
        session.input(&Input::Key(key, true));
        session.input(&Input::Key(key, false));
        rest(session);
    };
    press(&mut session, Key::Char('7'));
    let above = *session.camera();
    assert!(above.eye.y > 2.0 && above.eye.x.abs() < 0.5);
    press(&mut session, Key::Enter);
    assert_eq!(*session.camera(), Camera::default());
    press(&mut session, Key::Char('f'));
    assert_ne!(*session.camera(), Camera::default());
    press(&mut session, Key::Char('p'));
    let block = format!("{:?}", session.camera());
    assert_eq!(session.take_effects(), [Effect::Copy(block)]);
    press(&mut session, Key::Char('h'));
    assert!(session.shown().help);
    press(&mut session, Key::Escape);
    assert!(!session.shown().help && session.take_effects().is_empty());
    press(&mut session, Key::Escape);
    assert_eq!(session.take_effects(), [Effect::Close]);
    let opened = desk.opened.load(Ordering::Relaxed);
    press(&mut session, Key::Up);
    serve_until(&mut session, "a reload", |_| desk.opened.load(Ordering::Relaxed) > opened);
}

#[test]
fn a_middle_click_picks_the_pivot() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    drag(&mut session, Button::Middle, [0.0, 0.0]);
    rest(&mut session);
    let camera = *session.camera();
    assert_eq!(camera.eye, Camera::default().eye);
    let on_a_sphere =
        scene().spheres.iter().any(|(center, r, _)| ((*center - camera.look_at).length() - r).abs() < 1e-3);
    assert!(on_a_sphere, "{camera:?}");
}

#[test]
fn what_is_saved_is_the_finished_picture_even_if_the_viewer_is_closed() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    session.act(Action::Side(Side::Right));
    session.save(Destination::Named("picture.png".into()));
    assert!(desk.saved.lock().unwrap().is_empty(), "nothing is finished yet");
    rest(&mut session);
    session.tick(Instant::now());
    let bytes = shown(&session);
    drop(session);
    assert!(*desk.saved.lock().unwrap() == [("picture.png".into(), SIZE, bytes)]);
}

#[test]
fn closing_at_any_moment_is_no_accident() {
    let desk = Desk::new(scene());
    for delay in [0, 1, 3, 10, 30] {
        let mut session = session(&desk);
        session.tick(Instant::now());
        session.act(Action::Turntable);
        std::thread::sleep(Duration::from_millis(delay));
        session.tick(Instant::now());
        session.resize([0, 0], Instant::now());
        session.tick(Instant::now());
        session.resize([5000, 1], Instant::now());
        session.tick(Instant::now());
    }
}

#[test]
fn at_rest_nothing_asks_for_attention() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    let version = session.picture().version;
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(session.picture().version, version);
    assert_eq!(session.tick(Instant::now()), None, "no tick is due");
}

#[test]
fn nothing_moves_while_nobody_sees_it() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    session.act(Action::Turntable);
    let before = session.picture().drafts;
    serve_until(&mut session, "drafts", |session| session.picture().drafts > before + 3);
    session.set_visible(false);
    assert_eq!(session.tick(Instant::now()), None, "no tick is due");
    // What was on order is painted.
    std::thread::sleep(Duration::from_millis(300));
    let (drafts, camera) = (session.picture().drafts, *session.camera());
    for _ in 0..20 {
        session.tick(Instant::now());
        std::thread::sleep(Duration::from_millis(10));
    }
    assert_eq!((session.picture().drafts, *session.camera()), (drafts, camera));
    // Files are followed all the same.
    let mut edited = scene();
    edited.spheres.truncate(11);
    desk.edit(Ok(edited));
    serve_until(&mut session, "other shapes", |session| session.scene().is_some_and(|s| s.spheres.len() == 11));
    session.set_visible(true);
    serve_until(&mut session, "drafts again", |session| session.picture().drafts > drafts + 3);
    assert_ne!(*session.camera(), camera);
}

#[test]
fn every_view_is_the_one_that_a_render_writes() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    let frame = session.finished().unwrap();
    for (name, aov) in Aov::ALL {
        session.act(Action::NextView);
        assert_eq!(session.view(), Some(aov));
        rest(&mut session);
        let now = session.finished().unwrap();
        assert!(std::ptr::eq(&*frame.frame, &*now.frame), "{name}: the light was traced again");
        if aov != Aov::Time {
            let (prepared, settings) = (session.prepared().unwrap(), session.settings());
            let expected =
                aovs(&[aov], &frame.frame, prepared, settings, &Execution::default(), &|| 0, &Cancel::new()).unwrap();
            assert!(shown(&session) == expected[0].rgb8, "{name}");
        }
    }
    session.act(Action::NextView);
    rest(&mut session);
    assert_eq!(session.view(), None);
    assert_is_exact(&session, &scene());
}

#[test]
fn a_click_tells_the_rays_of_a_pixel() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    drag(&mut session, Button::Left, [0.0, 0.0]);
    serve_until(&mut session, "the rays", |session| session.inspection().is_some_and(|about| about.tree.is_some()));
    let about = session.inspection().unwrap();
    let tree = about.tree.as_ref().unwrap();
    assert_eq!((about.pixel, tree.samples.len()), ([80, 60], 1));
    assert!(!tree.samples[0].rays.is_empty());
    session.act(Action::Close);
    assert!(session.inspection().is_none() && session.take_effects().is_empty(), "the first thing to close");
}

#[test]
fn what_is_changed_by_hand_is_seen_at_once_and_can_be_written_back() {
    let desk = Desk::new(scene());
    let mut session = session(&desk);
    rest(&mut session);
    assert!(!session.is_changed());
    let mut look = session.look().unwrap().clone();
    look.materials[0].material.diffuse = 0.25;
    look.lights[0].color = Vec3f::new(0.5, 0.6, 0.7);
    session.set_look(look);
    rest(&mut session);
    let mut changed = scene();
    changed.materials[0].material.diffuse = 0.25;
    changed.lights[0].color = Vec3f::new(0.5, 0.6, 0.7);
    // A light is added, and another one removed.
    for lights in [2, 1] {
        let mut look = session.look().unwrap().clone();
        look.lights.resize(lights, changed.lights[0]);
        session.set_look(look);
        assert_eq!(session.look().unwrap().lights.len(), lights);
        rest(&mut session);
    }
    assert!(session.is_changed());
    assert_is_exact(&session, &changed);
    session.write_back();
    serve_until(&mut session, "the file", |session| session.scene().is_some_and(|s| s.lights == changed.lights));
    assert!(!session.is_changed());
    rest(&mut session);
    assert_is_exact(&session, &changed);
    // What is impossible is refused.
    let mut impossible = session.look().unwrap().clone();
    impossible.materials[0].material.ior = -1.0;
    session.set_look(impossible);
    assert_eq!(session.look().unwrap().materials, changed.materials);
}
