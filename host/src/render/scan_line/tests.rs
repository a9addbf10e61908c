//! Facts about scan line.
