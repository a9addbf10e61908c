//! Facts about ray tracing.
