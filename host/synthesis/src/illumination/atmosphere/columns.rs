//! How much air a ray goes through to the end of the atmosphere, in a table.

use super::air::{Amounts, density};

/// Radius of the earth, km.
pub(super) const GROUND: f64 = 6360.0;
/// The end of the atmosphere, km from the middle of the earth.
pub(super) const TOP: f64 = 6460.0;
/// Rows of the table: heights.
const HEIGHTS: usize = 64;
/// Columns of the table: directions.
const DIRECTIONS: usize = 256;
/// Steps along a ray.
const STEPS: usize = 200;

/// Distance to the end of the atmosphere, km.
///
/// - `radius`: from the middle of the earth, km. `cosine`: of the angle from the zenith.
pub(super) fn to_top(radius: f64, cosine: f64) -> f64 {
    let inside = radius * radius * (cosine * cosine - 1.0) + TOP * TOP;
    (inside.max(0.0).sqrt() - radius * cosine).max(0.0)
}

/// Distance to the ground, km; none if the ray does not hit it.
pub(super) fn to_ground(radius: f64, cosine: f64) -> Option<f64> {
    let inside = radius * radius * (cosine * cosine - 1.0) + GROUND * GROUND;
    (cosine < 0.0 && inside >= 0.0).then(|| (-radius * cosine - inside.sqrt()).max(0.0))
}

/// The table of rays that do not hit the ground, with the coordinates of Bruneton and Neyret 2008.
pub(super) struct Columns(Vec<Amounts>);

impl Columns {
    pub(super) fn new() -> Columns {
        let level = (TOP * TOP - GROUND * GROUND).sqrt();
        let of = |index: usize| {
            let at = [index % DIRECTIONS, index / DIRECTIONS];
            let [x, y] = [at[0] as f64 / (DIRECTIONS - 1) as f64, at[1] as f64 / (HEIGHTS - 1) as f64];
            let from_horizon = level * y;
            let radius = (from_horizon * from_horizon + GROUND * GROUND).sqrt();
            let (least, most) = (TOP - radius, from_horizon + level);
            let distance = least + x * (most - least);
            let cosine = match distance {
                0.0 => 1.0,
                _ => (level * level - from_horizon * from_horizon - distance * distance) / (2.0 * radius * distance),
            };
            integrated(radius, cosine.clamp(-1.0, 1.0), distance)
        };
        Columns((0..HEIGHTS * DIRECTIONS).map(of).collect())
    }

    /// Amounts up to the end of the atmosphere along a ray that does not hit the ground.
    pub(super) fn to_top(&self, radius: f64, cosine: f64) -> Amounts {
        let level = (TOP * TOP - GROUND * GROUND).sqrt();
        let from_horizon = (radius * radius - GROUND * GROUND).max(0.0).sqrt();
        let (least, most) = (TOP - radius, from_horizon + level);
        let place = |part: f64, count: usize| {
            let at = part.clamp(0.0, 1.0) * (count - 1) as f64;
            let low = (at as usize).min(count - 2);
            (low, at - low as f64)
        };
        let part = if most > least { (to_top(radius, cosine) - least) / (most - least) } else { 0.0 };
        let ((x, s), (y, t)) = (place(part, DIRECTIONS), place(from_horizon / level, HEIGHTS));
        let at = |x: usize, y: usize| self.0[y * DIRECTIONS + x];
        let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
        std::array::from_fn(|kind| {
            let (above, below) = (a[kind] + (b[kind] - a[kind]) * s, c[kind] + (d[kind] - c[kind]) * s);
            above + (below - above) * t
        })
    }
}

/// Amounts along a part of a ray, by the middles of steps.
pub(super) fn integrated(radius: f64, cosine: f64, distance: f64) -> Amounts {
    let mut sums = [0.0; 3];
    for step in 0..STEPS {
        // Short steps first, where there is most air.
        let [from, to] = [step, step + 1].map(|step| (step as f64 / STEPS as f64).powi(2) * distance);
        let t = 0.5 * (from + to);
        let height = (radius * radius + t * t + 2.0 * radius * t * cosine).sqrt() - GROUND;
        sums.iter_mut().zip(density(height)).for_each(|(sum, amount)| *sum += amount * (to - from));
    }
    sums
}
