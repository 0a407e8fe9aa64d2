//! What lies over the picture: cards, panels, the cheat sheet; drawn on the CPU.

mod cards;
mod events;
mod inspector;
mod panel;
mod projection;
mod status;
mod theme;

use crate::input::Input;
use crate::session::Session;
use egui::{Order, RawInput, Rect, ViewportId, pos2, vec2};
use egui_software_backend::{BufferMutRef, ColorFieldOrder, EguiSoftwareRender};
use events::Events;
use std::time::{Duration, Instant};

/// The overlay of one window.
pub(crate) struct Overlay {
    context: egui::Context,
    render: EguiSoftwareRender,
    events: Events,
    start: Instant,
    size: [u32; 2],
    /// Physical pixels for each unit of layout.
    scale: f32,
    /// When it wants to be drawn again even if nothing happens.
    due: Option<Instant>,
    panels: Panels,
}

/// The panels that remember something.
#[derive(Debug, Default)]
struct Panels {
    panel: panel::Panel,
    inspector: inspector::Inspector,
}

impl Overlay {
    /// The overlay of a window with so many physical pixels for each unit of layout.
    pub(crate) fn new(scale: f32) -> Self {
        let context = egui::Context::default();
        theme::apply(&context);
        Self {
            context,
            render: EguiSoftwareRender::new(ColorFieldOrder::Bgra),
            events: Events::default(),
            start: Instant::now(),
            size: [1, 1],
            scale,
            due: None,
            panels: Panels::default(),
        }
    }

    /// The window is on a display with another scale now.
    pub(crate) fn set_scale(&mut self, scale: f32) {
        self.scale = scale;
    }

    /// Take in an event. True if it is for the overlay and not for what lies below.
    pub(crate) fn take(&mut self, input: &Input, is_dragging: bool) -> bool {
        self.events.push(input, self.scale);
        match input {
            Input::Button(_, true) | Input::Wheel(_) => self.is_under_pointer(),
            Input::Key(..) | Input::Text(_) => self.context.egui_wants_keyboard_input(),
            Input::Button(_, false) | Input::Pointer(_) => !is_dragging && self.context.egui_is_using_pointer(),
            Input::PointerGone | Input::Modifiers(_) | Input::Focus(_) => false,
        }
    }

    /// True if the pointer is over a card or panel.
    fn is_under_pointer(&self) -> bool {
        let layer = self.events.pointer().and_then(|at| self.context.layer_id_at(at));
        layer.is_some_and(|layer| layer.order != Order::Background)
    }

    /// Time until it wants to be drawn again even if nothing happens.
    pub(crate) fn next(&self, now: Instant) -> Option<Duration> {
        self.due.map(|due| due.saturating_duration_since(now))
    }

    /// Lay everything out and draw it over `pixels` of a picture of this size.
    pub(crate) fn draw(&mut self, session: &mut Session, pixels: &mut [u32], size: [u32; 2]) {
        self.size = size;
        let now = Instant::now();
        let raw = self.raw_input(now);
        let panels = &mut self.panels;
        let output = self.context.run_ui(raw, |ui| show(ui, session, panels, now));
        let delay = output.viewport_output.get(&ViewportId::ROOT).map_or(Duration::MAX, |view| view.repaint_delay);
        self.due = now.checked_add(delay);
        let jobs = self.context.tessellate(output.shapes, output.pixels_per_point);
        let [width, height] = size.map(|side| side as usize);
        self.render.render_to_canvas(width, height, &jobs, &output.textures_delta, output.pixels_per_point);
        let pixels = bytemuck::cast_slice_mut(pixels);
        self.render.blit_canvas_to_buffer(&mut BufferMutRef::new(pixels, width, height));
    }

    fn raw_input(&mut self, now: Instant) -> RawInput {
        let mut raw = RawInput {
            screen_rect: Some(Rect::from_min_size(
                pos2(0.0, 0.0),
                vec2(self.size[0] as f32, self.size[1] as f32) / self.scale,
            )),
            time: Some(now.duration_since(self.start).as_secs_f64()),
            ..RawInput::default()
        };
        if let Some(viewport) = raw.viewports.get_mut(&ViewportId::ROOT) {
            viewport.native_pixels_per_point = Some(self.scale);
        }
        self.events.move_to(&mut raw);
        raw
    }
}

/// All that is shown at the moment.
fn show(ui: &mut egui::Ui, session: &mut Session, panels: &mut Panels, now: Instant) {
    let context = ui.ctx().clone();
    // What is wrong is shown whatever else is.
    cards::trouble(&context, session);
    if session.shown().clean {
        return;
    }
    status::show(&context, session, now);
    cards::legend(&context, session);
    cards::notes(&context, session);
    panels.inspector.show(&context, session);
    if session.shown().panel {
        panels.panel.show(&context, session);
    }
    cards::opening(&context, session, now);
    if session.shown().help {
        cards::help(&context, session);
    }
}
