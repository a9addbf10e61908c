//! `peris intersect`: accurate intersection curves of the objects of a scene.

use super::{CommandFailure, Exit, SCRIPT_HELP, ScriptArguments, SubcommandRow, load, output};
use crate::intersection::{Branch, CurvePrecision, Intersection, Mark, csv, obj};
use crate::scene::object_intersections;
use clap::{Args, FromArgMatches};
use files::Destination;
use serde_json::{Value, json};
use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "intersect",
    summary: "Finds the curves in which the objects of a scene meet, on their exact surfaces.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: ScriptArguments,
    /// Residual at which a point counts as found, as a part of the size of the objects
    #[arg(long, value_name = "PART", default_value_t = CurvePrecision::default().newton, value_parser = super::values::part)]
    newton: f64,
    /// Adds points until the lines between them are this near to the curve, scene units
    #[arg(long, value_name = "LENGTH", value_parser = super::values::length)]
    chord: Option<f64>,
    /// A file for all points (.csv) or for the curves as lines (.obj); may be given more than once
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let is_unknown = |path: &&PathBuf| !path.extension().is_some_and(|e| e == "csv" || e == "obj");
    if let Some(path) = arguments.output.iter().find(is_unknown) {
        return Err(CommandFailure::new(
            Exit::Usage,
            anyhow::anyhow!("{} ends neither in .csv nor in .obj", path.display()),
        ));
    }
    let destinations: Vec<Destination> = arguments.output.iter().map(Destination::of).collect::<Result<_, _>>()?;
    let scene = load(&arguments.script, &arguments.definitions)?.scene;
    let precision = CurvePrecision { newton: arguments.newton, chord: arguments.chord };
    let start = Instant::now();
    let found = object_intersections(&scene, &precision)?;
    let seconds = start.elapsed().as_secs_f64();
    let named: Vec<([String; 2], &Intersection)> = found
        .iter()
        .map(|meeting| (meeting.objects.map(|object| scene.objects[object].name.clone()), &meeting.intersection))
        .filter(|(_, intersection)| intersection.points().next().is_some() || intersection.counts.coincident > 0)
        .collect();
    for destination in &destinations {
        let is_table = destination.path().extension().is_some_and(|extension| extension == "csv");
        let text = if is_table { csv(&named) } else { obj(&named) };
        destination.write_or_save_elsewhere(|file| file.write_all(text.as_bytes()))?;
    }
    if arguments.json {
        let all: Vec<Value> = named.iter().map(|(names, intersection)| described(names, intersection)).collect();
        output::report(json!({ "seconds": seconds, "meetings": all }));
    } else {
        named.iter().for_each(|(names, intersection)| report(names, intersection));
        say!("{} pairs of objects meet, found in {:.1} ms", named.len(), seconds * 1e3);
    }
    Ok(())
}

/// What is counted of a branch.
struct Summary {
    points: usize,
    failed: usize,
    residual: f64,
    least_angle: f64,
    branching: usize,
    tangent: usize,
}

impl Summary {
    fn of(branch: &Branch) -> Summary {
        let points = &branch.points;
        let count = |mark: Mark| points.iter().filter(|point| point.mark == mark).count();
        Summary {
            points: points.len(),
            failed: points.iter().filter(|point| point.inaccuracy.is_some()).count(),
            residual: points.iter().map(|point| point.residual).fold(0.0, f64::max),
            least_angle: points.iter().map(|point| point.angle).fold(90.0, f64::min),
            branching: count(Mark::Branching),
            tangent: count(Mark::Tangent),
        }
    }
}

fn report([one, two]: &[String; 2], intersection: &Intersection) {
    say!("{one} and {two}: {} curves, {} points of touch", intersection.branches.len(), intersection.touching.len());
    if intersection.counts.coincident > 0 {
        say!(
            "  {} pairs of triangles lie in one plane; only the border of such regions is found",
            intersection.counts.coincident
        );
    }
    if !intersection.branches.is_empty() {
        say!("  curve  closed  points  failed      length     residual  angle (degrees)  tangent  branching");
    }
    for (index, branch) in intersection.branches.iter().enumerate() {
        let Summary { points, failed, residual, least_angle, branching, tangent } = Summary::of(branch);
        let (closed, length) = (if branch.is_closed { "yes" } else { "no" }, branch.length());
        say!(
            "  {index:>5}  {closed:>6}  {points:>6}  {failed:>6}  {length:>10.6}  {residual:>11.2e}  {least_angle:>15.3e}  {tangent:>7}  {branching:>9}"
        );
    }
    for point in &intersection.touching {
        say!("  touch at {} (residual {:.2e})", point.position, point.residual);
    }
    for point in intersection.points() {
        if let Some(failure) = point.inaccuracy {
            say!("  not accurate at {}: {failure} (residual {:.2e})", point.position, point.residual);
        }
    }
}

fn described(names: &[String; 2], intersection: &Intersection) -> Value {
    let branch = |branch: &Branch| {
        let Summary { points, failed, residual, least_angle, branching, tangent } = Summary::of(branch);
        json!({
            "closed": branch.is_closed, "points": points, "failed": failed, "length": branch.length(), "residual": residual,
            "least_angle_degrees": least_angle, "tangent": tangent, "branching": branching,
        })
    };
    let touching: Vec<[f64; 3]> = intersection.touching.iter().map(|point| point.position.to_array()).collect();
    json!({
        "objects": names, "branches": intersection.branches.iter().map(branch).collect::<Vec<Value>>(), "touching": touching,
        "coincident": intersection.counts.coincident, "added": intersection.counts.added, "unfilled": intersection.counts.unfilled,
    })
}
