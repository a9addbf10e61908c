//! Facts about both renderers at the extremes: each is held against a closed form, a limit, or an invariance.

use super::ray_tracer;
use super::scan_line::ScanLine;
use super::{RenderOrder, Renderer, Rendering, Watch};
use crate::color::{Color, Extrapolation, Spectrum};
use crate::illumination::light::LightShape;
use crate::illumination::material::{
    Classic, Coated, Finish, Material, MaterialKind, Metal, RefractiveIndex, Transparent,
};
use crate::illumination::{Light, Paint, RgbPower};
use crate::picture::difference;
use crate::plan::Plan;
use crate::scene::{Camera, Interreflection, Object, Parallel, Prepared, Scene, Settings, Shape, View};
use crate::solid::Primitive;
use glam::{DMat4, DVec2, DVec3};
use std::f64::consts::PI;

fn object(shape: Shape, transform: DMat4, material: impl Into<Material>) -> Object {
    Object { name: shape.word().into(), shape, transform, material: Some(material.into()), tolerance: None }
}

fn ground(size: f64, transform: DMat4, material: impl Into<Material>) -> Object {
    object(Shape::Ground { size }, transform, material)
}

fn ball(radius: f64, at: DVec3, material: impl Into<Material>) -> Object {
    object(Shape::from(Primitive::Sphere { radius }), DMat4::from_translation(at), material)
}

fn cuboid(size: DVec3, at: DVec3, material: impl Into<Material>) -> Object {
    object(Shape::from(Primitive::Box { size }), DMat4::from_translation(at), material)
}

fn diffuse(k: f64) -> Classic {
    Classic { diffuse: Paint::grey(k), ..Classic::default() }
}

fn glass(index: f64, roughness: f64, absorption: f64) -> Material {
    let (index, absorption) = (RefractiveIndex::Constant(index), Color::grey(absorption));
    MaterialKind::Transparent(Transparent { roughness: roughness.into(), absorption, ..Transparent::clear(index) })
        .into()
}

fn metal(n: f64, k: f64, finish: Finish) -> Material {
    let flat = |value: f64| Spectrum::regular(300.0, 600.0, vec![value; 2], Extrapolation::Held).expect("a spectrum");
    MaterialKind::Metal(Metal { n: flat(n), k: flat(k), finish }).into()
}

fn rough(name: &str, roughness: f64) -> Finish {
    Finish::Rough { name: name.into(), roughness: f64::into(roughness) }
}

fn camera(from: DVec3, at: DVec3, up: DVec3, field_of_view: f64) -> Camera {
    Camera { from, at, up, field_of_view, near: 0.0, far: None, lens: None, parallel: None, motion: None }
}

/// Sees a point of the plane y = 0 from an angle to its normal, degrees, within almost nothing.
fn at_angle(degrees: f64) -> Camera {
    let (sin, cos) = degrees.to_radians().sin_cos();
    camera(DVec3::new(sin, cos, 0.0), DVec3::ZERO, DVec3::Z, 1e-7)
}

/// Sees a square around the origin of the plane y = 0 straight from above.
fn from_above(from: f64, height: f64) -> Camera {
    let parallel = Some(Parallel { height, oblique: DVec2::ZERO });
    // Without a near depth, a parallel view begins before all there is.
    Camera { parallel, near: from * 1e-3, ..camera(DVec3::Y * from, DVec3::ZERO, DVec3::Z, 30.0) }
}

fn scene(objects: Vec<Object>, lights: Vec<Light>, camera: Camera, side: u32, samples: u32) -> Scene {
    let mut settings = Settings::of_size(side, side, samples);
    settings.light.spectral = Some(false);
    Scene { objects, lights, settings, camera: Some(camera), ..Scene::default() }
}

fn render(scene: &Scene, by_rays: bool) -> Rendering {
    let prepared = Prepared::new(scene).unwrap_or_else(|e| panic!("{e}"));
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let order = RenderOrder::of(&scene.settings);
    let rendering = match by_rays {
        true => ray_tracer(&prepared, &plan).expect("ready").render(&view, &order, &Watch::NOBODY),
        false => ScanLine::new(&prepared, &plan).expect("ready").render(&view, &order, &Watch::NOBODY),
    };
    let rendering = rendering.expect("a picture");
    assert!(
        rendering
            .film
            .tallies()
            .iter()
            .all(|t| t.sum.is_finite() && t.sum.min_element() >= 0.0 && t.squares.is_finite())
    );
    rendering
}

/// The red radiance of the first pixel, and what chance does to it.
fn red(rendering: &Rendering) -> (f64, f64) {
    let tally = &rendering.film.tallies()[0];
    (tally.mean().x, if tally.count > 1 { tally.variance().sqrt() } else { 0.0 })
}

/// The reflected part of light that is not polarised, without cancellation at n = 1.
///
/// # Source
/// Fresnel's equations, each difference of squares divided by its sum.
fn fresnel(n: f64, cosine: f64) -> f64 {
    let (excess, square) = ((n - 1.0) * (n + 1.0), cosine * cosine);
    if excess + square <= 0.0 {
        return 1.0;
    }
    let root = (excess + square).sqrt();
    let perpendicular = excess / (cosine + root).powi(2);
    let parallel = excess * ((n * n + 1.0) * square - 1.0) / (n * n * cosine + root).powi(2);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

#[test]
fn polished_surfaces_reflect_what_fresnel_says_up_to_grazing() {
    for n in [1.5, 1.0 + 1e-9, 1.0 - 1e-9, 1e3, 1e-3] {
        // What enters the body is absorbed at once; a metal that does not absorb reflects the same.
        for material in [glass(n, 0.0, 1e9), metal(n, 0.0, Finish::Polished)] {
            for degrees in [0.0, 45.0, 80.0, 89.0, 89.9, 89.999, 89.9999] {
                let body = cuboid(DVec3::new(40.0, 10.0, 40.0), DVec3::NEG_Y * 5.0, material.clone());
                let mut scene = scene(vec![body], vec![], at_angle(degrees), 1, 256);
                scene.background = RgbPower::ONE;
                let (found, error) = red(&render(&scene, true));
                let expected = fresnel(n, degrees.to_radians().cos());
                let off = (found - expected).abs();
                // Of what is faint, some samples see much and most see nothing: perhaps all of them.
                let faint = expected.min(1.0 - expected);
                let unseen = if faint < 1.0 / 64.0 { 5.0 * faint.min(4e-4) } else { 0.0 };
                assert!(off < 5.0 * error + unseen + 1e-6, "{n} {degrees}: {found} {error} {expected}");
            }
        }
    }
}

#[test]
fn no_roughness_and_no_angle_creates_light() {
    let coated = |roughness| {
        MaterialKind::Coated(Coated { diffuse: Paint::grey(1.0), index: 1.5, roughness: f64::into(roughness) }).into()
    };
    for roughness in [1e-6, 0.1, 10.0] {
        let lossless = |name| metal(0.0, 3.0, rough(name, roughness));
        let materials: [(Material, f64); 5] = [
            (lossless("GGX, all"), 1e-2),
            (lossless("Beckmann, all"), 1e-2),
            // One reflection between facets only: the rest is lost.
            (lossless("GGX"), 1.0),
            (lossless("Beckmann"), 1.0),
            (coated(roughness), 1.0),
        ];
        for (material, loss) in materials {
            let sky = Light::Sky { map: None, radiance: Color::grey(1.0), turned: 0.0 };
            let word = material.word();
            let mut scene = scene(vec![ground(1e3, DMat4::IDENTITY, material)], vec![sky], at_angle(0.0), 1, 256);
            scene.settings.light.interreflection = Interreflection::Followed;
            let prepared = Prepared::new(&scene).expect("a scene");
            let plan = Plan::new(&prepared, &prepared.view());
            let tracer = ray_tracer(&prepared, &plan).expect("ready");
            for degrees in [0.0, 60.0, 89.0, 89.9999] {
                let view = View::Camera(at_angle(degrees));
                let rendering =
                    tracer.render(&view, &RenderOrder::of(&scene.settings), &Watch::NOBODY).expect("a picture");
                let (found, error) = red(&rendering);
                let place = format!("{word} {roughness} {degrees}: {found} {error}");
                assert!(found < 1.0 + 5.0 * error + 1e-3 && found > 1.0 - loss - 5.0 * error, "{place}");
            }
        }
    }
}

#[test]
fn a_metal_of_almost_no_roughness_is_a_mirror() {
    let picture = |finish: Finish| {
        let objects = vec![
            ground(20.0, DMat4::IDENTITY, metal(0.2, 3.0, finish)),
            cuboid(DVec3::ONE, DVec3::new(0.3, 0.9, -0.5), diffuse(0.8)),
        ];
        let eye = camera(DVec3::new(1.0, 2.0, 6.0), DVec3::ZERO, DVec3::Y, 30.0);
        let mut scene = scene(objects, vec![], eye, 24, 16);
        (scene.ambient, scene.background) = (RgbPower::ONE, RgbPower::splat(0.2));
        render(&scene, true).picture
    };
    let mirror = picture(Finish::Polished);
    for name in ["GGX", "Beckmann", "GGX, all"] {
        let apart = difference(&picture(rough(name, 1e-6)), &mirror).expect("same size");
        assert!(apart.rmse < 5e-3, "{name}: {apart:?}");
    }
}

#[test]
fn glass_of_almost_the_index_of_air_is_not_seen_and_one_of_a_thousand_loses_nothing() {
    for (index, tolerance) in [(1.0 + 1e-9, 1e-4), (1.0 - 1e-9, 1e-4), (1e3, 1e-2)] {
        let eye = camera(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y, 24.0);
        let mut scene = scene(vec![ball(1.0, DVec3::ZERO, glass(index, 0.0, 0.0))], vec![], eye, 12, 64);
        (scene.background, scene.settings.light.reflection_depth) = (RgbPower::ONE, 200);
        let rendering = render(&scene, true);
        let pixels = rendering.film.tallies();
        let mean = pixels.iter().map(|tally| tally.mean().x).sum::<f64>() / pixels.len() as f64;
        assert!((mean - 1.0).abs() < tolerance, "{index}: {mean}");
    }
}

#[test]
fn a_light_at_any_distance_follows_the_inverse_square() {
    for by_rays in [true, false] {
        for height in [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9] {
            let lamp = Light::Point { at: DVec3::Y * height, intensity: Color::grey(height * height) };
            let floor = ground(50.0, DMat4::IDENTITY, diffuse(0.8));
            let (found, _) =
                red(&render(&scene(vec![floor], vec![lamp], from_above(0.5, height * 1e-3), 1, 1), by_rays));
            assert!((found * PI / 0.8 - 1.0).abs() < 1e-4, "{by_rays} {height}: {found}");
        }
        // On the surface itself it may give anything that is a number; `render` looks.
        let lamp = Light::Point { at: DVec3::ZERO, intensity: Color::grey(1.0) };
        let floor = ground(50.0, DMat4::IDENTITY, diffuse(0.8));
        render(&scene(vec![floor], vec![lamp], from_above(0.5, 1.0), 9, 4), by_rays);
    }
}

#[test]
fn lights_a_millionth_wide_give_what_their_closed_forms_say() {
    const R: f64 = 1e-6;
    for height in [1.0, 1e-3, 1e-5, 1e-6] {
        let center = DVec3::Y * height;
        let disc = LightShape::Disc { center, normal: DVec3::NEG_Y, radius: R };
        let sphere = LightShape::Sphere { center, radius: R };
        let square = LightShape::Rectangle {
            corner: center - DVec3::new(R, 0.0, R),
            across: DVec3::X * (2.0 * R),
            up: DVec3::Z * (2.0 * R),
        };
        let of_disc = PI * R * R / (R * R + height * height);
        let of_sphere = PI * R * R / (height * height);
        // Four times Lambert's formula for the corner above the point.
        let side = R / R.hypot(height);
        let of_square = 4.0 * side * (R / R.hypot(height)).atan();
        for (patch, factor) in [(disc, of_disc), (sphere, of_sphere), (square, of_square)] {
            if matches!(patch, LightShape::Sphere { .. }) && height <= R {
                continue;
            }
            let light = Light::Area { patch, radiance: Color::grey(1.0 / factor) };
            let floor = ground(10.0, DMat4::IDENTITY, diffuse(0.8));
            // The eye is between the light and the floor.
            let view = from_above(height * 0.4, height * 1e-4);
            let (found, error) = red(&render(&scene(vec![floor], vec![light], view, 1, 1024), true));
            let part = found * PI / 0.8;
            assert!((part - 1.0).abs() < 5.0 * error + 5e-3, "{patch:?} at {height}: {part}");
        }
    }
}

/// A glass ball, a mirror and matt things under a lamp with a size and a point; all lengths times a factor, moved.
fn still_life(factor: f64, by: DVec3, by_rays: bool) -> Scene {
    let place = DMat4::from_translation(by) * DMat4::from_scale(DVec3::splat(factor));
    let mirror = Classic { mirror: Paint::grey(0.7), ..diffuse(0.1) };
    let mut objects = vec![
        ground(6.0, DMat4::IDENTITY, diffuse(0.6)),
        cuboid(DVec3::new(0.6, 1.2, 0.5), DVec3::new(-0.9, 0.6, -0.4), diffuse(0.7)),
        ball(0.5, DVec3::new(0.7, 0.5, -0.5), if by_rays { mirror } else { diffuse(0.4) }),
    ];
    if by_rays {
        objects.push(ball(0.4, DVec3::new(0.0, 0.4, 0.6), glass(1.5, 0.0, 0.3 / factor)));
    }
    objects.iter_mut().for_each(|object| object.transform = place * object.transform);
    let at = |point: DVec3| place.transform_point3(point);
    let intensity = Color::grey(8.0 * factor * factor);
    let mut lights = vec![Light::Point { at: at(DVec3::new(2.0, 3.0, 2.0)), intensity }];
    if by_rays {
        let patch = LightShape::Sphere { center: at(DVec3::new(-1.0, 2.5, 1.0)), radius: 0.2 * factor };
        lights.push(Light::Area { patch, radiance: Color::grey(20.0) });
    }
    let eye = camera(at(DVec3::new(0.4, 1.6, 4.5)), at(DVec3::new(0.0, 0.5, 0.0)), DVec3::Y, 34.0);
    let mut scene = scene(objects, lights, eye, 32, 9);
    scene.background = RgbPower::splat(0.3);
    scene
}

#[test]
fn a_scene_of_any_size_gives_the_same_picture() {
    for by_rays in [true, false] {
        let usual = render(&still_life(1.0, DVec3::ZERO, by_rays), by_rays).picture;
        for power in [-30, -20, 20, 30] {
            // Powers of two: no digit changes.
            let sized = render(&still_life(2f64.powi(power), DVec3::ZERO, by_rays), by_rays).picture;
            let apart = difference(&sized, &usual).expect("same size");
            assert!(apart.rmse < 1e-6, "2^{power}, rays {by_rays}: {apart:?}");
        }
        for factor in [1e-6, 1e6] {
            let sized = render(&still_life(factor, DVec3::ZERO, by_rays), by_rays).picture;
            let apart = difference(&sized, &usual).expect("same size");
            assert!(apart.rmse < 5e-3, "{factor}, rays {by_rays}: {apart:?}");
        }
    }
}

#[test]
fn a_scene_far_from_the_origin_gives_the_same_picture() {
    for by_rays in [true, false] {
        let usual = render(&still_life(1.0, DVec3::ZERO, by_rays), by_rays).picture;
        for (distance, most) in [(1e3, 5e-3), (1e5, 5e-3), (1e7, 1e-2), (1e8, 2e-2)] {
            let moved = render(&still_life(1.0, DVec3::new(1.0, -0.5, 0.7) * distance, by_rays), by_rays).picture;
            let apart = difference(&moved, &usual).expect("same size");
            assert!(apart.rmse < most, "{distance}, rays {by_rays}: {apart:?}");
        }
    }
}

#[test]
fn an_eye_on_a_surface_sees_as_one_on_one_of_its_sides() {
    for turn in [0.0, 0.3, 1.1] {
        let turned = DMat4::from_rotation_z(turn) * DMat4::from_rotation_x(0.7 * turn);
        let at = |point: DVec3| turned.transform_point3(point);
        for by_rays in [true, false] {
            let picture = |height: f64, towards: DVec3| {
                let mut slab = cuboid(DVec3::new(3.0, 1.0, 3.0), DVec3::NEG_Y * 0.5, diffuse(0.5));
                slab.transform = turned * slab.transform;
                let mut lid = cuboid(DVec3::ONE, DVec3::new(0.2, 2.0, 0.1), diffuse(0.9));
                lid.transform = turned * lid.transform;
                let from = DVec3::new(0.1, height, 0.3);
                let eye = camera(at(from), at(from + towards), at(DVec3::X), 50.0);
                let mut scene = scene(vec![slab, lid], vec![], eye, 16, 4);
                (scene.ambient, scene.background) = (RgbPower::ONE, RgbPower::splat(0.2));
                render(&scene, by_rays).picture
            };
            for towards in [DVec3::Y, DVec3::NEG_Y, DVec3::new(0.0, 1.0, 0.5)] {
                let found = picture(0.0, towards);
                let sides =
                    [1e-9, -1e-9].map(|height| difference(&found, &picture(height, towards)).expect("same size").rmse);
                assert!(sides.iter().any(|rmse| *rmse < 1e-3), "{turn} {towards} rays {by_rays}: {sides:?}");
            }
        }
    }
}

#[test]
fn depths_from_a_thousandth_to_ten_thousand_are_right_in_one_picture() {
    // Plates that face the eye, each ten times as far as the one before, side by side in the picture.
    let distances: Vec<f64> = (-3..=4).map(|power| 10f64.powi(power)).collect();
    let plate = |(index, distance): (usize, &f64)| {
        let aside = (index as f64 - 3.5) * 0.2 * distance;
        let upright = DMat4::from_translation(DVec3::new(aside, 0.0, -distance)) * DMat4::from_rotation_x(PI / 2.0);
        ground(0.1 * distance, upright, diffuse(0.5))
    };
    let objects: Vec<Object> = distances.iter().enumerate().map(plate).collect();
    let eye = Camera {
        near: 0.99e-3,
        far: Some(1.01e4),
        ..camera(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 2.0 * 0.8f64.atan().to_degrees())
    };
    let mut scene = scene(objects, vec![], eye, 64, 1);
    scene.ambient = RgbPower::ONE;
    for by_rays in [true, false] {
        let rendering = render(&scene, by_rays);
        for (index, distance) in distances.iter().enumerate() {
            // Pixels are 0.025 wide at distance 1: the middle of a plate lies between two of them.
            for (x, y) in [(8 * index as u32 + 4, 31), (8 * index as u32 + 3, 32)] {
                let tally = &rendering.film.tallies()[(y * 64 + x) as usize];
                assert_eq!(
                    (tally.count, tally.elements, tally.first_ids[0]),
                    (1, 1, index as u32),
                    "rays {by_rays}, {distance}"
                );
                let [right, up] = [x, y].map(|place| (f64::from(place) + 0.5) * 0.025 - 0.8);
                let expected = distance * DVec3::new(right, up, 1.0).length();
                assert!(
                    (tally.distances / expected - 1.0).abs() < 1e-9,
                    "rays {by_rays}: {} {expected}",
                    tally.distances
                );
            }
        }
    }
}
