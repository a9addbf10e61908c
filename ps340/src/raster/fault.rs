//! What the raster system warns of and refuses, with the numbers of the graphics support routines.

/// A warning (30 to 33) or an error (550 to 558) of a raster command.
///
/// # Source
/// Numbers and meanings: the common declarations of the FORTRAN graphics support routines, 1983 to 1987.
/// Wording is ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RasterFault {
    /// 30: one transfer has more pixels than the screen.
    #[error("pixel count greater than the screen")]
    PixelCountTooBig,
    /// 31: a run of no pixels.
    #[error("pixel count less than 1")]
    PixelCountTooSmall,
    /// 32: a lookup table entry repeats more than 255 times. The counts of [`protocol::raster::LookupEntry`]
    /// cannot express it; a reader of wider counts can report it.
    #[error("lookup table repetition count greater than 255")]
    RepetitionCountTooBig,
    /// 33: a lookup table entry that repeats less than once.
    #[error("lookup table repetition count less than 1")]
    RepetitionCountTooSmall,
    /// 550: the current pixel is outside the window.
    #[error("illegal current pixel: outside the window")]
    IllegalPosition,
    /// 552: the entries go beyond the end of the lookup table.
    #[error("lookup table index outside 0 to 255")]
    IllegalIndex,
    /// 553: the window has its limits the wrong way round, or is not inside the screen.
    #[error("illegal window: limits reversed or outside the screen")]
    IllegalWindow,
    /// 554: no entries for the lookup table.
    #[error("number of lookup table entries less than 1")]
    NoEntries,
    /// 555: a ramp whose first entry is above its last.
    #[error("lookup table minimum greater than maximum")]
    MinimumAboveMaximum,
    /// 556: the first entry of a ramp is outside 0 to 255. A byte cannot express it; a reader of wider
    /// numbers can report it.
    #[error("lookup table minimum outside 0 to 255")]
    IllegalMinimum,
    /// 557: the last entry of a ramp is outside 0 to 255, as with 556.
    #[error("lookup table maximum outside 0 to 255")]
    IllegalMaximum,
    /// 558: a transfer without runs.
    #[error("number of pixel runs less than 1")]
    NoRuns,
}

impl RasterFault {
    /// The number in the list of completion codes.
    pub fn number(&self) -> u16 {
        match self {
            Self::PixelCountTooBig => 30,
            Self::PixelCountTooSmall => 31,
            Self::RepetitionCountTooBig => 32,
            Self::RepetitionCountTooSmall => 33,
            Self::IllegalPosition => 550,
            Self::IllegalIndex => 552,
            Self::IllegalWindow => 553,
            Self::NoEntries => 554,
            Self::MinimumAboveMaximum => 555,
            Self::IllegalMinimum => 556,
            Self::IllegalMaximum => 557,
            Self::NoRuns => 558,
        }
    }

    /// Whether the command was done as far as it made sense; otherwise it was not done at all.
    pub fn is_warning(&self) -> bool {
        self.number() < 256
    }
}
