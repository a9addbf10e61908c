//! Stages of long work, as spans of the crate `tracing`: what is done, how much of it, and how long it took.
//!
//! Work that takes long opens a stage by `stage!` and says how much of it is done. It does not know who listens: the
//! line on a terminal, statistics and profiles are all derived from what a [`StageLayer`] sees. Where nothing listens, a
//! stage costs a few nanoseconds.

mod span;
mod layer;
mod workers;
mod record;

pub use crate::{part, stage};
pub use layer::{StageEvent, StageLayer, observed};
pub use record::{StageRecord, StageTotal};
pub use span::{StageSpan, TARGET};
pub use workers::Workers;
