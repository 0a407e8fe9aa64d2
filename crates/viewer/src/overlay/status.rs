//! How far the picture is and how fast it moves: a line in the corner, and a thin bar while it gets better.

use super::theme::{ACCENT, FAINT, GAP, pill, room};
use crate::quality::Draft;
use crate::screen::Stage;
use crate::session::Session;
use egui::{Align2, Area, Context, Id, LayerId, Order, RichText, vec2};
use std::time::Instant;

/// Height of the bar in units of layout.
const BAR: f32 = 2.0;

/// The line is as long as this, in units of layout.
const ROOM: f32 = 260.0;

pub(super) fn show(context: &Context, session: &mut Session, now: Instant) {
    let Some(line) = line(session, now) else { return };
    Area::new(Id::new("status"))
        .anchor(Align2::LEFT_BOTTOM, vec2(GAP, -GAP))
        .order(Order::Middle)
        .interactable(false)
        .show(context, |ui| {
            pill().show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.label(RichText::new(line.0).monospace());
                    // The panel says it, too.
                    if room(context).x >= ROOM {
                        ui.label(RichText::new(line.1).color(FAINT));
                    }
                });
            });
        });
    if let Stage::Refining(share) = session.picture().stage {
        bar(context, share * 0.5);
    }
}

/// What matters and what may be of interest.
fn line(session: &mut Session, now: Instant) -> Option<(String, String)> {
    let rate = session.rate(now);
    let picture = session.picture();
    let [width, height] = picture.size;
    let size = format!("{width}×{height}");
    let line = match picture.stage {
        Stage::Blank => return None,
        Stage::Draft => {
            let Draft { size: [drawn, _], depth, .. } = picture.draft;
            let percent = 100.0 * f64::from(drawn) / f64::from(width.max(1));
            let is_shallow = depth < session.settings().depth;
            let shallow = if is_shallow { format!(", depth {depth}") } else { String::new() };
            (format!("{rate:.0} fps"), format!("{size} at {percent:.0} %{shallow}"))
        }
        Stage::Refining(share) if share < 1.0 => (format!("{:.0} %", share * 100.0), format!("{size}, tracing")),
        Stage::Refining(share) => (format!("{:.0} %", (share - 1.0) * 100.0), format!("{size}, refining edges")),
        Stage::Finished => {
            let Some(finished) = &picture.finished else { return None };
            let statistics = finished.frame.statistics;
            let rays = short(statistics.rays() as f64);
            (size, format!("finished in {:.2} s, {rays} rays", finished.time.as_secs_f64()))
        }
    };
    Some(line)
}

/// A large number in three digits.
pub(super) fn short(number: f64) -> String {
    match number {
        n if n >= 1e9 => format!("{:.2} G", n / 1e9),
        n if n >= 1e6 => format!("{:.2} M", n / 1e6),
        n if n >= 1e3 => format!("{:.1} k", n / 1e3),
        n => format!("{n:.0}"),
    }
}

fn bar(context: &Context, share: f32) {
    let screen = context.content_rect();
    let mut filled = screen;
    filled.min.y = screen.max.y - BAR;
    filled.max.x = screen.min.x + screen.width() * share;
    let painter = context.layer_painter(LayerId::new(Order::Foreground, Id::new("progress")));
    painter.rect_filled(filled, 0.0, ACCENT);
}
