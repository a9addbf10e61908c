//! Tests of eroded terrain: accounts, threads, symmetry, extremes, what is refused.

use super::super::error::TerrainError;
use super::super::grid::HeightGrid;
use super::eroded::{ErodedTerrain, erode};
use super::settings::{EROSION_PARAMETERS, ErosionEdge, ErosionSettings};
use crate::numeric::sampling::RandomStream;
use glam::DVec2;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Smooth hills with a little noise, none of them symmetric.
fn hills(size: [usize; 2], spacing: f64, height: f64) -> HeightGrid {
    let mut stream = RandomStream::new(11, 0);
    let of = |k: usize| {
        let (x, z) = ((k % size[0]) as f64, (k / size[0]) as f64);
        (0.13 * x + 0.4).sin() * (0.11 * z).cos() + 0.4 * (0.31 * x - 0.27 * z).sin() + 0.02 * stream.uniform()
    };
    let heights = (0..size[0] * size[1]).map(of).map(|h| h * height).collect();
    HeightGrid::new(size, DVec2::new(3.0, -4.0), spacing, heights).expect("sound")
}

fn settings() -> ErosionSettings {
    ErosionSettings {
        water_steps: 60.0,
        slide_steps: 40.0,
        river_steps: 8.0,
        rain: 2e-3,
        uplift: 0.1,
        diffusivity: 0.3,
        edge: ErosionEdge::Open,
        ..ErosionSettings::default()
    }
}

fn eroded(grid: &HeightGrid, settings: &ErosionSettings) -> ErodedTerrain {
    erode(grid, settings, &|| false).expect("sound")
}

fn is_sound(terrain: &ErodedTerrain) -> bool {
    let is_finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
    let at_least_0 = |values: &[f64]| values.iter().all(|value| *value >= 0.0);
    is_finite(terrain.heights.heights())
        && [&terrain.water, &terrain.deposit, &terrain.drainage].iter().all(|of| is_finite(of) && at_least_0(of))
        && terrain.account.material_error() < 1e-9
        && terrain.account.water_error() < 1e-9
}

#[test]
fn material_and_water_balance_at_every_edge() {
    let grid = hills([150, 131], 2.0, 30.0);
    let map: Arc<[f64]> = (0..150 * 131).map(|k| (k % 3) as f64).collect();
    for edge in [ErosionEdge::Open, ErosionEdge::Closed] {
        for rain_map in [None, Some(map.clone())] {
            let uplift_map = rain_map.clone();
            let terrain = eroded(&grid, &ErosionSettings { edge, rain_map, uplift_map, ..settings() });
            let account = terrain.account;
            assert!(is_sound(&terrain), "{account:?} {:e} {:e}", account.material_error(), account.water_error());
            assert!(account.material_error() < 1e-12 && account.water_error() < 1e-12);
            assert!(account.material_left > 0.0 && account.rain > 0.0 && account.evaporated > 0.0);
            assert_eq!(account.water_left > 0.0, edge == ErosionEdge::Open);
            assert!(terrain.deposit.iter().any(|deposit| *deposit > 0.0));
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let grid = hills([170, 201], 2.0, 30.0);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| eroded(&grid, &settings()))
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
}

#[test]
fn running_water_and_slides_know_no_direction() {
    let grid = hills([67, 90], 2.0, 30.0);
    let settings = ErosionSettings { river_steps: 0.0, ..settings() };
    let terrain = eroded(&grid, &settings);
    let ([columns, rows], heights) = (grid.size(), grid.heights());
    let mirrored = |values: &[f64]| -> Vec<f64> {
        (0..values.len()).map(|k| values[k / columns * columns + columns - 1 - k % columns]).collect()
    };
    let transposed =
        |values: &[f64]| -> Vec<f64> { (0..values.len()).map(|k| values[k % rows * columns + k / rows]).collect() };
    let of = |size, heights| eroded(&HeightGrid::new(size, DVec2::ZERO, 2.0, heights).expect("sound"), &settings);
    let other = of([columns, rows], mirrored(heights));
    assert!(other.heights.heights() == mirrored(terrain.heights.heights()) && other.water == mirrored(&terrain.water));
    let other = of([rows, columns], transposed(heights));
    assert!(other.heights.heights() == transposed(terrain.heights.heights()));
    assert!(other.water == transposed(&terrain.water) && other.deposit == transposed(&terrain.deposit));
}

#[test]
fn rivers_know_no_direction_but_for_ties() {
    let grid = hills([67, 90], 2.0, 30.0);
    let settings = ErosionSettings { water_steps: 0.0, slide_steps: 0.0, wander: 0.0, ..settings() };
    let terrain = eroded(&grid, &settings);
    let ([columns, rows], heights) = (grid.size(), grid.heights());
    let transposed =
        |values: &[f64]| -> Vec<f64> { (0..values.len()).map(|k| values[k % rows * columns + k / rows]).collect() };
    let other = HeightGrid::new([rows, columns], DVec2::ZERO, 2.0, transposed(heights)).expect("sound");
    let other = eroded(&other, &settings);
    let expected = transposed(terrain.heights.heights());
    let off = other.heights.heights().iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-10, "{off}");
}

#[test]
fn nothing_to_do_leaves_every_bit() {
    let grid = hills([30, 20], 3.0, 5.0);
    let nothing =
        ErosionSettings { water_steps: 0.0, slide_steps: 0.0, erodibility: 0.0, ..ErosionSettings::default() };
    let terrain = eroded(&grid, &nothing);
    assert_eq!(terrain.heights, grid);
    assert!(terrain.deposit.iter().chain(&terrain.water).all(|value| *value == 0.0));
    assert_eq!(terrain.rivers.steps, 0);
    let all: f64 = terrain.account.material_before - terrain.account.material_after;
    assert_eq!(all, 0.0);
    // Rain without slopes does nothing to the ground.
    let flat = HeightGrid::new([20, 20], DVec2::ZERO, 1.0, vec![7.0; 400]).expect("sound");
    assert_eq!(eroded(&flat, &ErosionSettings::default()).heights, flat);
}

#[test]
fn extremes_give_finite_ground() {
    let pit = |size: [usize; 2]| {
        let mut heights = vec![1.0; size[0] * size[1]];
        heights[size[0] / 2 + size[1] / 2 * size[0]] = -50.0;
        HeightGrid::new(size, DVec2::ZERO, 1.0, heights).expect("sound")
    };
    let grids = [
        hills([40, 33], 1.0, 1e6),
        hills([40, 33], 1.0, 1e-6),
        hills([40, 33], 1e-9, 1e14),
        hills([40, 33], 1e9, 1e-3),
        hills([2, 40], 1.0, 10.0),
        hills([40, 2], 1.0, 10.0),
        hills([2, 2], 1.0, 10.0),
        hills([3, 3], 1.0, 10.0),
        pit([20, 20]),
        pit([5, 5]),
    ];
    let few = ErosionSettings { water_steps: 12.0, slide_steps: 12.0, river_steps: 3.0, ..ErosionSettings::default() };
    for (number, grid) in grids.iter().enumerate() {
        assert!(is_sound(&eroded(grid, &few)), "{number}");
        for row in EROSION_PARAMETERS.iter().filter(|row| !row.name.ends_with("_steps")) {
            for value in row.range {
                let mut settings = few.clone();
                settings.set(row.name, value).expect("in range");
                match erode(grid, &settings, &|| false) {
                    Ok(terrain) => assert!(is_sound(&terrain), "{number} {} {value}", row.name),
                    Err(TerrainError::Parameter { name: "diffusivity", .. } | TerrainError::Cell { .. }) => {}
                    Err(error) => panic!("{number} {} {value}: {error}", row.name),
                }
            }
        }
    }
}

#[test]
fn what_makes_no_sense_is_refused_with_its_place() {
    let grid = hills([30, 20], 3.0, 5.0);
    let refused = |settings: ErosionSettings| erode(&grid, &settings, &|| false).expect_err("refused");
    let wrong = ErosionSettings { repose_angle: 90.0, ..settings() };
    assert!(matches!(refused(wrong), TerrainError::Parameter { name: "repose_angle", .. }));
    let wrong = ErosionSettings { rain: f64::NAN, ..settings() };
    assert!(matches!(refused(wrong), TerrainError::Parameter { name: "rain", .. }));
    let mut map = vec![1.0; 600];
    map[33] = f64::NAN;
    let wrong = ErosionSettings { rain_map: Some(map.into()), ..settings() };
    assert!(matches!(refused(wrong), TerrainError::Cell { column: 3, row: 1, .. }));
    let wrong = ErosionSettings { uplift_map: Some(Arc::new([1.0; 7])), ..settings() };
    assert!(matches!(refused(wrong), TerrainError::GridSize { .. }));
    assert!(matches!(ErosionSettings::default().set("rian", 1.0), Err(TerrainError::UnknownParameter { .. })));
    // Wherever it is cancelled, it ends.
    for most in [0, 1, 5, 40, 200] {
        let asked = AtomicUsize::new(0);
        let ended = erode(&grid, &settings(), &|| asked.fetch_add(1, Ordering::Relaxed) >= most);
        assert_eq!(ended, Err(TerrainError::Cancelled), "{most}");
    }
}

#[test]
fn the_table_holds_every_number_once() {
    let settings = ErosionSettings::default();
    let mut names: Vec<&str> = EROSION_PARAMETERS.iter().map(|row| row.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), EROSION_PARAMETERS.len());
    for row in EROSION_PARAMETERS {
        assert!((row.get)(&settings) == row.default && (row.range[0]..=row.range[1]).contains(&row.default));
        assert!(!row.summary.is_empty() && !row.summary.ends_with('.'));
    }
}
