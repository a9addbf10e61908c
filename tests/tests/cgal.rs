//! Results of the corpus before the self-intersection test of CGAL, where its Python package is installed.
//!
//! The package takes surfaces in which each edge has two triangles and each vertex one fan; others are left out.

use std::fmt::Write;
use std::process::Command;
use tests::corpus::{CLASSES, CorpusCase, evaluated};

/// Cases of each class.
const CASES: u32 = 8;

/// Reads the surfaces that are named, and prints how many it could read, and the names of those that cross themselves.
const JUDGE: &str = "
import os, sys
from CGAL.CGAL_Polyhedron_3 import Polyhedron_3
from CGAL.CGAL_Polygon_mesh_processing import does_self_intersect
read = 0
for name in sys.argv[1:]:
    surface = Polyhedron_3(name)
    if surface.size_of_facets() == 0 or not surface.is_closed():
        continue
    read += 1
    if does_self_intersect(surface):
        print('crosses', os.path.basename(name))
print('read', read)
";

#[test]
fn results_do_not_cross_themselves_as_cgal_sees_it() {
    let python = |arguments: &[&str]| Command::new("python3").args(arguments).output();
    if !python(&["-c", "import CGAL"]).is_ok_and(|output| output.status.success()) {
        println!("left out: the Python package of CGAL is not installed");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut names = Vec::new();
    for class in CLASSES {
        for number in 0..CASES {
            let CorpusCase::Tree { solids, expression, .. } = class.case(number) else { continue };
            let solids: Vec<_> =
                solids.into_iter().map(|mesh| host::solid::Solid::new(mesh).expect("a solid")).collect();
            let Ok(mesh) = evaluated(&solids.iter().collect::<Vec<_>>(), &expression) else { continue };
            let mut text = format!("OFF\n{} {} 0\n", mesh.vertices.len(), mesh.triangles.len());
            mesh.vertices.iter().for_each(|v| writeln!(text, "{:?} {:?} {:?}", v.x, v.y, v.z).expect("text"));
            mesh.triangles.iter().for_each(|[a, b, c]| writeln!(text, "3 {a} {b} {c}").expect("text"));
            let name = folder.path().join(format!("{} {number}.off", class.name.replace(' ', "-")));
            std::fs::write(&name, text).expect("written");
            names.push(name.display().to_string());
        }
    }
    let arguments: Vec<&str> = ["-c", JUDGE].into_iter().chain(names.iter().map(String::as_str)).collect();
    let output = python(&arguments).expect("it runs");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(!said.contains("crosses"), "{said}");
    let read: usize = said.trim().rsplit(' ').next().and_then(|count| count.parse().ok()).unwrap_or(0);
    println!("CGAL read {read} of {}", names.len());
    assert!(2 * read > names.len(), "{said}");
}
