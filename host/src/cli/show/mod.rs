//! `peris show`: a scene on a workstation, with dials and keys, until someone ends it.

mod arguments;
mod ready;
mod edits;
mod view_reporter;
mod serving;

use super::output::{self, warn};
use super::{CommandFailure, Exit, SubcommandRow, load, source};
use crate::{
    production::{Production, Sent},
    render::tiles::Tiling,
    script::Evaluated,
    workstation::{DrawnInstances, DrawnMotion, Emulator, Session, Timeouts, motion::MOTION_KEY, network::KEYS},
};
use arguments::ShowArguments;
use clap::{Args, FromArgMatches};
use edits::WatchedFiles;
use files::Destination;
use protocol::address::Address;
use ready::{flip_book, modelled};
use serving::Server;
use view_reporter::ViewReporter;

pub(super) const ROW: SubcommandRow = SubcommandRow {
    name: "show",
    summary: "Shows a scene on a PS 340 with dials and keys: key 1 renders the view there, key 4 stops that, key 2 resets, key 3 tells the view as a line of a script, key 5 stops what moves or lets it go on, key 12 ends.",
    arguments: ShowArguments::augment_args,
    run: |matches| run(&ShowArguments::from_arg_matches(matches)?),
};

fn run(arguments: &ShowArguments) -> Result<(), CommandFailure> {
    if !(0.0..=180.0).contains(&arguments.crease) {
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!("--crease is an angle of 0 to 180 degrees")));
    }
    if arguments.watch && source::file(&arguments.script).is_none() {
        let text = format!("--watch is for a file, and '{}' is a scene that ships", arguments.script);
        return Err(CommandFailure::new(Exit::Usage, anyhow::anyhow!(text)));
    }
    let file = arguments.camera.as_ref().map(Destination::of).transpose()?;
    let watched = arguments.watch.then(|| WatchedFiles::of(&arguments.script));
    let mut times = arguments.times();
    let first = times.as_mut().and_then(Iterator::next);
    let evaluated = match first {
        Some(time) => load(&arguments.script, &arguments.definitions.at(time))?,
        None => load(&arguments.script, &arguments.definitions)?,
    };
    if first.is_none() && evaluated.is_timed && evaluated.scene.motions.is_empty() {
        output::write_error(
            "the scene is a function of the time: --frames 0..48 shows it as a flip-book of two seconds",
        );
    }
    let camera = evaluated.scene.camera;
    let Evaluated { scene, files, .. } = source::lit(evaluated)?;
    let (model, light) = match times {
        Some(times) => (flip_book(&scene, times, arguments)?, None),
        None => modelled(&scene, arguments, None)?,
    };
    let edits = watched.map(|watched| edits::watch(arguments, watched, &files, camera, *model.initial()));
    let timeouts = arguments.waits.timeouts();
    let (mut emulator, line) = match &arguments.to {
        Some(line) => (None, line.clone()),
        None => {
            let emulator = start(arguments, timeouts)?;
            let line = emulator.line().clone();
            (Some(emulator), line)
        }
    };
    let session = Session::attach(&line, timeouts)?;
    let mut production = Production::show(model, session)?;
    report(arguments, &line, production.sent(), light.as_ref());
    if first.is_some() && production.sent().motion.is_none() {
        warn("nothing changes from picture to picture");
    }
    drop(light);
    if arguments.once {
        return Ok(());
    }
    let keys = KEYS.iter().map(|&(number, label, _)| (number, label));
    let keys = keys.chain(production.sent().motion.map(|_| MOTION_KEY));
    for (number, label) in keys.filter(|_| !arguments.json) {
        say!("key {number}: {label}");
    }
    let mut told = ViewReporter::new(file, arguments.json);
    let served = Server::new(&mut production, &mut emulator, arguments, &mut told, &scene).serve(edits.as_ref());
    let is_cut = matches!(&served, Err(failure) if failure.exit == Exit::Line);
    if is_cut && emulator.as_mut().is_some_and(|emulator| emulator.has_window() && emulator.has_quit()) {
        // Its window was closed.
        return Ok(());
    }
    served?;
    match told.report(&mut production) {
        // It ends as it was asked to, whether the machine still answers or not.
        Err(failure) if failure.exit == Exit::Line => {
            warn(&format!("the view is not known: {}", failure.error));
            Ok(())
        }
        told => told,
    }
}

/// Starts a PS 340 of our own, with a window if there is a display to open it on.
fn start(arguments: &ShowArguments, timeouts: Timeouts) -> Result<Emulator, CommandFailure> {
    let has_display =
        ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some_and(|d| !d.is_empty()));
    if has_display && !arguments.headless {
        match Emulator::start(timeouts, &arguments.files, true) {
            Ok(emulator) => return Ok(emulator),
            Err(error) => warn(&format!("{error}; it is started without a window")),
        }
    }
    Ok(Emulator::start(timeouts, &arguments.files, false)?)
}

/// Says what was sent.
fn report(arguments: &ShowArguments, line: &Address, sent: Sent, light: Option<&Tiling>) {
    let Sent { lines, points, instances, motion, seconds } = sent;
    let light = light.map(|light| (light.elements, light.tiles.len(), light.corners(), light.tolerance));
    if arguments.json {
        let light = light.map(|(elements, polygons, corners, tolerance)| {
            serde_json::json!({ "elements": elements, "polygons": polygons, "corners": corners, "tolerance": tolerance })
        });
        let line = line.to_string();
        let instances = instances.map(|DrawnInstances { count, drawn, lines }| {
            let [full, coarse, outlines, strokes] = drawn;
            serde_json::json!({
                "count": count, "full": full, "coarse": coarse, "outlines": outlines, "strokes": strokes, "vectors": lines,
            })
        });
        let motion = motion.map(|motion: DrawnMotion| {
            serde_json::json!({
                "objects": motion.objects, "motions": motion.motions, "pictures": motion.pictures,
                "period_seconds": motion.seconds(),
            })
        });
        let known = serde_json::json!({
            "line": line, "vectors": lines, "points": points, "instances": instances, "motion": motion, "light": light,
            "seconds": seconds,
        });
        return say!("{known}");
    }
    say!("{lines} vectors ({points} points) shown on {line} after {seconds:.3} s");
    instances.iter().for_each(|instances| say!("{}", instances.describe()));
    motion.iter().for_each(|motion| say!("{}", motion.describe()));
    if let Some((elements, polygons, corners, tolerance)) = light {
        let steps = tolerance * 255.0;
        say!(
            "the light of {elements} elements as {polygons} polygons ({corners} corners), {steps:.1} of 255 off at most"
        );
    }
}
