//! `peris measure`: size, volume, centre and inertia of solids.

use super::boolean::solid;
use super::{CommandFailure, SubcommandRow, output};
use crate::solid::Mass;
use clap::{Args, FromArgMatches};
use std::path::PathBuf;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "measure",
    summary: "Says volume, area, centre of mass, inertia and bounds of a closed mesh.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// A closed mesh (.obj, .stl, .ply, .gltf, .glb, .cmesh)
    #[arg(value_name = "MESH")]
    mesh: PathBuf,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let solid = solid(&arguments.mesh)?;
    let Mass { volume, centroid, inertia } = solid.mass();
    let (mesh, bounds) = (solid.mesh(), solid.mesh().bounds());
    let [low, high] = bounds.map_or([centroid; 2], |b| [b.min, b.max]);
    let rows: [[f64; 3]; 3] = [0, 1, 2].map(|row| inertia.row(row).to_array());
    if arguments.json {
        let known = serde_json::json!({
            "vertices": mesh.vertices.len(), "triangles": mesh.triangles.len(), "volume": volume, "area": mesh.area(),
            "centroid": centroid.to_array(), "inertia": rows, "low": low.to_array(), "high": high.to_array(),
        });
        output::report(known);
    } else {
        say!("vertices   {}\ntriangles  {}", mesh.vertices.len(), mesh.triangles.len());
        say!("volume     {volume}\narea       {}\ncentroid   {centroid}", mesh.area());
        say!("inertia    {:?}\n           {:?}\n           {:?}", rows[0], rows[1], rows[2]);
        say!("bounds     {low} to {high}");
    }
    Ok(())
}
