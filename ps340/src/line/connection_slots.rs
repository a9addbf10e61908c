//! Places at a listening socket: a visitor who has never said anything gives way to one who comes later.

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

/// How long a newcomer waits until a silent visitor has left.
const LEAVING_TIME: Duration = Duration::from_millis(700);
/// How long one who is turned away may take to read why.
const REJECTION_TIME: Duration = Duration::from_secs(1);
/// Those who are told why at the same time; of a crowd, not everybody is.
const MAX_REJECTIONS: usize = 64;

/// What is known of a visitor who is there, shared by those who serve them and those who want the place.
#[derive(Debug, Default)]
pub(super) struct Presence {
    has_sent: AtomicBool,
    leave: Notify,
}

impl Presence {
    /// The visitor has said something that counts: nobody takes the place.
    pub(super) fn note_sent(&self) {
        self.has_sent.store(true, Ordering::Relaxed);
    }

    /// Waits until the place is wanted by somebody else.
    pub(super) async fn is_evicted(&self) {
        self.leave.notified().await;
    }
}

/// A place that is taken until this is dropped.
#[derive(Debug)]
pub(super) struct ConnectionSlot {
    pub(super) presence: Arc<Presence>,
    _taken: OwnedSemaphorePermit,
}

/// The places of a socket.
#[derive(Debug)]
pub(super) struct ConnectionSlots {
    free: Arc<Semaphore>,
    rejections: Arc<Semaphore>,
    /// What one who is turned away reads.
    full: Arc<str>,
    /// Who came, the first first; some have gone.
    peers: VecDeque<Weak<Presence>>,
}

impl ConnectionSlots {
    /// - `count`: visitors who may be there at once.
    /// - `full`: what one more reads.
    pub(super) fn new(count: usize, full: &str) -> ConnectionSlots {
        let rejections = Arc::new(Semaphore::new(MAX_REJECTIONS));
        ConnectionSlots { free: Arc::new(Semaphore::new(count)), rejections, full: full.into(), peers: VecDeque::new() }
    }

    /// Lets a newcomer in, if there is a place; else tells them why not, and closes the connection.
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

    /// A place for a newcomer, if need be that of the visitor who has been silent for longest. None if all have spoken.
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

/// Tells one who came in vain why, and closes the connection.
async fn reject(mut stream: Box<dyn SocketStream>, text: Arc<str>, _farewell: OwnedSemaphorePermit) {
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

    /// Holds a place until it is unwanted.
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
