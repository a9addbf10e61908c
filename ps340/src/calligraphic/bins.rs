//! Which strokes touch which tile, in their order.

use super::light::{TILE_HEIGHT, TILE_WIDTH};
use super::optics::Optics;
use crate::traversal::Stroke;
use rayon::prelude::*;

/// Strokes that one task sorts. It has no influence on the light.
const CHUNK: usize = 4096;

/// The strokes of each tile. The room is kept from picture to picture.
#[derive(Clone, Debug, Default)]
pub(super) struct Bins {
    chunks: Vec<Chunk>,
    used: usize,
}

/// The same for some neighbouring strokes.
#[derive(Clone, Debug, Default)]
struct Chunk {
    /// Index of the first stroke.
    first: usize,
    /// First and last column and row of tiles that each stroke touches; none where the first is greater.
    touched: Vec<[[u16; 2]; 2]>,
    /// Where the members of each tile begin in `members`; one entry more than tiles.
    starts: Vec<u32>,
    /// Indices of strokes, tile after tile.
    members: Vec<u32>,
}

impl Bins {
    /// Sorts strokes into `columns` by `rows` tiles.
    pub fn sort(&mut self, optics: &Optics, strokes: &[Stroke], [columns, rows]: [usize; 2]) {
        self.used = strokes.len().div_ceil(CHUNK);
        if self.chunks.len() < self.used {
            self.chunks.resize_with(self.used, Chunk::default);
        }
        let chunks = self.chunks.par_iter_mut().zip(strokes.par_chunks(CHUNK)).enumerate();
        chunks.for_each(|(index, (chunk, strokes))| {
            chunk.first = index * CHUNK;
            chunk.sort(optics, strokes, columns, rows);
        });
    }

    /// The indices of the strokes that touch a tile.
    pub fn members(&self, tile: usize) -> impl Iterator<Item = usize> {
        self.chunks[..self.used].iter().flat_map(move |chunk| {
            let members = &chunk.members[chunk.starts[tile] as usize..chunk.starts[tile + 1] as usize];
            members.iter().map(|member| *member as usize)
        })
    }
}

impl Chunk {
    /// Sorts by counting.
    fn sort(&mut self, optics: &Optics, strokes: &[Stroke], columns: usize, rows: usize) {
        let tiles = |[low, high]: [usize; 2], size: usize| [(low / size) as u16, (high / size) as u16];
        self.touched.clear();
        self.touched.extend(strokes.iter().map(|stroke| match optics.touched(stroke) {
            Some([x, y]) => [tiles(x, TILE_WIDTH), tiles(y, TILE_HEIGHT)],
            None => [[1, 0]; 2],
        }));
        let Self { first, touched, starts, members } = self;
        starts.clear();
        starts.resize(columns * rows + 1, 0);
        let mut total = 0;
        for (stroke, touched) in strokes.iter().zip(&*touched) {
            each_tile(optics, stroke, touched, columns, |tile| {
                starts[tile] += 1;
                total += 1;
            });
        }
        // From counts to the ends of the bins; filling from the last stroke on makes the ends beginnings.
        let mut end = 0;
        for start in starts.iter_mut() {
            end += *start;
            *start = end;
        }
        members.clear();
        members.resize(total, 0);
        for (index, (stroke, touched)) in strokes.iter().zip(&*touched).enumerate().rev() {
            each_tile(optics, stroke, touched, columns, |tile| {
                starts[tile] -= 1;
                members[starts[tile] as usize] = (*first + index) as u32;
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
