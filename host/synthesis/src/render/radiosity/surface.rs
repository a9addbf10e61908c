//! The solution at every point of every surface: irradiance at the corners of elements, linear between them.
//!
//! Corners that elements share have one value. Where a corner lies in the middle of an edge of a larger element, it has
//! the value of that edge: there are no cracks.

use super::corners::ElementCorners;
use super::elements::Elements;
use super::faces;
use super::hierarchy::Hierarchy;
use super::node::NONE;
use crate::color::Channels;
use crate::render::indirect::IrradiancePart;
use crate::scene::Prepared;
use glam::DVec3;

/// Irradiance over all surfaces.
#[derive(Clone, Debug, Default)]
pub(super) struct SurfaceLight {
    hierarchy: Hierarchy,
    /// The patch of each side of each triangle, outer and inner; [`NONE`] where no light comes.
    patch_of: Vec<[u32; 2]>,
    /// For each node that is a leaf, its corners among the values; [`NONE`] where no light comes.
    corners: Vec<[u32; 3]>,
    /// For each patch that is part of a face cluster, its corners among the values; [`NONE`] where no light comes.
    of_faces: Vec<[u32; 3]>,
    /// Irradiance by lights, and by other elements.
    values: Vec<[Channels; 2]>,
}

/// A side of a triangle, or a part of it, with the parts of which it consists.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementTree {
    /// Its corners, counter-clockwise about the side; of the outer side of a triangle as the scene orders them, of the
    /// inner one the first, the third and the second.
    pub corners: [DVec3; 3],
    /// None for an element; else the four that the middles of its edges make, at the corners and in the middle, or, if
    /// it is cut, two halves or what lines left.
    pub parts: Vec<ElementTree>,
    /// Whether it is cut.
    pub is_cut: bool,
}

impl ElementTree {
    /// How many elements there are in it.
    pub fn leaves(&self) -> usize {
        if self.parts.is_empty() { 1 } else { self.parts.iter().map(ElementTree::leaves).sum() }
    }
}

impl SurfaceLight {
    /// No light anywhere.
    pub(super) fn dark(prepared: &Prepared) -> SurfaceLight {
        SurfaceLight { patch_of: vec![[NONE; 2]; prepared.triangles.len()], ..SurfaceLight::default() }
    }

    /// - `is_dark`: of each leaf, whether no light can come to it.
    /// - `indirect`: irradiance at each corner by other elements, W/m².
    pub(super) fn new(
        prepared: &Prepared,
        elements: Elements<'_>,
        leaves: &[u32],
        is_dark: &[bool],
        shared: &ElementCorners,
        indirect: &[Channels],
    ) -> SurfaceLight {
        let Elements { hierarchy, corner_light: around, direct: lit, .. } = elements;
        let mut patch_of = vec![[NONE; 2]; prepared.triangles.len()];
        for (number, patch) in (0..).zip(&hierarchy.patches) {
            patch_of[patch.triangle as usize][usize::from(!patch.outside)] = number;
        }
        let mut corners = vec![[NONE; 3]; hierarchy.nodes.len()];
        let mut sums = vec![(Channels::ZERO, 0.0); indirect.len()];
        for ((leaf, numbers), _) in leaves.iter().zip(&shared.of).zip(is_dark).filter(|(_, is_dark)| !**is_dark) {
            let node = &hierarchy.nodes[*leaf as usize];
            corners[*leaf as usize] = *numbers;
            for ((number, corner), lit) in numbers.iter().zip(node.corners).zip(around[*leaf as usize].iter()) {
                // The nearer the middle of an element, the more it counts.
                let weight = corner.distance(node.middle).recip();
                let (sum, all) = &mut sums[*number as usize];
                *sum += lit.direct * weight;
                *all += weight;
            }
        }
        let direct = sums.into_iter().map(|(sum, all)| if all > 0.0 { sum * all.recip() } else { sum });
        let mut values: Vec<[Channels; 2]> = direct.zip(indirect).map(|(direct, light)| [direct, *light]).collect();
        for (_, [middle, from, to]) in shared.hanging(&hierarchy, leaves) {
            let (from, to) = (values[from as usize], values[to as usize]);
            values[middle as usize] = [0, 1].map(|part| (from[part] + to[part]) * 0.5);
        }
        let lit_leaves =
            leaves.iter().zip(&shared.of).zip(is_dark).filter(|(_, is_dark)| !**is_dark).map(|(leaf, _)| leaf);
        let faces = lit_leaves.filter(|(leaf, _)| hierarchy.nodes[**leaf as usize].is_face_cluster());
        let faces = faces.map(|(leaf, [corner, ..])| (*leaf, [lit[*leaf as usize], indirect[*corner as usize]]));
        let of_faces = faces::spread(&hierarchy, shared, faces, &mut values);
        SurfaceLight { hierarchy, patch_of, corners, of_faces, values }
    }

    /// Irradiance at a place of a side of a triangle, W/m², in lanes that are means over all wavelength sets.
    ///
    /// - `weights`: of the corners, as the scene orders them.
    pub(super) fn at(&self, triangle: u32, outside: bool, weights: [f64; 3], part: IrradiancePart) -> Channels {
        let patch = self.patch_of[triangle as usize][usize::from(!outside)];
        if patch == NONE {
            return Channels::ZERO;
        }
        let weights = self.hierarchy.patches[patch as usize].weights(weights);
        let (leaf, weights) = self.hierarchy.leaf_at(patch, weights);
        let is_of_faces = self.hierarchy.nodes[leaf as usize].is_cluster();
        let corners = if is_of_faces { self.of_faces[patch as usize] } else { self.corners[leaf as usize] };
        if corners[0] == NONE {
            return Channels::ZERO;
        }
        let of = |(corner, weight): (u32, f64)| {
            let [direct, indirect] = self.values[corner as usize];
            (if part == IrradiancePart::All { direct + indirect } else { indirect }) * weight.max(0.0)
        };
        corners.into_iter().zip(weights).map(of).fold(Channels::ZERO, |a, b| a + b)
    }
}

impl SurfaceLight {
    /// How a side of a triangle is divided; none where no light comes.
    pub(super) fn element_tree(&self, triangle: u32, outside: bool) -> Option<ElementTree> {
        let patch = self.patch_of[triangle as usize][usize::from(!outside)];
        (patch != NONE).then(|| {
            let node = self.hierarchy.node_of[patch as usize] as usize;
            match self.hierarchy.nodes[node].is_cluster() {
                true => {
                    let corners = self.hierarchy.patches[patch as usize].corners;
                    ElementTree { corners, parts: Vec::new(), is_cut: false }
                }
                false => self.tree_of(node),
            }
        })
    }

    fn tree_of(&self, node: usize) -> ElementTree {
        let node = &self.hierarchy.nodes[node];
        let parts = node.children().filter(|_| !node.is_dark).map(|child| self.tree_of(child)).collect();
        ElementTree { corners: node.corners, parts, is_cut: node.is_cut }
    }
}
