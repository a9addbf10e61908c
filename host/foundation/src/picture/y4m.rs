//! Moving pictures as a stream of uncompressed frames, YUV4MPEG2, which encoders of films read.
//!
//! Every pixel has its own colour (4:4:4), by the matrix and in the limited range of BT.709. The stream says the range,
//! and has no word for the matrix.
//!
//! # Source
//! The manual page yuv4mpeg(5) of MJPEG Tools; ITU-R BT.709-6, items 3.2 to 3.5.

use super::frame_rate::FrameRate;

/// Luminance of red, green and blue.
const LUMA: [f64; 3] = [0.2126, 0.7152, 0.0722];
/// What is between the least and the greatest difference of blue, and of red, and luma.
const CHROMA: [f64; 2] = [1.8556, 1.5748];

/// The beginning of a stream.
pub fn y4m_header([width, height]: [u32; 2], rate: FrameRate) -> String {
    let (numerator, denominator) = (rate.numerator(), rate.denominator());
    format!("YUV4MPEG2 W{width} H{height} F{numerator}:{denominator} Ip A1:1 C444 XCOLORRANGE=LIMITED\n")
}

/// A frame of a stream: its head, and all of its luma, differences of blue, and differences of red.
///
/// - `srgb`: eight bits a band, three bytes a pixel, row by row from the top.
pub fn y4m_frame(srgb: &[u8]) -> Vec<u8> {
    let (pixels, _) = srgb.as_chunks::<3>();
    let mut bytes = b"FRAME\n".to_vec();
    let begin = bytes.len();
    bytes.resize(begin + 3 * pixels.len(), 0);
    let (luma, chroma) = bytes[begin..].split_at_mut(pixels.len());
    let (blue, red) = chroma.split_at_mut(pixels.len());
    for (at, pixel) in pixels.iter().enumerate() {
        [luma[at], blue[at], red[at]] = ycbcr(*pixel);
    }
    bytes
}

/// Luma 16..=235, and the differences of blue and red, 16..=240, of a colour of eight bits a band.
fn ycbcr(rgb: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = rgb.map(|band| f64::from(band) / 255.0);
    let y = LUMA[0] * r + LUMA[1] * g + LUMA[2] * b;
    let [blue, red] = [(b - y) / CHROMA[0], (r - y) / CHROMA[1]];
    [16.0 + 219.0 * y, 128.0 + 224.0 * blue, 128.0 + 224.0 * red].map(|code| code.round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_black_and_primaries_have_the_codes_of_the_recommendation() {
        for (rgb, codes) in [
            ([255, 255, 255], [235, 128, 128]),
            ([0, 0, 0], [16, 128, 128]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 255, 0], [173, 42, 26]),
            ([0, 0, 255], [32, 240, 118]),
            ([255, 255, 0], [219, 16, 138]),
            ([128, 128, 128], [126, 128, 128]),
        ] {
            assert_eq!(ycbcr(rgb), codes, "{rgb:?}");
        }
    }

    #[test]
    fn a_stream_says_its_size_and_rate_and_holds_plane_after_plane() {
        let rate = FrameRate::parse("24000/1001").expect("a rate");
        assert_eq!(y4m_header([2, 1], rate), "YUV4MPEG2 W2 H1 F24000:1001 Ip A1:1 C444 XCOLORRANGE=LIMITED\n");
        let frame = y4m_frame(&[255, 255, 255, 255, 0, 0]);
        assert_eq!(frame, [b"FRAME\n", &[235, 63, 128, 102, 128, 240][..]].concat());
    }
}
