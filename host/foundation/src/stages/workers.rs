//! Threads on which a stage goes on.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::num::NonZeroUsize;
use tracing::{Span, dispatcher};

/// A pool of threads that work within the stage that calls them.
#[derive(Debug)]
pub struct Workers(ThreadPool);

impl Workers {
    /// Starts threads.
    ///
    /// - `count`: how many; one for each core if not given.
    ///
    /// # Errors
    /// [`ThreadPoolBuildError`], if the system has none.
    pub fn new(count: Option<NonZeroUsize>) -> Result<Workers, ThreadPoolBuildError> {
        Ok(Workers(ThreadPoolBuilder::new().num_threads(count.map_or(0, NonZeroUsize::get)).build()?))
    }

    /// Does work on the threads; stages that it opens are within that which is open here.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let span = Span::current();
        let listener = dispatcher::get_default(Clone::clone);
        self.0.install(|| dispatcher::with_default(&listener, || span.in_scope(work)))
    }

    /// How many threads there are.
    pub fn count(&self) -> usize {
        self.0.current_num_threads()
    }
}
