//! Facts about scan line: closed forms, and what ray tracing finds of the same scenes.

use super::*;
use crate::color::Color;
use crate::illumination::light::LightShape;
use crate::illumination::material::{Classic, MaterialKind, RefractiveIndex, Transparent};
use crate::illumination::texture::{Motif, Pattern, TextureMapping};
use crate::illumination::{Material, Paint, RgbPower};
use crate::numeric::ray::Ray;
use crate::octree::{Octree, OctreeSettings};
use crate::render::ray_tracer;
use crate::scene::{Camera, Object, Parallel, Projection, Scene, Settings, Shape};
use crate::solid::Primitive;
use crate::stages::{StageEvent, observed};
use glam::{DMat4, DVec2, DVec4};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;

type Lamps = Vec<crate::illumination::Light>;

fn object(shape: Shape, transform: DMat4, material: impl Into<Material>) -> Object {
    Object { name: shape.word().into(), shape, transform, material: Some(material.into()), tolerance: None }
}

fn diffuse(k: f64) -> Classic {
    Classic { diffuse: Paint::grey(k), ..Classic::default() }
}

fn ground(size: f64) -> Object {
    object(Shape::Ground { size }, DMat4::IDENTITY, diffuse(0.6))
}

fn cuboid(size: DVec3, at: DVec3) -> Object {
    let transform = DMat4::from_translation(at) * DMat4::from_rotation_y(0.4);
    object(Shape::from(Primitive::Box { size }), transform, diffuse(0.5))
}

/// A floor with two boxes, one of which is sunk into it, and into the other.
fn boxes() -> Vec<Object> {
    vec![
        ground(20.0),
        cuboid(DVec3::new(1.0, 2.0, 1.0), DVec3::new(1.0, 1.0, 0.0)),
        cuboid(DVec3::new(2.5, 0.8, 2.0), DVec3::new(-0.3, 0.2, 0.5)),
    ]
}

fn pane(at: DVec3, turned: f64) -> Object {
    let through = Paint::Plain(Color::Bands(RgbPower::new(0.8, 0.5, 0.3)));
    let material = Classic { transparency: through, ..diffuse(0.2) };
    let transform = DMat4::from_translation(at) * DMat4::from_rotation_y(turned);
    object(Shape::from(Primitive::Box { size: DVec3::new(1.5, 2.0, 0.1) }), transform, material)
}

/// Turns a ground so that it faces a viewer on the z axis.
fn facing(z: f64) -> DMat4 {
    DMat4::from_translation(DVec3::Z * z) * DMat4::from_rotation_x(PI / 2.0)
}

/// Squares, light and dark.
fn checker(size: f64) -> Paint {
    let laying = TextureMapping { size: DVec3::splat(size), ..TextureMapping::default() };
    let paints = vec![Paint::grey(0.1), Paint::grey(0.9)];
    Paint::Pattern(Pattern { motif: Motif::Checker, laying, paints }.into())
}

fn lamp(at: DVec3) -> crate::illumination::Light {
    crate::illumination::Light::Point { at, intensity: Color::grey(30.0) }
}

fn sun() -> crate::illumination::Light {
    crate::illumination::Light::Directional { direction: DVec3::new(1.0, -1.0, -0.5), irradiance: Color::grey(2.0) }
}

fn spot() -> crate::illumination::Light {
    let (at, direction) = (DVec3::new(-3.0, 5.0, 1.0), DVec3::new(0.6, -1.0, -0.1));
    crate::illumination::Light::Spot { at, direction, intensity: Color::grey(60.0), inner: 10.0, outer: 25.0 }
}

fn camera(from: DVec3, at: DVec3) -> Camera {
    Camera {
        from,
        at,
        up: DVec3::Y,
        field_of_view: 35.0,
        near: 0.0,
        far: None,
        lens: None,
        parallel: None,
        motion: None,
    }
}

fn usual() -> Camera {
    camera(DVec3::new(1.0, 3.0, 8.0), DVec3::new(0.0, 0.8, 0.0))
}

fn scene(objects: Vec<Object>, lights: Lamps, camera: Camera) -> Scene {
    let settings = Settings::of_size(72, 64, 16);
    let (ambient, background) = (RgbPower::splat(0.05), RgbPower::new(0.3, 0.4, 0.5));
    Scene { objects, lights, settings, camera: Some(camera), ambient, background, ..Scene::default() }
}

fn order(scene: &Scene, threads: usize) -> RenderOrder {
    RenderOrder { threads: NonZeroUsize::new(threads), ..RenderOrder::of(&scene.settings) }
}

fn scan(scene: &Scene, view: Option<View>, threads: usize) -> Rendering {
    let prepared = Prepared::new(scene).unwrap_or_else(|e| panic!("{e}"));
    let view = view.unwrap_or(prepared.view());
    let plan = Plan::new(&prepared, &view);
    let scan = ScanLine::new(&prepared, &plan).expect("ready");
    scan.render(&view, &order(scene, threads), &Watch::NOBODY).expect("a picture")
}

/// Compares a scene with many rays: the mean difference, and the shares of pixels that differ by more than a tenth, and
/// in what is known beside the light.
fn compared(scene: &Scene, view: Option<View>) -> [f64; 3] {
    let prepared = Prepared::new(scene).unwrap_or_else(|e| panic!("{e}"));
    let view = view.unwrap_or(prepared.view());
    let plan = Plan::new(&prepared, &view);
    let order = RenderOrder { samples: 64, ..order(scene, 2) };
    let traced = ray_tracer(&prepared, &plan).expect("ready").render(&view, &order, &Watch::NOBODY);
    let (traced, drawn) = (traced.expect("a picture"), scan(scene, Some(view), 2));
    let mut sums = [0.0; 3];
    for (index, (a, b)) in drawn.film.tallies().iter().zip(traced.film.tallies()).enumerate() {
        let off = (a.mean() - b.mean()).abs().max_element();
        sums[0] += off;
        sums[1] += f64::from(off > 0.1);
        let [covered_a, covered_b] = [a, b].map(|tally| tally.coverage());
        assert!((covered_a - covered_b).abs() < 0.2, "pixel {index} is covered by {covered_a}, not {covered_b}");
        if a.elements == a.count && b.elements == b.count {
            let [near, far] = [a, b].map(|tally| tally.distances / f64::from(tally.elements));
            let [one, two] = [a, b].map(|tally| tally.normals / f64::from(tally.elements));
            sums[2] += f64::from((near / far - 1.0).abs() > 0.05 || (one - two).length() > 0.2);
        }
    }
    sums.map(|sum| sum / drawn.film.tallies().len() as f64)
}

fn agrees(name: &str, scene: &Scene, view: Option<View>) {
    let [mean, many, unlike] = compared(scene, view);
    assert!(mean < 2e-3 && many < 4e-3, "{name}: off by {mean} in the mean, and much in {many} of the pixels");
    assert!(unlike < 0.03, "{name}: other distances or normals in {unlike} of the pixels");
}

#[test]
fn all_kinds_of_sharp_lights_give_what_ray_tracing_gives() {
    agrees("two lights", &scene(boxes(), vec![lamp(DVec3::new(3.0, 5.0, 4.0)), sun()], usual()), None);
    agrees("a spot", &scene(boxes(), vec![spot()], usual()), None);
    let from_below = scene(boxes(), vec![lamp(DVec3::new(1.0, -2.0, 2.0))], usual());
    agrees("from below the floor", &from_below, None);
}

#[test]
#[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
fn the_bunny_and_its_shadow_are_those_of_ray_tracing() {
    let bunny = object(Shape::Bunny, DMat4::from_translation(DVec3::Y), diffuse(0.7));
    agrees("bunny", &scene(vec![ground(20.0), bunny], vec![lamp(DVec3::new(3.0, 5.0, 4.0))], usual()), None);
}

#[test]
fn a_coarse_sphere_has_no_dark_triangles_where_its_light_ends() {
    let ball = Shape::from(Primitive::Sphere { radius: 1.0 });
    let mut ball = object(ball, DMat4::from_translation(DVec3::Y), diffuse(0.7));
    ball.tolerance = Some(0.02);
    agrees("sphere", &scene(vec![ground(20.0), ball], vec![lamp(DVec3::new(6.0, 3.0, 1.0))], usual()), None);
}

#[test]
fn an_eye_within_shadow_volumes_sees_the_right_shadows() {
    let roof = cuboid(DVec3::new(6.0, 0.2, 4.0), DVec3::new(0.0, 2.0, -1.0));
    let objects = vec![ground(20.0), roof, cuboid(DVec3::splat(0.5), DVec3::new(0.3, 0.3, 2.0))];
    let eye = camera(DVec3::new(0.0, 0.3, -2.0), DVec3::new(0.0, 0.5, 3.0));
    agrees("in shadow", &scene(objects, vec![lamp(DVec3::new(0.5, 5.0, 0.0)), sun()], eye), None);
}

#[test]
fn sheets_without_an_inside_throw_shadows_from_both_sides() {
    let turned = DMat4::from_translation(DVec3::new(0.0, 1.5, 0.0)) * DMat4::from_rotation_z(0.5);
    let sheet = object(Shape::Ground { size: 2.0 }, turned, diffuse(0.5));
    let below = crate::illumination::Light::Point { at: DVec3::new(-1.0, 0.8, 2.0), intensity: Color::grey(4.0) };
    let lights = vec![lamp(DVec3::new(3.0, 5.0, 4.0)), below];
    agrees("open", &scene(vec![ground(20.0), sheet], lights, usual()), None);
}

#[test]
fn panes_are_seen_through_in_their_order_and_throw_colored_shadows() {
    let mut objects = boxes();
    objects.extend([pane(DVec3::new(0.0, 1.0, 1.5), 0.0), pane(DVec3::new(0.6, 1.0, 1.0), 1.0)]);
    agrees("panes", &scene(objects, vec![lamp(DVec3::new(3.0, 5.0, 4.0)), sun()], usual()), None);
}

#[test]
fn parallel_and_oblique_views_and_those_of_matrices_agree() {
    let lights = || vec![lamp(DVec3::new(3.0, 5.0, 4.0)), sun()];
    for oblique in [DVec2::ZERO, DVec2::new(0.3, 0.2)] {
        let view = Camera { parallel: Some(Parallel { height: 6.0, oblique }), ..usual() };
        agrees("parallel", &scene(boxes(), lights(), view), None);
    }
    let clipped = Camera { near: 6.0, far: Some(11.0), ..usual() };
    let scene = scene(boxes(), lights(), clipped);
    let Projection { to_clip, depth_clipping } = clipped.projection().expect("sees");
    agrees("matrix", &scene, Some(View::Projection(Projection { to_clip, depth_clipping })));
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * to_clip;
    agrees("mirrored", &scene, Some(View::Projection(Projection { to_clip: mirror, depth_clipping })));
}

#[test]
fn what_is_cut_off_at_the_near_plane_still_throws_its_shadow() {
    let near = Camera { near: 8.3, far: Some(12.0), ..usual() };
    agrees("near", &scene(boxes(), vec![lamp(DVec3::new(3.0, 5.0, 4.0)), sun()], near), None);
}

#[test]
fn surfaces_near_and_far_by_one_to_ten_million_hide_one_another() {
    let mut objects = boxes();
    objects[0] = ground(2e4);
    objects.push(cuboid(DVec3::splat(0.0005), DVec3::new(1.0, 1.0, 7.998)));
    let eye = camera(DVec3::new(1.0, 1.0, 8.0), DVec3::new(0.0, 1.0, 0.0));
    agrees("ratio", &scene(objects, vec![sun()], Camera { near: 1e-3, far: Some(1e4), ..eye }), None);
}

#[test]
fn an_eye_inside_an_object_sees_its_inside() {
    let hall = cuboid(DVec3::splat(6.0), DVec3::new(0.0, 2.9, 0.0));
    let eye = camera(DVec3::new(1.0, 1.0, 2.0), DVec3::new(0.0, 1.0, 0.0));
    let objects = vec![hall, cuboid(DVec3::splat(0.7), DVec3::new(0.0, 0.5, 0.0))];
    agrees("inside", &scene(objects, vec![lamp(DVec3::new(2.0, 4.0, 1.0))], eye), None);
}

#[test]
fn a_light_with_a_size_gives_its_light_from_its_points() {
    let (across, up) = (DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 0.0, 1.0));
    let patch = LightShape::Rectangle { corner: DVec3::new(-1.5, 4.0, -0.5), across, up };
    let light = crate::illumination::Light::Area { patch, radiance: Color::grey(20.0) };
    let mut scene = scene(boxes(), vec![light], usual());
    scene.settings.light.samples = 64;
    let [mean, ..] = compared(&scene, None);
    assert!(mean < 8e-3, "off by {mean}");
}

#[test]
fn a_diffuse_floor_under_a_lamp_follows_its_closed_form() {
    let mut scene = scene(vec![ground(50.0)], vec![lamp(DVec3::new(0.0, 2.0, 0.0))], usual());
    (scene.settings.image.width, scene.settings.image.height, scene.settings.image.samples) = (21, 21, 1);
    scene.ambient = RgbPower::ZERO;
    let half = 5.25;
    let rows = [
        DVec4::new(1.0 / half, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -1.0 / half, 0.0),
        DVec4::new(0.0, -1e-3, 0.0, 0.5),
        DVec4::W,
    ];
    let to_clip = DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
    let drawn = scan(&scene, Some(View::Projection(Projection { to_clip, depth_clipping: false })), 1);
    for x in 0..21u32 {
        let r = (f64::from(x) - 10.0) * 0.5;
        let expected = 0.6 / PI * 30.0 * 2.0 / (4.0 + r * r).powf(1.5);
        let found = f64::from(drawn.picture.get(x, 10).expect("inside").radiance[0]);
        assert!((found - expected).abs() < 1e-6, "at {r}: {found}, not {expected}");
    }
}

#[test]
#[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
fn points_are_in_shadow_volumes_where_rays_to_the_light_are_stopped() {
    let bunny = object(Shape::Bunny, DMat4::from_translation(DVec3::Y), diffuse(0.7));
    let mut objects = boxes();
    (objects[0], objects[2]) = (ground(4.0), bunny);
    let scene = scene(objects, vec![], usual());
    let prepared = Prepared::new(&scene).expect("a scene");
    let octree = Octree::build(&prepared.vertices, &prepared.triangles, &OctreeSettings::default()).expect("octree");
    let casters = Casters::new(&prepared, (0..prepared.triangles.len() as u32).collect(), Vec::new());
    let points = if cfg!(debug_assertions) { 20_000 } else { 1_000_000 / 4 };
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let lights = [
        LightPosition::Point(DVec3::new(3.0, 5.0, 4.0)),
        LightPosition::Point(DVec3::new(0.2, 0.9, 0.3)),
        LightPosition::Direction(DVec3::new(-1.0, 1.0, 0.5)),
        LightPosition::Direction(DVec3::Y),
    ];
    let mut in_shadow = 0;
    for light in lights {
        let facing = casters.facing(&light, None);
        let silhouettes = casters.silhouettes(&facing);
        let enclosed = ShadowVolumes::new(&casters, light, &facing, &silhouettes, 1).sorted();
        for _ in 0..points {
            let mut within = |low: f64, high: f64| random.random_range(low..high);
            let point = DVec3::new(within(-2.0, 2.0), within(-0.2, 2.0), within(-2.0, 2.0));
            let t_max = if matches!(light, LightPosition::Point(_)) { 1.0 } else { f64::INFINITY };
            let stopped = octree.occluded(&Ray { origin: point, direction: light.from(point) }, 0.0, t_max);
            let count = enclosed.counts(point)[0];
            assert!(
                count >= 0 && (count > 0) == stopped,
                "{light:?}: {point} is in {count} volumes; stopped: {stopped}"
            );
            in_shadow += usize::from(stopped);
        }
    }
    assert!(in_shadow > points / 4, "{in_shadow}");
}

#[test]
fn a_highlight_is_the_same_however_many_samples_see_it() {
    let shiny = Classic { specular: Paint::grey(0.4), exponent: 60.0.into(), ..diffuse(0.1) };
    let ball = object(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY, shiny);
    let mut scene = scene(vec![ball], vec![lamp(DVec3::new(2.0, 3.0, 4.0))], camera(DVec3::Z * 6.0, DVec3::ZERO));
    let mut drawn = |samples: u32| {
        scene.settings.image.samples = samples;
        scan(&scene, None, 1).film
    };
    let (one, few, many) = (drawn(1), drawn(4), drawn(64));
    let most = one.tallies().iter().map(|tally| tally.mean().max_element()).fold(0.0, f64::max);
    let mut seen = 0;
    for ((one, few), many) in one.tallies().iter().zip(few.tallies()).zip(many.tallies()) {
        if many.coverage() == 1.0 {
            let off = [few, many].map(|tally| (tally.mean() - one.mean()).abs().max_element());
            assert!(off.into_iter().all(|off| off < 0.02 * most), "{off:?} of {most}");
            seen += 1;
        }
    }
    assert!(seen > 800, "{seen}");
}

#[test]
fn a_lamp_is_seen_behind_panes_and_before_a_wall() {
    let lamp = crate::illumination::Light::Area {
        patch: LightShape::Sphere { center: DVec3::ZERO, radius: 0.5 },
        radiance: Color::grey(7.0),
    };
    let wall = object(
        Shape::from(Primitive::Box { size: DVec3::new(9.0, 9.0, 0.1) }),
        DMat4::from_translation(DVec3::NEG_Z * 2.0),
        diffuse(0.5),
    );
    let glass = |z: f64| {
        object(Shape::Ground { size: 9.0 }, facing(z), Classic { transparency: Paint::grey(0.5), ..diffuse(0.0) })
    };
    let view = camera(DVec3::Z * 6.0, DVec3::ZERO);
    let middle = |objects: Vec<Object>| {
        let scene = scene(objects, vec![lamp.clone()], view);
        scan(&scene, None, 1).film.tallies()[32 * 72 + 36].mean().x
    };
    for (objects, expected) in [
        (vec![wall.clone()], 7.0),
        (vec![wall.clone(), glass(2.0)], 3.5),
        (vec![wall.clone(), glass(2.0), glass(1.0)], 1.75),
        (vec![glass(2.0)], 3.5),
        (vec![wall.clone(), glass(2.0), glass(-1.0)], 3.5),
    ] {
        let found = middle(objects);
        assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
    }
    let hidden = Object { transform: DMat4::from_translation(DVec3::Z * 2.0), ..wall };
    assert!(middle(vec![hidden]) < 1.0);
}

#[test]
fn mirrors_metals_and_glass_show_the_ambient_light() {
    let mirror = Classic { mirror: Paint::grey(0.8), ..diffuse(0.0) };
    let glass = Transparent { absorption: Color::grey(2.0), ..Transparent::clear(RefractiveIndex::Constant(1.5)) };
    let slab = Shape::from(Primitive::Box { size: DVec3::new(9.0, 9.0, 0.5) });
    // Where no ray is reflected: of each face of the glass 4 %, of the rest what a length of half a unit leaves.
    let (reflected, left) = (0.04, 0.96 * (-1.0_f64).exp());
    for (shape, material, ambient, background) in [
        (Shape::Ground { size: 9.0 }, Material::from(mirror), 0.8, 0.0),
        (slab, MaterialKind::Transparent(glass).into(), reflected * (1.0 + left), left * 0.96),
    ] {
        let transform = if matches!(shape, Shape::Ground { .. }) { facing(0.0) } else { DMat4::IDENTITY };
        let mut scene =
            scene(vec![object(shape, transform, material)], Vec::new(), camera(DVec3::Z * 600.0, DVec3::ZERO));
        scene.camera = scene.camera.map(|camera| Camera { field_of_view: 0.1, ..camera });
        scene.ambient = RgbPower::new(0.2, 0.4, 0.6);
        scene.settings.light.reflection_depth = 0;
        let found = scan(&scene, None, 1).film.tallies()[32 * 72 + 36].mean();
        let expected = scene.ambient * ambient + scene.background * background;
        assert!((found - expected).abs().max_element() < 1e-6, "{found}, not {expected}");
    }
}

#[test]
fn glass_that_bends_no_light_is_what_ray_tracing_sees() {
    // A block and a ball in it that absorbs a little, and an eye that looks through both at the shadow of another
    // block.
    let glass = |absorption: f64| {
        let (index, absorption) = (RefractiveIndex::Constant(1.0 + 1e-9), Color::grey(absorption));
        Material::from(MaterialKind::Transparent(Transparent { absorption, ..Transparent::clear(index) }))
    };
    let at = DMat4::from_translation(DVec3::new(0.0, 0.8, 0.0));
    let size = DVec3::splat(1.5);
    let objects = vec![
        ground(20.0),
        object(Shape::from(Primitive::Box { size }), at, glass(0.0)),
        object(Shape::from(Primitive::Sphere { radius: 0.5 }), at, glass(0.1)),
        cuboid(DVec3::splat(0.8), DVec3::new(0.3, 0.4, -2.0)),
    ];
    agrees("glass", &scene(objects, vec![sun(), lamp(DVec3::new(-2.0, 4.0, 3.0))], usual()), None);
}

#[test]
fn patterns_are_as_sharp_where_many_samples_are_looked_at_in_groups() {
    let squares = checker(0.3);
    let tiles = object(Shape::Ground { size: 20.0 }, DMat4::IDENTITY, Classic { diffuse: squares, ..diffuse(0.0) });
    let mut scene = scene(vec![tiles], vec![sun()], usual());
    let mut drawn = |samples: u32| {
        scene.settings.image.samples = samples;
        scan(&scene, None, 2).film
    };
    let (few, many) = (drawn(64), drawn(128));
    let off = few.tallies().iter().zip(many.tallies()).map(|(a, b)| (a.mean() - b.mean()).abs().max_element());
    let (sum, most) = off.fold((0.0, 0.0_f64), |(sum, most), off| (sum + off, most.max(off)));
    assert!(sum / (72.0 * 64.0) < 0.003 && most < 0.05, "{sum} {most}");
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let mut objects = boxes();
    objects.push(pane(DVec3::new(0.0, 1.0, 1.5), 0.0));
    let scene = scene(objects, vec![lamp(DVec3::new(3.0, 5.0, 4.0)), sun()], usual());
    let mut with_rays = scene.clone();
    with_rays.objects.extend(shiny());
    with_rays.settings.light.interreflection = Interreflection::Followed;
    (with_rays.settings.image.width, with_rays.settings.image.samples) = (36, 4);
    for (scene, has_rays) in [(scene, false), (with_rays, true)] {
        let [one, four] = [1, 4].map(|threads| scan(&scene, None, threads));
        assert!(one.film == four.film && one.spans == four.spans && one.threads != four.threads);
        // How many rays to lights are spared depends on who asks first.
        let [rays, same] = [&one, &four].map(|drawn| [drawn.rays.primary, drawn.rays.reflected]);
        assert!(rays == same && (rays[0] > 0) == has_rays, "{rays:?} {same:?}");
    }
}

/// A ball that is a mirror, and one of green glass.
fn shiny() -> Vec<Object> {
    let mirror = Classic { mirror: Paint::grey(0.8), ..diffuse(0.05) };
    let ball = |at: DVec3, material: Material| {
        object(Shape::from(Primitive::Sphere { radius: 0.6 }), DMat4::from_translation(at), material)
    };
    vec![ball(DVec3::new(-1.5, 0.6, 2.0), mirror.into()), ball(DVec3::new(0.9, 0.6, 2.6), green_glass(1.5))]
}

fn green_glass(index: f64) -> Material {
    let absorption = Color::Bands(RgbPower::new(1.5, 0.2, 1.0));
    let glass = Transparent { absorption, ..Transparent::clear(RefractiveIndex::Constant(index)) };
    MaterialKind::Transparent(glass).into()
}

#[test]
fn mirrors_and_glass_show_what_ray_tracing_finds_in_them_and_the_rest_takes_no_rays() {
    let lights = || vec![lamp(DVec3::new(3.0, 5.0, 4.0)), sun()];
    let plain = scan(&scene(boxes(), lights(), usual()), None, 2);
    assert!(plain.rays == RayCounts::default() && plain.finished == FinishedCounts::default());
    let mut objects = boxes();
    objects.extend(shiny());
    objects.push(pane(DVec3::new(0.9, 1.0, 3.4), 0.2));
    let scene = scene(objects, lights(), usual());
    agrees("mirror, and glass behind a pane", &scene, None);
    let drawn = scan(&scene, None, 2);
    let FinishedCounts { pixels, samples, seconds } = drawn.finished;
    assert!((200..1500).contains(&pixels) && samples > 8 * pixels && samples < 16 * pixels && seconds > 0.0);
    assert_eq!(drawn.rays.primary, samples);
}

#[test]
fn glass_throws_a_colored_shadow_whatever_the_scene_asks_of_caustics() {
    let ball = object(
        Shape::from(Primitive::Sphere { radius: 0.8 }),
        DMat4::from_translation(DVec3::new(-1.5, 2.0, 1.0)),
        green_glass(1.3),
    );
    let above = camera(DVec3::new(0.5, 6.0, 3.0), DVec3::new(0.6, 0.0, 0.2));
    let mut scene = scene(vec![ground(20.0), ball], vec![sun()], above);
    let [mean, many, _] = compared(&scene, None);
    assert!(mean < 2e-3 && many < 4e-3, "{mean} {many}");
    let shadow = |scene: &Scene| {
        let film = scan(scene, None, 2).film;
        let lights = film.tallies().iter().map(Tally::mean).filter(|light| light.y > 1.3 * light.x);
        lights.fold((0, 0.0), |(count, most), light| (count + 1, f64::max(most, light.y)))
    };
    let (pixels, most) = shadow(&scene);
    assert!(pixels > 100 && most > 0.1, "{pixels} {most}");
    scene.settings.light.caustics = Caustics::PathTraced;
    assert_eq!(shadow(&scene), (pixels, most));
}

#[test]
fn light_of_a_sky_has_its_shadows_where_rays_finish_samples() {
    let sky = || crate::illumination::Light::Sky { map: None, radiance: Color::grey(0.5), turned: 0.0 };
    let off = |objects: Vec<Object>| {
        let mut scene = scene(objects, vec![sky()], usual());
        (scene.settings.image.width, scene.settings.image.height) = (36, 32);
        compared(&scene, None)[0]
    };
    let mut with_mirror = boxes();
    with_mirror.extend(shiny().drain(..1));
    let [with, without] = [with_mirror, boxes()].map(off);
    assert!(with < 0.01 && with < 0.5 * without, "{with} {without}");
}

#[test]
fn light_of_other_surfaces_is_that_of_ray_tracing_without_its_noise() {
    let wall = Classic { diffuse: Paint::Plain(Color::Bands(RgbPower::new(0.8, 0.2, 0.1))), ..Classic::default() };
    let mut objects = boxes();
    let size = DVec3::new(0.1, 4.0, 6.0);
    objects.push(object(
        Shape::from(Primitive::Box { size }),
        DMat4::from_translation(DVec3::new(-2.0, 2.0, 0.0)),
        wall,
    ));
    let mut scene = scene(objects, vec![lamp(DVec3::new(3.0, 5.0, 4.0))], usual());
    scene.background = RgbPower::ZERO;
    (scene.settings.image.width, scene.settings.image.height) = (36, 32);
    let [without, ..] = compared(&scene, None);
    scene.settings.light.interreflection = Interreflection::Followed;
    let [mean, many, _] = compared(&scene, None);
    assert!(mean < 0.012 && many < 0.01 && without < 2e-3, "{mean} {many} {without}");
}

#[test]
fn pixels_have_as_many_samples_as_were_asked_for() {
    for samples in [1, 3, 31, 40, 100] {
        let mut scene = scene(boxes(), vec![sun()], usual());
        (scene.settings.image.width, scene.settings.image.height, scene.settings.image.samples) = (9, 7, samples);
        let drawn = scan(&scene, None, 2);
        assert!(drawn.complete && drawn.film.samples() == [samples; 2], "{samples}");
    }
}

#[test]
fn an_empty_scene_is_its_background_and_degenerate_triangles_are_nothing() {
    let empty = scene(vec![], vec![sun()], usual());
    let drawn = scan(&empty, None, 2);
    let is_background = |p: &crate::picture::Pixel| p.coverage == 0.0 && (p.radiance[2] - 0.5).abs() < 1e-6;
    assert!(drawn.picture.pixels().iter().all(is_background));
    let line = object(Shape::Ground { size: 2.0 }, DMat4::from_scale(DVec3::new(1.0, 1.0, 1e-20)), diffuse(0.5));
    let mut objects = boxes();
    objects.push(line);
    agrees("a line", &scene(objects, vec![lamp(DVec3::new(3.0, 5.0, 4.0))], usual()), None);
}

#[test]
fn a_cancelled_picture_keeps_what_was_finished() {
    let scene = scene(boxes(), vec![sun()], usual());
    let prepared = Prepared::new(&scene).expect("a scene");
    let view = prepared.view();
    let plan = Plan::new(&prepared, &view);
    let cancelled = Arc::new(AtomicBool::new(false));
    let watch = Watch { cancelled: &cancelled, ..Watch::NOBODY };
    let stop = {
        let cancelled = cancelled.clone();
        move |event| cancelled.fetch_or(matches!(event, StageEvent::Progress { .. }), Ordering::Relaxed)
    };
    let scan = ScanLine::new(&prepared, &plan).expect("ready");
    let drawn =
        observed(move |event| _ = stop(event), || scan.render(&view, &order(&scene, 1), &watch)).expect("a part");
    assert!(!drawn.complete && drawn.film.samples() == [0, 16]);
}

#[test]
fn rooks_are_one_in_each_column() {
    for samples in [1, 2, 4, 7, 16, 64] {
        let mut offsets = rooks(samples);
        offsets.sort_by(f64::total_cmp);
        let even = (0..samples).map(|i| (f64::from(i) + 0.5) / f64::from(samples));
        assert!(offsets.iter().zip(even).all(|(a, b)| (a - b).abs() < 1e-15), "{samples}: {offsets:?}");
    }
}

#[test]
fn a_sky_lights_what_nothing_shades_as_ray_tracing_finds_it() {
    use crate::illumination::light::{Panorama, SkyMap};
    // Brighter above, and in one quarter.
    let panorama = Panorama::of(32, 16, |x, y| {
        DVec3::new(1.0, 0.9, 0.8) * (0.2 + (16.0 - f64::from(y)) / 8.0 + f64::from(u8::from(x / 8 == 1)))
    });
    let map = SkyMap { panorama: Some(std::sync::Arc::new(panorama.expect("small"))), ..SkyMap::default() };
    let sky = |map: Option<SkyMap>| crate::illumination::Light::Sky { map, radiance: Color::grey(0.5), turned: 20.0 };
    let mirror = Material::from(Classic { mirror: Paint::grey(0.8), ..diffuse(0.0) });
    for (name, map, material, most) in [
        ("even", None, diffuse(0.8).into(), 1e-3),
        ("even in a mirror", None, mirror, 2e-3),
        ("with a map", Some(map), diffuse(0.8).into(), 0.015),
    ] {
        let ball = object(Shape::from(Primitive::Sphere { radius: 1.0 }), DMat4::IDENTITY, material);
        let mut scene = scene(vec![ball], vec![sky(map)], camera(DVec3::new(2.0, 1.0, 4.0), DVec3::ZERO));
        scene.ambient = RgbPower::ZERO;
        let [mean, ..] = compared(&scene, None);
        assert!(mean < most, "{name}: off by {mean} in the mean");
    }
}
