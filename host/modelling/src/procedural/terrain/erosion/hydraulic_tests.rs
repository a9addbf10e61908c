//! Tests of running water: lakes rest, rain finds its level, nothing is lost.

use super::account::sum_of;
use super::ground::ErodibleGround;
use super::hydraulic::RunningWater;
use super::settings::{ErosionEdge, ErosionSettings};

const SIDE: usize = 48;

fn hills() -> Vec<f64> {
    let height = |k: usize| ((k % SIDE) as f64 * 0.31).sin() * 3.0 + ((k / SIDE) as f64 * 0.23).cos() * 4.0;
    (0..SIDE * SIDE).map(height).collect()
}

fn dry() -> ErosionSettings {
    ErosionSettings { rain: 0.0, evaporation: 0.0, ..ErosionSettings::default() }
}

#[test]
fn a_lake_at_rest_stays_at_rest() {
    // Islands stand out of it, shores are steep, and it touches the walls.
    let bed = hills();
    let depth: Vec<f64> = bed.iter().map(|bed| (1.0 - bed).max(0.0)).collect();
    let mut ground = ErodibleGround::new([SIDE, SIDE], &bed);
    let mut water = RunningWater::new(&dry(), depth.clone());
    (0..200).for_each(|_| water.step(&mut ground, None, &|| false));
    let off = |now: &[f64], before: &[f64]| now.iter().zip(before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off(water.depth(), &depth) < 1e-13, "{}", off(water.depth(), &depth));
    assert!(off(&ground.bed, &bed) < 1e-13);
}

#[test]
fn water_finds_one_level_and_none_is_lost() {
    let bed: Vec<f64> =
        (0..SIDE * SIDE).map(|k| ((k % SIDE) as f64 - 24.0).hypot((k / SIDE) as f64 - 24.0) * 0.1).collect();
    let mut depth = vec![0.0; bed.len()];
    depth[24 * SIDE + 6] = 40.0;
    let mut ground = ErodibleGround::new([SIDE, SIDE], &bed);
    let mut water = RunningWater::new(&ErosionSettings { capacity: 0.0, ..dry() }, depth);
    (0..6000).for_each(|_| water.step(&mut ground, None, &|| false));
    let total = sum_of(water.depth(), |depth| depth);
    assert!((total - 40.0).abs() < 1e-11, "{total}");
    let levels = || water.depth().iter().zip(&bed).filter(|(depth, _)| **depth > 0.05).map(|(depth, bed)| bed + depth);
    let (low, high) = (levels().fold(f64::MAX, f64::min), levels().fold(f64::MIN, f64::max));
    assert!(levels().count() > 20 && high - low < 0.02, "{low} {high}");
}

#[test]
fn all_runs_off_an_open_slope_with_what_it_carries() {
    let bed: Vec<f64> = (0..SIDE * SIDE).map(|k| (k % SIDE) as f64 * 0.3).collect();
    let mut ground = ErodibleGround::new([SIDE, SIDE], &bed);
    let settings = ErosionSettings { edge: ErosionEdge::Open, ..dry() };
    let mut water = RunningWater::new(&settings, vec![0.5; bed.len()]);
    (0..2000).for_each(|_| water.step(&mut ground, None, &|| false));
    water.settle(&mut ground);
    let left = sum_of(water.depth(), |depth| depth);
    let all = 0.5 * bed.len() as f64;
    assert!(left < 0.01 * all, "{left}");
    assert!((all - left - water.totals.water_left).abs() < 1e-10 * all);
    let [before, after] = [&bed, &ground.bed].map(|bed| sum_of(bed, |height| height));
    assert!(water.totals.load_left > 0.0);
    assert!((before - after - water.totals.load_left).abs() < 1e-11 * before);
}
