//! Bytes on the host line.
