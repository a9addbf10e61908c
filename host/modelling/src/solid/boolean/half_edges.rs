//! Half-edges: sides of triangles by the edges that they lie on.

/// Half-edges, those on one edge beside each other.
pub struct HalfEdges {
    /// By lower end: the first of its half-edges.
    firsts: Vec<u32>,
    /// The upper end of each half-edge, and what is beside it.
    half_edges: Vec<(u32, u32)>,
}

impl HalfEdges {
    /// Sorts half-edges by their ends and then by what is beside them.
    ///
    /// - `ends`: number of points that may be ends.
    /// - `sides`: two ends in either order, and a number of what is beside the side, which never falls.
    ///
    /// Cost: linear where few sides end in each point.
    pub fn new(ends: usize, sides: impl Iterator<Item = ([u32; 2], u32)> + Clone) -> HalfEdges {
        let mut firsts = vec![0; ends + 2];
        let mut count = 0;
        for ([a, b], _) in sides.clone() {
            firsts[a.min(b) as usize + 2] += 1;
            count += 1;
        }
        for k in 2..firsts.len() {
            firsts[k] += firsts[k - 1];
        }
        let mut sorted = vec![(0, 0); count];
        for ([a, b], beside) in sides {
            let place = &mut firsts[a.min(b) as usize + 1];
            sorted[*place as usize] = (a.max(b), beside);
            *place += 1;
        }
        for range in firsts.windows(2) {
            sorted[range[0] as usize..range[1] as usize].sort_by_key(|side| side.0);
        }
        HalfEdges { firsts, half_edges: sorted }
    }

    /// Each edge: its ends, the lower first, and by its upper end again what is beside it.
    pub fn edges(&self) -> impl Iterator<Item = ([u32; 2], &[(u32, u32)])> {
        self.firsts.windows(2).zip(0..).flat_map(|(range, low)| {
            let sides = &self.half_edges[range[0] as usize..range[1] as usize];
            sides.chunk_by(|a, b| a.0 == b.0).map(move |edge| ([low, edge[0].0], edge))
        })
    }
}

/// The half-edges of triangles that are counted from a number on.
pub fn of_triangles(
    triangles: impl Iterator<Item = [u32; 3]> + Clone,
    first: u32,
) -> impl Iterator<Item = ([u32; 2], u32)> + Clone {
    triangles.zip(first..).flat_map(|([a, b, c], number)| [([a, b], number), ([b, c], number), ([c, a], number)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn edges_are_those_of_a_sort() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(7);
        for (points, count) in [(3, 1), (5, 40), (300, 500), (1, 0)] {
            let triangles: Vec<[u32; 3]> = (0..count).map(|_| [0; 3].map(|_| random.random_range(0..points))).collect();
            let all = of_triangles(triangles.iter().copied(), 10);
            let mut slow: Vec<([u32; 2], u32)> = all.clone().map(|([a, b], t)| ([a.min(b), a.max(b)], t)).collect();
            slow.sort_unstable();
            let sides = HalfEdges::new(points as usize, all);
            let found = sides.edges().flat_map(|(edge, sides)| sides.iter().map(move |(_, t)| (edge, *t)));
            assert!(found.eq(slow.iter().copied()));
            assert!(sides.edges().map(|(edge, _)| edge).is_sorted_by(|a, b| a < b));
        }
    }
}
