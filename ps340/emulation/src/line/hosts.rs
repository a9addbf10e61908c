//! Host lines: whatever arrives goes to the machine, and back, as the conditions of the line allow.

use super::{
    Interface, LineContext, LineEvent, LineId,
    conditions::{Flow, INPUT_QUEUE, XOFF, XON, leave},
    connection_slots::Presence,
    http,
    pace::Pace,
    writer::{OutputQueue, Writer},
};
use protocol::{address::Conditions, capture::Event};
use std::{io, sync::Arc};
use tokio::{
    io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt},
    sync::watch,
    time::{Instant, sleep_until},
};

/// Hosts that may be attached to a socket at once; each may hold an open statement and an open vector list.
pub const MAX_HOSTS: usize = 64;
/// Bytes taken from a line at a time: so few that an operator command after all that waits is carried out soon.
const READ_BYTES: usize = 64 << 10;

/// The transport to a host that is not there: what is sent to it is captured, and that is all. Needs a tokio runtime.
pub(super) fn silent_writer(line: LineId, around: LineContext) -> Writer {
    let (writer, mut waiting) = Writer::new();
    tokio::spawn(async move {
        while let Some(bytes) = waiting.next().await {
            around.tap(line, || Event::ToHost(bytes));
        }
    });
    writer
}

/// A host that attaches.
#[derive(Debug)]
pub(super) struct Host {
    /// Who, for messages.
    pub(super) peer: String,
    /// Its protocol.
    pub(super) interface: Interface,
    /// How its line behaves.
    pub(super) conditions: Conditions,
    /// Whether it can close its side and still receive what it asked for.
    pub(super) half_closes: bool,
    /// Whether it has sent something, and whether somebody else wants its connection slot.
    pub(super) presence: Arc<Presence>,
    /// Whether it may be a page in a browser, which sends HTTP.
    pub(super) may_be_browser: bool,
}

/// How a line ended.
enum End {
    /// The host closed its side, or the line failed.
    Closed(Option<io::Error>),
    /// The machine wants no more of it.
    Dropped(&'static str),
}

impl Host {
    /// A host that sends text and packets, on a line that closes in each direction by itself.
    pub(super) fn stream(peer: String, conditions: Conditions) -> Host {
        Host {
            peer,
            interface: Interface::Stream,
            conditions,
            half_closes: true,
            presence: Arc::default(),
            may_be_browser: false,
        }
    }
}

/// Serves a host until it has closed its side and received everything, or is evicted from its slot.
pub(super) async fn serve(
    stream: impl AsyncRead + AsyncWrite + Send + Unpin + 'static,
    host: Host,
    around: LineContext,
) {
    let line = super::next_line();
    let (read, write) = tokio::io::split(stream);
    let (writer, waiting) = Writer::new();
    if !around.attach(line, host.peer.clone(), host.interface, writer).await {
        return;
    }
    let (flow, followed) = watch::channel(Flow::default());
    let sender = Sender { write, line, conditions: host.conditions, flow: followed, around: around.clone() };
    let mut sending = tokio::spawn(sender.run(waiting));
    let presence = &host.presence;
    let end = tokio::select! {
        end = receive(read, line, &host, &flow, &around) => end,
        () = presence.is_evicted() => End::Dropped("it never spoke, and its place was wanted"),
    };
    // Without the receiver, nothing that the host holds can be released.
    drop(flow);
    if !host.half_closes || matches!(end, End::Dropped(_)) {
        sending.abort();
    }
    let error = match end {
        End::Closed(error) => error,
        End::Dropped(reason) => Some(io::Error::other(reason)),
    };
    around.close(line, error).await;
    // The machine drops its writer when it sees the end; what is queued is still written.
    tokio::select! {
        _ = &mut sending => {}
        () = presence.is_evicted() => sending.abort(),
    }
}

/// Takes what the host sends, until the line ends.
async fn receive(
    mut read: impl AsyncRead + Unpin,
    line: LineId,
    host: &Host,
    flow: &watch::Sender<Flow>,
    around: &LineContext,
) -> End {
    let conditions = host.conditions;
    let mut requests = http::RequestDetector::default();
    let begin = Instant::now();
    let mut pace = Pace::new(conditions.speed);
    let most = if conditions.flow { INPUT_QUEUE / 4 } else { READ_BYTES };
    let piece = pace.piece().unwrap_or(most).min(most);
    let limit = if conditions.flow { INPUT_QUEUE } else { READ_BYTES };
    // What waits for the machine; what is still on its way; when the latter has passed.
    let (mut queue, mut arriving, mut at) = (Vec::new(), Vec::with_capacity(piece), begin);
    let (mut open, mut end) = (true, End::Closed(None));
    while open || !arriving.is_empty() || !queue.is_empty() {
        tokio::select! {
            result = read.read_buf(&mut arriving), if open && arriving.is_empty() && queue.len() < limit => match result {
                Ok(0) => open = false,
                Ok(count) => {
                    host.presence.note_sent();
                    at = begin + pace.pass(count, begin.elapsed());
                    if host.may_be_browser && requests.finds_request(&mut arriving) {
                        (open, end) = (false, End::Dropped("it speaks HTTP, as a page in a browser does"));
                    }
                }
                Err(reason) => (open, end) = (false, End::Closed(Some(reason))),
            },
            () = sleep_until(at), if !arriving.is_empty() && conditions.speed.is_some() => {
                take_in(&mut arriving, piece, &mut queue, conditions, flow);
            }
            permit = around.events.reserve(), if !queue.is_empty() => {
                let Ok(permit) = permit else { return end };
                let bytes = std::mem::take(&mut queue);
                around.tap(line, || Event::FromHost(bytes.clone()));
                permit.send(LineEvent::Bytes(line, bytes));
            }
        }
        if conditions.speed.is_none() && !arriving.is_empty() {
            take_in(&mut arriving, piece, &mut queue, conditions, flow);
        }
        let waiting = queue.len();
        flow.send_if_modified(|flow| {
            let before = *flow;
            flow.waiting(conditions, waiting);
            *flow != before
        });
    }
    end
}

/// Moves what has arrived into the queue of the machine.
fn take_in(
    arriving: &mut Vec<u8>,
    piece: usize,
    queue: &mut Vec<u8>,
    conditions: Conditions,
    flow: &watch::Sender<Flow>,
) {
    let mut bytes = std::mem::replace(arriving, Vec::with_capacity(piece));
    flow.send_if_modified(|flow| {
        let before = *flow;
        flow.receive(conditions, &mut bytes);
        *flow != before
    });
    if queue.is_empty() {
        *queue = bytes;
    } else {
        queue.extend_from_slice(&bytes);
    }
}

/// Sends to a host.
struct Sender<W> {
    write: W,
    line: LineId,
    conditions: Conditions,
    flow: watch::Receiver<Flow>,
    around: LineContext,
}

impl<W: AsyncWrite + Unpin> Sender<W> {
    async fn run(mut self, mut waiting: OutputQueue) {
        let begin = Instant::now();
        let mut pace = Pace::new(self.conditions.speed);
        let (mut bytes, mut sent) = (Vec::new(), 0);
        // Whether the host was asked to stop, and whether the receiver of the line is still there.
        let (mut stopped, mut followed) = (false, true);
        loop {
            let flow = if followed { *self.flow.borrow_and_update() } else { Flow::default() };
            if flow.machine_holds != stopped {
                stopped = flow.machine_holds;
                if self.write.write_all(&[if stopped { XOFF } else { XON }]).await.is_err() {
                    return;
                }
            }
            if sent == bytes.len() || flow.host_holds {
                tokio::select! {
                    changed = self.flow.changed(), if followed => followed = changed.is_ok(),
                    next = waiting.next(), if sent == bytes.len() => match next {
                        Some(next) => {
                            (bytes, sent) = (next, 0);
                            leave(self.conditions, &mut bytes);
                            if bytes.is_empty() { continue }
                        }
                        None => break,
                    },
                }
                continue;
            }
            let piece = &bytes[sent..bytes.len().min(sent.saturating_add(pace.piece().unwrap_or(usize::MAX)))];
            if self.write.write_all(piece).await.is_err() {
                return;
            }
            self.around.tap(self.line, || Event::ToHost(piece.to_vec()));
            sent += piece.len();
            if self.conditions.speed.is_some() {
                sleep_until(begin + pace.pass(piece.len(), begin.elapsed())).await;
            }
        }
        // The host may be gone already.
        let _ = self.write.shutdown().await;
    }
}

#[cfg(test)]
mod tests;
