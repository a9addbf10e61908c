//! Tests that need both processes.
