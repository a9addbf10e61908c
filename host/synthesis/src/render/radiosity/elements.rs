//! Elements with their reflectance and external light.

use super::direct::{CornerLight, Exitance, ExternalLight, bend, of_parts};
use super::hierarchy::{Hierarchy, HierarchyNode, RadiosityPatch, normal_and_area};
use super::visibility::VisibilityTester;
use crate::color::Channels;
use crate::render::world::mean_diffuse_albedo;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Elements at the most.
const MOST_ELEMENTS: usize = 2_000_000;

/// Nodes with what is known of them.
pub(super) struct Elements<'a> {
    pub(super) hierarchy: Hierarchy,
    /// Reflectance of each node, irradiance by lights, and irradiance by other elements.
    pub(super) reflectance: Vec<Channels>,
    pub(super) direct: Vec<Channels>,
    pub(super) indirect: Vec<Channels>,
    /// Radiosity from elsewhere, and all that a node sends, W/m².
    pub(super) extra: Vec<Channels>,
    pub(super) sent: Vec<Channels>,
    /// External light at places of each node.
    pub(super) corner_light: Vec<CornerLight>,
    /// Elements are divided that are twice as long or longer.
    finest: f64,
    exitance: Option<Exitance<'a>>,
    shadows: bool,
}

/// The known quantities of one node.
#[derive(Serialize, Deserialize)]
struct Known {
    reflectance: Channels,
    mean: ExternalLight,
    corner_light: CornerLight,
}

impl<'a> Elements<'a> {
    /// Finds the external light of all patches.
    ///
    /// - `finest`: a length; elements are divided that are twice as long or longer.
    pub(super) fn new(
        hierarchy: Hierarchy,
        visibility: &VisibilityTester<'_>,
        exitance: Option<Exitance<'a>>,
        shadows: bool,
        finest: f64,
    ) -> Elements<'a> {
        let mut elements = Elements {
            hierarchy,
            reflectance: Vec::new(),
            direct: Vec::new(),
            indirect: Vec::new(),
            extra: Vec::new(),
            sent: Vec::new(),
            corner_light: Vec::new(),
            finest,
            exitance,
            shadows,
        };
        elements.evaluate(visibility, 0, &[]);
        elements.pull();
        elements
    }

    /// Divides leaves, each once, and finds the external light of what comes of them.
    pub(super) fn divide(&mut self, visibility: &VisibilityTester<'_>, nodes: impl IntoIterator<Item = u32>) {
        let first = self.hierarchy.nodes.len();
        let mut known: Vec<Option<[ExternalLight; 3]>> = Vec::new();
        for node in nodes {
            if self.hierarchy.nodes[node as usize].is_leaf() {
                self.hierarchy.divide(node);
                let sliver = self.hierarchy.nodes[node as usize].sliver();
                known.extend(of_parts(&self.corner_light[node as usize], sliver));
                let indirect = self.indirect[node as usize];
                self.indirect.resize(self.hierarchy.nodes.len(), indirect);
            }
        }
        self.evaluate(visibility, first, &known);
    }

    /// Whether an element is long enough to be divided.
    pub(super) fn may_divide(&self, node: &HierarchyNode) -> bool {
        node.longest_edge() >= 2.0 * self.finest
    }

    /// Divides leaves over which external light is farther from linear than a bound, and those that are larger than a
    /// length.
    pub(super) fn divide_where_light_varies(&mut self, visibility: &VisibilityTester<'_>, bound: f64, coarsest: f64) {
        let mut from = 0;
        loop {
            let nodes = &self.hierarchy.nodes;
            let varies = |node: &usize| {
                let is_divisible = nodes[*node].is_leaf() && !nodes[*node].is_dark && self.may_divide(&nodes[*node]);
                is_divisible && (nodes[*node].longest_edge() > coarsest || bend(&self.corner_light[*node]) > bound)
            };
            let divided: Vec<u32> = (from..nodes.len()).filter(varies).map(|node| node as u32).collect();
            from = nodes.len();
            if divided.is_empty() || from > MOST_ELEMENTS {
                break;
            }
            self.divide(visibility, divided);
        }
        self.pull();
    }

    /// Finds what is not known of the nodes from one on.
    ///
    /// - `corners`: what is known at their corners; of none at first.
    fn evaluate(&mut self, visibility: &VisibilityTester<'_>, first: usize, corners: &[Option<[ExternalLight; 3]>]) {
        let nodes = &self.hierarchy.nodes[first..];
        let of = |i: usize, node: &HierarchyNode| match node.is_face_cluster() {
            true => self.known_of_faces(visibility, (first + i) as u32),
            false => self.known(visibility, node, corners.get(i).copied().flatten()),
        };
        let known: Vec<Known> = visibility.map(nodes, of);
        self.indirect.resize(self.hierarchy.nodes.len(), Channels::ZERO);
        for (Known { reflectance, mean: ExternalLight { direct, extra }, corner_light: around }, place) in
            known.into_iter().zip(first..)
        {
            self.reflectance.push(reflectance);
            self.direct.push(direct);
            self.extra.push(extra);
            self.corner_light.push(around);
            self.sent.push(extra + reflectance * (direct + self.indirect[place]));
        }
    }

    fn known(
        &self,
        visibility: &VisibilityTester<'_>,
        node: &HierarchyNode,
        corners: Option<[ExternalLight; 3]>,
    ) -> Known {
        if !node.is_leaf() || node.is_cluster() {
            return Known {
                reflectance: Channels::ZERO,
                mean: ExternalLight::default(),
                corner_light: CornerLight::default(),
            };
        }
        let patch = &self.hierarchy.patches[node.patch as usize];
        let divisible = self.may_divide(node);
        let (around, mean) = visibility.external_light(patch, node, corners, self.exitance, self.shadows, divisible);
        Known { reflectance: reflectance(visibility, patch, (node.corners, node.middle)), mean, corner_light: around }
    }

    /// The known quantities of a face cluster: light of lights at its points, all else by its triangles.
    fn known_of_faces(&self, visibility: &VisibilityTester<'_>, cluster: u32) -> Known {
        let hierarchy = &self.hierarchy;
        if hierarchy.nodes[cluster as usize].is_dark {
            return Known {
                reflectance: Channels::ZERO,
                mean: ExternalLight::default(),
                corner_light: CornerLight::default(),
            };
        }
        let at = |(turn, place): (u32, [DVec3; 2])| visibility.light_roughly(place, self.shadows, turn);
        let points = hierarchy.points(cluster);
        let direct = (0..).zip(points).map(at).fold(Channels::ZERO, |a, b| a + b) * (points.len() as f64).recip();
        let (mut reflected, mut extra, mut all) = (Channels::ZERO, Channels::ZERO, 0.0);
        for member in hierarchy.members(cluster) {
            let patch = &hierarchy.patches[*member as usize];
            let area = normal_and_area(patch.corners).1;
            let middle = patch.middle();
            reflected += reflectance(visibility, patch, (patch.corners, middle)) * area;
            extra += visibility.exitance(patch, middle, self.exitance) * area;
            all += area;
        }
        let mean = ExternalLight { direct, extra: extra * f64::recip(all) };
        Known { reflectance: reflected * f64::recip(all), mean, corner_light: CornerLight::default() }
    }

    /// Brings what is known of leaves up to the root.
    pub(super) fn pull(&mut self) {
        let Elements { hierarchy, reflectance, direct, indirect, extra, sent, .. } = self;
        for leaf in hierarchy.leaves().into_iter().map(|leaf| leaf as usize) {
            sent[leaf] = extra[leaf] + reflectance[leaf] * (direct[leaf] + indirect[leaf]);
        }
        for values in [direct, indirect, extra, sent] {
            hierarchy.pull(values);
        }
    }
}

/// The part of light that an element reflects diffusely, in the mean.
fn reflectance(
    visibility: &VisibilityTester<'_>,
    patch: &RadiosityPatch,
    ([a, b, c], middle): ([DVec3; 3], DVec3),
) -> Channels {
    let appearance = &visibility.world.appearance;
    let prepared = appearance.prepared;
    let triangle = patch.triangle;
    let bsdf = appearance.bsdf(prepared.object_of[triangle as usize], prepared.material_number(triangle));
    let weights = crate::numeric::triangle::weights(prepared.corners(triangle), middle);
    // About the parallelogram of the area of the element.
    let sides = [(b - a) * 0.5f64.sqrt(), (c - a) * 0.5f64.sqrt()];
    let place = bsdf.is_textured().then(|| prepared.texture_place(triangle, weights, sides));
    mean_diffuse_albedo(bsdf, place.as_ref(), appearance.wavelengths.count()).map(|part| part.clamp(0.0, 1.0))
}
