//! Tests of the mass memory.
