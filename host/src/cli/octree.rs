//! `peris octree`: the linear octree of a scene.

use super::{Failure, Row, SCRIPT_HELP, load};
use crate::octree::{MAX_DEPTH, Octree, Settings, Statistics};
use crate::scene::Prepared;
use clap::{Args, FromArgMatches};
use std::time::Instant;

pub(super) const ROW: Row = Row {
    name: "octree",
    summary: "Builds the linear octree of a scene and says what it holds.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, default_value = "teapot", value_name = "SCRIPT")]
    script: String,
    /// Shows all figures, and the terminal nodes level by level
    #[arg(long)]
    stats: bool,
    /// Resolution N: the modelling cube has 2^N voxels a side
    #[arg(long, value_name = "LEVELS", value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_DEPTH)))]
    depth: Option<u32>,
    /// Triangles in a cell that is not divided further
    #[arg(long, value_name = "COUNT")]
    leaf: Option<usize>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let prepared = Prepared::new(&load(&arguments.script)?.scene)?;
    let defaults = Settings::default();
    let settings = Settings {
        depth: arguments.depth.unwrap_or(defaults.depth),
        leaf_triangles: arguments.leaf.unwrap_or(defaults.leaf_triangles),
        ..defaults
    };
    let start = Instant::now();
    let octree = Octree::build(&prepared.vertices, &prepared.triangles, &settings)?;
    let seconds = start.elapsed().as_secs_f64();
    let statistics = octree.statistics();
    if arguments.json {
        let mut json = serde_json::to_value(&statistics)?;
        json["build_seconds"] = seconds.into();
        json["depth"] = settings.depth.into();
        say!("{}", serde_json::to_string_pretty(&json)?);
    } else {
        say!(
            "{} triangles in {} terminal nodes, built in {seconds:.3} s, {:.1} bytes a triangle",
            statistics.triangles,
            statistics.leaves,
            statistics.bytes_per_triangle
        );
        if arguments.stats {
            say_on!("{}", details(&statistics, settings.depth));
        }
    }
    Ok(())
}

fn details(s: &Statistics, depth: u32) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| text.push_str(&format!("{name:<34} {value}\n"));
    line("resolution N", depth.to_string());
    line("side of the modelling cube", format!("{:.6}", s.side));
    line("partial nodes", s.partial_nodes.to_string());
    line("voxel nodes", s.voxel_nodes.to_string());
    line("triangles named by all nodes", s.references.to_string());
    line("triangles named by a node, mean", format!("{:.2}", s.references as f64 / s.leaves.max(1) as f64));
    line("bytes", s.bytes.to_string());
    for (level, count) in s.depth_histogram.iter().enumerate().filter(|(_, n)| **n > 0) {
        line(&format!("terminal nodes of level {level}"), count.to_string());
    }
    text
}
