//! The display as it stands before a person: phosphor, refresh, knobs, and the pixels that are seen.
//!
//! Time goes in frames of 1/60 s. What is seen of a frame is the light that the phosphor sends out in it. A component
//! that keeps the part q of its energy from frame to frame sends out
//!
//!   e' = q e + (1 - q) E
//!
//! in the frame of a refresh that brings the light E, and e' = q e in a frame without. Over n frames with m refreshes,
//! p frames apart, the last one s frames ago, this is
//!
//!   e' = q^n e + (1 - q) E q^s (1 - q^(p m)) / (1 - q^p).
//!
//! A picture that stands still and is refreshed in every frame has e = E: its light does not depend on the phosphor.
//! What a display shows first is taken to have stood there for long.

use super::bins::Bins;
use super::drawer::Drawer;
use super::exposure::Exposure;
use super::phosphor::Emission;
use super::tile::{PLANE, STRIDE, TILE_HEIGHT, TILE_WIDTH, Tile};
use super::{Controls, Refresh, ScreenLight};
use crate::picture::Picture;
use crate::traversal::Stroke;
use processes::widest::{self, Work};
use protocol::raster::srgb_from_linear_each;
use rayon::prelude::*;

/// Pixels that are exposed together.
const LANES: usize = 16;
/// The visible remainder of a change that is not waited for: less than a step of the pixels.
const UNSEEN: f64 = 1e-4;
/// Light that is darkness.
const DARK: f32 = 2e-5;

/// A display with its settings and the light on its screen.
///
/// The window and files of pictures show the same: [`Display::frame`] holds the bytes of [`Display::picture`].
#[derive(Clone, Debug)]
pub struct Display {
    controls: Controls,
    size: [u32; 2],
    emission: Emission,
    light: ScreenLight,
    drawer: Drawer,
    bins: Bins,
    /// Red, green, blue and 255 of each pixel.
    rgba: Vec<u8>,
    written: Option<Written>,
    /// Whether the strokes must be written again although they are the same.
    stale: bool,
    /// Whether the pixels must be made again although the light is the same.
    unexposed: bool,
}

/// What was written last.
#[derive(Clone, Copy, Debug)]
struct Written {
    version: u64,
    /// The frame that is shown.
    frame: u64,
    /// The frame of the latest refresh.
    refreshed: u64,
    /// Frames from there to the next.
    period: u64,
    /// Frames for which nothing has changed.
    unchanged_frames: u64,
}

impl Display {
    /// A dark display of some width and height in pixels, at most [`super::MAX_SIZE`], whose light the processor
    /// writes.
    pub fn new(controls: Controls, size: [u32; 2]) -> Self {
        Self::drawn_by(Drawer::Processor, controls, size)
    }

    /// A dark display of some width and height in pixels, with somebody who writes its light.
    pub fn drawn_by(drawer: Drawer, controls: Controls, size: [u32; 2]) -> Self {
        let emission = controls.phosphor.emission();
        let light = controls.beam(size).dark(controls.phosphor.guns());
        let size = [light.width(), light.height()];
        let rgba = [0, 0, 0, 255].repeat(size[0] as usize * size[1] as usize);
        let bins = Bins::default();
        Self { controls, size, emission, light, drawer, bins, rgba, written: None, stale: false, unexposed: false }
    }

    /// Its settings.
    pub fn controls(&self) -> &Controls {
        &self.controls
    }

    /// Who writes its light.
    pub fn drawer(&self) -> &Drawer {
        &self.drawer
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Changes settings. Another phosphor or screen begins dark; all else keeps the light.
    pub fn set_controls(&mut self, controls: Controls) {
        let before = std::mem::replace(&mut self.controls, controls);
        if controls.phosphor != before.phosphor || controls.screen != before.screen {
            *self = Self::drawn_by(self.drawer.clone(), controls, self.size);
            return;
        }
        let optics = controls.beam(self.size).optics();
        self.stale |= optics != self.light.optics;
        self.unexposed |= controls.exposure() != before.exposure() || controls.steady != before.steady;
        self.light.optics = optics;
    }

    /// Gives the picture another size; it begins dark.
    pub fn resize(&mut self, size: [u32; 2]) {
        if size.map(|pixels| pixels.clamp(1, super::MAX_SIZE)) != self.size {
            *self = Self::drawn_by(self.drawer.clone(), self.controls, size);
        }
    }

    /// Releases the memory for strokes, which grows again with the next ones.
    pub fn shrink(&mut self) {
        self.bins = Bins::default();
    }

    /// Whether [`Display::show`] would change anything.
    pub fn awaits(&self, version: u64, frame: u64) -> bool {
        let Some(written) = self.written else { return true };
        let changed = written.version != version || self.stale || self.unexposed;
        changed || (frame > written.frame && !self.is_steady(&written))
    }

    /// Lets time go to a frame, in which the picture is `strokes`. Frames before it had the strokes of before.
    ///
    /// - `version`: the same number for the same strokes.
    /// - `frame`: frames of 1/60 s; a frame before the one that is shown counts as that.
    pub fn show(&mut self, strokes: &[Stroke], version: u64, frame: u64) {
        let Some(mut written) = self.written else {
            self.drawer.write(&mut self.light, &mut self.bins, strokes);
            let period = self.period(strokes);
            self.glow(1, f64::INFINITY, period, 0);
            self.written = Some(Written { version, frame, refreshed: frame, period, unchanged_frames: u64::MAX / 2 });
            self.expose(true);
            return;
        };
        if !self.awaits(version, frame) {
            if frame > written.frame {
                // It stands, refreshed in every frame.
                self.written = Some(Written { frame, refreshed: frame, ..written });
            }
            return;
        }
        if self.controls.steady {
            written.period = 1;
        }
        let changed = written.version != version || self.stale;
        let elapsed = frame.saturating_sub(written.frame);
        let first = (written.refreshed + written.period).max(written.frame + 1);
        if first <= written.frame + elapsed {
            let refreshes = (written.frame + elapsed - first) / written.period + 1;
            let last = first + (refreshes - 1) * written.period;
            let since = written.frame + elapsed - last;
            if changed {
                self.glow(last - written.frame, (refreshes - 1) as f64, written.period, written.period);
                self.drawer.write(&mut self.light, &mut self.bins, strokes);
                self.glow(since, 1.0, 1, since);
                written = Written { version, period: self.period(strokes), unchanged_frames: 0, ..written };
                self.stale = false;
            } else {
                self.glow(elapsed, refreshes as f64, written.period, since);
            }
            written.refreshed = last;
        } else {
            // No refresh begins; what one in this very frame writes may still change.
            self.glow(elapsed, 0.0, 1, 0);
            if changed && elapsed == 0 && written.refreshed == written.frame {
                self.drawer.write(&mut self.light, &mut self.bins, strokes);
                written = Written { version, period: self.period(strokes), unchanged_frames: 0, ..written };
                self.stale = false;
            }
        }
        written.frame += elapsed;
        written.unchanged_frames = written.unchanged_frames.saturating_add(elapsed);
        self.written = Some(written);
        if self.is_steady(&written) {
            // Nothing is left to wait for: the glow is that of a picture that stands still.
            self.glow(1, f64::INFINITY, 1, 0);
        }
        self.expose(written.refreshed == written.frame);
        self.unexposed = false;
    }

    /// Shows strokes that come part by part, as a picture that has stood there for long and is refreshed in every
    /// frame. The processor writes their light.
    ///
    /// - `give`: hands the parts to what it gets, in their order; together they are as one list.
    pub fn show_parts(&mut self, give: impl FnOnce(&mut dyn FnMut(&[Stroke]))) {
        let Self { light, bins, .. } = self;
        light.write(bins, &[]);
        give(&mut |strokes| light.add(bins, strokes));
        self.glow(1, f64::INFINITY, 1, 0);
        self.written =
            Some(Written { version: u64::MAX, frame: 0, refreshed: 0, period: 1, unchanged_frames: u64::MAX / 2 });
        self.expose(true);
    }

    /// The pixels: red, green, blue (sRGB) and 255, row after row from the top.
    pub fn frame(&self) -> &[u8] {
        &self.rgba
    }

    /// The pixels as linear floats.
    pub fn picture(&self) -> Picture {
        let [width, height] = self.size.map(|pixels| pixels as usize);
        let mut pixels = vec![[0.0; 3]; width * height];
        let pixel_rows = pixels.par_chunks_mut(width * TILE_HEIGHT);
        let refreshed = self.refreshed();
        pixel_rows.zip(self.light.tiles.par_chunks(self.light.columns())).for_each(|(pixels, tiles)| {
            for (column, tile) in tiles.iter().enumerate() {
                let source = Source { tile, display: self, refreshed };
                let put = Floats { pixels, width, left: column * TILE_WIDTH };
                widest::run(Exposing { source, exposure: self.controls.exposure(), put });
            }
        });
        Picture::new(self.size[0], self.size[1], pixels).expect("the size is at least 1, and the pixels as many")
    }

    /// The light that the latest refresh wrote, before phosphor and exposure.
    pub fn light(&self) -> &ScreenLight {
        &self.light
    }

    /// Frames from a refresh of some strokes to the next.
    fn period(&self, strokes: &[Stroke]) -> u64 {
        if self.controls.steady { 1 } else { Refresh::of(strokes).frames }
    }

    /// Whether the display is steady: the picture is refreshed in every frame, and the phosphor glows as it will for
    /// ever.
    fn is_steady(&self, written: &Written) -> bool {
        let steady = self.controls.steady || written.period == 1;
        steady
            && self
                .emission
                .slow
                .iter()
                .all(|slow| f64::from(slow.remaining).powf(written.unchanged_frames as f64) < UNSEEN)
    }

    /// Whether a refresh is seen in the frame that is shown.
    fn refreshed(&self) -> bool {
        self.written.is_some_and(|written| written.refreshed == written.frame)
    }

    /// Lets the slow components of the phosphor glow for some frames; see the text of the module.
    ///
    /// - `elapsed`: n; `refreshes`: m, of which the last was `since` (s) frames ago; `period`: p.
    fn glow(&mut self, elapsed: u64, refreshes: f64, period: u64, since: u64) {
        if self.emission.slow.is_empty() || (elapsed == 0 && refreshes == 0.0) {
            return;
        }
        // For each component: its gun, what is left of its light, and what comes of the light that is written.
        let gains: Vec<(usize, f32, f32)> = (self.emission.slow.iter())
            .map(|slow| {
                let q = f64::from(slow.remaining);
                let cycle = period as f64;
                let left = if refreshes.is_infinite() { 0.0 } else { q.powf(elapsed as f64) };
                let series = (1.0 - q.powf(cycle * refreshes)) / (1.0 - q.powf(cycle));
                (slow.gun, left as f32, ((1.0 - q) * q.powf(since as f64) * series) as f32)
            })
            .collect();
        self.light.tiles.par_iter_mut().filter(|tile| tile.lit || tile.glowing).for_each(|tile| {
            widest::run(Glowing { tile, gains: &gains });
        });
    }

    /// Makes the pixels of all tiles that are seen or were.
    ///
    /// - `refreshed`: whether what the components of short decay send out is seen.
    fn expose(&mut self, refreshed: bool) {
        let exposure = self.controls.exposure();
        let width = self.size[0] as usize;
        let columns = self.light.columns();
        let mut tiles = std::mem::take(&mut self.light.tiles);
        let mut rgba = std::mem::take(&mut self.rgba);
        rgba.par_chunks_mut(4 * width * TILE_HEIGHT).zip(tiles.par_chunks_mut(columns)).for_each(|(pixels, tiles)| {
            for (column, tile) in tiles.iter_mut().enumerate() {
                let seen = (tile.lit && refreshed) || tile.glowing;
                if seen || tile.visible {
                    tile.visible = seen;
                    let source = Source { tile, display: self, refreshed };
                    let put = Bytes { pixels, width, left: column * TILE_WIDTH };
                    widest::run(Exposing { source, exposure, put });
                }
            }
        });
        self.light.tiles = tiles;
        self.rgba = rgba;
    }
}

/// Where the light of a tile comes from.
struct Source<'a> {
    tile: &'a Tile,
    display: &'a Display,
    refreshed: bool,
}

impl Source<'_> {
    /// Linear red, green and blue of some pixels, by the index of the first in a plane.
    #[inline(always)]
    fn colors(&self, place: usize) -> [[f32; LANES]; 3] {
        let mut colors = [[0.0; LANES]; 3];
        let emission = &self.display.emission;
        let mut add = |light: &[f32], color: &[f32; 3]| {
            let Some(light) = light.first_chunk::<LANES>() else { return };
            for (sum, color) in colors.iter_mut().zip(color) {
                for (sum, light) in sum.iter_mut().zip(light) {
                    *sum = light.mul_add(*color, *sum);
                }
            }
        };
        if self.tile.lit && self.refreshed {
            for (gun, color) in emission.prompt.iter().enumerate().take(self.display.light.guns) {
                add(&self.tile.planes[gun * PLANE + place..], color);
            }
        }
        if self.tile.glowing {
            for (component, slow) in emission.slow.iter().enumerate() {
                add(&self.tile.glow[component * PLANE + place..], &slow.color);
            }
        }
        colors
    }
}

/// Where exposed pixels go.
trait Put {
    /// Rows of pixels there are.
    fn rows(&self) -> usize;
    /// Pixels in a row of the tile.
    fn across(&self) -> usize;
    /// Takes some pixels, red, green and blue, of a row from a column on.
    fn put(&mut self, row: usize, column: usize, count: usize, pixels: &[[f32; LANES]; 3]);
    /// Makes some pixels black.
    fn black(&mut self, row: usize, column: usize, count: usize);
}

/// Bytes of sRGB with 255 as the fourth.
struct Bytes<'a> {
    pixels: &'a mut [u8],
    width: usize,
    left: usize,
}

impl Put for Bytes<'_> {
    #[inline(always)]
    fn rows(&self) -> usize {
        self.pixels.len() / (4 * self.width)
    }

    #[inline(always)]
    fn across(&self) -> usize {
        (self.width - self.left).min(TILE_WIDTH)
    }

    #[inline(always)]
    fn put(&mut self, row: usize, column: usize, count: usize, [red, green, blue]: &[[f32; LANES]; 3]) {
        let start = 4 * (row * self.width + self.left + column);
        let (red, green, blue) =
            (srgb_from_linear_each(red), srgb_from_linear_each(green), srgb_from_linear_each(blue));
        let mut pixels = [[255; 4]; LANES];
        for (pixel, ((red, green), blue)) in pixels.iter_mut().zip(red.iter().zip(green).zip(blue)) {
            *pixel = (red | green << 8 | blue << 16 | 255 << 24).to_le_bytes();
        }
        self.pixels[start..start + 4 * count].copy_from_slice(&pixels.as_flattened()[..4 * count]);
    }

    #[inline(always)]
    fn black(&mut self, row: usize, column: usize, count: usize) {
        let start = 4 * (row * self.width + self.left + column);
        self.pixels[start..start + 4 * count].copy_from_slice(&[[0, 0, 0, 255]; LANES].as_flattened()[..4 * count]);
    }
}

/// Linear floats.
struct Floats<'a> {
    pixels: &'a mut [[f32; 3]],
    width: usize,
    left: usize,
}

impl Put for Floats<'_> {
    #[inline(always)]
    fn rows(&self) -> usize {
        self.pixels.len() / self.width
    }

    #[inline(always)]
    fn across(&self) -> usize {
        (self.width - self.left).min(TILE_WIDTH)
    }

    #[inline(always)]
    fn put(&mut self, row: usize, column: usize, count: usize, [red, green, blue]: &[[f32; LANES]; 3]) {
        let start = row * self.width + self.left + column;
        for (lane, pixel) in self.pixels[start..start + count].iter_mut().enumerate() {
            *pixel = [red[lane], green[lane], blue[lane]];
        }
    }

    #[inline(always)]
    fn black(&mut self, row: usize, column: usize, count: usize) {
        let start = row * self.width + self.left + column;
        self.pixels[start..start + count].fill([0.0; 3]);
    }
}

/// Making pixels of the light of a tile.
struct Exposing<'a, P> {
    source: Source<'a>,
    exposure: Exposure,
    put: P,
}

impl<P: Put> Work for Exposing<'_, P> {
    #[inline(always)]
    fn run(mut self) {
        for row in 0..self.put.rows() {
            for column in (0..self.put.across()).step_by(LANES) {
                let count = LANES.min(self.put.across() - column);
                let mut colors = self.source.colors(row * STRIDE + column);
                // Most of a tile is dark as a rule.
                if colors.as_flattened().iter().fold(0, |bits, color| bits | color.to_bits()) == 0 {
                    self.put.black(row, column, count);
                    continue;
                }
                let [red, green, blue] = &mut colors;
                for ((red, green), blue) in red.iter_mut().zip(green).zip(blue) {
                    [*red, *green, *blue] = self.exposure.respond([*red, *green, *blue]);
                }
                self.put.put(row, column, count, &colors);
            }
        }
    }
}

/// Letting the slow components of a tile glow.
struct Glowing<'a> {
    tile: &'a mut Tile,
    /// Gun, what is left, and what comes of the light, for each component.
    gains: &'a [(usize, f32, f32)],
}

impl Work for Glowing<'_> {
    #[inline(always)]
    fn run(self) {
        let Tile { planes, lit, glow, glowing, .. } = self.tile;
        if !*glowing {
            glow.clear();
            glow.resize(self.gains.len() * PLANE, 0.0);
        }
        let mut strongest = 0.0;
        for (glow, (gun, left, gain)) in glow.chunks_exact_mut(PLANE).zip(self.gains) {
            let light = if *lit { planes.get(gun * PLANE..(gun + 1) * PLANE) } else { None };
            match light {
                Some(light) => {
                    glow.iter_mut().zip(light).for_each(|(glow, light)| *glow = glow.mul_add(*left, light * gain));
                }
                None => glow.iter_mut().for_each(|glow| *glow *= left),
            }
            strongest = glow.iter().fold(strongest, |most, glow| if *glow > most { *glow } else { most });
        }
        *glowing = strongest > DARK;
    }
}
