//! Disjoint sets (union-find): which patches see each other, and which sets of them are lit.

/// So many are asked at once whether they are lit.
const ASKED: usize = 1024;

/// Disjoint sets of numbers, by union-find (Tarjan 1975).
pub(super) struct DisjointSets(Vec<u32>);

impl DisjointSets {
    pub(super) fn new(count: usize) -> DisjointSets {
        DisjointSets((0..count as u32).collect())
    }

    pub(super) fn root(&mut self, mut at: u32) -> u32 {
        while self.0[at as usize] != at {
            let next = self.0[self.0[at as usize] as usize];
            self.0[at as usize] = next;
            at = next;
        }
        at
    }

    pub(super) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high as usize] = low;
    }

    /// Whether each is in a set with one that is lit.
    ///
    /// - `are_lit`: tells of some whether they are lit. It is asked no more than needs be.
    pub(super) fn joined_to_lit(&mut self, are_lit: impl Fn(&[u32]) -> Vec<bool>) -> Vec<bool> {
        let mut root_lit = vec![false; self.0.len()];
        let mut next = 0;
        while next < self.0.len() {
            let mut asked = Vec::with_capacity(ASKED);
            while next < self.0.len() && asked.len() < ASKED {
                if !root_lit[self.root(next as u32) as usize] {
                    asked.push(next as u32);
                }
                next += 1;
            }
            for (at, _) in asked.iter().zip(are_lit(&asked)).filter(|(_, is_lit)| *is_lit) {
                root_lit[self.root(*at) as usize] = true;
            }
        }
        (0..self.0.len() as u32).map(|at| root_lit[self.root(at) as usize]).collect()
    }
}
