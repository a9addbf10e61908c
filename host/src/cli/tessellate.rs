//! `peris tessellate`: the triangles of a scene, to a tolerance.

use super::{CommandFailure, ScriptArguments, SubcommandRow, load, output};
use crate::mesh;
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
    /// The file to write: .obj (groups), .gltf or .glb (a primitive with a material for each surface), .ply (a property of faces), .stl
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
    let grouped = scene.tessellated()?;
    let seconds = start.elapsed().as_secs_f64();
    mesh::write_grouped(&grouped, &destination)?;
    let mesh = grouped.mesh;
    let error = scene.chord_error()?;
    let mut used = mesh.surfaces.clone();
    used.sort_unstable();
    used.dedup();
    let (objects, surfaces) = (scene.objects.len(), used.len());
    let (vertices, triangles) = (mesh.welded().vertices.len(), mesh.triangles.len());
    if *json {
        let known = serde_json::json!({
            "file": output, "objects": objects, "surfaces": surfaces, "vertices": vertices, "triangles": triangles,
            "seconds": seconds, "chord_error": error,
        });
        output::report(known);
    } else {
        say!(
            "{}: {objects} objects, {surfaces} surfaces, {vertices} vertices, {triangles} triangles in {seconds:.3} s; \
             measured, no exact surface is more than {error:.3e} away",
            output.display()
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

    #[test]
    fn groups_go_through_tessellate_convert_and_boolean() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(file("a.rhai"), "cylinder(1, parameter(\"height\", 2.0)).name(\"can\");").expect("written");
        let command = |words: &[&str]| {
            let matches = super::super::command().try_get_matches_from([&["peris"], words].concat());
            let matches = matches.unwrap_or_else(|error| panic!("{error}"));
            let (name, arguments) = matches.subcommand().expect("a command");
            let row = super::super::COMMANDS.iter().find(|row| row.name == name).expect("known");
            (row.run)(arguments).unwrap_or_else(|failure| panic!("{}", failure.error));
        };
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
