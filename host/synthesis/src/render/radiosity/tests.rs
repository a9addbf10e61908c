//! Facts about radiosity.

use super::hierarchy::Hierarchy;
use super::*;
use crate::color::Color;
use crate::illumination::material::Classic;
use crate::illumination::{Light, Material, Paint};
use crate::mesh::Mesh;
use crate::render::{RadiosityError, Technique};
use crate::scene::{Interreflection, Object, RadiositySettings, Scene, Shape};
use crate::solid::Primitive;
use crate::stages::{StageEvent, observed};
use glam::{DMat4, DVec3};
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

fn matt(reflectance: f64) -> Material {
    Classic { diffuse: Paint::grey(reflectance), ..Classic::default() }.into()
}

pub(super) fn object(name: &str, shape: Shape, reflectance: f64) -> Object {
    let transform = DMat4::IDENTITY;
    Object { name: name.into(), shape, transform, material: Some(matt(reflectance)), tolerance: Some(0.05) }
}

fn cube(name: &str, size: f64, reflectance: f64) -> Object {
    object(name, Shape::from(Primitive::Box { size: DVec3::splat(size) }), reflectance)
}

fn sphere(name: &str, radius: f64, reflectance: f64) -> Object {
    object(name, Shape::from(Primitive::Sphere { radius }), reflectance)
}

fn prepared(objects: Vec<Object>, lights: Vec<Light>) -> Prepared {
    let mut scene = Scene { objects, lights, ..Scene::default() };
    // Light that goes from surface to surface needs what is out of view.
    scene.settings.light.interreflection = Interreflection::Followed;
    Prepared::new(&scene).expect("a scene")
}

pub(super) fn solved(prepared: &Prepared, settings: &RadiositySettings, exitance: Option<Exitance<'_>>) -> Radiosity {
    let plan = Plan::new(prepared, &prepared.view());
    Radiosity::new(&World::new(prepared, &plan).expect("a world"), &plan, settings, exitance, &Watch::NOBODY)
        .expect("a solution")
}

fn coarse() -> RadiositySettings {
    RadiositySettings { error: 0.1, finest: 1.0 / 16.0, ..RadiositySettings::default() }
}

fn lamp(at: DVec3) -> Light {
    Light::Point { at, intensity: Color::grey(1.0) }
}

/// Irradiance in the middle of a side of a triangle.
fn middle(radiosity: &Radiosity, triangle: u32, outside: bool, part: IrradiancePart) -> f64 {
    radiosity.irradiance(triangle, outside, [1.0 / 3.0; 3], part).0[0]
}

/// Mean irradiance of a side of some triangles.
fn mean(prepared: &Prepared, radiosity: &Radiosity, object: usize, outside: bool, part: IrradiancePart) -> f64 {
    let of = &prepared.objects[object];
    let (mut sum, mut all) = (0.0, 0.0);
    for triangle in of.first..of.first + of.count {
        let area = normal_and_area(prepared.corners(triangle)).1;
        sum += area * middle(radiosity, triangle, outside, part);
        all += area;
    }
    sum / all
}

#[test]
fn in_a_closed_sphere_light_grows_by_one_over_what_is_lost() {
    for loss in [0.5, 0.1, 1e-3, 1e-6] {
        let prepared = prepared(vec![sphere("sphere", 1.0, 1.0 - loss)], vec![]);
        let inside = |_: u32, outside: bool, _: DVec3| if outside { Channels::ZERO } else { Channels::splat(2.0) };
        let radiosity = solved(&prepared, &coarse(), Some(&inside));
        let RadiosityReport { steps, solver_error, left, arrived, unbalanced, .. } = radiosity.report;
        for triangle in 0..prepared.triangles.len() as u32 {
            let found = 2.0 + (1.0 - loss) * middle(&radiosity, triangle, false, IrradiancePart::All);
            assert!((found * loss / 2.0 - 1.0).abs() < 1e-6, "{loss}: {found}");
            assert_eq!(middle(&radiosity, triangle, true, IrradiancePart::All), 0.0, "outside it is dark");
        }
        assert!(steps < 100 && solver_error < 1e-6, "{loss}: {:?}", radiosity.report);
        assert!((left / arrived).abs() < 1e-6 && unbalanced < 1e-6, "{loss}: {:?}", radiosity.report);
    }
}

#[test]
fn a_closed_room_that_reflects_nearly_all_is_solved_in_few_steps() {
    for loss in [1e-2, 1e-4, 1e-6] {
        let room = prepared(vec![cube("room", 2.0, 1.0 - loss), sphere("ball", 0.4, 1.0 - loss)], vec![]);
        // One wall emits on its inner side.
        let wall = |_: u32, outside: bool, at: DVec3| Channels::splat(if !outside && at.y > 0.99 { 1.0 } else { 0.0 });
        let radiosity = solved(&room, &coarse(), Some(&wall));
        let report = radiosity.report;
        assert!(report.steps < 100 && report.solver_error < 1e-6, "{loss}: {report:?}");
        assert!(
            (report.left / report.arrived).abs() < 1e-6 && report.escaped.abs() < 1e-6 * report.arrived,
            "{report:?}"
        );
        // All that is sent is absorbed, in the mean over all surfaces.
        let all = 24.0 + 4.0 * PI * 0.16;
        let mean = report.absorbed / 3.0 / (loss * all);
        let ball = super::tests::mean(&room, &radiosity, 1, true, IrradiancePart::All);
        assert!((ball / mean - 1.0).abs() < 0.05 + loss * 100.0, "{loss}: {ball} {mean}");
    }
}

#[test]
fn light_that_nothing_takes_away_is_refused_and_no_light_is_none() {
    let mirror = prepared(vec![sphere("sphere", 1.0, 1.0)], vec![]);
    let plan = Plan::new(&mirror, &mirror.view());
    let of = |exitance: f64| {
        let inside = move |_: u32, _: bool, _: DVec3| Channels::splat(exitance);
        Radiosity::new(&World::new(&mirror, &plan).expect("a world"), &plan, &coarse(), Some(&inside), &Watch::NOBODY)
    };
    assert!(matches!(of(1.0), Err(RenderError::Radiosity(RadiosityError::NoLoss))));
    let dark = of(0.0).expect("no light is an answer");
    assert_eq!(mean(&mirror, &dark, 0, false, IrradiancePart::All), 0.0);
}

#[test]
fn a_sphere_in_a_sphere_sends_all_its_light_to_it_and_gets_its_share_back() {
    let (r1, r2) = (0.5f64, 1.5f64);
    let faint = |object: Object| Object { material: Some(matt(1e-9)), ..object };
    let spheres = prepared(vec![faint(sphere("inner", r1, 0.0)), faint(sphere("outer", r2, 0.0))], vec![]);
    let inner = spheres.objects[0].count;
    let area = |object: usize| -> f64 {
        let of = &spheres.objects[object];
        (of.first..of.first + of.count).map(|t| normal_and_area(spheres.corners(t)).1).sum()
    };
    let ratio = area(0) / area(1);
    assert!((ratio / (r1 * r1 / (r2 * r2)) - 1.0).abs() < 0.1);
    let from_inner =
        |triangle: u32, outside: bool, _: DVec3| Channels::splat(if triangle < inner && outside { 1.0 } else { 0.0 });
    let radiosity = solved(&spheres, &coarse(), Some(&from_inner));
    // All light of the inner one comes to the other, whose triangles have less area than a sphere.
    let found = mean(&spheres, &radiosity, 1, false, IrradiancePart::All) / ratio;
    assert!((found - 1.0).abs() < 0.01, "{found}");
    assert!(mean(&spheres, &radiosity, 0, true, IrradiancePart::All) < 1e-6, "a convex body sees nothing of itself");
    let from_outer =
        |triangle: u32, outside: bool, _: DVec3| Channels::splat(if triangle >= inner && !outside { 1.0 } else { 0.0 });
    let radiosity = solved(&spheres, &coarse(), Some(&from_outer));
    let found = mean(&spheres, &radiosity, 0, true, IrradiancePart::All);
    assert!((found - 1.0).abs() < 0.02, "{found} {:?}", radiosity.report);
    let own = mean(&spheres, &radiosity, 1, false, IrradiancePart::All);
    assert!((own - (1.0 - ratio)).abs() < 0.02, "{own} {ratio}");
}

#[test]
fn a_closed_dark_room_with_lights_outside_stays_dark_to_the_last_bit() {
    // Two rooms that touch, a slab on which both stand, and lamps all around and in one of them.
    let mut lit = cube("lit room", 2.0, 0.7);
    lit.transform = DMat4::from_translation(DVec3::new(2.0, 0.0, 0.0));
    let mut slab = object("slab", Shape::from(Primitive::Box { size: DVec3::new(9.0, 0.5, 9.0) }), 0.6);
    slab.transform = DMat4::from_translation(DVec3::new(0.0, -1.25, 0.0));
    let lights = vec![
        lamp(DVec3::new(3.0, 4.0, 2.0)),
        lamp(DVec3::new(-2.0, 0.5, 0.3)),
        lamp(DVec3::new(2.0, 0.3, 0.2)),
        Light::Sky { map: None, radiance: Color::grey(0.3), turned: 0.0 },
    ];
    let scene = prepared(vec![cube("dark room", 2.0, 0.7), lit, slab], lights);
    let radiosity = solved(&scene, &coarse(), None);
    let room = &scene.objects[0];
    for triangle in room.first..room.first + room.count {
        for weights in [[1.0 / 3.0; 3], [0.98, 0.01, 0.01], [0.01, 0.01, 0.98], [1.0, 0.0, 0.0], [0.5, 0.5, 0.0]] {
            assert_eq!(radiosity.irradiance(triangle, false, weights, IrradiancePart::All), Channels::ZERO);
        }
    }
    assert!(mean(&scene, &radiosity, 0, true, IrradiancePart::All) > 0.0);
    assert!(mean(&scene, &radiosity, 1, false, IrradiancePart::Indirect) > 0.0);
    let RadiosityReport { arrived, left, .. } = radiosity.report;
    assert!((left / arrived).abs() < 1e-6, "{:?}", radiosity.report);
}

#[test]
fn the_hierarchy_gives_what_a_full_matrix_gives() {
    let room = prepared(vec![cube("room", 2.0, 0.6)], vec![lamp(DVec3::new(0.3, 0.5, -0.2))]);
    let plan = Plan::new(&room, &room.view());
    let world = World::new(&room, &plan).expect("a world");
    let visibility = VisibilityTester::new(&world, None);
    let inside: Vec<RadiosityPatch> =
        patches(&room, &plan, &visibility).into_iter().filter(|patch| !patch.outside).collect();
    let edges = ShortestEdges::everywhere(0.3);
    let mut elements = Elements::new(Hierarchy::new(inside, &edges, |_| false), &visibility, None, &[], true, &edges);
    let bound = |error: f64, mean: f64| RefinementBound { error, mean, dimmest: 1.0, shown: 0.0 };
    // All as fine as they may be, so that links do not divide elements.
    loop {
        let leaves = elements.hierarchy.leaves();
        let may_divide = |leaf: &u32| elements.may_divide(&elements.hierarchy.nodes[*leaf as usize]);
        let divided: Vec<u32> = leaves.into_iter().filter(may_divide).collect();
        if divided.is_empty() {
            break;
        }
        elements.divide(&visibility, divided);
    }
    elements.divide_where_light_varies(&visibility, bound(1.0, f64::INFINITY), 1.0);
    let mut links = Vec::new();
    let mut found = Vec::new();
    for error in [0.05, 0.002] {
        let bound = bound(error, elements.mean_irradiance());
        refine(&visibility, &mut elements, &mut links, bound, &|| false);
        let leaves = elements.hierarchy.leaves();
        let mut report = RadiosityReport::default();
        let gatherer = Gatherer { visibility: &visibility, elements: &elements, bound };
        let corners = ElementCorners::new(&room, &elements.hierarchy, &leaves, &[]);
        let views = gatherer.views(&links, &corners, &leaves);
        let seen = lit_patches::leaf_visibility(&visibility, &elements, &leaves, &views.rows(), 32, &|| false)
            .expect("memory");
        let last = Some((&seen, &views));
        let solved = light(&elements, &links, last, 1e-9, &|| false, &mut report).expect("a solution");
        found.push((links.len(), solved.0));
    }
    let leaves = elements.hierarchy.leaves();
    // All pairs, and Gauss and Seidel's sweeps.
    let nodes: Vec<_> = leaves.iter().map(|leaf| elements.hierarchy.nodes[*leaf as usize]).collect();
    let polygons: Vec<_> = nodes.iter().map(|node| node.polygon()).collect();
    let full: Vec<Vec<f64>> = nodes
        .iter()
        .zip(&polygons)
        .map(|(node, a)| polygons.iter().map(|b| form_factor::exchange(a, b, 1e-6) / node.area).collect())
        .collect();
    let rows = full.iter().map(|row| row.iter().sum::<f64>());
    assert!(rows.into_iter().all(|sum| (sum - 1.0).abs() < 2e-3), "a room is closed");
    let direct: Vec<f64> = leaves.iter().map(|leaf| elements.direct[*leaf as usize].0[0]).collect();
    let mut exact = vec![0.0; nodes.len()];
    for _ in 0..60 {
        for i in 0..nodes.len() {
            exact[i] = (0..nodes.len()).map(|j| full[i][j] * 0.6 * (direct[j] + exact[j])).sum();
        }
    }
    let greatest = exact.iter().fold(0.0f64, |a, b| a.max(*b));
    let [coarse, fine] = [0, 1].map(|i| {
        let off = exact.iter().zip(&found[i].1).map(|(a, b)| (a - b.0[0]).abs());
        (found[i].0, off.fold(0.0, f64::max) / greatest)
    });
    assert!(fine.1 < 0.05 && coarse.1 < 0.2, "{coarse:?} {fine:?}");
    assert!(coarse.0 < fine.0, "{coarse:?} {fine:?}");
}

#[test]
fn the_solution_is_the_same_for_any_number_of_threads() {
    let room = prepared(vec![cube("room", 2.0, 0.6), sphere("ball", 0.5, 0.8)], vec![lamp(DVec3::new(0.7, 0.8, 0.1))]);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let radiosity = pool.install(|| solved(&room, &coarse(), None));
        let at = |triangle: u32| radiosity.irradiance(triangle, false, [0.2, 0.3, 0.5], IrradiancePart::All);
        let values: Vec<u64> = (0..room.triangles.len() as u32).map(|t| at(t).0[0].to_bits()).collect();
        (values, RadiosityReport { seconds: 0.0, ..radiosity.report })
    };
    assert_eq!(with(1), with(2));
}

#[test]
fn nothing_breaks_without_objects_lights_reflectance_or_area() {
    let solved = |objects: Vec<Object>, lights: Vec<Light>| solved(&prepared(objects, lights), &coarse(), None).report;
    assert_eq!(solved(vec![], vec![]), RadiosityReport::default());
    assert_eq!(solved(vec![cube("cube", 1.0, 0.5)], vec![]), RadiosityReport::default());
    assert_eq!(solved(vec![cube("cube", 1.0, 0.0)], vec![lamp(DVec3::Y)]), RadiosityReport::default());
    let sliver = Mesh {
        vertices: vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::new(0.0, 1e-160, 0.0)],
        triangles: vec![[0, 1, 2], [0, 1, 1], [0, 1, 3]],
        corner_normals: vec![[DVec3::Z; 3]; 3],
        ..Mesh::default()
    };
    let file = tempfile::tempdir().expect("a folder");
    let path = file.path().join("sliver.obj");
    let lines = sliver.vertices.iter().map(|v| format!("v {:e} {:e} {:e}\n", v.x, v.y, v.z));
    let text: String = lines.chain(["f 1 2 3\n".into(), "f 1 2 2\n".into(), "f 1 2 4\n".into()]).collect();
    std::fs::write(&path, text).expect("a file");
    let corners = [DVec3::ZERO, DVec3::X, DVec3::new(0.0, 1e-160, 0.0)];
    assert!(normal_and_area(corners).1.is_finite());
}

#[test]
fn scenes_of_any_size_have_the_same_light() {
    let of = |scale: f64| {
        let room = cube("room", 2.0 * scale, 0.5);
        let light = Light::Point { at: DVec3::new(0.2, 0.3, 0.1) * scale, intensity: Color::grey(scale * scale) };
        let room = prepared(vec![room], vec![light]);
        mean(&room, &solved(&room, &coarse(), None), 0, false, IrradiancePart::Indirect)
    };
    let one = of(1.0);
    for scale in [1e-6, 1e6] {
        assert!((of(scale) / one - 1.0).abs() < 1e-6, "{scale}: {} {one}", of(scale));
    }
}

/// A patch of light on a floor, a square with a half side of 0.37, and the greatest error of what it brings to a ceiling at
/// points near it, as a part of that.
fn error_above_a_patch_of_light(height: f64, settings: &RadiositySettings, points: &[[f64; 2]]) -> f64 {
    let plate = |name: &str, y: f64| {
        let mut plate = object(name, Shape::from(Primitive::Box { size: DVec3::new(4.0, 0.2, 4.0) }), 0.001);
        plate.transform = DMat4::from_translation(DVec3::new(0.0, y, 0.0));
        plate
    };
    let room = prepared(vec![plate("floor", -0.1), plate("ceiling", height + 0.1)], vec![]);
    let half = 0.37;
    let sent = |_: u32, outside: bool, at: DVec3| {
        let is_in = outside && at.y.abs() < 1e-3 && at.x.abs() < half && at.z.abs() < half;
        Channels::splat(if is_in { 3.0 } else { 0.0 })
    };
    let radiosity = solved(&room, settings, Some(&sent));
    // From a point at a distance of 1 above the corner of a rectangle of x by y.
    let corner = |x: f64, y: f64| {
        let part = |x: f64, y: f64| x / (1.0 + x * x).sqrt() * (y / (1.0 + x * x).sqrt()).atan();
        (part(x, y) + part(y, x)) / (2.0 * PI)
    };
    let error = |[x, z]: &[f64; 2]| {
        let [left, right, front, back] = [x + half, half - x, z + half, half - z].map(|side| side / height);
        let sign = |side: f64| side.signum();
        let pairs = [[left, front], [left, back], [right, front], [right, back]];
        let exact: f64 = 3.0 * pairs.map(|[a, b]| sign(a) * sign(b) * corner(a.abs(), b.abs())).iter().sum::<f64>();
        let at = DVec3::new(*x, height, *z);
        let found = (0..room.triangles.len() as u32).find_map(|triangle| {
            let corners = room.corners(triangle);
            let faces_down = normal_and_area(corners).0.y < -0.9 && corners[0].y > 0.5 * height;
            let weights = crate::numeric::triangle::weights(corners, at);
            let [a, b, c] = corners;
            // Of what is off the triangle, weights are those of the nearest point.
            let off = (a * weights[0] + b * weights[1] + c * weights[2]).distance(at);
            (faces_down && off < 1e-9)
                .then(|| radiosity.irradiance(triangle, true, weights, IrradiancePart::Indirect).0[0])
        });
        let found = found.expect("a place on the ceiling");
        (found / exact - 1.0).abs()
    };
    points.iter().map(error).fold(0.0, f64::max)
}

#[test]
fn a_patch_of_light_on_a_floor_lights_the_ceiling_as_the_closed_form_tells() {
    let points = [[0.0, 0.0], [0.5, 0.2], [-1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [1.0, 0.7], [-1.0, 0.7]];
    let fine = RadiositySettings { error: 0.002, finest: 1.0 / 400.0, ..RadiositySettings::default() };
    assert!(error_above_a_patch_of_light(1.0, &fine, &points) < 0.015);
    // Near its edge, light changes within the length of an element.
    let points = [[0.3, 0.0], [0.35, 0.1], [0.4, -0.2], [-0.45, 0.0], [0.0, 0.42], [0.38, 0.38], [-0.5, 0.3]];
    let coarse = RadiositySettings { error: 0.03, finest: 1.0 / 100.0, ..RadiositySettings::default() };
    assert!(error_above_a_patch_of_light(0.1, &coarse, &points) < 0.12);
}

#[test]
fn progress_is_told_and_a_solution_that_is_stopped_is_still_one() {
    let room = prepared(vec![cube("room", 2.0, 0.6), sphere("ball", 0.5, 0.8)], vec![lamp(DVec3::new(0.7, 0.8, 0.1))]);
    let plan = Plan::new(&room, &room.view());
    let (cancelled, told) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU64::new(0)));
    let watch = Watch { cancelled: &cancelled, ..Watch::NOBODY };
    let stop = {
        let (cancelled, told) = (cancelled.clone(), told.clone());
        move |event| match event {
            StageEvent::Progress { done, .. } => {
                assert!(done >= told.load(Ordering::Relaxed) as f64);
                told.store(done as u64, Ordering::Relaxed);
                cancelled.store(true, Ordering::Relaxed);
            }
            StageEvent::Begin { name: "solving for radiosity", all, .. } => assert_eq!(all, 6.0),
            _ => {}
        }
    };
    let world = World::new(&room, &plan).expect("a world");
    let solved_until = || Radiosity::new(&world, &plan, &coarse(), None, &watch);
    let stopped = observed(stop, solved_until).expect("a solution");
    assert!((1..=6).contains(&told.load(Ordering::Relaxed)));
    let whole = solved(&room, &coarse(), None);
    assert!(stopped.report.links < whole.report.links);
    assert!(middle(&stopped, 0, false, IrradiancePart::All).is_finite());
}

#[test]
fn ray_tracing_with_radiosity_tells_how_far_that_is_and_stops_there() {
    use crate::render::{Task, ray_tracer_watched};
    let mut room = prepared(vec![cube("room", 2.0, 0.6)], vec![lamp(DVec3::new(0.7, 0.8, 0.1))]);
    (room.settings.light.interreflection, room.settings.radiosity.error) = (Interreflection::Solved, 0.02);
    let plan = Plan::new(&room, &room.view());
    let links = |cancelled: bool| {
        let (cancelled, told) = (AtomicBool::new(cancelled), Arc::new(AtomicU64::new(0)));
        let watch = Watch { cancelled: &cancelled, ..Watch::NOBODY };
        let tell = {
            let told = told.clone();
            move |event| {
                if let StageEvent::Progress { done, .. } = event {
                    told.store(done as u64, Ordering::Relaxed);
                }
            }
        };
        let task = Task { watch, ..Task::new(&room, &plan) };
        let (_, report) = observed(tell, || ray_tracer_watched(&task)).expect("a tracer");
        assert!(told.load(Ordering::Relaxed) > 0);
        report.expect("a solution").links
    };
    assert!(links(true) < links(false));
}

#[test]
fn balls_of_many_small_triangles_have_few_elements_and_light_as_the_closed_form_tells() {
    let fine = |name, radius: f64| Object { tolerance: Some(radius * 1e-3), ..sphere(name, radius, 0.001) };
    let balls = prepared(vec![fine("inner", 1.0), fine("outer", 2.0)], vec![]);
    let glowing = |_: u32, outside: bool, at: DVec3| {
        let is_glowing = !outside && at.length() > 1.5;
        Channels::splat(if is_glowing { 1.0 } else { 0.0 })
    };
    let radiosity = solved(
        &balls,
        &RadiositySettings { error: 0.01, finest: 1.0 / 40.0, ..RadiositySettings::default() },
        Some(&glowing),
    );
    let RadiosityReport { patches, elements, .. } = radiosity.report;
    assert!(2 * elements < patches, "{elements} of {patches}");
    // The inner one sees nothing but the outer one, which sees of itself what the inner one leaves: 1 - (1/2)².
    for (object, outside, exact) in [(0, true, 1.0), (1, false, 0.75)] {
        let found = mean(&balls, &radiosity, object, outside, IrradiancePart::Indirect);
        assert!((found / exact - 1.0).abs() < 0.015, "{found} {exact}");
        let of = &balls.objects[object];
        let off: Vec<f64> = (of.first..of.first + of.count)
            .map(|triangle| middle(&radiosity, triangle, outside, IrradiancePart::Indirect) / exact - 1.0)
            .collect();
        let square = off.iter().map(|off| off * off).sum::<f64>() / off.len() as f64;
        let most = off.iter().fold(0.0f64, |most, off| most.max(off.abs()));
        assert!(square.sqrt() < 0.03 && most < 0.15, "{} {most}", square.sqrt());
    }
}

#[test]
fn a_ball_of_face_clusters_that_emits_inside_keeps_all_light() {
    let ball = Object { tolerance: Some(1e-3), ..sphere("ball", 1.0, 0.99) };
    let ball = prepared(vec![ball], vec![]);
    let glowing = |_: u32, outside: bool, _: DVec3| Channels::splat(if outside { 0.0 } else { 1.0 });
    let radiosity = solved(&ball, &coarse(), Some(&glowing));
    let RadiosityReport { patches, elements, .. } = radiosity.report;
    assert!(4 * elements < patches, "{elements} of {patches}");
    for triangle in [0, 77, 400] {
        let found = 1.0 + 0.99 * middle(&radiosity, triangle, false, IrradiancePart::All);
        assert!((found / 100.0 - 1.0).abs() < 1e-6, "{triangle}: {found}");
    }
}

/// A thin upright plate of a perfect mirror.
fn mirror(middle: DVec3, size: DVec3) -> Object {
    let mirror = Classic { diffuse: Paint::grey(0.0), mirror: Paint::grey(1.0), ..Classic::default() };
    let plate = object("mirror", Shape::from(Primitive::Box { size }), 0.0);
    Object { transform: DMat4::from_translation(middle), material: Some(mirror.into()), ..plate }
}

#[test]
fn mirrors_show_elements_the_sky_and_each_other() {
    // A mirror stands on the ground: what it takes of the sky it shows, and the sky is there in all directions.
    let plate = mirror(DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.02, 2.0, 3.0));
    let sky = Light::Sky { map: None, radiance: Color::grey(1.0), turned: 0.0 };
    let ground = object("ground", Shape::Ground { size: 3.0 }, 0.5);
    let open = prepared(vec![ground, plate], vec![sky]);
    let radiosity = solved(&open, &RadiositySettings { error: 0.02, finest: 0.02, ..coarse() }, None);
    // Points of both triangles of the ground, none next to the mirror.
    let points: Vec<[f64; 3]> = (0..100)
        .map(|i| [f64::from(i % 10) + 0.5, f64::from(i / 10) + 0.5].map(|x| x / 10.0))
        .map(|[u, v]| if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] })
        .map(|[u, v]| [1.0 - u - v, u, v])
        .filter(|weights| {
            (0..2).all(|triangle| {
                let corners = open.corners(triangle);
                (0..3).map(|i| corners[i].x * weights[i]).sum::<f64>().abs() > 0.05
            })
        })
        .collect();
    let [all, by_mirror] = [IrradiancePart::All, IrradiancePart::Indirect].map(|part| {
        let at =
            |weights: &[f64; 3]| -> f64 { (0..2).map(|t| radiosity.irradiance(t, true, *weights, part).0[0]).sum() };
        points.iter().map(at).sum::<f64>() / (2 * points.len()) as f64
    });
    assert!(by_mirror > 0.3 && (all / PI - 1.0).abs() < 0.01, "{all} {by_mirror}");
    // A wall of a closed room is a mirror: all that the others send comes to them, and light is the same everywhere.
    let wall = mirror(DVec3::new(0.97, 0.0, 0.0), DVec3::new(0.02, 1.999, 1.999));
    let room = prepared(vec![cube("room", 2.0, 0.6), wall], vec![]);
    let sends = |_: u32, outside: bool, _: DVec3| Channels::splat(if outside { 0.0 } else { 1.0 });
    let radiosity = solved(&room, &coarse(), Some(&sends));
    let light = mean(&room, &radiosity, 0, false, IrradiancePart::All);
    assert!((light / 2.5 - 1.0).abs() < 0.03, "{light} {:?}", radiosity.report);
}

#[test]
fn small_pictures_have_fewer_elements_unless_light_is_to_be_the_same_in_all() {
    let of = |width: u32, pixels: f64| {
        let lit = lamp(DVec3::new(0.5, 2.0, 1.0));
        let ground = object("ground", Shape::Ground { size: 4.0 }, 0.5);
        let mut scene = prepared(vec![ground, sphere("ball", 0.5, 0.5)], vec![lit]);
        (scene.settings.image.width, scene.settings.image.height) = (width, width);
        let settings = RadiositySettings { error: 0.05, finest: 0.01, pixels, ..RadiositySettings::default() };
        let radiosity = solved(&scene, &settings, None);
        (radiosity.report.elements, mean(&scene, &radiosity, 0, true, IrradiancePart::All))
    };
    let ([large, light], [small, other]) = ([of(640, 0.5), of(640, 0.0)], [of(8, 0.5), of(8, 0.0)]);
    assert!(4 * small.0 < 3 * large.0, "{small:?} {large:?}");
    assert!((small.1 / large.1 - 1.0).abs() < 0.05, "{small:?} {large:?}");
    assert_eq!(light, other);
}

#[test]
fn what_no_picture_shows_is_of_little_importance_unless_mirrors_may_show_it() {
    let inside_and_outside = || vec![lamp(DVec3::ZERO), lamp(DVec3::new(3.0, 4.0, 5.0))];
    let found = |objects: Vec<Object>, pixels: f64| -> Vec<(bool, f64)> {
        let mut scene = prepared(objects, inside_and_outside());
        (Technique::Radiosity.row().require)(&mut scene.settings);
        let plan = Plan::new(&scene, &scene.view());
        let world = World::new(&scene, &plan).expect("a world");
        let settings = RadiositySettings { pixels, ..coarse() };
        let visibility = VisibilityTester::new(&world, None);
        let edges = ShortestEdges::new(&scene, &plan, &settings);
        let hierarchy = Hierarchy::new(patches(&scene, &plan, &visibility), &edges, |_| false);
        let mut elements = Elements::new(hierarchy, &visibility, None, &[], true, &edges);
        let bound = RefinementBound { error: 0.1, mean: 1.0, dimmest: 1.0, shown: 0.0 };
        elements.divide_where_light_varies(&visibility, bound, BENT);
        let leaves = elements.hierarchy.leaves();
        let shown = ShownPlaces::new(&visibility, &plan, &settings);
        let importance = importance(&visibility, &elements, &shown, &leaves);
        let of = |(leaf, importance): (&u32, &f64)| {
            let node = &elements.hierarchy.nodes[*leaf as usize];
            let outside = elements.hierarchy.patches[node.patch as usize].outside;
            let is_shown = outside && (scene.camera.from - node.middle).dot(node.normal) > 0.0;
            (is_shown, *importance)
        };
        leaves.iter().zip(&importance).map(of).collect()
    };
    // The inner sides and those that face away see nothing that is shown.
    let known = found(vec![cube("box", 2.0, 0.5)], 0.5);
    let shown = known.iter().filter(|(is_shown, _)| *is_shown).count();
    assert!(shown >= 6 && known.len() >= 3 * shown, "{shown} of {}", known.len());
    for (is_shown, importance) in known {
        assert_eq!(importance, if is_shown { 1.0 } else { 1.0 / 16.0 });
    }
    // What lights what is shown is half as important, as it reflects half of its light.
    let ground = object("ground", Shape::Ground { size: 9.0 }, 0.5);
    let ground = Object { transform: DMat4::from_translation(DVec3::NEG_Y), ..ground };
    let mut beside_ground = found(vec![cube("box", 2.0, 0.5), ground], 0.5);
    beside_ground.retain(|(is_shown, importance)| !is_shown && *importance == 0.5);
    assert!(beside_ground.len() >= 4, "{beside_ground:?}");
    let plate = || mirror(DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.1, 2.0, 2.0));
    for (objects, pixels) in [(vec![cube("box", 2.0, 0.5)], 0.0), (vec![cube("box", 2.0, 0.5), plate()], 0.5)] {
        assert!(found(objects, pixels).iter().all(|(_, importance)| *importance == 1.0), "{pixels}");
    }
}

#[test]
fn elements_are_shorter_where_the_light_of_others_changes_within_their_length() {
    let room = prepared(vec![cube("room", 2.0, 0.5)], vec![]);
    let plan = Plan::new(&room, &room.view());
    let world = World::new(&room, &plan).expect("a world");
    let visibility = VisibilityTester::new(&world, None);
    let edges = ShortestEdges::everywhere(0.02);
    // A bright place of the floor, beside a wall.
    let sends = |_: u32, outside: bool, at: DVec3| {
        Channels::splat(if !outside && at.y < -0.99 && at.x > 0.7 && at.z.abs() < 0.15 { 100.0 } else { 0.0 })
    };
    let hierarchy = Hierarchy::new(patches(&room, &plan, &visibility), &edges, |_| false);
    let mut elements = Elements::new(hierarchy, &visibility, Some(&sends), &[], true, &edges);
    let bound = |mean: f64| RefinementBound { error: 0.1, mean, dimmest: 1.0, shown: 0.0 };
    elements.divide_where_light_varies(&visibility, bound(elements.mean_irradiance()), BENT);
    let (bound, mut links) = (bound(elements.mean_irradiance()), Vec::new());
    refine(&visibility, &mut elements, &mut links, bound, &|| false);
    let longest = |elements: &Elements<'_>, from: DVec3| {
        let near =
            |node: &&node::HierarchyNode| node.is_leaf() && node.normal.x < -0.9 && node.middle.distance(from) < 0.3;
        elements.hierarchy.nodes.iter().filter(near).map(|node| node.longest_edge()).fold(0.0, f64::max)
    };
    let [beside, far] = [DVec3::new(1.0, -0.8, 0.0), DVec3::new(1.0, 0.8, 0.8)];
    let before = [beside, far].map(|from| longest(&elements, from));
    divide_where_light_curves(&visibility, &mut elements, &links, bound, 1e9, &|| false);
    assert_eq!([beside, far].map(|from| longest(&elements, from)), before);
    divide_where_light_curves(&visibility, &mut elements, &links, bound, 0.25, &|| false);
    let after = [beside, far].map(|from| longest(&elements, from));
    assert!(after[0] < 0.6 * before[0] && after[1] == before[1], "{before:?} {after:?}");
}
