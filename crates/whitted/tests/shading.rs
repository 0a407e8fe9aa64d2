//! Optics, local models, lights and textures against published and recomputed numbers.

use serde_json::Value;
use simd::{F32Lanes, Kernel, Level, Simd};
use whitted::math::{SplitMix64, Vec3, Vec3d, Vec3f};
use whitted::scene::{Light, LightKind};
use whitted::shading::{
    self, LocalSurface, Material, PreparedLight, PreparedMaterial, PreparedTexture, Reflectance, SpecularModel,
    Texture, fresnel, lanes, mirrored, refracted, schlick,
};

/// A file of `material/numbers`, if the environment says where it is.
fn numbers(file: &str) -> Option<Value> {
    let Some(shared) = std::env::var_os("WHITTED_SHARED") else {
        eprintln!("SKIPPED: WHITTED_SHARED is not set, so {file} was not checked");
        return None;
    };
    let path = std::path::Path::new(&shared).join("material/numbers").join(file);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    Some(serde_json::from_str(&text).expect("JSON"))
}

fn rows<'a>(numbers: &'a Value, table: &str) -> &'a [Value] {
    numbers[table].as_array().unwrap_or_else(|| panic!("no table {table}"))
}

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or_else(|| panic!("no number {key} in {row}"))
}

fn vector(value: &Value) -> Vec3d {
    let component = |i: usize| value[i].as_f64().expect("three numbers");
    Vec3::new(component(0), component(1), component(2))
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &dyn std::fmt::Debug) {
    assert!((found - expected).abs() <= tolerance, "{found} instead of {expected} for {what:?}");
}

fn near(a: Vec3f, b: Vec3d, tolerance: f64) -> bool {
    (a.to_f64() - b).abs().max_component() <= tolerance
}

/// A material without ambient light that has a diffuse part and a highlight.
fn shiny(diffuse: f32, specular: f32, exponent: f32, specular_model: SpecularModel) -> PreparedMaterial {
    let specular = Vec3f::splat(specular);
    prepared(&Material { ambient: 0.0, diffuse, specular, exponent, specular_model, ..Material::default() })
}

fn prepared(material: &Material) -> PreparedMaterial {
    assert_eq!(material.fault(), None);
    PreparedMaterial::new(material, Vec3d::ZERO, 1.0)
}

/// Direction at `degrees` from +z in the x, z plane.
fn at_angle(degrees: f64) -> Vec3f {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec3d::new(sin, 0.0, cos).to_f32()
}

const UP: Vec3f = Vec3f::new(0.0, 0.0, 1.0);

/// Reflectances are sums of a few products: errors of some ulp, magnified near the critical angle.
const REFLECTANCE: f64 = 2e-6;

#[test]
fn reflectances() {
    let Some(numbers) = numbers("analytic.json") else { return };
    for row in rows(&numbers, "fresnel_unpolarised") {
        let eta = (number(row, "n1") / number(row, "n2")) as f32;
        let cos = number(row, "angle").to_radians().cos() as f32;
        assert_near(fresnel(cos, eta).into(), number(row, "exact_R"), REFLECTANCE, row);
        assert_near(schlick(cos, eta).into(), number(row, "schlick_R"), REFLECTANCE, row);
    }
    for row in rows(&numbers, "critical_and_brewster") {
        let n = number(row, "n") as f32;
        for (eta, model) in [(n, fresnel as fn(f32, f32) -> f32), (1.0 / n, fresnel), (n, schlick), (1.0 / n, schlick)]
        {
            assert_near(model(1.0, eta).into(), number(row, "R0"), REFLECTANCE, row);
        }
        let critical = number(row, "critical_from_inside");
        for (angle, total) in [(critical - 1e-3, false), (critical + 1e-3, true)] {
            let incident = -at_angle(angle);
            let cos = -incident.dot(UP);
            assert_eq!(refracted(incident, UP, n).is_none(), total, "{row} at {angle}");
            assert_eq!((fresnel(cos, n) == 1.0, schlick(cos, n) == 1.0), (total, total), "{row} at {angle}");
        }
        // At Brewster's angle only one of the two polarisations is reflected.
        let cos_i = number(row, "brewster_from_outside").to_radians().cos();
        let cos_t = (1.0 - (1.0 - cos_i * cos_i) / f64::from(n * n)).sqrt();
        let s = (cos_i - f64::from(n) * cos_t) / (cos_i + f64::from(n) * cos_t);
        assert_near(fresnel(cos_i as f32, 1.0 / n).into(), 0.5 * s * s, REFLECTANCE, row);
    }
}

#[test]
fn reflectances_have_no_poles() {
    for eta in [0.3, 0.75, 1.0, 1.5, 4.0] {
        let mut previous = f32::INFINITY;
        for step in 0..=1000 {
            let cos = step as f32 / 1000.0;
            for r in [fresnel(cos, eta), schlick(cos, eta)] {
                assert!((0.0..=1.0).contains(&r), "{r} at {cos}, {eta}");
            }
            let falling = schlick(cos, eta);
            assert!(falling <= previous, "{falling} > {previous} at {cos}, {eta}");
            previous = falling;
        }
        let grazing = if eta == 1.0 { 0.0 } else { 1.0 };
        assert_eq!(fresnel(0.0, eta), grazing);
    }
}

#[test]
fn directions() {
    let Some(numbers) = numbers("analytic.json") else { return };
    for row in rows(&numbers, "reflect_refract_vectors") {
        let (incident, normal) = (vector(&row["dir"]).to_f32(), vector(&row["normal"]).to_f32());
        let eta = number(row, "eta_from_over_to") as f32;
        assert!(near(mirrored(incident, normal), vector(&row["reflected"]), 1e-6), "{row}");
        let refracted = refracted(incident, normal, eta);
        assert_eq!(refracted.is_none(), row["refracted"].is_null(), "{row}");
        if let Some(refracted) = refracted {
            assert!(near(refracted, vector(&row["refracted"]), 2e-6), "{row}");
        }
    }
}

/// A ray's way through a ball of radius 1.
struct Through {
    /// Angles turned at each event, in degrees.
    turns: Vec<f64>,
    /// First way from wall to wall.
    inside: f64,
    /// Where and in which direction the ray leaves after the first way.
    exit: (Vec3d, Vec3d),
}

/// Into a ball of index `n` at a distance `impact` from the axis, with `reflections` inside.
fn through_ball(n: f64, impact: f64, reflections: usize) -> Through {
    let turn =
        |a: Vec3f, b: Vec3f| a.to_f64().cross(b.to_f64()).length().atan2(a.to_f64().dot(b.to_f64())).to_degrees();
    let entry = Vec3d::new(impact, 0.0, -(1.0 - impact * impact).sqrt());
    let incident = UP;
    let mut direction =
        refracted(incident, entry.to_f32(), (1.0 / n) as f32).expect("no total reflection from outside");
    let mut turns = vec![turn(incident, direction)];
    let next = |p: Vec3d, d: Vec3f| p - d.to_f64().normalize() * (2.0 * p.dot(d.to_f64().normalize()));
    let mut position = next(entry, direction);
    let inside = (position - entry).length();
    let first_exit = refracted(direction, -position.to_f32(), n as f32).expect("no total reflection: entered by Snell");
    let exit = (position, first_exit.to_f64());
    for _ in 0..reflections {
        let reflected = mirrored(direction, -position.to_f32());
        turns.push(turn(direction, reflected));
        (position, direction) = (next(position, reflected), reflected);
    }
    let last = refracted(direction, -position.to_f32(), n as f32).expect("no total reflection: entered by Snell");
    turns.push(turn(direction, last));
    Through { turns, inside, exit }
}

#[test]
fn balls_of_glass() {
    let Some(numbers) = numbers("analytic.json") else { return };
    /// 10⁻⁶ radians at each of four events.
    const DEGREES: f64 = 2.5e-4;
    let deviations =
        ["deviation_two_refractions", "deviation_one_internal_reflection", "deviation_two_internal_reflections"];
    for row in rows(&numbers, "ray_through_glass_sphere") {
        let (n, impact) = (number(row, "n"), number(row, "impact_parameter_over_R"));
        for (reflections, key) in deviations.into_iter().enumerate() {
            let through = through_ball(n, impact, reflections);
            assert_near(through.turns.iter().sum(), number(row, key), DEGREES, row);
            assert_near(through.inside, number(row, "path_length_inside_over_R"), 1e-6, row);
        }
    }
    for row in rows(&numbers, "rainbow_minimum_deviation") {
        let deviation = |i: u32| through_ball(number(row, "n"), f64::from(i) / 1000.0, 1).turns.iter().sum::<f64>();
        let least = (1..1000).map(deviation).fold(f64::INFINITY, f64::min);
        // The impact parameter is within 1/2000 of that of the minimum, where the deviation is flat.
        assert_near(least, number(row, "primary"), 1e-3, row);
    }
    for row in rows(&numbers, "ball_lens_back_focal_length_paraxial") {
        let (position, direction) = through_ball(number(row, "n"), 0.01, 0).exit;
        let focus = position.z - position.x / direction.x * direction.z;
        // Aberration grows with the square of the distance from the axis.
        assert_near(focus, number(row, "from_centre"), 5e-4, row);
    }
}

#[test]
fn slabs_shift_rays() {
    let Some(numbers) = numbers("analytic.json") else { return };
    for row in rows(&numbers, "slab_lateral_shift") {
        let (n, thickness) = (number(row, "n"), number(row, "thickness"));
        let incident = -at_angle(number(row, "angle"));
        let inside = refracted(incident, UP, (1.0 / n) as f32).expect("enters");
        let leaving = refracted(inside, UP, n as f32).expect("leaves");
        assert!(near(leaving, incident.to_f64(), 1e-6), "{row}");
        let way = inside.to_f64() * (thickness / f64::from(-inside.z));
        assert_near(way.cross(incident.to_f64()).length(), number(row, "shift"), 1e-6, row);
    }
}

#[test]
fn mirrors_facing_each_other() {
    let Some(numbers) = numbers("analytic.json") else { return };
    for row in rows(&numbers, "parallel_mirrors") {
        let reflect = Vec3f::splat(number(row, "reflectivity") as f32);
        let mirror = prepared(&Material { reflect, ..Material::default() });
        let (mut weight, mut sum) = (1.0, 0.0);
        for _ in 0..number(row, "depth") as usize {
            sum += weight * number(row, "own_colour");
            weight *= f64::from(mirror.split(1.0, 1.0, true).0.x);
        }
        assert_near(sum, number(row, "colour"), 1e-6, row);
    }
}

#[test]
fn lambert() {
    let Some(numbers) = numbers("analytic.json") else { return };
    for row in rows(&numbers, "lambert_point_light") {
        let matte = shiny(number(row, "kd") as f32, 0.0, 1.0, SpecularModel::Phong);
        let light = PreparedLight::point(at_angle(number(row, "incidence")) * 7.0, Vec3f::ONE, false);
        let arriving = light.at(Vec3f::ZERO);
        let answer = matte.answer(Vec3f::ONE, UP, arriving.direction, UP).times(arriving.light);
        assert_near(answer.x.into(), number(row, "expected"), 1e-6, row);
    }
}

#[test]
fn worked_examples() {
    let Some(numbers) = numbers("worked_examples.json") else { return };
    let case = |name: &str| &numbers["cases"][name];
    let material = shiny(0.9, 0.9, 200.0, SpecularModel::Phong);
    let ambient = 0.1;
    for (name, angle) in [("Phong, eye and light straight on", 0.0), ("Phong, light 45 deg", 45.0)] {
        let answer = material.answer(Vec3f::ONE, UP, at_angle(angle), UP);
        assert!(near(answer + Vec3f::splat(ambient), vector(case(name)), 1e-6), "{name}: {answer:?}");
    }
    let behind = material.answer(Vec3f::ONE, UP, at_angle(180.0), UP) + Vec3f::splat(ambient);
    assert!(near(behind, vector(case("Phong, light behind")), 1e-7));

    let total = case("Schlick, total internal reflection: ray (0,0,sqrt2/2)->(0,1,0), 2nd hit").as_f64();
    assert_eq!(Some(f64::from(schlick(0.5_f32.sqrt(), 1.5))), total);
    let grazing = case("Schlick, grazing: ray (0,0.99,-2)->(0,0,1), 1st hit").as_f64().expect("a number");
    assert_near(schlick((1.0_f32 - 0.99 * 0.99).sqrt(), 1.0 / 1.5).into(), grazing, 1e-5, &"grazing");

    // The default world: the ray meets the outer ball at its nearest point.
    let (position, view) = (Vec3f::new(0.0, 0.0, -1.0), Vec3f::new(0.0, 0.0, -1.0));
    let outer = shiny(0.7, 0.2, 200.0, SpecularModel::Phong);
    let color = Vec3f::new(0.8, 1.0, 0.6);
    let arriving = PreparedLight::point(Vec3f::new(-10.0, 10.0, -10.0), Vec3f::ONE, false).at(position);
    let shaded = color * ambient + outer.answer(color, view, arriving.direction, view);
    assert!(near(shaded, vector(case("default world, ray (0,0,-5)->(0,0,1): colour")), 1e-6), "{shaded:?}");
}

#[test]
fn highlights() {
    let phong = shiny(0.0, 1.0, 10.0, SpecularModel::Phong);
    let blinn = shiny(0.0, 1.0, 10.0, SpecularModel::Blinn);
    let (light, view) = (at_angle(20.0), at_angle(-50.0));
    let power = |degrees: f64| degrees.to_radians().cos().powi(10);
    // The mirrored light is 30° from the view, the half vector 15° from the normal.
    assert_near(phong.answer(Vec3f::ONE, UP, light, view).x.into(), power(30.0), 1e-6, &"Phong");
    assert_near(blinn.answer(Vec3f::ONE, UP, light, view).x.into(), power(15.0), 1e-6, &"Blinn");
    for material in [phong, blinn, shiny(0.0, 1.0, 0.0, SpecularModel::Blinn)] {
        // From behind, opposite and along the surface: never a NaN, never a negative light.
        for (light, view) in [(-UP, UP), (UP, -UP), (at_angle(90.0), at_angle(-90.0)), (Vec3f::splat(f32::NAN), UP)] {
            let answer = material.answer(Vec3f::ONE, UP, light, view).x;
            assert!((0.0..=1.0).contains(&answer), "{answer}");
        }
        assert_eq!(material.answer(Vec3f::ONE, UP, -UP, UP), Vec3f::ZERO);
    }
}

#[test]
fn splitting_conserves_light() {
    let (reflect, transmit) = (Vec3f::splat(0.25), Vec3f::splat(0.5));
    let glass = |reflectance| prepared(&Material { reflect, transmit, reflectance, ior: 1.5, ..Material::default() });
    assert_eq!(glass(Reflectance::Constant).split(0.3, 1.5, false), (reflect, transmit));
    assert_eq!(glass(Reflectance::Constant).split(0.3, 1.5, true), (reflect + transmit, Vec3f::ZERO));
    for (reflectance, model) in
        [(Reflectance::Fresnel, fresnel as fn(f32, f32) -> f32), (Reflectance::Schlick, schlick)]
    {
        let r = model(0.4, 1.0 / 1.5);
        assert_eq!(glass(reflectance).split(0.4, 1.0 / 1.5, false), (reflect * r, transmit * (1.0 - r)));
        assert_eq!(glass(reflectance).split(0.1, 1.5, true), (reflect, Vec3f::ZERO));
        // An opaque body has no refracted ray, which is not total reflection.
        let opaque = prepared(&Material { reflect, reflectance, ior: 1.5, ..Material::default() });
        assert_eq!(opaque.split(0.4, 1.0 / 1.5, true), (reflect * r, Vec3f::ZERO));
    }
}

#[test]
fn absorption() {
    let absorb = Vec3f::new(0.0, 0.5, 3.0);
    let medium = Material { absorb, transmit: Vec3f::ONE, ..Material::default() };
    for (distance, scale) in [(0.0, 1.0), (1.0, 1.0), (2.0, 0.25), (0.01, 4.0)] {
        let left = PreparedMaterial::new(&medium, Vec3d::ZERO, scale).transmittance((distance * scale) as f32);
        assert!(near(left, absorb.to_f64().map(|a| (-a * distance).exp()), 1e-6), "{left:?} after {distance}");
    }
    assert_eq!(prepared(&medium).transmittance(f32::INFINITY), Vec3f::new(1.0, 0.0, 0.0));
}

#[test]
fn checkers() {
    let (even, odd) = (Vec3f::ZERO, Vec3f::ONE);
    let checker = |size: f32, origin: Vec3d, scale: f64| {
        let texture = PreparedTexture::new(&Texture::Checker { even, odd, size }, origin, scale);
        let material = Material { color: Texture::Checker { even, odd, size }, ..Material::default() };
        assert_eq!(PreparedMaterial::new(&material, origin, scale).texture(), &texture);
        PreparedMaterial::new(&material, origin, scale)
    };
    let plain = checker(2.0, Vec3d::ZERO, 1.0);
    for (p, expected) in
        [([1.0, 1.0, 1.0], even), ([3.0, 1.0, 1.0], odd), ([-1.0, 1.0, 1.0], odd), ([-1.0, 1.0, -1.0], even)]
    {
        assert_eq!(plain.color(p.into()), expected, "{p:?}");
        // The same square on a floor whose height is rounded either way.
        for y in [0.0_f32, -0.0, 1e-6, -1e-6] {
            assert_eq!(plain.color(Vec3f::new(p[0], y, p[2])), plain.color(Vec3f::new(p[0], 0.0, p[2])), "{p:?} {y}");
        }
    }
    // Moved and scaled with the space, even from a million cubes away.
    let moved = checker(2.0, Vec3d::splat(-2.0e6 * 0.25), 0.25);
    assert_eq!(moved.color(Vec3f::splat(0.25)), even);
    assert_eq!(moved.color(Vec3f::new(0.75, 0.25, 0.25)), odd);
    // Odd far cubes are still odd; what has no cube still has a colour.
    assert_eq!(plain.color(Vec3f::new(2_097_155.0, 1.0, 1.0)), odd);
    for p in [f32::INFINITY, f32::NAN, f32::MAX, -f32::MAX] {
        assert!([even, odd].contains(&plain.color(Vec3f::splat(p))));
    }
}

#[test]
fn lights() {
    let (color, position) = (Vec3f::new(1.0, 2.0, 4.0), Vec3d::new(0.0, 3.0, 0.0));
    let light = |kind, inverse_square| Light { kind, color, inverse_square };
    let prepare = |light: Light, scale: f64| {
        assert_eq!(light.fault(), None);
        light.prepare(|p| p * scale, scale)
    };
    let point = prepare(light(LightKind::Point { position }, false), 1.0).at(Vec3f::new(0.0, 1.0, 0.0));
    assert_eq!((point.direction, point.distance, point.light), (Vec3f::new(0.0, 1.0, 0.0), 2.0, color));
    // Intensity belongs to world lengths, whatever the scale of the space.
    for scale in [1.0, 0.125, 64.0] {
        let arriving =
            prepare(light(LightKind::Point { position }, true), scale).at(Vec3f::new(0.0, scale as f32, 0.0));
        assert_eq!(arriving.light, color / 4.0);
    }
    let at_light = prepare(light(LightKind::Point { position }, true), 1.0).at(position.to_f32());
    assert_eq!((at_light.direction, at_light.light), (Vec3f::ZERO, Vec3f::ZERO));
    let sun = prepare(light(LightKind::Directional { direction: Vec3d::new(0.0, -1e-200, 0.0) }, true), 8.0);
    let arriving = sun.at(Vec3f::ONE);
    assert_eq!(
        (arriving.direction, arriving.distance, arriving.light),
        (Vec3f::new(0.0, 1.0, 0.0), f32::INFINITY, color)
    );
    assert_eq!(sun.position(), None);
}

#[test]
fn spots() {
    let spot = |inner, outer| {
        let (position, look_at) = (Vec3d::ZERO, Vec3d::new(0.0, 0.0, 2.0));
        let kind = LightKind::Spot { position, look_at, inner, outer };
        let light = Light { kind, color: Vec3f::ONE, inverse_square: false };
        light.fault().is_none().then(|| light.prepare(|p| p, 1.0))
    };
    let share = |light: &PreparedLight, angle| light.at(at_angle(angle) * 5.0).light.x;
    let soft = spot(20.0, 40.0).expect("sound");
    assert_eq!([0.0, 19.9, 40.1, 90.0, 180.0].map(|angle| share(&soft, angle)), [1.0, 1.0, 0.0, 0.0, 0.0]);
    let between: Vec<f32> = (0..=20).map(|i| share(&soft, 20.0 + f64::from(i))).collect();
    assert!(between.is_sorted_by(|a, b| a >= b) && between[10] > 0.4 && between[10] < 0.7, "{between:?}");
    let hard = spot(30.0, 30.0).expect("sound");
    assert_eq!([29.9, 30.1].map(|angle| share(&hard, angle)), [1.0, 0.0]);
    let ball = spot(180.0, 180.0).expect("sound");
    assert_eq!([0.0, 90.0, 179.0].map(|angle| share(&ball, angle)), [1.0; 3]);
    for (inner, outer) in [(40.0, 20.0), (-1.0, 5.0), (1.0, 181.0), (f64::NAN, 3.0), (3.0, f64::NAN)] {
        assert!(spot(inner, outer).is_none(), "{inner} {outer}");
    }
}

#[test]
fn impossible_materials_are_named() {
    let good = Material::default();
    let bad = [
        Material { ambient: f32::NAN, ..good.clone() },
        Material { diffuse: -0.1, ..good.clone() },
        Material { reflect: Vec3f::new(0.0, f32::INFINITY, 0.0), ..good.clone() },
        Material { color: Texture::Color(Vec3f::new(0.0, 0.0, -1.0)), ..good.clone() },
        Material { exponent: -1.0, ..good.clone() },
        Material { ior: 0.0, ..good.clone() },
        Material { ior: f32::INFINITY, ..good.clone() },
        Material { absorb: Vec3f::splat(-1.0), ..good.clone() },
        Material { color: Texture::Checker { even: Vec3f::ZERO, odd: Vec3f::ONE, size: 0.0 }, ..good.clone() },
    ];
    assert_eq!(good.fault(), None);
    let faults: Vec<_> = bad.iter().map(|material| material.fault().expect("impossible")).collect();
    assert!(faults[2].contains("strength") && faults[3].contains("colour") && faults[5].contains("refraction"));
}

/// Everything per ray, for a vector of rays: the bits that each lane gives.
struct AllOptics<'a> {
    material: &'a PreparedMaterial,
    light: &'a PreparedLight,
    /// Rows of sixteen: directions, normals, positions, index.
    rows: &'a [[f32; 16]; 10],
}

impl Kernel for AllOptics<'_> {
    type Output = Vec<[f32; 16]>;

    fn run<S: Simd>(self, token: S) -> Self::Output {
        let row = |i: usize| S::F32x16::load(token, &self.rows[i]);
        let vector = |i: usize| Vec3::new(row(i), row(i + 1), row(i + 2));
        let (incident, normal, position, eta) = (vector(0), vector(3), vector(6), row(9));
        let (through, refracts) = lanes::refracted(token, incident, normal, eta);
        let arriving = self.light.at_lanes(token, position);
        let color = self.material.texture().at(token, position);
        let splat = |value| S::F32x16::splat(token, value);
        let surface = self.material.local().surface(Vec3f::ONE).map(splat);
        let surface = LocalSurface { diffuse: surface.diffuse.times(color), ..surface };
        let answer = lanes::answer(token, &surface, normal, arriving.direction, -incident);
        let cos = -incident.dot(normal);
        let zero = S::F32x16::splat(token, 0.0);
        let through = through.map(|a| S::F32x16::select(refracts, a, zero));
        [lanes::mirrored(token, incident, normal), through, arriving.direction, arriving.light, color, answer]
            .into_iter()
            .flat_map(Vec3::to_array)
            .chain([lanes::fresnel(token, cos, eta), lanes::schlick(token, cos, eta)])
            .map(|lane| {
                let mut stored = [0.0; 16];
                lane.store(&mut stored);
                stored
            })
            .collect()
    }
}

#[test]
fn one_ray_and_many_give_the_same_bits() {
    let mut random = SplitMix64::new(7);
    let unit = |random: &mut SplitMix64| Vec3::new((), (), ()).map(|()| random.uniform(-1.0, 1.0)).normalize().to_f32();
    for round in 0..200 {
        let specular_model = [SpecularModel::Phong, SpecularModel::Blinn][round % 2];
        let texture = Texture::Checker { even: Vec3f::ONE, odd: Vec3f::splat(0.2), size: 0.3 };
        let specular = Vec3f::new(0.5, 0.4, 0.3);
        let material = prepared(&Material { color: texture, specular, specular_model, ..Material::default() });
        let light = PreparedLight::point(unit(&mut random), Vec3f::new(3.0, 2.0, 1.0), round % 3 == 0);
        let light = if round % 5 == 0 { light.within_cone(Vec3d::ONE, 10.0, 60.0) } else { light };
        let mut rays = [(); 16].map(|()| {
            let (incident, normal) = (unit(&mut random), unit(&mut random));
            let normal = if incident.dot(normal) > 0.0 { -normal } else { normal };
            (incident, normal, unit(&mut random), random.uniform(0.5, 2.0) as f32)
        });
        rays[3].2 = light.position().expect("a point light");
        let mut rows = [[0.0; 16]; 10];
        for (lane, (incident, normal, position, eta)) in rays.iter().enumerate() {
            let all = [incident, normal, position].map(|v| v.to_array()).concat();
            (0..9).for_each(|i| rows[i][lane] = all[i]);
            rows[9][lane] = *eta;
        }
        for level in Level::available() {
            let many = simd::dispatch(level, AllOptics { material: &material, light: &light, rows: &rows });
            for (lane, &(incident, normal, position, eta)) in rays.iter().enumerate() {
                let arriving = light.at(position);
                let color = material.color(position);
                let cos = -incident.dot(normal);
                let through = shading::refracted(incident, normal, eta).unwrap_or(Vec3f::ZERO);
                let answer = material.answer(color, normal, arriving.direction, -incident);
                let vectors = [mirrored(incident, normal), through, arriving.direction, arriving.light, color, answer];
                let one = vectors.into_iter().flat_map(Vec3f::to_array).chain([fresnel(cos, eta), schlick(cos, eta)]);
                for (i, value) in one.enumerate() {
                    let lanes = many[i][lane];
                    assert_eq!(value.to_bits(), lanes.to_bits(), "{value} {lanes}: row {i} at {}", level.name());
                }
            }
        }
    }
}
