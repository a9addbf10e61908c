//! Files as hosts: a plain file is sent as it is, a capture is played again.

use super::{
    Interface, LineContext, LineEvent, LineId, OperatorLine,
    hosts::{Host, MAX_HOSTS, serve, silent_writer},
};
use protocol::{
    address::Conditions,
    capture::{CaptureReader, Event, HEADER, Record, is_capture},
};
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, Read},
    path::Path,
    time::Duration,
};
use tokio::{
    io::{AsyncWrite, AsyncWriteExt},
    sync::{mpsc, oneshot},
    time::{Instant, sleep_until},
};

/// Bytes read from a file at a time.
const READ_BYTES: usize = 64 << 10;
/// Latest time in a capture that is waited for: a year. Ours.
const MAX_MICROS: u64 = 365 * 24 * 3600 * 1_000_000;
/// How the names of hosts on the parallel interface begin, so that a capture distinguishes them from others.
pub(super) const PARALLEL: &str = "parallel:";
/// Chunks that are read ahead.
const READ_AHEAD: usize = 4;

/// The chunks of something that is read by a thread of its own, so that a slow file stops no line.
pub(super) fn pieces(mut from: impl Read + Send + 'static) -> mpsc::Receiver<io::Result<Vec<u8>>> {
    let (sender, receiver) = mpsc::channel(READ_AHEAD);
    std::thread::spawn(move || {
        loop {
            let mut buffer = vec![0; READ_BYTES];
            let read = match from.read(&mut buffer) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                read => read,
            };
            let piece = match read {
                Ok(0) => return,
                Ok(count) => {
                    buffer.truncate(count);
                    Ok(buffer)
                }
                Err(error) => Err(error),
            };
            let failed = piece.is_err();
            if sender.blocking_send(piece).is_err() || failed {
                return;
            }
        }
    });
    receiver
}

/// Sends a file as a host, or as the hosts that were captured in it, which then leave.
pub(super) async fn replay(path: &Path, file: File, timed: bool, conditions: Conditions, around: LineContext) {
    let peer = format!("file:{}", path.display());
    let mut pieces = pieces(file);
    let mut beginning = Vec::new();
    while beginning.len() <= HEADER.len() {
        match next_piece(&peer, &mut pieces).await {
            Some(piece) => beginning.extend(piece),
            None => break,
        }
    }
    if is_capture(&beginning) {
        play(&peer, beginning, pieces, timed, around).await;
    } else {
        let (near, far) = tokio::io::duplex(READ_BYTES);
        let (mut answers, questions) = tokio::io::split(near);
        // Nobody reads what the machine answers.
        tokio::spawn(async move { tokio::io::copy(&mut answers, &mut tokio::io::sink()).await });
        let host = Host::stream(peer.clone(), conditions);
        tokio::join!(feed(&peer, beginning, pieces, questions), serve(far, host, around));
    }
}

/// Writes chunks, as they come, and then closes.
pub(super) async fn feed(
    peer: &str,
    beginning: Vec<u8>,
    mut pieces: mpsc::Receiver<io::Result<Vec<u8>>>,
    mut to: impl AsyncWrite + Unpin,
) {
    let mut piece = Some(beginning);
    while let Some(bytes) = piece {
        if to.write_all(&bytes).await.is_err() {
            break;
        }
        piece = next_piece(peer, &mut pieces).await;
    }
    // The other side may be gone already.
    let _ = to.shutdown().await;
}

/// The next chunk; none at the end, or where it cannot be read.
async fn next_piece(peer: &str, pieces: &mut mpsc::Receiver<io::Result<Vec<u8>>>) -> Option<Vec<u8>> {
    match pieces.recv().await? {
        Ok(piece) => Some(piece),
        Err(error) => {
            tracing::warn!("{peer}: {error}");
            None
        }
    }
}

/// Plays a capture: opens its lines, sends what their hosts sent, and closes them.
async fn play(
    peer: &str,
    beginning: Vec<u8>,
    mut pieces: mpsc::Receiver<io::Result<Vec<u8>>>,
    timed: bool,
    around: LineContext,
) {
    let mut reader = CaptureReader::default();
    let begin = Instant::now();
    let mut lines: BTreeMap<u64, LineId> = BTreeMap::new();
    let mut piece = Some(beginning);
    loop {
        let ended = piece.is_none();
        match piece {
            Some(bytes) => reader.push(&bytes),
            None => reader.finish(),
        }
        for read in reader.by_ref() {
            let record = match read {
                Ok(record) => record,
                Err(error) => {
                    tracing::warn!("{peer}: {error}");
                    continue;
                }
            };
            if timed {
                sleep_until(begin + Duration::from_micros(record.micros.min(MAX_MICROS))).await;
            }
            let sent = match record.event {
                Event::ToHost(_) => continue,
                Event::OperatorCommand(text) => {
                    // Nobody waits for the reply.
                    let (reply, _) = oneshot::channel();
                    around.send(LineEvent::Operator(OperatorLine { text, reply, is_replayed: true })).await
                }
                Event::Close => match lines.remove(&record.line) {
                    Some(line) => around.close(line, None).await,
                    None => continue,
                },
                Event::Open(_) | Event::FromHost(_) => {
                    let line = match lines.get(&record.line) {
                        Some(line) => *line,
                        None if lines.len() >= MAX_HOSTS => continue,
                        None => match open_line(peer, &record, &around).await {
                            Some(line) => *lines.entry(record.line).or_insert(line),
                            None => return,
                        },
                    };
                    match record.event {
                        Event::FromHost(bytes) => around.receive(line, bytes).await,
                        _ => true,
                    }
                }
            };
            if !sent {
                return;
            }
        }
        if ended {
            break;
        }
        piece = next_piece(peer, &mut pieces).await;
    }
    for line in lines.into_values() {
        around.close(line, None).await;
    }
}

/// Attaches a line of a capture to the machine; none if the machine has ended.
async fn open_line(peer: &str, record: &Record, around: &LineContext) -> Option<LineId> {
    let line = super::next_line();
    let (kind, interface) = interface(&record.event);
    let peer = format!("{kind}{peer} line {}", record.line);
    let writer = silent_writer(line, around.clone());
    around.attach(line, peer, interface, writer).await.then_some(line)
}

/// The protocol of a captured line, and how the names of such hosts begin.
fn interface(opened: &Event) -> (&'static str, Interface) {
    match opened {
        Event::Open(peer) if peer.starts_with(PARALLEL) => (PARALLEL, Interface::Parallel),
        _ => ("", Interface::Stream),
    }
}
