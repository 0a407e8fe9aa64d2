//! Whether an X11 window is mapped. Whoever unmaps it without a window manager tells nobody of it: winit 0.30 passes no
//! event on, and what it knows of a window being visible is what it was told itself.

use winit::raw_window_handle::{HasWindowHandle, RawWindowHandle};
use winit::window::Window;
use x11rb::protocol::xproto::{ConnectionExt, MapState};
use x11rb::rust_connection::RustConnection;

/// Asks an X11 display about a window, on a connection of its own.
pub(crate) struct Mapping {
    connection: RustConnection,
    window: u32,
    /// A new window is mapped a moment after it was made: until then it is not away.
    was_mapped: bool,
}

impl Mapping {
    /// None on other window systems, or if the display takes no other connection.
    pub(crate) fn of(window: &Window) -> Option<Self> {
        let window = match window.window_handle().ok()?.as_raw() {
            RawWindowHandle::Xlib(handle) => u32::try_from(handle.window).ok()?,
            RawWindowHandle::Xcb(handle) => handle.window.get(),
            _ => return None,
        };
        let (connection, _) = RustConnection::connect(None).ok()?;
        Some(Self { connection, window, was_mapped: false })
    }

    /// Whether the window, or one that it lies in, has been unmapped; not if the display has no answer.
    pub(crate) fn is_away(&mut self) -> bool {
        let request = self.connection.get_window_attributes(self.window).ok();
        let Some(attributes) = request.and_then(|request| request.reply().ok()) else { return false };
        let is_mapped = attributes.map_state == MapState::VIEWABLE;
        self.was_mapped |= is_mapped;
        self.was_mapped && !is_mapped
    }
}
