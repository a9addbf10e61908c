//! Where to divide items, so that rays have little work.

use wide::f32x4;

use super::items::Item;
use super::lanes::LANES;

/// Bins along each axis.
const BINS: usize = 16;

/// Successive items as one.
#[derive(Clone, Copy)]
pub struct Part {
    /// Number of items.
    pub items: usize,
    /// Number of triangles that they stand for.
    pub weight: usize,
    /// The box around them.
    pub around: Item,
    /// The box around twice their middles.
    centres: Item,
}

impl Part {
    const NOTHING: Self = Self { items: 0, weight: 0, around: Item::EMPTY, centres: Item::EMPTY };

    /// All of some items.
    pub fn of(items: &[Item]) -> Self {
        let mut part = Self::NOTHING;
        items.iter().for_each(|item| part.add(item));
        part
    }

    #[inline]
    fn add(&mut self, item: &Item) {
        let centre = item.centre();
        self.items += 1;
        self.weight += item.weight();
        self.around = self.around.union(item);
        self.centres = self.centres.union(&Item { low: centre, high: centre });
    }
}

/// Divides the items of a part, at least two, in place, neither part empty.
///
/// # Source
/// Surface-area heuristic: Goldsmith and Salmon 1987; bins: Wald 2007. The price counts packets, not items.
pub fn divide(items: &mut [Item], part: &Part) -> [Part; 2] {
    let low = part.centres.low;
    let extent = (part.centres.high - low).to_array();
    let scale = f32x4::new(extent.map(|x| if x > 0.0 { BINS as f32 * (1.0 - 1e-6) / x } else { 0.0 }));
    let places = |item: &Item| ((item.centre() - low) * scale).fast_trunc_int().to_array();
    let mut bins = [[(Item::EMPTY, 0_usize); BINS]; 3];
    for item in items.iter() {
        let places = places(item);
        for (bins, place) in bins.iter_mut().zip(places) {
            let (around, weight) = &mut bins[place as usize & (BINS - 1)];
            *around = around.union(item);
            *weight += item.weight();
        }
    }
    match cheapest(&bins) {
        Some((axis, first)) => parted(items, |item| (places(item)[axis] as usize & (BINS - 1)) < first),
        None => {
            // All middles in one point: any half is as good.
            let (left, right) = items.split_at(items.len() / 2);
            [Part::of(left), Part::of(right)]
        }
    }
}

/// The axis, and the first bin of the second part; `None` if all items are in one bin along each axis.
fn cheapest(bins: &[[(Item, usize); BINS]; 3]) -> Option<(usize, usize)> {
    let price = |(around, weight): &(Item, usize)| around.half_area() * weight.div_ceil(LANES) as f32;
    let joined = |one: &(Item, usize), other: &(Item, usize)| (one.0.union(&other.0), one.1 + other.1);
    let mut best = (f32::INFINITY, None);
    for (axis, bins) in bins.iter().enumerate() {
        let mut prices = [f32::INFINITY; BINS];
        let mut after = (Item::EMPTY, 0);
        for i in (1..BINS).rev() {
            after = joined(&after, &bins[i]);
            if after.1 > 0 {
                prices[i] = price(&after);
            }
        }
        let mut before = (Item::EMPTY, 0);
        for i in 1..BINS {
            before = joined(&before, &bins[i - 1]);
            if before.1 > 0 && bins[i].1 > 0 && price(&before) + prices[i] < best.0 {
                best = (price(&before) + prices[i], Some((axis, i)));
            }
        }
    }
    best.1
}

/// Moves what belongs to the first part there.
fn parted(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> [Part; 2] {
    let (mut left, mut right) = (Part::NOTHING, Part::NOTHING);
    for i in 0..items.len() {
        if is_first(&items[i]) {
            left.add(&items[i]);
            items.swap(i, left.items - 1);
        } else {
            right.add(&items[i]);
        }
    }
    [left, right]
}
