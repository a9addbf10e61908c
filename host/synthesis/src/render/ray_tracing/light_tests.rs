//! Facts about light in a scene: closed forms for lights that have a size, glass, and furnaces.

use super::tests::{diffuse, from_above, mirror, object, red, scene, trace};
use super::*;
use crate::color::{Color, Extrapolation, Spectrum};
use crate::illumination::Paint;
use crate::illumination::light::LightShape;
use crate::illumination::material::{
    Classic, Coated, Finish, Material, MaterialKind, Metal, RefractiveIndex, Transparent,
};
use crate::illumination::{Light, RgbPower};
use crate::picture::difference;
use crate::scene::{Camera, Caustics, Interreflection, Parallel, Scene, Shape};
use crate::solid::Primitive;
use glam::{DMat4, DVec2, DVec3};
use std::f64::consts::PI;

fn glass(index: f64, roughness: f64, absorption: f64) -> Material {
    let (index, absorption) = (RefractiveIndex::Constant(index), Color::grey(absorption));
    MaterialKind::Transparent(Transparent { roughness: roughness.into(), absorption, ..Transparent::clear(index) })
        .into()
}

fn sky(radiance: f64) -> Light {
    Light::Sky { map: None, radiance: Color::grey(radiance), turned: 0.0 }
}

fn ball(material: impl Into<Material>) -> Vec<crate::scene::Object> {
    vec![object(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY, material)]
}

fn mean(rendering: &crate::render::Rendering) -> f64 {
    let pixels = rendering.picture.pixels();
    pixels.iter().map(|pixel| f64::from(pixel.radiance[0])).sum::<f64>() / pixels.len() as f64
}

#[test]
fn light_of_a_disc_and_of_a_sphere_on_a_floor_follow_their_closed_forms() {
    let center = DVec3::new(0.0, 2.0, 0.0);
    let disc = LightShape::Disc { center, normal: DVec3::NEG_Y, radius: 0.5 };
    let sphere = LightShape::Sphere { center, radius: 0.5 };
    for (patch, irradiance) in [(disc, PI * 0.25 / (0.25 + 4.0)), (sphere, PI * 0.25 / 4.0)] {
        let floor = object(Shape::Ground { size: 20.0 }, DMat4::IDENTITY, diffuse(0.8));
        let light = Light::Area { patch, radiance: Color::grey(10.0) };
        let mut scene = scene(vec![floor], vec![light], 1);
        scene.settings.image.samples = 1024;
        // A pixel that sees a square of a hundredth around the foot point of the light, from below the light.
        let mut view = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::ZERO]));
        (view.from, view.at, view.up) = (DVec3::Y, DVec3::ZERO, DVec3::Z);
        (view.parallel, view.near) = (Some(Parallel { height: 0.01, oblique: DVec2::ZERO }), 0.5);
        let rendering = trace(&scene, Some(View::Camera(view)), false, 1);
        let expected = 10.0 * irradiance * 0.8 / PI;
        assert!((red(&rendering, 0, 0) / expected - 1.0).abs() < 2e-3, "{} {expected}", red(&rendering, 0, 0));
    }
}

#[test]
fn a_white_furnace_hides_what_loses_nothing() {
    let flat = |value: f64| Spectrum::regular(300.0, 600.0, vec![value; 2], Extrapolation::Held).expect("a spectrum");
    let perfect = |finish| MaterialKind::Metal(Metal { n: flat(0.0), k: flat(3.0), finish });
    let rough = Finish::Rough { name: "GGX, all".into(), roughness: 0.4.into() };
    let coated = |roughness| {
        MaterialKind::Coated(Coated { diffuse: Paint::grey(1.0), index: 1.5, roughness: f64::into(roughness) })
    };
    let materials: Vec<(Material, f64)> = vec![
        // Of a ball of triangles, some directions above the normal are below a triangle.
        (diffuse(1.0).into(), 5e-3),
        (mirror(1.0).into(), 1e-6),
        (perfect(Finish::Polished).into(), 1e-6),
        (perfect(rough).into(), 5e-3),
        (coated(0.0).into(), 1e-2),
        (coated(0.2).into(), 1e-2),
        (glass(1.5, 0.0, 0.0), 1e-2),
        (glass(1.5, 0.3, 0.0), 1e-2),
        (glass(1.5, 1.0, 0.0), 1e-2),
    ];
    for (material, tolerance) in materials {
        let mut scene = scene(ball(material.clone()), vec![sky(1.0)], 8);
        scene.settings.image.samples = 256;
        (scene.settings.light.reflection_depth, scene.settings.light.interreflection) = (60, Interreflection::Followed);
        scene.settings.light.spectral = Some(false);
        let found = mean(&trace(&scene, Some(from_above(0.7)), false, 2));
        assert!((found - 1.0).abs() < tolerance, "{}: {found}", material.word());
    }
}

#[test]
fn glass_of_the_index_of_air_cannot_be_seen_and_absorbs_by_its_thickness() {
    let pane =
        |material| object(Shape::from(Primitive::Box { size: DVec3::new(4.0, 2.0, 4.0) }), DMat4::IDENTITY, material);
    for (index, absorption) in [(1.0, 0.0), (1.0, 0.4), (1.5, 0.0), (1.5, 0.4)] {
        let mut scene = scene(vec![pane(glass(index, 0.0, absorption))], vec![], 2);
        scene.background = RgbPower::ONE;
        scene.settings.light.reflection_depth = 100;
        scene.settings.image.samples = 64;
        let found = mean(&trace(&scene, Some(from_above(0.5)), false, 1));
        // What comes through, and what is reflected before or within and comes from the background, too.
        let (r, a) = (f64::powi((index - 1.0) / (index + 1.0), 2), f64::exp(-2.0 * absorption));
        let expected = r + (1.0 - r) * (1.0 - r) * a / (1.0 - r * a);
        assert!((found - expected).abs() < 2e-3, "{index} {absorption}: {found} {expected}");
    }
}

#[test]
fn an_eye_in_water_sees_through_water_from_the_beginning() {
    let block = |size: f64, at: DVec3, material: Material| {
        let shape = Shape::from(Primitive::Box { size: DVec3::splat(size) });
        object(shape, DMat4::from_translation(at), material)
    };
    let water = block(20.0, DVec3::ZERO, glass(1.33, 0.0, 0.3));
    // Light that is the same everywhere on something that reflects all of it: radiance 1.
    let white = block(2.0, DVec3::NEG_Z * 4.0, diffuse(1.0).into());
    let ball = Shape::from(Primitive::Sphere { radius: 0.5 });
    let clear = object(ball, DMat4::from_translation(DVec3::NEG_Z), glass(1.33, 0.0, 0.0));
    let mut camera = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::ZERO]));
    (camera.from, camera.at, camera.field_of_view) = (DVec3::ZERO, DVec3::NEG_Z, 0.1);
    for (objects, way) in [(vec![water.clone(), white.clone()], 3.0), (vec![water, white, clear], 2.0)] {
        let mut scene = scene(objects, vec![], 1);
        scene.ambient = RgbPower::ONE;
        (scene.settings.image.samples, scene.settings.light.reflection_depth) = (16, 4);
        let found = red(&trace(&scene, Some(View::Camera(camera)), false, 1), 0, 0);
        let expected = f64::exp(-0.3 * way);
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    }
}

#[test]
fn rays_that_carry_spectra_show_the_colors_of_those_that_carry_bands() {
    // As many samples as there are wavelength sets: each is used once, and nothing else differs within a pixel.
    let sun = Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::Bands(RgbPower::new(3.0, 2.0, 1.0)) };
    let floor = Classic { diffuse: Paint::grey(0.6), ..Classic::default() };
    let mut scene = scene(vec![object(Shape::Ground { size: 9.0 }, DMat4::IDENTITY, floor)], vec![sun], 2);
    scene.settings.image.samples = 64;
    let [bands, spectra] = [false, true].map(|spectral| {
        scene.settings.light.spectral = Some(spectral);
        trace(&scene, Some(from_above(2.0)), false, 2).picture
    });
    let apart = difference(&spectra, &bands).expect("same size");
    assert!(apart.largest < 2e-4, "{apart:?}");
}

#[test]
fn what_emits_lights_as_the_area_light_of_its_form() {
    // A square that emits, as an object and as a light.
    let floor = || object(Shape::Ground { size: 20.0 }, DMat4::IDENTITY, diffuse(0.8));
    let mut glowing = Material::from(diffuse(0.0));
    glowing.emission = Color::grey(5.0);
    let turned = DMat4::from_translation(DVec3::new(0.0, 2.0, 0.0)) * DMat4::from_rotation_x(PI);
    let lamp = object(Shape::Ground { size: 1.0 }, turned, glowing);
    let patch = LightShape::Rectangle { corner: DVec3::new(-0.5, 2.0, -0.5), across: DVec3::X, up: DVec3::Z };
    let light = Light::Area { patch, radiance: Color::grey(5.0) };
    let mut scenes = [scene(vec![floor(), lamp], vec![], 6), scene(vec![floor()], vec![light], 6)];
    let [object, light] = scenes.each_mut().map(|scene: &mut Scene| {
        scene.settings.image.samples = 256;
        trace(scene, Some(from_above(3.0)), false, 2).picture
    });
    // Where the lamp itself is in sight, its back is seen.
    let beside = |index: &usize| !(2..4).contains(&(index % 6)) || !(2..4).contains(&(index / 6));
    for index in (0..36).filter(beside) {
        let (a, b) = (object.pixels()[index], light.pixels()[index]);
        assert!((a.radiance[0] - b.radiance[0]).abs() < 0.03 * b.radiance[0] + 0.02, "{a:?} {b:?}");
    }
}

#[test]
fn a_hundred_mirrors_face_to_face_give_the_geometric_series() {
    let plate = |height: f64, material| {
        object(Shape::Ground { size: 50.0 }, DMat4::from_translation(DVec3::Y * height), material)
    };
    let mut glowing = Material::from(mirror(0.9));
    glowing.emission = Color::grey(1.0);
    let mut scene = scene(vec![plate(0.0, glowing), plate(2.0, mirror(0.8).into())], vec![], 1);
    (scene.settings.light.reflection_depth, scene.settings.image.samples) = (200, 64);
    let mut down = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::ZERO]));
    (down.from, down.at, down.up, down.field_of_view) = (DVec3::Y, DVec3::ZERO, DVec3::Z, 1e-3);
    let found = red(&trace(&scene, Some(View::Camera(down)), false, 1), 0, 0);
    let expected = 1.0 / (1.0 - 0.9 * 0.8);
    assert!((found - expected).abs() < 2e-3, "{found} {expected}");
}

#[test]
fn a_thin_gap_between_two_glass_spheres_is_not_lost() {
    // A sphere of the same glass within a shell of it: the gap of air remains, however thin.
    let solid = |radius: f64| Shape::from(Primitive::Sphere { radius });
    let through = |gap: f64| {
        let shell = object(solid(1.0), DMat4::IDENTITY, glass(1.5, 0.0, 0.0));
        let hollow = object(solid(0.5 + gap), DMat4::IDENTITY, glass(1.0, 0.0, 0.0));
        let core = object(solid(0.5), DMat4::IDENTITY, glass(1.5, 0.0, 0.0));
        let mut scene = scene(vec![shell, hollow, core], vec![], 1);
        scene.background = RgbPower::ONE;
        (scene.settings.image.samples, scene.settings.geometry.tolerance) = (64, Some(1e-3));
        scene.settings.light.reflection_depth = 60;
        let rendering = trace(&scene, Some(from_above(0.02)), false, 1);
        (mean(&rendering), rendering.rays.reflected)
    };
    for gap in [1e-1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12] {
        let (light, rays) = through(gap);
        assert!((light - 1.0).abs() < 0.02 && rays >= 6 * 64, "{gap}: {light}, {rays} rays");
    }
}

#[test]
fn a_lens_is_sharp_where_it_is_focused_and_nowhere_else() {
    let stripe =
        object(Shape::from(Primitive::Box { size: DVec3::new(1.0, 4.0, 0.01) }), DMat4::IDENTITY, diffuse(1.0));
    let mut scene = scene(vec![stripe], vec![], 16);
    scene.ambient = RgbPower::ONE;
    scene.settings.image.samples = 64;
    let contrast = |focus: f64| {
        let mut camera = Camera::framing(&crate::numeric::bounds::Bounds::of([DVec3::ZERO]));
        (camera.from, camera.at, camera.field_of_view) = (DVec3::Z * 10.0, DVec3::ZERO, 20.0);
        camera.lens = Some(crate::scene::Lens { radius: 0.5, focus });
        let rendering = trace(&scene, Some(View::Camera(camera)), false, 2);
        (0..16).map(|x| red(&rendering, x, 8)).filter(|value| (0.02..0.98).contains(value)).count()
    };
    assert!(contrast(10.0) <= 2 && contrast(5.0) >= 4, "{} {}", contrast(10.0), contrast(5.0));
}

#[test]
fn a_sphere_far_from_the_origin_is_lit_as_one_at_the_origin() {
    let at = |place: f64| {
        let center = DVec3::new(place, 0.0, 0.0);
        let shape = Shape::from(Primitive::Sphere { radius: 1.0 });
        let mut scene = scene(vec![object(shape, DMat4::from_translation(center), diffuse(0.7))], vec![sky(1.0)], 12);
        scene.settings.image.samples = 16;
        let mut camera = Camera::framing(&crate::numeric::bounds::Bounds::of([center]));
        (camera.from, camera.at, camera.field_of_view) = (center + DVec3::Z * 5.0, center, 30.0);
        scene.camera = Some(camera);
        trace(&scene, None, false, 2).picture
    };
    let near = at(0.0);
    for place in [1e4, 1e6, 1e8] {
        let apart = difference(&at(place), &near).expect("same size");
        assert!(apart.rmse < 1e-2, "{place}: {apart:?}");
    }
}

#[test]
fn a_pane_that_lets_everything_through_hides_no_light_of_a_lamp() {
    // Glossy and diffuse lobes, a lamp with a size and one that emits as an object, with and without a pane between.
    let coat = MaterialKind::Coated(Coated { diffuse: Paint::grey(0.5), index: 1.5, roughness: 0.3.into() });
    let clear = Classic { transparency: Paint::grey(1.0), ..diffuse(0.0) };
    let shining = Material { emission: Color::grey(8.0), ..Material::from(diffuse(0.0)) };
    let patch = LightShape::Rectangle { corner: DVec3::new(-1.5, 2.0, -0.5), across: DVec3::X, up: DVec3::Z };
    let lamp = Light::Area { patch, radiance: Color::grey(8.0) };
    let seen = |pane: bool, depth: u32| {
        let floor = object(Shape::Ground { size: 4.0 }, DMat4::IDENTITY, coat.clone());
        let other = DMat4::from_translation(DVec3::new(1.0, 2.0, 0.0)) * DMat4::from_rotation_x(PI);
        let mut objects = vec![floor, object(Shape::Ground { size: 1.0 }, other, shining.clone())];
        if pane {
            objects.push(object(Shape::Ground { size: 20.0 }, DMat4::from_translation(DVec3::Y), clear.clone()));
        }
        let mut scene = scene(objects, vec![lamp.clone()], 12);
        (scene.settings.image.samples, scene.settings.light.reflection_depth) = (256, depth);
        scene.settings.light.interreflection = Interreflection::Followed;
        let below = from_above(1.0);
        mean(&trace(&scene, Some(below), false, 2))
    };
    for depth in [1, 4] {
        let (with, without) = (seen(true, depth + 1), seen(false, depth));
        assert!((with / without - 1.0).abs() < 0.01, "{depth}: {with} {without}");
    }
}

#[test]
fn highlights_behind_broad_scattering_are_cut_off_unless_caustics_count() {
    // A small bright lamp over a smooth coat beside a matt wall: what the wall shows of it comes by chance only.
    let wall = DMat4::from_translation(DVec3::new(0.0, 0.0, -1.0)) * DMat4::from_rotation_x(PI / 2.0);
    let coat = MaterialKind::Coated(Coated { diffuse: Paint::grey(0.0), index: 1.5, roughness: 0.03.into() });
    let lamp = LightShape::Sphere { center: DVec3::new(0.0, 1.5, 1.0), radius: 0.02 };
    let spots = |caustics: bool| {
        let floor = object(Shape::Ground { size: 4.0 }, DMat4::IDENTITY, coat.clone());
        let wall = object(Shape::Ground { size: 4.0 }, wall, diffuse(0.8));
        let lamp = Light::Area { patch: lamp, radiance: Color::grey(2000.0) };
        let mut scene = scene(vec![floor, wall], vec![lamp], 24);
        (scene.settings.image.samples, scene.settings.light.interreflection, scene.settings.light.caustics) =
            (16, Interreflection::Followed, if caustics { Caustics::PathTraced } else { Caustics::LeftOut });
        let camera = Camera {
            from: DVec3::new(0.0, 1.0, 3.0),
            at: DVec3::new(0.0, 1.0, -1.0),
            up: DVec3::Y,
            field_of_view: 25.0,
            near: 0.1,
            far: None,
            lens: None,
            parallel: None,
            motion: None,
        };
        scene.camera = Some(camera);
        let film = trace(&scene, None, false, 2).film;
        film.tallies().iter().map(|tally| tally.variance()).fold(0.0, f64::max).sqrt()
    };
    let (with, without) = (spots(true), spots(false));
    assert!(without < 0.4 * with, "{without} {with}");
}

#[test]
#[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
fn the_light_buffer_changes_no_picture_and_spares_rays() {
    // A lamp, the sun and a large light over a bunny, walls with a hole, and a pane of red glass.
    let sheet = |width: f64, x: f64, material: Classic| {
        let size = DVec3::new(width, 4.0, 0.1);
        object(Shape::from(Primitive::Box { size }), DMat4::from_translation(DVec3::new(x, 2.0, 2.0)), material)
    };
    let red = Color::Bands(DVec3::new(0.6, 0.1, 0.1));
    let pane = Classic { transparency: red.into(), ..diffuse(0.0) };
    let objects = vec![
        object(Shape::Ground { size: 20.0 }, DMat4::IDENTITY, diffuse(0.6)),
        object(Shape::Bunny, DMat4::from_translation(DVec3::Y), diffuse(0.7)),
        sheet(3.0, -2.0, diffuse(0.7)),
        sheet(3.0, 2.5, diffuse(0.7)),
        sheet(1.5, 0.25, pane),
    ];
    let lights = vec![
        Light::Directional { direction: DVec3::new(0.2, -1.0, -1.0), irradiance: Color::grey(2.0) },
        Light::Point { at: DVec3::new(0.5, 1.5, 4.0), intensity: Color::grey(20.0) },
        Light::Area {
            patch: LightShape::Sphere { center: DVec3::new(-3.0, 3.0, -2.0), radius: 0.05 },
            radiance: Color::grey(500.0),
        },
        Light::Area {
            patch: LightShape::Disc { center: DVec3::new(0.0, 6.0, 0.0), normal: DVec3::NEG_Y, radius: 2.0 },
            radiance: Color::grey(1.0),
        },
    ];
    let mut scene = scene(objects, lights, 48);
    scene.settings.image.samples = 16;
    let mut drawn = |buffer: bool| {
        scene.settings.light.buffer = buffer;
        trace(&scene, Some(from_above(4.0)), false, 2)
    };
    let (with, without) = (drawn(true), drawn(false));
    assert_eq!(with.picture, without.picture);
    assert_eq!(without.rays.spared, 0);
    assert!(with.rays.spared > 1000, "{:?}", with.rays);
}
