//! Tests of drainage: areas add up, everything drains to the edge, over the lowest passes.

use super::drainage::Drainage;
use super::receivers::NONE;
use crate::numeric::sampling::RandomStream;

fn rough(size: [usize; 2]) -> Vec<f64> {
    let mut stream = RandomStream::new(7, 0);
    (0..size[0] * size[1]).map(|_| stream.uniform()).collect()
}

fn drained(size: [usize; 2], heights: &[f64]) -> Drainage {
    let mut drainage = Drainage::new(size, 0.0);
    drainage.find(heights, &|| false).expect("not cancelled");
    drainage
}

#[test]
fn areas_add_up_and_every_cell_drains_to_the_edge() {
    for size in [[64, 47], [3, 3], [2, 5], [5, 2], [1, 9], [9, 1], [200, 3]] {
        let heights = rough(size);
        let drainage = drained(size, &heights);
        let receivers = &drainage.receivers;
        let cells = 0..heights.len();
        let of_edge: u32 =
            cells.clone().filter(|cell| receivers.is_base(*cell)).map(|cell| drainage.counts[cell]).sum();
        assert_eq!(of_edge as usize, heights.len());
        assert!(cells.clone().all(|cell| (receivers.directions[cell] == NONE) == receivers.is_base(cell)));
        let mut order = drainage.order.clone();
        order.sort_unstable();
        assert!(order.iter().enumerate().all(|(k, cell)| k == *cell as usize));
        let mut is_passed = vec![false; heights.len()];
        for cell in drainage.order.iter().map(|cell| *cell as usize) {
            is_passed[cell] = true;
            let receiver = receivers.of(cell);
            assert!(receiver == cell || !is_passed[receiver], "each before its receiver");
        }
    }
}

#[test]
fn depressions_drain_over_their_lowest_passes() {
    let size = [40, 33];
    let heights = rough(size);
    let drainage = drained(size, &heights);
    let receivers = &drainage.receivers;
    // The lowest highest point on any way to the edge, by relaxation.
    let mut levels: Vec<f64> =
        (0..heights.len()).map(|k| if receivers.is_base(k) { heights[k] } else { f64::INFINITY }).collect();
    let mut is_changed = true;
    while is_changed {
        is_changed = false;
        for cell in (0..heights.len()).filter(|cell| !receivers.is_base(*cell)) {
            let lowest = (0..8).map(|way| levels[receivers.neighbour(cell, way)]).fold(f64::INFINITY, f64::min);
            let level = heights[cell].max(lowest);
            is_changed |= level < levels[cell];
            levels[cell] = level.min(levels[cell]);
        }
    }
    for cell in 0..heights.len() {
        let (mut at, mut highest) = (cell, heights[cell]);
        while receivers.of(at) != at {
            at = receivers.of(at);
            highest = highest.max(heights[at]);
        }
        assert_eq!(highest, levels[cell], "{cell}");
    }
}

#[test]
fn a_plane_drains_straight_down() {
    let size = [20, 10];
    let heights: Vec<f64> = (0..200).map(|k| (k % 20) as f64).collect();
    let drainage = drained(size, &heights);
    for row in 1..9 {
        assert_eq!(drainage.counts[row * 20], 19);
    }
    let flat = drained(size, &[1.0; 200]);
    assert!((0..200).all(|cell| flat.receivers.is_base(cell) || flat.receivers.directions[cell] != NONE));
}
