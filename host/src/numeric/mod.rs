//! Numbers: rays, exact predicates, seeded sampling.

pub mod bounds;
pub mod cubature;
pub mod exact;
pub mod implicit;
pub mod plane;
pub mod predicates;
mod print;
pub mod ray;
pub mod sampling;
pub mod sequence;
pub mod triangle;

pub(crate) use print::debug_hash;
