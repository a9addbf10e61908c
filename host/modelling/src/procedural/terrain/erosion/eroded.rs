//! An eroded terrain, and how it is made.

use super::super::error::TerrainError;
use super::super::grid::HeightGrid;
use super::account::{ErosionAccount, sum_of};
use super::drainage::Drainage;
use super::ground::ErodibleGround;
use super::hydraulic::RunningWater;
use super::settings::ErosionSettings;
use super::stream_power::{RiverOutcome, run_rivers};
use super::thermal::Slides;
use crate::memory;
use crate::stages::stage;

/// Bytes that the work takes for each cell without the network of rivers: heights at two times and rock; water, load
/// and two fluxes at two times.
const BYTES_EACH: u64 = 8 * (3 + 8);
/// Most cells: they are counted by 32 bits.
const MOST_CELLS: usize = u32::MAX as usize;

/// A terrain after erosion. All numbers of cells go row by row along x.
#[derive(Clone, Debug, PartialEq)]
pub struct ErodedTerrain {
    /// The heights.
    pub heights: HeightGrid,
    /// Depth of the water that is left on each cell, units of length.
    pub water: Vec<f64>,
    /// Thickness of what was moved and lies on ground that never was, units of length.
    pub deposit: Vec<f64>,
    /// Area that drains through each cell, itself among it, units of length squared: how wet it is. Depressions drain
    /// over their lowest passes; the area of the cells at the edge adds up to that of the grid.
    pub drainage: Vec<f64>,
    /// The account of material and water.
    pub account: ErosionAccount,
    /// How the erosion by rivers ended.
    pub rivers: RiverOutcome,
}

/// Erodes heights on a grid: first by rivers over long times, then by running water and by slides, a step of each in
/// turn.
///
/// Any of the three is left out by 0 steps, rivers also by numbers that move nothing. Each height stands for a square
/// cell of the spacing of the grid. Water runs within the grid or over its edge as the settings say, slides stay within
/// it, and for rivers its edge is the base level. The result is the same for any number of threads, to the bit.
///
/// The time grows with the cells times the steps: about 35 ns of a core for a cell and a step of water and slides, 85
/// ns for one of rivers, of which a half is shared among cores.
///
/// - `is_cancelled`: asked several times a step, from any thread.
///
/// # Errors
/// [`TerrainError::Cancelled`]; others for numbers out of range, maps that do not fit the grid, heights that would
/// overflow, and too little memory.
///
/// # Source
/// Rivers: Braun and Willett 2013; Cordonnier, Bovy and Braun 2019. Running water: O'Brien and Hodgins 1995; Mei,
/// Decaudin and Hu 2007, with fluxes of load in place of its semi-Lagrangian transport. Slides: Musgrave, Kolb and Mace
/// 1989.
pub fn erode(
    heights: &HeightGrid,
    settings: &ErosionSettings,
    is_cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<ErodedTerrain, TerrainError> {
    let size = heights.size();
    settings.check(size)?;
    let count = heights.heights().len();
    if count > MOST_CELLS {
        return Err(TerrainError::GridSize { columns: size[0], rows: size[1], heights: count });
    }
    memory::reserve(count as u64 * (BYTES_EACH + Drainage::BYTES), || format!("eroding {count} heights"))?;
    let spacing = heights.spacing();
    let area = spacing * spacing;
    let mut ground = ErodibleGround::new(size, heights.heights());
    let mut account = ErosionAccount {
        material_before: area * sum_of(&ground.bed, |height| height),
        magnitude: area * sum_of(&ground.bed, f64::abs),
        ..ErosionAccount::default()
    };
    let mut drainage = Drainage::new(size, settings.wander);
    let mut rivers = RiverOutcome::default();
    if settings.has_rivers() {
        let totals;
        (rivers, totals) = run_rivers(&mut ground, &mut drainage, settings, spacing, is_cancelled)?;
        account.material_uplifted += totals.uplifted * area;
        account.material_left += totals.left * area;
    }
    let mut water = vec![0.0; count];
    if settings.water_steps >= 0.5 || settings.slide_steps >= 0.5 {
        water = run_water_and_slides(&mut ground, settings, spacing, &mut account, is_cancelled)?;
    }
    account.material_after = area * sum_of(&ground.bed, |height| height);
    account.water_after = area * sum_of(&water, |depth| depth);
    drainage.find(&ground.bed, is_cancelled)?;
    let deposit = ground.bed.iter().zip(&ground.rock).map(|(bed, rock)| bed - rock).collect();
    let drained = drainage.counts.iter().map(|count| f64::from(*count) * area).collect();
    drop(drainage);
    let heights = HeightGrid::new(size, heights.corner(), spacing, ground.bed)?;
    Ok(ErodedTerrain { heights, water, deposit, drainage: drained, account, rivers })
}

/// Lets water run and ground slide, step by step.
///
/// - Returns the depth of the water, units of length.
fn run_water_and_slides(
    ground: &mut ErodibleGround,
    settings: &ErosionSettings,
    spacing: f64,
    account: &mut ErosionAccount,
    is_cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<f64>, TerrainError> {
    let volume = spacing * spacing * spacing;
    let [wet, sliding] = [settings.water_steps, settings.slide_steps].map(|steps| steps.round() as usize);
    let stage = stage!("eroding the terrain by water and slides", wet.max(sliding) as f64, "steps");
    // Water is computed in spacings.
    ground.scale(1.0 / spacing);
    let mut water = RunningWater::new(settings, vec![0.0; ground.bed.len()]);
    let slides = Slides::new(settings.repose_angle, settings.slide_rate, 1.0);
    for step in 0..wet.max(sliding) {
        if step < wet {
            water.step(ground, settings.rain_map.as_deref(), is_cancelled);
        }
        if step < sliding {
            slides.step(ground, is_cancelled);
        } else {
            ground.uncover();
        }
        if step + 1 == wet {
            water.settle(ground);
        }
        if is_cancelled() {
            return Err(TerrainError::Cancelled);
        }
        stage.progress((step + 1) as f64);
    }
    let rain_on_all = settings.rain_map.as_deref().map_or(ground.bed.len() as f64, |map| sum_of(map, |by| by));
    let totals = water.totals;
    account.rain += rain_on_all * settings.rain * wet as f64 * volume;
    account.evaporated += totals.evaporated * volume;
    account.water_left += totals.water_left * volume;
    account.material_left += totals.load_left * volume;
    ground.scale(spacing);
    let mut depth = water.into_depth();
    depth.iter_mut().for_each(|depth| *depth *= spacing);
    Ok(depth)
}
