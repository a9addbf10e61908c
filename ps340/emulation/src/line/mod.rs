//! The shell that moves bytes: host lines over sockets, terminals, standard streams and files, and text lines for
//! operators.

mod pace;
mod http;
mod token;
mod conditions;
mod capture;
mod listener;
mod terminal;
mod writer;
mod connection_slots;
mod hosts;
mod replay;
mod endpoint;
mod operator;

pub use crate::port::LineId;
pub use capture::Capture;
pub use endpoint::HostEndpoint;
pub use hosts::MAX_HOSTS;
pub use listener::{AllowedPeers, Listener, SocketFile};
pub use operator::{OperatorLine, Reply, serve_operators, serve_stdio, serve_window};
pub use protocol::address::{Address, AddressError, LineAddress};
pub use terminal::{PseudoTerminal, open_serial};
pub use token::{TOKEN_VARIABLE, Token};
pub use writer::{MAX_WAITING_BYTES, Writer};

use protocol::capture::Event;
use std::{
    io,
    sync::atomic::{AtomicU64, Ordering},
};
use tokio::sync::mpsc;

/// A number of a line that was not used before in this process.
fn next_line() -> LineId {
    static NEXT_LINE: AtomicU64 = AtomicU64::new(1);
    LineId(NEXT_LINE.fetch_add(1, Ordering::Relaxed))
}

/// What a host line carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// Text and packets.
    Stream,
    /// The words and blocks of the parallel interface.
    Parallel,
}

/// The events that the lines send to the machine's thread.
#[derive(Debug)]
pub enum LineEvent {
    /// A host attached.
    Attached {
        /// Its line.
        line: LineId,
        /// Who, for messages.
        peer: String,
        /// Its protocol.
        interface: Interface,
        /// Where bytes for it go.
        writer: Writer,
    },
    /// Bytes from a host.
    Bytes(LineId, Vec<u8>),
    /// A host line closed.
    Closed {
        /// The line that closed.
        line: LineId,
        /// The reason, if it is not a plain end.
        error: Option<io::Error>,
    },
    /// An endpoint from which all hosts have gone and to which no other will attach: standard input, or a file.
    SourceEnded,
    /// An operator's line of text, which wants one line of reply.
    Operator(OperatorLine),
    /// The operator on standard input, or at the window, is gone.
    OperatorGone,
    /// The process was asked to end.
    Interrupted,
}

/// The channel into the machine's thread. It is bounded: when the machine is slower than a host, that host waits.
pub type Events = mpsc::Sender<LineEvent>;

/// The context of a line: the machine's thread, and the capture.
#[derive(Clone, Debug)]
pub struct LineContext {
    /// The channel into the machine's thread.
    pub events: Events,
    /// Takes what passes, if a capture is requested.
    pub capture: Option<Capture>,
}

impl LineContext {
    /// Sends an event to the machine's thread; false if that is gone.
    async fn send(&self, event: LineEvent) -> bool {
        self.events.send(event).await.is_ok()
    }

    fn tap(&self, line: LineId, event: impl FnOnce() -> Event) {
        if let Some(capture) = &self.capture {
            capture.record(line, event());
        }
    }

    async fn attach(&self, line: LineId, peer: String, interface: Interface, writer: Writer) -> bool {
        self.tap(line, || Event::Open(peer.clone()));
        self.send(LineEvent::Attached { line, peer, interface, writer }).await
    }

    async fn receive(&self, line: LineId, bytes: Vec<u8>) -> bool {
        self.tap(line, || Event::FromHost(bytes.clone()));
        self.send(LineEvent::Bytes(line, bytes)).await
    }

    async fn close(&self, line: LineId, error: Option<io::Error>) -> bool {
        self.tap(line, || Event::Close);
        self.send(LineEvent::Closed { line, error }).await
    }
}
