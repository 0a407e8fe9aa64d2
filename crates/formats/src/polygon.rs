//! Cutting flat polygons into triangles.

use whitted::math::Vec3d;

/// Work allowed for all polygons of a file, in corners looked at: cutting a concave polygon takes time that can grow
/// with the cube of its corners. This is some seconds, thousands of times what scenes need.
pub(crate) const WORK: u64 = 2_000_000_000;

/// Give `emit` the corner numbers of `corners.len() − 2` triangles that cover the polygon and turn like it: a fan from
/// the first corner if the polygon is convex, else ears cut off one by one. A polygon without area, or one that crosses
/// itself, gives that many triangles too.
///
/// False if the work exceeds `work`, which is lessened by what was done.
#[must_use]
pub(crate) fn triangulate(corners: &[Vec3d], work: &mut u64, mut emit: impl FnMut([usize; 3])) -> bool {
    let flat = flatten(corners);
    let n = flat.len();
    let convex = (0..n).all(|i| turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) >= 0.0);
    if n > 3 && !convex {
        return cut_ears(&flat, work, emit);
    }
    (2..n).for_each(|i| emit([0, i - 1, i]));
    true
}

/// The polygon seen against its normal along the axis where it is broadest, counter-clockwise.
fn flatten(corners: &[Vec3d]) -> Vec<[f64; 2]> {
    let Some(&first) = corners.first() else { return Vec::new() };
    // Twice the area, as a vector (Newell's normal); relative to a corner, or far polygons would lose it to rounding.
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let normal = edges.fold(Vec3d::ZERO, |sum, (&a, &b)| sum + (a - first).cross(b - first));
    let size = normal.abs();
    let pick = |p: Vec3d| match () {
        () if size.x >= size.y && size.x >= size.z => [p.y, p.z * normal.x.signum()],
        () if size.y >= size.z => [p.z, p.x * normal.y.signum()],
        () => [p.x, p.y * normal.z.signum()],
    };
    corners.iter().map(|&p| pick(p - first)).collect()
}

/// Twice the area of the triangle `a b c`: positive if it turns left.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Cut ears off (Meisters 1975): a corner is one if it turns left and no other corner lies in its triangle.
fn cut_ears(flat: &[[f64; 2]], work: &mut u64, mut emit: impl FnMut([usize; 3])) -> bool {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    // Where to look for the next ear: with the corner after the last one, a spiral of 1000 corners takes 25 tries per
    // ear; with the one after that, 92.
    let mut at = 0;
    while left.len() > 3 {
        let n = left.len();
        let corner = |i: usize| [left[(i + n - 1) % n], left[i % n], left[(i + 1) % n]];
        let ear = (at..at + n).find(|&i| {
            *work = work.saturating_sub(n as u64);
            *work == 0 || is_ear(flat, &left, corner(i))
        });
        if *work == 0 {
            return false;
        }
        let Some(ear) = ear else { break };
        emit(corner(ear));
        left.remove(ear % n);
        at = ear % left.len();
    }
    // A triangle, or what has no ear because it crosses itself or has no area.
    (2..left.len()).for_each(|i| emit([left[0], left[i - 1], left[i]]));
    true
}

fn is_ear(flat: &[[f64; 2]], left: &[usize], [a, b, c]: [usize; 3]) -> bool {
    let [pa, pb, pc] = [flat[a], flat[b], flat[c]];
    let area = turn(pa, pb, pc);
    // A corner in a straight line, which cuts off nothing, can go at once; a spike back cannot.
    if area <= 0.0 {
        let ahead = (pc[0] - pb[0]) * (pb[0] - pa[0]) + (pc[1] - pb[1]) * (pb[1] - pa[1]) > 0.0;
        return area == 0.0 && ahead;
    }
    let inside = |&p: &usize| {
        let q = flat[p];
        ![a, b, c].contains(&p)
            && ![pa, pb, pc].contains(&q)
            && turn(pa, pb, q) >= 0.0
            && turn(pb, pc, q) >= 0.0
            && turn(pc, pa, q) >= 0.0
    };
    !left.iter().any(inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(points: &[[f64; 2]]) -> (Vec<[usize; 3]>, f64) {
        // In a tilted plane, so that the choice of axes is tested too.
        let corners: Vec<Vec3d> = points.iter().map(|p| Vec3d::new(p[0], p[1], 0.3 * p[0] - 2.0 * p[1])).collect();
        let mut triangles = Vec::new();
        assert!(triangulate(&corners, &mut { WORK }, |t| triangles.push(t)));
        let area = triangles.iter().map(|t| turn(points[t[0]], points[t[1]], points[t[2]]) / 2.0).sum();
        (triangles, area)
    }

    #[test]
    fn convex_polygons_become_fans() {
        let (triangles, area) = cut(&[[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [0.0, 2.0]]);
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(area, 4.0);
    }

    #[test]
    fn the_notch_of_a_concave_polygon_stays_open() {
        let (triangles, area) = cut(&[[-1.0, -1.0], [1.0, -1.0], [0.0, 0.0], [1.0, 1.0], [-1.0, 1.0]]);
        assert_eq!((triangles.len(), area), (3, 3.0));
        let points = [[-1.0, -1.0], [1.0, -1.0], [0.0, 0.0], [1.0, 1.0], [-1.0, 1.0]];
        let covers = |t: &[usize; 3], q| (0..3).all(|i| turn(points[t[i]], points[t[(i + 1) % 3]], q) > 0.0);
        assert!(!triangles.iter().any(|t| covers(t, [0.7, 0.01])));
        assert!(triangles.iter().any(|t| covers(t, [-0.7, 0.01])));
    }

    #[test]
    fn a_comb_is_covered_exactly() {
        let mut points = vec![[0.0, 0.0]];
        (0..50).for_each(|i| points.extend([[f64::from(i) + 0.5, 0.1], [f64::from(i) + 1.0, 0.0]]));
        points.extend([[50.0, 1.0], [0.0, 1.0]]);
        let (triangles, area) = cut(&points);
        assert_eq!(triangles.len(), points.len() - 2);
        assert!((area - 47.5).abs() < 1e-9, "{area}");
    }

    #[test]
    fn a_spiral_is_covered_exactly() {
        let spiral = |turns: f64, gap: f64| {
            let (radius, angle) = (1.0 + turns + gap, turns * std::f64::consts::TAU);
            [radius * angle.cos(), radius * angle.sin()]
        };
        let steps = || (0..500).map(|i| f64::from(i) / 50.0);
        let points: Vec<_> = steps().map(|t| spiral(t, 0.5)).chain(steps().rev().map(|t| spiral(t, 0.0))).collect();
        let n = points.len();
        let area: f64 = (1..n - 1).map(|i| turn(points[0], points[i], points[i + 1]) / 2.0).sum();
        let (triangles, covered) = cut(&points);
        assert_eq!(triangles.len(), n - 2);
        assert!((covered - area).abs() < 1e-9, "{covered} {area}");
        assert!(triangles.iter().all(|t| turn(points[t[0]], points[t[1]], points[t[2]]) >= 0.0));
    }

    #[test]
    fn work_is_bounded() {
        let star = |i: u32| {
            let (radius, angle) = (f64::from(1 + i % 2), f64::from(i) / 200.0);
            Vec3d::new(radius * angle.cos(), radius * angle.sin(), 0.0)
        };
        let corners: Vec<Vec3d> = (0..1000).map(star).collect();
        assert!(!triangulate(&corners, &mut 1000, |_| {}));
    }

    #[test]
    fn polygons_without_area_end() {
        assert_eq!(cut(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.5, 0.5], [0.0, 0.0]]).0.len(), 3);
        assert_eq!(cut(&[[1.0, 1.0]; 7]).0.len(), 5);
        assert_eq!(cut(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]).0.len(), 2);
    }
}
