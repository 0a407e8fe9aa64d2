//! Cards over the picture: what goes on, what is wrong, which keys there are.

use super::theme::{ACCENT, FAINT, TEXT, WRONG, card, pill};
use crate::action::{GESTURES, KEYS};
use crate::opener::Activity;
use crate::session::Session;
use egui::{Align2, Area, Context, Grid, Id, Order, RichText, Stroke, vec2};
use std::time::{Duration, Instant};
use whitted::render::{Aov, Legend, heat};

/// A clock on a card moves this often.
const CLOCK: Duration = Duration::from_millis(100);

/// What is read or built, once it takes long enough to be noticed.
pub(super) fn opening(context: &Context, session: &Session, now: Instant) {
    let activity = session.activity();
    let (what, since) = match activity {
        Activity::Idle => return,
        Activity::Reading(since) => ("reading".to_owned(), since),
        Activity::Building(count, since) => (format!("building the tree over {} primitives", grouped(count)), since),
    };
    let seconds = now.duration_since(since).as_secs_f64();
    context.request_repaint_after(CLOCK);
    // While an older picture is shown, the card keeps out of its way.
    let (align, offset) = match session.scene() {
        None => (Align2::CENTER_CENTER, vec2(0.0, 0.0)),
        Some(_) => (Align2::CENTER_BOTTOM, vec2(0.0, -10.0)),
    };
    Area::new(Id::new("opening")).anchor(align, offset).order(Order::Foreground).interactable(false).show(
        context,
        |ui| {
            card().show(ui, |ui| {
                if session.scene().is_none() {
                    ui.label(RichText::new(session.title()).heading());
                }
                ui.horizontal(|ui| {
                    ui.label(what);
                    ui.label(RichText::new(format!("{seconds:.1} s")).monospace().color(ACCENT));
                });
            });
        },
    );
}

/// Why the scene cannot be shown as it is now.
pub(super) fn trouble(context: &Context, session: &Session) {
    let Some(text) = session.trouble() else { return };
    let area = Area::new(Id::new("trouble")).anchor(Align2::CENTER_TOP, vec2(0.0, 14.0)).order(Order::Foreground);
    area.interactable(false).show(context, |ui| {
        card().stroke(Stroke::new(1.5, WRONG)).show(ui, |ui| {
            ui.set_max_width((context.content_rect().width() - 60.0).max(100.0));
            let mut lines = text.lines();
            ui.label(RichText::new(lines.next().unwrap_or_default()).color(WRONG).strong());
            for line in lines {
                match line.strip_prefix("hint: ") {
                    Some(hint) => ui.label(RichText::new(hint).color(TEXT)),
                    // Spaces matter: the caret stands below its place.
                    None => {
                        let is_caret = line.trim_start().starts_with('^');
                        let text = RichText::new(line).monospace().color(if is_caret { WRONG } else { TEXT });
                        ui.add(egui::Label::new(text).extend())
                    }
                };
            }
            let rest = match session.scene() {
                Some(_) => "The last good picture stays. Mend the file and save it.",
                None => "Mend the file and save it.",
            };
            ui.label(RichText::new(rest).color(FAINT).size(12.0));
        });
    });
}

/// What the colours of a view stand for.
pub(super) fn legend(context: &Context, session: &Session) {
    let Some(view) = session.view() else { return };
    let finished = session.picture().finished.clone();
    let shown = finished.as_ref().and_then(|finished| finished.view.as_ref()).filter(|shown| shown.aov == view);
    let scale = shown.and_then(|shown| shown.legend);
    let area = Area::new(Id::new("legend")).anchor(Align2::RIGHT_BOTTOM, vec2(-10.0, -10.0)).order(Order::Middle);
    area.interactable(false).show(context, |ui| {
        card().show(ui, |ui| {
            ui.label(RichText::new(view.what()).color(TEXT));
            if let Some(Legend { first, last }) = scale {
                ui.horizontal(|ui| {
                    ui.label(RichText::new(amount(first)).monospace());
                    bar_of_colours(ui, view);
                    let more = if view.is_cost() { "+" } else { "" };
                    ui.label(RichText::new(amount(last) + more).monospace());
                });
            }
        });
    });
}

/// A number in a few digits.
fn amount(value: f32) -> String {
    match value {
        value if value.abs() >= 1000.0 => super::status::short(f64::from(value)),
        value if value.fract() == 0.0 => format!("{value:.0}"),
        value => format!("{value:.3}"),
    }
}

/// All colours of a view's scale, from the first to the last.
fn bar_of_colours(ui: &mut egui::Ui, view: Aov) {
    let (response, painter) = ui.allocate_painter(vec2(180.0, 12.0), egui::Sense::hover());
    let bar = response.rect;
    let steps = bar.width() as usize;
    for step in 0..steps {
        let share = step as f32 / steps.max(1) as f32;
        let [r, g, b] = if view.is_cost() { heat(share) } else { [(255.0 * (1.0 - 0.8 * share)) as u8; 3] };
        let left = bar.left() + step as f32;
        let part = egui::Rect::from_min_max(egui::pos2(left, bar.top()), egui::pos2(left + 1.0, bar.bottom()));
        painter.rect_filled(part, 0.0, egui::Color32::from_rgb(r, g, b));
    }
}

/// Short messages.
pub(super) fn notes(context: &Context, session: &Session) {
    let area = Area::new(Id::new("notes")).anchor(Align2::LEFT_BOTTOM, vec2(10.0, -46.0)).order(Order::Middle);
    area.interactable(false).show(context, |ui| {
        for note in session.notes() {
            pill().show(ui, |ui| ui.label(&note.text));
        }
    });
}

/// All keys and gestures.
pub(super) fn help(context: &Context, session: &Session) {
    let area = Area::new(Id::new("help")).anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0)).order(Order::Foreground);
    area.interactable(false).show(context, |ui| {
        card().show(ui, |ui| {
            ui.label(RichText::new(session.title()).heading());
            ui.add_space(6.0);
            ui.horizontal_top(|ui| {
                let keys = KEYS.iter().map(|(key, _, what)| (key.label(), *what));
                table(ui, "mouse", GESTURES.iter().map(|(how, what)| ((*how).to_owned(), *what)));
                ui.add_space(22.0);
                table(ui, "keys", keys);
            });
        });
    });
}

fn table(ui: &mut egui::Ui, id: &str, rows: impl Iterator<Item = (String, &'static str)>) {
    Grid::new(id).num_columns(2).spacing([14.0, 4.0]).show(ui, |ui| {
        for (how, what) in rows {
            ui.label(RichText::new(how).color(ACCENT));
            ui.label(what);
            ui.end_row();
        }
    });
}

/// A number with thin gaps between groups of three digits.
pub(super) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|group| std::str::from_utf8(group).unwrap_or_default()).collect();
    groups.join("\u{2009}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_numbers_are_grouped() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(1_234_567), "1\u{2009}234\u{2009}567");
    }
}
