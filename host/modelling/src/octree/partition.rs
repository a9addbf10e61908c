//! Partition of items, so that rays have little work.

use wide::f32x4;

use super::items::Item;
use super::lanes::LANES;

/// Bins along each axis.
const BINS: usize = 16;

/// So many items or fewer are given to half as many bins, since testing these takes longer than filling them.
const FEW_ITEMS: usize = 32;

/// Successive items as one.
#[derive(Clone, Copy)]
pub struct ItemGroup {
    /// Number of items.
    pub items: usize,
    /// Number of triangles that they stand for.
    pub weight: usize,
    /// The box around them.
    pub around: Item,
    /// The box around twice their middles.
    centres: Item,
}

impl ItemGroup {
    const NOTHING: Self = Self { items: 0, weight: 0, around: Item::EMPTY, centres: Item::EMPTY };

    /// The group of some items.
    pub fn of(items: &[Item]) -> Self {
        let mut part = Self::NOTHING;
        items.iter().for_each(|item| {
            part.add(item);
            part.around = part.around.union(item);
        });
        part
    }

    /// Adds an item, but not to the box around.
    #[inline(always)]
    fn add(&mut self, item: &Item) {
        let centre = item.centre();
        self.items += 1;
        self.weight += item.weight();
        self.centres = self.centres.union(&Item { low: centre, high: centre });
    }
}

/// Divides the items of a part, at least two, in place, neither part empty.
///
/// # Source
/// Surface-area heuristic: Goldsmith and Salmon 1987; bins: Wald 2007. The price counts packets, not items.
pub fn divide(items: &mut [Item], part: &ItemGroup) -> [ItemGroup; 2] {
    let divided = if items.len() <= FEW_ITEMS {
        Bins::<{ BINS / 2 }>::divide(items, part)
    } else {
        Bins::<BINS>::divide(items, part)
    };
    divided.unwrap_or_else(|| {
        // All middles in one point: any half is as good.
        let (left, right) = items.split_at(items.len() / 2);
        [ItemGroup::of(left), ItemGroup::of(right)]
    })
}

/// Divides the largest part of some items again and again until a node is full; those of few are not divided.
///
/// - `leaf`: how many are few, by weight.
pub fn shares<'a>(mut items: &'a mut [Item], part: &ItemGroup, leaf: usize) -> Vec<(&'a mut [Item], ItemGroup)> {
    let mut parts = Vec::with_capacity(LANES);
    parts.push(*part);
    while parts.len() < LANES {
        let mut largest = (0.0, None);
        let mut first = 0;
        for (slot, part) in parts.iter().enumerate() {
            let area = part.around.half_area();
            if part.weight > leaf && part.items > 1 && area >= largest.0 {
                largest = (area, Some((slot, first)));
            }
            first += part.items;
        }
        let Some((slot, first)) = largest.1 else { break };
        let [left, right] = divide(&mut items[first..first + parts[slot].items], &parts[slot]);
        parts[slot] = left;
        parts.insert(slot + 1, right);
    }
    let share = |part: ItemGroup| {
        let (share, rest) = std::mem::take(&mut items).split_at_mut(part.items);
        items = rest;
        (share, part)
    };
    parts.into_iter().map(share).collect()
}

/// Items of each bin, by axis.
struct Bins<const N: usize> {
    around: [[Item; N]; 3],
    weight: [[u32; N]; 3],
}

impl<const N: usize> Bins<N> {
    fn divide(items: &mut [Item], part: &ItemGroup) -> Option<[ItemGroup; 2]> {
        let low = part.centres.low;
        let extent = (part.centres.high - low).to_array();
        let scale = extent.map(|x| if x > 0.0 { N as f32 * (1.0 - 1e-6) / x } else { 0.0 });
        let bins = Self::filled(items, low, f32x4::new(scale));
        let (axis, first) = bins.cheapest()?;
        let low = low.as_array()[axis];
        let place = |item: &Item| (item.low.as_array()[axis] + item.high.as_array()[axis] - low) * scale[axis];
        let mut parts = parted(items, |item| place(item) < first as f32);
        let all = |bins: &[Item]| bins.iter().fold(Item::EMPTY, |all, bin| all.union(bin));
        let (before, after) = bins.around[axis].split_at(first);
        (parts[0].around, parts[1].around) = (all(before), all(after));
        Some(parts)
    }

    #[inline(always)]
    fn filled(items: &[Item], low: f32x4, scale: f32x4) -> Self {
        let mut bins = Self { around: [[Item::EMPTY; N]; 3], weight: [[0; N]; 3] };
        for item in items {
            let places = ((item.centre() - low) * scale).fast_trunc_int().to_array();
            (0..3).for_each(|axis| {
                let place = places[axis] as usize & (N - 1);
                bins.around[axis][place] = bins.around[axis][place].union(item);
                bins.weight[axis][place] += item.weight() as u32;
            });
        }
        bins
    }

    /// The axis, and the first bin of the second part; `None` if all items are in one bin along each axis.
    #[inline(always)]
    fn cheapest(&self) -> Option<(usize, usize)> {
        // Where nothing is, the price is not a number and less than none.
        let price = |around: &Item, weight: u32| around.half_area() * weight.div_ceil(LANES as u32) as f32;
        let mut best = f32::INFINITY;
        let mut place = 0;
        for (axis, (around, weight)) in self.around.iter().zip(&self.weight).enumerate() {
            let mut prices = [0.0; N];
            let mut after = (Item::EMPTY, 0);
            for i in (1..N).rev() {
                after = (after.0.union(&around[i]), after.1 + weight[i]);
                prices[i] = price(&after.0, after.1);
            }
            let mut before = (Item::EMPTY, 0);
            for i in 1..N {
                before = (before.0.union(&around[i - 1]), before.1 + weight[i - 1]);
                let price = price(&before.0, before.1) + prices[i];
                // Two selections, no branch that no processor could foresee.
                let is_better = price < best;
                best = if is_better { price } else { best };
                place = if is_better { axis * N + i } else { place };
            }
        }
        (place > 0).then_some((place / N, place % N))
    }
}

/// Moves what belongs to the first part there; the boxes around the parts are left to the caller.
fn parted(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> [ItemGroup; 2] {
    let mut parts = [ItemGroup::NOTHING; 2];
    let mut first = 0;
    for i in 0..items.len() {
        // Without a branch that no processor could foresee: what is not of the first part changes places with its like.
        let item = items[i];
        items.swap(i, first);
        let is_first = is_first(&item);
        parts[usize::from(!is_first)].add(&item);
        first += usize::from(is_first);
    }
    parts
}
