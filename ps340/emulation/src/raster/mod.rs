//! The raster screen: a frame buffer of 640 by 480 pixels behind three lookup tables.
//!
//! It is static: it shows what was last written and is not refreshed from the display structure.
//!
//! # Model
//! A pixel holds 8 bits each of red, green and blue; each goes through a table of 256 entries of its own
//! before it reaches the monitor. Pixel (0, 0) is the lower left one. Runs fill the window from left to
//! right, then the next line upwards.
//!
//! # Decided here
//! - After the last pixel of the window the current pixel is the first one again.
//! - Setting a window puts the current pixel to its lower left corner.
//! - ERASE fills the whole screen, whatever the window, and leaves window and current pixel alone.
//! - An *error* changes nothing. A *warning* is reported after everything that makes sense was done: a run
//!   or an entry that repeats less than once is skipped; pixels beyond the 307,200th of one transfer
//!   are dropped. Of several warnings of one command the first is reported.
//! - What the tables put out is what the monitor displays, in sRGB: [`FrameBuffer::picture`] holds the linear
//!   light of these bytes, so that a PNG of it holds exactly the bytes and an OpenEXR their light.
//!
//! - Shaded renderings and washes write pixels where they belong, and leave window and current pixel alone.
//!
//! *Not modelled*: the monitor's own transfer curve, flicker and the time that a transfer takes.

mod fault;

pub use fault::RasterFault;

use crate::picture::Picture;
use protocol::raster::{LookupEntry, RASTER_HEIGHT, RASTER_WIDTH, RasterCommand, Run, linear_from_srgb};
use std::sync::Arc;

/// Width in pixels.
const WIDTH: usize = RASTER_WIDTH as usize;
/// Height in pixels.
const HEIGHT: usize = RASTER_HEIGHT as usize;
/// Entries of a lookup table.
const ENTRIES: usize = 256;

/// The raster screen: pixels, lookup tables, window and current pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameBuffer {
    /// Bottom line first, left to right. Shared with copies until one of them changes, so that a copy of a picture that
    /// stands still costs nothing, and neither does the comparison with it.
    pixels: Arc<[[u8; 3]]>,
    /// What each value of red, green and blue becomes.
    tables: [[u8; ENTRIES]; 3],
    window: Window,
    /// Column and line of the current pixel; inside the window.
    position: (usize, usize),
}

/// A rectangle of pixels, limits inclusive, inside the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Window {
    x: (usize, usize),
    y: (usize, usize),
}

impl Default for FrameBuffer {
    fn default() -> Self {
        Self::new()
    }
}

impl FrameBuffer {
    /// A black screen with linear tables, the whole screen as window, and the lower left pixel current.
    pub fn new() -> Self {
        let ramp = std::array::from_fn(|entry| entry as u8);
        Self {
            pixels: vec![[0; 3]; WIDTH * HEIGHT].into(),
            tables: [ramp; 3],
            window: Window { x: (0, WIDTH - 1), y: (0, HEIGHT - 1) },
            position: (0, 0),
        }
    }

    /// Does what a host asks for.
    ///
    /// # Errors
    /// The machine's fault: an error, after which nothing has changed, or a warning
    /// ([`RasterFault::is_warning`]), after which the rest of the command has been done.
    pub fn apply(&mut self, command: &RasterCommand) -> Result<(), RasterFault> {
        match command {
            RasterCommand::Erase { color } => {
                Arc::make_mut(&mut self.pixels).fill(*color);
                Ok(())
            }
            RasterCommand::Window { x_min, y_min, x_max, y_max } => {
                self.set_window((usize::from(*x_min), usize::from(*x_max)), (usize::from(*y_min), usize::from(*y_max)))
            }
            RasterCommand::Position { x, y } => self.set_position(usize::from(*x), usize::from(*y)),
            RasterCommand::Runs(runs) => self.write_runs(runs),
            RasterCommand::LookupTable { index, entries } => self.load_table(usize::from(*index), entries),
            RasterCommand::LookupRamp { min, max } => self.load_ramp(*min, *max),
        }
    }

    /// Writes a rectangle of pixels; what lies beyond the screen is left out.
    ///
    /// - `left`, `bottom`, `width`: in pixels.
    /// - `pixels`: the bottom line first, left to right.
    pub fn paint(&mut self, left: u32, bottom: u32, width: u32, pixels: &[[u8; 3]]) {
        let (left, bottom) = (left as usize, bottom as usize);
        let seen = WIDTH.saturating_sub(left).min(width as usize);
        if seen == 0 {
            return;
        }
        let lines = Arc::make_mut(&mut self.pixels).chunks_exact_mut(WIDTH).skip(bottom);
        for (line, new) in lines.zip(pixels.chunks_exact(width as usize)) {
            line[left..left + seen].copy_from_slice(&new[..seen]);
        }
    }

    /// The pixel in column `x` and line `y` from the lower left, before the tables; `None` outside the screen.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        let inside = x < RASTER_WIDTH && y < RASTER_HEIGHT;
        inside.then(|| self.pixels[y as usize * WIDTH + x as usize])
    }

    /// What the monitor shows there, after the tables; `None` outside the screen.
    pub fn shown(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        Some(self.looked_up(self.pixel(x, y)?))
    }

    fn looked_up(&self, [r, g, b]: [u8; 3]) -> [u8; 3] {
        let [red, green, blue] = &self.tables;
        [red[usize::from(r)], green[usize::from(g)], blue[usize::from(b)]]
    }

    /// Whether every pixel is as at the start.
    pub fn is_blank(&self) -> bool {
        self.pixels.iter().all(|pixel| *pixel == [0; 3])
    }

    /// What the monitor shows, after the tables: top line first, left to right.
    pub fn output(&self) -> Vec<[u8; 3]> {
        self.pixels.chunks_exact(WIDTH).rev().flatten().map(|pixel| self.looked_up(*pixel)).collect()
    }

    /// What the monitor shows, as linear light: its PNG holds the bytes of [`Self::output`].
    pub fn picture(&self) -> Picture {
        let pixels = self.output().into_iter().map(|pixel| pixel.map(linear_from_srgb)).collect();
        Picture::new(RASTER_WIDTH, RASTER_HEIGHT, pixels).expect("the frame buffer has the size of the screen")
    }

    fn set_window(&mut self, x: (usize, usize), y: (usize, usize)) -> Result<(), RasterFault> {
        if x.0 > x.1 || y.0 > y.1 || x.1 >= WIDTH || y.1 >= HEIGHT {
            return Err(RasterFault::IllegalWindow);
        }
        self.window = Window { x, y };
        self.position = (x.0, y.0);
        Ok(())
    }

    fn set_position(&mut self, x: usize, y: usize) -> Result<(), RasterFault> {
        let Window { x: columns, y: lines } = self.window;
        if x < columns.0 || x > columns.1 || y < lines.0 || y > lines.1 {
            return Err(RasterFault::IllegalPosition);
        }
        self.position = (x, y);
        Ok(())
    }

    fn write_runs(&mut self, runs: &[Run]) -> Result<(), RasterFault> {
        if runs.is_empty() {
            return Err(RasterFault::NoRuns);
        }
        let mut warning = None;
        let mut left = WIDTH * HEIGHT;
        for run in runs {
            let count = usize::from(run.count);
            if count == 0 {
                warning.get_or_insert(RasterFault::PixelCountTooSmall);
            } else if count > left {
                warning.get_or_insert(RasterFault::PixelCountTooBig);
            }
            let count = count.min(left);
            self.fill(count, run.color);
            left -= count;
        }
        warning.map_or(Ok(()), Err)
    }

    /// Fills `count` pixels from the current one on, line by line.
    fn fill(&mut self, mut count: usize, color: [u8; 3]) {
        let Window { x: columns, y: lines } = self.window;
        let (mut x, mut y) = self.position;
        let pixels = Arc::make_mut(&mut self.pixels);
        while count > 0 {
            let piece = count.min(columns.1 + 1 - x);
            let start = y * WIDTH + x;
            pixels[start..start + piece].fill(color);
            count -= piece;
            x += piece;
            if x > columns.1 {
                x = columns.0;
                y = if y == lines.1 { lines.0 } else { y + 1 };
            }
        }
        self.position = (x, y);
    }

    fn load_table(&mut self, index: usize, entries: &[LookupEntry]) -> Result<(), RasterFault> {
        if entries.is_empty() {
            return Err(RasterFault::NoEntries);
        }
        let end = entries.iter().fold(index, |end, entry| end + usize::from(entry.count));
        if end > ENTRIES {
            return Err(RasterFault::IllegalIndex);
        }
        let mut next = index;
        for entry in entries {
            let end = next + usize::from(entry.count);
            for (table, value) in self.tables.iter_mut().zip(entry.color) {
                table[next..end].fill(value);
            }
            next = end;
        }
        let empty = entries.iter().any(|entry| entry.count == 0);
        if empty { Err(RasterFault::RepetitionCountTooSmall) } else { Ok(()) }
    }

    /// 0 at `min`, 255 at `max`, rounded to the nearest between; a ramp of one entry is 255.
    fn load_ramp(&mut self, min: u8, max: u8) -> Result<(), RasterFault> {
        if min > max {
            return Err(RasterFault::MinimumAboveMaximum);
        }
        let span = u32::from(max - min);
        for entry in min..=max {
            let step = u32::from(entry - min);
            let value = (step * 255 + span / 2).checked_div(span).unwrap_or(255) as u8;
            for table in &mut self.tables {
                table[usize::from(entry)] = value;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
