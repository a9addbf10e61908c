//! PNG files, row by row.

use super::texel::{Buffered, Texel, TexelFormat};
use png::{BitDepth, ColorType, Decoder, DecodingError, Limits, Reader, Transformations};

/// Most bytes that the decoder may take for what is no pixel, and for rows.
const MOST_BESIDE: usize = 256 << 20;
/// Longest row, bytes.
const MOST_OF_ROW: usize = 64 << 20;

/// The passes of an interlaced file: first column, first row, and the steps between columns and rows.
///
/// # Source
/// PNG specification, section 8.2 (Adam7).
const PASSES: [[u32; 4]; 7] =
    [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];
/// The only pass of another file.
const WHOLE: [[u32; 4]; 1] = [[0, 0, 1, 1]];

/// A PNG file that is open.
pub(super) struct Png(Reader<Buffered>);

impl Png {
    pub(super) fn open(file: Buffered) -> Result<Png, String> {
        let said = |error: DecodingError| error.to_string();
        let mut decoder = Decoder::new_with_limits(file, Limits { bytes: MOST_BESIDE });
        decoder.set_transformations(Transformations::EXPAND);
        decoder.set_ignore_text_chunk(true);
        decoder.set_ignore_iccp_chunk(true);
        let row = decoder.read_header_info().map_err(said)?.raw_row_length();
        if row > MOST_OF_ROW {
            return Err(format!("its rows of {row} bytes are longer than {MOST_OF_ROW}"));
        }
        let reader = decoder.read_info().map_err(said)?;
        // The decoder takes any number of bytes for a palette, and fails at others than these.
        match reader.info().palette.as_deref().map_or(3, <[u8]>::len) {
            length if (3..=768).contains(&length) && length.is_multiple_of(3) => Ok(Png(reader)),
            length => Err(format!("its palette has {length} bytes: three for each of 1 to 256 colours are needed")),
        }
    }

    pub(super) fn size(&self) -> [u32; 2] {
        [self.0.info().width, self.0.info().height]
    }

    pub(super) fn precision(&self) -> TexelFormat {
        match self.0.output_color_type() {
            (color, BitDepth::Sixteen) => TexelFormat::Sixteen { grey: bands_of(color) < 3 },
            _ => TexelFormat::Eight,
        }
    }

    pub(super) fn each(mut self, tell: &mut impl FnMut(u32, u32, Texel)) -> Result<(), String> {
        let [width, height] = self.size();
        let (color, depth) = self.0.output_color_type();
        let (bands, interlaced) = (bands_of(color), self.0.info().interlaced);
        for [left, top, across, down] in if interlaced { &PASSES[..] } else { &WHOLE } {
            // A pass without columns has no rows either.
            for y in (*top..height).step_by(*down as usize).filter(|_| *left < width) {
                let row = self.0.next_row().map_err(|error| error.to_string())?.ok_or("rows are missing")?;
                let columns = (*left..width).step_by(*across as usize);
                if depth == BitDepth::Sixteen {
                    for (x, pixel) in columns.zip(row.data().chunks_exact(2 * bands)) {
                        let band = |at: usize| u16::from_be_bytes([pixel[2 * at], pixel[2 * at + 1]]);
                        tell(x, y, Texel::Sixteen(spread(bands, band, u16::MAX)));
                    }
                } else {
                    for (x, pixel) in columns.zip(row.data().chunks_exact(bands)) {
                        tell(x, y, Texel::Eight(spread(bands, |at| pixel[at], u8::MAX)));
                    }
                }
            }
        }
        Ok(())
    }
}

/// Numbers of a pixel, once palettes are looked up.
fn bands_of(color: ColorType) -> usize {
    color.samples()
}

/// Red, green, blue and coverage of a pixel with one to four numbers.
fn spread<T: Copy>(bands: usize, band: impl Fn(usize) -> T, covered: T) -> [T; 4] {
    let alpha = if bands.is_multiple_of(2) { band(bands - 1) } else { covered };
    if bands < 3 { [band(0), band(0), band(0), alpha] } else { [band(0), band(1), band(2), alpha] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{BufReader, Write};

    /// A file of 2 by 2 pixels that look up a palette of so many bytes.
    fn with_palette(length: usize) -> Result<usize, String> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_palette(vec![7; length]);
        let mut writer = encoder.write_header().map_err(|e| e.to_string())?;
        writer.write_image_data(&[0; 4]).map_err(|e| e.to_string())?;
        writer.finish().map_err(|e| e.to_string())?;
        let mut file = tempfile::tempfile().map_err(|e| e.to_string())?;
        file.write_all(&bytes).and_then(|()| std::io::Seek::rewind(&mut file)).map_err(|e| e.to_string())?;
        let mut pixels = 0;
        Png::open(BufReader::new(file))?.each(&mut |_, _, _| pixels += 1)?;
        Ok(pixels)
    }

    #[test]
    fn a_palette_of_a_wrong_length_is_an_error() {
        assert_eq!(with_palette(3), Ok(4));
        assert_eq!(with_palette(768), Ok(4));
        for length in [0, 1, 2, 4, 769, 771] {
            assert!(with_palette(length).is_err(), "{length}");
        }
    }
}
