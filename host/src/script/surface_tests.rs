//! Facts about curves, surfaces and subdivided polyhedra of scripts.

use super::tests::{problem, run};
use crate::mesh::Mesh;
use crate::scene::{Shape, SurfaceSheet};
use crate::surface::{Surface, Tolerance};
use glam::DVec2;

const NET: &str = "
    let net = [];
    for i in 0..5 {
        let row = [];
        for j in 0..4 { row.push([i, (i * 7 + j * 5) % 3 * 0.4, j]); }
        net.push(row);
    }
";

fn mesh(script: &str) -> Mesh {
    let made = run(script);
    let shape = &made.scene.objects.last().expect("an object").shape;
    shape.tessellate(Tolerance::new(0.003, 30.0)).unwrap_or_else(|error| panic!("{error}")).mesh
}

#[test]
fn a_bbb_spline_without_bias_and_tension_is_the_b_spline_and_with_zeros_the_bezier() {
    let both = |one: &str, two: &str| {
        let made = run(&format!("{NET} surface(net, {one}, {one}); surface(net, {two}, {two});"));
        let surfaces = made.scene.objects.iter().map(|object| match &object.shape {
            Shape::Sculpture(sculpture) => match &sculpture.sheets[0] {
                SurfaceSheet::Spline { surface, .. } => (**surface).clone(),
                filled => panic!("{filled:?}"),
            },
            other => panic!("{other:?}"),
        });
        let surfaces: Vec<_> = surfaces.collect();
        let at = |k: usize, u: f64, v: f64| {
            let [low, high] = surfaces[k].domain();
            surfaces[k].point(low + (high - low) * DVec2::new(u, v))
        };
        let gap = |k: usize| at(0, k as f64 / 9.0, 0.3).distance(at(1, k as f64 / 9.0, 0.3));
        (0..10).map(gap).fold(0.0, f64::max)
    };
    assert!(both("b_spline(#{ clamped: false })", "bbb_spline(#{ clamped: false })") < 1e-14);
    assert!(both("beta_spline(2, 3)", "bbb_spline(#{ bias: 2, tension: 3 })") < 1e-14);
    assert!(both("b_spline()", "bbb_spline(#{ tension: 9 })") > 0.01);
    // Four points, of which the intervals leave one span.
    let four = "let net = [[[0, 0], [0, 1], [1, 1], [1, 0]]]; let c = net[0];";
    let made = run(&format!(
        "{four} print(curve_at(curve(c, bezier()), 0.3).point == curve_at(curve(c, bbb_spline()), 0.3).point);"
    ));
    assert_eq!(made.printed, ["true"]);
}

#[test]
fn joining_says_what_holds_along_the_joint() {
    let made = run(&format!(
        "{NET}
        let a = surface(net);
        let b = surface(net).translate(4.2, 0.1, 0);
        let report = a.join(b, #{{ smoothness: \"G2\" }});
        print(report.gap == 0.0 && report.angle < 1e-9 && report.curvature_difference < 1e-9);
        let between = 0;
        for joint in a.continuity(b) {{
            if joint.surfaces == [0, 1] && joint.gap == 0.0 && joint.angle < 1e-9 {{ between += 1; }}
        }}
        print(between);
        print(a.control_points()[4] == b.control_points()[0]);"
    ));
    assert_eq!(made.printed, ["true", "1", "true"]);
}

#[test]
fn surfaces_that_close_are_solids_that_can_be_combined() {
    let ball = "
        let half = curve([[0, -1], [1, -1], [1, 0], [1, 1], [0, 1]],
            b_spline(#{ degree: 2, knots: [0, 0, 0, 1, 1, 2, 2, 2] }), [1, 0.5.sqrt(), 1, 0.5.sqrt(), 1]);
        let ball = sculptured([revolved(half)]);
    ";
    let whole = mesh(ball).signed_volume();
    assert!((whole - 4.0 / 3.0 * std::f64::consts::PI).abs() < 0.03, "{whole}");
    let cap = mesh(&format!("{ball} ball - half_space(\"y\");")).signed_volume();
    assert!((cap - whole / 2.0).abs() < 1e-2, "{cap}");
    // What is cut out fits into the hole.
    let window = "let rim = curve([[0.2, 0.3], [0.4, 0.3], [0.4, 0.6], [0.2, 0.6]], b_spline(#{ closed: true }));";
    let lidded = format!(
        "{ball} {window} let rest = revolved(half).trim(rim, true); let lid = revolved(half).trim(rim);
        sculptured([rest, lid]);"
    );
    assert!((mesh(&lidded).signed_volume() - whole).abs() < 0.02);
}

#[test]
fn creases_of_a_subdivided_polyhedron_stay() {
    let volume = |rest: &str| mesh(&format!("cube(2).subdivide(){rest};")).signed_volume();
    let (smooth, worn, sharp) = (volume(""), volume(".sharpen_creases(30, 0.5)"), volume(".sharpen_creases()"));
    assert!(smooth < worn && worn < sharp && (sharp - 8.0).abs() < 1e-9, "{smooth} {worn} {sharp}");
}

#[test]
fn functions_loops_and_closures_of_scripts_call_ours() {
    let made = run("
        fn post(x, height) { cylinder(0.1, height).translate(x, height / 2, 0) }
        let posts = [0, 1, 2].map(|x| post(x, 1.0 + x));
        let rail = posts.reduce(|whole, one| if type_of(whole) == \"()\" { one } else { whole + one });
        let k = 0;
        while k < 3 { sphere(0.2).translate(k, 2.0 + k, 0); k += 1; }
        let along = curve([[0, 1, 0], [1, 2, 0], [2, 3, 0]]);
        for part in [0.0, 0.5, 1.0] {
            let at = curve_at(along, part).point;
            cube(0.1).translate(at);
        }
    ");
    assert_eq!(made.scene.objects.len(), 7);
    assert_eq!(made.scene.objects.iter().filter(|o| matches!(o.shape, Shape::Composite(_))).count(), 1);
}

#[test]
fn surfaces_that_do_not_fit_are_refused_with_their_place() {
    let refused = |script: &str| problem(&format!("{NET}\n{script}"));
    let (line, column, message) = refused("  surface([[[0, 0, 0], [1, 0, 0]], [[0, 0, 1]]], bezier(), bezier());");
    assert_eq!((line, column), (9, 3));
    assert!(message.contains("row 1 has 1 control points, row 0 has 2"), "{message}");
    assert!(
        refused("surface(net, bbb_spline(#{ tension: [1, 2] }));").2.contains("2 tensions were given, 5 are needed")
    );
    assert!(refused("surface(net, 3);").2.contains("u must be what bezier()"));
    assert!(refused("sculptured([surface(net)]);").2.contains("edges are not closed"));
    assert!(refused("sphere(1).trim([[0, 0], [1, 0], [0, 1]]);").2.contains("sphere is no surface"));
    assert!(refused("surface(net).trim([[0, 0], [2, 0], [0, 1]]);").2.contains("leaves the domain"));
    assert!(refused("surface(net).trim([[0, 0], [1, 0]]);").2.contains("loops must be a list of loops"));
    assert!(refused("let s = surface(net); s.join(s);").2.contains("joined to itself"));
    assert!(refused("fill([[surface(net), \"left\"]]);").2.contains("sides must be a list of pairs"));
    assert!(refused("sphere(1).sharpen_creases();").2.contains("sphere is no subdivided polyhedron"));
    assert!(refused("cube(1).subdivide().sharpen_edges([[0, 99]]);").2.contains("no edge from vertex 0 to vertex 99"));
}
