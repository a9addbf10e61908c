//! The output to a host: bytes that wait until it reads, within a limit on the memory that they take.

use std::{
    collections::VecDeque,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};
use tokio::sync::Notify;

/// Bytes of memory in which messages wait for a host that does not read; what comes on top is dropped and counted.
pub const MAX_WAITING_BYTES: usize = 8 << 20;
/// Bytes that lie side by side: so many short messages share one piece of memory.
const BLOCK_BYTES: usize = 64 << 10;

/// The output to a host. When it is dropped, what still waits is sent, and then the end.
#[derive(Debug)]
pub struct Writer {
    shared: Arc<Shared>,
}

/// The other end of a [`Writer`].
#[derive(Debug)]
pub(super) struct OutputQueue {
    shared: Arc<Shared>,
    /// Memory of the block that was given out last: it counts until the next is asked for.
    lent_bytes: usize,
}

#[derive(Debug, Default)]
struct Shared {
    blocks: Mutex<Blocks>,
    changed: Notify,
}

#[derive(Debug, Default)]
struct Blocks {
    blocks: VecDeque<Vec<u8>>,
    /// Bytes of memory, those of the block that is being sent included.
    memory: usize,
    closed: bool,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Blocks> {
        // No thread panics while it holds the lock, but for want of memory.
        self.blocks.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Writer {
    /// An output to a host, and its other end.
    pub(super) fn new() -> (Writer, OutputQueue) {
        let shared = Arc::<Shared>::default();
        (Writer { shared: shared.clone() }, OutputQueue { shared, lent_bytes: 0 })
    }

    /// Lets bytes wait for the host; returns false if they are dropped, because the host does not read.
    pub fn send(&self, bytes: Vec<u8>) -> bool {
        let sent = self.shared.lock().add(bytes);
        self.shared.changed.notify_one();
        sent
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.shared.lock().closed = true;
        self.shared.changed.notify_one();
    }
}

impl Blocks {
    fn add(&mut self, mut bytes: Vec<u8>) -> bool {
        match self.blocks.back_mut() {
            Some(last) if last.len() + bytes.len() <= BLOCK_BYTES => {
                let more = BLOCK_BYTES.saturating_sub(last.capacity());
                if self.memory + more > MAX_WAITING_BYTES {
                    return false;
                }
                last.reserve_exact(BLOCK_BYTES - last.len());
                last.append(&mut bytes);
                self.memory += more;
            }
            _ => {
                bytes.shrink_to_fit();
                let memory = bytes.capacity() + size_of::<Vec<u8>>();
                if self.memory + memory > MAX_WAITING_BYTES {
                    return false;
                }
                self.memory += memory;
                self.blocks.push_back(bytes);
            }
        }
        true
    }
}

impl OutputQueue {
    /// The bytes that have waited longest; none when nothing waits and nothing more will come.
    pub(super) async fn next(&mut self) -> Option<Vec<u8>> {
        loop {
            {
                let mut blocks = self.shared.lock();
                blocks.memory -= std::mem::take(&mut self.lent_bytes);
                if let Some(block) = blocks.blocks.pop_front() {
                    self.lent_bytes = block.capacity() + size_of::<Vec<u8>>();
                    return Some(block);
                }
                if blocks.closed {
                    return None;
                }
            }
            self.shared.changed.notified().await;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run<T>(test: impl Future<Output = T>) -> T {
        tokio::runtime::Builder::new_current_thread().build().unwrap().block_on(test)
    }

    #[test]
    fn messages_come_in_their_order_and_then_the_end() {
        let (writer, mut waiting) = Writer::new();
        let messages: Vec<Vec<u8>> = (0..3000_u32).map(|i| vec![i as u8; (i * 7 % 500) as usize]).collect();
        assert!(messages.iter().all(|message| writer.send(message.clone())));
        drop(writer);
        let mut all = Vec::new();
        while let Some(block) = run(waiting.next()) {
            all.extend(block);
        }
        assert_eq!(all, messages.concat());
    }

    #[test]
    fn short_and_long_messages_count_by_their_memory() {
        for length in [1, 3, 40, 33_000, 65_535, 1 << 20] {
            let (writer, waiting) = Writer::new();
            let mut count = 0;
            while writer.send(vec![0; length]) {
                count += 1;
            }
            let blocks = writer.shared.lock();
            let held: usize = blocks.blocks.iter().map(|block| block.capacity() + size_of::<Vec<u8>>()).sum();
            assert_eq!(held, blocks.memory);
            assert!(held <= MAX_WAITING_BYTES, "{held}");
            // What is not used of the memory is the least of it.
            assert!(count * length > MAX_WAITING_BYTES / 10 * 9 - length, "{count} messages of {length} bytes");
            drop(blocks);
            drop(waiting);
        }
    }

    #[test]
    fn room_comes_back_when_the_host_has_read() {
        let (writer, mut waiting) = Writer::new();
        while writer.send(vec![0; BLOCK_BYTES]) {}
        let first = run(waiting.next());
        assert!(first.is_some() && !writer.send(vec![0; BLOCK_BYTES]), "what is being sent counts");
        run(waiting.next());
        assert!(writer.send(vec![0; BLOCK_BYTES]));
    }
}
