//! The hierarchy that exchanges light: clusters of patches, patches, and elements into which patches are divided.
//!
//! A patch is one side of a triangle. Clusters hold patches that are near each other and face the same way, so that
//! light that a cluster receives may be spread over all of it. A smooth piece of a surface of many small triangles is
//! one element: a cluster that is not divided, a face cluster.

use super::face_clusters::face_clusters;
use super::node::{HierarchyNode, NONE, RadiosityPatch};
use super::shortest_edges::ShortestEdges;
use crate::color::Channels;
use crate::numeric::bounds::Bounds;
use crate::numeric::triangle;
use glam::DVec3;
use std::ops::{Add, Mul, Range};

/// How much a difference of unit normals counts in clusters, in diagonals of the scene.
const NORMALS: f64 = 0.35;
/// Points that stand for a node where visibility is asked for.
pub(super) const POINTS: usize = 4;
/// A quantity that has sums and means: a number, or one for each lane.
pub(super) trait Summable: Copy + Default + Send + Sync + Add<Output = Self> + Mul<f64, Output = Self> {}

impl Summable for f64 {}
impl Summable for Channels {}

/// Nodes, parents before their children; the root is the first.
#[derive(Clone, Debug, Default)]
pub(super) struct Hierarchy {
    pub(super) nodes: Vec<HierarchyNode>,
    /// Points and unit normals that stand for each cluster, and its bounds.
    cluster_points: Vec<[[DVec3; 2]; POINTS]>,
    cluster_bounds: Vec<Bounds>,
    pub(super) patches: Vec<RadiosityPatch>,
    /// The node of each patch: its own, or that of the face cluster of which it is.
    pub(super) node_of: Vec<u32>,
    /// The patches, those of a cluster side by side, and for each node that is not a part of a patch which of them it
    /// has.
    order: Vec<u32>,
    ranges: Vec<Range<usize>>,
}

impl Hierarchy {
    /// Clusters over patches, each of which has an area.
    ///
    /// - `edges`: of elements; face clusters have no greater radius.
    /// - `is_alone`: whether a patch is to be part of no face cluster.
    pub(super) fn new(
        patches: Vec<RadiosityPatch>,
        edges: &ShortestEdges,
        is_alone: impl Fn(&RadiosityPatch) -> bool,
    ) -> Hierarchy {
        let own: Vec<HierarchyNode> = own_nodes(&patches);
        let faces = face_clusters(&own, edges, |patch| is_alone(&patches[patch as usize]));
        Hierarchy::of_faces(patches, &faces)
    }

    /// Clusters over patches of which it is known which are one element.
    ///
    /// - `faces`: the patches of each face cluster, and each patch that is alone.
    pub(super) fn of_faces(patches: Vec<RadiosityPatch>, faces: &[Vec<u32>]) -> Hierarchy {
        let mut hierarchy = Hierarchy { node_of: vec![NONE; patches.len()], patches, ..Hierarchy::default() };
        if hierarchy.patches.is_empty() {
            return hierarchy;
        }
        let own = own_nodes(&hierarchy.patches);
        let (low, high) = own.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), node| {
            (low.min(node.middle), high.max(node.middle))
        });
        let scale = NORMALS * low.distance(high);
        let of_faces = |faces_of: &[u32]| -> Vec<u32> {
            faces_of.iter().flat_map(|face| faces[*face as usize].iter().copied()).collect()
        };
        let node_of_face = |members: &Vec<u32>| match members[..] {
            [single] => own[single as usize],
            _ => cluster(members.iter().copied(), &own),
        };
        let face: Vec<HierarchyNode> = faces.iter().map(node_of_face).collect();
        let mut order: Vec<u32> = (0..faces.len() as u32).collect();
        // Breadth first, so that all clusters come before all patches but those that are alone.
        hierarchy.nodes.push(own[0]);
        let mut waiting = std::collections::VecDeque::from([(0usize, 0..faces.len())]);
        let mut ranges = Vec::new();
        while let Some((place, range)) = waiting.pop_front() {
            let part = &mut order[range.clone()];
            if let [single] = part {
                hierarchy.nodes[place] = face[*single as usize];
                faces[*single as usize].iter().for_each(|patch| hierarchy.node_of[*patch as usize] = place as u32);
                ranges.push(range);
                continue;
            }
            let all = cluster(of_faces(part).iter().copied(), &own);
            halve(part, &face, scale);
            let child = hierarchy.nodes.len() as u32;
            hierarchy.nodes[place] = HierarchyNode { child, children: 2, ..all };
            hierarchy.nodes.extend([own[0]; 2]);
            let middle = range.start + range.len() / 2;
            waiting.extend([(child as usize, range.start..middle), (child as usize + 1, middle..range.end)]);
            ranges.push(range);
        }
        // From ranges of faces to those of their patches.
        let mut first = Vec::with_capacity(order.len() + 1);
        let mut below = 0;
        for face in &order {
            first.push(below);
            below += faces[*face as usize].len();
        }
        first.push(below);
        let order = of_faces(&order);
        let ranges: Vec<Range<usize>> = ranges.iter().map(|range| first[range.start]..first[range.end]).collect();
        let points = |range: &Range<usize>| representatives(&order[range.clone()], &own);
        let corners = |range: &Range<usize>| order[range.clone()].iter().flat_map(|patch| own[*patch as usize].corners);
        hierarchy.cluster_points = ranges.iter().map(points).collect();
        hierarchy.cluster_bounds = ranges.iter().map(|range| Bounds::of(corners(range))).collect();
        (hierarchy.order, hierarchy.ranges) = (order, ranges);
        hierarchy
    }

    /// The patches of each face cluster, and each patch that is alone.
    pub(super) fn faces(&self) -> Vec<Vec<u32>> {
        let mut number_of = vec![NONE; self.nodes.len()];
        let mut faces: Vec<Vec<u32>> = Vec::new();
        for (patch, node) in (0..).zip(&self.node_of) {
            let number = &mut number_of[*node as usize];
            if *number == NONE {
                *number = faces.len() as u32;
                faces.push(Vec::new());
            }
            faces[*number as usize].push(patch);
        }
        faces
    }

    /// The bounds of a cluster.
    pub(super) fn cluster_bounds(&self, cluster: u32) -> Bounds {
        self.cluster_bounds[cluster as usize]
    }

    /// The point of a cluster that is the nearest to its middle.
    pub(super) fn central(&self, cluster: u32) -> [DVec3; 2] {
        let middle = self.nodes[cluster as usize].middle;
        let [first, others @ ..] = self.points(cluster);
        let nearer = |best: [DVec3; 2], point: [DVec3; 2]| {
            if point[0].distance_squared(middle) < best[0].distance_squared(middle) { point } else { best }
        };
        others.into_iter().fold(first, nearer)
    }

    /// The patches of a cluster.
    pub(super) fn members(&self, cluster: u32) -> &[u32] {
        &self.order[self.ranges[cluster as usize].clone()]
    }

    /// A point of a leaf with its unit normal.
    ///
    /// - `index`, `uniform`: which one, the second in the unit square.
    pub(super) fn place(&self, leaf: u32, index: u32, uniform: [f64; 2]) -> [DVec3; 2] {
        let node = &self.nodes[leaf as usize];
        if node.is_cluster() {
            return self.cluster_points[leaf as usize][index as usize % POINTS];
        }
        let [a, b, c] = node.corners;
        let [u, v] = crate::numeric::sampling::triangle(uniform);
        // Points that are on an edge may lie in another surface.
        let [u, v] = [u, v].map(|weight| weight * 0.998 + 0.001 / 1.5);
        [a + (b - a) * u + (c - a) * v, node.normal]
    }

    /// Divides a leaf into four, or a sliver into two.
    pub(super) fn divide(&mut self, node: u32) {
        let of = &self.nodes[node as usize];
        match of.sliver() {
            Some(edge) => {
                let halves = of.halves(edge);
                self.divide_into(node, &halves);
                self.nodes[node as usize].is_cut = true;
            }
            None => {
                let quarters = of.quarters();
                self.divide_into(node, &quarters);
            }
        }
    }

    pub(super) fn divide_into(&mut self, node: u32, parts: &[[DVec3; 3]]) {
        let child = self.nodes.len() as u32;
        let parent = &mut self.nodes[node as usize];
        (parent.child, parent.children) = (child, parts.len() as u32);
        let HierarchyNode { patch, is_dark, is_sharp, .. } = *parent;
        let part =
            |corners: &[DVec3; 3]| HierarchyNode { is_dark, is_sharp, ..HierarchyNode::triangle(*corners, patch) };
        self.nodes.extend(parts.iter().map(part));
    }

    /// Leaves the dark out: what is left of nodes has the area of what is not dark.
    ///
    /// - `is_dark`: of each node, whether no light can come to it if it is a leaf.
    pub(super) fn darken(&mut self, is_dark: &[bool]) {
        for place in (0..self.nodes.len()).rev() {
            let node = &self.nodes[place];
            let (dark, area) = match node.is_leaf() {
                true => (is_dark[place], node.area),
                false => {
                    let lit = || node.children().map(|child| &self.nodes[child]).filter(|child| !child.is_dark);
                    (lit().next().is_none(), lit().map(|child| child.area).sum())
                }
            };
            let node = &mut self.nodes[place];
            (node.is_dark, node.area) = (dark, area);
        }
    }

    /// Points and unit normals that stand for a node, each for the same part of its area.
    pub(super) fn points(&self, node: u32) -> [[DVec3; 2]; POINTS] {
        let of = &self.nodes[node as usize];
        match of.is_cluster() {
            true => self.cluster_points[node as usize],
            false => of.quarters().map(|[a, b, c]| [(a + b + c) / 3.0, of.normal]),
        }
    }

    /// The leaves to which light may come.
    pub(super) fn leaves(&self) -> Vec<u32> {
        let is_leaf = |node: &HierarchyNode| node.is_leaf() && !node.is_dark;
        (0..self.nodes.len() as u32).filter(|node| is_leaf(&self.nodes[*node as usize])).collect()
    }

    /// For each node its number among some leaves, or [`NONE`].
    ///
    /// - `leaves`: their nodes.
    pub(super) fn numbers_of(&self, leaves: &[u32]) -> Vec<u32> {
        let mut numbers = vec![NONE; self.nodes.len()];
        (0..).zip(leaves).for_each(|(number, leaf)| numbers[*leaf as usize] = number);
        numbers
    }

    /// The leaf of a patch at a place of it, and the weights of the corners of the leaf there, or of those of the patch
    /// if that is part of a face cluster.
    pub(super) fn leaf_at(&self, patch: u32, mut weights: [f64; 3]) -> (u32, [f64; 3]) {
        let mut at = self.node_of[patch as usize];
        while !self.nodes[at as usize].is_leaf() {
            let node = &self.nodes[at as usize];
            if node.is_cut {
                let [a, b, c] = node.corners;
                let point = a * weights[0] + b * weights[1] + c * weights[2];
                // Off a child are the weights those of the nearest point of it, or about that.
                let within = |child: usize| triangle::weights(self.nodes[child].corners, point);
                let off = |child: usize| {
                    let ([a, b, c], weights) = (self.nodes[child].corners, within(child));
                    point.distance_squared(a * weights[0] + b * weights[1] + c * weights[2])
                };
                let best = node.children().min_by(|one, other| off(*one).total_cmp(&off(*other)));
                let best = best.unwrap_or(node.child as usize);
                (at, weights) = (best as u32, within(best));
                continue;
            }
            let corner = weights.iter().position(|weight| *weight >= 0.5);
            weights = match corner {
                Some(corner) => std::array::from_fn(|i| 2.0 * weights[i] - if i == corner { 1.0 } else { 0.0 }),
                None => weights.map(|weight| 1.0 - 2.0 * weight),
            };
            at = self.nodes[at as usize].child + corner.unwrap_or(3) as u32;
        }
        (at, weights)
    }

    /// Sums of what leaves have, from the leaves up to the root: of their values times their areas, over the area.
    pub(super) fn pull<V: Summable>(&self, values: &mut [V]) {
        let is_inner = |node: &HierarchyNode| !node.is_leaf() && !node.is_dark;
        for place in (0..self.nodes.len()).rev().filter(|place| is_inner(&self.nodes[*place])) {
            let node = &self.nodes[place];
            let lit = node.children().filter(|child| !self.nodes[*child].is_dark);
            let sum = lit.fold(V::default(), |sum, child| sum + values[child] * self.nodes[child].area);
            values[place] = sum * node.area.recip();
        }
    }

    /// Sums of what nodes have, from the leaves up to the root.
    ///
    /// - `add`: the sum of two.
    pub(super) fn add_up<S: Copy>(&self, values: &mut [S], add: impl Fn(S, S) -> S) {
        for place in (0..self.nodes.len()).rev() {
            for child in self.nodes[place].children() {
                values[place] = add(values[place], values[child]);
            }
        }
    }

    /// The neighbourhood of each node: itself if it is large enough, else the least node above it that is, or the root.
    ///
    /// - `is_enough`: whether a node is large enough.
    pub(super) fn neighbourhoods(&self, is_enough: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut around: Vec<usize> = (0..self.nodes.len()).collect();
        for place in 0..self.nodes.len() {
            for child in self.nodes[place].children() {
                around[child] = if is_enough(child) { child } else { around[place] };
            }
        }
        around
    }

    /// The least or the most of the leaves of each node that are not dark.
    ///
    /// - `of_two`: the less or the more of two.
    pub(super) fn pull_extreme(&self, values: &mut [f64], of_two: fn(f64, f64) -> f64) {
        let is_inner = |node: &HierarchyNode| !node.is_leaf() && !node.is_dark;
        for place in (0..self.nodes.len()).rev().filter(|place| is_inner(&self.nodes[*place])) {
            let lit = self.nodes[place].children().filter(|child| !self.nodes[*child].is_dark);
            values[place] = lit.map(|child| values[child]).reduce(of_two).unwrap_or(values[place]);
        }
    }
}

/// A node for each patch.
fn own_nodes(patches: &[RadiosityPatch]) -> Vec<HierarchyNode> {
    (0..).zip(patches).map(|(i, patch)| HierarchyNode::triangle(patch.corners, i)).collect()
}

/// Orders the members so that the two halves are well apart.
fn halve(part: &mut [u32], own: &[HierarchyNode], scale: f64) {
    let place = |node: &HierarchyNode| {
        let normal = node.normal * scale;
        let at = node.middle;
        [at.x, at.y, at.z, normal.x, normal.y, normal.z]
    };
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 6];
    for member in part.iter() {
        for (range, at) in range.iter_mut().zip(place(&own[*member as usize])) {
            *range = [range[0].min(at), range[1].max(at)];
        }
    }
    let axis = (0..6).max_by(|a, b| (range[*a][1] - range[*a][0]).total_cmp(&(range[*b][1] - range[*b][0])));
    let axis = axis.unwrap_or(0);
    let key = |member: &u32| place(&own[*member as usize])[axis];
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
}

/// The node of a cluster of some patches, at least one.
fn cluster(part: impl Iterator<Item = u32> + Clone, own: &[HierarchyNode]) -> HierarchyNode {
    let members = || part.clone().map(|member| &own[member as usize]);
    let area: f64 = members().map(|node| node.area).sum();
    let middle = members().map(|node| node.middle * node.area).sum::<DVec3>() / area;
    let normal = members()
        .map(|node| node.normal * node.area)
        .sum::<DVec3>()
        .normalize_or(members().next().map_or(DVec3::ZERO, |node| node.normal));
    let spread = members().map(|node| node.normal.dot(normal).clamp(-1.0, 1.0).acos()).fold(0.0, f64::max);
    let radius = members().flat_map(|node| node.corners).map(|corner| corner.distance(middle)).fold(0.0, f64::max);
    let corners = [middle; 3];
    HierarchyNode { corners, middle, radius, normal, spread, area, ..HierarchyNode::triangle(corners, NONE) }
}

/// A few members at even steps of the area, by their middles.
fn representatives(part: &[u32], own: &[HierarchyNode]) -> [[DVec3; 2]; POINTS] {
    let all: f64 = part.iter().map(|member| own[*member as usize].area).sum();
    let mut found = [[DVec3::ZERO; 2]; POINTS];
    let (mut below, mut next) = (0.0, 0);
    for member in part {
        let node = &own[*member as usize];
        below += node.area;
        while next < POINTS && below >= all * (next as f64 + 0.5) / POINTS as f64 {
            found[next] = [node.middle, node.normal];
            next += 1;
        }
    }
    let last = &own[part[part.len() - 1] as usize];
    found[next..].fill([last.middle, last.normal]);
    found
}

#[cfg(test)]
mod tests {
    use super::super::direct::{ExternalLight, of_parts};
    use super::*;
    use crate::color::Channels;

    fn patch(corners: [DVec3; 3]) -> RadiosityPatch {
        RadiosityPatch { corners, triangle: 0, outside: true }
    }

    #[test]
    fn slivers_are_divided_into_two_and_what_is_known_at_corners_goes_with_them() {
        let at = DVec3::new;
        let slim = [at(0.0, 0.0, 0.0), at(0.0, 0.1, 0.0), at(-8.0, 0.0, 0.0)];
        let broad = [at(0.0, 0.0, 0.0), at(3.0, 0.0, 0.0), at(0.0, 3.0, 0.0)];
        for (corners, parts) in [(slim, 2), (broad, 4)] {
            let mut hierarchy = Hierarchy::new(vec![patch(corners)], &ShortestEdges::everywhere(1e-9), |_| false);
            let sliver = hierarchy.nodes[0].sliver();
            hierarchy.divide(0);
            let children: Vec<HierarchyNode> = hierarchy.nodes[1..].to_vec();
            assert_eq!((children.len(), hierarchy.nodes[0].is_cut), (parts, parts == 2));
            let area: f64 = children.iter().map(|child| child.area).sum();
            assert!((area - hierarchy.nodes[0].area).abs() < 1e-12 && children.iter().all(|c| c.normal.z > 0.99));
            // Light that tells where it is.
            let lit = |at: DVec3| ExternalLight { direct: Channels::splat(at.x - 10.0 * at.y), extra: Channels::ZERO };
            let [a, b, c] = corners;
            let around = [a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)].map(lit);
            for (child, known) in children.iter().zip(of_parts(&around.into(), sliver)) {
                let known = known.expect("it may be divided");
                for (corner, known) in child.corners.iter().zip(known) {
                    assert_eq!(known.direct, lit(*corner).direct);
                }
            }
        }
    }

    #[test]
    fn triangles_make_one_element_if_they_are_small_alike_and_connected() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let row = |from: f64, gap: f64| {
            (0..4).flat_map(move |k| {
                let x = from + f64::from(k) * (1.0 + gap);
                [
                    patch([at(x, 0.0), at(x + 1.0, 0.0), at(x, 1.0)]),
                    patch([at(x + 1.0, 0.0), at(x + 1.0, 1.0), at(x, 1.0)]),
                ]
            })
        };
        let leaves = |patches: Vec<RadiosityPatch>, finest: f64| {
            Hierarchy::new(patches, &ShortestEdges::everywhere(finest), |_| false).leaves().len()
        };
        assert_eq!(leaves(row(0.0, 0.0).collect(), 10.0), 1);
        // In two of four each, or alone.
        assert_eq!(leaves(row(0.0, 0.0).collect(), 1.2), 2);
        assert_eq!(leaves(row(0.0, 0.0).collect(), 0.1), 8);
        // Squares of two, none of which touches another, are too few.
        assert_eq!(leaves(row(0.0, 0.1).collect(), 10.0), 8);
        // A wall that rises from them faces another direction.
        let wall =
            row(0.0, 0.0).map(|RadiosityPatch { corners, .. }| patch(corners.map(|c| DVec3::new(c.x, 0.0, c.y))));
        assert!(leaves(row(0.0, 0.0).chain(wall).collect(), 10.0) > 1);
    }
}
