//! A flat cut through a kd-tree, and a ray on its way through it.

use super::WIDTH;
use super::canvas::{Anchor, circle, document, line, rectangle, text};
use svg::Document;
use svg::node::element::{Definitions, Marker, Path as Shape};

/// What lies in the plane of the cut.
pub(crate) struct Plan {
    /// Lower and upper corner of what is shown.
    pub(crate) bounds: [[f64; 2]; 2],
    pub(crate) cells: Vec<Rect>,
    /// Centres and radii of the circles in which the plane cuts spheres, and whether the ray hits this one.
    pub(crate) circles: Vec<([f64; 2], f64, Role)>,
}

/// A leaf: its corners, how it is coloured, and what it says when pointed at.
pub(crate) struct Rect {
    pub(crate) corners: [[f64; 2]; 2],
    pub(crate) class: &'static str,
    pub(crate) tip: String,
}

/// What an object is to the ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    Ignored,
    Tested,
    Hit,
}

/// A ray within the plane.
pub(crate) struct Path {
    pub(crate) from: [f64; 2],
    pub(crate) to: [f64; 2],
    /// Where it enters each leaf, in order.
    pub(crate) stations: Vec<[f64; 2]>,
}

/// The drawing of a cut, with a ray if there is one.
pub(crate) fn plan(plan: &Plan, path: Option<&Path>) -> Document {
    const MARGIN: f64 = 4.0;
    let [low, high] = plan.bounds;
    let scale = (WIDTH - 2.0 * MARGIN) / (high[0] - low[0]);
    let height = scale * (high[1] - low[1]) + 2.0 * MARGIN;
    // Paper counts from above.
    let place = |[x, y]: [f64; 2]| [MARGIN + scale * (x - low[0]), MARGIN + scale * (high[1] - y)];
    let mut out = document(height);
    for cell in &plan.cells {
        let ([left, bottom], [right, top]) = (place(cell.corners[0]), place(cell.corners[1]));
        out = out.add(rectangle(left, top, right - left, bottom - top, cell.class, &cell.tip));
    }
    for (center, radius, role) in &plan.circles {
        let class = match role {
            Role::Ignored => "object",
            Role::Tested => "object tested",
            Role::Hit => "object hit",
        };
        out = out.add(circle(place(*center), radius * scale, class, ""));
    }
    let Some(path) = path else { return out };
    let ray = line(place(path.from), place(path.to), "ray").set("marker-end", "url(#arrow)");
    out = out.add(arrow_head()).add(ray);
    for (index, station) in path.stations.iter().enumerate() {
        let at = place(*station);
        out = out.add(circle(at, 7.5, "station", "")).add(text(
            at[0],
            at[1] + 3.6,
            "number",
            Anchor::Middle,
            (index + 1).to_string(),
        ));
    }
    out
}

fn arrow_head() -> Definitions {
    let head = Shape::new().set("d", "M0,0 L8,4 L0,8 z").set("class", "arrow");
    let marker = Marker::new().set("id", "arrow").set("viewBox", (0, 0, 8, 8)).set("refX", 7).set("refY", 4);
    Definitions::new().add(marker.set("markerWidth", 7).set("markerHeight", 7).set("orient", "auto").add(head))
}
