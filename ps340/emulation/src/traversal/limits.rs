//! How much one update takes.

/// How deep nodes may nest. The real stack held tens of levels.
pub const MAX_DEPTH: usize = 10_000;
/// How many nodes one update visits, so that instances of instances of instances end.
pub const MAX_VISITS: u64 = 20_000_000;
/// How many vectors one update draws or counts.
pub const MAX_VECTORS: u64 = 200_000_000;
/// How many vectors are drawn where their strokes are stored; these take 36 bytes each.
pub const MAX_STORED_VECTORS: u64 = 20_000_000;
/// How many vectors XFORM VECTOR gathers.
pub const MAX_GATHERED: usize = 1 << 20;
