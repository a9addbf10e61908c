//! Squares of cells with their control heights and bounds, made from the next coarser ones when they are asked for.

use super::ground::{Control, Ground, SIDE, refined};
use super::patch::Patch;
use glam::DVec2;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// Control heights along a side: those of the cells and one more at both ends.
const CONTROLS: usize = SIDE + 2;
/// Cells of a block that one of its children covers, along a side.
pub(super) const HALF: usize = SIDE / 2;

/// A square of cells of one lattice.
pub(super) struct Block {
    level: u32,
    /// Number of the first cell along x and z.
    first: [i64; 2],
    /// The lower corner of that.
    pub(super) corner: DVec2,
    /// Side of a cell.
    pub(super) spacing: f64,
    controls: Vec<Control>,
    /// The cells that no finer lattice changes: for each row a bit a cell.
    finals: [u16; SIDE],
    bounds: Vec<CellBounds>,
    /// The four quarters on the next finer lattice.
    children: [OnceLock<Box<Block>>; 4],
}

/// Bounds of the surface over a cell, two numbers of single precision in one word, above and below a height of the
/// block; they may become narrower.
struct CellBounds(AtomicU64);

impl Block {
    /// Bytes that one takes.
    pub(super) const BYTES: u64 = (size_of::<Block>()
        + CONTROLS * CONTROLS * size_of::<Control>()
        + SIDE * SIDE * size_of::<CellBounds>()) as u64;

    /// The whole terrain.
    ///
    /// - `asked`: counts heights that the function was asked for.
    pub(super) fn root(ground: &Ground, asked: &mut u64) -> Block {
        *asked += (CONTROLS * CONTROLS) as u64;
        let controls = each_control().map(|[x, z]| ground.coarsest([x as i64 - 1, z as i64 - 1])).collect();
        Block::bounded(ground, 0, [0, 0], controls, asked)
    }

    /// The quarter of a block that has a cell, on the next finer lattice.
    ///
    /// - `made`: called when it had to be made, with how many heights the function was asked for.
    pub(super) fn quarter(&self, ground: &Ground, cell: [usize; 2], made: impl FnOnce(u64)) -> &Block {
        let quarter = cell.map(|axis| axis / HALF);
        self.children[2 * quarter[1] + quarter[0]].get_or_init(|| {
            let mut asked = 0;
            let block = Box::new(self.refined(ground, quarter, &mut asked));
            made(asked);
            block
        })
    }

    fn refined(&self, ground: &Ground, quarter: [usize; 2], asked: &mut u64) -> Block {
        let level = self.level + 1;
        let first: [i64; 2] = std::array::from_fn(|axis| 2 * (self.first[axis] + (quarter[axis] * HALF) as i64));
        let controls = each_control().map(|at| {
            // The control of the coarser lattice that is nearest, and on which side of it this one is.
            let near: [usize; 2] = std::array::from_fn(|axis| quarter[axis] * HALF + at[axis].div_ceil(2));
            let towards = at.map(|axis| if axis % 2 == 1 { -1 } else { 1 });
            let of = |x: i64, z: i64| {
                self.controls
                    [near[1].wrapping_add_signed(z as isize) * CONTROLS + near[0].wrapping_add_signed(x as isize)]
            };
            let cell = std::array::from_fn(|axis| first[axis] + at[axis] as i64 - 1);
            ground.finer(level, cell, refined(of, towards), asked)
        });
        let controls = controls.collect();
        Block::bounded(ground, level, first, controls, asked)
    }

    fn bounded(ground: &Ground, level: u32, first: [i64; 2], controls: Vec<Control>, asked: &mut u64) -> Block {
        let (corner, spacing) = (ground.corner_of(level, first), ground.spacing(level));
        let (bounds, finals, children) = (Vec::new(), [0; SIDE], Default::default());
        let mut block = Block { level, first, corner, spacing, controls, finals, bounds, children };
        if level == ground.finest {
            block.finals = [!0; SIDE];
        } else {
            for z in 0..SIDE {
                block.finals[z] = (0..SIDE).map(|x| u16::from(!block.is_divided([x, z])) << x).sum();
            }
        }
        let cells = (0..SIDE * SIDE).map(|k| [k % SIDE, k / SIDE]);
        let bounds = cells.map(|cell| {
            let [mut low, mut high] = block.patch(cell).range();
            if !block.is_final(cell) {
                *asked += 1;
                let of_function = ground.bounds(block.corner_of(cell) + 0.5 * spacing, spacing);
                (low, high) = (low.min(of_function[0]), high.max(of_function[1]));
            }
            CellBounds::new([low - block.datum(), high - block.datum()])
        });
        block.bounds = bounds.collect();
        block
    }

    /// Drops all finer cells.
    pub(super) fn forget(&mut self) {
        self.children = Default::default();
    }

    /// The lower corner of a cell.
    #[inline]
    pub(super) fn corner_of(&self, [x, z]: [usize; 2]) -> DVec2 {
        self.corner + DVec2::new(x as f64, z as f64) * self.spacing
    }

    /// The height of which bounds are kept as differences.
    fn datum(&self) -> f64 {
        self.controls[0].height
    }

    /// The polynomial that the surface is over a cell, unless a finer lattice tells it.
    pub(super) fn patch(&self, [x, z]: [usize; 2]) -> Patch {
        let row = |dz: usize| {
            let from = (z + dz) * CONTROLS + x;
            [0, 1, 2].map(|dx| self.controls[from + dx].height)
        };
        Patch::new([row(0), row(1), row(2)])
    }

    /// Whether a finer lattice is wanted somewhere over a cell.
    fn is_divided(&self, [x, z]: [usize; 2]) -> bool {
        let is_wanted = |k: usize| f64::from(self.controls[(z + k / 3) * CONTROLS + x + k % 3].wanted) < self.spacing;
        (0..9).any(is_wanted)
    }

    /// Whether no finer lattice changes the surface over a cell.
    #[inline]
    pub(super) fn is_final(&self, [x, z]: [usize; 2]) -> bool {
        self.finals[z] >> x & 1 == 1
    }

    /// Bounds of the surface over a cell.
    #[inline]
    pub(super) fn bounds(&self, [x, z]: [usize; 2]) -> [f64; 2] {
        self.bounds[z * SIDE + x].get().map(|bound| self.datum() + f64::from(bound))
    }

    /// Narrows the bounds over a cell to those of the four that divide it.
    pub(super) fn narrow(&self, cell: [usize; 2], finer: &Block) {
        let first = cell.map(|axis| axis % HALF * 2);
        let parts = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, z]| finer.bounds([first[0] + x, first[1] + z]));
        let low = parts.iter().map(|part| part[0]).fold(f64::INFINITY, f64::min) - self.datum();
        let high = parts.iter().map(|part| part[1]).fold(f64::NEG_INFINITY, f64::max) - self.datum();
        let bounds = &self.bounds[cell[1] * SIDE + cell[0]];
        let [old_low, old_high] = bounds.get().map(f64::from);
        if low > old_low || high < old_high {
            bounds.set([low.max(old_low), high.min(old_high)]);
        }
    }
}

impl CellBounds {
    fn new(bounds: [f64; 2]) -> CellBounds {
        let new = CellBounds(AtomicU64::new(0));
        new.set(bounds);
        new
    }

    fn get(&self) -> [f32; 2] {
        let word = self.0.load(Ordering::Relaxed);
        [f32::from_bits(word as u32), f32::from_bits((word >> 32) as u32)]
    }

    /// Whichever thread comes last, all that are set are bounds.
    fn set(&self, [low, high]: [f64; 2]) {
        // Rounded outwards.
        let (down, up) = (low as f32, high as f32);
        let down = if f64::from(down) > low { down.next_down() } else { down };
        let up = if f64::from(up) < high { up.next_up() } else { up };
        self.0.store(u64::from(down.to_bits()) | u64::from(up.to_bits()) << 32, Ordering::Relaxed);
    }
}

/// The controls of a block, row by row.
fn each_control() -> impl Iterator<Item = [usize; 2]> {
    (0..CONTROLS * CONTROLS).map(|k| [k % CONTROLS, k / CONTROLS])
}
