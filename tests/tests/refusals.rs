//! What the corpus scores, what `peris boolean` says and what a script gets come from one function: results are the
//! same to the bit, and refusals the same to the letter.

use glam::{DQuat, DVec3};
use host::mesh::{Format, Mesh, parse, print};
use host::solid::{Expression, Solid};
use host::surface::{Sphere, Tolerance, tessellate};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::path::Path;
use tests::corpus::{Score, evaluated};
use tests::{TIMEOUT, run};

const PERIS: &str = env!("CARGO_BIN_EXE_peris-under-test");

/// Three coarse spheres, turned by anything from a rounding to a hundredth: what is in an odd number of them is hard to
/// round, and may be refused. They have normals, since a script gives flat ones to what has none, and points where
/// normals change stay.
fn spheres(seed: u64) -> [Mesh; 3] {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut vector = || DVec3::from([0; 3].map(|_| random.random_range(-1.0..1.0)));
    let ball = tessellate(&[Sphere::new(DVec3::ZERO, 1.0)], Tolerance::new(0.3, 90.0)).expect("a sphere");
    [(); 3].map(|()| {
        let turn = DQuat::from_axis_angle(vector().normalize(), 10f64.powf(vector().x * 7.0 - 9.0));
        let vertices = ball.vertices.iter().map(|vertex| turn * *vertex).collect();
        let mut mesh = Mesh { vertices, triangles: ball.triangles.clone(), ..Mesh::default() }.welded();
        let flat = |triangle| [mesh.face_normal(triangle).expect("it has an area"); 3];
        mesh.corner_normals = (0..mesh.triangles.len()).map(flat).collect();
        mesh
    })
}

/// The positions of the triangles of a mesh, sorted.
fn places(mesh: &Mesh) -> Vec<[[u64; 3]; 3]> {
    let bits = |corner: DVec3| corner.to_array().map(f64::to_bits);
    let mut places: Vec<_> = (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(bits)).collect();
    // Which corner comes first does not matter.
    places.iter_mut().for_each(|corners| {
        let least = (0..3).min_by_key(|k| corners[*k]).unwrap_or(0);
        corners.rotate_left(least);
    });
    places.sort_unstable();
    places
}

/// What a command wrote to a file, or what it said instead on standard error and output.
///
/// - `refused`: the exit code for a refusal.
fn outcome(folder: &Path, arguments: &[&str], file: &str, refused: i32) -> Result<Mesh, [String; 2]> {
    let ended = run(PERIS, arguments, &[], folder, TIMEOUT);
    match ended.code {
        Some(0) => {
            let bytes = std::fs::read(folder.join(file)).expect("it was written");
            Ok(parse(&bytes, Format::of(Path::new(file)).expect("a mesh file")).expect("a mesh"))
        }
        code => {
            assert_eq!(code, Some(refused), "{}", ended.errors);
            Err([ended.errors, ended.out])
        }
    }
}

#[test]
fn the_corpus_the_command_and_a_script_get_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("a.rhai"), "mesh(\"0.obj\") ^ mesh(\"1.obj\") ^ mesh(\"2.obj\");").expect("written");
    let expression = Expression::SymmetricDifference((0..3).map(Expression::Operand).collect());
    let (mut results, mut refusals) = (0, 0);
    for seed in [0, 1, 2, 3, 6] {
        let meshes = spheres(seed);
        for (mesh, number) in meshes.iter().zip(0..) {
            let bytes = print(mesh, Format::Obj).expect("a mesh");
            std::fs::write(folder.join(format!("{number}.obj")), bytes).expect("written");
        }
        let solids = meshes.map(|mesh| Solid::new(mesh).expect("a sphere"));
        let scored = evaluated(&solids.each_ref(), &expression);
        let command = ["boolean", "0.obj", "^", "1.obj", "^", "2.obj", "-o", "b.obj", "--json"];
        let said = outcome(folder, &command, "b.obj", 1);
        let got = outcome(folder, &["tessellate", "a.rhai", "-o", "c.obj"], "c.obj", 3);
        match scored {
            Ok(mesh) => {
                let [said, got] = [said, got].map(|found| found.expect("the corpus has a result"));
                assert!(places(&mesh) == places(&said), "{seed}: the command has another result");
                assert!(places(&mesh) == places(&got), "{seed}: the script has another result");
                results += 1;
            }
            Err(Score::Refused(reason)) => {
                let [words, report] = said.map(|_| ()).expect_err("the corpus has none");
                assert!(words.contains(&reason), "{seed}: the command says {words}, the corpus {reason}");
                let report: serde_json::Value = serde_json::from_str(&report).expect("a report");
                assert_eq!(report["problem"], reason.as_str());
                let [words, _] = got.map(|_| ()).expect_err("the corpus has none");
                assert!(words.contains(&reason), "{seed}: the script says {words}, the corpus {reason}");
                refusals += 1;
            }
            Err(score) => panic!("{seed}: {score:?}"),
        }
    }
    assert!(results >= 2 && refusals >= 2, "{results} results, {refusals} refusals");
}
