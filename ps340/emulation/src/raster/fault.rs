//! What the raster system warns of and refuses, with the numbers of the graphics support routines.

/// A warning (30 to 33) or an error (550 to 558) of a raster command.
///
/// Not modelled: a lookup table entry that repeats more than 255 times (32), and a ramp that begins (556) or ends (557)
/// outside 0 to 255, which the bytes of a raster command cannot express.
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
            Self::RepetitionCountTooSmall => 33,
            Self::IllegalPosition => 550,
            Self::IllegalIndex => 552,
            Self::IllegalWindow => 553,
            Self::NoEntries => 554,
            Self::MinimumAboveMaximum => 555,
            Self::NoRuns => 558,
        }
    }

    /// Whether the command was done as far as it made sense; otherwise it was not done at all.
    pub fn is_warning(&self) -> bool {
        self.number() < 256
    }
}
