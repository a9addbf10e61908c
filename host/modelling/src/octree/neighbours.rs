//! Neighbours: the terminal nodes beside a cube, larger, as large, or smaller.

use std::ops::Range;

use super::build::octants;
use super::{LocationalCode, Octree};

impl Octree {
    /// The terminal nodes that touch a cube from one side, in order.
    ///
    /// - `towards`: -1, 0 or 1 along each axis: one step for the neighbours across a face, two for those that share an
    ///   edge with the cube, three for those at its vertex. Neighbours across a face are whole: those that also touch
    ///   the face's edges are among them. A node that contains the cube is nobody's neighbour.
    /// - Returns nothing where the region is empty, beyond the modelling cube, and for no step at all.
    ///
    /// Cost: a binary search for each cube opened, from the neighbour of the same size down.
    pub fn neighbours(&self, cube: LocationalCode, towards: [i8; 3]) -> Vec<LocationalCode> {
        let towards = towards.map(i8::signum);
        let mut found = Vec::new();
        let Some(beside) = cube.shifted(towards).filter(|&beside| beside != cube) else { return found };
        // The last node that begins before the neighbour of the same size ends is the only one that can contain it.
        let codes = &self.leaves().codes;
        let end = codes.partition_point(|&code| code.begins_before_end_of(beside));
        match end.checked_sub(1).map(|last| codes[last]).filter(|last| last.contains(beside)) {
            Some(larger) if !larger.contains(cube) => found.push(larger),
            Some(_) => {}
            None => self.touching(beside, towards, 0..end, &mut found),
        }
        found
    }

    /// Adds the nodes in a cube that reach the sides turned away from `towards`.
    fn touching(&self, cube: LocationalCode, towards: [i8; 3], nodes: Range<usize>, found: &mut Vec<LocationalCode>) {
        let nodes = self.leaves().within(cube, nodes);
        if nodes.is_empty() {
            return;
        }
        if self.leaves().codes[nodes.start] == cube {
            found.push(cube);
            return;
        }
        for (digit, octant) in octants(cube).enumerate() {
            let reaches = |axis: usize| match towards[axis] {
                1 => digit >> axis & 1 == 0,
                -1 => digit >> axis & 1 == 1,
                _ => true,
            };
            if (0..3).all(reaches) {
                self.touching(octant, towards, nodes.clone(), found);
            }
        }
    }
}
