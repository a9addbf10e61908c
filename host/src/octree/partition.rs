//! Where to divide items, so that rays have little work.

use super::clip::Bounds;
use super::items::Item;
use super::packet::LANES;

/// So many items or fewer are divided exactly, more by bins.
const EXACT: usize = 16;

/// Bins along each axis.
const BINS: usize = 16;

/// Divides items, at least two, in place; returns how many are in the first part, neither none nor all.
///
/// # Source
/// Surface-area heuristic: Goldsmith and Salmon 1987; bins: Wald 2007. The price counts packets, not items.
pub fn divide(items: &mut [Item]) -> usize {
    let parted = if items.len() <= EXACT { sweep(items) } else { bin(items) };
    parted.unwrap_or_else(|| {
        // All centres in one point: any half is as good.
        let middle = (items.len() / 2).next_multiple_of(LANES);
        middle.clamp(1, items.len() - 1)
    })
}

fn packets(count: usize) -> f32 {
    count.div_ceil(LANES) as f32
}

fn centre(item: &Item, axis: usize) -> f32 {
    item.bounds.low[axis] + item.bounds.high[axis]
}

/// Sorts along each axis and looks at every place between two items.
fn sweep(items: &mut [Item]) -> Option<usize> {
    let count = items.len();
    let sort = |items: &mut [Item], axis: usize| {
        items.sort_unstable_by(|a, b| centre(a, axis).total_cmp(&centre(b, axis)).then(a.number.cmp(&b.number)));
    };
    let mut best = (f32::INFINITY, 0, 0);
    for axis in 0..3 {
        sort(items, axis);
        let mut areas = [0.0; EXACT + 1];
        let mut after = Bounds::EMPTY;
        for i in (1..count).rev() {
            after = after.union(&items[i].bounds);
            areas[i] = after.half_area();
        }
        let mut before = Bounds::EMPTY;
        for i in 1..count {
            before = before.union(&items[i - 1].bounds);
            let price = before.half_area() * packets(i) + areas[i] * packets(count - i);
            if price < best.0 {
                best = (price, axis, i);
            }
        }
    }
    if best.1 != 2 {
        sort(items, best.1);
    }
    (best.2 > 0).then_some(best.2)
}

/// Sorts into bins along each axis and looks at every place between two bins.
fn bin(items: &mut [Item]) -> Option<usize> {
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for item in items.iter() {
        for axis in 0..3 {
            let x = centre(item, axis);
            low[axis] = low[axis].min(x);
            high[axis] = high[axis].max(x);
        }
    }
    let scale = [0, 1, 2].map(|axis| {
        let extent = high[axis] - low[axis];
        if extent > 0.0 { BINS as f32 * (1.0 - 1e-6) / extent } else { 0.0 }
    });
    let place = |item: &Item, axis: usize| (((centre(item, axis) - low[axis]) * scale[axis]) as usize).min(BINS - 1);
    let mut bins = [[(Bounds::EMPTY, 0_usize); BINS]; 3];
    for item in items.iter() {
        for (axis, bins) in bins.iter_mut().enumerate() {
            let (bounds, count) = &mut bins[place(item, axis)];
            *bounds = bounds.union(&item.bounds);
            *count += 1;
        }
    }
    let mut best = (f32::INFINITY, 0, 0);
    for (axis, bins) in bins.iter().enumerate() {
        let mut prices = [0.0; BINS];
        let mut after = (Bounds::EMPTY, 0);
        for i in (1..BINS).rev() {
            after = (after.0.union(&bins[i].0), after.1 + bins[i].1);
            prices[i] = after.0.half_area() * packets(after.1);
        }
        let mut before = (Bounds::EMPTY, 0);
        for i in 1..BINS {
            before = (before.0.union(&bins[i - 1].0), before.1 + bins[i - 1].1);
            let price = before.0.half_area() * packets(before.1) + prices[i];
            if before.1 > 0 && before.1 < items.len() && price < best.0 {
                best = (price, axis, i);
            }
        }
    }
    let (_, axis, first) = best;
    (first > 0).then(|| part(items, |item| place(item, axis) < first))
}

/// Moves what belongs to the first part there; returns its number.
fn part(items: &mut [Item], first: impl Fn(&Item) -> bool) -> usize {
    let mut kept = 0;
    for i in 0..items.len() {
        if first(&items[i]) {
            items.swap(i, kept);
            kept += 1;
        }
    }
    kept
}
