//! `peris tessellate`: the triangles of a scene, to a tolerance.

use super::{CommandFailure, ScriptArguments, SubcommandRow, load, output};
use crate::mesh::{self, Mesh, PlacedMeshes};
use clap::{Args, FromArgMatches};
use std::path::PathBuf;
use std::time::Instant;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "tessellate",
    summary: "Approximates all surfaces of a scene by triangles to a tolerance, grouped by object and surface, and measures the error.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// A scene script (.rhai), the name of a scene that ships, or a mesh
    #[arg(value_name = "SCENE")]
    input: PathBuf,
    #[command(flatten)]
    definitions: ScriptArguments,
    /// The file to write: .obj (groups), .gltf or .glb (a primitive with a material for each surface, and what is placed many times once), .ply (a property of faces), .stl
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Largest distance between surface and triangles, scene units [default: that of the scene and its objects]
    #[arg(long, value_name = "LENGTH", value_parser = super::values::length)]
    chord: Option<f64>,
    /// Largest turn of the normal along a triangle, degrees [default: that of the scene, 45]
    #[arg(long, value_name = "DEGREES", value_parser = angle)]
    angle: Option<f64>,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let Arguments { input, definitions, output, chord, angle, json } = arguments;
    let destination = mesh::destination(output)?;
    let scene = load(&input.to_string_lossy(), definitions)?.scene.within(*chord, *angle);
    let start = Instant::now();
    let placed = match mesh::Format::of(output).is_some_and(mesh::Format::has_places) {
        true => scene.tessellated_once()?,
        false => PlacedMeshes { alone: scene.tessellated()?, ..PlacedMeshes::default() },
    };
    let seconds = start.elapsed().as_secs_f64();
    if placed.places.count() > 0 {
        mesh::write_placed(&placed, &destination)?;
    } else {
        mesh::write_grouped(&placed.alone, &destination)?;
    }
    let error = scene.chord_error()?;
    let used = |mesh: &Mesh| {
        let mut used = mesh.surfaces.clone();
        used.sort_unstable();
        used.dedup();
        used.len()
    };
    let meshes = || std::iter::once(&placed.alone).chain(placed.repeated.iter().map(|repeated| &repeated.grouped));
    let objects = scene.objects.len();
    let surfaces = meshes().map(|grouped| used(&grouped.mesh)).sum::<usize>();
    let vertices = meshes().map(|grouped| grouped.mesh.welded().vertices.len()).sum::<usize>();
    let triangles = meshes().map(|grouped| grouped.mesh.triangles.len()).sum::<usize>();
    let instances = placed.places.count();
    if *json {
        let known = serde_json::json!({
            "file": output, "objects": objects, "surfaces": surfaces, "vertices": vertices, "triangles": triangles,
            "instances": instances, "seconds": seconds, "chord_error": error,
        });
        output::report(known);
    } else {
        say!(
            "{}: {objects} objects, {surfaces} surfaces, {vertices} vertices, {triangles} triangles{} in {seconds:.3} s; \
             measured, no exact surface is more than {error:.3e} away",
            output.display(),
            output::of_instances(instances)
        );
    }
    Ok(())
}

/// Reads an angle.
fn angle(text: &str) -> Result<f64, String> {
    let angle = text.parse().ok().filter(|angle| *angle > 0.0 && *angle <= 180.0);
    angle.ok_or_else(|| "give degrees, above 0 and at most 180".to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn command(words: &[&str]) {
        let matches = super::super::command().try_get_matches_from([&["peris"], words].concat());
        let matches = matches.unwrap_or_else(|error| panic!("{error}"));
        let (name, arguments) = matches.subcommand().expect("a command");
        let row = super::super::COMMANDS.iter().find(|row| row.name == name).expect("known");
        (row.run)(arguments).unwrap_or_else(|failure| panic!("{}", failure.error));
    }

    #[test]
    fn what_is_placed_many_times_goes_once_through_gltf_files_and_as_copies_through_others() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = |name: &str| folder.path().join(name).display().to_string();
        let script = "
            let row = instances([cube(1), cylinder(0.2, 3)], [[0, 0, 0], [3, 0, 0], #{ at: [6, 0, 0], turn: 45, scale: 2 }]);
            instances(row, [[0, 0, 0], #{ at: [0, 20, 0], scale: [1, -1, 1] }]);
            sphere(1).translate(0, 10, 0);
        ";
        std::fs::write(file("a.rhai"), script).expect("written");
        let placed = |name: &str| mesh::read_placed(file(name)).expect("meshes");
        let once = |name: &str, scale: f64| {
            let placed = placed(name);
            assert_eq!((placed.repeated.len(), placed.places.count()), (2, 12));
            assert_eq!(placed.repeated[0].grouped.mesh.triangles.len(), 12);
            let bounds = placed.alone.mesh.bounds().expect("a sphere");
            assert!((bounds.max.y - 11.0 * scale).abs() < 1e-2 * scale);
            mesh::read(file(name)).expect("a mesh")
        };
        command(&["tessellate", &file("a.rhai"), "-o", &file("a.glb")]);
        let made = once("a.glb", 1.0);
        command(&["convert", &file("a.glb"), &file("b.gltf"), "--scale", "0.5"]);
        let half = once("b.gltf", 0.5);
        assert!((half.signed_volume() * 8.0 / made.signed_volume() - 1.0).abs() < 1e-9);
        command(&["convert", &file("a.rhai"), &file("c.glb")]);
        once("c.glb", 1.0);
        for other in ["a.ply", "b.obj"] {
            command(&["convert", &file("a.glb"), &file(other)]);
            let read = mesh::read(file(other)).expect("a mesh");
            assert_eq!(read.triangles.len(), made.triangles.len());
            assert!((read.signed_volume() / made.signed_volume() - 1.0).abs() < 1e-9);
        }
        // Booleans take the copies.
        std::fs::write(file("d.rhai"), "mesh(\"e.glb\") - box(100, 0.5, 100);").expect("written");
        std::fs::write(file("e.rhai"), "instances(cube(1), [[0, 0, 0], [3, 0, 0]]);").expect("written");
        command(&["tessellate", &file("e.rhai"), "-o", &file("e.glb")]);
        command(&["tessellate", &file("d.rhai"), "-o", &file("d.ply")]);
        let left = mesh::read(file("d.ply")).expect("a mesh").signed_volume();
        assert!((left - 1.0).abs() < 1e-6, "{left}");
        command(&["boolean", &file("e.glb"), "+", &file("e.glb"), "-o", &file("f.glb")]);
        assert!((mesh::read(file("f.glb")).expect("a mesh").signed_volume() - 2.0).abs() < 1e-6);
    }

    #[test]
    fn groups_go_through_tessellate_convert_and_boolean() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(file("a.rhai"), "cylinder(1, parameter(\"height\", 2.0)).name(\"can\");").expect("written");
        let names = |name: &str| mesh::read_grouped(file(name)).expect("a mesh").names;
        command(&[
            "tessellate",
            &file("a.rhai"),
            "-o",
            &file("a.obj"),
            "--chord",
            "0.01",
            "--angle",
            "20",
            "-D",
            "height=4",
        ]);
        assert_eq!(mesh::read(file("a.obj")).expect("a mesh").bounds().expect("vertices").size().y, 4.0);
        assert_eq!(names("a.obj"), ["can/0", "can/1", "can/2"]);
        for other in ["a.glb", "a.ply", "a.gltf"] {
            command(&["convert", &file("a.obj"), &file(other)]);
            assert_eq!(names(other), ["can/0", "can/1", "can/2"]);
        }
        std::fs::write(file("b.rhai"), "sphere(1.5);").expect("written");
        command(&["tessellate", &file("b.rhai"), "-o", &file("b.stl"), "--chord", "0.01"]);
        command(&["boolean", &file("a.ply"), "-", &file("b.stl"), "-o", &file("c.obj")]);
        command(&["boolean", "difference", &file("a.ply"), &file("b.stl"), "-o", &file("first.obj")]);
        assert_eq!(mesh::read(file("c.obj")).expect("a mesh"), mesh::read(file("first.obj")).expect("a mesh"));
        let left = names("c.obj");
        assert!(left.contains(&"b".to_owned()) && left.contains(&"can/0".to_owned()) && left.len() == 4, "{left:?}");
        command(&["convert", &file("c.obj"), &file("d.ply"), "--scale", "0.001"]);
        let (large, small) = (mesh::read(file("c.obj")).expect("a mesh"), mesh::read(file("d.ply")).expect("a mesh"));
        assert!((small.signed_volume() * 1e9 / large.signed_volume() - 1.0).abs() < 1e-9);
    }
}
