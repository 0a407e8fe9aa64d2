//! Colours and shapes: dark and translucent, so that the picture stays the bright thing.

use egui::{Color32, CornerRadius, FontFamily, FontId, Frame, Margin, ScrollArea, Shadow, Stroke, TextStyle, Ui, Vec2};
use egui::{Visuals, vec2};

/// What draws the eye: progress, what is chosen.
pub(super) const ACCENT: Color32 = Color32::from_rgb(255, 178, 74);

/// What is wrong.
pub(super) const WRONG: Color32 = Color32::from_rgb(255, 107, 97);

/// Text, and text that may be overlooked.
pub(super) const TEXT: Color32 = Color32::from_rgb(232, 232, 228);
pub(super) const FAINT: Color32 = Color32::from_rgb(160, 162, 166);

const CARD: Color32 = Color32::from_rgba_premultiplied(19, 20, 23, 232);
const LINE: Color32 = Color32::from_rgba_premultiplied(52, 54, 58, 160);
const RADIUS: u8 = 7;

/// Make the panels look like this.
pub(super) fn apply(context: &egui::Context) {
    let mut visuals = Visuals::dark();
    visuals.window_fill = CARD;
    visuals.panel_fill = CARD;
    visuals.window_stroke = Stroke::new(1.0, LINE);
    visuals.window_corner_radius = CornerRadius::same(RADIUS);
    visuals.window_shadow = Shadow::NONE;
    visuals.popup_shadow = Shadow::NONE;
    visuals.selection.bg_fill = ACCENT.gamma_multiply(0.45);
    visuals.selection.stroke = Stroke::new(1.0, ACCENT);
    visuals.override_text_color = Some(TEXT);
    visuals.slider_trailing_fill = true;
    context.set_visuals(visuals);
    context.all_styles_mut(|style| {
        style.text_styles.insert(TextStyle::Body, FontId::new(13.5, FontFamily::Proportional));
        style.text_styles.insert(TextStyle::Button, FontId::new(13.5, FontFamily::Proportional));
        style.text_styles.insert(TextStyle::Monospace, FontId::new(13.0, FontFamily::Monospace));
        style.text_styles.insert(TextStyle::Heading, FontId::new(17.0, FontFamily::Proportional));
        style.spacing.item_spacing = egui::vec2(8.0, 5.0);
        style.interaction.selectable_labels = false;
        style.animation_time = 0.0;
    });
}

/// The ground of everything that lies over the picture.
pub(super) fn card() -> Frame {
    Frame::new()
        .fill(CARD)
        .stroke(Stroke::new(1.0, LINE))
        .corner_radius(CornerRadius::same(RADIUS))
        .inner_margin(Margin::symmetric(14, 11))
}

/// As [`card`], smaller.
pub(super) fn pill() -> Frame {
    card().stroke(Stroke::NONE).inner_margin(Margin::symmetric(9, 5))
}

/// Between a card and the edge of the window, in units of layout.
pub(super) const GAP: f32 = 10.0;

/// The least room: less is not worth a scroll bar.
const LEAST: f32 = 24.0;

/// The room for what is on a card.
pub(super) fn room(context: &egui::Context) -> Vec2 {
    let frame = card();
    let edges = vec2(2.0 * GAP, 2.0 * GAP) + frame.inner_margin.sum() + vec2(2.0, 2.0) * frame.stroke.width;
    (context.content_rect().size() - edges).max(vec2(LEAST, LEAST))
}

/// Show what may be larger than its room: then it can be scrolled both ways.
pub(super) fn scrolled<R>(ui: &mut Ui, room: Vec2, show: impl FnOnce(&mut Ui) -> R) -> R {
    ui.set_max_size(room);
    ScrollArea::both().min_scrolled_width(LEAST).min_scrolled_height(LEAST).show(ui, show).inner
}
