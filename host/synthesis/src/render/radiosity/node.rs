//! Nodes of the hierarchy: patches, elements and clusters as geometry.

use super::form_factor::Convex;
use glam::DVec3;
use std::ops::Range;

/// A triangle is a sliver if its longest edge is so many times as long as the height on it.
const SLIVER: f64 = 6.0;
/// No node.
pub(super) const NONE: u32 = u32::MAX;

/// One side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RadiosityPatch {
    /// Counter-clockwise about the side.
    pub(super) corners: [DVec3; 3],
    /// The triangle of the scene, and whether it is its outer side.
    pub(super) triangle: u32,
    pub(super) outside: bool,
}

impl RadiosityPatch {
    pub(super) fn middle(&self) -> DVec3 {
        self.corners.iter().sum::<DVec3>() / 3.0
    }
}

/// A cluster, a patch or an element of a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct HierarchyNode {
    /// Corners of a patch or element.
    pub(super) corners: [DVec3; 3],
    /// The middle of its area.
    pub(super) middle: DVec3,
    /// Radius around the middle that holds all of it.
    pub(super) radius: f64,
    /// Unit normal, of a cluster the mean one.
    pub(super) normal: DVec3,
    /// The greatest angle of a normal to it, radians; 0 unless it is a cluster.
    pub(super) spread: f64,
    pub(super) area: f64,
    /// The first of its children, 0 if there are none.
    pub(super) child: u32,
    pub(super) children: u32,
    /// The patch that it is a part of; [`NONE`] for a cluster.
    pub(super) patch: u32,
    /// Whether its children are halves, or what lines made of it, and not its quarters.
    pub(super) is_cut: bool,
    /// Whether a sharp edge of bright light is on it, so that its parts may be shorter than others.
    pub(super) is_sharp: bool,
    /// Whether no light can come to it.
    pub(super) is_dark: bool,
}

impl HierarchyNode {
    pub(super) fn triangle(corners: [DVec3; 3], patch: u32) -> HierarchyNode {
        let [a, b, c] = corners;
        let middle = (a + b + c) / 3.0;
        let (normal, area) = normal_and_area(corners);
        HierarchyNode {
            corners,
            middle,
            radius: corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max),
            normal,
            spread: 0.0,
            area,
            child: 0,
            children: 0,
            patch,
            is_cut: false,
            is_sharp: false,
            is_dark: false,
        }
    }

    pub(super) fn is_cluster(&self) -> bool {
        self.patch == NONE
    }

    pub(super) fn is_leaf(&self) -> bool {
        self.children == 0
    }

    /// Whether it is an element of many triangles.
    pub(super) fn is_face_cluster(&self) -> bool {
        self.is_cluster() && self.is_leaf()
    }

    pub(super) fn children(&self) -> Range<usize> {
        self.child as usize..(self.child + self.children) as usize
    }

    pub(super) fn polygon(&self) -> Convex {
        Convex::new(&self.corners)
    }

    pub(super) fn longest_edge(&self) -> f64 {
        let [a, b, c] = self.corners;
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    /// The longest edge, by the corner where it begins, if it is much longer than the triangle is wide: quarters would
    /// be many and no less thin.
    pub(super) fn sliver(&self) -> Option<usize> {
        let length = |i: usize| self.corners[i].distance(self.corners[(i + 1) % 3]);
        let longest = (1..3).fold(0, |best, i| if length(i) > length(best) { i } else { best });
        (length(longest) * length(longest) > SLIVER * 2.0 * self.area).then_some(longest)
    }

    /// Both triangles that the middle of an edge makes.
    ///
    /// - `edge`: the corner where it begins.
    pub(super) fn halves(&self, edge: usize) -> [[DVec3; 3]; 2] {
        let [a, b, c] = [0, 1, 2].map(|i| self.corners[(edge + i) % 3]);
        let middle = 0.5 * (a + b);
        [[a, middle, c], [middle, b, c]]
    }

    /// The four triangles that the middles of its edges make: at the corners, and the one in the middle.
    pub(super) fn quarters(&self) -> [[DVec3; 3]; 4] {
        let [a, b, c] = self.corners;
        let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]]
    }
}

/// Unit normal and area; both 0 for a triangle without area.
pub(super) fn normal_and_area([a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let cross = (b - a).cross(c - a);
    match cross.try_normalize() {
        Some(normal) if cross.length() > 0.0 => (normal, 0.5 * cross.length()),
        _ => (DVec3::ZERO, 0.0),
    }
}

/// A number for each point: equal points have one, others another.
pub(super) fn key(point: DVec3) -> [u64; 3] {
    // Adding 0 turns -0 into 0.
    point.to_array().map(|x| (x + 0.0).to_bits())
}
