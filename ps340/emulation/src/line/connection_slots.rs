//! Connection slots of a listening socket: a peer that has never sent anything gives way to one that comes later.

use super::listener::SocketStream;
use std::{
    collections::VecDeque,
    sync::{
        Arc, Weak,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};
use tokio::{
    io::{AsyncReadExt, AsyncWriteExt},
    sync::{Notify, OwnedSemaphorePermit, Semaphore},
    time::timeout,
};

/// How long a new connection waits until a silent peer has left.
const LEAVING_TIME: Duration = Duration::from_millis(700);
/// How long a rejected peer may take to read why.
const REJECTION_TIME: Duration = Duration::from_secs(1);
/// Rejections that are explained at the same time; of a crowd, not all are.
const MAX_REJECTIONS: usize = 64;

/// What is known of an attached peer, shared by those who serve it and those who want its slot.
#[derive(Debug, Default)]
pub(super) struct Presence {
    has_sent: AtomicBool,
    leave: Notify,
}

impl Presence {
    /// The peer has sent something that counts: nobody takes its slot.
    pub(super) fn note_sent(&self) {
        self.has_sent.store(true, Ordering::Relaxed);
    }

    /// Waits until the peer is evicted, since somebody else wants its slot.
    pub(super) async fn is_evicted(&self) {
        self.leave.notified().await;
    }
}

/// A connection slot that is taken until this is dropped.
#[derive(Debug)]
pub(super) struct ConnectionSlot {
    pub(super) presence: Arc<Presence>,
    _taken: OwnedSemaphorePermit,
}

/// The connection slots of a socket.
#[derive(Debug)]
pub(super) struct ConnectionSlots {
    free: Arc<Semaphore>,
    rejections: Arc<Semaphore>,
    /// The text that a rejected peer reads.
    full: Arc<str>,
    /// The peers in the order of their arrival; some have gone.
    peers: VecDeque<Weak<Presence>>,
}

impl ConnectionSlots {
    /// - `count`: peers that may be attached at once.
    /// - `full`: the text that one more reads.
    pub(super) fn new(count: usize, full: &str) -> ConnectionSlots {
        let rejections = Arc::new(Semaphore::new(MAX_REJECTIONS));
        ConnectionSlots { free: Arc::new(Semaphore::new(count)), rejections, full: full.into(), peers: VecDeque::new() }
    }

    /// Admits a new connection, if there is a slot; else sends the reason, and closes the connection.
    pub(super) async fn admit(
        &mut self,
        stream: Box<dyn SocketStream>,
        peer: &str,
    ) -> Option<(Box<dyn SocketStream>, ConnectionSlot)> {
        if let Some(place) = self.take().await {
            return Some((stream, place));
        }
        tracing::warn!("{peer} was turned away: {}", self.full.trim_end());
        if let Ok(rejection) = self.rejections.clone().try_acquire_owned() {
            tokio::spawn(reject(stream, self.full.clone(), rejection));
        }
        None
    }

    /// A slot for a new connection, if need be that of the peer that has been silent for longest. None if all have sent
    /// something.
    async fn take(&mut self) -> Option<ConnectionSlot> {
        self.peers.retain(|visitor| visitor.strong_count() > 0);
        let taken = match self.free.clone().try_acquire_owned() {
            Ok(taken) => taken,
            Err(_) => {
                let silent = |visitor: &Arc<Presence>| !visitor.has_sent.load(Ordering::Relaxed);
                let visitor = self.peers.iter().filter_map(Weak::upgrade).find(silent)?;
                visitor.leave.notify_one();
                timeout(LEAVING_TIME, self.free.clone().acquire_owned()).await.ok()?.ok()?
            }
        };
        let presence = Arc::<Presence>::default();
        self.peers.push_back(Arc::downgrade(&presence));
        Some(ConnectionSlot { presence, _taken: taken })
    }
}

/// Sends a rejected peer the reason, and closes the connection.
async fn reject(mut stream: Box<dyn SocketStream>, text: Arc<str>, _rejection: OwnedSemaphorePermit) {
    let said = async {
        stream.write_all(text.as_bytes()).await?;
        stream.shutdown().await?;
        // With bytes that were not read, the system would close so that the other side does not read either.
        let mut unread = [0; 4096];
        while stream.read(&mut unread).await? > 0 {}
        std::io::Result::Ok(())
    };
    // The connection closes, whether it was read or not.
    let _ = timeout(REJECTION_TIME, said).await;
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAX_HOSTS: usize = 5;
    const FULL: &str = "It is full.\r\n";

    fn run<T>(test: impl Future<Output = T>) -> T {
        tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap().block_on(test)
    }

    /// Holds a slot until it is evicted.
    fn sit(place: ConnectionSlot) -> tokio::task::JoinHandle<()> {
        tokio::spawn(async move {
            place.presence.is_evicted().await;
            drop(place);
        })
    }

    #[test]
    fn the_oldest_silent_host_gives_way() {
        run(async {
            let mut places = ConnectionSlots::new(MAX_HOSTS, FULL);
            let mut hosts = Vec::new();
            for number in 0..MAX_HOSTS {
                let place = places.take().await.expect("there is room");
                if number == 0 {
                    place.presence.note_sent();
                }
                hosts.push(sit(place));
            }
            let newcomer = places.take().await.expect("a silent host leaves");
            hosts.remove(1).await.expect("it leaves");
            assert!(hosts.iter().all(|host| !host.is_finished()));
            drop(newcomer);
        });
    }

    #[test]
    fn hosts_that_have_spoken_keep_their_places() {
        run(async {
            let mut places = ConnectionSlots::new(MAX_HOSTS, FULL);
            let mut hosts = Vec::new();
            for _ in 0..MAX_HOSTS {
                let place = places.take().await.expect("there is room");
                place.presence.note_sent();
                hosts.push(place);
            }
            assert!(places.take().await.is_none());
            hosts.pop();
            assert!(places.take().await.is_some());
        });
    }

    #[test]
    fn one_who_is_turned_away_reads_why_and_then_the_end() {
        run(async {
            let mut places = ConnectionSlots::new(0, FULL);
            let (near, mut far) = tokio::io::duplex(1024);
            assert!(places.admit(Box::new(near), "one").await.is_none());
            far.write_all(b"INITIALIZE;").await.unwrap();
            let mut text = String::new();
            far.read_to_string(&mut text).await.unwrap();
            assert_eq!(text, "It is full.\r\n");
            drop(far);
        });
    }
}
