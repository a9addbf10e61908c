//! Tests of rivers: steady profiles against the formula, the method of Newton, the end by tolerance.

use super::super::grid::HeightGrid;
use super::eroded::erode;
use super::receivers::Receivers;
use super::settings::ErosionSettings;
use crate::numeric::sampling::RandomStream;
use glam::DVec2;

fn only_rivers() -> ErosionSettings {
    ErosionSettings { water_steps: 0.0, slide_steps: 0.0, wander: 0.0, ..ErosionSettings::default() }
}

#[test]
fn a_river_becomes_steady_where_uplift_is_stream_power() {
    // Three rows wide: the middle one drains along itself where the sides are walls far above it.
    const LENGTH: usize = 60;
    let spacing = 2.0;
    let mut heights = vec![0.0; 3 * LENGTH];
    for k in 0..LENGTH {
        heights[k] = 1e6;
        heights[2 * LENGTH + k] = 1e6;
        heights[LENGTH + k] = 1e-3 * k as f64;
    }
    heights[2 * LENGTH - 1] = 1e6;
    let grid = HeightGrid::new([LENGTH, 3], DVec2::ZERO, spacing, heights).expect("sound");
    for (m, n) in [(0.5, 1.0), (0.4, 1.0), (0.5, 2.0), (0.3, 0.6)] {
        let (uplift, erodibility) = (1e-3, 1e-2);
        let settings = ErosionSettings {
            uplift,
            erodibility,
            area_exponent: m,
            slope_exponent: n,
            river_interval: 2000.0,
            river_steps: 3000.0,
            tolerance: 1e-16,
            ..only_rivers()
        };
        let eroded = erode(&grid, &settings, &|| false).expect("sound");
        let middle = &eroded.heights.heights()[LENGTH..2 * LENGTH];
        for k in 1..LENGTH - 1 {
            let area = (LENGTH - 1 - k) as f64 * spacing * spacing;
            assert_eq!(eroded.drainage[LENGTH + k], area);
            let slope = (middle[k] - middle[k - 1]) / spacing;
            let expected = (uplift / erodibility).powf(1.0 / n) * area.powf(-m / n);
            assert!((slope / expected - 1.0).abs() < 1e-6, "{m} {n} {k}: {slope} {expected}");
        }
    }
}

#[test]
fn heights_at_the_new_time_solve_their_equation() {
    let grid = HeightGrid::new([3, 3], DVec2::ZERO, 0.5, vec![0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    let grid = grid.expect("sound");
    for n in [0.25, 0.5, 0.9, 1.0, 1.1, 2.0, 4.0] {
        for erodibility in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
            let settings = ErosionSettings { erodibility, slope_exponent: n, river_steps: 1.0, ..only_rivers() };
            let eroded = erode(&grid, &settings, &|| false).expect("sound");
            let height = eroded.heights.heights()[4];
            let rate = erodibility * 0.5 * (height / 0.5).powf(n);
            assert!((height + rate - 1.0).abs() < 1e-12, "{n} {erodibility}: {height} {rate}");
        }
    }
}

#[test]
fn a_rough_plain_rises_to_a_steady_landscape_without_pits() {
    const SIDE: usize = 60;
    let mut stream = RandomStream::new(3, 0);
    let heights = (0..SIDE * SIDE).map(|_| stream.uniform()).collect();
    let grid = HeightGrid::new([SIDE, SIDE], DVec2::ZERO, 10.0, heights).expect("sound");
    let settings =
        ErosionSettings { uplift: 1.0, river_interval: 5.0, river_steps: 2000.0, tolerance: 1e-9, ..only_rivers() };
    let eroded = erode(&grid, &settings, &|| false).expect("sound");
    assert!(eroded.rivers.is_steady && eroded.rivers.steps < 2000, "{:?}", eroded.rivers);
    assert_eq!(Receivers::new([SIDE, SIDE], 0.0).find(eroded.heights.heights()), 0, "no pits");
    assert!(eroded.account.material_error() < 1e-12);
    // Everywhere it erodes as much as rises.
    let mut receivers = Receivers::new([SIDE, SIDE], 0.0);
    receivers.find(eroded.heights.heights());
    for cell in (0..SIDE * SIDE).filter(|cell| !receivers.is_base(*cell)) {
        let h = eroded.heights.heights();
        let slope = (h[cell] - h[receivers.of(cell)]) / (10.0 * Receivers::distance(receivers.directions[cell]));
        let rate = 0.02 * eroded.drainage[cell].sqrt() * slope;
        assert!((rate - 1.0).abs() < 1e-3, "{cell}: {rate}");
    }
    let hurried = ErosionSettings { river_steps: 3.0, ..settings };
    let told = erode(&grid, &hurried, &|| false).expect("sound").rivers;
    assert!(!told.is_steady && told.steps == 3 && told.largest_change > 0.0);
}

#[test]
fn hillslopes_are_parabolas_where_there_are_no_rivers() {
    // Long and narrow: across it D h'' = -U.
    let size = [81, 21];
    let grid = HeightGrid::new(size, DVec2::ZERO, 0.5, vec![0.0; size[0] * size[1]]).expect("sound");
    let settings = ErosionSettings {
        erodibility: 0.0,
        uplift: 0.3,
        diffusivity: 2.0,
        river_interval: 0.05,
        river_steps: 6000.0,
        tolerance: 1e-11,
        ..only_rivers()
    };
    let eroded = erode(&grid, &settings, &|| false).expect("sound");
    assert!(eroded.rivers.is_steady && eroded.account.material_error() < 1e-11, "{:?}", eroded.rivers);
    for row in 0..size[1] {
        let (z, half) = ((row as f64 - 10.0) * 0.5, 5.0);
        let expected = 0.3 / (2.0 * 2.0) * (half * half - z * z);
        assert!((eroded.heights.heights()[row * size[0] + 40] - expected).abs() < 0.02 * 1.875);
    }
}
