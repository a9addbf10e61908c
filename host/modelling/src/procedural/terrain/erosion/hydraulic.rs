//! Erosion by running water: all cells of a grid, step by step.

use super::flow::{FlowNumbers, FlowRow};
use super::ground::{BAND, ErodibleGround};
use super::settings::{ErosionEdge, ErosionSettings};
use rayon::prelude::*;

/// Rows of a band that are at hand at once.
const AT_HAND: i64 = 5;

/// Water on the ground, what it carries, and its fluxes.
#[derive(Clone, Debug)]
pub(super) struct RunningWater {
    numbers: FlowNumbers,
    state: WaterState,
    next: WaterState,
    /// Sums over the cells and steps, spacings.
    pub(super) totals: WaterTotals,
}

/// What is known of all cells at one time.
#[derive(Clone, Debug)]
struct WaterState {
    depth: Vec<f64>,
    load: Vec<f64>,
    /// Flux over the side to the next column.
    along: Vec<f64>,
    /// Flux over the side to the next row.
    across: Vec<f64>,
}

/// Sums over cells and steps, spacings.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WaterTotals {
    pub(super) evaporated: f64,
    pub(super) water_left: f64,
    pub(super) load_left: f64,
}

/// What a thread needs for a band.
struct WaterBand<'a> {
    ground: &'a ErodibleGround,
    state: &'a WaterState,
    numbers: FlowNumbers,
    rain_map: Option<&'a [f64]>,
}

/// The rows of a band after a step.
struct BandAfter<'a> {
    bed: &'a mut [f64],
    depth: &'a mut [f64],
    load: &'a mut [f64],
    along: &'a mut [f64],
    across: &'a mut [f64],
}

impl RunningWater {
    /// Water on a ground.
    ///
    /// - `depth`: its depth, spacings.
    pub(super) fn new(settings: &ErosionSettings, depth: Vec<f64>) -> RunningWater {
        let nothing = || vec![0.0; depth.len()];
        let state = WaterState { load: nothing(), along: nothing(), across: nothing(), depth };
        RunningWater {
            numbers: FlowNumbers {
                rain: settings.rain,
                evaporation: settings.evaporation,
                drag: settings.drag,
                capacity: settings.capacity,
                detachment: settings.detachment,
                settling: settings.settling,
                is_open: settings.edge == ErosionEdge::Open,
            },
            next: state.clone(),
            state,
            totals: WaterTotals::default(),
        }
    }

    /// Lets it rain and flow for a step.
    ///
    /// - `is_cancelled`: asked for each band; what is cancelled has no meaning.
    pub(super) fn step(
        &mut self,
        ground: &mut ErodibleGround,
        rain_map: Option<&[f64]>,
        is_cancelled: &(dyn Fn() -> bool + Sync),
    ) {
        let part = BAND * ground.columns;
        let mut next_bed = std::mem::take(&mut ground.next);
        let band = WaterBand { ground, state: &self.state, numbers: self.numbers, rain_map };
        let WaterState { depth, load, along, across } = &mut self.next;
        let water = depth.par_chunks_mut(part).zip(load.par_chunks_mut(part));
        let fluxes = along.par_chunks_mut(part).zip(across.par_chunks_mut(part));
        let totals: Vec<WaterTotals> = next_bed
            .par_chunks_mut(part)
            .zip(water)
            .zip(fluxes)
            .enumerate()
            .map(|(number, ((bed, (depth, load)), (along, across)))| {
                if is_cancelled() {
                    return WaterTotals::default();
                }
                band.step(number * BAND, BandAfter { bed, depth, load, along, across })
            })
            .collect();
        for band in &totals {
            self.totals.evaporated += band.evaporated;
            self.totals.water_left += band.water_left;
            self.totals.load_left += band.load_left;
        }
        ground.next = next_bed;
        ground.step();
        std::mem::swap(&mut self.state, &mut self.next);
    }

    /// All that is carried settles.
    pub(super) fn settle(&mut self, ground: &mut ErodibleGround) {
        ground.bed.par_iter_mut().zip(&mut self.state.load).for_each(|(bed, load)| *bed += std::mem::take(load));
    }

    /// Depth of the water, spacings.
    pub(super) fn into_depth(self) -> Vec<f64> {
        self.state.depth
    }

    /// Depth of the water, spacings.
    #[cfg(test)]
    pub(super) fn depth(&self) -> &[f64] {
        &self.state.depth
    }
}

impl WaterBand<'_> {
    /// A step of some rows. A row needs the loads beside it, these the fluxes of the rows beyond, these what the rows
    /// still further can give, and that their fluxes: so rows go through four stages, each a row behind the other.
    fn step(&self, first: usize, mut after: BandAfter<'_>) -> WaterTotals {
        let columns = self.ground.columns;
        let (begin, end) = (first as i64, (first + after.bed.len() / columns) as i64);
        let mut at_hand: Vec<FlowRow> = (0..AT_HAND).map(|_| FlowRow::new(columns)).collect();
        let last = self.ground.rows as i64;
        let is_near = |row: i64| (-1..=last).contains(&row);
        let is_cell = |row: i64| (0..last).contains(&row);
        let mut totals = WaterTotals::default();
        for row in begin - 3..end + 3 {
            if is_near(row) {
                self.prepare(row, &mut at_hand);
            }
            let limited = row - 1;
            if is_cell(limited) && limited >= begin - 2 {
                with(&mut at_hand, limited, |own, [_, south]| own.limit(south));
            }
            if is_near(limited) && limited >= (begin - 1).max(0) {
                with(&mut at_hand, limited, |own, [north, _]| own.limit_across(north));
            }
            let exchanged = row - 2;
            if is_cell(exchanged) && exchanged >= begin - 1 {
                let load = &self.state.load[self.cells(exchanged)];
                let own = (begin..end).contains(&exchanged);
                let ground = own.then(|| &mut after.bed[within(exchanged - begin, columns)]);
                with(&mut at_hand, exchanged, |own, beside| own.exchange(beside, load, ground, &self.numbers));
            }
            let carried = row - 3;
            if (begin..end).contains(&carried) {
                self.carry(carried, begin, &mut at_hand, &mut after, &mut totals);
            }
        }
        totals
    }

    /// Takes a row and finds the fluxes along it and to it.
    fn prepare(&self, row: i64, at_hand: &mut [FlowRow]) {
        let last = self.ground.rows as i64;
        let nearest = row.clamp(0, last - 1);
        let (bed, cells) = (&self.ground.bed[self.cells(nearest)], self.cells(nearest));
        with(at_hand, row, |own, [north, _]| {
            if row == nearest {
                let map = self.rain_map.map(|map| &map[cells.clone()]);
                own.take(bed, &self.state.depth[cells.clone()], self.numbers.rain, map);
                own.flow_along(&self.state.along[cells], &self.numbers);
            } else {
                own.take_beyond(bed);
            }
            // Beyond the first row there is nothing that it flows from.
            if row >= 0 {
                let before = (1..last).contains(&row).then(|| &self.state.across[self.cells(row - 1)]);
                own.flow_across(north, before, &self.numbers);
            }
        });
    }

    /// Moves water and load of a row, and keeps its fluxes.
    fn carry(
        &self,
        row: i64,
        begin: i64,
        at_hand: &mut [FlowRow],
        after: &mut BandAfter<'_>,
        totals: &mut WaterTotals,
    ) {
        let columns = self.ground.columns;
        let (cells, last) = (within(row - begin, columns), self.ground.rows as i64 - 1);
        with(at_hand, row, |own, [north, south]| {
            let (depth, load) = (&mut after.depth[cells.clone()], &mut after.load[cells.clone()]);
            totals.evaporated += own.carry([north, south], depth, load, &self.numbers);
            after.along[cells.clone()].copy_from_slice(&own.along[1..=columns]);
            after.across[cells].copy_from_slice(&south.across[1..=columns]);
            if !self.numbers.is_open {
                return;
            }
            let mut leave = |flux: f64, cell: usize| {
                totals.water_left += flux;
                totals.load_left += flux * own.density[cell];
            };
            leave(-own.along[0], 1);
            leave(own.along[columns], columns);
            for cell in 1..=columns {
                if row == 0 {
                    leave(-own.across[cell], cell);
                }
                if row == last {
                    leave(south.across[cell], cell);
                }
            }
        });
    }

    /// The cells of a row.
    fn cells(&self, row: i64) -> std::ops::Range<usize> {
        within(row, self.ground.columns)
    }
}

/// The numbers of the cells of a row.
fn within(row: i64, columns: usize) -> std::ops::Range<usize> {
    let first = row as usize * columns;
    first..first + columns
}

/// Works on a row that is at hand, with those before and after it.
fn with(at_hand: &mut [FlowRow], row: i64, work: impl FnOnce(&mut FlowRow, [&FlowRow; 2])) {
    let place = |row: i64| row.rem_euclid(AT_HAND) as usize;
    let mut own = std::mem::take(&mut at_hand[place(row)]);
    work(&mut own, [&at_hand[place(row - 1)], &at_hand[place(row + 1)]]);
    at_hand[place(row)] = own;
}
