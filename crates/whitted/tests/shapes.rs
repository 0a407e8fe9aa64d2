//! Discs, boxes, cylinders, cones and planes: crossings, bounds and surface points against their definitions.

use whitted::geometry::{Boxed, Cone, Cylinder, Disc, Plane, Shape};
use whitted::math::{Aabb, SplitMix64, Vec3d, Vec3f};
use whitted::ray::Ray;

fn vector(random: &mut SplitMix64, size: f64) -> Vec3d {
    Vec3d::new(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size))
}

fn unit(random: &mut SplitMix64) -> Vec3d {
    loop {
        let v = vector(random, 1.0);
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

/// A random shape of about size 1 around the origin.
fn shape(random: &mut SplitMix64) -> Shape {
    let (base, apex, capped) = (vector(random, 1.0), vector(random, 1.0), random.below(2) == 0);
    let radius = random.uniform(0.05, 1.0);
    match random.below(6) {
        0 => Shape::Disc(Disc { center: base, normal: apex, radius, inner_radius: 0.0 }),
        1 => Shape::Disc(Disc { center: base, normal: apex, radius, inner_radius: radius * random.next_f64() }),
        2 => Shape::Boxed(Boxed { lo: base.min(apex), hi: base.max(apex) }),
        3 => Shape::Cylinder(Cylinder { base, apex, radius, capped }),
        4 => Shape::Cone(Cone { base, apex, base_radius: radius, apex_radius: 0.0, capped }),
        _ => Shape::Cone(Cone { base, apex, base_radius: radius, apex_radius: random.next_f64(), capped }),
    }
}

/// `shape` scaled by `scale`, then moved by `by`.
fn placed(shape: &Shape, scale: f64, by: Vec3d) -> Shape {
    let p = |a: Vec3d| a * scale + by;
    match *shape {
        Shape::Disc(d) => Shape::Disc(Disc {
            center: p(d.center),
            normal: d.normal * scale,
            radius: d.radius * scale,
            inner_radius: d.inner_radius * scale,
        }),
        Shape::Boxed(b) => Shape::Boxed(Boxed { lo: p(b.lo), hi: p(b.hi) }),
        Shape::Cylinder(c) => {
            Shape::Cylinder(Cylinder { base: p(c.base), apex: p(c.apex), radius: c.radius * scale, ..c })
        }
        Shape::Cone(c) => Shape::Cone(Cone {
            base: p(c.base),
            apex: p(c.apex),
            base_radius: c.base_radius * scale,
            apex_radius: c.apex_radius * scale,
            ..c
        }),
    }
}

/// Height and distance from the axis, as written in a textbook.
fn axial(base: Vec3d, apex: Vec3d, p: Vec3d) -> (f64, f64, f64) {
    let height = (apex - base).length();
    let axis = (apex - base) / height;
    let at = (p - base).dot(axis);
    (at, height, (p - base - axis * at).length())
}

/// A function of space that changes its sign at the side of a round shape, with where on it the surface lies.
fn side(shape: &Shape, p: Vec3d) -> Option<(f64, bool)> {
    let (base, apex, r0, r1) = match *shape {
        Shape::Cylinder(c) => (c.base, c.apex, c.radius, c.radius),
        Shape::Cone(c) => (c.base, c.apex, c.base_radius, c.apex_radius),
        Shape::Disc(_) | Shape::Boxed(_) => return None,
    };
    let (at, height, distance) = axial(base, apex, p);
    Some((distance - (r0 + (r1 - r0) * at / height), 0.0 < at && at < height))
}

/// True inside a solid (a flat or open shape has no inside).
fn inside(shape: &Shape, p: Vec3d) -> bool {
    match shape {
        Shape::Disc(_) => false,
        Shape::Boxed(b) => p.min(b.hi).max(b.lo) == p,
        Shape::Cylinder(Cylinder { capped, .. }) | Shape::Cone(Cone { capped, .. }) => {
            side(shape, p).is_some_and(|(value, between)| *capped && between && value < 0.0)
        }
    }
}

/// How far `p` is from lying on the surface, in scene units: 0 if it satisfies the definition.
fn residual(shape: &Shape, p: Vec3d) -> f64 {
    let beyond = |value: f64, lo: f64, hi: f64| (lo - value).max(value - hi).max(0.0);
    let round = |base: Vec3d, apex: Vec3d, r0: f64, r1: f64, capped: bool| {
        let (at, height, distance) = axial(base, apex, p);
        let side = (distance - (r0 + (r1 - r0) * (at / height).clamp(0.0, 1.0))).abs().max(beyond(at, 0.0, height));
        let cap = |at_end: f64, radius: f64| (at - at_end).abs().max(beyond(distance, 0.0, radius));
        if capped { side.min(cap(0.0, r0)).min(cap(height, r1)) } else { side }
    };
    match *shape {
        Shape::Disc(d) => {
            let offset = p - d.center;
            let above = offset.dot(d.normal.normalize());
            let along = (offset - d.normal.normalize() * above).length();
            above.abs().max(beyond(along, d.inner_radius, d.radius))
        }
        Shape::Boxed(b) => {
            let outside = (b.lo - p).max(p - b.hi).max_component().max(0.0);
            let to_face = (b.lo - p).abs().min((p - b.hi).abs()).min_component();
            outside.max(to_face)
        }
        Shape::Cylinder(c) => round(c.base, c.apex, c.radius, c.radius, c.capped),
        Shape::Cone(c) => round(c.base, c.apex, c.base_radius, c.apex_radius, c.capped),
    }
}

fn in_bounds(bounds: &Aabb, p: Vec3d, slack: f64) -> bool {
    (0..3).all(|i| f64::from(bounds.lo[i]) - slack <= p[i] && p[i] <= f64::from(bounds.hi[i]) + slack)
}

/// Origins near and far, directions of all lengths, a third of them along an axis or plane.
fn line(random: &mut SplitMix64, shape: &Shape) -> (Vec3d, Vec3d) {
    let target = vector(random, 1.0);
    let mut direction = unit(random);
    match random.below(6) {
        0 => direction = Vec3d::new(0.0, 0.0, -1.0),
        1 => {
            if let Shape::Cylinder(Cylinder { base, apex, .. }) | Shape::Cone(Cone { base, apex, .. }) = shape {
                direction = (*apex - *base).normalize();
            }
        }
        _ => {}
    }
    let distance = [0.0, 3.0, 1000.0][random.below(3) as usize];
    (target - direction * distance, direction * [1.0, 1e-6, 1e6][random.below(3) as usize])
}

#[test]
fn crossings_lie_on_the_surface_and_in_the_bounds() {
    let mut random = SplitMix64::new(1);
    let mut crossed = 0;
    for _ in 0..200_000 {
        let shape = shape(&mut random);
        let (origin, direction) = line(&mut random, &shape);
        let crossings = shape.crossings(origin, direction);
        assert!(crossings.as_slice().is_sorted());
        for &t in crossings.as_slice() {
            let p = origin + direction * t;
            // Relative to the distance from the origin of the ray, which is at most 1000.
            let slack = 1e-9 * (1.0 + origin.length() / 10.0);
            assert!(residual(&shape, p) < slack, "{} for {shape:?} from {origin:?}", residual(&shape, p));
            assert!(in_bounds(&shape.bounds(), p, slack), "{shape:?} at {p:?}");
            crossed += 1;
        }
    }
    assert!(crossed > 50_000, "only {crossed} crossings: the test tests nothing");
}

#[test]
fn dense_sampling_finds_no_missed_crossing() {
    const STEPS: u32 = 1000;
    let mut random = SplitMix64::new(2);
    let mut changes = 0;
    for _ in 0..6000 {
        let shape = shape(&mut random);
        let direction = unit(&mut random);
        let origin = vector(&mut random, 1.0) - direction * 4.0;
        let crossings = shape.crossings(origin, direction);
        let at = |step: u32| 8.0 * f64::from(step) / f64::from(STEPS);
        for step in 0..STEPS {
            let (t0, t1) = (at(step), at(step + 1));
            let (p0, p1) = (origin + direction * t0, origin + direction * t1);
            // A solid is entered or left, an open side is passed between its ends, or a plate is pierced.
            let open_side = !inside(&shape, p0) && !inside(&shape, p1) && !solid(&shape);
            let passed = match (side(&shape, p0), side(&shape, p1)) {
                (Some((a, true)), Some((b, true))) => open_side && (a < 0.0) != (b < 0.0),
                _ => pierced(&shape, p0, p1),
            };
            if passed || inside(&shape, p0) != inside(&shape, p1) {
                changes += 1;
                let slack = 1e-9;
                let found = crossings.as_slice().iter().any(|&t| t0 - slack <= t && t <= t1 + slack);
                assert!(found, "{shape:?} between {t0} and {t1} from {origin:?} along {direction:?}: {crossings:?}");
            }
        }
    }
    assert!(changes > 1000, "only {changes} changes: the test tests nothing");
}

fn solid(shape: &Shape) -> bool {
    match shape {
        Shape::Disc(_) => false,
        Shape::Boxed(_) => true,
        Shape::Cylinder(Cylinder { capped, .. }) | Shape::Cone(Cone { capped, .. }) => *capped,
    }
}

/// True if the segment passes the plate of a disc, well away from its rims.
fn pierced(shape: &Shape, p0: Vec3d, p1: Vec3d) -> bool {
    let Shape::Disc(d) = shape else { return false };
    let (a, b) = ((p0 - d.center).dot(d.normal), (p1 - d.center).dot(d.normal));
    let distance = ((p0 + p1) * 0.5 - d.center).length();
    (a < 0.0) != (b < 0.0) && d.inner_radius + 0.01 < distance && distance < d.radius - 0.01
}

#[test]
fn surface_points_are_projections_with_outward_unit_normals() {
    let mut random = SplitMix64::new(3);
    for _ in 0..100_000 {
        let shape = shape(&mut random);
        let (origin, direction) = line(&mut random, &shape);
        for &t in shape.crossings(origin, direction).as_slice() {
            let p = origin + direction * t;
            let point = shape.surface(p + vector(&mut random, 1e-7));
            assert!((point.normal.length() - 1.0).abs() < 1e-14);
            assert!((point.position - p).length() < 1e-6, "{shape:?}: {p:?} became {point:?}");
            assert!(point.uv.iter().all(|c| (-1e-6..=1.0 + 1e-6).contains(c)), "{shape:?}: {point:?}");
            // Beyond the rim of an open shape the projection continues its side.
            assert!(residual(&shape, point.position) < 3e-7, "{shape:?}: {point:?}");
            if solid(&shape) {
                let step = point.normal * 1e-5;
                assert!(!inside(&shape, point.position + step), "{shape:?}: {point:?}");
                // A step inward stays inside except where the solid is thinner than it, near a rim or an apex.
                let inward = inside(&shape, point.position - step);
                assert!(inward || thin(&shape, point.position), "{shape:?}: {point:?}");
            }
        }
    }
}

/// True near a rim or apex, where a small step inward may leave the solid on another side.
fn thin(shape: &Shape, p: Vec3d) -> bool {
    const NEAR: f64 = 1e-3;
    match *shape {
        Shape::Disc(_) => true,
        Shape::Boxed(b) => {
            (b.hi - b.lo).min_component() < NEAR || {
                let to_face = (b.lo - p).abs().min((p - b.hi).abs()).to_array();
                to_face.iter().filter(|&&d| d < NEAR).count() > 1
            }
        }
        Shape::Cylinder(Cylinder { base, apex, .. }) | Shape::Cone(Cone { base, apex, .. }) => {
            let (at, height, distance) = axial(base, apex, p);
            let at_side = side(shape, p).is_some_and(|(value, _)| value.abs() < NEAR);
            height < NEAR || distance < NEAR || (at_side && (at < NEAR || height - at < NEAR))
        }
    }
}

#[test]
fn surface_points_of_rays_are_within_their_error() {
    let mut random = SplitMix64::new(4);
    for _ in 0..50_000 {
        let shape = shape(&mut random);
        let (origin, direction) = line(&mut random, &shape);
        let ray = Ray::new(origin.to_f32(), direction.to_f32());
        for &t in shape.crossings(ray.origin.to_f64(), ray.direction.to_f64()).as_slice() {
            let point = shape.surface_point(&ray, t as f32);
            assert!(point.error > 0.0 && point.error < 1e-5);
            let distance = residual(&shape, point.position.to_f64());
            // The offset itself is rounded again by as much as the position is.
            assert!(distance <= f64::from(point.error) / 2.0 || thin(&shape, point.position.to_f64()), "{shape:?}");
            assert!((point.n_g.length() - 1.0).abs() < 1e-6 && point.n_g == point.n_s);
        }
    }
}

#[test]
fn any_size_and_place() {
    let mut random = SplitMix64::new(5);
    for _ in 0..20_000 {
        let unit_shape = shape(&mut random);
        let scale = [1e-12, 1e-6, 1e6, 1e12][random.below(4) as usize];
        let by = vector(&mut random, 10.0) * scale;
        let shape = placed(&unit_shape, scale, by);
        assert!(!shape.is_degenerate(), "{shape:?}");
        let (origin, direction) = line(&mut random, &unit_shape);
        let (origin, direction) = (origin * scale + by, direction);
        let expected = unit_shape.crossings((origin - by) / scale, direction);
        let crossings = shape.crossings(origin, direction);
        for &t in crossings.as_slice() {
            let p = origin + direction * t;
            assert!(residual(&shape, p) < 1e-7 * scale, "{shape:?} at {p:?}");
        }
        // Only a touching line may be seen otherwise.
        if crossings.as_slice().len() != expected.as_slice().len() {
            let all = [crossings.as_slice(), expected.as_slice()].concat();
            let touching = all.windows(2).any(|t| (t[1] - t[0]).abs() * direction.length() < 1e-4 * scale.max(1.0));
            let along = !all.is_empty() && residual_along(&unit_shape, (origin - by) / scale, direction) < 1e-4;
            assert!(touching || along, "{shape:?}: {crossings:?} for {expected:?}");
        }
    }
}

/// The smallest distance from a rim, for lines that graze one.
fn residual_along(shape: &Shape, origin: Vec3d, direction: Vec3d) -> f64 {
    let distances = shape.crossings(origin, direction);
    let near_rim = |p: Vec3d| match *shape {
        Shape::Disc(d) => {
            let distance = (p - d.center).length();
            (distance - d.radius).abs().min((distance - d.inner_radius).abs())
        }
        Shape::Boxed(_) => f64::INFINITY,
        Shape::Cylinder(Cylinder { base, apex, .. }) | Shape::Cone(Cone { base, apex, .. }) => {
            let (at, height, _) = axial(base, apex, p);
            at.abs().min((height - at).abs())
        }
    };
    distances.as_slice().iter().map(|&t| near_rim(origin + direction * t)).fold(f64::INFINITY, f64::min)
}

#[test]
fn degenerate_shapes_say_so_and_are_never_hit() {
    let (o, x, nan, inf) = (Vec3d::ZERO, Vec3d::new(1.0, 0.0, 0.0), f64::NAN, f64::INFINITY);
    let disc = Disc { center: o, normal: x, radius: 1.0, inner_radius: 0.0 };
    let tube = Cylinder { base: o, apex: x, radius: 1.0, capped: true };
    let cone = Cone { base: o, apex: x, base_radius: 1.0, apex_radius: 0.0, capped: true };
    let boxed = Boxed { lo: o, hi: Vec3d::ONE };
    let mut bad = Vec::new();
    for value in [0.0, -1.0, nan, inf, 1e39] {
        bad.push(Shape::Disc(Disc { radius: value, ..disc }));
        bad.push(Shape::Cylinder(Cylinder { radius: value, ..tube }));
        bad.push(Shape::Cone(Cone { base_radius: value, ..cone }));
    }
    for value in [nan, inf, -inf] {
        let point = Vec3d::new(0.0, value, 0.0);
        bad.push(Shape::Disc(Disc { center: point, ..disc }));
        bad.push(Shape::Disc(Disc { normal: point, ..disc }));
        bad.push(Shape::Cylinder(Cylinder { base: point, ..tube }));
        bad.push(Shape::Cone(Cone { apex: point, ..cone }));
        bad.push(Shape::Boxed(Boxed { hi: point, ..boxed }));
    }
    bad.extend([
        Shape::Disc(Disc { normal: o, ..disc }),
        Shape::Disc(Disc { inner_radius: 1.0, ..disc }),
        Shape::Disc(Disc { inner_radius: -0.5, ..disc }),
        Shape::Disc(Disc { inner_radius: nan, ..disc }),
        Shape::Cylinder(Cylinder { apex: o, ..tube }),
        Shape::Cylinder(Cylinder { apex: x * 1e-9, ..tube }),
        Shape::Cone(Cone { apex: o, ..cone }),
        Shape::Cone(Cone { apex_radius: -0.1, ..cone }),
        Shape::Cone(Cone { apex_radius: nan, ..cone }),
        Shape::Boxed(Boxed { lo: x, ..boxed }),
        Shape::Boxed(Boxed { lo: x, hi: x }),
        Shape::Boxed(Boxed { lo: Vec3d::ONE, hi: o }),
    ]);
    // Of these only the box that is flat along one axis, a rectangle, is not degenerate.
    let good = bad.iter().filter(|shape| !shape.is_degenerate()).collect::<Vec<_>>();
    assert_eq!(good, [&Shape::Boxed(Boxed { lo: x, ..boxed })]);
    for shape in &bad {
        for (origin, direction) in [(o, x), (Vec3d::splat(0.5), x), (x * 3.0, -x), (o, o), (Vec3d::splat(nan), x)] {
            assert!(shape.crossings(origin, direction).as_slice().iter().all(|t| t.is_finite()), "{shape:?}");
        }
    }
}

#[test]
fn lines_that_are_none_cross_nothing() {
    let mut random = SplitMix64::new(6);
    let nan = Vec3d::splat(f64::NAN);
    for _ in 0..1000 {
        let shape = shape(&mut random);
        let p = vector(&mut random, 0.1);
        for (origin, direction) in [(p, Vec3d::ZERO), (nan, p), (p, nan)] {
            assert_eq!(shape.crossings(origin, direction).as_slice(), &[0.0; 0], "{shape:?}");
        }
    }
}

#[test]
fn bounds_are_tight() {
    let half = 0.5_f64.sqrt();
    let tilted = Vec3d::new(1.0, 1.0, 0.0);
    let disc = Shape::Disc(Disc { center: Vec3d::ZERO, normal: tilted, radius: 2.0, inner_radius: 0.0 });
    let reach = (2.0 * half) as f32;
    let (lo, hi) = (disc.bounds().lo, disc.bounds().hi);
    assert_eq!(hi, -lo);
    assert!((hi - Vec3f::new(reach, reach, 2.0)).abs().max_component() < 3e-7, "{hi:?}");
    let upright =
        Cone { base: Vec3d::ZERO, apex: Vec3d::new(0.0, 3.0, 0.0), base_radius: 1.0, apex_radius: 0.25, capped: false };
    let expected = Aabb::new(Vec3f::new(-1.0, 0.0, -1.0), Vec3f::new(1.0, 3.0, 1.0));
    assert_eq!(Shape::Cone(upright).bounds(), expected);
}

#[test]
fn the_inside_of_a_box_holds_no_surface() {
    let shape = Shape::Boxed(Boxed { lo: Vec3d::ZERO, hi: Vec3d::ONE });
    let cube = |lo: f32, hi: f32| Aabb::new(Vec3f::splat(lo), Vec3f::splat(hi));
    assert!(shape.clipped_bounds(&cube(0.25, 0.75)).is_empty());
    assert_eq!(shape.clipped_bounds(&cube(0.25, 1.0)), cube(0.25, 1.0));
    assert_eq!(shape.clipped_bounds(&cube(-1.0, 0.5)), cube(0.0, 0.5));
}

#[test]
fn a_box_is_left_by_its_far_face() {
    let shape = Shape::Boxed(Boxed { lo: Vec3d::ZERO, hi: Vec3d::ONE });
    let crossings = shape.crossings(Vec3d::splat(0.5), Vec3d::new(0.0, 2.0, 0.0));
    assert_eq!(crossings.as_slice(), [-0.25, 0.25]);
    assert_eq!(shape.surface(Vec3d::new(0.5, 1.0, 0.5)).normal, Vec3d::new(0.0, 1.0, 0.0));
}

/// `worked_examples.json`: the double cone x² + z² = y², of which a frustum holds the upper half.
#[test]
fn published_cone_examples() {
    let cone = Cone {
        base: Vec3d::new(0.0, -10.0, 0.0),
        apex: Vec3d::ZERO,
        base_radius: 10.0,
        apex_radius: 0.0,
        capped: false,
    };
    let upper =
        Cone { base: Vec3d::ZERO, apex: Vec3d::new(0.0, 10.0, 0.0), base_radius: 0.0, apex_radius: 10.0, ..cone };
    let touching = upper.crossings(Vec3d::new(0.0, 0.0, -5.0), Vec3d::ONE);
    assert_eq!(touching.as_slice(), [5.0, 5.0]);
    assert!((5.0 * Vec3d::ONE.length() - 8.660254037844386).abs() < 1e-12);
    // Parallel to one half of the double cone: only the other half is met, once.
    let parallel = Vec3d::new(0.0, 1.0, 1.0).normalize();
    let lower_t = cone.crossings(Vec3d::new(0.0, 0.0, -1.0), parallel);
    let upper_t = upper.crossings(Vec3d::new(0.0, 0.0, -1.0), parallel);
    let all = [lower_t.as_slice(), upper_t.as_slice()].concat();
    let [t] = all[..] else { panic!("{all:?}") };
    // The published 0.3535… is half the root of 2·half_b·t + c = 0: the point there, (0, 0.25, −0.75), is not on the cone.
    assert!((t - 2.0 * 0.3535533905932738).abs() < 1e-12, "{t}");
}

#[test]
fn planes() {
    let plane = Plane { point: Vec3d::new(0.0, 2.0, 0.0), normal: Vec3d::new(0.0, 5.0, 0.0) };
    let down = Vec3d::new(1.0, -1.0, 0.0);
    assert_eq!(plane.crossings(Vec3d::new(0.0, 5.0, 0.0), down).as_slice(), [3.0]);
    for direction in [Vec3d::new(1.0, 0.0, 0.0), Vec3d::ZERO, Vec3d::splat(f64::NAN)] {
        assert!(plane.crossings(Vec3d::ZERO, direction).as_slice().is_empty());
        assert!(plane.crossings(plane.point, direction).as_slice().is_empty());
    }
    let point = plane.surface_point(&Ray::new(Vec3f::new(0.0, 5.0, 0.0), down.to_f32()), 3.0);
    assert_eq!((point.position, point.n_g), (Vec3f::new(3.0, 2.0, 0.0), Vec3f::new(0.0, 1.0, 0.0)));
    assert!(point.error > 0.0 && point.error < 1e-6);
    assert!(!plane.is_degenerate());
    assert!(Plane { normal: Vec3d::ZERO, ..plane }.is_degenerate());
    assert!(Plane { point: Vec3d::splat(f64::INFINITY), ..plane }.is_degenerate());
    assert!(Plane { normal: Vec3d::splat(1e-200), ..plane }.is_degenerate());
}
