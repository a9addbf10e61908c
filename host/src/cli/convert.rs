//! `peris convert`: meshes, pictures and scenes from one file format to another.

use super::{Failure, Row};
use crate::mesh::{self, Mesh};
use crate::picture::Picture;
use crate::scene::Prepared;
use crate::script;
use clap::{Args, FromArgMatches};
use std::path::{Path, PathBuf};

pub(super) const ROW: Row = Row {
    name: "convert",
    summary: "Converts a mesh, a picture, or the triangles of a whole scene to another file format.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// A mesh (.obj, .stl, .ply, .cmesh), a picture (.png, .exr), a scene script (.rhai) or the name of a scene that ships
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// The file to write: a mesh from a mesh or a scene, a picture from a picture
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { input, output, json } = arguments;
    if Picture::check_name(input).is_ok() {
        let picture = Picture::read(input)?;
        picture.write(output)?;
        if *json {
            let known = serde_json::json!({ "file": output, "width": picture.width(), "height": picture.height() });
            say!("{known:#}");
        } else {
            say!("{}: {} x {} pixels", output.display(), picture.width(), picture.height());
        }
        return Ok(());
    }
    let mesh = triangles(input)?;
    mesh::write(&mesh, output)?;
    let (vertices, triangles) = (mesh.vertices.len(), mesh.triangles.len());
    if *json {
        say!("{:#}", serde_json::json!({ "file": output, "vertices": vertices, "triangles": triangles }));
    } else {
        say!("{}: {vertices} vertices, {triangles} triangles", output.display());
    }
    Ok(())
}

fn triangles(input: &Path) -> Result<Mesh, Failure> {
    let name = input.to_string_lossy();
    let is_script = input.extension().is_some_and(|e| e == "rhai");
    if is_script || script::EMBEDDED.iter().any(|e| e.name == name) {
        Ok(Prepared::new(&super::load(&name)?.scene)?.into_mesh())
    } else {
        Ok(mesh::read(input)?)
    }
}
