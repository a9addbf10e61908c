//! Facts about scenes.
