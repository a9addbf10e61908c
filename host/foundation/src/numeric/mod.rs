//! Numbers: rays, exact predicates, seeded sampling.

pub mod bounds;
pub mod cubature;
pub mod exact;
pub mod hilbert;
pub mod implicit;
pub mod plane;
pub mod predicates;
mod debug_hash;
pub mod ray;
pub mod sampling;
pub mod noise;
pub mod sequence;
pub mod triangle;

pub use debug_hash::debug_hash;
