//! Depressions: pits drain over the lowest passes out of them.

use super::receivers::{NONE, Receivers};
use rayon::prelude::*;

/// Two neighbours that drain to different pits.
#[derive(Clone, Copy, Debug)]
struct Pass {
    /// The higher one of their heights.
    height: f64,
    cells: [u32; 2],
}

/// Turns receivers around so that all pits drain to the edge: from each pit along the way up to the pass, against the
/// way the water came down, and over it.
///
/// The passes are those of a minimum spanning tree of the basins: no way out of a pit has a lower highest point. Of
/// passes that are as high the one whose cells come first is taken.
///
/// - `labels`: the pit to which each cell drains, from 1; 0 for the edge. `pits`: how many there are.
///
/// # Source
/// Cordonnier, Bovy and Braun 2019, with the algorithm of Kruskal for the tree.
pub(super) fn carve(receivers: &mut Receivers, heights: &[f64], labels: &[u32], pits: usize) {
    let passes = passes(receivers, heights, labels);
    let tree = spanning_tree(&passes, labels, pits + 1);
    // The passes at each basin, one basin after the other.
    let mut begins = vec![0_usize; pits + 2];
    for pass in &tree {
        pass.cells.iter().for_each(|cell| begins[labels[*cell as usize] as usize + 1] += 1);
    }
    (0..=pits).for_each(|basin| begins[basin + 1] += begins[basin]);
    let (mut places, mut of_basin) = (begins.clone(), vec![[0_u32; 2]; 2 * tree.len()]);
    for Pass { cells: [a, b], .. } in &tree {
        for (inner, outer) in [(*a, *b), (*b, *a)] {
            let place = &mut places[labels[inner as usize] as usize];
            of_basin[*place] = [inner, outer];
            *place += 1;
        }
    }
    // From the edge inwards.
    let mut is_drained = vec![false; pits + 1];
    is_drained[0] = true;
    let mut next = vec![0_usize];
    while let Some(basin) = next.pop() {
        for [outer, inner] in &of_basin[begins[basin]..begins[basin + 1]] {
            let beyond = labels[*inner as usize] as usize;
            if !is_drained[beyond] {
                is_drained[beyond] = true;
                turn_around(receivers, *inner as usize, *outer as usize);
                next.push(beyond);
            }
        }
    }
}

/// Makes a cell drain to a neighbour, and all cells down to its pit to that from which water came.
fn turn_around(receivers: &mut Receivers, cell: usize, outer: usize) {
    let (mut cell, mut to) = (cell, outer);
    loop {
        let (direction, receiver) = (receivers.directions[cell], receivers.of(cell));
        receivers.directions[cell] = direction_to(receivers, cell, to);
        if direction == NONE {
            break;
        }
        (cell, to) = (receiver, cell);
    }
}

fn direction_to(receivers: &Receivers, cell: usize, to: usize) -> u8 {
    (0..8).find(|direction| receivers.neighbour(cell, usize::from(*direction)) == to).unwrap_or(NONE)
}

/// All pairs of neighbours in different basins.
fn passes(receivers: &Receivers, heights: &[f64], labels: &[u32]) -> Vec<Pass> {
    let (columns, rows) = (receivers.columns, receivers.rows);
    let mut passes: Vec<Pass> = (1..rows - 1)
        .into_par_iter()
        .flat_map_iter(|row| {
            let first = row * columns;
            (first + 1..first + columns - 1).flat_map(move |cell| {
                // Each pair once, but for those with the edge, which the inner cell alone finds.
                (0..8).filter_map(move |direction| {
                    let other = receivers.neighbour(cell, direction);
                    let is_first = cell < other || receivers.is_base(other);
                    let is_pass = is_first && labels[cell] != labels[other];
                    let height = || if heights[cell] > heights[other] { heights[cell] } else { heights[other] };
                    is_pass.then(|| Pass { height: height(), cells: [cell as u32, other as u32] })
                })
            })
        })
        .collect();
    passes.par_sort_unstable_by(|a, b| a.height.total_cmp(&b.height).then(a.cells.cmp(&b.cells)));
    passes
}

/// The passes of a minimum spanning tree, of all in the order of their heights.
fn spanning_tree(passes: &[Pass], labels: &[u32], basins: usize) -> Vec<Pass> {
    let mut parents: Vec<u32> = (0..basins as u32).collect();
    let root_of = |parents: &mut [u32], mut basin: u32| {
        while parents[basin as usize] != basin {
            parents[basin as usize] = parents[parents[basin as usize] as usize];
            basin = parents[basin as usize];
        }
        basin
    };
    let mut tree = Vec::with_capacity(basins);
    for pass in passes {
        let [a, b] = pass.cells.map(|cell| root_of(&mut parents, labels[cell as usize]));
        if a != b {
            // The edge stays the root of what it is joined with.
            parents[a.max(b) as usize] = a.min(b);
            tree.push(*pass);
        }
    }
    tree
}
