//! The process around the machine: opens the lines, and runs the thread that brings them and the machine together.

mod mirror;
mod turns;

pub use mirror::{ArcShown, Asked, FunctionShown, InputShown, Mirror, NodeShown, Passed, Shown};

use crate::{
    calligraphic::Drawer,
    line::{
        Address, Capture, Events, LineAddress, LineEvent, Listener, OperatorLine, Source, Surroundings,
        serve_operators, serve_stdio, serve_window,
    },
    machine::Settings,
};
use protocol::address::Place;
use std::{io, path::PathBuf, sync::Arc, time::Duration};
use tokio::sync::{mpsc, oneshot};
use turns::Turns;

/// Events that wait for the machine; with [`LineEvent::Bytes`] of a quarter megabyte this bounds memory.
const WAITING_EVENTS: usize = 16;

/// Where the time of the machine comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Clock {
    /// Sixty frames in each second of the wall clock.
    Real,
    /// Frames pass only while an operator waits for them, as fast as they can.
    Virtual,
}

/// Who gives orders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Operator {
    /// Nobody.
    None,
    /// Standard input; the machine ends with it.
    Stdio,
    /// Whoever connects.
    Socket(Address),
}

/// What the process is to do.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where hosts attach.
    pub listen: Vec<LineAddress>,
    /// A file that takes what passes on the host lines.
    pub capture: Option<PathBuf>,
    /// Who gives orders.
    pub operator: Operator,
    /// Where time comes from.
    pub clock: Clock,
    /// Of the machine.
    pub settings: Settings,
    /// Who writes the light of the vector screen.
    pub drawer: Drawer,
}

/// A window on the machine: it sees by a mirror, and gives orders as an operator does.
pub struct Window {
    /// What it shows.
    pub mirror: Arc<Mirror>,
    /// What it wants; the machine ends when the other end is gone.
    pub orders: std::sync::mpsc::Receiver<OperatorLine>,
}

/// Why the process ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// By the order `quit`, with the operator on standard input, or with the last host that could come.
    Quit,
    /// By a signal.
    Interrupted,
}

/// Runs the machine until its end.
///
/// A `window` sees and gives orders, if there is one. `ready` is told each address in use, as a line of text, before the first event is taken. Without an operator the
/// machine ends when all its lines are files or standard input, and these have ended.
///
/// # Errors
/// If it cannot listen, or cannot write the capture: the address or the file, and the reason.
pub fn run(options: &Options, window: Option<Window>, mut ready: impl FnMut(&str)) -> io::Result<End> {
    let (events, inbox) = mpsc::channel(WAITING_EVENTS);
    let io_runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let failed = |address: &dyn std::fmt::Display, e: io::Error| {
        io::Error::new(e.kind(), format!("cannot listen on {address}: {e}"))
    };
    let capture = options.capture.as_deref().map(|path| {
        let is_read = |line: &LineAddress| matches!(&line.place, Place::File { path: read, .. } if read == path);
        let created = match options.listen.iter().any(is_read) {
            true => Err(io::Error::new(io::ErrorKind::InvalidInput, "it is to be played")),
            false => Capture::create(path),
        };
        created.map_err(|e| io::Error::new(e.kind(), format!("capture {}: {e}", path.display())))
    });
    let capture = capture.transpose()?;
    let around = Surroundings { events: events.clone(), capture: capture.clone() };
    for address in &options.listen {
        let source = io_runtime.block_on(Source::open(address)).map_err(|e| failed(address, e))?;
        ready(&format!("ready line {}", source.address()?));
        io_runtime.spawn(source.serve(around.clone()));
    }
    drop(around);
    match &options.operator {
        Operator::None => {}
        Operator::Stdio => {
            let events = events.clone();
            std::thread::spawn(move || serve_stdio(&events));
        }
        Operator::Socket(address) => {
            let listener = io_runtime.block_on(Listener::bind(address)).map_err(|e| failed(address, e))?;
            ready(&format!("ready operator {}", listener.address()?));
            io_runtime.spawn(serve_operators(listener, events.clone()));
        }
    }
    let mirror = window.map(|Window { mirror, orders }| {
        let events = events.clone();
        std::thread::spawn(move || serve_window(orders, &events));
        mirror
    });
    let (stop, stopped) = oneshot::channel::<()>();
    let lines = std::thread::spawn(move || {
        io_runtime.block_on(async {
            tokio::spawn(watch_signals(events));
            let _ = stopped.await;
            // Replies and bytes that are on their way may still leave.
            tokio::time::sleep(Duration::from_millis(50)).await;
        });
        io_runtime.shutdown_background();
    });
    ready("ready");
    let end = Turns::new(options, mirror, capture.clone(), inbox)?.run();
    let _ = stop.send(());
    let _ = lines.join();
    if let Some(capture) = capture {
        capture.finish();
    }
    Ok(end)
}

async fn watch_signals(events: Events) {
    use tokio::signal::unix::{SignalKind, signal};
    let Ok(mut terminate) = signal(SignalKind::terminate()) else { return };
    tokio::select! {
        _ = tokio::signal::ctrl_c() => {}
        _ = terminate.recv() => {}
    }
    let _ = events.send(LineEvent::Interrupted).await;
}
