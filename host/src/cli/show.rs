//! `peris show`: a scene on a workstation, with dials and keys, until someone ends it.

use super::{Definitions, Exit, Failure, Row, SCRIPT_HELP, Waits, load_lit, progress};
use crate::{
    production::{Production, ProductionError, Sent, tiling},
    render::{Order, tiles::Tiling},
    scene::Scene,
    script::camera_call,
    workstation::{
        Drawing, Emulator, Lines, Patience, Session, WorkstationError,
        network::{KEY_PREFIX, KEYS, Key},
    },
};
use clap::{Args, FromArgMatches};
use files::Destination;
use protocol::address::Address;
use std::{
    io::{BufRead, Write},
    num::NonZeroUsize,
    path::PathBuf,
    sync::mpsc,
    time::{Duration, Instant},
};

pub(super) const ROW: Row = Row {
    name: "show",
    summary: "Shows a scene on a PS 340 with dials and keys: key 1 renders the view there, key 2 resets, key 3 tells the view as a line of a script, key 12 ends.",
    arguments: Arguments::augment_args,
    run: |matches| run(&Arguments::from_arg_matches(matches)?),
};

/// How long to wait for a message before looking for orders and Ctrl-C.
const GLANCE: Duration = Duration::from_millis(50);

#[derive(Args, Debug)]
struct Arguments {
    #[arg(help = SCRIPT_HELP, default_value = "teapot", value_name = "SCRIPT")]
    script: String,
    #[command(flatten)]
    definitions: Definitions,
    /// The host line of a PS 340 that runs already (tcp:HOST:PORT or unix:PATH); without it, one is started, with a window if
    /// there is a display, and the lines of standard input are orders for its operator ('help' lists them)
    #[arg(long, value_name = "LINE")]
    to: Option<Address>,
    /// Sends the scene and ends, without waiting for keys
    #[arg(long, requires = "to")]
    once: bool,
    /// Reports what was sent as JSON on standard output
    #[arg(long)]
    json: bool,
    /// Which edges are sent
    #[arg(long, value_enum, default_value = "grid")]
    lines: Lines,
    /// Edges that bend more than this are always sent, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = Drawing::default().crease_degrees)]
    crease: f64,
    /// Sends polygons, materials and lights instead of vectors; the machine renders them itself when a host or operator
    /// sends FIX(1) to FIX(8) to <1>PERIS.SHADE, such as FIX(4), hidden lines, and FIX(8), Phong
    #[arg(long)]
    facets: bool,
    /// Solves for the light that goes from diffuse surface to diffuse surface, and sends it as colours at the corners of
    /// polygons beside the vectors; the machine shades them on its raster screen whenever the dials have stood still
    #[arg(long, conflicts_with = "facets")]
    radiosity: bool,
    /// Distance between curved surfaces and the lines sent, as a part of the object's diagonal
    #[arg(long, value_name = "PART", default_value_t = Drawing::default().tolerance, value_parser = super::part)]
    tolerance: f64,
    /// Opens no window, even if there is a display: orders from standard input do all
    #[arg(long, conflicts_with = "to")]
    headless: bool,
    /// Threads that render [default: one for each core]
    #[arg(long, value_name = "COUNT", value_parser = super::threads)]
    threads: Option<NonZeroUsize>,
    /// Writes the line of a script that asks for the view into this file, when key 3 is pressed and in the end
    #[arg(long, value_name = "FILE", conflicts_with = "once")]
    camera: Option<PathBuf>,
    /// The folder below which orders such as 'picture vector a.png' write files
    #[arg(long, value_name = "DIR", default_value = ".", conflicts_with = "to")]
    files: PathBuf,
    #[command(flatten)]
    waits: Waits,
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    if !(0.0..=180.0).contains(&arguments.crease) {
        return Err(Failure::new(Exit::Usage, anyhow::anyhow!("--crease is an angle of 0 to 180 degrees")));
    }
    let file = arguments.camera.as_ref().map(Destination::of).transpose()?;
    let drawing = Drawing {
        lines: arguments.lines,
        crease_degrees: arguments.crease,
        tolerance: arguments.tolerance,
        facets: arguments.facets,
    };
    let scene = load_lit(&arguments.script, &arguments.definitions)?.scene;
    let light = if arguments.radiosity { Some(solve(&scene, arguments)?) } else { None };
    let patience = arguments.waits.patience();
    let (mut emulator, line) = match &arguments.to {
        Some(line) => (None, line.clone()),
        None => {
            let emulator = start(arguments, patience)?;
            let line = emulator.line().clone();
            (Some(emulator), line)
        }
    };
    let session = Session::attach(&line, patience)?;
    let mut production = Production::lit(&scene, session, &drawing, light.as_ref())?;
    report(arguments, &line, production.sent(), light.as_ref());
    if arguments.once {
        return Ok(());
    }
    for (number, label, _) in KEYS.iter().filter(|_| !arguments.json) {
        say!("key {number}: {label}");
    }
    let mut told = Told { file, is_quiet: arguments.json, last: String::new() };
    let served = serve(&mut production, &mut emulator, &scene, arguments, &mut told);
    let is_cut = matches!(&served, Err(failure) if failure.exit == Exit::Line);
    if is_cut && emulator.as_mut().is_some_and(|emulator| emulator.has_window() && emulator.has_quit()) {
        // Its window was closed.
        return Ok(());
    }
    served?;
    match told.tell(&mut production) {
        // It ends as it was asked to, whether the machine still answers or not.
        Err(failure) if failure.exit == Exit::Line => {
            super::warn(&format!("the view is not known: {}", failure.error));
            Ok(())
        }
        told => told,
    }
}

/// Starts a PS 340 of our own, with a window if there is a display to open it on.
fn start(arguments: &Arguments, patience: Patience) -> Result<Emulator, Failure> {
    let has_display =
        ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some_and(|d| !d.is_empty()));
    if has_display && !arguments.headless {
        match Emulator::start(patience, &arguments.files, true) {
            Ok(emulator) => return Ok(emulator),
            Err(error) => super::warn(&format!("{error}; it is started without a window")),
        }
    }
    Ok(Emulator::start(patience, &arguments.files, false)?)
}

/// The view as somebody was told of it.
struct Told {
    /// Where it is written, too.
    file: Option<Destination>,
    /// Whether nobody is told.
    is_quiet: bool,
    /// The line that was told last.
    last: String,
}

impl Told {
    /// Tells the view that is set now, unless that was told already.
    fn tell(&mut self, production: &mut Production) -> Result<(), Failure> {
        let Some(camera) = production.camera()? else {
            super::warn("no camera sees what is set: it is scaled unequally, or not seen at all");
            return Ok(());
        };
        let line = camera_call(&camera);
        if line == self.last {
            return Ok(());
        }
        if let Some(file) = &self.file {
            file.write_or_keep(|file| writeln!(file, "{line}"))?;
        }
        if !self.is_quiet {
            say!("{line}");
        }
        self.last = line;
        Ok(())
    }
}

/// Solves for the light of all surfaces.
fn solve(scene: &Scene, arguments: &Arguments) -> Result<Tiling, Failure> {
    super::warn_of_emptiness(scene);
    let light = tiling(scene, arguments.threads, &progress::watch())?;
    progress::clear();
    Ok(light)
}

/// Says what was sent.
fn report(arguments: &Arguments, line: &Address, sent: Sent, light: Option<&Tiling>) {
    let Sent { lines, points, seconds } = sent;
    let light = light.map(|light| (light.elements, light.tiles.len(), light.corners(), light.tolerance));
    if arguments.json {
        let light = light.map(|(elements, polygons, corners, tolerance)| {
            serde_json::json!({ "elements": elements, "polygons": polygons, "corners": corners, "tolerance": tolerance })
        });
        let line = line.to_string();
        let known =
            serde_json::json!({ "line": line, "vectors": lines, "points": points, "light": light, "seconds": seconds });
        return say!("{known}");
    }
    say!("{lines} vectors ({points} points) shown on {line} after {seconds:.3} s");
    if let Some((elements, polygons, corners, tolerance)) = light {
        let steps = tolerance * 255.0;
        say!(
            "the light of {elements} elements as {polygons} polygons ({corners} corners), {steps:.1} of 255 off at most"
        );
    }
}

/// Carries out keys of the workstation and, if it is ours, orders from standard input.
fn serve(
    production: &mut Production,
    emulator: &mut Option<Emulator>,
    scene: &Scene,
    arguments: &Arguments,
    told: &mut Told,
) -> Result<(), Failure> {
    let mut orders = emulator.as_ref().map(|_| read_orders());
    let mut unanswered = 0_u64;
    // When it was last seen at work on an order.
    let mut at_work = Instant::now();
    loop {
        let given = orders.as_ref().map(mpsc::Receiver::try_recv);
        if let (Some(given), Some(emulator)) = (given, emulator.as_mut()) {
            match given {
                Ok(order) if order == "quit" => return Ok(()),
                Ok(order) => {
                    emulator.give(&order)?;
                    at_work = if unanswered == 0 { Instant::now() } else { at_work };
                    unanswered += 1;
                }
                Err(mpsc::TryRecvError::Empty) => {}
                // With a window, somebody else gives orders. Without one, the end of the orders is the end, once all are
                // answered.
                Err(mpsc::TryRecvError::Disconnected) if emulator.has_window() => orders = None,
                Err(mpsc::TryRecvError::Disconnected) if unanswered == 0 => return Ok(()),
                Err(mpsc::TryRecvError::Disconnected) => {}
            }
        }
        if let Some(emulator) = emulator.as_mut()
            && let Some(reply) = emulator.reply()?
        {
            unanswered -= 1;
            at_work = Instant::now();
            say!("{}", reply.replace("\\n", "\n"));
        }
        let session = production.session();
        if unanswered > 0 && at_work.elapsed() > session.patience().order {
            // Orders such as 'frames 10000' take their time; a machine that lives answers its hosts meanwhile.
            session.synchronize()?;
            at_work = Instant::now();
        }
        let message = match session.message(GLANCE, "a key") {
            Ok(message) => message,
            Err(WorkstationError::Silent { .. }) => continue,
            Err(error) => return Err(error.into()),
        };
        let number = message.strip_prefix(KEY_PREFIX.as_bytes()).and_then(|n| std::str::from_utf8(n).ok());
        let number = number.and_then(|n| n.trim().parse::<i32>().ok());
        let key = KEYS.iter().find(|row| Some(row.0) == number).map(|row| row.2);
        match key {
            Some(Key::Render) => render(production, scene, arguments.threads)?,
            Some(Key::Reset) => production.reset()?,
            Some(Key::Camera) => told.tell(production)?,
            Some(Key::End) => return Ok(()),
            None => say!("message: {}", String::from_utf8_lossy(&message)),
        }
    }
}

fn render(production: &mut Production, scene: &Scene, threads: Option<NonZeroUsize>) -> Result<(), Failure> {
    let matrix = production.view()?;
    let order = Order { threads, ..Order::of(&scene.settings) };
    let shot = production.render(&matrix, &order, &scene.display, &progress::watch());
    progress::clear();
    match shot {
        Ok(shot) => {
            production.show_image(&shot.shown)?;
            say!("rendered in {:.3} s, exposed by {:+.2} stops", shot.rendering.seconds, shot.stops);
        }
        // The person at the dials may have set a view that shows nothing; that ends nothing.
        Err(ProductionError::Render(error)) => say!("not rendered: {error}"),
        Err(error) => return Err(error.into()),
    }
    Ok(())
}

/// The lines of standard input, read by a thread of their own.
fn read_orders() -> mpsc::Receiver<String> {
    let (sender, orders) = mpsc::channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            let order = line.trim().to_string();
            if !order.is_empty() && sender.send(order).is_err() {
                return;
            }
        }
    });
    orders
}
