//! Signals that ask the process to end.

use std::io;
use tokio::signal::unix::{Signal, SignalKind, signal};

/// The signals that end the process: Ctrl-C, a request to terminate, and, unless it is to outlive its terminal, a
/// hang-up.
#[derive(Debug)]
pub(super) struct Signals {
    interrupt: Signal,
    terminate: Signal,
    hangup: Option<Signal>,
}

impl Signals {
    /// From now on these signals are only reported; needs a tokio runtime.
    ///
    /// # Errors
    /// Those of the system.
    pub(super) fn begin() -> io::Result<Signals> {
        let kind = SignalKind::hangup();
        let hangup = (!processes::is_ignored(kind.as_raw_value() as u32)).then(|| signal(kind));
        Ok(Signals {
            interrupt: signal(SignalKind::interrupt())?,
            terminate: signal(SignalKind::terminate())?,
            hangup: hangup.transpose()?,
        })
    }

    /// Waits for the next of them.
    pub(super) async fn next(&mut self) {
        let hangup = async {
            match &mut self.hangup {
                Some(hangup) => hangup.recv().await,
                None => std::future::pending().await,
            }
        };
        tokio::select! {
            _ = self.interrupt.recv() => {}
            _ = self.terminate.recv() => {}
            _ = hangup => {}
        }
    }
}
