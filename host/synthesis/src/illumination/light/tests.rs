//! Facts about lights: closed forms of irradiance, and pdfs.

use super::*;
use crate::color::WavelengthSets;
use crate::numeric::cubature::unit_square;
use crate::numeric::ray::Ray;
use crate::numeric::sampling::{RandomStream, sphere};
use std::f64::consts::PI;

fn source(light: Light) -> LightSource {
    light.check().unwrap_or_else(|error| panic!("{error}"));
    LightSource::new(&light, &WavelengthSets::bands())
}

fn area(patch: LightShape) -> LightSource {
    source(Light::Area { patch, radiance: Color::grey(1.0) })
}

/// Irradiance of a surface element by cubature over the light.
fn irradiance(source: &LightSource, point: DVec3, normal: DVec3) -> f64 {
    let term = |uniform| {
        source
            .sample_incident(point, None, uniform, 0)
            .map_or(0.0, |light_sample| light_sample.irradiance.0[0] * light_sample.towards.dot(normal).max(0.0))
    };
    unit_square(term, 1e-9, 200_000).value
}

#[test]
fn irradiance_of_a_point_falls_with_the_square_of_the_distance() {
    let point = source(Light::Point { at: DVec3::new(0.0, 3.0, 0.0), intensity: Color::grey(18.0) });
    let light_sample = point.sample_incident(DVec3::ZERO, None, [0.5; 2], 0).expect("light");
    assert_eq!((light_sample.irradiance.0[0], light_sample.distance, light_sample.towards), (2.0, 3.0, DVec3::Y));
    assert!(
        point.sample_incident(DVec3::new(0.0, 3.0, 0.0), None, [0.5; 2], 0).is_none(),
        "no direction at the light itself"
    );
    for far in [1e-9, 1e9] {
        let light_sample = point.sample_incident(DVec3::new(far, 3.0, 0.0), None, [0.5; 2], 0).expect("light");
        assert!((light_sample.irradiance.0[0] * far * far / 18.0 - 1.0).abs() < 1e-12);
    }
}

#[test]
fn irradiance_of_a_sphere_is_that_of_its_solid_angle() {
    // E = pi L (r/d)^2 cos, if all of the sphere is above the horizon.
    for (distance, radius) in [(2.0, 1.0), (1.0001, 1.0), (1e9, 1.0), (5.0, 1e-6)] {
        let patch = LightShape::Sphere { center: DVec3::new(0.0, distance, 0.0), radius };
        let expected = PI * (radius / distance).powi(2);
        let found = irradiance(&area(patch), DVec3::ZERO, DVec3::Y);
        assert!((found / expected - 1.0).abs() < 1e-6, "{distance} {radius}: {found} {expected}");
    }
    let patch = LightShape::Sphere { center: DVec3::new(3.0, 4.0, 0.0), radius: 1.0 };
    let found = irradiance(&area(patch), DVec3::ZERO, DVec3::Y);
    assert!((found - PI / 25.0 * 0.8).abs() < 1e-8);
    assert!(area(patch).sample_incident(DVec3::new(3.0, 4.5, 0.0), None, [0.5; 2], 0).is_none(), "dark inside");
}

#[test]
fn irradiance_of_a_disc_is_that_of_its_closed_form() {
    // E = pi L r^2 / (r^2 + h^2) on the axis.
    for (height, radius) in [(1.0, 1.0), (3.0, 0.5), (1e6, 10.0), (2.0, 1e-6)] {
        let center = DVec3::new(0.0, height, 0.0);
        let patch = LightShape::Disc { center, normal: DVec3::NEG_Y, radius };
        let expected = PI * radius * radius / (radius * radius + height * height);
        let found = irradiance(&area(patch), DVec3::ZERO, DVec3::Y);
        assert!((found / expected - 1.0).abs() < 1e-6, "{height} {radius}: {found} {expected}");
        assert!(area(patch).sample_incident(center * 2.0, None, [0.5; 2], 0).is_none(), "dark behind");
    }
}

/// Lambert's formula for a polygon that is wholly above the horizon.
fn of_polygon(corners: &[DVec3], normal: DVec3) -> f64 {
    let count = corners.len();
    let side = |i: usize| {
        let (a, b) = (corners[i].normalize(), corners[(i + 1) % count].normalize());
        let across = a.cross(b);
        across.normalize_or_zero().dot(normal) * across.length().atan2(a.dot(b))
    };
    0.5 * (0..count).map(side).sum::<f64>().abs()
}

#[test]
fn irradiance_of_a_rectangle_is_that_of_lamberts_formula() {
    let cases = [
        (DVec3::new(-1.0, 2.0, -1.0), DVec3::X * 2.0, DVec3::Z * 2.0),
        (DVec3::new(0.5, 0.1, -3.0), DVec3::X * 4.0, DVec3::new(0.0, 1.0, 1.0)),
        (DVec3::new(-10.0, 1e-3, -10.0), DVec3::X * 20.0, DVec3::Z * 20.0),
        (DVec3::new(0.0, 3.0, 0.0), DVec3::X * 1e-6, DVec3::Z * 1e-6),
        (DVec3::new(1e4, 3e4, 0.0), DVec3::X * 2.0, DVec3::Z * 3.0),
        // A parallelogram, which is sampled by area.
        (DVec3::new(-1.0, 2.0, -1.0), DVec3::new(2.0, 0.0, 1.0), DVec3::Z * 2.0),
    ];
    for (corner, across, up) in cases {
        let patch = LightShape::Rectangle { corner, across, up };
        // Seen from whichever side emits.
        let front = across.cross(up).dot(-corner) > 0.0;
        let patch = if front { patch } else { LightShape::Rectangle { corner, across: up, up: across } };
        let expected = of_polygon(&[corner, corner + across, corner + across + up, corner + up], DVec3::Y);
        let found = irradiance(&area(patch), DVec3::ZERO, DVec3::Y);
        assert!((found / expected - 1.0).abs() < 2e-5, "{patch:?}: {found} {expected}");
    }
}

#[test]
fn triangles_emit_as_the_rectangle_that_they_make() {
    let (corner, across, up) = (DVec3::new(-1.0, 2.0, -1.0), DVec3::X * 2.0, DVec3::Z * 2.0);
    let corners = [corner, corner + across, corner + across + up, corner + up];
    let triangles = vec![[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    let source = LightSource::of_triangles(triangles, WavelengthSets::bands().constant(1.0)).expect("area");
    let found = irradiance(&source, DVec3::ZERO, DVec3::Y);
    assert!((found - of_polygon(&corners, DVec3::Y)).abs() < 1e-6);
    assert!(LightSource::of_triangles(vec![[corner; 3]], WavelengthSets::bands().constant(1.0)).is_none());
}

#[test]
fn pdfs_are_those_of_the_sampled_directions() {
    let patches = [
        LightShape::Sphere { center: DVec3::new(1.0, 3.0, 0.0), radius: 0.7 },
        LightShape::Disc { center: DVec3::new(1.0, 3.0, 0.0), normal: DVec3::new(-0.3, -1.0, 0.2), radius: 0.7 },
        LightShape::Rectangle { corner: DVec3::new(-1.0, 2.0, -1.0), across: DVec3::X * 2.0, up: DVec3::Z },
        LightShape::Rectangle {
            corner: DVec3::new(-1.0, 2.0, -1.0),
            across: DVec3::X * 2.0,
            up: DVec3::new(1.0, 0.0, 1.0),
        },
    ];
    let mut stream = RandomStream::new(7, 7);
    for patch in patches {
        let source = area(patch);
        for _ in 0..200 {
            let light_sample = source.sample_incident(DVec3::ZERO, None, stream.point(), 0).expect("light");
            let ray = Ray { origin: DVec3::ZERO, direction: light_sample.towards * 2.0 };
            // A point of the border may fall on either side of it.
            let Some(light_hit) = source.intersect(&ray, 0.0, f64::INFINITY, 0) else { continue };
            assert!((2.0 * light_hit.t - light_sample.distance).abs() < 1e-6, "{patch:?}");
            assert!((light_hit.pdf / light_sample.pdf.expect("spread") - 1.0).abs() < 1e-6, "{patch:?}");
            assert_eq!(light_hit.radiance.0[0], 1.0);
        }
    }
}

#[test]
fn a_spot_falls_from_all_to_nothing_between_its_angles() {
    let spot = source(Light::Spot {
        at: DVec3::Y,
        direction: DVec3::NEG_Y,
        intensity: Color::grey(1.0),
        inner: 20.0,
        outer: 40.0,
    });
    let at = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        spot.sample_incident(DVec3::new(sin, 1.0 - cos, 0.0), None, [0.5; 2], 0)
            .map_or(0.0, |light_sample| light_sample.irradiance.0[0])
    };
    assert!((at(0.0) - 1.0).abs() < 1e-12 && (at(19.9) - 1.0).abs() < 1e-12 && at(40.1) == 0.0);
    let middle = ((20f64.to_radians().cos() + 40f64.to_radians().cos()) / 2.0).acos().to_degrees();
    assert!((at(middle) - 0.5).abs() < 1e-12);
    let bad = Light::Spot { at: DVec3::Y, direction: DVec3::X, intensity: Color::grey(1.0), inner: 50.0, outer: 40.0 };
    assert!(bad.check().unwrap_err().to_string().contains("50 to 40"));
}

const LAMP: &str =
    "IESNA:LM-63-2002\n[TEST] ours\nTILT=NONE\n1 -1 2 3 2 1 2 0 0 0\n1 1 60\n0 45 90\n0 90\n100 50 0\n100 80 0\n";

#[test]
fn a_luminaire_shines_as_its_file_says() {
    let table = Goniometry::parse(LAMP).expect("a table");
    let at = |vertical: f64, around: f64| {
        let (sin, cos) = vertical.to_radians().sin_cos();
        let (across, along) = around.to_radians().sin_cos();
        table.candelas(DVec3::new(sin * along, sin * across, -cos))
    };
    assert_eq!((at(0.0, 0.0), table.greatest()), (200.0, 200.0));
    for (vertical, around, expected) in [
        (45.0, 0.0, 100.0),
        (45.0, 90.0, 160.0),
        (45.0, 45.0, 130.0),
        (22.5, 0.0, 150.0),
        (45.0, 180.0, 100.0),
        (45.0, 270.0, 160.0),
        (45.0, 135.0, 130.0),
        (120.0, 0.0, 0.0),
    ] {
        assert!((at(vertical, around) - expected).abs() < 1e-9, "{vertical} {around}: {}", at(vertical, around));
    }
    let light = Light::Luminaire {
        at: DVec3::new(0.0, 2.0, 0.0),
        down: DVec3::NEG_Y,
        front: DVec3::X,
        goniometry: table,
        color: Color::grey(1.0),
    };
    let light_sample = source(light).sample_incident(DVec3::ZERO, None, [0.5; 2], 0).expect("light");
    assert!((light_sample.irradiance.0[0] - 200.0 / 683.0 / 4.0).abs() < 1e-12);
}

#[test]
fn broken_files_of_luminaires_are_errors_with_their_line() {
    let refused = |text: &str| Goniometry::parse(text).unwrap_err().to_string();
    assert!(refused("").contains("TILT"));
    assert!(refused("TILT=INCLUDE\n").contains("line 1"));
    assert!(refused(&LAMP.replace("50 0\n", "5O 0\n")).contains("line 8: an intensity is \"5O\""));
    assert!(refused(&LAMP.replace("0 45 90", "0 95 90")).contains("rise"));
    assert!(refused(&LAMP.replace("0 90\n", "0 70\n")).contains("horizontal"));
    assert!(refused(&LAMP.replace("100 80 0\n", "")).contains("ends where an intensity"));
    assert!(refused(&LAMP.replace("3 2 1", "3e9 2e9 1")).contains("whole number"));
    assert!(refused(&LAMP.replace("100 50", "-100 50")).contains("negative"));
}

fn map() -> SkyMap {
    let panorama = Panorama::of(8, 4, |x, y| DVec3::splat(f64::from((y * 8 + x) % 5))).expect("small");
    SkyMap { file: String::new(), panorama: Some(Arc::new(panorama)), ..SkyMap::default() }
}

#[test]
fn a_sky_of_one_radiance_lights_a_plane_with_pi_times_it() {
    let sky = source(Light::Sky { map: None, radiance: Color::grey(2.0), turned: 0.0 });
    assert!((irradiance(&sky, DVec3::ZERO, DVec3::Y) - 2.0 * PI).abs() < 1e-3);
    assert_eq!(sky.sky_radiance(&from_origin(DVec3::X), None, 0).expect("a sky").radiance.0[0], 2.0);
    // By the cosine above an element, each direction brings as much.
    for uniform in [[0.1, 0.2], [0.7, 0.9], [0.99, 0.5]] {
        let light_sample = sky.sample_incident(DVec3::ZERO, Some(DVec3::Y), uniform, 0).expect("light");
        assert!((light_sample.irradiance.0[0] * light_sample.towards.y - 2.0 * PI).abs() < 1e-9);
        assert_eq!(
            sky.sky_radiance(&from_origin(light_sample.towards), Some(DVec3::Y), 0).map(|light_hit| light_hit.pdf),
            light_sample.pdf
        );
    }
}

#[test]
fn a_map_is_seen_where_its_directions_are_and_sampled_as_bright_as_it_is() {
    let sky = source(Light::Sky { map: Some(map()), radiance: Color::grey(1.0), turned: 30.0 });
    // Irradiance by sampled directions, and by directions spread evenly.
    let drawn = irradiance(&sky, DVec3::ZERO, DVec3::new(0.6, 0.8, 0.0));
    let term = |uniform| {
        let towards = sphere(uniform);
        sky.sky_radiance(&from_origin(towards), None, 0).map_or(0.0, |light_hit| light_hit.radiance.0[0])
            * towards.dot(DVec3::new(0.6, 0.8, 0.0)).max(0.0)
    };
    let even = 4.0 * PI * unit_square(term, 1e-4, 400_000).value;
    assert!((drawn / even - 1.0).abs() < 2e-3, "{drawn} {even}");
    // The pdf integrates to 1.
    let all = 4.0
        * PI
        * unit_square(
            |u| sky.sky_radiance(&from_origin(sphere(u)), None, 0).map_or(0.0, |light_hit| light_hit.pdf),
            1e-4,
            400_000,
        )
        .value;
    assert!((all - 1.0).abs() < 2e-3, "{all}");
    let mut stream = RandomStream::new(2, 2);
    for _ in 0..100 {
        let light_sample = sky.sample_incident(DVec3::ZERO, None, stream.point(), 0).expect("light");
        let light_hit = sky.sky_radiance(&from_origin(light_sample.towards), None, 0).expect("a sky");
        assert!((light_hit.pdf / light_sample.pdf.expect("spread") - 1.0).abs() < 1e-9);
    }
    let ahead = source(Light::Sky { map: Some(map()), radiance: Color::grey(1.0), turned: 0.0 });
    // In the middle of column 4 of row 1, which is 60 degrees from the zenith, and straight up, where row 0 is.
    let towards = |degrees: f64, turn: f64| {
        let ((sine, cosine), (across, along)) = (degrees.to_radians().sin_cos(), turn.to_radians().sin_cos());
        ahead
            .sky_radiance(&from_origin(DVec3::new(sine * across, cosine, -sine * along)), None, 0)
            .expect("a sky")
            .radiance
            .0[0]
    };
    let pixel = |x: usize, y: usize| ((y * 8 + x) % 5) as f64;
    assert!((towards(60.0, 22.5) - pixel(4, 1)).abs() < 1e-9 && (towards(60.0, 112.5) - pixel(6, 1)).abs() < 1e-9);
    assert!(
        (towards(1e-9, 22.5) - pixel(4, 0)).abs() < 1e-6 && (towards(180.0 - 1e-6, 22.5) - pixel(4, 3)).abs() < 1e-6
    );
}

#[test]
fn a_disc_in_the_sky_is_sampled_evenly_and_seen_where_it_is() {
    let disc = SkyDisc { towards: DVec3::new(0.6, 0.8, 0.0), radius: 0.004_653 };
    let map = SkyMap { file: String::new(), panorama: None, disc: Some(disc) };
    let sun = source(Light::Sky { map: Some(map), radiance: Color::grey(2.0 / disc.solid_angle()), turned: 0.0 });
    assert!((irradiance(&sun, DVec3::ZERO, DVec3::Y) - 2.0 * 0.8).abs() < 1e-5);
    assert!(!sun.is_sky() && sun.is_infinite() && sun.emits_photons());
    let mut stream = RandomStream::new(4, 9);
    for _ in 0..1000 {
        let light_sample = sun.sample_incident(DVec3::ZERO, None, stream.point(), 0).expect("light");
        let angle = light_sample.towards.cross(disc.towards).length().asin();
        assert!(angle <= disc.radius * (1.0 + 1e-9) && (light_sample.towards.length() - 1.0).abs() < 1e-12);
        let seen = sun.sky_radiance(&from_origin(light_sample.towards), None, 0).expect("it is there");
        assert_eq!(Some(seen.pdf), light_sample.pdf);
    }
    assert!(
        sun.sky_radiance(&from_origin(-disc.towards), None, 0).is_none()
            && sun.sky_radiance(&from_origin(DVec3::Y), None, 0).is_none()
    );
    let [point] = sun.points(7)[..] else { panic!("one point") };
    let light_sample = sun.incident_from(&point, DVec3::ZERO, 0).expect("light");
    assert!(
        (light_sample.irradiance.0[0] - 2.0).abs() < 1e-6 && (light_sample.towards - disc.towards).length() < 1e-12
    );
}

#[test]
fn polygons_of_a_patch_lie_on_it_and_turn_counter_clockwise_about_where_it_emits_to() {
    let at = DVec3::new(1.0, -2.0, 3.0);
    let patches = [
        LightShape::Rectangle { corner: at, across: DVec3::new(2.0, 1.0, 0.0), up: DVec3::new(0.0, 1.0, 3.0) },
        LightShape::Disc { center: at, normal: DVec3::new(-1.0, 2.0, -3.0), radius: 2.0 },
        LightShape::Sphere { center: at, radius: 2.0 },
    ];
    for (patch, least) in patches.into_iter().zip([1.0, 0.99, 0.98]) {
        let mut area = 0.0;
        for polygon in patch.polygons(64) {
            let [a, b, c] = [polygon[0], polygon[1], polygon[2]];
            let normal = (b - a).cross(c - a).normalize();
            let middle = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
            let before = Ray { origin: middle + normal * 5.0, direction: -normal };
            let light_hit = area_hit(&patch, &before).expect("it is hit");
            assert!((light_hit.t - 5.0).abs() < 0.01 && light_hit.radiance.0[0] == 1.0, "{patch:?}: {light_hit:?}");
            let twice: DVec3 = polygon.windows(2).map(|pair| (pair[0] - a).cross(pair[1] - a)).sum();
            assert!(polygon.len() >= 3 && twice.dot(normal) > 0.0);
            area += twice.length() / 2.0;
        }
        let part = area / patch.area();
        assert!((least..=1.0 + 1e-12).contains(&part), "{patch:?}: {part}");
    }
}

fn area_hit(patch: &LightShape, ray: &Ray) -> Option<LightHit> {
    area(*patch).intersect(ray, 0.0, f64::INFINITY, 0)
}

/// A ray from the origin.
fn from_origin(direction: DVec3) -> Ray {
    Ray { origin: DVec3::ZERO, direction }
}

#[test]
fn portals_change_where_a_sky_is_looked_for_and_not_how_much_it_lights() {
    let rectangle = |corner: DVec3, across: DVec3, up: DVec3| LightShape::Rectangle { corner, across, up };
    let portals = [
        // Behind the origin, ahead of it, and one that is no right-angled one.
        rectangle(DVec3::new(-1.0, 0.0, 2.0), DVec3::X, DVec3::Y),
        rectangle(DVec3::new(-0.5, 0.2, -1.0), DVec3::X, DVec3::Y),
        rectangle(DVec3::new(1.0, 0.3, 0.0), DVec3::Z, DVec3::new(0.0, 1.0, -0.5)),
    ];
    let normal = DVec3::new(0.3, 0.9, -0.3).normalize();
    for map in [Some(map()), None] {
        let sky = source(Light::Sky { map, radiance: Color::grey(1.0), turned: 30.0 });
        let seen = sky.clone().with_portals(&portals);
        // Sampled with the normal, and without.
        for known in [Some(normal), None] {
            let mean = |source: &LightSource| {
                let term = |uniform| {
                    let light_sample = source.sample_incident(DVec3::ZERO, known, uniform, 0);
                    light_sample.map_or(0.0, |beam| beam.irradiance.0[0] * beam.towards.dot(normal).max(0.0))
                };
                unit_square(term, 1e-4, 400_000).value
            };
            let (plain, portal) = (mean(&sky), mean(&seen));
            assert!((portal / plain - 1.0).abs() < 3e-3, "{portal} {plain}");
            let pdf = |u| seen.sky_radiance(&from_origin(sphere(u)), known, 0).map_or(0.0, |light_hit| light_hit.pdf);
            let all = 4.0 * PI * unit_square(pdf, 1e-4, 400_000).value;
            assert!((all - 1.0).abs() < 3e-3, "{all}");
        }
        let mut stream = RandomStream::new(5, 1);
        let mut through = 0;
        for _ in 0..1000 {
            let Some(light_sample) = seen.sample_incident(DVec3::ZERO, Some(normal), stream.point(), 0) else {
                continue;
            };
            let light_hit = seen.sky_radiance(&from_origin(light_sample.towards), Some(normal), 0).expect("a sky");
            assert!((light_hit.pdf / light_sample.pdf.expect("spread") - 1.0).abs() < 1e-9);
            let at = light_sample.towards / -light_sample.towards.z;
            through += i32::from(light_sample.towards.z < 0.0 && at.x.abs() < 0.5 && (0.2..1.2).contains(&at.y));
        }
        assert!((380..560).contains(&through), "{through} of 1000 go ahead");
        // Where there is none before a point, nothing changes.
        let below = DVec3::new(0.0, -5.0, 9.0);
        assert_eq!(
            seen.sample_incident(below, None, [0.3, 0.4], 0).map(|light_sample| light_sample.towards),
            seen.with_portals(&[]).sample_incident(below, None, [0.3, 0.4], 0).map(|light_sample| light_sample.towards)
        );
    }
}

#[test]
fn a_lamp_that_reflects_is_sampled_as_one_that_does_not_and_left_to_its_body_to_be_hit() {
    let center = DVec3::new(0.3, 2.0, -0.2);
    let point = DVec3::new(0.5, 0.1, 0.4);
    for patch in [
        LightShape::Rectangle { corner: center, across: DVec3::X, up: DVec3::Z },
        LightShape::Rectangle { corner: center, across: DVec3::Z, up: DVec3::X },
        LightShape::Disc { center, normal: DVec3::NEG_Y, radius: 0.5 },
        LightShape::Sphere { center, radius: 0.5 },
    ] {
        let material = Box::default();
        let bare = source(Light::Area { patch, radiance: Color::grey(2.0) });
        let lamp = source(Light::Lamp { patch, radiance: Color::grey(2.0), material });
        assert!(!lamp.is_surface() && !lamp.is_delta() && lamp.origin() == bare.origin());
        assert_eq!(lamp.power(1.0, 0), bare.power(1.0, 0));
        for uniform in [[0.1, 0.7], [0.5, 0.5], [0.8, 0.2]] {
            let sample = lamp.sample_incident(point, None, uniform, 0);
            assert_eq!(sample, bare.sample_incident(point, None, uniform, 0));
            let Some(LightSample { towards, distance, pdf: Some(pdf), .. }) = sample else { continue };
            let ray = Ray { origin: point, direction: towards };
            assert_eq!(lamp.intersect(&ray, 0.0, f64::INFINITY, 0), None);
            let found = lamp.pdf_on_object(point, towards, distance, 1.0);
            assert!((found / pdf - 1.0).abs() < 1e-9, "{patch:?}: {found} {pdf}");
        }
        let emitted = [true, false].map(|is_outside| lamp.emission_on_object(is_outside, 0).0[0]);
        assert_eq!(emitted, [2.0, 0.0]);
    }
}

#[test]
fn no_point_of_a_rectangle_itself_is_lit_by_it() {
    let (corner, across, up) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.3, 0.7, 0.1), DVec3::new(-0.2, 0.1, 0.9));
    let patch = LightShape::Rectangle { corner, across, up };
    let source = source(Light::Lamp { patch, radiance: Color::grey(1.0), material: Box::default() });
    for step in 0..100 {
        let part = f64::from(step) / 100.0;
        let point = corner + across * part + up * (0.3 + 0.5 * part);
        assert_eq!(source.sample_incident(point, None, [0.3, 0.6], 0), None, "{point}");
    }
}
