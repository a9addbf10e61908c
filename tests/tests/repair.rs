//! `peris check --repair` from file to file: solids come out as they are, what is none is put right or refused by name.

use glam::{DQuat, DVec3};
use host::mesh::{Format, Mesh, parse, print};
use host::surface::{Tolerance, box_faces, tessellate};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde_json::Value;
use std::path::Path;
use tests::{TIMEOUT, run, simple};

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");

/// How often a kind of solid comes, each time in another place.
const PLACES: u32 = 5;

fn block(low: [f64; 3], high: [f64; 3]) -> Mesh {
    let faces = tessellate(&box_faces(low.into(), high.into()), Tolerance::new(1.0, 90.0)).expect("six flat faces");
    Mesh { vertices: faces.vertices, triangles: faces.triangles, ..Mesh::default() }.welded()
}

fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    meshes.iter().for_each(|mesh| all.append(mesh, 0));
    all
}

/// A mesh with a triangle more, and that one's back.
fn with_opposite(mesh: &Mesh, triangle: [u32; 3]) -> Mesh {
    let [a, b, c] = triangle;
    let mut triangles = mesh.triangles.clone();
    triangles.extend([[a, b, c], [a, c, b]]);
    Mesh { triangles, ..mesh.clone() }
}

/// Solids that are awkward: what they are, and the mesh.
fn awkward() -> Vec<(&'static str, Mesh)> {
    let unit = block([0.0; 3], [1.0; 3]);
    // Its mirror image has the same triangles on the wall between, the other way round.
    let mirrored = unit.vertices.iter().map(|v| DVec3::new(2.0 - v.x, v.y, v.z)).collect();
    let mirrored = Mesh { vertices: mirrored, ..unit.clone() }.reversed();
    let halves = joined(&[unit.clone(), mirrored]);
    let by_edge = joined(&[unit.clone(), block([1.0, 1.0, 0.0], [2.0, 2.0, 1.0])]);
    let by_corner = joined(&[unit.clone(), block([1.0; 3], [2.0; 3])]);
    let hollow = joined(&[block([-1.0; 3], [2.0; 3]), unit.clone().reversed()]);
    let blade = block([6.0, 0.0, 0.0], [7.0, 1.0, 1e-9]);
    vec![
        ("a wall between two halves, back to back", halves.welded()),
        ("the same with vertices of its own for each half", halves),
        ("an edge of four triangles", by_edge.welded()),
        ("shells that touch in a corner", by_corner.welded()),
        ("a cavity", hollow.clone()),
        ("opposite triangles on a face", with_opposite(&unit, unit.triangles[3])),
        ("opposite triangles within", with_opposite(&unit, [0, 3, 6])),
        ("a blade in a row with a hollow body", joined(&[hollow, block([4.0, 0.0, 0.0], [5.0; 3]), blade])),
    ]
}

fn placed(mesh: &Mesh, place: u32) -> Mesh {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), f64::from(place) * 0.7);
    let place = |v: &DVec3| turn * *v * 10f64.powi(place as i32 - 2) + DVec3::splat(f64::from(place));
    Mesh { vertices: mesh.vertices.iter().map(place).collect(), ..mesh.clone() }
}

/// Runs the check with repair and a report, which it gives with the exit code.
fn repair(folder: &Path, from: &str, to: &str) -> (Option<i32>, Value, String) {
    let ended = run(PERIS, &["check", from, "--repair", to, "--json"], &[], folder, TIMEOUT);
    (ended.code, serde_json::from_str(&ended.out).unwrap_or(Value::Null), ended.errors)
}

#[test]
fn awkward_solids_come_out_byte_for_byte() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut count = 0;
    for (what, mesh) in awkward() {
        for place in 0..PLACES {
            let (ending, format) = [("obj", Format::Obj), ("ply", Format::Ply)][place as usize % 2];
            let bytes = print(&placed(&mesh, place), format).expect("a mesh");
            let (from, to) = (format!("a.{ending}"), format!("b.{ending}"));
            std::fs::write(folder.path().join(&from), &bytes).expect("written");
            let (code, report, errors) = repair(folder.path(), &from, &to);
            assert_eq!((code, &report["solid"]), (Some(0), &Value::Bool(true)), "{what} {place}: {errors}");
            let done = report["repair"].as_object().expect("what was done");
            assert!(done.values().all(|done| *done == 0 || *done == false), "{what} {place}: {done:?}");
            assert!(std::fs::read(folder.path().join(&to)).expect("written") == bytes, "{what} {place}");
            count += 1;
        }
    }
    assert_eq!(count, 40);
}

#[test]
fn looks_and_names_of_a_solid_stay_in_its_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "# by hand\nmtllib a.mtl\no tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\n\
                f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(folder.path().join("a.obj"), text).expect("written");
    assert_eq!(repair(folder.path(), "a.obj", "b.obj").0, Some(0));
    assert_eq!(std::fs::read_to_string(folder.path().join("b.obj")).expect("written"), text);
}

/// Triangles anywhere in a cube, each of which crosses about ten others: alone, with their backs, or as tetrahedra.
fn soup(kind: &str, count: u32) -> Mesh {
    let mut random = Pcg64Mcg::seed_from_u64(u64::from(count));
    let size = 1.9 * (10.0 / f64::from(count)).cbrt();
    let mut vector = || DVec3::from([0; 3].map(|_| random.random::<f64>()));
    let mut mesh = Mesh::default();
    let corners = if kind == "tetrahedra" { 4 } else { 3 };
    while (mesh.triangles.len() as u32) < count {
        let (first, middle) = (mesh.vertices.len() as u32, vector());
        mesh.vertices.extend((0..corners).map(|_| middle + (vector() - 0.5) * size));
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| first + k);
        match kind {
            "tetrahedra" => mesh.triangles.extend([[a, c, b], [a, b, d], [b, c, d], [c, a, d]]),
            "with backs" => mesh.triangles.extend([[a, b, c], [a, c, b]]),
            _ => mesh.triangles.push([a, b, c]),
        }
    }
    mesh
}

#[test]
fn soups_of_triangles_end_as_solids_or_say_why_not() {
    let folder = tempfile::tempdir().expect("a folder");
    for count in [100, 400, 1600] {
        for (kind, problem) in [("alone", "is open"), ("with backs", "is open"), ("tetrahedra", "")] {
            let mesh = soup(kind, count);
            std::fs::write(folder.path().join("a.obj"), print(&mesh, Format::Obj).expect("a mesh")).expect("written");
            let (code, report, errors) = repair(folder.path(), "a.obj", "b.obj");
            if problem.is_empty() {
                assert_eq!(code, Some(0), "{count} {kind}: {errors}");
                assert_eq!(report["repair"]["is_resolved"], true);
                let bytes = std::fs::read(folder.path().join("b.obj")).expect("written");
                let found = parse(&bytes, Format::Obj).expect("a mesh");
                simple::check(&found).unwrap_or_else(|fault| panic!("{count} {kind}: {fault}"));
            } else {
                assert_eq!(code, Some(1), "{count} {kind}: {errors}");
                let told = report["repair_problem"].as_str().expect("it is told");
                assert!(told.contains(problem) && errors.contains(told), "{count} {kind}: {errors}");
            }
        }
    }
}

#[test]
fn the_boundary_loops_of_an_open_mesh_are_listed_and_closed() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut open = block([0.0; 3], [1.0; 3]);
    let is_lid = |corners: [DVec3; 3]| corners.iter().all(|v| v.z == 1.0);
    let kept = (0..open.triangles.len()).filter(|&t| !is_lid(open.corners(t)));
    open.triangles = kept.map(|t| open.triangles[t]).collect();
    std::fs::write(folder.path().join("a.ply"), print(&open, Format::Ply).expect("a mesh")).expect("written");
    let told = run(PERIS, &["check", "a.ply"], &[], folder.path(), TIMEOUT);
    assert_eq!(told.code, Some(1));
    assert!(
        told.out.contains("boundary loops          1") && told.out.contains("4 edges, 4.000000 long"),
        "{}",
        told.out
    );
    let (code, report, errors) = repair(folder.path(), "a.ply", "b.ply");
    assert_eq!(code, Some(0), "{errors}");
    assert_eq!(report["boundary_loops"][0]["edges"], 4);
    assert_eq!((&report["repair"]["loops"], &report["repair"]["added"]), (&1.into(), &2.into()));
}

#[test]
fn a_body_that_faces_inwards_beside_another_is_an_error_until_it_is_turned() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = joined(&[block([0.0; 3], [1.0; 3]), block([3.0; 3], [4.0; 3]).reversed()]);
    std::fs::write(folder.path().join("a.obj"), print(&mesh, Format::Obj).expect("a mesh")).expect("written");
    for arguments in [&["check", "a.obj"][..], &["boolean", "union", "a.obj", "a.obj", "-o", "b.obj"]] {
        let ended = run(PERIS, arguments, &[], folder.path(), TIMEOUT);
        assert_eq!(ended.code, Some(1), "{arguments:?}: {}", ended.errors);
        assert!(ended.errors.contains("1 of 2 shells face inwards"), "{arguments:?}: {}", ended.errors);
    }
    let (code, report, errors) = repair(folder.path(), "a.obj", "b.obj");
    assert_eq!((code, &report["repair"]["bodies"]), (Some(0), &1.into()), "{errors}");
    assert_eq!(run(PERIS, &["check", "b.obj"], &[], folder.path(), TIMEOUT).code, Some(0));
}
