//! `peris check`: whether a mesh bounds a solid.

use super::{CommandFailure, Exit, SubcommandRow, output};
use crate::mesh::{self, BoundaryLoop, Format, Grouped, Mesh};
use crate::solid::{self, Repair, Solid, SolidError};
use anyhow::Context;
use clap::{Args, FromArgMatches};
use files::Destination;
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) const ROW: SubcommandRow = SubcommandRow {
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

/// Boundary loops that the text names.
const NAMED: usize = 8;

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let destination = arguments.repair.as_ref().map(mesh::destination).transpose()?;
    let grouped = mesh::read_grouped(&arguments.mesh)?;
    let mesh = &grouped.mesh;
    let verdict = Solid::new(mesh.clone());
    let loops = solid::boundary(mesh);
    let repaired = destination.is_some().then(|| match &verdict {
        Ok(solid) => Ok((solid.clone(), Repair::default())),
        Err(problem) => Solid::repaired_of(mesh.clone(), problem),
    });
    if arguments.json {
        output::report(as_json(mesh, &loops, &verdict, repaired.as_ref()));
    } else {
        report(mesh, &loops);
        if verdict.is_ok() {
            say!("a solid");
        }
        if let Some(Ok((_, repair))) = &repaired {
            say!("repaired: {repair}");
        }
    }
    let outcome = match (repaired, destination) {
        (Some(Ok((_, repair))), Some(destination)) if repair.is_nothing() => {
            save(&arguments.mesh, &grouped, &destination)?;
            Ok(())
        }
        (Some(Ok((solid, _))), Some(destination)) => {
            mesh::write_grouped(&Grouped { mesh: solid.into_mesh(), ..grouped }, &destination)?;
            Ok(())
        }
        (Some(Err(error)), _) => Err(error),
        _ => verdict.map(|_| ()),
    };
    outcome.map_err(|error| CommandFailure::new(Exit::Failed, anyhow::anyhow!("{}: {error}", arguments.mesh.display())))
}

/// Writes a mesh that is a solid already: the same bytes if the format is the same and the file stands alone.
fn save(path: &Path, grouped: &Grouped, destination: &Destination) -> Result<(), CommandFailure> {
    let format = Format::of(path);
    if format != Format::of(destination.path()) || format == Some(Format::Gltf) {
        return Ok(mesh::write_grouped(grouped, destination)?);
    }
    let bytes = std::fs::read(path).with_context(|| format!("{}", path.display()))?;
    Ok(destination.write_or_save_elsewhere(|file| file.write_all(&bytes))?)
}

fn report(mesh: &Mesh, loops: &[BoundaryLoop]) {
    let report = mesh.edge_report();
    say!("vertices                {}", report.vertices);
    say!("triangles               {}", report.triangles);
    say!("edges                   {}", report.edges);
    say!("  open                  {}", report.boundary);
    say!("  non-manifold          {}", report.non_manifold);
    say!("  misoriented           {}", report.misoriented);
    say!("collapsed triangles     {}", report.collapsed);
    say!("degenerate triangles    {}", report.degenerate);
    say!("duplicate triangles     {}", mesh.duplicate_triangles());
    say!("Euler characteristic    {}", report.euler_characteristic());
    say!("boundary loops          {}", loops.len());
    let mut longest: Vec<(f64, &BoundaryLoop)> =
        loops.iter().map(|found| (found.length(&mesh.vertices), found)).collect();
    longest.sort_by(|one, two| two.0.total_cmp(&one.0));
    for (length, BoundaryLoop(corners)) in longest.iter().take(NAMED) {
        let near = mesh.vertices[corners[0] as usize];
        say!("  {} edges, {length:.6} long, near {near:.6}", corners.len());
    }
    if loops.len() > NAMED {
        say!("  and {} more", loops.len() - NAMED);
    }
}

fn as_json(
    mesh: &Mesh,
    loops: &[BoundaryLoop],
    verdict: &Result<Solid, SolidError>,
    repaired: Option<&Result<(Solid, Repair), SolidError>>,
) -> serde_json::Value {
    let report = mesh.edge_report();
    let told = |found: &BoundaryLoop| {
        let BoundaryLoop(corners) = found;
        let near = mesh.vertices[corners[0] as usize].to_array();
        serde_json::json!({ "edges": corners.len(), "length": found.length(&mesh.vertices), "near": near })
    };
    let mut known = serde_json::json!({
        "solid": verdict.is_ok(), "problem": verdict.as_ref().err().map(ToString::to_string),
        "vertices": report.vertices, "triangles": report.triangles,
        "edges": report.edges, "open_edges": report.boundary, "crowded_edges": report.non_manifold,
        "misoriented_edges": report.misoriented, "collapsed_triangles": report.collapsed,
        "triangles_without_area": report.degenerate, "duplicate_triangles": mesh.duplicate_triangles(),
        "euler_characteristic": report.euler_characteristic(),
        "boundary_loops": loops.iter().map(told).collect::<Vec<_>>(),
    });
    match repaired {
        Some(Ok((_, repair))) => known["repair"] = serde_json::json!(repair),
        Some(Err(error)) => known["repair_problem"] = serde_json::json!(error.to_string()),
        None => {}
    }
    known
}
