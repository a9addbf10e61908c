//! What the turtle draws, the figures of the book, and triangles.

use super::error::DerivationError;
use super::figures::ABOP_FIGURES;
use super::lsystem::LSystem;
use super::specimen::Specimen;
use super::turtle::EmptyEnvironment;
use crate::mesh::Mesh;
use crate::procedural::drawing::DrawingError;
use crate::procedural::drawing::PlantDrawing;
use glam::DVec3;
use std::collections::HashSet;
use std::f64::consts::PI;

fn try_draw(text: &str, steps: Option<u32>) -> Result<PlantDrawing, DerivationError> {
    let specimen = Specimen::new(&LSystem::parse(text).expect("a grammar"), 1, &[])?;
    specimen.draw(&specimen.derive(steps, &EmptyEnvironment)?)
}

fn draw(axiom: &str) -> PlantDrawing {
    try_draw(&format!("width: 0.2\naxiom: {axiom}"), None).expect("a drawing")
}

fn figure(name: &str, steps: u32) -> PlantDrawing {
    let figure = ABOP_FIGURES.iter().find(|figure| figure.name == name).expect("a figure");
    try_draw(figure.grammar, Some(steps)).expect("a drawing")
}

/// Where the last line of a word ends.
fn end(axiom: &str) -> DVec3 {
    draw(axiom).nodes.last().expect("a line").position
}

fn near(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-12
}

#[test]
fn the_turtle_turns_pitches_and_rolls_as_the_book_says() {
    let rows = [
        ("F", DVec3::Y),
        ("+F", DVec3::NEG_X),
        ("-F", DVec3::X),
        ("&F", DVec3::NEG_Z),
        ("^F", DVec3::Z),
        ("|F", DVec3::NEG_Y),
        // Rolled to the left, the left side is below: it was at -x and up at z, and is now at -z.
        ("\\+F", DVec3::NEG_Z),
        ("/+F", DVec3::Z),
        ("+(30)F(2)", DVec3::new(-1.0, 3.0_f64.sqrt(), 0.0)),
        ("[+F]f(2)F(3)", DVec3::new(0.0, 5.0, 0.0)),
        // Rolled by some angle and level again, the turtle turns in the level plane.
        ("&/(33)$+F", DVec3::NEG_X),
    ];
    for (axiom, expected) in rows {
        assert!(near(end(axiom), expected), "{axiom}: {}", end(axiom));
    }
}

#[test]
fn a_branch_bends_to_the_tropism_by_the_angle_of_the_book() {
    // H is x, T is down: after one piece it has turned by e |H x T| radians.
    let text = "tropism: 0, -2, 0\nelasticity: 0.1\naxiom: -(90)F(0)F(1)";
    let drawing = try_draw(text, None).expect("a drawing");
    let angle = 0.1 * 2.0_f64;
    assert!(near(drawing.nodes[2].position, DVec3::new(angle.cos(), -angle.sin(), 0.0)));
    // In the end it hangs, from wherever it began.
    let hanging = try_draw(&format!("tropism: 0, -1, 0\nelasticity: 0.2\naxiom: -(70){}", "F".repeat(200)), None);
    let nodes = hanging.expect("a drawing").nodes;
    assert!(near(nodes[200].position - nodes[199].position, DVec3::NEG_Y));
}

#[test]
fn lines_of_a_branch_are_one_stroke_that_narrows_and_takes_colours() {
    let drawing = draw("!(2)F'!(1)F[+F F]F f F");
    let strokes: Vec<usize> = drawing.strokes().map(<[_]>::len).collect();
    assert_eq!(strokes, [4, 3, 2]);
    let trunk = drawing.strokes().next().expect("a stroke");
    assert_eq!(trunk.iter().map(|node| node.radius).collect::<Vec<_>>(), [1.0, 1.0, 0.5, 0.5]);
    assert_eq!(trunk.iter().map(|node| node.colour).collect::<Vec<_>>(), [0, 0, 1, 1]);
    assert_eq!(trunk[3].position, DVec3::new(0.0, 3.0, 0.0));
}

#[test]
fn polygons_take_corners_from_lines_moves_and_points() {
    let drawing = draw("{.f(1)-(90)F(1)-(90)G(0.5)g(0.5).}");
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    assert!(drawing.corners.iter().zip(corners).all(|(a, b)| near(*a, b)) && drawing.corners.len() == 4);
    assert_eq!((drawing.polygons.len(), drawing.nodes.len()), (1, 2));
    assert!((area(&drawing.mesh(1.0).expect("a mesh"), 2) - 1.0).abs() < 1e-12);
    // What has no three corners, or is never closed, is nothing.
    assert!(draw("{.f}{f f f}}").polygons.len() == 1 && draw("{...").polygons.is_empty());
}

/// The area of the last triangles of a mesh.
fn area(mesh: &Mesh, triangles: usize) -> f64 {
    let all = mesh.triangles.len();
    let of = |triangle: usize| {
        let [a, b, c] = mesh.corners(triangle);
        0.5 * (b - a).cross(c - a).length()
    };
    (all - triangles..all).map(of).sum()
}

fn volume(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len()).map(|triangle| mesh.corners(triangle)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

#[test]
fn tubes_are_closed_and_as_large_as_cylinders_with_a_dome() {
    for (axiom, length) in [("!(2)F(10)", 10.0), ("!(2)F(5)+(60)F(5)", 10.0), ("!(2)F(5)+(90)F(5)&(100)F(5)", 15.0)] {
        let mesh = draw(axiom).stroke_mesh(1e-4).expect("a mesh");
        let report = mesh.edge_report();
        assert!(report.is_closed() && mesh.validate().is_ok(), "{axiom}: {report:?}");
        // Mitres take as much away on one side of the axis as they add on the other.
        let expected = PI * length + 2.0 / 3.0 * PI;
        assert!((volume(&mesh) / expected - 1.0).abs() < 1e-3, "{axiom}: {} {expected}", volume(&mesh));
        for (triangle, normals) in mesh.corner_normals.iter().enumerate() {
            let [a, b, c] = mesh.corners(triangle);
            let across = (b - a).cross(c - a).normalize();
            assert!(normals.iter().all(|normal| normal.dot(across) > 0.4 && (normal.length() - 1.0).abs() < 1e-9));
        }
    }
    // A cone frustum of radii 1 and 1/2.
    let cone = draw("!(2)F(0.0000001)!(1)F(6)").stroke_mesh(1e-4).expect("a mesh");
    let expected = 6.0 * PI / 3.0 * 1.75 + PI / 12.0;
    assert!((volume(&cone) / expected - 1.0).abs() < 1e-3 && cone.edge_report().is_closed());
    // A turn back is two tubes.
    let back = draw("!(2)F(3)|F(1)").stroke_mesh(1e-3).expect("a mesh");
    assert!(back.edge_report().is_closed() && volume(&back) > 4.0 * PI);
    assert!(draw("!(0)F").stroke_mesh(1.0).is_ok_and(|mesh| mesh.triangles.is_empty()));
    assert_eq!(draw("F").mesh(0.0), Err(DrawingError::Detail(0.0)));
}

#[test]
fn triangles_stay_within_the_detail() {
    let drawing = draw("!(2)F(4)f(4)@O(3)");
    for detail in [0.3, 0.01, 0.001] {
        let mesh = drawing.mesh(detail).expect("a mesh");
        let mut largest: f64 = 0.0;
        for [a, b, c] in (0..mesh.triangles.len()).map(|triangle| mesh.corners(triangle)) {
            for middle in [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)].into_iter().filter(|middle| middle.y > 1e-9) {
                let distance = match middle.y {
                    y if y > 6.0 => 1.5 - middle.distance(DVec3::Y * 8.0),
                    y if y < 4.0 => 1.0 - f64::hypot(middle.x, middle.z),
                    _ => 1.0 - middle.distance(DVec3::Y * 4.0),
                };
                largest = largest.max(distance.abs());
            }
        }
        assert!(largest <= detail * (1.0 + 1e-9) && largest > 0.2 * detail, "{detail}: {largest}");
    }
}

#[test]
fn predefined_surfaces_are_placed_along_the_turtle() {
    let text = "surface leaf:\n polygon (-1,0,0) (1,0,0) (0,1,0)\n\
        \x20patch (0,0,0) (1,0,0) (2,0,0) (3,0,0) (0,1,0) (1,1,1) (2,1,1) (3,1,0)\n\
        \x20(0,2,0) (1,2,1) (2,2,1) (3,2,0) (0,3,0) (1,3,0) (2,3,0) (3,3,0)\naxiom: F(2)-(90)'(7)~leaf(3)";
    let drawing = try_draw(text, None).expect("a drawing");
    let [placed] = drawing.placed[..] else { panic!("{:?}", drawing.placed) };
    assert!(near(placed.placement.transform_point3(DVec3::Y), DVec3::new(3.0, 2.0, 0.0)));
    assert!(near(placed.placement.transform_point3(DVec3::X), DVec3::new(0.0, -1.0, 0.0)));
    let mesh = drawing.mesh(0.01).expect("a mesh");
    let own = mesh.surfaces.iter().filter(|surface| **surface == 7).count();
    assert!(own > 10 && mesh.validate().is_ok());
    let polygon = mesh.surfaces.iter().position(|surface| *surface == 7).expect("a polygon");
    let [a, b, c] = mesh.corners(polygon);
    assert!(((b - a).cross(c - a).length() - 18.0).abs() < 1e-9);
}

#[test]
fn every_figure_of_the_book_is_drawn_and_has_its_name_once() {
    let names: HashSet<&str> = ABOP_FIGURES.iter().map(|figure| figure.name).collect();
    assert!(names.len() == ABOP_FIGURES.len() && names.len() >= 30);
    for figure in ABOP_FIGURES {
        let drawing = try_draw(figure.grammar, None).unwrap_or_else(|error| panic!("{}: {error}", figure.name));
        let bounds = drawing.bounds();
        assert!(bounds.min.is_finite() && bounds.max.is_finite(), "{} draws nothing", figure.name);
        let mesh = drawing.mesh(0.01 * bounds.diagonal()).expect("a mesh");
        assert!(!mesh.triangles.is_empty() && mesh.validate().is_ok(), "{}", figure.name);
    }
}

#[test]
fn koch_curves_close_and_have_their_dimension() {
    // Edges of one edge, and how much shorter they are.
    let rows = [
        ("koch_island", 8, 4.0),
        ("koch_island_wide", 18, 6.0),
        ("koch_variant_a", 8, 4.0),
        ("koch_variant_b", 7, 3.0),
        ("koch_variant_d", 5, 3.0),
        ("koch_variant_e", 5, f64::sqrt(5.0)),
        ("koch_variant_f", 5, f64::sqrt(5.0)),
    ];
    for (name, edges, ratio) in rows {
        let is_variant_a = name == "koch_variant_a";
        for steps in 0..3 {
            let drawing = figure(name, steps);
            assert_eq!(drawing.nodes.len(), 4 * edges_after(edges, steps) + 1, "{name}");
            let [first, last] = [drawing.nodes[0], drawing.nodes[drawing.nodes.len() - 1]].map(|node| node.position);
            assert!(near(first, last), "{name} {steps}: {last}");
            let side = drawing.nodes[edges_after(edges, steps)].position.length();
            let expected = f64::powi(ratio, steps as i32);
            assert!(is_variant_a || (side / expected - 1.0).abs() < 1e-12, "{name} {steps}: {side} {expected}");
        }
    }
    let snowflake = figure("snowflake_quadratic", 4);
    assert!(near(snowflake.nodes[625].position, DVec3::new(81.0, 0.0, 0.0)));
}

fn edges_after(edges: usize, steps: u32) -> usize {
    edges.pow(steps)
}

#[test]
fn curves_that_fill_space_visit_each_cell_once() {
    let rows =
        [("hilbert", 5, 32, 2), ("peano", 3, 27, 2), ("hilbert_in_space", 3, 8, 3), ("gosper_quadratic", 2, 25, 2)];
    for (name, steps, side, dimensions) in rows {
        let drawing = figure(name, steps);
        let cells: HashSet<[i64; 3]> =
            drawing.nodes.iter().map(|node| node.position.to_array().map(|x| x.round() as i64)).collect();
        // The quadratic Gosper curve runs along edges: it has one more corner than cells.
        let more = usize::from(name == "gosper_quadratic");
        assert_eq!((cells.len(), drawing.nodes.len()), (usize::pow(side, dimensions) + more, cells.len()), "{name}");
        let size = drawing.nodes.iter().fold(DVec3::ZERO, |size, node| size.max(node.position.abs()));
        assert_eq!(size.max_element().round() as usize, side - 1 + more, "{name}");
    }
    // No edge of the dragon curve is passed twice, and no corner of the hexagonal Gosper curve.
    let dragon = figure("dragon", 12);
    let edges: HashSet<[i64; 2]> = dragon
        .nodes
        .windows(2)
        .map(|edge| (edge[0].position + edge[1].position).to_array())
        .map(|[x, y, _]| [x.round() as i64, y.round() as i64])
        .collect();
    assert_eq!(edges.len(), 4096);
    let gosper = figure("gosper_hexagonal", 4);
    let corners: HashSet<[i64; 2]> =
        gosper.nodes.iter().map(|node| [node.position.x, node.position.y].map(|x| (4.0 * x).round() as i64)).collect();
    assert_eq!((corners.len(), gosper.nodes.len()), (2402, 2402));
    let size = gosper.nodes[2401].position.length();
    assert!((size - 49.0).abs() < 1e-9, "four times the root of 7: {size}");
}

#[test]
fn numbers_of_parts_follow_their_recurrences() {
    let count = |name: &str, steps: u32, module: &str| {
        let figure = ABOP_FIGURES.iter().find(|figure| figure.name == name).expect("a figure");
        let specimen = Specimen::new(&LSystem::parse(figure.grammar).expect("a grammar"), 1, &[]).expect("a specimen");
        specimen.derive(Some(steps), &EmptyEnvironment).expect("a string").count(module)
    };
    // Edges: 5 and 8 of one; nodes: twice and three times as many, with twice as long edges.
    assert_eq!([0, 1, 2, 5].map(|n| count("branching_a", n, "F")), [1, 5, 25, 3125]);
    assert_eq!([0, 1, 2, 4].map(|n| count("branching_c", n, "F")), [1, 8, 64, 4096]);
    assert_eq!([0, 1, 2, 5].map(|n| count("branching_f", n, "X")), [1, 4, 16, 1024]);
    assert_eq!([0, 1, 2, 10].map(|n| count("ternary", n.min(6), "A")), [1, 3, 9, 729]);
    // Monopodial trees: A gives A and B, B gives B and C or C and B: 2^n apices.
    let apices = |n| count("monopodial", n, "A") + count("monopodial", n, "B") + count("monopodial", n, "C");
    assert_eq!([0, 1, 5, 10].map(apices), [1, 2, 32, 1024]);
    // Apices of a compound leaf with a delay of d steps: a(n) = a(n - 1) + 2 a(n - 1 - d).
    assert_eq!([0, 1, 2, 3, 4, 5].map(|n| count("compound_leaf_b", n, "A")), [1, 3, 5, 11, 21, 43]);
    assert_eq!([0, 1, 2, 3, 4].map(|n| count("compound_leaf_a", n, "A")), [1, 3, 9, 27, 81]);
    // Cells of a filament are counted by the numbers of Fibonacci.
    let cells = |n| ["L", "R", "l", "r"].map(|cell| count("anabaena_lineage", n, cell)).iter().sum::<usize>();
    assert_eq!([0, 1, 2, 3, 4, 5, 20].map(cells), [1, 2, 3, 5, 8, 13, 17_711]);
}

#[test]
fn the_golden_angle_sets_florets_apart_as_the_formula_of_vogel() {
    let disc = figure("vogel_disc", 300);
    assert_eq!(disc.placed.len(), 300);
    let mut nearest: f64 = f64::INFINITY;
    for (n, place) in disc.placed.iter().enumerate() {
        let middle = place.placement.translation;
        assert!((middle.length() - (n as f64).sqrt()).abs() < 1e-9);
        for other in &disc.placed[..n] {
            nearest = nearest.min(middle.distance(other.placement.translation));
        }
    }
    // Florets of equal size fit at this angle.
    assert!(nearest > 0.99, "{nearest}");
}

#[test]
fn the_row_of_trees_keeps_its_base() {
    // Pythagoras: the two lower edges and the two upper ones span the edge that they replace, at 90 degrees.
    let row = try_draw(
        &ABOP_FIGURES
            .iter()
            .find(|figure| figure.name == "row_of_trees")
            .expect("a figure")
            .grammar
            .replace("angle: 86", "angle: 90"),
        Some(7),
    );
    let row = row.expect("a drawing");
    assert!(near(row.nodes.last().expect("a line").position, DVec3::X));
}
