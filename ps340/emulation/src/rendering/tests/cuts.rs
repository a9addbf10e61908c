//! Cross-sections and sectioned renderings.

use super::*;

/// A SECTIONING_PLANE with a descendant is not at hand here; its polygons come in a group of their own.
fn cut(polygons: Vec<Polygon>, plane: Polygon) -> Scene {
    let below = vec![Node::operate(Operation::SectioningPlane, None), block(vec![plane])];
    let below = below.into_iter().map(Member::Unnamed).collect();
    Scene::solid(polygons).below(Node::Group(below))
}

/// A square across the z axis whose front is that of the eye, or the other one.
fn level(z: f32, front: bool) -> Polygon {
    let mut corners = [[-1.0, -1.0, z], [-1.0, 1.0, z], [1.0, 1.0, z], [1.0, -1.0, z]];
    if !front {
        corners.reverse();
    }
    polygon(&corners)
}

fn cube() -> Vec<Polygon> {
    let at = |corner: usize| [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 0.5 } else { -0.5 });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [2, 6, 7, 3], [0, 1, 5, 4]];
    faces.iter().map(|face| polygon(&face.map(at))).collect()
}

const AB: [f32; 3] = [0.5, 0.0, 0.0];
const AC: [f32; 3] = [0.0, 0.5, 0.0];
const BD: [f32; 3] = [0.0, -0.5, 0.0];
const CD: [f32; 3] = [-0.5, 0.0, 0.0];

#[test]
fn the_middle_of_a_tetrahedron_is_a_square() {
    let square = [[AB, AC], [AC, CD], [CD, BD], [BD, AB]];
    for front in [true, false] {
        let scene = cut(tetrahedron(), level(0.0, front));
        assert_eq!(ends(&scene.lines(Rendering::CrossSection)), edges(&square));
        let rest = if front {
            [[A, D], [A, AB], [A, AC], [D, BD], [D, CD]]
        } else {
            [[B, C], [B, AB], [C, AC], [B, BD], [C, CD]]
        };
        let all: Vec<_> = rest.into_iter().chain(square).collect();
        assert_eq!(ends(&scene.lines(Rendering::Sectioned)), edges(&all), "the front is gone");
    }
}

#[test]
fn a_cut_needs_a_plane() {
    for kind in [Rendering::CrossSection, Rendering::Sectioned] {
        let fault = Scene::solid(tetrahedron()).render(kind, &plain()).unwrap_err();
        assert_eq!(fault, RenderingFault::NoPlane);
    }
}

#[test]
fn the_plane_is_no_part_of_the_object() {
    let scene = cut(tetrahedron(), level(-0.9, true));
    assert_eq!(scene.lines(Rendering::HiddenLine).len(), 5);
    assert_eq!(scene.lines(Rendering::BackFace).len(), 5);
}

#[test]
fn a_plane_along_a_face_takes_the_face_once_or_not_at_all() {
    let length = |scene: Scene| -> f64 {
        scene.lines(Rendering::CrossSection).iter().map(|s| (s.ends[1] - s.ends[0]).length()).sum()
    };
    // Behind the plane z = -0.5 is the cube, behind z = 0.5 nothing; with the other front it is the other way round.
    assert_eq!(length(cut(cube(), level(-0.5, true))), 4.0);
    assert_eq!(length(cut(cube(), level(0.5, true))), 0.0);
    assert_eq!(length(cut(cube(), level(0.5, false))), 4.0);
    assert_eq!(length(cut(cube(), level(-0.5, false))), 0.0);
    assert_eq!(length(cut(cube(), level(0.25, true))), 4.0);
    assert_eq!(cut(cube(), level(0.5, true)).lines(Rendering::Sectioned), []);
    assert_eq!(cut(cube(), level(-0.75, true)).lines(Rendering::Sectioned).len(), 12);
}

#[test]
fn a_plane_through_corners_and_edges_gives_a_closed_cut() {
    // Through two opposite edges of the cube: a rectangle of 1 by the square root of 2.
    let diagonal = polygon(&[[-0.5, -0.5, -0.5], [-0.5, -0.5, 0.5], [0.5, 0.5, 0.5], [0.5, 0.5, -0.5]]);
    let lines = cut(cube(), diagonal).lines(Rendering::CrossSection);
    let length: f64 = lines.iter().map(|s| (s.ends[1] - s.ends[0]).length()).sum();
    assert!((length - 2.0 - 2.0 * 2_f64.sqrt()).abs() < 1e-9, "{length}");
    // Through three corners: a triangle.
    let corner = polygon(&[[-0.5, -0.5, 0.5], [-0.5, 0.5, -0.5], [0.5, -0.5, -0.5]]);
    let lines = cut(cube(), corner).lines(Rendering::CrossSection);
    let length: f64 = lines.iter().map(|s| (s.ends[1] - s.ends[0]).length()).sum();
    assert!((length - 3.0 * 2_f64.sqrt()).abs() < 1e-9, "{length}");
    for end in lines.iter().flat_map(|s| s.ends) {
        let meets = lines.iter().flat_map(|s| s.ends).filter(|other| *other == end).count();
        assert_eq!(meets % 2, 0, "{end}");
    }
}

#[test]
fn a_torus_cut_across_its_hole_is_two_closed_outlines() {
    let upright = polygon(&[[0.0, -1.0, -1.0], [0.0, -1.0, 1.0], [0.0, 1.0, 1.0], [0.0, 1.0, -1.0]]);
    let lines = cut(torus(40, DMat3::IDENTITY), upright).lines(Rendering::CrossSection);
    let length: f64 = lines.iter().map(|s| (s.ends[1] - s.ends[0]).length()).sum();
    let circles = 2.0 * std::f64::consts::TAU * 0.3;
    assert!((length / circles - 1.0).abs() < 0.01, "{length} {circles}");
    for end in lines.iter().flat_map(|s| s.ends) {
        let meets = lines.iter().flat_map(|s| s.ends).filter(|other| (*other - end).length() < 1e-12).count();
        assert_eq!(meets, 2, "{end}");
    }
}

#[test]
fn a_plate_with_a_hole_is_cut_into_two_parts() {
    let square = |s: f32| [[-s, -s, 0.0], [-s, s, 0.0], [s, s, 0.0], [s, -s, 0.0]];
    let upright = polygon(&[[-1.0, 0.1, -1.0], [-1.0, 0.1, 1.0], [1.0, 0.1, 1.0]]);
    let scene = Scene { solid: false, ..cut(vec![polygon(&square(0.5)), hole(&square(0.25))], upright) };
    let cut = ends(&scene.lines(Rendering::CrossSection));
    assert_eq!(cut, edges(&[[[-0.5, 0.1, 0.0], [-0.25, 0.1, 0.0]], [[0.25, 0.1, 0.0], [0.5, 0.1, 0.0]]]));
}
