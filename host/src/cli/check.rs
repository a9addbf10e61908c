//! `peris check`: whether a mesh bounds a solid.

use super::{Exit, Failure, Row, say};
use crate::mesh;
use crate::solid::Solid;
use clap::{Args, FromArgMatches};
use std::path::PathBuf;

pub(super) const ROW: Row = Row {
    name: "check",
    summary: "Says whether a mesh is closed, consistently oriented and free of self-crossings; the exit code tells too.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// A mesh (.obj, .stl, .ply, .gltf, .glb, .cmesh)
    #[arg(value_name = "MESH")]
    mesh: PathBuf,
    /// Makes a solid of the mesh, and writes it to this file
    #[arg(long, value_name = "FILE")]
    repair: Option<PathBuf>,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let repaired = arguments.repair.as_ref().map(mesh::destination).transpose()?;
    let mesh = mesh::read(&arguments.mesh)?;
    let report = mesh.edge_report();
    let duplicates = mesh.duplicate_triangles();
    let mut verdict = Solid::new(mesh.clone());
    let problem = verdict.as_ref().err().map(ToString::to_string);
    if arguments.json {
        let known = serde_json::json!({
            "solid": verdict.is_ok(), "problem": problem, "vertices": report.vertices, "triangles": report.triangles,
            "edges": report.edges, "open_edges": report.boundary, "crowded_edges": report.crowded,
            "misoriented_edges": report.misoriented, "collapsed_triangles": report.collapsed,
            "triangles_without_area": report.slivers, "duplicate_triangles": duplicates,
            "euler_characteristic": report.euler_characteristic(),
        });
        say::report(known);
    } else {
        say!("vertices                {}", report.vertices);
        say!("triangles               {}", report.triangles);
        say!("edges                   {}", report.edges);
        say!("  open                  {}", report.boundary);
        say!("  of several triangles  {}", report.crowded);
        say!("  misoriented           {}", report.misoriented);
        say!("collapsed triangles     {}", report.collapsed);
        say!("triangles without area  {}", report.slivers);
        say!("duplicate triangles     {duplicates}");
        say!("Euler characteristic    {}", report.euler_characteristic());
        if verdict.is_ok() {
            say!("a solid");
        }
    }
    if let Some(destination) = &repaired {
        verdict = Solid::repaired(mesh).map(|(solid, repair)| {
            if !arguments.json {
                say!(
                    "repaired: {} collapsed and {} double triangles left out, {} turned, {} added in holes{}",
                    repair.collapsed,
                    repair.duplicates,
                    repair.turned,
                    repair.filled,
                    if repair.is_resolved { ", divided where it crossed itself" } else { "" }
                );
            }
            solid
        });
        if let Ok(solid) = &verdict {
            mesh::write(solid.mesh(), destination)?;
        }
    }
    match verdict {
        Ok(_) => Ok(()),
        Err(error) => Err(Failure::new(Exit::Failed, anyhow::anyhow!("{}: {error}", arguments.mesh.display()))),
    }
}
