//! Elements with what they reflect, and the light that comes to them.

use super::direct::Lit;
use super::hierarchy::{Hierarchy, Node, Patch};
use super::sight::Sight;
use crate::color::Channels;
use crate::illumination::optics::{Optics, Side, Sighting};
use glam::DVec3;
use rayon::prelude::*;

/// Exitance from elsewhere at a point of a side of a triangle, W/m², in lanes that are means over all combs.
///
/// Told the triangle, whether it is its outer side, and the point.
pub type Exitance<'a> = &'a (dyn Fn(u32, bool, DVec3) -> Channels + Sync);

/// Nodes with what is known of them.
pub(super) struct Elements<'a> {
    pub(super) hierarchy: Hierarchy,
    /// Of each node: the part of light that it reflects, the irradiance by lights, and that by other elements.
    pub(super) reflectance: Vec<Channels>,
    pub(super) direct: Vec<Channels>,
    pub(super) indirect: Vec<Channels>,
    /// Radiosity from elsewhere, and all that a node sends, W/m².
    pub(super) extra: Vec<Channels>,
    pub(super) sent: Vec<Channels>,
    /// How much the irradiance by lights varies over a leaf, W/m².
    variation: Vec<f64>,
    exitance: Option<Exitance<'a>>,
    shadows: bool,
}

/// What is known of one node.
struct Known {
    reflectance: Channels,
    direct: Channels,
    variation: f64,
    extra: Channels,
}

impl<'a> Elements<'a> {
    /// Finds the light of all patches.
    pub(super) fn new(
        hierarchy: Hierarchy,
        sight: &Sight<'_>,
        exitance: Option<Exitance<'a>>,
        shadows: bool,
    ) -> Elements<'a> {
        let mut elements = Elements {
            hierarchy,
            reflectance: Vec::new(),
            direct: Vec::new(),
            indirect: Vec::new(),
            extra: Vec::new(),
            sent: Vec::new(),
            variation: Vec::new(),
            exitance,
            shadows,
        };
        elements.learn(sight, 0);
        elements.pull();
        elements
    }

    /// Divides leaves, each once, and finds the light of what comes of them.
    pub(super) fn divide(&mut self, sight: &Sight<'_>, nodes: impl IntoIterator<Item = u32>) {
        let first = self.hierarchy.nodes.len();
        for node in nodes {
            if self.hierarchy.nodes[node as usize].is_leaf() {
                self.hierarchy.divide(node);
                let indirect = self.indirect[node as usize];
                self.indirect.extend([indirect; 4]);
            }
        }
        self.learn(sight, first);
    }

    /// Divides leaves whose light by lights varies by more than a bound, and those that are larger than a length.
    pub(super) fn divide_where_light_varies(&mut self, sight: &Sight<'_>, bound: f64, [finest, coarsest]: [f64; 2]) {
        let mut from = 0;
        loop {
            let nodes = &self.hierarchy.nodes;
            let varies = |node: &usize| {
                let length = nodes[*node].longest_edge();
                let is_divisible = nodes[*node].is_leaf() && length >= 2.0 * finest;
                is_divisible && (length > coarsest || self.variation[*node] > bound)
            };
            let divided: Vec<u32> = (from..nodes.len()).filter(varies).map(|node| node as u32).collect();
            from = nodes.len();
            if divided.is_empty() || from > super::MOST_ELEMENTS {
                break;
            }
            self.divide(sight, divided);
        }
        self.pull();
    }

    /// Finds what is not known of the nodes from one on.
    fn learn(&mut self, sight: &Sight<'_>, first: usize) {
        let nodes = &self.hierarchy.nodes[first..];
        let known: Vec<Known> = nodes.par_iter().map(|node| self.known(sight, node)).collect();
        self.indirect.resize(self.hierarchy.nodes.len(), Channels::ZERO);
        for (Known { reflectance, direct, variation, extra }, place) in known.into_iter().zip(first..) {
            self.reflectance.push(reflectance);
            self.direct.push(direct);
            self.extra.push(extra);
            self.variation.push(variation);
            self.sent.push(extra + reflectance * (direct + self.indirect[place]));
        }
    }

    fn known(&self, sight: &Sight<'_>, node: &Node) -> Known {
        if node.is_cluster() {
            let zero = Channels::ZERO;
            return Known { reflectance: zero, direct: zero, variation: 0.0, extra: zero };
        }
        let patch = &self.hierarchy.patches[node.patch as usize];
        let lit: Lit = sight.light(node, self.shadows);
        let mean = lit.iter().fold(Channels::ZERO, |sum, part| sum + *part) * (lit.len() as f64).recip();
        let off = |part: &Channels| (*part - mean).map(f64::abs).max();
        let extra = self.exitance.map_or(Channels::ZERO, |of| of(patch.triangle, patch.outside, node.middle));
        let lanes = sight.world.appearance.wavelengths.lanes();
        let extra = Channels(std::array::from_fn(|lane| if lane < lanes { extra.0[lane] } else { 0.0 }));
        Known {
            reflectance: reflectance(sight, patch, node),
            direct: mean,
            variation: 2.0 * lit.iter().map(off).fold(0.0, f64::max),
            extra,
        }
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
fn reflectance(sight: &Sight<'_>, patch: &Patch, node: &Node) -> Channels {
    let appearance = &sight.world.appearance;
    let prepared = appearance.prepared;
    let triangle = patch.triangle;
    let optics = appearance.optics(prepared.object_of[triangle as usize], prepared.material_number(triangle));
    let [a, b, c] = node.corners;
    let weights = crate::numeric::triangle::weights(prepared.corners(triangle), node.middle);
    // About the parallelogram of the area of the element.
    let sides = [(b - a) * 0.5f64.sqrt(), (c - a) * 0.5f64.sqrt()];
    let place = optics.is_textured().then(|| prepared.place(triangle, weights, sides));
    let combs = appearance.wavelengths.combs();
    let sum = (0..combs).fold(Channels::ZERO, |sum, comb| {
        let painting = place.as_ref().map(|place| optics.paint(place, comb));
        sum + diffuse(optics, comb, painting.as_ref().map_or(&[], |painting| painting.as_slice()))
    });
    (sum * (combs as f64).recip()).map(|part| part.clamp(0.0, 1.0))
}

/// The part of light that a material reflects diffusely.
pub(in crate::render) fn diffuse(optics: &Optics, comb: usize, painted: &[Channels]) -> Channels {
    let side = Side { before: Channels::ONE, behind: Channels::ONE };
    optics.diffuse(&Sighting { view: DVec3::Z, comb, side, lane: 0, painted })
}
