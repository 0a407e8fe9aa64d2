//! Exact answers made outside: rays aimed at vertices and edges of real meshes, and ray/triangle cases in rationals.

mod common;

use std::path::{Path, PathBuf};
use whitted::geometry::Primitives;
use whitted::math::{Vec3, Vec3f};
use whitted::ray::{HitBatch, Ray, RayBatch};
use whitted::tree::{Occlusion, Query, Scratch, Tree, TreeKind, WalkKind};

/// Bound on |t − t*| / |t*| where the same triangle is hit: rounding to `f32`, and the plane's condition in `f64`.
const T_BOUND: f64 = 1.0 / (1u64 << 23) as f64;

/// The folder of outside test files, or a loud skip.
fn material() -> Option<PathBuf> {
    match std::env::var_os("WHITTED_SHARED") {
        Some(folder) => Some(Path::new(&folder).join("material")),
        None => {
            eprintln!("SKIPPED: WHITTED_SHARED is not set, so no exact oracle was checked");
            None
        }
    }
}

/// A C hexadecimal float such as `-0x1.8p+3`, or a decimal one.
fn number(text: &str) -> f64 {
    let (negative, digits) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
    let Some(hex) = digits.strip_prefix("0x") else {
        return text.parse().expect("a number");
    };
    let (mantissa, exponent) = hex.split_once('p').expect("an exponent");
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let all = u64::from_str_radix(&format!("{whole}{fraction}"), 16).expect("hexadecimal digits");
    let exponent = exponent.parse::<i32>().expect("an exponent") - 4 * fraction.len() as i32;
    let value = all as f64 * 2f64.powi(exponent);
    if negative { -value } else { value }
}

fn vector(fields: &[&str]) -> Vec3f {
    Vec3::new(number(fields[0]), number(fields[1]), number(fields[2])).to_f32()
}

/// Positions and fan-triangulated faces of an OBJ file, nothing else.
fn read_obj(path: &Path) -> Primitives {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let fields: Vec<&str> = line.split_whitespace().collect();
        match fields.first() {
            Some(&"v") => positions.push(vector(&fields[1..4])),
            Some(&"f") => {
                let corner = |f: &&str| f.split('/').next().and_then(|i| i.parse::<u32>().ok()).expect("an index") - 1;
                let corners: Vec<u32> = fields[1..].iter().map(corner).collect();
                triangles.extend((1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]]));
            }
            _ => {}
        }
    }
    let mut primitives = Primitives::new();
    primitives.push_mesh(&positions, &triangles, &[], &[]).expect("a sound mesh");
    primitives
}

struct Case {
    kind: u32,
    ray: Ray,
    hits: u32,
    nearest_t: f64,
    triangle: u32,
    exact_edge: bool,
    must_hit: bool,
}

fn read_cases(path: &Path) -> Vec<Case> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let parse = |line: &str| {
        let f: Vec<&str> = line.split(',').collect();
        let whole = |i: usize| f[i].parse::<i64>().expect("a whole number");
        Case {
            kind: whole(0) as u32,
            ray: Ray::new(vector(&f[1..4]), vector(&f[4..7])),
            hits: whole(7) as u32,
            nearest_t: number(f[8]),
            triangle: whole(9) as u32,
            exact_edge: whole(11) != 0,
            must_hit: whole(12) != 0,
        }
    };
    text.lines().skip(1).map(parse).collect()
}

/// Check the answers of one query; returns (leaks, must_hit rays, rays with a checked t).
fn check(name: &str, query: &Query<'_>, cases: &[Case]) -> (usize, usize, usize) {
    let rays: RayBatch = cases.iter().map(|c| &c.ray).collect();
    let (mut hits, mut any, mut scratch) = (HitBatch::default(), Vec::new(), Scratch::default());
    query.closest_hit(&rays, &mut hits, &mut scratch);
    query.occluded(&rays, None, &mut any, &mut scratch);
    let (mut leaks, mut aimed, mut checked) = (0, 0, 0);
    for (i, case) in cases.iter().enumerate() {
        let hit = hits.get(i);
        assert_eq!(hit.is_hit(), any[i] == Occlusion::Blocked, "{name} ray {i}: any hit = closest hit");
        if case.must_hit {
            aimed += 1;
            // Through the vertex would mean a miss, or the far side.
            leaks += usize::from(!hit.is_hit() || f64::from(hit.t) > case.nearest_t * (1.0 + 1e-5));
        }
        if matches!(case.kind, 0 | 3) && !case.exact_edge {
            checked += 1;
            assert_eq!(hit.is_hit(), case.hits > 0, "{name} ray {i}: {hit:?}");
            if case.hits > 0 {
                assert_eq!(hit.primitive, case.triangle, "{name} ray {i}: {hit:?}, t* = {}", case.nearest_t);
                let error = (f64::from(hit.t) - case.nearest_t).abs() / case.nearest_t.abs();
                assert!(error <= T_BOUND, "{name} ray {i}: {hit:?}, t* = {}, error {error:e}", case.nearest_t);
            }
        }
    }
    (leaks, aimed, checked)
}

#[test]
fn no_ray_leaks_through_a_closed_fan() {
    let Some(material) = material() else { return };
    let mut total = (0, 0, 0);
    for mesh in ["suzanne", "teapot", "cow", "stanford-bunny", "homer", "fandisk", "beetle"] {
        let primitives = read_obj(&material.join(format!("mesh/common-3d/{mesh}.obj")));
        let cases = read_cases(&material.join(format!("oracle/{mesh}.rays.csv")));
        for kind in [TreeKind::Kd, TreeKind::Fast, TreeKind::Best] {
            let tree = Tree::build(&primitives, &kind.into());
            tree.validate(&primitives).unwrap_or_else(|error| panic!("{mesh}, {kind:?}: {error}"));
            for walk in [WalkKind::Stream, WalkKind::Single] {
                for level in simd::Level::available() {
                    let query = Query { tree: &tree, primitives: &primitives, level, walk };
                    let name = format!("{mesh}, {kind:?}, {walk:?}, {}", level.name());
                    let (leaks, aimed, checked) = check(&name, &query, &cases);
                    assert_eq!(leaks, 0, "{name}: of {aimed} rays aimed at closed fans");
                    total = (total.0 + leaks, total.1 + aimed, total.2 + checked);
                }
            }
        }
    }
    println!("{} leaks of {} aimed rays; triangle and t of {} rays checked", total.0, total.1, total.2);
    assert!(total.1 > 0 && total.2 > 0);
}

#[test]
fn triangles_agree_with_rational_arithmetic() {
    let Some(material) = material() else { return };
    // The sheared coordinates are good to this many units of 2⁻²⁴ of the distance from origin to vertex.
    const MARGIN: f64 = 8.0 / (1u64 << 24) as f64;
    let path = material.join("numbers/ray_triangle_exact.csv");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let (mut below, mut right, mut wrong_below) = (0, 0, 0);
    for (row, line) in text.lines().enumerate().skip(1) {
        let f: Vec<&str> = line.split(',').collect();
        let ray = Ray::new(vector(&f[1..4]), vector(&f[4..7]));
        let corners = [vector(&f[7..10]), vector(&f[10..13]), vector(&f[13..16])];
        let (expected, t) = (f[16] == "hit", number(f[17]));
        let mut primitives = Primitives::new();
        primitives.push_mesh(&corners, &[[0, 1, 2]], &[], &[]).expect("a sound mesh");
        let tree = Tree::build(&primitives, &TreeKind::Best.into());
        let query = Query { tree: &tree, primitives: &primitives, level: simd::Level::best(), walk: WalkKind::Auto };
        let (mut hits, mut scratch) = (HitBatch::default(), Scratch::default());
        query.closest_hit(&ray, &mut hits, &mut scratch);
        let found = hits.get(0);
        // An exact edge belongs to the triangle.
        let agrees = found.is_hit() == (expected || f[16] == "edge");
        if margin(&ray, corners) > MARGIN && f[16] != "edge" {
            assert!(agrees, "row {}: {line}\nfound {found:?}", row + 1);
            if expected {
                let error = (f64::from(found.t) - t).abs();
                assert!(error <= T_BOUND * t.abs(), "row {}: {line}\nfound {found:?}, error {error:e}", row + 1);
            }
            right += 1;
        } else {
            below += 1;
            wrong_below += usize::from(!agrees);
        }
    }
    println!("{right} rows right; {below} below the bound or exactly on an edge, of which {wrong_below} differ");
    assert!(right > 1000);
}

/// The distance from the line to the nearest edge of the triangle in sheared space, over the farthest coordinate from
/// the origin: below a few roundings of the sheared coordinates the answer may be either.
fn margin(ray: &Ray, corners: [Vec3f; 3]) -> f64 {
    let (o, d) = (ray.origin.to_f64(), ray.direction.to_f64());
    let axis = (0..3).max_by(|&a, &b| d[a].abs().total_cmp(&d[b].abs())).expect("three axes");
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let relative = corners.map(|c| c.to_f64() - o);
    let sheared = relative.map(|p| (p[x] - d[x] / d[axis] * p[axis], p[y] - d[y] / d[axis] * p[axis]));
    let far = relative.iter().map(|p| p.abs().max_component()).fold(0.0, f64::max);
    let distance = |a: (f64, f64), b: (f64, f64)| {
        let length = ((b.0 - a.0) * (b.0 - a.0) + (b.1 - a.1) * (b.1 - a.1)).sqrt();
        (a.0 * b.1 - a.1 * b.0).abs() / length
    };
    let [a, b, c] = sheared;
    distance(a, b).min(distance(b, c)).min(distance(c, a)) / far
}
