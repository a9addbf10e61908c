//! `peris convert`: meshes, pictures and scenes from one file format to another.

use super::display::DisplayArguments;
use super::source::warn_of_short_scatters;
use super::{CommandFailure, Exit, ScriptArguments, SubcommandRow, load, output};
use crate::mesh::{self, Grouped, PlacedMeshes};
use crate::picture::Picture;
use crate::picture::display::{DisplayTransform, Exposure};
use crate::render::metering::stops_of_picture;
use crate::scene::{Prepared, View};
use crate::workstation::{Drawing, DrawnEdges, InitialView, structure};
use clap::{Args, FromArgMatches};
use files::Destination;
use glam::{DAffine3, DVec3};
use protocol::command::{Command, Object as Node, print};
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "convert",
    summary: "Converts a mesh, a picture, or the triangles of a whole scene to another file format, or to commands of a \
              PS 340.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

#[derive(Args, Debug)]
struct Arguments {
    /// A mesh (.obj, .stl, .ply, .gltf, .glb, .cmesh), a picture (.png, .exr, .hdr), an octree (.octree), a scene script (.rhai) or the name of a scene that ships
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    definitions: ScriptArguments,
    /// The file to write: a mesh from a mesh or a scene, a picture from a picture; or commands (.ps300) that build a
    /// mesh or scene on a PS 340 as polygons with camera, lights and materials, below a node PERIS.SHADE that renders
    /// them on request: SEND FIX(4) TO <1>PERIS.SHADE removes hidden lines, FIX(7) and FIX(8) shade
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// For a mesh: at most so many triangles; edges collapse, those first with which least changes
    #[arg(long, value_name = "COUNT")]
    triangles: Option<usize>,
    /// For a mesh: all lengths are multiplied by it. Without it numbers stay: glTF counts in metres, the other formats do
    /// not say in what, so that a file in millimetres needs 0.001 on its way to glTF
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = factor)]
    scale: f64,
    /// For .ps300: the edges that pictures without hidden lines draw; all others are soft
    #[arg(long, value_enum, default_value = "grid")]
    lines: DrawnEdges,
    /// For .ps300: distance between curved surfaces and their triangles, as a part of the object's diagonal
    #[arg(long, value_name = "PART", default_value_t = Drawing::default().tolerance, value_parser = super::values::part)]
    tolerance: f64,
    #[command(flatten)]
    display: DisplayArguments,
    /// Reports as JSON on standard output
    #[arg(long)]
    json: bool,
}

fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let Arguments { input, output, triangles: most, json, .. } = arguments;
    let to_commands = output.extension().is_some_and(|e| e.eq_ignore_ascii_case("ps300"));
    if most.is_some() && (to_commands || Picture::is_picture(output)) {
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!("--triangles is for a mesh that is written")));
    }
    if !arguments.display.is_empty() && !Picture::is_picture(input) {
        let message = "--exposure, --tone, --white and --bloom are for a picture";
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
    }
    if Picture::is_picture(input) {
        let destination = Picture::destination(output)?;
        let mut picture = Picture::read(input)?;
        if !arguments.display.is_empty() {
            picture = shown(&picture, output, &arguments.display)?;
        }
        picture.write(&destination)?;
        if *json {
            let known = serde_json::json!({ "file": output, "width": picture.width(), "height": picture.height() });
            output::report(known);
        } else {
            say!("{}: {} x {} pixels", output.display(), picture.width(), picture.height());
        }
        return Ok(());
    }
    if to_commands {
        return commands(arguments);
    }
    let destination = mesh::destination(output)?;
    // What is placed many times stays there once where the file can tell it.
    let is_placed = most.is_none() && mesh::Format::of(output).is_some_and(mesh::Format::has_places);
    let mut placed = match is_placed {
        true => placed(input, &arguments.definitions)?,
        false => PlacedMeshes { alone: triangles(input, &arguments.definitions)?, ..PlacedMeshes::default() },
    };
    if let Some(most) = most.filter(|most| *most < placed.alone.mesh.triangles.len()) {
        placed.alone = placed.alone.mesh.simplified(most).into();
    }
    if arguments.scale != 1.0 {
        let scale = DAffine3::from_scale(DVec3::splat(arguments.scale));
        placed.alone.mesh = placed.alone.mesh.transformed(&scale);
        placed.places = placed.places.within(&scale);
    }
    let instances = placed.places.count();
    if instances > 0 {
        mesh::write_placed(&placed, &destination)?;
    } else {
        mesh::write_grouped(&placed.alone, &destination)?;
    }
    let meshes = || std::iter::once(&placed.alone).chain(placed.repeated.iter().map(|repeated| &repeated.grouped));
    let vertices = meshes().map(|grouped| grouped.mesh.vertices.len()).sum::<usize>();
    let triangles = meshes().map(|grouped| grouped.mesh.triangles.len()).sum::<usize>();
    if *json {
        output::report(serde_json::json!({
            "file": output, "vertices": vertices, "triangles": triangles, "instances": instances,
        }));
    } else {
        let instances = output::of_instances(instances);
        say!("{}: {vertices} vertices, {triangles} triangles{instances}", output.display());
    }
    Ok(())
}

/// Writes the commands that build a scene on a PS 340.
fn commands(arguments: &Arguments) -> Result<(), CommandFailure> {
    let Arguments { input, definitions, output, json, lines, tolerance, .. } = arguments;
    let destination = Destination::of(output)?;
    let scene = load(&input.to_string_lossy(), definitions)?.scene;
    let prepared = Prepared::new(&scene)?;
    warn_of_short_scatters(&prepared);
    let drawing = Drawing { lines: *lines, tolerance: *tolerance, facets: true, ..Drawing::default() };
    let shown = InitialView::of(&prepared)
        .and_then(|initial| structure::commands(&scene, &initial, &prepared.subject(), &drawing))
        .map_err(|error| CommandFailure::new(Exit::Scene, error))?;
    let mut text = Vec::new();
    for command in std::iter::once(&structure::delete()).chain(&shown.commands) {
        print(command, &mut text);
        text.push(b'\n');
    }
    destination.write_or_save_elsewhere(|file| file.write_all(&text))?;
    let polygons = |command: &Command| match command {
        Command::Define { object: Node::Polygons(polygons), .. } => polygons.len(),
        _ => 0,
    };
    let polygons: usize = shown.commands.iter().map(polygons).sum();
    if *json {
        output::report(serde_json::json!({ "file": output, "polygons": polygons, "bytes": text.len() }));
    } else {
        say!("{}: {polygons} polygons, {} bytes", output.display(), text.len());
        shown.instances.iter().for_each(|instances| say!("{}", instances.describe()));
    }
    Ok(())
}

/// A picture of radiance as the arguments show it; what they do not say is as it is.
fn shown(picture: &Picture, output: &Path, arguments: &DisplayArguments) -> Result<Picture, CommandFailure> {
    if Picture::is_exr(output) {
        let message = "EXR files keep the radiance: --exposure, --tone, --white and --bloom are for PNG files";
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(message)));
    }
    let display = arguments.over(DisplayTransform::LINEAR)?;
    let stops = match display.exposure {
        Exposure::Stops(stops) => stops,
        Exposure::Auto { compensation } => stops_of_picture(picture, display.tone) + compensation,
    };
    Ok(display.shown(picture, stops, View::parallel_pixel_angle(picture.width(), picture.height()))?)
}

/// Reads a factor above 0.
fn factor(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok().filter(|factor| *factor > 0.0 && *factor < f64::INFINITY);
    factor.ok_or_else(|| "give a number above 0".to_string())
}

/// The meshes of a file, or of a whole scene, and where those are that are placed many times.
fn placed(input: &Path, definitions: &ScriptArguments) -> Result<PlacedMeshes, CommandFailure> {
    let scene = load(&input.to_string_lossy(), definitions)?.scene;
    Ok(match mesh::Format::of(input) {
        Some(_) => mesh::read_placed(input)?,
        None => scene.tessellated_once()?,
    })
}

/// The triangles of a mesh with their groups, or of a whole scene.
fn triangles(input: &Path, definitions: &ScriptArguments) -> Result<Grouped, CommandFailure> {
    let scene = load(&input.to_string_lossy(), definitions)?.scene;
    Ok(match mesh::Format::of(input) {
        Some(_) => mesh::read_grouped(input)?,
        None => scene.tessellated()?,
    })
}
