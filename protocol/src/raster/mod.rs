//! What a host can do to the raster screen: the operations of a raster packet as plain data, and their bytes.

mod binary;
mod transfer;

pub use binary::{MAX_LOOKUP_ENTRIES, MAX_RUNS, RasterOpcode, decode, encode, record};
pub use transfer::{light_of_srgb, linear_from_srgb, srgb_from_linear, srgb_from_linear_each};

/// Width of the raster screen, in pixels. \[M\], size class \[S\].
pub const RASTER_WIDTH: u32 = 640;
/// Height of the raster screen, in pixels. \[M\], size class \[S\].
pub const RASTER_HEIGHT: u32 = 480;

/// One operation on the raster screen. Pixel (0, 0) is the lower left one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RasterCommand {
    /// Fills the whole screen with one colour (PRASER).
    Erase {
        /// Red, green, blue.
        color: [u8; 3],
    },
    /// The window of pixels that runs fill (PRASLD), all limits inclusive.
    Window {
        /// First column.
        x_min: u16,
        /// First line.
        y_min: u16,
        /// Last column.
        x_max: u16,
        /// Last line.
        y_max: u16,
    },
    /// The pixel that the next run begins at (PRASCP).
    Position {
        /// Column.
        x: u16,
        /// Line.
        y: u16,
    },
    /// Runs of equal pixels (PRASWP): left to right, then the next line *upwards*, inside the window.
    Runs(Vec<Run>),
    /// Entries of the three lookup tables (PRASLU), from `index` on.
    LookupTable {
        /// First entry, 0..=255.
        index: u8,
        /// The entries; each may repeat.
        entries: Vec<LookupEntry>,
    },
    /// A linear ramp over entries `min..=max` of the three tables (PRASLR): 0 at `min`, 255 at `max`.
    LookupRamp {
        /// First entry.
        min: u8,
        /// Last entry.
        max: u8,
    },
}

/// `count` pixels of one colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// How many pixels; 0 is a warning of the machine (31).
    pub count: u16,
    /// Red, green, blue, before the lookup tables.
    pub color: [u8; 3],
}

/// `count` equal entries of the lookup tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LookupEntry {
    /// How many entries; 0 is a warning of the machine (33).
    pub count: u8,
    /// What red, green and blue become.
    pub color: [u8; 3],
}
