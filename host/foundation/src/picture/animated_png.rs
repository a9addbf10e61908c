//! Moving pictures as animated PNG files, which browsers and most viewers of pictures show.
//!
//! # Source
//! PNG specification, third edition 2025, sections 4.9 and 11.3.6.

use super::encoder::encoding_error;
use super::frame_rate::FrameRate;
use super::provenance::SOFTWARE;
use files::Writer;
use png::{BitDepth, BlendOp, ColorType, DisposeOp, EncodingError, SrgbRenderingIntent};
use std::io::Error;
use std::ops::Range;

/// Bytes of a pixel.
const BANDS: usize = 3;

/// Writes frames as an animated PNG file of eight-bit sRGB that begins anew for ever. Of each frame but the first it
/// holds the rectangle that differs from the frame before.
///
/// - `size`: columns and rows of each frame. `count`: how many there are, 1 and more.
/// - `frame`: the bytes of a frame, three a pixel, row by row from the top; of one after the other, from 0 on.
///
/// # Errors
/// Those of `frame` and of the file; a frame of another size is one.
pub fn animated_png(
    file: &mut Writer<'_>,
    [width, height]: [u32; 2],
    rate: FrameRate,
    count: u32,
    frame: impl Fn(u32) -> Result<Vec<u8>, Error>,
) -> Result<(), Error> {
    let written = |file: &mut Writer<'_>| -> Result<(), EncodingError> {
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        encoder.add_text_chunk("Software".into(), SOFTWARE.into())?;
        encoder.set_animated(count, 0)?;
        // A frame is shown for the inverse of the rate.
        encoder.set_frame_delay(rate.denominator(), rate.numerator())?;
        encoder.set_blend_op(BlendOp::Source)?;
        encoder.set_dispose_op(DisposeOp::None)?;
        let mut writer = encoder.write_header()?;
        let mut before = frame(0)?;
        writer.write_image_data(&before)?;
        for number in 1..count {
            let now = frame(number)?;
            if now.len() != before.len() {
                return Err(Error::other(format!("frame {number} has another size than the first")).into());
            }
            let [columns, rows] = changed(&before, &now, width as usize);
            let row = |y: usize| &now[(y * width as usize + columns.start) * BANDS..][..columns.len() * BANDS];
            let pixels: Vec<u8> = rows.clone().flat_map(row).copied().collect();
            // The rectangle must be within the picture all the while.
            writer.reset_frame_position()?;
            writer.set_frame_dimension(columns.len() as u32, rows.len() as u32)?;
            writer.set_frame_position(columns.start as u32, rows.start as u32)?;
            writer.write_image_data(&pixels)?;
            before = now;
        }
        writer.finish()
    };
    written(file).map_err(encoding_error)
}

/// The columns and rows in which two pictures of one size differ; one pixel where they do not.
///
/// - `width`: columns of both.
fn changed(before: &[u8], now: &[u8], width: usize) -> [Range<usize>; 2] {
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    let all = before.chunks_exact(width * BANDS).zip(now.chunks_exact(width * BANDS));
    for (y, (before, now)) in all.enumerate().filter(|(_, (before, now))| before != now) {
        let differs = |x: &usize| before[x * BANDS..][..BANDS] != now[x * BANDS..][..BANDS];
        let first = (0..width).find(differs).unwrap_or_default();
        let last = (0..width).rfind(differs).unwrap_or_default();
        low = [low[0].min(first), low[1].min(y)];
        high = [high[0].max(last + 1), y + 1];
    }
    if high == [0; 2] { [0..1, 0..1] } else { [0, 1].map(|axis: usize| low[axis]..high[axis]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use files::Destination;
    use std::io::BufReader;

    #[test]
    fn the_rectangle_that_changed_holds_every_pixel_that_did() {
        let before = vec![7; 5 * 4 * BANDS];
        let with = |places: &[[usize; 2]]| {
            let mut now = before.clone();
            places.iter().for_each(|[x, y]| now[(y * 5 + x) * BANDS + 2] = 9);
            changed(&before, &now, 5)
        };
        assert_eq!(with(&[]), [0..1, 0..1]);
        assert_eq!(with(&[[3, 2]]), [3..4, 2..3]);
        assert_eq!(with(&[[4, 1], [1, 3]]), [1..5, 1..4]);
        assert_eq!(with(&[[0, 0], [4, 3]]), [0..5, 0..4]);
    }

    #[test]
    fn a_file_holds_its_frames_delays_and_an_endless_loop() {
        let folder = tempfile::tempdir().expect("a folder");
        let destination = Destination::of(folder.path().join("a.png")).expect("a destination");
        let rate = FrameRate::parse("24000/1001").expect("a rate");
        let frame = |number: u32| -> Result<Vec<u8>, Error> {
            let mut pixels = vec![20; 3 * 2 * BANDS];
            pixels[number as usize % 2 * BANDS] = 200;
            Ok(pixels)
        };
        destination.write(|file| animated_png(file, [3, 2], rate, 3, frame)).expect("written");
        let file = BufReader::new(std::fs::File::open(destination.path()).expect("there"));
        let mut reader = png::Decoder::new(file).read_info().expect("a picture");
        let control = reader.info().animation_control.expect("it moves");
        assert_eq!((control.num_frames, control.num_plays), (3, 0));
        let mut sizes = Vec::new();
        for _ in 0..3 {
            let mut pixels = vec![0; 3 * 2 * BANDS];
            reader.next_frame(&mut pixels).expect("a frame");
            let control = *reader.info().frame_control().expect("a frame");
            assert_eq!((control.delay_num, control.delay_den), (1001, 24000));
            sizes.push([control.x_offset, control.y_offset, control.width, control.height]);
        }
        assert_eq!(sizes, [[0, 0, 3, 2], [0, 0, 2, 1], [0, 0, 2, 1]]);
        let other = |number: u32| Ok(vec![0; (number as usize + 1) * 18]);
        assert!(destination.write(|file| animated_png(file, [3, 2], rate, 2, other)).is_err());
    }
}
