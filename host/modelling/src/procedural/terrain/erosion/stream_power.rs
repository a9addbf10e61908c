//! Erosion by rivers over long times: uplift against stream power.

use super::super::error::TerrainError;
use super::account::range_of;
use super::drainage::Drainage;
use super::ground::{BAND, ErodibleGround};
use super::hillslope::Hillslopes;
use super::receivers::{NONE, Receivers};
use super::settings::ErosionSettings;
use crate::stages::stage;
use rayon::prelude::*;

/// Most steps of the method of Newton for a height; a few are taken.
const MOST_ROUNDS: usize = 60;

/// How the erosion by rivers ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RiverOutcome {
    /// Steps that were taken.
    pub steps: usize,
    /// Largest change of a height in the last step, units of length.
    pub largest_change: f64,
    /// Whether that is below the tolerance times the relief, the greatest height less the least one, of the start or of
    /// the end, whichever is larger. If not, the heights are those after as many steps as there may be.
    pub is_steady: bool,
}

/// What rivers moved, as heights of cells.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RiverTotals {
    pub(super) uplifted: f64,
    pub(super) left: f64,
}

/// Erodes the ground by rivers, until it changes little.
///
/// dh/dt = U - K A^m S^n, with the height of the receiver at the new time: stable for every step, and steady where S =
/// (U / K)^(1/n) A^(-m/n). The edge of the grid is the base level: it is neither uplifted nor eroded. Cells that lie
/// below their receiver, in depressions, are not eroded; what is eroded leaves over the edge.
///
/// - `is_cancelled`: asked several times a step.
///
/// # Errors
/// [`TerrainError::Cancelled`], and [`TerrainError::Parameter`] for a diffusivity that is too large for the spacing.
///
/// # Source
/// Braun and Willett 2013.
pub(super) fn run_rivers(
    ground: &mut ErodibleGround,
    drainage: &mut Drainage,
    settings: &ErosionSettings,
    spacing: f64,
    is_cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<(RiverOutcome, RiverTotals), TerrainError> {
    let hillslopes = Hillslopes::new(settings.diffusivity, settings.river_interval, spacing)?;
    let most = settings.river_steps.round() as usize;
    let (mut outcome, mut totals) = (RiverOutcome::default(), RiverTotals::default());
    let relief_of = |ground: &ErodibleGround| {
        let [low, high] = range_of(&ground.bed);
        high - low
    };
    let first_relief = relief_of(ground);
    let mut law = StreamPower::new(settings, spacing, ground.bed.len());
    let uplift = Uplift { rise: settings.uplift * settings.river_interval, map: settings.uplift_map.as_deref() };
    let stage = stage!("eroding the terrain by rivers", most as f64, "steps");
    let mut before = if hillslopes.is_any() { ground.bed.clone() } else { Vec::new() };
    let stopped = || if is_cancelled() { Err(TerrainError::Cancelled) } else { Ok(()) };
    while outcome.steps < most && !outcome.is_steady {
        stopped()?;
        before.clone_from_slice(if hillslopes.is_any() { &ground.bed } else { &[] });
        drainage.find(&ground.bed, is_cancelled)?;
        law.prepare(drainage);
        stopped()?;
        outcome.largest_change = law.step(ground, drainage, uplift, &mut totals);
        if hillslopes.is_any() {
            totals.left += hillslopes.step(ground, is_cancelled);
            let changes = before.par_iter_mut().zip(&ground.bed);
            changes.for_each(|(before, after)| *before = (after - *before).abs());
            outcome.largest_change = range_of(&before)[1];
        }
        let (receivers, bed) = (&drainage.receivers, &ground.bed);
        ground.rock.par_iter_mut().enumerate().for_each(|(cell, rock)| {
            let risen = if receivers.is_base(cell) { *rock } else { *rock + uplift.of(cell) };
            *rock = risen.min(bed[cell]);
        });
        outcome.steps += 1;
        outcome.is_steady = outcome.largest_change <= settings.tolerance * relief_of(ground).max(first_relief);
        stage.progress(outcome.steps as f64);
    }
    Ok((outcome, totals))
}

/// Uplift in a step.
#[derive(Clone, Copy, Debug)]
struct Uplift<'a> {
    rise: f64,
    map: Option<&'a [f64]>,
}

impl Uplift<'_> {
    #[inline]
    fn of(&self, cell: usize) -> f64 {
        self.map.map_or(self.rise, |map| self.rise * map[cell])
    }
}

/// The law of stream power for a step.
#[derive(Clone, Debug)]
struct StreamPower {
    /// K dt.
    factor: f64,
    area_exponent: f64,
    slope_exponent: f64,
    spacing: f64,
    /// K dt A^m / d^n of each cell, with the distance d of its receiver.
    factors: Vec<f64>,
}

impl StreamPower {
    fn new(settings: &ErosionSettings, spacing: f64, count: usize) -> StreamPower {
        StreamPower {
            factor: settings.erodibility * settings.river_interval,
            area_exponent: settings.area_exponent,
            slope_exponent: settings.slope_exponent,
            spacing,
            factors: vec![0.0; count],
        }
    }

    /// Finds the factors of all cells.
    fn prepare(&mut self, drainage: &Drainage) {
        let (m, n) = (self.area_exponent, self.slope_exponent);
        let of_distance = |spacings: f64| self.factor / power(spacings * self.spacing, n);
        let (near, far) = (of_distance(1.0), of_distance(Receivers::distance(4)));
        let cell_area = self.spacing * self.spacing;
        let cells = drainage.counts.par_chunks(BAND * 64).zip(drainage.receivers.directions.par_chunks(BAND * 64));
        self.factors.par_chunks_mut(BAND * 64).zip(cells).for_each(|(factors, (counts, directions))| {
            for ((factor, count), direction) in factors.iter_mut().zip(counts).zip(directions) {
                *factor = power(f64::from(*count) * cell_area, m) * if *direction < 4 { near } else { far };
            }
        });
    }

    /// Uplifts and erodes all cells, each after its receiver.
    ///
    /// - Returns the largest change of a height.
    fn step(
        &self,
        ground: &mut ErodibleGround,
        drainage: &Drainage,
        uplift: Uplift<'_>,
        totals: &mut RiverTotals,
    ) -> f64 {
        let receivers = &drainage.receivers;
        let bed = &mut ground.bed;
        let (mut largest, mut left, mut uplifted) = (0.0_f64, 0.0, 0.0);
        for cell in drainage.order.iter().rev().map(|cell| *cell as usize) {
            if receivers.directions[cell] == NONE {
                continue;
            }
            let (old, base) = (bed[cell], bed[receivers.of(cell)]);
            let rise = uplift.of(cell);
            let risen = old + rise;
            let new = if risen > base { base + self.drop(risen - base, self.factors[cell]) } else { risen };
            bed[cell] = new;
            uplifted += rise;
            left += risen - new;
            largest = largest.max((new - old).abs());
        }
        totals.uplifted += uplifted;
        totals.left += left;
        largest
    }

    /// The drop x to the receiver after a step: x + f x^n = x0.
    ///
    /// Written s + g s^n = 1 with s = x / x0, or t^(1/n) + g t = 1 with t = s^n for n below 1, the left side is convex,
    /// and the method of Newton goes down to the root from any place above it.
    #[inline]
    fn drop(&self, before: f64, factor: f64) -> f64 {
        let n = self.slope_exponent;
        if n == 1.0 {
            return before / (1.0 + factor);
        }
        let g = (factor * power(before, n - 1.0)).min(f64::MAX);
        if n > 1.0 { before * root([1.0, g], n) } else { before * power(root([g, 1.0], 1.0 / n), 1.0 / n) }
    }
}

/// The positive root of a s + b s^p = 1, with a and b not negative, not both 0, and p above 1.
fn root([a, b]: [f64; 2], p: f64) -> f64 {
    let mut s = (1.0 / a).min(power(b, -1.0 / p));
    for _ in 0..MOST_ROUNDS {
        let (above, slope) = (power(s, p - 1.0) * b, a + p * b * power(s, p - 1.0));
        let next = s - (a * s + above * s - 1.0) / slope;
        // Rounding alone goes up.
        if next >= s || !next.is_finite() {
            break;
        }
        s = next;
    }
    s
}

/// A power of a number that is not negative; exact for exponents of 1/2 and 1.
#[inline]
fn power(base: f64, exponent: f64) -> f64 {
    if exponent == 1.0 {
        base
    } else if exponent == 0.5 {
        base.sqrt()
    } else {
        base.powf(exponent)
    }
}
