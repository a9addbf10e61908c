//! Elements with their reflectance and external light.

use super::bound::RefinementBound;
use super::correction::{LeafLight, flux_estimates};
use super::direct::{CornerLight, Exitance, ExternalLight, bend, of_parts, spread};
use super::enclosures::EnclosureTree;
use super::exchange::LeafVisibility;
use super::hierarchy::Hierarchy;
use super::node::{HierarchyNode, NONE, RadiosityPatch, normal_and_area};
use super::random_light::random_light;
use super::regions::{self, FluxEstimate};
use super::shortest_edges::ShortestEdges;
use super::side_elements::SideElements;
use super::through_openings::LightThroughOpening;
use super::visibility::VisibilityTester;
use crate::color::Channels;
use crate::render::world::mean_diffuse_albedo;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The longest edge of an element, in shortest ones.
pub(super) const COARSEST: f64 = 16.0;
/// Elements at the most.
pub(super) const MOST_ELEMENTS: usize = 2_000_000;
/// External light that differs by so many bounds over one of the shortest elements has a sharp edge there; its parts may
/// be shorter by this factor. What is near a patch of sunlight in a room is bright by how far that is.
const GLARING: f64 = 1000.0;
const SHARP_EDGE: f64 = 0.25;
/// Light through openings is more than corners tell if it is by so many standard errors.
const SIGNIFICANT: f64 = 3.0;

/// One over the importance of what is worth as many rays as what is shown.
const ALL_RAYS: f64 = 2.0;
/// So many times what chance explains of a difference is taken from it.
const CAUTION: f64 = 1.0;

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
    /// The least irradiance of the leaves of each node that are not dark, in its brightest lane, W/m².
    pub(super) least: Vec<f64>,
    /// The importance of each node: the most of its leaves that are not dark.
    pub(super) importance: Vec<f64>,
    /// External light at places of each node.
    pub(super) corner_light: Vec<CornerLight>,
    /// How short edges may be; and, of each patch, how short beside openings.
    edges: &'a ShortestEdges,
    beside_openings: Vec<f64>,
    exitance: Option<Exitance<'a>>,
    through: &'a [LightThroughOpening],
    shadows: bool,
}

/// The known quantities of one node.
#[derive(Serialize, Deserialize)]
struct Known {
    reflectance: Channels,
    mean: ExternalLight,
    corner_light: CornerLight,
}

/// Flux of lights that comes through openings.
#[derive(Clone, Copy, Default)]
struct FluxThroughOpenings {
    /// W.
    flux: Channels,
    /// In all lanes together.
    variance: f64,
    rays: u32,
}

impl<'a> Elements<'a> {
    /// Finds the external light of all patches.
    ///
    /// - `through`: light that comes through openings.
    pub(super) fn new(
        hierarchy: Hierarchy,
        visibility: &VisibilityTester<'_>,
        exitance: Option<Exitance<'a>>,
        through: &'a [LightThroughOpening],
        shadows: bool,
        edges: &'a ShortestEdges,
    ) -> Elements<'a> {
        let beside_openings =
            hierarchy.patches.iter().map(|patch| visibility.openings.finest_of(patch.corners)).collect();
        let mut elements = Elements {
            hierarchy,
            reflectance: Vec::new(),
            direct: Vec::new(),
            indirect: Vec::new(),
            extra: Vec::new(),
            sent: Vec::new(),
            least: Vec::new(),
            importance: Vec::new(),
            corner_light: Vec::new(),
            edges,
            beside_openings,
            exitance,
            through,
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
                let [least, importance] = [self.least[node as usize], self.importance[node as usize]];
                self.indirect.resize(self.hierarchy.nodes.len(), self.indirect[node as usize]);
                self.least.resize(self.hierarchy.nodes.len(), least);
                self.importance.resize(self.hierarchy.nodes.len(), importance);
            }
        }
        self.evaluate(visibility, first, &known);
    }

    /// Whether a leaf is beside an opening.
    pub(super) fn is_beside_opening(&self, leaf: u32) -> bool {
        let patch = self.hierarchy.nodes[leaf as usize].patch;
        patch != NONE && self.beside_openings[patch as usize].is_finite()
    }

    /// The greatest error of the irradiance of a node by one link, W/m².
    pub(super) fn bound_of(&self, node: u32, bound: RefinementBound) -> f64 {
        bound.of(self.least[node as usize], self.importance[node as usize])
    }

    /// How many rays a leaf is worth, as a part of those of one that is shown, 0..=1. All light of what is shown may come
    /// by few leaves that are not, so what they receive is to be known as well.
    pub(super) fn importance_to_rays(&self, leaf: u32) -> f64 {
        (self.importance[leaf as usize] * ALL_RAYS).min(1.0)
    }

    /// Takes up how important leaves are.
    pub(super) fn take_importance(&mut self, leaves: &[u32], importance: &[f64]) {
        leaves.iter().zip(importance).for_each(|(leaf, importance)| self.importance[*leaf as usize] = *importance);
        self.hierarchy.pull_extreme(&mut self.importance, f64::max);
    }

    /// Whether an element is long enough to be divided.
    pub(super) fn may_divide(&self, node: &HierarchyNode) -> bool {
        node.longest_edge() >= 2.0 * self.shortest_edge(node)
    }

    /// How short edges of parts of a node may be.
    fn shortest_edge(&self, node: &HierarchyNode) -> f64 {
        let shortest = self.edges.of(node) * if node.is_sharp { SHARP_EDGE } else { 1.0 };
        if node.is_cluster() { shortest } else { shortest.min(self.beside_openings[node.patch as usize]) }
    }

    /// Divides leaves over which external light is farther from linear than so many bounds, those on which more comes
    /// through openings than their corners tell, and those that are too large.
    pub(super) fn divide_where_light_varies(
        &mut self,
        visibility: &VisibilityTester<'_>,
        bound: RefinementBound,
        times: f64,
    ) {
        self.sharpen(visibility, bound);
        let mut from = 0;
        loop {
            let nodes = &self.hierarchy.nodes;
            let through = self.flux_through_openings(visibility);
            let varies = |node: &usize| {
                let is_divisible = nodes[*node].is_leaf() && !nodes[*node].is_dark && self.may_divide(&nodes[*node]);
                let bound = || times * self.bound_of(*node as u32, bound);
                let missed = || {
                    let FluxThroughOpenings { flux, variance, .. } = through[*node];
                    let excess = flux.max() - self.direct[*node].max() * nodes[*node].area;
                    excess > bound() * nodes[*node].area && excess > SIGNIFICANT * variance.sqrt()
                };
                is_divisible
                    && (nodes[*node].longest_edge() > COARSEST * self.edges.of(&nodes[*node])
                        || bend(&self.corner_light[*node]) > bound()
                        || missed())
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

    /// Finds the shortest elements over which light differs by very many bounds: their parts may be shorter, and what is
    /// known of them is found between their corners, too.
    fn sharpen(&mut self, visibility: &VisibilityTester<'_>, bound: RefinementBound) {
        let nodes = &self.hierarchy.nodes;
        let is_sharp = |place: &usize| {
            let node = &nodes[*place];
            node.is_leaf()
                && !(node.is_dark || node.is_cluster() || self.may_divide(node))
                && spread(&self.corner_light[*place]) > GLARING * self.bound_of(*place as u32, bound)
                && self.may_divide(&HierarchyNode { is_sharp: true, ..*node })
        };
        let sharp: Vec<usize> = (0..nodes.len()).filter(is_sharp).collect();
        sharp.iter().for_each(|place| self.hierarchy.nodes[*place].is_sharp = true);
        let known: Vec<Known> = visibility.map(&sharp, |_, place| {
            let corners = self.corner_light[*place].first_chunk().copied();
            self.known(visibility, &self.hierarchy.nodes[*place], corners)
        });
        for (place, Known { mean, corner_light, .. }) in sharp.into_iter().zip(known) {
            (self.direct[place], self.extra[place]) = (mean.direct, mean.extra);
            self.corner_light[place] = corner_light;
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
        self.least.resize(self.hierarchy.nodes.len(), 0.0);
        self.importance.resize(self.hierarchy.nodes.len(), 1.0);
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

    /// Flux of lights that comes through openings to each node that is a leaf.
    fn flux_through_openings(&self, visibility: &VisibilityTester<'_>) -> Vec<FluxThroughOpenings> {
        let mut of = vec![FluxThroughOpenings::default(); self.hierarchy.nodes.len()];
        let elements = SideElements::new(visibility, &self.hierarchy);
        for LightThroughOpening { at, flux } in self.through {
            let node = elements.find(*at);
            if node != NONE {
                let sum = &mut of[node as usize];
                sum.flux += *flux;
                sum.variance += total(*flux).powi(2);
                sum.rays += 1;
            }
        }
        of
    }

    /// Flux of lights to each leaf by rays, to random points of it and through openings. A leaf whose corners no light
    /// comes to has the light that these tell: what is not there cannot be multiplied.
    pub(super) fn sample_direct(&mut self, visibility: &VisibilityTester<'_>, leaves: &[u32]) -> Vec<FluxEstimate> {
        let hierarchy = &self.hierarchy;
        let random = random_light(visibility, hierarchy, leaves, |leaf| self.importance_to_rays(leaf), self.shadows);
        let through = self.flux_through_openings(visibility);
        let mut estimates = Vec::with_capacity(leaves.len());
        for (light, leaf) in random.iter().zip(leaves.iter().map(|leaf| *leaf as usize)) {
            let (area, through) = (hierarchy.nodes[leaf].area, &through[leaf]);
            let flux = light.irradiance * area + through.flux;
            if self.direct[leaf] == Channels::ZERO {
                self.direct[leaf] = flux * area.recip();
                self.corner_light[leaf].iter_mut().for_each(|light| light.direct = self.direct[leaf]);
            }
            estimates.push(FluxEstimate {
                by_elements: area * total(self.direct[leaf]),
                by_rays: total(flux),
                variance: area * area * light.variance + through.variance,
                rays: u64::from(light.samples + through.rays),
            });
        }
        self.pull();
        estimates
    }

    /// Corrects the light of lights, so that regions receive of lights what rays tell.
    ///
    /// Light samples at the corners of elements are the same for all: light differs smoothly, but the errors are of one
    /// sign over all of a room, and what comes through small openings is between them.
    ///
    /// - `estimates`: as [`Self::sample_direct`] tells them. `enclosures`: of each leaf.
    pub(super) fn correct_direct(&mut self, leaves: &[u32], estimates: &[FluxEstimate], enclosures: &[u32]) {
        let tree = EnclosureTree::new(&self.hierarchy, leaves, enclosures);
        for (leaf, factor) in leaves.iter().zip(regions::factors(&tree, leaves, estimates, CAUTION)) {
            self.direct[*leaf as usize] *= factor;
            self.corner_light[*leaf as usize].iter_mut().for_each(|light| light.direct *= factor);
        }
        self.pull();
    }

    /// The standard error of the mean over all leaves of what each receives as rays tell it, as a part of that: dim
    /// leaves count as much as bright ones, each as much as it is important. That of one leaf is no more than all its
    /// light: few next to dark leaves would tell of nothing but themselves.
    pub(super) fn error_by_chance(&self, leaves: &[u32], visibility: &LeafVisibility) -> f64 {
        let of = |values: &[Channels]| -> Vec<Channels> { leaves.iter().map(|leaf| values[*leaf as usize]).collect() };
        let [reflectance, direct, extra, irradiance] =
            [&self.reflectance, &self.direct, &self.extra, &self.indirect].map(|values| of(values));
        let first: Vec<Channels> = (0..leaves.len()).map(|i| extra[i] + reflectance[i] * direct[i]).collect();
        let areas: Vec<f64> = leaves.iter().map(|leaf| self.hierarchy.nodes[*leaf as usize].area).collect();
        let light = LeafLight { first: &first, reflectance: &reflectance, irradiance: &irradiance, brightness: &[] };
        let all = |i: usize| areas[i] * total(direct[i] + irradiance[i]);
        let estimates = flux_estimates(&areas, visibility, &light);
        let importance = |i: usize| self.importance_to_rays(leaves[i]);
        let of = |(i, estimate): (usize, &FluxEstimate)| match all(i) {
            all if all > 0.0 => (estimate.variance / (all * all)).min(1.0) * importance(i) * importance(i),
            _ => 0.0,
        };
        let sum: f64 = estimates.iter().enumerate().map(of).sum();
        let all_importance: f64 = (0..leaves.len()).map(importance).sum();
        if all_importance > 0.0 { sum.sqrt() / all_importance } else { 0.0 }
    }

    /// The power that a node sends, in all lanes together: W.
    pub(super) fn power(&self, node: u32) -> f64 {
        total(self.sent[node as usize]) * self.hierarchy.nodes[node as usize].area
    }

    /// Brings what is known of leaves up to the root.
    pub(super) fn pull(&mut self) {
        let Elements { hierarchy, reflectance, direct, indirect, extra, sent, least, .. } = self;
        for leaf in hierarchy.leaves().into_iter().map(|leaf| leaf as usize) {
            let irradiance = direct[leaf] + indirect[leaf];
            sent[leaf] = extra[leaf] + reflectance[leaf] * irradiance;
            least[leaf] = irradiance.max();
        }
        hierarchy.pull_extreme(least, f64::min);
        for values in [direct, indirect, extra, sent] {
            hierarchy.pull(values);
        }
    }
}

/// The sum over all lanes.
fn total(channels: Channels) -> f64 {
    channels.0.iter().sum()
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
