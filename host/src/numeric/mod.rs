//! Numbers: rays, exact predicates, seeded sampling.

pub mod ray;
