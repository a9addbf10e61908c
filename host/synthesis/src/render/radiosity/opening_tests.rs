//! Light through openings: beside closed forms, and beside random walks.

use super::elements::Elements;
use super::hierarchy::Hierarchy;
use super::tests::{object, solved};
use super::*;
use crate::color::Color;
use crate::illumination::Light;
use crate::illumination::light::LightShape;
use crate::numeric::sampling::{RandomStream, cosine_hemisphere};
use crate::numeric::triangle;
use crate::scene::{Interreflection, RadiositySettings, Scene, Shape};
use glam::DVec3;
use std::f64::consts::PI;

/// The wall x = 1 of a room of 2 by 2 by 2 around the origin, a sheet with a square hole in its middle, the other five
/// walls, and, if it is deep, a tunnel that leads from the hole outwards.
fn room_with_an_opening(width: f64, depth: f64, lights: Vec<Light>) -> Prepared {
    let half = 0.5 * width;
    let steps = [-1.0, -half, half, 1.0];
    let at = |i: usize, j: usize| DVec3::new(1.0, steps[i], steps[j]);
    let mut vertices: Vec<DVec3> = (0..16).map(|k| at(k / 4, k % 4)).collect();
    let mut triangles = Vec::new();
    for (i, j) in (0..9).map(|k| (k / 3, k % 3)).filter(|cell| *cell != (1, 1)) {
        let [a, b, c, d] = [4 * i + j, 4 * i + j + 1, 4 * i + j + 5, 4 * i + j + 4].map(|k| k as u32);
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    let first = vertices.len() as u32;
    vertices.extend((0..8).map(|k| {
        let side = |bit: u32| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
        DVec3::new(side(0), side(1), side(2))
    }));
    for [a, b, c, d] in [[0, 4, 6, 2], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
        triangles.extend([[a, b, c], [a, c, d]].map(|corners| corners.map(|k: u32| first + k)));
    }
    if depth > 0.0 {
        let (hole, end) = ([5, 9, 10, 6], vertices.len() as u32);
        vertices.extend(hole.map(|k: u32| vertices[k as usize] + DVec3::X * depth));
        for (i, j) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
            let [a, b, c, d] = [hole[i], hole[j], end + j as u32, end + i as u32];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.obj");
    let lines = vertices.iter().map(|v| format!("v {} {} {}\n", v.x, v.y, v.z));
    let faces = triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|corner| corner + 1);
        format!("f {a} {b} {c}\n")
    });
    std::fs::write(&path, lines.chain(faces).collect::<String>()).expect("a file");
    let room = object("room", Shape::Mesh { path }, 0.5);
    let mut scene = Scene { objects: vec![room], lights, ..Scene::default() };
    scene.settings.light.interreflection = Interreflection::Followed;
    let corner = DVec3::new(1.0, -half, -half);
    scene.portals.push(LightShape::Rectangle { corner, across: DVec3::Z * width, up: DVec3::Y * width });
    Prepared::new(&scene).expect("a scene")
}

/// Flux of lights that comes to the inner sides of the room, W.
fn flux_of_lights(room: &Prepared) -> f64 {
    let plan = Plan::new(room, &room.view());
    let world = World::new(room, &plan).expect("a world");
    let visibility = VisibilityTester::new(&world, None);
    let is_inner = |patch: &RadiosityPatch| normal_and_area(patch.corners).0.dot(patch.corners[0]) < 0.0;
    let inner: Vec<RadiosityPatch> = patches(room, &plan, &visibility).into_iter().filter(is_inner).collect();
    let edges = ShortestEdges::everywhere(room.bounds.diagonal() / 200.0);
    let through = visibility.light_through_openings(true);
    let mut elements =
        Elements::new(Hierarchy::new(inner, &edges, |_| false), &visibility, None, &through, true, &edges);
    let bound = RefinementBound { error: 0.005, mean: elements.mean_irradiance(), dimmest: 1.0, shown: 0.0 };
    elements.divide_where_light_varies(&visibility, bound, BENT);
    let leaves = elements.hierarchy.leaves();
    let sampled = elements.sample_direct(&visibility, &leaves);
    elements.correct_direct(&leaves, &sampled, &vec![0; leaves.len()]);
    leaves.iter().map(|leaf| elements.direct[*leaf as usize].0[0] * elements.hierarchy.nodes[*leaf as usize].area).sum()
}

#[test]
fn what_comes_through_an_opening_is_what_the_closed_form_tells() {
    let grey = Color::grey;
    for width in [0.05, 0.2, 0.6, 1.6] {
        let area = width * width;
        let lamp = DVec3::new(3.0, 0.4, -0.3);
        let direction = DVec3::new(-1.0, -0.35, 0.2).normalize();
        // Of a point, the solid angle of the opening, by its four rectangles from the foot of the perpendicular.
        let corner = |y: f64, z: f64, h: f64| (y * z).atan2(h * (h * h + y * y + z * z).sqrt());
        let angle = |at: DVec3| -> f64 {
            let ends = |middle: f64| [-0.5 * width - middle, 0.5 * width - middle];
            let ([y0, y1], [z0, z1], h) = (ends(at.y), ends(at.z), at.x - 1.0);
            corner(y1, z1, h) - corner(y0, z1, h) - corner(y1, z0, h) + corner(y0, z0, h)
        };
        let sky = Light::Sky { map: None, radiance: grey(1.0), turned: 0.0 };
        let sun = Light::Directional { direction, irradiance: grey(2.0) };
        let point = Light::Point { at: lamp, intensity: grey(3.0) };
        let lights = [(sky, PI * area), (sun, 2.0 * area * -direction.x), (point, 3.0 * angle(lamp))];
        for (light, exact) in lights {
            let room = room_with_an_opening(width, 0.0, vec![light.clone()]);
            let found = flux_of_lights(&room);
            assert!((found / exact - 1.0).abs() < 0.005, "{width} {light:?}: {found} {exact}");
        }
    }
}

/// Flux that comes to the side of a triangle that looks at the origin, W.
fn flux_inside(room: &Prepared, radiosity: &Radiosity, triangle: u32) -> f64 {
    let corners = room.corners(triangle);
    let inside = normal_and_area(corners).0.dot(corners[0]) < 0.0;
    let mut pending: Vec<ElementTree> = radiosity.element_tree(triangle, inside).into_iter().collect();
    let mut flux = 0.0;
    while let Some(tree) = pending.pop() {
        if tree.parts.is_empty() {
            let weights = triangle::weights(corners, tree.corners.iter().sum::<DVec3>() / 3.0);
            let irradiance = radiosity.irradiance(triangle, inside, weights, IrradiancePart::All).0[0];
            flux += irradiance * normal_and_area(tree.corners).1;
        }
        pending.extend(tree.parts);
    }
    flux
}

/// The flux that leaves the far end of a square tunnel of a length of 1 with grey walls, if diffuse light of a radiosity of
/// 1 comes to its near end: by random walks.
fn through_a_tunnel(width: f64, reflectance: f64, walks: u32) -> f64 {
    let mut random = RandomStream::new(7, 0);
    let mut out = 0;
    for _ in 0..walks {
        let [y, z] = random.point().map(|x| x * width);
        let (mut at, mut normal) = (DVec3::new(0.0, y, z), DVec3::X);
        loop {
            let towards = cosine_hemisphere(random.point(), normal);
            let to = |axis: usize, size: f64| {
                let end = if towards[axis] > 0.0 { size } else { 0.0 };
                if towards[axis] == 0.0 { f64::INFINITY } else { ((end - at[axis]) / towards[axis]).max(0.0) }
            };
            let distances = [to(0, 1.0), to(1, width), to(2, width)];
            let axis = (0..3).min_by(|a, b| distances[*a].total_cmp(&distances[*b])).expect("three");
            if axis == 0 {
                out += u32::from(towards.x > 0.0);
                break;
            }
            if random.uniform() >= reflectance {
                break;
            }
            at += towards * distances[axis];
            at[axis] = if towards[axis] > 0.0 { width } else { 0.0 };
            normal = DVec3::ZERO;
            normal[axis] = -towards[axis].signum();
        }
    }
    f64::from(out) / f64::from(walks) * width * width
}

#[test]
fn a_room_behind_a_deep_window_has_the_light_that_random_walks_in_the_window_tell() {
    let width = 0.25;
    let sky = Light::Sky { map: None, radiance: Color::grey(1.0), turned: 0.0 };
    let room = room_with_an_opening(width, 1.0, vec![sky]);
    let radiosity = solved(&room, &RadiositySettings { finest: 0.005, ..RadiositySettings::default() }, None);
    // The walls of the window are not of the room.
    let inner =
        (0..room.triangles.len() as u32).filter(|triangle| room.corners(*triangle).iter().all(|at| at.x <= 1.0));
    let found: f64 = inner.map(|triangle| flux_inside(&room, &radiosity, triangle)).sum();
    // Of what the room reflects, the part of the window is lost, but for what its walls send back.
    let lost = 0.75 * width * width / 24.0;
    let exact = PI * through_a_tunnel(width, 0.5, 1 << 23) / (1.0 - 0.5 * (1.0 - lost));
    assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
}
