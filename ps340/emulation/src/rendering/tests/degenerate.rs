//! Hidden lines where signs are 0: edges seen end on, lines in faces, corners in edges, polygons without area, the eye.

use super::*;

fn length(lines: &[Segment]) -> f64 {
    lines.iter().map(|s| (s.ends[1] - s.ends[0]).length()).sum()
}

/// A box with its front and back parallel to the screen; the front comes first.
fn cuboid() -> Vec<Polygon> {
    let at = |corner: usize| [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 0.5 } else { -0.5 });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [2, 6, 7, 3], [0, 1, 5, 4]];
    faces.iter().map(|face| polygon(&face.map(at))).collect()
}

#[test]
fn edges_seen_end_on_are_hidden_by_the_face_before_them() {
    for solid in [true, false] {
        let lines = Scene { solid, ..Scene::new(cuboid()) }.lines(Rendering::HiddenLine);
        assert_eq!((lines.len(), length(&lines)), (4, 4.0), "solid {solid}");
        assert!(lines.iter().flat_map(|s| s.ends).all(|end| end.z == -0.5));
    }
    // Without the front, what stands exactly behind its edges is seen.
    let open = Scene::new(cuboid()[1..].to_vec()).lines(Rendering::HiddenLine);
    assert_eq!((open.len(), length(&open)), (12, 12.0));
}

#[test]
fn lines_in_a_face_are_seen_at_a_grazing_angle_and_in_perspective() {
    for angle in [1.4, 1.5, 1.56, 1.5705] {
        let turn = DMat3::from_rotation_x(angle);
        let square = |x: f64, y: f64, s: f64| {
            let corners = [[x, y], [x, y + s], [x + s, y + s], [x + s, y]];
            polygon(&corners.map(|[x, y]| (turn * DVec3::new(x, y, 0.0) + DVec3::Z * 2.0).as_vec3().to_array()))
        };
        let squares = vec![square(-0.4, -0.4, 0.8), square(-0.3, -0.3, 0.2), square(0.0, -0.1, 0.4)];
        let lines = Scene::new(squares).above(perspective()).lines(Rendering::HiddenLine);
        assert!((length(&lines) - 4.0 * (0.8 + 0.2 + 0.4)).abs() < 1e-5, "{angle}: {}", length(&lines));
    }
}

#[test]
fn corners_in_an_edge_of_a_neighbour_hide_nothing_of_it() {
    for turn in
        (0..60).map(|k| DMat3::from_rotation_y(0.7 * f64::from(k)) * DMat3::from_rotation_x(0.05 * f64::from(k)))
    {
        // A long board, and two at an angle to it whose common corner is about on its edge.
        let at = |x: f64, y: f64, z: f64| (turn * DVec3::new(x, y, z)).as_vec3().to_array();
        let boards = vec![
            polygon(&[at(-0.6, 0.0, 0.0), at(-0.6, 0.5, 0.0), at(0.6, 0.5, 0.0), at(0.6, 0.0, 0.0)]),
            polygon(&[at(-0.6, 0.0, 0.0), at(0.1, 0.0, 0.0), at(0.1, -0.5, 0.1), at(-0.6, -0.5, 0.1)]),
            polygon(&[at(0.1, 0.0, 0.0), at(0.6, 0.0, 0.0), at(0.6, -0.5, 0.1), at(0.1, -0.5, 0.1)]),
        ];
        let lines = Scene::new(boards).lines(Rendering::HiddenLine);
        let direction = turn * DVec3::X;
        let on_edge = |p: DVec3| p.reject_from_normalized(direction).length() < 1e-6;
        let joint: Vec<Segment> = lines.iter().filter(|s| s.ends.iter().all(|p| on_edge(*p))).copied().collect();
        // The long edge and the two short ones upon it.
        assert!((length(&joint) - 2.4).abs() < 1e-5, "{turn}: {joint:?}");
    }
}

/// A sphere of quadrangles with soft edges; those at the poles use the pole twice unless they are made triangles.
fn sphere(n: usize, triangles: bool) -> Vec<Polygon> {
    let turn = DMat3::from_rotation_x(0.9) * DMat3::from_rotation_z(0.3);
    let at = |i: usize, k: usize| {
        let (u, v) = (std::f64::consts::PI * i as f64 / n as f64, std::f64::consts::TAU * (k % n) as f64 / n as f64);
        let ring = if i.is_multiple_of(n) { 0.0 } else { 0.7 * u.sin() };
        (turn * DVec3::new(ring * v.cos(), ring * v.sin(), 0.7 * u.cos())).as_vec3().to_array()
    };
    let cells = (0..n * n).map(|cell| (cell / n, cell % n));
    let cell = |(i, k)| {
        let [a, b, c, d] = [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)];
        soft(match (triangles, i) {
            (true, 0) => polygon(&[a, d, c]),
            (true, i) if i + 1 == n => polygon(&[a, c, b]),
            _ => polygon(&[a, d, c, b]),
        })
    };
    cells.map(cell).collect()
}

#[test]
fn a_corner_that_is_given_twice_counts_once() {
    for solid in [true, false] {
        let [doubled, plain] = [false, true]
            .map(|triangles| Scene { solid, ..Scene::new(sphere(24, triangles)) }.lines(Rendering::HiddenLine));
        assert_eq!(ends(&doubled), ends(&plain));
        // Its outline only: nothing is drawn at the pole that is seen.
        let outline = |p: DVec3| p.truncate().length() > 0.6;
        assert!(plain.len() > 20 && plain.iter().flat_map(|s| s.ends).all(outline));
    }
}

#[test]
fn polygons_without_area_hide_nothing() {
    let back = polygon(&[[-0.5, -0.5, 0.5], [0.0, 0.7, 0.5], [0.5, -0.5, 0.5]]);
    let flat = [
        polygon(&[[-0.9, 0.0, 0.0], [0.9, 0.0, 0.0], [0.0, 0.0, 0.0], [0.3, 0.0, 0.0]]),
        polygon(&[[0.0, 0.0, 0.0], [0.0, 0.0, 0.3], [0.0, 0.0, 0.4]]),
        polygon(&[[0.1, -0.9, 0.0], [0.1, 0.9, 0.0], [0.1, 0.0, 0.3]]),
    ];
    let alone = ends(&Scene::new(vec![back.clone()]).lines(Rendering::HiddenLine));
    for flat in flat {
        let lines = ends(&Scene::new(vec![flat, back.clone()]).lines(Rendering::HiddenLine));
        assert!(alone.iter().all(|line| lines.contains(line)), "{lines:?}");
    }
}

/// A square of four triangles, soft inside, with normals towards the eye: the third corner of one beside the diagonal
/// lies this far on the wrong side of it, so that the triangle shows its reverse.
fn folded(by: f32, has_normals: bool) -> Vec<Polygon> {
    let [a, b, c, d] = [[-0.5, -0.5, 0.0], [-0.5, 0.5, 0.0], [0.5, 0.5, 0.0], [0.5, -0.5, 0.0]];
    let middle = [-by, by, 0.0];
    let triangles = [[a, b, c], [a, c, middle], [c, d, middle], [d, a, middle]];
    let mut polygons: Vec<Polygon> = triangles.iter().map(|corners| soft(polygon(corners))).collect();
    if has_normals {
        polygons.iter_mut().flat_map(|p| &mut p.vertices).for_each(|vertex| vertex.normal = Some([0.0, 0.0, -1.0]));
    }
    polygons
}

#[test]
fn a_triangle_that_is_thin_but_for_single_precision_faces_as_its_normals_do() {
    let outline = |lines: &[Segment]| ends(lines).len() == 4 && length(lines) == 4.0;
    assert!(outline(&Scene::new(folded(3e-8, true)).lines(Rendering::HiddenLine)), "as the square");
    // Without normals, and where it is no matter of precision, it is a fold with edges of its own.
    assert!(!outline(&Scene::new(folded(3e-8, false)).lines(Rendering::HiddenLine)));
    assert!(!outline(&Scene::new(folded(0.1, true)).lines(Rendering::HiddenLine)));
}

#[test]
fn corners_in_the_plane_of_the_eye_take_no_depth_from_the_rest() {
    // Two squares so close that only a fine depth distinguishes them, and a floor through the plane of the eye.
    let square = |s: f32, z: f32| polygon(&[[-s, -s, z], [-s, s, z], [s, s, z], [s, -s, z]]);
    let squares = vec![square(0.5, 2.0), square(0.3, 2.0 + 1e-6)];
    let floors = [
        polygon(&[[-1.0, -0.6, 0.0], [0.0, -0.6, 4.0], [1.0, -0.6, 0.0]]),
        polygon(&[[0.0, 0.0, 0.0], [-1.0, -0.6, 4.0], [1.0, -0.6, 4.0]]),
        polygon(&[[0.0, -0.6, -1.0], [-1.0, -0.6, 4.0], [1.0, -0.6, 4.0]]),
    ];
    for floor in floors {
        let scene = Scene::new([squares.clone(), vec![floor]].concat()).above(perspective());
        let lines = scene.lines(Rendering::HiddenLine);
        assert!(lines.iter().flat_map(|s| s.ends).all(DVec3::is_finite));
        let behind =
            lines.iter().filter(|s| s.ends.iter().all(|p| p.x.abs() <= 0.3 && p.z > 2.0 && p.y > -0.5 && p.z < 2.1));
        assert_eq!(behind.count(), 0, "the square behind is hidden");
    }
}

#[test]
fn size_does_not_matter() {
    let polygons = torus(12, DMat3::from_rotation_x(0.9) * DMat3::from_rotation_y(0.4));
    let plain = Scene::new(polygons.clone()).lines(Rendering::HiddenLine);
    for size in [1e-30, 1e-9, 1e9, 1e30] {
        let sized = |p: &Polygon| {
            let vertices = p.vertices.iter().map(|v| PolygonVertex { position: v.position.map(|c| c * size), ..*v });
            Polygon { vertices: vertices.collect(), ..p.clone() }
        };
        let back = Operation::Linear(DMat3::from_diagonal(DVec3::splat(1.0 / f64::from(size))));
        let scene = Scene::new(polygons.iter().map(sized).collect()).above(back);
        let lines = scene.lines(Rendering::HiddenLine);
        let total = length(&lines) / f64::from(size);
        assert!((total - length(&plain)).abs() < 1e-4, "{size}: {total} {}", length(&plain));
        let inside = DMat3::from_diagonal(DVec3::splat(f64::from(size)));
        let large =
            Scene::new(polygons.clone()).above(Operation::Projective(view_of(size))).above(Operation::Linear(inside));
        assert!((length(&large.lines(Rendering::HiddenLine)) - length(&plain)).abs() < 1e-4, "{size}");
    }
}

/// A view of a box of a size, seen as the box of size 1 is without a view.
fn view_of(size: f32) -> DMat4 {
    DMat4::from_scale(DVec3::splat(1.0 / f64::from(size)))
}
