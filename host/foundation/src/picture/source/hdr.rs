//! Radiance's HDR files, line by line.
//!
//! # Source
//! Ward 1991, *Real pixels*; the file format as the Radiance distribution describes it.

use super::texel::{Buffered, Texel};
use crate::color::srgb;
use glam::DVec3;
use std::io::{BufRead, Read};

/// Longest header, bytes.
const MOST_HEADER: u64 = 1 << 20;
/// Least and greatest width of lines that are run-length encoded band by band.
const ENCODED: std::ops::Range<usize> = 8..0x8000;
/// Reciprocal of what a step of a band stands for where the exponent is 0, as a power of two.
const BIAS: i32 = 136;

/// An HDR file that is open.
pub(super) struct Hdr {
    file: Buffered,
    size: [u32; 2],
    /// Whether bands are X, Y and Z.
    is_xyz: bool,
    /// What numbers are multiplied with.
    factor: f64,
}

impl Hdr {
    pub(super) fn open(mut file: Buffered) -> Result<Hdr, String> {
        let mut header = (&mut file).take(MOST_HEADER);
        let mut line = || -> Result<String, String> {
            let mut bytes = Vec::new();
            header.read_until(b'\n', &mut bytes).map_err(|error| error.to_string())?;
            match bytes.pop() {
                Some(b'\n') => Ok(String::from_utf8_lossy(&bytes).trim().to_owned()),
                _ => Err("its header does not end".into()),
            }
        };
        if !line()?.starts_with("#?") {
            return Err("it does not begin with #?RADIANCE".into());
        }
        let (mut is_xyz, mut exposure) = (false, 1.0);
        loop {
            let text = line()?;
            match text.split_once('=').map(|(key, value)| (key.trim(), value.trim())) {
                _ if text.is_empty() => break,
                Some(("FORMAT", "32-bit_rle_rgbe")) => is_xyz = false,
                Some(("FORMAT", "32-bit_rle_xyze")) => is_xyz = true,
                Some(("FORMAT", other)) => return Err(format!("its format {other} is not read")),
                Some(("EXPOSURE", value)) => {
                    let number = value.parse::<f64>().ok().filter(|number| *number > 0.0 && number.is_finite());
                    exposure *= number.ok_or_else(|| format!("its exposure {value} is no number above 0"))?;
                }
                _ => {}
            }
        }
        let text = line()?;
        let words: Vec<&str> = text.split_whitespace().collect();
        let ["-Y", rows, "+X", columns] = words[..] else {
            return Err(format!("its rows and columns are given by '{text}'; only -Y ROWS +X COLUMNS is read"));
        };
        let side = |text: &str| text.parse().map_err(|_| format!("'{text}' is no number of pixels"));
        Ok(Hdr { file, size: [side(columns)?, side(rows)?], is_xyz, factor: 1.0 / exposure })
    }

    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }

    pub(super) fn each(mut self, tell: &mut impl FnMut(u32, u32, Texel)) -> Result<(), String> {
        let [width, height] = self.size;
        let mut line = vec![[0; 4]; width as usize];
        for y in 0..height {
            self.read(&mut line).map_err(|problem| format!("row {y}: {problem}"))?;
            for (x, code) in (0..).zip(&line) {
                let light = self.light(*code).as_vec3();
                tell(x, y, Texel::Float([light.x, light.y, light.z, 1.0, f32::INFINITY]));
            }
        }
        Ok(())
    }

    /// The light of three bands and an exponent; bands were rounded down.
    fn light(&self, [r, g, b, exponent]: [u8; 4]) -> DVec3 {
        if exponent == 0 {
            return DVec3::ZERO;
        }
        let scale = f64::from(i32::from(exponent) - BIAS).exp2() * self.factor;
        let bands = (DVec3::new(f64::from(r), f64::from(g), f64::from(b)) + 0.5) * scale;
        if self.is_xyz { srgb::from_xyz(bands) } else { bands }
    }

    /// Reads a line.
    fn read(&mut self, line: &mut [[u8; 4]]) -> Result<(), String> {
        let first = self.bytes::<4>()?;
        let is_encoded = ENCODED.contains(&line.len()) && first[..2] == [2, 2] && first[2] < 128;
        if !is_encoded {
            return self.pixels(first, line);
        }
        if usize::from(first[2]) << 8 | usize::from(first[3]) != line.len() {
            return Err("it has another length than the picture is wide".into());
        }
        for band in 0..4 {
            let mut at = 0;
            while at < line.len() {
                let [count] = self.bytes()?;
                let is_run = count > 128;
                let count = usize::from(if is_run { count - 128 } else { count });
                let rest = line.len() - at;
                if count == 0 || count > rest {
                    return Err(format!("a run of {count} where {rest} are left"));
                }
                let mut value = [0];
                for i in 0..count {
                    if i == 0 || !is_run {
                        value = self.bytes()?;
                    }
                    line[at + i][band] = value[0];
                }
                at += count;
            }
        }
        Ok(())
    }

    /// Reads pixels one after the other, of which 1, 1, 1 says how often the one before is repeated.
    fn pixels(&mut self, first: [u8; 4], line: &mut [[u8; 4]]) -> Result<(), String> {
        let (mut at, mut shift, mut next) = (0, 0, Some(first));
        while at < line.len() {
            let pixel = match next.take() {
                Some(pixel) => pixel,
                None => self.bytes()?,
            };
            if pixel[..3] != [1, 1, 1] {
                (line[at], at, shift) = (pixel, at + 1, 0);
                continue;
            }
            let count = usize::from(pixel[3]).checked_shl(shift).unwrap_or(usize::MAX);
            let rest = line.len() - at;
            if at == 0 || count > rest {
                return Err(format!("a run of {count} where {rest} are left"));
            }
            let before = line[at - 1];
            line[at..at + count].fill(before);
            (at, shift) = (at + count, shift + 8);
        }
        Ok(())
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes = [0; N];
        self.file.read_exact(&mut bytes).map_err(|error| match error.kind() {
            std::io::ErrorKind::UnexpectedEof => "the file ends in it".into(),
            _ => error.to_string(),
        })?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use crate::picture::{Picture, PictureError};
    use std::fs;

    fn read(text: &str, bytes: &[u8]) -> Result<Picture, PictureError> {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("a.hdr");
        fs::write(&path, [text.as_bytes(), bytes].concat()).expect("written");
        Picture::read(&path)
    }

    const HEAD: &str = "#?RADIANCE\n# made by nobody\nFORMAT=32-bit_rle_rgbe\n\n";

    #[test]
    fn the_three_ways_of_writing_a_line_are_read() {
        // 1 is 128 in 256 parts of 2.
        let plain = read(&format!("{HEAD}-Y 1 +X 2\n"), &[128, 64, 0, 129, 0, 0, 0, 0]).expect("pixels");
        let [one, black] = plain.pixels() else { panic!("two pixels") };
        assert_eq!(one.radiance, [128.5 / 128.0, 64.5 / 128.0, 0.5 / 128.0]);
        assert_eq!((black.radiance, black.coverage), ([0.0; 3], 1.0));
        let old = read(&format!("{HEAD}-Y 1 +X 5\n"), &[128, 64, 0, 129, 1, 1, 1, 3, 9, 9, 9, 129]).expect("a run");
        assert!(old.pixels()[..4].iter().all(|p| p == one) && old.pixels()[4].radiance == [9.5 / 128.0; 3]);
        let mut encoded = vec![2, 2, 0, 8];
        for band in [128, 64, 0, 129] {
            encoded.extend([128 + 6, band, 2, band, band]);
        }
        let new = read(&format!("{HEAD}-Y 1 +X 8\n"), &encoded).expect("runs");
        assert!(new.pixels().iter().all(|p| p == one));
    }

    #[test]
    fn exposures_and_other_primaries_are_undone() {
        let head = HEAD.replace("FORMAT", "EXPOSURE=2\nEXPOSURE= 4\nFORMAT");
        let dark = read(&format!("{head}-Y 1 +X 1\n"), &[128, 128, 128, 129]).expect("a pixel");
        assert!((dark.pixels()[0].radiance[1] - 128.5 / 128.0 / 8.0).abs() < 1e-6);
        let xyz =
            read(&format!("{}-Y 1 +X 1\n", HEAD.replace("rgbe", "xyze")), &[122, 128, 139, 129]).expect("a pixel");
        let [r, g, b] = xyz.pixels()[0].radiance;
        assert!([r, g, b].iter().all(|band| (band - 1.0).abs() < 0.02), "{r} {g} {b}");
    }

    #[test]
    fn broken_files_are_refused_with_the_place() {
        let refused = |text: &str, bytes: &[u8]| read(text, bytes).expect_err("broken").to_string();
        assert!(refused("RADIANCE\n", &[]).contains("#?RADIANCE"));
        assert!(refused("#?RADIANCE\nFORMAT=", &[]).contains("does not end"));
        assert!(refused(&format!("{HEAD}+X 1 -Y 1\n"), &[]).contains("-Y ROWS +X COLUMNS"));
        assert!(refused(&HEAD.replace("rgbe", "cmyk"), &[]).contains("cmyk"));
        assert!(refused(&format!("{HEAD}-Y 2 +X 1\n"), &[1, 2, 3, 4]).contains("row 1: the file ends"));
        assert!(refused(&format!("{HEAD}-Y 1 +X 9\n"), &[2, 2, 0, 8]).contains("another length"));
        assert!(refused(&format!("{HEAD}-Y 1 +X 8\n"), &[2, 2, 0, 8, 255, 1]).contains("a run of 127"));
        assert!(refused(&format!("{HEAD}-Y 1 +X 8\n"), &[1, 1, 1, 5]).contains("a run of 5"));
        assert!(refused(&format!("{HEAD}-Y 0 +X 8\n"), &[]).contains("empty"));
    }
}
