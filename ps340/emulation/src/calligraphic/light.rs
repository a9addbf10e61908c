//! The light that strokes leave on the screen, pixel by pixel, in tiles.

use super::bins::Bins;
use super::optics::Optics;
use super::{
    tile::{PLANE, STRIDE, TILE_HEIGHT, TILE_WIDTH, Tile, tiles},
    track::{Scratch, Track},
};
use crate::traversal::Stroke;
use processes::widest::{self, Work};
use rayon::prelude::*;

/// Strokes that are prepared before they are written, so that the processor waits for none of them. It has no influence
/// on the light.
const STROKES: usize = 16;

/// Light per pixel; 1 is the centre of a long stroke of intensity 1.
#[derive(Clone, Debug, PartialEq)]
pub struct ScreenLight {
    pub(super) optics: Optics,
    /// Guns of the tube: three that write red, green and blue, or one.
    pub(super) guns: usize,
    /// Row after row from the top.
    pub(super) tiles: Vec<Tile>,
}

impl ScreenLight {
    /// A dark screen.
    pub(super) fn dark(optics: Optics, guns: usize) -> Self {
        let [columns, rows] = tiles(optics.size);
        Self { optics, guns, tiles: vec![Tile::default(); columns * rows] }
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.optics.size[0] as u32
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.optics.size[1] as u32
    }

    /// Light for red, green and blue of the pixel in column `x` from the left and row `y` from the top, before the
    /// phosphor gives it its colour; `None` outside the picture. With a single gun all three are the same.
    pub fn at(&self, x: u32, y: u32) -> Option<[f32; 3]> {
        let (x, y) = (x as usize, y as usize);
        if x >= self.optics.size[0] || y >= self.optics.size[1] {
            return None;
        }
        let tile = &self.tiles[y / TILE_HEIGHT * self.columns() + x / TILE_WIDTH];
        let place = y % TILE_HEIGHT * STRIDE + x % TILE_WIDTH;
        Some([0, 1, 2].map(|channel| match tile.lit {
            true => tile.planes[channel.min(self.guns - 1) * PLANE + place],
            false => 0.0,
        }))
    }

    /// All the light on the screen, for red, green and blue.
    ///
    /// Its unit is the light of a stroke of length 1 (in screen units) and intensity 1, so that a stroke
    /// within the screen adds length times mean intensity times colour.
    pub fn total(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for y in 0..self.height() {
            for x in 0..self.width() {
                let light = self.at(x, y).unwrap_or_default();
                sum = [0, 1, 2].map(|channel| sum[channel] + f64::from(light[channel]));
            }
        }
        // Across a line of peak 1 lie sqrt(2 pi) spot pixels of light; a screen unit has `half` pixels.
        let Optics { half, spot, peak, .. } = self.optics;
        sum.map(|sum| sum / half / ((2.0 * std::f64::consts::PI).sqrt() * spot * peak))
    }

    /// Pixels on which light falls.
    pub fn lit_pixels(&self) -> u64 {
        let lit = |tile: &&Tile| tile.lit;
        let pixels = self.tiles.iter().filter(lit).flat_map(|tile| {
            let rows = (0..TILE_HEIGHT).flat_map(|y| (0..TILE_WIDTH).map(move |x| y * STRIDE + x));
            rows.map(|place| (0..self.guns).any(|gun| tile.planes[gun * PLANE + place] > 0.0))
        });
        pixels.filter(|lit| *lit).count() as u64
    }

    /// Columns of tiles.
    pub(super) fn columns(&self) -> usize {
        tiles(self.optics.size)[0]
    }

    /// Writes strokes in their order in place of what was written before.
    ///
    /// The light is the same for any number of threads: each tile belongs to one task, which adds the strokes in their
    /// order.
    pub(super) fn write(&mut self, bins: &mut Bins, strokes: &[Stroke]) {
        self.tiles.par_iter_mut().for_each(|tile| tile.lit = false);
        self.add(bins, strokes);
    }

    /// Writes more strokes after those that were written before.
    pub(super) fn add(&mut self, bins: &mut Bins, strokes: &[Stroke]) {
        let (optics, guns, extent) = (self.optics, self.guns, tiles(self.optics.size));
        let mut rest = strokes;
        while !rest.is_empty() {
            let taken = bins.sort(&optics, rest, extent);
            rest = &rest[taken..];
            let bins = &*bins;
            self.tiles.par_iter_mut().enumerate().for_each(|(index, tile)| {
                let corner = [index % extent[0] * TILE_WIDTH, index / extent[0] * TILE_HEIGHT];
                widest::run(Writing { optics: &optics, guns, corner, bins, index, tile });
            });
        }
    }
}

/// Adding strokes to a tile.
pub(super) struct Writing<'a> {
    pub optics: &'a Optics,
    pub guns: usize,
    /// The first pixel of the tile.
    pub corner: [usize; 2],
    pub bins: &'a Bins,
    /// Of the tile.
    pub index: usize,
    pub tile: &'a mut Tile,
}

impl Work for Writing<'_> {
    #[inline(always)]
    fn run(self) {
        let Self { optics, guns, corner, bins, index, tile } = self;
        let mut strokes = bins.members(index).flatten().peekable();
        if strokes.peek().is_none() {
            return;
        }
        let mut rooms = [const { Scratch::new() }; STROKES];
        let mut tracks = Vec::with_capacity(STROKES);
        loop {
            tracks.clear();
            while tracks.len() < STROKES
                && let Some(stroke) = strokes.next()
            {
                if let Some(track) = Track::new(optics, stroke, corner) {
                    tracks.push(track);
                }
            }
            if tracks.is_empty() {
                return;
            }
            if !tile.lit {
                tile.lit = true;
                tile.planes.resize(guns * PLANE, 0.0);
                tile.planes.fill(0.0);
            }
            for (track, room) in tracks.iter().zip(&mut rooms) {
                track.find(room);
            }
            for (track, room) in tracks.iter().zip(&rooms) {
                track.write(room, &mut tile.planes);
            }
        }
    }
}
