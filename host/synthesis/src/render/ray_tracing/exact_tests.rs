//! Facts about hits that are led on to exact surfaces: closed forms, whatever the triangles are like.

use super::tests::{diffuse, mirror, object, scene, trace};
use super::*;
use crate::color::Color;
use crate::illumination::material::Classic;
use crate::illumination::texture::{Motif, Pattern, TextureMapping};
use crate::illumination::{Light, Paint};
use crate::numeric::bounds::Bounds;
use crate::numeric::ray::Ray;
use crate::render::ray_tracer;
use crate::render::world::{BoundedRay, RayCone};
use crate::render::world::{RayHit, SurfaceInteraction};
use crate::scene::{Camera, Composite, Object, Operation, Scene, Shape};
use crate::solid::Primitive;
use crate::surface::{Surface, teapot};
use glam::{DMat4, DVec2, DVec3};
use std::f64::consts::PI;

fn coarse(shape: Shape, transform: DMat4) -> Object {
    Object { tolerance: Some(0.1), ..object(shape, transform, diffuse(0.5)) }
}

fn ball(radius: f64) -> Shape {
    Shape::from(Primitive::Sphere { radius })
}

/// Sends parallel rays from many sides and tells of each that hits something: where it began, its direction, what it
/// hit. How many there were, and the part of them that are on an exact surface: shading normals are not of single
/// precision.
fn met(objects: Vec<Object>, mut tell: impl FnMut(&Ray, &SurfaceInteraction<'_>)) -> usize {
    let prepared = Prepared::new(&scene(objects, Vec::new(), 8)).unwrap_or_else(|e| panic!("{e}"));
    let plan = Plan::new(&prepared, &prepared.view());
    assert!(plan.needs(Stage::ExactSurfaces));
    let tracer = ray_tracer(&prepared, &plan).expect("an octree");
    let (center, reach) = (prepared.bounds.center(), prepared.bounds.diagonal());
    let mut count = 0;
    for axis in [DVec3::Z, DVec3::new(0.3, 0.8, -0.5), DVec3::new(-0.9, 0.1, 0.2), DVec3::NEG_Y].map(DVec3::normalize) {
        let (right, up) = axis.any_orthonormal_pair();
        for k in 0..2500 {
            let at = DVec2::new(f64::from(k % 50) - 24.3, f64::from(k / 50) - 24.8) * (reach / 100.0);
            let origin = center + right * at.x + up * at.y + axis * reach;
            let ray = Ray { origin, direction: axis * -0.7 };
            let bounded = BoundedRay { ray, t_min: 0.0, t_max: f64::INFINITY, cone: RayCone::default() };
            if let RayHit::Surface(found) = tracer.world.intersect(&bounded, 0, 0.0) {
                let on = found.depth;
                assert!((ray.origin - axis * on - found.element.position).length() < 1e-9, "on its ray");
                tell(&ray, &found);
                count += 1;
            }
        }
    }
    count
}

#[test]
fn a_coarse_sphere_has_the_points_and_normals_of_the_sphere() {
    let (center, radius) = (DVec3::new(0.3, -2.0, 1.0), 1.5);
    let placed = DMat4::from_translation(center) * DMat4::from_rotation_z(0.4);
    let count = met(vec![coarse(ball(radius), placed)], |ray, found| {
        let towards = ray.direction.normalize();
        let along = (ray.origin - center).dot(towards);
        let across = (ray.origin - center).length_squared() - along * along;
        let distance = -along - (radius * radius - across).sqrt();
        let expected = ray.origin + towards * distance;
        assert!((found.element.position - expected).length() < 1e-9 && (found.depth - distance).abs() < 1e-9);
        assert!((found.element.normal - (expected - center) / radius).length() < 1e-9);
    });
    assert!(count > 1500, "{count}");
}

#[test]
fn an_uneven_placement_keeps_the_normals_of_its_ellipsoid() {
    let axes = DVec3::new(3.0, -0.5, 1.0);
    let placed = DMat4::from_translation(DVec3::X * 7.0) * DMat4::from_scale(axes);
    met(vec![coarse(ball(1.0), placed)], |_, found| {
        let at = (found.element.position - DVec3::X * 7.0) / axes;
        assert!((at.length() - 1.0).abs() < 1e-9, "{at}");
        assert!((found.element.normal - (at / axes).normalize()).length() < 1e-8);
    });
}

#[test]
fn a_coarse_torus_is_hit_exactly_but_where_rays_pass_by_it() {
    let torus = Shape::from(Primitive::Torus { ring: 2.0, tube: 0.7 });
    let mut missed = 0;
    let count = met(vec![coarse(torus, DMat4::IDENTITY)], |_, found| {
        let at = found.element.position;
        let middle = DVec3::new(at.x, 0.0, at.z).normalize() * 2.0;
        let off = at - middle;
        if (off.length() - 0.7).abs() < 1e-9 {
            let side = if found.element.outside { 1.0 } else { -1.0 };
            assert!((found.element.normal - off / 0.7 * side).length() < 1e-8, "{at}");
        } else {
            missed += 1;
            assert!((off.length() - 0.7).abs() < 0.15);
        }
    });
    assert!(missed * 100 < count, "{missed} of {count}");
}

#[test]
fn patches_of_a_coarse_teapot_are_hit_on_the_patches() {
    let patches = teapot();
    let bounds: Vec<Bounds> =
        patches.iter().map(|patch| Bounds::of(patch.control().iter().flatten().copied())).collect();
    let (mut missed, mut far) = (0, 0.0f64);
    let pot = Object { tolerance: Some(0.03), ..coarse(Shape::Teapot, DMat4::IDENTITY) };
    let count = met(vec![pot], |_, found| {
        let at = found.element.position;
        // A patch lies within the bounds of its control points: those whose bounds are farther need no search.
        let distance = patches.iter().zip(&bounds).fold(f64::INFINITY, |least, (patch, bounds)| {
            if (at - at.clamp(bounds.min, bounds.max)).length() >= least {
                return least;
            }
            let [low, high] = Surface::domain(patch);
            let guesses = [0.25, 0.75].map(|x| [0.25, 0.75].map(|y| low + (high - low) * DVec2::new(x, y)));
            let distance = |guess| Surface::point(patch, Surface::nearest(patch, at, guess)).distance(at);
            guesses.into_iter().flatten().map(distance).fold(least, f64::min)
        });
        missed += usize::from(distance > 1e-9);
        far = far.max(distance);
    });
    assert!(missed * 20 < count && far < 0.03, "{missed} of {count}, {far}");
}

#[test]
fn a_boolean_of_two_has_the_points_and_normals_of_both() {
    let drill = coarse(Shape::from(Primitive::Cylinder { radius: 0.5, height: 4.0 }), DMat4::from_rotation_x(PI / 2.0));
    let operands = vec![coarse(ball(1.0), DMat4::IDENTITY), drill];
    let composite = Composite { operation: Operation::Difference, operands, nesting: 1 };
    let mut on = [0; 3];
    met(vec![coarse(Shape::Composite(Box::new(composite)), DMat4::IDENTITY)], |_, found| {
        let (at, normal) = (found.element.position, found.element.normal);
        let across = DVec3::new(at.x, at.y, 0.0);
        if (at.length() - 1.0).abs() < 1e-9 && (normal - at).length() < 1e-8 {
            on[0] += 1;
        } else if (across.length() - 0.5).abs() < 1e-9 && (normal + across * 2.0).length() < 1e-8 {
            on[1] += 1;
        } else {
            on[2] += 1;
        }
    });
    // Beside the edge that both share, the tangent plane continues beyond the border of neither.
    assert!(on[0] > 1000 && on[1] > 100 && on[2] < 5, "{on:?}");
}

fn lit_ball(tolerance: f64, exact: bool) -> Scene {
    let light = Light::Directional { direction: DVec3::new(-0.6, -0.7, -0.3), irradiance: Color::grey(2.0) };
    let ball = Object { tolerance: Some(tolerance), ..coarse(ball(1.0), DMat4::IDENTITY) };
    let mut scene = scene(vec![ball], vec![light], 60);
    scene.camera = Some(Camera {
        from: DVec3::Z * 8.0,
        at: DVec3::ZERO,
        up: DVec3::Y,
        field_of_view: 15.0,
        near: 0.0,
        far: None,
        lens: None,
        parallel: None,
        motion: None,
    });
    scene.settings.geometry.exact_surfaces = exact;
    scene
}

#[test]
fn a_coarse_ball_is_lit_as_the_ball_up_to_its_terminator() {
    let [exact, interpolated] = [true, false].map(|exact| trace(&lit_ball(0.1, exact), None, false, 2));
    let towards = DVec3::new(0.6, 0.7, 0.3).normalize();
    let tangent = 7.5_f64.to_radians().tan();
    let mut worst = [0.0f64; 2];
    for (i, pixel) in exact.picture.pixels().iter().enumerate().filter(|(_, pixel)| pixel.coverage > 0.0) {
        let [x, y] = [i % 60, 59 - i / 60].map(|k| ((k as f64 + 0.5) / 30.0 - 1.0) * tangent);
        let direction = DVec3::new(x, y, -1.0).normalize();
        let along = -8.0 * direction.z;
        let normal = DVec3::Z * 8.0 + direction * (along - (along * along - 63.0).sqrt());
        let expected = 0.5 * 2.0 * normal.dot(towards).max(0.0) / PI;
        let off = |pixel: &crate::picture::Pixel| (f64::from(pixel.radiance[0]) - expected).abs();
        worst = [worst[0].max(off(pixel)), worst[1].max(off(&interpolated.picture.pixels()[i]))];
    }
    assert!(worst[0] < 1e-6 && worst[1] > 0.01, "{worst:?}");
}

/// A mirroring ball over a ground of clouds.
fn mirror_ball(tolerance: f64) -> Scene {
    let paints = vec![Paint::grey(0.1), Paint::grey(0.9)];
    let clouds = Pattern {
        motif: Motif::Noise { octaves: 1 },
        laying: TextureMapping { solid: true, ..TextureMapping::default() },
        paints,
    };
    let ground = Classic { diffuse: Paint::Pattern(Box::new(clouds)), ..Classic::default() };
    let ground = object(Shape::Ground { size: 60.0 }, DMat4::from_translation(DVec3::Y * -2.0), ground);
    let ball = Object { tolerance: Some(tolerance), ..object(ball(1.0), DMat4::IDENTITY, mirror(0.9)) };
    let lit = lit_ball(tolerance, true);
    let mut scene = Scene { objects: vec![ball, ground], lights: Vec::new(), ambient: DVec3::ONE, ..lit };
    scene.settings.light.texture_filter = 0.0;
    scene
}

#[test]
fn a_coarse_mirror_shows_what_a_fine_one_shows() {
    let [coarse, fine] = [0.1, 1e-4].map(|tolerance| trace(&mirror_ball(tolerance), None, false, 2));
    let tangent = 7.5_f64.to_radians().tan();
    let (mut compared, mut seen) = (0, [9.0f32, 0.0]);
    for (i, (a, b)) in coarse.picture.pixels().iter().zip(fine.picture.pixels()).enumerate() {
        let [x, y] = [i % 60, i / 60].map(|k| ((k as f64 + 0.5) / 30.0 - 1.0) * tangent);
        // Inside of the outline of the coarse one.
        if x.hypot(y) < 0.9 / 8.0 {
            assert!((a.radiance[0] - b.radiance[0]).abs() < 1e-4, "{i}: {:?} {:?}", a.radiance, b.radiance);
            seen = [seen[0].min(a.radiance[0]), seen[1].max(a.radiance[0])];
            compared += 1;
        }
    }
    assert!(compared > 1500 && seen[1] - seen[0] > 0.3, "{compared} {seen:?}");
}

#[test]
fn what_the_scene_does_not_ask_for_is_left_out_and_forced_without_effect() {
    for exact in [true, false] {
        let scene = lit_ball(0.05, exact);
        let prepared = Prepared::new(&scene).expect("a scene");
        assert_eq!(Plan::new(&prepared, &prepared.view()).needs(Stage::ExactSurfaces), exact);
        let [lean, forced] = [false, true].map(|everything| trace(&scene, None, everything, 2).picture);
        assert_eq!(lean.pixels(), forced.pixels());
    }
    let flat = scene(vec![object(Shape::Ground { size: 1.0 }, DMat4::IDENTITY, diffuse(0.5))], Vec::new(), 8);
    let prepared = Prepared::new(&flat).expect("a scene");
    assert!(!Plan::new(&prepared, &prepared.view()).needs(Stage::ExactSurfaces));
}
