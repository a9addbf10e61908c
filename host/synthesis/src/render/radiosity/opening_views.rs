//! What corners of elements see through openings.
//!
//! A few points of a far node tell little of what a small opening shows of it. So corners look through a grid of points of
//! each opening; the same for all corners, so that errors differ as smoothly as what is seen.

use super::form_factor::{from_point, kernel};
use super::hierarchy::Hierarchy;
use super::node::NONE;
use super::side_elements::SideElements;
use super::visibility::{RayTarget, VisibilityTester};
use crate::color::Channels;
use crate::numeric::ray::Ray;
use glam::DVec3;

/// Points of an opening along a side, at the most.
const SIDE: f64 = 8.0;
/// One point is enough for light that may be so small a part of what is there.
const LITTLE: f64 = 1e-3;

/// Looks through openings.
pub(super) struct OpeningViews<'v, 'a> {
    visibility: &'v VisibilityTester<'a>,
    elements: SideElements<'v>,
    hierarchy: &'v Hierarchy,
    /// The most that any leaf sends, W/m².
    brightest: f64,
}

impl<'v, 'a> OpeningViews<'v, 'a> {
    /// - `sent`: about what each node sends, W/m².
    pub(super) fn new(
        visibility: &'v VisibilityTester<'a>,
        hierarchy: &'v Hierarchy,
        sent: &[Channels],
    ) -> OpeningViews<'v, 'a> {
        let brightest = sent.iter().map(|sent| sent.max()).fold(0.0, f64::max);
        OpeningViews { visibility, elements: SideElements::new(visibility, hierarchy), hierarchy, brightest }
    }

    /// Leaves that are seen from a point with its normal, with the part of all that it sees that each is.
    ///
    /// - `least`: its irradiance, W/m².
    pub(super) fn seen(&self, from: [DVec3; 2], least: f64) -> Vec<(u32, f32)> {
        let openings = &self.visibility.openings;
        let mut found = Vec::new();
        for (number, opening) in openings.0.iter().enumerate() {
            let factor = from_point(from[0], from[1], &opening.polygon());
            if factor <= 0.0 {
                continue;
            }
            let side = (factor * self.brightest / (LITTLE * least)).sqrt().clamp(1.0, SIDE).ceil();
            let side = if side.is_finite() { side as u32 } else { SIDE as u32 };
            let outwards = opening.normal * (from[0] - opening.corner()).dot(opening.normal).signum();
            let weights: Vec<(DVec3, f64)> = opening
                .grid(side)
                .map(|at| (at, kernel(from, [at, outwards])))
                .filter(|(_, weight)| *weight > 0.0)
                .collect();
            let all: f64 = weights.iter().map(|(_, weight)| weight).sum();
            for (at, weight) in weights {
                let ray = Ray { origin: from[0] + from[1] * self.visibility.clearance, direction: at - from[0] };
                let target = self.visibility.trace(&ray);
                // The parameter of the opening is 1.
                let RayTarget::Side { t, transmittance, .. } = target else { continue };
                let leaf = if t > 1.0 { self.elements.find(target) } else { NONE };
                if leaf != NONE && !self.hierarchy.nodes[leaf as usize].is_dark {
                    // What is seen through several openings is found in each.
                    let crossed = 1 + openings.others_crossed(number, &ray, t);
                    found.push((leaf, (factor * weight / all * transmittance / crossed as f64) as f32));
                }
            }
        }
        found
    }
}
