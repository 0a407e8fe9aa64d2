//! The window: events in, pictures out. It holds no state of the scene's.

use crate::app::App;
use crate::host::Host;
use crate::input::{Button, Input, Key, Modifiers};
use crate::mapped::Mapping;
use crate::options::Options;
use crate::session::{Effect, Session};
use crate::sight::{GLANCE_AWAY, Sight};
use std::io::Write;
use std::num::NonZeroU32;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy, OwnedDisplayHandle};
use winit::keyboard::{Key as LogicalKey, NamedKey};
use winit::window::{Window as SystemWindow, WindowId};

/// The size of a window whose scene is not read yet.
const DEFAULT_SIZE: [u32; 2] = [1280, 720];

/// The smallest window that can be used.
const LEAST_SIZE: [u32; 2] = [160, 120];

/// The window waits so long for the scene to say how large it shall be: most are read by then.
const READING: Duration = Duration::from_millis(100);
const GLANCE: Duration = Duration::from_millis(2);

/// The part of the display that a window may take.
const ROOM: f64 = 0.9;

/// Pixels that a touch pad scrolls for what is a notch of a wheel.
const PIXELS_PER_NOTCH: f64 = 50.0;

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// There is no display, or it has refused.
    #[error("no window can be opened: {0}\nhint: a picture needs no display: `whitted render`")]
    Display(String),
    /// The display has gone, and the window with it.
    #[error("the display is gone: {0}")]
    Lost(String),
    /// The system has no thread left.
    #[error("cannot start a thread: {0}")]
    Thread(#[from] std::io::Error),
}

/// Another thread has something to show.
#[derive(Clone, Copy, Debug)]
struct Woken;

/// Open a window on the scene of `host`, and serve it until it is closed.
///
/// # Errors
/// If there is no display or it cannot show a window.
pub fn run(host: Arc<dyn Host>, options: Options) -> Result<(), WindowError> {
    let refused = |error: &dyn std::fmt::Display| WindowError::Display(error.to_string());
    let event_loop = EventLoop::<Woken>::with_user_event().build().map_err(|error| refused(&error))?;
    event_loop.set_control_flow(ControlFlow::Wait);
    let context = softbuffer::Context::new(event_loop.owned_display_handle()).map_err(|error| refused(&error))?;
    let mut shell = Shell { host, options, proxy: event_loop.create_proxy(), context, open: None, error: None };
    event_loop.run_app(&mut shell).map_err(|error| WindowError::Lost(error.to_string()))?;
    shell.error.map_or(Ok(()), Err)
}

type Surface = softbuffer::Surface<OwnedDisplayHandle, Rc<SystemWindow>>;

/// The program as the window system sees it.
struct Shell {
    host: Arc<dyn Host>,
    options: Options,
    proxy: EventLoopProxy<Woken>,
    context: softbuffer::Context<OwnedDisplayHandle>,
    open: Option<Open>,
    error: Option<WindowError>,
}

/// An open window.
struct Open {
    // Before the window, so that it is gone first.
    surface: Surface,
    window: Rc<SystemWindow>,
    app: App,
    clipboard: Option<arboard::Clipboard>,
    sight: Sight,
    /// On X11.
    mapping: Option<Mapping>,
}

impl Shell {
    fn open(&self, event_loop: &ActiveEventLoop) -> Result<Open, WindowError> {
        let refused = |error: &dyn std::fmt::Display| WindowError::Display(error.to_string());
        let proxy = self.proxy.clone();
        let wake = move || {
            // If the loop has ended, there is nothing left to show.
            let _ = proxy.send_event(Woken);
        };
        let size = self.options.size.unwrap_or(DEFAULT_SIZE);
        let mut session = Session::new(Arc::clone(&self.host), self.options.clone(), size, wake)?;
        let [width, height] = self.options.size.or_else(|| proposed_size(&mut session, event_loop)).unwrap_or(size);
        let attributes = SystemWindow::default_attributes()
            .with_title(format!("{} – whitted", session.title()))
            .with_inner_size(PhysicalSize::new(width, height))
            .with_min_inner_size(PhysicalSize::new(LEAST_SIZE[0], LEAST_SIZE[1]));
        let window = Rc::new(event_loop.create_window(attributes).map_err(|error| refused(&error))?);
        let surface = Surface::new(&self.context, Rc::clone(&window)).map_err(|error| refused(&error))?;
        let size: [u32; 2] = window.inner_size().into();
        session.resize(size, Instant::now());
        let app = App::new(session, size, window.scale_factor() as f32);
        let mapping = Mapping::of(&window);
        Ok(Open { surface, window, app, clipboard: None, sight: Sight::default(), mapping })
    }
}

/// The size that the scene asks for, as far as the display has room for it; `None` if it takes too long to read.
fn proposed_size(session: &mut Session, event_loop: &ActiveEventLoop) -> Option<[u32; 2]> {
    let start = Instant::now();
    while session.proposed_size().is_none() && session.trouble().is_none() && start.elapsed() < READING {
        std::thread::sleep(GLANCE);
        session.tick(Instant::now());
    }
    let [width, height] = session.proposed_size()?;
    let room = event_loop.primary_monitor().or_else(|| event_loop.available_monitors().next()).map(|m| m.size());
    let room = room.map_or(DEFAULT_SIZE, |size| [size.width, size.height]);
    let share = |side: u32, room: u32| f64::from(room) * ROOM / f64::from(side.max(1));
    let share = share(width, room[0]).min(share(height, room[1])).min(1.0);
    let fitted = |side: u32, least: u32| ((f64::from(side) * share) as u32).max(least);
    Some([fitted(width, LEAST_SIZE[0]), fitted(height, LEAST_SIZE[1])])
}

impl ApplicationHandler<Woken> for Shell {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        match self.open(event_loop) {
            Ok(open) => {
                open.window.request_redraw();
                self.open = Some(open);
            }
            Err(error) => {
                self.error = Some(error);
                event_loop.exit();
            }
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, _: StartCause) {}

    fn user_event(&mut self, _: &ActiveEventLoop, _: Woken) {}

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::RedrawRequested => open.draw(),
            other => open.event(&other),
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        let now = Instant::now();
        let next = open.tick(now);
        for effect in open.app.session.take_effects() {
            match effect {
                Effect::Close => event_loop.exit(),
                Effect::Copy(text) => open.copy(text),
            }
        }
        event_loop.set_control_flow(next.map_or(ControlFlow::Wait, |rest| ControlFlow::WaitUntil(now + rest)));
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // The window goes at once; what is being saved is saved to its end while the session is dropped.
        if let Some(open) = self.open.take() {
            open.window.set_visible(false);
        }
    }
}

impl Open {
    /// Move on, and ask for what is to be drawn. When to be called again at the latest.
    fn tick(&mut self, now: Instant) -> Option<Duration> {
        let is_seen = self.sight.is_seen(now, || {
            self.window.is_minimized() == Some(true) || self.mapping.as_mut().is_some_and(Mapping::is_away)
        });
        self.app.session.set_visible(is_seen);
        let (next, draw) = self.app.tick(now);
        if draw {
            self.sight.picture_waits(now);
            self.window.request_redraw();
        }
        if is_seen { next } else { Some(GLANCE_AWAY) }
    }

    fn draw(&mut self) {
        self.sight.picture_is_taken();
        let size: [u32; 2] = self.window.inner_size().into();
        let (Some(width), Some(height)) = (NonZeroU32::new(size[0]), NonZeroU32::new(size[1])) else { return };
        // A display that refuses a picture may take the next one; if it has gone, the loop ends.
        if self.surface.resize(width, height).is_err() {
            return;
        }
        self.app.resize_if_needed(size);
        let Ok(mut buffer) = self.surface.buffer_mut() else { return };
        self.app.draw(&mut buffer);
        self.window.pre_present_notify();
        let _ = buffer.present();
    }

    fn event(&mut self, event: &WindowEvent) {
        match event {
            WindowEvent::Resized(size) => self.app.resize((*size).into()),
            WindowEvent::Occluded(is_covered) => self.sight.cover(*is_covered),
            WindowEvent::ScaleFactorChanged { scale_factor, .. } => self.app.set_scale(*scale_factor as f32),
            // A key that was down when the window got the focus was pressed for another window, or comes again.
            WindowEvent::KeyboardInput { event, is_synthetic, .. } => {
                if !is_synthetic || !event.state.is_pressed() {
                    self.key(event);
                }
            }
            other => {
                if let Some(input) = translated(other) {
                    self.app.input(&input);
                }
            }
        }
    }

    fn key(&mut self, event: &winit::event::KeyEvent) {
        let is_pressed = event.state == ElementState::Pressed;
        if let Some(key) = key_of(&event.logical_key)
            && !event.repeat
        {
            self.app.input(&Input::Key(key, is_pressed));
        }
        let text = event.text.as_ref().filter(|text| is_pressed && !text.chars().any(char::is_control));
        if let Some(text) = text {
            self.app.input(&Input::Text(text.to_string()));
        }
    }

    /// Print a text and put it on the clipboard, which lives as long as the window.
    fn copy(&mut self, text: String) {
        // Whoever has closed standard output does not want it.
        let _ = writeln!(std::io::stdout(), "{text}");
        if self.clipboard.is_none() {
            self.clipboard = arboard::Clipboard::new().ok();
        }
        if let Some(clipboard) = &mut self.clipboard {
            // It was printed: a display without a clipboard loses nothing.
            let _ = clipboard.set_text(text);
        }
    }
}

fn translated(event: &WindowEvent) -> Option<Input> {
    Some(match event {
        WindowEvent::CursorMoved { position, .. } => Input::Pointer([position.x, position.y]),
        WindowEvent::CursorLeft { .. } => Input::PointerGone,
        WindowEvent::MouseInput { state, button, .. } => {
            let button = match button {
                MouseButton::Left => Button::Left,
                MouseButton::Middle => Button::Middle,
                MouseButton::Right => Button::Right,
                _ => return None,
            };
            Input::Button(button, *state == ElementState::Pressed)
        }
        WindowEvent::MouseWheel { delta, .. } => Input::Wheel(match delta {
            MouseScrollDelta::LineDelta(_, lines) => f64::from(*lines),
            MouseScrollDelta::PixelDelta(pixels) => pixels.y / PIXELS_PER_NOTCH,
        }),
        WindowEvent::ModifiersChanged(modifiers) => {
            let state = modifiers.state();
            let control = state.control_key() || state.super_key();
            Input::Modifiers(Modifiers { shift: state.shift_key(), control, alt: state.alt_key() })
        }
        WindowEvent::Focused(has_focus) => Input::Focus(*has_focus),
        _ => return None,
    })
}

fn key_of(key: &LogicalKey) -> Option<Key> {
    match key {
        LogicalKey::Character(text) => {
            let mut chars = text.chars();
            let c = chars.next().filter(|_| chars.next().is_none())?;
            Some(Key::Char(c.to_ascii_lowercase()))
        }
        LogicalKey::Named(named) => named_key(*named),
        _ => None,
    }
}

fn named_key(key: NamedKey) -> Option<Key> {
    Some(match key {
        NamedKey::Enter => Key::Enter,
        NamedKey::Escape => Key::Escape,
        NamedKey::Tab => Key::Tab,
        NamedKey::Space => Key::Space,
        NamedKey::Backspace => Key::Backspace,
        NamedKey::Delete => Key::Delete,
        NamedKey::ArrowUp => Key::Up,
        NamedKey::ArrowDown => Key::Down,
        NamedKey::ArrowLeft => Key::Left,
        NamedKey::ArrowRight => Key::Right,
        NamedKey::F12 => Key::Function(12),
        NamedKey::F5 => Key::Function(5),
        _ => return None,
    })
}
