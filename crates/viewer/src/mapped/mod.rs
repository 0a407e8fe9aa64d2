//! Whether a window is mapped, where the window system can be asked and does not tell by itself.

// Where winit has X11, as in this crate's Cargo.toml.
#[cfg_attr(
    all(
        unix,
        not(any(
            target_os = "redox",
            target_family = "wasm",
            target_os = "android",
            target_os = "ios",
            target_os = "macos"
        ))
    ),
    path = "x11.rs"
)]
mod system;

pub(crate) use system::Mapping;
