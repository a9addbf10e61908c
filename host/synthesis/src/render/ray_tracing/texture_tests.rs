//! Facts about textures in pictures: means that are known, and pictures that two methods of filtering agree on.

use super::tests::{diffuse, from_above, mirror, object, red, scene, trace};
use super::two_way_tests::{block, two_way};
use super::*;
use crate::color::Color;
use crate::illumination::material::Classic;
use crate::illumination::texture::{Image, ImageContent, Motif, Pattern, Relief, TextureMapping};
use crate::illumination::{Light, Material, Paint};
use crate::picture::difference;
use crate::render::ray_tracer;
use crate::scene::{Camera, Scene, Shape};
use glam::{DMat4, DVec3};
use std::f64::consts::PI;

fn painted(motif: Motif, laying: TextureMapping) -> Classic {
    let paints =
        if matches!(motif, Motif::Image { .. }) { Vec::new() } else { vec![Paint::grey(0.0), Paint::grey(1.0)] };
    Classic { diffuse: Paint::Pattern(Box::new(Pattern { motif, laying, paints })), ..Classic::default() }
}

fn sized(size: f64) -> TextureMapping {
    TextureMapping { size: DVec3::splat(size), ..TextureMapping::default() }
}

/// A square of side 2 under ambient light alone: the picture is the reflectance.
fn square(material: impl Into<Material>, side: u32) -> Scene {
    let ground = object(Shape::Ground { size: 2.0 }, DMat4::IDENTITY, material);
    Scene { ambient: DVec3::ONE, ..scene(vec![ground], Vec::new(), side) }
}

#[test]
fn an_image_on_a_square_is_seen_as_it_is() {
    let image = Image::new("ramp".into(), 16, 16, |x, y| DVec3::new(f64::from(x) / 15.0, f64::from(y) / 15.0, 0.5));
    let picture =
        trace(&square(painted(Motif::Image { image }, sized(1.0)), 16), Some(from_above(1.0)), false, 1).picture;
    for y in 0..16 {
        for x in 0..16 {
            // The ground has u to the right and v away from the viewer, who looks down.
            let expected = [x as f32 / 15.0, y as f32 / 15.0, 0.5];
            let found = picture.get(x, y).expect("inside").radiance;
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4), "{x} {y} {found:?}");
        }
    }
}

#[test]
fn tiles_that_are_smaller_than_a_pixel_have_their_mean() {
    for samples in [1, 4, 64] {
        let mut scene = square(painted(Motif::Checker, sized(1.0 / 1000.0)), 8);
        scene.settings.image.samples = samples;
        let picture = trace(&scene, Some(from_above(0.7)), false, 1).picture;
        let worst = picture.pixels().iter().map(|p| (p.radiance[0] - 0.5).abs()).fold(0.0, f32::max);
        assert!(worst < 0.02, "{samples} samples: {worst}");
    }
}

#[test]
fn filtered_tiles_to_the_horizon_agree_with_many_points() {
    let camera = Camera {
        from: DVec3::new(0.0, 0.12, 1.0),
        at: DVec3::new(0.3, 0.0, 0.0),
        up: DVec3::Y,
        field_of_view: 50.0,
        near: 1e-4,
        far: None,
        lens: None,
        parallel: None,
        motion: None,
    };
    let at = |samples: u32, filter: f64, motif: &Motif| {
        let mut scene = square(painted(motif.clone(), sized(0.06)), 32);
        (scene.settings.image.samples, scene.settings.light.texture_filter) = (samples, filter);
        scene.camera = Some(camera);
        trace(&scene, None, false, 2).picture
    };
    let image = Image::new("quarters".into(), 64, 64, |x, y| DVec3::splat(f64::from((x / 32 + y / 32) % 2)));
    for motif in [Motif::Checker, Motif::Image { image }] {
        let exact = at(4096, 0.0, &motif);
        let error = |picture| difference(&picture, &exact).expect("same size").rmse;
        let (filtered, points, more) =
            (error(at(4, 1.0, &motif)), error(at(4, 0.0, &motif)), error(at(64, 1.0, &motif)));
        assert!(filtered < 0.7 * points, "{filtered} {points}");
        assert!(more < 0.5 * filtered, "what is filtered too much falls with the samples: {more} {filtered}");
    }
}

#[test]
fn what_a_curtain_of_a_pattern_lets_through_falls_on_the_floor() {
    // Stripes along x of nothing and of everything: the floor below has them, too.
    let image = Image::new("stripes".into(), 8, 1, |x, _| DVec3::splat(f64::from(x / 4)));
    let stripes = Pattern { motif: Motif::Image { image }, laying: sized(1.0), paints: Vec::new() };
    let curtain =
        Classic { diffuse: Paint::grey(0.0), transparency: Paint::Pattern(Box::new(stripes)), ..Classic::default() };
    let lamp = Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::grey(std::f64::consts::PI) };
    let floor = object(
        Shape::Ground { size: 2.0 },
        DMat4::IDENTITY,
        Classic { diffuse: Paint::grey(0.5), ..Classic::default() },
    );
    let curtain = object(Shape::Ground { size: 2.0 }, DMat4::from_translation(DVec3::Y), curtain);
    let scene = scene(vec![floor, curtain], vec![lamp], 64);
    let prepared = Prepared::new(&scene).expect("a scene");
    let view = from_above(1.0);
    let plan = Plan::new(&prepared, &view);
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let picture = tracer.render(&view, &RenderOrder::of(&scene.settings), &Watch::NOBODY).expect("a picture").picture;
    for (x, square) in [(16, 0.0), (48, 1.0f32)] {
        // Light goes through the curtain down and up again.
        let found = picture.get(x, 32).expect("inside").radiance[0];
        assert!((found - 0.5 * square).abs() < 1e-3, "{x}: {found}");
    }
}

#[test]
fn a_relief_tilts_what_a_plane_reflects() {
    // Normals of one image: all tilted by 30 degrees towards +u, where the light comes from.
    let (sin, cos) = 30.0_f64.to_radians().sin_cos();
    let image = Image::new("tilted".into(), 1, 1, |_, _| DVec3::new(0.5 + 0.5 * sin, 0.5, 0.5 + 0.5 * cos));
    let lamp = Light::Directional { direction: DVec3::new(-sin, -cos, 0.0), irradiance: Color::grey(1.0) };
    let mut material: Material = Classic { diffuse: Paint::grey(1.0), ..Classic::default() }.into();
    material.relief = Some(Relief::Normals { image, laying: TextureMapping::default() });
    let ground = object(Shape::Ground { size: 2.0 }, DMat4::IDENTITY, material);
    let picture = trace(&scene(vec![ground], vec![lamp], 4), Some(from_above(1.0)), false, 1).picture;
    let found = f64::from(picture.get(1, 1).expect("inside").radiance[0]);
    assert!((found - std::f64::consts::FRAC_1_PI).abs() < 1e-4, "light falls straight on the tilted normal: {found}");
}

#[test]
fn one_texel_and_sixteen_thousand_are_as_good_as_any_other_number() {
    for (width, height) in [(1, 1), (16_384, 2), (2, 16_384)] {
        let image = Image::new("grey".into(), width, height, |_, _| DVec3::splat(0.25));
        let picture =
            trace(&square(painted(Motif::Image { image }, sized(0.37)), 8), Some(from_above(0.9)), false, 1).picture;
        assert!(picture.pixels().iter().all(|p| (p.radiance[0] - 0.25).abs() < 1e-4), "{width} x {height}");
    }
}

#[test]
fn an_image_in_a_file_that_is_none_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("none.png");
    assert!(Image::read(&path, ImageContent::Color).is_err());
    std::fs::write(&path, b"\x89PNG\r\n\x1a\nbroken").expect("written");
    assert!(Image::read(&path, ImageContent::Color).is_err());
}

#[test]
fn light_from_lamps_follows_the_slope_of_a_relief() {
    // A level mirror, with a relief that rises evenly by 22.5 degrees, throws the sun from above on a wall.
    let image = Image::new("ramp".into(), 16, 16, |x, _| DVec3::splat(f64::from(x) / 15.0));
    let rise = 2.0 * 15.0 / 16.0 * (PI / 8.0).tan();
    let pattern = Pattern { motif: Motif::Image { image }, laying: TextureMapping::default(), paints: Vec::new() };
    let mut material = Material::from(mirror(0.8));
    material.relief = Some(Relief::Bumps { pattern, height: rise });
    let objects = vec![
        object(Shape::Ground { size: 2.0 }, DMat4::IDENTITY, material),
        block(DVec3::new(0.1, 8.0, 4.0), DVec3::new(-3.05, 4.0, 0.0), diffuse(0.5)),
    ];
    let sun = Light::Directional { direction: -DVec3::Y, irradiance: Color::grey(2.0) };
    let mut scene = scene(objects, vec![sun], 8);
    (scene.settings.image.samples, scene.settings.photons.count) = (4, 200_000);
    let mut camera = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::ZERO]));
    (camera.from, camera.at, camera.field_of_view) = (DVec3::Y * 3.0, DVec3::new(-3.0, 3.0, 0.0), 26.0);
    let rendering = two_way(&scene, Some(View::Camera(camera)), 1);
    let expected = 2.0 * 0.8 * 0.5 / PI;
    for (x, y) in (0..64).map(|i| (i % 8, i / 8)) {
        let found = red(&rendering, x, y);
        assert!((found / expected - 1.0).abs() < 0.05, "{x} {y}: {found} {expected}");
    }
}
