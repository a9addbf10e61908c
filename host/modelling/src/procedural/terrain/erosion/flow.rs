//! A step of running water, row by row: pipes between neighbours, their limits, what water takes up, drops and carries.
//!
//! Lengths are in spacings, times in steps, and gravity is 1: a step is the time in which a body at rest falls half a
//! spacing. A row of cells has one more cell at each end, which stands for what is beyond the edge.

/// Deepest stream of a pipe. Long waves of this depth go half a cell in a step: dt sqrt(g h) / dx = 0.5 meets the
/// condition of Courant, Friedrichs and Lewy for two dimensions, 1 / sqrt 2. Deeper water levels out more slowly than
/// it would.
const DEEPEST_PIPE: f64 = 0.25;
/// Steeper than this, streams are no stronger.
const STEEPEST: f64 = 1.0;
/// A cell is dug by at most this part of what it lies above the lowest neighbour that it flows to.
const MOST_DUG: f64 = 0.25;
/// Water carries at most this part of its depth: more would come to rest in heaps above it.
const DENSEST: f64 = 0.3;
/// Keeps quotients finite where there is nothing.
const TINY: f64 = 1e-300;

/// The numbers of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlowNumbers {
    pub(super) rain: f64,
    pub(super) evaporation: f64,
    pub(super) drag: f64,
    pub(super) capacity: f64,
    pub(super) detachment: f64,
    pub(super) settling: f64,
    pub(super) is_open: bool,
}

/// Heights, water and levels of a row, with a cell beyond each end.
#[derive(Clone, Debug, Default)]
pub(super) struct FlowRow {
    pub(super) bed: Vec<f64>,
    pub(super) depth: Vec<f64>,
    pub(super) level: Vec<f64>,
    /// Flux over the side before each cell along x, and after the last one.
    pub(super) along: Vec<f64>,
    /// Flux over the side to the row before.
    pub(super) across: Vec<f64>,
    /// What part of the fluxes out of a cell it can give.
    pub(super) part: Vec<f64>,
    /// Load after water took up and dropped.
    pub(super) load: Vec<f64>,
    /// Load over depth.
    pub(super) density: Vec<f64>,
}

impl FlowRow {
    pub(super) fn new(columns: usize) -> FlowRow {
        let cells = || vec![0.0; columns + 2];
        FlowRow {
            bed: cells(),
            depth: cells(),
            level: cells(),
            along: cells(),
            across: cells(),
            part: cells(),
            load: cells(),
            density: cells(),
        }
    }

    /// Takes a row of cells, on which it has rained.
    ///
    /// - `rain`: depth, times a number for each cell where such are given.
    pub(super) fn take(&mut self, bed: &[f64], depth: &[f64], rain: f64, map: Option<&[f64]>) {
        let count = bed.len();
        self.bed[1..=count].copy_from_slice(bed);
        self.bed[0] = bed[0];
        self.bed[count + 1] = bed[count - 1];
        let wet = &mut self.depth[1..=count];
        match map {
            Some(map) => {
                for ((wet, depth), by) in wet.iter_mut().zip(depth).zip(map) {
                    *wet = depth + rain * by;
                }
            }
            None => {
                for (wet, depth) in wet.iter_mut().zip(depth) {
                    *wet = depth + rain;
                }
            }
        }
        self.depth[0] = 0.0;
        self.depth[count + 1] = 0.0;
        for ((level, bed), depth) in self.level.iter_mut().zip(&self.bed).zip(&self.depth) {
            *level = bed + depth;
        }
    }

    /// Becomes what is beyond the first or the last row.
    pub(super) fn take_beyond(&mut self, bed: &[f64]) {
        let count = bed.len();
        self.bed[1..=count].copy_from_slice(bed);
        self.level[1..=count].copy_from_slice(bed);
        for (values, value) in
            [(&mut self.depth, 0.0), (&mut self.along, 0.0), (&mut self.load, 0.0), (&mut self.density, 0.0)]
        {
            values.fill(value);
        }
        self.part.fill(1.0);
    }

    /// Fluxes along the row.
    ///
    /// - `before`: those of the step before over the side after each cell.
    pub(super) fn flow_along(&mut self, before: &[f64], numbers: &FlowNumbers) {
        let count = before.len();
        let (bed, level, along) = (&self.bed, &self.level, &mut self.along);
        let at_end = |side: usize| {
            if !numbers.is_open {
                return 0.0;
            }
            pipe(0.0, [level[side], level[side + 1]], [bed[side], bed[side + 1]], numbers.drag)
        };
        (along[0], along[count]) = (at_end(0), at_end(count));
        let inner = count - 1;
        let ([low, high], [from, to]) =
            ([&bed[1..=inner], &bed[2..inner + 2]], [&level[1..=inner], &level[2..inner + 2]]);
        let (along, before) = (&mut along[1..=inner], &before[..inner]);
        for side in 0..inner {
            along[side] = pipe(before[side], [from[side], to[side]], [low[side], high[side]], numbers.drag);
        }
    }

    /// Fluxes from the row before to this one.
    ///
    /// - `before`: those of the step before; none at the edge.
    pub(super) fn flow_across(&mut self, north: &FlowRow, before: Option<&[f64]>, numbers: &FlowNumbers) {
        let count = self.bed.len() - 2;
        let cells = 1..=count;
        let ([low, high], [from, to]) = (
            [&north.bed[cells.clone()], &self.bed[cells.clone()]],
            [&north.level[cells.clone()], &self.level[cells.clone()]],
        );
        let across = &mut self.across[cells];
        match before {
            Some(before) => {
                let before = &before[..count];
                for side in 0..count {
                    across[side] = pipe(before[side], [from[side], to[side]], [low[side], high[side]], numbers.drag);
                }
            }
            None if numbers.is_open => {
                for side in 0..count {
                    across[side] = pipe(0.0, [from[side], to[side]], [low[side], high[side]], numbers.drag);
                }
            }
            None => across.fill(0.0),
        }
    }

    /// Finds what part of the fluxes out of the cells they can give, and limits those along the row.
    pub(super) fn limit(&mut self, south: &FlowRow) {
        let count = self.bed.len() - 2;
        let (west, east) = (&self.along[..count], &self.along[1..=count]);
        let (north, south, depth) = (&self.across[1..=count], &south.across[1..=count], &self.depth[1..=count]);
        let part = &mut self.part[1..=count];
        for cell in 0..count {
            let out = (positive(east[cell]) + positive(-west[cell])) + (positive(south[cell]) + positive(-north[cell]));
            part[cell] = lesser(1.0, depth[cell] / (out + TINY));
        }
        (self.part[0], self.part[count + 1]) = (1.0, 1.0);
        let (from, to, along) = (&self.part[..=count], &self.part[1..count + 2], &mut self.along[..=count]);
        for side in 0..=count {
            along[side] *= if along[side] > 0.0 { from[side] } else { to[side] };
        }
    }

    /// Limits the fluxes from the row before.
    pub(super) fn limit_across(&mut self, north: &FlowRow) {
        let count = self.bed.len() - 2;
        let (from, to, across) = (&north.part[..count + 2], &self.part[..count + 2], &mut self.across[..count + 2]);
        for side in 0..count + 2 {
            across[side] *= if across[side] > 0.0 { from[side] } else { to[side] };
        }
    }

    /// Takes up from the bed what the stream can carry more, or drops what it carries too much.
    ///
    /// The power of a stream is the sum over the sides by which water leaves of flux times drop, so that a stream is as
    /// strong across the axes as along them. Its load is capacity times power^(3/2), and at most a part
    /// of its depth.
    ///
    /// - `load`: that before.
    /// - `ground`: gets the heights after.
    ///
    /// # Source
    /// Load by a power of 3/2 of stream power: Bagnold 1980. Take-up and settling in proportion to what is missing or
    /// too much: Mei, Decaudin and Hu 2007, eqs. 11 and 12.
    pub(super) fn exchange(
        &mut self,
        [north, south]: [&FlowRow; 2],
        load: &[f64],
        ground: Option<&mut [f64]>,
        numbers: &FlowNumbers,
    ) {
        let count = load.len();
        let cells = 1..=count;
        let (west, east) = (&self.along[..count], &self.along[1..=count]);
        let (up, down) = (&self.across[cells.clone()], &south.across[cells.clone()]);
        let (level_west, level_east) = (&self.level[..count], &self.level[2..count + 2]);
        let (level, depth) = (&self.level[cells.clone()], &self.depth[cells.clone()]);
        let (level_north, level_south) = (&north.level[cells.clone()], &south.level[cells.clone()]);
        let (loaded, density) = (&mut self.load[cells.clone()], &mut self.density[cells.clone()]);
        for cell in 0..count {
            let here = level[cell];
            let outs = [positive(-west[cell]), positive(east[cell]), positive(-up[cell]), positive(down[cell])];
            let drops = [
                positive(here - level_west[cell]),
                positive(here - level_east[cell]),
                positive(here - level_north[cell]),
                positive(here - level_south[cell]),
            ];
            let power = |side: usize| outs[side] * lesser(drops[side], STEEPEST);
            let power = (power(0) + power(1)) + (power(2) + power(3));
            let deepest = greater(greater(drops[0], drops[1]), greater(drops[2], drops[3]));
            let most = lesser(numbers.capacity * power * power.sqrt(), DENSEST * depth[cell]);
            let lack = most - load[cell];
            let taken = lesser(numbers.detachment * positive(lack), MOST_DUG * deepest);
            let gain = taken - numbers.settling * positive(-lack);
            loaded[cell] = load[cell] + gain;
            density[cell] = loaded[cell] / (depth[cell] + TINY);
        }
        if let Some(ground) = ground {
            let (ground, loaded, bed) = (&mut ground[..count], &self.load[cells.clone()], &self.bed[cells]);
            for cell in 0..count {
                ground[cell] = bed[cell] - (loaded[cell] - load[cell]);
            }
        }
    }

    /// Moves water and load over the sides of the cells, and lets water evaporate.
    ///
    /// The load that goes over a side is that of the water that goes over it (upwind), so that all that leaves a cell
    /// enters another.
    ///
    /// - `depths`, `loads`: get what is there after.
    /// - Returns the depth that evaporated, summed over the row.
    pub(super) fn carry(
        &self,
        [north, south]: [&FlowRow; 2],
        depths: &mut [f64],
        loads: &mut [f64],
        numbers: &FlowNumbers,
    ) -> f64 {
        let count = depths.len();
        let cells = 1..=count;
        let (west, east) = (&self.along[..count], &self.along[1..=count]);
        let (up, down) = (&self.across[cells.clone()], &south.across[cells.clone()]);
        let (here_west, here_east) = (&self.density[..count], &self.density[2..count + 2]);
        let (density, depth) = (&self.density[cells.clone()], &self.depth[cells.clone()]);
        let (here_north, here_south) = (&north.density[cells.clone()], &south.density[cells.clone()]);
        let (load, loads) = (&self.load[cells], &mut loads[..count]);
        let upwind = |flux: f64, from: f64, to: f64| flux * if flux > 0.0 { from } else { to };
        for cell in 0..count {
            let here = density[cell];
            let along = upwind(west[cell], here_west[cell], here) - upwind(east[cell], here, here_east[cell]);
            let across = upwind(up[cell], here_north[cell], here) - upwind(down[cell], here, here_south[cell]);
            loads[cell] = positive(load[cell] + (along + across));
            depths[cell] = positive(depth[cell] + ((west[cell] - east[cell]) + (up[cell] - down[cell])));
        }
        let mut sums = [0.0; 4];
        for four in depths.chunks_mut(4) {
            for (sum, depth) in sums.iter_mut().zip(four) {
                *sum += *depth;
                *depth *= 1.0 - numbers.evaporation;
            }
        }
        ((sums[0] + sums[1]) + (sums[2] + sums[3])) * numbers.evaporation
    }
}

/// The flux through a pipe between two cells after a step: gravity drives it, the drag of the bed slows it down.
///
/// q + c q |q| / h^2 = q0 + h (level difference), solved for q, with h the depth of the water over the higher bed.
///
/// # Source
/// Pipes: O'Brien and Hodgins 1995. The depth of flow over the higher bed and drag at the new time: Bates, Horritt and
/// Fewtrell 2010; the equation is solved exactly here.
#[inline(always)]
fn pipe(before: f64, level: [f64; 2], bed: [f64; 2], drag: f64) -> f64 {
    let depth = lesser(positive(greater(level[0], level[1]) - greater(bed[0], bed[1])), DEEPEST_PIPE);
    let driven = before + depth * (level[0] - level[1]);
    let root = (depth * depth + 4.0 * drag * driven.abs()).sqrt();
    2.0 * driven * depth / (depth + root + TINY)
}

/// The greater of two numbers, in one instruction; neither is none.
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The lesser of two numbers, in one instruction; neither is none.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// A number, or 0 if it is negative.
#[inline(always)]
fn positive(a: f64) -> f64 {
    if a > 0.0 { a } else { 0.0 }
}
