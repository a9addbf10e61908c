//! Facts about studies of renderers.
