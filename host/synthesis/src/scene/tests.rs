//! Facts about scenes.

use super::*;
use crate::color::Color;
use crate::illumination::Paint;
use crate::illumination::material::Classic;
use crate::numeric::bounds::Bounds;
use crate::solid::Primitive;
use glam::{DMat4, DVec3};

fn sphere(transform: DMat4) -> Scene {
    let shape = Shape::from(Primitive::Sphere { radius: 1.0 });
    let object = Object { name: "ball".into(), shape, transform, material: None, tolerance: None };
    Scene { objects: vec![object], ..Scene::default() }
}

fn problem(change: impl Fn(&mut Scene)) -> String {
    let mut scene = sphere(DMat4::IDENTITY);
    scene.lights.push(Light::Point { at: DVec3::Y, intensity: Color::grey(1.0) });
    scene.check().expect("right before the change");
    change(&mut scene);
    scene.check().expect_err("wrong after the change").to_string()
}

#[test]
fn problems_name_the_object_or_the_light() {
    assert!(
        problem(|s| s.objects[0].material = Some(Classic { diffuse: Paint::grey(1.5), ..Classic::default() }.into()))
            .starts_with("ball: diffuse reflectance")
    );
    assert!(
        problem(|s| s.objects[0].material = Some(Classic { exponent: f64::NAN.into(), ..Classic::default() }.into()))
            .starts_with("ball: exponent")
    );
    assert!(problem(|s| s.objects[0].transform = DMat4::ZERO).starts_with("ball: its transformation"));
    assert!(problem(|s| s.objects[0].transform.x_axis = s.objects[0].transform.y_axis).contains("singular"));
    assert!(
        problem(|s| s.objects[0].shape = Shape::from(Primitive::Sphere { radius: -1.0 }))
            .starts_with("ball: radius -1")
    );
    assert!(problem(|s| s.objects[0].tolerance = Some(0.0)).starts_with("ball: tolerance"));
    assert!(
        problem(|s| s.lights[0] = Light::Directional { direction: DVec3::ZERO, irradiance: Color::grey(1.0) })
            .starts_with("light 1: its direction")
    );
    assert!(problem(|s| s.background.y = f64::INFINITY).starts_with("background"));
    assert!(problem(|s| s.settings.image.width = 0).contains("empty or too large"));
    assert!(problem(|s| s.settings.image.samples = 0).contains("samples"));
    let camera = Camera::framing(&Bounds { min: DVec3::ZERO, max: DVec3::ONE });
    assert!(problem(|s| s.camera = Some(Camera { field_of_view: 180.0, ..camera })).starts_with("camera: field"));
    assert!(problem(|s| s.camera = Some(Camera { at: camera.from, ..camera })).starts_with("camera: from and at"));
    assert!(problem(|s| s.camera = Some(Camera { near: 2.0, far: Some(1.0), ..camera })).contains("near 2"));
}

#[test]
fn a_scene_survives_its_serialisation() {
    let mut scene = sphere(DMat4::from_rotation_x(0.3));
    scene.lights.push(Light::Directional { direction: DVec3::NEG_Y, irradiance: Color::grey(1.0) });
    scene.camera = Some(Camera::framing(&Bounds { min: DVec3::ZERO, max: DVec3::ONE }));
    let text = serde_json::to_string(&scene).expect("plain data");
    assert_eq!(serde_json::from_str::<Scene>(&text).expect("the same"), scene);
}

#[test]
fn placed_normals_point_outwards_whatever_the_transformation() {
    for factors in [DVec3::ONE, DVec3::new(2.0, 0.5, 1.0), DVec3::new(-1.0, 3.0, 1.0), DVec3::splat(-0.2)] {
        let prepared =
            Prepared::new(&sphere(DMat4::from_rotation_y(0.4) * DMat4::from_scale(factors))).expect("a scene");
        for t in 0..prepared.triangles.len() as u32 {
            let [a, b, c] = prepared.corners(t);
            let face = (b - a).cross(c - a);
            assert!(face.dot(a + b + c) > 0.0, "{factors}: triangle {t} faces inwards");
            for n in prepared.corner_normals(t).expect("curved") {
                assert!((n.length() - 1.0).abs() < 1e-5 && n.as_dvec3().dot(face) > 0.0, "{factors}: {t}");
            }
        }
    }
}

#[test]
fn a_tolerance_holds_in_scene_units_after_scaling() {
    let mut scene = sphere(DMat4::from_scale(DVec3::splat(100.0)));
    scene.settings.geometry.tolerance = Some(0.05);
    let error = scene.chord_error().expect("a mesh");
    assert!(error <= 0.05 && error > 0.005, "{error}");
}

#[test]
fn flat_objects_carry_no_normals() {
    let mut scene = sphere(DMat4::IDENTITY);
    scene.objects[0].shape = Shape::from(Primitive::Box { size: DVec3::new(1.0, 2.0, 3.0) });
    let prepared = Prepared::new(&scene).expect("a scene");
    assert!(!prepared.objects[0].is_curved() && prepared.corner_normals(0).is_none());
    assert_eq!(prepared.triangles.len(), 12);
    assert_eq!(prepared.bounds.max, DVec3::new(0.5, 1.0, 1.5));
}

#[test]
fn the_automatic_camera_has_everything_in_view() {
    let prepared = Prepared::new(&sphere(DMat4::from_translation(DVec3::new(7.0, -3.0, 2.0)))).expect("a scene");
    let projection = prepared.camera.projection().expect("sees");
    for corner in prepared.bounds.corners() {
        let clip = projection.to_clip * corner.extend(1.0);
        assert!(clip.w > 0.0 && clip.x.abs() < clip.w && clip.y.abs() < clip.w);
    }
}
