//! Endpoints that hosts attach to: opens them, and serves whoever attaches.

use super::{
    Address, AllowedPeers, Interface, LineAddress, LineContext, LineEvent, Listener, PseudoTerminal,
    connection_slots::ConnectionSlots,
    hosts::{Host, MAX_HOSTS, serve},
    open_serial,
    replay::{PARALLEL, feed, pieces, replay},
    terminal::TerminalStream,
};
use protocol::address::{Conditions, Endpoint, Serial};
use std::{
    fs::File,
    io::{self, Write},
    os::fd::OwnedFd,
    path::PathBuf,
    time::Duration,
};
use tokio::{io::AsyncReadExt, sync::oneshot, time::sleep};

/// How often a pseudo-terminal is looked at until a host opens it.
const TERMINAL_PAUSE: Duration = Duration::from_millis(20);
/// How long to wait after a failure before the next try.
const FAILURE_PAUSE: Duration = Duration::from_millis(100);
/// How long to wait before a serial device is opened again.
const DEVICE_PAUSE: Duration = Duration::from_secs(1);
/// Bytes that are on their way to and from the standard streams.
const STANDARD_BYTES: usize = 64 << 10;

/// An endpoint that is open for hosts.
#[derive(Debug)]
pub struct HostEndpoint {
    kind: Kind,
    conditions: Conditions,
}

#[derive(Debug)]
enum Kind {
    Sockets(Listener, Interface),
    Pty(PseudoTerminal),
    Serial(Serial, OwnedFd),
    Stdio,
    File { path: PathBuf, file: File, timed: bool },
}

impl HostEndpoint {
    /// Opens an endpoint; needs a tokio runtime.
    ///
    /// # Errors
    /// Those of the system, e.g. the address is in use, or the file does not exist.
    pub async fn open(address: &LineAddress) -> io::Result<HostEndpoint> {
        let kind = match &address.endpoint {
            Endpoint::Socket(at) => Kind::Sockets(Listener::bind(at, AllowedPeers::All).await?, Interface::Stream),
            Endpoint::Parallel(at) => {
                let listener = Listener::bind(&Address::Tcp(at.clone()), AllowedPeers::All).await?;
                Kind::Sockets(listener, Interface::Parallel)
            }
            Endpoint::Pty(None) => Kind::Pty(PseudoTerminal::open()?),
            Endpoint::Pty(Some(_)) => {
                let text = "the system chooses the path; give pty: alone, or serial:PATH for a terminal that is there";
                return Err(io::Error::new(io::ErrorKind::InvalidInput, text));
            }
            Endpoint::Serial(serial) => Kind::Serial(serial.clone(), open_serial(serial)?),
            Endpoint::Stdio => Kind::Stdio,
            Endpoint::File { path, timed } => Kind::File { path: path.clone(), file: File::open(path)?, timed: *timed },
        };
        Ok(HostEndpoint { kind, conditions: address.conditions })
    }

    /// Where hosts find it: port 0 has become a real port, and a pseudo-terminal has a path.
    ///
    /// # Errors
    /// Those of the system.
    pub fn address(&self) -> io::Result<LineAddress> {
        let place = match &self.kind {
            Kind::Sockets(listener, interface) => match (listener.address()?, interface) {
                (Address::Tcp(at), Interface::Parallel) => Endpoint::Parallel(at),
                (address, _) => Endpoint::Socket(address),
            },
            Kind::Pty(terminal) => Endpoint::Pty(Some(terminal.path().into())),
            Kind::Serial(serial, _) => Endpoint::Serial(serial.clone()),
            Kind::Stdio => Endpoint::Stdio,
            Kind::File { path, timed, .. } => Endpoint::File { path: path.clone(), timed: *timed },
        };
        Ok(LineAddress { endpoint: place, conditions: self.conditions })
    }

    /// Whether other computers may reach it.
    pub fn is_public(&self) -> bool {
        matches!(&self.kind, Kind::Sockets(listener, _) if listener.is_public())
    }

    /// Serves hosts until no more can attach, which it reports, or until the machine's thread is gone.
    pub async fn serve(self, around: LineContext) {
        let HostEndpoint { kind, conditions } = self;
        match kind {
            Kind::Sockets(listener, interface) => serve_sockets(listener, interface, conditions, around).await,
            Kind::Pty(terminal) => serve_terminal(terminal, conditions, around).await,
            Kind::Serial(serial, device) => serve_device(serial, device, conditions, around).await,
            Kind::Stdio => {
                serve_standard_streams(conditions, around.clone()).await;
                around.send(LineEvent::SourceEnded).await;
            }
            Kind::File { path, file, timed } => {
                replay(&path, file, timed, conditions, around.clone()).await;
                around.send(LineEvent::SourceEnded).await;
            }
        }
    }
}

async fn serve_sockets(listener: Listener, interface: Interface, conditions: Conditions, around: LineContext) {
    let full = format!("The PS 340 is full: {MAX_HOSTS} hosts are attached. Come again when one has left.\r\n");
    let mut places = ConnectionSlots::new(MAX_HOSTS, &full);
    while !around.events.is_closed() {
        let (stream, peer) = match listener.accept().await {
            Ok(accepted) => accepted,
            Err(error) => {
                tracing::warn!("a host could not attach: {error}");
                sleep(FAILURE_PAUSE).await;
                continue;
            }
        };
        let Some((stream, place)) = places.admit(stream, &peer).await else { continue };
        let peer = match interface {
            Interface::Stream => peer,
            Interface::Parallel => format!("{PARALLEL}{peer}"),
        };
        let presence = place.presence.clone();
        let host = Host { interface, presence, may_be_browser: true, ..Host::stream(peer, conditions) };
        let around = around.clone();
        tokio::spawn(async move {
            serve(stream, host, around).await;
            drop(place);
        });
    }
}

/// A host attaches when it opens the pseudo-terminal, and leaves when it closes it; then the next one can come.
async fn serve_terminal(terminal: PseudoTerminal, conditions: Conditions, around: LineContext) {
    let peer = format!("pty:{}", terminal.path().display());
    while !around.events.is_closed() {
        match terminal.is_open().and_then(|open| if open { terminal.stream().map(Some) } else { Ok(None) }) {
            Ok(None) => sleep(TERMINAL_PAUSE).await,
            Ok(Some(stream)) => {
                let host = Host { half_closes: false, ..Host::stream(peer.clone(), conditions) };
                serve(stream, host, around.clone()).await;
                terminal.forget_output();
            }
            Err(error) => {
                tracing::warn!("{peer}: {error}");
                sleep(DEVICE_PAUSE).await;
            }
        }
    }
}

/// A serial device is one host that is always there; a device that fails is opened again when it is back.
async fn serve_device(serial: Serial, device: OwnedFd, conditions: Conditions, around: LineContext) {
    let peer = format!("serial:{}", serial.device.display());
    let mut opened = Ok(device);
    while !around.events.is_closed() {
        match opened.and_then(TerminalStream::new) {
            Ok(stream) => {
                let host = Host { half_closes: false, ..Host::stream(peer.clone(), conditions) };
                serve(stream, host, around.clone()).await;
            }
            Err(error) => tracing::debug!("{peer}: {error}"),
        }
        sleep(DEVICE_PAUSE).await;
        opened = open_serial(&serial);
    }
}

async fn serve_standard_streams(conditions: Conditions, around: LineContext) {
    let peer = "stdio:".to_string();
    let (near, far) = tokio::io::duplex(STANDARD_BYTES);
    let (mut answers, questions) = tokio::io::split(near);
    let runtime = tokio::runtime::Handle::current();
    let (done, finished) = oneshot::channel();
    // A reader that does not read stops this thread, and not the other lines.
    std::thread::spawn(move || {
        let mut buffer = vec![0; STANDARD_BYTES];
        while let Ok(count @ 1..) = runtime.block_on(answers.read(&mut buffer)) {
            let mut out = io::stdout().lock();
            if out.write_all(&buffer[..count]).and_then(|()| out.flush()).is_err() {
                break;
            }
        }
        let _ = done.send(());
    });
    let host = Host::stream(peer.clone(), conditions);
    let input = pieces(io::stdin());
    tokio::join!(feed(&peer, Vec::new(), input, questions), serve(far, host, around));
    let _ = finished.await;
}
