//! Places for hosts at a listening socket: a host that has never said anything gives way to one that comes later.

use super::listener::Stream;
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

/// Hosts that may be attached to a socket at once; each may hold an open statement and an open vector list.
pub const MAX_HOSTS: usize = 64;
/// How long a newcomer waits until a silent host has left.
const LEAVING_TIME: Duration = Duration::from_millis(700);
/// How long one who is turned away may take to read why.
const FAREWELL_TIME: Duration = Duration::from_secs(1);

/// What is known of a host that is there, shared by those who serve it and those who want its place.
#[derive(Debug, Default)]
pub(super) struct Presence {
    has_spoken: AtomicBool,
    leave: Notify,
}

impl Presence {
    /// The host has sent something: nobody takes its place.
    pub(super) fn note_speech(&self) {
        self.has_spoken.store(true, Ordering::Relaxed);
    }

    /// Waits until the place is wanted by somebody else.
    pub(super) async fn is_unwanted(&self) {
        self.leave.notified().await;
    }
}

/// A place that is taken until this is dropped.
#[derive(Debug)]
pub(super) struct Place {
    pub(super) presence: Arc<Presence>,
    _taken: OwnedSemaphorePermit,
}

/// The places of a socket.
#[derive(Debug)]
pub(super) struct Places {
    free: Arc<Semaphore>,
    /// Who came, the first first; some have gone.
    hosts: VecDeque<Weak<Presence>>,
}

impl Places {
    pub(super) fn new() -> Places {
        Places { free: Arc::new(Semaphore::new(MAX_HOSTS)), hosts: VecDeque::new() }
    }

    /// A place for a newcomer, if need be that of the host that has been silent for longest. None if all hosts have
    /// spoken.
    pub(super) async fn take(&mut self) -> Option<Place> {
        self.hosts.retain(|host| host.strong_count() > 0);
        let taken = match self.free.clone().try_acquire_owned() {
            Ok(taken) => taken,
            Err(_) => {
                let silent = |host: &Arc<Presence>| !host.has_spoken.load(Ordering::Relaxed);
                let host = self.hosts.iter().filter_map(Weak::upgrade).find(silent)?;
                host.leave.notify_one();
                timeout(LEAVING_TIME, self.free.clone().acquire_owned()).await.ok()?.ok()?
            }
        };
        let presence = Arc::<Presence>::default();
        self.hosts.push_back(Arc::downgrade(&presence));
        Some(Place { presence, _taken: taken })
    }
}

/// Tells one who came in vain why, and closes the connection.
pub(super) async fn turn_away(mut stream: Box<dyn Stream>) {
    let said = async {
        let text = format!("The PS 340 is full: {MAX_HOSTS} hosts are attached. Come again when one has left.\r\n");
        stream.write_all(text.as_bytes()).await?;
        stream.shutdown().await?;
        // With bytes that were not read, the system would close so that the other side does not read either.
        let mut unread = [0; 4096];
        while stream.read(&mut unread).await? > 0 {}
        std::io::Result::Ok(())
    };
    // The connection closes, whether it was read or not.
    let _ = timeout(FAREWELL_TIME, said).await;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run<T>(test: impl Future<Output = T>) -> T {
        tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap().block_on(test)
    }

    /// Holds a place until it is unwanted.
    fn sit(place: Place) -> tokio::task::JoinHandle<()> {
        tokio::spawn(async move {
            place.presence.is_unwanted().await;
            drop(place);
        })
    }

    #[test]
    fn the_oldest_silent_host_gives_way() {
        run(async {
            let mut places = Places::new();
            let mut hosts = Vec::new();
            for number in 0..MAX_HOSTS {
                let place = places.take().await.expect("there is room");
                if number == 0 {
                    place.presence.note_speech();
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
            let mut places = Places::new();
            let mut hosts = Vec::new();
            for _ in 0..MAX_HOSTS {
                let place = places.take().await.expect("there is room");
                place.presence.note_speech();
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
            let (near, mut far) = tokio::io::duplex(1024);
            let turning = tokio::spawn(turn_away(Box::new(near)));
            far.write_all(b"INITIALIZE;").await.unwrap();
            let mut text = String::new();
            far.read_to_string(&mut text).await.unwrap();
            assert!(text.starts_with("The PS 340 is full") && text.ends_with("\r\n"), "{text}");
            drop(far);
            turning.await.unwrap();
        });
    }
}
