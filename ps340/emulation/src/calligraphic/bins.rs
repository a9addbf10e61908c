//! The strokes that touch each tile, in their order.

use super::optics::Optics;
use super::tile::{TILE_HEIGHT, TILE_WIDTH};
use crate::traversal::Stroke;
use processes::widest::{self, Work};
use rayon::prelude::*;

/// Strokes that one task sorts. It has no influence on the light.
const CHUNK: usize = 2048;
/// Strokes that are looked at together. It has no influence on the light.
const BLOCK: usize = 1 << 17;
/// Strokes in all tiles together that are kept at a time: a bound on memory. It has no influence on the light.
const MOST: usize = 1 << 21;

/// The strokes of each tile. Its scratch buffers are reused from picture to picture.
#[derive(Clone, Debug, Default)]
pub(super) struct Bins {
    chunks: Vec<Chunk>,
    used: usize,
}

/// The strokes of each tile, of some neighbouring strokes.
#[derive(Clone, Debug, Default)]
struct Chunk {
    /// First and last column and row of tiles that each stroke touches; none where the first is greater.
    touched: Vec<[[u16; 2]; 2]>,
    /// Where the members of each tile begin in `members`; one entry more than tiles.
    starts: Vec<u32>,
    /// Strokes, tile after tile: copies, so that a tile finds its own side by side.
    members: Vec<Stroke>,
}

impl Bins {
    /// Sorts strokes, from the first on, into `columns` by `rows` tiles. Returns how many it took: as many as fit.
    pub fn sort(&mut self, optics: &Optics, strokes: &[Stroke], [columns, rows]: [usize; 2]) -> usize {
        let strokes = &strokes[..strokes.len().min(BLOCK)];
        let wanted = strokes.len().div_ceil(CHUNK);
        if self.chunks.len() < wanted {
            self.chunks.resize_with(wanted, Chunk::default);
        }
        let chunks = self.chunks.par_iter_mut().zip(strokes.par_chunks(CHUNK));
        chunks.for_each(|(chunk, strokes)| chunk.count(optics, strokes, columns, rows));
        let mut room = MOST;
        let fits = |chunk: &&Chunk| {
            let left = room.checked_sub(chunk.total());
            room = left.unwrap_or(0);
            left.is_some()
        };
        self.used = self.chunks[..wanted].iter().take_while(fits).count().max(wanted.min(1));
        let chunks = self.chunks[..self.used].par_iter_mut().zip(strokes.par_chunks(CHUNK));
        chunks.for_each(|(chunk, strokes)| chunk.fill(optics, strokes, columns));
        strokes.len().min(self.used * CHUNK)
    }

    /// The strokes that touch a tile.
    pub fn members(&self, tile: usize) -> impl Iterator<Item = &[Stroke]> {
        let range = move |chunk: &Chunk| chunk.starts[tile] as usize..chunk.starts[tile + 1] as usize;
        self.chunks[..self.used].iter().map(move |chunk| &chunk.members[range(chunk)])
    }
}

impl Chunk {
    /// Strokes in all tiles together, after [`Chunk::count`].
    fn total(&self) -> usize {
        self.starts.last().map_or(0, |total| *total as usize)
    }

    /// Counts the strokes of each tile.
    fn count(&mut self, optics: &Optics, strokes: &[Stroke], columns: usize, rows: usize) {
        let Self { touched, starts, .. } = self;
        touched.clear();
        widest::run(Touching { optics, strokes, touched });
        starts.clear();
        starts.resize(columns * rows + 1, 0);
        for (stroke, touched) in strokes.iter().zip(touched) {
            each_tile(optics, stroke, touched, columns, |tile| starts[tile] += 1);
        }
        // From counts to the ends of the bins; filling from the last stroke on makes the ends beginnings.
        let mut end = 0;
        for start in starts {
            end += *start;
            *start = end;
        }
    }

    /// Copies the strokes to their tiles.
    fn fill(&mut self, optics: &Optics, strokes: &[Stroke], columns: usize) {
        let total = self.total();
        let Self { touched, starts, members } = self;
        members.resize(total, Stroke::default());
        for (stroke, touched) in strokes.iter().zip(touched).rev() {
            each_tile(optics, stroke, touched, columns, |tile| {
                starts[tile] -= 1;
                members[starts[tile] as usize] = *stroke;
            });
        }
    }
}

/// Finding the tiles that strokes touch.
struct Touching<'a> {
    optics: &'a Optics,
    strokes: &'a [Stroke],
    touched: &'a mut Vec<[[u16; 2]; 2]>,
}

impl Work for Touching<'_> {
    #[inline(always)]
    fn run(self) {
        for stroke in self.strokes {
            self.touched.push(match self.optics.touched(stroke) {
                Some([[left, right], [top, bottom]]) => [
                    [(left / TILE_WIDTH) as u16, (right / TILE_WIDTH) as u16],
                    [(top / TILE_HEIGHT) as u16, (bottom / TILE_HEIGHT) as u16],
                ],
                None => [[1, 0]; 2],
            });
        }
    }
}

/// Calls for each tile that a stroke may touch. Where it crosses many, each row of tiles is looked at by itself.
#[inline(always)]
fn each_tile(optics: &Optics, stroke: &Stroke, [x, y]: &[[u16; 2]; 2], columns: usize, mut visit: impl FnMut(usize)) {
    let many = x[1] > x[0] + 1 && y[1] > y[0];
    for row in usize::from(y[0])..=usize::from(y[1]) {
        let mut range = [usize::from(x[0]), usize::from(x[1])];
        if many {
            let top = row * TILE_HEIGHT;
            let Some(touched) = optics.columns_touched(stroke, top, top + TILE_HEIGHT - 1) else { continue };
            range = touched.map(|column| column / TILE_WIDTH);
        }
        for column in range[0]..=range[1] {
            visit(row * columns + column);
        }
    }
}
