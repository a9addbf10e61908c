//! Back-face and hidden-line removal.

use super::*;

#[test]
fn of_a_tetrahedron_the_edge_behind_is_hidden() {
    let seen = edges(&[[A, B], [B, C], [A, C], [B, D], [C, D]]);
    let all = edges(&[[A, B], [B, C], [A, C], [B, D], [C, D], [A, D]]);
    let solid = Scene::solid(tetrahedron());
    assert_eq!(ends(&solid.lines(Rendering::BackFace)), seen);
    assert_eq!(ends(&solid.lines(Rendering::HiddenLine)), seen);
    let surface = Scene::new(tetrahedron());
    assert_eq!(ends(&surface.lines(Rendering::BackFace)), all, "both sides of a surface are seen");
    assert_eq!(ends(&surface.lines(Rendering::HiddenLine)), seen);
}

#[test]
fn a_mirror_changes_what_is_front_and_not_what_is_outside() {
    let mirror = Operation::Linear(DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)));
    let solid = Scene::solid(tetrahedron()).above(mirror);
    let seen = edges(&[[A, B], [B, C], [A, C], [B, D], [C, D]]);
    assert_eq!(ends(&solid.lines(Rendering::BackFace)), seen);
    let behind = Operation::Linear(DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)));
    let seen = edges(&[[A, B], [A, D], [A, C], [B, D], [C, D]]);
    let solid = Scene::solid(tetrahedron()).above(behind);
    assert_eq!(ends(&solid.lines(Rendering::BackFace)), seen, "now A and D are in front");
    assert_eq!(ends(&solid.lines(Rendering::HiddenLine)), seen);
}

#[test]
fn soft_edges_are_drawn_where_they_are_the_outline() {
    let solid = Scene::solid(tetrahedron().into_iter().map(soft).collect());
    let outline = edges(&[[A, B], [A, C], [B, D], [C, D]]);
    assert_eq!(ends(&solid.lines(Rendering::HiddenLine)), outline);
}

#[test]
fn a_solid_must_be_one() {
    let mut open = tetrahedron();
    open.pop();
    let fault = Scene::solid(open).render(Rendering::HiddenLine, &plain()).unwrap_err();
    assert!(matches!(fault, RenderingFault::NotSolid { edges: 3, .. }), "{fault:?}");
    let mut turned = tetrahedron();
    turned[1].vertices.reverse();
    for kind in Rendering::ALL {
        let fault = Scene::solid(turned.clone()).render(kind, &plain()).unwrap_err();
        assert_eq!(
            fault.text("R"),
            "Rendering failed: not a valid solid: 3 of its edges are not shared by two polygons in opposite directions, \
             the first from 0.5,0.5,0.5 to -0.5,0.5,-0.5 at R"
        );
    }
    let twice = [tetrahedron(), tetrahedron()].concat();
    assert!(Scene::solid(twice).facets(STORAGE).is_ok_and(|facets| solid::check(&facets).is_err()));
}

/// A plate at z = 0 with a square hole, and a triangle behind it.
fn plate() -> Vec<Polygon> {
    let square = |s: f32| [[-s, -s, 0.0], [-s, s, 0.0], [s, s, 0.0], [s, -s, 0.0]];
    let mut inner = square(0.25);
    inner.reverse();
    vec![polygon(&square(0.8)), hole(&inner), polygon(&[[-0.9, 0.0, 0.5], [0.9, 0.0, 0.5], [0.9, -0.95, 0.5]])]
}

#[test]
fn a_line_is_seen_through_a_hole_and_beside_the_plate() {
    let lines = Scene::new(plate()).lines(Rendering::HiddenLine);
    let level = |s: &&Segment| s.ends.iter().all(|p| p.y == 0.0 && p.z == 0.5);
    let mut seen: Vec<[f64; 2]> = lines.iter().filter(level).map(|s| s.ends.map(|p| p.x)).collect();
    seen.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let expected = [[-0.9, -0.8], [-0.25, 0.25], [0.8, 0.9]];
    assert_eq!(seen.len(), 3, "{seen:?}");
    for (seen, expected) in seen.as_flattened().iter().zip(expected.as_flattened()) {
        assert!((seen - expected).abs() < 2e-7, "{seen} {expected}");
    }
    // The plate itself, hole and all, is whole.
    assert_eq!(lines.iter().filter(|s| s.ends.iter().all(|p| p.z == 0.0)).count(), 8);
}

#[test]
fn in_perspective_a_line_ends_where_it_is_seen_to_end() {
    // The plate at distance 1 hides what is within 0.3 of the axis there, so within 0.6 at distance 2.
    let s = 0.3;
    let plate = polygon(&[[-s, -s, 1.0], [-s, s, 1.0], [s, s, 1.0], [s, -s, 1.0]]);
    // This one goes away from the eye too: from (0, 0, 2) to (1, 0, 3), at (0.5, 0, 2.5) and so on.
    let slanted = polygon(&[[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [1.0, 0.9, 3.0]]);
    let lines = Scene::new(vec![plate, slanted]).above(perspective()).lines(Rendering::HiddenLine);
    let level: Vec<&Segment> = lines.iter().filter(|s| s.ends.iter().all(|p| p.y == 0.0 && p.z > 1.5)).collect();
    // x = 0.3 z where x = z - 2: z = 20 / 7.
    assert_eq!(level.len(), 1);
    let nearest = level[0].ends.map(|p| p.z).into_iter().fold(f64::INFINITY, f64::min);
    assert!((nearest - 20.0 / 7.0).abs() < 2e-6, "{nearest}");
}

/// Whether a triangle surely hides, or surely does not hide, a point of the screen; none if it is too close.
fn hides(triangle: &[DVec3; 3], p: DVec3) -> Option<bool> {
    const MARGIN: f64 = 1e-5;
    let [a, b, c] = triangle.map(|corner| corner.truncate());
    let area = (b - a).perp_dot(c - a);
    let q = p.truncate();
    let shares = [(b - q).perp_dot(c - q), (c - q).perp_dot(a - q), (a - q).perp_dot(b - q)].map(|s| s / area);
    if area.abs() < 1e-12 {
        return None;
    }
    if shares.iter().any(|s| *s < -MARGIN / area.abs().sqrt()) {
        return Some(false);
    }
    let depth: f64 = shares.iter().zip(triangle).map(|(s, corner)| s * corner.z).sum();
    let inside = shares.iter().all(|s| *s > MARGIN / area.abs().sqrt());
    let slope = MARGIN
        * (1.0
            + (triangle.iter().map(|t| t.z).fold(f64::NEG_INFINITY, f64::max)
                - triangle.iter().map(|t| t.z).fold(f64::INFINITY, f64::min))
                / area.abs().sqrt());
    if depth > p.z + slope {
        return Some(false);
    }
    (inside && depth < p.z - slope).then_some(true)
}

/// Compares each edge with a test of single points of it against every triangle. Returns points seen and hidden.
fn compare(polygons: &[Polygon], lines: &[Segment]) -> [usize; 2] {
    let triangles: Vec<[DVec3; 3]> =
        polygons.iter().map(|p| [0, 1, 2].map(|k| DVec3::from(p.vertices[k].position.map(f64::from)))).collect();
    let mut edges = std::collections::BTreeSet::new();
    let bits = |p: DVec3| p.to_array().map(f64::to_bits);
    for [a, b, c] in &triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (from, to) = (bits(*from), bits(*to));
            edges.insert([from.min(to), from.max(to)]);
        }
    }
    let mut counts = [0; 2];
    for edge in edges {
        let [a, b] = edge.map(|p| DVec3::from(p.map(f64::from_bits)));
        let direction = (b - a).normalize();
        let on_edge = |p: DVec3| (p - a).reject_from_normalized(direction).length() < 1e-9;
        let parts: Vec<[f64; 2]> = lines
            .iter()
            .filter(|s| s.ends.iter().all(|p| on_edge(*p)))
            .map(|s| {
                let [t, u] = s.ends.map(|p| (p - a).dot(direction) / (b - a).length());
                [t.min(u), t.max(u)]
            })
            .collect();
        for k in 0..5 {
            let t = 0.1 + 0.2 * f64::from(k);
            let p = a.lerp(b, t);
            let drawn = parts.iter().any(|[from, to]| *from <= t && t <= *to);
            let answers: Vec<Option<bool>> = triangles.iter().map(|triangle| hides(triangle, p)).collect();
            if answers.contains(&Some(true)) {
                assert!(!drawn, "shows through at {p}");
                counts[1] += 1;
            } else if answers.iter().all(|answer| *answer == Some(false)) {
                assert!(drawn, "missing at {p}");
                counts[0] += 1;
            }
        }
    }
    counts
}

#[test]
fn a_torus_of_two_thousand_triangles_hides_what_single_points_say() {
    let turn = DMat3::from_rotation_x(0.9) * DMat3::from_rotation_y(0.4);
    let polygons = torus(32, turn);
    assert_eq!(polygons.len(), 2048);
    // The points of an edge lie on its own triangles, so those are too close to say: they are left out by turns.
    for solid in [true, false] {
        let scene = Scene { solid, ..Scene::new(polygons.clone()) };
        let lines = scene.lines(Rendering::HiddenLine);
        let [_, hidden] = compare(&polygons, &lines);
        assert!(hidden > 4_000, "{hidden}");
    }
    let both =
        [true, false].map(|solid| ends(&Scene { solid, ..Scene::new(polygons.clone()) }.lines(Rendering::HiddenLine)));
    assert_eq!(both[0], both[1], "a closed surface hides as the solid does");
}

#[test]
fn triangles_that_pierce_each_other_cut_their_edges_at_the_line_of_intersection() {
    let level = polygon(&[[-0.5, -0.5, 0.0], [0.0, 0.7, 0.0], [0.5, -0.5, 0.0]]);
    let steep = polygon(&[[-0.8, 0.0, -0.4], [0.8, 0.0, 0.4], [0.8, 0.9, 0.4]]);
    let lines = Scene::new(vec![level, steep]).lines(Rendering::HiddenLine);
    let on_axis: Vec<[f64; 2]> =
        lines.iter().filter(|s| s.ends.iter().all(|p| p.y.abs() < 1e-9)).map(|s| s.ends.map(|p| p.x)).collect();
    // In front until x = 0, then behind the level triangle, whose right side is at y = 0 at 0.7 / 1.2 * 0.5.
    let right = 0.5 * 0.7 / 1.2;
    assert_eq!(on_axis.len(), 2, "{on_axis:?}");
    let mut all: Vec<f64> = on_axis.concat();
    all.sort_by(f64::total_cmp);
    for (got, expected) in all.into_iter().zip([-0.8, 0.0, right, 0.8]) {
        assert!((got - expected).abs() < 1e-6, "{got} {expected}");
    }
}

#[test]
fn coplanar_polygons_do_not_hide_each_other() {
    let turn = DMat3::from_rotation_x(0.7) * DMat3::from_rotation_y(1.1);
    let square = |x: f64, y: f64, s: f64| {
        let corners = [[x, y], [x, y + s], [x + s, y + s], [x + s, y]];
        polygon(&corners.map(|[x, y]| (turn * DVec3::new(x, y, 0.0)).as_vec3().to_array()))
    };
    // Overlapping, with a common corner, with a corner inside an edge, and far inside.
    let squares =
        vec![square(-0.4, -0.4, 0.5), square(-0.4, -0.4, 0.3), square(0.1, -0.2, 0.3), square(-0.3, 0.0, 0.2)];
    let lines = Scene::new(squares).lines(Rendering::HiddenLine);
    let length: f64 = lines.iter().map(|s| (s.ends[1] - s.ends[0]).length()).sum();
    assert!((length - 4.0 * (0.5 + 0.3 + 0.3 + 0.2)).abs() < 1e-5, "{length}");
}

#[test]
fn work_in_slices_gives_the_same_lines() {
    let polygons = torus(24, DMat3::from_rotation_x(0.9));
    let whole = Scene::new(polygons.clone()).lines(Rendering::HiddenLine);
    let facets = Scene::new(polygons).facets(STORAGE).unwrap();
    let mut task = Task::new(Rendering::HiddenLine, facets, &plain()).unwrap();
    let mut slices = 1;
    let sliced = loop {
        match task.advance(1_000) {
            Some(outcome) => break outcome,
            None => slices += 1,
        }
    };
    assert!(slices > 3, "{slices}");
    assert_eq!(sliced, RenderingResult::Lines(whole));
}

#[test]
fn edges_have_their_outline_or_the_colour_of_the_state() {
    let mut polygons = tetrahedron();
    polygons[3].outline = Some(120.0);
    let lines = Scene::solid(polygons).lines(Rendering::BackFace);
    assert_eq!(lines.iter().filter(|s| s.color == [120.0, 1.0]).count(), 2, "those that no polygon before had");
    let members = members(lines, [0.0, 0.0]);
    assert_eq!(members.len(), 3, "white ones first, SET COLOR, red ones");
}
