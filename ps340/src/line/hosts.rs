//! Host lines: whatever arrives goes to the machine, and back.

use super::{Events, LineEvent, LineId, Listener};
use std::sync::{
    Arc,
    atomic::{AtomicU64, AtomicUsize, Ordering},
};
use tokio::{
    io::{AsyncReadExt, AsyncWriteExt},
    sync::{Semaphore, mpsc},
};

/// Bytes that wait for a host that does not read; what comes on top is dropped and counted.
pub const MAX_WAITING_BYTES: usize = 16 << 20;
/// Hosts that may be attached at once; each may hold an open statement and an open vector list.
pub const MAX_HOSTS: usize = 64;
/// Bytes taken from a socket at a time.
const READ_BYTES: usize = 256 << 10;

static NEXT_LINE: AtomicU64 = AtomicU64::new(1);

/// The way to a host.
#[derive(Clone, Debug)]
pub struct Writer {
    queue: mpsc::UnboundedSender<Vec<u8>>,
    waiting: Arc<AtomicUsize>,
}

impl Writer {
    /// Queues bytes for the host; returns false if they are dropped, because the host does not read.
    pub fn send(&self, bytes: Vec<u8>) -> bool {
        let size = bytes.len();
        if self.waiting.load(Ordering::Relaxed) + size > MAX_WAITING_BYTES {
            return false;
        }
        self.waiting.fetch_add(size, Ordering::Relaxed);
        self.queue.send(bytes).is_ok()
    }
}

/// Takes hosts in from a listener until the machine's thread is gone.
pub async fn serve_hosts(listener: Listener, events: Events) {
    let places = Arc::new(Semaphore::new(MAX_HOSTS));
    loop {
        match listener.accept().await {
            Ok((stream, peer)) => match places.clone().try_acquire_owned() {
                Ok(place) => {
                    let events = events.clone();
                    tokio::spawn(async move {
                        serve(stream, peer, events).await;
                        drop(place);
                    });
                }
                Err(_) => tracing::warn!("{peer} was turned away: {MAX_HOSTS} hosts are attached"),
            },
            Err(error) => {
                tracing::warn!("a host could not attach: {error}");
                tokio::time::sleep(std::time::Duration::from_millis(100)).await;
            }
        }
        if events.is_closed() {
            return;
        }
    }
}

async fn serve(stream: Box<dyn super::Stream>, peer: String, events: Events) {
    let line = LineId(NEXT_LINE.fetch_add(1, Ordering::Relaxed));
    let (mut read, mut write) = tokio::io::split(stream);
    let (queue, mut queued) = mpsc::unbounded_channel::<Vec<u8>>();
    let waiting = Arc::new(AtomicUsize::new(0));
    let writer = Writer { queue, waiting: waiting.clone() };
    if events.send(LineEvent::Attached { line, peer, writer }).await.is_err() {
        return;
    }
    let sending = tokio::spawn(async move {
        while let Some(bytes) = queued.recv().await {
            let sent = write.write_all(&bytes).await;
            waiting.fetch_sub(bytes.len(), Ordering::Relaxed);
            if sent.is_err() {
                return;
            }
        }
        let _ = write.shutdown().await;
    });
    let error = loop {
        let mut buffer = Vec::with_capacity(READ_BYTES);
        match read.read_buf(&mut buffer).await {
            Ok(0) => break None,
            Ok(_) => {
                if events.send(LineEvent::Bytes(line, buffer)).await.is_err() {
                    break None;
                }
            }
            Err(error) => break Some(error),
        }
    };
    let _ = events.send(LineEvent::Closed { line, error }).await;
    // The machine drops its writer when it sees the end; what is queued is still written.
    let _ = sending.await;
}
