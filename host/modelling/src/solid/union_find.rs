//! Sets that grow together.

/// Disjoint sets of numbers.
#[derive(Clone, Debug, Default)]
pub struct UnionFind {
    parent: Vec<u32>,
}

impl UnionFind {
    /// A number of sets with one member each.
    pub fn new(count: usize) -> UnionFind {
        UnionFind { parent: (0..count as u32).collect() }
    }

    /// Adds a set of one.
    pub fn grow(&mut self) {
        self.parent.push(self.parent.len() as u32);
    }

    /// The lowest member of the set of a number.
    pub fn root(&self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            member = self.parent[member as usize];
        }
        member
    }

    /// The lowest member of the set of a number; shortens the way to it for the next time.
    pub fn find(&mut self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            let above = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = above;
            member = above;
        }
        member
    }

    /// Joins the sets of three numbers.
    pub fn join_three(&mut self, [one, two, three]: [u32; 3]) {
        let [one, two, three] = [self.find(one), self.find(two), self.find(three)];
        if one != two || two != three {
            let lowest = one.min(two).min(three);
            [one, two, three].into_iter().for_each(|root| self.parent[root as usize] = lowest);
        }
    }

    /// Joins the sets of two numbers.
    pub fn join(&mut self, one: u32, two: u32) {
        let (one, two) = (self.find(one), self.find(two));
        // The lower one stays, so that the result does not depend on the order.
        self.parent[one.max(two) as usize] = one.min(two);
    }
}
