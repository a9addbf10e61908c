//! Elements over which the light of others is far from linear.
//!
//! A link is kept where its own error is small, but of many near ones the errors add up: beside a patch of sunlight, each
//! part of it brings little, and all together bring light that changes within the length of an element. What a point
//! source at a distance d brings has second derivatives of about its light over d², so that is summed over all links of
//! an element, and over those of what the element is part of.

use super::bound::RefinementBound;
use super::elements::{Elements, MOST_ELEMENTS};
use super::exchange::ExchangeLink;
use super::refinement::AssessedLink;
use super::visibility::VisibilityTester;

/// Times that elements are divided at the most.
const MOST_ROUNDS: u32 = 4;

/// Divides leaves over which the light of others is farther from linear than so many bounds. Tells those that are as small
/// as they may be, in ascending order.
///
/// - `stopped`: asked before each time; then they stay as they are.
pub(super) fn divide_where_light_curves(
    visibility: &VisibilityTester<'_>,
    elements: &mut Elements<'_>,
    links: &[AssessedLink],
    bound: RefinementBound,
    times: f64,
    stopped: &dyn Fn() -> bool,
) -> Vec<u32> {
    let mut rounds = 0..MOST_ROUNDS;
    loop {
        let second = second_derivatives(elements, links);
        let nodes = &elements.hierarchy.nodes;
        let curves = |place: &u32| {
            let node = &nodes[*place as usize];
            let bend = || 0.5 * second[*place as usize] * node.radius * node.radius;
            node.is_leaf() && !(node.is_dark || node.is_cluster()) && bend() > times * elements.bound_of(*place, bound)
        };
        let all = (0..nodes.len() as u32).filter(curves);
        let may_divide = rounds.next().is_some() && !stopped() && nodes.len() <= MOST_ELEMENTS;
        let (divided, kept): (Vec<u32>, Vec<u32>) =
            all.partition(|place| may_divide && elements.may_divide(&nodes[*place as usize]));
        if divided.is_empty() {
            return kept;
        }
        elements.divide(visibility, divided);
        elements.pull();
    }
}

/// For each node, about the second derivative of the irradiance of its leaves by others, W/m⁴.
fn second_derivatives(elements: &Elements<'_>, links: &[AssessedLink]) -> Vec<f64> {
    let nodes = &elements.hierarchy.nodes;
    let mut second = vec![0.0; nodes.len()];
    for ExchangeLink { a, b, exchange } in links.iter().map(|assessed| assessed.link).filter(|link| link.exchange > 0.0)
    {
        let square = nodes[a as usize].middle.distance_squared(nodes[b as usize].middle);
        for (to, from) in [(a, b), (b, a)] {
            if square > 0.0 {
                second[to as usize] +=
                    elements.sent[from as usize].max() * exchange / (nodes[to as usize].area * square);
            }
        }
    }
    for place in 0..nodes.len() {
        for child in nodes[place].children() {
            second[child] += second[place];
        }
    }
    second
}
