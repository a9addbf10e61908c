//! The elements of sides of triangles: which one a ray hits.

use super::hierarchy::Hierarchy;

use super::node::NONE;
use super::visibility::{RayTarget, VisibilityTester};

/// Finds elements of a hierarchy.
pub(super) struct SideElements<'a> {
    hierarchy: &'a Hierarchy,
    /// The patch of each side of each triangle, outer and inner; [`NONE`] where there is none.
    patch_of: Vec<[u32; 2]>,
}

impl<'a> SideElements<'a> {
    pub(super) fn new(visibility: &VisibilityTester<'_>, hierarchy: &'a Hierarchy) -> SideElements<'a> {
        let mut patch_of = vec![[NONE; 2]; visibility.world.appearance.prepared.triangles.len()];
        for (number, patch) in (0..).zip(&hierarchy.patches) {
            patch_of[patch.triangle as usize][usize::from(!patch.outside)] = number;
        }
        SideElements { hierarchy, patch_of }
    }

    /// The node of the element that is hit; [`NONE`] where there is none.
    pub(super) fn find(&self, target: RayTarget) -> u32 {
        self.find_place(target).map_or(NONE, |(node, _)| node)
    }

    /// The node of the element that is hit, and the weights of its corners there, or of the corners of the triangle if
    /// the node is a face cluster; nothing where there is none.
    pub(super) fn find_place(&self, target: RayTarget) -> Option<(u32, [f64; 3])> {
        let RayTarget::Side { triangle, outside, weights, .. } = target else { return None };
        match self.patch_of[triangle as usize][usize::from(!outside)] {
            NONE => None,
            patch => Some(self.hierarchy.leaf_at(patch, self.hierarchy.patches[patch as usize].weights(weights))),
        }
    }
}
