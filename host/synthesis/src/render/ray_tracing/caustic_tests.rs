//! Closed forms of light behind mirrors and glass: nephroid and cardioid, lens, prism, slab and ball.

use super::tests::{diffuse, from_above, mirror, object, red, scene};
use super::two_way_tests::{ball, block, glass, lamp, two_way};
use super::*;
use crate::color::{Color, Extrapolation, Spectrum, shipped};
use crate::illumination::Light;
use crate::illumination::material::{Material, MaterialKind, RefractiveIndex, Transparent};
use crate::numeric::bounds::Bounds;
use crate::render::two_way::FluxBalance;
use crate::scene::{Camera, Object, Scene, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec2, DVec3};
use std::f64::consts::PI;

/// The reflected part of light that is not polarised.
///
/// # Source
/// Fresnel's equations.
pub(super) fn fresnel(index: f64, cosine: f64) -> f64 {
    let inside = (1.0 - (1.0 - cosine * cosine) / (index * index)).sqrt();
    let perpendicular = (cosine - index * inside) / (cosine + index * inside);
    let parallel = (index * cosine - inside) / (index * cosine + inside);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// Looks straight down on a square around a point, from a height above it.
pub(super) fn down_on(at: DVec3, half: f64, height: f64) -> View {
    let mut camera = Camera::framing(&Bounds::of([at]));
    (camera.from, camera.at, camera.up) = (at + DVec3::Y * height, at, DVec3::NEG_Z);
    camera.field_of_view = 2.0 * (half / height).atan().to_degrees();
    View::Camera(camera)
}

/// A mirror of a third of a cylinder of radius 1 around the y axis, hollow towards −x, on a floor.
fn hollow_mirror(height: f64, light: Light) -> Scene {
    let corners = [(1.0, -0.02), (1.02, -0.02), (1.02, height), (1.0, height)].map(|(x, y)| DVec2::new(x, y));
    let bent = Primitive::RevolvedPolygon { contours: vec![corners.to_vec()], turn: 1.0 / 3.0 };
    let objects = vec![
        block(DVec3::new(5.0, 0.1, 5.0), DVec3::new(0.0, -0.05, 0.0), diffuse(0.5)),
        object(Shape::from(bent), DMat4::from_rotation_y(PI / 6.0), mirror(1.0)),
    ];
    let mut scene = scene(objects, vec![light], ACROSS);
    (scene.settings.image.samples, scene.settings.photons.count) = (9, 200_000);
    scene
}

/// Columns of the picture of the floor around a hollow mirror, -1 to 1.
const ACROSS: u32 = 51;

/// Along the axis of a hollow mirror: x, and the irradiance as the floor shows it.
fn along_the_axis(scene: &Scene) -> Vec<(f64, f64)> {
    let rendering = two_way(scene, Some(from_above(1.0)), 2);
    let row = ACROSS / 2;
    let mean = |x: u32| [row - 1, row, row + 1].map(|y| red(&rendering, x, y)).iter().sum::<f64>() / 3.0;
    let place = |x: u32| (f64::from(x) + 0.5) * 2.0 / f64::from(ACROSS) - 1.0;
    (0..ACROSS).map(|x| (place(x), mean(x) * PI / 0.5)).collect()
}

/// Compares irradiance along an axis where a closed form is smooth.
fn compare(found: &[(f64, f64)], expected: impl Fn(f64) -> f64, smooth: &[[f64; 2]]) {
    let (mut squares, mut count) = (0.0, 0.0);
    for (x, e) in found.iter().filter(|(x, _)| smooth.iter().any(|[from, to]| (from..=to).contains(&x))) {
        let error = e / expected(*x) - 1.0;
        assert!(error.abs() < 0.1, "{x}: {e} {}", expected(*x));
        (squares, count) = (squares + error * error, count + 1.0);
    }
    let mean = f64::sqrt(squares / count);
    assert!(mean < 0.03 && count > 9.0, "{mean} {count}");
}

/// The zero of the straight line through some points.
fn zero(points: &[(f64, f64)]) -> f64 {
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let slope = mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x).powi(2));
    x - y / slope
}

#[test]
fn a_hollow_mirror_bends_parallel_light_to_a_nephroid() {
    let light = Light::Directional { direction: DVec3::new(1.0, -1.0, 0.0), irradiance: Color::grey(2.0) };
    let found = along_the_axis(&hollow_mirror(1.2, light));
    // A ray that hits the mirror at angle t from the axis is thrown along 2 t; s behind the mirror its neighbour is |2
    // s / cos t − 1| times as far away as they were. From beyond the cusp two more rays come, of cos t = 1 / 2x.
    let direct = 2.0 * 0.5f64.sqrt();
    let expected = |x: f64| {
        let others = if x > 0.5 { 2.0 / (4.0 * x * x - 1.0) } else { 0.0 };
        direct * (1.0 + 1.0 / (1.0 - 2.0 * x).abs() + others)
    };
    compare(&found, expected, &[[-0.1, 0.36], [0.66, 0.8]]);
    // What is thrown grows beyond all bounds towards the cusp.
    let before = found.iter().filter(|(x, _)| (-0.1..0.3).contains(x));
    let inverse: Vec<(f64, f64)> = before.map(|(x, e)| (*x, direct / (e - direct))).collect();
    let cusp = zero(&inverse);
    assert!((cusp - 0.5).abs() < 0.02, "{cusp}");
}

#[test]
fn a_hollow_mirror_bends_light_from_its_rim_to_a_cardioid() {
    let (height, intensity) = (1.0, 5.0);
    let found = along_the_axis(&hollow_mirror(0.42 * height, lamp(DVec3::new(-1.0, height, 0.0), intensity)));
    // By the equation of a hollow mirror: from the rim, 2 cos i away, to a focus 2 cos i / 3 behind it, i half of the
    // angle t of the mirror's place. `way` is the whole distance along the floor.
    let plain = |way: f64| intensity * height / (way * way + height * height).powf(1.5);
    let thrown = |before: f64, behind: f64| {
        plain(before + behind) * (before + behind) / (before * (1.0 - 3.0 * behind / before).abs())
    };
    let expected = |x: f64| plain(1.0 + x) + thrown(2.0, 1.0 - x);
    compare(&found, expected, &[[-0.2, 0.2]]);
    let before = found.iter().filter(|(x, _)| (-0.2..0.17).contains(x));
    let inverse: Vec<(f64, f64)> =
        before.map(|(x, e)| (*x, plain(3.0 - x) * (3.0 - x) / (e - plain(1.0 + x)))).collect();
    let cusp = zero(&inverse);
    assert!((cusp - 1.0 / 3.0).abs() < 0.03, "{cusp}");
}

#[test]
fn irradiance_behind_a_lens_grows_as_its_light_draws_together() {
    let (index, radius, height) = (1.5, 0.5, 0.0125);
    let curvature = radius * radius / (2.0 * height);
    let lens = Primitive::Paraboloid { radius, height };
    let reflected = fresnel(index, 1.0);
    let inside = index * curvature / (index - 1.0);
    let focus = (inside - height) / index;
    // Light that is reflected at the flat face and again at the curved one.
    let ghost = ((index - 1.0) / curvature + 2.0 * index / curvature).recip();
    for behind in [5.0, 8.0, 12.0, 16.0] {
        let objects = vec![
            object(Shape::from(lens.clone()), DMat4::IDENTITY, glass(index)),
            block(DVec3::new(2.0, 0.1, 2.0), DVec3::new(0.0, -behind - 0.05, 0.0), diffuse(0.5)),
        ];
        let light = Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::grey(1.0) };
        let mut scene = scene(objects, vec![light], 8);
        (scene.settings.image.samples, scene.settings.photons.count) = (4, 200_000);
        let drawn = 1.0 - behind / focus;
        let rendering = two_way(&scene, Some(down_on(DVec3::NEG_Y * behind, 0.15 * drawn, 0.5)), 2);
        let pixels = rendering.picture.pixels();
        let found = pixels.iter().map(|p| f64::from(p.radiance[0])).sum::<f64>() / pixels.len() as f64 * PI / 0.5;
        let once = ((1.0 - height / inside) * drawn).powi(-2);
        let expected = (1.0 - reflected).powi(2) * (once + (reflected / (1.0 - behind / ghost)).powi(2));
        assert!((found / expected - 1.0).abs() < 0.01, "{behind}: {found} {expected}");
    }
}

/// By how much a prism turns light, radians.
fn deviation(index: f64, apex: f64, incidence: f64) -> f64 {
    let first = (incidence.sin() / index).asin();
    incidence + (index * (apex - first).sin()).asin() - apex
}

#[test]
fn a_prism_turns_each_wavelength_as_snell_and_sellmeier_tell() {
    let flint = shipped::glass("SF11").expect("a glass");
    let (apex, incidence, below) = (PI / 3.0, 58f64.to_radians(), 10.0);
    let corners = [90.0f64, 210.0, 330.0].map(|angle| DVec2::from_angle(angle.to_radians()) * 0.01);
    let prism = Primitive::Prism { contours: vec![corners.to_vec()], height: 0.02 };
    let material = Transparent::clear(RefractiveIndex::Dispersive(flint.clone()));
    let material = Material::from(MaterialKind::Transparent(material));
    // The outside of its left face looks towards 150 degrees. Not at the least deviation: there the base mirrors light
    // to the same place.
    let turned = DMat4::from_rotation_z(PI / 6.0 - incidence);
    for wavelength in [480.0, 546.0, 588.0, 650.0] {
        let line = [(-6.0, 0.0), (0.0, 1.0), (6.0, 0.0)].map(|(by, of)| (wavelength + by, of));
        let line = Spectrum::irregular(&line, Extrapolation::Zero).expect("a spectrum");
        let light = Light::Directional { direction: DVec3::X, irradiance: Color::Spectrum(line) };
        // Along the light, so that none of it falls there straight.
        let screen = block(DVec3::new(12.0, 0.1, 12.0), DVec3::new(0.0, -below - 0.05, 0.0), diffuse(0.5));
        let objects = vec![object(Shape::from(prism.clone()), turned, material.clone()), screen];
        let mut scene = scene(objects, vec![light], 41);
        (scene.settings.image.samples, scene.settings.photons.count) = (4, 100_000);
        (scene.settings.light.spectral, scene.settings.photons.radius) = (Some(true), Some(0.03));
        let expected = below / deviation(flint.index(wavelength).expect("an index"), apex, incidence).tan();
        let rendering = two_way(&scene, Some(down_on(DVec3::new(expected, -below, 0.0), 0.15, 1.0)), 2);
        let (mut all, mut moment) = (0.0, 0.0);
        for (x, y) in (0..41u32).flat_map(|x| (0..41).map(move |y| (x, y))) {
            let radiance = rendering.picture.get(x, y).expect("inside").radiance;
            let light = radiance.iter().map(|band| f64::from(band.abs())).sum::<f64>();
            (all, moment) = (all + light, moment + light * (f64::from(x) - 20.0) * 0.3 / 41.0);
        }
        assert!(all > 0.0 && (moment / all).abs() < 0.015, "{wavelength}: {expected} {:+}", moment / all);
    }
}

/// The flux balance of parallel light on something over a wide floor, as parts of what hit it first.
fn parts(thing: Object, direction: DVec3) -> FluxBalance {
    let floor = block(DVec3::new(200.0, 0.1, 200.0), DVec3::new(0.0, -10.0, 0.0), diffuse(0.5));
    let light = Light::Directional { direction, irradiance: Color::grey(1.0) };
    let mut scene = scene(vec![thing, floor], vec![light], 4);
    (scene.settings.image.samples, scene.settings.photons.count) = (1, 200_000);
    let balance = two_way(&scene, Some(from_above(1.0)), 2).flux_balance.expect("photons are traced");
    let met = balance.sent - balance.straight;
    FluxBalance {
        stored: balance.stored / met,
        absorbed: balance.absorbed / met,
        escaped: balance.escaped / met,
        ..balance
    }
}

#[test]
fn a_slab_lets_through_what_fresnel_tells() {
    for (index, degrees) in [(1.5, 0.0), (1.5, 60.0), (2.42, 45.0), (1.1, 80.0)] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let slab = block(DVec3::new(4.0, 1e-3, 4.0), DVec3::ZERO, glass(index));
        let found = parts(slab, DVec3::new(sin, -cos, 0.0));
        // With all reflections between the faces.
        let reflected = fresnel(index, cos);
        let expected = (1.0 - reflected) / (1.0 + reflected);
        assert!((found.stored - expected).abs() < 5e-3, "{index} {degrees}: {} {expected}", found.stored);
        assert!((found.escaped - (1.0 - expected)).abs() < 5e-3 && found.absorbed.abs() < 1e-9);
    }
}

#[test]
fn a_ball_of_dark_glass_absorbs_what_fresnel_and_bouguer_tell() {
    let (index, absorption) = (1.5, 0.7);
    let glass =
        Transparent { absorption: Color::grey(absorption), ..Transparent::clear(RefractiveIndex::Constant(index)) };
    let found = parts(ball(1.0, DVec3::ZERO, MaterialKind::Transparent(glass)), DVec3::NEG_Y);
    // Over the disc, evenly by the square of the distance from its middle. Each chord is as long, each reflection as
    // strong.
    let term = |k: u32| {
        let square = (f64::from(k) + 0.5) / 10_000.0;
        let reflected = fresnel(index, (1.0 - square).sqrt());
        let passed = (-absorption * 2.0 * (1.0 - square / (index * index)).sqrt()).exp();
        (1.0 - reflected) * (1.0 - passed) / (1.0 - reflected * passed) / 10_000.0
    };
    let expected = (0..10_000).map(term).sum::<f64>();
    assert!((found.absorbed - expected).abs() < 5e-3, "{} {expected}", found.absorbed);
}
