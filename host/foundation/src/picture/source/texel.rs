//! What a file of a picture tells of its pixels, in whatever format it is.

use std::fs::File;
use std::io::BufReader;

/// What is read of a file.
pub(super) type Buffered = BufReader<File>;

/// How a file tells its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TexelFormat {
    /// Eight bits a band, encoded as sRGB.
    Eight,
    /// Sixteen bits a band, encoded as sRGB; `grey` where all bands are the same.
    Sixteen {
        /// Whether all bands are the same.
        grey: bool,
    },
    /// Floating-point numbers of linear light; `grey` where all bands are the same.
    Float {
        /// Whether all bands are the same.
        grey: bool,
    },
}

/// A pixel of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Texel {
    /// Red, green, blue, each encoded as sRGB, and coverage.
    Eight([u8; 4]),
    /// Red, green, blue, each encoded as sRGB, and coverage.
    Sixteen([u16; 4]),
    /// Red, green, blue of linear light, premultiplied by the coverage; coverage; depth.
    Float([f32; 5]),
}
