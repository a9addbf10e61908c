//! `peris octree`: the linear octree of a scene, or one from a file.

use super::{CommandFailure, Exit, ScriptArguments, SubcommandRow, load, output};
use crate::memory;
use crate::octree::{ENDING, MAX_BYTES, MAX_DEPTH, Octree, OctreeSettings, Statistics};
use crate::scene::Prepared;
use clap::{Args, FromArgMatches};
use files::Destination;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "octree",
    summary: "Builds the linear octree of a scene and says what it holds.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// A scene script (.rhai), the name of a scene that ships, a mesh, or an octree that was kept (.octree)
    #[arg(default_value = "teapot", value_name = "SCENE")]
    scene: String,
    #[command(flatten)]
    definitions: ScriptArguments,
    /// Keeps the octree in a file
    #[arg(short, long, value_name = "FILE.octree")]
    output: Option<PathBuf>,
    /// Shows all figures, and the terminal nodes level by level
    #[arg(long)]
    stats: bool,
    /// Resolution N: the modelling cube has 2^N voxels a side
    #[arg(long, value_name = "LEVELS", value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_DEPTH)))]
    depth: Option<u32>,
    /// Small triangles in a cell that is not divided further
    #[arg(long, value_name = "COUNT")]
    leaf: Option<usize>,
    /// Least side of a cell, scene units
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    leaf_side: Option<f64>,
    /// Prints JSON
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let destination = arguments.output.as_deref().map(destination).transpose()?;
    let path = Path::new(&arguments.scene);
    let kept = Octree::is_file(path);
    let (octree, seconds) = if kept { read(path, arguments)? } else { build(arguments)? };
    if let Some(destination) = destination {
        let bytes = octree.to_bytes()?;
        destination.write_or_save_elsewhere(|file| file.write_all(&bytes))?;
    }
    let statistics = octree.statistics();
    if arguments.json {
        let mut json = serde_json::to_value(&statistics)?;
        json["build_seconds"] = seconds.into();
        output::report(json);
    } else {
        say!(
            "{} triangles in {} terminal nodes, {} in {seconds:.3} s, {:.1} bytes a triangle",
            statistics.triangles,
            statistics.leaves,
            if kept { "read" } else { "built" },
            statistics.bytes_per_triangle
        );
        if arguments.stats {
            say_on!("{}", details(&statistics));
        }
    }
    Ok(())
}

/// Where the octree will be kept, under a name by which it is known again.
fn destination(path: &Path) -> Result<Destination, CommandFailure> {
    if !Octree::is_file(path) {
        let why = format!("{}: the name of an octree ends in .{ENDING}", path.display());
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(why)));
    }
    Ok(Destination::of(path)?)
}

/// Builds the octree of a scene; also says how long it took, seconds.
fn build(arguments: &Arguments) -> Result<(Octree, f64), CommandFailure> {
    let mut scene = load(&arguments.scene, &arguments.definitions)?.scene;
    // Bodies of lamps are no geometry of the scene.
    scene.lights.clear();
    // An octree that is kept is one mesh.
    scene.settings.geometry.copies_instances = true;
    let prepared = Prepared::new(&scene)?;
    let defaults = OctreeSettings::default();
    let settings = OctreeSettings {
        depth: arguments.depth.unwrap_or(defaults.depth),
        leaf_triangles: arguments.leaf.unwrap_or(defaults.leaf_triangles),
        leaf_side: arguments.leaf_side.unwrap_or(defaults.leaf_side),
        ..defaults
    };
    let start = Instant::now();
    let octree = Octree::build(&prepared.vertices, &prepared.triangles, &settings)?.divided();
    Ok((octree, start.elapsed().as_secs_f64()))
}

/// Reads an octree; also says how long it took, seconds.
fn read(path: &Path, arguments: &Arguments) -> Result<(Octree, f64), CommandFailure> {
    let Arguments { depth, leaf, leaf_side, definitions, .. } = arguments;
    if depth.is_some() || leaf.is_some() || leaf_side.is_some() || !definitions.is_empty() {
        let why = "-D, --depth, --leaf and --leaf-side are for an octree that is built, not for one that is read";
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(why)));
    }
    let start = Instant::now();
    let bytes = memory::read(path, MAX_BYTES).map_err(|error| failed(path, &error))?;
    let octree = Octree::from_bytes(&bytes).map_err(|error| failed(path, &error))?;
    Ok((octree, start.elapsed().as_secs_f64()))
}

fn failed(path: &Path, error: &dyn std::error::Error) -> CommandFailure {
    CommandFailure::new(Exit::Failed, anyhow::anyhow!("{}: {error}", path.display()))
}

/// Reads a length.
fn length(text: &str) -> Result<f64, String> {
    let length = text.parse().ok().filter(|length| *length >= 0.0 && *length < f64::INFINITY);
    length.ok_or_else(|| "give a length, 0 or more".to_string())
}

fn details(s: &Statistics) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| text.push_str(&format!("{name:<34} {value}\n"));
    line("objects", s.objects.to_string());
    line("resolution N", s.depth.to_string());
    line("side of the modelling cube", s.side.to_string());
    line("part of it in terminal nodes", format!("{:.4} %", s.filled * 100.0));
    line("partial nodes", s.partial_nodes.to_string());
    line("voxel nodes", s.voxel_nodes.to_string());
    line("triangles named by all nodes", s.references.to_string());
    line("triangles named by a node, mean", format!("{:.2}", s.references as f64 / s.leaves.max(1) as f64));
    line("triangles named by a node, most", s.most_references.to_string());
    line("bytes", s.bytes.to_string());
    line("bytes without the index", s.linear_bytes.to_string());
    for (level, count) in s.depth_histogram.iter().enumerate().filter(|(_, n)| **n > 0) {
        line(&format!("terminal nodes of level {level}"), count.to_string());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run_words(words: &[&str]) -> Result<(), CommandFailure> {
        let command = Arguments::augment_args(clap::Command::new("octree"));
        let matches = command.try_get_matches_from([&["octree"], words].concat()).expect("a sound command line");
        run(&Arguments::from_arg_matches(&matches).expect("all arguments"))
    }

    #[test]
    fn an_octree_that_is_kept_is_read_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("pot.octree");
        let file = path.to_str().expect("a plain name");
        assert!(run_words(&["teapot", "--leaf", "4", "--leaf-side", "0.1", "--output", file]).is_ok());
        assert!(run_words(&[file, "--stats"]).is_ok() && run_words(&[file, "--json"]).is_ok());
        assert_eq!(run_words(&[file, "--depth", "3"]).map_err(|failure| failure.exit), Err(Exit::Usage));
        let mut bytes = std::fs::read(&path).expect("written");
        bytes[99] ^= 1;
        std::fs::write(&path, bytes).expect("written again");
        assert_eq!(run_words(&[file]).map_err(|failure| failure.exit), Err(Exit::Failed));
    }
}
