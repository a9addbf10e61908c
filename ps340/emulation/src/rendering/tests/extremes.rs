//! Data at and beyond the limits.

use super::*;

fn every_kind(scene: &Scene) {
    for kind in Rendering::ALL {
        match scene.render(kind, &ShadingEnvironment::default()) {
            Ok(RenderingResult::Lines(lines)) => {
                assert!(lines.iter().all(|s| s.ends.iter().all(|end| end.is_finite())), "{kind:?}");
            }
            Ok(RenderingResult::Image(image)) => assert_eq!(image.pixels.len(), (image.width * image.height) as usize),
            Err(fault) => assert!(!fault.text("R").is_empty()),
        }
    }
}

#[test]
fn degenerate_polygons_do_no_harm() {
    let p = [0.1, 0.2, 0.3];
    let q = [0.3, 0.1, 0.0];
    let polygons = vec![
        polygon(&[p, p, p]),
        polygon(&[p, q, p]),
        polygon(&[p, q, q, p]),
        hole(&[p, p, q]),
        polygon(&[[0.0, 0.0, 0.0], [0.1, 0.1, 0.1], [0.2, 0.2, 0.2], [0.3, 0.3, 0.3]]),
        polygon(&[[-0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [0.5, -0.5, 0.0], [-0.5, 0.5, 0.0]]),
    ];
    every_kind(&Scene::new(polygons.clone()));
    every_kind(&Scene::new(polygons).above(perspective()));
}

#[test]
fn numbers_that_are_not_finite_or_huge_leave_polygons_out() {
    let good = polygon(&[[-0.5, -0.5, 0.0], [0.0, 0.7, 0.0], [0.5, -0.5, 0.0]]);
    for bad in [f32::NAN, f32::INFINITY, f32::MAX, -f32::MAX, 1e30, f32::MIN_POSITIVE] {
        let mut odd = polygon(&[[-0.9, -0.9, 0.5], [0.0, 0.9, 0.5], [0.9, -0.9, 0.5]]);
        odd.vertices[1].position[1] = bad;
        odd.vertices[0].normal = Some([bad; 3]);
        let scene = Scene::new(vec![odd.clone(), Polygon { coplanar: true, ..odd }, good.clone()]);
        every_kind(&scene);
        if !bad.is_finite() {
            assert_eq!(scene.lines(Rendering::HiddenLine).len(), 3, "{bad}");
        }
    }
    let huge = Operation::Projective(DMat4::from_diagonal(glam::DVec4::new(1e300, 1e300, 1e300, 1e-300)));
    every_kind(&Scene::new(vec![good.clone()]).above(huge));
    let nothing = Operation::Projective(DMat4::from_diagonal(glam::DVec4::new(1.0, 1.0, 1.0, 0.0)));
    let scene = Scene::new(vec![good.clone()]).above(nothing);
    every_kind(&scene);
    assert_eq!(scene.lines(Rendering::HiddenLine), []);
    every_kind(&Scene::solid(tetrahedron()).above(Operation::Linear(DMat3::ZERO)));
}

#[test]
fn what_is_behind_the_eye_hides_nothing_and_is_not_seen() {
    let behind = polygon(&[[-5.0, -5.0, -1.0], [0.0, 7.0, -1.0], [5.0, -5.0, -1.0]]);
    let before = polygon(&[[-0.5, -0.5, 2.0], [0.0, 0.7, 2.0], [0.5, -0.5, 2.0]]);
    let scene = Scene::new(vec![behind, before]).above(perspective());
    assert_eq!(scene.lines(Rendering::HiddenLine).len(), 3);
    let image = scene.image(Rendering::Wash, &plain());
    let alone = Scene::new(vec![polygon(&[[-0.5, -0.5, 2.0], [0.0, 0.7, 2.0], [0.5, -0.5, 2.0]])]).above(perspective());
    assert_eq!(image, alone.image(Rendering::Wash, &plain()));
    every_kind(&scene);
}

#[test]
fn a_floor_that_runs_under_the_eye_fills_the_lower_half() {
    let floor = polygon(&[[-1e3, -1.0, -1e3], [-1e3, -1.0, 1e3], [1e3, -1.0, 1e3], [1e3, -1.0, -1e3]]);
    let wall = polygon(&[[-9.0, -1.0, 30.0], [-9.0, 5.0, 30.0], [9.0, 5.0, 30.0], [9.0, -1.0, 30.0]]);
    let under = polygon(&[[-1.0, -2.0, 4.0], [0.0, -2.0, 6.0], [1.0, -2.0, 4.0]]);
    let scene = Scene::new(vec![floor.clone(), wall, under]).above(perspective());
    let lines = scene.lines(Rendering::HiddenLine);
    assert!(lines.iter().flat_map(|s| s.ends).all(|p| p.y > -2.0), "nothing shows through the floor");
    assert_eq!(lines.iter().filter(|s| s.ends.iter().all(|p| p.z == 30.0)).count(), 4);
    let image = Scene::new(vec![floor]).above(perspective()).image(Rendering::Wash, &plain());
    // The horizon is a thousand away: half a pixel under the middle.
    for (line, pixels) in image.pixels.chunks(480).enumerate() {
        assert!(pixels.iter().all(|p| *p == if line < 239 { [255; 3] } else { [0; 3] }) || line == 239, "{line}");
    }
    every_kind(&scene);
}

#[test]
fn the_eye_inside_a_solid_sees_its_walls() {
    let scene = Scene::solid(tetrahedron())
        .above(perspective())
        .above(Operation::Linear(DMat3::from_diagonal(DVec3::splat(8.0))));
    let image = scene.image(Rendering::Wash, &plain());
    assert!(image.pixels.iter().all(|pixel| *pixel == [255; 3]));
    assert!(!scene.lines(Rendering::HiddenLine).is_empty());
    every_kind(&scene);
}

#[test]
fn empty_viewports_give_empty_images() {
    for viewport in [[0, 0, 0, 0], [640, 480, 0, 0], [5, 5, 0, 100], [5, 5, 100, 0], [7, 7, 1, 1]] {
        let environment = ShadingEnvironment { viewport, ..ShadingEnvironment::default() };
        let image = Scene::solid(tetrahedron()).image(Rendering::Phong, &environment);
        assert_eq!(image.pixels.len(), (viewport[2] * viewport[3]) as usize);
    }
    let flat = Operation::Viewport { horizontal: [0.5, 0.5], vertical: [-1.0, 1.0], intensity: None };
    every_kind(&Scene::solid(tetrahedron()).above(flat));
}

#[test]
fn coplanar_polygons_show_the_first() {
    let turn = DMat3::from_rotation_x(0.7) * DMat3::from_rotation_y(0.6);
    let place = |p: [f64; 2]| (turn * DVec3::new(p[0], p[1], 0.0)).as_vec3().to_array();
    let mut first = polygon(&[[-0.6, -0.6], [-0.5, 0.6], [0.7, -0.1]].map(place));
    let second = polygon(&[[-0.9, -0.9], [-0.9, 0.9], [0.9, 0.9], [0.9, -0.9]].map(place));
    // Distinguished by the light of normals that are given.
    for vertex in &mut first.vertices {
        vertex.normal = Some(turn.z_axis.as_vec3().to_array().map(|c| -c + 0.3));
    }
    let alone = Scene::new(vec![first.clone()]).image(Rendering::Phong, &plain());
    let both = Scene::new(vec![first, second]).image(Rendering::Phong, &plain());
    let covered = alone.pixels.iter().zip(&both.pixels).filter(|(alone, _)| **alone != [0; 3]);
    assert!(covered.clone().count() > 10_000);
    assert_eq!(covered.filter(|(alone, both)| alone != both).count(), 0, "no speckles");
}

#[test]
fn storage_is_needed_for_every_vertex() {
    let scene = Scene::solid(tetrahedron());
    assert!(scene.facets(600).is_ok());
    let fault = scene.facets(599).unwrap_err();
    assert_eq!(fault, RenderingFault::Storage { needed: 600 });
    assert_eq!(
        (fault.number(), fault.text("A.R").as_str()),
        (8, "Insufficient memory: A.R needs RESERVE_WORKING_STORAGE 600")
    );
    let empty = Scene::new(Vec::new());
    assert_eq!(empty.facets(STORAGE).unwrap_err(), RenderingFault::NoPolygons);
}
