//! Shaded images.

use super::*;
use protocol::command::Illumination;

/// The pixel at a position of the vector screen.
pub(super) fn at(image: &Image, x: f64, y: f64) -> [u8; 3] {
    let place = |c: f64, pixels: u32| ((c + 1.0) / 2.0 * f64::from(pixels)) as usize;
    image.pixels[place(y, image.height) * image.width as usize + place(x, image.width)]
}

pub(super) fn grey(value: f64) -> [u8; 3] {
    [(value.min(1.0) * 255.0).round() as u8; 3]
}

/// Light of a white surface whose normal is at an angle with this cosine to light and eye, beyond any highlight.
pub(super) fn lambert(cosine: f64) -> f64 {
    0.25 + 0.75 * cosine
}

#[test]
fn wash_fills_the_outline_of_the_tetrahedron_exactly() {
    let image = Scene::solid(tetrahedron()).image(Rendering::Wash, &plain());
    assert_eq!((image.left, image.bottom, image.width, image.height), (80, 0, 480, 480));
    for (index, pixel) in image.pixels.iter().enumerate() {
        let inside = [index % 480, index / 480].iter().all(|c| (120..360).contains(c));
        assert_eq!(*pixel, if inside { [255; 3] } else { [0; 3] }, "{index}");
    }
}

#[test]
fn flat_light_is_that_of_the_face() {
    // Faces of the tetrahedron stand at cos = 1 / sqrt 3; their highlights go elsewhere.
    let value = grey(lambert(1.0 / 3_f64.sqrt()));
    for kind in [Rendering::Flat, Rendering::Gouraud, Rendering::Phong] {
        let image = Scene::solid(tetrahedron()).image(kind, &plain());
        assert!(image.pixels.iter().all(|pixel| *pixel == value || *pixel == [0; 3]), "{kind:?}");
    }
    let level = polygon(&[[-0.5, -0.5, 0.0], [0.0, 0.7, 0.0], [0.5, -0.5, 0.0]]);
    let image =
        Scene::new(vec![level.clone()]).image(Rendering::Flat, &ShadingEnvironment { ambient: [0.0; 3], ..plain() });
    assert_eq!(at(&image, 0.0, 0.0), [255; 3], "0.75 and a highlight of 0.25");
    let dull = ShadingEnvironment { ambient: [0.0; 3], highlights: false, exposure: 0.5, ..plain() };
    assert_eq!(at(&Scene::new(vec![level]).image(Rendering::Flat, &dull), 0.0, 0.0), grey(0.375));
}

#[test]
fn gouraud_mixes_the_light_of_the_corners_and_phong_their_normals() {
    let scene = Scene::solid(tetrahedron().into_iter().map(soft).collect());
    let cosine = 1.0 / 3_f64.sqrt();
    let close = |got: [u8; 3], expected: [u8; 3]| got[0].abs_diff(expected[0]) <= 1 && got[0] == got[2];
    // Normals at A and D point away from the light, those at B and C stand at that angle.
    let gouraud = scene.image(Rendering::Gouraud, &plain());
    let middle = (0.25 + 2.0 * lambert(cosine)) / 3.0;
    assert!(close(at(&gouraud, 1.0 / 6.0, 1.0 / 6.0), grey(middle)), "{:?}", at(&gouraud, 1.0 / 6.0, 1.0 / 6.0));
    assert!(close(at(&gouraud, 0.001, 0.001), grey(lambert(cosine))));
    let phong = scene.image(Rendering::Phong, &plain());
    // At the middle of this pixel A has the share u, B and C the rest.
    let u = 2.0 * (280.5 / 240.0 - 1.0);
    let normal = DVec3::new(u, u, 2.0 * u - 1.0).normalize();
    assert!(close(at(&phong, 1.0 / 6.0, 1.0 / 6.0), grey(lambert(-normal.z))));
    // In the middle of BC the normal points at the eye.
    assert_eq!(at(&phong, 0.001, 0.001), [255; 3]);
}

#[test]
fn normals_that_are_given_are_used() {
    let mut triangle = polygon(&[[-0.5, -0.5, 0.0], [0.0, 0.7, 0.0], [0.5, -0.5, 0.0]]);
    for vertex in &mut triangle.vertices {
        vertex.normal = Some([3.0, 0.0, -3.0]);
    }
    let cosine = 0.5_f64.sqrt();
    for kind in [Rendering::Gouraud, Rendering::Phong] {
        let image = Scene::new(vec![triangle.clone()]).image(kind, &plain());
        assert_eq!(at(&image, 0.0, 0.0), grey(lambert(cosine)), "{kind:?}");
    }
}

#[test]
fn gouraud_is_even_in_space_not_on_the_screen() {
    // A strip that goes away from z = 1 to z = 3; at its middle, z = 2, the light is the mean.
    let normals = [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0]];
    let mut strip = polygon(&[[-0.3, -0.5, 1.0], [-0.3, -0.5, 3.0], [0.3, -0.5, 3.0], [0.3, -0.5, 1.0]]);
    for (vertex, normal) in strip.vertices.iter_mut().zip([0, 1, 1, 0]) {
        vertex.normal = Some(normals[normal]);
    }
    let environment = ShadingEnvironment { ambient: [0.0; 3], highlights: false, ..plain() };
    let image = Scene::new(vec![strip]).above(perspective()).image(Rendering::Gouraud, &environment);
    let y = -0.5 / 2.0 / (30_f64.to_radians().tan());
    let got = at(&image, 0.0, y)[0];
    assert!(got.abs_diff(grey(0.375)[0]) <= 1, "{got}");
}

#[test]
fn lights_below_the_node_turn_with_it_and_colour_the_surface() {
    let level = polygon(&[[-0.5, -0.5, 0.0], [0.0, 0.7, 0.0], [0.5, -0.5, 0.0]]);
    let red = Illumination { direction: DVec3::NEG_X, color: [120.0, 1.0, 1.0], ambient: 0.0 };
    let scene = Scene::new(vec![level]).below(Node::Illumination(red));
    let dull = ShadingEnvironment { highlights: false, ..plain() };
    assert_eq!(at(&scene.image(Rendering::Flat, &dull), 0.0, 0.0), [0; 3], "it comes from the side");
    // Turning everything by 90 degrees about y would show the edge; only the light is turned here.
    let turn = Operation::Linear(crate::matrices::rotation(protocol::command::Axis::Y, 90.0));
    let turned = vec![Member::Unnamed(Node::operate(turn, None)), Member::Unnamed(Node::Illumination(red))];
    let mut scene = scene;
    scene.below[0] = Node::Group(turned);
    assert_eq!(at(&scene.image(Rendering::Flat, &dull), 0.0, 0.0), [191, 0, 0]);
}

#[test]
fn the_reverse_of_a_surface_is_lit_on_the_side_of_the_eye() {
    let mut back = polygon(&[[-0.5, -0.5, 0.0], [0.0, 0.7, 0.0], [0.5, -0.5, 0.0]]);
    back.vertices.reverse();
    for kind in [Rendering::Flat, Rendering::Gouraud, Rendering::Phong] {
        let dull = ShadingEnvironment { highlights: false, ambient: [0.0; 3], ..plain() };
        let image = Scene::new(vec![back.clone()]).image(kind, &dull);
        assert_eq!(at(&image, 0.0, 0.0), grey(0.75), "{kind:?}");
    }
}

/// A net of triangles over the whole viewport, with corners that lie anywhere.
fn net(n: usize) -> Vec<Polygon> {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f32 / (1 << 24) as f32 - 0.5
    };
    let side = 2.0 / n as f32;
    let mut corner = |i: usize, k: usize| {
        let inner = i > 0 && k > 0 && i < n && k < n;
        let shift = if inner { 0.9 * side } else { 0.0 };
        [i as f32 * side - 1.0 + random() * shift, k as f32 * side - 1.0 + random() * shift, random()]
    };
    let corners: Vec<[f32; 3]> =
        (0..=n).flat_map(|i| (0..=n).map(move |k| (i, k))).map(|(i, k)| corner(i, k)).collect();
    let at = |i: usize, k: usize| corners[i * (n + 1) + k];
    let cells = (0..n * n).map(|c| (c / n, c % n));
    cells
        .flat_map(|(i, k)| {
            let [a, b, c, d] = [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)];
            [polygon(&[a, b, c]), polygon(&[a, c, d])]
        })
        .collect()
}

#[test]
fn there_are_no_cracks_between_neighbours() {
    for n in [1, 7, 50, 150] {
        for quality in 0..=3 {
            if n == 150 && quality > 1 {
                continue;
            }
            let image = Scene::new(net(n)).image(Rendering::Wash, &ShadingEnvironment { quality, ..plain() });
            assert!(image.pixels.iter().all(|pixel| *pixel == [255; 3]), "{n} {quality}");
        }
    }
}

#[test]
fn two_thousand_polygons_show_the_nearest_one_at_each_pixel() {
    let turn = DMat3::from_rotation_x(0.9) * DMat3::from_rotation_y(0.4);
    let polygons = torus(32, turn);
    let environment = ShadingEnvironment { viewport: [0, 0, 160, 160], highlights: false, ..plain() };
    let image = Scene::solid(polygons.clone()).image(Rendering::Flat, &environment);
    let mut compared = 0;
    for (index, pixel) in image.pixels.iter().enumerate() {
        let [x, y] = [index % 160, index / 160].map(|c| (c as f64 + 0.5) / 80.0 - 1.0);
        let mut best = (f64::INFINITY, grey(0.0));
        let mut second = f64::INFINITY;
        let mut edge = false;
        for polygon in &polygons {
            let [a, b, c] = [0, 1, 2].map(|k| DVec3::from(polygon.vertices[k].position.map(f64::from)));
            let normal = (b - a).cross(c - a);
            let part = |p: DVec3, q: DVec3| ((p.x - x) * (q.y - y) - (p.y - y) * (q.x - x)) / normal.z;
            let shares = [part(b, c), part(c, a), part(a, b)];
            let least = shares.into_iter().fold(f64::INFINITY, f64::min);
            edge |= least.abs() < 1e-3;
            if least >= 0.0 {
                let depth = a.z - ((x - a.x) * normal.x + (y - a.y) * normal.y) / normal.z;
                if depth < best.0 {
                    let cosine = normal.normalize().dot(DVec3::NEG_Z).abs();
                    (second, best) = (best.0, (depth, grey(lambert(cosine))));
                } else {
                    second = second.min(depth);
                }
            }
        }
        if edge || second - best.0 < 1e-3 && second.is_finite() {
            continue;
        }
        compared += 1;
        assert_eq!(*pixel, best.1, "at {x} {y}");
    }
    assert!(compared > 15_000, "{compared}");
}

#[test]
fn smooth_edges_cover_as_much_as_the_area() {
    let triangle = polygon(&[[-0.83, -0.71, 0.0], [-0.17, 0.9, 0.0], [0.77, -0.3, 0.0]]);
    let area = {
        let [a, b, c] = [0, 1, 2].map(|k| DVec3::from(triangle.vertices[k].position.map(f64::from)).truncate());
        (b - a).perp_dot(c - a).abs() / 2.0 * 240.0 * 240.0
    };
    let mut errors = Vec::new();
    for quality in 0..=3 {
        let image =
            Scene::new(vec![triangle.clone()]).image(Rendering::Wash, &ShadingEnvironment { quality, ..plain() });
        let sum: f64 = image.pixels.iter().map(|pixel| f64::from(pixel[0]) / 255.0).sum();
        errors.push((sum - area).abs());
        let between = image.pixels.iter().filter(|pixel| pixel[0] > 0 && pixel[0] < 255).count();
        assert_eq!(between > 0, quality > 0);
    }
    assert!(errors[3] < 1.5 && errors[1] < 6.0, "{errors:?}");
}

#[test]
fn background_depth_cue_and_viewport_are_those_of_the_environment() {
    let environment =
        ShadingEnvironment { background: [240.0, 1.0, 0.5], viewport: [10, 20, 100, 50], depth_cue: 0.5, ..plain() };
    // From the front boundary on the left to the back boundary on the right.
    let slope = polygon(&[[-1.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, -1.0, 1.0]]);
    let image = Scene::new(vec![slope]).image(Rendering::Wash, &environment);
    assert_eq!((image.left, image.bottom, image.width, image.height), (10, 20, 100, 50));
    assert_eq!(image.pixels[49 * 100 + 50], [0, 128, 0]);
    for column in [0_usize, 50, 99] {
        let depth = (column as f64 + 0.5) / 100.0;
        assert_eq!(image.pixels[5 * 100 + column], grey(1.0 - 0.5 * depth), "{column}");
    }
}

#[test]
fn work_in_slices_gives_the_same_image() {
    let scene = Scene::solid(torus(16, DMat3::from_rotation_x(0.9)));
    let environment = ShadingEnvironment::default();
    let whole = scene.image(Rendering::Phong, &environment);
    let mut task = Task::new(Rendering::Phong, scene.facets(STORAGE).unwrap(), &environment).unwrap();
    let mut slices = 1;
    let sliced = loop {
        match task.advance(100_000) {
            Some(outcome) => break outcome,
            None => slices += 1,
        }
    };
    assert!(slices > 3, "{slices}");
    assert_eq!(sliced, RenderingResult::Image(whole));
}

#[test]
fn a_hole_shows_what_is_behind_it() {
    let square = |s: f32, z: f32| [[-s, -s, z], [-s, s, z], [s, s, z], [s, -s, z]];
    let plate = vec![polygon(&square(0.75, 0.0)), hole(&square(0.25, 0.0))];
    let lit = |image: &Image| image.pixels.iter().filter(|pixel| **pixel != [0; 3]).count();
    let open = Scene::new(plate.clone()).image(Rendering::Wash, &plain());
    assert_eq!(lit(&open), 360 * 360 - 120 * 120);
    let behind = vec![polygon(&square(0.125, 0.5))];
    let image = Scene::new([plate, behind].concat()).image(Rendering::Wash, &plain());
    assert_eq!(lit(&image), 360 * 360 - 120 * 120 + 60 * 60);
    assert_eq!((at(&image, 0.0, 0.0), at(&image, 0.2, 0.0)), ([255; 3], [0; 3]));
}
