//! The lines around the machine: opens them, serves them, and ends with the machine or a signal.

use super::{
    ExitReason, Mirror, Operator, Options,
    machine_loop::{MachineLoop, WAITING_EVENTS},
    signals::Signals,
};
use crate::line::{
    Address, AllowedPeers, Capture, Events, HostEndpoint, LineAddress, LineContext, LineEvent, Listener, OperatorLine,
    Token, serve_operators, serve_stdio, serve_window,
};
use files::Sandbox;
use protocol::address::Endpoint;
use std::{io, sync::Arc, time::Duration};
use tokio::sync::{mpsc, oneshot};

/// How long the machine may take to end after a signal.
const END_TIME: Duration = Duration::from_millis(500);
/// Exit code of a process that a signal ended.
pub const INTERRUPTED: i32 = 130;

/// A window on the machine: it sees by a mirror, and gives operator commands as an operator does.
pub struct Window {
    /// What it shows.
    pub mirror: Arc<Mirror>,
    /// What it wants; the machine ends when the other end is gone.
    pub operator_lines: std::sync::mpsc::Receiver<OperatorLine>,
}

/// What stands open before hosts and operators can come.
struct Opened {
    files: Sandbox,
    capture: Option<Capture>,
    sources: Vec<HostEndpoint>,
    operators: Option<(Listener, Option<Token>)>,
}

/// Runs the machine until its end.
///
/// A `window` sees and gives operator commands, if there is one. `ready` receives each address in use, as a line of
/// text, when signals are taken and before the first event is. Without an operator the machine ends when all its lines
/// are files or standard input, and these have ended.
///
/// # Errors
/// If it cannot listen, or cannot write the capture: the address or the file, and the reason.
pub fn run(options: &Options, window: Option<Window>, mut ready: impl FnMut(&str)) -> io::Result<ExitReason> {
    let (events, inbox) = mpsc::channel(WAITING_EVENTS);
    let io_runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    // Whatever is made from here on is cleaned up.
    let opened = io_runtime.block_on(async {
        let mut signals = Signals::begin()?;
        tokio::select! {
            opened = open(options) => opened.map(|opened| Some((signals, opened))),
            () = signals.next() => Ok(None),
        }
    });
    let Some((signals, Opened { files, capture, sources, operators })) = opened? else {
        // A name may still be looked up.
        io_runtime.shutdown_background();
        return Ok(ExitReason::Interrupted);
    };
    let around = LineContext { events: events.clone(), capture: capture.clone() };
    for source in sources {
        ready(&format!("ready line {}", source.address()?));
        io_runtime.spawn(source.serve(around.clone()));
    }
    drop(around);
    if options.operator == Operator::Stdio {
        let events = events.clone();
        std::thread::spawn(move || serve_stdio(&events));
    }
    if let Some((listener, token)) = operators {
        ready(&format!("ready operator {}", listener.address()?));
        if let Some(text) = token.as_ref().and_then(Token::unannounced) {
            ready(&format!("ready token {text}"));
        }
        io_runtime.spawn(serve_operators(listener, token, events.clone()));
    }
    let mirror = window.map(|Window { mirror, operator_lines: orders }| {
        let events = events.clone();
        std::thread::spawn(move || serve_window(orders, &events));
        mirror
    });
    let (stop, stopped) = oneshot::channel::<()>();
    let captured = capture.clone();
    let lines = std::thread::spawn(move || {
        let is_overdue = io_runtime.block_on(async {
            tokio::select! {
                () = is_overdue(signals, events) => true,
                _ = stopped => {
                    // Replies and bytes that are on their way may still leave.
                    tokio::time::sleep(Duration::from_millis(50)).await;
                    false
                }
            }
        });
        // The files of sockets go with what listens at them.
        io_runtime.shutdown_background();
        if is_overdue {
            end_at_once(captured.as_ref());
        }
    });
    ready("ready");
    let end = MachineLoop::new(options, files, mirror, capture.clone(), inbox)?.run();
    let _ = stop.send(());
    let _ = lines.join();
    if let Some(capture) = capture {
        capture.finish();
    }
    Ok(end)
}

/// Opens everything that the options name.
async fn open(options: &Options) -> io::Result<Opened> {
    let failed = |address: &dyn std::fmt::Display, e: io::Error| {
        io::Error::new(e.kind(), format!("cannot listen on {address}: {e}"))
    };
    let mut sources = Vec::new();
    for address in &options.listen {
        let source = HostEndpoint::open(address).await.map_err(|e| failed(address, e))?;
        check_public(options, source.is_public()).map_err(|e| failed(address, e))?;
        sources.push(source);
    }
    let operators = match &options.operator {
        Operator::Socket(address) => {
            let listener = Listener::bind(address, AllowedPeers::Owner).await.map_err(|e| failed(address, e))?;
            check_public(options, listener.is_public()).map_err(|e| failed(address, e))?;
            let token = matches!(address, Address::Tcp(_)).then(Token::begin);
            Some((listener, token.transpose()?))
        }
        Operator::None | Operator::Stdio => None,
    };
    let files = Sandbox::open(&options.files)
        .map_err(|e| io::Error::new(e.kind(), format!("--files {}: {e}", options.files.display())))?;
    // Last, without a wait after it: an interruption leaves no part of it.
    let capture = options.capture.as_deref().map(|path| {
        let is_read = |line: &LineAddress| matches!(&line.endpoint, Endpoint::File { path: read, .. } if read == path);
        let created = match options.listen.iter().any(is_read) {
            true => Err(io::Error::new(io::ErrorKind::InvalidInput, "it is to be played")),
            false => Capture::create(path),
        };
        created.map_err(|e| io::Error::new(e.kind(), format!("capture {}: {e}", path.display())))
    });
    let capture = capture.transpose()?;
    Ok(Opened { files, capture, sources, operators })
}

/// Refuses what other computers may reach, unless that was asked for.
fn check_public(options: &Options, is_public: bool) -> io::Result<()> {
    match (is_public, options.public) {
        (false, _) => Ok(()),
        (true, true) => {
            tracing::warn!("other computers may reach this machine: whoever does can use it");
            Ok(())
        }
        (true, false) => {
            let text = "other computers could reach it; --public allows that";
            Err(io::Error::new(io::ErrorKind::PermissionDenied, text))
        }
    }
}

/// Waits for a signal, asks the machine to end, and returns when that takes too long, or at the next signal.
async fn is_overdue(mut signals: Signals, events: Events) {
    signals.next().await;
    let asked = async {
        let _ = events.send(LineEvent::Interrupted).await;
        std::future::pending::<()>().await;
    };
    tokio::select! {
        () = asked => {}
        () = signals.next() => {}
        () = tokio::time::sleep(END_TIME) => {}
    }
}

/// Ends the process though the machine is busy.
fn end_at_once(capture: Option<&Capture>) {
    tracing::warn!("the machine is busy, and ends without finishing that");
    if let Some(capture) = capture {
        capture.finish();
    }
    // A picture on its way to its name gets there.
    let _naming = files::naming();
    std::process::exit(INTERRUPTED);
}
