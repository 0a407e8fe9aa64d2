//! Lines over a growing scene, both scales logarithmic.

use super::canvas::{Anchor, circle, document, line, rectangle, rounded, text};
use super::scale::{Scale, tick_name};
use crate::report::number;
use svg::Document;
use svg::node::element::Polyline;

/// One line: its name and its points.
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<[f64; 2]>,
}

/// Where the axes lie, and how high all is.
const LEFT: f64 = 34.0;
const RIGHT: f64 = 262.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 230.0;
const HEIGHT: f64 = 268.0;

/// Lines that have a class of their own, `line1` to `line6`.
const CLASSES: usize = 6;

/// The chart of `series`, with what its axes are; `band` is a range of y that the paper promises.
pub(crate) fn line_chart(series: &[Series], x_name: &str, y_name: &str, band: Option<[f64; 2]>) -> Document {
    let points = || series.iter().flat_map(|series| &series.points);
    let x = Scale::around(points().map(|point| point[0]), LEFT, RIGHT);
    let y = Scale::around(points().map(|point| point[1]).chain(band.into_iter().flatten()), BOTTOM, TOP);
    let mut out = document(HEIGHT);
    if let Some([low, high]) = band {
        let [top, bottom] = [y.at(high), y.at(low)];
        out = out.add(rectangle(LEFT, top, RIGHT - LEFT, bottom - top, "promise", "what the paper promises"));
    }
    for tick in x.ticks() {
        let at = x.at(tick);
        out = out.add(line([at, TOP], [at, BOTTOM], "grid")).add(text(
            at,
            BOTTOM + 14.0,
            "tick",
            Anchor::Middle,
            tick_name(tick),
        ));
    }
    for tick in y.ticks() {
        let at = y.at(tick);
        out = out.add(line([LEFT, at], [RIGHT, at], "grid")).add(text(
            LEFT - 5.0,
            at + 4.0,
            "tick",
            Anchor::End,
            tick_name(tick),
        ));
    }
    out = out.add(text((LEFT + RIGHT) / 2.0, BOTTOM + 31.0, "tick", Anchor::Middle, x_name));
    out = out.add(text(0.0, 10.0, "tick", Anchor::Start, y_name));
    let names =
        apart(series.iter().map(|series| series.points.last().map_or(BOTTOM, |point| y.at(point[1]))).collect());
    for (index, (series, name_y)) in series.iter().zip(names).enumerate() {
        out = draw(out, series, index % CLASSES + 1, name_y, &x, &y);
    }
    out
}

fn draw(mut out: Document, series: &Series, class: usize, name_y: f64, x: &Scale, y: &Scale) -> Document {
    let places: Vec<[f64; 2]> = series.points.iter().map(|&[px, py]| [x.at(px), y.at(py)]).collect();
    let path: Vec<String> = places.iter().map(|[x, y]| format!("{},{}", rounded(*x), rounded(*y))).collect();
    out = out.add(Polyline::new().set("points", path.join(" ")).set("class", format!("line line{class}")));
    for (place, [spheres, value]) in places.iter().zip(&series.points) {
        let tip = format!("{}, {}: {}", series.name, tick_name(*spheres), number(*value));
        out = out.add(circle(*place, 3.0, &format!("dot line{class}"), &tip));
    }
    let Some([end_x, end_y]) = places.last() else { return out };
    let label_x = RIGHT + 12.0;
    out.add(line([end_x + 4.0, *end_y], [label_x - 2.0, name_y - 4.0], "leader")).add(text(
        label_x,
        name_y,
        &format!("label name{class}"),
        Anchor::Start,
        &series.name,
    ))
}

/// Places of the names: near the ends of their lines, but a line of text apart.
fn apart(ends: Vec<f64>) -> Vec<f64> {
    const LINE: f64 = 13.0;
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|&a, &b| ends[a].total_cmp(&ends[b]));
    let mut places = ends;
    let mut above = f64::NEG_INFINITY;
    for index in order {
        places[index] = (places[index] + 4.0).max(above + LINE);
        above = places[index];
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_overlap() {
        let mut places = apart(vec![50.0, 51.0, 20.0, 50.5]);
        places.sort_by(f64::total_cmp);
        assert!(places.windows(2).all(|pair| pair[1] - pair[0] >= 13.0), "{places:?}");
    }
}
