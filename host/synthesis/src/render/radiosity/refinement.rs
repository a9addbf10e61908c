//! The refinement oracle: which nodes exchange light with which. Links are divided until the error bound of each is
//! small enough.
//!
//! # Source
//! Hanrahan, Salzman and Aupperle 1991, with the radiosity in the bound; clusters as Smits, Arvo and Greenberg 1994,
//! here of patches that face alike as Willmott, Heckbert and Garland 1999.

use super::bound::RefinementBound;
use super::elements::Elements;
use super::exchange::ExchangeLink;
use super::form_factor::{self, kernel};
use super::hierarchy::POINTS;
use super::node::HierarchyNode;
use super::visibility::VisibilityTester;
use crate::numeric::bounds::Bounds;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// Error of form factors, as a part of the smaller element.
const FORM_FACTOR_ERROR: f64 = 1e-2;
/// Relative error bound of the visibility of a link, as a part of its light: where rays disagree, where none comes
/// through, where all do.
const PARTLY_VISIBLE: f64 = 0.5;
const NOT_VISIBLE: f64 = 0.1;
const ALL_VISIBLE: f64 = 0.02;
/// Radii are the same if one is no less than this part of the other: rounding errors do not decide which node is divided.
const ALIKE: f64 = 1.0 - 1e-9;
/// What reaches less above a plane, as a part of both sizes, does so by rounding errors.
const FLAT: f64 = 1e-9;
/// Elements at the most; beyond them nothing is divided any more.
const MOST_NODES: usize = 3_000_000;

/// A link with its error bound.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct AssessedLink {
    pub(super) link: ExchangeLink,
    /// The error bound of its exchange, square units.
    error_bound: f64,
    /// Whether it is sure that nothing is between its nodes.
    pub(super) is_clear: bool,
}

/// The next refinement step of two nodes.
#[derive(Serialize, Deserialize)]
enum RefinementStep {
    Keep(AssessedLink),
    Drop,
    /// Divides one of them.
    Divide {
        divided: u32,
        other: u32,
        is_clear: bool,
    },
    /// Refines the links within a cluster.
    Within(u32),
}

/// Assesses all links again and divides those whose error bound is too large; at first, the root with itself.
pub(super) fn refine(
    visibility: &VisibilityTester<'_>,
    elements: &mut Elements<'_>,
    links: &mut Vec<AssessedLink>,
    bound: RefinementBound,
    stopped: &dyn Fn() -> bool,
) {
    let mut pending: Vec<([u32; 2], bool)> = Vec::new();
    if links.is_empty() {
        pending.push(([0, 0], false));
    }
    links.retain(|assessed| {
        let ExchangeLink { a, b, .. } = assessed.link;
        let is_sure = is_within(elements, bound, [a, b], assessed.error_bound);
        if !is_sure {
            pending.push(([a, b], assessed.is_clear));
        }
        is_sure
    });
    while !pending.is_empty() {
        let may_divide = elements.hierarchy.nodes.len() < MOST_NODES && !stopped();
        let bound = if may_divide { bound } else { RefinementBound { mean: f64::INFINITY, ..bound } };
        let decide = |_, (pair, is_clear): &([u32; 2], bool)| {
            RefinementOracle { visibility, elements, bound }.decide(*pair, *is_clear)
        };
        let steps: Vec<RefinementStep> = visibility.map(&pending, decide);
        let divided: Vec<u32> = steps
            .iter()
            .filter_map(|step| match step {
                RefinementStep::Divide { divided, .. } => Some(*divided),
                _ => None,
            })
            .collect();
        elements.divide(visibility, divided);
        pending.clear();
        for step in steps {
            match step {
                RefinementStep::Keep(assessed) => links.push(assessed),
                RefinementStep::Drop => {}
                RefinementStep::Divide { divided, other, is_clear } => {
                    let children = elements.hierarchy.nodes[divided as usize].children();
                    pending.extend(children.map(|child| ([child as u32, other], is_clear)));
                }
                RefinementStep::Within(cluster) => {
                    let children = elements.hierarchy.nodes[cluster as usize].children();
                    for first in children.clone() {
                        pending.extend((first..children.end).map(|second| ([first as u32, second as u32], false)));
                    }
                }
            }
        }
    }
}

/// Whether the error of the irradiance of both nodes by an error of their exchange is within the bound.
fn is_within(elements: &Elements<'_>, bound: RefinementBound, [a, b]: [u32; 2], exchange: f64) -> bool {
    let side = |to: u32, from: u32| {
        let error = elements.sent[from as usize].max() * exchange / elements.hierarchy.nodes[to as usize].area;
        error <= elements.bound_of(to, bound)
    };
    side(a, b) && side(b, a)
}

struct RefinementOracle<'j, 'a> {
    visibility: &'j VisibilityTester<'a>,
    elements: &'j Elements<'a>,
    bound: RefinementBound,
}

impl RefinementOracle<'_, '_> {
    fn node(&self, node: u32) -> &HierarchyNode {
        &self.elements.hierarchy.nodes[node as usize]
    }

    fn is_fine(&self, a: u32, b: u32, exchange: f64) -> bool {
        is_within(self.elements, self.bound, [a, b], exchange)
    }

    fn decide(&self, [a, b]: [u32; 2], is_clear: bool) -> RefinementStep {
        let (first, second) = (self.node(a), self.node(b));
        if first.is_dark || second.is_dark {
            return RefinementStep::Drop;
        }
        if a == b {
            return self.within(a, first);
        }
        let Some(cosines) = self.most_cosine(a, b).and_then(|one| Some(one * self.most_cosine(b, a)?)) else {
            return RefinementStep::Drop;
        };
        let distance = first.middle.distance(second.middle);
        let sizes = first.radius + second.radius;
        let are_elements = !first.is_cluster() && !second.is_cluster();
        let most = form_factor::limit(first.area, second.area, cosines, (distance - sizes).max(0.0));
        // Light between two planes goes within the angle that their normals make, from both sides.
        let turn = first.normal.angle_between(second.normal) + first.spread + second.spread;
        let most = most.min(first.area.min(second.area) * within_turn(turn));
        if self.is_fine(a, b, most) {
            let unoccluded = self.sampled(a, b).min(most);
            let seen = if unoccluded > 0.0 { self.visibility(a, b, is_clear, true) } else { 0.0 };
            let link = ExchangeLink { a, b, exchange: unoccluded * seen };
            return RefinementStep::Keep(AssessedLink { link, error_bound: most, is_clear });
        }
        if !are_elements
            && distance < sizes
            && let Some(step) = self.divide(a, b, is_clear)
        {
            return step;
        }
        let is_clear = is_clear || are_elements && self.visibility.is_clear(first, second);
        let rough = self.sampled(a, b).min(most);
        let variation = (0.5 * sizes / distance + first.spread + second.spread).min(1.0);
        // Whatever rays tell, visibility is less certain than that.
        let least = if is_clear { variation + ALL_VISIBLE } else { NOT_VISIBLE };
        if rough > 0.0
            && !self.is_fine(a, b, least * rough)
            && let Some(step) = self.divide(a, b, is_clear)
        {
            return step;
        }
        let unoccluded = match are_elements {
            true => form_factor::exchange(&first.polygon(), &second.polygon(), FORM_FACTOR_ERROR).min(most),
            false => rough,
        };
        if unoccluded <= 0.0 {
            return match (are_elements, 0.25 * most) {
                (true, _) => RefinementStep::Drop,
                (_, error_bound) if self.is_fine(a, b, error_bound) => none_yet([a, b], error_bound, is_clear),
                _ => self.divide(a, b, is_clear).unwrap_or(RefinementStep::Drop),
            };
        }
        let seen = self.visibility(a, b, is_clear, self.is_fine(a, b, NOT_VISIBLE * unoccluded));
        let unsure = match seen {
            0.0 => NOT_VISIBLE,
            seen if seen < 1.0 => PARTLY_VISIBLE,
            _ => ALL_VISIBLE,
        };
        let error_bound = unoccluded * (variation * seen + unsure);
        let link = ExchangeLink { a, b, exchange: unoccluded * seen };
        if self.is_fine(a, b, error_bound) {
            return RefinementStep::Keep(AssessedLink { link, error_bound, is_clear });
        }
        self.divide(a, b, is_clear).unwrap_or(match seen {
            0.0 => RefinementStep::Drop,
            _ => RefinementStep::Keep(AssessedLink { link, error_bound: 0.0, is_clear }),
        })
    }

    /// The most that the cosine between normals of a node and directions from it to another can be; none where all of the
    /// other is behind it.
    fn most_cosine(&self, node: u32, other: u32) -> Option<f64> {
        let (from, to) = (self.node(node), self.node(other));
        let offset = to.middle - from.middle;
        let distance = offset.length();
        let sizes = from.radius + to.radius;
        let mut most = 1.0;
        if !from.is_cluster() {
            let above = |corner: DVec3| (corner - from.corners[0]).dot(from.normal);
            let highest = match to.is_cluster() {
                false => to.corners.iter().map(|corner| above(*corner)).fold(f64::NEG_INFINITY, f64::max),
                true => {
                    let Bounds { min, max } = self.elements.hierarchy.cluster_bounds(other);
                    above(DVec3::select(from.normal.cmpge(DVec3::ZERO), max, min)) - FLAT * sizes
                }
            };
            if highest <= 0.0 {
                return None;
            }
            most = highest / (distance - sizes);
        }
        if distance <= sizes {
            return Some(1.0);
        }
        if from.is_cluster() {
            // The directions from one to the other are in a cone.
            let cone = (sizes / distance).asin();
            let angle = (offset.dot(from.normal) / distance).clamp(-1.0, 1.0).acos() - cone - from.spread;
            if angle > FRAC_PI_2 {
                return None;
            }
            most = angle.max(0.0).cos();
        }
        Some(most.min(1.0))
    }

    /// The refinement step of a node with itself: an element exchanges nothing, a cluster little if it is nearly flat or
    /// dim.
    fn within(&self, at: u32, node: &HierarchyNode) -> RefinementStep {
        if !node.is_cluster() {
            return RefinementStep::Drop;
        }
        let error_bound = within_turn(2.0 * node.spread) * node.area;
        match self.is_fine(at, at, error_bound) {
            true => none_yet([at, at], error_bound, false),
            false => RefinementStep::Within(at),
        }
    }

    /// The larger of both that can be divided.
    fn divide(&self, a: u32, b: u32, is_clear: bool) -> Option<RefinementStep> {
        let can = |node: &HierarchyNode| !node.is_leaf() || self.elements.may_divide(node);
        let (first, second) = (self.node(a), self.node(b));
        let takes_first = can(first) && (first.radius >= second.radius * ALIKE || !can(second));
        if takes_first {
            Some(RefinementStep::Divide { divided: a, other: b, is_clear })
        } else {
            can(second).then_some(RefinementStep::Divide { divided: b, other: a, is_clear })
        }
    }

    /// The exchange of two nodes by their points.
    fn sampled(&self, a: u32, b: u32) -> f64 {
        let hierarchy = &self.elements.hierarchy;
        let (from, to) = (hierarchy.points(a), hierarchy.points(b));
        let sum: f64 = from.iter().flat_map(|from| to.iter().map(|to| kernel(*from, *to))).sum();
        let each = self.node(a).area * self.node(b).area / (POINTS * POINTS) as f64;
        if sum.is_finite() { sum * each } else { self.node(a).area.min(self.node(b).area) }
    }

    /// The visible part of light from points of one to points of the other.
    ///
    /// - `is_clear`: nothing is between them. `roughly`: a few rays will do.
    fn visibility(&self, a: u32, b: u32, is_clear: bool, roughly: bool) -> f64 {
        if is_clear {
            return 1.0;
        }
        let hierarchy = &self.elements.hierarchy;
        let (from, to) = (hierarchy.points(a), hierarchy.points(b));
        // The pairs of points differ from link to link.
        let shift = (a.wrapping_mul(0x9e37_79b9) ^ b.wrapping_mul(0x85eb_ca6b)) as usize >> 7;
        let (mut seen, mut all) = (0.0, 0.0);
        let mut ask = |round: usize| {
            for (i, from) in from.iter().enumerate() {
                let to = to[(i + shift + round) % POINTS];
                let weight = kernel(*from, to);
                if weight > 0.0 && weight.is_finite() {
                    seen += weight * self.visibility.transmittance(*from, to);
                    all += weight;
                }
            }
            (seen, all)
        };
        let (mut seen, mut all) = ask(0);
        let agree = |seen: f64, all: f64| seen <= 0.0 || seen >= all * (1.0 - 1e-12);
        if !(roughly && agree(seen, all)) {
            (seen, all) = ask(1);
            if !agree(seen, all) {
                ask(2);
                (seen, all) = ask(3);
            }
        }
        if all > 0.0 { if agree(seen, all) { f64::from(seen > 0.0) } else { seen / all } } else { 0.0 }
    }
}

/// Keeps two nodes that exchange nothing that counts with the light that is known, but may when more is.
fn none_yet([a, b]: [u32; 2], error_bound: f64, is_clear: bool) -> RefinementStep {
    RefinementStep::Keep(AssessedLink { link: ExchangeLink { a, b, exchange: 0.0 }, error_bound, is_clear })
}

/// The greatest form factor between elements whose normals differ by an angle: that of all between their planes.
fn within_turn(turn: f64) -> f64 {
    0.5 * (1.0 - turn.min(PI).cos())
}
