//! Cards over the picture: what goes on, what is wrong, which keys there are.

use super::theme::{ACCENT, FAINT, GAP, TEXT, WRONG, card, pill, room, scrolled};
use crate::action::{GESTURES, KEYS};
use crate::opener::Activity;
use crate::session::Session;
use egui::{Align, Align2, Area, Context, Grid, Id, Layout, Order, RichText, Stroke, vec2};
use std::time::{Duration, Instant};
use whitted::render::{Aov, Legend, heat};

/// A clock on a card moves this often.
const CLOCK: Duration = Duration::from_millis(100);

/// In less room than this there is one thing in a line, in units of layout.
const NARROW: f32 = 320.0;

/// Height of the line in the corner, with its distance.
const STATUS: f32 = 36.0;

/// What is read or built, once it takes long enough to be noticed.
pub(super) fn opening(context: &Context, session: &Session, now: Instant) {
    let (what, since, share) = match session.activity() {
        Activity::Idle => return,
        Activity::Reading(since) => ("reading".to_owned(), since, None),
        Activity::Building(count, since) => {
            (format!("building the tree over {} primitives", grouped(count)), since, Some(session.built_share()))
        }
    };
    let seconds = now.duration_since(since).as_secs_f64();
    context.request_repaint_after(CLOCK);
    // While an older picture is shown, the card keeps out of its way.
    let (align, offset) = match session.scene() {
        None => (Align2::CENTER_CENTER, vec2(0.0, 0.0)),
        Some(_) => (Align2::CENTER_BOTTOM, vec2(0.0, -GAP)),
    };
    Area::new(Id::new("opening")).anchor(align, offset).order(Order::Foreground).interactable(false).show(
        context,
        |ui| {
            card().show(ui, |ui| {
                if session.scene().is_none() {
                    ui.label(RichText::new(session.title()).heading());
                }
                let is_narrow = room(context).x < NARROW;
                let line = if is_narrow { Layout::top_down(Align::Min) } else { Layout::left_to_right(Align::Center) };
                ui.with_layout(line, |ui| {
                    ui.label(what);
                    if let Some(share) = share {
                        ui.label(RichText::new(format!("{:3.0} %", 100.0 * share)).monospace().color(ACCENT));
                    }
                    ui.label(RichText::new(format!("{seconds:.1} s")).monospace().color(FAINT));
                });
                share.into_iter().for_each(|share| bar(ui, share));
            });
        },
    );
}

/// How far something is, as wide as what is above it.
fn bar(ui: &mut egui::Ui, share: f32) {
    const HEIGHT: f32 = 3.0;
    let (response, painter) = ui.allocate_painter(vec2(ui.min_rect().width(), HEIGHT), egui::Sense::hover());
    let whole = response.rect;
    let done = egui::Rect::from_min_size(whole.min, vec2(whole.width() * share, HEIGHT));
    painter.rect_filled(whole, 1.0, FAINT.gamma_multiply(0.3));
    painter.rect_filled(done, 1.0, ACCENT);
}

/// Why the scene cannot be shown as it is now.
pub(super) fn trouble(context: &Context, session: &Session) {
    let Some(text) = session.trouble() else { return };
    let (room, fits) = (room(context), lines_fit(context, text));
    let area = Area::new(Id::new("trouble")).anchor(Align2::CENTER_TOP, vec2(0.0, GAP)).order(Order::Foreground);
    // A card that can be scrolled takes the wheel, and the mouse below it.
    area.interactable(!fits).show(context, |ui| {
        card().stroke(Stroke::new(1.5, WRONG)).show(ui, |ui| {
            scrolled(ui, room, |ui| trouble_lines(ui, text, session.scene().is_some()));
        });
    });
}

/// Whether lines in letters of one width fit into a card, with two more below.
fn lines_fit(context: &Context, text: &str) -> bool {
    /// Units of layout.
    const LETTER: [f32; 2] = [8.0, 20.0];
    let longest = text.lines().map(|line| line.chars().count()).max().unwrap_or(0);
    let size = vec2(longest as f32 * LETTER[0], (text.lines().count() + 2) as f32 * LETTER[1]);
    let room = room(context);
    size.x < room.x && size.y < room.y
}

fn trouble_lines(ui: &mut egui::Ui, text: &str, is_shown: bool) {
    let mut lines = text.lines();
    let first = RichText::new(lines.next().unwrap_or_default()).color(WRONG).strong();
    ui.add(egui::Label::new(first).extend());
    for line in lines {
        let text = match line.strip_prefix("hint: ") {
            Some(hint) => RichText::new(hint).color(TEXT),
            // Spaces matter: the caret stands below its place.
            None => {
                let is_caret = line.trim_start().starts_with('^');
                RichText::new(line).monospace().color(if is_caret { WRONG } else { TEXT })
            }
        };
        ui.add(egui::Label::new(text).extend());
    }
    let rest = match is_shown {
        true => "The last good picture stays. Mend the file and save it.",
        false => "Mend the file and save it.",
    };
    ui.add(egui::Label::new(RichText::new(rest).color(FAINT).size(12.0)).extend());
}

/// What the colours of a view stand for.
pub(super) fn legend(context: &Context, session: &Session) {
    let Some(view) = session.view() else { return };
    let finished = session.picture().finished.clone();
    let shown = finished.as_ref().and_then(|finished| finished.view.as_ref()).filter(|shown| shown.aov == view);
    let scale = shown.and_then(|shown| shown.legend);
    let room = room(context);
    // Beside the line in the other corner, or above it.
    let above = if room.x < 2.0 * NARROW { STATUS } else { 0.0 };
    let area = Area::new(Id::new("legend")).anchor(Align2::RIGHT_BOTTOM, vec2(-GAP, -GAP - above)).order(Order::Middle);
    area.interactable(false).show(context, |ui| {
        card().show(ui, |ui| {
            ui.label(RichText::new(view.what()).color(TEXT));
            if let Some(Legend { first, last }) = scale {
                ui.horizontal(|ui| {
                    ui.label(RichText::new(amount(first)).monospace());
                    bar_of_colours(ui, view, (room.x - 100.0).clamp(20.0, 180.0));
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
fn bar_of_colours(ui: &mut egui::Ui, view: Aov, width: f32) {
    let (response, painter) = ui.allocate_painter(vec2(width, 12.0), egui::Sense::hover());
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
    let area = Area::new(Id::new("notes")).anchor(Align2::LEFT_BOTTOM, vec2(GAP, -GAP - STATUS)).order(Order::Middle);
    area.interactable(false).show(context, |ui| {
        // Else lines are no longer than those of the notes before, of which there may have been none.
        ui.set_max_width(room(context).x);
        for note in session.notes() {
            pill().show(ui, |ui| ui.label(&note.text));
        }
    });
}

/// All keys and gestures.
pub(super) fn help(context: &Context, session: &Session) {
    /// Both tables side by side, in units of layout.
    const SIZE: [f32; 2] = [640.0, 390.0];
    let room = room(context);
    let fits = room.x >= SIZE[0] && room.y >= SIZE[1];
    let area = Area::new(Id::new("help")).anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0)).order(Order::Foreground);
    area.interactable(!fits).show(context, |ui| {
        card().show(ui, |ui| {
            scrolled(ui, room, |ui| {
                ui.label(RichText::new(session.title()).heading());
                ui.add_space(6.0);
                let beside = Layout::left_to_right(Align::Min);
                let below = Layout::top_down(Align::Min);
                ui.with_layout(if room.x >= SIZE[0] { beside } else { below }, |ui| {
                    let keys = KEYS.iter().map(|(key, _, what)| (key.label(), *what));
                    table(ui, "mouse", GESTURES.iter().map(|(how, what)| ((*how).to_owned(), *what)));
                    ui.add_space(22.0);
                    table(ui, "keys", keys);
                });
            });
        });
    });
}

fn table(ui: &mut egui::Ui, id: &str, rows: impl Iterator<Item = (String, &'static str)>) {
    Grid::new(id).num_columns(2).spacing([14.0, 4.0]).show(ui, |ui| {
        for (how, what) in rows {
            ui.add(egui::Label::new(RichText::new(how).color(ACCENT)).extend());
            ui.add(egui::Label::new(what).extend());
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
