//! Facts about studies.

use super::*;
use crate::color::Color;
use crate::illumination::Light;
use crate::illumination::Paint;
use crate::illumination::material::Classic;
use crate::render::Watch;
use crate::scene::{Cage, Composite, Object, Operation, Scene, Sculpture, Settings, Shape, SurfaceSheet};
use crate::solid::Primitive;
use glam::{DMat4, DVec3};

/// One white object under parallel light.
fn scene(shape: Shape) -> Scene {
    let light = Light::Directional { direction: DVec3::new(0.0, -1.0, -1.0), irradiance: Color::grey(3.0) };
    let material = Classic { diffuse: Paint::grey(1.0), ..Classic::default() }.into();
    let object =
        Object { name: "it".into(), shape, transform: DMat4::IDENTITY, material: Some(material), tolerance: None };
    let settings = Settings::of_size(40, 40, 16);
    Scene { objects: vec![object], lights: vec![light], settings, ..Scene::default() }
}

fn sphere() -> Scene {
    scene(Shape::from(Primitive::Sphere { radius: 1.0 }))
}

fn row(name: &str) -> &'static KnobRow {
    KNOBS.iter().find(|k| k.name == name).expect("a known study")
}

#[test]
fn a_finer_tolerance_follows_the_sphere_more_closely() {
    let options = Options { width: 24, samples: 1, settings: 3, threads: None };
    let study = (row("tessellate").run)(&sphere(), &options, &Watch::NOBODY).expect("a study");
    for row in &study.rows {
        assert!(row.errors[0] <= row.setting, "chord error {} above the tolerance {}", row.errors[0], row.setting);
        assert!(row.errors[0] > row.setting / 30.0, "far more triangles than asked for");
    }
    assert!(study.rows[0].errors[1] > study.rows[2].errors[1], "the picture gets better");
    assert!(study.rows[0].counts[0] < study.rows[2].counts[0], "with more triangles");
}

#[test]
fn a_scene_without_curved_surfaces_has_no_tolerance_to_study() {
    let options = row("tessellate").options;
    let result =
        (row("tessellate").run)(&scene(Shape::from(Primitive::Box { size: DVec3::ONE })), &options, &Watch::NOBODY);
    assert!(matches!(result, Err(StudyError::Nothing(_))));
}

#[test]
fn a_cancelled_study_says_so() {
    let cancelled = std::sync::atomic::AtomicBool::new(true);
    let watch = Watch { cancelled: &cancelled, ..Watch::NOBODY };
    let result = (row("tessellate").run)(&sphere(), &row("tessellate").options, &watch);
    assert!(matches!(result, Err(StudyError::Interrupted)));
}

#[test]
fn leaf_size_and_depth_change_no_hit() {
    for name in ["octree", "depth"] {
        let options = Options { width: 40, settings: 4, ..row(name).options };
        let study = (row(name).run)(&sphere(), &options, &Watch::NOBODY).expect("a study");
        assert_eq!(study.rows.len(), 4);
        assert!(study.rows.iter().all(|row| row.errors == [0.0]), "{study:?}");
        let svg = study.plot("A").svg().expect("a plot of what it costs");
        assert!(svg.contains("memory (MB)") && svg.contains("no setting has an error"));
    }
}

#[test]
fn steps_of_subdivision_come_nearer_to_the_limit() {
    let scene = scene(Shape::from(Primitive::Box { size: DVec3::ONE }));
    let study = (row("subdivide").run)(&scene, &row("subdivide").options, &Watch::NOBODY).expect("a study");
    // The distance falls by four with each step where the surface is smooth, the angle by two.
    for pair in study.rows.windows(2).skip(1) {
        let [angle, distance] = [0, 2].map(|k| pair[0].errors[k] / pair[1].errors[k]);
        assert!(angle > 1.3 && distance > 2.0, "{angle} {distance}");
    }
    assert!(study.rows[3].errors[1] < 0.02);
}

#[test]
#[cfg_attr(not(feature = "bunny"), ignore = "needs the feature `bunny`")]
fn adaptive_triangles_keep_their_tolerance() {
    let options = Options { settings: 3, ..row("surface").options };
    let study = (row("surface").run)(&sphere(), &options, &Watch::NOBODY).expect("a study");
    assert!(study.rows.iter().all(|row| row.errors[2] <= row.setting * 1.01), "{study:?}");
    let [first, last] = [0, 2].map(|k| &study.rows[k]);
    assert!((0..3).all(|error| last.errors[error] < first.errors[error]), "{study:?}");
    let result = (row("surface").run)(&scene(Shape::Bunny), &options, &Watch::NOBODY);
    assert!(matches!(result, Err(StudyError::Nothing(_))));
}

#[test]
fn the_residual_of_any_exact_surface_falls_with_its_tolerance() {
    let torus = Shape::from(Primitive::Torus { ring: 2.0, tube: 0.5 });
    let surface = Box::new(crate::surface::rational_torus(2.0, 0.5).expect("a torus"));
    let sculpture = Sculpture { sheets: vec![SurfaceSheet::Spline { surface, loops: Vec::new() }] };
    let tube = Shape::from(Primitive::Cylinder { radius: 0.5, height: 4.0 });
    let operands = vec![scene(torus.clone()).objects.remove(0), scene(tube.clone()).objects.remove(0)];
    let both = Composite { operation: Operation::Union, operands, nesting: 1 };
    let options = Options { settings: 3, ..row("surface").options };
    let study = |shape| (row("surface").run)(&scene(shape), &options, &Watch::NOBODY).expect("a study");
    let shapes = [torus, Shape::Sculpture(Box::new(sculpture)), tube, Shape::Composite(Box::new(both))];
    for study in shapes.map(study) {
        assert!(study.rows.iter().all(|row| row.errors[2] <= row.setting * 1.01), "{study:?}");
        let [first, last] = [0, 2].map(|k| &study.rows[k]);
        assert!((0..3).all(|error| last.errors[error] < first.errors[error]), "{study:?}");
    }
}

#[test]
fn triangles_of_a_limit_surface_are_measured() {
    let points = (0..8).map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let cage = Cage { points: points.collect(), faces: faces.map(Vec::from).to_vec(), sharpenings: Vec::new() };
    let options = Options { width: 8, samples: 1, settings: 4, threads: None };
    let scene = scene(Shape::Subdivision(Box::new(cage)));
    let study = (row("tessellate").run)(&scene, &options, &Watch::NOBODY).expect("a study");
    for row in &study.rows {
        assert!(row.errors[0] <= row.setting && row.errors[0] > row.setting / 10.0, "{study:?}");
    }
}

#[test]
fn a_drilled_ball_loses_error_as_its_tolerance_falls() {
    let ball = Object { material: None, ..scene(Shape::from(Primitive::Sphere { radius: 1.0 })).objects[0].clone() };
    let mut drill = ball.clone();
    drill.shape = Shape::from(Primitive::Box { size: DVec3::new(0.5, 3.0, 0.5) });
    let composite = Composite { operation: Operation::Difference, operands: vec![ball, drill], nesting: 1 };
    let scene = scene(Shape::Composite(Box::new(composite)));
    let options = Options { settings: 4, ..row("boolean").options };
    let study = (row("boolean").run)(&scene, &options, &Watch::NOBODY).expect("a study");
    // A third of the tolerance is about a third of the error.
    for pair in study.rows.windows(2) {
        assert!(pair[0].errors.iter().zip(&pair[1].errors).all(|(one, two)| one / two > 2.0), "{pair:?}");
    }
    let error = (row("boolean").run)(&sphere(), &options, &Watch::NOBODY).expect_err("no composite");
    assert!(error.to_string().contains("made of others"));
}

#[test]
fn finer_triangles_bring_lines_nearer_to_the_curve_and_a_finer_iteration_the_points() {
    let mut scene = sphere();
    let tube = Shape::from(Primitive::Cylinder { radius: 0.5, height: 4.0 });
    let transform = DMat4::from_rotation_x(0.3);
    scene.objects.push(Object { name: "tube".into(), shape: tube, transform, material: None, tolerance: None });
    let run = |name: &str| {
        let options = Options { settings: 4, ..row(name).options };
        (row(name).run)(&scene, &options, &Watch::NOBODY).expect("a study")
    };
    let study = run("intersect");
    assert!(study.rows.iter().all(|row| row.errors[0] < 1e-13 && row.counts[1] == 0.0));
    assert!(
        study.rows[0].errors[1] > 2.0 * study.rows[3].errors[1] && study.rows[0].counts[0] < study.rows[3].counts[0]
    );
    let study = run("newton");
    assert!(study.rows[0].errors[0] > 1e-6 && study.rows[3].errors[0] < 1e-6 * 4.0);
    assert!(matches!(
        (row("newton").run)(&sphere(), &row("newton").options, &Watch::NOBODY),
        Err(StudyError::Nothing(_))
    ));
}

#[test]
fn the_family_of_distributions_is_measured_and_plotted() {
    let study = illumination(&[0.5], &Watch::NOBODY).expect("a study");
    let row = |name: &str| study.rows.iter().find(|row| row.name == name).expect("a member");
    let seen: Vec<&str> = study.rows.iter().filter(|row| row.viewed.is_some()).map(|row| row.name.as_str()).collect();
    assert_eq!(seen, ["Phong", "Blinn", "improved (7)"], "those that are not reciprocal");
    assert_eq!(study.csv().lines().count(), study.rows.len() + seen.len() + 1);
    assert!(row("Lambert").shares.iter().all(|share| (share - 1.0).abs() < 1e-9));
    assert!(row("GGX, all").shares.iter().all(|share| (share - 1.0).abs() < 1e-3));
    assert!(row("improved (7)").shares[0] > 3.0 && row("improved (7)").reciprocity > 0.5);
    assert!(row("Beckmann").shares.iter().all(|share| *share < 1.0 + 1e-9) && row("Beckmann").reciprocity < 1e-12);
    assert!(study.rows.iter().all(|row| row.evaluation > 0.0 && row.sample > 0.0));
    let plots = study.plots();
    assert!(plots.len() == 1 && plots[0].1.svg().expect("a plot").contains("improved (7), seen"));
    let cancelled = std::sync::atomic::AtomicBool::new(true);
    let watch = Watch { cancelled: &cancelled, ..Watch::NOBODY };
    assert!(matches!(illumination(&[0.5], &watch), Err(StudyError::Interrupted)));
    assert!(matches!(illumination(&[-1.0], &Watch::NOBODY), Err(StudyError::Distribution(_))));
}
