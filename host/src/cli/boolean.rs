//! `peris boolean`: solids from solids.

use super::{CommandFailure, Exit, SubcommandRow, formula, output};
use crate::mesh::{self, Grouped, MetallicRoughness};
use crate::solid::Solid;
use anyhow::Context;
use clap::{Args, FromArgMatches};
use std::path::{Path, PathBuf};
use std::time::Instant;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "boolean",
    summary: "Unites, intersects or subtracts solids that are given as closed meshes.",
    arguments: |command| {
        let usage = "peris boolean A OPERATION B [OPERATION C]... -o FILE\n       \
                     peris boolean OPERATION A B [C]... -o FILE";
        Arguments::augment_args(command).override_usage(usage)
    },
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// Closed meshes (.obj, .stl, .ply, .gltf, .glb, .cmesh) with an operation between each two, or with one in front
    /// of them all; their groups stay, one without has its name
    #[arg(value_name = "FORMULA", num_args = 1.., required = true, long_help = formula::HELP)]
    formula: Vec<PathBuf>,
    /// The file to write; its extension names the format
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let Arguments { formula, output, json } = arguments;
    let (meshes, expression) = formula::parse(formula).map_err(|error| CommandFailure::new(Exit::Usage, error))?;
    let destination = mesh::destination(output)?;
    let (mut solids, mut names, mut looks) = (Vec::new(), Vec::new(), Vec::new());
    for path in &meshes {
        let Operand { solid, names: own, materials: its_looks } = grouped_solid(path)?;
        // Numbers of surfaces of a result go on from operand to operand.
        let count = solid.mesh().surfaces.iter().max().map_or(0, |last| *last as usize + 1);
        names.extend((0..count).map(|k| own.get(k).cloned().unwrap_or_else(|| format!("{}/{k}", stem(path)))));
        looks.extend((0..count).map(|k| its_looks.get(k).copied().flatten()));
        solids.push(solid);
    }
    let start = Instant::now();
    let evaluated = Solid::evaluate(&solids.iter().collect::<Vec<_>>(), &expression);
    let (result, outcome) = evaluated.map_err(|error| {
        if *json {
            output::report(serde_json::json!({ "problem": error.to_string() }));
        }
        CommandFailure::new(Exit::Failed, error)
    })?;
    let seconds = start.elapsed().as_secs_f64();
    let grouped = Grouped { mesh: result.into_mesh(), names, materials: looks };
    mesh::write_grouped(&grouped, &destination)?;
    let mesh = &grouped.mesh;
    let volume = mesh.signed_volume();
    if *json {
        let counts = &outcome.counts;
        let known = serde_json::json!({
            "file": output, "vertices": mesh.vertices.len(), "triangles": mesh.triangles.len(), "volume": volume,
            "area": mesh.area(), "seconds": seconds, "pairs": counts.pairs, "contacts": counts.contacts,
            "points": counts.points, "divided": counts.divided, "facets": counts.facets, "parts": counts.parts,
            "rays": counts.rays,
        });
        output::report(known);
    } else {
        let empty = if mesh.triangles.is_empty() { "; the result is empty" } else { "" };
        say!(
            "{}: {} vertices, {} triangles, volume {volume}, {:.1} ms{empty}",
            output.display(),
            mesh.vertices.len(),
            mesh.triangles.len(),
            seconds * 1e3
        );
    }
    Ok(())
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Reads a mesh that must be a solid.
pub(super) fn solid(path: &Path) -> Result<Solid, CommandFailure> {
    grouped_solid(path).map(|operand| operand.solid)
}

/// A solid, and names and materials of its groups.
struct Operand {
    solid: Solid,
    names: Vec<String>,
    materials: Vec<Option<MetallicRoughness>>,
}

/// Reads a mesh that must be a solid; one without groups is one, called as the file.
fn grouped_solid(path: &Path) -> Result<Operand, CommandFailure> {
    let Grouped { mut mesh, mut names, materials: looks } = mesh::read_grouped(path)?;
    if mesh.surfaces.is_empty() {
        mesh.surfaces = vec![0; mesh.triangles.len()];
        names = vec![stem(path)];
    }
    let solid = Solid::resolved(mesh).with_context(|| format!("{} is no solid", path.display()));
    let (solid, crossing) = solid.map_err(|error| CommandFailure::new(Exit::Failed, error))?;
    if let Some(crossing) = crossing {
        tracing::warn!("{}: {crossing}; taken for all points of positive winding number", path.display());
    }
    Ok(Operand { solid, names, materials: looks })
}
