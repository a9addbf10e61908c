//! The network: instances of functions, arcs between them, and the list of those that are ready to fire.
//!
//! One FIFO of ready instances: the head fires once and goes to the end if it is still ready; then its results
//! arrive at their destinations, in the order of the outputs and of the connections. A firing takes nothing but
//! messages that are there, so loops are no recursion and need no stack; a budget bounds each run.
//!
//! An object is its own index: instances lie in a table by the numbers of the objects, so an arc leads to its end
//! without a search, and connections to a name outlive what the name stands for, until the name is deleted.
//!
//! A person may observe it, see [`Network::snapshot`]: counters, a trace of messages, breaks, single
//! firings. Nothing of it costs anything while there is no observer.
//!
//! Used: the execution model of the manuals. Modelled: queues, constants, faults, re-instancing. Not modelled:
//! the time that a function took on the machine's own processor.

mod arcs;
mod pool;
mod instance;
mod ready;
mod observe;
mod instruments;
mod graph;
mod instrumentation;
mod setup;
mod snapshot;
mod run;
mod in_place;
mod audit;

#[cfg(test)]
mod clock_tests;
#[cfg(test)]
mod contract;
#[cfg(test)]
mod extreme_tests;
#[cfg(test)]
mod spring_tests;
#[cfg(test)]
mod stress;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod watch_tests;

pub use arcs::{Destination, MAX_ARCS};
pub use graph::{MAX_STRING_BYTES, Network, NetworkCounters};
pub use instruments::{Activity, TRACE_LINES, TRACED_BYTES, Trace, Traced};
pub use observe::{ArcSource, Delivery};
pub use run::RunReport;
pub use snapshot::{FunctionView, InputView};
